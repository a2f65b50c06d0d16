//! Forces from points on a rod.

use crate::common::{complaint, vibrissa};
use std::fs;
use std::path::Path;

/// A rod with E I = 1e-6 N m^2.
const ROD: &str = "[rod]\nlength = 0.1\nbending_stiffness = 1e-6\n";

/// Points of a rod that a force of 4 E I / L^2 bends at 0.6 L, by steps of the moment from there to the base, and straight beyond.
fn points(count: usize) -> Vec<[f64; 2]> {
    // from the contact, at the origin with slope 0: phi'' = A cos phi + B sin phi with B = 0 and A = 4
    let (steps, contact) = (60_000, 0.6);
    let h = contact / f64::from(steps);
    let (mut phi, mut kappa, mut at) = (0.0_f64, 0.0, [0.0_f64; 2]);
    let mut course = vec![(contact, at)];
    for k in 1..=steps {
        // leapfrog, backwards
        let middle = kappa - 0.5 * h * 4.0 * phi.cos();
        let half = phi - 0.5 * h * middle;
        phi -= h * middle;
        kappa = middle - 0.5 * h * 4.0 * phi.cos();
        at = [at[0] - h * half.cos(), at[1] - h * half.sin()];
        course.push((contact - h * f64::from(k), at));
    }
    course.reverse();
    course.push((1.0, [0.4, 0.0]));
    let place = |s: f64| {
        let k = course.partition_point(|(place, _)| *place < s).clamp(1, course.len() - 1);
        let ((from, a), (to, b)) = (course[k - 1], course[k]);
        let share = (s - from) / (to - from);
        [0, 1].map(|c| 0.1 * (a[c] + share * (b[c] - a[c])))
    };
    (0..count).map(|k| place(k as f64 / (count - 1) as f64)).collect()
}

fn table(frames: &[Vec<[f64; 2]>]) -> String {
    let mut text = "frame,x,y\n".to_owned();
    for (number, points) in frames.iter().enumerate() {
        points.iter().for_each(|[x, y]| text += &format!("{number},{x:?},{y:?}\n"));
    }
    text
}

