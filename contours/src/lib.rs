#![doc = include_str!("../README.md")]
//!
//! A [`Contour`] is the border of a solid, travelled with the SOLID ON ITS LEFT: a point, a tangent angle `alpha` and
//! their rates at each parameter. From that one method ([`Contour::frame`]) follow the closest point, the signed gap
//! (positive outside the solid) and the bounds; shapes with a closed form override them: [`Line`], [`CircularArc`],
//! [`EllipticArc`], [`Parabola`], [`Bezier`]. A [`Graph`] and a [`Curve`] come from functions, with derivatives that are
//! computed along with them ([`Jet`]). A shape can be [`Moved`], [`Reversed`] or [`Trimmed`], and a [`Composite`] joins
//! pieces into one contour with convex corners and concave notches between them.
//!
//! The crate is geometry and nothing else: no rods, no forces, no units. Coordinates may be metres or dimensionless, as
//! long as one scene uses one kind; angles are radians.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod bounds;
mod check;
mod composite;
mod contour;
pub mod contract;
mod error;
#[cfg(feature = "files")]
mod files;
mod frame;
mod nearest;
mod point;
mod proof;
mod range;
mod shapes;
mod transform;

pub use bounds::Bounds;
pub use composite::{Bend, Composite, Part, Run, RunClosest, RunEnd, SelfCrossing, Stretch, StretchKind};
pub use contour::Contour;
pub use error::{Broken, ContourError};
#[cfg(feature = "files")]
pub use files::{description, file};
pub use frame::{Frame, FrameRate};
pub use nearest::{Closest, Index};
pub use point::{Point, Vector};
pub use proof::Limits;
pub use range::Range;
pub use shapes::{Bezier, CircularArc, Curve, DualNum, EllipticArc, Graph, Jet, Line, Parabola, Spline, SplineEnd};
pub use transform::{Motion, Moved, Reversed, Trimmed};
