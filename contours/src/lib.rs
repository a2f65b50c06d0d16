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

mod angle;
mod assembly;
mod bezier;
mod bounds;
mod carry;
mod check;
mod circular_arc;
mod closest;
mod composite;
mod contour;
pub mod contract;
mod crossing;
mod cubic;
mod curvature;
mod curve;
mod cuts;
#[cfg(feature = "files")]
pub mod description;
mod ellipse;
mod elliptic_arc;
mod error;
#[cfg(feature = "files")]
pub mod file;
mod frame;
mod frame_rate;
mod function;
mod graph;
mod index;
mod jet;
mod joint;
mod limits;
mod line;
mod motion;
mod moved;
mod newton;
mod one_way;
mod parabola;
mod part;
mod piece;
mod polygon;
mod probe;
mod proven;
mod range;
mod reversed;
mod run;
mod search;
mod self_crossing;
mod shared;
mod span;
mod spline;
mod stretch;
mod taken_apart;
mod trimmed;
mod trust;
mod vector;
mod vertex_rate;

pub use bezier::Bezier;
pub use bounds::Bounds;
pub use circular_arc::CircularArc;
pub use closest::Closest;
pub use composite::{Composite, RunClosest};
pub use contour::Contour;
pub use curve::Curve;
pub use elliptic_arc::EllipticArc;
pub use error::{Broken, ContourError};
pub use frame::Frame;
pub use frame_rate::FrameRate;
pub use graph::Graph;
pub use index::Index;
pub use jet::{DualNum, Jet};
pub use limits::Limits;
pub use line::Line;
pub use motion::Motion;
pub use moved::Moved;
pub use parabola::Parabola;
pub use part::Part;
pub use range::Range;
pub use reversed::Reversed;
pub use run::{Bend, Run, RunEnd};
pub use self_crossing::SelfCrossing;
pub use spline::{Spline, SplineEnd};
pub use stretch::{Stretch, StretchKind};
pub use trimmed::Trimmed;
