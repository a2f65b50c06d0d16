//! What accuracy a scene allows, as a user asks for it.

use crate::common::{complaint, vibrissa};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

const SCENE: &str = include_str!("../../scenes/O1_q40.toml");
/// Few samples, so that the tests are quick.
const QUICK: [&str; 4] = ["--rate", "20", "--out", "out"];

fn directory() -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    directory
}

fn budget(directory: &Path, arguments: &[&str]) -> Output {
    vibrissa(directory, &[&["budget", "scene.toml"], QUICK.as_slice(), arguments].concat())
}

fn record(directory: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(directory.join("out/budget.json")).unwrap()).unwrap()
}

#[test]
fn sources_runs_and_files() {
    let directory = directory();
    let output = budget(directory.path(), &["--runs", "6"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let report = String::from_utf8(output.stdout).unwrap();
    println!("{report}");
    for part in ["bias of f0x", "clamp angle", "all systematic errors", "0.1 mm ", "6 recordings with random errors"] {
        assert!(report.contains(part), "{part}: {report}");
    }
    let record = record(directory.path());
    let sources = record["sources"].as_array().unwrap();
    assert_eq!(sources.len(), 27);
    for source in sources {
        let [before, after] = ["before", "after"].map(|of| source[of].as_f64().unwrap());
        assert!(before > 0.0 && after <= before * 1.001, "{source}");
    }
    // the free rod tells the bias
    let bias = &sources[0];
    assert!(bias["source"] == "bias_f0x" && bias["left"].as_f64().unwrap() < 0.1 * bias["budget"].as_f64().unwrap());
    let runs = record["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 6);
    let mean = |of: &str| runs.iter().map(|run| run[of].as_f64().unwrap()).sum::<f64>() / 6.0;
    assert!(mean("labels_right") > 0.98 && mean("beyond_six_sigma") < 0.02, "{runs:?}");
    assert!((0.1..5.0).contains(&mean("error_variance")), "{runs:?}");
    let drawing = fs::read_to_string(directory.path().join("out/budget.svg")).unwrap();
    assert!(drawing.contains("after self-calibration") && drawing.contains("lag of the pose"));
}

#[test]
fn a_seed_gives_one_result_and_another_another() {
    let directory = directory();
    let runs = ["4", "4", "5"].map(|seed| {
        let output = budget(directory.path(), &["--runs", "1", "--seed", seed]);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        record(directory.path())["runs"].clone()
    });
    assert!(runs[0] == runs[1] && runs[0] != runs[2]);
}

/// A sensor that is as noisy as the scaling says gives the accuracy that was asked for.
#[test]
fn the_scaling_to_another_sensor_holds() {
    let directory = directory();
    let write = |factor: f64| {
        let (bias, moment) = (5e-3 * factor, 3e-4 * factor);
        let setup = format!(
            "[errors]\nbias_force = {bias}\ndrift_force = {bias}\nbias_moment = {moment}\ndrift_moment = {moment}\n\
             gain = 1e-3\ncross_talk = 5e-4\nclamp_angle = 0.05\nlever = 1e-4\nstiffness = 0.01\nlength = 5e-4\n\
             natural_curvature = 0.03\nclamp_compliance = 0.0\nlag = 2e-5\nstage_scale = 5e-4\n"
        );
        let noise = format!("white = {{ force = {}, m0z = {} }}\n", 5e-3 * factor, 2e-4 * factor);
        fs::write(directory.path().join("setup.toml"), setup).unwrap();
        fs::write(directory.path().join("noise.toml"), noise).unwrap();
    };
    let total = |of: &str| {
        let output = budget(directory.path(), &["--runs", "0", "--setup", "setup.toml", "--noise", "noise.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        let record = record(directory.path());
        println!("{} {} {}", record["shared_after"], record["noise_points"], record["needed"]);
        record.pointer(of).unwrap().as_f64()
    };
    write(1.0);
    let factor = total("/needed/sensor_factor").unwrap();
    write(factor);
    let reached = total("/total_after").unwrap();
    println!("factor {factor:.3}: {:.4} mm", 1e3 * reached);
    assert!((8e-5..1.25e-4).contains(&reached), "{factor} {reached}");
}

#[test]
fn without_errors_there_is_noise() {
    let directory = directory();
    let names = [
        "bias_force",
        "bias_moment",
        "drift_force",
        "drift_moment",
        "gain",
        "cross_talk",
        "clamp_angle",
        "lever",
        "stiffness",
        "length",
        "natural_curvature",
        "clamp_compliance",
        "lag",
        "stage_scale",
    ];
    let setup: String = names.iter().map(|name| format!("{name} = 0.0\n")).collect();
    fs::write(directory.path().join("setup.toml"), format!("[errors]\n{setup}")).unwrap();
    let output = budget(directory.path(), &["--runs", "1", "--setup", "setup.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let record = record(directory.path());
    assert!(record["sources"].as_array().unwrap().is_empty() && record["needed"].is_null());
    assert!(record["shared_after"] == 0.0 && record["noise_points"].as_f64().unwrap() > 0.0);
}

#[test]
fn bad_input_is_named() {
    let directory = directory();
    let path = directory.path();
    let far = SCENE.replace("from = [0.08, -0.04]", "from = [0.08, -0.4]").replace("[-0.09, -0.04]", "[-0.09, -0.4]");
    fs::write(path.join("far.toml"), far).unwrap();
    fs::write(path.join("setup.toml"), "[errors]\nstiffnes = 0.1\n").unwrap();
    fs::write(path.join("budget.json"), SCENE).unwrap();
    for (arguments, status, message) in [
        (vec!["scene.toml", "--rate", "0"], 2, "--rate is 0, expected a positive, finite number of Hz"),
        (vec!["scene.toml", "--runs", "many"], 2, "expected a whole number from 0 to 100000"),
        (
            vec!["scene.toml", "--rate", "0.05", "--runs", "0"],
            1,
            "scene: the simulated recording cannot be reconstructed",
        ),
        (vec!["far.toml", "--rate", "20", "--runs", "0"], 1, "far: no sample of the sweep has a single contact"),
        (vec!["scene.toml", "--setup", "setup.toml"], 1, "setup.toml:2:1: errors.stiffnes: unknown field"),
        (vec!["budget.json", "--rate", "20", "--runs", "0", "--out", "."], 1, "budget.json is read by this command"),
        (vec!["nowhere.toml"], 1, "cannot read the scene nowhere.toml"),
    ] {
        let output = vibrissa(path, &[&["budget"], arguments.as_slice()].concat());
        let complaint = complaint(&output);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {complaint}");
        assert!(complaint.contains(message), "{arguments:?}: {complaint}");
    }
}

/// As of other studies.
#[test]
fn rods_none_of_which_can_be_swept_are_no_success() {
    let directory = directory();
    let study = |field: &str| {
        format!(
            "scene = \"scene.toml\"\n[[parameter]]\nname = \"length\"\nvalues = [0.1, -1.0]\nset = [{{ field = \"rod.{field}\" }}]\n"
        )
    };
    fs::write(directory.path().join("noise.toml"), "white = { force = 2.5e-3, m0z = 6e-5 }\n").unwrap();
    for (field, status, message) in [
        ("lenght", 2, "2 scenes without a result, the first one is 0: "),
        ("length", 0, "1 scene without a result, the first one is 1: "),
    ] {
        fs::write(directory.path().join("rods.toml"), study(field)).unwrap();
        let output = vibrissa(directory.path(), &["budget", "rods.toml", "--rods", "--noise", "noise.toml"]);
        let report = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(status), "{report}");
        assert!(report.contains(message) && report.contains(&format!("rod.{field}")), "{report}");
    }
}

/// Two rods in the order of their standard deviations, which are those of reconstructions of their recordings.
#[test]
fn rods_are_ranked_by_the_precision_that_their_recordings_have() {
    let directory = directory();
    let study = "scene = \"scene.toml\"\n[[parameter]]\nname = \"length\"\nvalues = [0.1, 0.08]\n\
                 set = [{ field = \"rod.length\" }]\n";
    fs::write(directory.path().join("rods.toml"), study).unwrap();
    fs::write(directory.path().join("noise.toml"), "white = { force = 2.5e-3, m0z = 6e-5 }\n").unwrap();
    let noise = ["--noise", "noise.toml", "--speed", "10 mm/s"];
    let compared = [&["budget", "rods.toml", "--rods", "--sigma", "1e-5", "--out", "rods"], noise.as_slice()].concat();
    let output = vibrissa(directory.path(), &compared);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let mut table = csv::Reader::from_path(directory.path().join("rods/rods.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().unwrap();
    let cell = |row: &csv::StringRecord, name: &str| -> f64 {
        row[head.iter().position(|one| one == name).unwrap()].parse().unwrap()
    };
    assert_eq!(rows.len(), 2);
    assert!(cell(&rows[0], "sigma") < cell(&rows[1], "sigma"));
    for row in &rows {
        let number = row[0].to_owned();
        assert!(cell(row, "largest_stress") > 1e8 && cell(row, "touched") > 0.02);
        // a rod that is more exact than asked for bears more noise
        let factor = cell(row, "noise_factor");
        assert!((factor > 1.0) == (cell(row, "sigma") < 1e-5), "{row:?}");
        let scene = vibrissa(directory.path(), &["study", "rods.toml", "--scene", &number]);
        fs::write(directory.path().join("own.toml"), &scene.stdout).unwrap();
        let simulate = [&["simulate", "own.toml", "--file", "recording.csv"], noise.as_slice()].concat();
        assert!(vibrissa(directory.path(), &simulate).status.success());
        let found =
            ["reconstruct", "recording.csv", "--rod", "own.toml", "--as-is", "--noise", "noise.toml", "--out", "found"];
        assert!(vibrissa(directory.path(), &found).status.success());
        let mut sigmas: Vec<f64> = rod_files::read_known_contours(&directory.path().join("found"))
            .unwrap()
            .iter()
            .flat_map(|one| &one.known)
            .filter_map(|known| known.sigma())
            .collect();
        sigmas.sort_by(f64::total_cmp);
        let ratio = cell(row, "sigma") / sigmas[sigmas.len() / 2];
        assert!((0.7..=1.4).contains(&ratio), "{number}: {ratio}");
    }
}
