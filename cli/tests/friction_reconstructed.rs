//! Recordings of rods that rub, as a user reconstructs, calibrates and plans them.

use crate::common::{complaint, vibrissa};
use serde_json::Value;
use std::fs;
use std::path::Path;

const SCENE: &str = include_str!("../../scenes/O1_q40.toml");
const NOISE: &str = "ar1 = { force = 2.5e-3, m0z = 6e-5, correlation = 0.45 }\n";

/// A directory with scene.toml, whose contacts rub, and noise.toml.
fn directory(mu: f64) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), format!("{SCENE}\n[contact]\nfriction = {mu}\n")).unwrap();
    fs::write(directory.path().join("noise.toml"), NOISE).unwrap();
    directory
}

fn done(directory: &Path, status: i32, arguments: &[&str]) -> (String, String) {
    let output = vibrissa(directory, arguments);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {}", complaint(&output));
    (String::from_utf8(output.stdout.clone()).unwrap(), complaint(&output))
}

fn json(directory: &Path, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(directory.join(name)).unwrap()).unwrap()
}

#[test]
fn friction_that_nobody_asked_for_is_never_silent() {
    let noisy = ["--noise", "noise.toml", "--seed", "7"].as_slice();
    let local = ["--local"].as_slice();
    for (mu, noise, how) in [(0.05, noisy, &[][..]), (0.1, &[], local), (0.3, noisy, local)] {
        let directory = directory(mu);
        let path = directory.path();
        done(path, 0, &[&["simulate", "scene.toml", "--rate", "50", "--file", "r.csv"], noise].concat());
        let reconstruct = ["reconstruct", "r.csv", "--rod", "scene.toml", "--truth", "scene.toml", "--out", "out"];
        let reconstruct = [&reconstruct[..], how].concat();
        let (_, complaint) = done(path, 2, &reconstruct);
        assert!(complaint.contains("the contacts have friction: a coefficient mu = "), "{mu}: {complaint}");
        let (report, _) = done(path, 0, &[&reconstruct[..], &["--friction", "estimate"]].concat());
        let found = json(path, "out/report.json");
        let [estimate, sigma] = ["mu", "sigma"].map(|of| found["friction"][0][of].as_f64().unwrap());
        let median = found["truth"]["single"]["median"].as_f64().unwrap();
        println!("{mu}: {estimate} +- {sigma:.1e}, median {median:.1e} m");
        assert!((estimate - mu).abs() < 1e-3 && median < 5e-5, "{mu}: {estimate} {median}");
        // in noise an ordinary laboratory knows its clamp less well than such a scan tells friction
        assert_eq!(report.contains("; poorly separated from "), !noise.is_empty(), "{report}");
    }
}

