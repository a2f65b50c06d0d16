//! Ctrl-C: what was computed is written and marked, and nothing else stays behind.
#![cfg(unix)]

use crate::common::{SCENE, edited};
use rod_files::{Interrupt, ReadOptions, Recording, Scan, Scene, Simulation, Staged};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use vibrissa::Rod;
use vibrissa::reconstruct::NoiseModel;
use vibrissa_cli::{Paper, PaperError, write_sweep};

/// The first wait before a signal; each try doubles it.
const FIRST_WAIT: Duration = Duration::from_millis(30);
/// Longer than any machine needs to start a process.
const PATIENCE: Duration = Duration::from_secs(60);

/// The scene with 8e5 states: nearly the most there may be.
fn long_scene() -> String {
    edited("step = 1e-3", "step = 5e-8")
}

fn start(directory: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_vibrissa"))
        .args(arguments)
        .current_dir(directory)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// The staging directory in `out`, if there is one.
fn stage(out: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(out).ok()?.flatten().map(|entry| entry.path());
    entries.into_iter().find(|path| path.file_name().unwrap().to_string_lossy().starts_with(".vibrissa-"))
}

/// Waits for something that the child does.
fn until<T>(child: &mut Child, mut seen: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(seen) = seen() {
            return seen;
        }
        assert!(child.try_wait().unwrap().is_none(), "the command ended too early");
        assert!(start.elapsed() < PATIENCE, "the command does not come to it");
        sleep(Duration::from_millis(1));
    }
}

fn names(directory: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn json(file: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A sweep that is sent this signal in its midst: its directory and what it said.
fn interrupted_sweep(name: &str) -> (tempfile::TempDir, Output) {
    let mut wait = FIRST_WAIT;
    loop {
        let directory = tempfile::tempdir().unwrap();
        fs::write(directory.path().join("scene.toml"), long_scene()).unwrap();
        let mut child = start(directory.path(), &["sweep", "scene.toml", "--out", "new/out"]);
        let out = directory.path().join("new/out");
        until(&mut child, || stage(&out));
        sleep(wait);
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        if !stderr(&output).contains("nothing is written") {
            return (directory, output);
        }
        // too early: then nothing is left, not even the directories
        assert_eq!(names(directory.path()), ["scene.toml"]);
        wait *= 2;
    }
}

#[test]
fn an_interrupted_sweep_writes_what_it_has_and_says_so() {
    for (name, status) in [("-INT", 130), ("-TERM", 143)] {
        let (directory, output) = interrupted_sweep(name);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(status), "{message}");
        assert!(message.starts_with("warning: scene: interrupted at clamp (0.0"), "{message}");
        assert!(message.contains("sweep.json") && message.lines().count() == 1, "{message}");
        assert!(String::from_utf8(output.stdout).unwrap().starts_with("scene: incomplete, "));

        let out = directory.path().join("new/out");
        assert_eq!(
            names(&out),
            ["contacts.csv", "events.jsonl", "states.csv", "states.jsonl", "sweep.json", "sweep.svg"]
        );
        let states = fs::read_to_string(out.join("states.jsonl")).unwrap();
        let count = states.lines().count();
        assert!((1..800_001).contains(&count), "{count}");
        assert_eq!(fs::read_to_string(out.join("states.csv")).unwrap().lines().count(), count + 1);
        let summary = json(&out.join("sweep.json"));
        assert_eq!((&summary["complete"], &summary["stop"]["kind"]), (&false.into(), &"interrupted".into()));
        assert_eq!(summary["states"], count);
        let events = fs::read_to_string(out.join("events.jsonl")).unwrap();
        let last = |lines: &str| lines.lines().last().map(|line| serde_json::from_str::<Value>(line).unwrap());
        let ends = [last(&states), last(&events)].into_iter().flatten().map(|end| end["x0"].clone());
        assert!(ends.into_iter().any(|x0| x0 == summary["stop"]["x0"]), "{summary}");
        assert!(fs::read_to_string(out.join("sweep.svg")).unwrap().contains(", interrupted"));
    }
}

#[test]
fn a_second_signal_leaves_no_stage_either() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), long_scene()).unwrap();
    let mut child = start(directory.path(), &["sweep", "scene.toml", "--out", "out"]);
    let out = directory.path().join("out");
    until(&mut child, || stage(&out));
    sleep(20 * FIRST_WAIT);
    // whichever of them it is in: the sweep, the writing, or an end at once
    while child.try_wait().unwrap().is_none() {
        signal(&child, "-INT");
        sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let left = if out.exists() { names(&out) } else { Vec::new() };
    assert!(left.is_empty() || left.len() == 6 && stage(&out).is_none(), "{left:?}");
}

