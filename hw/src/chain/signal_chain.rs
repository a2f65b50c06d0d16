//! From raw values to the reactions at the clamp.

use super::rails::{RailError, Rails};
use super::stage::{StageError, StageSource};
use super::timekeeper::{Timekeeper, TimingError};
use crate::calibrate::{Calibration, CalibrationError, Tare};
use crate::geometry::Mounting;
use crate::sample::{Number, Quality, RawSample, RawSource, ReactionSample, WrenchSample, WrenchSource};
use core::mem::take;
use rod_core::Pose;

/// What is done to wrenches before they are taken to the clamp: a [`Tare`], or something of your own, which then marks what a
/// restart of the device spoils. `()` does nothing, nor does `None`.
pub trait Correction<T = f64> {
    /// The same sample, corrected.
    fn correct(&mut self, sample: &WrenchSample<T>) -> WrenchSample<T>;
}

impl<T: Copy> Correction<T> for () {
    fn correct(&mut self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        *sample
    }
}

impl<T: Number> Correction<T> for Tare<T> {
    fn correct(&mut self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        self.apply(sample)
    }
}

impl<T: Copy, K: Correction<T>> Correction<T> for Option<K> {
    fn correct(&mut self, sample: &WrenchSample<T>) -> WrenchSample<T> {
        self.as_mut().map_or(*sample, |correction| correction.correct(sample))
    }
}

/// Raw samples of a sensor to the reactions of the clamp, one by one and without allocation: rails, time, calibration, then
/// the [`WrenchChain`]. Where a sample goes no further, the next one says what it said of a restart or a gap.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{
///     Channels, ConstantSpeed, FnCalibration, Frame, Mounting, Rails, RawSample, SignalChain, Timekeeper, Velocity, Wrench,
///     WrenchChain, WrenchSample,
/// };
/// // a base that tells the moment in steps of 10 uN m
/// let calibration = FnCalibration(|raw: &RawSample| {
///     Ok(WrenchSample::<f64>::of(raw, Wrench { force: [0.0; 3], torque: [0.0, 0.0, 1e-5 * raw.channels[0]] }))
/// });
/// let start = Pose { x: 0.08, y: -0.04, phi: 1.571 };
/// let stage = ConstantSpeed::new(start, Velocity { x: -1e-3, ..Velocity::default() }, 0.0)?;
/// let mut chain = SignalChain::new(calibration, WrenchChain::new(stage, Mounting::new(Frame::same())))
///     .with_rails(Rails::of_bits(16, 1).ok_or("no such converter")?)
///     .with_timekeeper(Timekeeper::counted(Some(2e-3)));
/// let found = chain.take(&RawSample::new(5.0, Channels::from([-500.0])))?;
/// assert_eq!((found.pose.x, found.reactions.m0z), (0.075, 5e-3));
///
/// // or all that a source has
/// let source = [5.002, 5.004].map(|t| Ok::<_, std::io::Error>(RawSample::new(t, Channels::from([100.0]))));
/// let all: Result<Vec<_>, _> = chain.over(source.into_iter()).collect();
/// assert_eq!(all?.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalChain<C, S, K = (), T = f64> {
    rails: Rails,
    timekeeper: Timekeeper,
    calibration: C,
    wrenches: WrenchChain<S, K, T>,
    /// What a sample that went no further says of the next one.
    news: Quality,
}

/// What is true of the next sample where the one that says it goes no further.
const NEWS: Quality = Quality::RESTARTED.union(Quality::GAP_BEFORE);