#[test]
fn errors_of_the_laboratory_hide_no_friction() {
    let directory = directory(0.05);
    let path = directory.path();
    let record = ["simulate", "scene.toml", "--rate", "50", "--noise", "noise.toml", "--seed", "7", "--file", "r.csv"];
    done(path, 0, &record);
    for sign in [1.0, -1.0] {
        let mut text = String::from("t,x0,y0,phi0,f0x,f0y,m0z\n");
        for row in csv::Reader::from_path(path.join("r.csv")).unwrap().records() {
            let mut row: Vec<f64> = row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect();
            row[3] -= sign * 0.5_f64.to_radians();
            row[4] += sign * 1e-3;
            row[5] = row[5] * (1.0 + sign * 0.02) + sign * 1e-3;
            text += &(row.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n");
        }
        fs::write(path.join("p.csv"), text).unwrap();
        let reconstruct = ["reconstruct", "p.csv", "--rod", "scene.toml", "--local", "--out", "out"];
        let (_, complaint) = done(path, 2, &reconstruct);
        assert!(complaint.contains("the contacts have friction: a coefficient mu = "), "{sign}: {complaint}");
        done(path, 0, &[&reconstruct[..], &["--friction", "estimate"]].concat());
        let found = json(path, "out/report.json");
        let [mu, sigma] = ["mu", "sigma"].map(|of| found["friction"][0][of].as_f64().unwrap());
        println!("{sign}: {mu} +- {sigma}");
        assert!((mu - 0.05).abs() < 3.0 * sigma && sigma < 0.02, "{mu} {sigma}");
    }
}

/// The rod at O1 to x0 = -20 mm and back, as it would be recorded by an untared sensor with an error of gain and angle.
fn there_and_back(directory: &Path, mu: f64) {
    let legs = SCENE.replace("to = [-0.09, -0.04]", "to = [-0.02, -0.04]").replace("step = 1e-3", "step = 2e-5");
    let scene = format!("{legs}\n[[sweep.leg]]\nto = [0.08, -0.04]\n\n[contact]\nfriction = {mu}\n");
    fs::write(directory.join("legs.toml"), scene).unwrap();
    done(directory, 0, &["sweep", "legs.toml", "--out", "sweep"]);
    let noise = vibrissa::reconstruct::NoiseModel {
        white: vibrissa::rod::Reactions { f0x: 5e-4, f0y: 5e-4, m0z: 2e-5 },
        ..Default::default()
    };
    let mut sensor = noise.generator(3).unwrap();
    let mut table = csv::Reader::from_path(directory.join("sweep/states.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let mut text = String::from("t,x0,y0,phi0,f0x,f0y,m0z\n");
    for (number, row) in table.records().enumerate() {
        let row = row.unwrap();
        let [x0, y0, phi0, f0x, f0y, m0z] = ["x0", "y0", "phi0", "f0x", "f0y", "m0z"].map(|name| {
            let column = head.iter().position(|head| head == name).unwrap();
            row[column].parse::<f64>().unwrap()
        });
        let felt = sensor.sample(vibrissa::rod::Reactions { f0x: f0x + 1e-3, f0y: 1.01 * f0y + 1e-3, m0z }).unwrap();
        let (t, phi0) = (0.02 * number as f64, phi0 - 0.3_f64.to_radians());
        text += &format!("{t},{x0},{y0},{phi0},{},{},{}\n", felt.f0x, felt.f0y, felt.m0z);
    }
    fs::write(directory.join("both.csv"), &text).unwrap();
    // the same without the way back
    let half = text.lines().count() / 2;
    fs::write(directory.join("there.csv"), text.lines().take(half).collect::<Vec<_>>().join("\n") + "\n").unwrap();
}

/// What `calibrate` says of friction: the estimate and its standard deviation.
fn calibrated(directory: &Path, recordings: &[&str]) -> (f64, f64, String) {
    let options = ["--rod", "legs.toml", "--friction", "estimate", "--out", "rod.toml"];
    let (report, _) = done(directory, 0, &[&["calibrate"], recordings, &options].concat());
    let row = report.lines().find(|line| line.trim_start().starts_with("friction of ")).unwrap();
    let numbers: Vec<f64> = row.split_whitespace().filter_map(|cell| cell.parse().ok()).collect();
    // unit, known, budget, estimate, sigma
    (numbers[3], numbers[4], report)
}

#[test]
fn a_scan_there_and_back_tells_friction_from_gain_and_angle() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    there_and_back(path, 0.2);
    let (alone, of_alone, report) = calibrated(path, &["there.csv"]);
    println!("{report}");
    assert!((alone - 0.2).abs() < 3.0 * of_alone && of_alone > 5e-3, "{alone} {of_alone}");
    // what one direction does not tell apart is said
    assert!(
        report.contains("friction of there.csv: mu = 0.") && report.contains("; poorly separated from "),
        "{report}"
    );
    let (both, of_both, report) = calibrated(path, &["both.csv"]);
    println!("{report}");
    assert!((both - 0.2).abs() < 3.0 * of_both && of_both < 0.3 * of_alone, "{both} {of_both}");
    assert!(!report.contains("; poorly separated from "), "{report}");
    // friction is of the objects: the file of the rod does not have it
    assert!(!fs::read_to_string(path.join("rod.toml")).unwrap().contains("friction"));
}

/// Where the clamp turns, the contact rolls before it slips back: no sample of it has a point that is off, and friction of the wrong sign is
/// not taken for granted.
#[test]
fn a_contact_that_rolls_where_the_clamp_turns_has_no_point_that_is_off() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    there_and_back(path, 0.3);
    let lines = |name: &str| fs::read_to_string(path.join(name)).unwrap();
    let rows: Vec<(usize, f64, f64, bool)> = csv::Reader::from_path(path.join("sweep/contacts.csv"))
        .unwrap()
        .deserialize::<std::collections::HashMap<String, String>>()
        .map(|row| {
            let row = row.unwrap();
            let number = |name: &str| row[name].parse::<f64>().unwrap();
            (number("state") as usize, number("x"), number("y"), row["mode"] == "stick")
        })
        .collect();
    let rolls = rows.iter().filter(|row| row.3).count();
    assert!(rolls > 10, "{rolls} samples");
    let options = ["reconstruct", "both.csv", "--rod", "legs.toml", "--out", "out", "--friction"];
    for friction in ["estimate", "0.3+-0.02"] {
        done(path, 0, &[&options[..], &[friction]].concat());
        let points: Vec<Value> =
            lines("out/points.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        let (mut slid, mut off) = (0, 0.0_f64);
        for (state, x, y, rolls) in &rows {
            let point = &points[*state];
            let (Some(px), Some(py)) = (point["x"].as_f64(), point["y"].as_f64()) else { continue };
            slid += usize::from(!rolls);
            off = off.max((px - x).hypot(py - y));
        }
        println!("{friction}: {slid} of {} have a point, {off:.1e} m at most", rows.len() - rolls);
        assert!(off < 2e-3 && 10 * slid > 9 * (rows.len() - rolls), "{friction}: {off} {slid}");
    }
    // without friction it does not fit; a contour for all of it would be looked for in vain
    let (_, complaint) = done(path, 2, &[&options[..], &["none", "--local"]].concat());
    assert!(complaint.contains("the contacts have friction"), "{complaint}");
}

/// Scenes with legs were refused as truth. A pose that is on both ways is compared with the way that the recording was on.
#[test]
fn a_recording_there_and_back_is_compared_with_its_scene() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let scene = SCENE.replace("to = [-0.09, -0.04]", "to = [-0.055, -0.04]") + "\n[[sweep.leg]]\nto = [0.08, -0.04]\n";
    fs::write(path.join("scene.toml"), format!("{scene}\n[contact]\nfriction = 0.3\n")).unwrap();
    done(path, 0, &["simulate", "scene.toml", "--rate", "50", "--file", "r.csv"]);
    let reconstruct = ["reconstruct", "r.csv", "--rod", "scene.toml", "--truth", "scene.toml", "--out", "out"];
    let (report, _) = done(path, 0, &[&reconstruct[..], &["--friction", "estimate"]].concat());
    println!("{report}");
    let found = json(path, "out/report.json");
    let truth = &found["truth"];
    assert!(truth["compared"] == 13501 && truth["off_path"] == 0, "{truth}");
    assert!(
        truth["accuracy"].as_f64().unwrap() > 0.99 && truth["single"]["median"].as_f64().unwrap() < 5e-5,
        "{truth}"
    );
    let transitions = truth["transitions"].as_array().unwrap();
    // BB and BA begin and end at other poses on the way back
    let at = |from: &str, to: &str| {
        let one = transitions.iter().find(|one| one["from"] == from && one["to"] == to).unwrap();
        (one["pose"]["x0"].as_f64().unwrap(), one["error"].as_f64().unwrap())
    };
    let [there, back] = [at("B", "BB"), at("BB", "B")];
    assert!((there.0 - back.0).abs() > 1e-3 && there.1.abs() < 1e-4 && back.1.abs() < 1e-4, "{there:?} {back:?}");
}

/// A wrong coefficient was blamed on K that varies, and on units.
#[test]
fn a_wrong_coefficient_is_named() {
    let directory = directory(0.3);
    let path = directory.path();
    done(path, 0, &["simulate", "scene.toml", "--rate", "50", "--noise", "noise.toml", "--file", "r.csv"]);
    let reconstruct = |friction: &str, status: i32| {
        let options = ["reconstruct", "r.csv", "--rod", "scene.toml", "--out", "out", "--friction"];
        let (_, complaint) = done(path, status, &[&options[..], &[friction]].concat());
        (complaint, json(path, "out/report.json")["friction"][0]["alone"].clone())
    };
    for friction in ["0.1", "0.1+-0.02"] {
        let (complaint, alone) = reconstruct(friction, 2);
        assert!(complaint.contains("the given coefficient of friction is 0.1000, the recording gives "), "{complaint}");
        assert!(complaint.contains("friction with mu = 0.30: 100 %") && !complaint.contains(" mN"), "{complaint}");
        let [mu, sigma, given, deviation] = ["mu", "sigma", "given", "deviation"].map(|of| alone[of].as_f64().unwrap());
        let apart = (mu - given) / if friction == "0.1" { sigma } else { sigma.hypot(0.02) };
        assert!((mu - 0.3).abs() < sigma && given == 0.1 && (deviation - apart).abs() < 1e-9, "{alone}");
    }
    for friction in ["0.3", "0.31+-0.02"] {
        let (complaint, alone) = reconstruct(friction, 0);
        assert!(!complaint.contains("was given") && alone["deviation"].as_f64().unwrap() < 2.0, "{complaint} {alone}");
    }
}

/// Of such a scan forces in mN were called the likely cause, beside friction that explains it exactly.
#[test]
fn units_are_no_cause_of_what_friction_explains() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let scene = include_str!("../../scenes/O3_q40.toml");
    fs::write(path.join("scene.toml"), format!("{scene}\n[contact]\nfriction = 0.3\n")).unwrap();
    done(path, 0, &["simulate", "scene.toml", "--rate", "20", "--file", "r.csv"]);
    let (_, complaint) = done(path, 2, &["reconstruct", "r.csv", "--rod", "scene.toml", "--out", "out"]);
    assert!(complaint.contains("the contacts have friction: a coefficient mu = 0.3000"), "{complaint}");
    assert!(complaint.contains("causes among the tested ones: friction with mu = 0.30: 100 %"), "{complaint}");
}

