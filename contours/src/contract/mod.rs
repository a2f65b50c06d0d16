//! The contract of [`Contour`] as functions, one for each numbered line in the trait's documentation.
//!
//! Each takes a shape and a place and says in words what is wrong there. [`check`] runs them all, for a property test of
//! a new shape:
//!
//! ```
//! use rod_contours::{Parabola, contract};
//!
//! let shape = Parabola::new([0.1, 0.2], -3.0)?;
//! // Under proptest: random shapes, and `samples` from `vec(0.0..=1.0, 8)`.
//! contract::check(&shape, &[0.0, 0.2, 0.51, 1.0])?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod spot_check;

use crate::{Bounds, Contour, Frame, Point, Range, Vector};

/// Part of an infinite range that [`check`] tests, in units of the parameter.
const WINDOW: f64 = 10.0;

/// Accepted error of a length, relative to the largest coordinate: the ends of a composite's pieces may differ
/// by as much.
const CLOSE: f64 = 2e-9;

/// Accepted error of a distance that is exact to rounding, relative to the largest coordinate.
const EXACT: f64 = 1e-13;

/// Rounding of a coordinate or an angle, relative.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Step of the differences, relative to the range.
const STEP: f64 = 1e-6;

/// Accepted error of a rate from differences, relative, beside how much the rate itself varies between the samples.
const RATE: f64 = 1e-6;

/// Samples against which the closest point is compared.
const SAMPLES: usize = 256;

/// 1: the frame at `t` is finite.
pub fn c1_finite(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let frame = shape.frame(t);
    let numbers = [frame.x, frame.y, frame.alpha, frame.speed, frame.turning];
    holds(numbers.iter().all(|number| number.is_finite()), || {
        format!("1: the frame at t = {t} is not finite: {frame:?}")
    })
}

/// 2: `dr/dt = speed (cos alpha, sin alpha)`, by differences over 1e-6 of the range; the error may be 1e-6 of the speed
/// plus the change of `dr/dt` within the difference.
pub fn c2_velocity(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let difference = Difference::new(shape, t);
    let [before, here, after] = difference.frames;
    let [v0, v1, v2] = difference.frames.map(velocity);
    let width = difference.width;
    let error = (after.x - before.x - width * v1[0]).hypot(after.y - before.y - width * v1[1]);
    let varies = (v0[0] - v1[0]).hypot(v0[1] - v1[1]) + (v2[0] - v1[0]).hypot(v2[1] - v1[1]);
    let accepted = width * (varies + RATE * here.speed) + ROUNDING * scale(shape, [here.x, here.y]);
    holds(error <= accepted, || {
        format!(
            "2: over {width:e} about t = {t} the point moves from ({}, {}) to ({}, {}), which speed {} and alpha {} miss by {error:e}, more than {accepted:e}",
            before.x, before.y, after.x, after.y, here.speed, here.alpha
        )
    })
}

/// 3: `d alpha/dt = turning` and alpha does not jump, by the differences of [`c2_velocity`].
pub fn c3_turning(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let difference = Difference::new(shape, t);
    let [before, here, after] = difference.frames;
    let width = difference.width;
    let error = (after.alpha - before.alpha - width * here.turning).abs();
    let varies = (before.turning - here.turning).abs() + (after.turning - here.turning).abs();
    // Smooth joints of a composite may turn by up to `CLOSE`.
    let accepted = width * (varies + RATE * here.turning.abs()) + ROUNDING * here.alpha.abs() + CLOSE;
    holds(error <= accepted, || {
        format!(
            "3: over {width:e} about t = {t} alpha goes from {} to {}, which turning {} misses by {error:e}, more than {accepted:e}",
            before.alpha, after.alpha, here.turning
        )
    })
}

/// 4: `speed >= 0` and `speed + |turning| > 0` at `t`.
pub fn c4_moving(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let Frame { speed, turning, .. } = shape.frame(t);
    holds(speed >= 0.0 && speed + turning.abs() > 0.0, || {
        format!("4: speed {speed} and turning {turning} at t = {t}, expected speed >= 0 and speed + |turning| > 0")
    })
}

