//! Calibration files of ATI.

mod element;
mod error;
mod matrix;

pub use error::AtiFileError;

use super::gauge_matrix::Compensation;
use super::{CalibrationDataError, GaugeMatrix, RatedLoad, WrenchUnits};
use crate::sample::{Channels, Component, Dimension, Number};
use core::array::from_fn;
use element::{Element, document};
use std::path::Path;

/// A calibration file (`.cal`) of ATI, of a sensor that is read through a data acquisition card.
///
/// ```
/// use rod_hw::{AtiFile, Calibration, Channels, RawSample};
/// let text = r#"<FTSensor Serial="FT00000" BodyStyle="Nano" NumGages="6"><Calibration PartNumber="SI-12-0.12"
///     ForceUnits="N" TorqueUnits="N-mm" DistUnits="mm" OutputRange="20" OutputBipolar="True">
///     <Axis Name="Fx" values="2 0 0 0 0 0" max="12" scale="2"/> <Axis Name="Fy" values="0 2 0 0 0 0" max="12" scale="2"/>
///     <Axis Name="Fz" values="0 0 2 0 0 0" max="17" scale="2"/> <Axis Name="Tx" values="0 0 0 2 0 0" max="120" scale="2"/>
///     <Axis Name="Ty" values="0 0 0 0 2 0" max="120" scale="2"/> <Axis Name="Tz" values="0 0 0 0 0 2" max="120" scale="2"/>
/// </Calibration></FTSensor>"#;
/// let file = AtiFile::parse(text)?;
/// let calibration = file.calibration(None)?;
/// let matrix = calibration.matrix::<6, f64>()?;
/// let sample = matrix.wrench(&RawSample::new(0.0, Channels::from([0.5, 0.0, 0.0, 0.0, 0.0, 8.0])))?;
/// assert_eq!((sample.wrench.force[0], sample.wrench.torque[2]), (0.5, 8e-3)); // from N mm
/// assert_eq!((calibration.rated.largest().torque[2], calibration.rails), (0.12, Some([-10.0, 10.0])));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct AtiFile {
    /// Serial number of the sensor: the file is for no other.
    pub serial: String,
    /// Its rated loads.
    pub calibrations: Vec<AtiCalibration>,
}

/// One calibration of a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct AtiCalibration {
    /// Its name, as `SI-20-1`.
    pub part_number: String,
    /// When it was measured, as the file says.
    pub date: String,
    /// Units of the file; everything here is in SI.
    pub units: WrenchUnits,
    /// How many gauges the sensor has.
    pub gauges: usize,
    /// The largest loads.
    pub rated: RatedLoad,
    /// Least and largest volts of a gauge, where the file tells: there it is saturated.
    pub rails: Option<[f64; 2]>,
    line: u32,
    rows: Vec<(Component, [f64; Channels::MOST])>,
    slopes: Option<Slopes>,
}

#[derive(Clone, Debug, PartialEq)]
struct Slopes {
    bias: Vec<f64>,
    gain: Vec<f64>,
    thermistor: f64,
}

impl AtiFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`AtiFileError::In`] with the file and what is wrong with it.
    pub fn read(file: &Path) -> Result<Self, AtiFileError> {
        let text = std::fs::read_to_string(file).map_err(|e| AtiFileError::Unreadable { message: e.to_string() });
        text.and_then(|text| Self::parse(&text))
            .map_err(|error| AtiFileError::In { file: file.to_path_buf(), error: Box::new(error) })
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`AtiFileError`] with line and element.
    pub fn parse(text: &str) -> Result<Self, AtiFileError> {
        let document = document(text)?;
        let root = Element(document.root_element());
        if root.name() != "FTSensor" {
            let found = format!("the file is of a `{}`", root.name());
            return Err(AtiFileError::Element {
                line: root.line(),
                found,
                expected: "`FTSensor`, as in .cal files of ATI",
            });
        }
        let gauges = root.attribute("NumGages").and_then(|text| text.parse().ok());
        let gauges = gauges
            .filter(|gauges| (1..=Channels::MOST).contains(gauges))
            .ok_or_else(|| root.wrong("NumGages", "a number from 1 to 16"))?;
        let calibrations: Result<Vec<_>, _> =
            root.children("Calibration").map(|element| AtiCalibration::of(element, gauges)).collect();
        let calibrations = calibrations?;
        if calibrations.is_empty() {
            let found = "`FTSensor` has no `Calibration`".to_owned();
            return Err(AtiFileError::Element { line: root.line(), found, expected: "at least one" });
        }
        Ok(Self { serial: root.text("Serial")?, calibrations })
    }

    /// The calibration of this part number, or the only one there is.
    ///
    /// # Errors
    /// [`AtiFileError::Part`] where there is none of it, or several and none is named.
    pub fn calibration(&self, part_number: Option<&str>) -> Result<&AtiCalibration, AtiFileError> {
        let mut fitting =
            self.calibrations.iter().filter(|c| part_number.is_none_or(|part| part == c.part_number)).fuse();
        match (fitting.next(), fitting.next()) {
            (Some(only), None) => Ok(only),
            _ => {
                let names: Vec<&str> = self.calibrations.iter().map(|c| c.part_number.as_str()).collect();
                Err(AtiFileError::Part { part: part_number.map(str::to_owned), found: names.join(", ") })
            }
        }
    }
}

