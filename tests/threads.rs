//! All types of a simulator may go from thread to thread, and be shared: docs/tutorials/simulator.md says so.

use vibrissa::contact::{Item, Stop};
use vibrissa::rod::{AnyRod, VaryingRod};
use vibrissa::{ClampPath, Composite, Event, Follower, Rod, State, Sweep};

const fn is_send_and_sync<T: Send + Sync>() {}

// fails when it is compiled
const _: () = {
    is_send_and_sync::<(Rod, VaryingRod, AnyRod)>();
    is_send_and_sync::<(Composite, ClampPath)>();
    is_send_and_sync::<(Follower<'_>, Follower<'_, AnyRod>, Sweep<'_>)>();
    is_send_and_sync::<(State, Event, Item, Stop)>();
};
