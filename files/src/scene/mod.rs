//! Scenes: a rod, objects and the way the clamp goes, read from a TOML file.
//!
//! Four steps, one file each: `document` is the file as written, `shape` its pieces of contour, `object` puts these
//! together and where they stand, and `check` turns the rest into what the library takes. Whatever is wrong becomes a
//! [`SceneError`] that points into the file.

mod check;
mod document;
mod elastica;
mod friction;
mod known_rod;
mod leg;
mod numbers;
mod object;
mod rod;
mod rod_on_path;
mod rod_table;
mod scans;
mod schema;
mod shape;

pub use elastica::ElasticaScene;
pub use friction::SceneFriction;
pub use known_rod::{CalibratedRod, read_calibrated_rod, read_uniform_rod, unit_of};
pub use leg::{Leg, LegPath};
pub(crate) use numbers::MOST_STATES;
pub use rod::{FilmedRod, read_filmed_rod};
pub use rod_on_path::RodOnPath;
pub use scans::{ScanList, read_scans};

use crate::SceneError;
use crate::toml_file::{self, SourceText};
use rod_table::{NO_ROLLER, NOT_RIGID, NOT_UNIFORM};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, Deserializer};
use toml::{Spanned, Table};
use vibrissa::contact::{ContactError, StopReason};
use vibrissa::rod::AnyRod;
use vibrissa::{ClampPath, Composite, Pose, Rod, State, Sweep};

/// Poses along a leg about a pivot, for figures.
const PARTS: u32 = 32;

/// A rod swept along a contour.
#[derive(Debug)]
pub struct Scene {
    /// What to call it: the file's name without its extension.
    pub name: String,
    /// The rod on its clamp.
    pub rod: AnyRod,
    /// The objects, coordinates in m.
    pub objects: Vec<Composite>,
    /// The way of the clamp; with `legs`, the first one of it.
    pub path: ClampPath,
    /// Distance between reported states: m, or radians where the clamp only turns.
    pub step: f64,
    /// Where the clamp goes after that, one leg after another.
    pub legs: Vec<Leg>,
    /// Friction between the rod and the objects; none where there is none.
    pub friction: Option<SceneFriction>,
    /// What may be a mistake in the file: a rod of implausible size or stiffness, angles that look like radians where degrees
    /// belong, or the other way round.
    pub warnings: Vec<String>,
    /// The file of the scene, and those that it names.
    pub files: Vec<PathBuf>,
    tables: Table,
    source: SourceText,
}

impl Scene {
    /// The scene in a file.
    ///
    /// # Errors
    /// [`SceneError`]: the file cannot be read, or is no scene.
    pub fn read(file: &Path) -> Result<Self, SceneError> {
        Self::parse(file, &toml_file::text("the scene", file)?)
    }

