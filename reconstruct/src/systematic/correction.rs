//! Errors that all samples share, taken off a sample.

use super::source::{Errors, Source};
use crate::point::Clamp;
use crate::scan::Track;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// What the place of a sample in its scan is measured by: the first pose and the range of the path parameter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    start: Vector3<f64>,
    from: f64,
    length: f64,
}

impl Frame {
    /// Of a scan with one sample at least.
    pub fn of(track: &Track) -> Option<Self> {
        let (from, to) = (*track.tau.first()?, *track.tau.last()?);
        Some(Self { start: track.clamps.first()?.pose, from, length: (to - from).max(f64::MIN_POSITIVE) })
    }

    /// The same for a scan that goes on: drift is counted on this way at least.
    pub fn on_way(self, least: f64) -> Self {
        Self { length: self.length.max(least), ..self }
    }
}

/// Takes given errors off samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Correction {
    frame: Frame,
    errors: Errors,
    /// From measured reactions without bias to true ones, in the units of the given rod.
    channels: Matrix3<f64>,
    /// The given rod's units of length, force and moment in those of the true rod.
    scale: [f64; 3],
}

impl Correction {
    /// None where gains and cross-talk leave fewer than three channels.
    pub fn new(frame: Frame, errors: &Errors) -> Option<Self> {
        let e = |source: Source| errors[source as usize];
        let shown = Matrix3::new(
            1.0 + e(Source::GainF0x),
            e(Source::F0yInF0x),
            e(Source::M0zInF0x),
            e(Source::F0xInF0y),
            1.0 + e(Source::GainF0y),
            e(Source::M0zInF0y),
            e(Source::F0xInM0z),
            e(Source::F0yInM0z),
            1.0 + e(Source::GainM0z),
        );
        let (length, stiffness) = (1.0 + e(Source::Length), 1.0 + e(Source::Stiffness));
        let scale = [1.0 / length, length * length / stiffness, length / stiffness];
        Some(Self { frame, errors: *errors, channels: shown.try_inverse()?, scale })
    }

    /// Length of the true rod in lengths of the given one.
    pub fn length(&self) -> f64 {
        1.0 + self.error(Source::Length)
    }

    fn error(&self, source: Source) -> f64 {
        self.errors[source as usize]
    }

    fn three(&self, first: Source) -> Vector3<f64> {
        self.errors.fixed_rows::<3>(first as usize).into_owned()
    }

    /// The sample at path parameter `tau` and its rate, both without the errors and in the units of the true rod.
    pub fn apply(&self, tau: f64, clamp: &Clamp, rate: &Clamp) -> (Clamp, Clamp) {
        let Frame { start, from, length } = self.frame;
        let u = (tau - from) / length;
        let (drift, bow) = (self.three(Source::DriftF0x), self.three(Source::BowF0x));
        let (sin, cos) = (PI * u).sin_cos();
        let shift = self.three(Source::BiasF0x) + drift * (u - 0.5) + bow * sin;
        let shift_rate = (drift + bow * (PI * cos)) / length;
        let mut force = self.channels * (clamp.reactions - shift);
        let mut force_rate = self.channels * (rate.reactions - shift_rate);
        // the pose: lag, scale of the stage, angle
        let stage = 1.0 + self.error(Source::StageScale);
        let moved = clamp.pose + rate.pose * self.error(Source::Lag) - start;
        let mut pose = start + Vector3::new(moved.x * stage, moved.y * stage, moved.z);
        let mut pose_rate = Vector3::new(rate.pose.x * stage, rate.pose.y * stage, rate.pose.z);
        pose.z += self.error(Source::ClampAngle);
        // the moment about the clamp, from forces along the rod there and across
        let (along, across) = (self.error(Source::LeverAlong), self.error(Source::LeverAcross));
        let (sin, cos) = pose.z.sin_cos();
        let in_clamp = |force: &Vector3<f64>| [force.x * cos + force.y * sin, force.y * cos - force.x * sin];
        let ([t, n], [t_rate, n_rate]) = (in_clamp(&force), in_clamp(&force_rate));
        force.z += along * n - across * t;
        force_rate.z += along * (n_rate - pose_rate.z * t) - across * (t_rate + pose_rate.z * n);
        // the units of the true rod
        let [by_length, by_force, by_moment] = self.scale;
        let units = Vector3::new(by_force, by_force, by_moment);
        (force, force_rate) = (force.component_mul(&units), force_rate.component_mul(&units));
        for pose in [&mut pose, &mut pose_rate] {
            pose.x *= by_length;
            pose.y *= by_length;
        }
        // a clamp that yields turns against the moment on the rod
        let compliance = self.error(Source::ClampCompliance);
        pose.z -= compliance * force.z;
        pose_rate.z -= compliance * force_rate.z;
        let natural = clamp.natural + self.error(Source::NaturalCurvature);
        let friction = clamp.friction + self.error(Source::Friction);
        (
            Clamp { pose, reactions: force, natural, friction },
            Clamp { pose: pose_rate, reactions: force_rate, natural: 0.0, friction: 0.0 },
        )
    }

