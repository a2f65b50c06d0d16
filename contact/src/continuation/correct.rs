//! Predict along the tangent, correct by Newton's method: the next point of a branch, before it is judged.

use crate::contact_set::{Configuration, Unknown};
use crate::continuation::branch::Condition;
use crate::continuation::joint::{BehindJoint, cross_joint, crosses_joint};
use crate::continuation::stepper::Stepper;
use crate::continuation::transition::range_of_force;
use crate::continuation::{Corrected, Point};
use crate::limits::LIMITS;
use rod_core::PhysicalRod;

/// A step along the tangent, before it is corrected.
pub(super) struct Prediction {
    next: Configuration,
    /// Arclength of the step along the tangent, and the longest one that is allowed.
    length: f64,
    reach: f64,
    /// Whether the step aims at the target pose.
    lands: bool,
}

impl<R: PhysicalRod> Stepper<'_, R> {
    /// A step along the tangent: to the pose `target` where that is near enough, otherwise as long as allowed.
    pub(super) fn predict(&self, from: &Point, target: f64) -> Prediction {
        let Point { configuration, tangent, scan, .. } = from;
        let slope = tangent.by_tau();
        let to_go =
            if slope > LIMITS.step.least_tau_rate { (target - configuration.tau()) / slope } else { f64::INFINITY };
        // a free rod is safe as far as its gap reaches, and goes little further
        let reach = if configuration.count() == 0 {
            let fastest = self.largest_speed();
            (scan.gap.lower.clamp(0.0, 1.0) / fastest).max(self.h.min(LIMITS.step.longest_free / fastest))
        } else {
            self.h.min(LIMITS.step.longest_way / slope.abs()).min(self.to_border(from))
        };
        let lands = to_go <= reach;
        let length = if lands { to_go } else { reach };
        Prediction { next: tangent.ahead(configuration, length), length, reach, lands }
    }

    /// The point of the branch near a prediction: at the pose `target` if the prediction aims there or the branch has come past it, otherwise
    /// at the length of the step; just behind a joint of the rod if a contact slides over one. None: the step was too long.
    pub(super) fn correct(&mut self, from: &Point, prediction: Prediction, target: f64) -> Option<Corrected> {
        let Point { configuration, tangent, .. } = from;
        let Prediction { mut next, length, reach, mut lands } = prediction;
        if crosses_joint(&self.corrector, configuration, &next) {
            return self.over_joint(from, &next, target, reach);
        }
        let predicted = next.z.clone();
        let at_pose = Condition::Fixed { unknown: Unknown::Path, value: target };
        let condition =
            if lands { at_pose } else { Condition::Plane { tangent, from: &configuration.z, distance: length } };
        let (mut report, mut ahead) = self.corrector.correct_with_tangent(&mut next, condition);
        let off = tangent.distance(&next.z, &predicted);
        if !report.status.is_solved()
            || report.residual > LIMITS.step.largest_residual
            || !next.is_ordered(&self.corrector.setup.world)
            || off > LIMITS.step.largest_correction * length + LIMITS.step.correction_rounding
        {
            return None;
        }
        if !lands && next.tau() > target {
            // ran past it: the pose is between the two
            next = between(configuration, next, target);
            (report, ahead) = self.corrector.correct_with_tangent(&mut next, at_pose);
            let length = tangent.along(&next.z, &configuration.z);
            if !report.status.is_solved()
                || !next.is_ordered(&self.corrector.setup.world)
                || !(0.0..=reach).contains(&length)
            {
                return None;
            }
            lands = true;
        }
        if lands {
            // to the last bit, so that the sweep knows it has arrived
            next.set_tau(target);
        }
        let mut ahead = ahead?;
        if next.rubs() {
            // whether a contact still slips forward depends on more digits than those of a Jacobian that is one correction old
            let own = if lands { at_pose } else { condition };
            ahead = self.corrector.inspect(&next, own).0;
        }
        if !crosses_joint(&self.corrector, configuration, &next) {
            let length = tangent.along(&next.z, &configuration.z);
            return Some(Corrected { next, tangent: ahead, report, length, kink: false });
        }
        self.over_joint(from, &next, target, reach)
    }

    /// The point just behind the first joint on the way to `next`, if that is as near as a step may go.
    fn over_joint(&mut self, from: &Point, next: &Configuration, target: f64, reach: f64) -> Option<Corrected> {
        let BehindJoint { configuration: next, tangent, report } =
            cross_joint(&mut self.corrector, (&from.configuration, &from.tangent), next)?;
        let length = from.tangent.along(&next.z, &from.configuration.z);
        let near = next.tau() <= target && (0.0..=2.0 * reach).contains(&length);
        let solved = report.residual <= LIMITS.step.largest_residual && next.is_ordered(&self.corrector.setup.world);
        (near && solved).then_some(Corrected { next, tangent, report, length, kink: true })
    }

    /// Length of a step that takes a contact over the border of its stretch for certain, but not much further: there may be
    /// many short ones.
    fn to_border(&self, from: &Point) -> f64 {
        let Point { configuration, tangent, .. } = from;
        let step = |j: usize| {
            let (t, rate) = (configuration.t(j), tangent.rate_of(Unknown::Parameter(j)));
            // a tip that sticks has no border ahead, not even on one
            if rate == 0.0 || (configuration.is_tip(j) && configuration.contacts[j].grip.sticks()) {
                return f64::INFINITY;
            }
            let range = range_of_force(&self.corrector.setup.world, configuration.contacts[j].stretch);
            let border = if rate > 0.0 { range.to } else { range.from };
            1.5 * ((border - t) / rate).max(0.0) + LIMITS.probe.way
        };
        (0..configuration.count()).map(step).fold(f64::INFINITY, f64::min)
    }

    /// Largest speed of any point of a free rod by the path parameter: none is farther from the clamp than 1.
    pub(super) fn largest_speed(&self) -> f64 {
        self.corrector.setup.path.largest_speed()
    }
}

/// The point at `tau` on the chord between two points of a branch.
fn between(from: &Configuration, mut to: Configuration, tau: f64) -> Configuration {
    let part = (tau - from.tau()) / (to.tau() - from.tau());
    for (z, start) in to.z.iter_mut().zip(&from.z) {
        *z = start + part * (*z - start);
    }
    to
}
