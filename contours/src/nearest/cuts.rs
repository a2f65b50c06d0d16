//! Where a contour is parted into arcs that bend one way and turn by at most a right angle.

use std::f64::consts::FRAC_PI_2;

use super::search::CELLS;
use crate::{Frame, Range};

/// Angle (rad) that a whole range turns at the rate of a sample whose sign counts for nothing: a straight contour has
/// only rounding there.
const STRAIGHT: f64 = 1e-9;

/// How far an arc may turn beyond a right angle, relative: a quarter of a circle stays whole.
const ROUNDING: f64 = 1e-9;

/// Largest number of arcs between two inflections, for shapes whose angle may be wrong.
const MOST: f64 = 1e5;

/// Shortest arc next to an inflection, relative to the range: an inflection at an end may be rounded into the range, and
/// two that have just merged may be rounded apart.
const SHORTEST: f64 = 1e-9;

/// Steps of a bisection, which halves a cell to rounding.
const STEPS: usize = 60;

/// The cuts of a contour of which only the frame is known, see [`Contour::cuts`](crate::Contour::cuts).
pub(crate) fn from_samples(frame: impl Fn(f64) -> Frame, range: Range) -> Vec<f64> {
    if !range.is_finite() {
        return Vec::new();
    }
    let mut bends = Vec::new();
    // The last sample that bends, and which way.
    let mut last = None;
    for sample in 0..=CELLS {
        let t = range.at(sample as f64 / CELLS as f64);
        let turning = frame(t).turning;
        if turning.abs() * range.length() <= STRAIGHT {
            continue;
        }
        if let Some((before, convex)) = last
            && convex != (turning > 0.0)
        {
            bends.push(last_where(before, t, |t| (frame(t).turning > 0.0) == convex));
        }
        last = Some((t, turning > 0.0));
    }
    at_equal_turns(frame, range, &bends)
}

/// The cuts of a contour whose inflections inside `range` are `bends`, in order: those, and between two of them as many
/// as it needs, at equal angles.
pub(crate) fn at_equal_turns(frame: impl Fn(f64) -> Frame, range: Range, bends: &[f64]) -> Vec<f64> {
    let mut cuts = Vec::new();
    let mut from = range.from;
    let shortest = SHORTEST * range.length();
    for &to in bends.iter().chain([&range.to]) {
        if to < range.to && (to - from < shortest || range.to - to < shortest) {
            continue;
        }
        let (first, last) = (frame(from).alpha, frame(to).alpha);
        let count = arc_count(last - first);
        for arc in 1..count {
            let turned = (last - first).abs() * arc as f64 / count as f64;
            let cut = last_where(from, to, |t| (frame(t).alpha - first).abs() < turned);
            cuts.push(cut);
        }
        if to < range.to {
            cuts.push(to);
        }
        from = to;
    }
    cuts
}

/// The cuts of a shape travelled the other way, by `-t`, whose cuts these are.
pub(crate) fn reverse(mut cuts: Vec<f64>) -> Vec<f64> {
    cuts.reverse();
    cuts.iter_mut().for_each(|cut| *cut = -*cut);
    cuts
}

/// How many arcs of at most a right angle make up a turn (rad).
pub(crate) fn arc_count(turn: f64) -> usize {
    (turn.abs() / FRAC_PI_2 * (1.0 - ROUNDING)).ceil().clamp(1.0, MOST) as usize
}

/// The last parameter between `low` and `high` where `before` holds, of a condition that holds from `low` on and from
/// some parameter on no more.
pub(crate) fn last_where(low: f64, high: f64, before: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if before(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contour;

    /// One wave of y = sin x.
    #[derive(Debug)]
    struct Wave;

    impl Contour for Wave {
        fn frame(&self, t: f64) -> Frame {
            let (sin, cos) = t.sin_cos();
            let stretch = 1.0 + cos * cos;
            Frame { x: t, y: sin, alpha: cos.atan(), speed: stretch.sqrt(), turning: -sin / stretch }
        }
    }

    #[test]
    fn a_wave_is_cut_at_its_inflections() {
        let cuts = Wave.cuts(Range { from: -4.0, to: 5.0 });
        let expected = [-std::f64::consts::PI, 0.0, std::f64::consts::PI];
        assert_eq!(cuts.len(), 3);
        assert!(cuts.iter().zip(expected).all(|(cut, expected)| (cut - expected).abs() < 1e-14), "{cuts:?}");
        assert!(Wave.cuts(Range { from: 0.0, to: 3.0 }).is_empty());
        assert!(Wave.cuts(Range::ALL).is_empty());
    }

    /// A spiral that turns by t^2.
    #[derive(Debug)]
    struct Spiral;

    impl Contour for Spiral {
        fn frame(&self, t: f64) -> Frame {
            Frame { x: 0.0, y: 0.0, alpha: t * t, speed: 1.0, turning: 2.0 * t }
        }
    }

    #[test]
    fn a_spiral_is_cut_by_angle() {
        let cuts = Spiral.cuts(Range { from: 0.0, to: 3.0 });
        assert_eq!(cuts.len(), 5);
        for (k, cut) in cuts.iter().enumerate() {
            assert!((cut * cut - 1.5 * (k + 1) as f64).abs() < 1e-14);
        }
        // A straight contour with noise in its turning stays whole, a quarter turn too.
        assert_eq!(arc_count(FRAC_PI_2 * (1.0 + 1e-15)), 1);
        assert_eq!((arc_count(f64::NAN), arc_count(1e300)), (0, 100_000));
    }
}
