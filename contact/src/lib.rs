//! A flexible rod against a contour.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod branch;
mod certify;
mod chain;
mod configuration;
mod error;
mod event;
mod fold;
mod landing;
mod path;
mod phase;
mod scan;
mod stability;
mod state;
mod stepper;
mod sweep;
mod transition;
mod world;

pub use error::{ContactError, Stop, StopReason};
pub use event::{Event, EventKind};
pub use path::ClampPath;
pub use phase::Phase;
pub use state::{Certificate, Contact, ContactKind, State};
pub use sweep::{Item, Outcome, Sweep};
