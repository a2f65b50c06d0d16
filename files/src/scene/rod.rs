//! A rod on its own.

use super::document::{CalibrationTable, ClampTable, RodTable};
use super::{rod_table, schema};
use crate::toml_file::Fault;
use crate::{SceneError, toml_file};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::Path;
use toml::Spanned;
use toml::de::Deserializer;
use vibrissa::Rod;
use vibrissa::rod::AnyRod;

/// A file with a rod in it: that, perhaps with a calibration, or a scene, of which nothing else is looked at.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RodFile {
    pub rod: Spanned<RodTable>,
    pub clamp: Option<Spanned<ClampTable>>,
    pub calibration: Option<Spanned<CalibrationTable>>,
    #[serde(rename = "contact")]
    _contact: Option<IgnoredAny>,
    #[serde(rename = "contour")]
    _contour: Option<IgnoredAny>,
    #[serde(rename = "object")]
    _object: Option<IgnoredAny>,
    #[serde(rename = "sweep")]
    _sweep: Option<IgnoredAny>,
}

impl RodFile {
    /// The rod, if it is uniform and straight at rest and its clamp is rigid; `instead` is what the user may do with another one.
    pub fn uniform(&self, instead: &str) -> Result<Rod, Fault> {
        match (rod_table::uniform(&self.rod, instead)?, &self.clamp) {
            (rod, None) => Ok(rod),
            (_, Some(clamp)) => Err(match &clamp.get_ref().roller {
                Some(roller) => Fault::new(roller.span(), rod_table::NO_ROLLER),
                None => Fault::new(clamp.span(), format!("{}; {instead}", rod_table::NOT_RIGID)),
            }),
        }
    }

    /// The rod of any kind on its clamp.
    pub fn any(&self) -> Result<AnyRod, Fault> {
        rod_table::rod_for_recordings(&self.rod, self.clamp.as_ref())
    }
}

/// A rod that was filmed.
#[derive(Clone, Debug)]
pub struct FilmedRod {
    /// The rod; of an unknown stiffness with that of 1 N m^2 at its base.
    pub rod: AnyRod,
    /// Whether its stiffness is known. Otherwise forces are known in E I / L^2 only, and moments in E I / L, with E I at the base;
    /// columns of measured forces and moments are an error.
    pub is_stiffness_known: bool,
}

/// The rod in a TOML file that holds a table `[rod]` as a scene does, or in a scene: of any kind on any springs, perhaps of another
/// `length` (m) than the file says. It may have no stiffness at all: neither bending_stiffness nor youngs_modulus.
///
/// # Errors
/// [`SceneError`]: the file cannot be read, or holds no rod.
pub fn read_filmed_rod(file: &Path, length: Option<f64>) -> Result<FilmedRod, SceneError> {
    parse_filmed(file, &toml_file::text("the rod", file)?, length)
}

