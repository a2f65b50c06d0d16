//! Scenes whose rod is not uniform or not straight at rest, or whose clamp gives way.

use crate::common::{edited, refused_beside, vibrissa};
use rod_files::{Scan, Scene};
use vibrissa::rod::Reactions;

/// The scene with another table `[rod]`.
fn with_rod(rod: &str) -> String {
    edited("length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n", rod)
}

const WIRE: &str = "length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n";
const TABLE: &str = "length = 0.1\nyoungs_modulus = 206e9\n\
                     diameter = [[0, 0.5e-3], [0.04, 0.4e-3], [0.07, 0.45e-3], [0.1, 0.1e-3]]\n";
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
        (
            TABLE.replace("[0.04, 0.4e-3]", "[0.04, 0]"),
            ["scene.toml:4:12: rod.diameter: ", "diameter of point 2 is 0.0 m, expected a positive, finite number"],
        ),
        (
            TABLE.replace("[0.1, 0.1e-3]", "[0.09, 0.1e-3]"),
            ["rod.diameter: ", "point 4 of diameter has the arc length 0.09 m, expected 0.1 m, the length of the rod"],
        ),
        (
            format!("{TABLE}tip_diameter = 1e-4\n"),
            ["scene.toml:5:16: rod.tip_diameter: ", "given beside the diameters"],
        ),
        (
            TABLE.replace("youngs_modulus = 206e9\n", ""),
            ["rod: ", "missing field `youngs_modulus`, expected bending_stiffness, or diameter and youngs_modulus"],
        ),
        (
            TABLE.replace("youngs_modulus = 206e9", "bending_stiffness = 1e-3"),
            ["rod.bending_stiffness: ", "expected either it or those two"],
        ),
        (
            TABLE.replace("[0.1, 0.1e-3]", "[0.1]"),
            ["rod.diameter: ", "or a list of points: [[s, diameter], ...] in m and m"],
        ),
        (
            WIRE.replace("0.5e-3", "\"0.5e-3\""),
            ["rod.diameter: ", "the value is the text \"0.5e-3\", expected a number (m), or a list of points"],
        ),
        (
            format!("{WIRE}natural_curvature = [[0.0, 1.0], [0.09, 2.0]]\n"),
            [
                "scene.toml:5:21: rod.natural_curvature: ",
                "arc length 0.09 m, expected 0.1 m: the points go from 0 to the length",
            ],
        ),
        (
            format!("{WIRE}natural_curvature = [[0.01, 1.0], [0.1, 2.0]]\n"),
            ["rod.natural_curvature: ", "point 1 of natural_curvature has the arc length 0.01 m, expected 0.0 m"],
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
            format!("{WIRE}[clamp]\nroller = 0\n"),
            ["scene.toml:6:10: clamp.roller: ", "is 0.0, expected a number above 0 and below 0.1"],
        ),
        (format!("{WIRE}[clamp]\nroller = -0.02\n"), ["clamp.roller: ", "is -0.02, expected"]),
        (format!("{WIRE}[clamp]\nroller = 0.1\n"), ["clamp.roller: ", "is 0.1, expected"]),
        (format!("{WIRE}[clamp]\nroller = nan\n"), ["clamp.roller: ", "is NaN, expected"]),
        (format!("{WIRE}[clamp]\nroller = inf\n"), ["clamp.roller: ", "is inf, expected"]),
        (format!("{WIRE}[clamp]\nroller = 0.02\nstiffness_x = 3\n"), ["clamp.stiffness_x: ", "springs or a roller"]),
        (
            format!("{WIRE}[clamp]\nroller = 0.02\n[contact]\nfriction = 0.2\n"),
            ["clamp.roller: ", "expected one of the two"],
        ),
        (
            format!("{WIRE}yield_stress = 1e9\n[clamp]\nstiffness_x = 3\n"),
            ["rod.yield_stress: ", "expected it with a rigid clamp alone"],
        ),
        (TWO.replace("0.04", "0.05"), ["scene.toml:2:10: rod.length: ", "add up to 0.11, expected 0.1"]),
        (TWO.replace("6e-4", "0"), ["rod.section[1].bending_stiffness: ", "bending_stiffness is 0"]),
        (
            TWO.replace("diameter = 0.3e-3\nyoungs_modulus = 206e9", "bending_stiffness = 6e-14"),
            ["rod.section[2].bending_stiffness: ", "times that of the first section"],
        ),
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
        TABLE.into(),
        // with the thin tip it would wrap around the contour
        format!("{}natural_curvature = [[0.0, 0.0], [0.05, 3.0], [0.1, 8.0]]\n", TABLE.replace("0.1e-3]]", "0.2e-3]]")),
        format!("{WIRE}[clamp]\nstiffness_phi = 0.2\n"),
        format!("{TWO}[clamp]\nstiffness_x = 500\nstiffness_y = 300\nstiffness_phi = 0.2\n"),
    ] {
        let scene = Scene::parse("scene.toml".as_ref(), &with_rod(&rod)).unwrap();
        assert!(scene.rod.varying().is_some() || scene.rod.springs().is_some(), "uniform: {rod}");
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
    let events = |text: &str| {
        let scene = Scene::parse("scene.toml".as_ref(), text).unwrap();
        Scan::run(scene).unwrap().outcome.events
    };
    let (wire, section) = (events(&wire), events(&section));
    assert_eq!(wire.len(), section.len());
    for (one, other) in wire.iter().zip(&section) {
        assert!(one.kind == other.kind && (one.pose().x - other.pose().x).abs() < 1e-12);
        assert!((one.before.reactions.f0x - other.before.reactions.f0x).abs() < 1e-11);
    }
}

