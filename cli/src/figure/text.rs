//! Letters, some of them lowered.

use super::element::number;
use super::palette::RGBColor;

/// Where a text stands beside its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum HPos {
    /// It begins there.
    Left,
    /// Its middle is there.
    Center,
    /// It ends there.
    Right,
}

/// Size of lowered letters beside the others, and how much they are lowered, em.
const LOW: (f64, f64) = (0.7, 0.22);
/// Height of the middle of small letters and capitals above their line, em.
const MIDDLE: f64 = 0.35;

/// A text that stands somewhere.
pub(crate) struct Letters {
    /// Pixels of the canvas; the middle in height.
    pub at: (f64, f64),
    pub side: HPos,
    /// Pixels.
    pub size: u32,
    pub colour: RGBColor,
    /// Whether it runs upwards.
    pub upwards: bool,
}

impl Letters {
    /// As SVG text.
    pub fn svg(&self, text: &str) -> String {
        let (x, y) = self.at;
        let size = f64::from(self.size);
        let anchor = match self.side {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let (x, y, turn) = if self.upwards {
            (x + MIDDLE * size, y, format!(" transform=\"rotate(-90 {} {})\"", number(x + MIDDLE * size), number(y)))
        } else {
            (x, y + MIDDLE * size, String::new())
        };
        let colour = self.colour.code();
        let (mut spans, mut lowered) = (String::new(), false);
        for (part, low) in tspans(text) {
            let part = part.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
            let shift = number(if low { LOW.1 * size } else { -LOW.1 * size });
            spans += &match (low, lowered) {
                (true, _) => format!("<tspan dy=\"{shift}\" font-size=\"{}\">{part}</tspan>", number(LOW.0 * size)),
                (false, true) => format!("<tspan dy=\"{shift}\">{part}</tspan>"),
                (false, false) => part,
            };
            lowered = low;
        }
        let (x, y, size) = (number(x), number(y), number(size));
        format!(
            "<text xml:space=\"preserve\" x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{colour}\"{turn}>{spans}</text>"
        )
    }
}

/// The parts of a text, and whether they are lowered: `f_{0x} in N` has the parts `f`, `0x` (lowered), ` in N`.
pub(crate) fn tspans(text: &str) -> impl Iterator<Item = (&str, bool)> {
    text.split("_{")
        .enumerate()
        .flat_map(|(index, part)| match part.split_once('}').filter(|_| index > 0) {
            Some((low, rest)) => [(low, true), (rest, false)],
            None => [(part, false), ("", false)],
        })
        .filter(|(part, _)| !part.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_lower_letters_and_names_keep_their_underscores() {
        let parts: Vec<(&str, bool)> = tspans("f_{0x} in N, φ_{0}").collect();
        assert_eq!(parts, [("f", false), ("0x", true), (" in N, φ", false), ("0", true)]);
        assert_eq!(tspans("O1_q40").collect::<Vec<_>>(), [("O1_q40", false)]);
        let letters = Letters { at: (0.0, 0.0), side: HPos::Left, size: 10, colour: RGBColor(0, 0, 0), upwards: false };
        let text = letters.svg("a_{b}c < d");
        assert!(
            text.contains(">a<tspan dy=\"2.2\" font-size=\"7\">b</tspan><tspan dy=\"-2.2\">c &lt; d</tspan></text>"),
            "{text}"
        );
    }
}
