//! How far objects reach in a direction, and which part of those that go on for ever is within reach.

use crate::Outline;
use rod_contours::{Composite, Frame, Range, StretchKind};

/// Cells in which a stretch that goes on for ever is looked at, spread by [`Range::at`]. Fewer: coarse shapes are missed.
const CELLS: usize = 512;

/// Bisections to rounding.
const HALVINGS: usize = 60;

/// A half-plane: the places nearer than `limit` (m) in a direction (rad).
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfPlane {
    pub angle: f64,
    pub limit: f64,
}

impl HalfPlane {
    fn contains(&self, frame: Frame) -> bool {
        along(self.angle, frame) <= self.limit
    }
}

/// How far a place is in a direction, m.
pub(crate) fn along(angle: f64, frame: Frame) -> f64 {
    frame.x * angle.cos() + frame.y * angle.sin()
}

/// How far the object's nearest place is in a direction (rad), m; none where it goes on for ever against it.
pub(crate) fn nearest(object: &Composite, angle: f64) -> Option<f64> {
    let mut nearest = f64::INFINITY;
    for (stretch, cells) in pieces(object) {
        let far = |t: f64| along(angle, object.own_frame(stretch, t));
        let falls = |t: f64| (object.own_frame(stretch, t).alpha - angle).cos() < 0.0;
        let range = object.own_range(stretch);
        let ends = [cells.first().map(|cell| cell.from), cells.last().map(|cell| cell.to)];
        let outermost = |end: f64, is_finite: bool| if is_finite { f64::INFINITY } else { far(end) };
        let mut inner = f64::INFINITY;
        for cell in &cells {
            let (mut low, mut high) = (cell.from, cell.to);
            if falls(low) && !falls(high) {
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if falls(middle) { low = middle } else { high = middle }
                }
            }
            let is_inner = |t: &f64| range.is_finite() || !ends.contains(&Some(*t));
            inner =
                [low, high, cell.from, cell.to].iter().filter(|t| is_inner(t)).map(|t| far(*t)).fold(inner, f64::min);
        }
        let [from, to] = ends;
        let outer = outermost(from?, range.from.is_finite()).min(outermost(to?, range.to.is_finite()));
        if outer < inner {
            return None;
        }
        let finite_ends = [(from?, range.from.is_finite()), (to?, range.to.is_finite())];
        let finite = finite_ends.iter().filter(|end| end.1).map(|end| far(end.0)).fold(inner, f64::min);
        nearest = nearest.min(finite);
    }
    nearest.is_finite().then_some(nearest)
}

/// The outline of an object as far as it is in one of the half-planes, where it goes on for ever; none where it does so within them.
pub(crate) fn outline(object: &Composite, reached: &[HalfPlane]) -> Option<Outline> {
    let is_reached = |stretch: usize, t: f64| {
        let frame = object.own_frame(stretch, t);
        reached.iter().any(|half| half.contains(frame))
    };
    let window = |stretch: usize| {
        let range = object.own_range(stretch);
        if range.is_finite() {
            return Some(range);
        }
        let at: Vec<f64> = (0..=CELLS).map(|k| range.at(k as f64 / CELLS as f64)).collect();
        let border = |inside: f64, outside: f64| {
            let (mut inside, mut outside) = (inside, outside);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                if is_reached(stretch, middle) { inside = middle } else { outside = middle }
            }
            inside
        };
        let first = at.iter().position(|t| is_reached(stretch, *t)).unwrap_or(CELLS / 2);
        let last = at.iter().rposition(|t| is_reached(stretch, *t)).unwrap_or(CELLS / 2);
        let from = match (range.from.is_finite(), first) {
            (true, _) => range.from,
            (false, 0) => return None,
            (false, first) => border(at[first], at[first - 1]),
        };
        let to = match (range.to.is_finite(), last) {
            (true, _) => range.to,
            (false, CELLS) => return None,
            (false, last) => border(at[last], at[last + 1]),
        };
        Some(Range { from, to })
    };
    Outline::within(object, window)
}

/// The stretches that are pieces, each in cells that hardly turn.
fn pieces(object: &Composite) -> Vec<(usize, Vec<Range>)> {
    let mut pieces: Vec<(usize, Vec<Range>)> = Vec::new();
    for part in object.parts().filter(|part| matches!(object.kind(part.stretch), StretchKind::Piece(_))) {
        let parts = if part.range.is_finite() { 1 } else { CELLS };
        let at = |k: usize| part.range.at(k as f64 / parts as f64);
        let cells = (0..parts).map(|k| Range { from: at(k), to: at(k + 1) });
        match pieces.last_mut() {
            Some((stretch, all)) if *stretch == part.stretch => all.extend(cells),
            _ => pieces.push((part.stretch, cells.collect())),
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_contours::{CircularArc, Parabola};
    use std::f64::consts::{FRAC_PI_2, TAU};

    #[test]
    fn a_circle_is_as_far_as_its_centre_less_its_radius() {
        let circle = Composite::single(CircularArc::new([0.3, 0.2], 0.1, 0.3, 0.3 + TAU).unwrap()).unwrap();
        for angle in [0.0_f64, 0.7, 2.0, 4.0] {
            let expected = 0.3 * angle.cos() + 0.2 * angle.sin() - 0.1;
            assert!((nearest(&circle, angle).unwrap() - expected).abs() < 1e-15, "{angle}");
        }
    }

    #[test]
    fn a_parabola_is_near_from_below_and_endless_from_above() {
        let parabola = Composite::single(Parabola::new([0.2, 0.1], 5.0).unwrap()).unwrap();
        assert!((nearest(&parabola, FRAC_PI_2).unwrap() - 0.1).abs() < 1e-15);
        // where its slope is -0.5: y - 0.1 = 5 (x - 0.2)^2
        let (tilted, x) = (0.5_f64.atan2(1.0), -0.5_f64.recip() / 10.0);
        let expected = (0.2 + x) * tilted.cos() + (0.1 + 5.0 * x * x) * tilted.sin();
        assert!((nearest(&parabola, tilted).unwrap() - expected).abs() < 1e-14);
        assert_eq!(nearest(&parabola, -FRAC_PI_2), None);
        let half = HalfPlane { angle: FRAC_PI_2, limit: 0.6 };
        let found = outline(&parabola, &[half]).unwrap();
        let ends = [0.0, found.length()].map(|place| found.frame(&parabola, place).x);
        assert!((ends[0] - 0.2 + 0.1_f64.sqrt()).abs() < 1e-12 && (ends[1] - 0.2 - 0.1_f64.sqrt()).abs() < 1e-12);
        let floor = Composite::single(Parabola::new([0.0, 0.0], 0.0).unwrap()).unwrap();
        assert!(outline(&floor, &[half]).is_none());
    }
}
