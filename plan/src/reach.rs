//! What of an object the scans of a grid of distances and angles touch.

use crate::scan::{Pass, StraightScan};
use crate::scanned::{self, Computation, Progress};
use crate::support::{HalfPlane, along, nearest, outline};
use crate::{Outline, PlanError, Scanned, Touched};
use rayon::prelude::*;
use rod_contact::{ContactError, Path};
use rod_contours::Composite;
use rod_core::PhysicalRod;
use std::sync::Arc;

/// The scans that are tried: all distances at all angles, each with passes to both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachGrid {
    /// Distances of the path from the object's nearest place along the rod, m: more than 0, less than the rod's length.
    pub distances: Vec<f64>,
    /// Directions of the rod at its clamp, rad.
    pub angles: Vec<f64>,
    /// Distance between the states of a sweep, m.
    pub step: f64,
}

impl ReachGrid {
    /// No scans yet, with states every hundredth of the rod's length.
    pub fn of<R: PhysicalRod>(rod: &R) -> Self {
        Self { distances: Vec::new(), angles: Vec::new(), step: scanned::STEP * rod.units().length }
    }

    /// The scans: for each angle and distance a pass to the left and one to the right.
    pub fn scans(&self) -> impl Iterator<Item = StraightScan> + '_ {
        let at = |angle: f64| {
            let both = move |distance: f64| Pass::BOTH.map(|pass| StraightScan { distance, angle, pass });
            self.distances.iter().copied().flat_map(both)
        };
        self.angles.iter().copied().flat_map(at)
    }

    pub(crate) fn check<R: PhysicalRod>(&self, rod: &R) -> Result<(), PlanError> {
        let length = rod.units().length;
        for (what, values) in [("distances", &self.distances), ("angles", &self.angles)] {
            if values.is_empty() {
                return Err(PlanError::Empty { what });
            }
        }
        self.scans().try_for_each(|scan| scan.check(length))?;
        if !(self.step.is_finite() && self.step > 0.0) {
            return Err(ContactError::Step { value: self.step }.into());
        }
        Ok(())
    }
}

/// What one scan touches.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanReach {
    /// The scan.
    pub scan: StraightScan,
    /// What came of it.
    pub found: Scanned,
}

/// What all scans of a grid touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// The outline of each object. One that goes on for ever ends where no straight rod of any scan ends.
    pub outlines: Vec<Outline>,
    /// The scans in the order of [`ReachGrid::scans`]; fewer where the work was ended early.
    pub scans: Vec<ScanReach>,
}

impl Reach {
    /// What any of the scans touches.
    pub fn union(&self) -> Touched {
        let mut union = Touched::nothing(self.outlines.len());
        self.scans.iter().for_each(|scan| union.extend(&scan.found.touched));
        union
    }

    /// Length of all outlines, m.
    pub fn length(&self) -> f64 {
        self.outlines.iter().map(Outline::length).sum()
    }
}

/// Sweeps `rod` past `objects` on all scans of a grid, on all cores, and collects what the contacts go over, without friction. `goes_on` hears
/// how many scans are done, also within a scan, and ends the work where it returns false.
///
/// Where several objects are near each other, the distance counts from the nearest of them. The clamp passes on the near side of all objects.
///
/// # Errors
/// [`PlanError`] where the grid has no scans, or scans that cannot be.
pub fn reach<R: PhysicalRod + Sync>(
    rod: &R,
    objects: &[Composite],
    grid: &ReachGrid,
    goes_on: &(impl Fn(usize) -> bool + Sync),
) -> Result<Reach, PlanError> {
    grid.check(rod)?;
    let length = rod.units().length;
    let of_angle = |&angle: &f64| {
        let of_object = |(number, object): (usize, &Composite)| {
            nearest(object, angle).ok_or(PlanError::NoNearest { object: number, angle })
        };
        let all = objects.iter().enumerate().map(of_object).collect::<Result<Vec<_>, _>>()?;
        Ok(all.into_iter().fold(f64::INFINITY, f64::min))
    };
    let nearest = grid.angles.iter().map(of_angle).collect::<Result<Vec<f64>, PlanError>>()?;
    let closest = grid.distances.iter().copied().fold(f64::INFINITY, f64::min);
    let half_planes: Vec<HalfPlane> = grid
        .angles
        .iter()
        .zip(&nearest)
        .map(|(&angle, near)| HalfPlane { angle, limit: near - closest + length })
        .collect();
    let endless = |(number, object): (usize, &Composite)| {
        outline(object, &half_planes).ok_or(PlanError::Endless { object: number })
    };
    let outlines = objects.iter().enumerate().map(endless).collect::<Result<Vec<_>, _>>()?;
    let scans: Vec<(StraightScan, f64)> = grid
        .scans()
        .zip(nearest.iter().flat_map(|near| std::iter::repeat_n(*near, 2 * grid.distances.len())))
        .collect();
    let progress = Progress::new(goes_on);
    let one = |&(scan, near): &(StraightScan, f64)| {
        let limit = near - scan.distance + length;
        let found = scan_reach(rod, objects, &outlines, scan, (near, limit), (grid.step, &progress));
        (found, progress.count())
    };
    let found = scans.par_iter().map(one).take_any_while(|(_, goes_on)| *goes_on).map(|(found, _)| found);
    let scans = found.collect::<Result<Vec<_>, _>>()?;
    Ok(Reach { outlines, scans })
}

/// One scan; `near` and `limit` (m) are how far in the rod's direction the nearest place of the objects and the tip of the straight rod are.
fn scan_reach<R: PhysicalRod>(
    rod: &R,
    objects: &[Composite],
    outlines: &[Outline],
    scan: StraightScan,
    (near, limit): (f64, f64),
    (step, progress): (f64, &Progress<'_>),
) -> Result<ScanReach, PlanError> {
    let left = scan.angle + std::f64::consts::FRAC_PI_2;
    let places = objects.iter().zip(outlines).flat_map(|(object, outline)| outline.points(object));
    let within = places.filter(|(_, frame)| along(scan.angle, *frame) <= limit).map(|(_, frame)| along(left, frame));
    let across = within.fold((f64::INFINITY, f64::NEG_INFINITY), |ends, place| (ends.0.min(place), ends.1.max(place)));
    let path: Arc<dyn Path> = Arc::new(scan.path(near, across, rod.units().length)?);
    let computation = Computation { step, most_steps: None, most_stress: None };
    Ok(ScanReach { scan, found: Scanned::of(rod, objects, outlines, &path, computation, progress)?.0 })
}
