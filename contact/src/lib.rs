#![doc = include_str!("../README.md")]
//!
//! [`Sweep`] takes a [`Rod`](rod_core::Rod) along a [`ClampPath`] past one or more
//! [`Composite`](rod_contours::Composite) contours and hands out states and events as they come; [`equilibrium`] solves
//! for one pose and one given contact set. Units are SI.
//!
//! How it works: a contact set turns the rod into a multi-point boundary-value problem
//! ([`MultiPoint`](rod_core::MultiPoint)). The path parameter joins its unknowns, and one linear condition picks a
//! point of the branch: a pose, a step of pseudo-arclength, or a transition, whose defining unknown (a force that
//! vanishes, an arc length of 1, a border) is held fixed, so that each transition is located to the accuracy of any
//! other solve. At a fold, or where no contact set goes on, an overdamped chain of links finds where the rod lands.
//!
//! Every step is proven: a lower bound of the gap over the whole rod, from lines that separate it from the contours, or the
//! place where it goes through, from which the touch is located.
//!
//! This crate knows nothing of sensors, files or reconstruction.
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod contact_set;
mod continuation;
mod derivatives;
mod equilibrium;
mod error;
mod event;
mod friction;
mod gap;
mod limits;
mod path;
mod phase;
mod scene;
mod snap;
mod stability;
mod state;
mod sweep;

pub use derivatives::{Derivatives, Quantity, TransitionDerivatives};
#[cfg(feature = "argmin")]
pub use equilibrium::equilibrium_with_search;
pub use equilibrium::{Equilibrium, Inadmissible, equilibrium, sliding_equilibrium};
pub use error::{ContactError, LARGEST_ANGLE, Obstacle, Stop, StopReason};
pub use event::{Event, EventKind};
pub use friction::{Coefficients, Friction};
pub use path::{Chain, ClampArc, ClampPath, ClampSpline, Path, PathPoint};
pub use phase::Phase;
pub use rod_core::{ContactRate, Response, SupportRate};
pub use state::{Certificate, Contact, ContactFriction, ContactKind, GapBounds, RollerContact, SlipMode, State};
pub use sweep::{Approach, Follower, Item, Outcome, Start, StartCandidate, Sweep};
