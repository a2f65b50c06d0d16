//! Made-up outcomes for tests: what happened and where, without mechanics.

use vibrissa::contact::{Certificate, Contact, ContactKind, EventKind, GapBounds, Outcome};
use vibrissa::rod::Reactions;
use vibrissa::{Event, Pose, State};

fn pose(x: f64) -> Pose {
    Pose { x, y: 0.0, phi: 0.0 }
}

/// The way along it.
pub(crate) fn along(state: &State) -> f64 {
    state.pose.x
}

/// A state at x in a phase given by its name.
pub(crate) fn state(x: f64, phase: &str) -> State {
    let contact = |letter| Contact {
        object: 0,
        piece: 0,
        kind: if letter == 'A' { ContactKind::Tip } else { ContactKind::Tangent },
        s: 0.0,
        x: 0.0,
        y: 0.0,
        alpha: 0.0,
        force: 0.0,
        friction: None,
    };
    State {
        pose: pose(x),
        contacts: phase.chars().filter(|_| phase != "free").map(contact).collect(),
        leg: 0,
        roller: None,
        reactions: Reactions::default(),
        energy: 0.0,
        max_stress: None,
        certificate: Certificate {
            residual: 0.0,
            min_gap: GapBounds { lower: 0.0, seen: 0.0, proven: true },
            min_force: None,
            first_integral: Some(0.0),
            stable: true,
            condition: 1.0,
            iterations: 0,
        },
    }
}

/// A transition at x.
pub(crate) fn event(x: f64, from: &str, to: &str, kind: EventKind) -> Event {
    Event { kind, before: state(x, from), after: state(x, to), dissipated: None }
}

/// A sweep that was not stopped.
pub(crate) fn outcome(states: &[(f64, &str)], events: Vec<Event>) -> Outcome {
    let mut outcome = Outcome::default();
    outcome.states.extend(states.iter().map(|&(x, phase)| state(x, phase)));
    outcome.events = events;
    outcome
}
