//! The search for all equilibria of a rod without contacts.
//!
//! Where the tip's place is not held, one number is unknown, the moment at the clamp, and it is bounded: the roots are found by an
//! adaptive scan with the exact derivative. Where the place is held, Newton's method starts from a grid of clamp moments and support
//! forces, from each node whose first step stays in its neighbourhood. Where a single coordinate of it is held, Newton's method also starts
//! from the equilibria without it under a series of support forces. A tip near full extension needs forces beyond the grid: its
//! equilibria are followed from a tip nearer to the clamp, and those under strong loads from weaker ones.

use super::phase::in_sections;
use super::problem::{Multiple, Problem, Shape, Single, Unknowns, shot};
use super::scan::Scan;
use super::tip::{STRETCHED, Tip, TipEnd};
use crate::model::RodModel;
use crate::solve::{NewtonOptions, NewtonWorkspace, System, linear, solve};
use std::f64::consts::TAU;

/// Largest residual of an equilibrium: L, rad, and E I / L relative to 1 + the largest moment.
const LARGEST_RESIDUAL: f64 = 1e-12;
/// Growth (exponent) of the state between two nodes of multiple shooting: keeps the condition number below about 100 per interval.
const GROWTH: f64 = 2.0;

/// The grid of starts.
///
/// Forces count by their phase, int sqrt(force / EI) ds: buckling loads are a few multiples of pi / 2 apart, for uniform rods and
/// others.
struct Grid {
    /// Steps of the phase of the support force, rad.
    phase: f64,
    /// Their number.
    phases: usize,
    /// Directions of the force.
    directions: usize,
    /// Starts in the clamp moment for each radian of phase, on either side of 0.
    moments: f64,
    /// Length of a first Newton step in cells up to which Newton's method starts from a node.
    near: f64,
}

/// Forces up to 225 E I / L^2 of a uniform rod hold the first four modes of a rod between two clamps. A grid with steps
/// a quarter as large finds no more in 100 random problems (the test below).
const GRID: Grid = Grid { phase: 1.0, phases: 15, directions: 16, moments: 1.5, near: 3.0 };
/// The forces of starts that fulfil all equations but that of a single held coordinate. Its equilibria lie on the curves of these in the plane
/// of moment and force; the grid alone misses some on steep parts of them.
const CURVES: Grid = Grid { phase: 0.3, phases: 50, directions: 2, moments: 0.0, near: 4.0 };
/// Largest turn of the tip between two starts of a rod that varies, rad, and most starts on either side of 0 for that.
const MOST_APART: f64 = 1.2;
const MOST_MOMENTS: f64 = 200.0;
/// Sections of a rod that varies, for the grid.
const SECTIONS: usize = 24;
/// The largest phase of the grid, rad.
pub(super) const LARGEST_PHASE: f64 = GRID.phase * GRID.phases as f64;
/// Relative difference up to which two solutions are the same.
const SAME: f64 = 1e-6;

/// Distance of the tip (L) from which the equilibria of one near full extension are followed.
const SLACK: f64 = 0.8;
/// Phase of the given forces (rad) up to which single shooting resolves all equilibria: those under larger ones are followed, too.
const MODERATE: f64 = 7.0;
/// Most equilibria that are followed, of the lowest forces.
const MOST_FOLLOWED: usize = 16;
/// First and least step of the way from one to the other.
const STEPS: (f64, f64) = (0.1, 1e-3);

/// An equilibrium: its shape, the force of the tip's support, and its residual.
pub(super) struct Found<'a, M> {
    pub shape: Shape<'a, M>,
    pub force: [f64; 2],
    pub residual: f64,
}

/// All equilibria that the search finds, each once, in no order.
pub(super) fn equilibria<'a, M: RodModel>(problem: &Problem<'a, M>) -> Vec<Found<'a, M>> {
    let mut workspace = NewtonWorkspace::new();
    let mut found = direct(problem, &mut workspace);
    let phase = problem.phase();
    if phase > MODERATE {
        // the loads grow geometrically, as the square of their phase
        let factor = (MODERATE / phase).powi(2);
        found.extend(followed(&|t: f64| problem.with_loads(factor.powf(1.0 - t)), &mut workspace));
    }
    if let Some(nearer) = slackened(problem) {
        found.extend(followed(&nearer, &mut workspace));
    }
    distinct(found)
}

/// Without continuation.
fn direct<'a, M: RodModel>(problem: &Problem<'a, M>, workspace: &mut NewtonWorkspace) -> Vec<Found<'a, M>> {
    if problem.held().next().is_some() {
        return from_grid(problem, &GRID, workspace);
    }
    let shape = |moment| shot(problem, &Unknowns { moment, force: [0.0; 2] });
    scan(problem).into_iter().filter_map(|moment| polished(problem, &shape(moment), [0.0; 2], workspace)).collect()
}

