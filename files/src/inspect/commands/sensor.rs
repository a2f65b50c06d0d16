//! The command for a sensor with its stage.

use super::clocks::{CLOCKS, Clocks, stage_delay};
use super::{is_answered, rod, scan, start, tried};
use crate::inspect::InspectOptions;
use crate::inspect::look::{Content, Look};
use crate::inspect::physics::{Measured, Says, Source, physics};
use crate::inspect::proposal::{Proposal, name_of};
use crate::inspect::report::{InspectedFile, Question, ReadCommand};
use crate::inspect::setup_text::{Components, SetupText};
use crate::inspect::stage_log::StageLog;
use crate::inspect::values::channel;
use crate::{ReadOptions, Setup, StageDelay, StageSpec};
use vibrissa::Pose;
use vibrissa::hw::recording::Role;

/// The stage whose times overlap most with those of a sensor.
pub(super) fn stage_of(looks: &[Look], sensor: usize, stages: &[usize]) -> Option<usize> {
    let Some([first, last]) = looks[sensor].times() else {
        return stages.first().copied().filter(|_| stages.len() == 1);
    };
    let overlap =
        |stage: usize| looks[stage].times().map_or(f64::NEG_INFINITY, |[from, to]| last.min(to) - first.max(from));
    stages.iter().copied().max_by(|a, b| overlap(*a).total_cmp(&overlap(*b)))
}

const WRENCH: [(Role, &str); 6] =
    [(Role::Fx, "Fx"), (Role::Fy, "Fy"), (Role::Fz, "Fz"), (Role::Tx, "Tx"), (Role::Ty, "Ty"), (Role::Tz, "Tz")];

