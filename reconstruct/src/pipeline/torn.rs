//! Whether the first contact of one stretch with several goes on in the next.
//!
//! Where contacts change without a jump, one of them begins or ends with force 0 and the others go on. If the first contacts on both sides
//! bear forces and are at different places, contacts of one side are wrong, such as those of three that were taken for two.

use super::reading::Reading;
use crate::point::Touch;
use nalgebra::Vector2;
use rod_core::Units;

/// Samples on each side in which the nearest contact is looked for.
const NEAR: usize = 60;
/// Path length of a contact along the contour and change of its force (EI/L^2) per path length of the clamp, at most.
const CONTACT_RATE: f64 = 3.0;
const FORCE_RATE: f64 = 150.0;
/// Distance of two contacts that are not one, in standard deviations.
const SIGMAS: f64 = 6.0;

/// Whether the answers to consecutive samples contradict each other at `border`, a number of samples; `tau` are their path parameters in
/// rod lengths.
pub(super) fn torn(readings: &[Reading], tau: &[f64], border: usize, units: Units) -> bool {
    let first = |k: usize| Some((tau[k], readings[k].touch.ok()?));
    let before = (border.saturating_sub(NEAR)..border).rev().find_map(first);
    let after = (border..readings.len().min(border + NEAR)).find_map(first);
    let (Some((from, a)), Some((to, b))) = (before, after) else { return false };
    let way = (to - from).abs();
    let strong = |touch: &Touch| touch.force / units.force > FORCE_RATE * way;
    let apart = Vector2::new(b.x - a.x, b.y - a.y);
    let distance = apart.norm();
    let sigma = apart.dot(&((a.covariance + b.covariance) * apart)).max(0.0).sqrt() / distance.max(f64::MIN_POSITIVE);
    strong(&a) && strong(&b) && distance > CONTACT_RATE * way * units.length + SIGMAS * sigma
}