/// Diameters in a list are those of `diameter` and `tip_diameter`, and a list on a straight line is too.
#[test]
fn a_list_of_diameters_is_the_cone() {
    let states = |rod: &str| {
        let scene = Scene::parse("scene.toml".as_ref(), &with_rod(rod)).unwrap();
        Scan::run(scene).unwrap().outcome.states
    };
    let list = |points: &str| format!("length = 0.1\ndiameter = [{points}]\nyoungs_modulus = 206e9\n");
    let cone = states(&format!("{WIRE}tip_diameter = 0.1e-3\n"));
    assert_eq!(states(&list("[0, 0.5e-3], [0.1, 0.1e-3]")), cone);
    let on_a_line: Vec<String> =
        (0..=40).map(|k| format!("[{}, {}]", 0.0025 * f64::from(k), 0.5e-3 - 1e-5 * f64::from(k))).collect();
    let many = states(&list(&on_a_line.join(", ")));
    assert!(many.len() == cone.len() && cone.iter().any(|state| state.max_stress > Some(1e8)));
    for (one, other) in many.iter().zip(&cone) {
        let alike = |one: f64, other: f64| (one - other).abs() < 1e-10 * (1.0 + other.abs());
        let Reactions { f0x, f0y, m0z } = one.reactions;
        let felt = [(f0x, other.reactions.f0x), (f0y, other.reactions.f0y), (m0z, other.reactions.m0z)];
        assert!(felt.into_iter().all(|(one, other)| alike(one, other)), "{one:?} {other:?}");
        assert!(alike(one.max_stress.unwrap() / 1e9, other.max_stress.unwrap() / 1e9), "{one:?} {other:?}");
    }
}

#[test]
fn implausible_diameters_are_told() {
    let scene = with_rod(&TABLE.replace("0.45e-3", "0.6e-7").replace("0.5e-3", "1e-6").replace("0.4e-3", "1e-6"));
    let scene = Scene::parse("scene.toml".as_ref(), &scene.replace("0.1e-3", "1e-6")).unwrap();
    let warnings = &scene.warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("rod.diameter: diameter is 0.00000006 m"), "{warnings:?}");
}

/// A table without springs is no clamp that gives way, and the command gives the base where the springs let it go.
/// Then everything that takes a uniform rod alone takes it.
#[test]
fn a_uniform_rod_is_uniform_however_it_is_written() {
    let stiff = "bending_stiffness = 6e-4\n";
    let sections = |first: &str, second: &str| {
        format!("length = 0.1\n[[rod.section]]\nlength = 0.06\n{first}[[rod.section]]\nlength = 0.04\n{second}")
    };
    let wire = "diameter = 0.5e-3\nyoungs_modulus = 206e9\n";
    for (rod, uniform) in [
        (format!("{WIRE}tip_diameter = 0.5e-3\nyield_stress = 1e9\n"), true),
        (format!("{WIRE}natural_curvature = 0\n"), true),
        (format!("length = 0.1\n[[rod.section]]\nlength = 0.1\n{wire}"), true),
        (sections(stiff, stiff), true),
        (sections(wire, &format!("{wire}natural_curvature = 0.0\n")), true),
        (sections(stiff, &format!("{stiff}natural_curvature = 1.0\n")), false),
        (sections(stiff, "bending_stiffness = 5e-4\n"), false),
        (sections(wire, "diameter = 0.4e-3\nyoungs_modulus = 206e9\n"), false),
        (format!("{WIRE}tip_diameter = 0.4e-3\n"), false),
    ] {
        let scene = Scene::parse("scene.toml".as_ref(), &with_rod(&rod)).unwrap();
        assert_eq!(scene.rod.uniform().is_some(), uniform, "{rod}");
        if let Some(uniform) = scene.rod.uniform() {
            assert_eq!(uniform.diameter().is_some(), rod.contains("diameter"), "{rod}");
            assert_eq!(uniform.length(), 0.1);
        }
    }
}

