//! The scenes of a study.

use super::document::{StudyDocument, StudyError};
use super::parameter::Parameter;
use super::row::StudyRow;
use crate::toml_file::{self, Fault};
use crate::{Scene, SceneError};
use serde::Deserialize;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use toml::Table;
use toml::de::Deserializer;

/// Most scenes of a study.
const MOST: usize = 10_000_000;

/// A scene and the values that some of its numbers take: every combination of them is a scene, and the last parameter
/// changes fastest. Read from a TOML file:
///
/// ```toml
/// scene = "O1_q40.toml"   # relative to this file
///
/// [[parameter]]
/// name = "distance"       # the column of its values
/// from = 0.1              # or values = [0.1, 0.5, 0.9]
/// to = 0.9
/// count = 9
/// set = [                 # numbers of the scene: offset + scale * value
///     { field = "sweep.from[2]", scale = -0.1 },
///     { field = "sweep.to[2]", scale = -0.1 },
/// ]
/// ```
///
/// Fields have the names that messages on scene files use, counted from 1. Where several parameters set one field, their
/// contributions add.
#[derive(Debug)]
pub struct Study {
    /// The file of the scene.
    pub scene: PathBuf,
    /// Its text, and that of the study: a run goes on only with the same ones.
    pub(super) texts: [String; 2],
    table: Table,
    pub(super) parameters: Vec<Parameter>,
}

impl Study {
    /// The study in a file.
    ///
    /// # Errors
    /// [`SceneError`]: the file or that of its scene cannot be read, or is none. Whether the scenes with changed numbers are
    /// scenes is seen when they are swept.
    pub fn read(file: &Path) -> Result<Self, SceneError> {
        let text = toml_file::text("the study", file)?;
        let mut scene = PathBuf::new();
        let parameters = toml_file::parse(file, &text, |table| {
            let document = StudyDocument::deserialize(Deserializer::from(table))?;
            scene = file.parent().unwrap_or(Path::new("")).join(document.scene.get_ref());
            if let Err(error) = std::fs::metadata(&scene) {
                return Err(Fault::new(document.scene.span(), format!("the scene {}: {error}", scene.display())));
            }
            let parameters: Vec<_> = document.parameter.iter().map(Parameter::new).collect::<Result<_, _>>()?;
            let mut names = HashSet::new();
            for (table, parameter) in document.parameter.iter().zip(&parameters) {
                if !names.insert(parameter.name.clone()) || StudyRow::COLUMNS.contains(&parameter.name.as_str()) {
                    let message = format!(
                        "the name {:?} is that of another parameter or of a column of the results, expected another one",
                        parameter.name
                    );
                    return Err(Fault::new(table.get_ref().name.span(), message));
                }
            }
            let count = parameters.iter().try_fold(1_usize, |count, one| count.checked_mul(one.values.len()));
            if count.is_none_or(|count| count > MOST) {
                return Err(Fault::new(0..0, format!("more than {MOST} combinations of values, expected fewer")));
            }
            Ok(parameters)
        })?;
        let of_scene = toml_file::text("the scene", &scene)?;
        // told with its place there, before anything is changed
        let table = Scene::parse(&scene, &of_scene)?.tables().clone();
        let study = Self { scene, texts: [text, of_scene], table, parameters };
        study.check_fields(file)?;
        Ok(study)
    }

    /// Whether the scene has the fields.
    fn check_fields(&self, file: &Path) -> Result<(), SceneError> {
        toml_file::parse(file, &self.texts[0], |table| {
            let document = StudyDocument::deserialize(Deserializer::from(table))?;
            for (table, parameter) in document.parameter.iter().zip(&self.parameters) {
                for (written, set) in table.get_ref().set.iter().zip(&parameter.set) {
                    let wrong = |message: String| {
                        let field = &written.get_ref().field;
                        Fault::new(field.span(), format!("{}: {message}", field.get_ref()))
                    };
                    set.field.set(&mut self.table.clone(), 0.0).map_err(wrong)?;
                }
            }
            Ok(())
        })
    }

    /// How many scenes it has.
    pub fn count(&self) -> usize {
        self.parameters.iter().map(|parameter| parameter.values.len()).product()
    }

    /// The names of the parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters.iter().map(|parameter| parameter.name.as_str())
    }

    /// The values of the parameters in a scene, from 0.
    pub fn values(&self, mut number: usize) -> Vec<f64> {
        let fastest_first = self.parameters.iter().rev().map(|parameter| {
            let value = parameter.values[number % parameter.values.len()];
            number /= parameter.values.len();
            value
        });
        let mut values: Vec<f64> = fastest_first.collect();
        values.reverse();
        values
    }

    /// A scene as a scene file, by its number from 0. Files that it names are relative to the study's scene.
    ///
    /// # Errors
    /// [`StudyError::NoScene`].
    pub fn text(&self, number: usize) -> Result<String, StudyError> {
        let count = self.count();
        if number >= count {
            return Err(StudyError::NoScene { number, last: count - 1 });
        }
        self.scene_text(number).map_err(|reason| StudyError::Field { number, reason })
    }

    fn scene_text(&self, number: usize) -> Result<String, String> {
        let mut table = self.table.clone();
        let values = self.values(number);
        let sets =
            || self.parameters.iter().zip(&values).flat_map(|(one, value)| one.set.iter().map(move |set| (set, value)));
        for (set, _) in sets() {
            let same = sets().filter(|(other, _)| other.field == set.field);
            set.field.set(&mut table, same.map(|(set, value)| set.offset + set.scale * value).sum())?;
        }
        toml::to_string(&table).map_err(|error| error.to_string())
    }

    /// Sweeps a scene, from 0, and measures it.
    pub fn row(&self, number: usize) -> StudyRow {
        let values = self.values(number);
        match self.scene_text(number) {
            Ok(text) => StudyRow::sweep(number, values, &self.scene, &text),
            Err(reason) => StudyRow::without_scene(number, values, reason),
        }
    }
}
