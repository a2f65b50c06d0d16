//! States and events as they are written: SI units, everything counted from 0, numbers that survive a round trip.

use serde::Serialize;
use vibrissa::contact::Contact;
use vibrissa::{Event, State};

/// A line of states.jsonl.
#[derive(Serialize)]
pub(super) struct StateRecord {
    x0: f64,
    y0: f64,
    phi0: f64,
    phase: String,
    f0x: f64,
    f0y: f64,
    m0z: f64,
    contacts: Vec<ContactRecord>,
    residual: f64,
    min_gap: f64,
    stable: bool,
    energy: f64,
    max_stress: Option<f64>,
    /// Proven lower bound of the gap; none where the rod goes through.
    min_gap_bound: Option<f64>,
    gap_proven: bool,
    leg: usize,
    min_force: Option<f64>,
    first_integral: Option<f64>,
    condition: f64,
    iterations: u32,
    /// The reaction of a roller ahead of the clamp, and the arc length there.
    #[serde(skip_serializing_if = "Option::is_none")]
    roller: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    roller_s: Option<f64>,
}

impl From<&State> for StateRecord {
    fn from(state: &State) -> Self {
        Self {
            x0: state.pose.x,
            y0: state.pose.y,
            phi0: state.pose.phi,
            phase: state.phase().to_string(),
            f0x: state.reactions.f0x,
            f0y: state.reactions.f0y,
            m0z: state.reactions.m0z,
            contacts: state.contacts.iter().map(ContactRecord::from).collect(),
            residual: state.certificate.residual,
            min_gap: state.certificate.min_gap.seen,
            stable: state.certificate.stable,
            energy: state.energy,
            max_stress: state.max_stress,
            min_gap_bound: Some(state.certificate.min_gap.lower).filter(|bound| bound.is_finite()),
            gap_proven: state.certificate.min_gap.proven,
            leg: state.leg,
            min_force: state.certificate.min_force,
            first_integral: state.certificate.first_integral,
            condition: state.certificate.condition,
            iterations: state.certificate.iterations,
            roller: state.roller.as_ref().map(|roller| roller.force),
            roller_s: state.roller.as_ref().map(|roller| roller.s),
        }
    }
}

#[derive(Serialize)]
struct ContactRecord {
    object: usize,
    piece: usize,
    kind: String,
    s: f64,
    x: f64,
    y: f64,
    alpha: f64,
    force: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    mode: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slip: Option<f64>,
}

impl From<&Contact> for ContactRecord {
    fn from(contact: &Contact) -> Self {
        let kind = contact.kind.to_string();
        let Contact { object, piece, s, x, y, alpha, force, .. } = *contact;
        let rubs = contact.friction.as_ref();
        let mode = rubs.map(|friction| friction.mode.to_string());
        let (friction, slip) = (rubs.map(|friction| friction.force), rubs.map(|friction| friction.slip));
        Self { object, piece, kind, s, x, y, alpha, force, mode, friction, slip }
    }
}

/// A line of events.jsonl: reactions and contacts before the event, the whole state after it.
#[derive(Serialize)]
pub(super) struct EventRecord {
    x0: f64,
    y0: f64,
    phi0: f64,
    from: String,
    to: String,
    kind: String,
    f0x: f64,
    f0y: f64,
    m0z: f64,
    contacts: Vec<ContactRecord>,
    after: StateRecord,
    leg: usize,
    /// Of the rod and its clamp before the event, J.
    energy: f64,
    /// What friction and jumps have taken since the sweep began, J.
    #[serde(skip_serializing_if = "Option::is_none")]
    dissipated: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    roller: Option<f64>,
}

impl From<&Event> for EventRecord {
    fn from(event: &Event) -> Self {
        let (pose, reactions) = (event.pose(), event.before.reactions);
        Self {
            x0: pose.x,
            y0: pose.y,
            phi0: pose.phi,
            from: event.from().to_string(),
            to: event.to().to_string(),
            kind: event.kind.to_string(),
            f0x: reactions.f0x,
            f0y: reactions.f0y,
            m0z: reactions.m0z,
            contacts: event.before.contacts.iter().map(ContactRecord::from).collect(),
            after: StateRecord::from(&event.after),
            leg: event.leg(),
            energy: event.before.energy,
            dissipated: event.dissipated,
            roller: event.before.roller.as_ref().map(|roller| roller.force),
        }
    }
}

/// The columns of states.csv.
pub(super) const STATE_COLUMNS: [&str; 20] = [
    "state",
    "x0",
    "y0",
    "phi0",
    "phase",
    "f0x",
    "f0y",
    "m0z",
    "residual",
    "min_gap",
    "stable",
    "energy",
    "max_stress",
    "min_gap_bound",
    "gap_proven",
    "leg",
    "min_force",
    "first_integral",
    "condition",
    "iterations",
];

/// Those that follow where the rod runs through a roller.
pub(super) const ROLLER_COLUMNS: [&str; 2] = ["roller", "roller_s"];

/// A row of states.csv: the state of this number.
pub(super) fn state_row((index, state): (usize, &State)) -> impl Serialize {
    let r = StateRecord::from(state);
    let place = (index, r.x0, r.y0, r.phi0, r.phase);
    let forces = (r.f0x, r.f0y, r.m0z);
    let checks = (r.residual, r.min_gap, r.stable);
    // two columns more where there is a roller
    let roller: Vec<f64> = [r.roller, r.roller_s].into_iter().flatten().collect();
    let others = (r.energy, r.max_stress, r.min_gap_bound, r.gap_proven, r.leg);
    let solver = (r.min_force, r.first_integral, r.condition, r.iterations);
    (place, forces, checks, others, solver, roller)
}

/// The columns of contacts.csv.
pub(super) const CONTACT_COLUMNS: [&str; 17] = [
    "state", "x0", "y0", "phi0", "phase", "contact", "object", "piece", "kind", "s", "x", "y", "alpha", "force",
    "mode", "friction", "slip",
];

/// The rows of contacts.csv for a state: one for each contact, from the clamp to the tip, the pose and the phase repeated.
pub(super) fn contact_rows((index, state): (usize, &State)) -> impl Iterator<Item = impl Serialize> {
    state.contacts.iter().enumerate().map(move |(number, contact)| {
        let ContactRecord { object, piece, kind, s, x, y, alpha, force, mode, friction, slip } = contact.into();
        let vibrissa::Pose { x: x0, y: y0, phi: phi0 } = state.pose;
        let place = (index, x0, y0, phi0, state.phase().to_string());
        (place, (number, object, piece, kind), (s, x, y, alpha, force), (mode, friction, slip))
    })
}
