//! How the end of an interval changes with its start, its force and its ends.

/// Derivatives of the cut at the end of an interval, each as (x, y, phi, moment). Position moves along with that of the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutSensitivities {
    /// By the slope angle at the start.
    pub by_phi: [f64; 4],
    /// By the bending moment at the start.
    pub by_moment: [f64; 4],
    /// By the force component A.
    pub by_a: [f64; 4],
    /// By the force component B.
    pub by_b: [f64; 4],
    /// By the arc length where the interval starts, its end and the cut at its start kept.
    pub by_from: [f64; 4],
    /// By the arc length where the interval ends: the differential equation itself.
    pub by_to: [f64; 4],
}
