//! Starts in contact: what a short way along the path brings, or else the equilibrium of least energy; and the sweep says so.

use crate::common::judge::judge;
use crate::common::vibrissa;
use crate::random::dice::Dice;
use crate::random::generator;
use rayon::prelude::*;
use rod_files::{Scan, Scene};
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use vibrissa::contact::{Approach, Start, StartCandidate};
use vibrissa::{ClampPath, Pose, State, Sweep};

/// A clamp above a floor, the rod pointing down into it, that moves along the floor. Behind, the floor has an end, round which a rod
/// that comes along the path is rolled over.
const FLOOR: &str = r#"
[rod]
length = 1.0
bending_stiffness = 1.0

[[object]]
[[object.piece]]
shape = "polygon"
points = [[-2.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-2.0, 0.0]]

[sweep]
from = [0.0, 0.6]
to = [0.2, 0.6]
angle = -70.0
step = 0.1
"#;

/// Relative difference of energies by rounding.
const SAME: f64 = 1e-9;

fn candidates(start: Option<&Start>) -> &[StartCandidate] {
    match start {
        Some(Start::InContact(candidates)) => candidates,
        _ => &[],
    }
}

#[test]
fn above_a_floor_the_rod_is_bent_least() {
    let scan = Scan::run(Scene::parse("floor.toml".as_ref(), FLOOR).unwrap()).unwrap();
    judge(&scan.scene, &scan.outcome).unwrap();
    let found = candidates(scan.outcome.start.as_ref());
    let taken = found[0];
    assert!((taken.energy - scan.outcome.states[0].energy).abs() < SAME, "{found:?}");
    assert!(found.iter().all(|other| other.energy >= taken.energy * (1.0 - SAME)), "{found:?}");
    // the one that comes along the path is another
    let rolled = found.iter().find(|other| other.approach == Approach::AlongPath).unwrap();
    assert!(rolled.energy > 4.0 * taken.energy, "{found:?}");
}

#[test]
fn the_command_says_how_the_start_was_found() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("floor.toml"), FLOOR).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "floor.toml", "--out", "out"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success() && said.contains("starts in contact"), "{said}");
    let sweep: Value =
        serde_json::from_str(&fs::read_to_string(directory.path().join("out/sweep.json")).unwrap()).unwrap();
    let (start, reached) = (&sweep["start"], sweep["start"]["reached"].as_array().unwrap());
    assert_eq!(start["kind"], "in-contact");
    let energies: Vec<_> = reached.iter().map(|one| one["energy"].as_f64().unwrap()).collect();
    assert!(energies.is_sorted(), "{energies:?}");
    let free = FLOOR.replace("0.6]", "1.6]");
    fs::write(directory.path().join("free.toml"), free).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "free.toml", "--out", "out"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success() && !said.contains("starts in contact"), "{said}");
    let sweep: Value =
        serde_json::from_str(&fs::read_to_string(directory.path().join("out/sweep.json")).unwrap()).unwrap();
    assert_eq!(sweep["start"]["kind"], "free");
}

/// What a start in contact came to, beside the sweep that was there.
#[derive(Default)]
struct Counts {
    starts: usize,
    /// No equilibrium.
    none: usize,
    /// The same equilibrium as the sweep from outside, and what the first approach that leads anywhere would have come to.
    same: usize,
    same_by_first: usize,
    /// No more energy than the sweep from outside, and the same for the first approach.
    lower: usize,
    lower_by_first: usize,
}

impl Counts {
    fn add(mut self, other: Self) -> Self {
        self.starts += other.starts;
        self.none += other.none;
        self.same += other.same;
        self.same_by_first += other.same_by_first;
        self.lower += other.lower;
        self.lower_by_first += other.lower_by_first;
        self
    }
}

