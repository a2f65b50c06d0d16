//! Forces from what was seen of a rod: points on it, and any channels of its base, frame by frame.
//!
//! A [`Frame`] holds observations, each with its noise. Their model is one shape of the rod (`shape`): it is followed from its outermost contact,
//! where the bending moment vanishes, back to the base, so that free end and balance of forces hold for any values of the unknowns and the
//! least squares (`problem`) have no conditions. `seen` is a smooth curve through the points, about which the rod is linear in its forces (`linear_rod`),
//! so that `sight` sees the best places of contacts at once; `start` begins there, `candidate` solves for one set of contacts, `choose` says how many contacts
//! the frame shows, and `judge` what it cannot tell. `check` refuses what is no frame, `noise` finds the noise of a film, and
//! `pole_search` the pole that all its frames touch. [`forces`] does all that; [`rest_shape`] is the same for a rod that nothing touches, of unknown curvature.

mod candidate;
mod check;
mod choose;
mod ends;
mod fault;
mod forces;
mod judge;
mod linear_rod;
mod noise;
mod observation;
mod observed;
mod pole;
mod pole_search;
mod problem;
mod rest;
mod rest_curve;
mod result;
mod scatter;
mod seen;
mod settings;
mod shape;
mod sight;
mod start;
mod verdict;

pub use ends::HiddenBase;
pub use fault::FrameFault;
pub use forces::forces;
pub use observation::{Axis, Channel, Frame, Measurand, SeenPoint};
pub use pole::{FilmPole, PolePrior};
pub use rest::{RestError, RestShape, rest_shape};
pub use result::{Film, FrameContact, FrameForces};
pub use settings::ForceSettings;
pub use verdict::{FamilyMember, FrameVerdict};