/// The equilibrium near a shape, by multiple shooting.
fn polished<'a, M: RodModel>(
    problem: &Problem<'a, M>,
    shape: &Shape<'_, impl RodModel>,
    force: [f64; 2],
    workspace: &mut NewtonWorkspace,
) -> Option<Found<'a, M>> {
    let nodes = Multiple::new(problem, force, GROWTH);
    let guess = nodes.vector(shape, force);
    let mut u = guess.clone();
    let report = solve(&nodes, &mut u, &NewtonOptions::default(), workspace);
    // at a critical load Newton's method has no direction, and the guess may solve the equations already
    let solutions = [report.status.is_solved().then_some(u), Some(guess)];
    solutions.into_iter().flatten().find_map(|u| {
        let (cuts, force, residual) = nodes.shape(&u);
        let shape = Shape { rod: problem.rod, nodes: cuts };
        (residual <= LARGEST_RESIDUAL).then_some(Found { shape, force, residual })
    })
}

fn distinct<M: RodModel>(found: Vec<Found<'_, M>>) -> Vec<Found<'_, M>> {
    // near a separatrix the moments at the clamp agree in all digits, and the shapes do not
    let numbers = |one: &Found<'_, M>| {
        let [middle, tip] = [0.5, 1.0].map(|s| one.shape.cut(s));
        let ends = [one.shape.nodes[0].start.moment, one.force[0], one.force[1]];
        [ends[0], ends[1], ends[2], middle.phi, middle.moment, tip.phi, tip.moment, tip.x, tip.y]
    };
    let mut once: Vec<(Found<'_, M>, [f64; 9])> = Vec::new();
    for one in found {
        let own = numbers(&one);
        if !once.iter().any(|(_, other)| same(other, &own)) {
            once.push((one, own));
        }
    }
    once.into_iter().map(|(one, _)| one).collect()
}

fn same(one: &[f64], other: &[f64]) -> bool {
    let size = one.iter().chain(other).fold(1.0, |most: f64, value| most.max(value.abs()));
    one.iter().zip(other).all(|(u, v)| (u - v).abs() <= SAME * size)
}

/// The bending moment that turns the tip of the rod to the prescribed angle or is prescribed there, without any force.
fn mean_moment<M: RodModel>(problem: &Problem<'_, M>) -> f64 {
    match problem.tip.phi {
        TipEnd::Loaded(moment) => moment,
        TipEnd::Held(phi) => {
            let (end, by) = problem.rod.carry_with_sensitivities(0.0, &problem.start(0.0), 0.0, 0.0, 1.0);
            (phi - end.phi) / by.by_moment[2]
        }
    }
}

/// All moments at the clamp that give the prescribed moment or angle at the tip.
fn scan<M: RodModel>(problem: &Problem<'_, M>) -> Vec<f64> {
    let mean = mean_moment(problem);
    if problem.size == 0.0 {
        return vec![mean];
    }
    let bound = bound(problem, mean, problem.size);
    let (least, most) = ((mean - problem.size).max(-bound), (mean + problem.size).min(bound));
    let room = 1e-3 * (most - least);
    let miss = |moment| problem.last_miss(&Unknowns { moment, force: [0.0; 2] });
    Scan::new(miss).all(least - room, most + room)
}

/// A bound of the moment at the clamp under forces of the sum `size`, where it is `mean` without them.
///
/// No arm of a force is longer than the rod: the moment leaves that without forces by at most the sum of the forces. Of a uniform
/// rod, kappa^2 / 2 changes by at most twice that sum, too.
fn bound<M: RodModel>(problem: &Problem<'_, M>, mean: f64, size: f64) -> f64 {
    let by_arms = mean.abs() + size;
    if problem.rod.is_uniform() { by_arms.min((mean * mean + 4.0 * size).sqrt()) } else { by_arms }
}

/// The equilibria to which Newton's method leads from the nodes of a grid. A rod that varies is searched in sections.
fn from_grid<'a, M: RodModel>(
    problem: &Problem<'a, M>,
    grid: &Grid,
    workspace: &mut NewtonWorkspace,
) -> Vec<Found<'a, M>> {
    if problem.rod.is_uniform() {
        return of_candidates(problem, problem, grid, workspace);
    }
    let sections = in_sections(problem.rod, SECTIONS);
    sections.map_or_else(Vec::new, |rod| of_candidates(problem, &problem.with_rod(&rod), grid, workspace))
}

