//! The boundary-value problem of a rod without contacts, dimensionless, and its two shooting methods: from the clamp to the tip
//! in one go, and from node to node.
//!
//! Unknown are the moment at the clamp and the forces of the support along the coordinates of the tip that are held. Single
//! shooting has these unknowns only; it serves the search. Multiple shooting (e.g. Stoer and Bulirsch, Introduction to Numerical
//! Analysis, section 7.3.5) adds angle and moment at nodes, so that no error grows along the rod; it gives the results.

use super::phase::{PARTS, compliance, integral, of_equal_phase};
use super::tip::{DeadLoad, Tip, TipEnd};
use crate::model::{Chain, Cut, CutSensitivities, RodModel};
use crate::pose::Pose;
use crate::segment::Segment;
use crate::solve::System;
use crate::units::Units;

/// Moment at the clamp, and the force of the tip's support along x and y (0 where none is held).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unknowns {
    pub moment: f64,
    pub force: [f64; 2],
}

/// The rod, its clamp, its loads and its tip.
pub(super) struct Problem<'a, M> {
    pub rod: &'a M,
    pub clamp: Pose,
    pub tip: Tip,
    /// Arc lengths from 0 to 1 between which the force is constant.
    pub breaks: Vec<f64>,
    /// Sum of the given forces beyond each break but the last, (fx, fy).
    pub ahead: Vec<[f64; 2]>,
    /// Sum of all given forces, those at the clamp included.
    pub total: [f64; 2],
    /// Sum of their magnitudes.
    pub size: f64,
    /// Integral of 1 / EI along the rod: the turn of the tip by a moment.
    pub compliance: f64,
    /// Least 1 / EI along the rod.
    pub least_compliance: f64,
    /// Integral of EI^(-1/2) along the rod: phase by the square root of a force.
    pub root_compliance: f64,
}

/// The components (A, B) of a force: kappa' = A cos phi + B sin phi.
pub(super) fn components([fx, fy]: [f64; 2]) -> (f64, f64) {
    (0.0 - fy, fx)
}

impl<'a, M: RodModel> Problem<'a, M> {
    pub fn new(rod: &'a M, units: Units, pose: Pose, loads: &[DeadLoad], tip: &Tip) -> Self {
        let Units { length, force, moment, .. } = units;
        let scaled = |end: TipEnd, held: f64, loaded: f64| match end {
            TipEnd::Held(value) => TipEnd::Held(value / held),
            TipEnd::Loaded(value) => TipEnd::Loaded(value / loaded),
        };
        let tip =
            Tip { x: scaled(tip.x, length, force), y: scaled(tip.y, length, force), phi: scaled(tip.phi, 1.0, moment) };
        let given = |end: TipEnd| if let TipEnd::Loaded(force) = end { force } else { 0.0 };
        let mut loads: Vec<(f64, [f64; 2])> =
            loads.iter().map(|load| (load.s / length, [load.fx / force, load.fy / force])).collect();
        loads.push((1.0, [given(tip.x), given(tip.y)]));
        loads.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut breaks = vec![0.0];
        breaks.extend(loads.iter().map(|load| load.0).filter(|s| *s > 0.0));
        breaks.dedup();
        let sum = |beyond: f64| {
            let beyond = loads.iter().rev().filter(|(s, _)| *s > beyond);
            beyond.fold([0.0, 0.0], |sum: [f64; 2], (_, force)| [sum[0] + force[0], sum[1] + force[1]])
        };
        Self {
            rod,
            clamp: Pose { x: pose.x / length, y: pose.y / length, phi: pose.phi },
            tip,
            ahead: breaks[..breaks.len() - 1].iter().map(|s| sum(*s)).collect(),
            total: sum(-1.0),
            size: loads.iter().map(|(_, [fx, fy])| fx.hypot(*fy)).sum(),
            compliance: integral(rod, &[0.0, 1.0], |compliance| compliance),
            least_compliance: (0..=PARTS)
                .map(|k| compliance(rod, k as f64 / PARTS as f64))
                .fold(f64::INFINITY, f64::min),
            root_compliance: integral(rod, &[0.0, 1.0], f64::sqrt),
            breaks,
        }
    }

