//! Where a rod lands that has lost its equilibrium: the descent of its energy (`chain`), and the equilibrium next to where that comes to
//! rest. From a guess of the contacts to a verified equilibrium at one pose: solve, look for violated conditions, mend the contact set,
//! solve again.

pub(crate) mod chain;

use crate::contact_set::edit::{as_tangent, as_tip, beyond_corner, onto_neighbour, without_contact};
use crate::contact_set::notch::split_onto_walls;
use crate::contact_set::{ActiveContact, Configuration, Contacts, Unknown};
use crate::continuation::Seen;
use crate::continuation::branch::Corrector;
use crate::continuation::transition::{Break, breaks, with_contact};
use crate::gap::Scanner;
use crate::scene::world::World;
use crate::snap::chain::Chain;
use rod_core::{Hold, PhysicalRod};
use smallvec::SmallVec;

/// Limit of repairs of one guess.
const MOST_REPAIRS: usize = 12;

/// Solves `guess` at its own pose and changes its contact set until it is a stable equilibrium of which no condition is violated. None where no
/// such equilibrium is found.
pub(crate) fn settle<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    scanner: &mut Scanner,
    guess: Configuration,
) -> Option<Seen> {
    let mut configuration = guess;
    let tau = configuration.tau();
    let mut tried: SmallVec<[Contacts; 4]> = SmallVec::new();
    for _ in 0..MOST_REPAIRS {
        tried.push(configuration.contacts.clone());
        let start = configuration.clone();
        let report = (configuration.count() > 0).then(|| corrector.solve_from_guess(&mut configuration, tau));
        let world = &corrector.setup.world;
        if report.is_some_and(|r| !r.status.is_solved()) || !configuration.is_ordered(world) {
            configuration = onto_end(start, world)?;
            continue;
        }
        let scan = scanner.scan(&corrector.setup, &configuration);
        let mut broken: SmallVec<[(f64, Break); 4]> = SmallVec::new();
        breaks(world, &configuration, &scan.crossings, |b| broken.push((badness(&b, &configuration), b)));
        if broken.is_empty() {
            let stable = scanner.is_stable(&corrector.setup, &configuration, &scan);
            return (scan.is_outside() && stable).then_some(Seen { configuration, scan });
        }
        // what has led back to a contact set that does not hold is left as it is
        broken.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut mended = broken.into_iter().map(|(_, b)| mend(configuration.clone(), b, world));
        configuration = mended.find(|mended| !tried.contains(&mended.contacts))?;
    }
    None
}