/// The equilibria beside those of a problem that is nearly the same.
fn of_candidates<'a, M: RodModel, N: RodModel>(
    problem: &Problem<'a, M>,
    other: &Problem<'_, N>,
    grid: &Grid,
    workspace: &mut NewtonWorkspace,
) -> Vec<Found<'a, M>> {
    let candidates = candidates(other, grid, workspace);
    let polish = |unknowns: Unknowns| polished(problem, &shot(other, &unknowns), unknowns.force, workspace);
    candidates.into_iter().filter_map(polish).collect()
}

/// Newton's method from many starts.
struct Starts<'w, 'p, 'a, M> {
    system: Single<'p, 'a, M>,
    workspace: &'w mut NewtonWorkspace,
    residual: Vec<f64>,
    jacobian: Vec<f64>,
    inverse: Vec<f64>,
    step: Vec<f64>,
    solutions: Vec<Vec<f64>>,
}

impl<'w, 'p, 'a, M: RodModel> Starts<'w, 'p, 'a, M> {
    fn new(problem: &'p Problem<'a, M>, workspace: &'w mut NewtonWorkspace) -> Self {
        let system = Single(problem);
        let n = system.dimension();
        let square = || vec![0.0; n * n];
        let (jacobian, inverse, solutions) = (square(), square(), Vec::new());
        Self { system, workspace, residual: vec![0.0; n], jacobian, inverse, step: vec![0.0; n], solutions }
    }

    /// Solves from a start whose first step is not longer than `near`: in the moment and in each force.
    fn solve_from(&mut self, start: &Unknowns, near: [f64; 2]) {
        let Self { system, workspace, residual, jacobian, inverse, step, solutions } = self;
        let options = NewtonOptions { max_iterations: 25, least_damping: 0.05, ..NewtonOptions::default() };
        let mut u = system.vector(start);
        system.evaluate(&u, residual, Some(jacobian));
        if !linear::invert(u.len(), jacobian, inverse) {
            return;
        }
        linear::multiply(inverse, residual, -1.0, step);
        let (moment, forces) = (step[0].abs(), step[1..].iter().map(|df| df.abs()));
        if moment <= near[0]
            && forces.fold(0.0, f64::max) <= near[1]
            && solve(system, &mut u, &options, workspace).status.is_solved()
            && !solutions.iter().any(|known| same(known, &u))
        {
            solutions.push(u);
        }
    }
}

/// The solutions of single shooting.
fn candidates<M: RodModel>(problem: &Problem<'_, M>, grid: &Grid, workspace: &mut NewtonWorkspace) -> Vec<Unknowns> {
    let mut starts = Starts::new(problem, workspace);
    let mean = mean_moment(problem);
    let turn = (mean * problem.compliance).abs();
    let most_moment = |force: [f64; 2]| {
        let size = problem.size + force[0].hypot(force[1]);
        // of a rod that softens towards the tip the moment obeys the bound of a uniform one; of others it is a guess
        let softening = (mean * mean + 4.0 * size / problem.least_compliance).sqrt();
        1.05 * bound(problem, mean, size).min(softening) + 0.05 / problem.compliance
    };
    for (force, cell) in forces(problem, grid) {
        let (size, bound) = (problem.size + force[0].hypot(force[1]), most_moment(force));
        let by_phase = 4.0 + grid.moments * problem.root_compliance * size.sqrt() + turn;
        // an odd number of starts: a straight rod is among them
        let half = by_phase.max((bound * problem.compliance / MOST_APART).min(MOST_MOMENTS)).ceil();
        for k in -(half as i32)..=half as i32 {
            let start = Unknowns { moment: bound * f64::from(k) / half, force };
            starts.solve_from(&start, [grid.near * bound / half, grid.near * cell]);
        }
    }
    if problem.held().count() == 1 {
        // without the held coordinate, the equilibria under each force of the support are the roots of a function of one variable
        for (force, cell) in forces(problem, &CURVES) {
            let bound = most_moment(force);
            let miss = |moment| problem.last_miss(&Unknowns { moment, force });
            for moment in Scan::coarse(miss).all(-bound, bound) {
                starts.solve_from(&Unknowns { moment, force }, [f64::INFINITY, CURVES.near * cell]);
            }
        }
    }
    let Starts { system, solutions, .. } = starts;
    // beyond the grid it is chance which ones are found
    let most = (grid.phase * grid.phases as f64 / problem.root_compliance).powi(2);
    let unknowns = solutions.iter().map(|u| system.unknowns(u));
    unknowns.filter(|unknowns| unknowns.force[0].hypot(unknowns.force[1]) <= most).collect()
}

