//! The file of a study as written.

use serde::Deserialize;
use std::path::PathBuf;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyDocument {
    pub scene: Spanned<PathBuf>,
    pub parameter: Vec<Spanned<ParameterTable>>,
}

/// `[[parameter]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterTable {
    pub name: Spanned<String>,
    pub values: Option<Spanned<Vec<f64>>>,
    pub from: Option<Spanned<f64>>,
    pub to: Option<Spanned<f64>>,
    pub count: Option<Spanned<usize>>,
    pub set: Vec<Spanned<SetTable>>,
}

/// One of `set`: a number of the scene, offset + scale * value.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SetTable {
    pub field: Spanned<String>,
    #[serde(default)]
    pub offset: f64,
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}
