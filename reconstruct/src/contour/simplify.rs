//! Polygons with no more points than their shape needs (Ramer 1972; Douglas and Peucker 1973).

use super::trace::TracePoint;

/// Departure, m, that counts as zero: it only keeps the quotient below finite.
const SMALLEST: f64 = 1e-100;

/// The points without those that depart from the chords between the others by no more than a share of their standard deviation, or
/// the tolerance (m) where that is larger.
pub(crate) fn simplify(points: &[TracePoint], share: f64, tolerance: f64) -> Vec<TracePoint> {
    let allowed = |k: usize| (share * points[k].sigma).max(tolerance);
    let keep = corners(points.len(), |k| [points[k].x, points[k].y], allowed);
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// Which of so many points depart from the chords between the others by more than is `allowed` of each, m; the first and the last always.
pub(crate) fn corners(count: usize, at: impl Fn(usize) -> [f64; 2], allowed: impl Fn(usize) -> f64) -> Vec<bool> {
    let Some(last) = count.checked_sub(1) else { return Vec::new() };
    let mut keep = vec![false; count];
    keep[0] = true;
    keep[last] = true;
    let mut spans = vec![(0, last)];
    while let Some((from, to)) = spans.pop() {
        let ([ax, ay], [bx, by]) = (at(from), at(to));
        let (dx, dy) = (bx - ax, by - ay);
        let square = dx * dx + dy * dy;
        let mut worst = (1.0, 0);
        for k in from + 1..to {
            let [x, y] = at(k);
            let (px, py) = (x - ax, y - ay);
            let t = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
            let (u, v) = (px - t * dx, py - t * dy);
            let most = allowed(k).max(SMALLEST);
            let departure = (u * u + v * v) / (most * most);
            if departure > worst.0 {
                worst = (departure, k);
            }
        }
        if worst.1 > 0 {
            keep[worst.1] = true;
            spans.extend([(from, worst.1), (worst.1, to)]);
        }
    }
    keep
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_on_a_chord_is_left_out() {
        let point = |k: i32| {
            let x = f64::from(k) * 1e-5;
            TracePoint { x, y: 50.0 * x * x, alpha: (100.0 * x).atan(), sigma: 0.0, systematic: 0.0 }
        };
        let points: Vec<_> = (-1000..=1000).map(point).collect();
        let few = simplify(&points, 0.5, 1e-6);
        assert!(few.len() < 120 && few[0] == points[0] && few.last() == points.last(), "{}", few.len());
        for p in &points {
            let k = few.iter().position(|q| q.x >= p.x).unwrap().max(1);
            let (a, b) = (few[k - 1], few[k]);
            let y = a.y + (b.y - a.y) * (p.x - a.x) / (b.x - a.x);
            assert!((y - p.y) / (1.0 + (100.0 * p.x).powi(2)).sqrt() < 1.2e-6);
        }
        assert!(simplify(&points, 0.5, 1e-3).len() < 10);
        assert_eq!(simplify(&points[..1], 0.5, 1e-6).len(), 1);
        assert_eq!(simplify(&[], 0.5, 1e-6), []);
    }
}