/// 5: the closest point to `point` lies in the range, has the frame of its parameter, and is `|gap|` away.
pub fn c5_foot(shape: &dyn Contour, point: Point) -> Result<(), String> {
    let [x, y] = point;
    let closest = shape.closest(x, y);
    let range = shape.range();
    holds(range.contains(closest.t), || {
        format!("5: the closest point to ({x}, {y}) is at t = {}, outside {range:?}", closest.t)
    })?;
    let frame = shape.frame(closest.t);
    let accepted = CLOSE * scale(shape, point);
    let apart = frame.distance(closest.frame.x, closest.frame.y);
    let turned = (frame.alpha - closest.frame.alpha).abs();
    holds(apart <= accepted && turned <= CLOSE, || {
        format!(
            "5: the closest point to ({x}, {y}) is at t = {} with {:?}, but the frame there is {frame:?}",
            closest.t, closest.frame
        )
    })?;
    let distance = closest.frame.distance(x, y);
    holds((closest.gap.abs() - distance).abs() <= accepted, || {
        format!(
            "5: the gap at ({x}, {y}) is {}, but the closest point (t = {}) is {distance} away",
            closest.gap, closest.t
        )
    })
}

/// 6: none of 257 samples of the contour is nearer to `point` than the closest point.
pub fn c6_nearest(shape: &dyn Contour, point: Point) -> Result<(), String> {
    let [x, y] = point;
    let gap = shape.gap(x, y);
    let accepted = CLOSE * scale(shape, point);
    for t in spread(shape.range()) {
        let frame = shape.frame(t);
        let distance = frame.distance(x, y);
        // The second term is the rounding of a far sample.
        holds(distance >= gap.abs() - accepted - ROUNDING * distance, || {
            format!("6: the gap at ({x}, {y}) is {gap}, but t = {t} is only {distance} away")
        })?;
    }
    Ok(())
}

/// 7: a small step from the point at `t` leads outside against the normal and inside along it, unless another part of
/// the contour is nearer there. Says nothing in a corner (speed 0).
pub fn c7_side(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let frame = shape.frame(t);
    let reach = 1e-3 * frame.speed * shape.range().window(WINDOW).length();
    let step = reach.min(0.1 / frame.curvature().abs());
    // Not where there is no normal, nor where the step would drown in rounding.
    if frame.speed == 0.0 || step < CLOSE * scale(shape, [frame.x, frame.y]) {
        return Ok(());
    }
    let (nx, ny) = frame.normal();
    for outwards in [1.0, -1.0] {
        let (x, y) = (frame.x - outwards * step * nx, frame.y - outwards * step * ny);
        let gap = shape.gap(x, y);
        holds(gap * outwards > 0.0 || gap.abs() < step * (1.0 - 1e-6), || {
            let side = if outwards > 0.0 { "outside" } else { "inside" };
            format!("7: {step:e} to the {side} of t = {t}, at ({x}, {y}), the gap is {gap:e}")
        })?;
    }
    Ok(())
}

/// 8: from `point` to `other` the gap changes by no more than their distance: always in absolute value, and with its sign
/// where nine points on the way all have interior closest points.
pub fn c8_lipschitz(shape: &dyn Contour, point: Point, other: Point) -> Result<(), String> {
    let way = [other[0] - point[0], other[1] - point[1]];
    let stops: Vec<_> = (0..=8)
        .map(|stop| f64::from(stop) / 8.0)
        .map(|u| shape.closest(point[0] + u * way[0], point[1] + u * way[1]))
        .collect();
    let (here, there) = (stops[0], stops[8]);
    let accepted = way[0].hypot(way[1]) + CLOSE * scale(shape, point);
    let signed = stops.iter().all(|stop| stop.interior);
    let change = if signed { (there.gap - here.gap).abs() } else { (there.gap.abs() - here.gap.abs()).abs() };
    holds(change <= accepted, || {
        format!(
            "8: the gap goes from {} at {point:?} to {} at {other:?}, expected a change of at most {accepted}",
            here.gap, there.gap
        )
    })
}

/// 9: the bounds contain the point at `t`.
pub fn c9_bounds(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let frame = shape.frame(t);
    let bounds = shape.bounds();
    let margin = ROUNDING * scale(shape, [frame.x, frame.y]);
    holds(bounds.grown(margin).contains(frame.x, frame.y), || {
        format!("9: ({}, {}) at t = {t} lies outside {bounds:?}", frame.x, frame.y)
    })
}

