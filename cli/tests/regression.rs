//! Defects that were, each with the scene that showed it.
#![allow(clippy::unwrap_used)]

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
