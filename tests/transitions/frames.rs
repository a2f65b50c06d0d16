//! One scene in several frames, with its path cut in legs, with other steps: the events and the end must be the same.

use super::scene::{Frame, Scene};
use vibrissa::contact::{Item, Stop};

/// An event of a sweep in the scene's own frame.
struct Told {
    /// Kind and phases.
    name: String,
    pose: [f64; 3],
}

/// The events of a sweep, and why it ended.
pub struct Run {
    events: Vec<Told>,
    pub end: String,
}

impl Run {
    pub fn of(scene: &Scene, frame: &Frame, items: &[Result<Item, Stop>]) -> Self {
        let mut run = Self { events: Vec::new(), end: "done".into() };
        for item in items {
            match item {
                Ok(Item::State(_)) => {}
                Ok(Item::Event(event)) => {
                    let pose = frame.back(event.pose(), scene.length);
                    let name = format!("{} {}-{}", event.kind, event.from(), event.to());
                    run.events.push(Told { name, pose: [pose.x, pose.y, pose.phi] });
                }
                Err(stop) => run.end = stop.reason.to_string(),
            }
        }
        run
    }

    pub fn count(&self) -> usize {
        self.events.len()
    }

    /// By how much poses of events differ at most (L, rad), or where the sweeps are not the same.
    pub fn differs(&self, other: &Self) -> Result<f64, String> {
        let mut most = 0.0_f64;
        for (k, (one, two)) in self.events.iter().zip(&other.events).enumerate() {
            if one.name != two.name {
                return Err(format!("event {k} is {} and {}, poses before it differ by {most:e}", one.name, two.name));
            }
            most = one.pose.iter().zip(&two.pose).map(|(a, b)| (a - b).abs()).fold(most, f64::max);
        }
        if self.count() != other.count() || self.end != other.end {
            let ends = [self, other].map(|run| format!("{} events, {}", run.count(), run.end));
            return Err(format!("{} and {}, poses differ by {most:e}", ends[0], ends[1]));
        }
        Ok(most)
    }
}

/// The same scene seen otherwise, each time with a name: turned, shifted, mirrored, scaled, its legs cut in two, with other steps.
pub fn variants(scene: &Scene) -> Vec<(&'static str, Run)> {
    let frames = [
        ("turned", Frame { turn: 0.7313, ..Frame::OWN }),
        ("shifted", Frame { shift: [37.3, -11.9], ..Frame::OWN }),
        ("mirrored", Frame { mirror: true, ..Frame::OWN }),
        ("scaled", Frame { scale: 0.0137, ..Frame::OWN }),
    ];
    let seen = |(name, frame): (&'static str, Frame)| {
        let scene = scene.seen(&frame);
        (name, Run::of(&scene, &frame, &scene.items(1.0)))
    };
    let cut = scene.cut(0.371_001);
    let steps = [("a tenth of the step", 0.1), ("five times the step", 5.0)];
    let stepped = |(name, share): (&'static str, f64)| (name, Run::of(scene, &Frame::OWN, &scene.items(share)));
    let cut = ("its legs cut", Run::of(&cut, &Frame::OWN, &cut.items(1.0)));
    frames.into_iter().map(seen).chain([cut]).chain(steps.into_iter().map(stepped)).collect()
}
