//! Whether a sensor suits a rod.

use super::{Accuracy, CalibrationDataError, RatedLoad};
use crate::sample::{Component, Wrench};
use core::fmt;
use rod_core::Units;

/// An error of one unit (E I / L^2, E I / L) is as large as most of what a scan gives.
const HIDDEN: f64 = 1.0;
/// Small peaks of a scan are some units: this part of one is a percent of them.
const DOMINATES: f64 = 0.05;
/// Peaks over the nine scans of Merker et al. (2020), as `vibrissa paper` has them: 1.49 N and 43 mN m on a rod of
/// E I / L^2 = 63.2 mN and E I / L = 6.32 mN m, 23.6 and 6.9 of them.
const PEAK: Wrench = Wrench { force: [24.0; 3], torque: [7.0; 3] };
/// The components in the plane of the rod.
const PLANAR: [Component; 3] = [Component::Fx, Component::Fy, Component::Tz];

/// Whether a sensor's range and class suit a rod, before anything is measured.
///
/// ```
/// use rod_core::Rod;
/// use rod_hw::{RatedLoad, SensorCheck, Wrench, WrenchUnits};
/// let units = Rod::from_diameter(0.1, 0.5e-3, 206e9)?.units(); // E I / L^2 = 63 mN, E I / L = 6.3 mN m
/// let percent = Wrench { force: [0.1; 3], torque: [0.1; 3] };
/// let check = |torque| {
///     let rated = RatedLoad::in_units([2.0, 2.0, 2.0, torque, torque, torque], WrenchUnits::SI)?;
///     SensorCheck::new(units, &rated, percent)
/// };
/// assert_eq!(check(0.05)?.findings().count(), 0);
/// let finding = check(50.0)?.findings().next().ok_or("none")?;
/// assert!(finding.is_misfit());
/// assert!(finding.to_string().contains("Is +-50 mN m meant?"), "{finding}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorCheck {
    /// One unit of each component, N and N m.
    unit: Wrench,
    rated: Wrench,
    percent: Wrench,
    bound: Wrench,
    largest: Wrench,
}

impl SensorCheck {
    /// Of a rod, by its units, and a sensor, by its rated load and its class in percent of that. Looks at Fx, Fy and Tz, and
    /// expects reactions of up to 24 E I / L^2 and 7 E I / L.
    ///
    /// # Errors
    /// [`CalibrationDataError`] where a class is none ([`Accuracy::of_class`]).
    pub fn new(units: Units, rated: &RatedLoad, percent: Wrench) -> Result<Self, CalibrationDataError> {
        let unit = Wrench { force: [units.force; 3], torque: [units.moment; 3] };
        Ok(Self {
            unit,
            rated: rated.largest(),
            percent,
            bound: Accuracy::of_class(rated, percent)?.systematic(),
            largest: unit.zip(&PEAK, |unit, peak| unit * peak),
        })
    }

    /// Findings against this sensor for this rod; empty if it suits.
    pub fn findings(&self) -> impl Iterator<Item = SensorFinding> {
        let check = *self;
        PLANAR.into_iter().flat_map(move |component| {
            let [rated, unit, bound] = [check.rated, check.unit, check.bound].map(|w| component.of(&w));
            let (percent, largest) = (component.of(&check.percent), component.of(&check.largest));
            let class = SensorFinding::Class { component, percent, rated, unit };
            let range = SensorFinding::Range { component, rated, largest, unit };
            [(bound > DOMINATES * unit, class), (rated < largest, range)]
                .into_iter()
                .filter_map(|(found, finding)| found.then_some(finding))
        })
    }
}

/// Something that speaks against a sensor at a rod. Displays as sentences without the last full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SensorFinding {
    /// The maker's class lets errors be large beside what the rod gives.
    Class {
        /// The component.
        component: Component,
        /// The class, percent.
        percent: f64,
        /// The limit, N or N m.
        rated: f64,
        /// E I / L^2 or E I / L, N or N m.
        unit: f64,
    },
    /// The rod gives more than the sensor is rated for.
    Range {
        /// The component.
        component: Component,
        /// The rated load of the sensor, N or N m.
        rated: f64,
        /// The largest load that the rod can cause, N or N m.
        largest: f64,
        /// E I / L^2 or E I / L, N or N m.
        unit: f64,
    },
}

impl SensorFinding {
    /// Whether sensor and rod do not fit together; otherwise it is a notice.
    pub fn is_misfit(&self) -> bool {
        match *self {
            Self::Class { percent, rated, unit, .. } => 0.01 * percent * rated > HIDDEN * unit,
            Self::Range { rated, unit, .. } => rated < unit,
        }
    }
}

impl fmt::Display for SensorFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Class { component, .. } | Self::Range { component, .. }) = *self;
        let (si, name) = if component.index() < 3 { ("N", "E I / L^2") } else { ("N m", "E I / L") };
        match *self {
            Self::Class { percent, rated, unit, .. } => {
                let (bound, accepted) = (0.01 * percent * rated, DOMINATES * unit);
                let ratio = bound / unit;
                write!(
                    f,
                    "{component}: class {percent} of +-{rated} {si} is {bound:.2e} {si}, {ratio:.2} times {name} = {unit:.2e} {si}: "
                )?;
                if !self.is_misfit() {
                    return write!(
                        f,
                        "systematic errors of the sensor will be seen in the contour, expected below {accepted:.1e} {si}; \
                         measured bounds of its errors, or a calibration of your own, may be better than the class"
                    );
                }
                write!(f, "this hides most of the load of the rod, expected below {accepted:.1e} {si}. ")?;
                // a slip of milli leads to a range that holds what the rod gives, at an error that does not matter
                if 1e-3 * ratio < DOMINATES && 1e-3 * rated > unit {
                    write!(f, "Is +-{rated} m{si} meant? That would be {:.1e} times. ", 1e-3 * ratio)?;
                }
                write!(
                    f,
                    "Otherwise take a sensor of a range of {:.1e} {si} or less at this class",
                    accepted / (0.01 * percent)
                )
            }
            Self::Range { rated, largest, unit, .. } => write!(
                f,
                "{component}: the sensor is rated for {rated} {si}, {:.2} times {name} = {unit:.2e} {si}, but the rod may give \
                 {largest:.2e} {si}; take a larger range or a softer rod, or state how large the reactions of your scans are",
                rated / unit
            ),
        }
    }
}
