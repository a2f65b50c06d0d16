//! Whether an equilibrium is stable: the second variation of the bending energy under the contacts.
//!
//! For a variation eta of the slope angle that keeps every contact closed to first order, and of the base along its springs (eta(0) = 0
//! and no other way on a rigid clamp),
//!
//! ```text
//! Q = int_0^1 EI eta'^2 - (A sin phi - B cos phi) eta^2 ds  -  sum_j f_j g_j  +  sum_k p_k^2 / softness_k
//! ```
//!
//! where (A, B) is the force on the segment and g_j the second-order change of gap j: k u^2 at the tip, and
//! (2 w eta u - w kappa' u^2 - v eta^2) / (w - v kappa') where the rod is tangential, with u the shift of the rod's point
//! along the contour, kappa' the rod's curvature in the contour's sense, k = w / v the contour's curvature (dr/dt = v,
//! d alpha/dt = w). Where the straight end of the rod lies on a straight edge (w = kappa' = 0) g_j is of the order
//! -|eta|^(3/2), so that eta is held. p_k is the way of the base along its spring k. The equilibrium is stable if Q > 0 for all such
//! eta and p. eta is expanded in the first modes of a free cantilever and the turn of the base, the constraints enter by a large penalty, and Q is positive exactly if its matrix has a
//! Cholesky factor. A [`roller`] holds the rod like a vertex that it slides over, v = 0, with a force of either sign.
//! With friction the contacts are held along the contour too (u = 0): the energy of a rod that sticks. Then friction must
//! also resist slips (`friction::resists`). Mostly that is not needed: [`condensed`] proves it from the derivatives of the segments, and where it does
//! not, the modes decide.

mod condensed;
mod roller;

use crate::contact_set::Configuration;
use crate::friction::{UNLOADED, resists};
use crate::gap::shape::{Node, Shape};
use crate::scene::Setup;
use crate::scene::rod::{Segment, curvature_behind};
use crate::scene::springs::{Spring, springs};
use nalgebra::{DMatrix, SMatrix};
use rod_core::{Clamp, Cut, Grip, Hold, PhysicalRod, RodModel, Station, Support, Supports};
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Number of modes beyond those that the contacts fix. Mode m has an energy of about (m pi)^2 / 2: a mode that is left out is
/// unstable only under loads of hundreds of E I / L^2.
const MODES: usize = 6;
/// Stiffness of the penalty that keeps contacts closed, over that of the modes. A rod that is soft somewhere has soft modes: with the same
/// penalty for all, rounding would hide them.
const PENALTY: f64 = 1e9;

/// Square of the way (L per rad) by which the modes move a contact across the contour, below which the penalty grows no more. A nearly
/// straight rod, pressed along its axis, moves across by little: with the same penalty for all, it would give way. Below the limit
/// the way is one of rounding.
const LEAST_WAY: f64 = 1e-6;

/// Most that the phase of the modes grows over two intervals of Simpson's rule, rad: as much as on a uniform rod of 28 intervals.
const MOST_PHASE: f64 = 2.0 * PI / 28.0;
/// Halvings of two intervals at most: enough for a tip that is 1e8 times as soft as the clamp.
const MOST_HALVINGS: u32 = 24;

/// Curvature (1 / L) of a rod on a straight edge by rounding, with a condition number of 1e7.
const FLAT: f64 = 1e-9;

/// Arc length (L) behind a contact up to which a rod that is straight there must be straight at rest.
const BESIDE: f64 = 1e-3;

/// Number of points of the rod whose recurrences run at once.
const LANES: usize = 4;
/// One number a lane.
type Lanes = [f64; LANES];

/// Judges stability, in memory that is used again.
#[derive(Debug, Default)]
pub(crate) struct Judge {
    integrals: Integrals,
    quadratic: Quadratic,
    /// How far each mode moves the rod at a contact, along the contour and across it, and turns it.
    along: Vec<f64>,
    across: Vec<f64>,
    eta: Vec<f64>,
}

