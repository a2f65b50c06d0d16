//! What a sensor without noise would record.

use super::{Outcome, STEP};
use rod_files::Scene;
use std::path::Path;
use vibrissa::contact::{EventKind, Item};
use vibrissa::reconstruct::NoiseModel;
use vibrissa::{Event, Label, Sample, Sweep};

/// A transition between two phases.
#[derive(Clone, Debug)]
pub struct Transition {
    /// Way of the clamp from the start of the path, m.
    pub at: f64,
    /// From which phase to which, as `A -> BA`.
    pub name: String,
    /// Whether it shows in the reactions: A -> B hardly does (Merker et al. 2020, section 3), the border of a piece not at
    /// all.
    pub shows: bool,
}

/// A scan without noise.
pub struct Clean {
    /// What was swept.
    pub scene: Scene,
    /// Coefficient of friction.
    pub friction: f64,
    /// What was felt.
    pub samples: Vec<Sample>,
    /// In which phase each sample was.
    pub labels: Vec<Label>,
    /// Where these change.
    pub transitions: Vec<Transition>,
}

impl Clean {
    /// Sweeps the scene in a file with this coefficient of friction, a sample every [`STEP`].
    pub fn sweep(file: &Path, friction: f64) -> Outcome<Self> {
        let scene = Scene::read(file)?;
        let (mut samples, mut labels, mut transitions) = (Vec::new(), Vec::new(), Vec::new());
        let sweep = Sweep::new(&scene.rod, &scene.objects, scene.path, STEP)?;
        for item in if friction == 0.0 { sweep } else { sweep.with_friction(friction)? } {
            match item? {
                Item::State(state) => {
                    let phase = state.phase();
                    samples.push(Sample::new(state.pose, state.reactions));
                    labels.push(Label::of(phase.contacts, phase.tip));
                }
                Item::Event(event) => transitions.push(transition(&scene, &event)),
            }
        }
        Ok(Self { scene, friction, samples, labels, transitions })
    }

    /// What a sensor makes of it. Lost samples are missing.
    pub fn recorded(&self, model: &NoiseModel, seed: u64) -> Outcome<Vec<Sample>> {
        let mut sensor = model.generator(seed)?;
        let felt = |sample: &Sample| Some(Sample { reactions: sensor.sample(sample.reactions)?, ..*sample });
        Ok(self.samples.iter().filter_map(felt).collect())
    }

    /// Places of the transitions that show, or of the others, m.
    pub fn places(&self, shows: bool) -> Vec<f64> {
        self.transitions.iter().filter(|transition| transition.shows == shows).map(|transition| transition.at).collect()
    }
}

fn transition(scene: &Scene, event: &Event) -> Transition {
    let (pose, start) = (event.pose(), scene.path.at(0.0));
    Transition {
        at: (pose.x - start.x).hypot(pose.y - start.y),
        name: format!("{} -> {}", event.from(), event.to()),
        shows: !matches!(event.kind, EventKind::TipToTangent | EventKind::Piece),
    }
}
