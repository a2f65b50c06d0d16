//! Transitions without end at one pose.

use crate::contact_set::{ActiveContact, Configuration};
use crate::error::StopReason;
use crate::limits::LIMITS;
use crate::scene::world::World;

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
        let count = if (tau - self.tau).abs() < LIMITS.sweep.one_pose { self.count + 1 } else { 0 };
        *self = Self { tau, count };
        if count <= LIMITS.sweep.most_at_one_pose {
            return Ok(());
        }
        // an open contour that is met head-on at its end has no side to rest on
        let at_end = |(held, j): (&ActiveContact, usize)| {
            let at = world.support(held.stretch, reached.t(j));
            world.open_ends().iter().any(|(x, y)| (at.x - x).hypot(at.y - y) < LIMITS.sweep.at_open_end)
        };
        let by_an_end = reached.contacts.iter().zip(0..).any(at_end);
        Err(if by_an_end { StopReason::EndOfContour } else { StopReason::Chatter })
    }
}
