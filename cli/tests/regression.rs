//! Defects that were, each with the scene that showed it.

use crate::common::judge::judge;
use rod_files::{Scan, Scene};
use std::path::Path;
use vibrissa::Event;
use vibrissa::contact::StopReason;

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

/// Thin and small things in the way of a rod were passed over within a step: at other reporting steps there were other events.
#[test]
fn thin_things_are_met_at_every_step() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/thin");
    for file in std::fs::read_dir(folder).unwrap() {
        let file = file.unwrap().path();
        let run = |factor: f64| {
            let mut scene = Scene::read(&file).unwrap();
            scene.step *= factor;
            let scan = Scan::run(scene).unwrap();
            let unit = scan.scene.rod.length();
            let place = |event: &Event| (event.pose().x / unit, event.pose().y / unit, event.pose().phi);
            let events: Vec<_> = scan.outcome.events.iter().map(|event| (event.kind, place(event))).collect();
            (scan.outcome.stop.map(|stop| stop.reason), events)
        };
        let usual = run(1.0);
        assert!(!usual.1.is_empty(), "{}", file.display());
        for factor in [7.69, 0.137] {
            let other = run(factor);
            assert_eq!((other.0, other.1.len()), (usual.0, usual.1.len()), "{} x{factor}", file.display());
            for ((kind, a), (other_kind, b)) in usual.1.iter().zip(&other.1) {
                let off = (a.0 - b.0).abs().max((a.1 - b.1).abs()).max((a.2 - b.2).abs());
                assert!(kind == other_kind && off < 1e-9, "{} x{factor}: {kind} {other_kind} {off:e}", file.display());
            }
        }
    }
}

/// A clamp went through a thin blade at coarse steps.
#[test]
fn a_clamp_does_not_go_through_a_blade() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/blade_in_the_way_of_the_clamp.toml");
    for factor in [1.0, 0.1, 7.0] {
        let mut scene = Scene::read(&file).unwrap();
        scene.step *= factor;
        let stop = Scan::run(scene).unwrap().outcome.stop.unwrap();
        assert_eq!(stop.reason, StopReason::ClampInside, "x{factor}");
    }
}
