//! The path of a clamp whose poses tremble.

use nalgebra::Vector3;

/// Samples on either side of the narrowest window.
const NARROWEST: usize = 2;
/// Factor by which the window grows until the clamp moves on from every sample to the next.
const GROWTH: f64 = 1.5;
/// The window that is used is wider than the first that lets the clamp move on by this factor. Larger: more even steps, and
/// changes of speed are smoothed. At 1 some steps are almost 0.
const WIDER: f64 = 2.0;
/// A window has at most this share of the path on either side.
const SHARE: f64 = 0.1;

/// Poses smoothed along the path by means over triangular windows (which leave a uniform motion as it is), as narrow as lets
/// the clamp move on in one direction; none where no window does.
pub(super) fn smooth_path(
    poses: &[Vector3<f64>],
    moves_on: impl Fn(&[Vector3<f64>]) -> bool,
) -> Option<Vec<Vector3<f64>>> {
    let widest = (SHARE * poses.len() as f64) as usize;
    let mut half = NARROWEST;
    while half <= widest {
        if moves_on(&smooth_twice(poses, half)) {
            let wider = smooth_twice(poses, ((WIDER * half as f64) as usize).min(widest));
            return Some(if moves_on(&wider) { wider } else { smooth_twice(poses, half) });
        }
        half = (half as f64 * GROWTH).ceil() as usize;
    }
    None
}

/// Means over windows of `half` samples on either side, twice. Beyond the ends the path goes on by its reflection in the end, the
/// place of which is that of a line through the nearest samples.
fn smooth_twice(poses: &[Vector3<f64>], half: usize) -> Vec<Vector3<f64>> {
    let count = poses.len();
    let half = half.min(count.saturating_sub(1) / 2);
    let reach = 2 * half;
    let near = (3 * half + 1).min(count);
    let start = line_at_end(poses[..near].iter());
    let end = line_at_end(poses[count - near..].iter().rev());
    let at = |k: isize| {
        let last = count as isize - 1;
        if k < 0 {
            2.0 * start - poses[(-k).min(last) as usize]
        } else if k > last {
            2.0 * end - poses[(2 * last - k).max(0) as usize]
        } else {
            poses[k as usize]
        }
    };
    let extended: Vec<Vector3<f64>> = (-(reach as isize)..(count + reach) as isize).map(at).collect();
    means(&means(&extended, half), half)
}

/// Means of 2 half + 1 neighbours; there are 2 half fewer of them.
fn means(values: &[Vector3<f64>], half: usize) -> Vec<Vector3<f64>> {
    let width = 2 * half + 1;
    // sums relative to the first value, so that they stay small
    let first = values.first().copied().unwrap_or_default();
    let mut sums = vec![Vector3::zeros()];
    let mut sum = Vector3::zeros();
    for value in values {
        sum += value - first;
        sums.push(sum);
    }
    sums.windows(width + 1).map(|w| first + (w[width] - w[0]) / width as f64).collect()
}

/// The value at the first place of a straight line through the values.
fn line_at_end<'a>(values: impl ExactSizeIterator<Item = &'a Vector3<f64>>) -> Vector3<f64> {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let (mut mean, mut slope, mut square) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for (k, value) in values.enumerate() {
        let t = k as f64 - middle;
        mean += value / count;
        slope += value * t;
        square += t * t;
    }
    if square > 0.0 { mean - slope * (middle / square) } else { mean }
}
