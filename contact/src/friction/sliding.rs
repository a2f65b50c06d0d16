//! Contacts that slide all one way along the rod.
//!
//! On a rod that is drawn past an object nearly all contacts slide, and all in the same sense of the rod. Where this is taken for granted, the
//! friction of a state does not depend on how the rod came there: equilibria are those of forces that are turned by a known angle, and can be followed to
//! both sides, as inversion needs it.

use super::{UNLOADED, sense};
use crate::contact_set::Configuration;
use crate::continuation::branch::Corrector;
use crate::scene::world::World;
use rod_core::PhysicalRod;

/// Steps in which the coefficient of a loaded contact changes: an equilibrium is near one with a tenth less or more.
const GROWTH: u32 = 10;

/// Difference of two f_t / f that is rounding.
const SAME: f64 = 1e-12;

/// f_t / f of contact j by its coefficient.
fn ratio_of(world: &World<'_>, configuration: &Configuration, j: usize) -> f64 {
    world.sliding() * along(world, configuration, j)
}

/// The rate of f_t / f of contact j by the coefficient with which it slides: 1 where the rod runs in the sense of the contour, -1 where it runs against it,
/// 0 where it rests in a notch.
pub(crate) fn along(world: &World<'_>, configuration: &Configuration, j: usize) -> f64 {
    let stretch = configuration.contacts[j].stretch;
    if world.is_notch(stretch) {
        return 0.0;
    }
    sense(configuration, j, &world.support(stretch, configuration.t(j)))
}

/// Lets contacts without a force slide, which changes nothing yet.
pub(crate) fn slide_new_contacts(world: &World<'_>, configuration: &mut Configuration) {
    slide_where(world, configuration, |force| force.abs() < UNLOADED);
}

/// The guess of an equilibrium all of whose contacts slide.
pub(crate) fn slide_all(world: &World<'_>, configuration: &mut Configuration) {
    slide_where(world, configuration, |_| true);
}

/// Lets contacts with some forces slide, if contacts slide at all.
fn slide_where(world: &World<'_>, configuration: &mut Configuration, slides: impl Fn(f64) -> bool) {
    if world.sliding() == 0.0 {
        return;
    }
    for j in 0..configuration.count() {
        if slides(configuration.force(j)) {
            configuration.set_slipping(j, ratio_of(world, configuration, j));
        }
    }
}

/// The equilibrium at the same pose all of whose contacts slide, near one with another friction; none where there is none.
pub(crate) fn sliding_near<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    near: &Configuration,
) -> Option<Configuration> {
    let world = &corrector.setup.world;
    let ratios: Vec<f64> = (0..near.count()).map(|j| ratio_of(world, near, j)).collect();
    // a state that is given has its force along the contour to rounding
    if ratios.iter().enumerate().all(|(j, ratio)| (ratio - near.ratio(j)).abs() < SAME) {
        return Some(near.clone());
    }
    with_ratios(corrector, near, &ratios)
}

/// The equilibrium at the same pose with these f_t / f, to which those of `near` grow.
pub(crate) fn with_ratios<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    near: &Configuration,
    ratios: &[f64],
) -> Option<Configuration> {
    let tau = near.tau();
    let given: Vec<f64> = (0..near.count()).map(|j| near.ratio(j)).collect();
    let mut grown = near.clone();
    for step in 1..=GROWTH {
        let share = f64::from(step) / f64::from(GROWTH);
        for (j, (from, to)) in given.iter().zip(ratios).enumerate() {
            grown.set_slipping(j, from + share * (to - from));
        }
        let report = corrector.at_pose(&mut grown, tau);
        let holds = |j: usize| grown.force(j) > 0.0 && grown.s(j) <= 1.0;
        if !report.status.is_solved() || !(0..grown.count()).all(holds) {
            return None;
        }
    }
    Some(grown)
}