fn parse_filmed(file: &Path, text: &str, length: Option<f64>) -> Result<FilmedRod, SceneError> {
    toml_file::parse_quantities(file, text, schema::filmed_rod, |table| {
        let file = RodFile::deserialize(Deserializer::from(table))?;
        let (rod, is_stiffness_known) = rod_table::filmed_rod(&file.rod, file.clamp.as_ref(), length)?;
        Ok(FilmedRod { rod, is_stiffness_known })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_uniform_rod;

    fn parse(text: &str) -> Result<Rod, SceneError> {
        let rod_of = |file: RodFile| file.uniform("take another");
        toml_file::parse_quantities("rod.toml".as_ref(), text, schema::rod_file, |table| {
            rod_of(RodFile::deserialize(Deserializer::from(table))?)
        })
    }

    #[test]
    fn a_rod_alone_and_that_of_a_scene() {
        let alone = parse("[rod]\nlength = 0.1\nbending_stiffness = 6.32e-4\n").unwrap();
        assert_eq!((alone.length(), alone.bending_stiffness()), (0.1, 6.32e-4));
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/O1_q40.toml");
        let (rod, _) = read_uniform_rod(&scene, "").unwrap();
        assert!((rod.bending_stiffness() - 6.32e-4).abs() < 1e-6);
        // Of a scene only the rod is looked at.
        let scene =
            "[rod]\nlength = 0.1\nbending_stiffness = 1\n[contact]\nfriction = 1\n[sweep]\nfrom = 3\n[[object]]\n";
        assert!(parse(scene).is_ok());
    }

    #[test]
    fn a_filmed_rod_may_have_no_stiffness_and_another_length() {
        let read = |text: &str, length| parse_filmed("rod.toml".as_ref(), text, length).unwrap();
        let known = read("[rod]\nlength = 0.1\nbending_stiffness = 2e-3\n", Some(0.05));
        assert!(known.is_stiffness_known && known.rod.length() == 0.05);
        assert_eq!(known.rod.at_clamp().bending_stiffness(), 2e-3);
        for text in [
            "[rod]\nlength = 0.1\n",
            "[rod]\nlength = 0.1\ndiameter = 1e-3\ntip_diameter = 1e-4\n",
            "[rod]\nlength = 0.1\ndiameter = [[0, 1e-3], [0.02, 0.9e-3], [0.1, 1e-4]]\n",
        ] {
            let unknown = read(text, None);
            let stiffness = unknown.rod.at_clamp().bending_stiffness();
            assert!(!unknown.is_stiffness_known && (stiffness - 1.0).abs() < 1e-12, "{stiffness}");
        }
        let thin = "[rod]\nlength = 0.1\ntip_diameter = 1e-4\n";
        let error = parse_filmed("rod.toml".as_ref(), thin, None).unwrap_err().to_string();
        assert!(
            error.starts_with("rod.toml:3:16: rod.tip_diameter: tip_diameter is given without diameter"),
            "{error}"
        );
    }

    #[test]
    fn a_list_of_diameters_is_checked_without_a_stiffness_too() {
        for (diameters, expected) in [
            ("[]", "rod.toml:3:12: rod.diameter: diameter has 0 points"),
            (
                "[[0, 0.0], [0.1, 1e-4]]",
                "rod.toml:3:12: rod.diameter: diameter of point 1 is 0.0 m, expected a positive",
            ),
            (
                "[[0, 1e-3], [0.05, 1e-6], [0.09, 1e-4]]",
                "rod.toml:3:12: rod.diameter: diameter of point 2 is 1e-6 m, expected between 0.01 and 100 times that at the clamp, 0.001 m; \
                 point 3 of diameter has the arc length 0.09 m, expected 0.1 m",
            ),
        ] {
            let text = format!("[rod]\nlength = 0.1\ndiameter = {diameters}\n");
            let error = parse_filmed("rod.toml".as_ref(), &text, None).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        // points to another length than that of `--length`
        let text = "[rod]\nlength = 0.1\ndiameter = [[0, 1e-3], [0.1, 1e-4]]\n";
        let error = parse_filmed("rod.toml".as_ref(), text, Some(0.09)).unwrap_err().to_string();
        assert!(error.contains("arc length 0.1 m, expected 0.09 m, the length of the rod"), "{error}");
    }

    #[test]
    fn a_rod_in_units() {
        let rod = parse("[rod]\nlength = \"40 mm\"\ndiameter = \"0.2 mm\"\nyoungs_modulus = \"3 GPa\"\n").unwrap();
        assert_eq!(rod.length(), 0.04);
        let text = "[rod]\nlength = \"40 mm\"\ndiameter = [[0, \"0.2 mm\"], [\"40 mm\", \"20 um\"]]\n";
        let filmed = parse_filmed("rod.toml".as_ref(), text, None).unwrap();
        assert!(!filmed.is_stiffness_known && filmed.rod.length() == 0.04);
        let error = parse("[rod]\nlength = \"40 kg\"\nbending_stiffness = 1").unwrap_err().to_string();
        let expected =
            "rod.toml:2:10: rod.length: length is \"40 kg\": `kg` is a unit of mass, expected one of length: m, mm";
        assert!(error.starts_with(expected), "{error}");
    }

    #[test]
    fn no_rod() {
        for (text, message) in [
            ("", "rod.toml:1:1: missing field `rod`"),
            ("length = 0.1", "rod.toml:1:1: length: unknown field `length`, expected one of `rod`"),
            ("[rod]\nlength = 0.1", "rod.toml:1:1: rod: missing field `bending_stiffness`"),
            (
                "[rod]\nlength = -1\nbending_stiffness = 1",
                "rod.toml:2:10: rod.length: length is -1, expected a positive",
            ),
            (
                "[rod]\nlength = \"m\"\nbending_stiffness = 1",
                "rod.toml:2:10: rod.length: the value is the text \"m\", expected a number",
            ),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        let error = read_uniform_rod("nowhere.toml".as_ref(), "").unwrap_err().to_string();
        assert!(error.starts_with("cannot read the rod nowhere.toml: "), "{error}");
    }
}
