//! Scans along the contour that is known, and how it may go on.

use super::ExploreError;
use super::ExplorerSettings;
use super::free_space::FreeSpace;
use crate::choice::exhaustive;
use crate::forecast::{candidates_of, hypotheses, plan_of};
use crate::hypothesis::Hypothesis;
use crate::{Candidate, Forecast, Measurement, PlanError, PlanSettings, ReachGrid};
use rod_contact::ClampPath;
use rod_core::Rod;
use rod_reconstruct::FittedObject;

/// Scans that are planned together; only the best of them is made. One alone overlaps with what is known or leaves a remainder for which a further scan is needed.
/// All sets of so many are tried: with three, a hundred candidates have 160,000.
const AHEAD: usize = 2;

/// The better one of the two scans that together add most to what is known, and what it adds (m): length newly touched, and length of the contour that gets as certain as
/// asked for. None where nothing is known, or no safe scan adds [`ExplorerSettings::least_gain`].
pub(super) fn best_scan(
    rod: &Rod,
    settings: &ExplorerSettings,
    known: &[FittedObject],
    space: &FreeSpace,
    is_allowed: impl Fn(ClampPath) -> bool,
) -> Result<Option<(Forecast, ClampPath, f64)>, ExploreError> {
    let grid =
        ReachGrid { distances: settings.distances.clone(), angles: settings.angles.clone(), ..ReachGrid::of(rod) };
    let plan_settings = plan_settings(rod, settings, known);
    let Some(hypotheses) = drawn(rod, &plan_settings, known, space)? else { return Ok(None) };
    let candidates = candidates_of(&hypotheses, grid.scans(), rod.length(), &|| true)?;
    let is_safe = |path: ClampPath| space.allows(path) && is_allowed(path);
    let safe: Vec<Candidate> =
        candidates.into_iter().filter(|candidate| candidate.path.straight().is_some_and(is_safe)).collect();
    if safe.is_empty() {
        return Ok(None);
    }
    let plan = plan_of(rod, known, hypotheses, &safe, &plan_settings, &|_| true)?;
    let allowed = plan.allowed();
    let worth = |taken: &[usize]| plan.value(taken) + plan.improved(taken, settings.sigma);
    let own = |taken: &[usize]| taken.iter().map(|k| allowed[*k]).collect::<Vec<_>>();
    let (ahead, _) = exhaustive(allowed.len(), AHEAD, &|taken: &[usize]| worth(&own(taken)));
    let valued = own(&ahead).into_iter().map(|k| (k, worth(&[k]))).filter(|one| one.1 >= settings.least_gain);
    let best = valued.reduce(|best, one| if one.1 > best.1 { one } else { best });
    Ok(best.and_then(|(k, value)| {
        let forecast = plan.forecasts[k].clone();
        let path = forecast.candidate.path.straight()?;
        Some((forecast, path, value))
    }))
}

/// Whether an object can be drawn through what is known of a contour.
///
/// # Errors
/// [`ExploreError`].
pub(super) fn is_drawn(
    rod: &Rod,
    settings: &ExplorerSettings,
    known: &[FittedObject],
    space: &FreeSpace,
) -> Result<bool, ExploreError> {
    Ok(drawn(rod, &plan_settings(rod, settings, known), known, space)?.is_some())
}

fn plan_settings(rod: &Rod, settings: &ExplorerSettings, known: &[FittedObject]) -> PlanSettings {
    PlanSettings {
        hypotheses: settings.hypotheses,
        seed: settings.seed,
        speed: settings.speed,
        most_stress: Some(settings.largest_stress),
        measurement: Some(Measurement::of(&settings.noise, settings.spacing, known, rod.length())),
    }
}

/// Touched points (m) through which no object is drawn.
pub(super) fn left_out(
    rod: &Rod,
    settings: &ExplorerSettings,
    known: &[FittedObject],
    space: &FreeSpace,
) -> Vec<[f64; 2]> {
    let all = Hypothesis::all(known, rod.length(), (0, settings.seed), &|point| space.may_be(point));
    all.into_iter().next().map_or_else(Vec::new, |one| one.left_out)
}

/// Objects through what is known of a contour; none where there is no such object.
fn drawn(
    rod: &Rod,
    settings: &PlanSettings,
    known: &[FittedObject],
    space: &FreeSpace,
) -> Result<Option<Vec<Hypothesis>>, ExploreError> {
    match hypotheses(known, rod.length(), settings, &|point| space.may_be(point)) {
        Err(PlanError::NothingKnown) => Ok(None),
        all => Ok(Some(all?)),
    }
}
