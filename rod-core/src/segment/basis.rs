//! The five functions of (P, M, s) that every pendulum arc is made of.
//!
//! They are Jacobi's elliptic functions scaled so that nothing is ever divided by P or M, hence smooth for every
//! P, M >= 0: the inflectional, the orbit-like, the separatrix, the circle (P = 0) and the straight line are one formula.

use super::scalar::{Scalar, tolerance};

/// Values of the basis functions at one arc length. S' = C D, C' = -P S D, D' = -M S C, with S(0) = 0, C(0) = D(0) = 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Basis<T> {
    /// S: sn scaled; C^2 + P S^2 = 1 and D^2 + M S^2 = 1.
    pub s: T,
    /// C: cn or dn, whichever the regime calls it.
    pub c: T,
    /// D: the other of the two.
    pub d: T,
    /// V = (1 - C) / P.
    pub v: T,
    /// K = (2 int_0^s D^2 - s - S C D) / P, the part of the second kind; K' = 2 S^2 - 3 M S^4.
    pub k: T,
}

/// Largest max(P, M) h^2 at which six terms of the Maclaurin series of S and K are exact to rounding. The coefficients
/// fall at worst like those of tanh (P = M), by 4 / pi^2 a term: 2 (0.405 * 0.0032)^6 = 1e-17. For `f64`; less exact numbers
/// reach farther, by the sixth root.
const SERIES_REACH: f64 = 3.2e-3;

/// Limit of halvings: a segment that needs more has P s^2 or M s^2 beyond 1e36.
const MOST_HALVINGS: u32 = 64;

/// C or D below which the duplication formula that keeps its relative error is used; above, the one that keeps its distance to 1.
const STEEP: f64 = 0.7;

/// Basis functions at arc length `s` for P = `p` and M = P + `excess`: halve `s` until the series is exact, then double
/// back. The excess is asked for, rather than M, because near the separatrix it is the small difference of large numbers
/// on which everything depends.
#[inline]
pub(crate) fn basis<T: Scalar>(p: T, excess: T, s: T) -> Basis<T> {
    let (half, quarter) = (T::from_f64(0.5), T::from_f64(0.25));
    let reach = T::from_f64(const { tolerance::<T>(SERIES_REACH, 6) });
    let m = p + excess;
    let (mut size, mut part, mut halvings) = (if m > p { m } else { p } * s * s, s, 0);
    while size > reach && halvings < MOST_HALVINGS {
        size = size * quarter;
        part = part * half;
        halvings += 1;
    }
    let mut at = series(p, m, part);
    for _ in 0..halvings {
        at = at.doubled(p, m, excess);
    }
    at
}

/// Maclaurin series in s, symmetric in P and M: with u = (P + M) s^2 and v = P M s^4, from S'' = -(P + M) S + 2 P M S^3.
#[inline(always)]
fn series<T: Scalar>(p: T, m: T, s: T) -> Basis<T> {
    let n = T::from_f64;
    let s2 = s * s;
    let ms2 = m * s2;
    let u = p * s2 + ms2;
    let v = p * s2 * ms2;
    let u2 = u * u;
    // S = s (1 + a1 + a2 + ...)
    let a1 = u * n(-1.0 / 6.0);
    let a2 = (u2 + v * n(12.0)) * n(1.0 / 120.0);
    let a3 = (u2 + v * n(132.0)) * u * n(-1.0 / 5040.0);
    let a4 = (u2 * u2 + (u2 * n(1224.0) + v * n(3024.0)) * v) * n(1.0 / 362_880.0);
    let a5 = (u2 * u2 + (u2 * n(11_064.0) + v * n(132_624.0)) * v) * u * n(-1.0 / 39_916_800.0);
    // S^2 = s^2 (1 + b1 + ...), S^4 = s^4 (1 + c1 + ...)
    let two = n(2.0);
    let b1 = two * a1;
    let b2 = two * a2 + a1 * a1;
    let b3 = two * (a3 + a1 * a2);
    let b4 = two * (a4 + a1 * a3) + a2 * a2;
    let b5 = two * (a5 + a1 * a4 + a2 * a3);
    let c1 = two * b1;
    let c2 = two * b2 + b1 * b1;
    let c3 = two * (b3 + b1 * b2);
    let c4 = two * (b4 + b1 * b3) + b2 * b2;
    let k2 = n(1.0 / 3.0)
        + b1 * n(1.0 / 5.0)
        + b2 * n(1.0 / 7.0)
        + b3 * n(1.0 / 9.0)
        + b4 * n(1.0 / 11.0)
        + b5 * n(1.0 / 13.0);
    let k4 = n(1.0 / 5.0) + c1 * n(1.0 / 7.0) + c2 * n(1.0 / 9.0) + c3 * n(1.0 / 11.0) + c4 * n(1.0 / 13.0);

    let one = n(1.0);
    let sine = s * (one + (a1 + (a2 + (a3 + (a4 + a5)))));
    let sine2 = sine * sine;
    let c = (one - p * sine2).sqrt();
    let d = (one - m * sine2).sqrt();
    Basis { s: sine, c, d, v: sine2 / (one + c), k: s * s2 * (two * k2 - n(3.0) * ms2 * k4) }
}

