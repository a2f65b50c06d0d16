//! The points of a whole ellipse that are nearest to a given one.
//!
//! The ellipse has half axes 1 (along x) and `ratio` (along y, from 0 to 1) here, and the point lies in the first
//! quadrant; everything else follows by symmetry. With the normal `r = p + lambda n` and `w = lambda + ratio^2` the
//! foot is `(cos e, sin e) = (x / (w + 1 - ratio^2), ratio y / w)`, where w is a root of `cos^2 e + sin^2 e = 1`. The
//! sum is convex on either side of `w = 0`, so Newton's iteration from the side where it exceeds 1 runs up to the root
//! without passing it.

/// Steps after which the iteration gives up. The nearest point takes 4 to 10; near a centre of curvature, where two of
/// them merge, it loses its speed and each step halves what remains.
const STEPS: usize = 100;

/// Relative step below which the next one would be below rounding.
const LAST_STEP: f64 = 2.0 * f64::EPSILON;

/// `ratio y` below which the point counts as one on the major axis: the foot is wrong by less than 1e-60 then, and squares
/// of larger numbers do not vanish.
const ON_AXIS: f64 = 1e-100;

/// Square of the cosine at the start above which the root may lie far from there: close to the axis near the centre of
/// curvature of the sharp end.
const NEAR_END: f64 = 0.5;

/// Cosine and sine of the eccentric angle of the nearest point, both not negative.
pub(crate) fn nearest(ratio: f64, x: f64, y: f64) -> [f64; 2] {
    let flat = (1.0 - ratio) * (1.0 + ratio);
    let height = ratio * y;
    // How far the point is short of the axis on which the whole end is nearest.
    let short = flat - x;
    if height <= ON_AXIS {
        return if short > 0.0 { on_axis(flat, x) } else { [1.0, 0.0] };
    }
    // Either term alone is 1 at one of these, so both fall short of the root.
    let mut w = height.max(-short);
    if (x / (w + flat)).powi(2) > NEAR_END {
        // 1 - cos^2 is at most 2 (w + short) / flat: sin^2 is more than that up to here.
        let square = height * height * flat;
        w = w.max(if short > 0.0 {
            (0.25 * square).cbrt().min((0.25 * square / short).sqrt())
        } else {
            (0.5 * square).cbrt()
        });
    }
    for _ in 0..STEPS {
        let width = w + flat;
        let (cos, sin) = (x / width, height / w);
        // The form that keeps its digits near the ends of the major axis.
        let excess = sin * sin - (w + short) / width * (1.0 + cos);
        let step = 0.5 * excess / (cos * cos / width + sin * sin / w);
        w += step.max(0.0);
        // Also where the step is not a number.
        if excess <= 0.0 || step <= LAST_STEP * w || step.is_nan() {
            break;
        }
    }
    [x / (w + flat), height / w]
}

/// Cosine and sine of the other minimum of the distance, beyond the major axis: the sine is not positive. There is one for
/// points inside the evolute.
pub(crate) fn opposite(ratio: f64, x: f64, y: f64) -> Option<[f64; 2]> {
    let flat = (1.0 - ratio) * (1.0 + ratio);
    let height = ratio * y;
    if height <= ON_AXIS {
        return (x < flat).then(|| on_axis(flat, x)).map(|[cos, sin]| [cos, -sin]);
    }
    // -w of the other minimum.
    let mut v = height;
    for _ in 0..STEPS {
        let width = flat - v;
        let (cos, sin) = (x / width, height / v);
        let excess = sin * sin - (width - x) / width * (1.0 + cos);
        let fall = sin * sin / v - cos * cos / width;
        // Past the least value of the sum: it does not come down to 1.
        if !(width > 0.0 && fall > 0.0) {
            return None;
        }
        let step = 0.5 * excess / fall;
        v += step.max(0.0);
        if excess <= 0.0 || step <= LAST_STEP * v {
            break;
        }
    }
    Some([x / (flat - v), -height / v])
}

/// The foot of a point of the major axis between the centres of curvature of its ends.
fn on_axis(flat: f64, x: f64) -> [f64; 2] {
    [x / flat, ((flat - x) * (flat + x)).sqrt() / flat]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half the slope of the squared distance, relative to its parts, and the excess of cos^2 + sin^2.
    fn residuals(ratio: f64, x: f64, y: f64, [cos, sin]: [f64; 2]) -> [f64; 2] {
        let slope = -(cos - x) * sin + (ratio * sin - y) * ratio * cos;
        let size = (1.0 + x) * sin.abs() + (ratio + y) * ratio * cos;
        [slope / size.max(f64::MIN_POSITIVE), cos * cos + sin * sin - 1.0]
    }

    #[test]
    fn feet_are_on_the_ellipse_and_perpendicular() {
        for ratio in [1.0, 0.999_999, 0.7, 1e-2, 1e-6] {
            let flat = 1.0 - ratio * ratio;
            for x in [0.0, 1e-200, 1e-12, 0.3, flat * (1.0 - 1e-15), flat, flat * (1.0 + 1e-15), 1.0, 1.0 + 1e-12, 40.0]
            {
                for y in [0.0, 1e-300, 1e-30, 1e-12, 0.5 * ratio, ratio, 0.3, 1.0, 1e3] {
                    for foot in [Some(nearest(ratio, x, y)), opposite(ratio, x, y)].into_iter().flatten() {
                        let [slope, excess] = residuals(ratio, x, y, foot);
                        assert!(
                            slope.abs() < 1e-14 && excess.abs() < 1e-14,
                            "{ratio} {x} {y} {foot:?} {slope:e} {excess:e}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_other_minimum_exists_inside_the_evolute_only() {
        assert_eq!(nearest(0.5, 0.0, 0.0), [0.0, 1.0]);
        assert_eq!(opposite(0.5, 0.0, 0.0), Some([0.0, -1.0]));
        assert!(opposite(0.5, 0.7, 0.01).is_some() && opposite(0.5, 0.7, 0.1).is_none());
        assert!(opposite(0.5, 0.0, 1.49).is_some() && opposite(0.5, 0.0, 1.51).is_none());
        assert!(opposite(1.0, 0.0, 0.0).is_none());
        assert!(nearest(0.5, f64::NAN, 1.0)[0].is_nan());
    }
}
