//! A rod with what a calibration knows of it and of its sensor.

use super::document::{CalibrationTable, EstimateTable};
use super::rod::RodFile;
use super::schema;
use crate::toml_file::Fault;
use crate::{SceneError, toml_file};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;
use toml::de::Deserializer;
use vibrissa::Rod;
use vibrissa::reconstruct::{Known, ReconstructError, Source};
use vibrissa::rod::AnyRod;

/// A rod on its clamp, and what `vibrissa calibrate` found of the errors of rod, sensor, clamp and stage.
#[derive(Clone, Debug)]
pub struct CalibratedRod {
    /// The rod.
    pub rod: AnyRod,
    /// Nothing where the file has no table `[calibration]`.
    pub known: Known,
}

/// The unit of a source in the table `[calibration]`, and what one unit of the library is in it.
pub fn unit_of(source: Source, rod: &Rod) -> (&'static str, f64) {
    match (source, source.name().1) {
        (Source::NaturalCurvature, _) => ("1/m", 1.0 / rod.length()),
        (Source::ClampCompliance, _) => ("rad/(N m)", 1.0 / rod.units().moment),
        (_, "") => ("1", 1.0),
        (_, unit) => (unit, 1.0),
    }
}

/// The rod of any kind in a TOML file, on the springs of its table `[clamp]`, with its table `[calibration]`.
///
/// # Errors
/// [`SceneError`]: the file cannot be read, holds no rod, or its calibration or its clamp is wrong.
pub fn read_calibrated_rod(file: &Path) -> Result<CalibratedRod, SceneError> {
    parse_any(file, &toml_file::text("the rod", file)?)
}

fn parse_any(file: &Path, text: &str) -> Result<CalibratedRod, SceneError> {
    toml_file::parse_quantities(file, text, schema::rod_file, |table| {
        let file = RodFile::deserialize(Deserializer::from(table))?;
        let rod = file.any()?;
        let known = file.known(rod.at_clamp())?;
        let table = file.calibration.as_ref().map(Spanned::get_ref);
        match table.and_then(|table| table.get(&Source::NaturalCurvature)) {
            Some(estimate) if rod.uniform().is_none() => {
                Err(Fault::new(estimate.span(), ReconstructError::NaturalCurvature.to_string()))
            }
            _ => Ok(CalibratedRod { known, rod }),
        }
    })
}

/// The rod in a TOML file that holds a table `[rod]` as a scene does, or in a scene, with its table `[calibration]`. `instead` ends the
/// message where the rod is not uniform, not straight at rest or not on a rigid clamp: what the user may do with it.
///
/// # Errors
/// [`SceneError`]: the file cannot be read, holds no rod, or its calibration is wrong.
pub fn read_uniform_rod(file: &Path, instead: &str) -> Result<(Rod, Known), SceneError> {
    parse(file, &toml_file::text("the rod", file)?, instead)
}

fn parse(file: &Path, text: &str, instead: &str) -> Result<(Rod, Known), SceneError> {
    toml_file::parse_quantities(file, text, schema::rod_file, |table| {
        let file = RodFile::deserialize(Deserializer::from(table))?;
        let rod = file.uniform(instead)?;
        Ok((rod, file.known(&rod)?))
    })
}

impl RodFile {
    /// The calibration of the file.
    fn known(&self, rod: &Rod) -> Result<Known, Fault> {
        self.calibration.as_ref().map_or(Ok(Known::NOTHING), |table| known_of_table(table.get_ref(), rod))
    }
}

fn known_of_table(table: &CalibrationTable, rod: &Rod) -> Result<Known, Fault> {
    table.iter().try_fold(Known::NOTHING, |known, (source, estimate)| {
        let EstimateTable { value, sigma, unit } = estimate.get_ref();
        let (expected, size) = unit_of(*source, rod);
        if let Some(unit) = unit.as_ref().filter(|unit| unit.get_ref() != expected) {
            let message = format!("the unit is {}, expected {expected}", unit.get_ref());
            return Err(Fault::new(unit.span(), message));
        }
        let (of, deviation) = (*value.get_ref(), *sigma.get_ref());
        if !of.is_finite() {
            return Err(Fault::new(value.span(), format!("value is {of}, expected a finite number")));
        }
        if !(deviation.is_finite() && deviation >= 0.0) {
            let message = format!("sigma is {deviation}, expected a standard deviation, 0 or larger");
            return Err(Fault::new(sigma.span(), message));
        }
        Ok(known.with(*source, of / size, deviation / size))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROD: &str = "[rod]\nlength = 0.1\nbending_stiffness = 1e-3\n";

    #[test]
    fn any_rod_may_have_a_calibration() {
        let cone = "[rod]\nlength = 0.1\ndiameter = 1e-3\ntip_diameter = 5e-4\nyoungs_modulus = 2e11\n";
        let CalibratedRod { rod, known } = parse_any("rod.toml".as_ref(), cone).unwrap();
        assert!(rod.varying().is_some() && rod.uniform().is_none() && known.is_nothing());
        let at_clamp = Rod::from_diameter(0.1, 1e-3, 2e11).unwrap().bending_stiffness();
        assert!((rod.at_clamp().bending_stiffness() / at_clamp - 1.0).abs() < 1e-14 && rod.length() == 0.1);
        let table = format!("{cone}[calibration]\nlag = {{ value = 1e-3, sigma = 1e-4 }}\n");
        let CalibratedRod { known, .. } = parse_any("rod.toml".as_ref(), &table).unwrap();
        assert_eq!(known.of(Source::Lag), Some((1e-3, 1e-4)));
        let bent = format!("{table}natural_curvature = {{ value = 0.3, sigma = 0.01 }}\n");
        let error = parse_any("rod.toml".as_ref(), &bent).unwrap_err().to_string();
        assert!(error.starts_with("rod.toml:8:") && error.contains("calibration.natural_curvature: "), "{error}");
    }

    #[test]
    fn a_calibration_is_read_in_its_units() {
        let read = |table: &str| parse("rod.toml".as_ref(), &format!("{ROD}{table}"), "take another");
        let plain = read("").unwrap();
        assert!(plain.1.is_nothing());
        let table = "[calibration]\nclamp_angle = { value = 8e-3, sigma = 1e-4, unit = \"rad\" }\n\
                     natural_curvature = { value = 0.3, sigma = 0.01 }\n\
                     m0z_in_f0x = { value = 1e-3, sigma = 0, unit = \"1\" }\n";
        let known = read(table).unwrap().1;
        assert_eq!(known.of(Source::ClampAngle), Some((8e-3, 1e-4)));
        let (value, sigma) = known.of(Source::NaturalCurvature).unwrap();
        assert!((value - 0.03).abs() < 1e-15 && (sigma - 1e-3).abs() < 1e-15);
        assert_eq!(known.of(Source::M0zInF0x), Some((1e-3, 0.0)));
        for (table, message) in [
            ("[calibration]\nangle = { value = 1, sigma = 1 }", "the value is `angle`, expected one of"),
            ("[calibration]\nlag = { value = 1 }", "missing field `sigma`"),
            ("[calibration]\nlag = { value = 1, sigma = -1 }", "sigma is -1, expected a standard deviation"),
            ("[calibration]\nlag = { value = nan, sigma = 1 }", "value is NaN, expected a finite number"),
            ("[calibration]\nclamp_angle = { value = 1, sigma = 1, unit = \"deg\" }", "the unit is deg, expected rad"),
        ] {
            let error = read(table).unwrap_err().to_string();
            assert!(error.starts_with("rod.toml:5:") && error.contains(message), "{error}");
        }
    }
}
