//! The true sweep of a scene: poses, reactions and labels at every sample, without a sensor.

use super::world::World;
use rod_files::Scene;
use std::path::Path;
use std::sync::{Arc, OnceLock};
use vibrissa::contact::Item;
use vibrissa::rod::Reactions;
use vibrissa::{ClampPath, Label, Pose, Sweep};

/// The scenes of the table.
pub const SCENES: [&str; 5] = ["O1_q40", "O2_q20", "O3_q60", "square_tilted", "disc"];
/// Slow and fast scans, m/s.
pub const SPEEDS: [f64; 2] = [1e-3, 1e-2];

/// Way of the clamp before the first contact and after the last one, m. An imperfection of the rod or the clamp moves the
/// first contact by up to 3 mm; at least 2 mm must be left.
const FREE: f64 = 6e-3;
/// The scan is looked for on the path of the scene and this much on either side of it, m.
const BESIDE: f64 = 0.05;
/// Step of that search, m.
const COARSE: f64 = 1e-3;

/// One sample of a true sweep.
#[derive(Clone, Copy, Debug)]
pub struct TrueState {
    /// Way of the clamp from the start of the path, m.
    pub way: f64,
    /// Pose that the stage is told, SI units.
    pub pose: Pose,
    pub reactions: Reactions,
    pub label: Label,
}

/// A true sweep.
#[derive(Debug)]
pub struct Truth {
    pub states: Vec<TrueState>,
    /// Ways of the clamp at which the label changes, m.
    pub changes: Vec<f64>,
}

impl Truth {
    pub fn new(states: Vec<TrueState>) -> Self {
        let pairs = states.windows(2).filter(|pair| pair[0].label != pair[1].label);
        let changes = pairs.map(|pair| 0.5 * (pair[0].way + pair[1].way)).collect();
        Self { states, changes }
    }

    /// The labels in order.
    pub fn cycle(&self) -> String {
        let labels = self.states.chunk_by(|a, b| a.label == b.label).map(|run| run[0].label.to_string());
        labels.collect::<Vec<_>>().join(" ")
    }

    /// The sweep by the library. The clamp is turned by `turned` against the angle that the stage is told.
    pub fn sweep(scene: &Scene, path: ClampPath, step: f64, turned: f64) -> Self {
        let turn = |pose: Pose| Pose { phi: pose.phi + turned, ..pose };
        let true_path = ClampPath::new(turn(path.at(0.0)), turn(path.at(path.length()))).unwrap();
        let mut states = Vec::new();
        for item in Sweep::new(&scene.rod, &scene.objects, true_path, step).unwrap() {
            let Item::State(state) = item.unwrap() else { continue };
            let (phase, start) = (state.phase(), path.at(0.0));
            let way = (state.pose.x - start.x).hypot(state.pose.y - start.y);
            let label = Label::of(phase.contacts, phase.tip);
            states.push(TrueState { way, pose: path.at(way), reactions: state.reactions, label });
        }
        Self::new(states)
    }
}

/// A scene of the table with the sweeps of the ideal rod.
pub struct Site {
    pub name: &'static str,
    pub scene: Scene,
    /// The scan with a free rod at both ends.
    pub path: ClampPath,
    /// Samples in a second, 1/s.
    pub rate: f64,
    ideal: [OnceLock<Arc<Truth>>; SPEEDS.len()],
}

impl Site {
    pub fn new(name: &'static str, rate: f64) -> Self {
        let scene = if name == "disc" {
            Scene::parse("disc.toml".as_ref(), include_str!("disc.toml")).unwrap()
        } else {
            let directory = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes"));
            Scene::read(&directory.join(format!("{name}.toml"))).unwrap()
        };
        let path = with_free_ends(&scene);
        Self { name, scene, path, rate, ideal: Default::default() }
    }

    /// Way of the clamp between two samples, m.
    pub fn step(&self, speed: usize) -> f64 {
        SPEEDS[speed] / self.rate
    }

    /// The sweep of the rod, the clamp and the object as they are in this world.
    pub fn truth(&self, speed: usize, world: &World) -> Arc<Truth> {
        let ideal = || Arc::new(Truth::sweep(&self.scene, self.path, self.step(speed), 0.0));
        if world.is_ideal() {
            self.ideal[speed].get_or_init(ideal).clone()
        } else {
            Arc::new(world.sweep(self, self.step(speed)))
        }
    }
}

/// The path of the scene, shortened or extended to [`FREE`] before the first contact and after the last one.
fn with_free_ends(scene: &Scene) -> ClampPath {
    let at = |way: f64| scene.path.at(way);
    let search = ClampPath::new(at(-BESIDE), at(scene.path.length() + BESIDE)).unwrap();
    let coarse = Truth::sweep(scene, search, COARSE, 0.0);
    let free = |state: &TrueState| state.label == Label::Free;
    assert!(coarse.states.first().is_some_and(free) && coarse.states.last().is_some_and(free), "{}", scene.name);
    let touching: Vec<f64> = coarse.states.iter().filter(|state| !free(state)).map(|state| state.way).collect();
    let (first, last) = (touching[0] - COARSE, touching[touching.len() - 1] + COARSE);
    ClampPath::new(search.at(first - FREE), search.at(last + FREE)).unwrap()
}