/// Wrenches at the sensor to the reactions of the clamp: tare, pose of the clamp, mounting. Also on its own, for sensors that
/// deliver wrenches.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{FnStage, Frame, Mounting, Quality, Tare, Wrench, WrenchChain, WrenchSample, Zero};
/// let stage = FnStage(|t: f64| Ok(Pose { x: -1e-3 * t, y: -0.04, phi: 1.571 }));
/// let mut chain = WrenchChain::new(stage, Mounting::new(Frame::same())).with_tare(None);
/// let mut sample = WrenchSample::new(2.0, Wrench { force: [0.5, 0.0, 0.0], torque: [0.0; 3] });
/// assert_eq!(chain.take(&sample)?.reactions.f0x, -0.5);
/// // what it read without load, once that is known
/// let unloaded = Wrench { force: [0.25, 0.0, 0.0], torque: [0.0; 3] };
/// let zero = Zero::known(unloaded, Wrench { force: [1e-3; 3], torque: [1e-5; 3] }, 0.0, 1.0)?;
/// chain.set_tare(Some(Tare::single(zero)));
/// assert_eq!(chain.take(&sample)?.reactions.f0x, -0.25);
/// // the device began anew, and with it its zero
/// sample.quality = Quality::RESTARTED;
/// assert!(chain.take(&sample)?.quality.contains(Quality::TARE_STALE));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchChain<S, K = (), T = f64> {
    tare: K,
    stage: S,
    mounting: Mounting<T>,
    /// What a sample that went no further says of the next one.
    news: Quality,
    /// Time of the last sample, s.
    last: f64,
}

