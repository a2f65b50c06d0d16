//! A cheap test of a shape from another crate before it becomes a piece: `contract::check` at few places.
//!
//! A wrong shape gives wrong contacts without an error, so plain mistakes are refused. Tolerances are wide: a shape that is right
//! to four digits passes.

use crate::error::Broken;
use crate::{Contour, Frame, Range, Vector};

/// Places, as fractions of the range. The ends are left out, so that differences stay within the range.
const FRACTIONS: [f64; 5] = [0.03, 0.26, 0.5, 0.74, 0.97];

/// Part of an infinite range that is tested, in units of the parameter.
const WINDOW: f64 = 10.0;

/// Steps of the differences, relative to the range: noise spoils a short one, a sharp bend a long one. Both must be wrong.
const STEPS: [f64; 2] = [1e-6, 1e-3];

/// Accepted error of a rate, relative.
const RATE: f64 = 1e-3;

/// Factor of the allowance for a rate that varies unevenly within a difference; the error is a third of this where its
/// second derivative is constant.
const VARIES: f64 = 8.0;

/// Share of the even variation itself that is added: differences do not see it, but for features between the three places.
const EVEN: f64 = 0.01;

/// Rounding of a coordinate or an angle, relative.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Accepted error of an angle, rad, and of a length, relative to the coordinates.
const CLOSE: f64 = 2e-9;

/// Turn between two neighbouring places, rad, above which a jump of alpha is looked for; a jump is that of whole turns.
const TURN: f64 = 2.0;

/// Halvings in search of a jump.
const HALVINGS: usize = 48;

/// Half the part around a place of which the closest point is asked, relative to the range.
const PART: f64 = 0.02;

/// A line of the contract that the shape breaks; `None` if it seems right.
pub(crate) fn broken_line(shape: &dyn Contour) -> Option<Broken> {
    let range = shape.range();
    let window = range.window(WINDOW);
    let mut scale = 0.0_f64;
    let ends = [window.from, window.to];
    for t in ends.into_iter().chain(FRACTIONS.map(|fraction| window.at(fraction))) {
        let frame = shape.frame(t);
        if let Some(broken) = finite(frame, t) {
            return Some(broken);
        }
        scale = scale.max(frame.x.abs()).max(frame.y.abs());
    }
    let probe = Probe { shape, range, window, scale };
    let places = FRACTIONS.map(|fraction| window.at(fraction));
    let found = places.into_iter().find_map(|t| probe.rates(t).or_else(|| probe.side(t)));
    let jumps = || places.windows(2).find_map(|pair| probe.jump(pair[0], pair[1]));
    found.or_else(jumps).or_else(|| probe.contained(&places))
}

fn finite(frame: Frame, t: f64) -> Option<Broken> {
    let Frame { x, y, alpha, speed, turning } = frame;
    if ![x, y, alpha, speed, turning].iter().all(|number| number.is_finite()) {
        return Some(Broken::new(1, t, format!("it is {frame:?}")));
    }
    let moves = speed >= 0.0 && speed + turning.abs() > 0.0;
    (!moves).then(|| Broken::new(4, t, format!("speed is {speed} and turning is {turning}")))
}

struct Probe<'a> {
    shape: &'a dyn Contour,
    range: Range,
    window: Range,
    /// The largest coordinate seen.
    scale: f64,
}