fn lines(file: &Path) -> Vec<serde_json::Value> {
    fs::read_to_string(file).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn place_and_force_come_from_points() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let straight: Vec<[f64; 2]> = (0..40).map(|k| [0.1 * f64::from(k) / 39.0, 0.0]).collect();
    fs::write(path.join("frames.csv"), table(&[points(40), straight])).unwrap();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    let output = vibrissa(path, &["forces", "frames.csv", "--rod", "rod.toml"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let found = lines(&path.join("out/frames/forces.jsonl"));
    let number = |key: &str| found[0][key].as_f64().unwrap();
    assert_eq!((found[0]["verdict"].as_str(), found[1]["verdict"].as_str()), (Some("determined"), Some("free")));
    // 4 E I / L^2 = 4e-4 N at 0.06 m, pushing along -y at slope 0
    assert!((number("s") - 0.06).abs() < 1e-6 && (number("force") - 4e-4).abs() < 1e-8, "{}", found[0]);
    assert!((found[0]["contacts"][0]["fy"].as_f64().unwrap() + 4e-4).abs() < 1e-8);
    // the moment at the base holds that of the force
    let lever = number("x") - number("x0");
    assert!((number("m0z") - 4e-4 * lever).abs() < 1e-12, "{}", found[0]);
    for file in ["forces.csv", "frames.svg", "forces.svg"] {
        assert!(path.join("out/frames").join(file).exists(), "{file}");
    }
    // without a stiffness in E I / L^2 and E I / L
    fs::write(path.join("soft.toml"), "[rod]\nlength = 0.1\n").unwrap();
    let output = vibrissa(path, &["forces", "frames.csv", "--rod", "soft.toml", "--out", "soft"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let found = lines(&path.join("soft/forces.jsonl"));
    assert_eq!(found[0]["force_unit"], "EI/L^2");
    assert!((found[0]["force"].as_f64().unwrap() - 4.0).abs() < 1e-4);
    assert!((found[0]["m0z"].as_f64().unwrap() - 40.0 * lever).abs() < 1e-3);
}

#[test]
fn what_is_no_film_is_told() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    let good = points(20);
    let shifted = good.iter().map(|[x, y]| [*x, y + 0.02]);
    let mixed: Vec<[f64; 2]> = good.iter().copied().zip(shifted).flat_map(|(one, other)| [one, other]).collect();
    let in_mm = good.iter().map(|[x, y]| [1e3 * x, 1e3 * y]).collect();
    for (text, status, message) in [
        (table(&[mixed]), 2, "frame 0: the points scatter by"),
        (table(&[in_mm]), 2, "are the points in mm?"),
        (table(&[good.clone(), vec![[0.0, 0.0]]]), 2, "frame 1: 1 points and 0 channels, expected points at 3 places"),
        ("frame,x,y\n1,0,0\n0,0,0\n".into(), 1, "line 3: frame 0 after frame 1, expected frames in order"),
        (
            "frame,x,y\n1,a,0\n1.5,0,0\n".into(),
            1,
            "line 2: x is `a`, expected a number\nline 3: frame is 1.5, expected a whole",
        ),
        ("frame,x\n1,0\n".into(), 1, "no column y, found frame, x"),
        ("u,v\n1,0\n".into(), 1, "no column of a measured number, found u, v; expected frame, x, y for points"),
        ("frame,x,y\n".into(), 1, "no frame, expected rows"),
    ] {
        fs::write(path.join("frames.csv"), &text).unwrap();
        let output = vibrissa(path, &["forces", "frames.csv", "--rod", "rod.toml"]);
        assert_eq!(output.status.code(), Some(status), "{text}");
        assert!(complaint(&output).contains(message), "{message}: {}", complaint(&output));
    }
}

/// Markers on the rod, where its base is known, tell what as many points tell.
#[test]
fn markers_tell_place_and_force() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    // one every 10 mm
    let marks = points(11);
    fs::write(path.join("frames.csv"), table(&[points(40)])).unwrap();
    assert!(vibrissa(path, &["forces", "frames.csv", "--rod", "rod.toml", "--out", "whole"]).status.success());
    let whole = lines(&path.join("whole/forces.jsonl")).remove(0);
    let base = ["x0", "y0", "phi0"].map(|name| format!("{:?}", whole[name].as_f64().unwrap())).join(",");
    let [[x, y], [end, height]] = [marks[3], marks[10]];
    // the slope beyond the contact is 0
    let text = format!(
        "x0,y0,phi0,x@0.03,y@0.03,x@0.1,y@0.1,phi@0.1,sigma_phi@0.1\n{base},{x:?},{y:?},{end:?},{height:?},0,1e-4\n"
    );
    fs::write(path.join("marks.csv"), text).unwrap();
    let output = vibrissa(path, &["forces", "marks.csv", "--rod", "rod.toml"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let found = lines(&path.join("out/marks/forces.jsonl")).remove(0);
    let of = |key: &str| found[key].as_f64().unwrap();
    assert!((of("s") - 0.06).abs() < 1e-5 && (of("force") - 4e-4).abs() < 1e-7, "{found}");
    assert!(of("chi2") < 1e-4 && of("freedom") == 3.0, "{found}");
    // a marker elsewhere contradicts it
    fs::write(
        path.join("off.csv"),
        format!("x0,y0,phi0,x@0.03,y@0.03,x@0.1,y@0.1,phi@0.1\n{base},{x:?},0.03,{end:?},{height:?},0\n"),
    )
    .unwrap();
    let output = vibrissa(path, &["forces", "off.csv", "--rod", "rod.toml"]);
    let found = lines(&path.join("out/off/forces.jsonl")).remove(0);
    assert_eq!(found["verdict"], "not explained", "{found} {}", complaint(&output));
    fs::write(path.join("beyond.csv"), "x0,x@0.2,phi@tip\n0,0,0\n").unwrap();
    let output = vibrissa(path, &["forces", "beyond.csv", "--rod", "rod.toml"]);
    let expected = "beyond.csv: x@0.2 is at `0.2`, expected an arc length in m, from 0 to 0.1, the length of the rod\nphi@tip is at `tip`";
    assert!(output.status.code() == Some(1) && complaint(&output).contains(expected), "{}", complaint(&output));
}

/// A sensor that is turned and sits at a lever measures combinations of the reactions.
#[test]
fn a_sensor_is_mounted() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    fs::write(path.join("frames.csv"), table(&[points(40)])).unwrap();
    assert!(vibrissa(path, &["forces", "frames.csv", "--rod", "rod.toml", "--out", "whole"]).status.success());
    let whole = lines(&path.join("whole/forces.jsonl")).remove(0);
    let [x0, y0, phi0, f0x, f0y, m0z] =
        ["x0", "y0", "phi0", "f0x", "f0y", "m0z"].map(|name| whole[name].as_f64().unwrap());
    // turned by 30 degrees, the clamp 3 mm along its x and 12 mm along its y; it feels the opposite of what the rod does
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    let (fx, fy) = (-(cos * f0x + sin * f0y), -(cos * f0y - sin * f0x));
    let torque = -m0z + 0.003 * fy - 0.012 * fx;
    let row = format!("{x0:?},{y0:?},{phi0:?},{fx:?},{fy:?},0,{torque:?}");
    fs::write(path.join("felt.csv"), format!("x0,y0,phi0,Fx,Fy,Fz,Tz\n{row}\n")).unwrap();
    fs::write(path.join("setup.toml"), "[mounting]\nangle = 30.0\nlever = [0.003, 0.012, 0.0]\n").unwrap();
    let judged = |arguments: &[&str]| {
        let output = vibrissa(path, &[&["forces", "felt.csv", "--rod", "rod.toml"], arguments].concat());
        (lines(&path.join("out/felt/forces.jsonl")).remove(0), complaint(&output))
    };
    let (found, said) = judged(&["--setup", "setup.toml"]);
    let of = |key: &str| found[key].as_f64().unwrap();
    assert_eq!(found["verdict"], "determined", "{found} {said}");
    assert!((of("s") - 0.06).abs() < 1e-5 && (of("force") - 4e-4).abs() < 1e-7, "{found}");
    // taken as if it sat at the base, it is another contact or none
    let (found, _) = judged(&[]);
    assert!(found["verdict"] != "determined" || (found["force"].as_f64().unwrap() - 4e-4).abs() > 1e-5, "{found}");
    // it turns with the clamp, whose angle now is not known
    fs::write(path.join("setup.toml"), "[mounting]\nturns_from = 90.0\n").unwrap();
    fs::write(path.join("felt.csv"), "x0,Fx\n0,1\n").unwrap();
    let output = vibrissa(path, &["forces", "felt.csv", "--rod", "rod.toml", "--setup", "setup.toml"]);
    assert!(output.status.code() == Some(1) && complaint(&output).contains("expected phi0"), "{}", complaint(&output));
}

/// Axial force and moment of a frictionless contact on the side of a uniform rod are one number, F = -M^2 / 2 E I; across and moment are two.
#[test]
fn a_part_of_the_base_signal_tells_what_it_tells() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    // of the contact of `points`, in the frame of the base: by the first integral of the elastica
    let all = points(40);
    let frames = table(std::slice::from_ref(&all));
    fs::write(path.join("frames.csv"), frames).unwrap();
    assert!(vibrissa(path, &["forces", "frames.csv", "--rod", "rod.toml", "--out", "whole"]).status.success());
    let found = lines(&path.join("whole/forces.jsonl")).remove(0);
    let of = |key: &str| found[key].as_f64().unwrap();
    let (sin, cos) = of("phi0").sin_cos();
    // turned so that the base points along x
    let (along, across, moment) = (of("f0x") * cos + of("f0y") * sin, of("f0y") * cos - of("f0x") * sin, of("m0z"));
    assert!((along - moment * moment / 2e-6).abs() < 1e-6 * along.abs(), "{along} {moment}");
    for (columns, row, verdict) in [
        ("f0x,m0z", format!("{along:?},{moment:?}"), "family"),
        ("m0z", format!("{moment:?}"), "family"),
        ("f0x,f0y,m0z", format!("{along:?},{across:?},{moment:?}"), "determined"),
    ] {
        fs::write(path.join("part.csv"), format!("x0,y0,phi0,{columns}\n0,0,0,{row}\n")).unwrap();
        let output = vibrissa(path, &["forces", "part.csv", "--rod", "rod.toml"]);
        let judged = lines(&path.join("out/part/forces.jsonl")).remove(0);
        assert_eq!(judged["verdict"], verdict, "{columns}: {judged} {}", complaint(&output));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let figure = fs::read_to_string(path.join("out/part/frames.svg")).unwrap();
        assert_eq!(
            said.contains("1 frame of verdict family without a force of their own"),
            verdict == "family",
            "{said}"
        );
        assert_eq!(said.contains("--pole finds it"), verdict == "family", "{said}");
        assert_eq!(figure.contains("1 of them family: --pole may determine them"), verdict == "family", "{columns}");
        if verdict == "family" {
            // the true contact is a member: the force at 0.6 L is 4 E I / L^2
            let members = judged["family"].as_array().unwrap();
            let near = members.iter().find(|member| (member["s"].as_f64().unwrap() - 0.06).abs() < 1e-9).unwrap();
            assert!((near["force"].as_f64().unwrap() - 4e-4).abs() < 4e-6, "{near}");
            assert!(judged["sigma_force"].is_null() || judged["sigma_force"].as_f64().unwrap() > 1e-3, "{judged}");
        } else {
            assert!((judged["s"].as_f64().unwrap() - 0.06).abs() < 1e-5, "{judged}");
        }
    }
}

/// Frames turned about their contact touch one edge there.
#[test]
fn a_pole_that_all_frames_touch_is_found() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let turned = |k: usize, way: f64| -> Vec<[f64; 2]> {
        let (sin, cos) = (0.08 * k as f64).sin_cos();
        points(30).iter().map(|[x, y]| [cos * x - sin * y + 0.02 + way, sin * x + cos * y - 0.01]).collect()
    };
    let mut frames: Vec<Vec<[f64; 2]>> = (0..8).map(|k| turned(k, 0.0)).collect();
    frames.push(turned(3, 0.01));
    fs::write(path.join("rod.toml"), ROD).unwrap();
    let pixels = |frames: &[Vec<[f64; 2]>]| {
        let image = |[x, y]: &[f64; 2]| [1e4 * x, -1e4 * y];
        table(&frames.iter().map(|points| points.iter().map(image).collect()).collect::<Vec<_>>())
    };
    fs::write(path.join("frames.csv"), pixels(&frames)).unwrap();
    let forces =
        ["forces", "frames.csv", "--rod", "rod.toml", "--sigma", "1e-5", "--scale", "1e-4", "--image", "--pole"];
    let output = vibrissa(path, &forces);
    assert!(output.status.success(), "{}", complaint(&output));
    let pole: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path.join("out/frames/pole.json")).unwrap()).unwrap();
    let number = |key: &str| pole[key].as_f64().unwrap();
    assert!((number("x") - 0.02).abs() < 1e-6 && (number("y") + 0.01).abs() < 1e-6, "{pole}");
    assert_eq!((pole["radius"].as_f64(), pole["elsewhere"].as_array().unwrap().len()), (Some(0.0), 1), "{pole}");
    assert_eq!(pole["elsewhere"][0], 8);
    assert!(String::from_utf8_lossy(&output.stdout).contains("8 frames at it, 1 elsewhere"));
    // a centre that is known, in pixels as the points, and one that is not there
    let known = vibrissa(path, &[&forces[..], &["200,100", "--pole-radius", "0"]].concat());
    assert!(known.status.success(), "{}", complaint(&known));
    let wrong = vibrissa(path, &[&forces[..], &["300,100", "--pole-radius", "0", "--pole-sigma", "0.1"]].concat());
    assert_eq!(wrong.status.code(), Some(2), "{}", complaint(&wrong));
    assert!(complaint(&wrong).contains("the frames contradict the given pole"), "{}", complaint(&wrong));
    assert!(!path.join("out/frames/pole.json").exists());
    let text = vibrissa(path, &[&forces[..], &["12"]].concat());
    assert!(complaint(&text).contains("expected X,Y"), "{}", complaint(&text));
}

