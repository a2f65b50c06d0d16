//! What the page shows: objects, the rod among them, and the last answer to the script.

use crate::answer;
use crate::objects::Objects;
use vibrissa::contact::Item;
use vibrissa::rod::{AnyRod, RodSpec};
use vibrissa::{Follower, Pose};

pub type Failure = Box<dyn std::error::Error>;

/// Steps of a move after which it is given up. A move of a frame takes some tens, a snap some hundreds. More would hold the page up
/// for longer than half a second.
const MOST_STEPS: u64 = 10_000;

#[derive(Default)]
pub struct Page {
    pub objects: Objects,
    pub answer: String,
    rod: Option<AnyRod>,
    friction: f64,
    follower: Option<Follower<'static, AnyRod>>,
}

impl Page {
    pub fn set_rod(&mut self, spec: &RodSpec, friction: f64) -> Result<String, Failure> {
        self.rod = Some(spec.build()?);
        self.friction = friction;
        self.follower = None;
        Ok(String::new())
    }

    fn rod(&self) -> Result<&AnyRod, Failure> {
        Ok(self.rod.as_ref().ok_or("there is no rod yet, expected a call of rod first")?)
    }

    pub fn place(&mut self, pose: Pose) -> Result<String, Failure> {
        let rod = self.rod()?;
        let follower = Follower::new(rod, self.objects.lasting(), pose)?.with_most_steps(MOST_STEPS);
        // without a coefficient there is no friction, which is cheaper than one of 0
        let follower = if self.friction == 0.0 { follower } else { follower.with_friction(self.friction)? };
        let answer = answer::state(rod, follower.state(), &[])?;
        self.follower = Some(follower);
        Ok(answer)
    }

    pub fn move_to(&mut self, pose: Pose) -> Result<String, Failure> {
        let follower = self.follower.as_mut().ok_or("there is no rod yet, expected a call of place first")?;
        let items = follower.to(pose)?;
        let events: Vec<_> = items
            .into_iter()
            .filter_map(|item| match item {
                Item::Event(event) => Some(event),
                Item::State(_) => None,
            })
            .collect();
        let rod = self.rod.as_ref().ok_or("there is no rod yet")?;
        answer::state(rod, follower.state(), &events)
    }
}