    /// The same with another tip, whose given loads are the same.
    pub fn with_tip(&self, tip: Tip) -> Self {
        Self { tip, ..self.with_rod(self.rod) }
    }

    /// The same of another rod.
    pub fn with_rod<'b, N>(&self, rod: &'b N) -> Problem<'b, N> {
        let (breaks, ahead) = (self.breaks.clone(), self.ahead.clone());
        let Self { clamp, tip, total, size, compliance, least_compliance, root_compliance, .. } = *self;
        Problem { rod, clamp, tip, breaks, ahead, total, size, compliance, least_compliance, root_compliance }
    }

    /// The same with all given forces times a factor.
    pub fn with_loads(&self, factor: f64) -> Self {
        let scaled = |force: [f64; 2]| force.map(|component| factor * component);
        let tip = |end: TipEnd| if let TipEnd::Loaded(force) = end { TipEnd::Loaded(factor * force) } else { end };
        Self {
            ahead: self.ahead.iter().map(|force| scaled(*force)).collect(),
            total: scaled(self.total),
            size: factor * self.size,
            ..self.with_tip(Tip { x: tip(self.tip.x), y: tip(self.tip.y), phi: self.tip.phi })
        }
    }

    /// Distance of the held tip from the clamp along the coordinates that are held, L.
    pub fn distance(&self) -> f64 {
        let held = |end: TipEnd, clamp: f64| if let TipEnd::Held(value) = end { value - clamp } else { 0.0 };
        held(self.tip.x, self.clamp.x).hypot(held(self.tip.y, self.clamp.y))
    }

    /// The phase of the given forces, int sqrt(force / EI) ds: the logarithm of how much the tip depends on the clamp.
    pub fn phase(&self) -> f64 {
        let on = |(ends, [fx, fy]): (&[f64], &[f64; 2])| fx.hypot(*fy).sqrt() * integral(self.rod, ends, f64::sqrt);
        self.breaks.windows(2).zip(&self.ahead).map(on).sum()
    }

    /// The tip's coordinates along x and y that are held: 0, 1 or both.
    pub fn held(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        [self.tip.x, self.tip.y]
            .into_iter()
            .enumerate()
            .filter(|(_, end)| matches!(end, TipEnd::Held(_)))
            .map(|(k, _)| k)
    }

    pub fn start(&self, moment: f64) -> Cut {
        let Pose { x, y, phi } = self.clamp;
        Cut { x, y, phi, moment }
    }

    /// The force on the interval behind break `i`, with that of the tip's support.
    pub fn force(&self, i: usize, [fx, fy]: [f64; 2]) -> [f64; 2] {
        [self.ahead[i][0] + fx, self.ahead[i][1] + fy]
    }

    /// How far the tip is from what is prescribed: x, y, and angle or moment; 0 along what is not held.
    pub fn misses(&self, tip: &Cut) -> [f64; 3] {
        let held = |end: TipEnd, value: f64| if let TipEnd::Held(given) = end { value - given } else { 0.0 };
        let last = match self.tip.phi {
            TipEnd::Held(phi) => tip.phi - phi,
            TipEnd::Loaded(moment) => tip.moment - moment,
        };
        [held(self.tip.x, tip.x), held(self.tip.y, tip.y), last]
    }

    /// Which entry of a cut (x, y, phi, moment) is prescribed besides the place.
    fn last_row(&self) -> usize {
        if matches!(self.tip.phi, TipEnd::Held(_)) { 2 } else { 3 }
    }

    /// The tip by single shooting, with the derivatives of its cut by the moment at the clamp and by the force along x and y.
    pub fn shoot(&self, unknowns: &Unknowns) -> (Cut, [[f64; 4]; 3]) {
        let (mut cut, mut chain) = (self.start(unknowns.moment), Chain::new());
        for (i, ends) in self.breaks.windows(2).enumerate() {
            let (a, b) = components(self.force(i, unknowns.force));
            let (end, part) = self.rod.carry_with_sensitivities(ends[0], &cut, a, b, ends[1] - ends[0]);
            chain.then(&part);
            cut = end;
        }
        let [by_moment, by_a, by_b] = chain.all();
        (cut, [by_moment, by_b, by_a.map(|v| -v)])
    }

    /// The angle or moment at the tip less the prescribed one, and its derivative by the moment at the clamp.
    pub fn last_miss(&self, unknowns: &Unknowns) -> (f64, f64) {
        let (tip, by) = self.shoot(unknowns);
        (self.misses(&tip)[2], by[0][self.last_row()])
    }
}

