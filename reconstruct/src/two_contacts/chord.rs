//! The chord between two places of a contact.

use super::conditions::ContourPoint;
use super::unknowns::{Gradient, Unknowns};

/// The component of the chord from one place of a contact to the next along the mean of the normals there. On a smooth contour it
/// is of third order in the length of the chord. With derivatives by the unknowns at both places.
pub(super) struct Chord {
    pub across: f64,
    pub by: [Gradient; 2],
}

impl Chord {
    /// From one place to the next; their normals may differ in sign.
    pub fn between(p: &ContourPoint, q: &ContourPoint) -> Self {
        let side = (p.normal[0].value * q.normal[0].value + p.normal[1].value * q.normal[1].value).signum();
        let n = [0, 1].map(|i| 0.5 * (q.normal[i].value + side * p.normal[i].value));
        let chord = [q.x.value - p.x.value, q.y.value - p.y.value];
        let by_q = Unknowns::from_fn(|u| {
            let i = u as usize;
            n[0] * q.x.derivatives[i]
                + n[1] * q.y.derivatives[i]
                + 0.5 * (chord[0] * q.normal[0].derivatives[i] + chord[1] * q.normal[1].derivatives[i])
        });
        let by_p = Unknowns::from_fn(|u| {
            let i = u as usize;
            -n[0] * p.x.derivatives[i] - n[1] * p.y.derivatives[i]
                + 0.5 * side * (chord[0] * p.normal[0].derivatives[i] + chord[1] * p.normal[1].derivatives[i])
        });
        Self { across: chord[0] * n[0] + chord[1] * n[1], by: [by_p, by_q].map(Gradient::of_values) }
    }
}
