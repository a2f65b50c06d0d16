//! Where results may go: standard output, and no link, device or input.

use crate::common::{SCENE, complaint, vibrissa, with_objects};
use std::fs;
use std::path::Path;

fn with_scene(scene: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), scene).unwrap();
    directory
}

#[test]
fn a_table_goes_to_standard_output_with_the_report_beside() {
    let directory = with_scene(SCENE);
    for (arguments, file) in [
        (&["simulate", "scene.toml", "--rate", "10"][..], "r.csv"),
        (&["contour", "scene.toml", "--tolerance", "1e-4"], "c.csv"),
    ] {
        let run = |out: &str| vibrissa(directory.path(), &[arguments, &["--out", out]].concat());
        let output = run("-");
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        assert!(complaint(&output).contains("written to standard output"), "{}", complaint(&output));
        assert!(run(file).status.success());
        assert!(output.stdout == fs::read(directory.path().join(file)).unwrap() && output.stdout.len() > 500);
    }
    assert!(!directory.path().join("-").exists() && !directory.path().join("out").exists());
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_error() {
    use std::process::{Command, Stdio};
    let directory = with_scene(SCENE);
    for command in ["simulate", "contour"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_vibrissa"))
            .args([command, "scene.toml", "--quiet", "--out", "-"])
            .current_dir(directory.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), complaint(&output).as_str()), (Some(0), ""), "{command}");
    }
}

/// Runs a command that must refuse to write, and checks that the file is as it was.
fn refuses(directory: &Path, arguments: &[&str], file: &str, why: &str) {
    let before = fs::read(directory.join(file)).unwrap();
    let output = vibrissa(directory, arguments);
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
    assert!(message.contains(why) && message.contains("name another file or directory"), "{arguments:?}: {message}");
    assert_eq!(fs::read(directory.join(file)).unwrap(), before, "{arguments:?}");
}

#[test]
fn no_input_is_overwritten() {
    let points = "[[object]]\n[[object.piece]]\nshape = \"polygon\"\nfile = \"states.csv\"\n";
    let directory = with_scene(&with_objects(points));
    let path = directory.path();
    fs::write(path.join("states.csv"), "x,y\n0.0,0.02\n0.01,0.02\n0.01,0.03\n0.0,0.03\n").unwrap();
    fs::write(path.join("noise.toml"), "white = { force = 1e-3 }").unwrap();
    let read = "is read by this command";
    refuses(path, &["simulate", "scene.toml", "--file", "scene.toml"], "scene.toml", read);
    refuses(path, &["simulate", "scene.toml", "--file", "./states.csv"], "states.csv", read);
    refuses(path, &["simulate", "scene.toml", "--noise", "noise.toml", "--file", "noise.toml"], "noise.toml", read);
    refuses(path, &["contour", "scene.toml", "--file", "states.csv"], "states.csv", read);
    refuses(path, &["sweep", "scene.toml", "--out", "."], "states.csv", read);

    fs::create_dir(path.join("r")).unwrap();
    assert!(vibrissa(path, &["simulate", "scene.toml", "--file", "r/contour.csv"]).status.success());
    let reconstruct = ["reconstruct", "r/contour.csv", "--rod", "scene.toml", "--out", "r"];
    refuses(path, &reconstruct, "r/contour.csv", read);
    fs::rename(path.join("r/contour.csv"), path.join("r/recording.csv")).unwrap();
    let live = ["live", "--sensor", "file:r/recording.csv", "--rod", "scene.toml", "--out", "r"];
    refuses(path, &live, "r/recording.csv", read);
    assert_eq!(fs::read_dir(path.join("r")).unwrap().count(), 1, "nothing else is written");
}

/// A drawing beside the table of a contour is an output, too.
#[test]
fn a_drawing_that_is_read_is_not_overwritten() {
    let drawing = "[[object]]\n[[object.piece]]\nshape = \"svg\"\nfile = \"bump.svg\"\nscale = 1e-3\n";
    let directory = with_scene(&with_objects(drawing));
    fs::write(directory.path().join("bump.svg"), "<svg><path d=\"M0 -20 h10 v-10 h-10 z\"/></svg>").unwrap();
    refuses(directory.path(), &["contour", "scene.toml", "--file", "bump.csv"], "bump.svg", "is read by this command");
    assert!(!directory.path().join("bump.csv").exists());
}

#[cfg(unix)]
#[test]
fn no_link_and_no_device_is_replaced() {
    use std::os::unix::fs::symlink;
    let directory = with_scene(SCENE);
    let path = directory.path();
    for name in ["link.csv", "link.svg", "states.jsonl", "recording.csv"] {
        symlink("target", path.join(name)).unwrap();
    }
    fs::write(path.join("target"), "kept").unwrap();
    assert!(vibrissa(path, &["simulate", "scene.toml", "--file", "r.csv"]).status.success());
    let link = "is a link and is not replaced";
    refuses(path, &["simulate", "scene.toml", "--file", "link.csv"], "target", link);
    refuses(path, &["contour", "scene.toml", "--file", "link.csv"], "target", link);
    refuses(path, &["contour", "scene.toml", "--file", "link"], "target", link);
    refuses(path, &["sweep", "scene.toml", "--out", "."], "target", link);
    refuses(path, &["live", "--sensor", "file:r.csv", "--rod", "scene.toml", "--out", "."], "target", link);
    refuses(path, &["simulate", "scene.toml", "--file", "/dev/null"], "target", "/dev/null is a device");
    assert!(fs::symlink_metadata(path.join("link.csv")).unwrap().is_symlink());
}
