//! What comes out of a sweep.

use super::start::Start;
use crate::error::Stop;
use crate::event::Event;
use crate::state::State;

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
