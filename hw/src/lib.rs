//! From force/torque sensors and recordings to what the clamp of a rod feels, and where the clamp is.
//!
//! - [`sample`]: what comes and goes. [`RawSample`], what a device said, counts or volts with its own time, sequence number and
//!   status; [`WrenchSample`], force and torque at the sensor's origin; [`ReactionSample`], pose and reactions of the clamp;
//!   [`Quality`], which travels with all of them. Any iterator of results is a [`RawSource`] or a [`WrenchSource`].
//! - [`geometry`]: the [`Mounting`] of the sensor to the clamp, by a [`Frame`].
//! - [`calibrate`]: raw values to a wrench by a [`Calibration`] ([`Scale`] of counts, [`GaugeMatrix`], and with the feature `cal`
//!   `AtiCalibration` from a file of ATI), its zero by a [`TareWindow`] and a [`Tare`]. [`Accuracy`], [`RatedLoad`]: how far a
//!   sensor can be trusted; [`SensorCheck`]: whether it suits a rod.
//! - [`chain`]: all of it, in this order, by a [`SignalChain`]: [`Rails`] for what is saturated, a [`Timekeeper`] for when, the
//!   calibration, the tare, a [`StageSource`] for where the clamp is, the mounting.
//! - [`link`]: bytes to raw samples. A [`Protocol`] has no input or output of its own, a [`Transport`] brings bytes there and back,
//!   a [`Link`] joins them, with a deadline and [`LinkCounters`]; `spawn` does so in a thread of its own. Transports: `Udp`
//!   (feature `rdt`), `SerialPort` (feature `serial`).
//! - [`device`]: the protocols that sensors speak. [`device::rdt`] over UDP, [`device::framed`] on a serial line.
//! - `recording`: tables of text (feature `recordings`), files of LabVIEW and NI-DAQmx (`tdms`), of ROS (`mcap`).
//!
//! Units are SI throughout: N, N m, m, rad, s. Without the feature `std` there is no allocation, and what is on the way of a
//! sample is generic over the number, f32 or f64.
//!
//! This crate knows nothing of contours and contacts: what it hands on is [`rod_core::Sample`].
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod calibrate;
pub mod chain;
pub mod device;
pub mod geometry;
pub mod link;
#[cfg(feature = "std")]
pub mod recording;
pub mod sample;

pub use calibrate::{
    Accuracy, Calibration, CalibrationDataError, CalibrationError, Compensation, GaugeMatrix, RatedLoad, Scale,
    SensorCheck, SensorFinding, Tare, TareError, TareLimits, TareWindow, WrenchUnits, Zero,
};
#[cfg(feature = "cal")]
pub use calibrate::{AtiCalibration, AtiFile, AtiFileError};
#[cfg(feature = "std")]
pub use chain::StageTable;
pub use chain::{
    ChainError, ConstantSpeed, Rails, SensorError, SignalChain, StageError, StageSource, Timekeeper, Velocity,
    WrenchChain,
};
#[cfg(feature = "std")]
pub use device::SerialProfile;
pub use geometry::{Axis, Frame, GeometryError, Mounting, Sense};
#[cfg(feature = "serial")]
pub use link::SerialPort;
#[cfg(feature = "rdt")]
pub use link::Udp;
pub use link::{
    Clock, FrameFault, Link, LinkCounters, LinkError, LinkSettings, Protocol, Reconnect, Request, Sequence,
    SequenceStep, Transport,
};
#[cfg(feature = "std")]
pub use link::{HostClock, Spawned, TransportError, spawn};
pub use sample::{
    Channels, Component, Dimension, Number, OutOfPlane, Quality, RawSample, RawSource, ReactionSample, Unit, UnitError,
    Wrench, WrenchSample, WrenchSource,
};
