//! Faults of sensor, frame and recording that an inversion must see through, or tell.

use crate::common::{complaint, vibrissa};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

const NOISE: &str = "[white]\nforce = 5e-4\nm0z = 2e-5\n";
const ROD: &str = "[rod]\nlength = 0.1\nbending_stiffness = 6.32e-4\n";

/// A directory with a noisy recording r.csv of a scene, and its rod.
fn recorded(scene: &str, rate: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    for (name, text) in [("scene.toml", scene), ("noise.toml", NOISE), ("rod.toml", ROD)] {
        fs::write(path.join(name), text).unwrap();
    }
    let all = ["simulate", "scene.toml", "--noise", "noise.toml", "--seed", "4", "--rate", rate, "--file", "r.csv"];
    let output = vibrissa(path, &all);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    directory
}

const O1: &str = include_str!("../../scenes/O1_q40.toml");

/// Writes the recording `to` with edited rows: number of the row, and t, x0, y0, phi0, f0x, f0y, m0z.
fn edited(directory: &Path, to: &str, edit: impl Fn(usize, &mut [f64])) {
    let mut table = csv::Reader::from_path(directory.join("r.csv")).unwrap();
    let names = table.headers().unwrap().iter().collect::<Vec<_>>().join(",");
    let mut text = format!("{names}\n");
    for (k, row) in table.deserialize::<Vec<f64>>().enumerate() {
        let mut row = row.unwrap();
        edit(k, &mut row);
        text += &row.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
        text += "\n";
    }
    fs::write(directory.join(to), text).unwrap();
}

fn reconstruct(directory: &Path, recordings: &[&str], out: &str) -> Output {
    let tail = ["--rod", "rod.toml", "--out", out];
    vibrissa(directory, &[&["reconstruct"], recordings, &tail].concat())
}

/// The same without the search for one contour, which takes most of the time.
fn locally(directory: &Path, recordings: &[&str], out: &str) -> Output {
    reconstruct(directory, &[recordings, &["--local"]].concat(), out)
}

