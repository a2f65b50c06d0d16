//! How exactly one scan of a known object determines its contour: for the choice of a rod and a sensor.

use crate::precision::{Measurement, predicted};
use crate::scanned::{self, Computation, Progress};
use crate::support::{HalfPlane, outline};
use crate::{Outline, PlanError, Scanned};
use rod_contact::{Path, State};
use rod_contours::{Composite, Frame};
use rod_core::PhysicalRod;
use rod_reconstruct::noise_estimate::ChannelNoise;
use rod_reconstruct::{FittedObject, Knowledge};
use std::sync::Arc;

/// Poses along the path from which the rod reaches what is kept of a contour that goes on for ever.
const POSES: u32 = 20;

/// Distance of the points of a fit, rod lengths.
const RESOLUTION: f64 = 0.02;

/// Turn (rad) of a contour from one of its points to the next above which it has a vertex there: a curve turns so far only with a radius of 0.04 rod lengths.
const VERTEX: f64 = 0.5;

/// Rounds in which the noise for an accuracy is looked for, and relative error that is left of the accuracy.
const ROUNDS: usize = 20;
const CLOSE: f64 = 0.01;

/// A scan of objects that are known, without friction.
#[derive(Debug)]
pub struct KnownScan<'a, R> {
    rod: &'a R,
    objects: &'a [Composite],
    outlines: Vec<Outline>,
    states: Vec<State>,
    /// m
    way: f64,
    /// What it touches, and how far the rod bends.
    pub found: Scanned,
}

impl<'a, R: PhysicalRod> KnownScan<'a, R> {
    /// The scan along a path, whose parameter is the way of the clamp in m.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn new(rod: &'a R, objects: &'a [Composite], path: &Arc<dyn Path>) -> Result<Self, PlanError> {
        let length = rod.units().length;
        let poses = (0..=POSES).map(|k| path.point(path.length() * f64::from(k) / f64::from(POSES)).pose);
        let reached: Vec<HalfPlane> = poses
            .map(|pose| {
                let (sin, cos) = pose.phi.sin_cos();
                HalfPlane { angle: pose.phi, limit: pose.x * cos + pose.y * sin + length }
            })
            .collect();
        let endless = |(number, object): (usize, &Composite)| {
            outline(object, &reached).ok_or(PlanError::Endless { object: number })
        };
        let outlines = objects.iter().enumerate().map(endless).collect::<Result<Vec<_>, _>>()?;
        let computation = Computation { step: scanned::STEP * length, most_steps: None, most_stress: None };
        let (found, states) = Scanned::of(rod, objects, &outlines, path, computation, &Progress::new(&|_| true))?;
        Ok(Self { rod, objects, outlines, states, way: path.length(), found })
    }

    /// The sensor, and the contour that will be fitted, as smooth as the objects are: for this noise of f0x, f0y (N) and m0z (N m), and a sample every `spacing` (m) of the
    /// clamp's way.
    pub fn measurement(&self, noise: &[ChannelNoise; 3], spacing: f64) -> Measurement {
        let length = self.rod.units().length;
        let known = self.objects.iter().zip(&self.outlines).map(|(object, outline)| {
            let count = (outline.length() / (RESOLUTION * length)).ceil().max(1.0);
            let frame = |k: usize| outline.frame(object, outline.length() * k as f64 / count);
            let frames: Vec<Frame> = (0..=count as usize).map(frame).collect();
            let turns = |k: &usize| (frames[k - 1].alpha - frames[*k].alpha).cos() < VERTEX.cos();
            FittedObject {
                vertices: (1..frames.len()).filter(turns).flat_map(|k| [k - 1, k]).collect(),
                known: vec![Knowledge::Touched { sigma: 0.0 }; frames.len()],
                points: frames.into_iter().map(|frame| [frame.x, frame.y]).collect(),
            }
        });
        let measurement = Measurement::of(noise, spacing, &known.collect::<Vec<_>>(), length);
        Measurement { resolution: RESOLUTION * length, ..measurement }
    }

    /// Median standard deviation across the contour where it is touched, m, by the noise alone; none where nothing is touched.
    pub fn sigma(&self, measurement: &Measurement) -> Option<f64> {
        let places = predicted(self.rod, self.objects, &self.outlines, &self.states, self.way, measurement);
        let mut sigmas: Vec<f64> = places.iter().map(|place| place.sigma).collect();
        sigmas.sort_by(f64::total_cmp);
        sigmas.get(sigmas.len() / 2).copied()
    }

    /// How many times the noise may be for a median standard deviation `sigma` (m), within 1 % of it; none where it is not reached with any noise that is tried, or even without
    /// a measurement.
    pub fn noise_factor(&self, measurement: &Measurement, sigma: f64) -> Option<f64> {
        let mut factor = 1.0;
        for _ in 0..ROUNDS {
            let scaled = Measurement { sigma: measurement.sigma.map(|one| factor * one), ..*measurement };
            let found = self.sigma(&scaled)?;
            if (found / sigma - 1.0).abs() < CLOSE {
                return Some(factor);
            }
            // at most in proportion: the prior and the least error of the fit do not grow with the noise
            factor *= sigma / found;
        }
        None
    }
}
