//! Where a rod comes to rest: overdamped descent of the bending energy under unilateral contact.
//!
//! The rod is a chain of rigid links with a spring in each joint (inextensible by construction). Each step is implicit: it
//! minimises the energy after the step plus the distance gone, in the metric of the springs (a rod with internal,
//! Kelvin-Voigt damping), under the linearised gaps of all nodes and of corners to links, which is a small quadratic programme. The result is good to
//! the square of a link's length: enough to see which contacts there are.

use crate::configuration::{Configuration, Held, lying};
use crate::corner::Corner;
use crate::notch::into_notch;
use crate::path::ClampPath;
use crate::world::World;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use rod_contours::{Bounds, StretchKind};
use rod_core::{Hold, Pose, Section, advance};
use smallvec::{SmallVec, smallvec};

/// Number of links.
const LINKS: usize = 64;
/// Length of a link.
const LINK: f64 = 1.0 / LINKS as f64;
/// Longest way of a node in one step: gaps are taken to be linear over it.
const LONGEST_MOVE: f64 = 0.04;
/// Gaps beyond this are out of reach of the longest step.
const REACH: f64 = 2.0 * LONGEST_MOVE;
/// A step that moves no node further than this has arrived.
const ARRIVED: f64 = 2e-5;
/// Most steps.
const MOST_STEPS: usize = 400;
/// Time step over the damping time: the unconstrained shape loses half of its bend in a step of 1.
const TIME_STEP: f64 = 1.0;
/// Forces below this are what a chain that has all but arrived leaves.
const LEAST_FORCE: f64 = 1e-4;
/// Length, in links, of what is pressed all along and may be two contacts.
const WIDE: f64 = 1.5;
/// Deepest penetration taken back in one step.
const DEEPEST_PUSH: f64 = 0.03;

/// How far walls give way to a unit of force where they leave the chain no other way.
const YIELDING: f64 = 1e-5;

/// A chain of links in the contour's world.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub clamp: Pose,
    /// Turning angle of each joint; the first is between clamp and first link.
    joints: [f64; LINKS],
}

/// A point of the chain near the contour: a node, or the point of a link that is next to a corner.
struct Near {
    /// Arc length, in links.
    s: f64,
    /// The point.
    x: f64,
    y: f64,
    stretch: usize,
    gap: f64,
    alpha: f64,
}

impl Chain {
    /// A straight chain, but for the slight bend (radians over its length) without which it could not buckle.
    pub fn straight(clamp: Pose, bend: f64) -> Self {
        Self { clamp, joints: [bend * LINK; LINKS] }
    }

    /// The shape of the rod in `configuration`, on another clamp.
    pub fn of(world: &World<'_>, path: &ClampPath, configuration: &Configuration, clamp: Pose) -> Self {
        let spans = configuration.spans(world, path);
        let phi = |s: f64| {
            let span = spans[spans.partition_point(|span| span.s <= s).saturating_sub(1)];
            advance(&span.start, span.a, span.b, s - span.s).phi
        };
        let mut before = path.at(configuration.tau()).phi;
        let joints = std::array::from_fn(|i| {
            let here = phi((i as f64 + 0.5) * LINK);
            let joint = here - before;
            before = here;
            joint
        });
        Self { clamp, joints }
    }

    /// Stiffness of a joint: a full link between two links, half a link between clamp and first one.
    fn stiffness(i: usize) -> f64 {
        if i == 0 { 2.0 / LINK } else { 1.0 / LINK }
    }

    /// Ends of the links, the clamp first, and the angle of each link.
    fn nodes(&self) -> ([[f64; 2]; LINKS + 1], [f64; LINKS]) {
        let (mut nodes, mut angles) = ([[self.clamp.x, self.clamp.y]; LINKS + 1], [0.0; LINKS]);
        let mut phi = self.clamp.phi;
        for i in 0..LINKS {
            phi += self.joints[i];
            angles[i] = phi;
            let (sin, cos) = phi.sin_cos();
            nodes[i + 1] = [nodes[i][0] + LINK * cos, nodes[i][1] + LINK * sin];
        }
        (nodes, angles)
    }

