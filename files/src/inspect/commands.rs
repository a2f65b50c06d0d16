//! The command lines that read the files, tried by the readers themselves.

use super::frame::{Before, MARGIN, ReactionFrame, frame};
use super::look::{Content, Look, quoted};
use super::physics::{Reacting, physics, unit_question};
use super::proposal::{Proposal, name_of};
use super::report::{Certainty, InspectedFile, Question, ReadCommand};
use super::setup_text::SetupText;
use super::values::samples;
use super::{InspectOptions, RodInspected};
use crate::film::check_frames;
use crate::{LiveScan, ReadOptions, Setup, StageSpec};
use std::path::Path;
use vibrissa::hw::recording::Role;
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
        let found = match looks[k].content {
            Content::Reactions => Some(reactions(&mut looks[k], options)),
            Content::Wrench | Content::Raw | Content::Topic(_) => {
                let stage = stage_of(looks, k, &stages);
                used.extend(stage);
                sensor(looks, k, stage, options)
            }
            Content::Frames => Some(frames(&mut looks[k], options)),
            Content::Stage | Content::Other => None,
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
    Some(LiveScan { rod, budget, known, setup, stage, path: None, read, inputs: Vec::new() })
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

fn reactions(look: &mut Look, options: &InspectOptions) -> ReadCommand {
    angle(look, options);
    if let Some((table, guess)) = &look.table
        && let Some(samples) = samples(table, guess)
    {
        let columns = [Role::F0x, Role::F0y, Role::M0z].map(|role| guess.of(role));
        if let [Some(x), Some(y), Some(z)] = columns {
            let all = [x, y, z];
            let is_given = |role| guess.of(role).is_some_and(|column| column.is_given);
            let reacting = Reacting {
                names: all.map(|column| name_of(table, column.column)),
                columns: all.map(|column| column.column),
                is_written: all.map(|column| column.is_unit_written),
                is_given: all.iter().all(|column| {
                    let own = &table.columns()[column.column];
                    options.read.options.units.iter().any(|(name, _)| *name == own.name || *name == own.heading)
                }),
                units: all.map(|column| column.unit),
                is_turned: all.map(|column| column.is_turned),
                is_own: all.iter().all(|column| column.is_recognized)
                    || [Role::F0x, Role::F0y, Role::M0z].into_iter().any(is_given),
            };
            let rod = rod(options).map(|rod| &rod.rod);
            physics(&mut look.report, &samples, &reacting, rod, Some(&mut look.proposal));
        }
    }
    let words =
        [start("reconstruct", &look.path, options), look.proposal.layout_words(), look.proposal.words("")].concat();
    let reads = is_answered(&look.report)
        && scan(options, Setup::default(), None, look.proposal.read())
            .is_some_and(|scan| tried(&scan, &look.path, &mut look.report).is_some());
    ReadCommand { words, setup: None, reads }
}

/// Tells radians from degrees by the physics, where the values do not.
fn angle(look: &mut Look, options: &InspectOptions) {
    let Some((table, guess)) = &mut look.table else { return };
    let Some(column) = guess.of(Role::Phi0).filter(|column| column.unit.is_none()).map(|column| column.column) else {
        return;
    };
    let name = name_of(table, column);
    let rod = rod(options).map(|rod| &rod.rod);
    let mut rated = ["rad", "deg"].map(|unit| {
        guess.columns[column].unit = Some(unit);
        let verdict = samples(table, guess).and_then(|samples| frame(&samples, Before { rod, units: [false; 2] }));
        (unit, verdict.filter(|verdict| verdict.is_decided).map_or(0.0, |verdict| verdict.best.score()))
    });
    rated.sort_by(|a, b| b.1.total_cmp(&a.1));
    let [(unit, best), (_, other)] = rated;
    guess.columns[column].unit = None;
    if best - other < MARGIN {
        return;
    }
    guess.columns[column].unit = Some(unit);
    look.proposal.set_unit(&name, unit.to_owned());
    let asked = unit_question(&name);
    look.report.questions.retain(|question| !question.text.starts_with(&asked));
    if let Some(described) = look.report.columns.get_mut(column) {
        described.unit = Some(unit.to_owned());
        described.unit_certainty = Certainty::Likely;
        "the physics of the contacts".clone_into(&mut described.unit_why);
    }
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

/// The stage whose times overlap most with those of a sensor.
fn stage_of(looks: &[Look], sensor: usize, stages: &[usize]) -> Option<usize> {
    let Some([first, last]) = looks[sensor].times() else {
        return stages.first().copied().filter(|_| stages.len() == 1);
    };
    let overlap =
        |stage: usize| looks[stage].times().map_or(f64::NEG_INFINITY, |[from, to]| last.min(to) - first.max(from));
    stages.iter().copied().max_by(|a, b| overlap(*a).total_cmp(&overlap(*b)))
}

const WRENCH: [(Role, &str); 6] =
    [(Role::Fx, "Fx"), (Role::Fy, "Fy"), (Role::Fz, "Fz"), (Role::Tx, "Tx"), (Role::Ty, "Ty"), (Role::Tz, "Tz")];

fn sensor(looks: &mut [Look], k: usize, stage: Option<usize>, options: &InspectOptions) -> Option<ReadCommand> {
    let mut setup = SetupText::default();
    if let Content::Topic(topic) = &looks[k].content {
        setup.topic = Some(topic.clone());
    }
    if looks[k].content == Content::Raw && options.setup.is_none() {
        if looks[k].report.questions.is_empty() {
            looks[k].report.questions.push(Question {
                text: "what makes N and N m of these raw values?".to_owned(),
                answers: vec![
                    "--setup FILE with a calibration or a matrix in [sensor], and columns in [recording]".to_owned(),
                ],
            });
        }
    }
    if looks[k].content == Content::Wrench {
        incomplete(&mut looks[k], &mut setup);
    }
    let mut proposal = looks[k].proposal.clone();
    let (place, spec) = match stage {
        Some(stage) => {
            times(looks, k, stage);
            let path = looks[stage].path.clone();
            let name = path.display().to_string();
            looks[k].report.fact("stage", format!("{name} has the poses of these times"));
            (format!("table:{name}"), Some(StageSpec::Table(path)))
        }
        None => {
            looks[k].report.questions.push(Question {
                text: "where is the clamp at these times?".to_owned(),
                answers: vec!["--stage table:FILE".into(), "--stage constant:SPEED (with --path SCENE)".into()],
            });
            ("table:STAGE.csv".to_owned(), None)
        }
    };
    let of_stage = stage.map(|stage| looks[stage].proposal.clone());
    let is_settled = is_answered(&looks[k].report) && stage.is_none_or(|stage| is_answered(&looks[stage].report));
    let mut reads = false;
    if is_settled {
        let given = || options.setup.as_ref().map(|given| given.1.clone());
        let made = |text: &SetupText| Setup::parse("setup.toml".as_ref(), &text.text()).ok();
        let read = combined(&proposal, of_stage.as_ref());
        let first = given().or_else(|| if setup.is_needed() { made(&setup) } else { Some(Setup::default()) });
        if let Some(found) = first.and_then(|first| scan(options, first, spec.clone(), read.clone())) {
            let samples = tried(&found, &looks[k].path, &mut looks[k].report);
            reads = samples.is_some();
            if let Some(samples) = samples.filter(|_| options.setup.is_none()) {
                let columns = Reacting {
                    names: ["-Fx", "-Fy", "-Tz"].map(str::to_owned),
                    columns: [0; 3],
                    is_written: [true; 3],
                    is_given: false,
                    units: [Some("N"), Some("N"), Some("N m")],
                    is_turned: [false; 3],
                    is_own: false,
                };
                let rod = rod(options).map(|rod| &rod.rod);
                setup.frame = physics(&mut looks[k].report, &samples, &columns, rod, None);
                settle_sense(&mut looks[k].report, setup.frame);
                reads = looks[k].report.questions.is_empty();
            }
        }
    }
    if options.setup.is_some() {
        setup = SetupText::default();
    }
    let mut words = [start("reconstruct", &looks[k].path, options), vec!["--stage".into(), place]].concat();
    let is_made = setup.is_needed() || options.write_setup.is_some();
    match (&options.setup, is_made) {
        (Some((file, _)), _) => words.extend(["--setup".into(), file.display().to_string()]),
        (None, true) => words.extend(["--setup".into(), setup_name(options)]),
        (None, false) => {}
    }
    proposal.units.dedup();
    words.extend(proposal.layout_words());
    words.extend(proposal.words(""));
    words.extend(of_stage.iter().flat_map(|stage| stage.words("stage:")));
    let text = (is_made && options.setup.is_none()).then(|| setup.text());
    Some(ReadCommand { words, setup: text, reads })
}

/// Asks for the frame of a sensor where the physics does not decide it.
fn settle_sense(file: &mut InspectedFile, frame: Option<ReactionFrame>) {
    if frame.is_some() {
        return;
    }
    file.questions.pop();
    file.questions.push(Question {
        text: "along which axes of the scene does the sensor lie, and does it measure loads or reactions?".to_owned(),
        answers: vec![
            "--setup FILE with axes and sense in [mounting]; --write-setup FILE makes one to begin with".to_owned(),
        ],
    });
}

/// The name of the setup file that is made.
fn setup_name(options: &InspectOptions) -> String {
    options.write_setup.as_ref().map_or_else(|| "setup.toml".to_owned(), |file| file.display().to_string())
}

fn combined(sensor: &Proposal, stage: Option<&Proposal>) -> ReadOptions {
    let stage = stage.filter(|stage| !stage.columns.is_empty() || !stage.units.is_empty());
    ReadOptions { stage: stage.map(|stage| Box::new(stage.read())), ..sensor.read() }
}

/// A wrench without some of its components is read as raw values of those that are there.
fn incomplete(look: &mut Look, setup: &mut SetupText) {
    let Some((table, guess)) = &look.table else { return };
    let found: Vec<_> =
        WRENCH.iter().filter_map(|(role, name)| guess.of(*role).map(|column| (*role, *name, column))).collect();
    if found.len() == WRENCH.len() {
        return;
    }
    let missing: Vec<&str> = WRENCH.iter().filter(|(role, _)| guess.of(*role).is_none()).map(|one| one.1).collect();
    let unit = |torque: bool| {
        let of = found.iter().filter(|(role, ..)| (*role as usize >= Role::Tx as usize) == torque);
        of.filter_map(|(_, _, column)| column.unit).next().map(str::to_owned)
    };
    let units = [unit(false).unwrap_or_else(|| "N".to_owned()), unit(true).unwrap_or_else(|| "N m".to_owned())];
    let components = found.iter().map(|(_, name, column)| (*name, name_of(table, column.column))).collect();
    let needed = [Role::Fx, Role::Fy, Role::Tz];
    if !needed.iter().all(|role| guess.of(*role).is_some()) {
        let expected = "at least Fx, Fy and Tz (or the three in the plane of the rod)";
        return look.report.prevents(table.header_line(), missing.join(", "), "no such column", expected);
    }
    look.report.fact(
        "components",
        format!("{} are missing, which a planar rod does not need: the setup says so", missing.join(", ")),
    );
    // as raw values they go by their names, and their units are those of the setup
    look.proposal.columns.retain(|(role, _)| *role == Role::Time);
    let names: Vec<String> = found.iter().map(|(.., column)| name_of(table, column.column)).collect();
    look.proposal.units.retain(|(name, _)| !names.contains(name));
    setup.components = Some((components, units));
}

/// Compares the times of a sensor and of its stage.
fn times(looks: &mut [Look], sensor: usize, stage: usize) {
    let (Some([first, last]), Some([from, to])) = (looks[sensor].times(), looks[stage].times()) else { return };
    let common = (last.min(to) - first.max(from)).max(0.0);
    let part = common / (last - first).max(f64::MIN_POSITIVE);
    let text = format!("{first:.4} to {last:.4} s, the stage {from:.4} to {to:.4} s: {:.0} % in common", 100.0 * part);
    looks[sensor].report.fact("times", text.clone());
    if common <= 0.0 {
        looks[sensor].report.prevents(None, "time", text, "the times of one clock, or times that begin together");
    }
}

fn frames(look: &mut Look, options: &InspectOptions) -> ReadCommand {
    let mut words = start("forces", &look.path, options);
    if let Some((table, guess)) = &look.table {
        let x = table.columns().iter().position(|column| column.name.eq_ignore_ascii_case("x"));
        let size = x.and_then(|x| guess.columns.get(x)).map_or(0.0, |column| column.values.range());
        let unit = x.and_then(|x| guess.columns.get(x)).and_then(|column| column.unit);
        match rod(options).map(|rod| size / rod.rod.length()) {
            Some(lengths) if (50.0..1500.0).contains(&lengths) && unit != Some("m") => {
                look.report.fact(
                    "unit",
                    format!("x spans {size:.4}, {lengths:.0} lengths of the rod in m: it is taken for mm"),
                );
                words.extend(["--scale".into(), "1e-3".into()]);
            }
            Some(lengths) if lengths > 1.5 => look.report.questions.push(Question {
                text: format!("how long is a unit of x and y? x spans {size:.4}"),
                answers: vec!["--scale METRES, as the size of a pixel, of the printed command".into()],
            }),
            None if size > 2.0 => look.report.questions.push(Question {
                text: format!("how long is a unit of x and y? x spans {size:.4}, too far for metres"),
                answers: vec!["--rod FILE compares it with the length of the rod".into()],
            }),
            _ => {}
        }
    }
    let reads = is_answered(&look.report)
        && check_frames(&look.path).map_err(|error| refused(&mut look.report, &error.to_string())).is_ok();
    ReadCommand { words, setup: None, reads }
}
