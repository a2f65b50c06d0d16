#![doc = include_str!("../README.md")]
//!
//! - [`sample`]: the data. [`RawSample`] has the counts or volts of a device, with its time, sequence number and status word;
//!   [`WrenchSample`] force and torque at the sensor's origin; [`ReactionSample`] pose and reactions of the clamp. All of them have
//!   [`Quality`] flags. A source is any iterator of results of them.
//! - [`geometry`]: the [`Mounting`] of the sensor at the clamp, by a [`Frame`].
//! - [`calibrate`]: a [`Calibration`] converts raw values to a wrench: a [`Scale`] of counts, a [`GaugeMatrix`], a closure, and with
//!   the feature `cal` a file of ATI (`AtiFile`). A [`TareWindow`] gives the zero of a [`Tare`]. [`Accuracy`] and [`RatedLoad`]
//!   describe a sensor; [`SensorCheck`] compares it with a rod.
//! - [`chain`]: a [`SignalChain`] does all of it, in this order: [`Rails`] flag saturated samples, a [`Timekeeper`] gives the time,
//!   then calibration, tare, pose of the clamp by a [`StageSource`], mounting.
//! - [`link`]: bytes to raw samples. A [`Protocol`] decodes without input or output of its own, a [`Transport`] sends and receives
//!   bytes, a [`Link`] joins them, with a deadline and [`LinkCounters`]; `spawn` reads a link in a separate thread. Transports: `Udp`
//!   (feature `rdt`), `SerialPort` (feature `serial`).
//! - [`device`]: the protocols of sensors. [`device::rdt`] over UDP, [`device::framed`] on a serial line.
//! - `recording`: tables of text (feature `recordings`), files of LabVIEW and NI-DAQmx (`tdms`), of ROS (`mcap`).
//!
//! Units are SI throughout: N, N m, m, rad, s. Without the feature `std` there is no allocation, and the conversion of a sample is
//! generic over the number, f32 or f64.
//!
//! This crate knows nothing of contours and contacts: its result is a [`rod_core::Sample`].
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
    Channels, Component, Dimension, Number, OutOfPlane, Quality, RawSample, ReactionSample, Unit, UnitError, Wrench,
    WrenchSample,
};