/// Single shooting as a system of 1 to 3 equations.
pub(super) struct Single<'p, 'a, M>(pub &'p Problem<'a, M>);

impl<M: RodModel> Single<'_, '_, M> {
    pub fn unknowns(&self, u: &[f64]) -> Unknowns {
        let mut unknowns = Unknowns { moment: u[0], force: [0.0; 2] };
        self.0.held().zip(&u[1..]).for_each(|(k, force)| unknowns.force[k] = *force);
        unknowns
    }

    pub fn vector(&self, unknowns: &Unknowns) -> Vec<f64> {
        std::iter::once(unknowns.moment).chain(self.0.held().map(|k| unknowns.force[k])).collect()
    }
}

impl<M: RodModel> System for Single<'_, '_, M> {
    fn dimension(&self) -> usize {
        1 + self.0.held().count()
    }

    fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        let (tip, by) = self.0.shoot(&self.unknowns(u));
        let (misses, last) = (self.0.misses(&tip), self.0.last_row());
        let rows = || std::iter::once((2, last)).chain(self.0.held().map(|k| (k, k)));
        rows().zip(&mut *residual).for_each(|((k, _), r)| *r = misses[k]);
        let Some(jacobian) = jacobian else { return };
        let columns = std::iter::once(0).chain(self.0.held().map(|k| k + 1));
        for (column, entries) in columns.zip(jacobian.chunks_exact_mut(u.len())) {
            rows().zip(entries).for_each(|((_, row), entry)| *entry = by[column][row]);
        }
    }

    fn weights(&self, u: &[f64], weights: &mut [f64]) {
        u.iter().zip(weights).for_each(|(u, w)| *w = 1.0 / (1.0 + u.abs()));
    }
}

/// A shape as nodes: arc length, cut, and the force behind; the last node is the tip.
pub(super) type Nodes = Vec<Segment<Cut>>;

/// Most nodes between two breaks.
const MOST_NODES: f64 = 100.0;

/// Multiple shooting between nodes.
pub(super) struct Multiple<'p, 'a, M> {
    problem: &'p Problem<'a, M>,
    /// Arc lengths from 0 to 1.
    mesh: Vec<f64>,
    /// Given forces ahead, interval by interval.
    ahead: Vec<[f64; 2]>,
}

impl<'p, 'a, M: RodModel> Multiple<'p, 'a, M> {
    /// With the nodes so close together that the state between two of them grows by at most about e^`growth`.
    pub fn new(problem: &'p Problem<'a, M>, force: [f64; 2], growth: f64) -> Self {
        let (mut mesh, mut ahead) = (vec![0.0], Vec::new());
        for (i, ends) in problem.breaks.windows(2).enumerate() {
            let [fx, fy] = problem.force(i, force);
            let phase = fx.hypot(fy).sqrt() * integral(problem.rod, ends, f64::sqrt);
            let parts = (phase / growth).ceil().clamp(1.0, MOST_NODES) as usize;
            mesh.extend(of_equal_phase(problem.rod, [ends[0], ends[1]], parts));
            mesh.push(ends[1]);
            ahead.extend(std::iter::repeat_n(problem.ahead[i], parts));
        }
        Self { problem, mesh, ahead }
    }

    /// The arc lengths of the nodes, with parts of the intervals so that there are at least `least` of them.
    pub fn refined(self, least: usize) -> Vec<f64> {
        let parts = least.div_ceil(self.intervals());
        let within = |ends: &[f64]| {
            let (from, length) = (ends[0], ends[1] - ends[0]);
            (0..parts).map(move |k| from + length * k as f64 / parts as f64)
        };
        self.mesh.windows(2).flat_map(within).chain([1.0]).collect()
    }