    /// What could meet the contour within a step: nodes, and links at corners.
    fn near(&self, world: &World<'_>, nodes: &[[f64; 2]; LINKS + 1], angles: &[f64; LINKS], reach: f64) -> Vec<Near> {
        let mut near = Vec::new();
        for (node, &[x, y]) in nodes.iter().enumerate().skip(1) {
            world.parts_near(Bounds::EMPTY.with(x, y).grown(REACH), |part| {
                let stretch = part.stretch;
                let at = |gap, alpha| Near { s: node as f64, x, y, stretch, gap, alpha };
                match world.kind(stretch) {
                    // what holds the tip in a notch are the two pieces that end there
                    StretchKind::Notch { .. } => {}
                    StretchKind::Corner { .. } => {
                        let start =
                            Section { x: nodes[node - 1][0], y: nodes[node - 1][1], phi: angles[node - 1], kappa: 0.0 };
                        near.extend(at_corner(world, stretch, node - 1, &start, reach));
                    }
                    StretchKind::Piece(_) => {
                        let foot = world.foot_in(part, x, y);
                        if foot.gap > reach || foot.gap < -REACH {
                        } else if world.ends_in_notch(stretch, &foot) {
                            // beyond its end a piece goes on as its tangent
                            let gap = (x - foot.x) * foot.alpha.sin() - (y - foot.y) * foot.alpha.cos();
                            near.push(at(gap, foot.alpha));
                        } else if foot.interior && (foot.gap >= -1e-9 || world.goes_through(stretch, &foot, x, y)) {
                            near.push(at(foot.gap, foot.alpha));
                        }
                    }
                }
            });
        }
        near
    }

    /// One implicit step under the gaps smaller than `reach`: how far it moved the chain, and the force at each near node.
    /// None where the programme failed.
    fn step(&mut self, world: &World<'_>, time_step: f64, reach: f64) -> Option<(f64, Vec<(Near, f64)>)> {
        let (nodes, angles) = self.nodes();
        let near = self.near(world, &nodes, &angles, reach);
        let (mut time_step, mut push) = (time_step, DEEPEST_PUSH);
        loop {
            let solved = programme(self, &nodes, &near, time_step, push, 0.0);
            let (change, forces) = solved.or_else(|| programme(self, &nodes, &near, time_step, push, YIELDING))?;
            let mut moved = self.clone();
            for (joint, change) in moved.joints.iter_mut().zip(&change) {
                *joint += change;
            }
            let (after, _) = moved.nodes();
            let way = nodes.iter().zip(&after).map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1])).fold(0.0, f64::max);
            if way <= 0.75 * reach || time_step < 1e-4 {
                *self = moved;
                return Some((way, near.into_iter().zip(forces).collect()));
            }
            if reach < REACH {
                return self.step(world, time_step, REACH);
            }
            time_step *= (LONGEST_MOVE / way).min(0.5);
            push *= 0.5;
        }
    }

    /// Lets the chain come to rest, and gives the contacts it then has as guesses for the boundary-value problem at `tau`, the
    /// likeliest first. What is pressed all along a few links is one contact, or, on a contour that follows the rod, one at
    /// either end.
    pub fn settle(&mut self, world: &World<'_>, tau: f64) -> SmallVec<[Configuration; 2]> {
        let Some(forces) = self.come_to_rest(world) else { return SmallVec::new() };
        let clusters = clusters(forces);
        let mut guesses = smallvec![self.contacts(world, &clusters, tau)];
        if clusters.iter().any(Cluster::is_wide) {
            let parted: Vec<_> = clusters.iter().flat_map(Cluster::ends).collect();
            guesses.push(self.contacts(world, &parted, tau));
        }
        guesses
    }

    /// The force at each near node of the chain come to rest.
    fn come_to_rest(&mut self, world: &World<'_>) -> Option<Vec<(Near, f64)>> {
        let (mut time_step, mut reach) = (TIME_STEP, REACH);
        for _ in 0..MOST_STEPS {
            let (way, forces) = self.step(world, time_step, reach)?;
            // what a slow chain cannot get to costs it nothing
            reach = (8.0 * way).clamp(0.25 * REACH, REACH);
            let inside = forces.iter().any(|(near, _)| near.gap < -0.5 * LINK);
            if way < ARRIVED && !inside {
                return Some(forces);
            }
            // slow motion is far from everything that could be missed
            if way < 0.25 * LONGEST_MOVE {
                time_step = (2.0 * time_step).min(1e3);
            }
        }
        None
    }

    /// Clusters as contacts.
    fn contacts(&self, world: &World<'_>, clusters: &[Cluster], tau: f64) -> Configuration {
        let (nodes, angles) = self.nodes();
        let mut configuration = Configuration::free(tau);
        for &Cluster { stretch, force, moment, .. } in clusters {
            let middle = moment / force;
            let node = (middle.round() as usize).clamp(1, LINKS);
            let [x, y] = nodes[node];
            let foot = world.foot(stretch, x, y);
            let tip = middle > LINKS as f64 - 0.75 && !world.is_corner(stretch);
            let phi = if node < LINKS { 0.5 * (angles[node - 1] + angles[node]) } else { angles[LINKS - 1] };
            let on_corner = world.is_corner(stretch).then(|| Corner::new(world, stretch));
            let lies = on_corner.and_then(|corner| corner.passing(&Section { x, y, phi, kappa: 0.0 }));
            let (t, alpha) = lies.map_or((foot.t, foot.alpha), |passing| (passing.t, passing.alpha));
            let (hold, third) = if tip { (Hold::Tip, phi) } else { (lying(phi - alpha), middle * LINK) };
            let j = configuration.count();
            if j > 0 && configuration.ends_at_tip() {
                into_notch(world, &mut configuration, stretch, foot.alpha, force);
                continue;
            }
            configuration.insert(j, Held { stretch, hold }, [t, force, third]);
        }
        configuration
    }
}

