//! Where a rod comes to rest: overdamped descent of the bending energy under unilateral contact.
//!
//! The rod is a chain of rigid links with a spring in each joint (inextensible by construction), its base on the springs of the clamp. Each step is implicit: it
//! minimises the energy after the step plus the distance gone, in the metric of the springs (a rod with internal,
//! Kelvin-Voigt damping), under the linearised gaps of all nodes and of corners to links, which is a small quadratic
//! programme. The result is good to the square of a link's length: enough to see which contacts there are.

mod cluster;
mod near;
mod programme;
mod root;
mod solution;

use crate::contact_set::Configuration;
use crate::scene::springs::{Spring, Springs, springs};
use crate::scene::world::World;
use crate::scene::{Setup, rod};
use cluster::{Cluster, clusters, contacts};
use near::{Near, near};
use programme::Programme;
use rod_core::{Clamp, PhysicalRod, Pose, RodModel};
use root::Root;
use smallvec::{SmallVec, smallvec};
use solution::solve;

/// Number of links.
const LINKS: usize = 64;
/// Length of a link.
const LINK: f64 = 1.0 / LINKS as f64;
/// Longest way (L) of a node in one step where an object is near. The gaps are linearised over it.
const LONGEST_MOVE: f64 = 0.04;
/// Gap (L) above which a contour is out of reach of a step.
const REACH: f64 = 2.0 * LONGEST_MOVE;
/// Way (L) of a step below which the chain is at rest.
const ARRIVED: f64 = 2e-5;
/// Work of the active-set method, in units of the cube of the number of near nodes, after which a descent is given up. Block
/// pivoting settles nearly all steps, and is not counted. A larger limit lets a snap in a narrow gap go on for longer.
const MOST_WORK: f64 = 1e8;
/// Limit of steps of one descent.
const MOST_STEPS: usize = 400;
/// Steps after which a chain that still moves fast is taken to swing: in a hollow, whose curvature the linearised gaps leave out, it
/// goes from one wall to the other. Then the time step is halved and grows no more. With a smaller number long descents take more
/// steps.
const PATIENCE: usize = 100;
/// Longest time step of a slow chain.
const LONGEST_TIME_STEP: f64 = 1e3;
/// Share of the longest way at which a step aims. Larger: more steps are too long. Smaller: more steps.
const AIM: f64 = 0.8;
/// Distance (L) up to which contours are looked for: of a chain that touches something, and of one in free flight. Larger: each look finds more of
/// many pieces. Smaller: a node is looked at more often.
const HORIZON: f64 = 2.0 * REACH;
const FAR: f64 = 0.5;
/// Time step over the damping time: the unconstrained shape loses half of its bend in a step of 1.
const TIME_STEP: f64 = 1.0;
/// Deepest penetration (L) that one step takes back.
const DEEPEST_PUSH: f64 = 0.03;
/// Way (L) by which walls give way to a unit of force, where the linearised walls leave no room.
const YIELDING: f64 = 1e-5;

/// The share of the way to its rest that an unconstrained chain goes in a time step, and the time step in which it goes a share.
fn share_gone(time_step: f64) -> f64 {
    time_step / (1.0 + time_step)
}
fn time_step_of(share: f64) -> f64 {
    if share < 1.0 { share / (1.0 - share) } else { f64::INFINITY }
}

/// Turn (rad) of a joint of a straight chain by rounding.
const STRAIGHT: f64 = 1e-9;

/// One number a spring of the base.
type Base = [f64; 3];

/// Ends of the links, the base first.
type Nodes = [[f64; 2]; LINKS + 1];

/// Where a chain is: ends of the links, and the angle of each link.
struct Place {
    nodes: Nodes,
    angles: [f64; LINKS],
}

/// A step that was taken.
struct Taken {
    /// Longest way of a node, and the largest share of the way that a node may go.
    way: f64,
    share: f64,
    /// Time step, shortened until the way was short enough.
    time_step: f64,
    /// Where the chain is then.
    place: Place,
    /// The force at each near node.
    forces: Vec<(Near, f64)>,
}