    /// A scan without the errors.
    pub fn track(&self, track: &Track) -> Track {
        let mut corrected = track.clone();
        for (index, clamp) in corrected.clamps.iter_mut().enumerate() {
            let motion = still(motion(track, index));
            *clamp = self.apply(track.tau[index], clamp, &motion).0;
        }
        corrected.natural += self.error(Source::NaturalCurvature);
        corrected.friction += self.error(Source::Friction);
        corrected
    }
}

/// Rates of a clamp that moves and whose reactions stay the same.
pub(crate) fn still(pose: Vector3<f64>) -> Clamp {
    Clamp { pose, reactions: Vector3::zeros(), natural: 0.0, friction: 0.0 }
}

/// Rate of the pose at a sample, from its neighbours.
pub(crate) fn motion(track: &Track, index: usize) -> Vector3<f64> {
    let (from, to) = (index.saturating_sub(1), (index + 1).min(track.len() - 1));
    let by = track.tau[to] - track.tau[from];
    if by > 0.0 { (track.clamps[to].pose - track.clamps[from].pose) / by } else { Vector3::zeros() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systematic::source::SOURCES;

    #[test]
    fn the_rate_is_that_of_the_corrected_sample_and_no_error_changes_nothing() {
        let clamp = |tau: f64| Clamp {
            pose: Vector3::new(0.3 - tau, 0.1 + 0.2 * tau, 1.2 + 0.5 * tau),
            reactions: Vector3::new(tau.sin(), 2.0 + tau * tau, -1.0 + tau),
            natural: 0.0,
            friction: 0.0,
        };
        let rate = |tau: f64| Clamp {
            pose: Vector3::new(-1.0, 0.2, 0.5),
            reactions: Vector3::new(tau.cos(), 2.0 * tau, 1.0),
            natural: 0.0,
            friction: 0.0,
        };
        let tau: Vec<f64> = (0..11).map(|k| 0.1 * f64::from(k)).collect();
        let track = Track { clamps: tau.iter().map(|&tau| clamp(tau)).collect(), tau, ..Track::default() };
        let frame = Frame::of(&track).unwrap();
        let none = Correction::new(frame, &Errors::zeros()).unwrap();
        let (same, still) = none.apply(0.4, &clamp(0.4), &rate(0.4));
        assert!((same.pose - clamp(0.4).pose).norm() < 1e-15 && (same.reactions - clamp(0.4).reactions).norm() < 1e-15);
        assert!((still.reactions - rate(0.4).reactions).norm() < 1e-15);
        let errors = Errors::from_fn(|k, _| 0.01 * (1.0 + k as f64 / SOURCES as f64));
        let some = Correction::new(frame, &errors).unwrap();
        let at = |tau: f64| some.apply(tau, &clamp(tau), &rate(tau));
        let (step, by) = (1e-5, at(0.4).1);
        let difference =
            |of: fn(&Clamp) -> Vector3<f64>| (of(&at(0.4 + step).0) - of(&at(0.4 - step).0)) / (2.0 * step);
        assert!((difference(|c| c.pose) - by.pose).norm() < 1e-9, "{}", by.pose);
        assert!((difference(|c| c.reactions) - by.reactions).norm() < 1e-9);
    }
}
