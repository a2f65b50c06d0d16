//! The command, run as a user runs it, and a judge of sweeps that shares no code with the solver.
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod case;
#[path = "../../../tests/common/golden.rs"]
pub mod golden;
pub mod judge;
pub mod outline;
pub mod rod;

use std::path::Path;
use std::process::{Command, Output};

/// A rod swept a little way into contact with two parabolas.
pub const SCENE: &str = "\
[rod]
length = 0.1
diameter = 0.5e-3
youngs_modulus = 206e9

[[contour.piece]]
shape = \"parabola\"
vertex = [0.0, 0.0]
coefficient = 50.0

[[contour.piece]]
shape = \"parabola\"
vertex = [0.03, 0.0]
coefficient = 50.0

[sweep]
from = [0.07, -0.04]
to = [0.03, -0.04]
angle = 90.0
step = 1e-3
";

/// The scene with one part replaced by another.
pub fn edited(from: &str, to: &str) -> String {
    assert!(SCENE.contains(from), "{from} is not in the scene");
    SCENE.replacen(from, to, 1)
}

/// Runs `vibrissa ARGUMENTS` in a directory.
pub fn vibrissa(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vibrissa")).args(arguments).current_dir(directory).output().unwrap()
}

/// What a command said on standard error.
pub fn complaint(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The scene with other objects, on lines 6 and after.
pub fn with_objects(objects: &str) -> String {
    let (rod, sweep) = (SCENE.find("[[contour").unwrap(), SCENE.find("[sweep]").unwrap());
    SCENE[..rod].to_owned() + objects + "\n" + &SCENE[sweep..]
}

/// What a sweep of this scene says on standard error, where it fails.
pub fn refused(scene: &str) -> String {
    refused_beside(scene, &[])
}

/// The same for a scene with other files beside it, by name and content.
pub fn refused_beside(scene: &str, files: &[(&str, &str)]) -> String {
    let directory = tempfile::tempdir().unwrap();
    for (name, content) in files {
        std::fs::write(directory.path().join(name), content).unwrap();
    }
    std::fs::write(directory.path().join("scene.toml"), scene).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "scene.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
    assert!(!directory.path().join("out").exists(), "nothing is written for a scene that is none");
    complaint(&output)
}
