//! The frame of a recording, by the physics, in words and as options.

use super::frame::{Before, FrameVerdict, ReactionFrame, SHARE, frame};
use super::proposal::Proposal;
use super::report::{InspectedFile, Question};
use vibrissa::hw::recording::Role;
use vibrissa::{Rod, Sample};

/// Relative difference of the stiffness that is told.
const STIFFNESS: f64 = 0.03;

/// The columns of the reactions: names, units, whether these are known, whether the names stand for reactions on the rod.
pub(super) struct Reacting {
    pub names: [String; 3],
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
    let known = [columns.units[0].is_some() && columns.units[1].is_some(), columns.units[2].is_some()];
    let verdict = frame(samples, Before { rod, units: known });
    let names = columns.names.each_ref().map(String::as_str);
    let decided = verdict.filter(|verdict| verdict.is_decided);
    match &verdict {
        None => file.fact("frame", "the physics cannot tell axes and signs: too few samples in contact beyond the noise, or no line of tangential contacts"),
        Some(verdict) => {
            if let Some([x, y, z]) = verdict.offset {
                let [a, b, c] = names;
                let found = format!(
                    "{a} {x:.3e}, {b} {y:.3e}, {c} {z:.3e} at the start, where nothing changes: not tared; subtracted for the frame, and \
                     estimated by `reconstruct`"
                );
                file.fact("offset", found);
            }
            tell(file, verdict, names, rod.is_some());
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
        // they are told by the physics now
        let told: Vec<String> = names.iter().map(|name| unit_question(name)).collect();
        file.questions.retain(|question| !told.iter().any(|told| question.text.starts_with(told)));
    }
    if let Some(proposal) = proposal {
        options(proposal, columns, &verdict, rod.is_some());
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

fn tell(file: &mut InspectedFile, verdict: &FrameVerdict, names: [&str; 3], has_rod: bool) {
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
        (false, _, _) => format!("the physics cannot tell axes and signs; {text} {agreement}"),
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
fn options(proposal: &mut Proposal, columns: &Reacting, verdict: &FrameVerdict, has_rod: bool) {
    let best = &verdict.best;
    let [x, y, z] = [0, 1, 2];
    let order = if best.frame.swapped { [y, x, z] } else { [x, y, z] };
    for (meaning, column) in order.into_iter().enumerate() {
        let name = &columns.names[column];
        if best.frame.swapped && meaning < 2 {
            proposal.set_column([Role::F0x, Role::F0y][meaning], name);
        }
        let is_force = meaning < 2;
        let factor = best.units[usize::from(!is_force)];
        let unit = match columns.units[column] {
            Some(unit) => Some(unit),
            None if has_rod => Some(unit_name(factor, is_force)),
            None => None,
        };
        let turned = best.frame.turned[meaning] != columns.is_turned[column];
        let Some(unit) = unit else { continue };
        // a column that is not what its own name says has no unit without a word
        let is_renamed = best.frame.swapped && is_force;
        if turned || is_renamed || columns.units[column].is_none() {
            proposal.set_unit(name, format!("{}{unit}", if turned { "-" } else { "" }));
        }
    }
}
