//! From force/torque sensors and recordings to what the clamp of a rod feels, and where the clamp is.
//!
//! What comes and goes:
//! - [`RawSample`]: what a device said, counts or volts with its own time, sequence number and status. [`WrenchSample`]: force
//!   and torque at the sensor's origin. [`ReactionSample`]: clamp pose and reactions. [`Quality`] travels with all of them.
//! - [`RawSource`], [`WrenchSource`]: any iterator of results is one, so that closures (`core::iter::from_fn`), adapters,
//!   `&mut source` and `Box<dyn Iterator>` are, too. [`StageSource`]: where the clamp is at a time, by constant speed, a table
//!   or a closure.
//!
//! From raw values to reactions:
//! - [`SignalChain`]: all of it, in this order: [`Rails`] for what is saturated, a [`Timekeeper`] for when, a [`Calibration`], a
//!   [`Tare`], the stage, the [`Mounting`] of the sensor to the clamp. `SimulatedSensor`: the way back.
//! - [`Calibration`]: raw values to a wrench; [`Scale`] of counts, [`GaugeMatrix`] of gauges, and with the feature `cal`
//!   `AtiCalibration` from a file of ATI. [`Unit`]s by name, checked.
//! - [`TareWindow`]: samples without load to a [`Zero`], of which one or two make a [`Tare`].
//! - [`Accuracy`], [`RatedLoad`]: how far a sensor can be trusted. [`SensorCheck`]: whether it suits a rod.
//! - `fit_lever_arm`: the lever arm of a mounting that was not measured.
//!
//! From bytes to raw values:
//! - [`Protocol`]: bytes to raw samples, without any input or output of its own; [`Transport`]: bytes there and back; [`Link`]: a
//!   protocol on a transport, with a deadline and [`LinkCounters`]; `spawn`: the same in a thread of its own.
//! - [`rdt`]: sensors over UDP that speak ATI's RDT; with the feature `rdt` the transport `Udp` and a fake sensor.
//! - [`framed`]: sensors on a serial line; the transport `ReadWrite`, with the feature `serial` `SerialPort`; `fake`: devices that
//!   fail by a script.
//!
//! From recordings:
//! - `recording` (feature `recordings`): tables of text, LabVIEW's among them, read; samples recorded.
//! - `tdms` (feature `tdms`): files of LabVIEW and NI-DAQmx. `mcap` (feature `mcap`): files of ROS.
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
mod chain;
mod clock;
mod component;
mod counters;
#[cfg(feature = "std")]
pub mod fake;
mod frame;
pub mod framed;
#[cfg(feature = "std")]
mod lever_arm;
mod link;
#[cfg(feature = "mcap")]
pub mod mcap;
mod mounting;
mod onrobot_filter;
mod protocol;
mod quality;
mod raw;
pub mod rdt;
mod reaction_sample;
#[cfg(feature = "std")]
mod read_write;
#[cfg(feature = "recordings")]
pub mod recording;
mod saturation;
mod sequence;
#[cfg(feature = "std")]
mod serial;
#[cfg(feature = "std")]
mod simulated;
mod source;
#[cfg(feature = "std")]
mod spawn;
mod stage;
mod tare;
#[cfg(feature = "tdms")]
pub mod tdms;
mod timing;
mod transport;
#[cfg(feature = "rdt")]
mod udp;
mod unit;
mod wrench;
mod wrench_sample;

pub use calibration::{
    Accuracy, Calibration, CalibrationDataError, CalibrationError, Compensation, FnCalibration, GaugeMatrix, RatedLoad,
    Scale, SensorCheck, SensorFinding, WrenchUnits,
};
#[cfg(feature = "cal")]
pub use calibration::{AtiCalibration, AtiFile, AtiFileError};
pub use chain::{ChainError, Correction, SensorError, SignalChain, WrenchChain};
pub use clock::Clock;
#[cfg(feature = "std")]
pub use clock::HostClock;
pub use component::Component;
pub use counters::LinkCounters;
pub use frame::{Axis, Frame, FrameError};
#[cfg(feature = "std")]
pub use lever_arm::{LeverArm, LeverArmError, fit_lever_arm};
pub use link::{Link, LinkError, LinkSettings, Reconnect};
pub use mounting::{Mounting, Sense};
pub use protocol::{FrameFault, Protocol, Request};
pub use quality::{Quality, QualityError};
pub use raw::{Channels, RawSample};
pub use reaction_sample::{OutOfPlane, ReactionSample};
#[cfg(feature = "std")]
pub use read_write::ReadWrite;
pub use saturation::{RailError, Rails};
pub use sequence::{Sequence, SequenceStep};
#[cfg(all(feature = "serial", unix))]
pub use serial::{Pty, open_pty};
#[cfg(feature = "serial")]
pub use serial::{SerialError, SerialPort};
#[cfg(feature = "std")]
pub use serial::{SerialProfile, SerialProfileError};
#[cfg(feature = "std")]
pub use simulated::{Counts, CountsError, SimulatedSensor};
pub use source::{RawSource, WrenchSource};
#[cfg(feature = "std")]
pub use spawn::{Spawned, spawn};
pub use stage::{ConstantSpeed, FnStage, StageError, StageSource, Velocity};
#[cfg(feature = "std")]
pub use stage::{StageTable, StageTableError};
pub use tare::{Tare, TareError, TareLimits, TareWindow, Zero};
pub use timing::{Timekeeper, TimingError};
pub use transport::Transport;
#[cfg(feature = "rdt")]
pub use udp::{Udp, UdpError};
pub use unit::{Dimension, Unit, UnitError};
pub use wrench::Wrench;
pub use wrench_sample::WrenchSample;
