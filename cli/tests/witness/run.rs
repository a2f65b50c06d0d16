//! A sweep as a list of items, and whether two sweeps of one scene with different reporting steps agree.

use super::boundary::Boundary;
use super::state::{CROSSES, Fault, faults};
use rod_files::Scene;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::channel;
use std::time::Duration;
use vibrissa::contact::{Item, Stop, StopReason};
use vibrissa::{Event, Pose, State};

/// More items than any sweep of these tests can have.
const MOST_ITEMS: usize = 50_000;
/// A sweep is waited for so long: hundreds of times what nearly all of them take.
const LONGEST: Duration = Duration::from_secs(12);
/// How exactly events at different steps agree, in lengths of the rod and radians.
pub const AGREES: f64 = 1e-9;

/// How a sweep ended.
#[allow(clippy::enum_variant_names, reason = "the names are those of the library's reasons")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    Done,
    NoStart,
    StepTooSmall,
    NoLanding,
    EndOfContour,
    LineContact,
    ClampInside,
    Chatter,
    Other,
    Endless,
    /// Longer than any of these scenes should take.
    Slow,
    Panicked,
}

impl End {
    fn of(reason: StopReason) -> Self {
        match reason {
            StopReason::NoStart => Self::NoStart,
            StopReason::StepTooSmall(_) => Self::StepTooSmall,
            StopReason::NoLanding => Self::NoLanding,
            StopReason::EndOfContour => Self::EndOfContour,
            StopReason::LineContact => Self::LineContact,
            StopReason::ClampInside => Self::ClampInside,
            StopReason::Chatter => Self::Chatter,
            _ => Self::Other,
        }
    }
}

/// All that a sweep gave.
#[derive(Debug)]
pub struct Run {
    pub states: Vec<State>,
    pub events: Vec<Event>,
    pub end: End,
    pub stop: Option<Stop>,
}

/// A false state: where along the path (m or rad), in which phase, and its gravest fault.
#[derive(Clone, Debug)]
pub struct False {
    pub tau: f64,
    pub phase: String,
    pub fault: Fault,
}

impl fmt::Display for False {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { bad, s } = &self.fault;
        write!(f, "{} at tau = {:.9}: {}, {:.3e} at s = {s:.6}", self.phase, self.tau, bad.what, bad.off)
    }
}

impl Run {
    /// The sweep of a scene with its step times a factor.
    pub fn of(scene: &mut Scene, factor: f64) -> Self {
        let step = scene.step;
        scene.step *= factor;
        let mut run = Self { states: Vec::new(), events: Vec::new(), end: End::Done, stop: None };
        if catch_unwind(AssertUnwindSafe(|| run.fill(scene))).is_err() {
            run.end = End::Panicked;
        }
        scene.step = step;
        run
    }

    /// The same for the text of a scene, given up where it takes too long: what it does then goes on unseen.
    pub fn within_time(text: &str, factor: f64) -> Self {
        let (text, (sender, receiver)) = (text.to_owned(), channel());
        std::thread::spawn(move || {
            let mut scene = Scene::parse("scene.toml".as_ref(), &text).unwrap();
            // nobody listens any more where it has taken too long
            sender.send(Self::of(&mut scene, factor)).unwrap_or_default();
        });
        let nothing = |_| Self { states: Vec::new(), events: Vec::new(), end: End::Slow, stop: None };
        receiver.recv_timeout(LONGEST).unwrap_or_else(nothing)
    }

    fn fill(&mut self, scene: &Scene) {
        for (count, item) in scene.sweep().unwrap().enumerate() {
            match item {
                Ok(Item::State(state)) => self.states.push(state),
                Ok(Item::Event(event)) => self.events.push(event),
                Err(stop) => {
                    self.end = End::of(stop.reason);
                    self.stop = Some(stop);
                }
            }
            if count > MOST_ITEMS {
                self.end = End::Endless;
                return;
            }
        }
    }

    /// What this judge finds wrong with the reported states: the gravest fault of each.
    pub fn false_states(&self, scene: &Scene, boundaries: &[Boundary]) -> Vec<False> {
        self.states.iter().filter_map(|state| judged(scene, state, boundaries)).collect()
    }

    /// The same with the states before and after each event.
    pub fn false_events(&self, scene: &Scene, boundaries: &[Boundary]) -> Vec<False> {
        let states = self.events.iter().flat_map(|event| [&event.before, &event.after]);
        states.filter_map(|state| judged(scene, state, boundaries)).collect()
    }

    /// In what another sweep of the same scene differs.
    pub fn differs(&self, other: &Self, length: f64) -> Option<String> {
        let count = self.events.len().max(other.events.len());
        for k in 0..count {
            let (Some(a), Some(b)) = (self.events.get(k), other.events.get(k)) else {
                return Some(format!(
                    "{} events and {}, {:?} and {:?}",
                    self.events.len(),
                    other.events.len(),
                    self.end,
                    other.end
                ));
            };
            let off = apart(a.pose(), b.pose(), length);
            if a.kind != b.kind || a.to() != b.to() {
                return Some(format!("event {k} is a {} to {} or a {} to {}", a.kind, a.to(), b.kind, b.to()));
            }
            if off > AGREES {
                return Some(format!("event {k}, a {}, is {off:.1e} elsewhere", a.kind));
            }
        }
        (self.end != other.end).then(|| format!("ends with {:?} or {:?}", self.end, other.end))
    }
}

fn apart(a: Pose, b: Pose, length: f64) -> f64 {
    ((a.x - b.x).hypot(a.y - b.y) / length).max((a.phi - b.phi).abs())
}

/// The gravest fault of a state: that it crosses an object, before all others.
fn judged(scene: &Scene, state: &State, boundaries: &[Boundary]) -> Option<False> {
    let grave = |fault: &Fault| (fault.bad.what == CROSSES, fault.bad.off);
    let found = faults(scene, state, boundaries);
    let fault = found.into_iter().max_by(|a, b| grave(a).partial_cmp(&grave(b)).unwrap())?;
    Some(False { tau: along(scene, state), phase: state.phase().to_string(), fault })
}

/// The way along the path to a state's pose.
fn along(scene: &Scene, state: &State) -> f64 {
    let (start, rate) = (scene.path.at(0.0), scene.path.rate());
    if scene.path.turns_only() {
        (state.pose.phi - start.phi) / rate.phi
    } else {
        (state.pose.x - start.x) * rate.x + (state.pose.y - start.y) * rate.y
    }
}
