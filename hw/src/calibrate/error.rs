//! Why the data of a sensor are no calibration.

use crate::sample::{Component, UnitError};

/// Why the data of a sensor are no calibration.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationDataError {
    /// A unit is not known, or measures something else.
    #[error("{field}: {error}")]
    Unit {
        /// Which unit.
        field: &'static str,
        /// The fault.
        error: UnitError,
    },
    /// A number is out of its range.
    #[error("{field} is {value}, expected {expected}")]
    Number {
        /// Which one.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// A number of one component is out of its range.
    #[error("{field} of {component} is {value}, expected {expected}")]
    OfComponent {
        /// Which number.
        field: &'static str,
        /// The component.
        component: Component,
        /// Its value.
        value: f64,
        /// The expected value.
        expected: &'static str,
    },
    /// There is no scale.
    #[error(
        "counts per unit of {component} are {value}, expected a positive, finite number; ask the device or look at its \
         certificate, there is no value that fits all"
    )]
    CountsPerUnit {
        /// Which one.
        component: Component,
        /// Its value.
        value: f64,
    },
    /// An element of the matrix is no number.
    #[error("the element of {component} and gauge {gauge} is {value}, expected a finite number")]
    Element {
        /// Its row.
        component: Component,
        /// Its column, from 1.
        gauge: usize,
        /// Its value.
        value: f64,
    },
    /// A row of zeros.
    #[error("the row of {component} is zero throughout; leave out the components that the sensor does not measure")]
    NoGauge {
        /// Which row.
        component: Component,
    },
    /// A row is a linear combination of the others.
    #[error(
        "the row of {component} is a combination of the other rows: only a part of {independent:.1e} is independent, expected at least \
         {limit:.0e}; is a row repeated, or rounded too far? Leave out the components that the sensor cannot tell apart"
    )]
    Dependent {
        /// Which row.
        component: Component,
        /// The part of it that is linearly independent of the other rows.
        independent: f64,
        /// The smallest part that is accepted.
        limit: f64,
    },
    /// Fewer gauges than components.
    #[error("{gauges} gauges for {components} components, expected at least as many gauges as components")]
    Gauges {
        /// How many gauges there are.
        gauges: usize,
        /// How many components.
        components: usize,
    },
    /// A component is there twice.
    #[error("{component} is given twice, expected at most once")]
    Twice {
        /// Which one.
        component: Component,
    },
    /// Nothing is measured.
    #[error("no component is given, expected at least one")]
    Nothing,
    /// More channels than a sample can have.
    #[error("{count} channels, expected at most {most}", most = crate::sample::Channels::MOST)]
    Channels {
        /// How many.
        count: usize,
    },
    /// A range whose lower end is not below the upper one.
    #[error("channel {channel} reaches from {low} to {high}, expected the lower end first")]
    Ends {
        /// Which channel, from 1.
        channel: usize,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A calibration that compensates for temperature has a bias of no known temperature.
    #[error(
        "this calibration compensates for temperature, but the temperature of the bias is unknown; give it with the bias"
    )]
    BiasTemperature,
}