impl Judge {
    /// Whether the second variation is positive definite. `shape` is that of the rod in `configuration`.
    pub fn is_stable<R: PhysicalRod>(
        &mut self,
        setup: &Setup<'_, R>,
        configuration: &Configuration,
        shape: &Shape,
    ) -> bool {
        // without a force the second variation is that of the bending energy alone
        if (0..configuration.count()).all(|j| configuration.force(j).abs() < UNLOADED) {
            return true;
        }
        let is_positive = condensed::is_positive(setup, configuration, shape)
            || self.is_positive_by_modes(setup, configuration, shape);
        // with friction that of a rod whose contacts all stick, and friction that lets those that slip move in one way only
        is_positive && (!configuration.rubs() || resists(setup, configuration))
    }

    /// The same by the modes alone.
    fn is_positive_by_modes<R: PhysicalRod>(
        &mut self,
        setup: &Setup<'_, R>,
        configuration: &Configuration,
        shape: &Shape,
    ) -> bool {
        let (rod, world) = (setup.rod.model(), &setup.world);
        let n = configuration.count();
        let Self { integrals, quadratic: q, along, across, eta } = self;
        let shape = &shape.refine(rod);
        let springs = springs(setup.clamp(configuration.tau()).law());
        let lead = shape.lead();
        let modes = MODES + 2 * (n + lead);
        let end = configuration.s(n - 1);
        let turns = Turns::new(rod, end, !springs.is_empty());
        let penalty = PENALTY * (end / turns.softness);
        q.reset(modes + springs.len(), |m| match m.checked_sub(modes) {
            None => 0.5 / turns.softness * ((m as f64 + 0.5) * PI).powi(2),
            Some(k) => 1.0 / springs[k].softness,
        });
        integrals.reset(modes);
        let supports = configuration.supports(world);
        for i in 0..lead + n {
            let Segment { a, b, .. } = shape.segments[i];
            match turns.scale {
                Some(scale) => integrals.add(shape.along(i), (a, b), scale),
                None => integrals.add_at(rod, shape.along(i), (a, b), &turns),
            }
            let (support, form, s) = match i.checked_sub(lead) {
                None => (roller::support(shape), roller::form(rod, shape), shape.segments[1].s),
                Some(j) => {
                    let support = supports.support(j, configuration.t(j));
                    (support, form(rod, configuration, shape, (j, penalty), &support), configuration.s(j))
                }
            };
            integrals.shifts(support.alpha.sin_cos(), along, across);
            push_shifts(&springs, shape, &support, along, across);
            let form = match form {
                Form::Moves(form) => form,
                Form::Held => [penalty, 0.0, 0.0],
                Form::Flat => [0.0, 0.0, penalty],
                Form::Slips => return false,
            };
            modes_at(turns.phase(rod, s), modes, eta);
            eta.extend(springs.iter().map(|spring| spring.way[2]));
            q.add(form, along, eta);
            let held = |ways: &[f64]| penalty / ways.iter().map(|way| way * way).sum::<f64>().clamp(LEAST_WAY, 1.0);
            q.add([held(across), 0.0, 0.0], across, eta);
            if i.checked_sub(lead).is_some_and(|j| configuration.contacts[j].grip != Grip::SMOOTH) {
                q.add([held(along), 0.0, 0.0], along, eta);
            }
        }
        q.add_load(modes, &integrals.moments);
        q.add_load_of_base(modes, &springs, integrals);
        q.is_positive()
    }
}

/// The phase of the modes along the rod, from 0 at the clamp to pi at the last contact: it grows as the rod turns under a constant
/// moment, x = pi int_0^s ds / EI / int_0^end ds / EI. So the modes sin((m + 1/2) x) are orthogonal in the bending energy of any rod, and
/// finest where it is soft.
struct Turns {
    /// int ds / EI from the clamp to the last contact.
    softness: f64,
    /// x / s of a uniform rod.
    scale: Option<f64>,
}

impl Turns {
    /// Up to the last contact, at `end`; `at_nodes`: with the phase of each node, not by recurrences.
    fn new(rod: &impl RodModel, end: f64, at_nodes: bool) -> Self {
        if rod.is_uniform() && !at_nodes {
            return Self { softness: end, scale: Some(PI / end) };
        }
        Self { softness: softness(rod, 0.0, end), scale: None }
    }