impl Probe<'_> {
    /// Lines 2 and 3 at `t`, if both steps break them.
    fn rates(&self, t: f64) -> Option<Broken> {
        let [short, long] = STEPS.map(|step| self.difference(t, step * self.window.length()));
        // The same line for both: what only one of them finds is noise or a bend.
        short.and_then(|short| long.filter(|long| long.line == short.line))
    }

    fn difference(&self, t: f64, step: f64) -> Option<Broken> {
        let (from, to) = (t - step, t + step);
        let [before, here, after] = [from, t, to].map(|t| self.shape.frame(t));
        let width = to - from;
        let [v0, v1, v2] = [before, here, after].map(velocity);
        let error = (after.x - before.x - width * v1[0]).hypot(after.y - before.y - width * v1[1]);
        let varies = unevenness([v0[0], v1[0], v2[0]]).hypot(unevenness([v0[1], v1[1], v2[1]]));
        if error > width * (VARIES * varies + RATE * here.speed) + ROUNDING * self.scale {
            let speed = (after.x - before.x).hypot(after.y - before.y) / width;
            let direction = (after.y - before.y).atan2(after.x - before.x);
            let Frame { alpha, speed: said, .. } = here;
            let found = format!(
                "the point moves at speed {speed:.6} in direction {direction:.6}, but speed is {said:.6} and alpha is {alpha:.6}"
            );
            return Some(Broken::new(2, t, found));
        }
        let error = (after.alpha - before.alpha - width * here.turning).abs();
        let varies = unevenness([before.turning, here.turning, after.turning]);
        let accepted = width * (VARIES * varies + RATE * here.turning.abs()) + ROUNDING * here.alpha.abs() + CLOSE;
        (error > accepted).then(|| {
            let turning = (after.alpha - before.alpha) / width;
            Broken::new(3, t, format!("alpha changes at the rate {turning:.6}, but turning is {:.6}", here.turning))
        })
    }

    /// Lines 5 and 7 at `t`: both sides, of the part around it, and of the whole range in the middle.
    fn side(&self, t: f64) -> Option<Broken> {
        let frame = self.shape.frame(t);
        let around = PART * self.window.length();
        let part = self.range.within(Range { from: t - around, to: t + around });
        let step = (1e-3 * frame.speed * self.window.length()).min(0.1 / frame.curvature().abs());
        // Not where there is no normal, nor where the step would drown in rounding.
        if frame.speed == 0.0 || step < CLOSE * self.scale {
            return None;
        }
        let whole = (t == self.window.at(FRACTIONS[2])).then_some(self.range);
        let (nx, ny) = frame.normal();
        for (range, outwards) in whole.into_iter().chain([part]).flat_map(|range| [(range, 1.0), (range, -1.0)]) {
            let (x, y) = (frame.x - outwards * step * nx, frame.y - outwards * step * ny);
            let closest = self.shape.closest_in(range, x, y);
            if !range.contains(closest.t) {
                let found = format!("the closest point in {range:?} is reported at t = {}", closest.t);
                return Some(Broken::new(5, t, found));
            }
            // Nearer to another place it may be on either side of that.
            let right = closest.gap * outwards > 0.0 || closest.gap.abs() < step * (1.0 - 1e-3);
            if !right {
                let side = if outwards > 0.0 { "right" } else { "left" };
                let found = format!("the gap {step:e} to the {side} of the contour is {:e}", closest.gap);
                return Some(Broken::new(7, t, found));
            }
        }
        None
    }

    /// Line 3: a jump of alpha between two places that differ by much.
    fn jump(&self, from: f64, to: f64) -> Option<Broken> {
        let alpha = |t: f64| self.shape.frame(t).alpha;
        let (mut low, mut high) = ([from, alpha(from)], [to, alpha(to)]);
        for _ in 0..HALVINGS {
            if (high[1] - low[1]).abs() <= TURN {
                return None;
            }
            let t = 0.5 * (low[0] + high[0]);
            let middle = [t, alpha(t)];
            if (middle[1] - low[1]).abs() > (high[1] - middle[1]).abs() {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(Broken::new(3, low[0], format!("alpha jumps from {:.6} to {:.6}", low[1], high[1])))
    }

    /// Lines 9 and 11 at the places.
    fn contained(&self, places: &[f64]) -> Option<Broken> {
        let bounds = self.shape.bounds_in(self.range).grown(CLOSE * self.scale);
        let (least, largest) = self.shape.curvature_in(self.range);
        places.iter().find_map(|&t| {
            let frame = self.shape.frame(t);
            if !bounds.contains(frame.x, frame.y) {
                return Some(Broken::new(9, t, format!("({}, {}) lies outside {bounds:?}", frame.x, frame.y)));
            }
            let curvature = frame.curvature();
            let accepted = RATE * (curvature.abs() + 1.0 / (frame.speed * self.window.length()));
            let outside = curvature < least - accepted || curvature > largest + accepted;
            (outside && frame.speed > 0.0)
                .then(|| Broken::new(11, t, format!("the curvature is {curvature}, not from {least} to {largest}")))
        })
    }
}

fn velocity(frame: Frame) -> Vector {
    let (sin, cos) = frame.alpha.sin_cos();
    [frame.speed * cos, frame.speed * sin]
}

/// By how much the second of three values may miss their mean.
fn unevenness([before, here, after]: [f64; 3]) -> f64 {
    (before - 2.0 * here + after).abs() + EVEN * ((before - here).abs() + (after - here).abs())
}
