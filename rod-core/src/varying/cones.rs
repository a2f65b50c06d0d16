//! A wire that is measured in several places: cones, one after the other.

use crate::error::RodError;
use crate::model::Profile;

use super::MOST_TAPERED;

/// Relative rounding of the arc lengths of both ends.
const ROUNDING: f64 = 1e-9;
/// Most faults that are told.
const MOST_FAULTS: usize = 5;
/// Largest number of points: each is an end of an element, so that more of them take longer.
const MOST_POINTS: usize = 1000;

/// Cones from the clamp to the tip, each with the diameter that the one before it ends with. Dimensionless: arc lengths in L, diameters in that at
/// the clamp.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cones {
    /// Where one ends and the next begins: kinks of the diameter.
    pub joints: Vec<f64>,
    parts: Vec<Frustum>,
}

/// A cone without its point. The diameter at `s` is `diameter` (1 - `taper` (s - `from`)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frustum {
    pub from: f64,
    pub diameter: f64,
    pub taper: f64,
}

impl Frustum {
    #[inline(always)]
    pub fn at(&self, s: f64) -> f64 {
        self.diameter * (1.0 - self.taper * (s - self.from))
    }
}

impl Cones {
    /// Of points (m, m) that have been [checked](check), on a rod of `length`.
    pub fn new(length: f64, points: &[[f64; 2]]) -> Self {
        let last = points.len() - 1;
        // the ends are those of the rod, to the last bit
        let place = |k: usize| {
            if k == 0 {
                0.0
            } else if k == last {
                1.0
            } else {
                points[k][0] / length
            }
        };
        let part = |k: usize| {
            let (thick, thin) = (points[k][1], points[k + 1][1]);
            let taper = (thick - thin) / thick / (place(k + 1) - place(k));
            Frustum { from: place(k), diameter: thick / points[0][1], taper }
        };
        Self { joints: (1..last).map(place).collect(), parts: (0..last).map(part).collect() }
    }

    /// The cone of a place; at a joint that on the side of the tip.
    #[inline(always)]
    pub fn part(&self, s: f64) -> &Frustum {
        &self.parts[self.joints.partition_point(|&joint| joint <= s)]
    }
}

impl Profile for Cones {
    #[inline(always)]
    fn stiffness(&self, s: f64) -> f64 {
        let diameter = self.part(s).at(s);
        let square = diameter * diameter;
        square * square
    }
    #[inline(always)]
    fn is_monotonic(&self) -> bool {
        true
    }
}

/// The steepest change between two points.
pub(super) fn step(points: &[[f64; 2]]) -> RodError {
    let steepness = |k: usize| {
        let [[s, diameter], [next, other]] = [points[k], points[k + 1]];
        (other / diameter).ln().abs() / (next - s)
    };
    let steeper = |best: usize, k: usize| if steepness(k) > steepness(best) { k } else { best };
    let k = (0..points.len() - 1).fold(0, steeper);
    RodError::Step { number: k + 1, from: points[k][1], to: points[k + 1][1] }
}

/// Whether points of arc length and diameter (m, m) are those of a rod of `length` (m).
///
/// # Errors
/// [`RodError::Diameters`] with all that is wrong.
pub(super) fn check(length: f64, points: &[[f64; 2]]) -> Result<(), RodError> {
    let mut faults = Vec::new();
    if points.len() > MOST_POINTS {
        let expected = format!(
            "diameter has {} points, expected at most {MOST_POINTS}: a part of them says as much",
            points.len()
        );
        return Err(RodError::Diameters { faults: vec![expected] });
    }
    if points.len() < 2 {
        faults.push(format!("diameter has {} points, expected two or more, from the clamp to the tip", points.len()));
    }
    let slack = ROUNDING * length;
    let is_diameter = |diameter: f64| diameter.is_finite() && diameter > 0.0;
    let base = points.first().map_or(f64::NAN, |point| point[1]);
    for (k, &[s, diameter]) in points.iter().enumerate() {
        let number = k + 1;
        let mut expected_place = |expected: String| {
            faults.push(format!("point {number} of diameter has the arc length {s:?} m, expected {expected}"));
        };
        if k == 0 && (s.is_nan() || s.abs() > slack) {
            expected_place("0, the base of the rod".into());
        } else if k > 0 && (s.is_nan() || s <= points[k - 1][0]) {
            expected_place("more than that of the point before".into());
        } else if number == points.len() && number > 1 && (s - length).abs() > slack {
            expected_place(format!("{length:?} m, the length of the rod"));
        }
        let mut expected_size = |expected: String| {
            faults.push(format!("diameter of point {number} is {diameter:?} m, expected {expected}"));
        };
        if !is_diameter(diameter) {
            expected_size("a positive, finite number".into());
        } else if diameter > length {
            expected_size(format!("at most the length, {length:?} m"));
        } else if is_diameter(base) && !(1.0 / MOST_TAPERED..=MOST_TAPERED).contains(&(diameter / base)) {
            expected_size(format!("between 0.01 and 100 times that at the clamp, {base:?} m"));
        }
    }
    if faults.is_empty() {
        return Ok(());
    }
    let more = faults.len().saturating_sub(MOST_FAULTS);
    faults.truncate(MOST_FAULTS);
    if more > 0 {
        faults.push(format!("and {more} more"));
    }
    Err(RodError::Diameters { faults })
}
