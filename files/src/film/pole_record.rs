//! A pole as it is written.

use serde::Serialize;
use vibrissa::reconstruct::{FilmPole, Frame};

/// pole.json. Standard deviations of a radius that was given, or not needed, are null.
#[derive(Serialize)]
pub(super) struct PoleRecord {
    /// Centre, m.
    x: f64,
    y: f64,
    /// m.
    radius: f64,
    sigma_x: f64,
    sigma_y: f64,
    sigma_radius: Option<f64>,
    /// Of (x, y, radius), m^2.
    covariance: [[f64; 3]; 3],
    chi2: f64,
    freedom: usize,
    p: f64,
    /// Numbers of the frames that touch it, and of those that touch something else.
    frames: Vec<i64>,
    elsewhere: Vec<i64>,
}

impl PoleRecord {
    /// The pole of frames with their numbers.
    pub fn of(pole: &FilmPole, frames: &[(i64, Frame)]) -> Self {
        let [sigma_x, sigma_y, sigma_radius] = pole.sigmas();
        let numbers = |all: &[usize]| all.iter().filter_map(|index| Some(frames.get(*index)?.0)).collect();
        Self {
            x: pole.center[0],
            y: pole.center[1],
            radius: pole.radius,
            sigma_x,
            sigma_y,
            sigma_radius: (sigma_radius > 0.0).then_some(sigma_radius),
            covariance: pole.covariance,
            chi2: pole.chi_squared,
            freedom: pole.freedom,
            p: pole.p_value,
            frames: numbers(&pole.frames),
            elsewhere: numbers(&pole.elsewhere),
        }
    }
}
