//! The results of a sweep: states, events, and how its first equilibrium was found.

use crate::error::Stop;
use crate::event::Event;
use crate::phase::Phase;
use crate::state::State;
use std::fmt;

/// What a sweep comes to next.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::large_enum_variant, reason = "items are handed out one by one, not kept")]
pub enum Item {
    /// The equilibrium at a pose that is reported.
    State(State),
    /// A transition.
    Event(Event),
}

/// All of a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Outcome {
    /// How the first equilibrium was found; none where there is none.
    #[cfg_attr(feature = "serde", serde(default))]
    pub start: Option<Start>,
    /// States at start, start + step, ..., and at the end of each leg.
    pub states: Vec<State>,
    /// Transitions in order.
    pub events: Vec<Event>,
    /// Energy (J) lost by friction and jumps ([`Sweep::dissipated`](crate::Sweep::dissipated)).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub dissipated: Option<f64>,
    /// Why it stopped before the end of the path, if it did.
    pub stop: Option<Stop>,
}

/// How the first equilibrium was found.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Start {
    /// The rod touches nothing in the first pose.
    Free,
    /// The rod is in contact there: the equilibria that were reached. The first is the one taken; the others
    /// follow in order of their energies. Which one a rod is in depends on how it came there: a sweep that leads there from outside gives
    /// the state with which [`Sweep::from_state`](crate::Sweep::from_state) begins.
    InContact(Vec<StartCandidate>),
    /// The equilibrium was given.
    Given,
}

/// An equilibrium that was reached in the first pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StartCandidate {
    /// The first approach that came to it.
    pub approach: Approach,
    /// Its contacts.
    pub phase: Phase,
    /// Its bending energy, J.
    pub energy: f64,
}

/// Ways in which a rod comes into its first pose, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Approach {
    /// The clamp moves along its path, from where, further back, the rod is free.
    AlongPath,
    /// The clamp turns into its first pose, from one side or the other.
    TurningIn,
    /// The clamp moves in sideways, across the rod, from one side or the other.
    MovingIn,
    /// The rod, straight or slightly bent, is let go in the first pose.
    LettingGo,
}

/// In words, such as `letting go`.
impl fmt::Display for Approach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::AlongPath => "moving along the path",
            Self::TurningIn => "turning in",
            Self::MovingIn => "moving in sideways",
            Self::LettingGo => "letting go",
        })
    }
}
