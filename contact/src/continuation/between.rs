//! The equilibria to report between both ends of a step: predicted by a cubic through both ends, corrected by Newton's method.

use crate::contact_set::Configuration;
use crate::continuation::branch::{Condition, Tangent};
use crate::continuation::certify::{Quality, state};
use crate::continuation::stepper::Stepper;
use crate::continuation::transition::breaks;
use crate::continuation::{Point, Step};
use crate::gap::{Scan, Scanner};
use crate::limits::LIMITS;
use crate::state::State;
use rod_core::PhysicalRod;

/// Limit of halvings of an interval. 60 halvings reach rounding.
const MOST_HALVINGS: usize = 60;
/// Distance (path parameter) from the pose at which the cubic is left to Newton's method, which comes to the pose in one step.
const NEAR_POSE: f64 = 1e-12;

impl<R: PhysicalRod> Stepper<'_, R> {
    /// The certified equilibrium at the pose `tau` between `from` and the end of `step`. None where it is not found, or where a condition of the
    /// contact set is violated or it is not stable: the step has passed over a transition.
    pub fn between(&mut self, from: &Point, step: &Step, tau: f64) -> Option<State> {
        let last = step.last();
        if last.contacts.len() != from.configuration.contacts.len() {
            return None;
        }
        let length = from.tangent.along(&last.z, &from.configuration.z);
        let after = if let Step::Moved(next) = step {
            Some((&next.tangent, 1.0 / from.tangent.component(&next.tangent.direction)))
        } else {
            None
        };
        let way = Way { from, to: last, after, length };
        let mut here = way.at_pose(tau)?;
        let predicted = here.z.clone();
        let mut report = self.corrector.at_pose(&mut here, tau);
        let strayed = |here: &Configuration| {
            from.tangent.distance(&here.z, &predicted)
                > LIMITS.step.largest_correction * length + LIMITS.step.correction_rounding
        };
        if !report.status.is_solved() || strayed(&here) {
            here = self.solve_by_arclength(&way, tau)?;
            report = self.corrector.at_pose(&mut here, tau);
        }
        if !report.status.is_solved()
            || report.residual > LIMITS.step.largest_residual
            || !here.is_ordered(&self.corrector.setup.world)
        {
            return None;
        }
        here.set_tau(tau);
        let scan = self.scanner.scan_between(&self.corrector.setup, &here);
        let stable = self.keeps_contacts(&here, &scan) && self.keeps_stability(from, &here, &scan);
        let quality = if here.count() == 0 { Quality::FREE } else { Quality::new(&report, true) };
        let state = stable.then(|| state(&self.corrector.setup, &here, &scan, quality));
        self.scanner.recycle(scan);
        state
    }

    /// Whether the rod is outside of all objects, and no condition of its contact set is violated.
    #[inline(never)]
    fn keeps_contacts(&self, here: &Configuration, scan: &Scan) -> bool {
        let mut holds = scan.is_outside();
        breaks(&self.corrector.setup.world, here, &scan.crossings, |_| holds = false);
        holds
    }

    /// Whether the equilibrium `here` is stable, by the start of its step or by itself.
    #[inline(never)]
    fn keeps_stability(&mut self, from: &Point, here: &Configuration, scan: &Scan) -> bool {
        self.stays_stable(from, here, scan) || self.is_stable(here, scan)
    }

    /// Whether the equilibrium `here`, of which the corrector still holds the Jacobian, is stable because the start of its step is. Between the
    /// two, the sign of the second variation changes only in a fold, where tau begins to fall, or where a contact wraps around the contour.
    fn stays_stable(&self, from: &Point, here: &Configuration, scan: &Scan) -> bool {
        let direction = self.corrector.direction(here.z.len());
        from.quality.stable
            && from.tangent.by_tau() > LIMITS.step.least_tau_rate
            && from.tangent.cosine(&direction) > LIMITS.step.least_cosine
            && Scanner::wraps_nowhere(&self.corrector.setup, here, scan)
    }

    /// The point of the way at the pose `tau` by its arclength: next to a fold the pose alone is ill-conditioned.
    fn solve_by_arclength(&mut self, way: &Way<'_>, tau: f64) -> Option<Configuration> {
        let Way { from, length, .. } = *way;
        let (mut low, mut high) = (0.0, length);
        let mut found = None;
        for _ in 0..MOST_HALVINGS {
            let distance = 0.5 * (low + high);
            let mut here = way.at(distance);
            let plane = Condition::Plane { tangent: &from.tangent, from: &from.configuration.z, distance };
            if !self.corrector.correct(&mut here, plane).status.is_solved() {
                return None;
            }
            if here.tau() < tau {
                low = distance;
            } else {
                high = distance;
            }
            found = Some(here);
        }
        found
    }
}

