//! Scenes whose rod is not uniform or not straight at rest, or whose clamp gives way.

use crate::common::{SCENE, edited, refused_beside, vibrissa};
use vibrissa_cli::{AnyScene, Scan};

/// The scene with another table `[rod]`.
fn with_rod(rod: &str) -> String {
    edited("length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n", rod)
}

const WIRE: &str = "length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n";
const TWO: &str = "length = 0.1\n[[rod.section]]\nlength = 0.06\nbending_stiffness = 6e-4\n\
                   [[rod.section]]\nlength = 0.04\ndiameter = 0.3e-3\nyoungs_modulus = 206e9\nnatural_curvature = -3.0\n";

#[test]
fn each_mistake_has_its_place() {
    for (rod, parts) in [
        (
            format!("{WIRE}tip_diameter = 0\n"),
            ["scene.toml:5:16: rod.tip_diameter: ", "tip_diameter is 0, expected a positive"],
        ),
        (
            format!("{WIRE}tip_diameter = -1e-4\n"),
            ["rod.tip_diameter: ", "is -0.0001, expected a positive, finite number"],
        ),
        (format!("{WIRE}tip_diameter = 1e-6\n"), ["rod.tip_diameter: ", "100"]),
        (format!("{WIRE}tip_diameter = 0.2\n"), ["rod.tip_diameter: ", "0.2"]),
        (
            "length = 0.1\nbending_stiffness = 1e-3\ntip_diameter = 1e-4\n".into(),
            ["rod.tip_diameter: ", "expected diameter and youngs_modulus"],
        ),
        (
            format!("{WIRE}natural_curvature = \"left\"\n"),
            ["rod.natural_curvature: ", "expected a number (1/m), or a list of points"],
        ),
        (
            format!("{WIRE}natural_curvature = [[0.0, 1.0, 2.0]]\n"),
            ["rod.natural_curvature: ", "[[s, curvature], ...]"],
        ),
        (
            format!("{WIRE}natural_curvature = [[0.05, 1.0], [0.01, 2.0]]\n"),
            ["rod.natural_curvature: ", "has the arc length 0.01 m, expected more than that of the point before"],
        ),
        (format!("{WIRE}natural_curvature = []\n"), ["rod.natural_curvature: ", "number of points"]),
        (format!("{WIRE}natural_curvature = nan\n"), ["rod.natural_curvature: ", "NaN"]),
        (format!("{WIRE}natural_curvature = 100.0\n"), ["rod.natural_curvature: ", "crosses itself at rest"]),
        (format!("{WIRE}tip_diameter = 1e-4\nyield_stress = 1e9\n"), ["rod.yield_stress: ", "uniform rod alone"]),
        (
            format!("{WIRE}[clamp]\nstiffness_phi = 0\n"),
            ["scene.toml:6:17: clamp.stiffness_phi: ", "is 0.0, expected a positive"],
        ),
        (format!("{WIRE}[clamp]\nstiffness_x = -4.0\n"), ["clamp.stiffness_x: ", "-4.0, expected a positive number"]),
        (format!("{WIRE}[clamp]\nstiffness_y = nan\n"), ["clamp.stiffness_y: ", "NaN"]),
        (format!("{WIRE}[clamp]\nstiffness = 3\n"), ["clamp.stiffness: ", "expected one of `stiffness_x`"]),
        (
            format!("{WIRE}yield_stress = 1e9\n[clamp]\nstiffness_x = 3\n"),
            ["rod.yield_stress: ", "expected it with a rigid clamp alone"],
        ),
        (TWO.replace("0.04", "0.05"), ["scene.toml:2:10: rod.length: ", "add up to 0.11, expected 0.1"]),
        (TWO.replace("6e-4", "0"), ["rod.section[1].bending_stiffness: ", "bending_stiffness is 0"]),
        (TWO.replace("length = 0.04", "length = -0.04"), ["rod.section[2].length: ", "-0.04"]),
        (TWO.replace("diameter = 0.3e-3\n", ""), ["rod.section[2]: ", "missing field `diameter`"]),
        (
            TWO.replacen("length = 0.1\n", "length = 0.1\ndiameter = 1e-3\n", 1),
            ["rod.diameter: ", "beside [[rod.section]]"],
        ),
        (
            TWO.replacen("length = 0.1\n", "length = 0.1\nnatural_curvature = 1.0\n", 1),
            ["rod.section[2].natural_curvature: ", "one of the two"],
        ),
    ] {
        let message = refused_beside(&with_rod(&rod), &[]);
        assert!(parts.iter().all(|part| message.contains(part)), "{parts:?} are not in: {message}");
    }
}