    /// The scene in a text. `file` names it, in messages and as a whole; it is not opened, but the files that the text
    /// names are: relative ones are looked for in the directory of `file`.
    ///
    /// ```
    /// use rod_files::Scene;
    /// let scene = Scene::parse("line.toml".as_ref(), r#"
    ///     [rod]
    ///     length = 0.1
    ///     bending_stiffness = 1e-3
    ///     [[contour.piece]]
    ///     shape = "parabola"
    ///     vertex = [0.0, 0.05]
    ///     coefficient = 0.0
    ///     [sweep]
    ///     from = [0.0, 0.0]
    ///     to = [0.1, 0.0]
    ///     angle = 45.0
    ///     step = 1e-3
    /// "#)?;
    /// assert_eq!((scene.name.as_str(), scene.objects[0].pieces()), ("line", 1));
    /// # Ok::<(), rod_files::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the place in the text.
    pub fn parse(file: &Path, text: &str) -> Result<Self, SceneError> {
        let directory = file.parent().unwrap_or(file);
        let source = SourceText::new(file, text);
        let read = |table: Spanned<DeTable<'_>>| {
            let values = table.clone();
            let document = document::document(table)?;
            let tables = Table::deserialize(Deserializer::from(values))?;
            check::scene(stem(file), source, document, tables, directory)
        };
        let (mut scene, warnings) = toml_file::parse_angles(file, text, schema::scene, read)?;
        scene.warnings.extend(warnings);
        Ok(scene)
    }

    /// The file as a table: its quantities are numbers in SI units, angles in degrees, whatever units they are written with.
    pub fn tables(&self) -> &Table {
        &self.tables
    }

    /// The rod, if it is uniform and straight at rest, on a rigid clamp. `instead` ends the message where it is not: what the user may do
    /// with it.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `rod` of another one, at `clamp` or at `clamp.roller`.
    pub fn uniform(&self, instead: &str) -> Result<Rod, SceneError> {
        self.check_rigid(instead)?;
        let other = || self.source.error("rod", &format!("{NOT_UNIFORM}; {instead}"));
        self.rod.uniform().copied().ok_or_else(other)
    }

    /// Refuses a clamp that gives way or has a roller, of whatever rod. `instead` ends the message: what the user may do with it.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `clamp` or `clamp.roller`.
    pub fn check_rigid(&self, instead: &str) -> Result<(), SceneError> {
        self.check_no_roller()?;
        match self.rod.springs() {
            Some(_) => Err(self.source.error("clamp", &format!("{NOT_RIGID}; {instead}"))),
            None => Ok(()),
        }
    }

    /// Refuses a roller.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `clamp.roller`.
    pub fn check_no_roller(&self) -> Result<(), SceneError> {
        match self.rod.roller() {
            Some(_) => Err(self.source.error("clamp.roller", NO_ROLLER)),
            None => Ok(()),
        }
    }

    /// Whether the clamp is outside of all objects in its first pose.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `sweep.from` where it is inside.
    pub fn check_start(&self) -> Result<(), SceneError> {
        let first = self.sweep().ok().and_then(|mut sweep| sweep.next());
        match first {
            Some(Err(stop)) if stop.reason == StopReason::ClampInside => Err(self.source.error(
                "sweep.from",
                "the clamp is inside an object in the first pose, expected a position outside of all objects",
            )),
            _ => Ok(()),
        }
    }

    /// The sweep this scene asks for.
    ///
    /// # Errors
    /// [`ContactError`] where `step` is no step, which [`parse`](Self::parse) has excluded.
    pub fn sweep(&self) -> Result<Sweep<'_, AnyRod>, ContactError> {
        self.on_path().sweep_by(&self.all_legs().map(|leg| leg.step).collect::<Vec<_>>())
    }

    /// What is swept, without the distances of its states.
    pub fn on_path(&self) -> RodOnPath<'_> {
        let legs = self.all_legs().map(|leg| leg.path).collect();
        RodOnPath { rod: &self.rod, objects: &self.objects, legs, friction: self.friction.as_ref() }
    }

    /// The legs of the whole path in order: `path`, and those after it.
    pub fn all_legs(&self) -> impl Iterator<Item = Leg> + '_ {
        let first = Leg { path: LegPath::Straight(self.path), step: self.step };
        std::iter::once(first).chain(self.legs.iter().copied())
    }

    /// Whether the clamp turns without moving on all legs.
    pub fn turns_only(&self) -> bool {
        self.on_path().turns_only()
    }

    /// How many steps the path is long.
    pub fn steps(&self) -> f64 {
        self.all_legs().map(|leg| leg.path.length() / leg.step).sum()
    }

    /// Way along the whole path at a state of its sweep: m, where the clamp moves, plus radians, where it only turns.
    pub fn way(&self, state: &State) -> f64 {
        self.way_at(state.leg, state.pose)
    }

    /// The same at a pose of a leg.
    pub fn way_at(&self, leg: usize, pose: Pose) -> f64 {
        self.way_by(leg, pose, 1.0)
    }

    /// The same in m: where the clamp only turns, the way of the tip of a straight rod.
    pub fn way_in_m(&self, leg: usize, pose: Pose) -> f64 {
        self.way_by(leg, pose, self.rod.length())
    }

    /// Way along the whole path at a pose of a leg, where a radian of a leg on which the clamp only turns counts as `radian`.
    fn way_by(&self, leg: usize, pose: Pose, radian: f64) -> f64 {
        let unit = |path: &LegPath| if path.turns_only() { radian } else { 1.0 };
        let ways =
            self.all_legs().take(leg + 1).enumerate().map(|(number, Leg { path, .. })| {
                unit(&path) * if number < leg { path.length() } else { path.way(pose) }
            });
        ways.sum()
    }

    /// Where its legs end, in m as [`way_in_m`](Self::way_in_m).
    pub fn ends_of_legs(&self) -> Vec<f64> {
        let ends = self.all_legs().map(|leg| leg.path.at(leg.path.length()));
        ends.enumerate().map(|(leg, end)| self.way_in_m(leg, end)).collect()
    }

    /// Poses along the path: the ends of straight legs, and others in between where the clamp goes about a pivot.
    pub fn poses(&self) -> Vec<Pose> {
        let mut poses = vec![self.path.at(0.0)];
        for leg in self.all_legs() {
            let parts = if matches!(leg.path, LegPath::Straight(_)) { 1 } else { PARTS };
            let at = |part: u32| leg.path.at(leg.path.length() * f64::from(part) / f64::from(parts));
            poses.extend((1..=parts).map(at));
        }
        poses
    }

    /// Refuses friction. `instead` ends the message: what the user may do with it.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `contact.friction`.
    pub fn check_no_friction(&self, instead: &str) -> Result<(), SceneError> {
        match self.friction {
            Some(_) => Err(self.source.error("contact.friction", &format!("friction, expected none; {instead}"))),
            None => Ok(()),
        }
    }

    /// Refuses a path of several legs.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `sweep.leg`.
    pub fn check_single_leg(&self) -> Result<(), SceneError> {
        if self.legs.is_empty() {
            return Ok(());
        }
        let message = "several legs, which only `sweep`, `contour`, `study`, `simulate` and `reconstruct --truth` take, expected a path \
                       without [[sweep.leg]]";
        Err(self.source.error("sweep.leg", message))
    }
}

fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}
