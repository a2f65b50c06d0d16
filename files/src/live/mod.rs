//! A sensor, read and reconstructed as it measures.
//!
//! `address` and `stage` are the arguments of the command line for the sensor and the clamp. `connect` opens a [`Sensor`], or `played` a
//! recording; `motion` is the motion of the clamp. `head` records the free rod for the tare and the noise. `session` is the
//! scan from the first sample to the last, `losses` counts what no counter tells of, `physics` checks at its end
//! whether it can be of the rod, `record` writes its files and `summary` its report.
//! `whole` takes a recording at once, and `recorded` any file: reactions as they are, raw values and wrenches by the way of a live scan.

mod address;
mod connect;
mod error;
mod feed;
mod head;
mod latency;
mod losses;
mod motion;
mod physics;
mod played;
mod record;
mod recorded;
mod scan;
mod session;
mod stage;
mod summary;
mod whole;

pub use address::{AddressError, SensorAddress};
pub use error::LiveError;
pub use feed::{Fed, Feed, Miss, Sensor};
pub use latency::Latency;
pub use scan::LiveScan;
pub use stage::{StageSpec, StageSpecError};
pub use summary::{End, LiveReport};