/// Loaded neighbouring nodes on one stretch.
#[derive(Clone, Copy)]
struct Cluster {
    stretch: usize,
    force: f64,
    /// Sum of force times arc length, in links.
    moment: f64,
    /// Arc lengths of the first and the last of them, in links.
    from: f64,
    to: f64,
}

impl Cluster {
    fn is_wide(&self) -> bool {
        self.to - self.from > WIDE
    }

    /// The two forces at its ends that are worth as much; the cluster itself where it is not wide.
    fn ends(&self) -> SmallVec<[Self; 2]> {
        if !self.is_wide() {
            return smallvec![*self];
        }
        let last = (self.moment - self.force * self.from) / (self.to - self.from);
        let end = |s: f64, force: f64| Self { force, moment: force * s, from: s, to: s, ..*self };
        smallvec![end(self.from, self.force - last), end(self.to, last)]
    }
}

/// Clusters of loaded neighbouring nodes, along the chain.
fn clusters(mut forces: Vec<(Near, f64)>) -> Vec<Cluster> {
    forces.retain(|(_, force)| *force > LEAST_FORCE);
    forces.sort_by(|(a, _), (b, _)| a.s.total_cmp(&b.s).then(a.stretch.cmp(&b.stretch)));
    let mut clusters: Vec<Cluster> = Vec::new();
    for (Near { s, stretch, .. }, force) in forces {
        let moment = force * s;
        match clusters.iter_mut().rev().find(|c| c.stretch == stretch && s - c.to < 1.5) {
            Some(cluster) => {
                cluster.force += force;
                cluster.moment += moment;
                cluster.to = s;
            }
            None => clusters.push(Cluster { stretch, force, moment, from: s, to: s }),
        }
    }
    clusters
}

