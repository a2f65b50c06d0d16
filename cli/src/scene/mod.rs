//! Scenes: a rod, objects and the way the clamp goes, read from a TOML file.
//!
//! Four steps, one file each: `document` is the file as written, `shape` its pieces of contour, `object` puts these
//! together and where they stand, and `check` turns the rest into what the library takes. Whatever is wrong becomes a
//! [`SceneError`] that points into the file.

mod check;
mod document;
mod files;
mod known_rod;
mod object;
mod plausible;
mod rod;
mod shape;

pub(crate) use check::MOST_STATES;
pub(crate) use known_rod::written;
pub use known_rod::{KnownRod, read_known_rod};
pub use rod::read_rod;

use crate::SceneError;
use crate::toml_file::{self, Source};
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::DeTable;
use vibrissa::contact::{ContactError, StopReason};
use vibrissa::{ClampPath, Composite, Rod, Sweep};

/// A rod swept along a contour.
#[derive(Debug)]
pub struct Scene {
    /// What to call it: the file's name without its extension.
    pub name: String,
    /// The rod.
    pub rod: Rod,
    /// The objects, coordinates in m.
    pub objects: Vec<Composite>,
    /// The way of the clamp.
    pub path: ClampPath,
    /// Distance between reported states: m, or radians where the clamp only turns.
    pub step: f64,
    /// What may be a mistake in the file: a rod of implausible size or stiffness, angles that look like radians where degrees
    /// belong, or the other way round.
    pub warnings: Vec<String>,
    /// The file of the scene, and those that it names.
    pub files: Vec<PathBuf>,
    source: Source,
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
    /// use vibrissa_cli::Scene;
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
    /// # Ok::<(), vibrissa_cli::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// [`SceneError::Invalid`] with the place in the text.
    pub fn parse(file: &Path, text: &str) -> Result<Self, SceneError> {
        let directory = file.parent().unwrap_or(file);
        let source = Source::new(file, text);
        let read =
            |table: Spanned<DeTable<'_>>| check::scene(stem(file), source, document::document(table)?, directory);
        let (scene, warnings) = toml_file::parse_angles(file, text, read)?;
        Ok(Self { warnings: [scene.warnings, warnings].concat(), ..scene })
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
    pub fn sweep(&self) -> Result<Sweep<'_>, ContactError> {
        Sweep::new(&self.rod, &self.objects, self.path, self.step)
    }
}

fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}
