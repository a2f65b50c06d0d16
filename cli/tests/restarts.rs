//! A sweep that goes on from a state follows the branch of that state, whichever way the clamp goes.
//!
//! Forward, the sweep that reported the state says what comes next; backward, it says what came before, as far as the last jump.
//! Sideways and turning there is no such record: there the clamp goes and comes back, and the rod must then be as it was. From a
//! jump on the way it goes back from the last state before it.

use crate::random::dice::Dice;
use crate::random::generator;
use rayon::prelude::*;
use rod_files::Scene;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use vibrissa::contact::{EventKind, Item, Outcome};
use vibrissa::{ClampPath, Event, Pose, State, Sweep};

/// Tolerances of lengths (L), angles, forces (E I / L^2), moments and energies, relative to 1 + their size: of the state that
/// is given, and of states that were gone to, which ill-conditioned ones exceed by their condition number.
const GIVEN: f64 = 1e-9;
const GONE: f64 = 1e-7;
const BY_CONDITION: f64 = 1e-13;
/// Distance (L) from an event within which another one counts as the same.
const AT_EVENT: f64 = 1e-6;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Direction {
    Forward,
    Backward,
    Sideways,
    Turning,
}

const DIRECTIONS: [Direction; 4] = [Direction::Forward, Direction::Backward, Direction::Sideways, Direction::Turning];

/// What came of a restart: none where nothing was to be compared.
type Verdict = Result<Option<Outcome>, String>;

/// A scene, all that its sweep came to, and where along the path.
struct Swept {
    scene: Scene,
    items: Vec<Item>,
}

fn swept(scene: Scene) -> Swept {
    let items = scene.sweep().unwrap().map_while(Result::ok).collect();
    Swept { scene, items }
}

/// Energy (E I / L) that rounding leaves of a rod that is hardly bent.
const NO_ENERGY: f64 = 1e-9;

impl Swept {
    /// Whether the rod leaves its branch; a first contact may be a jump, too.
    fn is_jump(&self, event: &Event) -> bool {
        let Event { kind, before, after, .. } = event;
        let units = self.scene.rod.units();
        matches!(kind, EventKind::Snap | EventKind::SnapOff | EventKind::SlipOver)
            || (before.pose.x - after.pose.x).hypot(before.pose.y - after.pose.y) > 0.0
            || (before.energy - after.energy).abs() > NO_ENERGY * units.energy
    }

    /// Way along the path, lengths of the rod or radians.
    fn tau(&self, pose: Pose) -> f64 {
        let path = &self.scene.path;
        let (start, rate) = (path.at(0.0), path.rate());
        if path.turns_only() {
            (pose.phi - start.phi) / rate.phi
        } else {
            ((pose.x - start.x) * rate.x + (pose.y - start.y) * rate.y) / self.scene.rod.length()
        }
    }

    /// What differs in two states, beyond a tolerance. At events contacts come and go without force, so that they are not
    /// compared there.
    fn difference(&self, a: &State, b: &State, contacts: bool, tolerance: f64) -> Option<String> {
        let units = self.scene.rod.units();
        let (length, force) = (units.length, units.force);
        let numbers = |s: &State| {
            let r = s.reactions;
            let mut all = vec![s.pose.x / length, s.pose.y / length, s.pose.phi];
            all.extend([r.f0x / force, r.f0y / force, r.m0z / (force * length), s.energy / (force * length)]);
            if contacts {
                all.extend(s.contacts.iter().flat_map(|c| [c.s / length, c.x / length, c.y / length, c.force / force]));
            }
            all
        };
        if contacts && a.phase() != b.phase() {
            return Some(format!("{} in place of {}", a.phase(), b.phase()));
        }
        let off = numbers(a)
            .iter()
            .zip(numbers(b))
            .map(|(a, b)| (a - b).abs() / (1.0 + b.abs()))
            .fold(0.0, |most: f64, off| if off.is_nan() { off } else { most.max(off) });
        (off.is_nan() || off > tolerance).then(|| format!("off by {off:.1e} ({})", a.phase()))
    }

