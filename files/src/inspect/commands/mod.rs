//! The command lines that read the files, tried by the readers themselves: of `reactions` with poses, of a `sensor` with its stage, whose
//! clocks `clocks` compares, of `frames` of points.

mod clocks;
mod frames;
mod reactions;
mod sensor;

use super::look::{Content, Look};
use super::report::{InspectedFile, Question, ReadCommand};
use super::shell_word::quoted;
use super::{InspectOptions, RodInspected};
use crate::{LiveScan, ReadOptions, Setup, StageSpec};
use frames::frames;
use reactions::reactions;
use sensor::{sensor, stage_of};
use std::path::Path;
use vibrissa::reconstruct::{Budget, Known};
use vibrissa::{Rod, Sample};

/// What stands for a rod that is not given.
const ROD: &str = "ROD.toml";
/// A rod for readers that need one, where none is given: that of Merker et al. (2020).
const USUAL: (f64, f64) = (0.1, 6.32e-4);

/// The commands for all files; what speaks against them is put into the reports.
pub(super) fn commands(looks: &mut [Look], options: &InspectOptions) -> Vec<ReadCommand> {
    let mut commands = Vec::new();
    let stages: Vec<usize> = (0..looks.len()).filter(|k| looks[*k].content == Content::Stage).collect();
    let mut used = Vec::new();
    for k in 0..looks.len() {
        if let Content::Tracked(tracked) = &looks[k].content {
            let file = rod(options).map_or_else(|| ROD.to_owned(), |rod| rod.file.display().to_string());
            let found = tracked.commands(&looks[k].path, &file);
            commands.extend(found.map(|words| ReadCommand { words, setup: None, reads: false }));
        }
        let found = match looks[k].content {
            Content::Reactions => Some(reactions(&mut looks[k], options)),
            Content::Wrench | Content::Raw | Content::Topic(_) => {
                let stage = stage_of(looks, k, &stages);
                used.extend(stage);
                sensor(looks, k, stage, options)
            }
            Content::Frames => Some(frames(&mut looks[k], options)),
            Content::Stage | Content::Tracked(_) | Content::Other => None,
        };
        commands.extend(found);
    }
    for k in stages.into_iter().filter(|k| !used.contains(k)) {
        let name = looks[k].path.display().to_string();
        looks[k].report.questions.push(Question {
            text: "which recording of a sensor belongs to this stage?".to_owned(),
            answers: vec![format!("vibrissa inspect SENSOR {}", quoted(&name))],
        });
    }
    commands
}

fn rod(options: &InspectOptions) -> Option<&RodInspected> {
    options.rod.as_ref()
}

fn start(command: &str, file: &Path, options: &InspectOptions) -> Vec<String> {
    let rod = rod(options).map_or_else(|| ROD.to_owned(), |rod| rod.file.display().to_string());
    vec!["vibrissa".into(), command.into(), file.display().to_string(), "--rod".into(), rod]
}

/// A scan for the readers.
fn scan(options: &InspectOptions, setup: Setup, stage: Option<StageSpec>, read: ReadOptions) -> Option<LiveScan> {
    let rod = match rod(options) {
        Some(rod) => rod.rod,
        None => Rod::new(USUAL.0, USUAL.1).ok()?,
    };
    let (budget, known) = (Budget::laboratory(&rod), Known::NOTHING);
    Some(LiveScan {
        rod,
        budget,
        known,
        setup,
        stage,
        stage_delay: options.stage_delay,
        path: None,
        read,
        inputs: Vec::new(),
    })
}

/// Puts what a reader says into the report.
fn refused(file: &mut InspectedFile, message: &str) {
    // it names the file, which the report does already
    let text = message.strip_prefix(&file.file).map_or(message, |rest| rest.trim_start_matches([':', ' ']));
    let (line, text) = match text.split_once(": ") {
        Some((line, rest)) if line.parse::<u64>().is_ok() => (line.parse().ok(), rest),
        _ => (None, text),
    };
    let (value, expected) = text.split_once("expected ").unwrap_or((text, "a file that is read"));
    let value = value.trim_end_matches([',', ' ', ';']);
    file.prevents(line, "reading", value, expected);
}

fn is_answered(file: &InspectedFile) -> bool {
    file.questions.is_empty() && file.faults.iter().all(|fault| !fault.prevents)
}

/// The samples that the reader finds; what it refuses is put into the report.
fn tried(scan: &LiveScan, path: &Path, file: &mut InspectedFile) -> Option<Vec<Sample>> {
    match scan.recording(path) {
        Ok(recording) => {
            for warning in recording.warnings().iter().filter(|warning| warning.contains("cannot be used")) {
                let text = warning.split_once(": ").map_or(warning.as_str(), |(_, text)| text);
                file.fact("left out", text);
            }
            Some(recording.samples().copied().collect())
        }
        Err(error) => {
            refused(file, &error.to_string());
            None
        }
    }
}
