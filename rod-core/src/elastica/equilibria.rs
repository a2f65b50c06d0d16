//! Equilibria of a rod without contacts: under dead loads, with a load at the tip or with coordinates of the tip held.

use super::Elastica;
use super::problem::{Problem, Shape, components};
use super::search::{self, Found, LARGEST_PHASE};
use super::second_variation::unstable_directions;
use super::tip::{DeadLoad, ElasticaError, Tip, TipEnd, check};
use crate::model::{Cut, RodModel, Uniform};
use crate::physical::PhysicalRod;
use crate::pose::{Pose, Reactions};
use crate::segment::Segment;
use crate::units::Units;

/// Relative difference of the energies of mirror images.
const SAME_ENERGY: f64 = 1e-10;

/// Force (N) and moment (N m) on the rod at its tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TipLoad {
    /// Along x, N.
    pub fx: f64,
    /// Along y, N.
    pub fy: f64,
    /// N m.
    pub moment: f64,
}

/// An equilibrium of a rod without contacts, SI units.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ElasticaEquilibrium<M = Uniform> {
    /// The shape.
    pub shape: Elastica<M>,
    /// Force and moment of the clamp on the rod.
    pub reactions: Reactions,
    /// Force and moment on the tip: those that are given, and those of the support where coordinates are held.
    pub tip: TipLoad,
    /// Bending energy, J.
    pub bending_energy: f64,
    /// Bending energy less the work of the given loads from the shape at rest, J. The lowest one comes first.
    pub potential_energy: f64,
    /// Whether each small motion that the tip allows needs energy: the second variation is positive definite. Never true of a critical one.
    pub stable: bool,
    /// In how many independent directions the second variation is negative.
    pub unstable_directions: usize,
    /// Whether the second variation vanishes in a direction: at a critical load, and of an equilibrium that belongs to a family of them.
    pub critical: bool,
    /// Largest violation of the equations: L, rad, and moments in E I / L relative to 1 + the largest of them.
    pub residual: f64,
}

/// The equilibria of a rod that is clamped at `pose`, without contacts, under dead loads and with what is prescribed at its tip, by
/// potential energy, the lowest first. Of a family that moves without a change of energy, such as a closed loop that slides along itself,
/// it gives one; that is [`critical`](ElasticaEquilibrium::critical).
///
/// The search is sampled: it may miss equilibria. Each that it gives fulfils the equations to 1e-12 ([`residual`]). Without a held place the moment at the clamp is
/// scanned over the whole range that it can have. With one there are infinitely many equilibria; the search starts from support forces up to 225 E I / L^2,
/// which hold those of the first four buckling modes.
///
/// ```
/// use rod_core::{Pose, Rod, Tip, elastica_equilibria};
/// let (rod, clamp) = (Rod::new(1.0, 1.0)?, Pose { x: 0.0, y: 0.0, phi: 0.0 });
/// // a column under 1.2 times its Euler load: straight and unstable, or buckled to either side
/// let euler = std::f64::consts::PI.powi(2) / 4.0;
/// let found = elastica_equilibria(&rod, clamp, &[], &Tip::loaded(-1.2 * euler, 0.0, 0.0))?;
/// assert_eq!(found.iter().map(|one| one.stable).collect::<Vec<_>>(), [true, true, false]);
/// assert!((found[0].reactions.m0z + found[1].reactions.m0z).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// [`residual`]: ElasticaEquilibrium::residual
///
/// # Errors
/// [`ElasticaError::Argument`] for a clamp that gives way, numbers that are not finite, a load beside the rod, a tip out of reach, or loads
/// beyond 1000 E I / L^2; [`ElasticaError::NotFound`].
pub fn elastica_equilibria<R: PhysicalRod>(
    rod: &R,
    pose: Pose,
    loads: &[DeadLoad],
    tip: &Tip,
) -> Result<Vec<ElasticaEquilibrium<R::Model>>, ElasticaError> {
    check(rod, pose, loads, tip)?;
    let (units, model) = (rod.units(), rod.model());
    let problem = Problem::new(model, units, pose, loads, tip);
    let found = search::equilibria(&problem);
    if found.is_empty() {
        let dimensionless = (LARGEST_PHASE / problem.root_compliance).powi(2);
        let distance = problem.distance();
        return Err(ElasticaError::NotFound { most: dimensionless * units.force, dimensionless, distance });
    }
    let mut all: Vec<_> = found.into_iter().map(|one| equilibrium(model, &problem, one, units)).collect();
    all.sort_by(|one, other| one.potential_energy.total_cmp(&other.potential_energy));
    order_images(&mut all, units);
    Ok(one_of_each_family(all, units))
}

/// Whether two equilibria have one energy.
fn alike<M>(one: &ElasticaEquilibrium<M>, other: &ElasticaEquilibrium<M>, units: Units) -> bool {
    let size = units.energy + one.potential_energy.abs() + one.bending_energy;
    (other.potential_energy - one.potential_energy).abs() <= SAME_ENERGY * size
}

