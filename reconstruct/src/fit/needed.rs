//! The shared errors that a recording asks for, chosen by evidence.
//!
//! Where all errors are free, each moves by what noise and the freedom of the contour let it: an offset of the sensor alone moved 26 errors by up to half
//! of their budgets, and the contour by 0.1 mm. A fit with fewer free errors that explains the recording is preferred. The others are as they are known;
//! what they may be stays in the standard deviations of the contact points.

use super::AGAIN;
use super::blocks::Blocks;
use super::posterior::numbers;
use super::problem::Sources;
use super::solve::{Search, Solved};
use rod_core::PhysicalRod;

/// The fit with the most probable free errors, and these, from a fit with all of them; none where none that explains the recording is more probable than
/// that.
pub(super) fn with_fewest_errors<R: PhysicalRod>(
    rod: &R,
    all: &Sources,
    best: &Solved,
    blocks: &Blocks,
) -> Option<(Solved, Sources)> {
    let posterior = best.posterior();
    posterior.sets(all).into_iter().find_map(|free| {
        let (kept, fixed) = (numbers(&free, true), numbers(&free, false));
        let sources = Sources { free: kept.iter().map(|i| all.free[*i]).collect(), ..all.clone() };
        let (curve, errors) = best.without(&fixed, &kept)?;
        let mut search = Search { rod, sources: &sources, errors: &errors, evaluations: AGAIN };
        let found = search.continued(&curve, best, blocks)?;
        // the cost is not quadratic: the fit itself must be the more probable one
        let rise = found.cost - best.cost;
        let is_worth = found.goodness.explains && rise + posterior.penalty(&free) - posterior.without(&free)?.1 < 0.0;
        // other errors may be what one of them explains
        let spread =
            kept.iter().zip(found.errors().iter()).map(|(i, value)| posterior.spread_about(*i, *value)).collect();
        is_worth.then(|| (found.with_spread(spread), sources))
    })
}