    fn phase(&self, rod: &impl RodModel, s: f64) -> f64 {
        self.scale.map_or_else(|| self.on(rod, 0.0, s), |scale| scale * s)
    }

    /// How much it grows between two places.
    fn on(&self, rod: &impl RodModel, from: f64, to: f64) -> f64 {
        PI * softness(rod, from, to) / self.softness
    }
}

/// int ds / EI between two places: by how much more the rod turns under a moment than at rest. Under a moment of 1 a thin tip would be wound
/// up; under that of its least stiffness the rod turns by 1 rad at most.
fn softness(rod: &impl RodModel, from: f64, to: f64) -> f64 {
    let turned = |moment: f64| rod.carry(from, &Cut { x: 0.0, y: 0.0, phi: 0.0, moment }, 0.0, 0.0, to - from).phi;
    let moment = rod.least_stiffness(from, to);
    (turned(moment) - turned(0.0)) / moment
}

/// Appends how far the springs of the base move the rod at a contact, along the contour and across it.
fn push_shifts(springs: &[Spring], shape: &Shape, support: &Support, along: &mut Vec<f64>, across: &mut Vec<f64>) {
    let (sin, cos) = support.alpha.sin_cos();
    let start = &shape.segments[0].start;
    for Spring { way: [x, y, phi], .. } in springs {
        let (x, y) = (x - phi * (support.y - start.y), y + phi * (support.x - start.x));
        along.push(cos * x + sin * y);
        across.push(cos * y - sin * x);
    }
}

/// The second-order change of a contact's gap, times its force: the form of the shift u along the contour and the turn eta.
enum Form {
    /// Its coefficients of u^2, 2 u eta and eta^2.
    Moves([f64; 3]),
    /// In a notch, from both sides: u = 0.
    Held,
    /// The end of a straight rod on a straight edge: eta = 0.
    Flat,
    /// The tip on a convex vertex, or a rod as curved as the contour: not stable.
    Slips,
}

fn form(
    rod: &impl RodModel,
    configuration: &Configuration,
    shape: &Shape,
    (j, penalty): (usize, f64),
    support: &Support,
) -> Form {
    let (v, w, f) = (support.speed, support.turning, configuration.force(j));
    match configuration.contacts[j].hold {
        Hold::Tip if v == 0.0 && w < 0.0 => Form::Held,
        Hold::Tip if v == 0.0 => Form::Slips,
        Hold::Tip => Form::Moves([-f * w / v, 0.0, 0.0]),
        Hold::Tangent { offset } => {
            let kappa = offset.cos() * curvature_behind(rod, &shape.segments, (j, configuration.count()));
            let divisor = w - v * kappa;
            if w == 0.0 && is_straight(rod, configuration, (j, kappa)) {
                Form::Flat
            } else if divisor > 0.0 {
                let scale = f / divisor;
                Form::Moves([scale * w * kappa, -scale * w, (scale * v).min(penalty)])
            } else {
                Form::Slips
            }
        }
    }
}

/// A symmetric matrix.
#[derive(Debug, Default)]
struct Quadratic {
    size: usize,
    entries: Vec<f64>,
}

impl Quadratic {
    fn reset(&mut self, size: usize, diagonal: impl Fn(usize) -> f64) {
        self.size = size;
        self.entries.clear();
        self.entries.resize(size * size, 0.0);
        for (i, row) in self.rows() {
            row[i] = diagonal(i);
        }
    }

    fn rows(&mut self) -> impl Iterator<Item = (usize, &mut [f64])> {
        self.entries.chunks_exact_mut(self.size).enumerate()
    }

    /// Adds uu u^2 + 2 uv u v + vv v^2.
    fn add(&mut self, [uu, uv, vv]: [f64; 3], u: &[f64], v: &[f64]) {
        for (i, row) in self.rows() {
            let (by_u, by_v) = (uu * u[i] + uv * v[i], uv * u[i] + vv * v[i]);
            for ((entry, u), v) in row.iter_mut().zip(u).zip(v) {
                *entry += by_u * u + by_v * v;
            }
        }
    }