/// Numbers in N and N m say nothing of a rod whose forces are in E I / L^2.
#[test]
fn loads_on_a_rod_without_stiffness_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), "[rod]\nlength = 0.1\ndiameter = 1e-3\n").unwrap();
    fs::write(path.join("frames.csv"), table(&[points(40)])).unwrap();
    let refused = |arguments: &[&str], said: &str| {
        let output = vibrissa(path, &[&["forces"], arguments, &["--rod", "rod.toml"]].concat());
        assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
        let expected = " are in N and N m, but the rod has no stiffness; expected bending_stiffness, or diameter and youngs_modulus, in its table [rod]";
        assert!(complaint(&output).contains(&format!("{said}{expected}")), "{}", complaint(&output));
    };
    fs::write(path.join("part.csv"), "x0,y0,phi0,f0x,m0z\n0,0,0,-0.1,0.01\n").unwrap();
    refused(&["part.csv"], "part.csv:1: the columns f0x, m0z");
    fs::write(path.join("felt.csv"), "frame,Fy,sigma_Fy,Tz\n0,0.1,0.01,0.01\n").unwrap();
    refused(&["frames.csv", "--channels", "felt.csv"], "felt.csv:1: the columns Fy, Tz");
    // a pose and a curvature need no stiffness
    fs::write(path.join("bent.csv"), "frame,phi0,kappa@0.01\n0,0,1\n").unwrap();
    let output = vibrissa(path, &["forces", "frames.csv", "--channels", "bent.csv", "--rod", "rod.toml"]);
    assert_ne!(output.status.code(), Some(1), "{}", complaint(&output));
}