/// Of a search for scans nothing is written when it is interrupted, so it ends at once: a minute's work within a second.
#[test]
fn a_search_for_scans_ends_at_once() {
    for (command, first) in [(["reach", "scene.toml"], "scene"), (["plan", "found"], "plan")] {
        let directory = tempfile::tempdir().unwrap();
        fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
        let points: String = (0..40)
            .map(|k| format!("1,{},{},touched,1e-5,,false\n", 1e-3 * f64::from(k), 1e-4 * f64::from(k)))
            .collect();
        fs::create_dir(directory.path().join("found")).unwrap();
        let text = format!("object,x,y,known,sigma,room,vertex\n{points}");
        fs::write(directory.path().join("found/fitted.csv"), text).unwrap();
        let distances = ["--distances", "0.02:0.09:20000"];
        let rod: &[&str] = if first == "plan" { &["--rod", "scene.toml", "--stress", "any"] } else { &[] };
        let mut child = start(directory.path(), &[&command, &distances[..], rod].concat());
        sleep(10 * FIRST_WAIT);
        assert!(child.try_wait().unwrap().is_none(), "the command ended too early");
        signal(&child, "-TERM");
        let sent = Instant::now();
        let output = child.wait_with_output().unwrap();
        assert!(sent.elapsed() < Duration::from_secs(1), "{command:?}: {:?}", sent.elapsed());
        assert_eq!(output.status.code(), Some(143), "{output:?}");
        assert!(stderr(&output).contains("interrupted; nothing is written"), "{output:?}");
        let out = directory.path().join("out").join(first);
        assert!(!out.exists() || names(&out).is_empty(), "{command:?}");
    }
}

#[test]
fn a_sweep_interrupted_at_once_has_no_states() {
    let interrupt = Interrupt::default();
    interrupt.raise();
    let scan = Scan::run_until(Scene::parse("scene.toml".as_ref(), SCENE).unwrap(), &interrupt).unwrap();
    assert!(scan.outcome.states.is_empty() && scan.outcome.events.is_empty() && !scan.is_complete());
    assert_eq!(scan.interrupted.unwrap().pose, None);
    assert!(scan.report().starts_with("scene: incomplete, no phase; 0 states"), "{}", scan.report());
    let directory = tempfile::tempdir().unwrap();
    let staged = Staged::new(directory.path()).unwrap();
    write_sweep(&scan, &staged, Path::new("")).unwrap();
    staged.publish().unwrap();
    assert_eq!(json(&directory.path().join("sweep.json"))["phases"], Value::Null);
}

#[test]
fn a_sweep_that_is_not_interrupted_says_that_it_is_complete() {
    let directory = tempfile::tempdir().unwrap();
    let scan = Scan::run(Scene::parse("scene.toml".as_ref(), SCENE).unwrap()).unwrap();
    let staged = Staged::new(directory.path()).unwrap();
    write_sweep(&scan, &staged, Path::new("")).unwrap();
    staged.publish().unwrap();
    let summary = json(&directory.path().join("sweep.json"));
    assert_eq!((&summary["complete"], &summary["stop"]), (&true.into(), &Value::Null));
    assert_eq!((&summary["states"], &summary["phases"]), (&41.into(), &"free A B".into()));
}

#[test]
fn one_state_can_be_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let mut scan = Scan::run(Scene::parse("scene.toml".as_ref(), SCENE).unwrap()).unwrap();
    scan.outcome.states.truncate(1);
    scan.outcome.events.clear();
    write_sweep(&scan, &Staged::new(directory.path()).unwrap(), Path::new("")).unwrap();
}

#[test]
fn an_interrupted_simulation_ends_with_a_comment_that_the_reader_knows() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let arguments = ["simulate", "scene.toml", "--rate", "2.4e4", "--file", "out/recording.csv"];
    let mut child = start(directory.path(), &arguments);
    let out = directory.path().join("out");
    let begun = || fs::metadata(stage(&out)?.join("recording.csv")).ok().filter(|file| file.len() > 0);
    until(&mut child, begun);
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.starts_with("warning: scene: interrupted at clamp (0.0"), "{message}");
    assert_eq!(names(&out), ["recording.csv"]);

    let file = out.join("recording.csv");
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.lines().last().unwrap().starts_with("# incomplete: interrupted at clamp (0.0"));
    let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap();
    let recording = Recording::read(&file, &rod, &ReadOptions::default()).unwrap();
    assert_eq!(recording.samples().count(), text.lines().count() - 2);
    let warnings = recording.warnings();
    assert!(warnings[0].contains("the recording is incomplete: interrupted at clamp"), "{warnings:?}");
}

