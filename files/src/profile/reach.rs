//! How much of a contour that goes on for ever the rod can reach.

use vibrissa::contour::{Frame, Range};
use vibrissa::{Composite, Pose};

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
    /// The straight parts of the path: where each starts, and where it leads.
    parts: Vec<([f64; 2], [f64; 2])>,
    /// Length of the rod, m.
    length: f64,
}

impl Reach {
    /// Along straight lines from pose to pose.
    pub fn new(poses: Vec<Pose>, length: f64) -> Self {
        let part = |pair: &[Pose]| {
            let [from, to] = [pair[0], pair[1]].map(|pose| [pose.x, pose.y]);
            (from, [to[0] - from[0], to[1] - from[1]])
        };
        Self { parts: poses.windows(2).map(part).collect(), length }
    }

    /// The range of one stretch in its own parameter, as far as the rod reaches where it goes on for ever.
    pub fn range(&self, contour: &Composite, stretch: usize) -> Range {
        let range = contour.own_range(stretch);
        if range.is_finite() {
            return range;
        }
        let distance = |t: f64| self.distance(contour.own_frame(stretch, t));
        let places = self.parts.iter().flat_map(|part| (0..PLACES).map(move |place| (part, place)));
        let start = places
            .map(|((from, along), place)| {
                let share = place as f64 / (PLACES - 1) as f64;
                let [x, y] = [0, 1].map(|side| from[side] + share * along[side]);
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
        let distance = |(from, along): &([f64; 2], [f64; 2])| {
            let [dx, dy] = [frame.x - from[0], frame.y - from[1]];
            let [along_x, along_y] = *along;
            let square = along_x * along_x + along_y * along_y;
            let share = if square > 0.0 { ((dx * along_x + dy * along_y) / square).clamp(0.0, 1.0) } else { 0.0 };
            (dx - share * along_x).hypot(dy - share * along_y)
        };
        // NaN must not get lost
        self.parts.iter().map(distance).reduce(|a, b| if b < a || b.is_nan() { b } else { a }).unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::{ClampPath, Parabola};

    fn poses() -> Vec<Pose> {
        vec![path().at(0.0), path().at(path().length())]
    }

    /// The path on which all of it happens: from x = 0 to 10.
    fn path() -> ClampPath {
        ClampPath::new(Pose { x: 0.0, y: 0.0, phi: 0.0 }, Pose { x: 10.0, y: 0.0, phi: 0.0 }).unwrap()
    }

    #[test]
    fn a_line_is_followed_to_the_end_of_the_reach() {
        let line = Composite::single(Parabola::new([0.0, 0.9], 0.0).unwrap()).unwrap();
        let range = Reach::new(poses(), 1.0).range(&line, 0);
        assert!((range.from + 1.2).abs() < 1e-12 && (range.to - 11.2).abs() < 1e-12, "{range:?}");
        let far = Composite::single(Parabola::new([0.0, 9.0], 0.0).unwrap()).unwrap();
        let range = Reach::new(poses(), 1.0).range(&far, 0);
        assert!((range.to - 10.0 - (9.5_f64 * 9.5 - 81.0).sqrt()).abs() < 1e-9, "{range:?}");
        let half =
            Composite::single(Parabola::new([0.0, 0.9], 0.0).unwrap().between(1.0, f64::INFINITY).unwrap()).unwrap();
        assert_eq!(Reach::new(poses(), 1.0).range(&half, 0).from, 1.0);
    }
}
