//! Which recordings are made: environment variables.

use super::making::Wrong;
use super::truth::SCENES;
use std::ops::Range;
use std::path::PathBuf;

pub struct Settings {
    pub wrong: Vec<Wrong>,
    pub scenes: Vec<&'static str>,
    pub seeds: Range<u64>,
    pub level: f64,
    pub rate: f64,
    /// Directory that keeps the files of all recordings.
    pub keep: Option<PathBuf>,
}

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// Whether a name contains one of the parts, which are separated by semicolons.
fn is_chosen(name: &str, parts: Option<&str>) -> bool {
    parts.is_none_or(|parts| parts.split(';').any(|part| name.contains(part)))
}

impl Settings {
    pub fn read() -> Self {
        let (only, scenes) = (variable("ONLY"), variable("SCENES"));
        let number = |name: &str, usual: f64| variable(name).map_or(usual, |value| value.parse().unwrap());
        let seeds = variable("SEEDS").unwrap_or_else(|| "0..1".into());
        let (first, end) = seeds.split_once("..").expect("SEEDS=0..4");
        Self {
            wrong: Wrong::all().into_iter().filter(|wrong| is_chosen(&wrong.name(), only.as_deref())).collect(),
            scenes: SCENES.into_iter().filter(|name| is_chosen(name, scenes.as_deref())).collect(),
            seeds: first.parse().unwrap()..end.parse().unwrap(),
            level: number("LEVEL", 1.0),
            rate: number("RATE", 500.0),
            keep: variable("KEEP").map(PathBuf::from),
        }
    }
}
