//! Contact phases from the reactions of a scan.
//!
//! `evidence` computes the criteria of each phase at places of the scan, `diagram` the transitions that are possible between them,
//! and `trellis` the most likely sequence of both. `identify` does this for a whole scan, and `contact` gives the contact point of a
//! sample whose phase is known.

#[cfg(feature = "std")]
mod border;
#[cfg(feature = "std")]
mod contact;
#[cfg(feature = "std")]
mod diagram;
#[cfg(feature = "std")]
mod evidence;
#[cfg(feature = "std")]
mod identify;
mod label;
#[cfg(feature = "std")]
mod trellis;

#[cfg(feature = "std")]
pub(crate) use contact::{constrained_contact, contact};
#[cfg(feature = "std")]
pub(crate) use diagram::Break;
#[cfg(feature = "std")]
pub use evidence::{Basis, Evidence, Quantity};
#[cfg(feature = "std")]
pub(crate) use evidence::{CRITERIA, Criterion};
#[cfg(feature = "std")]
pub(crate) use identify::{
    Place, PlaceNumber, ScanPhases, evaluate_places, identify_phases, label_log_likelihood, most_likely_labels, parts,
};
pub use label::Label;
#[cfg(feature = "std")]
pub(crate) use trellis::{Trellis, forward_probabilities, most_likely, viterbi_step};
