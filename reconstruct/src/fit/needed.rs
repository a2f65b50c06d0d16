//! The shared errors that a recording asks for, chosen by evidence.
//!
//! Where all errors are free, each moves by what noise and the freedom of the contour let it: an offset of the sensor alone moved 26 errors by up to half
//! of their budgets, and the contour by 0.1 mm. A fit with fewer free errors that explains the recording is preferred. The others are as they are known;
//! what they may be stays in the standard deviations of the contact points.

use super::AGAIN;
use super::blocks::Blocks;
use super::curve::Curve;
use super::posterior::numbers;
use super::problem::{FreeError, Sources};
use super::solve::{Search, Solved};
use crate::systematic::BEYOND;
use nalgebra::DVector;
use rod_core::PhysicalRod;

/// The fit with friction besides all errors of another one, and these, where it is beyond what the errors leave open; none where it is not.
pub(super) fn with_friction<R: PhysicalRod>(
    rod: &R,
    all: &Sources,
    best: &Solved,
    blocks: &Blocks,
) -> Option<(Solved, Sources)> {
    let sources = all.and_friction();
    let with = |errors: DVector<f64>, curve: &Curve| {
        let errors = errors.resize_vertically(sources.free.len(), 0.0);
        let mut search = Search { rod, sources: &sources, errors: &errors, evaluations: AGAIN };
        search.continued(curve, best, blocks).filter(|found| found.goodness.explains)
    };
    // errors that make up for friction may be far off: then they are as they are known at first
    let anew = || with(DVector::zeros(all.free.len()), &best.curve_anew()?);
    let found = with(best.errors(), &best.curve).or_else(anew)?;
    let posterior = found.posterior(sources.free.len());
    let is_beyond = |i: usize| posterior.errors[i].abs() > BEYOND * posterior.covariance[(i, i)].sqrt();
    (all.free.len()..sources.free.len()).any(is_beyond).then_some((found, sources))
}

/// The fit with the most probable free errors, and these, from a fit with all of them; none where none that explains the recording is more probable than
/// that.
pub(super) fn with_fewest_errors<R: PhysicalRod>(
    rod: &R,
    all: &Sources,
    best: &Solved,
    blocks: &Blocks,
) -> Option<(Solved, Sources)> {
    let (mut found, mut sources) = with_fewer_errors(rod, all, best, blocks, all.free.len())?;
    // near this set, another one may be the more probable
    while let Some(fewer) = with_fewer_errors(rod, &sources, &found, blocks, all.free.len()) {
        (found, sources) = fewer;
    }
    // other errors may be what one of them explains
    let posterior = best.posterior(all.free.len());
    let spread = |(error, value): (&FreeError, &f64)| {
        let i = all.free.iter().position(|one| one == error)?;
        Some(posterior.spread_about(i, *value))
    };
    let spread = sources.free.iter().zip(found.errors().iter()).map(spread).collect::<Option<_>>()?;
    Some((found.with_spread(spread), sources))
}

/// The same with fewer errors than those of `sources`, of `possible` ones.
fn with_fewer_errors<R: PhysicalRod>(
    rod: &R,
    sources: &Sources,
    best: &Solved,
    blocks: &Blocks,
    possible: usize,
) -> Option<(Solved, Sources)> {
    let posterior = best.posterior(possible);
    let mut most_probable: Option<(f64, Solved, Sources)> = None;
    for free in posterior.sets(sources) {
        // the cost is not quadratic: the fit itself must be the more probable one. With fewer errors it does not fall
        let least = posterior.penalty(&free) - posterior.without(&free)?.1;
        let so_far = most_probable.as_ref().map_or(0.0, |one| one.0);
        if least >= so_far {
            continue;
        }
        let (kept, fixed) = (numbers(&free, true), numbers(&free, false));
        let fewer = Sources { free: kept.iter().map(|i| sources.free[*i]).collect(), ..sources.clone() };
        let (curve, errors) = best.without(&fixed, &kept)?;
        let mut search = Search { rod, sources: &fewer, errors: &errors, evaluations: AGAIN };
        let Some(found) = search.unchanged(&curve, best, blocks) else { continue };
        let penalty = found.cost - best.cost + least;
        if found.goodness.explains && penalty < so_far {
            most_probable = Some((penalty, found, fewer));
        }
    }
    most_probable.map(|(_, found, fewer)| (found, fewer))
}