#[test]
fn implausible_sections_are_told() {
    let rod = TWO
        .replace("diameter = 0.3e-3", "diameter = 0.3")
        .replace("length = 0.04", "length = 0.4")
        .replace("206e9", "206");
    let scene =
        Scene::parse("scene.toml".as_ref(), &with_rod(&rod.replace("length = 0.1\n", "length = 0.46\n"))).unwrap();
    let warnings = &scene.warnings;
    assert!(
        warnings[0].contains("rod.section[2].diameter: diameter is 0.3 m, expected 1e-7 to 1e-1 m"),
        "{warnings:?}"
    );
    assert!(warnings[1].contains("rod.section[2].youngs_modulus: youngs_modulus is 206 Pa"), "{warnings:?}");
    assert_eq!(warnings.len(), 2, "{warnings:?}");
}

#[test]
fn a_clamp_gives_way_by_its_springs() {
    let of = |clamp: &str| Scene::parse("scene.toml".as_ref(), &with_rod(&format!("{WIRE}{clamp}"))).unwrap();
    assert!(of("[clamp]\n").rod.is_held_rigidly());
    assert!(of("[clamp]\nstiffness_x = inf\n").rod.is_held_rigidly());
    let scene = of("[clamp]\nstiffness_phi = 0.2\n");
    assert!(scene.rod.springs().is_some() && scene.rod.uniform().is_some());
    let scan = Scan::run(scene).unwrap();
    for state in scan.outcome.states.iter().filter(|state| !state.contacts.is_empty()) {
        let base = state.elastica(&scan.scene.rod).unwrap().at(0.0);
        assert!((base.phi - state.pose.phi + state.reactions.m0z / 0.2).abs() < 1e-12);
        assert_eq!((base.x, base.y), (state.pose.x, state.pose.y));
    }
}

/// The reaction of a roller is written where the others are; what cannot take it says so.
#[test]
fn the_reaction_of_a_roller_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let scene = with_rod(&format!("{WIRE}[clamp]\nroller = 0.02\n"));
    std::fs::write(dir.path().join("roller.toml"), &scene).unwrap();
    std::fs::write(dir.path().join("rigid.toml"), with_rod(WIRE)).unwrap();
    assert!(vibrissa(dir.path(), &["sweep", "roller.toml"]).status.success());
    let written = |name: &str| std::fs::read_to_string(dir.path().join("out/roller").join(name)).unwrap();
    let header = written("states.csv").lines().next().unwrap().to_owned();
    assert!(header.ends_with(",leg,min_force,first_integral,condition,iterations,roller,roller_s"), "{header}");
    let scene = Scene::parse("roller.toml".as_ref(), &scene).unwrap();
    assert!(scene.rod.roller().is_some());
    let states = Scan::run(scene).unwrap().outcome.states;
    assert!(states.iter().any(|state| state.roller.as_ref().unwrap().force.abs() > 1.0));
    for (line, state) in written("states.jsonl").lines().zip(&states) {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        assert_eq!(line["roller"].as_f64().unwrap(), state.roller.as_ref().unwrap().force);
    }
    // a recording: one sample every millimetre, as the states are
    assert!(vibrissa(dir.path(), &["simulate", "roller.toml", "--rate", "1", "--speed", "1e-3"]).status.success());
    let recording = written("recording.csv");
    let mut rows = recording.lines();
    assert_eq!(rows.next().unwrap(), "t,x0,y0,phi0,f0x,f0y,m0z,roller");
    let read: Vec<f64> = rows.map(|row| row.rsplit(',').next().unwrap().parse().unwrap()).collect();
    assert!(
        read.len() == states.len() && read.iter().zip(&states).all(|(r, s)| *r == s.roller.as_ref().unwrap().force)
    );
    for arguments in [
        ["reconstruct", "out/roller/recording.csv", "--rod", "roller.toml"],
        ["reconstruct", "out/roller/recording.csv", "--rod", "rigid.toml"],
    ] {
        let refused = vibrissa(dir.path(), &arguments);
        let said = String::from_utf8(refused.stderr).unwrap();
        assert!(!refused.status.success() && said.contains("roller ahead of the clamp"), "{said}");
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
    said(&["simulate", "soft.toml", "--rate", "100", "--speed", "0.01", "--file", "felt.csv"]);
    let of = |rod: &str| said(&["reconstruct", "felt.csv", "--rod", rod, "--as-is", "--out", "found"]);
    let scene = Scene::parse("soft.toml".as_ref(), &scene).unwrap();
    assert!(scene.rod.springs().is_some());
    let mut phases: Vec<String> =
        Scan::run(scene).unwrap().outcome.states.iter().map(|state| state.phase().to_string()).collect();
    phases.dedup();
    let wanted = format!("felt: {};", phases.join(" "));
    assert!(of("soft.toml").contains(&wanted), "{wanted}\n{}", of("soft.toml"));
    assert!(!of("rigid.toml").contains(&wanted));
}