    fn resumed(&self, state: &State, to: Pose, parts: f64) -> Result<Outcome, String> {
        let path = ClampPath::new(state.pose, to).map_err(|error| error.to_string())?;
        let step = path.length() / parts;
        let sweep = Sweep::from_state(&self.scene.rod, &self.scene.objects, state, path, step);
        let outcome = sweep.map_err(|error| error.to_string())?.run();
        let first = outcome.states.first().ok_or("no state at the first pose")?;
        match self.difference(first, state, true, GIVEN) {
            Some(off) => Err(format!("another state at the first pose: {off}")),
            None => Ok(outcome),
        }
    }

    /// The states and events that the sweep went through between a pose and at most `way` further along the path (or back).
    fn record(&self, from: f64, way: f64) -> (Vec<&State>, Vec<&Event>) {
        let within = |tau: f64| (tau - from) * way.signum() > AT_EVENT && (tau - from).abs() <= way.abs();
        let (mut states, mut events) = (Vec::new(), Vec::new());
        for item in &self.items {
            match item {
                Item::State(state) if within(self.tau(state.pose)) => states.push(state),
                Item::Event(event) if within(self.tau(event.pose())) => events.push(event),
                _ => {}
            }
        }
        if way < 0.0 {
            states.reverse();
            events.reverse();
        }
        (states, events)
    }

    /// From a state along the path of its own sweep, either way.
    fn along(&self, state: &State, contacts: bool, way: f64) -> Verdict {
        let from = self.tau(state.pose);
        let (mut states, mut events) = self.record(from, way);
        if way < 0.0 {
            // what was before a jump is on another branch
            let here = self.items.iter().any(|item| {
                matches!(item, Item::Event(event) if !std::ptr::eq(&raw const event.before, state)
                && self.is_jump(event) && (self.tau(event.after.pose) - from).abs() < AT_EVENT)
            });
            if here {
                return Ok(None);
            }
            let jump = events.iter().position(|event| self.is_jump(event));
            let end = jump.map_or(f64::NEG_INFINITY, |jump| self.tau(events[jump].after.pose));
            states.retain(|state| self.tau(state.pose) > end + AT_EVENT);
            events.truncate(jump.unwrap_or(events.len()));
        }
        let Some(last) = states.last() else {
            return Ok(None);
        };
        let end = self.tau(last.pose);
        events.retain(|event| (self.tau(event.pose()) - end) * way.signum() < -AT_EVENT);
        let outcome = self.resumed(state, last.pose, 1.0)?;
        let again: Vec<_> =
            outcome.events.iter().filter(|event| (self.tau(event.pose()) - from).abs() > AT_EVENT).collect();
        let name = |event: &&Event| {
            let (from, to) = (event.from().to_string(), event.to().to_string());
            if way < 0.0 { (to, from) } else { (from, to) }
        };
        let plain = |event: &&Event| (event.from().to_string(), event.to().to_string());
        let (ours, theirs): (Vec<_>, Vec<_>) = (again.iter().map(plain).collect(), events.iter().map(name).collect());
        let text = |all: &[(String, String)]| {
            all.iter().map(|(from, to)| format!("{from}>{to}")).collect::<Vec<_>>().join(" ")
        };
        if ours != theirs {
            return Err(format!("events {} in place of {} ({:?})", text(&ours), text(&theirs), outcome.stop));
        }
        for (ours, theirs) in again.iter().zip(&events) {
            let off = (self.tau(ours.pose()) - self.tau(theirs.pose())).abs();
            if off > GONE {
                return Err(format!("event {} off by {off:.1e}", ours.kind));
            }
        }
        if let Some(stop) = &outcome.stop {
            return Err(format!("stopped: {stop}"));
        }
        let Some(reached) = outcome.states.last().filter(|_| outcome.states.len() == 2) else {
            return Err("the last pose is left out".into());
        };
        let tolerance = GONE + BY_CONDITION * last.certificate.condition;
        let off = self.difference(reached, last, contacts, tolerance);
        off.map_or(Ok(Some(outcome)), |off| Err(format!("at the end {off}")))
    }

