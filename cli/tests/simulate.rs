//! Simulated recordings, and what is said of those that cannot be made.

use crate::common::{SCENE, complaint, edited, vibrissa};
use rod_files::{ReadOptions, Recording, Scan, Scene};
use std::fs;
use std::path::Path;
use std::process::Output;

const NOISE: &str = "\
[white]
force = 2.5e-3
m0z = 6e-5

[dropout]
probability = 0.1
";

/// A directory with the scene and the noise in it.
fn prepared(scene: &str, noise: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), scene).unwrap();
    fs::write(directory.path().join("noise.toml"), noise).unwrap();
    directory
}

fn simulate(directory: &Path, arguments: &[&str]) -> Output {
    vibrissa(directory, &[&["simulate", "scene.toml"], arguments].concat())
}

fn rows(file: &Path) -> Vec<Vec<f64>> {
    let mut table = csv::Reader::from_path(file).unwrap();
    let row = |row: Result<csv::StringRecord, _>| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect();
    table.records().map(row).collect()
}

fn header(file: &Path) -> String {
    fs::read_to_string(file).unwrap().lines().next().unwrap().to_owned()
}

/// Checks that there is no recording, and that the message holds all these parts.
fn refuses(scene: &str, noise: &str, arguments: &[&str], parts: &[&str]) {
    let directory = prepared(scene, noise);
    let output = simulate(directory.path(), &[arguments, &["--file", "out/r.csv"]].concat());
    let message = complaint(&output);
    // a wrong option, or a file that is wrong
    assert_eq!(output.status.code(), Some(if message.starts_with("error: --") { 2 } else { 1 }), "{message}");
    assert!(!directory.path().join("out").exists(), "nothing is written");
    assert_eq!(message.trim_end().lines().count(), 1, "one line where nobody looks at a terminal: {message}");
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn a_clean_recording_is_the_sweep_to_the_last_bit() {
    let directory = prepared(SCENE, NOISE);
    let output = simulate(directory.path(), &["--rate", "4", "--speed", "2e-3"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said, "scene: 81 samples, 0 lost in dropouts\nwritten to out/scene/recording.csv\n");
    let file = directory.path().join("out/scene/recording.csv");
    assert_eq!(header(&file), "t,x0,y0,phi0,f0x,f0y,m0z");
    let recorded = rows(&file);
    let scene = edited("step = 1e-3", "step = 5e-4");
    let states = Scan::run(Scene::parse("scene.toml".as_ref(), &scene).unwrap()).unwrap().outcome.states;
    assert_eq!(recorded.len(), states.len());
    for (k, (row, state)) in recorded.iter().zip(&states).enumerate() {
        let (pose, reactions) = (state.pose, state.reactions);
        let expected = [0.25 * k as f64, pose.x, pose.y, pose.phi, reactions.f0x, reactions.f0y, reactions.m0z];
        assert_eq!(row[..], expected);
    }
    assert!(recorded.last().unwrap()[6].abs() > 1e-3, "it touches");
}

#[test]
fn a_noisy_one_is_that_with_the_noise_of_its_seed() {
    let directory = prepared(SCENE, NOISE);
    let run = |arguments: &[&str], out: &str| {
        let all = [&["--rate", "100", "--out", out], arguments].concat();
        let output = simulate(directory.path(), &all);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        (String::from_utf8(output.stdout).unwrap(), rows(&directory.path().join(out)))
    };
    let (_, clean) = run(&[], "clean.csv");
    let (said, noisy) = run(&["--noise", "noise.toml"], "noisy.csv");
    let (_, again) = run(&["--noise", "noise.toml", "--seed", "0", "--sigmas"], "again.csv");
    let (_, other) = run(&["--noise", "noise.toml", "--seed", "1"], "other.csv");
    assert_eq!(clean.len(), 4001);
    let lost = clean.len() - noisy.len();
    assert!((300..500).contains(&lost), "{lost} of 4001 lost, of which a tenth is expected");
    assert!(said.contains(&format!("{} samples, {lost} lost", noisy.len())), "{said}");

    // Of what is there, time and pose are right, and the reactions are off by the noise.
    let mut squares = [0.0; 3];
    for row in &noisy {
        let truth = &clean[(row[0] * 100.0).round() as usize];
        assert_eq!(row[..4], truth[..4]);
        for (i, square) in squares.iter_mut().enumerate() {
            *square += (row[4 + i] - truth[4 + i]).powi(2) / noisy.len() as f64;
        }
    }
    // Four standard deviations of the estimate from 3600 samples.
    for (square, sigma) in squares.into_iter().zip([2.5e-3, 2.5e-3, 6e-5]) {
        assert!((square.sqrt() / sigma - 1.0).abs() < 4.0 / (2.0 * 3600.0_f64).sqrt(), "{square}");
    }
    assert!(noisy.iter().zip(&again).all(|(one, two)| one[..] == two[..7]) && noisy.len() == again.len());
    assert_eq!(header(&directory.path().join("again.csv")), "t,x0,y0,phi0,f0x,f0y,m0z,sigma_f0x,sigma_f0y,sigma_m0z");
    assert!(again.iter().all(|row| row[7..] == [2.5e-3, 2.5e-3, 6e-5]));
    assert_ne!(noisy, other);
}

#[test]
fn what_is_written_can_be_read() {
    let directory = prepared(SCENE, NOISE);
    let file = directory.path().join("r.csv");
    let arguments = ["--noise", "noise.toml", "--rate", "100", "--sigmas", "--out", "r.csv"];
    assert_eq!(simulate(directory.path(), &arguments).status.code(), Some(0));
    let rod = Scene::parse("scene.toml".as_ref(), SCENE).unwrap().rod;
    let recording = Recording::read(&file, rod.at_clamp(), &ReadOptions::default()).unwrap();
    assert!(recording.warnings().is_empty(), "{:?}", recording.warnings());
    let read: Vec<Vec<f64>> = recording
        .samples()
        .map(|sample| {
            let (pose, r, sigma) = (sample.pose, sample.reactions, sample.sigma.unwrap());
            let t = sample.t.unwrap();
            vec![t, pose.x, pose.y, pose.phi, r.f0x, r.f0y, r.m0z, sigma.f0x, sigma.f0y, sigma.m0z]
        })
        .collect();
    assert_eq!(read, rows(&file));
}

#[test]
fn a_snap_leaves_poses_out_but_no_time() {
    // The tip snaps off the second bump on the way out.
    let there = edited("to = [0.03, -0.04]", "to = [-0.09, -0.04]");
    let directory = prepared(&there, "random_walk.force = 1e-3");
    for (noise, out) in [(None, "clean.csv"), (Some("noise.toml"), "noisy.csv")] {
        let noise = noise.map_or(vec![], |file| vec!["--noise", file]);
        let all = [&["--rate", "20", "--speed", "1e-2", "--out", out][..], &noise[..]].concat();
        assert_eq!(simulate(directory.path(), &all).status.code(), Some(0));
    }
    let clean = rows(&directory.path().join("clean.csv"));
    for row in &clean {
        assert!((row[0] * 1e-2 - (0.07 - row[1])).abs() < 1e-12, "{row:?}");
    }
    assert!(clean.iter().any(|row| row[6] != 0.0) && clean.last().unwrap()[6] == 0.0);
    let noisy = rows(&directory.path().join("noisy.csv"));
    assert_eq!(noisy[0], clean[0], "a walk starts where it is");
    assert!((noisy[100][4] - clean[100][4]).abs() > 1e-4);
}

#[test]
fn a_clamp_that_turns_does_so_in_radians() {
    let turning = "from = [0.05, -0.04]\nto = [0.05, -0.04]\nangle = 120.0\nangle_to = 60.0\nstep_angle = 2.0\n";
    let directory = prepared(&(SCENE[..SCENE.find("from").unwrap()].to_owned() + turning), "");
    let output = simulate(directory.path(), &["--rate", "10", "--speed", "0.1", "--file", "r.csv"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let recorded = rows(&directory.path().join("r.csv"));
    assert_eq!(recorded.len(), 105);
    for (k, row) in recorded.iter().enumerate() {
        assert!((row[3] - (120_f64.to_radians() - 0.01 * k as f64)).abs() < 1e-12);
        assert_eq!(row[0], k as f64 / 10.0);
    }
    let against = ["reconstruct", "r.csv", "--rod", "scene.toml", "--truth", "scene.toml", "--local"];
    let output = vibrissa(directory.path(), &against);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("were found within 1 mrad of the clamp's way") && said.contains("error mrad"), "{said}");
    let simulated = |speed: &str| simulate(directory.path(), &["--rate", "10", "--speed", speed, "--file", "r.csv"]);
    assert_eq!(simulated("6 deg/s").status.code(), Some(0));
    assert_eq!(rows(&directory.path().join("r.csv")).len(), 101);
    let message = complaint(&simulated("1 mm/s"));
    assert!(message.contains("--speed is 1 mm/s, expected an angle per second: the clamp only turns"), "{message}");
}

#[test]
fn a_speed_may_have_a_unit() {
    let directory = prepared(SCENE, "");
    let recorded = |speed: &str| {
        let output = simulate(directory.path(), &["--rate", "4", "--speed", speed, "--file", "r.csv"]);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        fs::read_to_string(directory.path().join("r.csv")).unwrap()
    };
    assert_eq!(recorded("2e-3"), recorded("2 mm/s"));
    refuses(SCENE, "", &["--speed", "2 deg/s"], &["--speed is 2 deg/s, expected a length per second: the clamp moves"]);
    let output = simulate(directory.path(), &["--speed", "2 mm"]);
    assert!(output.status.code() == Some(2) && complaint(&output).contains("as 1 mm/s or 10 deg/s"));
}

#[test]
fn a_sweep_that_stops_early_keeps_what_it_has() {
    let into = "from = [0.0, -0.15]\nto = [0.0, 0.05]\nangle = 60.0\nstep = 1e-3\n";
    let directory = prepared(&(SCENE[..SCENE.find("from").unwrap()].to_owned() + into), "");
    let output = simulate(directory.path(), &["--rate", "10", "--speed", "1e-2", "--file", "r.csv"]);
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("scene: the sweep stopped at clamp (0.000000000, "), "{message}");
    let text = fs::read_to_string(directory.path().join("r.csv")).unwrap();
    assert!((51..201).contains(&text.lines().count()), "{}", text.lines().count());
    let mark = "# incomplete: the sweep stopped at clamp (0.000000000, ";
    assert!(text.lines().last().unwrap().starts_with(mark), "{text}");
}

#[test]
fn a_rate_or_speed_that_is_none() {
    refuses(SCENE, "", &["--rate", "0"], &["--rate is 0, expected a positive, finite number of Hz"]);
    refuses(SCENE, "", &["--rate", "-500"], &["--rate is -500, expected a positive"]);
    refuses(SCENE, "", &["--speed", "nan"], &["--speed is NaN, expected a positive, finite number of m/s"]);
    refuses(
        SCENE,
        "",
        &["--rate", "1e5"],
        &[
            "--rate 100000 Hz at --speed 0.001 m/s asks for 4.0e6 samples on a path of 0.040000 m, expected at most 1e6",
            "lower the rate, raise the speed or cut the path",
        ],
    );
}

#[test]
fn a_noise_file_that_is_none() {
    let with = ["--noise", "noise.toml"];
    refuses(
        SCENE,
        "[white]\nforce = -1.0",
        &with,
        &["noise.toml:2:9: white.force: ", "is -1, expected a finite number"],
    );
    refuses(SCENE, "[whit]", &with, &["noise.toml:1:2: whit: unknown field `whit`, expected one of `gain`"]);
    refuses(
        SCENE,
        "[ar1]\nforce = 1\ncorrelation = 1.5",
        &with,
        &["noise.toml:3:15: ", "correlation is 1.5, expected"],
    );
    refuses(SCENE, "", &["--noise", "no.toml"], &["cannot read the noise model no.toml: "]);
}

#[test]
fn standard_deviations_that_are_not_there() {
    let message = ["the noise model gives f0x no standard deviation, expected white or AR(1) noise or a quantum"];
    refuses(SCENE, "", &["--sigmas"], &message);
    let message = ["the noise model gives m0z no standard deviation"];
    refuses(SCENE, "white.force = 1.0", &["--sigmas", "--noise", "noise.toml"], &message);
}

#[test]
fn a_file_that_cannot_be_written() {
    let directory = prepared(SCENE, "");
    fs::create_dir(directory.path().join("folder")).unwrap();
    for (out, part) in [
        ("folder", "folder is a directory, expected a file"),
        ("..", ".. is a directory"),
        ("results/", "results/ is a directory"),
    ] {
        let output = simulate(directory.path(), &["--rate", "1", "--file", out]);
        let message = complaint(&output);
        assert!(output.status.code() == Some(2) && message.contains(part), "{message}");
    }
    let output = simulate(directory.path(), &["--rate", "1", "--file", "scene.toml/r.csv"]);
    let message = complaint(&output);
    assert!(message.contains("scene.toml is a file, expected a directory"), "{message}");
    // as before 0.2.0
    assert!(simulate(directory.path(), &["--rate", "1", "--out", "r.csv"]).status.success());
    assert!(directory.path().join("r.csv").is_file());
}