/// Puts equilibria of one energy, such as mirror images, in the order of their moments at the clamp: first those that bend to the left.
fn order_images<M>(all: &mut [ElasticaEquilibrium<M>], units: Units) {
    for run in all.chunk_by_mut(|one, other| alike(one, other, units)) {
        run.sort_by(|one, other| one.reactions.m0z.total_cmp(&other.reactions.m0z));
    }
}

/// Leaves one of those critical equilibria of one energy that are more than a pair of mirror images: they belong to a family.
fn one_of_each_family<M>(all: Vec<ElasticaEquilibrium<M>>, units: Units) -> Vec<ElasticaEquilibrium<M>> {
    let related = |one: &ElasticaEquilibrium<M>, other: &ElasticaEquilibrium<M>| {
        let directions = [one, other].map(|one| one.unstable_directions);
        one.critical && other.critical && directions[0] == directions[1] && alike(one, other, units)
    };
    let relatives = |one: &ElasticaEquilibrium<M>| all.iter().filter(|other| related(one, other)).count();
    let is_of_family: Vec<bool> = all.iter().map(|one| relatives(one) > 2).collect();
    let mut kept: Vec<ElasticaEquilibrium<M>> = Vec::new();
    for (one, is_of_family) in all.into_iter().zip(is_of_family) {
        if !(is_of_family && kept.iter().any(|other| related(&one, other))) {
            kept.push(one);
        }
    }
    kept
}

fn equilibrium<M: RodModel + Clone>(
    model: &M,
    problem: &Problem<'_, M>,
    found: Found<'_, M>,
    units: Units,
) -> ElasticaEquilibrium<M> {
    let Found { shape, force, residual } = found;
    let (unstable_directions, critical) = unstable_directions(problem, &shape, force);
    let total = [problem.total[0] + force[0], problem.total[1] + force[1]];
    let work = work(problem, &shape) * units.energy;
    let tip = tip_load(problem, &shape, force, units);
    let mut segments = shape.nodes;
    let first = segments[0];
    let (a, b) = components(total);
    if (first.a, first.b) != (a, b) {
        // loads at the clamp itself
        segments.insert(0, Segment { a, b, ..first });
    }
    let shape = Elastica::of_segments(model.clone(), units, segments);
    // that of a straight rod may be rounding below 0
    let bending_energy = shape.bending_energy().max(0.0);
    ElasticaEquilibrium {
        reactions: shape.reactions(),
        tip,
        bending_energy,
        potential_energy: bending_energy - work,
        stable: unstable_directions == 0 && !critical,
        unstable_directions,
        critical,
        residual,
        shape,
    }
}

fn tip_load<M: RodModel>(problem: &Problem<'_, M>, shape: &Shape<'_, M>, force: [f64; 2], units: Units) -> TipLoad {
    let given = |end: TipEnd| if let TipEnd::Loaded(force) = end { force } else { 0.0 };
    let moment = match problem.tip.phi {
        TipEnd::Loaded(moment) => moment,
        TipEnd::Held(_) => shape.cut(1.0).moment,
    };
    TipLoad {
        fx: (given(problem.tip.x) + force[0]) * units.force,
        fy: (given(problem.tip.y) + force[1]) * units.force,
        moment: moment * units.moment,
    }
}

/// Work of the given loads from the shape at rest.
fn work<M: RodModel>(problem: &Problem<'_, M>, shape: &Shape<'_, M>) -> f64 {
    let rest = |s: f64| problem.rod.carry(0.0, &problem.start(0.0), 0.0, 0.0, s);
    // the force on an interval times how much further its ends have moved apart
    let moved = |s: f64| {
        let (Cut { x, y, .. }, rest) = (shape.cut(s), rest(s));
        [x - rest.x, y - rest.y]
    };
    let intervals = problem.breaks.windows(2).zip(&problem.ahead);
    let forces: f64 = intervals
        .map(|(ends, force)| {
            let (from, to) = (moved(ends[0]), moved(ends[1]));
            force[0] * (to[0] - from[0]) + force[1] * (to[1] - from[1])
        })
        .sum();
    match problem.tip.phi {
        TipEnd::Loaded(moment) => forces + moment * (shape.cut(1.0).phi - rest(1.0).phi),
        TipEnd::Held(_) => forces,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::Rod;

    #[test]
    fn a_family_is_one_critical_equilibrium() {
        // a closed loop slides along itself
        let clamp = Pose { x: 0.2, y: -0.1, phi: 0.7 };
        let found = elastica_equilibria(&Rod::new(1.0, 1.0).unwrap(), clamp, &[], &Tip::pose(clamp)).unwrap();
        let first = &found[0];
        assert!(first.critical && !first.stable && first.unstable_directions == 0);
        let energies: Vec<f64> = found.iter().map(|one| one.potential_energy).collect();
        assert!(energies.windows(2).all(|pair| pair[1] > 1.001 * pair[0]), "{energies:?}");
    }

    #[test]
    fn where_nothing_is_found_the_message_says_where_the_tip_is() {
        let message = |distance| ElasticaError::NotFound { most: 1.0, dimensionless: 1.0, distance }.to_string();
        assert!(message(0.95).contains("0.950 L from the clamp, expected a tip further from full extension"));
        assert!(!message(0.71).contains("full extension"));
    }
}
