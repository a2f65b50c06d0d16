//! A sensor, read and reconstructed as it measures.
//!
//! `address` and `stage` are the arguments of the command line for the sensor and the clamp. `connect` opens a [`Sensor`], or `played` a
//! recording; `motion` is the motion of the clamp. `head` records the free rod for the tare and the noise. `scan` is what
//! a scan is made with, `session` the scan from the first sample to the last, `physics` the check at its end whether it can be of the rod; `losses` counts what no counter tells of,
//! `record` writes its files and `summary` its report.
//! `whole` takes a recording at once: reactions as they are, raw values and wrenches by the way of a live scan.

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
mod scan;
mod session;
mod stage;
mod summary;
mod whole;

pub use address::{AddressError, SensorAddress};
pub use error::LiveError;
pub use feed::{Fed, Feed, Miss, Sensor};
pub use latency::Latency;
pub(crate) use motion::origin_of;
pub use scan::LiveScan;
pub use stage::{StageDelay, StageDelayError, StageSpec, StageSpecError};
pub use summary::{End, LiveReport};
pub(crate) use whole::SensorTimes;