/// A chain of links in the contour's world.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// The support of the clamp.
    pub clamp: Pose,
    /// The springs between it and the base, and how far each has given way.
    springs: Springs,
    given: Base,
    /// Turning angle of each joint; the first is between base and first link.
    joints: [f64; LINKS],
    /// The same at rest, and by how much each joint turns by a unit of moment.
    rest: [f64; LINKS],
    softness: [f64; LINKS],
    /// A roller at its root.
    root: Option<Root>,
}

impl Chain {
    /// A chain at rest, but for a slight bend (radians over its length): without one, a straight chain could not buckle.
    pub fn at_rest(rod: &impl RodModel, clamp: &impl Clamp, bend: f64) -> Self {
        // a full link between two links, half a link between clamp and first one
        let share = |i: usize| if i == 0 { (0.25 * LINK, 0.5 * LINK) } else { (i as f64 * LINK, LINK) };
        let rest = std::array::from_fn(|i| {
            let (s, length) = share(i);
            length * rod.natural_curvature(s)
        });
        let mut softness = std::array::from_fn(|i| {
            let (s, length) = share(i);
            length * (rod.curvature_at(s, 1.0) - rod.natural_curvature(s))
        });
        let joints = rest.map(|joint| joint + bend * LINK);
        let mut springs = springs(clamp.law());
        let root = clamp.roller().map(|roller| Root::new(rod, &roller, clamp.pose()));
        if let Some(root) = &root {
            root.stiffen(&mut softness);
            springs.push(root.spring);
        }
        Self { clamp: clamp.pose(), springs, given: [0.0; 3], joints, rest, softness, root }
    }

