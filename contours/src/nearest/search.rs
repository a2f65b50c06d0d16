//! The defaults of the trait: closest point and bounds of a contour from samples of its frame.

use crate::point::dot;
use crate::{Bounds, Closest, Frame, Range, Vector};

/// Cells of a search in a finite range: of a full circle, each turns by less than 4 degrees.
pub(crate) const CELLS: usize = 96;

/// Fewest cells of a part of a finite range: one alone would not see a minimum between two maxima at its ends.
const FEWEST: usize = 2;

/// Cells of an infinite range: neighbouring samples differ by less than 7 % of their distance from the middle.
const CELLS_INFINITE: usize = 512;

/// Parts of a cell in which the distance may have several minima, and how often they are divided again: minima that are not told apart then differ by less than
/// a part in 1e14 of the cell.
const PARTS: usize = 8;
const SPLITS: usize = 4;
/// Least rate of the slope in a cell over the larger one at its ends at which a cell has one minimum.
const FLAT: f64 = 0.1;

/// Steps towards the extremum of the slope within a cell. An extremum that they miss is too flat to change the result.
const DIP_STEPS: usize = 12;

/// Largest number of steps; bisection alone reaches rounding in about 60.
const ZERO_STEPS: usize = 80;

/// A sample of the contour, seen from the point whose closest point is wanted.
#[derive(Clone, Copy)]
pub(crate) struct Probe {
    t: f64,
    distance: f64,
    /// (r - p) . dr/dt, or the same by the unit tangent: the distance falls with t where this is negative.
    slope: f64,
    /// d slope / dt.
    rate: f64,
}

impl Probe {
    /// The point and its first two derivatives at `t`, seen from `(x, y)`: without alpha, whose sine and cosine would take
    /// most of the time.
    pub fn new(t: f64, [place, velocity, acceleration]: [Vector; 3], x: f64, y: f64) -> Self {
        let way = [place[0] - x, place[1] - y];
        Self {
            t,
            distance: way[0].hypot(way[1]),
            slope: dot(way, velocity),
            rate: dot(velocity, velocity) + dot(way, acceleration),
        }
    }

    /// The same of a shape of which only the frame is known.
    fn of_frame(t: f64, frame: Frame, x: f64, y: f64) -> Self {
        let (ahead, outside) = frame.local(x, y);
        Self { t, distance: ahead.hypot(outside), slope: -ahead, rate: frame.speed + frame.turning * outside }
    }
}

/// The closest point on the part in `range` of a contour whose own range is `whole`, see
/// [`Contour::closest_in`](crate::Contour::closest_in).
pub(crate) fn closest(frame: impl Fn(f64) -> Frame, whole: Range, range: Range, x: f64, y: f64) -> Closest {
    closest_by(&frame, whole, range, x, y, |t| Probe::of_frame(t, frame(t), x, y))
}

/// The closest point of a shape that computes its probes in a cheaper way than from the frame.
pub(crate) fn closest_by(
    frame: impl Fn(f64) -> Frame,
    whole: Range,
    range: Range,
    x: f64,
    y: f64,
    probe: impl Fn(f64) -> Probe,
) -> Closest {
    let cells = cells(whole, range);
    let first = probe(range.at(0.0));
    // An end is a candidate where the distance grows away from it. The first sample stands in when there is no candidate
    // at all, which only numbers that are not finite and infinite ranges can bring about.
    let (mut best, mut interior) = (first, false);
    let mut left = first;
    for cell in 1..=cells {
        let right = probe(range.at(cell as f64 / cells as f64));
        if let Some(foot) = foot(&probe, left, right, SPLITS)
            && foot.distance < best.distance
        {
            (best, interior) = (foot, foot.t < range.to);
        }
        left = right;
    }
    if left.distance < best.distance {
        (best, interior) = (left, false);
    }
    Closest::new(best.t, frame(best.t), interior, x, y)
}

/// Cells of the part in `range` of a contour whose own range is `whole`: in proportion where both are finite.
fn cells(whole: Range, range: Range) -> usize {
    match (whole.is_finite(), range.is_finite()) {
        (_, false) => CELLS_INFINITE,
        (false, true) => CELLS,
        (true, true) => {
            let share = range.length() / whole.length();
            ((CELLS as f64 * share).ceil() as usize).clamp(FEWEST, CELLS)
        }
    }
}