#[test]
fn a_simulation_interrupted_at_once_leaves_the_earlier_file_alone() {
    let directory = tempfile::tempdir().unwrap();
    let scene = Scene::parse("scene.toml".as_ref(), SCENE).unwrap();
    let noise = NoiseModel::default();
    let simulation = Simulation { scene, noise, rate: 500.0, speed: 1e-2, seed: 0, sigmas: false };
    let interrupt = Interrupt::default();
    let file = directory.path().join("recording.csv");
    assert_eq!(simulation.write(&file, &interrupt).unwrap().interrupted, None);
    let good = fs::read(&file).unwrap();
    interrupt.raise();
    for out in [file.clone(), directory.path().join("new/recording.csv")] {
        let simulated = simulation.write(&out, &interrupt).unwrap();
        assert!(simulated.interrupted.is_some() && simulated.samples == 0);
    }
    assert_eq!(fs::read(&file).unwrap(), good);
    assert_eq!(names(directory.path()), ["recording.csv"]);
}

#[test]
fn an_interrupted_paper_keeps_the_scans_that_are_done() {
    let directory = tempfile::tempdir().unwrap();
    let interrupt = Interrupt::default();
    let ended_by_its_first_scan = || {
        interrupt.raise();
    };
    let paper = Paper::run(&interrupt, ended_by_its_first_scan).unwrap();
    assert!(!paper.scans.is_empty());
    let staged = Staged::new(directory.path()).unwrap();
    assert!(!paper.write(&staged, &interrupt).unwrap());
    staged.publish().unwrap();
    let report = json(&directory.path().join("paper.json"));
    assert_eq!(report["complete"], false);
    let (done, missing) = (report["scans"].as_array().unwrap(), report["missing"].as_array().unwrap());
    assert_eq!((done.len(), done.len() + missing.len()), (paper.scans.len(), Paper::SCANS));
    let mut expected: Vec<&str> = done.iter().map(|scan| scan["name"].as_str().unwrap()).collect();
    expected.push("paper.json");
    assert_eq!(names(directory.path()), expected, "no figure of all scans");
    let names: Vec<&str> = missing.iter().map(|name| name.as_str().unwrap()).collect();
    assert!(names.iter().all(|name| name.starts_with('O') && !name.ends_with(".toml")), "as in scans: {names:?}");
    for scan in done {
        let summary = directory.path().join(scan["name"].as_str().unwrap()).join("sweep.json");
        assert_eq!((&json(&summary)["complete"], &scan["matches"]), (&true.into(), &true.into()));
    }
    assert_eq!(paper.report().starts_with("incomplete: "), !missing.is_empty());
}

#[test]
fn a_paper_interrupted_at_once_has_no_scans() -> Result<(), PaperError> {
    let interrupt = Interrupt::default();
    interrupt.raise();
    let paper = Paper::run(&interrupt, || ())?;
    assert!(paper.scans.is_empty() && !paper.is_complete());

    // where the signal comes too late, once more
    let (_directory, out, output) = (0..20)
        .find_map(|_| {
            let directory = tempfile::tempdir().unwrap();
            let mut child = start(directory.path(), &["paper", "--out", "out"]);
            let out = directory.path().join("out");
            until(&mut child, || stage(&out));
            signal(&child, "-INT");
            let output = child.wait_with_output().unwrap();
            (output.status.code() != Some(0)).then_some((directory, out, output))
        })
        .unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stage(&out).is_none());
    match out.exists() {
        true => assert_eq!(json(&out.join("paper.json"))["complete"], false),
        false => assert!(stderr(&output).contains("nothing is written"), "{}", stderr(&output)),
    }
    Ok(())
}

/// A command that reads one of its files from a pipe, into which nothing comes, is interrupted while it waits.
#[test]
fn contour_and_reconstruct_end_at_once_and_write_nothing() {
    for arguments in [
        &["contour", "pipe", "--file", "out/contour.csv"][..],
        &["reconstruct", "recording.csv", "--rod", "pipe", "--out", "out"],
    ] {
        let directory = tempfile::tempdir().unwrap();
        let pipe = directory.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let child = start(directory.path(), arguments);
        // opened here once it is opened there
        let writer = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
        signal(&child, "-INT");
        let output = child.wait_with_output().unwrap();
        drop(writer);
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert_eq!(stderr(&output), "warning: interrupted; nothing is written\n");
        assert_eq!(names(directory.path()), ["pipe"]);
    }
}
