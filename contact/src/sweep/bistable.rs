//! A branch that turns back in a fold and forward again in another one: the rod snaps from the first fold onto the part behind the
//! second, with the same contacts.

use super::Sweep;
use crate::contact_set::Configuration;
use crate::continuation::Seen;
use crate::continuation::branch::{Condition, Tangent};
use crate::continuation::certify::energy;
use crate::continuation::stepper::Stepper;
use crate::continuation::transition::breaks;
use crate::limits::LIMITS;
use crate::snap::settle;
use rod_core::PhysicalRod;

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The equilibrium on the same branch behind its next fold, at the pose of `fold`. None where a contact begins or ends on the way there, or where
    /// it has more energy than the rod has in the fold.
    pub(super) fn behind_next_fold(&mut self, fold: &Configuration) -> Option<Seen> {
        if fold.count() == 0 {
            return None;
        }
        let (there, _) = self.stepper.corrector.inspect_at_pose(fold);
        let back = Tangent { direction: there.direction.iter().map(|d| -d).collect(), weights: there.weights.clone() };
        [there, back].into_iter().find_map(|tangent| self.follow_to_next_fold(fold, tangent))
    }

    /// The same in one direction along the branch.
    fn follow_to_next_fold(&mut self, fold: &Configuration, mut tangent: Tangent) -> Option<Seen> {
        let tau = fold.tau();
        let mut h = LIMITS.snap.first_step;
        let (mut here, mut has_turned) = (fold.clone(), false);
        for _ in 0..LIMITS.snap.most_steps {
            let mut next = tangent.ahead(&here, h);
            let plane = Condition::Plane { tangent: &tangent, from: &here.z, distance: h };
            let corrector = &mut self.stepper.corrector;
            let report = corrector.correct(&mut next, plane);
            let solved = report.status.is_solved() && report.residual <= LIMITS.step.largest_residual;
            let after = solved.then(|| corrector.inspect(&next, plane).0);
            let Some(after) = after.filter(|after| after.cosine(&tangent.direction) > LIMITS.step.least_cosine) else {
                h *= 0.5;
                if h < LIMITS.snap.shortest_step {
                    return None;
                }
                continue;
            };
            let scan = self.stepper.scan(&next);
            let world = &self.stepper.corrector.setup.world;
            let mut holds = scan.is_outside() && next.is_ordered(world);
            breaks(world, &next, &scan.crossings, |_| holds = false);
            if !holds {
                return None;
            }
            if has_turned && next.tau() >= tau {
                return self.settle_between(tau, &here, &next, fold);
            }
            has_turned |= after.by_tau() > 0.0 && next.tau() < tau;
            (here, tangent, h) = (next, after, (1.5 * h).min(LIMITS.snap.longest_step));
        }
        None
    }

    /// The equilibrium at `tau` between two points of the branch.
    fn settle_between(
        &mut self,
        tau: f64,
        from: &Configuration,
        to: &Configuration,
        fold: &Configuration,
    ) -> Option<Seen> {
        let share = (tau - from.tau()) / (to.tau() - from.tau());
        let mut guess = from.clone();
        for (z, end) in guess.z.iter_mut().zip(&to.z) {
            *z += share * (end - *z);
        }
        guess.set_tau(tau);
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let landed = settle(corrector, scanner, guess)?;
        let lower = energy(self.setup(), &landed.configuration) < energy(self.setup(), fold);
        (lower && !landed.configuration.is_same_equilibrium(fold, &self.setup().world)).then_some(landed)
    }
}
