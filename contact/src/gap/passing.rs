//! What a step has passed over: thin things that are beside the rod before and after it, on another side.
//!
//! The rod before a step, the way of its tip, the rod after the step and the way of the clamp enclose what the rod has swept
//! over. An object that crosses neither rod nor one of the two ways is either outside of that, or all of it is inside: then
//! the rod has gone through it.

use crate::contact_set::{ActiveContact, Configuration};
use crate::gap::interval::{Interval, Knot};
use crate::gap::shape::Shape;
use crate::scene::world::World;
use rod_core::RodModel;

/// What has gone through an object within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passing {
    Clamp,
    Rod,
}

/// Length (L) below which a part of the rod is its chord.
const SHORTEST: f64 = 1e-12;

/// Whether the rod has swept over an object on its way from one shape to another, other than those that it touches.
pub(crate) fn swept_over(
    rod: &impl RodModel,
    world: &World<'_>,
    from: &Shape,
    to: &Shape,
    held: &Configuration,
) -> bool {
    let mut found = false;
    world.closed_objects_in(from.bounds().union(to.bounds()), |object, point| {
        if !held.contacts.iter().any(|contact| world.object(contact.stretch) == object) {
            let mut before = polygon(rod, from, point);
            let mut after = polygon(rod, to, point);
            after.reverse();
            before.append(&mut after);
            found |= turns_around(point, &before);
        }
    });
    found
}

/// Points of the rod, so close together where it is near a point that this is on the same side of the rod and of the chords.
fn polygon(rod: &impl RodModel, shape: &Shape, point: (f64, f64)) -> Vec<(f64, f64)> {
    let mut points = vec![shape.ends().0];
    for pair in shape.nodes.windows(2) {
        let segment = pair[0].segment;
        let whole = |from, to| Interval::new(rod, from, to, segment, shape.force(segment));
        let mut parts = vec![whole(Knot::from(&pair[0]), Knot::from(&pair[1]))];
        while let Some(part) = parts.pop() {
            if part.length < SHORTEST || distance(point, &part) > part.bulge() {
                points.push((part.to.at.x, part.to.at.y));
            } else {
                let [before, after] = part.split(rod, &shape.segments[segment], 0.5 * (part.from.s + part.to.s));
                parts.extend([after, before]);
            }
        }
    }
    points
}

/// Distance of a point from the chord of a part of the rod.
fn distance((x, y): (f64, f64), Interval { from, to, .. }: &Interval) -> f64 {
    let (dx, dy) = (to.at.x - from.at.x, to.at.y - from.at.y);
    let (x, y) = (x - from.at.x, y - from.at.y);
    let share = ((x * dx + y * dy) / (dx * dx + dy * dy).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (x - share * dx).hypot(y - share * dy)
}

/// Whether a closed polygon goes around a point.
fn turns_around((x, y): (f64, f64), polygon: &[(f64, f64)]) -> bool {
    let points = polygon.iter().map(|(px, py)| (px - x, py - y));
    let mut turns = 0;
    let mut before = polygon.last().map_or((0.0, 0.0), |(px, py)| (px - x, py - y));
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
    contacts.into_iter().any(|(j, ActiveContact { stretch, .. })| world.is_on_run(run, *stretch, configuration.t(j)))
}
