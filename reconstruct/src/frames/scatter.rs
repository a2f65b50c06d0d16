//! How much neighbouring points scatter.

use super::observation::Frame;
use crate::numeric::robust_sigma;

/// What third differences of independent noise have as their variance, in that of the noise: 1 + 9 + 9 + 1.
const THIRD: f64 = 20.0;
/// Largest precision of points, as a share of the length of the rod: rounding.
pub(super) const LEAST: f64 = 1e-12;

/// The scatter of the points across the rod (L), a first guess of their noise: from the third differences of the points, across the chord, which a smooth shape
/// leaves small.
pub(super) fn scatter<'a>(frames: impl Iterator<Item = &'a Frame>, length: f64) -> f64 {
    let mut differences = Vec::new();
    for frame in frames {
        for four in frame.points.windows(4) {
            let [x, y] = [four[3].x - four[0].x, four[3].y - four[0].y];
            let chord = x.hypot(y);
            let third = |of: fn(&super::SeenPoint) -> f64| {
                of(&four[3]) - 3.0 * of(&four[2]) + 3.0 * of(&four[1]) - of(&four[0])
            };
            let across = (x * third(|p| p.y) - y * third(|p| p.x)) / chord;
            if across.is_finite() {
                differences.push(across / length);
            }
        }
    }
    (robust_sigma(differences.into_iter()).unwrap_or(LEAST) / THIRD.sqrt()).max(LEAST)
}
