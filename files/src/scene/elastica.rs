//! A rod without contacts: its clamp, its loads and its tip, read from a TOML file.

use super::document::{PointValue, RodTable};
use super::numbers::{not, too_large};
use super::{rod_table, schema, stem};
use crate::toml_file::{self, Fault, SourceText};
use crate::{ElasticaRun, SceneError};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::de::Deserializer;
use toml::{Spanned, Value};
use vibrissa::Pose;
use vibrissa::contact::LARGEST_ANGLE;
use vibrissa::rod::{AnyRod, DeadLoad, ElasticaArgument, ElasticaError, Tip, TipEnd, elastica_equilibria};

/// Points of a shape where the file does not say.
const POINTS: usize = 200;
/// Most points of a shape: a table of 100 MB.
const MOST_POINTS: i64 = 1_000_000;

/// The file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ElasticaFile {
    rod: Spanned<RodTable>,
    clamp: Option<Spanned<ClampPose>>,
    #[serde(default)]
    load: Vec<Spanned<LoadTable>>,
    tip: Option<Spanned<TipTable>>,
    branches: Option<Spanned<Value>>,
    points: Option<Spanned<i64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClampPose {
    place: Option<Spanned<PointValue>>,
    angle: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LoadTable {
    s: Spanned<f64>,
    force: Spanned<PointValue>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TipTable {
    place: Option<Spanned<PointValue>>,
    x: Option<Spanned<f64>>,
    y: Option<Spanned<f64>>,
    angle: Option<Spanned<f64>>,
    force: Option<Spanned<PointValue>>,
    fx: Option<Spanned<f64>>,
    fy: Option<Spanned<f64>>,
    moment: Option<Spanned<f64>>,
}

/// A rod without contacts, and what is prescribed of it.
#[derive(Debug)]
pub struct ElasticaScene {
    /// What to call it: the file's name without its extension.
    pub name: String,
    /// The rod, on a rigid clamp.
    pub rod: AnyRod,
    /// Its clamp.
    pub clamp: Pose,
    /// Forces on it.
    pub loads: Vec<DeadLoad>,
    /// Its tip.
    pub tip: Tip,
    /// How many equilibria are wanted; none where all of them are.
    pub branches: Option<usize>,
    /// Points of each shape.
    pub points: usize,
    /// Angles that look like radians where degrees belong.
    pub warnings: Vec<String>,
    /// The file.
    pub file: PathBuf,
    source: SourceText,
}

impl ElasticaScene {
    /// The rod in a file.
    ///
    /// # Errors
    /// [`SceneError`]: the file cannot be read, or is not such a file.
    pub fn read(file: &Path) -> Result<Self, SceneError> {
        Self::parse(file, &toml_file::text("the rod and its loads", file)?)
    }

    /// The rod in a text, which `file` names in messages.
    ///
    /// ```
    /// use rod_files::ElasticaScene;
    /// let scene = ElasticaScene::parse("cantilever.toml".as_ref(), "
    ///     rod = { length = 0.1, bending_stiffness = 1e-3 }
    ///     tip = { force = [0.0, -0.1] }
    /// ")?;
    /// let run = scene.solve()?;
    /// assert!(run.equilibria.len() == 1 && run.equilibria[0].stable);
    /// # Ok::<(), rod_files::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the place in the text.
    pub fn parse(file: &Path, text: &str) -> Result<Self, SceneError> {
        let source = SourceText::new(file, text);
        let (mut scene, warnings) = toml_file::parse_angles(file, text, schema::elastica, |table| {
            let document = ElasticaFile::deserialize(Deserializer::from(table))?;
            scene(stem(file), source, &document)
        })?;
        scene.warnings = warnings;
        Ok(scene)
    }

    /// Finds the equilibria, the lowest potential energy first.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field that the search refuses.
    pub fn solve(self) -> Result<ElasticaRun, SceneError> {
        let found = elastica_equilibria(&self.rod, self.clamp, &self.loads, &self.tip);
        let mut equilibria = found.map_err(|error| self.source.error_at(&fields(&error), &error.to_string()))?;
        let all = equilibria.len();
        equilibria.truncate(self.branches.unwrap_or(all));
        Ok(ElasticaRun { scene: self, equilibria, found: all })
    }
}

/// The fields that may have caused an error, the likeliest first.
fn fields(error: &ElasticaError) -> Vec<String> {
    let ElasticaError::Argument { argument, message, .. } = error else { return vec!["tip".to_owned()] };
    let what = message.split([' ', ',']).next().unwrap_or_default();
    match argument {
        ElasticaArgument::Load(index) => {
            let table = format!("load[{}]", index + 1);
            let field = if what == "s" { "s" } else { "force" };
            vec![format!("{table}.{field}"), table]
        }
        ElasticaArgument::Loads => vec!["load".to_owned(), "tip".to_owned()],
        ElasticaArgument::Pose => vec!["clamp".to_owned()],
        ElasticaArgument::Tip => {
            let other = match what {
                "x" | "y" => "place",
                "fx" | "fy" | "the" => "force",
                "phi" => "angle",
                other => other,
            };
            vec![format!("tip.{what}"), format!("tip.{other}"), "tip".to_owned()]
        }
        _ => vec!["rod".to_owned()],
    }
}

fn scene(name: String, source: SourceText, document: &ElasticaFile) -> Result<ElasticaScene, Fault> {
    let ElasticaFile { rod, clamp, load, tip, branches, points } = document;
    let rod = rod_table::alone(rod)?;
    let (place, direction) = match clamp.as_ref().map(Spanned::get_ref) {
        Some(ClampPose { place, angle }) => (place.as_ref(), angle.as_ref()),
        None => (None, None),
    };
    let [x, y] = place.map_or(Ok([0.0; 2]), finite_point)?;
    let clamp = Pose { x, y, phi: direction.map_or(Ok(0.0), angle)? };
    let dead_load = |table: &Spanned<LoadTable>| {
        let LoadTable { s, force } = table.get_ref();
        let [fx, fy] = force.get_ref().0;
        DeadLoad { s: *s.get_ref(), fx, fy }
    };
    Ok(ElasticaScene {
        name,
        rod,
        clamp,
        loads: load.iter().map(dead_load).collect(),
        tip: tip.as_ref().map_or(Ok(Tip::FREE), prescribed)?,
        branches: branches.as_ref().map_or(Ok(Some(1)), count)?,
        points: points.as_ref().map_or(Ok(POINTS), number_of_points)?,
        warnings: Vec::new(),
        file: source.file().to_path_buf(),
        source,
    })
}

fn finite_point(point: &Spanned<PointValue>) -> Result<[f64; 2], Fault> {
    let [x, y] = point.get_ref().0;
    if x.is_finite() && y.is_finite() {
        return Ok([x, y]);
    }
    Err(Fault::new(point.span(), format!("place is [{x}, {y}], expected two finite numbers: [x, y] in m")))
}

fn angle(field: &Spanned<f64>) -> Result<f64, Fault> {
    let degrees = *field.get_ref();
    if !degrees.is_finite() {
        return Err(Fault::new(field.span(), not("angle", degrees)));
    }
    if degrees.to_radians().abs() > LARGEST_ANGLE {
        return Err(Fault::new(field.span(), too_large("angle", degrees)));
    }
    Ok(degrees.to_radians())
}

fn count(field: &Spanned<Value>) -> Result<Option<usize>, Fault> {
    let value = field.get_ref();
    let number = value.as_integer().and_then(|number| usize::try_from(number).ok()).filter(|number| *number > 0);
    match (number, value.as_str()) {
        (Some(number), _) => Ok(Some(number)),
        (_, Some("all")) => Ok(None),
        _ => {
            let message = format!("branches is {value}, expected a whole number, at least 1, or \"all\"");
            Err(Fault::new(field.span(), message))
        }
    }
}

fn number_of_points(field: &Spanned<i64>) -> Result<usize, Fault> {
    let number = *field.get_ref();
    let points = usize::try_from(number).ok().filter(|_| (2..=MOST_POINTS).contains(&number));
    let message = || format!("points is {number}, expected a whole number from 2 to {MOST_POINTS}");
    points.ok_or_else(|| Fault::new(field.span(), message()))
}

/// What the fields of the tip prescribe: along each coordinate its value or the load, none of which is 0.
fn prescribed(table: &Spanned<TipTable>) -> Result<Tip, Fault> {
    let TipTable { place, x, y, angle: direction, force, fx, fy, moment } = table.get_ref();
    let of = |point: &Option<Spanned<PointValue>>, k: usize| {
        point.as_ref().map(|point| (point.span(), point.get_ref().0[k]))
    };
    let one = |number: &Option<Spanned<f64>>| number.as_ref().map(|number| (number.span(), *number.get_ref()));
    let direction = match direction {
        Some(field) => Some((field.span(), angle(field)?)),
        None => None,
    };
    let coordinates = [
        ("x", [("place", of(place, 0)), ("x", one(x))], [("force", of(force, 0)), ("fx", one(fx))]),
        ("y", [("place", of(place, 1)), ("y", one(y))], [("force", of(force, 1)), ("fy", one(fy))]),
        ("angle", [("angle", direction), ("", None)], [("moment", one(moment)), ("", None)]),
    ];
    let mut faults = Vec::new();
    let [x, y, phi] = coordinates.map(|(coordinate, held, loaded)| {
        let held = held.into_iter().filter_map(|(name, value)| Some((name, value?, true)));
        let loaded = loaded.into_iter().filter_map(|(name, value)| Some((name, value?, false)));
        let mut given = held.chain(loaded);
        let Some((first, (_, value), is_held)) = given.next() else { return TipEnd::Loaded(0.0) };
        faults.extend(given.map(|(second, (span, _), _)| {
            let message = format!("{second} is given beside {first}, expected one of the two along {coordinate}");
            Fault::new(span, message)
        }));
        if is_held { TipEnd::Held(value) } else { TipEnd::Loaded(value) }
    });
    Fault::all(table.span(), faults).map_or(Ok(Tip { x, y, phi }), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::rod::TipEnd::{Held, Loaded};

    const ROD: &str = "[rod]\nlength = 0.1\nbending_stiffness = 1e-3\n";

    fn read(rest: &str) -> Result<ElasticaRun, String> {
        let scene = ElasticaScene::parse("rod.toml".as_ref(), &format!("{rest}\n{ROD}"));
        scene.and_then(ElasticaScene::solve).map_err(|error| error.to_string())
    }

    #[test]
    fn quantities_may_have_units() {
        let run = read(
            "clamp = { place = [\"10 mm\", 0], angle = \"1 deg\" }\nload = [{ s = \"5 cm\", force = [0, \"-2 mN\"] }]\n\
             tip = { force = [\"1 mN\", \"0 N\"], moment = \"3 N mm\" }",
        );
        let scene = run.unwrap().scene;
        assert_eq!((scene.clamp.x, scene.clamp.phi), (0.01, 1_f64.to_radians()));
        assert_eq!(scene.loads, [DeadLoad { s: 0.05, fx: 0.0, fy: -2e-3 }]);
        assert_eq!(scene.tip, Tip::loaded(1e-3, 0.0, 3e-3));
        let wrong = read("tip = { moment = \"3 mN\" }").unwrap_err();
        assert!(wrong.contains("moment is \"3 mN\": `mN` is a unit of force, expected one of torque"), "{wrong}");
    }

    #[test]
    fn each_coordinate_of_the_tip_is_held_or_loaded() {
        for (table, tip) in [
            ("", Tip::FREE),
            ("tip = { force = [0.1, -0.2], moment = 1e-3 }", Tip::loaded(0.1, -0.2, 1e-3)),
            ("tip = { place = [0.06, 0.02] }", Tip::place(0.06, 0.02)),
            (
                "tip = { place = [0.06, 0.02], angle = 180 }",
                Tip { phi: Held(std::f64::consts::PI), ..Tip::place(0.06, 0.02) },
            ),
            ("tip = { fx = -0.3, y = 0.0, angle = 0 }", Tip { x: Loaded(-0.3), y: Held(0.0), phi: Held(0.0) }),
        ] {
            let run = read(table).unwrap();
            assert_eq!(run.scene.tip, tip);
            assert_eq!(run.equilibria.len(), 1, "{table}");
        }
        let run =
            read("clamp = { place = [0.01, 0], angle = 90 }\nbranches = \"all\"\ntip = { force = [0, -0.5] }").unwrap();
        assert!(run.equilibria.len() == 3 && run.found == 3 && run.scene.clamp.phi == 90_f64.to_radians());
        let run = read("load = [{ s = 0.05, force = [0, 1] }]\npoints = 11").unwrap();
        assert!(run.scene.points == 11 && (run.equilibria[0].reactions.f0y + 1.0).abs() < 1e-15);
    }

    #[test]
    fn mistakes_have_their_places() {
        for (table, message) in [
            (
                "tip = { place = [0.2, 0] }",
                "rod.toml:1:17: tip.place: place is (0.2, 0.0) m, 0.2 m from the clamp, expected",
            ),
            (
                "tip = { place = [0, 0], fx = 1 }",
                "rod.toml:1:30: tip.fx: fx is given beside place, expected one of the two along x",
            ),
            ("tip = { force = [inf, 0] }", "rod.toml:1:17: tip.force: fx is inf, expected a finite number"),
            ("tip = { moment = nan }", "rod.toml:1:18: tip.moment: moment is NaN, expected a finite number"),
            ("tip = { moment = 7 }", "rod.toml:1:18: tip.moment: moment is 7.0 N m, expected at most"),
            ("tip = { angle = 9000 }", "rod.toml:1:17: tip.angle: angle is 9000 degrees, expected at most"),
            ("load = [{ s = 0.2, force = [0, 1] }]", "rod.toml:1:15: load[1].s: s is 0.2 m, expected 0 to 0.1 m"),
            ("load = [{ s = 0.1, force = [0, 999] }]", "rod.toml:1:8: load: the forces add up to 999.0 N, expected"),
            ("load = [{ s = 0.1 }]", "rod.toml:1:9: load[1]: missing field `force`"),
            ("branches = 0", "rod.toml:1:12: branches: branches is 0, expected a whole number, at least 1, or \"all\""),
            ("points = 1", "rod.toml:1:10: points: points is 1, expected a whole number from 2"),
            (
                "clamp = { stiffness_x = 5 }",
                "rod.toml:1:11: clamp.stiffness_x: unknown field `stiffness_x`, expected `place` or `angle`",
            ),
            ("tips = 1", "rod.toml:1:1: tips: unknown field `tips`"),
            (
                "[tip]\nplace = [0, 0]\nx = 0.01\nfy = 1",
                "rod.toml:1:1: tip: x is given beside place, expected one of the two along x (line 3); fy is given beside place, \
                 expected one of the two along y (line 4)",
            ),
            (
                "[[load]]\ns = \"1 N\"\nforce = [0, 1]\n[[load]]\ns = 0.1\nforce = 0.01",
                "rod.toml:1:1: load[1]: s is \"1 N\": `N` is a unit of force, expected one of length: m, mm, um, cm, in, ft (line 2); \
                 force is 0.01, expected two numbers: [x, y] (line 6)",
            ),
            (
                "[load]\ns = 0.1\nforce = [0, 1]",
                "rod.toml:1:1: load: load is a table, expected a list of tables: [[load]]",
            ),
            ("tip = { x = 2020-01-01 }", "rod.toml:1:13: tip.x: x is a date, expected a number"),
            (
                "clamp = { roller = 0.01 }",
                "rod.toml:1:11: clamp.roller: unknown field `roller`, expected `place` or `angle`: the",
            ),
        ] {
            let error = read(table).unwrap_err();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