#[test]
fn a_rod_of_each_kind_is_swept() {
    for rod in [
        format!("{WIRE}tip_diameter = 0.2e-3\n"),
        format!("{WIRE}natural_curvature = 5\n"),
        format!("{WIRE}tip_diameter = 0.2e-3\nnatural_curvature = [[0.0, 0.0], [0.05, 3.0], [0.1, 8.0]]\n"),
        TWO.into(),
        format!("{WIRE}[clamp]\nstiffness_phi = 0.2\n"),
        format!("{TWO}[clamp]\nstiffness_x = 500\nstiffness_y = 300\nstiffness_phi = 0.2\n"),
    ] {
        let AnyScene::Mounted(scene) = AnyScene::parse("scene.toml".as_ref(), &with_rod(&rod)).unwrap() else {
            panic!("uniform: {rod}")
        };
        let scan = Scan::run(scene).unwrap();
        assert!(scan.is_complete() && !scan.outcome.events.is_empty(), "{rod}\n{}", scan.report());
        let held = scan.outcome.states.iter().filter(|state| !state.contacts.is_empty());
        let shapes: Vec<_> = held.map(|state| state.elastica(&scan.scene.rod).unwrap()).collect();
        // what is beyond the last contact carries nothing
        assert!(!shapes.is_empty() && shapes.iter().all(|shape| shape.moment(0.1).abs() < 1e-12), "{rod}");
    }
}

/// The same rod in three ways of writing.
#[test]
fn a_section_a_cone_without_taper_and_the_wire_are_the_same() {
    let modulus = "bending_stiffness = 6.320e-4\n";
    let wire = with_rod(&format!("length = 0.1\n{modulus}"));
    let section = with_rod(&format!("length = 0.1\n[[rod.section]]\nlength = 0.1\n{modulus}"));
    let events = |text: &str| match AnyScene::parse("scene.toml".as_ref(), text).unwrap() {
        AnyScene::Uniform(scene) => Scan::run(scene).unwrap().outcome.events,
        AnyScene::Mounted(scene) => Scan::run(scene).unwrap().outcome.events,
    };
    let (wire, section) = (events(&wire), events(&section));
    assert_eq!(wire.len(), section.len());
    for (one, other) in wire.iter().zip(&section) {
        assert!(one.kind == other.kind && (one.pose().x - other.pose().x).abs() < 1e-12);
        assert!((one.before.reactions.f0x - other.before.reactions.f0x).abs() < 1e-11);
    }
}

/// A table without springs is no clamp that gives way, and the command gives the base where the springs let it go.
#[test]
fn a_clamp_gives_way_by_its_springs() {
    let of = |clamp: &str| AnyScene::parse("scene.toml".as_ref(), &with_rod(&format!("{WIRE}{clamp}"))).unwrap();
    assert!(matches!(of("[clamp]\n"), AnyScene::Uniform(_)));
    assert!(matches!(of("[clamp]\nstiffness_x = inf\n"), AnyScene::Uniform(_)));
    let AnyScene::Mounted(scene) = of("[clamp]\nstiffness_phi = 0.2\n") else { panic!("rigid") };
    let scan = Scan::run(scene).unwrap();
    for state in scan.outcome.states.iter().filter(|state| !state.contacts.is_empty()) {
        let base = state.elastica(&scan.scene.rod).unwrap().at(0.0);
        assert!((base.phi - state.pose.phi + state.reactions.m0z / 0.2).abs() < 1e-12);
        assert_eq!((base.x, base.y), (state.pose.x, state.pose.y));
    }
}

/// What was felt on a clamp that gives way is reconstructed with the springs of the file of the rod.
#[test]
fn a_scan_on_springs_is_reconstructed() {
    let springs = "[clamp]\nstiffness_x = 400\nstiffness_y = 300\nstiffness_phi = 0.13\n";
    let dir = tempfile::tempdir().unwrap();
    let scene = with_rod(&format!("{WIRE}{springs}"));
    std::fs::write(dir.path().join("soft.toml"), &scene).unwrap();
    std::fs::write(dir.path().join("rigid.toml"), scene.replace(springs, "")).unwrap();
    let said = |arguments: &[&str]| String::from_utf8(vibrissa(dir.path(), arguments).stdout).unwrap();
    said(&["simulate", "soft.toml", "--rate", "100", "--speed", "0.01", "--out", "felt.csv"]);
    let of = |rod: &str| said(&["reconstruct", "felt.csv", "--rod", rod, "--as-is", "--out", "found"]);
    let AnyScene::Mounted(scene) = AnyScene::parse("soft.toml".as_ref(), &scene).unwrap() else { panic!("rigid") };
    let mut phases: Vec<String> =
        Scan::run(scene).unwrap().outcome.states.iter().map(|state| state.phase().to_string()).collect();
    phases.dedup();
    let wanted = format!("felt: {};", phases.join(" "));
    assert!(of("soft.toml").contains(&wanted), "{wanted}\n{}", of("soft.toml"));
    assert!(!of("rigid.toml").contains(&wanted));
}

#[test]
fn other_commands_refuse_it() {
    let soft = with_rod(&format!("{WIRE}[clamp]\nstiffness_phi = 0.2\n"));
    let scenes = [(with_rod(TWO), "not uniform or not straight at rest"), (soft, "clamp: a clamp that gives way")];
    for (scene, why) in scenes {
        refuse(&scene, why);
    }
}

fn refuse(scene: &str, why: &str) {
    assert!(scene != SCENE);
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("scene.toml"), scene).unwrap();
    for arguments in [
        &["live", "--sensor", "file:nowhere", "--rod", "scene.toml"][..],
        &["fake-sensor", "scene.toml", "--protocol", "rdt"],
        &["budget", "scene.toml"],
    ] {
        let output = vibrissa(dir.path(), arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && message.contains(why), "{message}");
    }
}
