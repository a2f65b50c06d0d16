//! The equations of a contact set solved from a rough guess: from several starts, until a root is one that a rod may be in.

use crate::contact_set::guess::{GuessedContact, along_chords, by_chords, by_forces, configuration_of_guess};
use crate::contact_set::{Configuration, Unknowns};
use crate::continuation::branch::Corrector;
use crate::scene::Setup;
use crate::scene::world::World;
use rod_core::{PhysicalRod, SolveReport};

type Root = (Configuration, SolveReport);

/// Newton's method from each start, then `rescue` from each (none where there is no such method): the first root in which no contact
/// pulls, lies beyond the tip, out of order or off its piece; else the first root; else what the first solve came to. `rescue` is only tried where
/// Newton's method finds no root.
pub(crate) fn solve_guess<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    supposed: &[GuessedContact],
    mut rescue: impl FnMut(&mut Corrector<'_, R>, &mut Configuration) -> Option<SolveReport>,
) -> Root {
    let [first, second, third] = starts(&corrector.setup, supposed);
    let mut best = by_newton(corrector, &first);
    for start in [&second, &third] {
        if is_plausible(&corrector.setup.world, &best) {
            return best;
        }
        let root = by_newton(corrector, start);
        best = better(&corrector.setup.world, best, root);
    }
    if best.1.status.is_solved() {
        return best;
    }
    // the chords, which do not depend on forces and arc lengths, lead the trust region to a root most often
    for start in [third, first, second] {
        let mut configuration = start;
        let Some(report) = rescue(corrector, &mut configuration) else { return best };
        best = better(&corrector.setup.world, best, (configuration, report));
        if is_plausible(&corrector.setup.world, &best) {
            break;
        }
    }
    best
}

fn by_newton<R: PhysicalRod>(corrector: &mut Corrector<'_, R>, start: &Configuration) -> Root {
    let mut configuration = start.clone();
    let report = corrector.solve_from_guess(&mut configuration, 0.0);
    (configuration, report)
}

fn better(world: &World<'_>, best: Root, other: Root) -> Root {
    let gained = other.1.status.is_solved() && (!best.1.status.is_solved() || is_plausible(world, &other));
    if gained { other } else { best }
}

/// Whether a solve came to a root that a rod may be in, as far as that costs nothing to see.
fn is_plausible(world: &World<'_>, (configuration, report): &Root) -> bool {
    let holds = |j| configuration.force(j) >= 0.0 && configuration.s(j) <= 1.0;
    let solved = report.status.is_solved();
    solved
        && (0..configuration.count()).all(holds)
        && configuration.is_ordered(world)
        && configuration.off_piece(world).is_none()
}

/// Where a solve may start: with the arc lengths and forces of the guess and the slope angles of arcs or those by the forces, the
/// smaller residual first, since a force may be a mere guess; then with arc lengths and slope angles of the chords.
fn starts<R: PhysicalRod>(setup: &Setup<'_, R>, supposed: &[GuessedContact]) -> [Configuration; 3] {
    let clamp = setup.path.at(0.0);
    let arcs = configuration_of_guess(supposed, &by_chords(clamp, supposed, 2.0));
    let by_forces = configuration_of_guess(supposed, &by_forces(setup.rod.model(), &setup.clamp(0.0), supposed));
    let chords = configuration_of_guess(&along_chords(clamp, supposed), &by_chords(clamp, supposed, 1.0));
    let off = |configuration: &Configuration| {
        let (supports, u) = (configuration.supports(&setup.world), configuration.of_contacts());
        let mut residual = Unknowns::from_elem(0.0, u.len());
        setup.problem(&supports, 0.0).evaluate_into(u, &mut residual, None);
        residual.iter().map(|r| r * r).sum::<f64>()
    };
    if off(&by_forces) < off(&arcs) { [by_forces, arcs, chords] } else { [arcs, by_forces, chords] }
}
