//! The path of a point on a rolling disc.

use vibrissa::contour::{Contour, ContourError, Frame, Range};

/// Ripples: the path of a point `arm` from the centre of a disc that rolls along the line above it (y = radius) to +x,
/// by the angle rolled; the solid is above.
///
/// ```text
/// r = (radius t - arm sin t, -arm cos t),   tan alpha = arm sin t / (radius - arm cos t)
/// ```
///
/// Crests of curvature `arm / (radius - arm)^2` point down at every whole turn; the inflections are where
/// `cos t = arm / radius`. Everything but the frame is the trait's default. Let the angle to either side be pi, 2 pi, 3 pi or
/// 4 pi: then crests and troughs lie between the cells of the default search, which within one, seen from about the centre of
/// curvature, may take the wrong one of two points almost as near.
///
/// ```
/// use custom_shape::Trochoid;
/// use std::f64::consts::TAU;
/// use vibrissa::Contour;
///
/// let ripples = Trochoid::new(0.006, 0.003, TAU)?; // m, m, rad
/// assert!((ripples.gap(0.0, -0.010) - 0.007).abs() < 1e-15); // below the crest at -arm
/// assert!((ripples.frame(0.0).curvature() - 0.003 / 0.003_f64.powi(2)).abs() < 1e-9);
/// # Ok::<(), vibrissa::contour::ContourError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trochoid {
    radius: f64,
    arm: f64,
    half: f64,
}

impl Trochoid {
    /// Radius of the disc and distance of the point from its centre, lengths, and the angle rolled to either side of a
    /// crest, rad.
    ///
    /// # Errors
    ///
    /// [`ContourError::NotPositive`] unless arm > 0, radius > arm (else there are cusps or loops) and half > 0.
    pub fn new(radius: f64, arm: f64, half: f64) -> Result<Self, ContourError> {
        let checks = [("arm", arm), ("radius - arm", radius - arm), ("half the angle", half)];
        let wrong = checks.into_iter().find(|(_, value)| !(f64::MIN_POSITIVE..f64::INFINITY).contains(value));
        wrong.map_or(Ok(Self { radius, arm, half }), |(what, value)| Err(ContourError::NotPositive { what, value }))
    }
}

impl Contour for Trochoid {
    fn frame(&self, t: f64) -> Frame {
        let (Self { radius, arm, .. }, (sin, cos)) = (*self, t.sin_cos());
        let (u, v) = (radius - arm * cos, arm * sin); // dr/dt; u > 0, so that alpha cannot jump
        let (x, y, alpha, speed) = (radius * t - v, -arm * cos, v.atan2(u), u.hypot(v));
        Frame { x, y, alpha, speed, turning: arm * (radius * cos - arm) / speed / speed }
    }

    fn range(&self) -> Range {
        Range { from: -self.half, to: self.half }
    }
}