/// A step from one configuration to another one on the same branch, as a cubic in the arclength along the first tangent.
struct Way<'a> {
    from: &'a Point,
    to: &'a Configuration,
    /// The tangent at the end, where it is known, and the arclength along it per unit of arclength along the first tangent.
    after: Option<(&'a Tangent, f64)>,
    length: f64,
}

impl Way<'_> {
    /// The coefficients, constant first, of the cubic of unknown number `i` in the arclength.
    fn cubic(&self, i: usize) -> [f64; 4] {
        let (start, end, l) = (self.from.configuration.z[i], self.to.z[i], self.length);
        let rate = self.from.tangent.rate(i);
        let bent = (end - start - rate * l) / (l * l);
        let Some((after, stretch)) = self.after else { return [start, rate, bent, 0.0] };
        let turned = (after.rate(i) * stretch - rate) / l;
        [start, rate, 3.0 * bent - turned, (turned - 2.0 * bent) / l]
    }

    fn at(&self, x: f64) -> Configuration {
        let mut here = self.to.clone();
        for i in 0..here.z.len() {
            here.z[i] = cubic_value(self.cubic(i), x);
        }
        here
    }

    /// The point at the pose `tau`. None where the step has no length.
    #[inline(never)]
    fn at_pose(&self, tau: f64) -> Option<Configuration> {
        let cubic = self.cubic(self.to.z.len() - 1);
        let (mut low, mut high) = (0.0, self.length);
        if high <= 0.0 || high.is_nan() {
            return None;
        }
        let (mut x, mut before) = (high * (tau - cubic[0]) / (self.to.tau() - cubic[0]), f64::NAN);
        for _ in 0..MOST_HALVINGS {
            let off = cubic_value(cubic, x) - tau;
            if off < 0.0 {
                low = x;
            } else {
                high = x;
            }
            if off.abs() <= NEAR_POSE || before == x {
                break;
            }
            before = x;
            let [_, b, c, d] = cubic;
            let newton = x - off / (b + x * (2.0 * c + x * 3.0 * d));
            x = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        }
        Some(self.at(x))
    }
}

/// The value of a cubic at x.
fn cubic_value([a, b, c, d]: [f64; 4], x: f64) -> f64 {
    a + x * (b + x * (c + x * d))
}

#[cfg(test)]
mod tests {
    use crate::path::ClampPath;
    use crate::{Sweep, equilibrium};
    use rod_contours::{Composite, Parabola};
    use rod_core::{Pose, Rod};
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn what_is_stable_by_its_step_is_stable_on_its_own() {
        let parabola = |x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as _;
        let contour = Composite::joined(vec![parabola(0.0), parabola(0.3)]).unwrap();
        let rod = Rod::new(1.0, 1.0).unwrap();
        let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
        let states = Sweep::new(&rod, &contour, ClampPath::new(at(0.8), at(-0.9)).unwrap(), 1e-3).unwrap().run().states;
        let held: Vec<_> = states.iter().filter(|state| !state.contacts.is_empty()).collect();
        assert!(held.len() > 1000);
        for state in held {
            let alone = equilibrium(&rod, &contour, state.pose, &state.contacts).unwrap().state.certificate;
            assert!(state.certificate.stable && alone.stable, "{:?}", state.pose);
        }
    }
}
