//! One scene swept, and everything in it judged.

use super::generator::Generated;
use crate::common::case::{Bad, Case};
use crate::common::outline::{Outline, wrapped};
use rod_files::Scene;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};
use vibrissa::contact::{ContactKind, EventKind, Item, Phase, Stop, StopReason};
use vibrissa::{Event, State};

/// How a sweep ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    Done,
    Stopped(StopReason),
    /// The scene file is no scene.
    Refused(String),
    Panicked(String),
    /// More items than any sweep can have.
    Endless,
}

impl End {
    pub fn name(&self) -> String {
        match self {
            Self::Done => "done".into(),
            Self::Stopped(reason) => format!("{reason:?}"),
            Self::Refused(_) => "refused".into(),
            Self::Panicked(_) => "panic".into(),
            Self::Endless => "endless".into(),
        }
    }
}

/// What is wrong, where along the path (lengths of the rod, or radians), and in which phase.
#[derive(Clone, Debug)]
pub struct Fault {
    pub bad: Bad,
    pub tau: f64,
    pub phase: Phase,
    /// Whether it is a state of an event, not a reported one.
    pub event: bool,
}

/// A scene and what came of it.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub scene: Generated,
    pub end: End,
    /// The message of a stop.
    pub message: String,
    /// An end that the problem itself does not seem to have.
    pub doubt: Option<String>,
    pub states: usize,
    pub touching: usize,
    pub events: usize,
    pub most: usize,
    pub faults: Vec<Fault>,
    /// All items, a line each.
    pub trace: Vec<String>,
    pub time: Duration,
    /// Snaps that land further along the path than where they began: poses in between were given up.
    pub late: usize,
    /// Where it stopped, as a share of the path.
    pub share: f64,
}

const MOST_ITEMS: usize = 20_000;

impl Verdict {
    /// Whether the sweep gave up where the problem goes on.
    pub fn gave_up(&self) -> bool {
        use StopReason::{Chatter, NoLanding, NoStart, StepTooSmall};
        match &self.end {
            End::Stopped(NoStart) => self.doubt.is_some(),
            End::Stopped(reason) => matches!(reason, Chatter | NoLanding | StepTooSmall(_)),
            End::Endless => true,
            _ => false,
        }
    }

    pub fn is_bad(&self) -> bool {
        !self.faults.is_empty()
    }
}

/// Runs a scene and judges all of it.
pub fn verdict(generated: Generated) -> Verdict {
    let started = Instant::now();
    let mut verdict = Verdict {
        scene: generated,
        end: End::Done,
        message: String::new(),
        doubt: None,
        states: 0,
        touching: 0,
        events: 0,
        most: 0,
        faults: Vec::new(),
        trace: Vec::new(),
        time: Duration::ZERO,
        late: 0,
        share: 1.0,
    };
    let file = format!("{}.toml", verdict.scene.seed);
    let scene = match Scene::parse(file.as_ref(), &verdict.scene.text) {
        Ok(scene) => scene,
        Err(error) => {
            verdict.end = End::Refused(error.to_string());
            verdict.message = error.to_string();
            return verdict;
        }
    };
    let mut items = Vec::new();
    let outcome = catch_unwind(AssertUnwindSafe(|| sweep(&scene, &mut items)));
    verdict.time = started.elapsed();
    let stop = match outcome {
        Ok(Ran::Through) => None,
        Ok(Ran::Endless) => {
            verdict.end = End::Endless;
            None
        }
        Ok(Ran::Stopped(stop)) => {
            verdict.end = End::Stopped(stop.reason);
            verdict.message = stop.to_string();
            verdict.share = stop.tau / scene.path.length();
            Some(stop)
        }
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default();
            verdict.end = End::Panicked(text.clone());
            verdict.message = text;
            None
        }
    };
    let outlines: Vec<_> = scene.objects.iter().map(|object| Outline::new(object, scene.rod.length())).collect();
    Examiner { scene: &scene, outlines: &outlines, verdict: &mut verdict }.examine(&items, stop.as_ref());
    verdict
}

enum Ran {
    Through,
    Stopped(Stop),
    Endless,
}

fn sweep(scene: &Scene, items: &mut Vec<Item>) -> Ran {
    for item in scene.sweep().unwrap() {
        match item {
            Ok(item) => items.push(item),
            Err(stop) => return Ran::Stopped(stop),
        }
        if items.len() > MOST_ITEMS {
            return Ran::Endless;
        }
    }
    Ran::Through
}

struct Examiner<'a> {
    scene: &'a Scene,
    outlines: &'a [Outline<'a>],
    verdict: &'a mut Verdict,
}