/// A column that is mistyped, or that such a table has no use for, is told.
#[test]
fn columns_without_a_use_are_told() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    let said = |arguments: &[&str]| {
        let output = vibrissa(path, &[&["forces"], arguments, &["--rod", "rod.toml"]].concat());
        assert_ne!(output.status.code(), Some(1), "{}", complaint(&output));
        complaint(&output)
    };
    fs::write(path.join("part.csv"), "T,frame,x0,y0,phi0,foz,m0z,sigma_m0z,sigma_f0x\n0,0,0,0,0,-0.1,0.01,1e-4,1\n")
        .unwrap();
    let heard = said(&["part.csv"]);
    assert!(heard.contains("warning: part.csv: not used: column foz, sigma_f0x\n"), "{heard}");
    let text = table(&[points(40)]);
    fs::write(path.join("free.csv"), &text).unwrap();
    let text = text.replace("frame,x,y", "Frame,x,y,z,sigma_x").replace('\n', ",,\n").replacen(",,\n", "\n", 1);
    fs::write(path.join("frames.csv"), text).unwrap();
    let heard = said(&["frames.csv", "--channels", "part.csv"]);
    let expected = "warning: frames.csv: not used: column z, sigma_x, foz of part.csv, sigma_f0x of part.csv\n";
    assert!(heard.contains(expected), "{heard}");
    let heard = said(&["free.csv", "--rest", "frames.csv"]);
    assert!(heard.contains("warning: free.csv: not used: column z of frames.csv, sigma_x of frames.csv\n"), "{heard}");
}

