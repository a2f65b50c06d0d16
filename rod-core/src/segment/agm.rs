//! The arithmetic-geometric mean, which gives the period of a pendulum.

use super::scalar::{Scalar, tolerance};

/// From a relative difference of this the next step leaves half of 5e-17, for it converges quadratically. For `f64`; less exact
/// numbers by the square root.
const NEAR: f64 = 2e-8;

/// From any ratio above 1e-8 this many steps exhaust the digits.
const MOST_STEPS: usize = 8;

/// Arithmetic-geometric mean of two positive numbers: half the period of the pendulum is pi / agm(sqrt P, sqrt (P - M));
/// one that goes round takes pi / agm(sqrt M, sqrt (M - P)) a turn of the rod.
#[inline]
pub(crate) fn agm<T: Scalar>(mut a: T, mut g: T) -> T {
    let (half, near) = (T::from_f64(0.5), T::from_f64(const { tolerance::<T>(NEAR, 2) }));
    for _ in 0..MOST_STEPS {
        let last = a - g <= near * a && g - a <= near * a;
        (a, g) = (half * (a + g), (a * g).sqrt());
        if last {
            break;
        }
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_means() {
        // Gauss's constant is 1 / agm(1, sqrt 2); agm(24, 6) = 13.4581714817256...
        for (a, g, mean) in [(1.0, 2.0_f64.sqrt(), 1.198_140_234_735_592_2), (6.0, 24.0, 13.458_171_481_725_615)] {
            assert!((agm::<f64>(a, g) / mean - 1.0).abs() < 4e-16);
            assert!((f64::from(agm(a as f32, g as f32)) / mean - 1.0).abs() < 2e-7);
        }
        // a ratio k' of 1e-8: pi / 2 over ln(4 / k')
        let far = agm(1.0, 1e-8);
        assert!((far * (4e8_f64).ln() / core::f64::consts::FRAC_PI_2 - 1.0).abs() < 1e-15, "{far}");
    }
}
