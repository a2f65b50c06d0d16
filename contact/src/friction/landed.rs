//! Friction where a rod has snapped: statics does not determine it, since it depends on the motion.

use crate::contact_set::{Configuration, Segments};
use crate::continuation::branch::Corrector;
use crate::scene::rod::along;
use rod_core::{Grip, PhysicalRod};

/// Steps in which the coefficient grows from 0: an equilibrium without friction is near the one with a tenth of it.
const GROWTH: u32 = 10;

/// The same contacts without a force along the contour. The coefficients of friction of the objects stay.
pub(crate) fn without_friction(configuration: &Configuration) -> Configuration {
    let mut without = configuration.clone();
    for j in 0..without.count() {
        without.set_slipping(j, 0.0);
    }
    without
}

/// The equilibrium with friction near `landed`, to which a descent without friction has led. At each contact, friction opposes its motion from
/// the shape `before`. None where there is no such equilibrium.
pub(crate) fn with_drag<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    landed: &Configuration,
    before: &Segments,
) -> Option<Configuration> {
    let (world, tau) = (&corrector.setup.world, landed.tau());
    let ratio = |j: usize| {
        let held = landed.contacts[j];
        if world.is_notch(held.stretch) {
            return 0.0;
        }
        let at = world.support(held.stretch, landed.t(j));
        let was = along(corrector.setup.rod.model(), before, landed.s(j));
        let way = (at.x - was.x) * at.alpha.cos() + (at.y - was.y) * at.alpha.sin();
        -world.coefficients(held.stretch).slipping * way.signum()
    };
    let ratios: Vec<f64> = (0..landed.count()).map(ratio).collect();
    let mut dragged = landed.clone();
    for step in 1..=GROWTH {
        let share = f64::from(step) / f64::from(GROWTH);
        for (j, ratio) in ratios.iter().enumerate() {
            dragged.contacts[j].grip = Grip::Slips { ratio: share * ratio };
        }
        let report = corrector.at_pose(&mut dragged, tau);
        let holds = |j: usize| dragged.force(j) > 0.0 && dragged.s(j) <= 1.0;
        if !report.status.is_solved() || !(0..dragged.count()).all(holds) {
            return None;
        }
    }
    Some(dragged)
}
