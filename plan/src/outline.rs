//! The border of an object by arc length.

use rod_contact::{Contact, ContactKind};
use rod_contours::{Composite, Frame, Range, StretchKind};

/// Gauss-Legendre points and weights on -1 to 1, of degree 9: relative error of the length of a part below 1e-9 where its direction
/// turns by less than a radian.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Parts into which an arc of the contour, which turns by a right angle at most, is cut: none turns by more than a few degrees unless its
/// parameter is very uneven. More: slower.
const PARTS: usize = 64;

/// Halvings after which a place is found to rounding.
const HALVINGS: usize = 60;

/// The border of an object by arc length (m), from its start in its own direction, the solid on the left.
///
/// A border that goes on for ever is cut where no rod reaches it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    knots: Vec<Knot>,
    is_closed: bool,
}

/// A place of the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    stretch: usize,
    /// The stretch's own parameter.
    t: f64,
    /// m
    arc_length: f64,
}

impl Outline {
    /// The outline of an object, each of its stretches cut to a window of its own parameter; none where a window has no end.
    pub(crate) fn within(object: &Composite, window: impl Fn(usize) -> Option<Range>) -> Option<Self> {
        let (mut knots, mut arc_length): (Vec<Knot>, f64) = (Vec::new(), 0.0);
        let is_piece = |stretch: usize| matches!(object.kind(stretch), StretchKind::Piece(_));
        let parts: Vec<_> = object.parts().filter(|part| is_piece(part.stretch)).collect();
        for run in parts.chunk_by(|one, other| one.stretch == other.stretch) {
            let stretch = run[0].stretch;
            let whole = window(stretch)?;
            knots.push(Knot { stretch, t: whole.from, arc_length });
            for part in run.iter().map(|part| part.range.within(whole)).filter(|part| part.from < part.to) {
                for k in 1..=PARTS {
                    let [from, to] = [k - 1, k].map(|k| part.at(k as f64 / PARTS as f64));
                    arc_length += length(object, stretch, from, to);
                    knots.push(Knot { stretch, t: to, arc_length });
                }
            }
        }
        (!knots.is_empty()).then(|| Self { knots, is_closed: object.is_closed() })
    }

    /// Its whole length, m.
    pub fn length(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.arc_length)
    }

    /// Whether its end meets its start.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The contour of `object`, whose outline this is, at an arc length (m).
    pub fn frame(&self, object: &Composite, arc_length: f64) -> Frame {
        let last = self.knots.len() - 1;
        let after = self.knots.partition_point(|knot| knot.arc_length < arc_length).clamp(1, last);
        let (from, to) = (self.knots[after - 1], self.knots[after]);
        if from.stretch != to.stretch {
            return object.own_frame(to.stretch, to.t);
        }
        let (mut low, mut high) = (from.t, to.t);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if from.arc_length + length(object, from.stretch, from.t, middle) < arc_length {
                low = middle;
            } else {
                high = middle;
            }
        }
        object.own_frame(from.stretch, high)
    }

    /// The arc length (m) of a contact with `object`.
    pub fn place(&self, object: &Composite, contact: &Contact) -> Option<f64> {
        match contact.kind {
            ContactKind::Corner | ContactKind::Notch => {
                let piece = object.find(StretchKind::Piece(contact.piece))?;
                self.knots.iter().rfind(|knot| knot.stretch == piece).map(|knot| knot.arc_length)
            }
            _ => self.nearest_on(object, contact.piece, contact.x, contact.y).map(|(place, _)| place),
        }
    }

    /// The arc length (m) of the place nearest to a point.
    pub fn nearest(&self, object: &Composite, x: f64, y: f64) -> Option<f64> {
        let pieces = (0..object.pieces()).filter_map(|piece| self.nearest_on(object, piece, x, y));
        pieces.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(place, _)| place)
    }

    /// The arc length (m) of the place of a piece nearest to a point, and the distance.
    fn nearest_on(&self, object: &Composite, piece: usize, x: f64, y: f64) -> Option<(f64, f64)> {
        let stretch = object.find(StretchKind::Piece(piece))?;
        let first = self.knots.partition_point(|knot| knot.stretch < stretch);
        let knots = &self.knots[first..self.knots.partition_point(|knot| knot.stretch <= stretch)];
        let window = Range { from: knots.first()?.t, to: knots.last()?.t };
        let closest = object.own_closest_in(stretch, window, x, y);
        let before = knots.partition_point(|knot| knot.t <= closest.t).max(1) - 1;
        Some((knots[before].arc_length + length(object, stretch, knots[before].t, closest.t), closest.gap.abs()))
    }

    /// Points along it and beyond neither end, with their arc lengths (m): so close together that a chord turns by a degree or two.
    pub fn points(&self, object: &Composite) -> impl Iterator<Item = (f64, Frame)> {
        self.knots.iter().map(|knot| (knot.arc_length, object.own_frame(knot.stretch, knot.t)))
    }
}

/// Length of a stretch between two of its own parameters, m.
fn length(object: &Composite, stretch: usize, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * GAUSS.iter().map(|(at, weight)| weight * object.own_frame(stretch, middle + half * at).speed).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_contours::{CircularArc, Parabola};
    use std::f64::consts::{FRAC_PI_2, TAU};

    #[test]
    fn a_circle_has_its_circumference_and_its_places() {
        let circle =
            Composite::single(CircularArc::new([1.0, 2.0], 0.5, -FRAC_PI_2, TAU - FRAC_PI_2).unwrap()).unwrap();
        let outline = Outline::within(&circle, |stretch| Some(circle.own_range(stretch))).unwrap();
        assert!((outline.length() - TAU * 0.5).abs() < 1e-13 && outline.is_closed());
        let frame = outline.frame(&circle, 0.5 * FRAC_PI_2);
        assert!((frame.x - 1.5).abs() < 1e-12 && (frame.y - 2.0).abs() < 1e-12, "{frame:?}");
        let contact = Contact {
            object: 0,
            piece: 0,
            kind: ContactKind::Tangent,
            s: 0.0,
            x: frame.x,
            y: frame.y,
            alpha: frame.alpha,
            force: 1.0,
            friction: None,
        };
        assert!((outline.place(&circle, &contact).unwrap() - 0.5 * FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn a_parabola_has_its_length() {
        let parabola = Composite::single(Parabola::new([0.0, 0.0], 5.0).unwrap()).unwrap();
        let outline = Outline::within(&parabola, |_| Some(Range { from: 0.0, to: 0.3 })).unwrap();
        let slope = 3.0_f64;
        let expected = 0.1 * (0.5 * slope * slope.hypot(1.0) + 0.5 * slope.asinh());
        assert!((outline.length() - expected).abs() < 1e-13, "{}", outline.length() - expected);
    }
}
