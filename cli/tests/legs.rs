//! Paths of several legs in scene files: `[[sweep.leg]]`.

use crate::common::vibrissa;
use serde_json::Value;
use std::fs;
use std::path::Path;
use vibrissa_cli::Scene;

fn whisking() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/whisking.toml")).unwrap()
}

fn lines(file: &Path) -> Vec<Value> {
    fs::read_to_string(file).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn states_and_events_carry_their_leg() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("whisking.toml"), whisking()).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "whisking.toml", "--out", "out"]);
    assert!(output.status.success(), "{output:?}");
    let out = directory.path().join("out");
    let states = lines(&out.join("states.jsonl"));
    let legs: Vec<_> = states.iter().map(|state| state["leg"].as_u64().unwrap()).collect();
    assert!(legs.is_sorted() && legs.first() == Some(&0) && legs.last() == Some(&3));
    // the last pose of each leg
    for (leg, x0, phi0) in
        [(0, 0.0, 90_f64), (1, 8e-3 * 60_f64.to_radians().sin(), 30.0), (2, 0.0, 90.0), (3, 0.0, 90.0)]
    {
        let last = states.iter().rfind(|state| state["leg"] == leg).unwrap();
        assert!((last["x0"].as_f64().unwrap() - x0).abs() < 1e-15, "{last}");
        assert!((last["phi0"].as_f64().unwrap() - phi0.to_radians()).abs() < 1e-14, "{last}");
    }
    let events = lines(&out.join("events.jsonl"));
    let of = |leg: u64, kind: &str| {
        let event = events.iter().find(|event| event["leg"] == leg && event["kind"] == kind).unwrap();
        event["phi0"].as_f64().unwrap().to_degrees()
    };
    // the rod comes off the peg at an angle at which it is not yet back on the way back
    let (off, on) = (of(1, "snap-off"), of(2, "first-contact"));
    assert!((40.0..55.0).contains(&off) && on > off + 20.0, "{off} {on}");
    let svg = fs::read_to_string(out.join("sweep.svg")).unwrap();
    assert!(!svg.contains("NaN"));
    let table = fs::read_to_string(out.join("states.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + states.len());
    assert!(table.lines().last().unwrap().ends_with(",3"));
}

#[test]
fn recordings_have_no_several_legs() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("whisking.toml"), whisking()).unwrap();
    assert!(vibrissa(directory.path(), &["contour", "whisking.toml"]).status.success());
    let output = vibrissa(directory.path(), &["simulate", "whisking.toml"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && message.contains("sweep.leg"), "{message}");
    assert!(message.contains("only `sweep`, `contour` and `study` take"), "{message}");
    let study = "scene = \"whisking.toml\"\n[[parameter]]\nname = \"turn\"\nvalues = [-60.0]\nset = [{ field = \"sweep.leg[1].turn\" }]\n";
    fs::write(directory.path().join("study.toml"), study).unwrap();
    let output = vibrissa(directory.path(), &["study", "study.toml"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("1 done, 0 stopped early, 0 refused"), "{output:?}");
}

#[test]
fn what_is_wrong_in_a_leg_is_said() {
    let refused = |from: &str, to: &str| {
        let text = whisking();
        assert!(text.contains(from), "{from}");
        Scene::parse("legs.toml".as_ref(), &text.replacen(from, to, 1)).unwrap_err().to_string()
    };
    for (from, to, what) in [
        ("turn = -60.0 ", "turn = 0.0 ", "turn is 0"),
        ("turn = -60.0 ", "angle_to = 0.0 ", "both straight and about a pivot"),
        ("turn = -60.0 ", "#", "expected turn (degrees) beside it"),
        ("pivot = [0.0, -0.008]", "#", "expected pivot = [x, y] (m) beside it"),
        ("turn = -60.0 ", "turn = -6000.0 ", "at most 5729 degrees"),
        ("to = [0.0, -0.01]         #", "to = [0.0, 0.0] #", "the leg ends where it starts"),
        ("to = [0.0, -0.01]         #", "#", "leads nowhere"),
        ("to = [0.0, -0.01]         #", "angle_to = 80.0 #", "missing field `step_angle`"),
        (
            "to = [0.0, -0.01]         #",
            "to = [0.0, -0.01]\nstep_angle = 1.0 #",
            "step_angle is 1, but the clamp moves on this leg, expected step",
        ),
        ("to = [0.0, -0.01]         #", "to = [0.0, -0.01]\nstep = 1e-12 #", "at most 1e6"),
        ("to = [0.0, -0.01]         #", "too = [0.0, -0.01] #", "unknown field"),
    ] {
        let message = refused(from, to);
        assert!(message.contains(what), "{to}: {message}");
        assert!(message.starts_with("legs.toml:"), "{message}");
    }
}

/// A leg that turns on the spot was told to take its step from [sweep], which refused one in degrees.
#[test]
fn sweep_has_the_steps_of_all_legs() {
    let text = whisking().replacen("step = 5e-4", "step_angle = 2.0\nstep = 5e-4", 1);
    let text = text.replacen("to = [0.0, -0.01]         #", "angle_to = 80.0 #", 1);
    let scene = Scene::parse("legs.toml".as_ref(), &text).unwrap();
    assert!(
        (scene.legs[2].step - 2.0_f64.to_radians()).abs() < 1e-15 && scene.legs[1].step == 5e-4 && scene.step == 5e-4
    );
    assert!(Scene::parse("legs.toml".as_ref(), &whisking().replacen("step = 5e-4", "step_angle = 2.0", 1)).is_err());
}

#[test]
fn a_table_is_no_list_of_legs() {
    let text = whisking();
    let one = text.match_indices("[[sweep.leg]]").nth(1).map(|(second, _)| &text[..second]).unwrap();
    let error =
        Scene::parse("legs.toml".as_ref(), &one.replace("[[sweep.leg]]", "[sweep.leg]")).unwrap_err().to_string();
    assert!(error.contains("expected [[sweep.leg]] before each leg"), "{error}");
}
