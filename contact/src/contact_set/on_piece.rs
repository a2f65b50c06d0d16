//! Whether contacts lie on their pieces.

use crate::contact_set::Configuration;
use crate::scene::world::World;
use rod_contours::Range;

/// Way (L; rad at a corner) beyond the end of a piece that is rounding.
const ROUNDING: f64 = 1e-9;

/// The first contact that lies beyond the end of its piece, where the equations follow the curve on which the piece lies. At a corner:
/// whose force points out of the cone of its normals.
pub(crate) fn off_piece(world: &World<'_>, configuration: &Configuration) -> Option<usize> {
    (0..configuration.count()).find(|j| {
        let (stretch, t) = (configuration.contacts[*j].stretch, configuration.t(*j));
        let Range { from, to } = world.span(stretch);
        let beyond = (from - t).max(t - to);
        let speed = world.support(stretch, t.clamp(from, to)).speed;
        beyond * if speed > 0.0 { speed } else { 1.0 } > ROUNDING
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_set::ActiveContact;
    use rod_contours::Composite;
    use rod_core::Hold;

    #[test]
    fn an_edge_ends_at_its_corners() {
        let square = Composite::polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]).unwrap();
        let world = World::new(square.as_ref(), 1.0);
        let off = |stretch: usize, t: f64| {
            let mut set = Configuration::free(0.0);
            set.insert(0, ActiveContact::smooth(stretch, Hold::Tip), [t, 1.0, 0.0]);
            off_piece(&world, &set)
        };
        for stretch in 0..square.stretches().len() {
            let [from, to] = [false, true].map(|upper| world.border(stretch, upper));
            assert!(
                off(stretch, from).is_none() && off(stretch, 0.5 * (from + to)).is_none() && off(stretch, to).is_none()
            );
            assert!(off(stretch, from - 1e-3) == Some(0) && off(stretch, to + 1e-3) == Some(0), "{stretch}");
        }
    }
}
