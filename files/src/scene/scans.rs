//! Scans in a file: paths of the clamp, and straight scans past an object.

use super::document::{LegTable, PointValue};
use super::leg::{self, LegPath};
use super::numbers::{not, too_large};
use super::schema;
use crate::SceneError;
use crate::toml_file::{self, Fault};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;
use toml::de::Deserializer;
use vibrissa::Pose;
use vibrissa::contact::LARGEST_ANGLE;
use vibrissa::plan::{Pass, StraightScan};

/// The scans of a file.
#[derive(Clone, Debug, Default)]
pub struct ScanList {
    /// Straight scans by distance and angle, `[[scan]]`.
    pub scans: Vec<StraightScan>,
    /// Paths of the clamp, `[[path]]`, on which it moves.
    pub paths: Vec<LegPath>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScanFile {
    #[serde(default)]
    scan: Vec<Spanned<ScanTable>>,
    #[serde(default)]
    path: Vec<Spanned<PathTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScanTable {
    distance: Spanned<f64>,
    angle: Spanned<f64>,
    pass: Option<Spanned<String>>,
}

/// As `[sweep]` of a scene, or an arc from `from` about `pivot`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PathTable {
    from: Spanned<PointValue>,
    angle: Spanned<f64>,
    to: Option<Spanned<PointValue>>,
    angle_to: Option<Spanned<f64>>,
    pivot: Option<Spanned<PointValue>>,
    turn: Option<Spanned<f64>>,
}

/// The scans in a TOML file, for a rod of this length (m).
///
/// # Errors
/// [`SceneError`]: the file cannot be read, or holds no scans.
pub fn read_scans(file: &Path, length: f64) -> Result<ScanList, SceneError> {
    parse(file, &toml_file::text("the scans", file)?, length)
}

fn parse(file: &Path, text: &str, length: f64) -> Result<ScanList, SceneError> {
    toml_file::parse_quantities(file, text, schema::scans, |table| {
        let span = table.span();
        let ScanFile { scan, path } = ScanFile::deserialize(Deserializer::from(table))?;
        if scan.is_empty() && path.is_empty() {
            return Err(Fault::new(span, "the file has no scans, expected tables [[scan]] or [[path]]"));
        }
        let (scans, faulty_scans) = apart(scan.iter().map(|table| scans_of(table.get_ref(), length)));
        let (paths, faulty_paths) = apart(path.into_iter().map(|table| path_of(table, length)));
        let faults: Vec<Fault> = faulty_scans.into_iter().chain(faulty_paths).collect();
        let first = faults.first().map_or(span, Fault::span);
        Fault::all(first, faults).map_or_else(|| Ok(ScanList { scans: scans.concat(), paths }), Err)
    })
}

/// The good results and the faults of some tables.
fn apart<T>(tables: impl Iterator<Item = Result<T, Fault>>) -> (Vec<T>, Vec<Fault>) {
    let (mut good, mut faults) = (Vec::new(), Vec::new());
    for table in tables {
        match table {
            Ok(one) => good.push(one),
            Err(fault) => faults.push(fault),
        }
    }
    (good, faults)
}

/// One scan, or both passes.
fn scans_of(table: &ScanTable, length: f64) -> Result<Vec<StraightScan>, Fault> {
    let (distance, angle) = (*table.distance.get_ref(), angle(&table.angle, "angle")?);
    if !(distance > 0.0 && distance < length) {
        let message =
            format!("distance is {distance} m, expected more than 0 and less than the rod's length, {length} m");
        return Err(Fault::new(table.distance.span(), message));
    }
    let passes = match &table.pass {
        None => Pass::BOTH.to_vec(),
        Some(given) => match Pass::BOTH.into_iter().find(|pass| pass.to_string() == *given.get_ref()) {
            Some(pass) => vec![pass],
            None => {
                let message = format!("pass is {}, expected left or right, or no pass for both", given.get_ref());
                return Err(Fault::new(given.span(), message));
            }
        },
    };
    Ok(passes.into_iter().map(|pass| StraightScan { distance, angle, pass }).collect())
}

fn path_of(table: Spanned<PathTable>, length: f64) -> Result<LegPath, Fault> {
    let span = table.span();
    let PathTable { from, angle: first, to, angle_to, pivot, turn } = table.into_inner();
    let [x, y] = from.get_ref().0;
    if !(x.is_finite() && y.is_finite()) {
        return Err(Fault::new(from.span(), format!("from is [{x}, {y}], expected finite numbers")));
    }
    let pose = Pose { x, y, phi: angle(&first, "angle")? };
    let table = Spanned::new(span.clone(), LegTable { to, angle_to, pivot, turn, step: None, step_angle: None });
    let path = leg::path(&table, pose, leg::SAME * length)?;
    if path.turns_only() {
        return Err(Fault::new(span, "the clamp turns without moving, expected a path on which it moves"));
    }
    Ok(path)
}

/// An angle in radians.
fn angle(degrees: &Spanned<f64>, what: &str) -> Result<f64, Fault> {
    let value = *degrees.get_ref();
    match value.to_radians() {
        radians if !radians.is_finite() => Err(Fault::new(degrees.span(), not(what, value))),
        radians if radians.abs() > LARGEST_ANGLE => Err(Fault::new(degrees.span(), too_large(what, value))),
        radians => Ok(radians),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ScanList, String> {
        parse("scans.toml".as_ref(), text, 0.1).map_err(|error| error.to_string())
    }

    #[test]
    fn straight_scans_and_paths_are_read_in_their_units() {
        let text = "[[scan]]\ndistance = \"4 cm\"\nangle = 90.0\n\n[[scan]]\ndistance = 0.02\nangle = 0\npass = \"right\"\n\n\
                    [[path]]\nfrom = [0.08, -0.03]\nto = [-0.08, -0.03]\nangle = 90\n\n\
                    [[path]]\nfrom = [0.05, 0.0]\nangle = 180\npivot = [0.0, 0.0]\nturn = 90\n";
        let ScanList { scans, paths } = read(text).unwrap();
        let passes: Vec<_> = scans.iter().map(|scan| (scan.distance, scan.pass)).collect();
        assert_eq!(passes, [(0.04, Pass::Left), (0.04, Pass::Right), (0.02, Pass::Right)]);
        assert!((scans[0].angle - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        let end = paths[1].at(paths[1].length());
        assert!(end.x.abs() < 1e-15 && (end.y - 0.05).abs() < 1e-15 && (end.phi - 270_f64.to_radians()).abs() < 1e-14);
        assert_eq!(paths[0].length(), 0.16);
    }

    #[test]
    fn scans_that_cannot_be_are_named_with_their_place() {
        for (text, message) in [
            ("", "the file has no scans, expected tables [[scan]] or [[path]]"),
            (
                "[[scan]]\ndistance = 0.2\nangle = 90",
                "distance is 0.2 m, expected more than 0 and less than the rod's length, 0.1 m",
            ),
            (
                "[[scan]]\ndistance = 0.02\nangle = 90\npass = \"up\"",
                "scans.toml:4:8: scan[1].pass: pass is up, expected left or right",
            ),
            ("[[path]]\nfrom = [0, 0]\nangle = 90", "leads nowhere"),
            (
                "[[path]]\nfrom = [0, 0]\nangle = 90\nangle_to = 80",
                "the clamp turns without moving, expected a path on which it moves",
            ),
            (
                "[scan]\ndistance = 0.02\nangle = 90",
                "scan is a table, expected a list of tables: [[scan]] with two brackets",
            ),
            (
                "[[scan]]\ndistance = 0.2\nangle = 90\n\n[[scan]]\ndistance = -1\nangle = 90\n\n[[path]]\nfrom = [0, 0]\nangle = 90",
                "scans.toml:2:12: scan[1].distance: distance is 0.2 m, expected more than 0 and less than the rod's length, 0.1 m; \
                 distance is -1 m, expected more than 0 and less than the rod's length, 0.1 m (line 6); ",
            ),
            (
                "[[scan]]\ndistance = 0.02\n\n[[path]]\nfrom = [0]\nangle = 90\n\n[[path]]\nfrom = [0, 0]\nangle = \"up\"",
                "missing field `angle`; from is a list of 1, expected two numbers: [x, y] (line 5); angle is the text \"up\", expected a number (line 10)",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }
}
