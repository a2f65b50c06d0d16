//! Contact phases from the reactions of a scan.

#[cfg(feature = "std")]
mod border;
#[cfg(feature = "std")]
pub(crate) mod contact;
#[cfg(feature = "std")]
mod evidence;
#[cfg(feature = "std")]
mod identify;
pub(crate) mod label;
#[cfg(feature = "std")]
mod trellis;

#[cfg(feature = "std")]
pub use evidence::{Basis, Evidence, Quantity};
#[cfg(feature = "std")]
pub(crate) use identify::{Identified, Node, identify};
#[cfg(feature = "std")]
pub(crate) use trellis::{Break, Trellis, forward};