/// The minimum of the distance in the cell from `left` to `right`, the nearest where it has several; none where it has none.
fn foot(probe: &impl Fn(f64) -> Probe, left: Probe, right: Probe, splits: usize) -> Option<Probe> {
    if splits == 0 || !may_have_several(left, right) {
        return falls_then_rises(probe, left, right).map(|(low, high)| refine(probe, low, high));
    }
    let cell = Range { from: left.t, to: right.t };
    let ends: [Probe; PARTS + 1] = std::array::from_fn(|k| match k {
        0 => left,
        PARTS => right,
        _ => probe(cell.at(k as f64 / PARTS as f64)),
    });
    let feet = ends.windows(2).filter_map(|pair| foot(probe, pair[0], pair[1], splits - 1));
    feet.min_by(|one, other| one.distance.total_cmp(&other.distance))
}

/// Whether the slope, as a cubic from its values and rates at the ends of a cell, rises at both but falls, or hardly rises, between them, near 0: then the
/// distance may have a maximum beside a minimum, as near a centre of curvature.
fn may_have_several(left: Probe, right: Probe) -> bool {
    let (length, steepest) = (right.t - left.t, left.rate.max(right.rate));
    if left.rate.min(right.rate) <= 0.0 || left.slope > steepest * length || right.slope < -steepest * length {
        return false;
    }
    let mean = (right.slope - left.slope) / length;
    // the rate is left.rate + linear s + square s^2 for s from 0 to 1
    let (square, linear) =
        (3.0 * (left.rate + right.rate - 2.0 * mean), 6.0 * mean - 4.0 * left.rate - 2.0 * right.rate);
    let is_inside = square > 0.0 && linear < 0.0 && -linear < 2.0 * square;
    is_inside && left.rate - linear * linear / (4.0 * square) < FLAT * steepest
}

