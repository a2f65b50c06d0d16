//! From a sensor that is played to contact points, over the connections that real ones have, and what is said where that
//! cannot be.

use crate::common::{complaint, edited, vibrissa};
use rod_files::{ReadOptions, Recording, Scene, Simulation, Tick};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use vibrissa::reconstruct::{NoiseModel, single};
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Sample};

/// O1 at q = 0.4 L: A, B, BB, BA, B, A.
fn scene() -> String {
    let (from, to) = ("from = [0.07, -0.04]\nto = [0.03, -0.04]", "from = [0.08, -0.04]\nto = [-0.09, -0.04]");
    edited(from, to)
}

fn prepared(setup: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), scene()).unwrap();
    fs::write(directory.path().join("setup.toml"), setup).unwrap();
    directory
}

/// A sensor that is played, and where.
struct Fake {
    process: Child,
    address: String,
}

impl Fake {
    fn start(directory: &Path, arguments: &[&str]) -> Self {
        Self::on_port("0", directory, arguments)
    }

    fn on_port(port: &str, directory: &Path, arguments: &[&str]) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_vibrissa"))
            .args([&["fake-sensor", "scene.toml", "--port", port, "--scaling-port", "0"], arguments].concat())
            .current_dir(directory)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let address = line.split(": ").next().unwrap().to_owned();
        Self { process, address }
    }
}

impl Drop for Fake {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Listens with `live` and returns what it said and its summary.
fn listen(directory: &Path, address: &str, arguments: &[&str]) -> (Output, Value) {
    let rod: &[&str] = if arguments.contains(&"--rod") { &[] } else { &["--rod", "scene.toml"] };
    let output = vibrissa(
        directory,
        &[&["live", "--sensor", address, "--out", "out", "--setup", "setup.toml"], rod, arguments].concat(),
    );
    let summary = fs::read(directory.join("out/summary.json")).unwrap_or_else(|_| panic!("{}", complaint(&output)));
    (output, serde_json::from_slice(&summary).unwrap())
}

/// What a sensor without errors reads at each sample.
fn truth(directory: &Path, rate: f64, speed: f64) -> Vec<Sample> {
    let scene = Scene::read(&directory.join("scene.toml")).unwrap();
    let simulation = Simulation { scene, noise: NoiseModel::default(), rate, speed, seed: 0, sigmas: false };
    let ticks = simulation.ticks().unwrap().map(|tick| tick.unwrap());
    let of = |Tick { number, pose, reactions, .. }| Sample {
        t: Some(number as f64 / rate),
        ..Sample::new(pose, reactions.unwrap())
    };
    ticks.map(of).collect()
}

/// Checks the recording and all of its points with one contact against the direct computation: a sample is off by half a
/// quantum (N, N m) at most, a point by what that makes of it.
fn agrees(directory: &Path, truth: &[Sample], quantum: [f64; 2]) {
    let scene = Scene::read(&directory.join("scene.toml")).unwrap();
    let recording =
        Recording::read(&directory.join("out/recording.csv"), scene.rod.at_clamp(), &ReadOptions::default()).unwrap();
    let samples: Vec<&Sample> = recording.samples().collect();
    let first = samples[0].t.unwrap();
    assert_eq!(samples.len(), recording.rows.len());
    let half = Reactions { f0x: 0.5 * quantum[0], f0y: 0.5 * quantum[0], m0z: 0.5 * quantum[1] };
    let squares = nalgebra::Vector3::new(half.f0x, half.f0y, half.m0z).map(|q| q * q);
    let (mut points, mut worst) = (0, 0.0_f64);
    for sample in &samples {
        // by time, for what a snap jumps over has samples, too
        let t = sample.t.unwrap() - first;
        let at = truth.partition_point(|known| known.t.unwrap() < t - 1e-7);
        let Some(known) = truth.get(at).filter(|known| (known.t.unwrap() - t).abs() < 1e-7) else { continue };
        let off = |a: f64, b: f64, half: f64| {
            assert!((a - b).abs() <= 1.01 * half + 1e-15, "{t}: {a} {b}");
        };
        let (Pose { x, y, phi }, Reactions { f0x, f0y, m0z }) = (sample.pose, sample.reactions);
        assert!((x - known.pose.x).hypot(y - known.pose.y) < 1e-12 && (phi - known.pose.phi).abs() < 1e-12);
        off(f0x, known.reactions.f0x, half.f0x);
        off(f0y, known.reactions.f0y, half.f0y);
        off(m0z, known.reactions.m0z, half.m0z);
        // far enough from first contact for a point to be a linear function of the reactions
        let covariance = nalgebra::Matrix3::from_diagonal(&squares);
        let (Ok(found), Ok(exact)) = (
            single(scene.rod.at_clamp(), sample.pose, sample.reactions, &covariance),
            single(scene.rod.at_clamp(), known.pose, known.reactions, &nalgebra::Matrix3::zeros()),
        ) else {
            continue;
        };
        if exact.force < 5e-3 {
            continue;
        }
        // the sum of three errors is no more than sqrt 3 times the root of the sum of their squares
        let bound = (3.0 * found.covariance.trace()).sqrt();
        let error = (found.x - exact.x).hypot(found.y - exact.y);
        assert!(error <= 1.01 * bound + 1e-12, "{t}: {error:.1e} {bound:.1e}");
        worst = worst.max(error);
        points += 1;
    }
    assert!(points > truth.len() / 2, "{points} of {}", truth.len());
    println!("{points} points within the quantisation, the farthest off by {worst:.1e} m");
}

/// The labels of points.jsonl in order, runs as one, those of fewer than `least` samples left out.
fn phases(directory: &Path, least: usize) -> Vec<String> {
    let text = fs::read_to_string(directory.join("out/points.jsonl")).unwrap();
    let labels =
        text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["label"].as_str().map(str::to_owned));
    let labels: Vec<String> = labels.flatten().collect();
    let runs = labels.chunk_by(|a, b| a == b).filter(|run| run.len() >= least).map(|run| run[0].clone());
    let mut phases: Vec<String> = runs.collect();
    phases.dedup();
    phases
}

