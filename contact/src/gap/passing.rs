//! What a step has passed over: thin things that are beside the rod before and after it, on another side.
//!
//! The rod before a step, the way of its tip, the rod after the step and the way of the clamp enclose what the rod has swept
//! over. An object that crosses neither rod nor one of the two ways is either outside of that, or all of it is inside: then
//! the rod has gone through it.

use crate::contact_set::{Configuration, Held};
use crate::gap::shape::Shape;
use crate::scene::world::World;

/// What has gone through an object within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passing {
    Clamp,
    Rod,
}

/// Whether the rod has swept over an object on its way from one shape to another, other than those that it touches.
pub(crate) fn swept_over(world: &World<'_>, from: &Shape, to: &Shape, held: &Configuration) -> bool {
    let mut found = false;
    world.closed_objects_in(from.bounds().union(to.bounds()), |object, point| {
        let is_held = held.contacts.iter().any(|contact| world.object(contact.stretch) == object);
        found |= !is_held && turns_around(point, from, to);
    });
    found
}

/// Whether the two rods and the ways of their ends go around a point.
fn turns_around((x, y): (f64, f64), from: &Shape, to: &Shape) -> bool {
    let points = from.nodes.iter().chain(to.nodes.iter().rev());
    let points = points.map(|node| (node.at.x - x, node.at.y - y));
    let mut turns = 0;
    let mut before = (to.nodes[0].at.x - x, to.nodes[0].at.y - y);
    for here in points {
        // crossings of the ray to the right, upwards and downwards
        if (before.1 < 0.0) != (here.1 < 0.0) {
            let side = before.0 * here.1 - before.1 * here.0;
            if here.1 > before.1 && side > 0.0 {
                turns += 1;
            } else if here.1 < before.1 && side < 0.0 {
                turns -= 1;
            }
        }
        before = here;
    }
    turns != 0
}

/// Whether a run holds the rod: the way of the tip may cut it, since the rod slides along it.
pub(crate) fn holds(world: &World<'_>, configuration: &Configuration, run: usize) -> bool {
    let contacts = configuration.contacts.iter().enumerate();
    contacts.into_iter().any(|(j, Held { stretch, .. })| world.is_on_run(run, *stretch, configuration.t(j)))
}