/// How a sensor sits says nothing of numbers that are not its own.
#[test]
fn a_setup_without_numbers_of_a_sensor_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("rod.toml"), ROD).unwrap();
    fs::write(path.join("setup.toml"), "[mounting]\nlever = [0.003, 0.012, 0.0]\n").unwrap();
    fs::write(path.join("frames.csv"), table(&[points(40)])).unwrap();
    fs::write(path.join("part.csv"), "frame,m0z\n0,-0.1\n").unwrap();
    fs::write(path.join("felt.csv"), "frame,Tz\n0,-0.1\n").unwrap();
    let judged = |arguments: &[&str]| {
        let output =
            vibrissa(path, &[&["forces"], arguments, &["--rod", "rod.toml", "--setup", "setup.toml"]].concat());
        (output.status.code(), complaint(&output))
    };
    for (arguments, file) in [
        (&["frames.csv"][..], "frames.csv"),
        (&["part.csv"], "part.csv"),
        (&["frames.csv", "--channels", "part.csv"], "part.csv"),
    ] {
        let (status, said) = judged(arguments);
        let expected = format!(
            "{file}:1: no column of Fx, Fy, Fz, Tx, Ty, Tz, so that the mounting of the sensor (--setup) has no effect"
        );
        assert!(status == Some(2) && said.contains(&expected), "{arguments:?}: {said}");
    }
    let (_, said) = judged(&["frames.csv", "--channels", "felt.csv"]);
    assert!(!said.contains("--setup"), "{said}");
}
