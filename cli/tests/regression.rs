//! Defects that were, each with the scene that showed it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::judge::judge;
use std::path::Path;
use vibrissa_cli::{Scan, Scene};

fn swept(name: &str) -> Scan {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    Scan::run(Scene::read(&file).unwrap()).unwrap()
}

/// A contact at the tip was reported beyond it by rounding, and the rod's shape could not be drawn.
#[test]
fn no_contact_is_beyond_the_tip() {
    let scan = swept("tip_by_rounding.toml");
    assert!(scan.outcome.states.len() > 10);
    for state in &scan.outcome.states {
        assert!(state.contacts.iter().all(|contact| contact.s <= scan.scene.rod.length()));
        state.elastica(&scan.scene.rod).unwrap();
    }
    for event in &scan.outcome.events {
        event.before.elastica(&scan.scene.rod).unwrap();
        event.after.elastica(&scan.scene.rod).unwrap();
    }
}

/// Sweeps that stopped early: a tip at the very height of a corner, rods pushed against sides and vertices, contacts that come
/// between others.
#[test]
fn sweeps_that_stopped_go_through() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mended");
    let mut seen = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let scan = Scan::run(Scene::read(&file.unwrap().path()).unwrap()).unwrap();
        judge(&scan.scene, &scan.outcome).unwrap();
        seen += 1;
    }
    assert!(seen >= 9);
}
