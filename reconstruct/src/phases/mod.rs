//! Contact phases from the reactions of a scan.

mod automaton;
mod border;
mod evidence;
mod identify;

pub(crate) use automaton::{Break, Trellis, forward};
pub use evidence::{Basis, Evidence, Quantity};
pub(crate) use identify::{Identified, Node, identify};