/// Why a sample gives no reactions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChainError {
    /// A raw value that is none, or another number of them.
    #[error("raw values: {0}")]
    Raw(#[from] RailError),
    /// No time.
    #[error("time: {0}")]
    Timing(#[from] TimingError),
    /// No wrench.
    #[error("calibration: {0}")]
    Calibration(#[from] CalibrationError),
    /// No pose.
    #[error("stage: {0}")]
    Stage(#[from] StageError),
    /// A wrench that is older than the one before.
    #[error(
        "the wrench at {t} s comes after that at {before} s, expected times that do not run back; sort the recording, or leave \
         it out"
    )]
    Backwards {
        /// Its time, s.
        t: f64,
        /// That of the one before, s.
        before: f64,
    },
    /// A wrench that is none.
    #[error("the wrench at {t} s is not finite after the {step}, expected finite numbers of N and N m")]
    NotFinite {
        /// Its time, s.
        t: f64,
        /// What came before.
        step: &'static str,
    },
}

/// Why a source gives no reactions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SensorError<E> {
    /// There is no sample.
    #[error(transparent)]
    Source(E),
    /// A sample gives none.
    #[error(transparent)]
    Chain(#[from] ChainError),
}

impl<C, S, T> SignalChain<C, S, (), T> {
    /// Without rails, at the host's time.
    pub fn new<K>(calibration: C, wrenches: WrenchChain<S, K, T>) -> SignalChain<C, S, K, T> {
        let (rails, timekeeper) = (Rails::none(), Timekeeper::host());
        SignalChain { rails, timekeeper, calibration, wrenches, news: Quality::empty() }
    }
}

impl<C, S, K, T> SignalChain<C, S, K, T> {
    /// With the ends of the ranges of the raw values.
    pub fn with_rails(self, rails: Rails) -> Self {
        Self { rails, ..self }
    }

    /// With another way to tell when samples were taken.
    pub fn with_timekeeper(self, timekeeper: Timekeeper) -> Self {
        Self { timekeeper, ..self }
    }

    /// The calibration.
    pub fn calibration(&self) -> &C {
        &self.calibration
    }

    /// Time, to look at its jitter.
    pub fn timekeeper(&self) -> &Timekeeper {
        &self.timekeeper
    }

    /// What comes after calibration.
    pub fn wrenches(&mut self) -> &mut WrenchChain<S, K, T> {
        &mut self.wrenches
    }
}

impl<C: Calibration<T>, S: StageSource, K: Correction<T>, T: Number> SignalChain<C, S, K, T> {
    /// The reactions behind a raw sample.
    ///
    /// # Errors
    /// [`ChainError`]; the next sample may be good.
    pub fn take(&mut self, raw: &RawSample) -> Result<ReactionSample<T>, ChainError> {
        let wrench = self.wrench(raw)?;
        self.wrenches.take(&wrench)
    }

    /// The calibrated wrench behind a raw sample, at the sensor and without the tare: what a tare is made of.
    ///
    /// # Errors
    /// [`ChainError`]; the next sample may be good.
    pub fn wrench(&mut self, raw: &RawSample) -> Result<WrenchSample<T>, ChainError> {
        let mut raw = RawSample { quality: raw.quality | take(&mut self.news), ..*raw };
        let result = self.calibrated(&mut raw);
        if result.is_err() {
            self.news = raw.quality & NEWS;
        }
        result
    }

    fn calibrated(&mut self, raw: &mut RawSample) -> Result<WrenchSample<T>, ChainError> {
        raw.quality |= self.rails.check(raw)?;
        let t = self.timekeeper.time(raw)?;
        let sample = self.calibration.wrench(raw)?;
        finite(&WrenchSample { t, ..sample }, "calibration")
    }

    /// The reactions behind all samples of a source. After an error it may go on.
    pub fn over<I: RawSource>(
        &mut self,
        source: I,
    ) -> impl Iterator<Item = Result<ReactionSample<T>, SensorError<<I as RawSource>::Error>>> {
        source.map(|raw| Ok(self.take(&raw.map_err(SensorError::Source)?)?))
    }
}

impl<S, T> WrenchChain<S, (), T> {
    /// Without a tare.
    pub fn new(stage: S, mounting: Mounting<T>) -> Self {
        Self { tare: (), stage, mounting, news: Quality::empty(), last: f64::NEG_INFINITY }
    }

    /// With a tare, or a place for one: `None`.
    pub fn with_tare<K>(self, tare: K) -> WrenchChain<S, K, T> {
        let Self { stage, mounting, news, last, .. } = self;
        WrenchChain { tare, stage, mounting, news, last }
    }
}

impl<S, K, T> WrenchChain<S, K, T> {
    /// Takes another tare.
    pub fn set_tare(&mut self, tare: K) {
        self.tare = tare;
    }

    /// The tare.
    pub fn tare(&self) -> &K {
        &self.tare
    }

    /// The stage.
    pub fn stage(&mut self) -> &mut S {
        &mut self.stage
    }

    /// The mounting.
    pub fn mounting(&self) -> &Mounting<T> {
        &self.mounting
    }
}

impl<S: StageSource, K: Correction<T>, T: Number> WrenchChain<S, K, T> {
    /// The reactions behind a wrench.
    ///
    /// # Errors
    /// [`ChainError`]; the next sample may be good.
    pub fn take(&mut self, sample: &WrenchSample<T>) -> Result<ReactionSample<T>, ChainError> {
        let sample = WrenchSample { quality: sample.quality | take(&mut self.news), ..*sample };
        let result = self.reactions(&sample);
        if result.is_err() {
            self.news = sample.quality & NEWS;
        }
        result
    }

    fn reactions(&mut self, sample: &WrenchSample<T>) -> Result<ReactionSample<T>, ChainError> {
        let sample = finite(sample, "sensor")?;
        if sample.t < self.last {
            return Err(ChainError::Backwards { t: sample.t, before: self.last });
        }
        let tared = finite(&self.tare.correct(&sample), "tare")?;
        let Pose { x, y, phi } = self.stage.pose_at(tared.t)?;
        let pose = Pose { x: T::from_f64(x), y: T::from_f64(y), phi: T::from_f64(phi) };
        self.last = sample.t;
        Ok(self.mounting.reactions(&tared, pose))
    }

    /// The reactions behind all wrenches of a source. After an error it may go on.
    pub fn over<I: WrenchSource<T>>(
        &mut self,
        source: I,
    ) -> impl Iterator<Item = Result<ReactionSample<T>, SensorError<<I as WrenchSource<T>>::Error>>> {
        source.map(|sample| Ok(self.take(&sample.map_err(SensorError::Source)?)?))
    }
}

fn finite<T: Number>(sample: &WrenchSample<T>, step: &'static str) -> Result<WrenchSample<T>, ChainError> {
    let t = sample.t;
    if t.is_finite() && sample.wrench.is_finite() { Ok(*sample) } else { Err(ChainError::NotFinite { t, step }) }
}
