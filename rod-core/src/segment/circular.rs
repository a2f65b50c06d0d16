//! Sine and cosine in single precision arithmetic alone: the usual ones compute in double precision inside, which costs a
//! processor without it 40 times as much.

/// pi / 2 in three parts, the first two so short that whole multiples of them are exact.
const PARTS: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];

/// Angles beyond this, rad, are brought near first: so many quarter turns would not be exact.
const FAR: f32 = 8192.0;

/// Adding it, and taking it away again, rounds to a whole number.
const ROUNDING: f32 = 1.5 * 8_388_608.0;

/// Sine and cosine of an angle (rad), within 1e-7; within 3e-7 where the angle is more than 1300 turns.
///
/// Quarter turns are taken off in three parts (Cody and Waite 1980); on what is left, at most pi / 4, the polynomials of least
/// largest error (Remez) are good to 4e-9.
#[inline]
pub(crate) fn sin_cos(angle: f32) -> (f32, f32) {
    let angle = if angle > -FAR && angle < FAR { angle } else { brought_near(angle) };
    let quarters = (angle * core::f32::consts::FRAC_2_PI + ROUNDING) - ROUNDING;
    let [high, middle, low] = PARTS;
    let x = ((angle - quarters * high) - quarters * middle) - quarters * low;
    let z = x * x;
    let sin = x + x * z * (-0.166_666_55 + z * (8.332_169e-3 + z * -1.951_601_2e-4));
    let cos = (1.0 - 0.5 * z) + z * z * (4.166_664_7e-2 + z * (-1.388_735_5e-3 + z * 2.443_700_8e-5));
    match quarters as i32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The same angle within half a turn; what is not finite is not a number.
#[cold]
#[inline(never)]
fn brought_near(angle: f32) -> f32 {
    const ROUNDING: f64 = 1.5 * 4_503_599_627_370_496.0;
    let mut angle = f64::from(angle);
    // once is enough up to 2^52 turns; of more a number of single precision knows nothing, but the result is an angle
    for _ in 0..3 {
        angle -= core::f64::consts::TAU * ((angle / core::f64::consts::TAU + ROUNDING) - ROUNDING);
    }
    angle as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_exact_as_single_precision_is() {
        let error = |angle: f32| {
            let ((sin, cos), (s, c)) = (sin_cos(angle), f64::from(angle).sin_cos());
            (f64::from(sin) - s).abs().max((f64::from(cos) - c).abs())
        };
        let near = (-1_200_000..=1_200_000).map(|i| error(i as f32 * 1e-5)).fold(0.0, f64::max);
        let far = |from: f32, to: f32| {
            (0..200_000).map(|i| error(from * (to / from).powf(i as f32 / 200_000.0))).fold(0.0, f64::max)
        };
        assert!(near < 1e-7 && far(1.0, FAR) < 1e-7 && far(FAR, 1e9) < 3e-7, "{near:e} {:e}", far(1.0, FAR));
    }

    #[test]
    fn small_angles_and_quarter_turns_keep_their_digits() {
        for angle in
            [1e-30_f32, -1e-3, 0.1, core::f32::consts::PI, core::f32::consts::TAU, core::f32::consts::FRAC_PI_2]
        {
            let ((sin, cos), (s, c)) = (sin_cos(angle), f64::from(angle).sin_cos());
            for (ours, exact) in [(sin, s), (cos, c)] {
                assert!((f64::from(ours) - exact).abs() <= 1.2e-7 * exact.abs(), "{angle}: {ours:e} {exact:e}");
            }
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
    }

    #[test]
    fn of_any_number_they_are_of_an_angle() {
        for angle in [1e15, -3e22, 1e30, f32::MAX] {
            let (sin, cos) = sin_cos(angle);
            assert!((sin * sin + cos * cos - 1.0).abs() < 1e-6, "{angle}: {sin} {cos}");
        }
    }

    #[test]
    fn what_is_not_finite_is_not_a_number() {
        for angle in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let (sin, cos) = sin_cos(angle);
            assert!(sin.is_nan() && cos.is_nan());
        }
    }
}
