//! Where a bent segment is straight: the first section without moment, in closed form.

use super::basis::agm;
use super::kernel::{Section, axial, in_frame};
use super::scalar::{Scalar, is_finite, tolerance};

/// Carlson's expansion is exact to rounding where the three arguments deviate from their mean by no more than this: its
/// first omitted term is of order 8, and 0.0085^8 = 3e-17. For `f64`; less exact numbers are content with less, by the eighth
/// root.
const NEAR: f64 = 8.5e-3;

/// A duplication brings the arguments nearer by a factor of 4: from 1e-300 apart 500 suffice. NaN stops at once.
const MOST_DUPLICATIONS: usize = 600;

/// Arc length from `start` to the first section ahead where the curvature vanishes, along a segment that carries the
/// force (A, B): where the rod ends, as far as the clamp can tell, if a single contact holds it. 0 where the start is
/// without curvature already; none where the curvature keeps its sign for ever (a rod that goes round and round, or that carries
/// no force).
///
/// No iteration on the rod: with P, M, q = kappa / 2 and delta as in [`advance`](crate::advance), w = P cos^2(delta / 2),
/// v = P sin^2(delta / 2), M = q^2 + v, e = P - M, it is |q| R_F(e v, e M, w M), Carlson's integral of the first kind, on
/// the way to the turning point, and half a period minus that before the rod has passed the stable direction. (Carlson
/// 1995, Numerical Algorithms 10, 13, for R_F.)
///
/// Accuracy: 1e-14 relative, as far as the start is exact; near the separatrix, P = M, the rounding of the start grows as
/// 1 / e.
///
/// ```
/// use rod_core::{Section, advance, inflection};
/// let clamp = Section { x: 0.0, y: 0.0, phi: 1.5, kappa: 1.2 };
/// let s = inflection(&clamp, 1.0_f64, 2.0).ok_or("never straight")?;
/// assert!(advance(&clamp, 1.0, 2.0, s).kappa.abs() < 1e-14);
/// # Ok::<(), &str>(())
/// ```
#[inline]
pub fn inflection<T: Scalar>(start: &Section<T>, a: T, b: T) -> Option<T> {
    let (zero, half) = (T::from_f64(0.0), T::from_f64(0.5));
    let (sin, cos) = start.phi.sin_cos();
    let (c, d) = in_frame((a, b), (sin, cos));
    let p = (c * c + d * d).sqrt();
    let q = start.kappa * half;
    if q == zero {
        return Some(q);
    }
    let (w, v) = (axial(c, d, p), axial(-c, d, p));
    let (m, e) = (q * q + v, w - q * q);
    // also where anything is not a number
    if !(e > zero && m > zero) {
        return None;
    }
    let size = if q < zero { -q } else { q };
    // in parts of M, so that tiny forces are as good as any
    let (e1, w1) = (e / m, w / m);
    let ahead = size / m * carlson(e1 * (v / m), e1, w1);
    // a quarter of the pendulum's period before the turning point it passes the stable direction
    if d * q >= zero {
        return Some(ahead);
    }
    let quarter = T::from_f64(core::f64::consts::FRAC_PI_2) / agm(p.sqrt(), e.sqrt());
    Some(quarter + (quarter - ahead))
}

