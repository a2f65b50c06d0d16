//! How friction turns the force of a contact.

use rod_core::Scalar;

/// The part of a contact's force (A, B) along the normal of the contour, where the rod has the sine and cosine of this angle; (A, B) is turned
/// by a quarter from the force itself, so that it points along the contour's tangent. `friction` is the tangent of the angle of friction,
/// positive where it draws the rod from the clamp towards its tip: it turns the force one way where the solid is on the rod's left,
/// and the other way where it is on its right.
pub(crate) fn normal_part<T: Scalar>([a, b]: [T; 2], (sin, cos): (T, T), friction: T) -> [T; 2] {
    let along = (a * cos + b * sin).to_f64();
    let turn = if along < 0.0 { -friction } else { friction };
    let square = T::from_f64(1.0) + turn * turn;
    [(a + b * turn) / square, (b - a * turn) / square]
}

/// What a tangential contact that pushes with this normal force adds to the force (A, B), where the rod has the sine and cosine of this angle:
/// positive from a solid on the rod's left, negative from one on its right. `friction` is as above.
#[cfg(feature = "std")]
pub(crate) fn tangential<T: Scalar>(normal: T, (sin, cos): (T, T), friction: T) -> [T; 2] {
    let along = if normal.to_f64() < 0.0 { -normal * friction } else { normal * friction };
    [normal * cos - along * sin, normal * sin + along * cos]
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    #[test]
    fn the_two_are_inverse_on_both_sides_of_the_rod() {
        for (normal, friction) in [(0.7, 0.2), (-0.7, 0.2), (0.7, -0.2), (-0.7, -0.2), (0.4, 0.0)] {
            let at = 1.1_f64.sin_cos();
            let [a, b] = tangential(normal, at, friction);
            // the force itself is (B, -A): friction acts along the rod
            let along: f64 = b * at.1 - a * at.0;
            assert!((along - f64::abs(normal) * friction).abs() < 1e-15, "{along}");
            let [c, d] = normal_part([a, b], at, friction);
            assert!((c - normal * at.1).abs() < 1e-15 && (d - normal * at.0).abs() < 1e-15);
        }
    }
}