/// The support forces of the grid, each with the size of its cell: along the line from the clamp to the tip and in equal angles from it.
fn forces<M: RodModel>(problem: &Problem<'_, M>, grid: &Grid) -> Vec<([f64; 2], f64)> {
    let held: Vec<usize> = problem.held().collect();
    let unit = problem.root_compliance.powi(-2);
    let mut forces = vec![([0.0; 2], unit)];
    let along = match (problem.tip.x, problem.tip.y) {
        (TipEnd::Held(x), TipEnd::Held(y)) if x != problem.clamp.x || y != problem.clamp.y => {
            (y - problem.clamp.y).atan2(x - problem.clamp.x)
        }
        _ => problem.clamp.phi,
    };
    for k in 1..=grid.phases {
        let phase = grid.phase * k as f64;
        let (size, radial) = (phase * phase * unit, 2.0 * phase * grid.phase * unit);
        match held[..] {
            [one] => forces.extend([size, -size].map(|force| {
                let mut both = [0.0; 2];
                both[one] = force;
                (both, radial)
            })),
            _ => forces.extend((0..grid.directions).map(|k| {
                let angle = TAU / grid.directions as f64;
                let (sin, cos) = (along + angle * k as f64).sin_cos();
                ([size * cos, size * sin], radial.max(size * angle))
            })),
        }
    }
    forces
}

/// For a tip near full extension: the problem on the way there from a tip nearer to the clamp, by a parameter from 0 to 1.
fn slackened<'a, M: RodModel>(problem: &Problem<'a, M>) -> Option<impl Fn(f64) -> Problem<'a, M>> {
    let clamp = problem.clamp;
    let from_clamp = |end: TipEnd, clamp: f64| if let TipEnd::Held(value) = end { value - clamp } else { 0.0 };
    let (dx, dy) = (from_clamp(problem.tip.x, clamp.x), from_clamp(problem.tip.y, clamp.y));
    let away = problem.distance();
    // the distance from full extension goes down geometrically
    let at = move |t: f64| {
        let distance = 1.0 - (1.0 - SLACK).powf(1.0 - t) * (1.0 - away).powf(t);
        let moved = |end, clamp: f64, d: f64| match end {
            TipEnd::Held(_) => TipEnd::Held(clamp + d * distance / away),
            loaded => loaded,
        };
        let Tip { x, y, phi } = problem.tip;
        let nearer = Tip { x: moved(x, clamp.x, dx), y: moved(y, clamp.y, dy), phi };
        problem.with_tip(if t < 1.0 { nearer } else { problem.tip })
    };
    (away > STRETCHED).then_some(at)
}

/// The equilibria of a problem that depends on a parameter, at 1, followed from those at 0.
fn followed<'a, M: RodModel>(
    at: &impl Fn(f64) -> Problem<'a, M>,
    workspace: &mut NewtonWorkspace,
) -> Vec<Found<'a, M>> {
    let mut starts = distinct(direct(&at(0.0), workspace));
    starts.sort_by(|one, other| one.force[0].hypot(one.force[1]).total_cmp(&other.force[0].hypot(other.force[1])));
    starts.truncate(MOST_FOLLOWED);
    let follow = |first: Found<'a, M>| {
        let (mut now, mut t, mut step) = (first, 0.0, STEPS.0);
        while t < 1.0 {
            let next: f64 = (t + step).min(1.0);
            match polished(&at(next), &now.shape, now.force, workspace) {
                Some(found) => (now, t, step) = (found, next, 1.5 * step),
                None if step > STEPS.1 => step *= 0.5,
                None => return None,
            }
        }
        Some(now)
    };
    starts.into_iter().filter_map(follow).collect()
}

#[cfg(test)]
#[expect(clippy::print_stdout, reason = "prints the numbers of docs/elastica.md")]
mod tests {
    use super::*;
    use crate::elastica::tip::DeadLoad;
    use crate::model::{RodSection, Uniform};
    use crate::physical::PhysicalRod;
    use crate::pose::Pose;
    use crate::rod::Rod;
    use crate::units::Units;

    /// A grid with steps of about a quarter.
    const FINE: Grid = Grid { phase: 0.3, phases: 50, directions: 48, moments: 4.0, near: 3.0 };

