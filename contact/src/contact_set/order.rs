//! Whether contacts follow each other along the rod.

use crate::contact_set::Configuration;
use crate::contact_set::notch::straddles;
use crate::scene::world::World;

/// Whether the contacts follow each other along the rod. Two that straddle a notch may run past each other: their meeting
/// is a transition of its own.
pub(crate) fn ordered(world: &World<'_>, configuration: &Configuration) -> bool {
    let n = configuration.count() - usize::from(straddles(world, configuration));
    (0..n).all(|j| configuration.s(j) > if j == 0 { 0.0 } else { configuration.s(j - 1) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_set::ActiveContact;
    use rod_contours::{Composite, Parabola};
    use rod_core::Hold;

    #[test]
    fn contacts_follow_each_other_from_the_clamp_on() {
        let contour = Composite::single(Parabola::new([0.0, 0.0], 1.0).unwrap()).unwrap();
        let world = World::new(contour.as_ref(), 1.0);
        let at = |places: &[f64]| {
            let mut set = Configuration::free(0.0);
            for (j, s) in places.iter().enumerate() {
                set.insert(j, ActiveContact::smooth(0, Hold::Tangent { offset: 0.0 }), [0.0, 1.0, *s]);
            }
            ordered(&world, &set)
        };
        assert!(at(&[]) && at(&[0.3]) && at(&[0.3, 0.7]));
        assert!(!at(&[0.7, 0.3]) && !at(&[0.3, 0.3]) && !at(&[-0.1]));
    }
}
