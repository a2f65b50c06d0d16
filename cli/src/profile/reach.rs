//! How much of a contour that goes on for ever the rod can reach.

use vibrissa::contour::{Frame, Range};
use vibrissa::{ClampPath, Composite};

/// How far from the path of the clamp a contour is followed, in lengths of the rod.
const REACH: f64 = 1.5;

/// How much farther than its nearest point a contour out of reach is followed, in lengths of the rod.
const BEYOND: f64 = 0.5;

/// Way from one look to the next, in lengths of the rod, and the most looks.
const STEP: f64 = 0.05;
const LOOKS: usize = 20_000;

/// Places on the path from which the contour's nearest point is asked for.
const PLACES: usize = 17;

/// Bisections of the place where the contour leaves the reach, to rounding.
const HALVINGS: usize = 60;

/// The neighbourhood of the clamp's path.
pub(super) struct Reach {
    from: [f64; 2],
    along: [f64; 2],
    /// Length of the rod, m.
    length: f64,
}

impl Reach {
    pub fn new(path: &ClampPath, length: f64) -> Self {
        let [from, to] = [path.at(0.0), path.at(path.length())].map(|pose| [pose.x, pose.y]);
        Self { from, along: [to[0] - from[0], to[1] - from[1]], length }
    }

    /// The range of one stretch in its own parameter, as far as the rod reaches where it goes on for ever.
    pub fn range(&self, contour: &Composite, stretch: usize) -> Range {
        let range = contour.own_range(stretch);
        if range.is_finite() {
            return range;
        }
        let distance = |t: f64| self.distance(contour.own_frame(stretch, t));
        let start = (0..PLACES)
            .map(|place| place as f64 / (PLACES - 1) as f64)
            .map(|share| {
                let [x, y] = [0, 1].map(|side| self.from[side] + share * self.along[side]);
                contour.own_closest_in(stretch, range, x, y).t
            })
            .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
            .unwrap_or(0.0);
        let reach = (REACH * self.length).max(distance(start) + BEYOND * self.length);
        let walk = |direction: f64| {
            let (mut inside, mut outside) = (start, start);
            let mut t = start;
            for _ in 0..LOOKS {
                t += direction * STEP * self.length / contour.own_frame(stretch, t).speed;
                let far = distance(t);
                if far <= reach {
                    (inside, outside) = (t, t);
                } else if outside == inside {
                    outside = t;
                }
                // It may come back from a little outside.
                if far > 2.0 * reach || far.is_nan() {
                    break;
                }
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                if distance(middle) <= reach {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            inside
        };
        Range {
            from: if range.from.is_finite() { range.from } else { walk(-1.0) },
            to: if range.to.is_finite() { range.to } else { walk(1.0) },
        }
    }

    /// Distance from the path, m.
    fn distance(&self, frame: Frame) -> f64 {
        let [dx, dy] = [frame.x - self.from[0], frame.y - self.from[1]];
        let [along_x, along_y] = self.along;
        let square = along_x * along_x + along_y * along_y;
        let share = if square > 0.0 { ((dx * along_x + dy * along_y) / square).clamp(0.0, 1.0) } else { 0.0 };
        (dx - share * along_x).hypot(dy - share * along_y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::path;
    use vibrissa::Parabola;

    #[test]
    fn a_line_is_followed_to_the_end_of_the_reach() {
        let line = Composite::single(Parabola::new([0.0, 0.9], 0.0).unwrap()).unwrap();
        let range = Reach::new(&path(), 1.0).range(&line, 0);
        assert!((range.from + 1.2).abs() < 1e-12 && (range.to - 11.2).abs() < 1e-12, "{range:?}");
        let far = Composite::single(Parabola::new([0.0, 9.0], 0.0).unwrap()).unwrap();
        let range = Reach::new(&path(), 1.0).range(&far, 0);
        assert!((range.to - 10.0 - (9.5_f64 * 9.5 - 81.0).sqrt()).abs() < 1e-9, "{range:?}");
        let half =
            Composite::single(Parabola::new([0.0, 0.9], 0.0).unwrap().between(1.0, f64::INFINITY).unwrap()).unwrap();
        assert_eq!(Reach::new(&path(), 1.0).range(&half, 0).from, 1.0);
    }
}
