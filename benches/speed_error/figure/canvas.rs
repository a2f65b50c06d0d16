//! What figures are drawn on and with: SVG in decimal pixels, 1530 of which are 180 mm, the width of a page.

/// Size of letters: titles, everything else (8 pt in print), settings beside points.
pub const TITLE: f64 = 27.0;
pub const BODY: f64 = 24.0;
pub const SMALL: f64 = 18.0;

/// Millimetres a pixel.
const PIXEL: f64 = 180.0 / 1530.0;
/// Height of the middle of letters above their line, em.
const MIDDLE: f64 = 0.35;
/// Width of a line, pixels.
pub const LINE: f64 = 2.5;

/// A colour as SVG has it.
pub type Colour = &'static str;

pub const INK: Colour = "#000000";
pub const FAINT: Colour = "#e1e1e1";

pub type Point = (f64, f64);

/// Where a text stands at its point.
#[derive(Clone, Copy)]
pub enum Side {
    Left,
    Middle,
    Right,
}

/// A drawing.
#[derive(Default)]
pub struct Sheet(String);

impl Sheet {
    /// A white drawing of this size, painted, as SVG text.
    pub fn svg((width, height): Point, paint: impl FnOnce(&mut Self)) -> String {
        let mut sheet = Self::default();
        paint(&mut sheet);
        let [w, h] = [width, height].map(|pixels| number(pixels * PIXEL));
        let [width, height] = [width, height].map(number);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            sheet.0
        )
    }

    /// A part whose pixels count from a corner.
    pub fn part(&mut self, corner: Point, paint: impl FnOnce(&mut Self)) {
        self.put(&format!("<g transform=\"translate({})\">", pair(corner)));
        paint(self);
        self.put("</g>");
    }

    /// Text at a point, which is its middle in height and what `side` says in width.
    pub fn write(&mut self, text: &str, at: Point, side: Side, size: f64, colour: Colour) {
        self.letters(text, (at.0, at.1 + MIDDLE * size), side, (size, colour), "");
    }

    /// Text that runs upwards, its middle at a point.
    pub fn write_upwards(&mut self, text: &str, at: Point, size: f64) {
        let at = (at.0 + MIDDLE * size, at.1);
        let turn = format!(" transform=\"rotate(-90 {} {})\"", number(at.0), number(at.1));
        self.letters(text, at, Side::Middle, (size, INK), &turn);
    }

    fn letters(&mut self, text: &str, (x, y): Point, side: Side, (size, colour): (f64, Colour), turn: &str) {
        let anchor = match side {
            Side::Left => "start",
            Side::Middle => "middle",
            Side::Right => "end",
        };
        let text = text.replace('&', "&amp;").replace('<', "&lt;");
        let [x, y, size] = [x, y, size].map(number);
        self.put(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{colour}\"{turn}>{text}</text>"
        ));
    }

    /// A straight or broken line.
    pub fn line(&mut self, points: &[Point], colour: Colour, width: f64) {
        let points: Vec<String> = points.iter().copied().map(pair).collect();
        let (points, width) = (points.join(" "), number(width));
        self.put(&format!(
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
        ));
    }

    /// The area within points.
    pub fn area(&mut self, points: &[Point], colour: Colour) {
        let points: Vec<String> = points.iter().copied().map(pair).collect();
        self.put(&format!("<polygon points=\"{}\" fill=\"{colour}\"/>", points.join(" ")));
    }

    /// A disc, or with the width of its line a circle.
    pub fn circle(&mut self, (x, y): Point, radius: f64, colour: Colour, line: Option<f64>) {
        let [x, y, radius] = [x, y, radius].map(number);
        let style = match line {
            Some(width) => format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{}\"", number(width)),
            None => format!("fill=\"{colour}\""),
        };
        self.put(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {style}/>"));
    }

    fn put(&mut self, element: &str) {
        self.0.push_str(element);
        self.0.push('\n');
    }
}

/// About how wide a text is. Nothing here knows the reader's font: common ones are no wider.
pub fn width(text: &str, size: f64) -> f64 {
    0.58 * size * text.chars().count() as f64
}

/// To a hundredth of a pixel.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn pair((x, y): Point) -> String {
    format!("{},{}", number(x), number(y))
}
