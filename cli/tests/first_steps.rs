//! What leads a newcomer on: the help, a scene to begin with, the list of shapes.

use crate::common::{SCENE, complaint, vibrissa};
use std::fs;
use std::path::Path;

fn said(arguments: &[&str]) -> String {
    let output = vibrissa(Path::new("."), arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", complaint(&output));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn without_a_command_the_first_steps_are_told() {
    let output = vibrissa(Path::new("."), &[]);
    let help = complaint(&output);
    assert_eq!(output.status.code(), Some(2));
    for part in ["Simulates a flexible whisker", "vibrissa init", "vibrissa sweep scene.toml", "sweep.svg", "shapes"] {
        assert!(help.contains(part), "{part} is not in {help}");
    }
}

/// A path in mm leads far away from the objects: this is valid, and is told.
#[test]
fn a_sweep_that_touches_nothing_says_so() {
    let directory = tempfile::tempdir().unwrap();
    let report = |scene: &str| {
        fs::write(directory.path().join("scene.toml"), scene).unwrap();
        let output = vibrissa(directory.path(), &["sweep", "scene.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        (String::from_utf8_lossy(&output.stdout).into_owned(), complaint(&output))
    };
    let (said, warned) = report(&SCENE.replace("0.07, -", "70, -").replace("0.03, -", "30, -").replace("1e-3", "1.0"));
    assert!(said.starts_with("scene: free; 41 states, 0 events\nnote: no contact on the whole path; the rod of 100.000000 mm comes as near"), "{said}");
    assert!(said.contains(" mm; are all lengths in m?\n"), "{said}");
    assert!(warned.contains("sweep.to: the path is 400 lengths of the rod long; are from and to in m?"), "{warned}");
    let (said, warned) = report(&SCENE.replace("to = [0.03, -", "to = [0.066, -"));
    let near = said.split("comes as near to the objects as ").nth(1).unwrap().split(" mm\n").next().unwrap();
    assert!((0.1..2.0).contains(&near.parse::<f64>().unwrap()) && warned.is_empty(), "{said}{warned}");
    assert!(!report(SCENE).0.contains("note:"));
}

#[test]
fn every_command_has_an_example_and_a_next_step() {
    let whole = said(&["--help"]);
    let commands = whole.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0;
    let names: Vec<&str> = commands.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() >= 11, "{names:?}");
    for name in names.into_iter().filter(|name| *name != "help") {
        let help = said(&[name, "--help"]);
        assert!(help.contains("Example") && help.contains(&format!("\n  vibrissa {name}")), "{name}: {help}");
        assert!(help.contains("\nNext: "), "{name}: {help}");
    }
}

#[test]
fn the_first_scene_is_swept_as_it_is_and_never_written_over_a_file() {
    let directory = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| vibrissa(directory.path(), arguments);
    assert_eq!(run(&["init"]).status.code(), Some(0));
    let output = run(&["sweep", "scene.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let report = String::from_utf8(output.stdout).unwrap();
    assert!(report.starts_with("scene: free A B A free; ") && output.stderr.is_empty(), "{report}");

    fs::write(directory.path().join("mine.toml"), "mine").unwrap();
    let output = run(&["init", "mine.toml"]);
    assert_eq!((output.status.code(), complaint(&output).contains("mine.toml exists and is kept")), (Some(1), true));
    assert_eq!(fs::read_to_string(directory.path().join("mine.toml")).unwrap(), "mine");
    assert!(complaint(&run(&["init", "nowhere/scene.toml"])).contains("cannot write nowhere/scene.toml"));
}

#[test]
fn each_first_scene_is_swept_as_it_is() {
    let directory = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| vibrissa(directory.path(), arguments);
    for (option, phases) in
        [("--whisking", "free B A free B A free"), ("--recording", "free A B A free"), ("--polygon", "free B A")]
    {
        let file = format!("{}.toml", option.trim_start_matches('-'));
        assert_eq!(run(&["init", option, &file]).status.code(), Some(0), "{option}");
        let output = run(&["sweep", &file]);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        let report = String::from_utf8(output.stdout).unwrap();
        assert!(report.contains(&format!(": {phases};")) && output.stderr.is_empty(), "{report}");
    }
    let output = run(&["init", "--whisking", "--polygon", "both.toml"]);
    assert!(output.status.code() == Some(2) && complaint(&output).contains("cannot be used with"));
}

/// The scene of each average whisker is swept to its end: the longest and the shortest of each animal, and one with a source in its comments.
#[test]
fn the_scene_of_a_whisker_meets_its_peg() {
    let directory = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| vibrissa(directory.path(), arguments);
    for name in ["C0", "c5", "rat:C2", "mouse:B0", "mouse:A3"] {
        let file = format!("{}.toml", name.replace(':', "_"));
        let output = run(&["init", "--whisker", name, &file]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", complaint(&output));
        let output = run(&["sweep", &file]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", complaint(&output));
        let report = String::from_utf8(output.stdout).unwrap();
        assert!(report.contains(": free B free B") && output.stderr.is_empty(), "{report}");
    }
    let text = fs::read_to_string(directory.path().join("rat_C2.toml")).unwrap();
    for part in
        ["\nlength = \"32.6 mm\"\n", "\ndiameter = \"131.4 um\"", "Belli et al. (2017)", "1.48 GPa, Quist et al."]
    {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    let output = run(&["init", "--whisker", "mouse:A0"]);
    assert!(
        output.status.code() == Some(2)
            && complaint(&output).contains("expected 1 to 3: the whiskers in row A of a mouse")
    );
}

/// The commands in the comments of the scene, run as they are.
#[test]
fn the_commands_of_the_recording_scene_work() {
    let directory = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| vibrissa(directory.path(), arguments);
    assert_eq!(run(&["init", "--recording"]).status.code(), Some(0));
    let text = fs::read_to_string(directory.path().join("scene.toml")).unwrap();
    let commands = text.lines().filter_map(|line| line.strip_prefix("#   vibrissa ")).map(str::to_owned);
    let commands: Vec<String> = commands.collect();
    assert_eq!(commands.len(), 2, "{text}");
    for command in commands {
        let output = run(&command.split_whitespace().collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(0), "{command}: {}", complaint(&output));
    }
    assert!(directory.path().join("reconstruction/contour.svg").exists());
    let noise = text.lines().find_map(|line| line.strip_prefix("#   white")).unwrap();
    fs::write(directory.path().join("noise.toml"), format!("white{noise}\n")).unwrap();
    let noisy = ["simulate", "scene.toml", "--noise", "noise.toml", "--seed", "1", "--sigmas", "--file", "noisy.csv"];
    assert_eq!(run(&noisy).status.code(), Some(0));
}

/// The list is made from the shapes; the page about scene files must name the same fields.
#[test]
fn the_list_of_shapes_is_that_of_the_page() {
    let list = said(&["shapes"]);
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/scene-files.md")).unwrap();
    for shape in list.split("\n\n") {
        let (name, fields) = shape.split_once("\n").unwrap();
        let name = name.split('"').nth(1).unwrap();
        let row = page.lines().find(|line| line.starts_with(&format!("| `\"{name}\"` |"))).unwrap();
        for field in fields.lines().skip(1).filter_map(|line| line.split_whitespace().next()) {
            assert!(row.contains(&format!("`{field}`")), "{name}: {field} is not in {row}");
        }
    }
    assert!(list.contains("radius") && list.contains("degrees") && list.contains("1/m"), "{list}");
}

#[test]
fn quiet_commands_say_nothing_but_warnings() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    fs::write(directory.path().join("radians.toml"), SCENE.replace("angle = 90.0", "angle = 1.5708")).unwrap();
    for command in ["sweep", "contour", "simulate"] {
        let output = vibrissa(directory.path(), &[command, "scene.toml", "--quiet"]);
        assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(), "{command}");
    }
    assert!(directory.path().join("out/scene/sweep.svg").exists());
    let output = vibrissa(directory.path(), &["-q", "contour", "radians.toml"]);
    assert!(complaint(&output).contains("is 90 degrees meant?") && output.stdout.is_empty());
}

#[test]
fn completions_and_manual_pages() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = said(&["completions", shell]);
        assert!(text.contains("reconstruct") && text.contains("fake-sensor"), "{shell}");
    }
    let page = said(&["man"]);
    assert!(page.contains(".TH vibrissa 1") && page.contains("vibrissa init"), "{page}");
    let page = said(&["man", "sweep"]);
    assert!(page.contains(".TH vibrissa-sweep 1") && page.contains("vibrissa sweep"), "{page}");
    let output = vibrissa(Path::new("."), &["man", "sweeep"]);
    assert!(output.status.code() == Some(2) && complaint(&output).contains("expected one of init, sweep"));
}
