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
