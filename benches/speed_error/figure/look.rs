//! How the points of a method look.

use super::canvas::{Colour, LINE, Point, Sheet};

/// The colours of Okabe and Ito (2008) that are read on white.
const COLOURS: [Colour; 7] = ["#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"];

/// Half the width of a mark, pixels.
const MARK: f64 = 7.0;

/// Seven colours and six marks, no pair of which comes twice among 42.
#[derive(Clone, Copy)]
pub struct Look(pub usize);

impl Look {
    pub fn colour(self) -> Colour {
        COLOURS[self.0 % COLOURS.len()]
    }

    pub fn line(self, sheet: &mut Sheet, points: &[Point]) {
        sheet.line(points, self.colour(), LINE);
    }

    pub fn mark(self, sheet: &mut Sheet, (x, y): Point) {
        let (colour, r) = (self.colour(), MARK);
        let s = r - 1.0;
        match self.0 % 6 {
            0 => sheet.circle((x, y), r, colour, None),
            1 => sheet.area(&[(x - s, y - s), (x + s, y - s), (x + s, y + s), (x - s, y + s)], colour),
            2 => sheet.area(&[(x - r, y + r), (x + r, y + r), (x, y - r)], colour),
            3 => sheet.area(&[(x - r, y), (x, y - r - 1.0), (x + r, y), (x, y + r + 1.0)], colour),
            4 => {
                sheet.line(&[(x - s, y - s), (x + s, y + s)], colour, 3.0);
                sheet.line(&[(x - s, y + s), (x + s, y - s)], colour, 3.0);
            }
            _ => sheet.circle((x, y), s, colour, Some(3.0)),
        }
    }
}