    /// Adds the load on the modes by its cosine moments: sin((m + 1/2) x) sin((n + 1/2) x) is half of
    /// cos((m - n) x) - cos((m + n + 1) x).
    fn add_load(&mut self, modes: usize, moments: &[Lanes]) {
        let moments: SmallVec<[f64; 64]> = moments.iter().map(|lanes| lanes.iter().sum()).collect();
        for (i, row) in self.rows().take(modes) {
            for (j, (entry, after)) in row[..modes].iter_mut().zip(&moments[i + 1..]).enumerate() {
                *entry += moments[i.abs_diff(j)] - after;
            }
        }
    }

    /// Adds the load on the turn of the base, which is one of the whole rod.
    fn add_load_of_base(&mut self, modes: usize, springs: &[Spring], integrals: &Integrals) {
        let size = self.size;
        for (k, spring) in springs.iter().enumerate() {
            let (row, turn) = (modes + k, spring.way[2]);
            for (m, load) in integrals.turned.iter().enumerate() {
                self.entries[row * size + m] += turn * load;
                self.entries[m * size + row] += turn * load;
            }
            for (l, other) in springs.iter().enumerate() {
                self.entries[row * size + modes + l] += turn * other.way[2] * integrals.load;
            }
        }
    }

    /// Whether there is a Cholesky factor. The usual sizes take no memory.
    fn is_positive(&self) -> bool {
        let Self { size, entries } = self;
        match size {
            8 => SMatrix::<f64, 8, 8>::from_column_slice(entries).cholesky().is_some(),
            10 => SMatrix::<f64, 10, 10>::from_column_slice(entries).cholesky().is_some(),
            12 => SMatrix::<f64, 12, 12>::from_column_slice(entries).cholesky().is_some(),
            _ => DMatrix::from_column_slice(*size, *size, entries).cholesky().is_some(),
        }
    }
}

/// The modes sin((m + 1/2) x), by the recurrence of Chebyshev.
fn modes_at(x: f64, size: usize, modes: &mut Vec<f64>) {
    let (sin, cos) = (0.5 * x).sin_cos();
    let twice_cos = 2.0 * (cos * cos - sin * sin);
    let (mut before, mut here) = (-sin, sin);
    let next = |_| {
        let mode = here;
        (before, here) = (here, twice_cos * here - before);
        mode
    };
    modes.clear();
    modes.extend((0..size).map(next));
}

/// A point of the rod, and the phase of the modes there.
#[derive(Clone, Copy)]
struct Point {
    s: f64,
    x: f64,
    at: Station,
}

impl Point {
    /// One that comes after it.
    fn to(&self, rod: &impl RodModel, turns: &Turns, s: f64, at: Station) -> Self {
        let x = turns.scale.map_or_else(|| self.x + turns.on(rod, self.s, s), |scale| scale * s);
        Self { s, x, at }
    }
}

/// What is integrated along the rod for the modes eta_m = sin((m + 1/2) x), by Simpson's rule, lane by lane.
#[derive(Debug, Default)]
struct Integrals {
    /// int (-sin phi, cos phi) eta_m ds from the clamp on: how far mode m moves the rod's points.
    shifts: Vec<[Lanes; 2]>,
    /// int -(A sin phi - B cos phi) cos(m x) ds / 2.
    moments: Vec<Lanes>,
    /// The same with eta_m, and with 1, in place of cos(m x) / 2: of [`add_at`](Self::add_at) alone.
    turned: Vec<f64>,
    load: f64,
}

impl Integrals {
    fn reset(&mut self, size: usize) {
        let zero = [0.0; LANES];
        self.shifts.clear();
        self.shifts.resize(size, [zero; 2]);
        self.moments.clear();
        self.moments.resize(2 * size, zero);
        self.turned.clear();
        self.turned.resize(size, 0.0);
        self.load = 0.0;
    }

    /// Goes on along the `nodes` of a segment under the force (A, B), with any phase: where it grows fast, as at a soft tip, with points in
    /// between.
    fn add_at(&mut self, rod: &impl RodModel, nodes: &[Node], force: (f64, f64), turns: &Turns) {
        let [first, rest @ ..] = nodes else { return };
        let mut modes = Vec::new();
        let mut left = Point { s: first.s, x: turns.phase(rod, first.s), at: first.at };
        for pair in rest.chunks_exact(2) {
            let after = |before: &Point, node: &Node| before.to(rod, turns, node.s, node.at);
            let middle = after(&left, &pair[0]);
            let last = after(&middle, &pair[1]);
            self.add_panel(rod, [left, middle, last], force, (turns, MOST_HALVINGS), &mut modes);
            left = last;
        }
    }

