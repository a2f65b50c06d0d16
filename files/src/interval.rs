//! A scan cut at its transitions.

use vibrissa::contact::{EventKind, Outcome, Phase};
use vibrissa::{ClampPath, Event, Pose, State};

/// A part of a scan between two transitions.
#[derive(Clone, Debug)]
pub struct Interval<'a> {
    /// The phase all along.
    pub phase: Phase,
    /// Where the clamp was at its first state.
    pub from: Pose,
    /// Where the clamp was at its last state.
    pub to: Pose,
    /// What ended it; none for the last one.
    pub end: Option<EventKind>,
    /// Its states in order, those at the two transitions included.
    pub states: Vec<&'a State>,
}

impl<'a> Interval<'a> {
    /// An interval of these states; none of no states.
    fn of(states: Vec<&'a State>, end: Option<EventKind>) -> Option<Self> {
        let (first, last) = (states.first()?, states.last()?);
        Some(Self { phase: last.phase(), from: first.pose, to: last.pose, end, states })
    }

    /// The state in the middle.
    pub fn middle(&self) -> Option<&'a State> {
        self.states.get(self.states.len() / 2).copied()
    }
}

/// Way along the path at a pose on it: m, or radians where the clamp only turns.
pub(crate) fn way(path: &ClampPath, pose: Pose) -> f64 {
    let (start, rate) = (path.at(0.0), path.rate());
    if path.turns_only() {
        (pose.phi - start.phi) * rate.phi
    } else {
        (pose.x - start.x) * rate.x + (pose.y - start.y) * rate.y
    }
}

/// Whether a transition separates two parts of a scan: the phase changes, or the shape jumps.
fn separates(event: &Event) -> bool {
    event.from() != event.to() || matches!(event.kind, EventKind::Snap | EventKind::SnapOff)
}

/// The parts of a scan between transitions, in order, by the way along its path at a state.
pub fn intervals(way: impl Fn(&State) -> f64, outcome: &Outcome) -> Vec<Interval<'_>> {
    cut(way, outcome, separates)
}

/// The parts of a scan between events that cut it. A state reported at the very pose of one belongs to the part after it.
pub(crate) fn cut(way: impl Fn(&State) -> f64, outcome: &Outcome, cuts: impl Fn(&Event) -> bool) -> Vec<Interval<'_>> {
    let mut parts = Vec::new();
    let mut part: Vec<&State> = Vec::new();
    let mut states = outcome.states.iter().peekable();
    for event in outcome.events.iter().filter(|event| cuts(event)) {
        let place = way(&event.before);
        while let Some(state) = states.next_if(|state| way(state) < place) {
            part.push(state);
        }
        part.push(&event.before);
        parts.extend(Interval::of(std::mem::take(&mut part), Some(event.kind)));
        part.push(&event.after);
    }
    part.extend(states);
    parts.extend(Interval::of(part, None));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{along, event, outcome};
    use EventKind::{FirstContact, Piece, Snap, SnapOff};

    fn shape(outcome: &Outcome) -> Vec<(String, usize, Option<EventKind>)> {
        let parts = intervals(along, outcome);
        parts.iter().map(|part| (part.phase.to_string(), part.states.len(), part.end)).collect()
    }

    #[test]
    fn transitions_cut_and_belong_to_both_sides() {
        let outcome = outcome(
            &[(0.0, "free"), (1.0, "A"), (2.0, "A"), (3.0, "free")],
            vec![event(0.5, "free", "A", FirstContact), event(2.5, "A", "free", SnapOff)],
        );
        let expected =
            [("free".into(), 2, Some(FirstContact)), ("A".into(), 4, Some(SnapOff)), ("free".into(), 2, None)];
        assert_eq!(shape(&outcome), expected);
        let part = &intervals(along, &outcome)[1];
        assert_eq!((part.from.x, part.to.x), (0.5, 2.5));
    }

    #[test]
    fn a_snap_within_a_phase_cuts_and_a_new_piece_does_not() {
        let outcome = outcome(
            &[(0.0, "A"), (1.0, "A"), (2.0, "A")],
            vec![event(0.5, "A", "A", Piece), event(2.0, "A", "A", Snap)],
        );
        // The state reported at the snap stands after it.
        assert_eq!(shape(&outcome), [("A".into(), 3, Some(Snap)), ("A".into(), 2, None)]);
    }

    #[test]
    fn no_states_make_no_intervals() {
        assert!(shape(&outcome(&[], Vec::new())).is_empty());
    }
}
