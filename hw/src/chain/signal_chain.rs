//! From raw values to the reactions at the clamp.

use super::error::{ChainError, SensorError};
use super::rails::Rails;
use super::stage::StageSource;
use super::timekeeper::Timekeeper;
use crate::calibrate::{Calibration, Tare};
use crate::geometry::Mounting;
use crate::sample::{Number, Quality, RawSample, ReactionSample, WrenchSample};
use core::mem::take;
use rod_core::Pose;

/// Raw samples of a sensor to the reactions of the clamp, one by one and without allocation: rails, time, calibration, then
/// the [`WrenchChain`]. Where a sample goes no further, the next one says what it said of a restart or a gap.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{
///     Channels, ConstantSpeed, Frame, Mounting, Rails, RawSample, SignalChain, Timekeeper, Velocity, Wrench,
///     WrenchChain, WrenchSample,
/// };
/// // a base that tells the moment in steps of 10 uN m
/// let calibration = |raw: &RawSample| {
///     Ok(WrenchSample::<f64>::of(raw, Wrench { force: [0.0; 3], torque: [0.0, 0.0, 1e-5 * raw.channels[0]] }))
/// };
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
pub struct SignalChain<C, S, T = f64> {
    rails: Rails,
    timekeeper: Timekeeper,
    calibration: C,
    wrenches: WrenchChain<S, T>,
    /// The flags that a discarded sample passes to the next one.
    news: Quality,
}

/// The flags that pass to the next sample if their sample is discarded.
const NEWS: Quality = Quality::RESTARTED.union(Quality::GAP_BEFORE);

/// Wrenches at the sensor to the reactions of the clamp: tare, pose of the clamp, mounting. Also on its own, for sensors that
/// deliver wrenches.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{Frame, Mounting, Quality, Tare, Wrench, WrenchChain, WrenchSample, Zero};
/// let stage = |t: f64| Ok(Pose { x: -1e-3 * t, y: -0.04, phi: 1.571 });
/// let mut chain = WrenchChain::new(stage, Mounting::new(Frame::same()));
/// let mut sample = WrenchSample::new(2.0, Wrench { force: [0.5, 0.0, 0.0], torque: [0.0; 3] });
/// assert_eq!(chain.take(&sample)?.reactions.f0x, -0.5);
/// // what it read without load, once that is known
/// let unloaded = Wrench { force: [0.25, 0.0, 0.0], torque: [0.0; 3] };
/// let zero = Zero::known(unloaded, Wrench { force: [1e-3; 3], torque: [1e-5; 3] }, 1.0)?;
/// chain.set_tare(Some(Tare::single(zero)));
/// assert_eq!(chain.take(&sample)?.reactions.f0x, -0.25);
/// // the device began anew, and with it its zero
/// sample.quality = Quality::RESTARTED;
/// assert!(chain.take(&sample)?.quality.contains(Quality::TARE_STALE));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchChain<S, T = f64> {
    tare: Option<Tare<T>>,
    stage: S,
    mounting: Mounting<T>,
    /// The flags that a discarded sample passes to the next one.
    news: Quality,
    /// Time of the last sample, s.
    last: f64,
}

impl<C, S, T> SignalChain<C, S, T> {
    /// Without rails, at the host's time.
    pub fn new(calibration: C, wrenches: WrenchChain<S, T>) -> Self {
        let (rails, timekeeper) = (Rails::none(), Timekeeper::host());
        Self { rails, timekeeper, calibration, wrenches, news: Quality::empty() }
    }

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

    /// The part of the chain after calibration.
    pub fn wrenches(&mut self) -> &mut WrenchChain<S, T> {
        &mut self.wrenches
    }
}

impl<C: Calibration<T>, S: StageSource, T: Number> SignalChain<C, S, T> {
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
        raw.quality |= self.rails.check(raw).map_err(ChainError::Raw)?;
        let t = self.timekeeper.time(raw)?;
        let sample = self.calibration.wrench(raw).map_err(ChainError::Calibration)?;
        finite(&WrenchSample { t, ..sample }, "calibration")
    }

    /// The reactions behind all samples of a source. After an error it may go on.
    pub fn over<E>(
        &mut self,
        source: impl Iterator<Item = Result<RawSample, E>>,
    ) -> impl Iterator<Item = Result<ReactionSample<T>, SensorError<E>>> {
        source.map(|raw| Ok(self.take(&raw.map_err(SensorError::Source)?)?))
    }
}

impl<S, T> WrenchChain<S, T> {
    /// Without a tare.
    pub fn new(stage: S, mounting: Mounting<T>) -> Self {
        Self { tare: None, stage, mounting, news: Quality::empty(), last: f64::NEG_INFINITY }
    }

    /// Replaces the tare.
    pub fn set_tare(&mut self, tare: Option<Tare<T>>) {
        self.tare = tare;
    }

    /// The stage.
    pub fn stage(&mut self) -> &mut S {
        &mut self.stage
    }
}

impl<S: StageSource, T: Number> WrenchChain<S, T> {
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
        let tared = finite(&self.tare.as_mut().map_or(sample, |tare| tare.apply(&sample)), "tare")?;
        let Pose { x, y, phi } = self.stage.pose_at(tared.t)?;
        let pose = Pose { x: T::from_f64(x), y: T::from_f64(y), phi: T::from_f64(phi) };
        self.last = sample.t;
        Ok(self.mounting.reactions(&tared, pose))
    }
}

fn finite<T: Number>(sample: &WrenchSample<T>, step: &'static str) -> Result<WrenchSample<T>, ChainError> {
    let t = sample.t;
    if t.is_finite() && sample.wrench.is_finite() { Ok(*sample) } else { Err(ChainError::NotFinite { t, step }) }
}