    /// Two equal intervals by Simpson's rule, or by halves where the phase grows too much along them.
    fn add_panel(
        &mut self,
        rod: &impl RodModel,
        panel: [Point; 3],
        (a, b): (f64, f64),
        (turns, halvings): (&Turns, u32),
        modes: &mut Vec<f64>,
    ) {
        let [first, middle, last] = panel;
        if last.x - first.x > MOST_PHASE && halvings > 0 {
            let quarter = |from: Point, to: Point| {
                let s = 0.5 * (from.s + to.s);
                let Station { x, y, cos, sin, moment } = from.at;
                let start = Cut { x, y, phi: sin.atan2(cos), moment };
                from.to(rod, turns, s, Station::from(&rod.carry(from.s, &start, a, b, s - from.s)))
            };
            let [before, after] = [quarter(first, middle), quarter(middle, last)];
            self.add_panel(rod, [first, before, middle], (a, b), (turns, halvings - 1), modes);
            self.add_panel(rod, [middle, after, last], (a, b), (turns, halvings - 1), modes);
            return;
        }
        let third = (last.s - first.s) / 6.0;
        for (Point { x, at, .. }, times) in panel.into_iter().zip([1.0, 4.0, 1.0]) {
            let weight = times * third;
            modes_at(x, self.shifts.len(), modes);
            for ([by_x, by_y], mode) in self.shifts.iter_mut().zip(&*modes) {
                by_x[0] -= weight * at.sin * mode;
                by_y[0] += weight * at.cos * mode;
            }
            let load = weight * (b * at.cos - a * at.sin);
            for (m, moment) in self.moments.iter_mut().enumerate() {
                moment[0] += 0.5 * load * (m as f64 * x).cos();
            }
            for (turned, mode) in self.turned.iter_mut().zip(&*modes) {
                *turned += load * mode;
            }
            self.load += load;
        }
    }

    /// Goes on along the `nodes` of a segment under the force (A, B), with x = `scale` s.
    fn add(&mut self, nodes: &[Node], (a, b): (f64, f64), scale: f64) {
        let [first, .., last] = nodes else { return };
        let intervals = nodes.len() - 1;
        let h = (last.s - first.s) / intervals as f64;
        // the weights 1, 4, 2, 4, .., 2, 4, 1: two blocks have an end
        let (twice, end) = ([2.0, 4.0, 2.0, 4.0].map(|weight| weight * h / 3.0), h / 3.0);
        // sine and cosine of half of x, by turning on: to the next node, or the next block
        let turned = |(sin, cos): (f64, f64), (s, c): (f64, f64)| (sin * c + cos * s, cos * c - sin * s);
        let step = (0.5 * scale * h).sin_cos();
        let mut half_x = [(0.5 * scale * first.s).sin_cos(); LANES];
        (1..LANES).for_each(|l| half_x[l] = turned(half_x[l - 1], step));
        let (mut sines, mut cosines) = (half_x.map(|(sin, _)| sin), half_x.map(|(_, cos)| cos));
        let block_step = turned(turned(step, step), turned(step, step));
        for (block, nodes) in nodes.chunks(LANES).enumerate() {
            let [mut sin, mut cos] = [[0.0; LANES]; 2];
            for (lane, Node { at, .. }) in nodes.iter().enumerate() {
                (sin[lane], cos[lane]) = (at.sin, at.cos);
            }
            let mut weights = twice;
            if block == 0 {
                weights[0] = end;
            }
            if block == intervals / LANES {
                weights[intervals % LANES] = end;
            }
            let by_x = lanes(|l| -weights[l] * sin[l]);
            let by_y = lanes(|l| weights[l] * cos[l]);
            let load = lanes(|l| 0.5 * (a * by_x[l] + b * by_y[l]));
            let cos_x = lanes(|l| cosines[l] * cosines[l] - sines[l] * sines[l]);
            let recurrence = |here: &Lanes, before: &Lanes| lanes(|l| 2.0 * cos_x[l] * here[l] - before[l]);
            let (mut before, mut here) = (sines.map(|sin| -sin), sines);
            for [x, y] in &mut self.shifts {
                *x = lanes(|l| x[l] + by_x[l] * here[l]);
                *y = lanes(|l| y[l] + by_y[l] * here[l]);
                (before, here) = (here, recurrence(&here, &before));
            }
            let (mut before, mut here) = (lanes(|l| load[l] * cos_x[l]), load);
            for moment in &mut self.moments {
                *moment = lanes(|l| moment[l] + here[l]);
                (before, here) = (here, recurrence(&here, &before));
            }
            let next = |l: usize| turned((sines[l], cosines[l]), block_step);
            (sines, cosines) = (lanes(|l| next(l).0), lanes(|l| next(l).1));
        }
    }

