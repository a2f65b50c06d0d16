//! What an equilibrium depends on.

use std::fmt;

/// A quantity by which to differentiate. Objects and their pieces are counted from 0.
///
/// An object turns about the origin of coordinates and is scaled from there. About a point (x, y) instead, the derivative by the
/// angle is `ObjectAngle + y ObjectX - x ObjectY`, that by the scale `ObjectScale - x ObjectX - y ObjectY`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quantity<'a> {
    /// Position of the clamp along x, m. Of a transition: of the whole path.
    ClampX,
    /// Position of the clamp along y, m. Of a transition: of the whole path.
    ClampY,
    /// Angle of the clamp, rad. Of a transition: at each point of the path, which stays where it is.
    ClampAngle,
    /// Bending stiffness E I, N m^2; of a rod that varies that at the clamp, all others in proportion.
    Stiffness,
    /// Length of the rod, m, at the same bending stiffness. A taper, sections and the shape at rest are stretched with it.
    Length,
    /// Stiffness of the clamp along x, N/m, as of a spring beside those that are there; the derivative is 0 where it is rigid.
    ClampStiffnessX,
    /// Stiffness of the clamp along y, N/m.
    ClampStiffnessY,
    /// Stiffness of the clamp against turning, N m/rad.
    ClampStiffnessPhi,
    /// Position of an object along x, m.
    ObjectX(usize),
    /// Position of an object along y, m.
    ObjectY(usize),
    /// Angle of an object about the origin of coordinates, rad.
    ObjectAngle(usize),
    /// Size of an object: a factor of its coordinates, 1 as it is.
    ObjectScale(usize),
    /// A [parameter](rod_contours::Contour::frame_rate) of the shape of a piece, in the unit of that parameter. Other pieces stay as
    /// they are; a vertex is where the two pieces, continued, cross.
    Shape {
        /// Number of the object.
        object: usize,
        /// Number of the piece in the object.
        piece: usize,
        /// The name that the shape gives the parameter.
        parameter: &'a str,
    },
}

impl fmt::Display for Quantity<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ClampX => f.write_str("x of the clamp"),
            Self::ClampY => f.write_str("y of the clamp"),
            Self::ClampAngle => f.write_str("angle of the clamp"),
            Self::Stiffness => f.write_str("bending stiffness"),
            Self::Length => f.write_str("length of the rod"),
            Self::ClampStiffnessX => f.write_str("stiffness of the clamp along x"),
            Self::ClampStiffnessY => f.write_str("stiffness of the clamp along y"),
            Self::ClampStiffnessPhi => f.write_str("stiffness of the clamp against turning"),
            Self::ObjectX(object) => write!(f, "x of object {object}"),
            Self::ObjectY(object) => write!(f, "y of object {object}"),
            Self::ObjectAngle(object) => write!(f, "angle of object {object}"),
            Self::ObjectScale(object) => write!(f, "scale of object {object}"),
            Self::Shape { object, piece, parameter } => {
                write!(f, "parameter {parameter:?} of piece {piece} of object {object}")
            }
        }
    }
}
