//! The frame of a recording, by the physics, in words and as options.

use super::frame::{Before, FrameVerdict, NEAR, ReactionFrame, SHARE, frame};
use super::proposal::Proposal;
use super::report::{Certainty, InspectedFile, Question};
use vibrissa::hw::recording::Role;
use vibrissa::{Rod, Sample};

/// Relative difference between the stiffness by the recording and that of the rod from which on it is reported.
const STIFFNESS: f64 = 0.03;

/// The columns of the reactions: names, units, whether these are known, whether the names stand for reactions on the rod.
pub(super) struct Reacting {
    pub names: [String; 3],
    /// Their numbers in the table.
    pub columns: [usize; 3],
    /// Whether the file or the user says the units.
    pub is_written: [bool; 3],
    /// Whether the user does.
    pub is_given: bool,
    pub units: [Option<&'static str>; 3],
    pub is_turned: [bool; 3],
    pub is_own: bool,
}

/// Units in which forces and moments are, by what one of them is in N and N m.
fn unit_name(factor: f64, of_force: bool) -> &'static str {
    match (of_force, factor) {
        (true, 1.0) => "N",
        (true, _) => "mN",
        (false, 1.0) => "N m",
        (false, 1e-3) => "N mm",
        (false, _) => "mN mm",
    }
}

/// Tests all frames, says which one the physics prefers, and puts it into the options. Returns the frame where it is decided.
pub(super) fn physics(
    file: &mut InspectedFile,
    samples: &[Sample],
    columns: &Reacting,
    rod: Option<&Rod>,
    proposal: Option<&mut Proposal>,
) -> Option<ReactionFrame> {
    let known = [columns.is_written[0] && columns.is_written[1], columns.is_written[2]];
    let verdict = frame(samples, Before { rod, units: known });
    let names = columns.names.each_ref().map(String::as_str);
    let decided = verdict.filter(|verdict| verdict.is_decided);
    match &verdict {
        None => file.fact("frame", "the physics does not determine axes and signs: too few samples in contact beyond the noise, or no line of tangential contacts"),
        Some(verdict) => {
            if let Some([x, y, z]) = verdict.offset {
                let [a, b, c] = names;
                let found = format!(
                    "{a} {x:.3e}, {b} {y:.3e}, {c} {z:.3e} at the start, where the reactions are constant: the sensor is not tared; subtracted to find the frame, and \
                     estimated by `reconstruct`"
                );
                file.fact("offset", found);
            }
            report_frame(file, verdict, names, rod.is_some());
            if verdict.is_decided {
                stiffness(file, verdict, rod);
            }
        }
    }
    let Some(verdict) = decided else {
        if !columns.is_own {
            ask(file, names);
        }
        return None;
    };
    let best = verdict.best;
    if rod.is_some() && !(known[0] && known[1]) {
        // the stiffness of the rod answers these questions
        let answered: Vec<String> = names.iter().map(|name| unit_question(name)).collect();
        file.questions.retain(|question| !answered.iter().any(|begin| question.text.starts_with(begin)));
    }
    if let Some(proposal) = proposal {
        options(file, proposal, columns, &verdict, rod.is_some());
    }
    if let Some(rod) = rod
        && !(1.0 / NEAR..NEAR).contains(&best.stiffness)
        && !columns.is_given
    {
        file.questions.push(contradiction(columns, &verdict, rod));
    }
    if rod.is_some() && best.units != [1.0; 2] {
        let [force, moment] = [unit_name(best.units[0], true), unit_name(best.units[1], false)];
        file.fact("units", format!("the stiffness of the rod fits forces in {force} and moments in {moment}"));
    }
    Some(best.frame)
}

/// How the question for the unit of a column begins.
pub(super) fn unit_question(name: &str) -> String {
    format!("in which unit is `{name}`?")
}