#[test]
fn over_udp_the_points_are_those_of_the_direct_computation() {
    let (rate, speed) = (7000.0, 0.02);
    let directory = prepared("[sensor]\nrate = 7000\n[tare]\nseconds = 0.5\n");
    let dir = directory.path();
    let fake = Fake::start(dir, &["--protocol", "rdt", "--rate", "7000", "--speed", "0.02"]);
    let (output, summary) = listen(dir, &fake.address, &["--stage", "constant:0.02"]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}{}", complaint(&output));
    let truth = truth(dir, rate, speed);
    let link = &summary["link"];
    for counter in ["repeated", "reordered", "malformed", "foreign", "restarts"] {
        assert_eq!(link[counter], 0, "{counter}");
    }
    assert_eq!(summary["end"], "stage");
    // a machine that is busy elsewhere may lose some, but not without knowing
    let count = |counter: &str| link[counter].as_u64().unwrap();
    let all = count("samples") + count("lost");
    let expected = (0.17 * rate / speed) as u64;
    assert!((expected - expected / 100..=expected + 1).contains(&all), "{all} of {expected}");
    println!("{} of {expected} lost", count("lost") + count("untaken"));
    // 10^6 counts a N and a N mm
    agrees(dir, &truth, [1e-6, 1e-9]);
    assert!(summary["latency"]["p999"].as_f64() >= summary["latency"]["median"].as_f64(), "{summary}");
    assert_eq!(phases(dir, 20), ["free", "A", "B", "BB", "BA", "B", "A", "free"]);
    assert!(said.contains("B -> BB") && said.contains("the clamp has arrived"), "{said}");
}

#[test]
fn a_way_that_is_no_whole_number_of_samples_ends_all_the_same() {
    let directory = prepared("[sensor]\nrate = 1000\n[tare]\nseconds = 0.3\n");
    let fake =
        Fake::start(directory.path(), &["--protocol", "rdt", "--rate", "1000", "--speed", "0.0299", "--faster", "3"]);
    let (output, summary) = listen(directory.path(), &fake.address, &["--stage", "constant:0.0299"]);
    assert_eq!((output.status.code(), &summary["end"]), (Some(0), &Value::from("stage")), "{}", complaint(&output));
}

