//! Further legs of the clamp's path: `[[sweep.leg]]`.

use super::document::{LegTable, SweepTable};
use super::numbers::{check_step_count, not, too_large};
use crate::toml_file::Fault;
use std::sync::Arc;
use toml::Spanned;
use vibrissa::contact::{ClampArc, ContactError, Path};
use vibrissa::{ClampPath, Pose};

/// A leg of the path after the first one, and the distance of its reported states: m, or radians where the clamp only turns.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// Straight, or about a pivot.
    pub path: LegPath,
    /// Distance between reported states.
    pub step: f64,
}

/// The path of a leg.
#[derive(Clone, Copy, Debug)]
pub enum LegPath {
    /// `to`, `angle_to`.
    Straight(ClampPath),
    /// `pivot`, `turn`.
    Pivot(ClampArc),
}

impl LegPath {
    /// As a leg of a chain.
    pub fn path(&self) -> Arc<dyn Path> {
        match self {
            Self::Straight(path) => Arc::new(*path),
            Self::Pivot(path) => Arc::new(*path),
        }
    }

    /// Pose at a parameter: m, or radians where the clamp only turns.
    pub fn at(&self, way: f64) -> Pose {
        self.path().point(way).pose
    }

    /// The parameter at the end.
    pub fn length(&self) -> f64 {
        self.path().length()
    }

    /// Whether the clamp turns without moving.
    pub fn turns_only(&self) -> bool {
        match self {
            Self::Straight(path) => path.turns_only(),
            Self::Pivot(path) => path.turns_only(),
        }
    }

    /// The parameter at a pose on the leg.
    pub fn way(&self, pose: Pose) -> f64 {
        match self {
            Self::Straight(path) => crate::interval::way(path, pose),
            // it turns as it goes
            Self::Pivot(path) => (pose.phi - path.point(0.0).pose.phi) / path.point(0.0).rate.phi,
        }
    }
}

/// Distance (lengths of the rod, radians) that counts as none: the end of a leg about a pivot has rounding errors.
pub(super) const SAME: f64 = 1e-12;

/// The legs of a path whose first leg ends at `end`; `length` is that of the rod, m.
pub(super) fn all(sweep: &SweepTable, end: Pose, length: f64) -> Result<Vec<Leg>, Fault> {
    let mut from = end;
    let leg = |table: &Spanned<LegTable>| {
        let path = path(table, from, SAME * length)?;
        from = path.at(path.length());
        Ok(Leg { step: step(table, sweep, &path)?, path })
    };
    sweep.leg.iter().map(leg).collect()
}

/// The path of a leg from a pose; `same` (m) is a distance that counts as none.
pub(super) fn path(table: &Spanned<LegTable>, from: Pose, same: f64) -> Result<LegPath, Fault> {
    let LegTable { to, angle_to, pivot, turn, .. } = table.get_ref();
    let wrong = |message: &str| Err(Fault::new(table.span(), message.to_owned()));
    // a clamp that comes back to where it was is there
    let at = |[x, y]: [f64; 2]| {
        if (x - from.x).hypot(y - from.y) <= same { [from.x, from.y] } else { [x, y] }
    };
    match (to, angle_to, pivot, turn) {
        (None, None, Some(pivot), Some(turn)) => {
            let by = turn.get_ref().to_radians();
            ClampArc::about(from, at(pivot.get_ref().0), by).map(LegPath::Pivot).map_err(|error| match error {
                ContactError::NotFinite { what: "turn", .. } => Fault::new(turn.span(), not("turn", *turn.get_ref())),
                ContactError::Angle { .. } => Fault::new(turn.span(), too_large("turn", *turn.get_ref())),
                ContactError::NoPath { .. } => {
                    Fault::new(turn.span(), "turn is 0, expected an angle in degrees by which the clamp turns")
                }
                error => Fault::new(pivot.span(), error.to_string()),
            })
        }
        (None, None, None, None) => wrong("a leg that leads nowhere, expected to or angle_to, or pivot and turn"),
        (_, _, None, None) => {
            let [x, y] = to.as_ref().map_or([from.x, from.y], |to| at(to.get_ref().0));
            let phi = angle_to.as_ref().map_or(from.phi, |angle| angle.get_ref().to_radians());
            let phi = if (phi - from.phi).abs() <= SAME { from.phi } else { phi };
            let span = to.as_ref().map(Spanned::span).or(angle_to.as_ref().map(Spanned::span));
            ClampPath::new(from, Pose { x, y, phi }).map(LegPath::Straight).map_err(|error| {
                let value = angle_to.as_ref().map_or(f64::NAN, |angle| *angle.get_ref());
                let at_angle = angle_to.as_ref().map(Spanned::span);
                match error {
                    ContactError::NotFinite { what: "to.phi", .. } => {
                        Fault::new(at_angle.unwrap_or(table.span()), not("angle_to", value))
                    }
                    ContactError::Angle { .. } => {
                        Fault::new(at_angle.unwrap_or(table.span()), too_large("angle_to", value))
                    }
                    ContactError::NoPath { .. } => Fault::new(
                        span.unwrap_or(table.span()),
                        "the leg ends where it starts, expected another position or angle",
                    ),
                    error => Fault::new(span.unwrap_or(table.span()), error.to_string()),
                }
            })
        }
        (None, None, Some(pivot), None) => {
            Err(Fault::new(pivot.span(), "the leg has a pivot, expected turn (degrees) beside it"))
        }
        (None, None, None, Some(turn)) => {
            Err(Fault::new(turn.span(), "the leg has a turn, expected pivot = [x, y] (m) beside it"))
        }
        _ => wrong("the leg is both straight and about a pivot, expected to, angle_to, or both, or pivot and turn"),
    }
}

/// The step in the unit of the leg's parameter: its own, or that of `[sweep]`.
fn step(table: &Spanned<LegTable>, sweep: &SweepTable, path: &LegPath) -> Result<f64, Fault> {
    let own = table.get_ref();
    let (what, one, other) = if path.turns_only() {
        ("step_angle", own.step_angle.as_ref().or(sweep.step_angle.as_ref()), own.step.as_ref())
    } else {
        ("step", own.step.as_ref().or(sweep.step.as_ref()), own.step_angle.as_ref())
    };
    if let Some(other) = other {
        let (given, moves) = if path.turns_only() { ("step", "turns on the spot") } else { ("step_angle", "moves") };
        let message = format!("{given} is {}, but the clamp {moves} on this leg, expected {what}", other.get_ref());
        return Err(Fault::new(other.span(), message));
    }
    let Some(one) = one else {
        let message = format!("missing field `{what}`, the distance between reported states, here or in [sweep]");
        return Err(Fault::new(table.span(), message));
    };
    if path.turns_only() {
        check_step_count(one.span(), what, *one.get_ref(), path.length().to_degrees()).map(f64::to_radians)
    } else {
        check_step_count(one.span(), what, *one.get_ref(), path.length())
    }
}
