//! The scenes with many contacts, with corners, and with objects on both sides of the rod.

use crate::common::judge::{is_pushed_from_both_sides, judge};
use rod_files::{Scan, Scene};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use vibrissa::Event;
use vibrissa::contact::{EventKind, Phase};

/// Scene, phases, and the largest number of contacts that any state has.
const SCENES: [(&str, &str, usize); 14] = [
    ("bay", "A BA BBA BBBA BBA BBBA BBA", 4),
    ("bumps", "A B BB BA B BB BA B BB BBB BBA BB BBB BB BA BBA BBBA BBA BB BBB BB B", 4),
    ("channel", "A B BA BB BBA BBB BBBA BBBB", 4),
    ("comb", "B BB BA B BB BA B BB BA BBA BA B BB BBB BB BA BBA BB BBB BB BBB BB BA BBA BBBA BBB BB B", 4),
    ("gears", "B BB B BB BBB BB BBB BB BBB BB BBB BB BBB BB BBB", 3),
    ("pegs", "B BB BBB BBA BB", 3),
    ("ring_gear", "A BA BBA", 3),
    ("ripples", "B BB BA B BA B BA B BB BA BBA BA B BB BBB BB BA BBA BBBA BBB BB BBB BBA BA BBA BB B A", 4),
    (
        "saw",
        "B BA B BA B BB BBB BB BA B BB BBB BA B BB BBB BB BBA BB BBB BB BBB BB BBA BB BBB BB BBB BB BA BBA BB B A",
        3,
    ),
    ("scallops", "A B BB BA B BB BA B BB BA BBA BA B BB BBB BB BA BBA BB BBB BB BBB BBA BBBA BBA BB BBB BB BA B", 4),
    ("square_flush", "B A", 1),
    ("square_tilted", "B A B", 1),
    ("triangle", "A B", 1),
    ("whisking", "B A free B A", 1),
];

/// Object O1 with another rod or another clamp.
const OTHER_RODS: [&str; 2] = ["sections", "springs"];

/// Those with objects on both sides of the rod.
const THREADED: [&str; 3] = ["channel", "gears", "pegs"];

/// Those in which the rod meets the object between two contacts it has.
const BETWEEN: [&str; 6] = ["bumps", "gears", "pegs", "ripples", "saw", "scallops"];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes")
}

fn swept(name: &str) -> Scan {
    Scan::run(Scene::read(&folder().join(name).with_extension("toml")).unwrap()).unwrap()
}

/// Whether the contact that came is neither the first nor the last one.
fn comes_between(event: &Event) -> bool {
    let [before, after] = [&event.before, &event.after].map(|state| &state.contacts);
    let same = |i: usize, j: usize| (before[i].s - after[j].s).abs() < 1e-9;
    event.kind == EventKind::Touch
        && after.len() == before.len() + 1
        && before.len() >= 2
        && same(0, 0)
        && same(before.len() - 1, after.len() - 1)
}

#[test]
fn every_scene_but_those_of_the_paper_is_in_the_table() {
    let files = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let names: BTreeSet<String> = files.map(|file| file.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let of_one_object = |name: &&str| {
        name.starts_with('O') || name.starts_with("whisker") || *name == "there_and_back" || OTHER_RODS.contains(name)
    };
    let others: Vec<&str> = names.iter().map(String::as_str).filter(|name| !of_one_object(name)).collect();
    assert_eq!(others, SCENES.map(|(name, ..)| name));
    // nine of the paper, one of them again with a roller, on springs, with sections and with friction, and two with a rod that tapers
    assert_eq!(names.len(), others.len() + 15);
}

#[test]
fn the_scenes_of_other_rods_come_to_their_end() {
    for (name, phases) in OTHER_RODS.into_iter().zip(["A B BB BA B", "A B BB BA B A"]) {
        let scene = Scene::read(&folder().join(name).with_extension("toml")).unwrap();
        assert!(scene.rod.varying().is_some() || !scene.rod.is_held_rigidly(), "{name} is uniform");
        let scan = Scan::run(scene).unwrap();
        assert!(scan.is_complete() && scan.scene.warnings.is_empty(), "{name}");
        assert_eq!(scan.cycle().to_string(), phases, "{name}");
    }
}

#[test]
fn every_scene_gives_its_phases_and_nothing_but_equilibria() {
    let mut between = Vec::new();
    for (name, phases, most) in SCENES {
        let scan = swept(name);
        judge(&scan.scene, &scan.outcome).unwrap();
        assert_eq!(scan.cycle().to_string(), phases, "{name}");
        let events = scan.outcome.events.iter().flat_map(|event| [event.from(), event.to()]);
        let counts = scan.outcome.states.iter().map(|state| state.phase()).chain(events).map(|phase| phase.contacts);
        assert_eq!(counts.max(), Some(most), "{name}");
        if scan.outcome.events.iter().any(comes_between) {
            between.push(name);
        }
        let threaded = scan.outcome.states.iter().any(|state| is_pushed_from_both_sides(state, &scan.scene));
        assert_eq!(threaded, THREADED.contains(&name), "{name}: contacts on both sides");
        assert_eq!(scan.outcome.states.first().map(|state| state.phase()), Some(Phase::FREE), "{name} starts free");
    }
    assert_eq!(between, BETWEEN, "a contact between others");
}
