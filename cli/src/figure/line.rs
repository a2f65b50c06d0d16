//! Lines with no more points than a reader can tell apart.

use std::f64::consts::{PI, TAU};

/// How far a line may be from the points left out, pixels: a curve of long chords would look like a polygon.
const SLACK: f64 = 0.01;

/// The points at which a broken line turns, the first and the last among them, where a pixel is so wide and so high.
/// The canvas knows whole ones only: a straight line with points in between would go in steps.
pub(super) fn thin_line(points: impl IntoIterator<Item = (f64, f64)>, pixel: (f64, f64)) -> Vec<(f64, f64)> {
    let mut points = points.into_iter();
    let Some(first) = points.next() else { return Vec::new() };
    let (mut kept, mut from, mut last, mut fan) = (vec![first], first, first, Fan::default());
    for point in points {
        let seen = |from: (f64, f64)| ((point.0 - from.0) / (SLACK * pixel.0), (point.1 - from.1) / (SLACK * pixel.1));
        fan = fan.narrow(seen(from)).unwrap_or_else(|| {
            kept.push(last);
            from = last;
            Fan::default().narrow(seen(from)).unwrap_or_default()
        });
        last = point;
    }
    kept.push(last);
    kept
}

/// The directions from the origin in which a line passes within 1 of all points so far, about the first of them; and
/// how far the farthest is. By default all directions, before any point.
#[derive(Clone, Copy, Default)]
struct Fan {
    range: Option<(f64, [f64; 2])>,
    far: f64,
}

impl Fan {
    /// Narrowed by one more point; none where a chord to it is not within 1 of the others, or the line comes back.
    fn narrow(self, (x, y): (f64, f64)) -> Option<Self> {
        let distance = x.hypot(y);
        if distance < self.far - 1.0 {
            return None;
        }
        let far = distance.max(self.far);
        if distance <= 1.0 {
            return Some(Self { far, ..self });
        }
        let (half, direction) = ((1.0 / distance).asin(), y.atan2(x));
        let (first, [least, most]) = self.range.unwrap_or((direction, [-PI, PI]));
        let off = (direction - first + PI).rem_euclid(TAU) - PI;
        let within = (least..=most).contains(&off);
        within.then_some(Self { range: Some((first, [least.max(off - half), most.min(off + half)])), far })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(count: usize) -> impl Iterator<Item = (f64, f64)> {
        (0..=count).map(move |k| (4.0 * k as f64 / count as f64).sin_cos()).map(|(sin, cos)| (200.0 * cos, 300.0 * sin))
    }

    #[test]
    fn what_is_left_out_is_near_the_chords() {
        let kept = thin_line(arc(5000), (1.0, 2.0));
        assert!((100..300).contains(&kept.len()), "{}", kept.len());
        assert_eq!((kept.first().copied(), kept.last().copied()), (arc(1).next(), arc(1).last()));
        for (x, y) in arc(5000).map(|(x, y)| (x, y / 2.0)) {
            let distance = |pair: &[(f64, f64)]| {
                let [(a, b), (c, d)] = [pair[0], pair[1]].map(|(x, y)| (x, y / 2.0));
                let (u, v) = (c - a, d - b);
                let t = (((x - a) * u + (y - b) * v) / (u * u + v * v)).clamp(0.0, 1.0);
                (a + t * u - x).hypot(b + t * v - y)
            };
            let off = kept.windows(2).map(distance).fold(f64::INFINITY, f64::min);
            assert!(off <= SLACK * (1.0 + 1e-9), "{off}");
        }
    }

    #[test]
    fn corners_and_turnings_stay() {
        let corner = [(0.0, 0.0), (50.0, 0.0), (100.0, 0.0), (100.0, 1e-9), (100.0, 30.0), (100.0, 60.0)];
        assert_eq!(thin_line(corner, (1.0, 1.0)), [(0.0, 0.0), (100.0, 1e-9), (100.0, 60.0)]);
        let back = [(0.0, 0.0), (90.0, 0.0), (40.0, 0.0), (0.1, 0.0)];
        assert_eq!(thin_line(back, (1.0, 1.0)), [(0.0, 0.0), (90.0, 0.0), (0.1, 0.0)]);
        assert_eq!(thin_line([], (1.0, 1.0)), []);
    }
}
