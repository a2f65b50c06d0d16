//! Angles that look like radians where degrees belong, and the other way round, are told of and taken as they are.

use crate::common::{SCENE, complaint, edited, vibrissa};
use rod_files::{Scene, Setup};
use std::f64::consts::FRAC_PI_2;
use std::fs;

fn warnings(scene: &str) -> Vec<String> {
    Scene::parse("scene.toml".as_ref(), scene).unwrap().warnings
}

#[test]
fn radians_in_a_scene() {
    assert!(warnings(SCENE).is_empty());
    let clamp = "scene.toml:19:9: sweep.angle: angle is 1.5708 degrees; is 90 degrees meant?";
    assert_eq!(warnings(&edited("90.0", "1.5708")), [clamp]);
    let turned = "scene.toml:20:12: sweep.angle_to: angle_to is -3.142 degrees; is -180 degrees meant?";
    assert_eq!(warnings(&edited("90.0", "90\nangle_to = -3.142")), [turned]);
    let object = edited("[[contour.piece]]", "[contour]\nangle = 0.0\n[[contour.piece]]");
    assert!(warnings(&object).is_empty());
    let object = object.replace("angle = 0.0", "angle = 6.283");
    assert_eq!(warnings(&object), ["scene.toml:7:9: contour.angle: angle is 6.283 degrees; is 360 degrees meant?"]);
    let arc = "[[contour.piece]]\nshape = \"arc\"\ncenter = [0, 0]\nradius = 0.01\nfrom_angle = 0\nto_angle = 4.712\n";
    let warned = warnings(&crate::common::with_objects(arc));
    assert_eq!(warned.len(), 1);
    assert!(warned[0].contains("contour.piece[1].to_angle: ") && warned[0].contains("270"), "{warned:?}");
}

#[test]
fn a_clamp_that_turns_more_than_twice() {
    assert!(warnings(&edited("90.0", "720")).is_empty());
    let warned = warnings(&edited("90.0", "5156.62"));
    let clamp = "scene.toml:19:9: sweep.angle: angle is 5156.62 degrees; is 90 degrees meant, converted twice?";
    assert_eq!(warned, [clamp]);
    let warned = warnings(&edited("90.0", "1000"));
    let clamp = "scene.toml:19:9: sweep.angle: angle is 1000 degrees, more than two turns of the clamp; is that meant?";
    assert_eq!(warned, [clamp]);
}

#[test]
fn other_angles_in_radians_and_degrees_with_the_unit_of_radians() {
    let clamp = "scene.toml:19:9: sweep.angle: angle is 0.7854 degrees; is 45 degrees meant?";
    assert_eq!(warnings(&edited("90.0", "0.7854")), [clamp]);
    let clamp = "scene.toml:19:9: sweep.angle: angle is 90 rad, 14.3 turns; is \"90 deg\" meant?";
    assert_eq!(warnings(&edited("90.0", "\"90 rad\"")), [clamp]);
    assert!(warnings(&edited("90.0", "\"1.5708 rad\"")).is_empty());
}

#[test]
fn positions_that_are_not_in_metres() {
    let far = "scene.toml:13:10: contour.piece[2].vertex: vertex is 299 lengths of the rod away from sweep.from; are both in m?";
    assert_eq!(warnings(&edited("[0.03, 0.0]", "[30.0, 0.0]")), [far]);
    let object = edited("[[contour.piece]]", "[contour]\nposition = [0.0, 30.0]\n[[contour.piece]]");
    let far =
        "scene.toml:7:12: contour.position: position is 300 lengths of the rod away from sweep.from; are both in m?";
    assert_eq!(warnings(&object), [far]);
    let wall = "[[object]]\n[[object.piece]]\nshape = \"circle\"\ncenter = [0, 50]\nradius = 50\n";
    assert!(warnings(&crate::common::with_objects(wall)).is_empty(), "a wall that is nearly flat");
    let leg = SCENE.to_owned() + "[[sweep.leg]]\nto = [30.0, -40.0]\nstep = 1.0\n";
    assert!(warnings(&leg)[0].contains("sweep.leg[1].to: to is 499 lengths of the rod away from sweep.from"));
}

#[test]
fn radians_in_a_setup() {
    let text = "[mounting]\nangle = 3.1416\nturns_from = 90.0\n";
    let setup = Setup::parse("sensor.toml".as_ref(), text).unwrap();
    assert_eq!(setup.warnings, ["sensor.toml:2:9: mounting.angle: angle is 3.1416 degrees; is 180 degrees meant?"]);
    let setup = Setup::parse("sensor.toml".as_ref(), "[mounting]\nturns_from = 1.571\n").unwrap();
    assert!(setup.warnings[0].contains("mounting.turns_from: turns_from is 1.571 degrees"), "{:?}", setup.warnings);
}

#[test]
fn the_command_warns_and_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), edited("90.0", "1.5708")).unwrap();
    let output = vibrissa(directory.path(), &["contour", "scene.toml", "--file", "contour.csv"]);
    assert_eq!(output.status.code(), Some(0));
    let message = complaint(&output);
    assert!(
        message.starts_with("warning: scene.toml:19:9: sweep.angle: ") && message.lines().count() == 1,
        "{message}"
    );
    // taken as it is
    let scene = Scene::parse("scene.toml".as_ref(), &edited("90.0", "1.5708")).unwrap();
    assert!(scene.path.at(0.0).phi < FRAC_PI_2 / 50.0);
}