/// The first acceptable equilibrium of those where the chain comes to rest, with its clamp at `tau`.
pub(crate) fn settle_chain<R: PhysicalRod>(
    chain: &mut Chain,
    corrector: &mut Corrector<'_, R>,
    scanner: &mut Scanner,
    tau: f64,
    accept: impl Fn(&World<'_>, &Seen) -> bool,
) -> Option<Seen> {
    let guesses = chain.settle(&corrector.setup.world, tau);
    guesses
        .into_iter()
        .find_map(|guess| settle(corrector, scanner, guess).filter(|found| accept(&corrector.setup.world, found)))
}

/// The order in which violated conditions are mended: a force that pulls first, then the deepest penetration.
fn badness(b: &Break, configuration: &Configuration) -> f64 {
    match b {
        Break::Release(j) => 1e3 - configuration.force(*j),
        Break::TangentToTip | Break::TipToTangent(_) | Break::OntoWall(..) | Break::Border(..) | Break::Slip(..) => 1e2,
        Break::Touch(crossing) => -crossing.foot.gap,
    }
}

fn mend(configuration: Configuration, b: Break, world: &World<'_>) -> Configuration {
    match b {
        Break::Release(j) => without_contact(configuration, j),
        Break::Border(j, upwards) => {
            slide_over_end(&configuration, j, upwards, world).unwrap_or_else(|| without_contact(configuration, j))
        }
        Break::TipToTangent(angle) => as_tangent(configuration, angle),
        Break::OntoWall(wall, _) => split_onto_walls(world, &configuration, wall),
        Break::TangentToTip => back_to_tip(configuration, world),
        Break::Slip(j, ratio) => {
            let mut slips = configuration;
            slips.set_slipping(j, ratio);
            slips
        }
        Break::Touch(crossing) => with_contact(&configuration, &crossing).0,
    }
}

/// Contact j moved over an end of its stretch: onto the next one, or, where it is the tip's, over the corner there onto the
/// piece beyond. None where the contour ends.
fn slide_over_end(configuration: &Configuration, j: usize, upwards: bool, world: &World<'_>) -> Option<Configuration> {
    let over = configuration.is_tip(j).then(|| beyond_corner(configuration.clone(), world)).flatten();
    over.or_else(|| {
        let next = world.neighbour(configuration.contacts[j].stretch, upwards)?;
        Some(onto_neighbour(configuration.clone(), j, upwards, next, world))
    })
}

/// The last contact, tangential beyond the tip, as a contact of the tip, at the point of its stretch that is nearest to the tip.
fn back_to_tip(configuration: Configuration, world: &World<'_>) -> Configuration {
    let last = configuration.count() - 1;
    let (stretch, beyond) = (configuration.contacts[last].stretch, configuration.s(last) - 1.0);
    let at = world.support(stretch, configuration.t(last));
    let mut tip = as_tip(configuration, world);
    let (sin, cos) = tip.slope(last).sin_cos();
    let foot = world.foot(stretch, at.x - beyond * cos, at.y - beyond * sin);
    tip.set(Unknown::Parameter(last), foot.t);
    tip
}

/// The last contact, along a straight edge, at the end of that edge on the clamp's side: a rod that is bent too much to lie on
/// the edge rolls back to there. None where the contour does not bend away there.
fn onto_end(mut configuration: Configuration, world: &World<'_>) -> Option<Configuration> {
    let last = configuration.count().checked_sub(1)?;
    let ActiveContact { stretch, hold: Hold::Tangent { offset }, .. } = configuration.contacts[last] else {
        return None;
    };
    let at = world.support(stretch, configuration.t(last));
    let after = offset.cos() < 0.0;
    let next = world.neighbour(stretch, after).filter(|next| at.turning == 0.0 && !world.is_notch(*next))?;
    let end = world.support(stretch, world.border(stretch, after));
    let way = (end.x - at.x).hypot(end.y - at.y);
    let s = configuration.s(last) - way;
    configuration = onto_neighbour(configuration, last, after, next, world);
    configuration.set(Unknown::ArcLength(last), s);
    (s > 0.0).then_some(configuration)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::ClampPath;
    use crate::scene::Setup;
    use rod_contours::{Composite, Parabola};
    use rod_core::{Pose, Rod};

    /// What becomes of a guess for a level rod, its clamp at (-0.5, `y`), below the solid above y = x^2.
    fn settle_guess(y: f64, guess: Configuration) -> Option<Configuration> {
        let ceiling = Composite::single(Parabola::new([0.0, 0.0], 1.0).unwrap()).unwrap();
        let path = ClampPath::standing(Pose { x: -0.5, y, phi: 0.0 });
        let mut corrector = Corrector::new(Setup::new(&Rod::new(1.0, 1.0).unwrap(), ceiling.as_ref(), path));
        settle(&mut corrector, &mut Scanner::default(), guess).map(|seen| seen.configuration)
    }

    #[test]
    fn a_rod_that_goes_through_gets_a_contact() {
        let held = settle_guess(0.02, Configuration::free(0.0)).unwrap();
        assert!(held.count() == 1 && !held.is_tip(0) && held.force(0) > 0.0);
    }

    #[test]
    fn a_contact_that_pulls_is_let_go() {
        let mut pulled = Configuration::free(0.0);
        pulled.insert(0, ActiveContact::smooth(0, Hold::Tangent { offset: 0.0 }), [0.0, 1.0, 0.5]);
        assert_eq!(settle_guess(-0.02, pulled).unwrap().count(), 0);
    }

    #[test]
    fn a_tip_that_lies_down_gets_a_tangential_contact() {
        let side = settle_guess(0.02, Configuration::free(0.0)).unwrap();
        let mut tip = side.clone();
        tip.contacts[0].hold = Hold::Tip;
        tip.set(Unknown::Slope(0), -0.1);
        let mended = settle_guess(0.02, tip).unwrap();
        assert!(!mended.is_tip(0) && (mended.s(0) - side.s(0)).abs() < 1e-9);
    }
}
