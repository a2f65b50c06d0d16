//! A sweep that goes on from an equilibrium that is given.

use super::Sweep;
use crate::contact_set::guess::{by_forces, configuration_of_guess, contacts_of_guess};
use crate::contact_set::{Configuration, Unknowns};
use crate::continuation::branch::{Corrector, Tangent};
use crate::continuation::certify::{Quality, energy};
use crate::continuation::{Point, Step};
use crate::error::{ContactError, StopReason};
use crate::gap::Scan;
use crate::limits::LIMITS;
use crate::state::{Contact, State};
use rod_core::PhysicalRod;

/// An equilibrium from which a leg begins.
#[derive(Debug)]
pub(super) struct Departure {
    pub configuration: Configuration,
    /// Its scan and its quality, where another leg has ended there: neither depends on the way from there on.
    certified: Option<(Scan, Quality)>,
}

impl Departure {
    /// From the end of another leg.
    pub fn from_end(end: &Point) -> Self {
        Self { configuration: end.configuration.clone(), certified: Some((end.scan.clone(), end.quality)) }
    }
}

impl From<Configuration> for Departure {
    fn from(configuration: Configuration) -> Self {
        Self { configuration, certified: None }
    }
}

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
    pub(super) fn resume(&mut self, given: Departure) -> Result<(Point, Option<Step>), StopReason> {
        if self.setup().world.rubs() && given.configuration.count() > 0 {
            return self.resume_rubbing(given.configuration);
        }
        Ok(self.resume_smooth(given))
    }

    fn resume_smooth(&mut self, Departure { configuration, certified }: Departure) -> (Point, Option<Step>) {
        let mut point = match certified {
            Some((scan, quality)) => {
                let (tangent, _) = self.stepper.corrector.inspect_at_pose(&configuration);
                Point { configuration, scan, quality, tangent }
            }
            None => self.point_of(configuration),
        };
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
        let ends = (one.is_none() && other.is_none()).then(|| point.end());
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

/// The configuration of the contacts of a state (SI units), with the clamp at 0 of the path of `corrector`.
fn recall<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    contacts: &[Contact],
) -> Result<Configuration, ContactError> {
    let setup = &corrector.setup;
    let all = contacts_of_guess(&setup.world, setup.rod.units(), contacts)?;
    // the forces give the rod's angle at each contact, and so its whole turns and the side on which it lies
    let recalled = configuration_of_guess(&all, &by_forces(setup.rod.model(), &setup.clamp(0.0), &all));
    let residual = residual(corrector, &recalled);
    if residual <= LIMITS.resume.solved {
        return Ok(recalled);
    }
    let mut solved = recalled.clone();
    let report = corrector.at_pose(&mut solved, 0.0);
    let is_near =
        |(z, recalled): (&f64, &f64)| (z - recalled).abs() <= LIMITS.resume.same_state * (1.0 + recalled.abs());
    if report.status.is_solved() && solved.z.iter().zip(&recalled.z).all(is_near) {
        Ok(solved)
    } else if residual <= LIMITS.resume.nearly_solved {
        Ok(recalled)
    } else {
        Err(ContactError::NotEquilibrium { reason: "the rod does not pass through its contacts" })
    }
}

/// Largest residual of the boundary-value problem at 0 of the path.
fn residual<R: PhysicalRod>(corrector: &Corrector<'_, R>, configuration: &Configuration) -> f64 {
    let (supports, u) = (configuration.supports(&corrector.setup.world), configuration.of_contacts());
    let mut residual = Unknowns::from_elem(0.0, u.len());
    corrector.setup.problem(&supports, 0.0).evaluate_into(u, &mut residual, None);
    residual.iter().fold(0.0, |most, r| if r.is_nan() { f64::INFINITY } else { f64::max(most, r.abs()) })
}
