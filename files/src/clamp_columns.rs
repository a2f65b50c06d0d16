//! The coordinates of a clamp in a table of text.

use vibrissa::Pose;

/// Smallest change of a coordinate that is shown, in lengths of the rod or rad: rounding of a path is below.
const CHANGE: f64 = 1e-9;

/// A coordinate in lengths of the rod: the name of its column, and the coordinate of a pose in m.
type InLengths = (&'static str, fn(Pose) -> f64);

/// The coordinates of a clamp that change along a path, as columns: x0 and y0 in mm, phi0 in degrees. One that stays the same would look like data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ClampColumns {
    changes: [bool; 3],
}

impl ClampColumns {
    /// Those that change between the poses of a rod of this length (m); all of them where none does.
    pub fn of(poses: impl IntoIterator<Item = Pose>, length: f64) -> Self {
        let mut poses = poses.into_iter().map(|pose| [pose.x / length, pose.y / length, pose.phi]);
        let first = poses.next().unwrap_or_default();
        let mut changes = [false; 3];
        for pose in poses {
            for (k, change) in changes.iter_mut().enumerate() {
                *change |= (pose[k] - first[k]).abs() > CHANGE;
            }
        }
        Self { changes: if changes.contains(&true) { changes } else { [true; 3] } }
    }

    fn shown<T>(self, columns: [T; 3]) -> impl Iterator<Item = T> {
        columns.into_iter().zip(self.changes).filter(|column| column.1).map(|column| column.0)
    }

    /// Their names.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        self.shown(["x0 mm", "y0 mm", "phi0 deg"])
    }

    /// Their values at a pose, with so many decimals.
    pub fn cells(self, pose: Pose, decimals: usize) -> impl Iterator<Item = String> {
        self.shown([1e3 * pose.x, 1e3 * pose.y, pose.phi.to_degrees()]).map(move |value| format!("{value:.decimals$}"))
    }

    /// The first coordinate that changes, if it is a length, in lengths of the rod.
    pub fn in_lengths(self) -> Option<InLengths> {
        match self.changes {
            [true, ..] => Some(("x0/L", |pose| pose.x)),
            [_, true, _] => Some(("y0/L", |pose| pose.y)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ClampColumns;
    use vibrissa::Pose;

    #[test]
    fn a_coordinate_that_stays_the_same_has_no_column() {
        let of = |[dx, dy, turn]: [f64; 3]| {
            let pose = |k: f64| Pose { x: 0.02 + k * dx, y: -0.04 + k * dy, phi: 1.5 + k * turn };
            let columns = ClampColumns::of([0.0, 0.5, 1.0].map(pose), 0.1);
            let in_lengths = columns.in_lengths().map(|(name, value)| format!("{name} {}", value(pose(0.0))));
            let cells: Vec<String> = columns.cells(pose(0.0), 1).collect();
            (columns.names().collect::<Vec<_>>().join(", "), cells.join(", "), in_lengths.unwrap_or_default())
        };
        let all = ("x0 mm, y0 mm, phi0 deg", "20.0, -40.0, 85.9");
        let cases = [
            ([0.01, 0.0, 0.0], ("x0 mm", "20.0"), "x0/L 0.02"),
            ([0.0, 0.01, 1e-12], ("y0 mm", "-40.0"), "y0/L -0.04"),
            ([1e-13, 0.0, 0.3], ("phi0 deg", "85.9"), ""),
            ([1e-3, 1e-3, 0.3], all, "x0/L 0.02"),
            ([0.0, 0.0, 0.0], all, "x0/L 0.02"),
        ];
        for (change, (names, cells), in_lengths) in cases {
            assert_eq!(of(change), (names.to_owned(), cells.to_owned(), in_lengths.to_owned()), "{change:?}");
        }
    }
}
