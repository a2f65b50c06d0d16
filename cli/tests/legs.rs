//! Paths of several legs in scene files: `[[sweep.leg]]`.

use crate::common::vibrissa;
use rod_files::Scene;
use serde_json::Value;
use std::fs;
use std::path::Path;

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
    let leg = table.lines().next().unwrap().split(',').position(|name| name == "leg").unwrap();
    assert_eq!(table.lines().last().unwrap().split(',').nth(leg), Some("3"));
}

/// Legs were refused. The rows are those of the sweep, one each period, and the friction that is remembered at the turn is in them.
#[test]
fn a_recording_goes_there_and_back() {
    let directory = tempfile::tempdir().unwrap();
    let scene = include_str!("../../scenes/O1_q40.toml");
    let scene = scene.replace("to = [-0.09, -0.04]", "to = [0.03001, -0.04]").replace("step = 1e-3", "step = 5e-4");
    let scene = format!("{scene}\n[[sweep.leg]]\nto = [0.08, -0.04]\n\n[contact]\nfriction = 0.3\n");
    fs::write(directory.path().join("legs.toml"), &scene).unwrap();
    let output =
        vibrissa(directory.path(), &["simulate", "legs.toml", "--rate", "2", "--speed", "1e-3", "--file", "r.csv"]);
    assert!(output.status.success(), "{output:?}");
    let mut table = csv::Reader::from_path(directory.path().join("r.csv")).unwrap();
    let rows: Vec<[f64; 7]> = table.deserialize().map(Result::unwrap).collect();
    // 99.98 periods are 100
    assert_eq!(rows.len(), 201);
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(row[0], 0.5 * number as f64);
        let way = number.abs_diff(100) as f64 / 100.0;
        assert!((row[1] - (0.03001 + way * 0.04999)).abs() < 1e-15, "{row:?}");
    }
    let whole = scene.replace("step = 5e-4", "step = 4.999e-4");
    let scan = rod_files::Scan::run(Scene::parse("legs.toml".as_ref(), &whole).unwrap()).unwrap();
    let states = &scan.outcome.states;
    assert_eq!(states.len(), rows.len());
    for (row, state) in rows.iter().zip(states) {
        assert!((row[4] - state.reactions.f0x).abs() < 1e-11 && (row[6] - state.reactions.m0z).abs() < 1e-12);
    }
    let [there, back] = [80, 120].map(|number: usize| rows[number][4]);
    assert!((there - back).abs() > 0.1 * there.abs(), "{there} {back}");
}

/// A leg on which the clamp only turns takes the time in which the tip of the straight rod goes its way.
#[test]
fn a_recording_goes_about_a_pivot_and_turns_on_the_spot() {
    let directory = tempfile::tempdir().unwrap();
    let turn = "\n[[sweep.leg]]\nangle_to = 80.0\nstep_angle = 1.0\n";
    fs::write(directory.path().join("whisking.toml"), whisking() + turn).unwrap();
    let output = vibrissa(directory.path(), &["simulate", "whisking.toml", "--rate", "100", "--file", "r.csv"]);
    assert!(output.status.success(), "{output:?}");
    let mut table = csv::Reader::from_path(directory.path().join("r.csv")).unwrap();
    let rows: Vec<[f64; 7]> = table.deserialize().map(Result::unwrap).collect();
    // every 10 um: 10 mm, twice 60 degrees at 8 mm, 10 mm, and 10 degrees of a rod of 40 mm
    assert_eq!(rows.len(), 1 + 1000 + 2 * 838 + 1000 + 698);
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    let last = rows.last().unwrap();
    assert!((last[3] - 80_f64.to_radians()).abs() < 1e-14, "{last:?}");
}

#[test]
fn what_asks_for_one_leg_refuses_more() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("whisking.toml"), whisking()).unwrap();
    assert!(vibrissa(directory.path(), &["contour", "whisking.toml"]).status.success());
    let output = vibrissa(directory.path(), &["budget", "whisking.toml"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(1) && message.contains("sweep.leg"), "{message}");
    assert!(
        message.contains("only `sweep`, `contour`, `study`, `simulate` and `reconstruct --truth` take"),
        "{message}"
    );
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
    assert!(error.contains("expected a list of tables: [[sweep.leg]] with two brackets"), "{error}");
}