/// 10: unless it is not convex, none of 257 samples of the contour is on one side of the tangent at `t` and none of the others
/// on the other; the same for the part between neighbouring cuts that holds `t`.
pub fn c10_convex(shape: &dyn Contour, t: f64) -> Result<(), String> {
    let whole = shape.range();
    let cuts = shape.cuts(whole);
    let next = cuts.partition_point(|&cut| cut <= t);
    let part = Range {
        from: next.checked_sub(1).and_then(|before| cuts.get(before)).copied().unwrap_or(whole.from),
        to: cuts.get(next).copied().unwrap_or(whole.to),
    };
    for range in [whole, part] {
        holds(!shape.is_convex(range) || is_on_one_side(shape, range, t), || {
            format!("10: `is_convex` is true in {range:?}, but the shape lies on both sides of its tangent at t = {t}")
        })?;
    }
    Ok(())
}

/// Whether the samples of the range are on one side of the tangent at `t`.
fn is_on_one_side(shape: &dyn Contour, range: Range, t: f64) -> bool {
    let frame = shape.frame(t);
    let (mut inside, mut outside) = (false, false);
    for t in spread(range) {
        let at = shape.frame(t);
        let (side, accepted) = (frame.local(at.x, at.y).1, CLOSE * scale(shape, [at.x, at.y]));
        inside |= side < -accepted;
        outside |= side > accepted;
    }
    !(inside && outside)
}

/// 11: the curvature at 257 samples of the range lies within its bounds, to 2e-9 of itself and of one over the length.
pub fn c11_curvature(shape: &dyn Contour, range: Range) -> Result<(), String> {
    let (least, largest) = shape.curvature_in(range);
    let length = shape.range().window(WINDOW).length();
    for t in spread(range) {
        let frame = shape.frame(t);
        let curvature = frame.curvature();
        let accepted = if frame.speed > 0.0 { CLOSE * (curvature.abs() + 1.0 / (frame.speed * length)) } else { 0.0 };
        holds(curvature >= least - accepted && curvature <= largest + accepted, || {
            format!(
                "11: the curvature at t = {t} is {curvature}, but in {range:?} it is said to be {least} to {largest}"
            )
        })?;
    }
    Ok(())
}

/// 12: unless closest points are not exact, that of the part in `range` to `point` lies in the part, and none of 257
/// samples of the part is nearer, to rounding.
pub fn c12_exact(shape: &dyn Contour, range: Range, point: Point) -> Result<(), String> {
    if !shape.closest_is_exact() {
        return Ok(());
    }
    let [x, y] = point;
    let closest = shape.closest_in(range, x, y);
    holds(range.contains(closest.t), || {
        format!("12: the closest point to ({x}, {y}) in {range:?} is at t = {}, outside", closest.t)
    })?;
    let rounding = EXACT * scale(shape, point);
    for t in spread(range) {
        let distance = shape.frame(t).distance(x, y);
        holds(distance >= closest.gap.abs() - rounding - EXACT * distance, || {
            format!("12: the gap at ({x}, {y}) in {range:?} is {}, but t = {t} is only {distance} away", closest.gap)
        })?;
    }
    Ok(())
}

/// The whole contract at parameters and points spread over the range (over 10 units of the parameter from its finite end,
/// or either way from 0, where it is infinite) by `samples`, numbers from 0 to 1.
///
/// # Errors
///
/// The fault in words, after the number of the contract's line.
pub fn check(shape: &dyn Contour, samples: &[f64]) -> Result<(), String> {
    let window = shape.range().window(WINDOW);
    let extent = (0..=32)
        .map(|k| shape.frame(window.at(f64::from(k) / 32.0)))
        .fold(Bounds::EMPTY, |bounds, frame| bounds.with(frame.x, frame.y));
    let size = (extent.max[0] - extent.min[0]).hypot(extent.max[1] - extent.min[1]);
    for (&sample, &other) in samples.iter().zip(samples.iter().cycle().skip(1)) {
        let t = window.at(sample);
        let part = Range { from: t.min(window.at(other)), to: t.max(window.at(other)) };
        c1_finite(shape, t)?;
        c2_velocity(shape, t)?;
        c3_turning(shape, t)?;
        c4_moving(shape, t)?;
        c7_side(shape, t)?;
        c9_bounds(shape, t)?;
        c10_convex(shape, t)?;
        c11_curvature(shape, part)?;
        let frame = shape.frame(t);
        let (nx, ny) = frame.normal();
        for (k, away) in [-0.7, -0.03, -1e-6, 0.0, 1e-6, 0.03, 0.7].into_iter().enumerate() {
            let point = [frame.x + away * size * nx, frame.y + away * size * ny];
            c5_foot(shape, point)?;
            c6_nearest(shape, point)?;
            c12_exact(shape, part, point)?;
            // Short ways in all directions: a long one may lead around the end of a contour unseen.
            let (sin, cos) = (k as f64 + 100.0 * sample).sin_cos();
            let step = 0.01 * size;
            c8_lipschitz(shape, point, [point[0] + step * cos, point[1] + step * sin])?;
        }
    }
    c11_curvature(shape, shape.range())
}

