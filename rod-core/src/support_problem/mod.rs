//! A rod on given supports: the boundary-value problem, its linearisation, and the friction at a support.

mod grip;
mod linearisation;
mod multipoint;

pub use grip::{Grip, arc_length};
pub use linearisation::{ContactRate, Linearisation, PathRow, Response, SupportRate};
pub use multipoint::{Hold, MultiPoint, Support, Supports};
