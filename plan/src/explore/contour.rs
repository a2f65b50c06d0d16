//! Scans along the contour that is known, and how it may go on.

use super::ExploreError;
use super::ExplorerSettings;
use super::free_space::FreeSpace;
use crate::forecast::{candidates_of, hypotheses, plan_of};
use crate::{Candidate, Forecast, Measurement, PlanError, PlanSettings, ReachGrid};
use rod_core::Rod;
use rod_reconstruct::FittedObject;

/// The candidate that adds most to what is known, and what it adds (m): length newly touched, and length of the contour that gets as certain as asked for. None where
/// nothing is known, or no scan is safe.
pub(super) fn best_scan(
    rod: &Rod,
    settings: &ExplorerSettings,
    known: &[FittedObject],
    space: &FreeSpace,
    is_allowed: impl Fn(&Candidate) -> bool,
) -> Result<Option<(Forecast, f64)>, ExploreError> {
    let grid =
        ReachGrid { distances: settings.distances.clone(), angles: settings.angles.clone(), ..ReachGrid::of(rod) };
    let plan_settings = PlanSettings {
        hypotheses: settings.hypotheses,
        seed: settings.seed,
        speed: settings.speed,
        measurement: Some(Measurement::of(&settings.noise, settings.spacing, known, rod.length())),
    };
    // chains that contradict each other give no object: the longest ones hold
    let mut chains: Vec<FittedObject> = known.to_vec();
    chains.sort_by_key(|chain| std::cmp::Reverse(chain.points.len()));
    let hypotheses = loop {
        match hypotheses(&chains, rod.length(), &plan_settings, &|point| space.may_be(point)) {
            Err(PlanError::NothingKnown) if chains.len() > 1 => chains.pop(),
            Err(PlanError::NothingKnown) => return Ok(None),
            all => break all?,
        };
    };
    let candidates = candidates_of(&hypotheses, &grid, rod.length())?;
    let safe: Vec<Candidate> =
        candidates.into_iter().filter(|candidate| space.allows(candidate.path) && is_allowed(candidate)).collect();
    if safe.is_empty() {
        return Ok(None);
    }
    let plan = plan_of(rod, &chains, hypotheses, &safe, &plan_settings, &|_| true)?;
    let allowed = plan.allowed(Some(settings.largest_stress));
    let forecasts = plan.forecasts.iter().enumerate().filter(|(k, _)| allowed.contains(k)).map(|(_, one)| one);
    let valued = forecasts.map(|forecast| (forecast, forecast.gain + forecast.improved(settings.sigma)));
    let best = valued.reduce(|best, one| if one.1 > best.1 { one } else { best });
    Ok(best.map(|(forecast, value)| (forecast.clone(), value)))
}