fn report_frame(file: &mut InspectedFile, verdict: &FrameVerdict, names: [&str; 3], has_rod: bool) {
    let FrameVerdict { best, second, is_decided, .. } = verdict;
    let of = if has_rod { "" } else { ", with stiffness and length as the recording suggests" };
    let agreement = format!(
        "explains {:.0} % of the contact, work and elastic energy correlate by {:+.2}; next {}: {:.0} %, {:+.2}{of}",
        100.0 * best.explained,
        best.energy,
        second.frame.text(names),
        100.0 * second.explained,
        second.energy
    );
    let text = best.frame.text(names);
    let found = match (is_decided, best.frame.is_as_is(), best.frame.is_load()) {
        (false, _, _) => format!("the physics does not determine axes and signs; {text} {agreement}"),
        (true, true, _) => format!("the physics confirms {text}: it {agreement}"),
        (true, _, true) => {
            format!("the columns are loads on the sensor, the opposite of reactions on the rod: {text} {agreement}")
        }
        (true, _, _) => format!("the physics prefers {text}: it {agreement}"),
    };
    file.fact("frame", found);
    if *is_decided && best.explained < SHARE {
        let why = "many samples fit neither contact condition: friction, a rod or clamp of another kind, or reactions with an offset; the frame \
                   follows from the work";
        file.fact("contact", why);
    }
}

fn stiffness(file: &mut InspectedFile, verdict: &FrameVerdict, rod: Option<&Rod>) {
    let Some(rod) = rod else { return };
    let ratio = verdict.best.stiffness;
    if (ratio - 1.0).abs() > STIFFNESS {
        let found = format!(
            "{:.4e} N m^2 by the line of tangential contacts, {ratio:.3} times that of the rod",
            ratio * rod.bending_stiffness()
        );
        file.fact("stiffness", found);
    }
}

/// The question where the units that the file states contradict the rod.
fn contradiction(columns: &Reacting, verdict: &FrameVerdict, rod: &Rod) -> Question {
    let ratio = verdict.best.stiffness;
    let [x, y, z] = &columns.names;
    let stiffness = rod.bending_stiffness();
    Question {
        text: format!(
            "the reactions give {ratio:.3e} times the bending stiffness of the rod ({stiffness:.4e} N m^2): is it another rod, or is a unit wrong? \
             Forces in mN taken for N give 1e-3, moments in N mm taken for N m give 1e6"
        ),
        answers: vec![format!("--unit {x}=... --unit {y}=... --unit {z}=... (unchanged, if the rod is another one)")],
    }
}

/// The question for axes and signs.
fn ask(file: &mut InspectedFile, [x, y, z]: [&str; 3]) {
    file.questions.push(Question {
        text: format!("are `{x}`, `{y}`, `{z}` reactions of the clamp on the rod, along the axes of the poses, or loads on the sensor?"),
        answers: vec![
            format!("reactions: --column f0x={x}"),
            format!("loads: --column f0x={x} --unit {x}=-N (and so on: a minus turns the sign)"),
        ],
    });
}

/// Columns and units as the frame asks for them.
fn options(
    file: &mut InspectedFile,
    proposal: &mut Proposal,
    columns: &Reacting,
    verdict: &FrameVerdict,
    has_rod: bool,
) {
    let best = &verdict.best;
    let [x, y, z] = [0, 1, 2];
    let order = if best.frame.swapped { [y, x, z] } else { [x, y, z] };
    for (meaning, column) in order.into_iter().enumerate() {
        let name = &columns.names[column];
        if best.frame.swapped && meaning < 2 {
            proposal.set_column([Role::F0x, Role::F0y][meaning], name);
        }
        let is_force = meaning < 2;
        let is_by_rod = has_rod && !columns.is_written[column];
        let by_rod = unit_name(best.units[usize::from(!is_force)], is_force);
        let Some(unit) = (if is_by_rod { Some(by_rod) } else { columns.units[column] }) else { continue };
        let is_turned = best.frame.turned[meaning] != columns.is_turned[column];
        // a column that is not what its own name says has no unit without a word
        let is_renamed = best.frame.swapped && is_force;
        let signed = format!("{}{unit}", if is_turned { "-" } else { "" });
        if let Some(described) = file.columns.get_mut(columns.columns[column]) {
            described.meaning = Some(["f0x", "f0y", "m0z"][meaning].to_owned());
            described.unit = Some(signed.clone());
            if is_by_rod && columns.units[column] != Some(by_rod) {
                described.unit_certainty = Certainty::Likely;
                "the stiffness of the rod".clone_into(&mut described.unit_why);
            }
        }
        if is_turned || is_renamed || columns.units[column] != Some(unit) {
            proposal.set_unit(name, signed);
        }
    }
}
