//! The file of a calibrated rod.

use super::result::RodCalibration;
use crate::{WriteError, figure};
use rod_files::Staged;
use rod_files::output::check_output;
use rod_files::unit_of;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use vibrissa::reconstruct::Source;

/// The drawing beside it.
const DRAWING: &str = "calibration.svg";

impl RodCalibration {
    /// Writes the rod to a TOML file, and calibration.svg beside it; returns the name of the drawing. None of the `inputs` is replaced.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write(&self, out: &Path, inputs: Vec<PathBuf>) -> Result<PathBuf, WriteError> {
        check_output(out, &inputs)?;
        let (staged, name) = Staged::of_file(out)?;
        let staged = staged.keeping(inputs);
        staged.write(name, |file| file.write_all(self.rod_file().as_bytes()))?;
        let drawing = figure::calibration(&self.residuals)?;
        staged.write(DRAWING.as_ref(), |file| file.write_all(drawing.as_bytes()))?;
        staged.publish()?;
        Ok(out.with_file_name(DRAWING))
    }

    /// The tables `[rod]` and `[calibration]`.
    pub fn rod_file(&self) -> String {
        let mut text = String::from("# Rod and sensor as `vibrissa calibrate` found them in these recordings:\n");
        for file in &self.recordings {
            let _ = writeln!(text, "#   {}", file.display().to_string().replace(char::is_control, "?"));
        }
        let (length, stiffness) = (self.rod.length(), self.rod.bending_stiffness());
        let _ = writeln!(text, "\n[rod]\nlength = {length:?} # m\nbending_stiffness = {stiffness:?} # N m^2");
        text += "\n# What is left of the errors that all samples share, relative to this rod: value and standard deviation.\n\
                 # `reconstruct --rod` takes the values off the samples. Sources that are not named have the budget of [errors].\n\
                 [calibration]\n";
        for source in Source::ALL {
            let Some((value, sigma)) = self.known.of(source) else { continue };
            let (unit, size) = unit_of(source, &self.rod);
            // of a source there is a name, as in report.json
            let name = serde_json::to_string(&source).unwrap_or_default();
            let (value, sigma) = (value * size, sigma * size);
            let _ = writeln!(
                text,
                "{} = {{ value = {value:?}, sigma = {sigma:?}, unit = \"{unit}\" }} # {}",
                name.trim_matches('"'),
                match source {
                    Source::NaturalCurvature => "natural curvature".to_owned(),
                    Source::ClampCompliance => "compliance of the clamp".to_owned(),
                    _ => source.to_string(),
                }
            );
        }
        text
    }
}