/// Two probes in the cell from `left` to `right` between which the distance has a minimum, if it has one.
///
/// Where the slope has the same sign at both ends of the cell but tends towards 0 at both, as it does near a centre of
/// curvature, it may change sign twice between them: its extremum is looked at, too.
fn falls_then_rises(probe: impl Fn(f64) -> Probe, left: Probe, right: Probe) -> Option<(Probe, Probe)> {
    let falls = left.slope < 0.0;
    if falls != (right.slope < 0.0) {
        return falls.then_some((left, right));
    }
    let sign = if falls { -1.0 } else { 1.0 };
    let (rate_left, rate_right) = (sign * left.rate, sign * right.rate);
    if rate_left >= 0.0 || rate_right <= 0.0 {
        return None;
    }
    // The tangents of the slope at both ends meet below its extremum, unless it is bent both ways in the cell.
    let lowest = (sign * (left.slope * rate_right - right.slope * rate_left)
        + rate_left * rate_right * (right.t - left.t))
        / (rate_right - rate_left);
    if lowest > 0.0 || lowest.is_nan() {
        return None;
    }
    let (mut low, mut high) = (left, right);
    for _ in 0..DIP_STEPS {
        let share = low.rate / (low.rate - high.rate);
        let middle = probe(low.t + share.clamp(0.1, 0.9) * (high.t - low.t));
        if falls != (middle.slope < 0.0) {
            return Some(if falls { (left, middle) } else { (middle, right) });
        }
        if sign * middle.rate < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    None
}

/// The zero of the slope between `low` (slope negative) and `high` (slope not negative), to rounding.
fn refine(probe: impl Fn(f64) -> Probe, low: Probe, high: Probe) -> Probe {
    let resolution = f64::EPSILON * low.t.abs().max(high.t.abs());
    // A slope of zero at the end of a cell may be a maximum's, behind the minimum.
    let mut here = if -low.slope < high.slope || high.slope == 0.0 { low } else { high };
    zero(Range { from: low.t, to: high.t }, here.t, resolution, |t| {
        if t != here.t {
            here = probe(t);
        }
        [here.slope, here.rate]
    });
    here
}

/// The zero, to `resolution`, of a function that is negative where the range begins and not where it ends. `function`
/// gives value and derivative; it is called with `start`, a place in the range, and at last with the zero.
pub(crate) fn zero(range: Range, start: f64, resolution: f64, mut function: impl FnMut(f64) -> [f64; 2]) -> f64 {
    let Range { from: mut low, to: mut high } = range;
    let mut t = start;
    let mut step_before = range.length();
    let [mut value, mut rate] = function(t);
    for _ in 0..ZERO_STEPS {
        if value < 0.0 {
            low = t;
        } else {
            high = t;
        }
        if value == 0.0 || high - low <= resolution {
            break;
        }
        let mut step = -value / rate;
        let mut next = t + step;
        // Newton only while it stays inside and converges faster than halving would.
        if !(next > low && next < high && step.abs() <= 0.5 * step_before.abs()) {
            next = 0.5 * (low + high);
            step = next - t;
        }
        if next == t {
            break;
        }
        t = next;
        [value, rate] = function(t);
        if step.abs() <= resolution {
            break;
        }
        step_before = step;
    }
    t
}

/// The bounds, see [`Contour::bounds_in`](crate::Contour::bounds_in).
pub(crate) fn bounds(frame: impl Fn(f64) -> Frame, range: Range) -> Bounds {
    if !range.is_finite() {
        return Bounds::ALL;
    }
    let step = range.length() / CELLS as f64;
    let mut left = frame(range.from);
    let mut bounds = Bounds::EMPTY;
    for cell in 1..=CELLS {
        let right = frame(range.at(cell as f64 / CELLS as f64));
        let (sin, cos) = left.alpha.sin_cos();
        let (sin_right, cos_right) = right.alpha.sin_cos();
        let change = (right.speed * cos_right - left.speed * cos).hypot(right.speed * sin_right - left.speed * sin);
        // An even change of dr/dt takes the curve |change| step / 8 off its chord, a sudden one (a kink) step / 4.
        let cell_box = Bounds::EMPTY.with(left.x, left.y).with(right.x, right.y).grown(0.5 * change * step);
        bounds = bounds.union(cell_box);
        left = right;
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Contour, DualNum, Graph};

    #[test]
    fn a_maximum_at_the_end_of_a_cell_does_not_hide_the_minimum() {
        // From just beyond the centre of curvature the vertex is a maximum, between two minima at x^2 = e.
        let parabola = Graph::new(Range { from: -1.0, to: 0.0 }, |x| x * x).unwrap();
        for e in [1e-6, 1e-5, 1e-4] {
            let closest = parabola.closest(0.0, 0.5 + e);
            assert!((closest.gap.abs() - (0.25 + e).sqrt()).abs() < 1e-15, "{e}: {closest:?}");
            assert!((closest.t.abs() - e.sqrt()).abs() < 1e-9, "{e}: {closest:?}");
        }
    }

    #[test]
    fn the_nearer_of_two_minima_in_a_cell_is_found() {
        // just beyond the centre of curvature of the crest and beside its axis: a maximum between two minima in one cell of 96
        let (a, b): (f64, f64) = (1.3910512260179702, 2.2320789384322715);
        let crest = Graph::new(Range { from: -0.5, to: 3.5 }, move |x| (x * b).sin() * a).unwrap();
        let axis = std::f64::consts::FRAC_PI_2 / b;
        for aside in [-1e-6, -1e-9, 1e-9, 1e-6] {
            for beyond in [1e-8, 1e-6, 1e-4, 2e-3] {
                let closest = crest.closest(axis + aside, a - 1.0 / (a * b * b) - beyond);
                assert!(closest.t != axis && (closest.t > axis) == (aside > 0.0), "{aside} {beyond}: {closest:?}");
            }
        }
    }

    #[test]
    fn parts_get_their_share_of_the_cells() {
        let whole = Range { from: -1.0, to: 3.0 };
        assert_eq!(cells(whole, whole), 96);
        assert_eq!(cells(whole, Range { from: 0.0, to: 1.0 }), 24);
        assert_eq!(cells(whole, Range { from: 0.0, to: 1e-9 }), 2);
        assert_eq!(cells(whole, Range { from: 0.0, to: 0.0 }), 2);
        assert_eq!(cells(whole, Range { from: -9.0, to: 9.0 }), 96);
        assert_eq!(cells(Range::ALL, whole), 96);
        assert_eq!(cells(Range::ALL, Range::ALL), 512);
    }
}