/// A link (its number, and where it starts) next to a corner that it may come to lie on.
fn at_corner(world: &World<'_>, stretch: usize, link: usize, start: &Section, reach: f64) -> Option<Near> {
    let corner = Corner::new(world, stretch);
    let (sin, cos) = start.phi.sin_cos();
    let way = (corner.x - start.x) * cos + (corner.y - start.y) * sin;
    if !(0.0..LINK).contains(&way) {
        return None;
    }
    let at = Section { x: start.x + way * cos, y: start.y + way * sin, ..*start };
    let passing = corner.passing(&at).filter(|passing| passing.gap.abs() <= reach)?;
    let s = link as f64 + way / LINK;
    let rest = (s * LINK, (LINKS as f64 - s) * LINK);
    (passing.gap >= -1e-9 || corner.is_cut(world, &at, &passing, rest)).then_some(Near {
        s,
        x: at.x,
        y: at.y,
        stretch,
        gap: passing.gap,
        alpha: passing.alpha,
    })
}

/// The quadratic programme of one step: change d of the joints, force at each near node.
///
/// It is minimise 1/2 d' D d + q' d subject to A d <= b with a diagonal D, solved by its dual in the forces, which are few:
/// minimise 1/2 f' (A D^-1 A') f + (b + A D^-1 q)' f over f >= 0, then d = -D^-1 (q + A' f). Walls between which, linearised,
/// there is no room are let give way by `yielding` a unit of force: A d <= b + yielding f.
fn programme(
    chain: &Chain,
    nodes: &[[f64; 2]; LINKS + 1],
    near: &[Near],
    time_step: f64,
    push: f64,
    yielding: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let damped = 1.0 + 1.0 / time_step;
    let softness = |i: usize| 1.0 / (Chain::stiffness(i) * damped);
    // D^-1 q: every joint gives way by the same share
    let mut change: Vec<f64> = chain.joints.iter().map(|joint| -joint / damped).collect();
    if near.is_empty() {
        return Some((change, Vec::new()));
    }
    // by joint i node turns as (dx, dy) -> (-dy, dx); the gap falls along the normal (-sin, cos)
    let gradient = |&Near { s, x, y, alpha, .. }: &Near| -> [f64; LINKS] {
        let (sin, cos) = alpha.sin_cos();
        std::array::from_fn(|i| if (i as f64) < s { (y - nodes[i][1]) * sin + (x - nodes[i][0]) * cos } else { 0.0 })
    };
    let rows: Vec<[f64; LINKS]> = near.iter().map(gradient).collect();
    let m = near.len();
    let (mut columns, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
    for (j, right) in rows.iter().enumerate() {
        for (i, left) in rows.iter().enumerate().take(j + 1) {
            indices.push(i);
            let given = if i == j { yielding } else { 0.0 };
            values.push(given + (0..LINKS).map(|k| left[k] * right[k] * softness(k)).sum::<f64>());
        }
        columns.push(indices.len());
    }
    let quadratic = CscMatrix::new(m, m, columns, indices, values);
    let linear: Vec<f64> = near
        .iter()
        .zip(&rows)
        .map(|(near, row)| {
            let unforced: f64 = row.iter().zip(&change).map(|(a, d)| a * d).sum();
            near.gap.max(-push) - unforced
        })
        .collect();
    let pushing = CscMatrix::new(m, m, (0..=m).collect(), (0..m).collect(), vec![-1.0; m]);
    let settings = DefaultSettingsBuilder::default().verbose(false).presolve_enable(false).max_iter(60).build().ok()?;
    let cones = [NonnegativeConeT(m)];
    let mut solver = DefaultSolver::new(&quadratic, &linear, &pushing, &vec![0.0; m], &cones, settings).ok()?;
    solver.solve();
    if !matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return None;
    }
    let forces = solver.solution.x.clone();
    for (row, force) in rows.iter().zip(&forces) {
        for (i, d) in change.iter_mut().enumerate() {
            *d -= softness(i) * row[i] * force;
        }
    }
    Some((change, forces))
}