impl Examiner<'_> {
    fn examine(&mut self, items: &[Item], stop: Option<&Stop>) {
        let events: Vec<&Event> =
            items.iter().filter_map(|item| if let Item::Event(event) = item { Some(event) } else { None }).collect();
        let states: Vec<&State> =
            items.iter().filter_map(|item| if let Item::State(state) = item { Some(state) } else { None }).collect();
        (self.verdict.states, self.verdict.events) = (states.len(), events.len());
        for state in &states {
            self.verdict.touching += usize::from(!state.contacts.is_empty());
            self.verdict.most = self.verdict.most.max(state.contacts.len());
            self.judge(state, true, false);
        }
        for event in &events {
            // the state before a jump is the very last one, where stability is lost
            self.judge(&event.before, false, true);
            self.judge(&event.after, false, true);
        }
        self.verdict.trace = items.iter().map(|item| self.line(item)).collect();
        let late = |event: &&&Event| self.along(&event.after).0 > self.along(&event.before).0 + 1e-6 * self.unit();
        self.verdict.late = events.iter().filter(late).count();
        self.order(items);
        self.spread(&states, &events, stop);
        self.chatter(&events);
        if let Some(stop) = stop {
            self.verdict.doubt = self.doubt(stop, &states);
        }
    }

    fn line(&self, item: &Item) -> String {
        let state = |state: &State| {
            let (length, force) = (self.scene.rod.length(), self.scene.rod.units().force);
            let rod = Case::new(self.scene, state).rod;
            let contact = |c: &vibrissa::contact::Contact| {
                // the rod's angle to the contour, and how far along its piece the contact is
                let angle = wrapped(rod.at(c.s / length).phi - c.alpha).to_degrees();
                let outline = &self.outlines[c.object];
                let strip = outline.strips.iter().position(|s| s.piece == c.piece);
                let share = strip.map_or(f64::NAN, |s| outline.share(s, c.x / length, c.y / length));
                let (s, f) = (c.s / length, c.force / force);
                format!("{:?} {}.{}@{share:.6} s={s:.6} f={f:.3e} {angle:.4} deg", c.kind, c.object, c.piece)
            };
            let contacts: Vec<_> = state.contacts.iter().map(contact).collect();
            let (tau, gap) = (self.along(state).0 / self.unit(), state.certificate.min_gap.seen / length);
            format!("{tau:.9} {} gap={gap:.2e} [{}]", state.phase(), contacts.join(", "))
        };
        match item {
            Item::State(one) => format!("state {}", state(one)),
            Item::Event(event) => {
                format!("EVENT {}\n  {}\n  {}", event.kind, state(&event.before), state(&event.after))
            }
        }
    }

    /// Way along the path of a state's pose, in m or rad, and how far off the path it is.
    fn along(&self, state: &State) -> (f64, f64) {
        let path = &self.scene.path;
        let (start, rate) = (path.at(0.0), path.rate());
        let tau = if path.turns_only() {
            (state.pose.phi - start.phi) / rate.phi
        } else {
            (state.pose.x - start.x) * rate.x + (state.pose.y - start.y) * rate.y
        };
        let at = path.at(tau);
        let length = self.scene.rod.length();
        let off = (at.x - state.pose.x).hypot(at.y - state.pose.y) / length + (at.phi - state.pose.phi).abs();
        (tau, off)
    }

    /// Length of one unit of the path in which tolerances are given.
    fn unit(&self) -> f64 {
        if self.scene.path.turns_only() { 1.0 } else { self.scene.rod.length() }
    }

    fn fault(&mut self, state: &State, what: &'static str, off: f64, event: bool) {
        let tau = self.along(state).0 / self.unit();
        self.verdict.faults.push(Fault { bad: Bad { what, off }, tau, phase: state.phase(), event });
    }

    fn judge(&mut self, state: &State, stable: bool, event: bool) {
        for Bad { what, off } in Case::new(self.scene, state).allowing_for_sensitivity().judge(self.outlines) {
            self.fault(state, what, off, event);
        }
        if stable && !state.certificate.stable {
            self.fault(state, "not stable by its certificate", 1.0, event);
        }
        if state.contacts.is_empty() && state.energy != 0.0 {
            self.fault(state, "a free rod is bent", state.energy, event);
        }
        let off = self.along(state).1;
        if off.is_nan() || off >= 1e-9 {
            self.fault(state, "a pose is off the path", off, event);
        }
    }

    /// States and events come in the order of the path.
    fn order(&mut self, items: &[Item]) {
        let mut at = f64::NEG_INFINITY;
        for item in items {
            let states = match item {
                Item::State(state) => vec![state],
                Item::Event(event) => vec![&event.before, &event.after],
            };
            for state in states {
                let tau = self.along(state).0 / self.unit();
                if tau < at - 1e-9 {
                    self.fault(state, "the path is gone back", at - tau, false);
                }
                at = at.max(tau);
            }
        }
        for pair in items.windows(2) {
            if let [Item::Event(a), Item::Event(b)] = pair
                && a.to() != b.from()
            {
                self.fault(&b.before, "an event does not start in the phase before", 1.0, true);
            }
            if let [Item::State(a), Item::State(b)] = pair
                && a.phase() != b.phase()
            {
                self.fault(b, "another phase without an event", 1.0, false);
            }
        }
    }

    /// A state at every step, but where a snap goes over it.
    fn spread(&mut self, states: &[&State], events: &[&Event], stop: Option<&Stop>) {
        let (step, unit) = (self.scene.step, self.unit());
        let length = stop.map_or(self.scene.path.length(), |stop| stop.tau);
        if states.is_empty() {
            return;
        }
        let jumped = |tau: f64| {
            events.iter().any(|event| {
                self.along(&event.before).0 - 1e-9 * unit <= tau && tau <= self.along(&event.after).0 + 1e-9 * unit
            })
        };
        let mut k = 0;
        let mut faults = Vec::new();
        for state in states {
            let tau = self.along(state).0;
            let here = (tau / step).round();
            if (tau - step * here).abs() > 1e-9 * unit {
                faults.push((*state, "a pose between the steps", (tau - step * here).abs() / unit));
                continue;
            }
            while f64::from(k) < here {
                if !jumped(step * f64::from(k)) {
                    faults.push((*state, "a pose to report is left out", step * f64::from(k) / unit));
                }
                k += 1;
            }
            k += 1;
        }
        // the last one may be lost to rounding
        let left = step * f64::from(k) < length * (1.0 - 1e-9) - 1e-9 * unit;
        if left && self.verdict.end == End::Done && !jumped(step * f64::from(k)) {
            faults.push((states[states.len() - 1], "the last poses are left out", step * f64::from(k) / unit));
        }
        for (state, what, off) in faults {
            self.fault(state, what, off, false);
        }
    }

    /// The same two phases to and fro more than three times at one place.
    fn chatter(&mut self, events: &[&Event]) {
        for (first, event) in events.iter().enumerate() {
            let here = self.along(&event.before).0;
            let near = |other: &&&Event| (self.along(&other.before).0 - here).abs() <= 1e-6 * self.unit();
            let same = |other: &&&Event| {
                other.kind == event.kind
                    && other.from() == event.from()
                    && other.to() == event.to()
                    && (event.kind != EventKind::Piece || other.before.contacts.len() == event.before.contacts.len())
            };
            let times = events[first..].iter().filter(near).filter(same).count();
            if times > 3 {
                self.fault(&event.before, "chatter", times as f64, true);
                return;
            }
        }
    }

    /// Why a stop does not look like an end that the problem itself has.
    fn doubt(&self, stop: &Stop, states: &[&State]) -> Option<String> {
        let length = self.scene.rod.length();
        let gap = |x: f64, y: f64| {
            let gaps = self.outlines.iter().map(|outline| outline.foot(x / length, y / length).gap);
            gaps.fold(f64::INFINITY, f64::min)
        };
        let clamp = gap(stop.pose.x, stop.pose.y);
        match stop.reason {
            StopReason::NoStart if clamp > 1e-9 => Some(format!("the clamp is outside by {clamp:.3e}")),
            StopReason::ClampInside if clamp > 0.02 => Some(format!("the clamp is outside by {clamp:.3e}")),
            StopReason::EndOfContour => {
                let last = states.last()?;
                let near = |c: &vibrissa::contact::Contact| {
                    self.outlines[c.object].distance_to_open_end(c.x / length, c.y / length)
                };
                // it may come upon an end from the side, anywhere along the rod
                let rod = Case::new(self.scene, last).rod;
                let points = (0..=100).map(|k| rod.at(0.01 * f64::from(k)));
                let from_rod =
                    points.flat_map(|at| self.outlines.iter().map(move |o| o.distance_to_open_end(at.x, at.y)));
                let least = last.contacts.iter().map(near).chain(from_rod).fold(f64::INFINITY, f64::min);
                (least > 0.2).then(|| format!("nothing is nearer to an end than {least:.3}"))
            }
            StopReason::LineContact => {
                // The end of the rod is straight: at an inflection its contact can become two, one on either side.
                let last = states.last()?;
                let case = Case::new(self.scene, last);
                let (contact, [x, y]) = (last.contacts.last()?, *case.points.last()?);
                let outline = &self.outlines[contact.object];
                let foot = outline.foot(x, y);
                let smooth = contact.kind == ContactKind::Tangent && outline.inflects_near(&foot, 0.1);
                smooth.then(|| "the last contact is at an inflection, where it can become two".to_owned())
            }
            _ => None,
        }
    }
}
