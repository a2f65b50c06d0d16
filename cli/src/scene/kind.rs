//! The rods that a scene may have.

use super::Scene;
use super::rod_table::{NO_ROLLER, NOT_RIGID, NOT_UNIFORM};
use crate::SceneError;
use crate::toml_file;
use std::path::{Path, PathBuf};
use vibrissa::rod::{ElasticClamp, Guided, Mounted, PhysicalRod, VaryingRod};
use vibrissa::{ClampPath, Composite, Rod};

/// A rod of a scene.
pub trait SceneRod: PhysicalRod {
    /// The rod, if it is uniform and straight at rest and its clamp is rigid: only of such a rod contacts are found from reactions.
    fn uniform(&self) -> Option<&Rod>;

    /// The springs of its clamp, if that gives way.
    fn springs(&self) -> Option<&ElasticClamp> {
        None
    }

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

    fn springs(&self) -> Option<&ElasticClamp> {
        Some(Mounted::springs(self)).filter(|springs| !springs.is_rigid())
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

impl Scene<Guided<VaryingRod>> {
    /// The error of what does not take a roller.
    pub fn no_roller(&self) -> SceneError {
        self.source.error("clamp.roller", NO_ROLLER)
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

    /// What to call it, as [`Scene::name`].
    pub fn name(&self) -> &str {
        match self {
            Self::Uniform(scene) => &scene.name,
            Self::Mounted(scene) => &scene.name,
            Self::Guided(scene) => &scene.name,
        }
    }

    /// The objects, as [`Scene::objects`].
    pub fn objects(&self) -> &[Composite] {
        match self {
            Self::Uniform(scene) => &scene.objects,
            Self::Mounted(scene) => &scene.objects,
            Self::Guided(scene) => &scene.objects,
        }
    }

    /// The way of the clamp, as [`Scene::path`].
    pub fn path(&self) -> &ClampPath {
        match self {
            Self::Uniform(scene) => &scene.path,
            Self::Mounted(scene) => &scene.path,
            Self::Guided(scene) => &scene.path,
        }
    }

    /// Refuses a path of several legs, as [`Scene::check_single_leg`].
    ///
    /// # Errors
    /// As [`Scene::check_single_leg`].
    pub fn check_single_leg(&self) -> Result<(), SceneError> {
        match self {
            Self::Uniform(scene) => scene.check_single_leg(),
            Self::Mounted(scene) => scene.check_single_leg(),
            Self::Guided(scene) => scene.check_single_leg(),
        }
    }

    /// Whether the clamp is outside of all objects in its first pose, as [`Scene::check_start`].
    ///
    /// # Errors
    /// As [`Scene::check_start`].
    pub fn check_start(&self) -> Result<(), SceneError> {
        match self {
            Self::Uniform(scene) => scene.check_start(),
            Self::Mounted(scene) => scene.check_start(),
            Self::Guided(scene) => scene.check_start(),
        }
    }

    /// Takes the scene whose rod is uniform and straight at rest, on a rigid clamp. `instead` ends the message where it is not: what the
    /// user may do with it.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `rod` of another one, at `clamp` or at `clamp.roller`.
    pub fn uniform(self, instead: &str) -> Result<Scene, SceneError> {
        match self {
            Self::Uniform(scene) => Ok(scene),
            Self::Mounted(scene) if !scene.rod.springs().is_rigid() => {
                Err(scene.source.error("clamp", &format!("{NOT_RIGID}; {instead}")))
            }
            Self::Mounted(scene) => Err(scene.source.error("rod", &format!("{NOT_UNIFORM}; {instead}"))),
            Self::Guided(scene) => Err(scene.no_roller()),
        }
    }

    /// Refuses a clamp that gives way or has a roller, of whatever rod. `instead` ends the message: what the user may do with it.
    ///
    /// # Errors
    /// [`SceneError::Invalid`] at the field `clamp` or `clamp.roller`.
    pub fn check_rigid(&self, instead: &str) -> Result<(), SceneError> {
        match self {
            Self::Mounted(scene) if !scene.rod.springs().is_rigid() => {
                Err(scene.source.error("clamp", &format!("{NOT_RIGID}; {instead}")))
            }
            Self::Guided(scene) => Err(scene.no_roller()),
            _ => Ok(()),
        }
    }
}