    /// From a state to a pose and back.
    fn there_and_back(&self, state: &State, contacts: bool, to: Pose) -> Verdict {
        let outcome = self.resumed(state, to, 3.0)?;
        let jump = outcome.events.iter().find(|event| self.is_jump(event));
        let farthest = match jump {
            Some(jump) => &jump.before,
            None => outcome.states.last().ok_or("no state")?,
        };
        let far = (farthest.pose.x - state.pose.x).hypot(farthest.pose.y - state.pose.y) / self.scene.rod.length()
            + (farthest.pose.phi - state.pose.phi).abs();
        if far < AT_EVENT {
            // a jump at once: that of an equilibrium that ends here, or none
            let ends = !contacts || state.certificate.condition > 1e5;
            return if ends { Ok(None) } else { Err(format!("jumps at once ({:?})", jump.map(|jump| jump.kind))) };
        }
        let back = self.resumed(farthest, state.pose, 1.0).map_err(|error| format!("back: {error}"))?;
        let why = || {
            let names = |all: &[Event]| {
                all.iter().map(|e| format!("{}:{}>{}", e.kind, e.from(), e.to())).collect::<Vec<_>>().join(" ")
            };
            format!(
                "there {} back {} from {}",
                names(&outcome.events),
                names(&back.events),
                if jump.is_some() { "a jump" } else { "the end" }
            )
        };
        if let Some(stop) = &back.stop {
            return Err(format!("back stopped: {stop} {}", why()));
        }
        let Some(again) = back.states.last().filter(|_| back.states.len() == 2) else {
            return Err(format!("back: the last pose is left out {}", why()));
        };
        let tolerance = GONE + BY_CONDITION * state.certificate.condition;
        match self.difference(again, state, contacts, tolerance) {
            Some(off) => Err(format!("back {off} {}", why())),
            None => Ok(Some(outcome)),
        }
    }

    fn restart(&self, direction: Direction, dice: &mut Dice) -> (String, Verdict) {
        let touching = |state: &&State| !state.contacts.is_empty();
        let of_states: Vec<_> = self
            .items
            .iter()
            .filter_map(|item| if let Item::State(state) = item { Some(state) } else { None })
            .filter(touching)
            .collect();
        let of_events: Vec<_> = self
            .items
            .iter()
            .flat_map(|item| {
                if let Item::Event(event) = item { vec![(&event.before, true), (&event.after, false)] } else { vec![] }
            })
            .filter(|(state, _)| touching(state))
            .collect();
        let at_event = of_states.is_empty() || (!of_events.is_empty() && dice.chance(0.25));
        let (state, is_before) = if at_event {
            if of_events.is_empty() {
                return (String::new(), Ok(None));
            }
            of_events[dice.whole(0, of_events.len() - 1)]
        } else {
            (of_states[dice.whole(0, of_states.len() - 1)], false)
        };
        let length = self.scene.rod.length();
        let rate = self.scene.path.rate();
        let sign = if dice.chance(0.5) { 1.0 } else { -1.0 };
        let way = dice.between(0.02, 0.2);
        let verdict = match direction {
            Direction::Forward => self.along(state, !at_event, way),
            Direction::Backward => self.along(state, !at_event, -way),
            Direction::Sideways => {
                let Pose { x, y, phi } = state.pose;
                let (sin, cos) =
                    if self.scene.path.turns_only() { phi.sin_cos() } else { rate.y.atan2(rate.x).sin_cos() };
                let way = sign * 0.5 * way * length;
                self.there_and_back(state, !at_event, Pose { x: x - way * sin, y: y + way * cos, phi })
            }
            Direction::Turning => {
                self.there_and_back(state, !at_event, Pose { phi: state.pose.phi + sign * way, ..state.pose })
            }
        };
        let what = format!(
            "{} {direction:?} way {way} sign {sign} at tau {:.9} {} {}",
            self.scene.name,
            self.tau(state.pose),
            state.phase(),
            if at_event { if is_before { "before an event" } else { "after an event" } } else { "" }
        );
        (what, verdict)
    }
}

