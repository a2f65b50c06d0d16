//! One segment between two contacts in closed form, in any number type: the part of the crate that needs no heap.

mod basis;
mod circular;
mod dual;
mod inflection;
mod kernel;
mod scalar;
mod walk;

#[cfg(feature = "std")]
pub(crate) use basis::agm;
pub use dual::Dual;
pub use inflection::inflection;
#[cfg(feature = "std")]
pub(crate) use kernel::axial;
pub use kernel::{Section, Segment, Sensitivities, advance, advance_with_sensitivities};
pub use scalar::Scalar;
pub use walk::{Station, stations, walk};
