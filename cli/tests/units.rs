//! Quantities with a unit in scene files, and clamps that only turn.

use crate::common::{SCENE, complaint, edited, vibrissa};
use rod_files::Scene;
use std::fs;

fn read(scene: &str) -> Scene {
    Scene::parse("scene.toml".as_ref(), scene).unwrap_or_else(|error| panic!("{error}"))
}

/// Every quantity of a scene in other units gives the same numbers, to the last digit.
#[test]
fn a_scene_in_units_is_that_in_si() {
    let plain = "\
[rod]\nlength = 0.035\ndiameter = [[0.0, 0.3e-3], [0.035, 0.05e-3]]\nyoungs_modulus = 3e9\nnatural_curvature = 20.0
[clamp]\nstiffness_x = 1e3\nstiffness_phi = 0.5
[[object]]\nposition = [0.007, 0.03]\nangle = 20.0\n[[object.piece]]\nshape = \"circle\"\ncenter = [0.0, 0.003]\nradius = 0.003
[[object]]\nposition = [0.05, 0.09]\n[[object.piece]]\nshape = \"polygon\"\npoints = [[0.0, 0.0], [0.01, 0.0], [0.01, 0.01]]
[sweep]\nfrom = [0.0, -0.01]\nto = [0.0, 0.0]\nangle = 90.0\nstep = 5e-4\nstep_angle = 1.0
[[sweep.leg]]\npivot = [0.0, -0.008]\nturn = -30.0\n";
    let units = "\
[rod]\nlength = \"35 mm\"\ndiameter = [[0.0, \"0.3 mm\"], [\"35mm\", \"50 um\"]]\nyoungs_modulus = \"3 GPa\"\nnatural_curvature = \"0.02 1/mm\"
[clamp]\nstiffness_x = \"1 N/mm\"\nstiffness_phi = \"500 mN m/rad\"
[[object]]\nposition = [\"7 mm\", \"3 cm\"]\nangle = \"20 deg\"\n[[object.piece]]\nshape = \"circle\"\ncenter = [0.0, \"3 mm\"]\nradius = \"3 mm\"
[[object]]\nposition = [\"5 cm\", \"90 mm\"]\n[[object.piece]]\nshape = \"polygon\"\npoints = [[0.0, 0.0], [\"10 mm\", 0.0], [\"10 mm\", \"10 mm\"]]
[sweep]\nfrom = [0.0, \"-10 mm\"]\nto = [0.0, 0.0]\nangle = \"90\u{b0}\"\nstep = \"0.5 mm\"\nstep_angle = \"1 deg\"
[[sweep.leg]]\npivot = [0.0, \"-8 mm\"]\nturn = \"-30 deg\"\n";
    let (plain, units) = (read(plain), read(units));
    assert_eq!(plain.tables(), units.tables());
    assert_eq!((units.rod.length(), units.legs.len(), units.warnings.len()), (0.035, 1, 0));
    let end = |scene: &Scene| scene.legs[0].path.at(scene.legs[0].path.length());
    assert_eq!(end(&plain), end(&units));
}

#[test]
fn a_study_changes_a_quantity_with_a_unit() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), edited("0.1", "\"100 mm\"")).unwrap();
    let study = "scene = \"scene.toml\"\n[[parameter]]\nname = \"size\"\nvalues = [0.1, 0.11]\nset = [{ field = \"rod.length\" }]\n";
    fs::write(directory.path().join("study.toml"), study).unwrap();
    let output = vibrissa(directory.path(), &["study", "study.toml", "--scene", "1"]);
    assert!(output.status.success(), "{}", complaint(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("length = 0.11"));
}

#[test]
fn a_clamp_that_only_turns_needs_no_end() {
    let turning = edited("to = [0.03, -0.04]\n", "").replace("90.0", "90.0\nangle_to = 120.0");
    let turning = turning.replace("step = 1e-3", "step_angle = \"1 deg\"");
    let same = turning.replacen("angle = ", "to = [0.07, -0.04]\nangle = ", 1);
    let (turning, same) = (read(&turning), read(&same));
    assert!(turning.turns_only() && same.turns_only());
    assert_eq!((turning.path.at(0.1), turning.step), (same.path.at(0.1), same.step));
    let still = edited("to = [0.03, -0.04]\n", "").replace("90.0", "90.0\nangle_to = 90.0");
    let error = Scene::parse("scene.toml".as_ref(), &still).unwrap_err().to_string();
    assert!(error.starts_with("scene.toml:19:12: sweep.angle_to: the path ends where it starts"), "{error}");
    assert!(!read(SCENE).turns_only());
}
