//! Counts, or values in other units, to a wrench.

use super::wrench_units::WrenchUnits;
use super::{Calibration, CalibrationDataError, CalibrationError};
use crate::sample::{Channels, Component, Number, RawSample, Unit, Wrench, WrenchSample};
use core::array::from_fn;

/// A factor for each channel: for devices that send components of a wrench, as counts or in units of their own.
///
/// ```
/// use rod_hw::{Calibration, Channels, Dimension, RawSample, Scale, Unit, WrenchSample};
/// // as the record of a Net F/T tells: counts per N and counts per N mm
/// let (newton, torque) = (Unit::parse("N", Dimension::Force)?, Unit::parse("Nmm", Dimension::Torque)?);
/// let scale = Scale::<f64>::from_counts(1e6, newton, 1e3, torque)?;
/// let raw = RawSample::new(0.0, Channels::from([1e6, 0.0, 0.0, 0.0, 0.0, 5e3]));
/// let sample: WrenchSample = scale.wrench(&raw)?;
/// assert_eq!((sample.wrench.force[0], sample.wrench.torque[2]), (1.0, 5e-3));
/// assert!(Scale::<f64>::from_counts(0.0, newton, 1e3, torque).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale<T = f64> {
    /// SI per raw unit.
    factors: [T; 6],
    /// The channel of each component in a sample.
    channels: [Option<usize>; 6],
    /// How many channels a sample has.
    count: usize,
}

impl<T: Number> Scale<T> {
    /// Counts per unit of force and torque, with these units, as records of devices tell them. Six channels: Fx, Fy, Fz,
    /// Tx, Ty, Tz.
    ///
    /// # Errors
    /// [`CalibrationDataError`] where a number of counts is not positive and finite, or a unit measures something else.
    pub fn from_counts(
        counts_per_force: f64,
        force_unit: Unit,
        counts_per_torque: f64,
        torque_unit: Unit,
    ) -> Result<Self, CalibrationDataError> {
        let ([f, t], units) = ([counts_per_force, counts_per_torque], WrenchUnits::new(force_unit, torque_unit)?);
        Self::from_counts_per_axis([f, f, f, t, t, t], units)
    }

    /// Counts per unit of each component, with these units.
    ///
    /// # Errors
    /// [`CalibrationDataError::CountsPerUnit`] where one is not positive and finite, or so small or large that the factor
    /// is not.
    pub fn from_counts_per_axis(counts: [f64; 6], units: WrenchUnits) -> Result<Self, CalibrationDataError> {
        for component in Component::ALL {
            let value = counts[component.index()];
            let factor = units.factor(component) / value;
            let fits = T::from_f64(factor).to_f64();
            if !(value.is_finite() && fits.is_finite() && fits > 0.0) {
                return Err(CalibrationDataError::CountsPerUnit { component, value });
            }
        }
        Ok(Self {
            factors: Component::ALL.map(|c| T::from_f64(units.factor(c) / counts[c.index()])),
            channels: from_fn(Some),
            count: 6,
        })
    }

    /// Components in N and N m already.
    ///
    /// ```
    /// use rod_hw::{Calibration, Channels, RawSample, Scale};
    /// let raw = RawSample::new(0.0, Channels::from([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    /// assert_eq!(Scale::<f64>::si().wrench(&raw)?.wrench.components(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    /// # Ok::<(), rod_hw::CalibrationError>(())
    /// ```
    pub fn si() -> Self {
        Self { factors: [T::from_f64(1.0); 6], channels: from_fn(Some), count: 6 }
    }

    /// Components in these units.
    ///
    /// ```
    /// use rod_hw::{Calibration, Channels, RawSample, Scale, WrenchUnits};
    /// let scale = Scale::<f32>::in_units(WrenchUnits::parse("mN", "N mm")?);
    /// let raw = RawSample::new(0.0, Channels::from([250.0, 0.0, 0.0, 0.0, 0.0, 2.0]));
    /// assert_eq!(scale.wrench(&raw)?.wrench.force[0], 0.25_f32);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn in_units(units: WrenchUnits) -> Self {
        Self { factors: Component::ALL.map(|c| T::from_f64(units.factor(c))), ..Self::si() }
    }

    /// The same with other channels: what each channel of a sample is, none where it is no component. Components that
    /// there are no channels for are zero.
    ///
    /// ```
    /// use rod_hw::{Calibration, Channels, Component, RawSample, Scale};
    /// // a sensor of three forces, after a channel of something else
    /// let forces = [None, Some(Component::Fx), Some(Component::Fy), Some(Component::Fz)];
    /// let scale = Scale::<f64>::si().with_channels(&forces)?;
    /// let found = scale.wrench(&RawSample::new(0.0, Channels::from([99.0, 1.0, 2.0, 3.0])))?;
    /// assert_eq!(found.wrench.components(), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CalibrationDataError`] where a component is there twice or none is, or there are more channels than a sample can
    /// have.
    pub fn with_channels(self, channels: &[Option<Component>]) -> Result<Self, CalibrationDataError> {
        let mut scale = Self { channels: [None; 6], count: channels.len(), ..self };
        if channels.len() > Channels::MOST {
            return Err(CalibrationDataError::Channels { count: channels.len() });
        }
        for (channel, component) in channels.iter().enumerate() {
            if let Some(component) = *component
                && scale.channels[component.index()].replace(channel).is_some()
            {
                return Err(CalibrationDataError::Twice { component });
            }
        }
        if scale.channels == [None; 6] { Err(CalibrationDataError::Nothing) } else { Ok(scale) }
    }

    /// The counts that the device would send for a wrench, not rounded: the inverse, for simulated sensors.
    pub fn channels(&self, wrench: &Wrench<T>) -> Channels {
        let mut values = [0.0; Channels::MOST];
        for component in Component::ALL {
            let i = component.index();
            if let Some(place) = self.channels[i].and_then(|channel| values.get_mut(channel)) {
                *place = component.of(wrench).to_f64() / self.factors[i].to_f64();
            }
        }
        values.get(..self.count).and_then(Channels::new).unwrap_or_default()
    }
}

impl<T: Number> Calibration<T> for Scale<T> {
    fn wrench(&self, raw: &RawSample) -> Result<WrenchSample<T>, CalibrationError> {
        super::expect_channels(raw, self.count)?;
        let mut components = [T::from_f64(0.0); 6];
        for ((component, &factor), channel) in components.iter_mut().zip(&self.factors).zip(self.channels) {
            if let Some(channel) = channel {
                *component = T::from_f64(super::finite_channel(raw, channel)?) * factor;
            }
        }
        super::finished(raw, components)
    }
}
