//! The window that a zero is taken from, and its limits.

use super::batches::{Batches, Course};
use super::{TareError, Zero};
use crate::sample::{Component, Number, Quality, Wrench, WrenchSample};
use core::marker::PhantomData;
use rod_core::Scalar;

/// Fewest samples of a window: fewer do not give enough batches.
const FEWEST: usize = 32;
/// A slope of more standard errors is a drift. Noise exceeds this in two of a thousand windows (14 degrees of freedom).
const SLOPE: f64 = 4.0;
/// Of stretches that differ from the rest by so many standard deviations, estimated from 15 differences at least and the
/// largest of all stretches taken, one or two in a thousand are noise.
const CHANGE: f64 = 6.0;

/// Takes the samples of a sensor without load, any number of them in 4 kB, and gives the [`Zero`] if the sensor was at rest.
///
/// ```
/// use rod_hw::{TareError, TareLimits, TareWindow, Wrench, WrenchSample};
/// let limits = TareLimits::new(0.5, Wrench { force: [2e-3; 3], torque: [1e-4; 3] })?;
/// let sample = |i: u32, force: f64| WrenchSample::new(1e-3 * f64::from(i), Wrench { force: [force, 0.0, 0.0], torque: [0.0; 3] });
/// let mut window = TareWindow::new(limits);
/// for i in 0..1000 {
///     window.push(&sample(i, 0.1))?;
/// }
/// assert!((window.finish()?.wrench().force[0] - 0.1).abs() < 1e-15);
/// // and if something touches the rod
/// for i in 1000..1300 {
///     window.push(&sample(i, 0.15))?;
/// }
/// assert!(matches!(window.finish(), Err(TareError::Change { .. })));
/// # Ok::<(), TareError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TareWindow<T = f64> {
    limits: TareLimits,
    batches: Batches,
    count: usize,
    mean: [f64; 6],
    from: f64,
    to: f64,
    arrived: f64,
    fault: Option<TareError>,
    number: PhantomData<T>,
}

impl TareWindow {
    /// Fewest samples of a window that may give a zero.
    pub const FEWEST: usize = FEWEST;
}

impl<T: Number> TareWindow<T> {
    /// An empty window.
    pub fn new(limits: TareLimits) -> Self {
        Self {
            limits,
            batches: Batches::new(),
            count: 0,
            mean: [0.0; 6],
            from: 0.0,
            to: 0.0,
            arrived: 0.0,
            fault: None,
            number: PhantomData,
        }
    }

    /// Takes a sample. After an error the window is spoilt: begin a new one.
    ///
    /// # Errors
    /// [`TareError`] where the sample is not usable ([`Quality::is_usable`]) or not finite, the device restarted after
    /// the first one, or its time is not after that of the one before.
    pub fn push(&mut self, sample: &WrenchSample<T>) -> Result<(), TareError> {
        let result = self.fault.map_or_else(|| self.check(sample), Err);
        self.fault = result.err();
        result?;
        if self.count == 0 {
            (self.from, self.arrived) = (sample.t, sample.raw.host_time);
        }
        self.to = sample.t;
        self.count += 1;
        let values = sample.wrench.components().map(Scalar::to_f64);
        for (mean, value) in self.mean.iter_mut().zip(values) {
            *mean += (value - *mean) / self.count as f64;
        }
        self.batches.push(sample.t, values);
        Ok(())
    }

    fn check(&self, sample: &WrenchSample<T>) -> Result<(), TareError> {
        let (t, quality) = (sample.t, sample.quality);
        if !quality.is_usable() {
            return Err(TareError::Unusable { t, quality });
        }
        if self.count > 0 && quality.contains(Quality::RESTARTED) {
            return Err(TareError::Restarted { t });
        }
        if !t.is_finite() || (self.count > 0 && t <= self.to) {
            return Err(TareError::Time { t, before: self.to });
        }
        let bad = Component::ALL.into_iter().find(|c| !c.of(&sample.wrench).to_f64().is_finite());
        bad.map_or(Ok(()), |component| {
            Err(TareError::NotFinite { component, t, value: component.of(&sample.wrench).to_f64() })
        })
    }