    /// How far each mode moves the rod where it is now, in the direction `(cos, sin)` and across it.
    fn shifts(&self, (sin, cos): (f64, f64), along: &mut Vec<f64>, across: &mut Vec<f64>) {
        along.clear();
        across.clear();
        for [x, y] in &self.shifts {
            let (x, y) = (x.iter().sum::<f64>(), y.iter().sum::<f64>());
            along.push(cos * x + sin * y);
            across.push(cos * y - sin * x);
        }
    }
}

fn lanes(f: impl Fn(usize) -> f64) -> Lanes {
    std::array::from_fn(f)
}

/// The curvatures (1 / L) of the contour at contact j and, towards it, of the rod, cut into `segments`. Where the first is no more than the second,
/// the rod touches along a line. None at the tip.
pub(crate) fn bends<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    configuration: &Configuration,
    segments: &[Segment],
    j: usize,
) -> Option<(f64, f64)> {
    let Hold::Tangent { offset } = configuration.contacts[j].hold else { return None };
    let Support { speed, turning, .. } = configuration.supports(&setup.world).support(j, configuration.t(j));
    let kappa = curvature_behind(setup.rod.model(), segments, (j, configuration.count()));
    Some((turning / speed, offset.cos() * kappa))
}

/// By how much the contour is more curved (1 / L) than the rod, cut into `segments`, at contact j; infinite at the tip.
pub(crate) fn clearance<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    configuration: &Configuration,
    segments: &[Segment],
    j: usize,
) -> f64 {
    bends(setup, configuration, segments, j).map_or(f64::INFINITY, |(contour, rod)| contour - rod)
}

/// The contact where the rod, cut into `segments`, is as curved, towards the solid, as the contour that it lies on: it then touches along a line.
pub(crate) fn wraps<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    configuration: &Configuration,
    segments: &[Segment],
) -> Option<usize> {
    let model = setup.rod.model();
    (0..configuration.count()).find(|&j| {
        bends(setup, configuration, segments, j).is_some_and(|(contour, rod)| {
            // an edge along which the rod bends neither way but by rounding
            let grazes = contour == 0.0 && rod.abs() < FLAT;
            (contour <= rod || grazes) && !(grazes && is_straight(model, configuration, (j, rod)))
        })
    })
}