/// `live` said nothing of it.
#[test]
fn a_live_scan_tells_of_friction() {
    let directory = directory(0.3);
    let path = directory.path();
    let live = ["live", "--sensor", "file:r.csv", "--rod", "scene.toml", "--out", "out"];
    for (mu, status) in [("0.3", 2), ("0", 0)] {
        let scene =
            fs::read_to_string(path.join("scene.toml")).unwrap().replace("friction = 0.3", &format!("friction = {mu}"));
        fs::write(path.join("of.toml"), scene).unwrap();
        done(path, 0, &["simulate", "of.toml", "--rate", "50", "--noise", "noise.toml", "--file", "r.csv"]);
        let (said, _) = done(path, status, &live);
        let tells = said.contains("the contacts have friction: a coefficient mu = 0.3");
        assert!(tells == (status == 2), "{mu}: {said}");
        let summary = fs::read_to_string(path.join("out/summary.json")).unwrap();
        assert_eq!(summary.contains("the contacts have friction"), tells);
    }
}

#[test]
fn a_piece_with_another_coefficient_is_told() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let scene = SCENE.replacen("coefficient = 50.0 # 1/m", "coefficient = 50.0\nfriction = 0.1", 1)
        + "\n[contact]\nfriction = 0.2\n";
    fs::write(path.join("scene.toml"), scene).unwrap();
    fs::write(path.join("noise.toml"), NOISE).unwrap();
    for noise in [[].as_slice(), &["--noise", "noise.toml"]] {
        done(path, 0, &[&["simulate", "scene.toml", "--rate", "100", "--file", "r.csv"], noise].concat());
        let (_, complaint) = done(path, 2, &["reconstruct", "r.csv", "--rod", "scene.toml", "--friction", "estimate"]);
        assert!(complaint.contains("K over 2 |F| along tangential contacts varies by "), "{complaint}");
    }
}

