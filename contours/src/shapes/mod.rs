//! The shapes: lines, arcs, parabolas, Bezier curves and splines with closed forms or isolated minima; graphs and curves from functions.

mod bezier;
mod circular_arc;
mod cubic;
mod curve;
mod ellipse;
mod elliptic_arc;
mod function;
mod graph;
mod line;
mod parabola;
mod span;
mod spline;

pub use bezier::Bezier;
pub use circular_arc::CircularArc;
pub use curve::Curve;
pub use elliptic_arc::EllipticArc;
pub use function::{DualNum, Jet};
pub use graph::Graph;
pub use line::Line;
pub use parabola::Parabola;
pub use spline::{Spline, SplineEnd};
