//! One scene swept and judged.

use crate::random::generator::Generated;
use crate::witness::description::boundaries;
use crate::witness::run::{End, False, Run};
use rod_files::Scene;
use std::time::{Duration, Instant};

/// Factors of the step that must not change anything but which states are reported.
pub const FACTORS: [f64; 3] = [0.999, 0.37, 0.125];

#[derive(Clone, Debug)]
pub struct Verdict {
    pub scene: Generated,
    /// None where the scene file was refused.
    pub end: Option<End>,
    pub message: String,
    pub states: usize,
    pub touching: usize,
    pub events: usize,
    pub false_states: Vec<False>,
    pub false_events: Vec<False>,
    /// What each other step changed; none where it was not tried.
    pub steps: Option<Vec<(f64, String)>>,
    pub time: Duration,
}

impl Verdict {
    /// Whether the sweep ended where the problem may go on.
    pub fn gave_up(&self) -> bool {
        use End::{Chatter, Endless, NoLanding, NoStart, Other, Panicked, Slow, StepTooSmall};
        self.end.is_none_or(|end| {
            matches!(end, StepTooSmall | NoLanding | Chatter | Endless | Slow | Panicked | Other | NoStart)
        })
    }

    pub fn disagrees(&self) -> bool {
        self.steps.as_ref().is_some_and(|steps| !steps.is_empty())
    }
}

/// Sweeps and judges a scene; at other steps too, if asked to.
pub fn verdict(generated: Generated, at_other_steps: bool) -> Verdict {
    let started = Instant::now();
    let mut verdict = Verdict {
        scene: generated,
        end: None,
        message: String::new(),
        states: 0,
        touching: 0,
        events: 0,
        false_states: Vec::new(),
        false_events: Vec::new(),
        steps: None,
        time: Duration::ZERO,
    };
    let file = format!("{}.toml", verdict.scene.seed);
    let scene = match Scene::parse(file.as_ref(), &verdict.scene.text) {
        Ok(scene) => scene,
        Err(error) => {
            verdict.message = error.to_string();
            return verdict;
        }
    };
    let objects = boundaries(&verdict.scene.text).unwrap();
    let run = Run::within_time(&verdict.scene.text, 1.0);
    verdict.end = Some(run.end);
    verdict.message = run.stop.as_ref().map(ToString::to_string).unwrap_or_default();
    (verdict.states, verdict.events) = (run.states.len(), run.events.len());
    verdict.touching = run.states.iter().filter(|state| !state.contacts.is_empty()).count();
    verdict.false_states = run.false_states(&scene, &objects);
    verdict.false_events = run.false_events(&scene, &objects);
    if at_other_steps && run.end != End::Slow {
        let differs = |factor: f64| {
            let other = Run::within_time(&verdict.scene.text, factor);
            Some((factor, run.differs(&other, scene.rod.length())?))
        };
        verdict.steps = Some(FACTORS.into_iter().filter_map(differs).collect());
    }
    verdict.time = started.elapsed();
    verdict
}