impl<T: Scalar> Basis<T> {
    /// The same functions at twice the arc length. The denominator is a sum of squares and cannot cancel.
    ///
    /// C and D have two forms each. 1 - P V is exact to rounding as long as C is near 1; close to the separatrix, though, C
    /// and D together fall to 0 like sech, and what matters there is their error relative to themselves, which
    /// (C^2 D^2 +- (M - P) S^2) / E keeps: for one of them it is a sum of positive terms, and the other crosses 0 anyway.
    #[inline(always)]
    fn doubled(self, p: T, m: T, excess: T) -> Self {
        let (one, two, steep) = (T::from_f64(1.0), T::from_f64(2.0), T::from_f64(STEEP));
        let Basis { s, c, d, v: _, k } = self;
        let (s2, c2, d2) = (s * s, c * c, d * d);
        let inverse = one / (c2 + p * s2 * d2);
        let twice_s2 = two * s2 * inverse;
        let new_s = two * s * c * d * inverse;
        let v = twice_s2 * d2;
        let (new_c, new_d) = if c < steep || d < steep {
            let (product, difference) = (c2 * d2, excess * s2);
            ((product + difference) * inverse, (product - difference) * inverse)
        } else {
            (one - p * v, one - m * twice_s2 * c2)
        };
        let ms4 = m * s2 * s2;
        Basis { s: new_s, c: new_c, d: new_d, v, k: two * k + new_s * (v * new_d - ms4 * (one + two * d2 * inverse)) }
    }
}

/// From a relative difference of this the next step leaves half of 5e-17, for it converges quadratically. For `f64`; less exact
/// numbers by the square root.
const AGM_NEAR: f64 = 2e-8;

/// From any ratio above 1e-8 this many steps exhaust the digits.
const MOST_AGM_STEPS: usize = 8;

/// Arithmetic-geometric mean of two positive numbers: half the period of the pendulum is pi / agm(sqrt P, sqrt (P - M));
/// one that goes round takes pi / agm(sqrt M, sqrt (M - P)) a turn of the rod.
#[inline]
pub(crate) fn agm<T: Scalar>(mut a: T, mut g: T) -> T {
    let (half, near) = (T::from_f64(0.5), T::from_f64(const { tolerance::<T>(AGM_NEAR, 2) }));
    for _ in 0..MOST_AGM_STEPS {
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
    fn series_is_the_solution_of_its_differential_equation() {
        // S'' = -(P + M) S + 2 P M S^3 by exact recurrence of Taylor coefficients, against the typed-in ones
        let (p, m) = (0.7, 0.9);
        let mut a = [0.0; 14];
        a[1] = 1.0;
        for n in 0..12 {
            let cube: f64 =
                (0..=n).flat_map(|i| (0..=n - i).map(move |j| (i, j))).map(|(i, j)| a[i] * a[j] * a[n - i - j]).sum();
            a[n + 2] = (-(p + m) * a[n] + 2.0 * p * m * cube) / ((n + 1) * (n + 2)) as f64;
        }
        let h: f64 = 0.3;
        let direct: f64 = (1..=11).map(|n| a[n] * h.powi(n as i32)).sum();
        assert!((series(p, m, h).s - direct).abs() < 1e-16, "{} {}", series(p, m, h).s, direct);
    }

    #[test]
    fn identities_hold_over_all_regimes() {
        for (p, m) in [(0.0, 0.0), (0.0, 9.0), (25.0, 0.0), (25.0, 25.0), (25.0, 24.9), (8.0, 30.0), (30.0, 8.0)] {
            for i in -10..=20 {
                let s = f64::from(i) * 0.1;
                let b = basis(p, m - p, s);
                assert!((b.c * b.c + p * b.s * b.s - 1.0).abs() < 4e-14);
                assert!((b.d * b.d + m * b.s * b.s - 1.0).abs() < 4e-14);
                assert!((1.0 - p * b.v - b.c).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn k_is_the_integral_of_its_derivative() {
        for (p, m) in [(0.0, 0.0), (0.0, 9.0), (25.0, 0.0), (20.0, 20.0), (8.0, 30.0), (30.0, 8.0)] {
            let n = 2000;
            let h = 1.0 / f64::from(n);
            let rate = |s: f64| {
                let b = basis(p, m - p, s);
                2.0 * b.s.powi(2) - 3.0 * m * b.s.powi(4)
            };
            let simpson: f64 = (0..n)
                .map(|i| {
                    let s = f64::from(i) * h;
                    h / 6.0 * (rate(s) + 4.0 * rate(s + 0.5 * h) + rate(s + h))
                })
                .sum();
            let k = basis(p, m - p, 1.0).k;
            assert!((k - simpson).abs() < 1e-11, "P {p} M {m}: {k} against {simpson}");
        }
    }

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
