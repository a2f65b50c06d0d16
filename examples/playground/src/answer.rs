//! Answers to the script, as JSON. SI units, angles in rad:
//!
//! ```json
//! {"phase": "BA", "pose": [x, y, phi], "reactions": [f0x, f0y, m0z],
//!  "contacts": [{"kind": "tip", "s": .., "x": .., "y": .., "alpha": .., "force": .., "friction": .., "mode": ".."}],
//!  "shape": [x, y, x, y, ..], "recovered": {"kind": "tip", "x": .., "y": ..},
//!  "events": [{"kind": "snap", "from": "B", "to": "A", "pose": [x, y, phi]}]}
//! ```
//!
//! Numbers are finite and have all their digits; `mode` is there with friction only; `recovered` is null of a free rod.

use crate::outline::Line;
use crate::page::Failure;
use crate::recovered::recovered;
use vibrissa::contact::Contact;
use vibrissa::rod::{AnyRod, Reactions};
use vibrissa::{Event, Pose, State};

/// Points of a shape, clamp and tip included.
const POINTS: usize = 100;

/// A text in quotation marks.
fn text(plain: &str) -> String {
    let mut quoted = String::from('"');
    for letter in plain.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            control if control.is_control() => quoted.push(' '),
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}

fn list(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(","))
}

fn numbers(numbers: impl IntoIterator<Item = f64>) -> String {
    list(numbers.into_iter().map(|number| number.to_string()))
}

fn pose(Pose { x, y, phi }: Pose) -> String {
    numbers([x, y, phi])
}

fn contact(at: &Contact) -> String {
    let Contact { kind, s, x, y, alpha, force, friction, .. } = at;
    let along = friction.map_or(0.0, |friction| friction.force);
    let mode = friction.map_or(String::new(), |friction| format!(r#","mode":"{}""#, friction.mode));
    format!(r#"{{"kind":"{kind}","s":{s},"x":{x},"y":{y},"alpha":{alpha},"force":{force},"friction":{along}{mode}}}"#)
}

fn event(event: &Event) -> String {
    format!(
        r#"{{"kind":"{}","from":"{}","to":"{}","pose":{}}}"#,
        event.kind,
        event.from(),
        event.to(),
        pose(event.pose())
    )
}

/// The state of the rod after a move, and what happened on the way.
pub fn state(rod: &AnyRod, state: &State, events: &[Event]) -> Result<String, Failure> {
    let Reactions { f0x, f0y, m0z } = state.reactions;
    let shape = state.elastica(rod)?;
    let found = recovered(rod, state);
    Ok(format!(
        r#"{{"phase":"{}","pose":{},"reactions":{},"contacts":{},"shape":{},"recovered":{},"events":{}}}"#,
        state.phase(),
        pose(state.pose),
        numbers([f0x, f0y, m0z]),
        list(state.contacts.iter().map(contact)),
        numbers(shape.sample(POINTS).flat_map(|at| [at.x, at.y])),
        found.map_or("null".into(), |(kind, [x, y])| format!(r#"{{"kind":"{kind}","x":{x},"y":{y}}}"#)),
        list(events.iter().map(event)),
    ))
}

/// Why a call did nothing.
pub fn failure(failure: &Failure) -> String {
    format!(r#"{{"failure":{}}}"#, text(&failure.to_string()))
}

/// A line for each object.
pub fn outlines(lines: &[Line]) -> String {
    list(lines.iter().map(|line| numbers(line.iter().copied().flatten())))
}