    fn intervals(&self) -> usize {
        self.ahead.len()
    }

    fn force(&self, u: &[f64]) -> [f64; 2] {
        let mut force = [0.0; 2];
        self.problem.held().zip(&u[2 * self.intervals() - 1..]).for_each(|(k, f)| force[k] = *f);
        force
    }

    fn start(&self, u: &[f64], i: usize, place: [f64; 2]) -> Cut {
        let (phi, moment) = if i == 0 { (self.problem.clamp.phi, u[0]) } else { (u[2 * i - 1], u[2 * i]) };
        Cut { x: place[0], y: place[1], phi, moment }
    }

    fn segment(&self, u: &[f64], force: [f64; 2], i: usize, place: [f64; 2]) -> Segment<Cut> {
        let (a, b) = components([self.ahead[i][0] + force[0], self.ahead[i][1] + force[1]]);
        Segment { s: self.mesh[i], start: self.start(u, i, place), a, b }
    }

    /// The unknowns of a shape that is known.
    pub fn vector(&self, shape: &Shape<'_, impl RodModel>, force: [f64; 2]) -> Vec<f64> {
        let mut u = vec![shape.cut(0.0).moment];
        for s in &self.mesh[1..self.intervals()] {
            let cut = shape.cut(*s);
            u.extend([cut.phi, cut.moment]);
        }
        u.extend(self.problem.held().map(|k| force[k]));
        u
    }

    /// The shape of the unknowns, the force of the support, and the residual: the largest gap between two intervals or miss at the tip, in
    /// L, rad, and E I / L relative to 1 + the largest moment.
    pub fn shape(&self, u: &[f64]) -> (Nodes, [f64; 2], f64) {
        let force = self.force(u);
        let mut place = [self.problem.clamp.x, self.problem.clamp.y];
        let (mut nodes, mut gaps, mut most) = (Nodes::new(), Vec::new(), 1.0_f64);
        for i in 0..self.intervals() {
            let segment = self.segment(u, force, i, place);
            let length = self.mesh[i + 1] - self.mesh[i];
            let end = self.problem.rod.carry(segment.s, &segment.start, segment.a, segment.b, length);
            place = [end.x, end.y];
            most = most.max(1.0 + segment.start.moment.abs()).max(1.0 + end.moment.abs());
            nodes.push(segment);
            if i + 1 < self.intervals() {
                let next = self.start(u, i + 1, place);
                gaps.push((end.phi - next.phi, end.moment - next.moment));
            } else {
                let [x, y, last] = self.problem.misses(&end);
                let moment = if self.problem.last_row() == 3 { last } else { 0.0 };
                gaps.push((x.abs().max(y.abs()), moment));
                gaps.push((last - moment, 0.0));
                nodes.push(Segment { s: 1.0, start: end, a: 0.0, b: 0.0 });
            }
        }
        // NaN comes through
        let worst = gaps.iter().flat_map(|(gap, moment)| [gap.abs(), moment.abs() / most]);
        let residual = worst.fold(0.0, |worst: f64, gap| if gap > worst || gap.is_nan() { gap } else { worst });
        (nodes, force, residual)
    }
}

impl<M: RodModel> System for Multiple<'_, '_, M> {
    fn dimension(&self) -> usize {
        2 * self.intervals() - 1 + self.problem.held().count()
    }