#[test]
fn a_budget_counts_what_is_known_of_friction() {
    let directory = directory(0.2);
    let path = directory.path();
    let sources = |options: &[&str]| {
        let all = [&["budget", "scene.toml", "--rate", "20", "--out", "out"], options].concat();
        let (report, _) = done(path, 0, &all);
        let record = json(path, "out/budget.json");
        let find = |source: &&Value| source["source"] == "friction";
        (report, record["sources"].as_array().unwrap().iter().find(find).cloned(), record)
    };
    // the friction of the scene, of which nothing is known
    let (report, friction, record) = sources(&["--runs", "2"]);
    println!("{report}");
    let friction = friction.unwrap();
    let [budget, left, before, after] = ["budget", "left", "before", "after"].map(|of| friction[of].as_f64().unwrap());
    assert!(budget == 0.3 && left < 0.05 && after < 0.2 * before && after > 0.0, "{friction}");
    let [known, shared] = ["shared_with_known_friction", "shared_after"].map(|of| record[of].as_f64().unwrap());
    assert!(known < shared && report.contains("with an exactly known coefficient of friction"), "{known} {shared}");
    for run in record["runs"].as_array().unwrap() {
        assert!(run["labels_right"].as_f64().unwrap() > 0.95 && run["median"].as_f64().unwrap() < 3e-3, "{run}");
    }
    // what is known of it is a prior, and leaves less
    let (_, prior, of_prior) = sources(&["--runs", "0", "--friction", "0.2+-0.004"]);
    let prior = prior.unwrap();
    assert!(prior["budget"] == 0.004 && prior["left"].as_f64().unwrap() < left.min(0.004), "{prior}");
    assert!(of_prior["shared_after"].as_f64().unwrap() < shared, "{of_prior}");
    // known exactly it is no error
    let (report, none, exact) = sources(&["--runs", "0", "--friction", "0.2"]);
    assert!(none.is_none() && exact["shared_with_known_friction"].is_null() && !report.contains("coefficient"));
}
