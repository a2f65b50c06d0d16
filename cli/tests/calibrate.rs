//! Rods, sensors and clamps calibrated from recordings, as a user does it.

use crate::common::{complaint, vibrissa};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

const SCENES: [(&str, &str); 2] =
    [("O1.toml", include_str!("../../scenes/O1_q40.toml")), ("O2.toml", include_str!("../../scenes/O2_q20.toml"))];
const NOISE: &str = "white = { force = 5e-4, m0z = 2e-5 }\noffset = { f0x = 4e-3, f0y = -5e-3, m0z = 2e-4 }\n";
/// The bending stiffness of the scenes, N m^2.
const STIFFNESS: f64 = 6.320_000_846e-4;

fn rod(stiffness: f64) -> String {
    format!("[rod]\nlength = 0.1\nbending_stiffness = {stiffness}\n")
}

fn file(directory: &Path, name: &str, text: &str) {
    fs::write(directory.join(name), text).unwrap();
}

/// Two recordings, a.csv and b.csv, of untared sensors, and rod.toml with a stiffness that is 5 % too small.
fn recorded() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    file(path, "noise.toml", NOISE);
    file(path, "rod.toml", &rod(STIFFNESS / 1.05));
    for ((scene, text), (out, seed)) in SCENES.into_iter().zip([("a.csv", "3"), ("b.csv", "2")]) {
        file(path, scene, text);
        record(path, scene, out, seed);
    }
    directory
}

fn record(directory: &Path, scene: &str, out: &str, seed: &str) {
    let options = ["--noise", "noise.toml", "--rate", "50", "--seed", seed, "--out", out];
    let output = vibrissa(directory, &[&["simulate", scene], options.as_slice()].concat());
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
}