pub(super) fn sensor(
    looks: &mut [Look],
    k: usize,
    stage: Option<usize>,
    options: &InspectOptions,
) -> Option<ReadCommand> {
    let mut setup = SetupText::default();
    if let Content::Topic(topic) = &looks[k].content {
        setup.topic = Some(topic.clone());
    }
    let is_scale_missing = looks[k].content == Content::Raw && options.setup.is_none();
    if is_scale_missing && looks[k].report.questions.is_empty() {
        let (which, group) = match looks[k].table {
            Some(_) => ("which calibration converts these raw values", ""),
            None => (
                "which channels of which group are the gauges, and which calibration converts their values",
                "group and ",
            ),
        };
        looks[k].report.questions.push(Question {
            text: format!("{which} to N and N m?"),
            answers: vec![format!(
                "--setup FILE with a calibration or a matrix in [sensor], and {group}columns in [recording]"
            )],
        });
    }
    if looks[k].content == Content::Wrench {
        incomplete(&mut looks[k], &mut setup);
    }
    let mut proposal = looks[k].proposal.clone();
    let (place, spec) = match stage {
        Some(stage) => {
            times(looks, k, stage, stage_delay(options));
            proposal = looks[k].proposal.clone();
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
    let mut of_stage = stage.map(|stage| looks[stage].proposal.clone());
    let is_settled = is_answered(&looks[k].report) && stage.is_none_or(|stage| is_answered(&looks[stage].report));
    let mut reads = false;
    let given = || options.setup.as_ref().map(|given| given.1.clone());
    let made = |text: &SetupText| Setup::parse("setup.toml".as_ref(), &text.text()).ok();
    let first = given().or_else(|| if setup.is_needed() { made(&setup) } else { Some(Setup::default()) });
    let scan = first.and_then(|first| scan(options, first, spec, combined(&proposal, of_stage.as_ref())));
    let clocks = stage.and_then(|stage| Clocks::of(&looks[k], &looks[stage], scan.as_ref(), options));
    if is_settled {
        if let Some(mut found) = scan {
            let columns = stage.and_then(|stage| columns(&looks[stage], options));
            if let (Some(clocks), Some(columns)) = (&clocks, &columns) {
                let log = stage.and_then(|stage| stage_log(&looks[stage]));
                let delay = clocks.compare(&mut looks[k].report, &found, &looks[k].path, log, columns, options);
                found.stage_delay = StageDelay::new(delay).ok();
            }
            let is_asked = !looks[k].report.questions.is_empty();
            let samples = if is_asked && clocks.as_ref().is_some_and(|clocks| !clocks.overlap()) {
                None
            } else {
                tried(&found, &looks[k].path, &mut looks[k].report)
            };
            reads = samples.is_some();
            if let Some(samples) = samples.filter(|_| options.setup.is_none())
                && let (Some(stage), Some(mut columns)) = (stage, columns)
            {
                columns[..3].iter_mut().for_each(|column| column.name = format!("stage:{}", column.name));
                let asked = looks[k].report.questions.len();
                let found =
                    physics(&mut looks[k].report, &samples, &columns, Source::Sensor, rod(options).map(|rod| &rod.rod));
                if let Some(found) = found {
                    columns[..3].iter_mut().for_each(|column| column.name = column.name.replacen("stage:", "", 1));
                    let stage = &mut looks[stage];
                    found.apply(&mut stage.report, &mut stage.proposal, &columns, &samples, 0..3);
                    of_stage = Some(stage.proposal.clone());
                    setup.frame = Some(found.frame);
                } else if is_asked && clocks.as_ref().is_some_and(|clocks| !clocks.are_alike()) {
                    // wrong poses may be why no frame fits: the clocks first
                    looks[k].report.questions.truncate(asked);
                } else {
                    settle_sense(&mut looks[k].report);
                }
                reads = is_answered(&looks[k].report);
            }
        }
    } else if let Some(clocks) = &clocks {
        clocks.ask_without_physics(&mut looks[k].report, options);
    }
    if let Some(stage) = stage {
        ask_speed(&mut looks[stage]);
        reads &= is_answered(&looks[stage].report);
    }
    if options.setup.is_some() {
        setup = SetupText::default();
    }
    let mut words = [start("reconstruct", &looks[k].path, options), vec!["--stage".into(), place]].concat();
    if let Some(delay) = options.stage_delay.filter(|_| stage.is_some()) {
        words.extend(["--stage-delay".into(), delay.to_string()]);
    }
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

/// The columns of the poses, and the reactions that a sensor in the axes of the scene has.
fn columns(stage: &Look, options: &InspectOptions) -> Option<[Measured; 6]> {
    let reaction = |(role, name, unit): (Role, &str, &'static str)| Measured {
        role,
        name: name.to_owned(),
        column: 0,
        unit: Some(unit),
        is_turned: false,
        says: Says::File,
    };
    let [x, y, phi] = [Role::X0, Role::Y0, Role::Phi0].map(|role| stage.measured(role, options));
    let [fx, fy, mz] = [(Role::F0x, "-Fx", "N"), (Role::F0y, "-Fy", "N"), (Role::M0z, "-Tz", "N m")].map(reaction);
    Some([x?, y?, phi?, fx, fy, mz])
}

/// The poses of a stage with their times.
fn stage_log(stage: &Look) -> Option<StageLog> {
    let (table, guess) = stage.table.as_ref()?;
    let [t, x, y, phi] = [Role::Time, Role::X0, Role::Y0, Role::Phi0].map(|role| channel(table, guess, role));
    let (t, x, y, phi) = (t?, x?, y?, phi?);
    let rows = (0..t.len()).map(|k| (t[k], Pose { x: x[k], y: y[k], phi: phi[k] }));
    let is_finite = |(t, pose): &(f64, Pose)| [*t, pose.x, pose.y, pose.phi].iter().all(|value| value.is_finite());
    let mut rows: Vec<(f64, Pose)> = rows.filter(is_finite).collect();
    // a row that is there twice says nothing else
    rows.dedup();
    StageLog::new(rows)
}

/// Asks whether the clamp moves evenly where only the ends of its motion are known.
fn ask_speed(stage: &mut Look) {
    let Some(log) = stage_log(stage) else { return };
    let Some(([from, to], _)) = log.motion() else { return };
    let within = log.rows().iter().filter(|row| from < row.0 && row.0 < to).count();
    if within > 0 {
        return;
    }
    let middle = 0.5 * (from + to);
    let Pose { x, y, phi } = log.at(middle);
    let text = format!(
        "is the speed of the clamp constant from {from} to {to} s? The file has only the two ends of this motion, and the poses between are taken to be \
         evenly apart"
    );
    let answers = vec![
        format!(
            "if it is: a row in the middle, at {middle} s with x0 = {:.4} mm, y0 = {:.4} mm, phi0 = {:.4} degrees, states it",
            1e3 * x,
            1e3 * y,
            phi.to_degrees()
        ),
        "if it is not: a row wherever the speed changes, or the positions as the stage logs them".to_owned(),
    ];
    stage.report.questions.push(Question { text, answers });
}

/// Asks for the frame of a sensor where the physics does not decide it.
fn settle_sense(file: &mut InspectedFile) {
    let answer =
        "--setup FILE with axes and sense in [mounting]; --write-setup FILE makes one to begin with".to_owned();
    // that of the clocks is not of the frame
    let Some(asked) = file.questions.pop_if(|question| !question.text.starts_with(CLOCKS)) else { return };
    let text = format!("along which axes of the scene does the sensor lie, and is it load or reaction? {}", asked.text);
    // options for columns of the sensor would name components; those of the stage are options as they are
    let of_stage = asked.answers.into_iter().filter(|answer| answer.contains("stage:"));
    file.questions.push(Question { text, answers: [vec![answer], of_stage.collect()].concat() });
}

/// The name of the setup file that is made.
fn setup_name(options: &InspectOptions) -> String {
    options.write_setup.as_ref().map_or_else(|| "setup.toml".to_owned(), |file| file.display().to_string())
}

fn combined(sensor: &Proposal, stage: Option<&Proposal>) -> ReadOptions {
    let says =
        |stage: &&Proposal| !(stage.columns.is_empty() && stage.units.is_empty() && stage.layout.constants.is_empty());
    let stage = stage.filter(says);
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
    let columns = found.iter().map(|(_, name, column)| (*name, name_of(table, column.column))).collect();
    let needed = [Role::Fx, Role::Fy, Role::Tz];
    if !needed.iter().all(|role| guess.of(*role).is_some()) {
        let expected = "at least Fx, Fy and Tz (or the three in the plane of the rod)";
        return look.report.prevents(table.header_line(), missing.join(", "), "no such column", expected);
    }
    look.report.fact(
        "components",
        format!("{} are missing; a planar rod does not need them, and the setup is without them", missing.join(", ")),
    );
    // as raw values they go by their names, and their units are those of the setup
    look.proposal.columns.retain(|(role, _)| *role == Role::Time);
    let names: Vec<String> = found.iter().map(|(.., column)| name_of(table, column.column)).collect();
    look.proposal.units.retain(|(name, _)| !names.contains(name));
    setup.components = Some(Components { columns, units });
}

/// Compares the times of a sensor and of its stage. Where a unit is not written, it is the one with the longest common part.
fn times(looks: &mut [Look], sensor: usize, stage: usize, delay: Option<StageDelay>) {
    let units = |k: usize| looks[k].time_units();
    let both = || units(sensor).into_iter().flat_map(|a| units(stage).into_iter().map(move |b| (a, b)));
    let common = |a: &'static str, b: &'static str| {
        let ([first, last], [from, to]) = (looks[sensor].times_in(a)?, looks[stage].times_in(b)?);
        let part = |part: f64, of: f64| part / of.max(f64::MIN_POSITIVE);
        let common = part(last.min(to) - first.max(from), last.max(to) - first.min(from));
        // clocks that begin at different times: durations that are alike
        let (long, short) = ((last - first).max(to - from), (last - first).min(to - from));
        Some(if common > 0.0 { common } else { 0.1 * part(short, long) - 0.1 })
    };
    let rated = both().filter_map(|(a, b)| Some((a, b, common(a, b)?)));
    // the first of those that are alike: the guesses of both, or SI
    let best = rated.reduce(|best, other| if other.2 > best.2 + 0.1 { other } else { best });
    if let Some((of_sensor, of_stage, _)) = best {
        looks[sensor].set_time_unit(of_sensor);
        looks[stage].set_time_unit(of_stage);
    }
    let (Some([first, last]), Some([from, to])) = (looks[sensor].times(), looks[stage].times()) else { return };
    let delay = delay.map_or(0.0, StageDelay::seconds);
    let (from, to) = (from + delay, to + delay);
    let common = (last.min(to) - first.max(from)).max(0.0);
    let part = common / (last - first).max(f64::MIN_POSITIVE);
    let delayed = if delay == 0.0 { String::new() } else { format!(", delayed by {delay} s,") };
    let text = format!(
        "{first:.4} to {last:.4} s, the stage{delayed} {from:.4} to {to:.4} s: {:.0} % in common",
        100.0 * part
    );
    looks[sensor].report.fact("times", text);
}
