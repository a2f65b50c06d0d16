//! The command for reactions with poses.

use super::{is_answered, rod, scan, start, tried};
use crate::Setup;
use crate::inspect::InspectOptions;
use crate::inspect::frame::{Before, MARGIN, frame};
use crate::inspect::look::Look;
use crate::inspect::physics::{Reacting, physics, unit_question};
use crate::inspect::proposal::name_of;
use crate::inspect::report::{Certainty, ReadCommand};
use crate::inspect::values::samples;
use vibrissa::hw::recording::Role;

pub(super) fn reactions(look: &mut Look, options: &InspectOptions) -> ReadCommand {
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
