//! The ends of a run with two contacts.

use nalgebra::Vector2;

/// What is assumed at an end of a run. `bend` is the curvature of the contour along the neighbour's contact, 1/L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// No contact goes on.
    Open,
    /// The second contact goes on as the neighbour's single contact: a point of the contour, its normal and its standard
    /// deviation across the contour; the path length of the clamp to there.
    Last { place: Vector2<f64>, normal: Vector2<f64>, sigma: f64, way: f64, bend: f64 },
    /// The first contact goes on as the neighbour's single contact, at this arc length with its standard deviation; the path length of
    /// the clamp to there.
    First { s: f64, sigma: f64, way: f64, bend: f64 },
}

/// A neighbour's single contact next to the run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    /// The end, if the second contact goes on.
    pub last: End,
    /// Arc length of the contact and its standard deviation.
    pub s: f64,
    pub sigma_s: f64,
    /// Path length of the clamp between the neighbour's samples and those of the run.
    pub way: f64,
    /// Curvature of the contour along the neighbour's contact, 1/L: at most this, given the noise.
    pub bend: f64,
}

impl Beside {
    /// The end, if the first contact goes on.
    pub fn first(&self) -> End {
        End::First { s: self.s, sigma: self.sigma_s, way: self.way, bend: self.bend }
    }
}
