//! Every mistake in a scene file is answered with its place, the value and what was expected.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{SCENE, edited, refused};

/// Checks that the message for a scene holds all these parts.
fn says(scene: &str, parts: &[&str]) {
    let message = refused(scene);
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert_eq!(message.trim_end().lines().count(), 1, "one line where nobody looks at a terminal: {message}");
}

#[test]
fn a_missing_field() {
    says(&edited("length = 0.1\n", ""), &["scene.toml:1:1: rod: ", "missing field `length`"]);
    says(&edited("vertex = [0.03, 0.0]\n", ""), &["scene.toml:11:", "contour.piece[2]", "missing field `vertex`"]);
    says(&edited("shape = \"parabola\"\n", ""), &["scene.toml:6:", "contour.piece[1]", "missing field `shape`"]);
    says(&edited("to = [0.03, -0.04]\n", ""), &["scene.toml:16:1: sweep: ", "missing field `to`"]);
    says(&edited("step = 1e-3\n", ""), &["scene.toml:16:1: sweep: ", "missing field `step` (m)"]);
    says(&edited("youngs_modulus = 206e9\n", ""), &["rod: ", "missing field `youngs_modulus`", "bending_stiffness"]);
    says(&edited("diameter = 0.5e-3\n", ""), &["rod: ", "missing field `diameter`"]);
    says("", &["scene.toml:1:1: ", "missing field `rod`"]);
}

#[test]
fn an_unknown_field() {
    says(&edited("length", "lenght"), &["scene.toml:2:1: rod.lenght: ", "unknown field `lenght`", "`length`"]);
    says(&edited("coefficient", "curvature"), &["scene.toml:9:1: contour.piece[1].curvature: ", "`coefficient`"]);
    says(&edited("parabola", "parbola"), &["scene.toml:7:9: contour.piece[1].shape: ", "parbola", "`parabola`"]);
    says(&edited("[sweep]", "[swep]"), &["scene.toml:16:", "swep: ", "unknown field `swep`"]);
}

#[test]
fn a_wrong_type() {
    says(&edited("0.1", "\"long\""), &["scene.toml:2:10: rod.length: ", "string \"long\"", "expected a number"]);
    says(&edited("[0.03, 0.0]", "0.03"), &["scene.toml:13:10: contour.piece[2].vertex: ", "0.03", "sequence"]);
    says(
        &edited("[0.07, -0.04]", "[0.07]"),
        &["scene.toml:17:8: sweep.from: ", "found a list of 1, expected two numbers"],
    );
    says(&edited("[0.07, -0.04]", "[0.07, 1.0, 2.0]"), &["sweep.from: ", "found a list of 3, expected two numbers"]);
    says(&edited("\"parabola\"", "3"), &["scene.toml:7:9: contour.piece[1].shape: ", "integer", "name of a shape"]);
    says(&edited("1e-3", "[1"), &["scene.toml:20:", "array"]);
}

#[test]
fn a_length_that_is_none() {
    says(
        &edited("0.1", "-0.1"),
        &["scene.toml:2:10: rod.length: ", "length is -0.1, expected a positive, finite number"],
    );
    says(&edited("0.1", "0.0"), &["scene.toml:2:10: rod.length: ", "length is 0, expected a positive"]);
    says(&edited("0.5e-3", "-5e-4"), &["scene.toml:3:12: rod.diameter: ", "diameter is -0.0005, expected a positive"]);
    says(&edited("206e9", "0"), &["scene.toml:4:18: rod.youngs_modulus: ", "youngs_modulus is 0, expected a positive"]);
    let stiffness = edited("diameter = 0.5e-3\nyoungs_modulus = 206e9", "bending_stiffness = 0.0");
    says(&stiffness, &["scene.toml:3:21: rod.bending_stiffness: ", "is 0, expected a positive"]);
    says(&edited("206e9", "206e9\nyield_stress = -1.0"), &["scene.toml:5:16: rod.yield_stress: ", "is -1, expected"]);
    says(&edited("206e9", "206e9\nbending_stiffness = 1.0"), &["scene.toml:5:21: ", "either it or those two"]);
}

#[test]
fn a_number_that_is_none() {
    says(
        &edited("0.1", "nan"),
        &["scene.toml:2:10: rod.length: ", "length is NaN, expected a positive, finite number"],
    );
    says(&edited("0.1", "inf"), &["scene.toml:2:10: rod.length: ", "length is inf, expected a positive, finite"]);
    says(&edited("[0.03, 0.0]", "[nan, 0.0]"), &["scene.toml:13:10: contour.piece[2].vertex: ", "NaN", "finite"]);
    says(&edited("50.0", "nan"), &["scene.toml:9:15: contour.piece[1].coefficient: ", "NaN", "finite"]);
    says(&edited("[0.07, -0.04]", "[0.07, nan]"), &["scene.toml:17:8: sweep.from: ", "NaN", "finite"]);
    says(&edited("[0.03, -0.04]", "[nan, 0.0]"), &["scene.toml:18:6: sweep.to: ", "NaN", "finite"]);
    says(&edited("90.0", "nan"), &["scene.toml:19:9: sweep.angle: ", "NaN", "degrees"]);
    says(&edited("90.0", "90\nangle_to = inf"), &["scene.toml:20:12: sweep.angle_to: ", "inf", "degrees"]);
    says(&edited("1e-3", "nan"), &["scene.toml:20:8: sweep.step: ", "step is NaN, expected a positive, finite"]);
}

#[test]
fn a_contour_that_is_none() {
    // The second bump lies in the solid of the first one, or left of it.
    let lifted = edited("vertex = [0.03, 0.0]", "vertex = [0.0, 1.0]");
    says(&lifted, &["scene.toml:11:", "contour.piece[2]: ", "piece 1", "piece 2", "expected a crossing"]);
    let without = SCENE[..SCENE.find("[[contour").unwrap()].to_owned() + &SCENE[SCENE.find("[sweep]").unwrap()..];
    says(&without, &["scene.toml", "missing field `contour`"]);
    let empty = without.replace("[sweep]", "[contour]\npiece = []\n[sweep]");
    says(&empty, &["scene.toml:6:", "contour: ", "at least one piece"]);
}

#[test]
fn a_sweep_that_is_none() {
    says(
        &edited("to = [0.03", "to = [0.07"),
        &["scene.toml:18:6: sweep.to: ", "ends where it starts", "expected two different"],
    );
    says(&edited("1e-3", "0.0"), &["scene.toml:20:8: sweep.step: ", "step is 0, expected a positive"]);
    says(&edited("1e-3", "-1e-3"), &["scene.toml:20:8: sweep.step: ", "step is -0.001, expected a positive"]);
    says(
        &edited("1e-3", "1e-12"),
        &["scene.toml:20:8: sweep.step: ", "step is 1e-12", "4.0e10 states, expected at most 1e6"],
    );
    says(&edited("step = 1e-3", "step_angle = 1.0"), &["sweep.step_angle: ", "the clamp moves", "step in m"]);
    let turning = edited("to = [0.03", "to = [0.07").replace("90.0", "90.0\nangle_to = 120.0");
    says(&turning, &["scene.toml:21:8: sweep.step: ", "turns without moving", "step_angle"]);
    let turning = turning.replace("step = 1e-3", "step_angle = -1.0");
    says(&turning, &["scene.toml:21:14: sweep.step_angle: ", "step_angle is -1, expected a positive"]);
}
