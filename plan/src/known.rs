//! What is known of a contour before the next scan.

/// What is known at a point of a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// A rod has touched it there.
    Touched {
        /// Standard deviation across the contour, m.
        sigma: f64,
    },
    /// A rod has passed outside without touching.
    Bounded {
        /// How far the object may reach beyond the point, across the contour, at most, m.
        room: f64,
    },
    /// No rod was there.
    Unknown,
}

/// An estimated contour: a spline through points in its direction, the solid on its left, cut at its vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownContour {
    /// Points, m.
    pub points: Vec<[f64; 2]>,
    /// Numbers of the points at which smooth pieces meet at an angle, in order; neither the first nor the last point.
    pub vertices: Vec<usize>,
    /// What is known at each point.
    pub known: Vec<Known>,
}

impl KnownContour {
    /// Contours joined where the end of one and the start of another are nearer than `most` (m): between two places that were touched the border of
    /// one object is taken to go on. The nearest are joined first.
    pub(crate) fn joined(contours: &[Self], most: f64) -> Vec<Self> {
        let mut contours: Vec<Self> =
            contours.iter().map(Self::without_unknown_ends).filter(|one| one.points.len() > 1).collect();
        loop {
            let mut best: Option<(f64, usize, usize)> = None;
            for (one, before) in contours.iter().enumerate() {
                for (other, after) in contours.iter().enumerate().filter(|(other, _)| *other != one) {
                    let (Some(end), Some(start)) = (before.points.last(), after.points.first()) else { continue };
                    let apart = (start[0] - end[0]).hypot(start[1] - end[1]);
                    if apart < best.map_or(most, |best| best.0) {
                        best = Some((apart, one, other));
                    }
                }
            }
            let Some((_, one, other)) = best else { return contours };
            let after = contours[other].clone();
            contours[one].append(after);
            contours.remove(other);
        }
    }

    fn append(&mut self, after: Self) {
        let first = self.points.len();
        self.vertices.extend(after.vertices.iter().map(|vertex| vertex + first));
        self.points.extend(after.points);
        self.known.extend(after.known);
    }

    /// From the first to the last point of which anything is known.
    fn without_unknown_ends(&self) -> Self {
        let is_known = |known: &Known| *known != Known::Unknown;
        let (first, last) = match (self.known.iter().position(is_known), self.known.iter().rposition(is_known)) {
            (Some(first), Some(last)) => (first, last),
            _ => return Self { points: Vec::new(), vertices: Vec::new(), known: Vec::new() },
        };
        let vertices =
            self.vertices.iter().filter(|vertex| (first + 1..last).contains(vertex)).map(|vertex| vertex - first);
        Self {
            points: self.points[first..=last].to_vec(),
            vertices: vertices.collect(),
            known: self.known[first..=last].to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contours_are_joined_end_to_start_without_what_is_not_known() {
        let line = |from: f64, known: Known| KnownContour {
            points: vec![[from, 0.0], [from + 1.0, 0.0], [from + 2.0, 0.0]],
            vertices: vec![1],
            known: vec![known, Known::Touched { sigma: 0.1 }, Known::Touched { sigma: 0.1 }],
        };
        let [left, right] = [line(0.0, Known::Unknown), line(2.5, Known::Bounded { room: 0.2 })];
        let joined = KnownContour::joined(&[right.clone(), left.clone()], 1.0);
        assert_eq!(joined.len(), 1);
        assert_eq!(joined[0].points.len(), 5);
        assert_eq!((joined[0].points[0], joined[0].points[2]), ([1.0, 0.0], [2.5, 0.0]));
        assert_eq!(joined[0].vertices, [3]);
        assert_eq!(KnownContour::joined(&[left, right], 0.4).len(), 2);
    }
}