/// 13: where the shape knows the parameter, the rate's alpha is the angle by which its point turns the tangent, by differences over
/// 1e-6 of the range. Not part of [`check`], which does not know the names of parameters. It does not see a rate that is wrong
/// along the contour, or by a constant: compare with a shape whose parameter differs, too.
pub fn c13_frame_rate(shape: &dyn Contour, parameter: &str, t: f64) -> Result<(), String> {
    let step = STEP * shape.range().window(WINDOW).length();
    let Range { from, to } = Range { from: t - step, to: t + step };
    let Some(rates) = [from, t, to].map(|t| shape.frame_rate(t, parameter)).into_iter().collect::<Option<Vec<_>>>()
    else {
        return Err(format!("13: the shape does not know the parameter {parameter:?} at t = {t}"));
    };
    let [before, here, after] = [rates[0], rates[1], rates[2]];
    let frame = shape.frame(t);
    let (nx, ny) = frame.normal();
    let turned = (nx * (after.x - before.x) + ny * (after.y - before.y)) / (to - from);
    let expected = frame.speed * here.alpha;
    let size = [here.x, here.y, here.alpha].into_iter().fold(frame.speed, |most: f64, v| most.max(v.abs()));
    let accepted = 1e3 * RATE * size * (1.0 + frame.turning.abs());
    holds((turned - expected).abs() <= accepted, || {
        format!(
            "13: at t = {t} the rates of the point by {parameter:?} turn the tangent by {turned}, its alpha by {expected}"
        )
    })
}

/// The parameters of 257 samples of a range, ends included.
fn spread(range: Range) -> impl Iterator<Item = f64> {
    let window = range.window(WINDOW);
    (0..=SAMPLES).map(move |sample| window.at(sample as f64 / SAMPLES as f64))
}

/// Three frames about a parameter, at the distance at which differences are neither rounding nor curvature.
struct Difference {
    frames: [Frame; 3],
    /// From the first to the last, units of the parameter.
    width: f64,
}

impl Difference {
    fn new(shape: &dyn Contour, t: f64) -> Self {
        let range = shape.range();
        let step = STEP * range.window(WINDOW).length();
        // What the numbers really differ by.
        let Range { from, to } = Range { from: t - step, to: t + step };
        Self { frames: [from, t, to].map(|t| shape.frame(t)), width: to - from }
    }
}

/// `dr/dt` as the frame has it.
fn velocity(frame: Frame) -> Vector {
    let (sin, cos) = frame.alpha.sin_cos();
    [frame.speed * cos, frame.speed * sin]
}

/// The largest coordinate of the point and of the contour (where it is infinite, of one unit of its parameter): the
/// length against which rounding is judged. The point alone will not do, it may be the origin.
fn scale(shape: &dyn Contour, point: Point) -> f64 {
    let near = shape.range().window(1.0);
    (0..=4)
        .map(|k| shape.frame(near.at(f64::from(k) / 4.0)))
        .fold(point[0].abs().max(point[1].abs()), |scale, frame| scale.max(frame.x.abs()).max(frame.y.abs()))
}

/// The message unless it holds.
fn holds(condition: bool, message: impl FnOnce() -> String) -> Result<(), String> {
    if condition { Ok(()) } else { Err(message()) }
}
