//! What figures are drawn on and with: pixels, text, marks.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Size of letters: titles, everything else, settings beside points. Coordinates are whole pixels, so figures are drawn
/// large, to be scaled down.
pub const TITLE: u32 = 30;
pub const BODY: u32 = 24;
pub const SMALL: u32 = 17;

pub const INK: RGBColor = RGBColor(0, 0, 0);
pub const FAINT: RGBColor = RGBColor(225, 225, 225);

/// The colours of Okabe and Ito (2008) that are read on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

/// Half the width of a mark.
const MARK: i32 = 7;
const LINE: u32 = 2;

/// A white canvas of this size (pixels), painted, as SVG text.
pub fn svg(size: (u32, u32), paint: impl FnOnce(&Area<'_>)) -> String {
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
    root.fill(&WHITE).unwrap();
    paint(&root);
    root.present().unwrap();
    drop(root);
    text
}

/// Text at a point, which is its middle in height and what `side` says in width.
pub fn write(area: &Area<'_>, text: &str, at: (i32, i32), side: HPos, size: u32, colour: RGBColor) {
    let style = ("sans-serif", size).into_font().color(&colour).pos(Pos::new(side, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style)).unwrap();
}

/// Text that runs upwards, its middle at a point.
pub fn write_upwards(area: &Area<'_>, text: &str, at: (i32, i32), size: u32) {
    let font = ("sans-serif", size).into_font().transform(FontTransform::Rotate270);
    let style = font.color(&INK).pos(Pos::new(HPos::Center, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style)).unwrap();
}

/// About how wide a text is, pixels. Nothing here knows the reader's font: common ones are no wider.
pub fn width(text: &str, size: u32) -> i32 {
    (0.5 * f64::from(size) * text.chars().count() as f64).ceil() as i32
}

/// A straight or broken line.
pub fn stroke(area: &Area<'_>, points: Vec<(i32, i32)>, style: impl Into<ShapeStyle>) {
    area.draw(&PathElement::new(points, style)).unwrap();
}

/// How the points of a method look: seven colours and six marks, no pair of which comes twice among 42.
#[derive(Clone, Copy)]
pub struct Look(pub usize);

impl Look {
    pub fn colour(self) -> RGBColor {
        COLOURS[self.0 % COLOURS.len()]
    }

    pub fn line(self, area: &Area<'_>, points: Vec<(i32, i32)>) {
        stroke(area, points, self.colour().stroke_width(LINE));
    }

    pub fn mark(self, area: &Area<'_>, (x, y): (i32, i32)) {
        let (colour, r) = (self.colour(), MARK);
        let style = colour.stroke_width(3);
        match self.0 % 6 {
            0 => area.draw(&Circle::new((x, y), r, colour.filled())),
            1 => area.draw(&Rectangle::new([(x - r + 1, y - r + 1), (x + r - 1, y + r - 1)], colour.filled())),
            2 => area.draw(&Polygon::new(vec![(x - r, y + r), (x + r, y + r), (x, y - r)], colour)),
            3 => area.draw(&Polygon::new(vec![(x - r, y), (x, y - r - 1), (x + r, y), (x, y + r + 1)], colour)),
            4 => area.draw(&Cross::new((x, y), r - 1, style)),
            _ => area.draw(&Circle::new((x, y), r - 1, style)),
        }
        .unwrap();
    }
}
