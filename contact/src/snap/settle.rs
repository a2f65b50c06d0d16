//! From a guess of the contacts to a verified equilibrium at one pose: solve, look what is broken, mend the contact set,
//! solve again.

use crate::contact_set::Configuration;
use crate::contact_set::edit::{as_tangent, as_tip, beyond_corner, onto_neighbour, without};
use crate::contact_set::notch::parted;
use crate::contact_set::order::ordered;
use crate::continuation::branch::Corrector;
use crate::continuation::step::Seen;
use crate::continuation::transition::{Break, breaks, with_contact};
use crate::gap::scan::Scanner;
use crate::scene::world::World;

/// Most repairs of one guess.
const MOST_REPAIRS: usize = 12;

/// Mends `guess` at its own pose until it is an equilibrium that holds (nothing is broken, and it is stable); none
/// where that does not come about.
pub(crate) fn settle(corrector: &mut Corrector<'_>, scanner: &mut Scanner, guess: Configuration) -> Option<Seen> {
    let mut configuration = guess;
    let tau = configuration.tau();
    for _ in 0..MOST_REPAIRS {
        let report = (configuration.count() > 0).then(|| corrector.solve_from_guess(&mut configuration, tau));
        if report.is_some_and(|r| !r.status.is_solved()) || !ordered(&corrector.setup.world, &configuration) {
            return None;
        }
        let scan = scanner.scan(&corrector.setup, &configuration);
        let mut worst = None;
        breaks(&corrector.setup.world, &configuration, &scan.crossings, |b| {
            let weight = badness(&b, &configuration);
            if worst.is_none_or(|(w, _)| weight > w) {
                worst = Some((weight, b));
            }
        });
        match worst {
            Some((_, b)) => configuration = mend(configuration, b, &corrector.setup.world),
            None => {
                let stable = scanner.is_stable(&corrector.setup.world, &configuration, &scan);
                return (scan.is_outside() && stable).then_some(Seen { configuration, scan });
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

fn mend(configuration: Configuration, b: Break, world: &World<'_>) -> Configuration {
    match b {
        Break::Release(j) => without(configuration, j),
        Break::Border(j, upwards) => {
            slid(&configuration, j, upwards, world).unwrap_or_else(|| without(configuration, j))
        }
        Break::TipToTangent(angle) => as_tangent(configuration, angle),
        Break::OntoWall(wall, _) => parted(world, &configuration, wall),
        Break::TangentToTip => as_tip(configuration, world),
        Break::Touch(crossing) => with_contact(&configuration, &crossing).0,
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_set::{Held, Unknown};
    use crate::path::ClampPath;
    use crate::scene::setup::Setup;
    use rod_contours::{Composite, Parabola};
    use rod_core::{Hold, Pose, Rod};

    /// What becomes of a guess for a level rod, its clamp at (-0.5, `y`), below the solid above y = x^2.
    fn settled(y: f64, guess: Configuration) -> Option<Configuration> {
        let ceiling = Composite::single(Parabola::new([0.0, 0.0], 1.0).unwrap()).unwrap();
        let path = ClampPath::standing(Pose { x: -0.5, y, phi: 0.0 });
        let mut corrector = Corrector::new(Setup::new(&Rod::new(1.0, 1.0).unwrap(), ceiling.as_ref(), path));
        settle(&mut corrector, &mut Scanner::default(), guess).map(|seen| seen.configuration)
    }

    #[test]
    fn a_rod_that_goes_through_gets_a_contact() {
        let held = settled(0.02, Configuration::free(0.0)).unwrap();
        assert!(held.count() == 1 && !held.is_tip(0) && held.force(0) > 0.0);
    }

    #[test]
    fn a_contact_that_pulls_is_let_go() {
        let mut pulled = Configuration::free(0.0);
        pulled.insert(0, Held { stretch: 0, hold: Hold::Tangent { offset: 0.0 } }, [0.0, 1.0, 0.5]);
        assert_eq!(settled(-0.02, pulled).unwrap().count(), 0);
    }

    #[test]
    fn a_tip_that_lies_down_gets_a_tangential_contact() {
        let side = settled(0.02, Configuration::free(0.0)).unwrap();
        let mut tip = side.clone();
        tip.contacts[0].hold = Hold::Tip;
        tip.set(Unknown::Slope(0), -0.1);
        let mended = settled(0.02, tip).unwrap();
        assert!(!mended.is_tip(0) && (mended.s(0) - side.s(0)).abs() < 1e-9);
    }
}