    fn evaluate(&self, u: &[f64], residual: &mut [f64], mut jacobian: Option<&mut [f64]>) {
        let (n, intervals, force) = (u.len(), self.intervals(), self.force(u));
        let (row_last, first_force) = (2 * (intervals - 1), 2 * intervals - 1);
        if let Some(jacobian) = jacobian.as_deref_mut() {
            jacobian.fill(0.0);
        }
        let mut place = [self.problem.clamp.x, self.problem.clamp.y];
        for i in 0..intervals {
            let Segment { s, start, a, b } = self.segment(u, force, i, place);
            let length = self.mesh[i + 1] - self.mesh[i];
            let (end, by): (Cut, Option<CutSensitivities>) = if jacobian.is_some() {
                let (end, by) = self.problem.rod.carry_with_sensitivities(s, &start, a, b, length);
                (end, Some(by))
            } else {
                (self.problem.rod.carry(s, &start, a, b, length), None)
            };
            place = [end.x, end.y];
            // the rows that this interval ends in, each with the entry of its cut
            let is_last = i + 1 == intervals;
            let own = if is_last { [(row_last, self.problem.last_row()); 2] } else { [(2 * i, 2), (2 * i + 1, 3)] };
            if is_last {
                let misses = self.problem.misses(&end);
                residual[row_last] = misses[2];
                self.problem.held().enumerate().for_each(|(k, held)| residual[first_force + k] = misses[held]);
            } else {
                let next = self.start(u, i + 1, place);
                (residual[2 * i], residual[2 * i + 1]) = (end.phi - next.phi, end.moment - next.moment);
            }
            let (Some(jacobian), Some(by)) = (jacobian.as_deref_mut(), by) else { continue };
            let places = || self.problem.held().enumerate().map(|(k, held)| (first_force + k, held));
            let forces = self.problem.held().map(|held| if held == 0 { by.by_b } else { by.by_a.map(|v| -v) });
            let moment = if i == 0 { 0 } else { 2 * i };
            let angle = (i > 0).then(|| (2 * i - 1, by.by_phi));
            let columns = angle.into_iter().chain([(moment, by.by_moment)]);
            for (column, derivative) in columns.chain(forces.enumerate().map(|(k, by)| (first_force + k, by))) {
                let entries = &mut jacobian[n * column..n * (column + 1)];
                own.iter().for_each(|(row, entry)| entries[*row] = derivative[*entry]);
                places().for_each(|(row, entry)| entries[row] += derivative[entry]);
            }
            if !is_last {
                jacobian[n * (2 * i + 1) + 2 * i] = -1.0;
                jacobian[n * (2 * i + 2) + 2 * i + 1] = -1.0;
            }
        }
    }

    fn weights(&self, u: &[f64], weights: &mut [f64]) {
        let intervals = self.intervals();
        let moments = || std::iter::once(u[0]).chain((1..intervals).map(|i| u[2 * i]));
        let most = 1.0 + moments().fold(0.0, |most: f64, moment| most.max(moment.abs()));
        weights.fill(1.0);
        weights[0] = 1.0 / most;
        (1..intervals).for_each(|i| weights[2 * i] = 1.0 / most);
        let first = 2 * intervals - 1;
        u[first..].iter().zip(&mut weights[first..]).for_each(|(f, w)| *w = 1.0 / (1.0 + f.abs()));
    }
}

/// A shape that can be asked for a cut anywhere.
pub(super) struct Shape<'a, M> {
    pub rod: &'a M,
    pub nodes: Nodes,
}

impl<M: RodModel> Shape<'_, M> {
    pub fn cut(&self, s: f64) -> Cut {
        let i = self.nodes.partition_point(|node| node.s <= s).saturating_sub(1);
        let node = &self.nodes[i];
        self.rod.carry(node.s, &node.start, node.a, node.b, s - node.s)
    }

    /// The force (A, B) just beyond an arc length.
    pub fn force(&self, s: f64) -> (f64, f64) {
        let node = &self.nodes[self.nodes.partition_point(|node| node.s <= s).saturating_sub(1)];
        (node.a, node.b)
    }
}

/// The shape by single shooting.
pub(super) fn shot<'a, M: RodModel>(problem: &Problem<'a, M>, unknowns: &Unknowns) -> Shape<'a, M> {
    let (mut nodes, mut cut) = (Nodes::new(), problem.start(unknowns.moment));
    for (i, ends) in problem.breaks.windows(2).enumerate() {
        let (a, b) = components(problem.force(i, unknowns.force));
        nodes.push(Segment { s: ends[0], start: cut, a, b });
        cut = problem.rod.carry(ends[0], &cut, a, b, ends[1] - ends[0]);
    }
    nodes.push(Segment { s: 1.0, start: cut, a: 0.0, b: 0.0 });
    Shape { rod: problem.rod, nodes }
}