/// Whether the rod, of curvature `kappa` behind contact j, is straight there: behind its last contact a rod without natural curvature is, and so it
/// is up to a tip that only pushes along it. One whose curvature merely vanishes at the contact is not.
fn is_straight(rod: &impl RodModel, configuration: &Configuration, (j, kappa): (usize, f64)) -> bool {
    let is_last = j + 1 == configuration.count();
    let at_rest = || [0.0, BESIDE].map(|beyond| rod.natural_curvature((configuration.s(j) + beyond).min(1.0)));
    kappa.abs() < FLAT && !(is_last && at_rest().iter().any(|natural| natural.abs() >= FLAT))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_set::ActiveContact;
    use crate::path::ClampPath;
    use rod_contours::{Composite, Parabola};
    use rod_core::{ElasticClamp, Mounted, Pose, Rod};

    /// A straight rod standing under a ceiling y = 1 + c x^2, pressed with force f: the tip slides, the clamp holds.
    fn stands(c: f64, f: f64) -> bool {
        is_held(&Rod::new(1.0, 1.0).unwrap(), c, f)
    }

    /// Another rod that stands so, by all that judges it.
    pub(super) fn is_held(rod: &impl PhysicalRod, c: f64, f: f64) -> bool {
        let contour = Composite::single(Parabola::new([0.0, 1.0], c).unwrap()).unwrap();
        let path = ClampPath::standing(Pose { x: 0.0, y: 0.0, phi: 0.5 * PI });
        let setup = Setup::new(rod, contour.as_ref(), path);
        let mut column = Configuration::free(0.0);
        column.insert(0, ActiveContact::smooth(0, Hold::Tip), [0.0, f, 0.5 * PI]);
        let shape = Shape::of(Vec::new(), &setup, &column);
        let by_modes = Judge::default().is_positive_by_modes(&setup, &column, &shape);
        assert!(by_modes || !condensed::is_positive(&setup, &column, &shape));
        Judge::default().is_stable(&setup, &column, &shape)
    }

    #[test]
    fn a_column_buckles_at_eulers_load() {
        let euler = PI * PI / 4.0;
        assert!(stands(0.0, 0.999 * euler));
        assert!(!stands(0.0, 1.001 * euler));
    }

    #[test]
    fn a_ceiling_that_gives_way_buckles_it_earlier_and_a_hollow_one_later() {
        // On a ceiling of curvature k: eta'' + p^2 eta = -k p^2 int eta with p^2 = f, eta(0) = eta'(1) = 0, which has a
        // solution first where (1 + k) cos p = k sin p / p.
        let critical = |k: f64| {
            let (mut low, mut high): (f64, f64) = (1e-3, PI);
            for _ in 0..100 {
                let p = 0.5 * (low + high);
                if (1.0 + k) * p.cos() > k * p.sin() / p { low = p } else { high = p }
            }
            low * low
        };
        for k in [-0.5, 0.5] {
            let f = critical(k);
            assert!(if k > 0.0 { f < PI * PI / 4.0 } else { f > PI * PI / 4.0 });
            assert!(stands(0.5 * k, 0.995 * f) && !stands(0.5 * k, 1.005 * f), "{k}: {f}");
        }
    }

    #[test]
    fn a_base_that_turns_buckles_the_column_earlier() {
        // eta'' + p^2 eta = 0, eta'(0) = k eta(0), eta'(1) = 0: p tan p = k
        for k in [0.5, 4.0, 100.0] {
            let (mut low, mut high): (f64, f64) = (0.0, 0.5 * PI);
            for _ in 0..100 {
                let p = 0.5 * (low + high);
                if p * p.tan() < k { low = p } else { high = p }
            }
            let critical = low * low;
            // it is free to shift under a flat ceiling, spring or not; along its axis nothing turns
            for shifts in [None, Some(30.0)] {
                let clamp = ElasticClamp::springs(shifts, shifts, Some(k)).unwrap();
                // the path is that of the support, and the force of the ceiling pushes the base down
                let rod = Mounted::new(Rod::new(1.0, 1.0).unwrap(), clamp);
                let [less, more] = [0.998 * critical, 1.002 * critical].map(|f| is_held(&rod, 0.0, f));
                assert!(less && !more, "{k} {shifts:?}");
            }
        }
    }

    #[test]
    fn a_hollow_ceiling_holds_a_base_that_shifts() {
        // A rod that cannot bend on a base that shifts, under a hollow of curvature -c: the ceiling pushes it back with f c u, the
        // spring with k u; under a hill of curvature c it gives way at f c = k.
        let (stiff, k, c) = (1e6, 2.0, 0.4);
        let clamp = ElasticClamp::springs(Some(k), None, None).unwrap();
        let rod = Mounted::new(Rod::new(1.0, stiff).unwrap(), clamp);
        let in_units = |f: f64| f / stiff;
        assert!(is_held(&rod, 0.5 * c, in_units(0.99 * k / c)) != is_held(&rod, 0.5 * c, in_units(1.01 * k / c)));
        assert!(is_held(&rod, -0.5 * c, in_units(10.0 * k / c)));
    }
}