/// R_F(x, y, z) = 1/2 int_0^inf dt / sqrt((t + x) (t + y) (t + z)), by duplication. At most one argument may be 0, and is none where duals
/// differentiate.
#[inline]
fn carlson<T: Scalar>(mut x: T, mut y: T, mut z: T) -> T {
    let n = T::from_f64;
    let (third, quarter) = (n(1.0 / 3.0), n(0.25));
    let near = n(const { tolerance::<T>(NEAR, 8) });
    let mut mean = (x + y + z) * third;
    for _ in 0..MOST_DUPLICATIONS {
        let reach = near * mean;
        let is_near = |u: T| mean - u <= reach && u - mean <= reach;
        if is_near(x) && is_near(y) && is_near(z) || !is_finite(mean) {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * (ry + rz) + ry * rz;
        (x, y, z) = ((x + lambda) * quarter, (y + lambda) * quarter, (z + lambda) * quarter);
        mean = (x + y + z) * third;
    }
    let (u, v) = ((mean - x) / mean, (mean - y) / mean);
    let w = -(u + v);
    let (e2, e3) = (u * v - w * w, u * v * w);
    let series = n(1.0)
        + e2 * (n(-0.1) + e2 * (n(1.0 / 24.0) - e2 * n(5.0 / 208.0)) - e3 * n(3.0 / 44.0))
        + e3 * (n(1.0 / 14.0) + e3 * n(3.0 / 104.0) + e2 * e2 * n(1.0 / 16.0));
    series / mean.sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::dual::Dual;
    use super::super::kernel::{advance, advance_with_sensitivities};
    use super::super::walk::walk;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn integral_of_the_first_kind() {
        // DLMF 19.20, Carlson 1995: R_F(1, 2, 0), R_F(0.5, 1, 0), R_F(2, 3, 4), R_F(x, x, x) = 1 / sqrt x
        for (x, y, z, value) in [
            (0.0, 1.0, 2.0, 1.311_028_777_146_059_9),
            (0.0, 0.5, 1.0, 1.854_074_677_301_371_9),
            (2.0, 3.0, 4.0, 0.584_082_841_677_151_7),
            (4.0, 4.0, 4.0, 0.5),
            (0.0, 1e-300, 1e-300, std::f64::consts::FRAC_PI_2 * 1e150),
        ] {
            let found = carlson(x, y, z);
            assert!((found / value - 1.0_f64).abs() < 5e-16, "{x} {y} {z}: {found}");
        }
        assert!(carlson(f64::NAN, 1.0, 1.0).is_nan());
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 1000, ..ProptestConfig::default() })]
        #[test]
        fn is_the_first_section_without_curvature(
            phi in -3.2..3.2, kappa in -6.0..6.0, a in -20.0..20.0, b in -20.0..20.0, size in prop_oneof![Just(1.0), Just(1e-6), Just(1e-120)],
        ) {
            let (kappa, a, b): (f64, f64, f64) = (kappa * f64::sqrt(size), a * size, b * size);
            let start = Section { x: 0.0, y: 0.0, phi, kappa };
            let (p, stable) = (a.hypot(b), b.atan2(a) + std::f64::consts::FRAC_PI_2);
            let spare = p * (0.5 * (phi - stable)).cos().powi(2) - 0.25 * kappa * kappa;
            let found = inflection(&start, a, b);
            prop_assert_eq!(found.is_some(), spare > 0.0);
            let Some(s) = found else { return Ok(()) };
            let unit = size.sqrt();
            let tolerance = 1e-13 * (1.0 + p / spare.max(1e-300)) * (1.0 + (s * unit).powi(2));
            prop_assert!((advance(&start, a, b, s).kappa / unit).abs() < tolerance * 20.0, "{:e}", advance(&start, a, b, s).kappa / unit);
            // none before
            prop_assert!(walk(&start, a, b, s * 0.999, 200).all(|section| section.kappa * kappa > 0.0));
        }

        #[test]
        fn duals_differentiate_it(phi in 0.5..2.0_f64, kappa in -1.5..-0.2_f64, a in 0.5..4.0_f64, b in -4.0..4.0_f64) {
            let start = Section { x: 0.0, y: 0.0, phi, kappa };
            let Some(s) = inflection(&start, a, b) else { return Ok(()) };
            prop_assume!(s < 2.0);
            let (end, by) = advance_with_sensitivities(&start, a, b, s);
            prop_assume!(by.by_s[3].abs() > 0.1 && end.kappa.abs() < 1e-12);
            let v = |value, index| Dual::<f64, 4>::variable(value, index);
            let zero = Dual::constant(0.0);
            let dual = Section { x: zero, y: zero, phi: v(phi, 0), kappa: v(kappa, 1) };
            let Some(by_dual) = inflection(&dual, v(a, 2), v(b, 3)) else { return Err(TestCaseError::fail("none")) };
            for (found, column) in by_dual.derivatives.into_iter().zip([by.by_phi, by.by_kappa, by.by_a, by.by_b]) {
                let implicit = -column[3] / by.by_s[3];
                prop_assert!((found - implicit).abs() < 1e-9 * (1.0 + implicit.abs()), "{found} {implicit}");
            }
        }
    }

    #[test]
    fn limits() {
        let at = |phi, kappa, a, b| inflection(&Section { x: 0.0, y: 0.0, phi, kappa }, a, b);
        assert_eq!(at(0.3, 0.0, 1.0, 2.0), Some(0.0), "straight from the start");
        assert_eq!(at(0.3, 1.0, 0.0, 0.0), None, "a circle");
        assert_eq!(at(0.0, 30.0, 1.0, 2.0), None, "round and round");
        assert_eq!(at(f64::NAN, 1.0, 1.0, 2.0), None);
        // a quarter of the period of small swings about the stable direction
        let quarter = at(0.0, 1e-9, 0.0, -4.0).unwrap();
        assert!((quarter - std::f64::consts::FRAC_PI_4).abs() < 1e-15, "{quarter}");
        let single = inflection(&Section { x: 0.0_f32, y: 0.0, phi: 1.5, kappa: 1.2 }, 1.0, 2.0).unwrap();
        assert!((f64::from(single) - at(1.5, 1.2, 1.0, 2.0).unwrap()).abs() < 1e-6);
    }
}
