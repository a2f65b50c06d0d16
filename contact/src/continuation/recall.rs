//! The configuration that a state was made from: its contact set with all unknowns, so that a sweep goes on from there.

use crate::contact_set::guess::{by_forces, configuration_of_guess, contacts_of_guess};
use crate::contact_set::{Configuration, Unknowns};
use crate::continuation::branch::Corrector;
use crate::error::ContactError;
use crate::limits::LIMITS;
use crate::state::Contact;
use rod_core::PhysicalRod;

/// The configuration of the contacts of a state (SI units), with the clamp at 0 of the path of `corrector`.
pub(crate) fn recall<R: PhysicalRod>(
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
