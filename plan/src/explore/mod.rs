//! Active exploration: the next scan, from all that was measured so far.
//!
//! `explorer` is the loop. `approach` proposes scans of which nothing is known, `contour` those along what is known; `facing` knows which sides were touched. `fused` makes one contour of several scans,
//! `free_space` knows where no object is, `measured` reconstructs a recording.

mod abort;
mod approach;
mod contour;
mod error;
mod explorer;
mod facing;
mod free_space;
mod fused;
mod measured;
mod rectangle;
mod settings;

pub use abort::Abort;
pub use error::ExploreError;
pub use explorer::{Explorer, Finish, Proposal, Purpose};
pub use rectangle::Rectangle;
pub use settings::{ExplorerSettings, Stage};
