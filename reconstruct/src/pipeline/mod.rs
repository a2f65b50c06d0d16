//! From samples to labels, contact points and the contour: a whole scan at once, or sample by sample.
//!
//! [`reconstruct`] joins the rooms of this crate: kinks, phases, single and double contacts (`answers`). [`Live`] does the same as
//! samples come, except for several contacts; [`LiveSession`] keeps the answers together with the samples that they are for, and
//! estimates the errors that all samples share from the places so far (`history`, `learned`).

mod answers;
mod calibrated;
mod doubts;
mod each_pass;
mod explanation;
mod general;
mod history;
mod learned;
mod live;
mod live_settings;
mod reading;
mod reconstruct;
mod reconstruction;
mod session;
mod settings;
mod several;
mod tell_apart;

pub use each_pass::reconstruct_passes;
pub use explanation::{Explanation, explanations};
pub use general::reconstruct_general;
pub use live::Live;
pub use live_settings::LiveSettings;
pub use reading::{Reading, Reason};
pub use reconstruct::reconstruct;
pub use reconstruction::{Pass, Reconstruction};
pub use session::LiveSession;
pub use settings::{ReconstructError, Settings};
