//! A line of points.jsonl for each row of a recording: SI units, all digits, null where there is no answer.

use super::result::Reconstructed;
use crate::RowFault;
use serde::Serialize;
use vibrissa::reconstruct::{Basis, Reading, Reason, Touch};
use vibrissa::{Label, Pose};

/// A line of points.jsonl.
#[derive(Serialize)]
pub(crate) struct PointRecord {
    x0: Option<f64>,
    y0: Option<f64>,
    phi0: Option<f64>,
    #[serde(flatten)]
    touch: TouchRecord,
    label: Option<Label>,
    several: Option<bool>,
    probability: Option<f64>,
    basis: Option<Basis>,
    second: Option<TouchRecord>,
}

impl PointRecord {
    /// The answer to a usable row.
    pub fn of_sample(found: &Reconstructed, sample: usize) -> Self {
        let (reading, pose) = (&found.found.readings[sample], found.pose(sample));
        let basis = found.found.evidence(sample).map(|evidence| evidence.basis(reading.label));
        Self { basis, ..Self::of_reading(pose, reading) }
    }

    /// The answer to a sample with the clamp at this pose.
    pub fn of_reading(pose: Pose, reading: &Reading) -> Self {
        Self {
            x0: Some(pose.x),
            y0: Some(pose.y),
            phi0: Some(pose.phi),
            touch: TouchRecord::of(&reading.touch),
            label: Some(reading.label),
            several: Some(reading.label.several()),
            probability: Some(reading.probability),
            basis: None,
            second: reading.second.as_ref().map(TouchRecord::of),
        }
    }

    /// A row that cannot be used.
    pub fn of_fault(fault: &RowFault) -> Self {
        Self::without(fault.pose, fault.to_string())
    }

    /// A sample that cannot be used, and why.
    pub fn without(pose: Option<Pose>, reason: String) -> Self {
        let touch = TouchRecord { reason: Some(reason), ..TouchRecord::default() };
        let (x0, y0, phi0) = (pose.map(|p| p.x), pose.map(|p| p.y), pose.map(|p| p.phi));
        Self { x0, y0, phi0, touch, label: None, several: None, probability: None, basis: None, second: None }
    }
}

/// A contact, or why there is none.
#[derive(Default, Serialize)]
struct TouchRecord {
    x: Option<f64>,
    y: Option<f64>,
    s: Option<f64>,
    alpha: Option<f64>,
    force: Option<f64>,
    sigma_x: Option<f64>,
    sigma_y: Option<f64>,
    systematic_x: Option<f64>,
    systematic_y: Option<f64>,
    reason: Option<String>,
}

impl TouchRecord {
    fn of(touch: &Result<Touch, Reason>) -> Self {
        match touch {
            Ok(Touch { x, y, s, alpha, force, covariance, systematic }) => Self {
                x: Some(*x),
                y: Some(*y),
                s: Some(*s),
                alpha: Some(*alpha),
                force: Some(*force),
                sigma_x: Some(covariance[(0, 0)].max(0.0).sqrt()),
                sigma_y: Some(covariance[(1, 1)].max(0.0).sqrt()),
                systematic_x: Some(systematic[(0, 0)].max(0.0).sqrt()),
                systematic_y: Some(systematic[(1, 1)].max(0.0).sqrt()),
                reason: None,
            },
            Err(reason) => Self { reason: Some(reason.to_string()), ..Self::default() },
        }
    }
}
