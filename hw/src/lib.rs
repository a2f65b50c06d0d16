//! From force/torque sensors and recordings to what the clamp of a rod feels, and where the clamp is.
//!
//! - [`RawSample`]: what a device said, counts or volts with its own time, sequence number and status. [`WrenchSample`]: force
//!   and torque at the sensor's origin. [`ReactionSample`]: clamp pose and reactions. [`Quality`] travels with all of them.
//! - [`RawSource`], [`WrenchSource`]: any iterator of results is one, so that closures (`core::iter::from_fn`), adapters,
//!   `&mut source` and `Box<dyn Iterator>` are, too.
//! - [`Calibration`]: raw values to a wrench. [`StageSource`]: where the clamp is at a time.
//! - [`Protocol`]: bytes to raw samples, without any input or output of its own; [`Transport`]: bytes there and back; [`Link`]: a
//!   protocol on a transport, with a deadline.
//!
//! Units are SI throughout: N, N m, m, rad, s. Without the feature `std` there is no allocation, and what is on the way of a
//! sample is generic over the number, f32 or f64.
//!
//! This crate knows nothing of contours and contacts: what it hands on is [`rod_core::Sample`].
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

#[cfg(any(feature = "tdms", feature = "mcap"))]
#[allow(dead_code, reason = "each format needs a part of it")]
mod bytes;
mod calibration;
mod clock;
mod counters;
mod link;
#[cfg(feature = "mcap")]
pub mod mcap;
mod protocol;
mod quality;
mod raw;
mod reaction_sample;
mod sequence;
mod source;
mod stage;
#[cfg(feature = "tdms")]
pub mod tdms;
mod transport;
mod unit;
mod wrench;
mod wrench_sample;

pub use calibration::{Calibration, CalibrationError, FnCalibration};
pub use clock::Clock;
#[cfg(feature = "std")]
pub use clock::HostClock;
pub use counters::LinkCounters;
pub use link::{Link, LinkError, LinkSettings, Reconnect};
pub use protocol::{FrameFault, Protocol, Request};
pub use quality::Quality;
pub use raw::{Channels, RawSample};
pub use reaction_sample::{OutOfPlane, ReactionSample};
pub use sequence::{Sequence, Step};
pub use source::{RawSource, WrenchSource};
pub use stage::{FnStage, StageError, StageSource};
pub use transport::Transport;
pub use unit::{Dimension, Unit, UnitError};
pub use wrench::Wrench;
pub use wrench_sample::WrenchSample;
