//! A sweep that goes on from an equilibrium that is given.

use super::Sweep;
use crate::contact_set::Configuration;
use crate::continuation::branch::Tangent;
use crate::continuation::certify::energy;
use crate::continuation::recall::recall;
use crate::continuation::{Point, Step};
use crate::error::{ContactError, StopReason};
use crate::limits::LIMITS;
use crate::state::State;
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The configuration of a state at the first pose of the path.
    pub(super) fn recall_state(&mut self, state: &State) -> Result<Configuration, ContactError> {
        let recalled = recall(&mut self.stepper.corrector, &state.contacts)?;
        let pulls = (0..recalled.count()).any(|j| recalled.force(j) < -LIMITS.resume.pull);
        let wrong = |reason| Err(ContactError::NotEquilibrium { reason });
        if pulls {
            return wrong("a contact pulls");
        }
        if !self.stepper.look(recalled.clone()).scan.is_outside() {
            return wrong("the rod goes through an object");
        }
        Ok(recalled)
    }

    /// The point to begin with. At a fold two branches meet. The sweep takes the stable one, if the path parameter grows along it. Otherwise the
    /// equilibrium ends here: the returned step ends the branch, and the rod snaps.
    pub(super) fn resume(&mut self, given: Configuration) -> Result<(Point, Option<Step>), StopReason> {
        if self.setup().world.rubs() && given.count() > 0 {
            return self.resume_rubbing(given);
        }
        Ok(self.resume_smooth(given))
    }

    fn resume_smooth(&mut self, given: Configuration) -> (Point, Option<Step>) {
        let mut point = self.at_rest(given);
        if point.tangent.by_tau() > LIMITS.resume.least_tau_rate && point.quality.stable {
            return (point, None);
        }
        let there = point.tangent.clone();
        let back = Tangent { direction: there.direction.iter().map(|d| -d).collect(), weights: there.weights.clone() };
        let [one, other] = [&there, &back].map(|tangent| {
            point.tangent = tangent.clone();
            self.stepper.beyond_fold(&point)
        });
        let is_there = match (&one, &other) {
            (Some(one), Some(other)) => self.is_lower(one, other),
            (one, _) => one.is_some(),
        };
        let ends = (one.is_none() && other.is_none()).then(|| point.ends());
        point.tangent = if is_there { there } else { back };
        (point, ends)
    }

    /// Whether the first of two branches beside a fold has the lower energy at the same pose, as the stable one has. So close to
    /// the fold both may pass for stable, by the modes that the second variation leaves out.
    fn is_lower(&mut self, one: &Configuration, other: &Configuration) -> bool {
        let corrector = &mut self.stepper.corrector;
        let tau = one.tau().min(other.tau());
        let [one, other] = [one, other].map(|configuration| {
            let mut here = configuration.clone();
            corrector.at_pose(&mut here, tau);
            energy(&corrector.setup, &here)
        });
        one <= other
    }
}
