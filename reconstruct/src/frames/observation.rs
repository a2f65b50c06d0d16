//! What was seen of a rod at one instant.

use std::fmt;

/// Everything that was measured at one instant, SI units: points on the rod, numbers at its base, or both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Points on the rod, in order from the base to the tip; where along the rod they are is not known.
    pub points: Vec<SeenPoint>,
    /// Whether the first point is the base of the rod.
    pub base_is_first: bool,
    /// Whether the last point is the tip of the rod.
    pub tip_is_last: bool,
    /// Measured numbers.
    pub channels: Vec<Channel>,
}

/// A point on the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPoint {
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Standard deviation of each coordinate, m; that of the film where it is not known.
    pub sigma: Option<f64>,
}

/// A measured number with its noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// What was measured.
    pub quantity: Measurand,
    /// The number.
    pub value: f64,
    /// Its standard deviation, larger than 0, in the same unit.
    pub sigma: f64,
}

/// What a channel measures.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Measurand {
    /// A linear combination of the reactions at the base: the weights of f0x, f0y (N) and m0z (N m). (1, 0, 0) is f0x itself; a sensor that is
    /// turned or sits at a lever has other weights.
    Reaction([f64; 3]),
    /// Where the base of the rod is: m, rad. On a rigid clamp that of the support.
    Base(Axis),
    /// Where the support of a clamp on springs is: m, rad.
    Support(Axis),
    /// The curvature of the rod at an arc length (m), 1/m: twice the strain at the surface over the diameter.
    Curvature(f64),
    /// A coordinate of the rod at a known arc length (m), m: of a marker on it.
    Marker(f64, Axis),
}

/// A component of a position and direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along x, m.
    X,
    /// Along y, m.
    Y,
    /// The slope angle, rad.
    Angle,
}

/// As the columns of tables are named.
impl fmt::Display for Measurand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |axis: &Axis| ["x", "y", "phi"][axis.index()];
        match self {
            Self::Reaction([1.0, 0.0, 0.0]) => f.write_str("f0x"),
            Self::Reaction([0.0, 1.0, 0.0]) => f.write_str("f0y"),
            Self::Reaction([0.0, 0.0, 1.0]) => f.write_str("m0z"),
            Self::Reaction([x, y, m]) => write!(f, "{x} f0x + {y} f0y + {m} m0z"),
            Self::Base(axis) => write!(f, "base_{}", name(axis)),
            Self::Support(axis) => write!(f, "{}0", name(axis)),
            Self::Curvature(s) => write!(f, "kappa@{s}"),
            Self::Marker(s, axis) => write!(f, "{}@{s}", name(axis)),
        }
    }
}

impl Axis {
    /// Its place in (x, y, phi).
    pub(super) fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Angle => 2,
        }
    }
}

impl Frame {
    /// The same points in reverse order, of the same ends.
    pub(super) fn reversed(&self) -> Self {
        let points = self.points.iter().rev().copied().collect();
        Self { points, channels: self.channels.clone(), ..*self }
    }

    /// A frame of points of which the first is the base of the rod.
    ///
    /// ```
    /// use rod_reconstruct::Frame;
    /// let frame = Frame::from_base(&[[0.0, 0.0], [0.01, 0.001], [0.02, 0.003]]);
    /// assert!(frame.base_is_first && !frame.tip_is_last && frame.points.len() == 3);
    /// ```
    pub fn from_base(points: &[[f64; 2]]) -> Self {
        let points = points.iter().map(|&[x, y]| SeenPoint { x, y, sigma: None }).collect();
        Self { points, base_is_first: true, ..Self::default() }
    }
}
