//! Transitions without end at one pose.

use crate::contact_set::{Configuration, Held};
use crate::error::StopReason;
use crate::scene::world::World;

/// Largest number of transitions at one pose. A rod that comes to lie on the edges of a comb needs several; more are a contact
/// that comes and goes by rounding.
const MOST_AT_ONE_POSE: usize = 12;
/// Path parameter by which transitions at one pose differ at most.
const ONE_POSE: f64 = 1e-9;
/// Distance (L) from an end of an open contour. Where contacts come and go closer to it, the sweep stops with `EndOfContour`,
/// farther away with `Chatter`.
const AT_OPEN_END: f64 = 1e-3;

/// Where the last transition was, and how many there were at that pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crowd {
    tau: f64,
    count: usize,
}

impl Crowd {
    pub const NONE: Self = Self { tau: f64::NAN, count: 0 };

    /// Counts a transition.
    pub fn count(&mut self, reached: &Configuration, world: &World<'_>) -> Result<(), StopReason> {
        let tau = reached.tau();
        let count = if (tau - self.tau).abs() < ONE_POSE { self.count + 1 } else { 0 };
        *self = Self { tau, count };
        if count <= MOST_AT_ONE_POSE {
            return Ok(());
        }
        // an open contour that is met head-on at its end has no side to rest on
        let at_end = |(held, j): (&Held, usize)| {
            let at = world.support(held.stretch, reached.t(j));
            world.open_ends().iter().any(|(x, y)| (at.x - x).hypot(at.y - y) < AT_OPEN_END)
        };
        let by_an_end = reached.contacts.iter().zip(0..).any(at_end);
        Err(if by_an_end { StopReason::EndOfContour } else { StopReason::Chatter })
    }
}
