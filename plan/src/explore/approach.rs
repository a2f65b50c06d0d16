//! Scans into space of which nothing is known.

use super::free_space::FreeSpace;
use super::{ExplorerSettings, Rectangle};
use crate::{Pass, StraightScan};
use rod_contact::ClampPath;
use rod_core::Rod;

/// How far the tip of the straight rod goes beyond the nearest place that the rod has not passed, rod lengths. No object is nearer to the clamp's path than the rest of the
/// rod. Larger: fewer scans, and larger stress where the object begins at once, so that the rig stops.
pub(super) const DEPTH: f64 = 0.5;

/// Relative difference of areas that rounding makes.
const EQUAL: f64 = 1e-9;

/// The scan that goes through the largest area that the rod has not passed, with the tip of the rod only; of equal ones the first that no scan `came_from` the side of, else
/// the first. None where the stage allows none.
pub(super) fn approach(
    rod: &Rod,
    settings: &ExplorerSettings,
    space: &FreeSpace,
    is_allowed: impl Fn(ClampPath) -> bool,
    came_from: impl Fn(ClampPath) -> bool,
) -> Option<ClampPath> {
    let candidate = |(number, &angle): (usize, &f64)| {
        let limit = space.frontier(angle)? + DEPTH * rod.length();
        // alternating passes: the rod trails to either side
        let pass = Pass::BOTH[number % 2];
        let scan = StraightScan { distance: (1.0 - DEPTH) * rod.length(), angle, pass };
        let across = Rectangle::extent(&settings.object, angle + std::f64::consts::FRAC_PI_2);
        let path = scan.path(limit - DEPTH * rod.length(), across, rod.length()).ok()?;
        (space.allows(path) && is_allowed(path)).then(|| (path, space.unknown_area(angle, limit)))
    };
    let all = settings.angles.iter().enumerate().filter_map(candidate);
    let is_better = |(path, area): &(ClampPath, f64), (other, than): &(ClampPath, f64)| {
        let are_equal = (area - than).abs() <= EQUAL * than;
        if are_equal { came_from(*other) && !came_from(*path) } else { area > than }
    };
    all.reduce(|best, one| if is_better(&one, &best) { one } else { best }).map(|best| best.0)
}
