//! The setup of a sensor, read from a TOML file: what it sends, how it sits under the clamp, how far it can be trusted; and what
//! of a recording is meant.
//!
//! `document` is the file as written, `check` turns it into what the library takes, with `gauges` and `recording` for parts of it.

mod calibration;
mod check;
mod document;
mod errors;
mod field;
mod gauges;
mod recording;

pub use calibration::{Gauges, SensorCalibration};
pub use errors::SharedErrors;
pub use recording::{RecordingSetup, RecordingTime};

use crate::toml_file::{self, Fault, Quantities};
use crate::{SceneError, StageDelay};
use document::SetupDocument;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};
use vibrissa::hw::device::rdt::RdtProfile;
use vibrissa::hw::{Accuracy, Dimension, Frame, Mounting, RatedLoad, Wrench};

/// How a sensor is set up.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Family of an RDT sensor.
    pub profile: RdtProfile,
    /// Rate of its own counter, Hz: where it is known, times are counted.
    pub rate: Option<f64>,
    /// What its numbers are in N and N m; none where the device, its protocol or the recording tells.
    pub calibration: Option<SensorCalibration>,
    /// How it sits under the clamp.
    pub mounting: Mounting,
    /// How much it may be loaded.
    pub rated: Option<RatedLoad>,
    /// Its class in percent of that.
    pub class: Wrench,
    /// How far it can be trusted.
    pub accuracy: Option<Accuracy>,
    /// The window for the tare.
    pub tare: TareSetup,
    /// Half of the window in which contacts and phases are told, m; where it is not given, 2 % of the rod, or 200 samples.
    pub half_window: Option<f64>,
    /// Delay of the clock of a stage's table.
    pub stage_delay: Option<StageDelay>,
    /// What of a recording is meant.
    pub recording: RecordingSetup,
    /// How large the errors may be that all samples of a scan share; none without the table `errors`.
    pub errors: Option<SharedErrors>,
    /// What may be a mistake in the file: angles that look like radians where degrees belong.
    pub warnings: Vec<String>,
    /// The file of the setup, and the calibration file that it names.
    pub files: Vec<PathBuf>,
}

/// The window without contact that a scan begins with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TareSetup {
    /// How long it is, s.
    pub seconds: f64,
    /// Largest change of a component within it, N and N m; where it is not given, a hundredth of E I / L^2 and E I / L.
    pub change: Option<Wrench>,
}

impl Default for Setup {
    /// A Net F/T that tells its scaling, with the scene's axes and its origin at the clamp, tared for a second.
    fn default() -> Self {
        Self {
            profile: RdtProfile::NetFt,
            rate: None,
            calibration: None,
            mounting: Mounting::new(Frame::same()),
            rated: None,
            class: Wrench::default(),
            accuracy: None,
            tare: TareSetup { seconds: 1.0, change: None },
            half_window: None,
            stage_delay: None,
            recording: RecordingSetup::default(),
            errors: None,
            warnings: Vec::new(),
            files: Vec::new(),
        }
    }
}

impl Setup {
    /// The setup in a file with any of the tables `sensor`, `mounting`, `accuracy`, `tare`, `identification`, `stage`, `recording`, `errors`.
    ///
    /// # Errors
    /// [`SceneError`]: the file cannot be read, or is no setup.
    pub fn read(file: &Path) -> Result<Self, SceneError> {
        Self::parse(file, &toml_file::text("the setup", file)?)
    }

    /// The setup in a text; `file` names it in messages, and a calibration file that it names is beside it.
    ///
    /// ```
    /// use rod_files::Setup;
    /// let setup = Setup::parse("sensor.toml".as_ref(), r#"
    ///     [sensor]
    ///     rate = 7000.0                # Hz, of its own counter
    ///     [mounting]
    ///     axes = ["-y", "x", "z"]      # of the scene, along which its x, y, z lie
    ///     lever = [0.0, 0.012, 0.0]    # m, from its origin to the clamp, in its axes
    /// "#)?;
    /// assert_eq!(setup.rate, Some(7000.0));
    /// assert!(setup.calibration.is_none());
    /// # Ok::<(), rod_files::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the place in the text.
    pub fn parse(file: &Path, text: &str) -> Result<Self, SceneError> {
        let read = |table: Spanned<DeTable<'_>>| {
            let tree = table.get_ref().clone();
            let directory = file.parent().unwrap_or(file);
            let document = SetupDocument::deserialize(Deserializer::from(table))?;
            let calibration = document.sensor.calibration.as_ref().map(|name| directory.join(name.get_ref()));
            Ok((check::setup(&document, &tree, directory)?, calibration))
        };
        let ((setup, calibration), warnings) = toml_file::parse_angles(file, text, quantities, read)?;
        let files = std::iter::once(file.to_path_buf()).chain(calibration).collect();
        Ok(Self { warnings, files, ..setup })
    }
}

/// Fields that may have a unit.
fn quantities(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    let mut quantities = Quantities::default();
    let delay = table.get_ref().get("stage").and_then(|stage| stage.get_ref().as_table()?.get("delay"));
    if let Some(delay) = delay
        && let DeValue::String(text) = delay.get_ref()
    {
        quantities.read("delay", text, delay.span(), Dimension::Time).transpose()?;
    }
    Ok(quantities)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_delay_of_the_stage_may_have_a_unit() {
        let read = |text: &str| Setup::parse("s.toml".as_ref(), text).map(|setup| setup.stage_delay);
        for text in ["[stage]\ndelay = \"-120 ms\"", "[stage]\ndelay = -0.12"] {
            assert_eq!(read(text).unwrap().unwrap().seconds(), -0.12, "{text}");
        }
        assert_eq!(read("").unwrap(), None);
        let error = read("[stage]\ndelay = \"3 mm\"").unwrap_err().to_string();
        assert!(error.contains("`mm` is a unit of length, expected one of time: s, ms"), "{error}");
        assert!(read("[stage]\ndelay = nan").unwrap_err().to_string().contains("expected a finite time"));
    }
}