impl AtiCalibration {
    fn of(element: Element<'_>, gauges: usize) -> Result<Self, AtiFileError> {
        let line = element.line();
        let data = |error| AtiFileError::Data { line, error };
        let force = element.unit("ForceUnits", Dimension::Force, None)?;
        let units = WrenchUnits::new(force, element.unit("TorqueUnits", Dimension::Torque, None)?).map_err(data)?;
        let (rows, largest) = matrix::rows(element, gauges, units)?;
        // the check of the matrix does not need the number of gauges: columns of zeros change nothing
        GaugeMatrix::<{ Channels::MOST }>::new(&rows, WrenchUnits::SI).map_err(data)?;
        let range = element.number("OutputRange")?;
        if range.is_some_and(|range| range <= 0.0) {
            return Err(element.wrong("OutputRange", "a positive number of volts"));
        }
        let rails = match (range, element.attribute("OutputBipolar").map(str::to_ascii_lowercase).as_deref()) {
            (Some(range), Some("true")) => Some([-0.5 * range, 0.5 * range]),
            (Some(range), Some("false")) => Some([0.0, range]),
            _ => None,
        };
        Ok(Self {
            part_number: element.attribute("PartNumber").unwrap_or_default().to_owned(),
            date: element.attribute("CalDate").unwrap_or_default().to_owned(),
            units,
            gauges,
            rated: RatedLoad::in_units(largest, units).map_err(data)?,
            rails,
            line,
            rows,
            slopes: Slopes::of(element, gauges)?,
        })
    }

    /// Whether the file has what it takes to compensate for temperature.
    pub fn compensates(&self) -> bool {
        self.slopes.is_some()
    }

    /// The calibration of gauges in volts. Where the file has slopes of temperature it compensates, and expects the volts of
    /// the thermistor as one more channel after the gauges; [`without_temperature`](Self::without_temperature) does not.
    ///
    /// # Errors
    /// [`AtiFileError::Gauges`] where the sensor has another number of gauges.
    pub fn matrix<const N: usize, T: Number>(&self) -> Result<GaugeMatrix<N, T>, AtiFileError> {
        let matrix = self.without_temperature()?;
        let Some(slopes) = &self.slopes else { return Ok(matrix) };
        let of = |slopes: &[f64]| from_fn(|i| slopes.get(i).copied().unwrap_or_default());
        Compensation::new(of(&slopes.bias), of(&slopes.gain), slopes.thermistor)
            .and_then(|compensation| matrix.with_compensation(compensation))
            .map_err(|error| AtiFileError::Data { line: self.line, error })
    }

    /// The calibration of gauges in volts at the temperature of the calibration.
    ///
    /// # Errors
    /// [`AtiFileError::Gauges`] where the sensor has another number of gauges.
    pub fn without_temperature<const N: usize, T: Number>(&self) -> Result<GaugeMatrix<N, T>, AtiFileError> {
        if self.gauges != N {
            return Err(AtiFileError::Gauges { found: self.gauges, expected: N });
        }
        let mut rows = [(Component::Fx, [0.0; N]); 6];
        for (place, (component, row)) in rows.iter_mut().zip(&self.rows) {
            *place = (*component, from_fn(|i| row[i]));
        }
        let rows = rows.get(..self.rows.len()).unwrap_or_default();
        GaugeMatrix::new(rows, WrenchUnits::SI).map_err(|error| AtiFileError::Data { line: self.line, error })
    }
}

impl Slopes {
    /// Those of a file, unless all are zero.
    fn of(element: Element<'_>, gauges: usize) -> Result<Option<Self>, AtiFileError> {
        let slopes = |name| match element.child(name)? {
            Some(child) => child.numbers("values", gauges).map(|(values, _)| values),
            None => Ok(vec![0.0; gauges]),
        };
        let (bias, gain) = (slopes("BiasSlope")?, slopes("GainSlope")?);
        if bias.iter().chain(&gain).all(|slope| *slope == 0.0) {
            return Ok(None);
        }
        let missing = || AtiFileError::Element {
            line: element.line(),
            found: "slopes of temperature without a `Thermistor`".to_owned(),
            expected: "its value at the temperature of the calibration",
        };
        let thermistor = element.child("Thermistor")?.ok_or_else(missing)?;
        let value = thermistor.number("value")?.ok_or_else(|| thermistor.wrong("value", "a number of volts"))?;
        Ok(Some(Self { bias, gain, thermistor: value }))
    }
}
