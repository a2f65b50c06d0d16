//! The phases of a scan in order.

use std::fmt;
use vibrissa::contact::{Outcome, Phase};

/// The cycles of Merker et al. (2020), fig. 8a: name and phases.
pub const CYCLES: [(&str, &str); 3] = [("C1", "A B BB B A"), ("C2", "A B BB BA B A"), ("C3", "A B A BA B A")];

/// The phases of a scan in order, from first contact to snap-off.
///
/// Displays as `A B BB BA B A`, or `free` where there was no contact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cycle(Vec<Phase>);

impl Cycle {
    /// The cycle of a sweep. Events within a phase (a contact that passes from one piece to the next, a snap from A to A)
    /// do not show; nor does the free rod before and after.
    pub fn of(outcome: &Outcome) -> Self {
        let start = outcome.states.first().map(|state| state.phase());
        let phases = start.into_iter().chain(outcome.events.iter().flat_map(|event| [event.from(), event.to()]));
        let mut phases: Vec<Phase> = phases.skip_while(|phase| *phase == Phase::FREE).collect();
        phases.dedup();
        if phases.last() == Some(&Phase::FREE) {
            phases.pop();
        }
        Self(phases)
    }

    /// C1, C2 or C3 of Merker et al. (2020), fig. 8a; none for another cycle.
    pub fn name(&self) -> Option<&'static str> {
        let phases = self.to_string();
        CYCLES.iter().find(|(_, cycle)| *cycle == phases).map(|(name, _)| *name)
    }

    /// The phases, and the name if there is one, as in `A B BB B A (cycle C1 of Merker et al. 2020)`.
    pub fn titled(&self) -> String {
        self.name().map_or_else(|| self.to_string(), |name| format!("{self} (cycle {name} of Merker et al. 2020)"))
    }
}

impl fmt::Display for Cycle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.pad("free");
        }
        let names: Vec<String> = self.0.iter().map(Phase::to_string).collect();
        f.pad(&names.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{event, outcome};
    use vibrissa::contact::EventKind::{FirstContact, Piece, Snap, SnapOff};

    #[test]
    fn the_free_ends_and_what_happens_within_a_phase_do_not_show() {
        let cycle = Cycle::of(&outcome(
            &[(0.0, "free")],
            vec![
                event(1.0, "free", "A", FirstContact),
                event(2.0, "A", "A", Piece),
                event(3.0, "A", "BA", Snap),
                event(4.0, "BA", "free", SnapOff),
                event(5.0, "free", "A", FirstContact),
                event(6.0, "A", "free", SnapOff),
            ],
        ));
        assert_eq!(cycle.to_string(), "A BA free A");
        assert_eq!(cycle.name(), None);
    }

    #[test]
    fn cycles_of_the_paper_have_names() {
        let phases = ["A", "B", "BB", "B", "A"];
        let events = phases.windows(2).map(|pair| event(1.0, pair[0], pair[1], Piece)).collect();
        assert_eq!(Cycle::of(&outcome(&[(0.0, "A")], events)).name(), Some("C1"));
        assert_eq!(Cycle::of(&outcome(&[(0.0, "free")], Vec::new())).to_string(), "free");
        assert_eq!(Cycle::of(&outcome(&[(0.0, "B")], Vec::new())).to_string(), "B");
    }
}
