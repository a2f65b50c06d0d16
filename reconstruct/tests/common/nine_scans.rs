//! The nine scans of Merker et al. (2020) in units of the rod: L = EI = 1.

use rod_contact::{ClampPath, EventKind, Item, Sweep};
use rod_contours::{Composite, Parabola};
use rod_core::{Pose, Rod};
use std::f64::consts::FRAC_PI_2;

pub struct Clean {
    pub name: String,
    pub tau: Vec<f64>,
    pub channels: [Vec<f64>; 3],
    /// Transitions along the path.
    pub events: Vec<(f64, EventKind, String)>,
}

/// Vertices of the two parabolas of each object.
const OBJECTS: [[[f64; 2]; 2]; 3] = [[[0.0, 0.0], [0.3, 0.0]], [[0.0, 0.0], [0.3, 0.1]], [[0.0, 0.1], [0.3, 0.0]]];

/// A scan of object 1 to 3 at distance `q`, sampled every `step`.
pub fn scan(object: usize, q: f64, step: f64) -> Clean {
    let vertices = OBJECTS[object - 1];
    let pieces = vertices.map(|v| Box::new(Parabola::new(v, 5.0).unwrap()) as Box<dyn rod_contours::Contour>);
    let contour = Composite::joined(pieces.into()).unwrap();
    let y = vertices[0][1].min(vertices[1][1]) - q;
    let pose = |x| Pose { x, y, phi: FRAC_PI_2 };
    let path = ClampPath::new(pose(0.8), pose(-0.9)).unwrap();
    let rod = Rod::new(1.0, 1.0).unwrap();
    let mut clean = Clean {
        name: format!("O{object}_q{:.0}", 100.0 * q),
        tau: Vec::new(),
        channels: [Vec::new(), Vec::new(), Vec::new()],
        events: Vec::new(),
    };
    for item in Sweep::new(&rod, &contour, path, step).unwrap() {
        match item.unwrap() {
            Item::State(state) => {
                clean.tau.push(0.8 - state.pose.x);
                for (channel, value) in
                    clean.channels.iter_mut().zip([state.reactions.f0x, state.reactions.f0y, state.reactions.m0z])
                {
                    channel.push(value);
                }
            }
            Item::Event(event) => {
                clean.events.push((0.8 - event.pose().x, event.kind, format!("{}>{}", event.from(), event.to())));
            }
        }
    }
    clean
}

pub fn nine(step: f64) -> Vec<Clean> {
    (1..=3).flat_map(|object| [0.2, 0.4, 0.6].map(|q| scan(object, q, step))).collect()
}

/// Whether a transition shows in the reactions (A -> B hardly does, the border of a piece not at all).
pub fn shows(kind: EventKind) -> bool {
    !matches!(kind, EventKind::TipToTangent | EventKind::Piece)
}
