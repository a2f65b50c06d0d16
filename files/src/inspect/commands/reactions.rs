//! The command for reactions with poses.

use super::{is_answered, rod, scan, start, tried};
use crate::Setup;
use crate::inspect::InspectOptions;
use crate::inspect::look::{FEWEST, Look};
use crate::inspect::physics::{Source, physics};
use crate::inspect::report::ReadCommand;
use crate::inspect::values::samples;
use vibrissa::hw::recording::Role;

pub(super) fn reactions(look: &mut Look, options: &InspectOptions) -> ReadCommand {
    const ROLES: [Role; 6] = [Role::X0, Role::Y0, Role::Phi0, Role::F0x, Role::F0y, Role::M0z];
    if let Some((table, guess)) = &look.table
        && table.len() >= FEWEST
        && let Some(samples) = samples(table, guess)
        && let [Some(x), Some(y), Some(phi), Some(fx), Some(fy), Some(mz)] =
            ROLES.map(|role| look.measured(role, options))
    {
        let columns = [x, y, phi, fx, fy, mz];
        let reactions = || ROLES[3..].iter().filter_map(|role| guess.of(*role));
        let is_own = reactions().all(|column| column.is_recognized) || reactions().any(|column| column.is_given);
        let source = if is_own { Source::OwnNames } else { Source::OtherNames };
        let found = physics(&mut look.report, &samples, &columns, source, rod(options).map(|rod| &rod.rod));
        if let Some(found) = found {
            found.apply(&mut look.report, &mut look.proposal, &columns, &samples, 0..6);
        }
    }
    let words =
        [start("reconstruct", &look.path, options), look.proposal.layout_words(), look.proposal.words("")].concat();
    let reads = is_answered(&look.report)
        && scan(options, Setup::default(), None, look.proposal.read())
            .is_some_and(|scan| tried(&scan, &look.path, &mut look.report).is_some());
    ReadCommand { words, setup: None, reads }
}