/// A scan of O1 by a rod of any kind: how the wire of the paper is written instead.
const O1: &str = "[[contour.piece]]\nshape = \"parabola\"\nvertex = [0.0, 0.0]\ncoefficient = 50.0\n\
                  [[contour.piece]]\nshape = \"parabola\"\nvertex = [0.03, 0.0]\ncoefficient = 50.0\n\
                  [sweep]\nfrom = [0.08, -0.04]\nto = [-0.09, -0.04]\nangle = 90.0\nstep = 5e-5\n";

/// One line of points.jsonl beside the state in which it was felt.
struct Answer {
    label: String,
    truth: String,
    /// Distance (m) of a point of one contact from the true contact, and its standard deviation across the contour.
    off: Option<(f64, f64)>,
}

/// What `vibrissa simulate` and `vibrissa reconstruct` make of a scan of O1, beside a sweep, with report.json and what was said.
fn there_and_back(rod: &str, noise: Option<&str>) -> (Vec<Answer>, serde_json::Value, String) {
    let dir = tempfile::tempdir().unwrap();
    let scene = format!("[rod]\n{rod}{O1}");
    std::fs::write(dir.path().join("scene.toml"), &scene).unwrap();
    std::fs::write(dir.path().join("noise.toml"), noise.unwrap_or_default()).unwrap();
    let said = |arguments: &[&str]| {
        let output = vibrissa(dir.path(), arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let simulate =
        ["simulate", "scene.toml", "--rate", "200", "--speed", "0.01", "--noise", "noise.toml", "--file", "felt.csv"];
    said(&simulate);
    let with_noise = ["--noise", "noise.toml"];
    let told: &[&str] = if noise.is_none() { &with_noise } else { &[] };
    let reconstruct = ["reconstruct", "felt.csv", "--rod", "scene.toml", "--truth", "scene.toml", "--out", "found"];
    let text = said(&[&reconstruct[..], &["--local"], told].concat());
    for file in ["points.jsonl", "contour.csv", "report.json", "contour.svg", "phases.svg"] {
        assert!(dir.path().join("found").join(file).metadata().unwrap().len() > 100, "{file}");
    }
    let read = |file: &str| std::fs::read_to_string(dir.path().join("found").join(file)).unwrap();
    let scene = Scene::parse("scene.toml".as_ref(), &scene).unwrap();
    assert!(scene.rod.varying().is_some());
    let mut states = Scan::run(scene).unwrap().outcome.states.into_iter().peekable();
    let several = |label: &str| if label.len() == 2 { "several".to_owned() } else { label.to_owned() };
    let answer = |line: &str| {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let number = |name: &str| line[name].as_f64();
        // the sensor feels what the rod carries at its pose
        let state = std::iter::from_fn(|| states.next())
            .find(|state| (state.pose.x - number("x0").unwrap()).abs() < 1e-9)
            .expect("each sample has its state");
        let touch = number("x").zip(number("y")).filter(|_| state.contacts.len() == 1);
        let off = touch.map(|(x, y)| {
            let contact = state.contacts[0];
            let [sx, sy] = ["sigma_x", "sigma_y"].map(|name| number(name).unwrap());
            ((x - contact.x).hypot(y - contact.y), sx.hypot(sy))
        });
        Answer { label: several(line["label"].as_str().unwrap()), truth: several(&state.phase().to_string()), off }
    };
    let answers = read("points.jsonl").lines().map(answer).collect();
    (answers, serde_json::from_str(&read("report.json")).unwrap(), text)
}

const CONE: &str = "length = 0.1\ndiameter = 0.5e-3\ntip_diameter = 0.1e-3\nyoungs_modulus = 206e9\n";
const CURVED: &str = "length = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\nnatural_curvature = 5.0\n";

/// What was felt with a rod that is not uniform, or not straight at rest, is reconstructed by the command, and compared with the truth.
#[test]
fn a_scan_of_any_rod_is_reconstructed() {
    for rod in [CONE, CURVED] {
        let (answers, report, text) = there_and_back(rod, None);
        let wrong = answers.iter().filter(|answer| answer.label != answer.truth).count();
        let points: Vec<f64> = answers.iter().filter_map(|answer| answer.off).map(|off| off.0).collect();
        let worst = points.iter().copied().fold(0.0, f64::max);
        let several = answers.iter().filter(|answer| answer.truth == "several").count();
        println!(
            "{} samples, {wrong} labels wrong, {several} several, {} points within {worst:.1e} m",
            answers.len(),
            points.len()
        );
        assert!(wrong == 0 && several > 20 && points.len() > 1500 && worst < 1e-10, "{text}");
        // the command says the same of itself
        let truth = &report["truth"];
        assert_eq!(truth["accuracy"].as_f64(), Some(1.0), "{text}");
        assert!(truth["single"]["largest"].as_f64().unwrap() < 1e-10);
        assert_eq!(truth["single"]["points"].as_u64(), Some(points.len() as u64));
        for contact in ["first", "second"] {
            assert_eq!(truth[contact]["points"].as_u64(), Some(several as u64), "{text}");
            assert!(truth[contact]["largest"].as_f64().unwrap() < 1e-9, "{text}");
        }
        assert_eq!(report["rod"]["uniform"].as_bool(), Some(false));
        let taken = |source: &serde_json::Value| source["taken"].as_f64().unwrap().abs();
        let sources = report["calibration"]["sources"].as_array().unwrap();
        assert!(sources.iter().map(taken).fold(0.0, f64::max) < 1e-9, "{sources:?}");
        assert!(report["physics"]["explained"].is_null(), "{text}");
        for part in ["check by the physics", "likely causes"] {
            assert!(text.contains(part) && report["missing"].as_str().unwrap().contains(part), "{part}: {text}");
        }
        assert!(text.contains("accuracy 100 %"), "{text}");
    }
}

/// The same of a sensor with noise.
#[test]
fn a_noisy_scan_of_a_cone_is_reconstructed() {
    let (answers, report, text) = there_and_back(CONE, Some("white = { force = 1e-4, m0z = 3e-6 }\n"));
    let wrong = answers.iter().filter(|answer| answer.label != answer.truth).count();
    let points: Vec<(f64, f64)> = answers.iter().filter_map(|answer| answer.off).collect();
    let far = points.iter().filter(|(off, sigma)| *off > 6.0 * sigma + 1e-8).count();
    println!("{} samples, {wrong} labels wrong, {} points, {far} of them beyond 6 sigma", answers.len(), points.len());
    assert!(100 * wrong < 2 * answers.len() && points.len() > 1400 && 100 * far < points.len(), "{text}");
    assert!(report["truth"]["accuracy"].as_f64().unwrap() > 0.98);
    assert!(points.iter().any(|(off, _)| *off > 1e-8), "there is noise");
}

/// What is known of errors that all samples share is used, but for a natural curvature, which the model of the rod has.
#[test]
fn a_natural_curvature_of_such_rods_is_in_their_model_alone() {
    let dir = tempfile::tempdir().unwrap();
    let write = |file: &str, text: &str| std::fs::write(dir.path().join(file), text).unwrap();
    write("scene.toml", &format!("[rod]\n{CONE}{O1}"));
    write("known.toml", &format!("[rod]\n{CONE}[calibration]\nnatural_curvature = {{ value = 0.0, sigma = 0.01 }}\n"));
    write("sensor.toml", "[tare]\nseconds = 0\n");
    let felt = |rows: i32| (0..rows).map(|k| format!("{},0,1.5,0,0,0\n", 1e-3 * f64::from(k))).collect::<String>();
    write("felt.csv", &format!("x0,y0,phi0,f0x,f0y,m0z\n{}", felt(20)));
    let message = |arguments: &[&str]| {
        let output = vibrissa(dir.path(), &[&["reconstruct", "felt.csv", "--out", "found"], arguments].concat());
        assert!(!output.status.success() && !dir.path().join("found").exists());
        String::from_utf8(output.stderr).unwrap()
    };
    let said = message(&["--rod", "known.toml"]);
    assert!(said.contains("a natural curvature is known besides that of the rod's model"), "{said}");
    write("felt.csv", &format!("x0,y0,phi0,f0x,f0y,m0z\n{}", felt(1)));
    let said = message(&["--rod", "scene.toml", "--setup", "sensor.toml"]);
    assert!(said.contains("felt.csv: ") && said.contains("expected at least"), "{said}");
}

/// The poses of the files are those of the support, and a scan on springs is compared with its scene.
#[test]
fn a_scan_on_springs_is_compared_with_its_scene() {
    let springs = "[clamp]\nstiffness_x = 400\nstiffness_y = 300\nstiffness_phi = 0.13\n";
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("soft.toml"), format!("[rod]\n{WIRE}{springs}{O1}")).unwrap();
    let run = |arguments: &[&str]| assert!(vibrissa(dir.path(), arguments).status.success());
    run(&["simulate", "soft.toml", "--rate", "200", "--speed", "0.01", "--file", "felt.csv"]);
    let reconstruct =
        ["reconstruct", "felt.csv", "--rod", "soft.toml", "--truth", "soft.toml", "--as-is", "--out", "found"];
    run(&reconstruct);
    let report = std::fs::read_to_string(dir.path().join("found/report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let truth = &report["truth"];
    println!("{truth:#}");
    assert_eq!((truth["off_path"].as_u64(), truth["accuracy"].as_f64()), (Some(0), Some(1.0)));
    let points = std::fs::read_to_string(dir.path().join("found/points.jsonl")).unwrap();
    let felt = std::fs::read_to_string(dir.path().join("felt.csv")).unwrap();
    for (line, row) in points.lines().zip(felt.lines().skip(1)) {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        let row: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let off = ["x0", "y0", "phi0"].iter().zip(&row[1..]).map(|(name, value)| line[*name].as_f64().unwrap() - value);
        assert!(off.map(f64::abs).fold(0.0, f64::max) < 1e-14, "{line} {row:?}");
    }
}

/// What takes a uniform rod on a rigid clamp alone names the field, and says what to use instead.
#[test]
fn other_commands_refuse_it() {
    let dir = tempfile::tempdir().unwrap();
    let write = |file: &str, scene: &str| std::fs::write(dir.path().join(file), scene).unwrap();
    write("rod.toml", &with_rod(TWO));
    write("clamp.toml", &with_rod(&format!("{WIRE}[clamp]\nstiffness_phi = 0.2\n")));
    let parts = [
        ("rod", "rod.toml:1:1: rod: a rod that is not uniform or not straight at rest, expected length with diameter"),
        ("clamp", "clamp.toml:5:1: clamp: a clamp that gives way, expected no table [clamp]"),
    ];
    for (name, why) in parts {
        let file = format!("{name}.toml");
        for (arguments, instead) in [
            (
                &["live", "--sensor", "file:nowhere", "--rod", &file][..],
                "`vibrissa reconstruct --rod`, which takes any rod",
            ),
            (
                &["calibrate", "nowhere.csv", "--rod", &file, "--file", "o.toml"],
                "`vibrissa reconstruct --rod` takes any rod",
            ),
            (&["budget", &file], "`vibrissa simulate --noise` and `vibrissa reconstruct --truth` show"),
            (
                &["fake-sensor", &file, "--protocol", "rdt", "--rate", "-1"],
                "with `vibrissa simulate`, which takes any clamp",
            ),
        ] {
            let output = vibrissa(dir.path(), arguments);
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(!output.status.success());
            // a sensor is played with any rod on a rigid clamp: the next mistake is told
            let refused = arguments[0] != "fake-sensor" || name == "clamp";
            let expected: &[&str] = if refused { &[why, instead] } else { &["--rate is -1"] };
            assert!(expected.iter().all(|part| message.contains(part)), "{expected:?} is not in: {message}");
        }
    }
}