    /// How long it lasts, s, a sample's period after the last one included.
    pub fn seconds(&self) -> f64 {
        if self.count < 2 { 0.0 } else { (self.to - self.from) * self.count as f64 / (self.count - 1) as f64 }
    }

    /// The mean as zero, if the sensor was at rest: the means of 16 to 31 batches follow no slope, and no
    /// stretch of them differs from the rest, by more than the change of the limits, as far as that is no noise. The means of batches, unlike
    /// samples, are nearly independent in noise whose neighbours are correlated.
    ///
    /// # Errors
    /// [`TareError`], which says what, where and how large.
    pub fn finish(&self) -> Result<Zero<T>, TareError> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        let (count, seconds, shortest) = (self.count, self.seconds(), self.limits.shortest());
        if count < FEWEST {
            return Err(TareError::Few { count, fewest: FEWEST });
        }
        // periods that are not exact in binary are not too short for that
        if seconds < shortest * (1.0 - 1e-9) {
            return Err(TareError::Short { seconds, shortest });
        }
        let (batches, complete) = self.batches.settled();
        let batches = batches.get(..complete).unwrap_or_default();
        let mut sigma = [0.0; 6];
        for component in Component::ALL {
            let course = Course::of(batches, component.index());
            self.at_rest(component, &course)?;
            sigma[component.index()] = course.sigma;
        }
        let wrench = |components: [f64; 6]| Wrench::from_components(components.map(T::from_f64));
        let zero = Zero::known(wrench(self.mean), wrench(sigma), self.arrived)?;
        Ok(Zero { count, ..zero })
    }

    fn at_rest(&self, component: Component, course: &Course) -> Result<(), TareError> {
        let limit = component.of(&self.limits.change());
        let seconds = self.seconds();
        let (change, sigma) = (course.slope * seconds, course.slope_sigma * seconds);
        let drift = change.abs() > limit && change.abs() > SLOPE * sigma;
        let changed = course.change.size.abs() > limit && course.change.deviations > CHANGE;
        if drift && (course.steady || !changed) {
            return Err(TareError::Drift { component, change, sigma, limit, seconds });
        }
        if changed {
            return Err(TareError::Change { component, change: course.change.size, t: course.change.t, limit });
        }
        if course.sigma > limit {
            return Err(TareError::Noisy { component, sigma: course.sigma, limit });
        }
        Ok(())
    }
}

const POSITIVE: &str = "a positive number";

/// The conditions that a tare window must fulfil.
///
/// ```
/// use rod_hw::{TareLimits, Wrench};
/// let limits = TareLimits::new(0.5, Wrench { force: [2e-3; 3], torque: [1e-4; 3] })?;
/// assert!(TareLimits::new(0.0, limits.change()).is_err());
/// # Ok::<(), rod_hw::TareError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TareLimits {
    shortest: f64,
    change: Wrench,
}

impl TareLimits {
    /// A window of so many seconds at least, within which no component changes by more than `change` (N and N m; infinite
    /// where it does not matter): by drift, by a step, or there and back. Choose what is small beside the rod's reactions.
    ///
    /// # Errors
    /// [`TareError::Number`] where a limit is not positive.
    pub fn new(shortest: f64, change: Wrench) -> Result<Self, TareError> {
        if !(shortest > 0.0 && shortest.is_finite()) {
            return Err(TareError::Number { field: "the shortest tare window", value: shortest, expected: POSITIVE });
        }
        positive("the largest change within a tare window", &change)?;
        Ok(Self { shortest, change })
    }

    /// How long a window is at least, s.
    pub fn shortest(&self) -> f64 {
        self.shortest
    }

    /// The largest change within a window, N and N m.
    pub fn change(&self) -> Wrench {
        self.change
    }
}

fn positive(field: &'static str, limits: &Wrench) -> Result<(), TareError> {
    match Component::ALL.map(|c| c.of(limits)).into_iter().find(|limit| limit.is_nan() || *limit <= 0.0) {
        Some(value) => Err(TareError::Number { field, value, expected: POSITIVE }),
        None => Ok(()),
    }
}