fn calibrate(directory: &Path, arguments: &[&str]) -> Output {
    vibrissa(directory, &[&["calibrate"], arguments].concat())
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn read(directory: &Path, name: &str) -> toml::Table {
    fs::read_to_string(directory.join(name)).unwrap().parse().unwrap()
}

fn number(table: &toml::Table, path: [&str; 3]) -> f64 {
    table[path[0]][path[1]].get(path[2]).unwrap().as_float().unwrap()
}

#[test]
fn a_stiffness_told_wrong_is_found() {
    let directory = recorded();
    let path = directory.path();
    let output = calibrate(path, &["a.csv", "b.csv", "--rod", "rod.toml", "--file", "all.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let report = said(&output);
    assert!(report.contains("they agree") && report.contains("not separated: "), "{report}");
    let all = read(path, "all.toml");
    let found = all["rod"]["bending_stiffness"].as_float().unwrap();
    let sigma = number(&all, ["calibration", "stiffness", "sigma"]);
    println!("{:+.2e} of the stiffness, sigma {sigma:.1e}", found / STIFFNESS - 1.0);
    assert!((found / STIFFNESS - 1.0).abs() < 3.0 * sigma && sigma < 0.02, "{found} {sigma}");
    assert!(fs::read_to_string(path.join("calibration.svg")).unwrap().contains("normal speed"));

    let only = calibrate(path, &["a.csv", "b.csv", "--rod", "rod.toml", "--free", "stiffness", "--file", "only.toml"]);
    assert_eq!(only.status.code(), Some(0), "{}", complaint(&only));
    let only = read(path, "only.toml");
    let found = only["rod"]["bending_stiffness"].as_float().unwrap();
    println!("{:+.2e} of the stiffness where nothing else is wrong", found / STIFFNESS - 1.0);
    assert!((found / STIFFNESS - 1.0).abs() < 1e-3, "{found}");
    // nothing is known of the others
    assert_eq!(only["calibration"].as_table().unwrap().len(), 1, "{only}");

    // a reconstruction starts from what is known
    let output = vibrissa(path, &["reconstruct", "a.csv", "--rod", "all.toml", "--truth", "O1.toml", "--local"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let report: Value = serde_json::from_str(&fs::read_to_string(path.join("out/a/report.json")).unwrap()).unwrap();
    let sources = report["calibration"]["sources"].as_array().unwrap();
    let stiffness = sources.iter().find(|source| source["source"] == "stiffness").unwrap();
    assert!((stiffness["given"].as_f64().unwrap() - sigma).abs() < 1e-12, "{stiffness}");
    assert!(stiffness["taken"].as_f64().unwrap().abs() < 1e-3, "{stiffness}");
    let median = report["truth"]["single"]["median"].as_f64().unwrap();
    println!("median {median:.1e} m");
    assert!(median < 1e-4 && report["truth"]["accuracy"].as_f64().unwrap() > 0.99, "{median}");
}

#[test]
fn an_angle_told_wrong_is_found() {
    let directory = recorded();
    let path = directory.path();
    file(path, "rod.toml", &rod(STIFFNESS));
    // the true angle is 0.4 degrees more than the recorded one
    let mut table = csv::Reader::from_path(path.join("a.csv")).unwrap();
    let mut text = String::from("t,x0,y0,phi0,f0x,f0y,m0z\n");
    for row in table.records() {
        let mut row: Vec<f64> = row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect();
        row[3] -= 0.4_f64.to_radians();
        text += &(row.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n");
    }
    file(path, "turned.csv", &text);
    let output = calibrate(path, &["turned.csv", "--rod", "rod.toml", "--free", "angle,lever", "--file", "found.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let found = read(path, "found.toml");
    let [angle, sigma] = ["value", "sigma"].map(|of| number(&found, ["calibration", "clamp_angle", of]));
    println!("{:.4} degrees, sigma {:.1e}", angle.to_degrees(), sigma.to_degrees());
    assert!((angle.to_degrees() - 0.4).abs() < 0.02, "{angle}");
    // a second calibration begins with what is known, and keeps it
    let output = calibrate(path, &["turned.csv", "--rod", "found.toml", "--free", "stiffness", "--file", "again.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let again = read(path, "again.toml");
    for (of, before) in [("value", angle), ("sigma", sigma)] {
        assert!((number(&again, ["calibration", "clamp_angle", of]) - before).abs() < 1e-12, "{again}");
    }
}

#[test]
fn recordings_of_two_rods_contradict_each_other() {
    let directory = recorded();
    let path = directory.path();
    file(path, "stiff.toml", &SCENES[0].1.replace("206e9", "214e9"));
    record(path, "stiff.toml", "stiff.csv", "4");
    let output =
        calibrate(path, &["b.csv", "stiff.csv", "--rod", "rod.toml", "--free", "stiffness", "--file", "c.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", complaint(&output));
    assert!(complaint(&output).contains("the recordings contradict each other: chi-squared"), "{}", complaint(&output));
    assert!(said(&output).ends_with("nothing is written\n"), "{}", said(&output));
    assert!(!path.join("c.toml").exists() && !path.join("calibration.svg").exists());
}

#[test]
fn an_estimate_beyond_its_budget_is_told() {
    let directory = recorded();
    let path = directory.path();
    file(path, "rod.toml", &rod(STIFFNESS / 1.25));
    let output = calibrate(path, &["a.csv", "--rod", "rod.toml", "--file", "c.toml"]);
    assert_eq!(output.status.code(), Some(2), "{}", complaint(&output));
    let complaint = complaint(&output);
    assert!(complaint.contains("warning: bending stiffness: the estimate +"), "{complaint}");
    assert!(complaint.contains("standard deviations away from the known value"), "{complaint}");
    assert!(said(&output).contains("yes, budget raised") && path.join("c.toml").exists());
}

#[test]
fn bad_input_is_named() {
    let directory = recorded();
    let path = directory.path();
    file(path, "none.toml", "[errors]\nstiffness = 0.0\n");
    file(
        path,
        "known.toml",
        &(rod(STIFFNESS) + "[calibration]\nlag = { value = 1e-3, sigma = 1e-4, unit = \"mm\" }\n"),
    );
    for (arguments, status, message) in [
        (vec!["--rod", "rod.toml", "--file", "c.toml"], 2, "<RECORDING>"),
        (vec!["a.csv", "--rod", "rod.toml"], 2, "--file <FILE>"),
        (vec!["a.csv", "--rod", "rod.toml", "--file", "-"], 2, "- is no name for a file"),
        (vec!["a.csv", "--rod", "rod.toml", "--free", "stiffnes", "--file", "c.toml"], 2, "'stiffnes'"),
        (vec!["c.csv", "--rod", "rod.toml", "--file", "c.toml"], 1, "cannot read the recording c.csv"),
        (vec!["a.csv", "--rod", "rod.toml", "--file", "rod.toml"], 1, "rod.toml is read by this command"),
        (vec!["a.csv", "--rod", "rod.toml", "--file", "a.csv"], 1, "a.csv is read by this command"),
        (vec!["a.csv", "--rod", "known.toml", "--file", "c.toml"], 1, "the unit is mm, expected m"),
        (
            vec!["a.csv", "--rod", "rod.toml", "--setup", "none.toml", "--free", "stiffness", "--file", "c.toml"],
            1,
            "nothing to calibrate: the budget of every requested source is 0",
        ),
    ] {
        let output = calibrate(path, &arguments);
        let complaint = complaint(&output);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {complaint}");
        assert!(complaint.contains(message), "{arguments:?}: {complaint}");
        assert!(!path.join("c.toml").exists(), "{arguments:?}");
    }
}