/// Starts at a state in contact of a sweep from outside, along its path or in any direction.
fn started(scene: &Scene, state: &State, along: bool, dice: &mut Dice) -> Counts {
    let length = scene.rod.length();
    let angle = dice.between(0.0, TAU);
    let way = if along {
        let (rate, angle) = (scene.path.rate(), if scene.path.turns_only() { 1.0 } else { 0.0 });
        (rate.x * length, rate.y * length, rate.phi * (length + angle))
    } else {
        (length * angle.cos(), length * angle.sin(), 0.0)
    };
    let pose = state.pose;
    let to = Pose { x: pose.x + 0.01 * way.0, y: pose.y + 0.01 * way.1, phi: pose.phi + 0.01 * way.2 };
    let path = ClampPath::new(pose, to).unwrap();
    let step = path.length();
    let mut sweep = Sweep::new(&scene.rod, &scene.objects, path, step).unwrap();
    let first = sweep.next();
    // the straight rod is free there, though one that came from outside is not
    if sweep.start() == Some(&Start::Free) {
        return Counts::default();
    }
    let found = candidates(sweep.start());
    let Some((Ok(_), taken)) = first.zip(found.first()) else {
        return Counts { starts: 1, none: 1, ..Counts::default() };
    };
    // in the order of the approaches
    let by_first = found.iter().min_by_key(|one| one.approach as u8).unwrap();
    let unit = 1e-9 * scene.rod.units().energy;
    let same = |one: &StartCandidate| {
        one.phase == state.phase() && (one.energy - state.energy).abs() <= 1e-6 * state.energy + unit
    };
    let lower = |one: &StartCandidate| one.energy <= state.energy * (1.0 + 1e-6) + unit;
    Counts {
        starts: 1,
        none: 0,
        same: usize::from(same(taken)),
        same_by_first: usize::from(same(by_first)),
        lower: usize::from(lower(taken)),
        lower_by_first: usize::from(lower(by_first)),
    }
}

fn study(seeds: std::ops::Range<u64>, along: bool) -> Counts {
    let counts = seeds.into_par_iter().map(|seed| {
        let scene = Scene::parse(format!("{seed}.toml").as_ref(), &generator::scene(seed).text).unwrap();
        let mut dice = Dice::new(seed);
        let outcome = scene.sweep().unwrap().run();
        let from_outside = outcome.start == Some(Start::Free);
        let touching: Vec<_> = outcome.states.iter().filter(|state| !state.contacts.is_empty()).collect();
        if !from_outside || touching.is_empty() {
            return Counts::default();
        }
        started(&scene, touching[dice.whole(0, touching.len() - 1)], along, &mut dice)
    });
    let counts = counts.reduce(Counts::default, Counts::add);
    let share = |n: usize| format!("{n} ({:.1} %)", 100.0 * n as f64 / counts.starts as f64);
    println!("{} starts {}", counts.starts, if along { "along the path" } else { "in any direction" });
    println!("no equilibrium                    {}", share(counts.none));
    println!("same as from outside              {}", share(counts.same));
    println!("  by the first approach           {}", share(counts.same_by_first));
    println!("no more energy than from outside  {}", share(counts.lower));
    println!("  by the first approach           {}", share(counts.lower_by_first));
    counts
}

#[test]
fn starts_along_the_path_are_those_of_the_sweep_from_outside() {
    let Counts { starts, none, same, .. } = study(0..100, true);
    assert!(starts > 40 && none == 0 && 10 * same >= 9 * starts, "{none} {same} of {starts}");
}

/// `STARTS=10000..12000` takes those random scenes.
#[test]
#[ignore = "takes a minute"]
fn starts_beside_sweeps_from_outside() {
    let seeds = std::env::var("STARTS").ok().and_then(|seeds| {
        let (first, end) = seeds.split_once("..")?;
        Some(first.parse().ok()?..end.parse().ok()?)
    });
    let seeds = seeds.unwrap_or(10_000..12_000);
    for along in [true, false] {
        let counts = study(seeds.clone(), along);
        assert!(counts.starts > 0);
    }
}
