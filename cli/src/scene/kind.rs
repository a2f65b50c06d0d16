//! The rods that a scene may have.

use super::Scene;
use super::rod_table::{NO_ROLLER, NOT_RIGID, NOT_UNIFORM};
use crate::SceneError;
use crate::toml_file;
use std::path::{Path, PathBuf};
use vibrissa::Rod;
use vibrissa::rod::{Guided, Mounted, PhysicalRod, VaryingRod};

/// A rod of a scene.
pub trait SceneRod: PhysicalRod {
    /// The rod, if it is uniform and straight at rest and its clamp is rigid: only of such a rod contacts are found from reactions.
    fn uniform(&self) -> Option<&Rod>;

    /// Whether it runs through a roller, whose reaction is measured as well.
    fn has_roller(&self) -> bool {
        false
    }
}

impl SceneRod for Rod {
    fn uniform(&self) -> Option<&Rod> {
        Some(self)
    }
}

impl SceneRod for Mounted<VaryingRod> {
    fn uniform(&self) -> Option<&Rod> {
        None
    }
}

impl SceneRod for Guided<VaryingRod> {
    fn uniform(&self) -> Option<&Rod> {
        None
    }

    fn has_roller(&self) -> bool {
        true
    }
}

/// A rod of either kind.
#[derive(Clone, Debug)]
pub enum AnyRod {
    /// Uniform, straight at rest, and clamped rigidly.
    Uniform(Rod),
    /// Its stiffness varies, it is bent at rest, or its clamp gives way.
    Mounted(Mounted<VaryingRod>),
}

impl AnyRod {
    /// Length, m.
    pub fn length(&self) -> f64 {
        match self {
            Self::Uniform(rod) => rod.length(),
            Self::Mounted(rod) => rod.rod().length(),
        }
    }
}

/// A scene with any rod.
#[derive(Debug)]
pub enum AnyScene {
    /// The rod is uniform, straight at rest, and clamped rigidly.
    Uniform(Scene),
    /// Its stiffness varies, it is bent at rest, or its clamp gives way.
    Mounted(Scene<Mounted<VaryingRod>>),
    /// Any rod that runs through a roller ahead of a rigid clamp.
    Guided(Scene<Guided<VaryingRod>>),
}

impl AnyScene {
    /// The scene in a file, as [`Scene::read`].
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn read(file: &Path) -> Result<Self, SceneError> {
        Self::parse(file, &toml_file::text("the scene", file)?)
    }

    /// The scene in a text, as [`Scene::parse`].
    ///
    /// ```
    /// use vibrissa_cli::AnyScene;
    /// let scene = AnyScene::parse("whisker.toml".as_ref(), r#"
    ///     [rod]
    ///     length = 0.04
    ///     diameter = 1e-4
    ///     tip_diameter = 2e-5
    ///     youngs_modulus = 3e9
    ///     natural_curvature = 20.0
    ///     [[contour.piece]]
    ///     shape = "parabola"
    ///     vertex = [0.0, 0.02]
    ///     coefficient = 0.0
    ///     [sweep]
    ///     from = [0.0, -0.03]
    ///     to = [0.0, 0.01]
    ///     angle = 45.0
    ///     step = 1e-3
    /// "#)?;
    /// assert!(matches!(scene, AnyScene::Mounted(_)));
    /// # Ok::<(), vibrissa_cli::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn parse(file: &Path, text: &str) -> Result<Self, SceneError> {
        super::parse(file, text)
    }

    /// What may be a mistake in the file, as [`Scene::warnings`].
    pub fn warnings(&self) -> &[String] {
        match self {
            Self::Uniform(scene) => &scene.warnings,
            Self::Mounted(scene) => &scene.warnings,
            Self::Guided(scene) => &scene.warnings,
        }
    }

    /// The files of the scene, as [`Scene::files`].
    pub fn files(&self) -> &[PathBuf] {
        match self {
            Self::Uniform(scene) => &scene.files,
            Self::Mounted(scene) => &scene.files,
            Self::Guided(scene) => &scene.files,
        }
    }

    /// Takes the scene whose rod is uniform and straight at rest, on a rigid clamp.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `rod` of another one, at `clamp` or at `clamp.roller`.
    pub fn uniform(self) -> Result<Scene, SceneError> {
        match self {
            Self::Uniform(scene) => Ok(scene),
            Self::Mounted(scene) if !scene.rod.springs().is_rigid() => Err(scene.source.error("clamp", NOT_RIGID)),
            Self::Mounted(scene) => Err(scene.source.error("rod", NOT_UNIFORM)),
            Self::Guided(scene) => Err(scene.source.error("clamp.roller", NO_ROLLER)),
        }
    }
}
