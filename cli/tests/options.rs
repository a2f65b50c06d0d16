//! Options with wrong values, and warnings of numbers that are valid but implausible.

use crate::common::{SCENE, complaint, edited, vibrissa};
use std::fs;

/// Checks that a command on the scene ends with the status of wrong options, and that the message holds this.
fn refuses(command: &str, arguments: &[&str], part: &str) {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let output = vibrissa(directory.path(), &[&[command, "scene.toml"], arguments].concat());
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains(part), "`{part}` is not in: {message}");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1, "nothing is written");
}

#[test]
fn wrong_values_have_the_status_of_wrong_options() {
    refuses("simulate", &["--rate", "0"], "--rate is 0, expected a positive");
    refuses("simulate", &["--speed", "0"], "--speed is 0, expected a positive");
    refuses("simulate", &["--seed", "-1"], "invalid value '-1' for '--seed <N>': expected a whole number from 0 to");
    refuses("simulate", &["--sigmas"], "--sigmas: ");
    refuses("contour", &["--tolerance", "0"], "--tolerance is 0 m, expected at least");
    refuses("contour", &["--object", "3"], "--object is 3, expected a number from 0 to 0");
    refuses("contour", &["--object", "-1"], "'--object <N>': expected a whole number, 0 or larger");
    refuses("fake-sensor", &["--protocol", "rdt", "--faster", "0"], "--faster is 0, expected a positive");
}

#[test]
fn a_directory_of_results_is_not_standard_output() {
    refuses("sweep", &["--out", "-"], "several files cannot go to standard output, expected a directory");
}

#[test]
fn a_quiet_option_is_listed_where_there_is_a_report() {
    let help = |command: &str| {
        let output = vibrissa(".".as_ref(), &[command, "--help"]);
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(help("sweep").contains("--quiet") && help("init").contains("--quiet"));
    for command in ["shapes", "completions", "man"] {
        assert!(!help(command).contains("--quiet"), "{command}");
    }
    assert_eq!(vibrissa(".".as_ref(), &["shapes", "--quiet"]).status.code(), Some(0));
}

#[test]
fn implausible_rods_are_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    for (from, to, part) in [
        ("length = 0.1", "length = 50.0", "scene.toml:2:10: rod.length: length is 50 m, expected 1e-4 to 1e1 m"),
        ("206e9", "3.0", "rod.youngs_modulus: youngs_modulus is 3 Pa, expected 1e4 to 2e12 Pa"),
    ] {
        fs::write(directory.path().join("scene.toml"), edited(from, to)).unwrap();
        let output = vibrissa(directory.path(), &["contour", "scene.toml"]);
        let message = complaint(&output);
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.starts_with("warning: ") && message.contains(part), "{message}");
    }
}
