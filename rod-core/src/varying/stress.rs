//! The bending stress at the surface of a round rod whose diameter varies.

use crate::model::RodModel;
use crate::propagator::Cut;
use crate::segment::Segment;
use core::f64::consts::PI;

/// Part of the largest stress by which the one that is found may be too small. Smaller: more bisections around a maximum between the ends of
/// a segment, one for each factor of 4.
const ACCURACY: f64 = 1e-10;
/// Most intervals of a piece of a segment that are looked at. A maximum takes about 40.
const MOST_INTERVALS: usize = 4096;

/// The diameters (m) of a round rod along it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Diameters {
    /// It falls linearly: `clamp` (1 - `taper` s).
    Cone { clamp: f64, taper: f64 },
    /// One for each section; `joints` are the arc lengths between them.
    Sections { joints: Vec<f64>, diameters: Vec<f64> },
}

/// The stress of a unit of moment: 32 / (pi d^3) at the arc length `s`, and how fast that varies.
struct Modulus {
    /// Diameter at s = 0 and its relative decrease along the rod.
    clamp: f64,
    taper: f64,
}

impl Modulus {
    fn inverse(&self, s: f64) -> f64 {
        32.0 / (PI * (self.clamp * (1.0 - self.taper * s)).powi(3))
    }

    /// Logarithmic derivative of the diameter, less its sign.
    fn narrowing(&self, s: f64) -> f64 {
        self.taper / (1.0 - self.taper * s)
    }
}

/// A place of a segment.
#[derive(Clone, Copy)]
struct Place {
    s: f64,
    cut: Cut,
    /// Stress of a unit of moment times the moment, and its derivative by s.
    stress: f64,
    rate: f64,
}

impl Diameters {
    /// The diameter at an arc length (L); at a joint that on the side of the tip.
    pub fn at(&self, s: f64) -> f64 {
        let Modulus { clamp, taper } = self.modulus(self.piece(s));
        clamp * (1.0 - taper * s)
    }

    fn piece(&self, s: f64) -> usize {
        match self {
            Self::Cone { .. } => 0,
            Self::Sections { joints, .. } => joints.partition_point(|&joint| joint <= s),
        }
    }

    fn modulus(&self, piece: usize) -> Modulus {
        match self {
            Self::Cone { clamp, taper } => Modulus { clamp: *clamp, taper: *taper },
            Self::Sections { diameters, .. } => Modulus { clamp: diameters[piece], taper: 0.0 },
        }
    }

    fn joints(&self) -> &[f64] {
        match self {
            Self::Cone { .. } => &[],
            Self::Sections { joints, .. } => joints,
        }
    }

    /// The largest |moment| 32 / (pi d^3) along a segment of a rod of this model that ends at arc length `to`, moments in E I / L.
    pub fn largest_stress<M: RodModel + ?Sized>(&self, model: &M, segment: &Segment<Cut>, to: f64) -> f64 {
        let Segment { s: from, start, a, b } = *segment;
        let ends = self.joints().iter().copied().filter(|joint| *joint > from && *joint < to).chain([to]);
        let (mut largest, mut left) = (0.0_f64, (from, start));
        for end in ends {
            let modulus = self.modulus(self.piece(left.0));
            if a == 0.0 && b == 0.0 {
                // the moment is the same everywhere
                let most = modulus.inverse(left.0).max(modulus.inverse(end));
                largest = largest.max(start.moment.abs() * most);
                left.0 = end;
                continue;
            }
            let right = (end, model.carry(left.0, &left.1, a, b, end - left.0));
            largest = largest_in_piece(model, &modulus, [a, b], [left, right], largest);
            left = right;
        }
        largest
    }
}

/// The largest stress between two places without a joint between them, or `least` if that is larger; NaN where a moment is NaN.
///
/// Branch and bound: with g = w m, w = 32 / (pi d^3), the force P and the curvature kappa, |m'| <= P and |m''| <= P |kappa| bound |g''| on an
/// interval. By this bound g leaves the values at its ends by h^2 |g''| / 8 at most, and not at all where it is monotone. An interval
/// that may hold more than the largest value so far is halved.
fn largest_in_piece<M: RodModel + ?Sized>(
    model: &M,
    modulus: &Modulus,
    [a, b]: [f64; 2],
    ends: [(f64, Cut); 2],
    least: f64,
) -> f64 {
    let force = a.hypot(b);
    let place = |(s, cut): (f64, Cut)| {
        let (w, (sin, cos)) = (modulus.inverse(s), cut.phi.sin_cos());
        let rate = 3.0 * modulus.narrowing(s) * cut.moment + a * cos + b * sin;
        Place { s, cut, stress: w * cut.moment, rate: w * rate }
    };
    let [first, last] = ends.map(place);
    // what is NaN stays so
    let larger =
        |most: f64, place: &Place| if most.is_nan() || place.stress.abs() <= most { most } else { place.stress.abs() };
    let mut largest = larger(larger(least, &first), &last);
    let mut open = vec![(first, last)];
    for _ in 0..MOST_INTERVALS {
        let Some((left, right)) = open.pop() else { break };
        let h = right.s - left.s;
        let (low, high) = model.curvature_bounds((left.s, left.cut.moment), (right.s, right.cut.moment), force);
        let most_moment = left.cut.moment.abs().max(right.cut.moment.abs()) + 0.5 * force * h;
        let narrowing = modulus.narrowing(left.s).abs().max(modulus.narrowing(right.s).abs());
        let w = modulus.inverse(left.s).max(modulus.inverse(right.s));
        let of_taper = 12.0 * narrowing * narrowing * most_moment + 6.0 * narrowing * force;
        let bend = w * (of_taper + force * low.abs().max(high.abs()));
        let at_ends = left.stress.abs().max(right.stress.abs());
        let is_monotone = left.rate.abs() > bend * h;
        // not where something is NaN
        let may_exceed = at_ends + 0.125 * bend * h * h > largest * (1.0 + ACCURACY);
        if is_monotone || !may_exceed {
            continue;
        }
        let half = 0.5 * h;
        if left.s + half <= left.s || left.s + half >= right.s {
            continue;
        }
        let middle = place((left.s + half, model.carry(left.s, &left.cut, a, b, half)));
        largest = larger(largest, &middle);
        // the half that ends in the larger value first: it is what the other one has to exceed
        let halves = [(left, middle), (middle, right)];
        if left.stress.abs() > right.stress.abs() {
            open.extend(halves.into_iter().rev());
        } else {
            open.extend(halves);
        }
    }
    largest
}
