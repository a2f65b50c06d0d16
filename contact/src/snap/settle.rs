//! From a guess of the contacts to a verified equilibrium at one pose: solve, look what is broken, mend the contact set,
//! solve again.

use crate::contact_set::Configuration;
use crate::contact_set::edit::{as_tangent, as_tip, beyond_corner, onto_neighbour};
use crate::contact_set::notch::parted;
use crate::contact_set::order::ordered;
use crate::continuation::branch::Corrector;
use crate::continuation::transition::{Break, breaks, with_contact};
use crate::gap::scan::Scanner;
use crate::scene::world::World;

/// Most repairs of one guess.
const MOST_REPAIRS: usize = 12;

/// Mends `guess` at its own pose until it is an equilibrium that holds (nothing is broken, and it is stable); none
/// where that does not come about.
pub(crate) fn settle(
    corrector: &mut Corrector<'_>,
    scanner: &mut Scanner,
    guess: Configuration,
) -> Option<Configuration> {
    let mut configuration = guess;
    let tau = configuration.tau();
    for _ in 0..MOST_REPAIRS {
        let report = (configuration.count() > 0).then(|| corrector.solve_from_guess(&mut configuration, tau));
        if report.is_some_and(|r| !r.status.is_solved()) || !ordered(&corrector.setup.world, &configuration) {
            return None;
        }
        let scan = scanner.scan(&corrector.setup, &configuration);
        let mut worst = None;
        breaks(corrector, &configuration, &scan, |b| {
            let weight = badness(&b, &configuration);
            if worst.is_none_or(|(w, _)| weight > w) {
                worst = Some((weight, b));
            }
        });
        match worst {
            Some((_, b)) => configuration = mend(configuration, b, corrector),
            None => {
                let stable = scanner.is_stable(&corrector.setup.world, &configuration, &scan);
                return (scan.is_outside() && stable).then_some(configuration);
            }
        }
    }
    None
}

/// What to mend first: a force that pulls before all, then what is furthest off.
fn badness(b: &Break, configuration: &Configuration) -> f64 {
    match b {
        Break::Release(j) => 1e3 - configuration.force(*j),
        Break::TangentToTip | Break::TipToTangent(_) | Break::OntoWall(..) | Break::Border(..) => 1e2,
        Break::Touch(crossing) => -crossing.foot.gap,
    }
}

fn mend(mut configuration: Configuration, b: Break, corrector: &Corrector<'_>) -> Configuration {
    match b {
        Break::Release(j) => configuration.remove(j),
        Break::Border(j, upwards) => match slid(&configuration, j, upwards, &corrector.setup.world) {
            Some(slid) => configuration = slid,
            None => configuration.remove(j),
        },
        Break::TipToTangent(angle) => configuration = as_tangent(configuration, angle),
        Break::OntoWall(wall, _) => configuration = parted(&corrector.setup.world, &configuration, wall),
        Break::TangentToTip => configuration = as_tip(configuration, &corrector.setup.world),
        Break::Touch(crossing) => configuration = with_contact(&configuration, &crossing).0,
    }
    configuration
}

/// Contact j moved over an end of its stretch: onto the next one, or, where it is the tip's, over the corner there onto the
/// piece beyond. None where the contour ends.
fn slid(configuration: &Configuration, j: usize, upwards: bool, world: &World<'_>) -> Option<Configuration> {
    let over = configuration.is_tip(j).then(|| beyond_corner(configuration.clone(), world)).flatten();
    over.or_else(|| {
        let next = world.neighbour(configuration.contacts[j].stretch, upwards)?;
        Some(onto_neighbour(configuration.clone(), j, upwards, next, world))
    })
}