    /// Clamp moments and support forces of the equilibria by the search and by the finer grid, up to 150 E I / L^2.
    fn by_both_grids(loads: &[DeadLoad], tip: &Tip) -> [Vec<[f64; 3]>; 2] {
        let clamp = Pose { x: 0.0, y: 0.0, phi: 0.0 };
        let problem = Problem::new(&Uniform, Units::ONE, clamp, loads, tip);
        let numbers = |found: Vec<Found<'_, Uniform>>| {
            let number = |one: &Found<'_, Uniform>| [one.shape.nodes[0].start.moment, one.force[0], one.force[1]];
            found.iter().filter(|one| one.force[0].hypot(one.force[1]) < 150.0).map(number).collect::<Vec<_>>()
        };
        let fine = from_grid(&problem, &FINE, &mut NewtonWorkspace::new());
        [numbers(equilibria(&problem)), numbers(distinct(fine))]
    }

    #[test]
    fn a_finer_grid_finds_the_same() {
        let load = [DeadLoad { s: 0.4, fx: -8.0, fy: 15.0 }];
        let pinned = Tip { phi: TipEnd::Loaded(-1.5), ..Tip::place(0.5, 0.3) };
        for (loads, tip) in [(&load[..], pinned), (&[], Tip::pose(Pose { x: 0.8, y: -0.1, phi: 0.3 }))] {
            let [coarse, fine] = by_both_grids(loads, &tip);
            assert!(fine.len() >= 3 && coarse.len() == fine.len(), "{coarse:?} {fine:?}");
            assert!(fine.iter().all(|one| coarse.iter().any(|other| same(one, other))), "{coarse:?} {fine:?}");
        }
    }

    fn moments<M: RodModel>(problem: &Problem<'_, M>) -> Vec<f64> {
        equilibria(problem).iter().map(|one| one.shape.nodes[0].start.moment).collect()
    }

    /// One coordinate is held, and Newton's method from the grid missed the equilibrium: a uniform rod and one of two sections.
    #[test]
    fn steep_curves_of_a_tip_with_one_coordinate_held_are_found() {
        let clamp = Pose { x: -0.346_487_061_378_143_2, y: -0.802_957_742_295_170_1, phi: -0.637_630_384_051_832_3 };
        let load = DeadLoad { s: 0.579_383_480_596_781_7, fx: 2.108_233_840_825_6, fy: -1.942_956_750_671_231_7 };
        let tip = Tip {
            x: TipEnd::Held(-0.873_721_393_929_565),
            y: TipEnd::Loaded(-0.202_434_196_729_629_56),
            phi: TipEnd::Held(1.576_940_858_871_673_3),
        };
        let found = moments(&Problem::new(&Uniform, Units::ONE, clamp, &[load], &tip));
        assert!(found.iter().any(|moment| (moment + 19.186).abs() < 1e-2), "{found:?}");
        let section =
            |length, bending_stiffness, natural_curvature| RodSection { length, bending_stiffness, natural_curvature };
        let rod = Rod::sections(1.0, &[section(0.396, 1.0, 0.033), section(0.604, 0.236, 0.031)]).unwrap();
        let tip = Tip { x: TipEnd::Held(-0.366_407), y: TipEnd::Loaded(-33.260_911), phi: TipEnd::Loaded(-2.246_97) };
        let clamp = Pose { x: 0.0, y: 0.0, phi: 0.3 };
        let found = moments(&Problem::new(rod.model(), rod.units(), clamp, &[], &tip));
        assert!(found.iter().any(|moment| (moment + 13.13).abs() < 1e-2), "{found:?}");
    }

    /// The numbers of docs/elastica.md: 100 random problems with up to two loads and a tip that is pinned or clamped.
    #[test]
    #[ignore = "takes 15 s"]
    fn random_problems_by_a_finer_grid() {
        let mut state = 1_u64;
        let mut random = |from: f64, to: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            from + (to - from) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
        };
        let (mut all, mut missed) = (0, 0);
        for number in 0..100 {
            let loads: Vec<DeadLoad> = (0..number % 3)
                .map(|_| DeadLoad { s: random(0.1, 1.0), fx: random(-20.0, 20.0), fy: random(-20.0, 20.0) })
                .collect();
            let (away, along) = (random(0.1, 0.85), random(-3.0, 3.0));
            let place = (away * along.cos(), away * along.sin());
            let tip = match number % 2 {
                0 => Tip::place(place.0, place.1),
                _ => Tip::pose(Pose { x: place.0, y: place.1, phi: random(-3.0, 3.0) }),
            };
            let [coarse, fine] = by_both_grids(&loads, &tip);
            all += fine.len();
            missed += fine.iter().filter(|one| !coarse.iter().any(|other| same(*one, other))).count();
        }
        println!("{missed} of {all} equilibria are missed");
        assert!(50 * missed <= all);
    }
}