    /// The shape of the rod in `configuration`, its clamp at another `tau`.
    pub fn of<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration, tau: f64) -> Self {
        let segments = configuration.segments(setup);
        let (base, support) = (&segments[0].start, setup.path.at(configuration.tau()));
        let mut chain = Self::at_rest(setup.rod.model(), &setup.clamp(tau), 0.0);
        let displacement = [base.x - support.x, base.y - support.y, base.phi - support.phi];
        for (given, spring) in chain.given.iter_mut().zip(&chain.springs) {
            *given = spring.along(displacement);
        }
        let mut before = base.phi;
        if let Some(Root { turn, at, lean, .. }) = &chain.root {
            let turned = rod::along(setup.rod.model(), &segments, *at).phi - support.phi - lean;
            chain.given = [turned / turn, 0.0, 0.0];
            before += turned;
        }
        let joints = std::array::from_fn(|i| {
            // up to a roller it is as at rest
            let is_root = chain.root.as_ref().is_some_and(|root| root.leads(i));
            let here = if is_root {
                before + chain.rest[i]
            } else {
                rod::along(setup.rod.model(), &segments, (i as f64 + 0.5) * LINK).phi
            };
            let joint = here - before;
            before = here;
            joint
        });
        Self { joints, ..chain }
    }

    /// Where the base is.
    fn base(&self) -> Pose {
        let Pose { mut x, mut y, mut phi } = self.clamp;
        for (Spring { way, .. }, given) in self.springs.iter().zip(self.given) {
            (x, y, phi) = (x + given * way[0], y + given * way[1], phi + given * way[2]);
        }
        Pose { x, y, phi }
    }

    /// Bends a straight chain (radians over its length): else it could not buckle.
    pub fn bend_if_straight(&mut self, bend: f64) {
        if self.joints.iter().all(|joint| joint.abs() < STRAIGHT) {
            self.joints = [bend * LINK; LINKS];
        }
    }

    /// Where it is.
    fn place(&self) -> Place {
        let Pose { x, y, mut phi } = self.base();
        let (mut nodes, mut angles) = ([[x, y]; LINKS + 1], [0.0; LINKS]);
        for i in 0..LINKS {
            phi += self.joints[i];
            angles[i] = phi;
            let (sin, cos) = phi.sin_cos();
            nodes[i + 1] = [nodes[i][0] + LINK * cos, nodes[i][1] + LINK * sin];
        }
        Place { nodes, angles }
    }

    /// One implicit step under the gaps smaller than `reach`, of at most `time_step`, with the `room` of each node. None where the programme failed.
    fn step(
        &mut self,
        world: &World<'_>,
        (place, room): (&Place, &mut [f64; LINKS]),
        time_step: f64,
        (reach, horizon): (f64, f64),
        work: &mut f64,
    ) -> Option<Taken> {
        let near = near(world, place, room, (reach, horizon));
        let (mut time_step, mut push) = (time_step, DEEPEST_PUSH);
        loop {
            let mut programme = Programme::new(self, &place.nodes, &near, time_step, push);
            let (change, forces) = match solve(&programme, work) {
                Some(solved) => solved,
                None => {
                    programme.yielding = YIELDING;
                    solve(&programme, work)?
                }
            };
            let mut moved = self.clone();
            moved.joints.iter_mut().zip(change.joints).for_each(|(joint, change)| *joint += change);
            moved.given.iter_mut().zip(change.base).for_each(|(given, change)| *given += change);
            let after = moved.place();
            let ways: [f64; LINKS] = std::array::from_fn(|i| {
                let [[x, y], [after_x, after_y]] = [place.nodes[i + 1], after.nodes[i + 1]];
                ((after_x - x).powi(2) + (after_y - y).powi(2)).sqrt()
            });
            // a node goes no further than its linearised gaps hold, or than to where what was not near could be met
            let shares = ways.iter().zip(&*room).map(|(way, room)| way / (0.75 * reach).max(room - LINK));
            let share = shares.fold(0.0, f64::max);
            if share <= 1.0 || time_step < 1e-4 {
                room.iter_mut().zip(ways).for_each(|(room, way)| *room -= way);
                *self = moved;
                let way = ways.into_iter().fold(0.0, f64::max);
                return Some(Taken {
                    way,
                    share,
                    time_step,
                    place: after,
                    forces: near.into_iter().zip(forces).collect(),
                });
            }
            if reach < REACH {
                return self.step(world, (place, room), time_step, (REACH, horizon), work);
            }
            time_step = time_step_of(share_gone(time_step) * (AIM / share).min(0.5));
            push *= 0.5;
        }
    }

    /// Lets the chain come to rest, and gives the contacts it then has as guesses for the boundary-value problem at
    /// `tau`, the likeliest first. What is pressed all along a few links is one contact, or, on a contour that follows
    /// the rod, one at either end.
    pub fn settle(&mut self, world: &World<'_>, tau: f64) -> SmallVec<[Configuration; 2]> {
        let Some(forces) = self.come_to_rest(world) else { return SmallVec::new() };
        let clusters = clusters(forces);
        let mut guesses = smallvec![contacts(self, world, &clusters, tau)];
        if clusters.iter().any(Cluster::is_wide) {
            let parted: Vec<_> = clusters.iter().flat_map(Cluster::ends).collect();
            guesses.push(contacts(self, world, &parted, tau));
        }
        guesses
    }

    /// The force at each near node of the chain come to rest, or where it is after the last step: it has swung, and moves slowly by then.
    fn come_to_rest(&mut self, world: &World<'_>) -> Option<Vec<(Near, f64)>> {
        let (mut time_step, mut reach, mut work) = (TIME_STEP, REACH, MOST_WORK);
        let (mut longest, mut last) = (LONGEST_TIME_STEP, None);
        let (mut here, mut room, mut horizon) = (self.place(), [0.0; LINKS], HORIZON);
        for taken in 0..MOST_STEPS {
            let Taken { way, share, time_step: accepted, place, forces } =
                self.step(world, (&here, &mut room), time_step, (reach, horizon), &mut work)?;
            here = place;
            // what a slow chain cannot get to costs it nothing
            reach = (8.0 * way).clamp(0.25 * REACH, REACH);
            // in free flight it goes as far as there is room
            horizon = if forces.iter().all(|(_, force)| *force == 0.0) { FAR } else { HORIZON };
            let inside = forces.iter().any(|(near, _)| near.gap < -0.5 * LINK);
            if way < ARRIVED && !inside {
                return Some(forces);
            }
            if way >= 0.25 * LONGEST_MOVE && taken > PATIENCE {
                longest = 0.5 * accepted;
            }
            // the share of the rest of its way at which the next step would be as long as it may
            time_step = time_step_of(accepted * AIM / share).min(longest);
            last = Some(forces);
        }
        last
    }
}
