//! The reference problems: what is given as doubles, what is sought to 30 digits.

use crate::exact::Exact;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use vibrissa::Pose;
use vibrissa::rod::Section;

/// Problems that lose more digits than this, relative changes of results by those of inputs, tell of themselves more than of the
/// method.
const MODERATE: f64 = 100.0;

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Start {
    x: f64,
    y: f64,
    phi: f64,
    kappa: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Force {
    pub a: f64,
    pub b: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct End {
    pub x: Exact,
    pub y: Exact,
    pub phi: Exact,
    pub kappa: Exact,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Placed {
    pub x: f64,
    pub y: f64,
    pub phi: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(tag = "shape", rename_all = "lowercase")]
pub enum Shape {
    Parabola { vertex: [f64; 2], coefficient: f64 },
    Circle { centre: [f64; 2], radius: f64 },
    Line { point: [f64; 2], angle: f64 },
    Vertex { point: [f64; 2] },
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum Holds {
    Tangent,
    Tip,
    Notch,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Touch {
    /// None of a notch, which two supports make.
    pub support: Option<usize>,
    pub hold: Holds,
    #[serde(default)]
    pub turns: i32,
    pub x: Exact,
    pub y: Exact,
    pub alpha: Exact,
    pub force: Exact,
    pub s: Exact,
    pub phi: Exact,
}

#[derive(Clone, Copy, Debug, Deserialize)]
pub struct ClampFeels {
    pub f0x: Exact,
    pub f0y: Exact,
    pub m0z: Exact,
}

/// One file of the reference set; which fields are there depends on its kind.
#[derive(Clone, Debug, Deserialize)]
pub struct Problem {
    pub name: String,
    pub kind: String,
    pub condition: f64,
    pub start: Option<Start>,
    pub force: Option<Force>,
    pub length: Option<f64>,
    pub end: Option<End>,
    pub clamp: Option<Placed>,
    pub motion: Option<Placed>,
    pub tau: Option<Exact>,
    #[serde(default)]
    pub supports: Vec<Shape>,
    #[serde(default)]
    pub contacts: Vec<Touch>,
    pub reactions: Option<ClampFeels>,
}

impl Problem {
    pub fn is_moderate(&self) -> bool {
        self.condition <= MODERATE
    }

    /// The phase, from the clamp to the tip; none of a segment and of a notch.
    pub fn phase(&self) -> Option<String> {
        let letter = |touch: &Touch| match touch.hold {
            Holds::Tangent => Some('B'),
            Holds::Tip => Some('A'),
            Holds::Notch => None,
        };
        let letters: Option<String> = self.contacts.iter().map(letter).collect();
        letters.filter(|letters| self.kind == "contacts" && !letters.is_empty())
    }

    /// The clamp of a problem that has one.
    pub fn pose(&self) -> Pose {
        let Placed { x, y, phi } = self.clamp.unwrap();
        Pose { x, y, phi }
    }

    /// The start of a segment.
    pub fn section(&self) -> Section {
        let Start { x, y, phi, kappa } = self.start.unwrap();
        Section { x, y, phi, kappa }
    }
}

/// Where the reference problems lie.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/problems")
}

/// All reference problems, by name.
pub fn problems() -> Vec<Problem> {
    let folder = folder();
    let files = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut problems: Vec<Problem> = files
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        })
        .collect();
    problems.sort_by(|a, b| a.name.cmp(&b.name));
    problems
}