#[cfg(unix)]
#[test]
fn over_a_pseudo_terminal_too() {
    let setup = "[sensor]\nrate = 400\nforce_unit = 'N'\ntorque_unit = 'N m'\n[tare]\nseconds = 0.5\n";
    let directory = prepared(setup);
    let dir = directory.path();
    // 28 bytes a frame at 115200 baud: 411 frames a second; a pseudo-terminal knows no baud
    let fake = Fake::start(dir, &["--protocol", "gsv8", "--rate", "400", "--speed", "0.02", "--faster", "2"]);
    let address = format!("{}:115200", fake.address);
    let (output, summary) = listen(dir, &address, &["--stage", "constant:0.02"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", String::from_utf8_lossy(&output.stdout), complaint(&output));
    assert_eq!((&summary["link"]["malformed"], &summary["link"]["skipped_bytes"]), (&Value::from(0), &Value::from(0)));
    assert_eq!(summary["samples"], 3400);
    // single precision: the last bit of 1 N and of 20 mN m
    agrees(dir, &truth(dir, 400.0, 0.02), [1.2e-7, 3.8e-9]);
}

#[test]
fn a_recording_is_a_sensor_too() {
    let directory = prepared("");
    let dir = directory.path();
    let output = vibrissa(dir, &["simulate", "scene.toml", "--rate", "2000", "--speed", "0.02", "--file", "clean.csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let (output, summary) = listen(dir, "file:clean.csv", &[]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    assert_eq!(summary["end"], "source");
    assert_eq!(phases(dir, 5), ["free", "A", "B", "BB", "BA", "B", "A", "free"]);
    // what was recorded live is a recording like any other
    let output = vibrissa(dir, &["reconstruct", "out/recording.csv", "--rod", "scene.toml", "--truth", "scene.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", String::from_utf8_lossy(&output.stdout), complaint(&output));
}

#[test]
fn a_sensor_that_falls_silent_loses_nothing() {
    let directory = prepared("[sensor]\nrate = 1000\n[tare]\nseconds = 0.3\n");
    let dir = directory.path();
    let mut fake = Fake::start(dir, &["--protocol", "rdt", "--rate", "1000", "--speed", "0.01"]);
    let pid = fake.process.id();
    let killer = std::thread::spawn(move || {
        std::thread::sleep(std::time::Duration::from_secs(4));
        Command::new("kill").args(["-9", &pid.to_string()]).status().unwrap();
    });
    let (output, summary) = listen(dir, &fake.address, &["--stage", "constant:0.01"]);
    killer.join().unwrap();
    let _ = fake.process.wait();
    assert_eq!(output.status.code(), Some(2), "{}", complaint(&output));
    assert_eq!((&summary["end"], &summary["complete"]), (&Value::from("silence"), &Value::from(false)));
    let samples = summary["samples"].as_u64().unwrap() as usize;
    assert!(samples >= 100, "{samples}");
    assert_eq!(fs::read_to_string(dir.join("out/points.jsonl")).unwrap().lines().count(), samples);
}

#[test]
#[ignore = "takes 9 s; the counting itself is tested beside `Losses`"]
fn a_sensor_that_starts_anew_has_lost_what_its_counter_does_not_tell() {
    let directory = prepared("[sensor]\nrate = 1000\n[tare]\nseconds = 0.3\n");
    let dir = directory.path();
    let arguments = ["--protocol", "rdt", "--rate", "1000", "--speed", "0.02"];
    let fake = Fake::start(dir, &arguments);
    let address = fake.address.clone();
    let port = address.split([':', '?']).nth(2).unwrap().to_owned();
    let there = dir.to_path_buf();
    let restarted = std::thread::spawn(move || {
        std::thread::sleep(std::time::Duration::from_secs(3));
        drop(fake);
        std::thread::sleep(std::time::Duration::from_millis(1500));
        Fake::on_port(&port, &there, &arguments)
    });
    let (output, summary) = listen(dir, &address, &["--stage", "constant:0.02"]);
    drop(restarted.join().unwrap());
    assert_eq!((output.status.code(), &summary["end"]), (Some(0), &Value::from("stage")), "{}", complaint(&output));
    let lost = summary["link"]["lost"].as_u64().unwrap();
    assert!((1300..4000).contains(&lost), "{lost} {summary}");
    let all = summary["samples"].as_u64().unwrap() + lost;
    assert!((8000..8800).contains(&all), "{all} of 8500");
}

#[cfg(unix)]
#[test]
#[ignore = "takes 9 s"]
fn a_short_silence_is_not_the_end() {
    let directory = prepared("[sensor]\nrate = 1000\n[tare]\nseconds = 0.3\n");
    let dir = directory.path();
    let fake = Fake::start(dir, &["--protocol", "rdt", "--rate", "1000", "--speed", "0.02"]);
    let pid = fake.process.id().to_string();
    let paused = std::thread::spawn(move || {
        let signal = |name: &str| Command::new("kill").args([name, &pid]).status().unwrap();
        // the second silence begins with the first sample after the first one, or nearly so
        for [run, pause] in [[2000, 1400], [20, 1400]] {
            std::thread::sleep(std::time::Duration::from_millis(run));
            signal("-STOP");
            std::thread::sleep(std::time::Duration::from_millis(pause));
            signal("-CONT");
        }
    });
    let (output, summary) = listen(dir, &fake.address, &["--stage", "constant:0.02"]);
    paused.join().unwrap();
    assert_eq!((output.status.code(), &summary["end"]), (Some(0), &Value::from("stage")), "{}", complaint(&output));
    let text = fs::read_to_string(dir.join("out/points.jsonl")).unwrap();
    let last: Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    assert!(last["x0"].as_f64().unwrap() < -0.085, "{last}");
}

#[test]
fn the_budget_and_the_calibration_are_used_and_told() {
    let directory = prepared("[errors]\nclamp_angle = 2.0\ngain = 0.02\n");
    let dir = directory.path();
    let output = vibrissa(dir, &["simulate", "scene.toml", "--rate", "200", "--speed", "0.02", "--file", "clean.csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let rod = "[rod]\nlength = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n\
               [calibration]\nlever_along = { value = 1e-3, sigma = 1e-5, unit = \"m\" }\n";
    fs::write(dir.join("rod.toml"), rod).unwrap();
    let (_, summary) = listen(dir, "file:clean.csv", &["--rod", "rod.toml"]);
    let error = |name: &str| {
        let errors = summary["errors"].as_array().unwrap();
        errors.iter().find(|error| error["source"] == name).unwrap_or_else(|| panic!("{summary}")).clone()
    };
    assert!((error("clamp_angle")["given"].as_f64().unwrap() - 2.0_f64.to_radians()).abs() < 1e-15);
    assert_eq!((&error("gain_f0y")["given"], &error("stiffness")["given"]), (&Value::from(0.02), &Value::from(0.05)));
    let lever = error("lever_along");
    assert!((lever["known"].as_f64().unwrap() - 1e-3).abs() < 1e-12, "{lever}");
    let text = fs::read_to_string(dir.join("out/points.jsonl")).unwrap();
    let told = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()["probability"].as_f64().unwrap());
    assert!(told.clone().all(|p| (0.0..=1.0).contains(&p)) && told.clone().any(|p| p < 0.95), "all labels are sure");
    let (_, summary) = listen(dir, "file:clean.csv", &["--as-is"]);
    assert_eq!(summary["errors"], Value::Array(Vec::new()));
}

/// Checks that `live` with these arguments fails like this.
fn refuses(setup: &str, files: &[(&str, &str)], arguments: &[&str], parts: &[&str]) {
    let directory = prepared(setup);
    for (name, content) in files {
        fs::write(directory.path().join(name), content).unwrap();
    }
    let arguments = [&["live", "--setup", "setup.toml", "--out", "out"], arguments].concat();
    let output = vibrissa(directory.path(), &arguments);
    let message = complaint(&output);
    assert!(matches!(output.status.code(), Some(1 | 2)), "{message}");
    for part in parts {
        assert!(message.contains(part), "{part}: {message}");
    }
}

const ROD: &str = "[rod]\nlength = 0.1\nbending_stiffness = 6.32e-4\n";

#[test]
fn what_cannot_be_listened_to() {
    let on_scene = |sensor| ["--sensor", sensor, "--rod", "scene.toml", "--stage", "constant:0.01"];
    refuses("", &[], &on_scene("tcp://there"), &["`tcp://there` is no address of a sensor, expected rdt://HOST"]);
    refuses(
        "",
        &[],
        &on_scene("rdt://127.0.0.1:1?scaling=1"),
        &["rdt://127.0.0.1:1", "no TCP connection to `127.0.0.1:1`"],
    );
    refuses(
        "",
        &[],
        &on_scene("serial:/dev/null/x:gsv9"),
        &["`gsv9` is not a known serial sensor, expected one of: gsv8"],
    );
    refuses("", &[], &on_scene("serial:/dev/null/x:gsv8"), &["the units of its numbers are unknown", "--setup"]);
    refuses("", &[], &on_scene("serial:/dev/null/x:bota"), &["cannot open the serial port /dev/null/x at 460800 baud"]);
    refuses("", &[], &on_scene("file:nothing.csv"), &["nothing.csv"]);
    refuses("[sensor]\nrate = -1\n", &[], &on_scene("rdt://127.0.0.1"), &["setup.toml:2:8: sensor.rate: rate is -1"]);
    refuses("", &[], &["--sensor", "rdt://x", "--rod", "scene.toml", "--stage", "slow"], &["`slow` is no stage"]);
}

/// A recording of a wrench, without poses, of this many rows.
fn wrenches(rows: usize, fx: impl Fn(usize) -> f64) -> String {
    let mut text = "t [s],Fx [N],Fy [N],Fz [N],Tx [N mm],Ty [N mm],Tz [N mm]\n".to_owned();
    for k in 0..rows {
        text += &format!("{},{},0.01,0,0,0,0.5\n", 1e-3 * k as f64, fx(k));
    }
    text
}

#[test]
fn stages_and_tares_that_are_none() {
    let free = wrenches(3000, |k| 1e-6 * (k % 7) as f64);
    let files = [("free.csv", free.as_str()), ("rod.toml", ROD)];
    let with = |stage: &'static [&'static str]| [&["--sensor", "file:free.csv", "--rod", "rod.toml"], stage].concat();
    refuses("", &files, &with(&[]), &["the poses of the clamp are missing; give --stage"]);
    refuses("", &files, &with(&["--stage", "constant:1e-3"]), &["needs the path of the clamp: give --path SCENE"]);
    refuses("", &files, &with(&["--stage", "table:stage.csv"]), &["stage.csv"]);
    for (table, part) in [
        ("t,x0,y0,phi0\n0,0,0,1\n1,1e-3,0,1\n1,2e-3,0,1\n", "stage.csv: "),
        ("t,x0,phi0\n0,0,1\n", "no column y0"),
        ("t,x0,y0,phi0\n0,0,0,1\n1,oops,0,1\n", "stage.csv:3: x0 is `oops`, expected a number"),
    ] {
        let files = [files[0], files[1], ("stage.csv", table)];
        refuses("", &files, &with(&["--stage", "table:stage.csv"]), &[part]);
    }
    // no extrapolation: the first samples have no pose
    let files = [files[0], files[1], ("stage.csv", "t,x0,y0,phi0\n5,0,0,1\n9,1e-3,0,1\n")];
    refuses("", &files, &with(&["--stage", "table:stage.csv"]), &["the stage is known from 5 s to 9 s"]);

    let scene = scene();
    let loaded = wrenches(3000, |k| if k > 600 { 0.1 } else { 0.0 });
    let files = [("free.csv", loaded.as_str()), ("rod.toml", scene.as_str())];
    refuses("", &files, &with(&["--stage", "constant:1e-3"]), &["no tare from the first 1 s", "Fx changes by"]);
    refuses(
        "",
        &[("free.csv", &wrenches(30, |_| 0.0)), ("rod.toml", scene.as_str())],
        &with(&["--stage", "constant:1e-3"]),
        &["30 samples before the end, expected at least 100"],
    );
}

#[test]
fn a_range_that_is_larger_than_what_the_rod_can_give() {
    let directory = prepared("[accuracy]\nforce_range = 2\ntorque_range = 50\nforce_class = 0.5\ntorque_class = 0.1\n");
    let dir = directory.path();
    fs::write(dir.join("free.csv"), wrenches(3000, |k| 1e-6 * (k % 7) as f64)).unwrap();
    let (output, summary) = listen(dir, "file:free.csv", &["--stage", "constant:1e-3"]);
    assert_eq!(output.status.code(), Some(2), "flagged, yet listened to");
    let findings = summary["findings"].to_string();
    assert!(findings.contains("Is +-50 mN m meant?"), "{findings}");
    // class 0.5 of 2 N is 0.16 EI/L^2: no misfit, but said
    assert!(findings.contains("Fx"), "{findings}");
    assert!(String::from_utf8(output.stdout).unwrap().contains("warning: "));
}
