//! A round pole that the rod touches.

use super::shape::Contact;
use nalgebra::Matrix3;
use rod_core::Units;

/// What is known of a pole, a disc in the plane of the rod, that is in the same place in all frames: its rim is where the rod touches it, on the side
/// or with the tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PolePrior {
    /// Its centre, m; found from the frames where it is not known.
    pub center: Option<[f64; 2]>,
    /// Standard deviation of each coordinate of a centre that is known, m; a thousandth of the length of the rod where it is not known.
    pub sigma: Option<f64>,
    /// Its radius, m; found from the frames where it is not known. Points of a surface that is small beside the way of the contact on the
    /// rod are a pole of radius 0.
    pub radius: Option<f64>,
}

/// The pole that explains the frames.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmPole {
    /// Centre, m.
    pub center: [f64; 2],
    /// Radius, m.
    pub radius: f64,
    /// Covariance of (x, y, radius), m^2; 0 where the radius was given, or no more than 0 was needed.
    pub covariance: [[f64; 3]; 3],
    /// Chi squared of the frames that touch it, and degrees of freedom.
    pub chi_squared: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// The probability that chance leaves as much.
    pub p_value: f64,
    /// The frames that touch it, by their index.
    pub frames: Vec<usize>,
    /// Frames with a contact that is not at this pole, by their index: they are judged as without it.
    pub elsewhere: Vec<usize>,
}

/// A pole as the least squares of one frame know it, lengths in L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pole {
    pub center: [f64; 2],
    pub radius: f64,
    /// Standard deviation of the distance of its rim from the contact.
    pub sigma: f64,
}

/// Where the centre of a pole of a radius is that a contact touches, with its rates by the unknowns.
pub(super) struct Centre {
    pub at: [f64; 2],
    /// The direction from the contact to it.
    pub direction: [f64; 2],
    by: Vec<[f64; 2]>,
}

impl Centre {
    /// The pole is where the force comes from: across the rod on the side, against the force at the tip.
    pub fn of(contact: &Contact, radius: f64, unknowns: usize) -> Self {
        let [a, b] = contact.force.ab;
        let size = a.hypot(b).max(f64::MIN_POSITIVE);
        let (sin, cos) = contact.node.cut.phi.sin_cos();
        // the force on the rod is (B, -A): from a pole on its left, along (-sin, cos), it goes against that
        let side = if a * cos + b * sin < 0.0 { -1.0 } else { 1.0 };
        let direction = if contact.is_tip { [-b / size, a / size] } else { [-sin * side, cos * side] };
        let by = (0..unknowns).map(|k| {
            let [x, y, turn, _] = contact.node.by[k];
            let turned = if contact.is_tip {
                let [da, db] = contact.force.by[k];
                let along = (a * da + b * db) / size;
                [-(db - b / size * along) / size, (da - a / size * along) / size]
            } else {
                [-cos * side * turn, -sin * side * turn]
            };
            [x + radius * turned[0], y + radius * turned[1]]
        });
        let cut = &contact.node.cut;
        Self { at: [cut.x + radius * direction[0], cut.y + radius * direction[1]], direction, by: by.collect() }
    }

    /// Rates of one coordinate.
    pub fn by(&self, unknown: usize) -> [f64; 2] {
        self.by[unknown]
    }
}

impl PolePrior {
    /// With lengths in the length of the rod.
    pub(super) fn in_lengths(&self, length: f64) -> Self {
        Self {
            center: self.center.map(|center| center.map(|c| c / length)),
            sigma: self.sigma.map(|sigma| sigma / length),
            radius: self.radius.map(|radius| radius / length),
        }
    }
}

impl FilmPole {
    /// Standard deviations of x, y and the radius.
    pub fn sigmas(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.covariance[i][i].max(0.0).sqrt())
    }

    /// Poles that are off by one standard deviation each, in independent directions.
    pub(super) fn moved(&self) -> Vec<Self> {
        let directions = Matrix3::from_fn(|i, j| self.covariance[i][j]).symmetric_eigen();
        let sizes = directions.eigenvalues.map(|variance| variance.max(0.0).sqrt());
        let moved = (0..3).filter(|k| sizes[*k] > 0.0).map(|k| {
            let way = directions.eigenvectors.column(k) * sizes[k];
            let center = [self.center[0] + way[0], self.center[1] + way[1]];
            Self { center, radius: (self.radius + way[2]).max(0.0), ..self.clone() }
        });
        moved.collect()
    }

    /// As the least squares know it.
    pub(super) fn in_lengths(&self, units: &Units, sigma: f64) -> Pole {
        Pole { center: self.center.map(|c| c / units.length), radius: self.radius / units.length, sigma }
    }
}
