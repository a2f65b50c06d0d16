//! What friction does at a contact: the rod slips along a curve, or sticks to it.

/// Points and weights of the Gauss-Lobatto rule with 8 points on 0 to 1 (Abramowitz and Stegun, table 25.6), symmetric about 1/2.
const RULE: [(f64, f64); 4] = [
    (0.0, 0.017_857_142_857_142_856),
    (0.064_129_925_745_196_69, 0.105_352_113_571_753_02),
    (0.204_149_909_283_428_85, 0.170_561_346_241_752_18),
    (0.395_350_391_048_760_6, 0.206_229_397_329_351_94),
];
/// Change of an arc length by halving the interval, relative to it, at which it is taken: rounding.
const CONVERGED: f64 = 4.0 * f64::EPSILON;
/// Most halvings: beyond them the curve is not smooth.
const HALVINGS: u32 = 20;

/// Coulomb friction at a support, in one of its modes. The tangential force on the rod, f_t, is positive in the sense of the curve.
///
/// The contact has gone a along the curve and s along the rod, which runs in the sense o = 1 of the curve or against it, o = -1. The material
/// point of the rod at the contact moves along the curve with the rate of the **slip coordinate** g = a - o s: g is constant
/// exactly where the rod sticks, with its tip, or rolls, with its side.
///
/// ```
/// use rod_core::{Grip, Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, solve};
/// // the tip of an upright rod on a wall x = 0.5 that is travelled upwards; the rod was pushed on along its axis
/// struct Wall(Grip);
/// impl Supports for Wall {
///     fn count(&self) -> usize { 1 }
///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
///     fn support(&self, _: usize, t: f64) -> Support {
///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
///     }
///     fn grip(&self, _: usize) -> Grip { self.0 }
/// }
/// let clamp = Pose { x: 0.45, y: 0.0, phi: std::f64::consts::FRAC_PI_2 };
/// // it slips upwards: the wall holds it back
/// let slips = MultiPoint { rod: Uniform, clamp, supports: &Wall(Grip::Slips { ratio: -0.2 }) };
/// let mut u = [1.0, 0.1, 1.5];
/// assert!(solve(&slips, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new()).status.is_solved());
/// let reactions = slips.elastica(&u, rod_core::Units::ONE).reactions();
/// assert!((reactions.f0y - 0.2 * u[1]).abs() < 1e-14 && (reactions.f0x + u[1]).abs() < 1e-14);
/// // it sticks where it is: the tangential force is one more unknown
/// let sticks = MultiPoint { rod: Uniform, clamp, supports: &Wall(Grip::Sticks { t: u[0], s: 1.0 }) };
/// let mut stuck = [u[0], u[1], u[2], 0.0];
/// assert!(solve(&sticks, &mut stuck, &NewtonOptions::default(), &mut NewtonWorkspace::new()).status.is_solved());
/// // along its axis the nearly straight rod is 3e5 times as stiff as E I / L^3, and so is rounding
/// assert!((stuck[3] + 0.2 * u[1]).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// The rod slips, or there is no friction: f_t = `ratio` f, minus the coefficient of friction where the rod slips in the sense of the
    /// curve, plus it where it slips the other way.
    Slips {
        /// f_t / f.
        ratio: f64,
    },
    /// The rod sticks with its tip, or rolls with its side, from an instant on when the contact was here.
    Sticks {
        /// Parameter of the curve.
        t: f64,
        /// Arc length of the rod.
        s: f64,
    },
}

impl Grip {
    /// No friction.
    pub const SMOOTH: Self = Self::Slips { ratio: 0.0 };

    /// Whether the rod sticks or rolls.
    #[inline(always)]
    pub fn sticks(&self) -> bool {
        matches!(self, Self::Sticks { .. })
    }
}

/// The arc length of a curve between two of its parameters, negative backwards, by its speed |dr/dt| (Gauss-Lobatto with 8 points,
/// halved until it agrees to rounding). Exact to 1e-13 relative, also where the curvature jumps or has a kink, as at the points of a spline.
///
/// ```
/// // a quarter of a circle of radius 2, and a parabola y = 5 x^2 from 0 to 0.1
/// assert_eq!(rod_core::arc_length(|_| 2.0, 0.0, 0.5), 1.0);
/// let length = rod_core::arc_length(|t| (1.0 + 100.0 * t * t).sqrt(), 0.0, 0.1);
/// assert!((length - 0.05 * (2.0_f64.sqrt() + 1.0_f64.asinh())).abs() < 1e-16);
/// ```
pub fn arc_length(speed: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    if from == to {
        return 0.0;
    }
    halved(&speed, from, to, lobatto(&speed, from, to), HALVINGS)
}

/// The length of a part, of which one rule gives `whole`.
fn halved(speed: &impl Fn(f64) -> f64, from: f64, to: f64, whole: f64, halvings: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let [left, right] = [lobatto(speed, from, middle), lobatto(speed, middle, to)];
    let both = left + right;
    // what is not finite stays so
    if (both - whole).abs() > CONVERGED * both.abs() && halvings > 0 {
        halved(speed, from, middle, left, halvings - 1) + halved(speed, middle, to, right, halvings - 1)
    } else {
        both
    }
}

/// A rule with points at both ends: without them it would not see a jump of the curvature next to an end.
fn lobatto(speed: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let pair = |(at, weight): (f64, f64)| weight * (speed(from + at * (to - from)) + speed(to - at * (to - from)));
    RULE.into_iter().map(pair).sum::<f64>() * (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A speed with a kink, as that of a spline has at its points: for one end in some tens the rule and its halves agree by chance.
    #[test]
    fn a_kink_anywhere_costs_no_digits() {
        let speed = |t: f64| 1.0 + if t > 0.3 { 0.5 * (t - 0.3) } else { 0.0 };
        let exact = |t: f64| t + if t > 0.3 { 0.25 * (t - 0.3_f64).powi(2) } else { 0.0 };
        let bend = |t: f64| 1.0 + if t > 0.3 { 20.0 * (t - 0.3).powi(2) } else { 0.0 };
        let bent = |t: f64| t + if t > 0.3 { 20.0 / 3.0 * (t - 0.3_f64).powi(3) } else { 0.0 };
        for k in 1..20_000 {
            let t = f64::from(k) * 5e-5;
            let off = (arc_length(speed, 0.0, t) - exact(t)).abs().max((arc_length(bend, 0.0, t) - bent(t)).abs());
            assert!(off < 1e-13 * (1.0 + t), "{t}: {off:e}");
        }
    }
}