fn nine_scans() -> Vec<Scene> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let names = ["O1", "O2", "O3"].into_iter().flat_map(|object| [20, 40, 60].map(|q| format!("{object}_q{q}.toml")));
    names.map(|name| Scene::read(&directory.join(name)).unwrap()).collect()
}

/// So many restarts of each scene in each direction: how many there were, and how many did not go on with the same branch.
fn restart_all(scenes: Vec<Scene>, times: usize) -> (BTreeMap<Direction, [usize; 3]>, Vec<String>) {
    let results: Vec<_> = scenes
        .into_par_iter()
        .enumerate()
        .flat_map_iter(|(number, scene)| {
            let swept = swept(scene);
            let mut dice = Dice::new(number as u64);
            let mut all = Vec::new();
            for direction in (0..times).flat_map(|_| DIRECTIONS) {
                let (what, verdict) = swept.restart(direction, &mut dice);
                all.push((direction, what, verdict));
            }
            all
        })
        .collect();
    let mut counts = BTreeMap::new();
    let mut failures = Vec::new();
    for (direction, what, verdict) in results {
        let count: &mut [usize; 3] = counts.entry(direction).or_default();
        match verdict {
            Ok(Some(_)) => count[0] += 1,
            Ok(None) => count[1] += 1,
            Err(why) => {
                count[2] += 1;
                failures.push(format!("{what}: {why}"));
            }
        }
    }
    (counts, failures)
}

fn table(counts: &BTreeMap<Direction, [usize; 3]>) -> String {
    let mut out =
        format!("{:10} {:>12} {:>20} {:>15}\n", "direction", "same branch", "nothing to compare", "another branch");
    for (direction, [same, none, other]) in counts {
        writeln!(out, "{:10} {same:12} {none:20} {other:15}", format!("{direction:?}")).unwrap();
    }
    out
}

fn check(scenes: Vec<Scene>, times: usize, most: usize) {
    let (counts, failures) = restart_all(scenes, times);
    println!("{}", table(&counts));
    failures.iter().for_each(|failure| println!("{failure}"));
    assert!(counts.values().all(|[same, none, _]| same > none), "too little was compared");
    assert!(failures.len() <= most, "{} went on with another branch", failures.len());
}

fn random(seeds: std::ops::Range<u64>) -> Vec<Scene> {
    let parse = |seed: u64| Scene::parse(format!("{seed}.toml").as_ref(), &generator::scene(seed).text).unwrap();
    seeds.map(parse).collect()
}

#[test]
fn restarts_of_the_nine_scans_follow_their_branch() {
    check(nine_scans(), 5, 0);
}

#[test]
fn restarts_of_random_scenes_follow_their_branch() {
    check(random(0..30), 2, 0);
}

/// `RESTARTS=100..400` restarts those random scenes alone.
#[test]
#[ignore = "takes minutes"]
fn ten_thousand_restarts() {
    if let Some((first, end)) = std::env::var("RESTARTS").ok().and_then(|seeds| {
        let (first, end) = seeds.split_once("..")?;
        Some((first.parse().ok()?, end.parse().ok()?))
    }) {
        check(random(first..end), 5, 0);
        return;
    }
    println!("nine scans");
    check(nine_scans(), 140, 0);
    println!("random scenes");
    check(random(0..250), 5, 25);
}
