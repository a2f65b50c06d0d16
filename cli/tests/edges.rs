//! A square and a triangle in many poses, rods parallel to a side among them, from both sides, with clamps that turn.

use crate::common::judge::judge;
use rod_files::{Scan, Scene};
use vibrissa::contact::EventKind;

/// Centre at the origin, sides of 40 mm. Side angles: 0 and 90 degrees, and every multiple of 60, plus the rotation.
const SHAPES: [(&str, &str); 2] = [
    ("square", "[[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]]"),
    ("triangle", "[[-0.02, -0.011547005383793], [0.02, -0.011547005383793], [0.0, 0.023094010767585]]"),
];
/// Degrees. With rods at 60, 90 and 120 degrees, 0, 30, 60 and 90 make one parallel to a side.
const ROTATIONS: [f64; 6] = [0.0, 15.0, 30.0, 45.0, 60.0, 90.0];

/// A scene of one polygon. The path in the words of a scene file.
fn scene(name: &str, points: &str, rotation: f64, path: &str) -> Scene {
    let text = format!(
        "[rod]\nlength = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n\
         [[object]]\nangle = {rotation:?}\n[[object.piece]]\nshape = \"polygon\"\npoints = {points}\n[sweep]\n{path}"
    );
    Scene::parse(name.as_ref(), &text).unwrap()
}

/// What is wrong with the sweeps of all shapes in all rotations along some paths, each with a name.
fn faults(paths: &[(String, String)]) -> Vec<String> {
    let mut faults = Vec::new();
    for (shape, points) in SHAPES {
        for rotation in ROTATIONS {
            for (name, path) in paths {
                let scan = Scan::run(scene(&format!("{shape} at {rotation}, {name}"), points, rotation, path)).unwrap();
                faults.extend(judge(&scan.scene, &scan.outcome).err());
            }
        }
    }
    faults
}

fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn straight_past_from_both_sides() {
    let mut paths = Vec::new();
    for y in [-0.05, -0.075, -0.085] {
        for angle in [60.0, 90.0, 120.0] {
            for from in [0.13, -0.13] {
                let path =
                    format!("from = [{from:?}, {y:?}]\nto = [{:?}, {y:?}]\nangle = {angle:?}\nstep = 5e-3\n", -from);
                paths.push((format!("clamp at {y}, {angle} degrees from {from}"), path));
            }
        }
    }
    assert_none(&faults(&paths));
}

#[test]
fn clamps_that_turn() {
    let mut paths = Vec::new();
    for [x, y] in [[0.05, -0.05], [0.0, -0.06], [-0.04, -0.07]] {
        for way in [1.0, -1.0] {
            let [from, to] = [90.0 + 100.0 * way, 90.0 - 100.0 * way];
            let turn = format!(
                "from = [{x:?}, {y:?}]\nto = [{x:?}, {y:?}]\nangle = {from:?}\nangle_to = {to:?}\nstep_angle = 5.0\n"
            );
            paths.push((format!("turning from {from} at ({x}, {y})"), turn));
            let [start, end] = [x + 0.1 * way, x - 0.1 * way];
            let [from, to] = [90.0 + 60.0 * way, 90.0 - 60.0 * way];
            let both = format!(
                "from = [{start:?}, {y:?}]\nto = [{end:?}, {:?}]\nangle = {from:?}\nangle_to = {to:?}\nstep = 5e-3\n",
                y + 0.01
            );
            paths.push((format!("turning from {from} on the way from {start}"), both));
        }
    }
    assert_none(&faults(&paths));
}

/// Sides and vertices met head-on, some exactly. On a side the branch ends where that of the buckled rod crosses it, and a solution there is on either by
/// rounding: one place tells nothing of the next.
#[test]
fn pushed_along_the_rod() {
    let mut paths = Vec::new();
    for angle in [60.0, 90.0, 120.0_f64] {
        for aside in [0.0, 0.004, -0.013, 0.006, -0.009, 0.012, -0.015] {
            let (sin, cos) = angle.to_radians().sin_cos();
            let at = |back: f64| format!("[{:?}, {:?}]", -back * cos - aside * sin, -back * sin + aside * cos);
            let path = format!("from = {}\nto = {}\nangle = {angle:?}\nstep = 2e-3\n", at(0.15), at(0.09));
            paths.push((format!("along {angle} degrees, {aside} aside"), path));
        }
    }
    assert_none(&faults(&paths));
}

/// A rod pushed against a wall at a right angle carries Euler's load, and buckles: both at the pose where it meets the wall.
#[test]
fn a_column_buckles_at_eulers_load() {
    let path = "from = [0.004, -0.15]\nto = [0.004, -0.11]\nangle = 90.0\nstep = 2e-3\n";
    let (name, points) = SHAPES[0];
    let scan = Scan::run(scene(name, points, 0.0, path)).unwrap();
    judge(&scan.scene, &scan.outcome).unwrap();
    let buckled = scan.outcome.events.iter().find(|event| event.kind == EventKind::Snap).unwrap();
    let load = buckled.after.contacts[0].force / scan.scene.rod.units().force;
    let euler = std::f64::consts::PI.powi(2) / 4.0;
    assert!((load - euler).abs() < 1e-3 * euler, "{load}");
    assert!((buckled.pose().y + 0.12).abs() < 1e-9, "{buckled:?}");
}