fn points(directory: &Path, out: &str) -> Vec<Value> {
    let text = fs::read_to_string(directory.join(out).join("points.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn number(line: &Value, field: &str) -> f64 {
    line[field].as_f64().unwrap()
}

#[test]
fn a_stuck_a_lost_and_a_saturated_sensor_are_told() {
    let directory = recorded(O1, "50");
    let path = directory.path();
    let inside = |k: usize| (1800..2000).contains(&k);
    let lost = |k: usize, row: &mut [f64]| row[4..7].iter_mut().filter(|_| inside(k)).for_each(|v| *v = 0.0);
    let stuck = |k: usize, row: &mut [f64]| {
        if inside(k) {
            row[4..7].copy_from_slice(&[0.03, 0.21, -0.015]);
        }
    };
    edited(path, "lost.csv", lost);
    edited(path, "stuck.csv", stuck);
    // the moment is up to 23 mN m
    edited(path, "saturated.csv", |_, row| row[6] = row[6].clamp(-0.0215, 0.0215));
    for name in ["lost", "stuck", "saturated"] {
        let way = if name == "lost" { reconstruct } else { locally };
        let output = way(path, &[&format!("{name}.csv")], name);
        let message = complaint(&output);
        assert!(
            message.contains("are left out: a reaction stays exactly the same for 40 samples or more"),
            "{message}"
        );
        let points = points(path, name);
        let told =
            |line: &Value| line["reason"].as_str().is_some_and(|reason| reason.contains("stays exactly the same"));
        let count = points.iter().filter(|line| told(line)).count();
        assert!(count >= 190 && points.iter().all(|line| !told(line) || line["x"].is_null()), "{name}: {count}");
        let elsewhere = points.iter().filter(|line| !told(line) && line["x"].is_f64()).count();
        assert!(elsewhere > 2000, "{name}: {elsewhere}");
    }
}

#[test]
fn the_place_of_the_frame_changes_no_uncertainty() {
    let directory = recorded(O1, "50");
    let path = directory.path();
    let bias = |row: &mut [f64]| (row[4], row[5], row[6]) = (row[4] + 1e-3, row[5] - 1e-3, row[6] + 5e-5);
    edited(path, "here.csv", |_, row| bias(row));
    edited(path, "there.csv", |_, row| {
        bias(row);
        row[1] += 100.0;
        row[2] -= 7.0;
    });
    for name in ["here", "there"] {
        let output = locally(path, &[&format!("{name}.csv")], name);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", complaint(&output));
    }
    let (here, there) = (points(path, "here"), points(path, "there"));
    let mut compared = 0;
    for (a, b) in here.iter().zip(&there).filter(|(a, b)| a["x"].is_f64() && b["x"].is_f64()) {
        assert!((number(a, "x") + 100.0 - number(b, "x")).abs() < 1e-7 && a["label"] == b["label"], "{a}\n{b}");
        for field in ["sigma_x", "systematic_x", "sigma_y", "systematic_y"] {
            assert!((number(a, field) - number(b, field)).abs() < 1e-8 + 1e-3 * number(a, field), "{field}\n{a}\n{b}");
        }
        compared += 1;
    }
    assert!(compared > 2500, "{compared}");
}

#[test]
fn each_point_has_the_error_that_all_share() {
    // the rod is given 0.5 % too short, and the first contact is weak
    let directory = recorded(include_str!("../../scenes/O3_q60.toml"), "100");
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD.replace("0.1", "0.0995")).unwrap();
    let output = reconstruct(path, &["r.csv"], "out");
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let points = points(path, "out");
    let answered: Vec<&Value> = points.iter().filter(|line| line["x"].is_f64()).collect();
    assert!(answered.len() > 3000, "{}", answered.len());
    for line in answered {
        assert!(number(line, "systematic_x").hypot(number(line, "systematic_y")) > 1e-5, "{line}");
    }
}

#[test]
fn a_bias_is_no_wrong_sign_and_a_wrong_axis_is_no_free_rod() {
    let directory = recorded(include_str!("../../scenes/square_tilted.toml"), "50");
    let path = directory.path();
    for (k, [fx, fy, m]) in [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, 1.0]].into_iter().enumerate() {
        let name = format!("bias{k}");
        edited(path, &format!("{name}.csv"), |_, row| {
            (row[4], row[5], row[6]) = (row[4] + 1e-3 * fx, row[5] + 1e-3 * fy, row[6] + 5e-5 * m);
        });
        let way = if k == 0 { reconstruct } else { locally };
        let output = way(path, &[&format!("{name}.csv")], &name);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", complaint(&output));
    }
    for rate in ["25", "50", "100"] {
        let directory = recorded(O1, rate);
        let path = directory.path();
        edited(path, "swapped.csv", |_, row| row.swap(4, 5));
        let output = reconstruct(path, &["swapped.csv"], "swapped");
        let message = complaint(&output);
        assert_eq!(output.status.code(), Some(2), "{rate}: {message}");
        assert!(message.contains("f0x and f0y are swapped"), "{rate}: {message}");
    }
}

#[test]
fn contours_that_disagree_are_told_and_one_bad_recording_spoils_no_other() {
    let directory = recorded(O1, "50");
    let path = directory.path();
    edited(path, "moved.csv", |_, row| row[2] += 3e-3);
    edited(path, "same.csv", |_, _| ());
    let output = locally(path, &["r.csv", "moved.csv"], "apart");
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("the contours of the scans disagree: at x from "), "{message}");
    let output = locally(path, &["r.csv", "same.csv"], "together");
    assert_eq!((output.status.code(), complaint(&output)), (Some(0), String::new()));
    fs::write(path.join("empty.csv"), "").unwrap();
    let output = reconstruct(path, &["empty.csv", "r.csv"], "one");
    assert_eq!(output.status.code(), Some(1));
    assert!(complaint(&output).starts_with("error: empty.csv"), "{}", complaint(&output));
    assert!(path.join("one/r/points.jsonl").exists() && path.join("one/merged.json").exists());
}

#[test]
fn a_live_scan_with_a_wrong_sign_is_told() {
    let directory = recorded(O1, "100");
    let path = directory.path();
    edited(path, "r2.csv", |_, row| row[6] = -row[6]);
    let arguments = ["live", "--sensor", "file:r2.csv", "--rod", "rod.toml", "--out", "live"];
    let output = vibrissa(path, &arguments);
    assert_eq!(output.status.code(), Some(2), "{}", complaint(&output));
    let summary: Value = serde_json::from_str(&fs::read_to_string(path.join("live/summary.json")).unwrap()).unwrap();
    let findings = summary["findings"].to_string();
    assert!(findings.contains("m0z or f0x has the wrong sign"), "{findings}");
}
