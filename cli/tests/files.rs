//! What a sweep writes, and what it leaves alone.

use crate::common::{SCENE, complaint, edited, vibrissa};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn lines(file: &Path) -> Vec<Value> {
    fs::read_to_string(file).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// A directory with the scene in it, swept into `out/scene`.
fn swept(scene: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), scene).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "scene.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.starts_with("scene: ") && said.contains("first-contact"), "{said}");
    directory
}

#[test]
fn a_sweep_writes_states_events_and_a_figure() {
    let directory = swept(SCENE);
    let out = directory.path().join("out/scene");
    let mut names: Vec<_> = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["contacts.csv", "events.jsonl", "states.csv", "states.jsonl", "sweep.json", "sweep.svg"]);

    let states = lines(&out.join("states.jsonl"));
    assert_eq!(states.len(), 41);
    let state = states.last().unwrap();
    let mut expected = vec![
        "x0",
        "y0",
        "phi0",
        "phase",
        "f0x",
        "f0y",
        "m0z",
        "contacts",
        "residual",
        "min_gap",
        "min_gap_bound",
        "gap_proven",
        "leg",
        "stable",
        "energy",
        "max_stress",
        "min_force",
        "first_integral",
        "condition",
        "iterations",
    ];
    expected.sort_unstable();
    assert_eq!(keys(state), expected);
    assert_eq!((&state["phase"], &state["stable"]), (&"B".into(), &true.into()));
    assert!(state["max_stress"].as_f64().unwrap() > 1e6);
    let contact = &state["contacts"][0];
    assert_eq!(keys(contact), ["alpha", "force", "kind", "object", "piece", "s", "x", "y"]);
    assert_eq!((&contact["kind"], &contact["piece"]), (&"tangent".into(), &1.into()));

    let events = lines(&out.join("events.jsonl"));
    let mut expected =
        vec!["x0", "y0", "phi0", "from", "to", "kind", "f0x", "f0y", "m0z", "contacts", "after", "leg", "energy"];
    expected.sort_unstable();
    assert_eq!(keys(&events[0]), expected);
    assert_eq!(
        (&events[0]["kind"], &events[0]["from"], &events[0]["to"]),
        (&"first-contact".into(), &"free".into(), &"A".into())
    );
    // at first contact the states before and after are one, but for the contact
    let after = &events[0]["after"];
    assert_eq!(keys(after), keys(state));
    assert_eq!((&after["x0"], &after["phase"]), (&events[0]["x0"], &"A".into()));
    assert_eq!((&events[0]["contacts"], &after["contacts"][0]["kind"]), (&Value::Array(Vec::new()), &"tip".into()));
    // Reach of the tip: 0.03 + sqrt((0.1 - 0.04) / 50).
    let reach = 0.03 + (0.06_f64 / 50.0).sqrt();
    assert!((events[0]["x0"].as_f64().unwrap() - reach).abs() < 1e-11);
    assert_eq!(events[1]["kind"], "tip-to-tangent");

    let figure = fs::read_to_string(out.join("sweep.svg")).unwrap();
    assert!(figure.starts_with("<svg") && figure.trim_end().ends_with("</svg>"));
    for text in ["x in mm", "y in mm", ">0x</tspan>", "> in N mm</tspan>", "phase A", "phase B", "free"] {
        assert!(figure.contains(text), "{text}");
    }
}

/// Lines have fractions of pixels, the page is 180 mm wide, and a closed contour around the rod is seen as a whole.
#[test]
fn a_figure_is_fine_and_whole() {
    let directory = tempfile::tempdir().unwrap();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let output =
        vibrissa(directory.path(), &["sweep", scenes.join("ring_gear.toml").to_str().unwrap(), "--out", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let figure = fs::read_to_string(directory.path().join("out/sweep.svg")).unwrap();
    assert!(figure.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"180mm\""));
    let ring = figure.lines().find(|line| line.contains("stroke=\"#000000\" stroke-width=\"5\"") && line.len() > 1000);
    let points = ring.unwrap().split('"').nth(1).unwrap().to_owned();
    let points: Vec<(f64, f64)> = points
        .split(' ')
        .map(|point| point.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap())).unwrap())
        .collect();
    assert!(points.iter().any(|(x, _)| x.fract() != 0.0) && points.first() == points.last());
    assert!(points.iter().all(|(x, y)| *x > 0.0 && *y > 0.0 && *x < 860.0 && *y < 1150.0), "{points:?}");
}

#[test]
fn the_table_holds_the_same_numbers_to_the_last_bit() {
    let directory = swept(SCENE);
    let out = directory.path().join("out/scene");
    let mut table = csv::Reader::from_path(out.join("states.csv")).unwrap();
    let header = "state,x0,y0,phi0,phase,f0x,f0y,m0z,residual,min_gap,stable,energy,max_stress,min_gap_bound,gap_proven,leg,\
                  min_force,first_integral,condition,iterations";
    assert_eq!(table.headers().unwrap().iter().collect::<Vec<_>>().join(","), header);
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let states = lines(&out.join("states.jsonl"));
    assert_eq!(rows.len(), states.len());
    for (index, (row, state)) in rows.iter().zip(&states).enumerate() {
        assert_eq!(row[0].parse::<usize>().unwrap(), index, "the number of the line in states.jsonl");
        for (cell, column) in row.iter().zip(header.split(',')).skip(1) {
            match &state[column] {
                Value::Number(number) => assert_eq!(cell.parse::<f64>().unwrap(), number.as_f64().unwrap(), "{column}"),
                Value::String(text) => assert_eq!(cell, text),
                // the smallest force of a free rod
                Value::Null => assert_eq!(cell, "", "{column}"),
                other => assert_eq!(cell, other.to_string()),
            }
        }
    }
}

#[test]
fn the_table_of_contacts_has_a_row_for_each() {
    let directory = swept(&edited("to = [0.03, -0.04]", "to = [-0.09, -0.04]"));
    let out = directory.path().join("out/scene");
    let mut table = csv::Reader::from_path(out.join("contacts.csv")).unwrap();
    let header = "state,x0,y0,phi0,phase,contact,object,piece,kind,s,x,y,alpha,force,mode,friction,slip";
    assert_eq!(table.headers().unwrap().iter().collect::<Vec<_>>().join(","), header);
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let states = lines(&out.join("states.jsonl"));
    let contacts = |state: &Value| state["contacts"].as_array().unwrap().clone();
    let all: Vec<(usize, usize, Value)> = (0_usize..)
        .zip(&states)
        .flat_map(|(state, record)| {
            (0_usize..).zip(contacts(record)).map(move |(contact, record)| (state, contact, record))
        })
        .collect();
    assert!(rows.len() == all.len() && all.iter().any(|(_, contact, _)| *contact == 1), "{}", rows.len());
    for (row, (state, contact, record)) in rows.iter().zip(&all) {
        assert_eq!((row[0].parse::<usize>().unwrap(), row[5].parse::<usize>().unwrap()), (*state, *contact));
        for (cell, column) in
            row.iter().zip(header.split(',')).filter(|(_, column)| !["state", "contact"].contains(column))
        {
            match record.get(column).unwrap_or(&states[*state][column]) {
                Value::String(text) => assert_eq!(cell, text),
                // a scene without friction
                Value::Null => assert_eq!(cell, "", "{column}"),
                number => assert_eq!(cell.parse::<f64>().unwrap(), number.as_f64().unwrap(), "{column}"),
            }
        }
    }
}

#[test]
fn a_rod_without_thickness_has_no_stress() {
    let directory = swept(&edited("diameter = 0.5e-3\nyoungs_modulus = 206e9", "bending_stiffness = 6.32e-4"));
    let states = lines(&directory.path().join("out/scene/states.jsonl"));
    assert!(states.iter().all(|state| state["max_stress"].is_null()));
    let table = fs::read_to_string(directory.path().join("out/scene/states.csv")).unwrap();
    assert!(table.lines().skip(1).all(|line| line.split(',').nth(12) == Some("")));
}

#[test]
fn a_clamp_that_turns_is_plotted_against_its_angle() {
    let turning = "from = [0.05, -0.04]\nto = [0.05, -0.04]\nangle = 60.0\nangle_to = 120.0\nstep_angle = 2.0\n";
    let directory = swept(&(SCENE[..SCENE.find("from").unwrap()].to_owned() + turning));
    let states = lines(&directory.path().join("out/scene/states.jsonl"));
    assert_eq!(states.len(), 31);
    assert!((states[30]["phi0"].as_f64().unwrap().to_degrees() - 120.0).abs() < 1e-12);
    let figure = fs::read_to_string(directory.path().join("out/scene/sweep.svg")).unwrap();
    assert!(figure.contains("in degrees"));
}

#[test]
fn a_rod_that_yields_is_told_of() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), edited("206e9", "206e9\nyield_stress = 1e6")).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "scene.toml", "--out", "here"]);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("the rod yields") && said.contains("1.0000e6 Pa"), "{said}");
    assert!(directory.path().join("here/states.csv").exists());
}

#[test]
fn an_unreadable_scene() {
    let directory = tempfile::tempdir().unwrap();
    let output = vibrissa(directory.path(), &["sweep", "nowhere.toml"]);
    assert_eq!(output.status.code(), Some(1));
    let message = complaint(&output);
    assert!(message.contains("cannot read the scene nowhere.toml"), "{message}");
    fs::write(directory.path().join("image.toml"), b"\xff\xfe").unwrap();
    let message = complaint(&vibrissa(directory.path(), &["sweep", "image.toml"]));
    assert!(message.contains("image.toml:1: byte 0xff is no text in UTF-8, expected the scene"), "{message}");
    fs::write(directory.path().join("image.toml"), b"[rod]\nlength\0").unwrap();
    let message = complaint(&vibrissa(directory.path(), &["sweep", "image.toml"]));
    assert!(message.contains("image.toml:2: byte 0x00 is no text"), "{message}");
}

#[test]
fn a_file_where_a_directory_is_to_be() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    fs::write(directory.path().join("taken"), "a file").unwrap();
    let contour = ["contour", "scene.toml"];
    for (command, out) in
        [(&["sweep", "scene.toml"][..], "taken"), (&["paper"], "taken/below"), (&contour, "taken/c.csv")]
    {
        let output = vibrissa(directory.path(), &[command, &["--out", out]].concat());
        assert_eq!(output.status.code(), Some(1));
        let message = complaint(&output);
        assert!(message.contains("taken is a file, expected a directory; name another one"), "{message}");
    }
    assert_eq!(fs::read_to_string(directory.path().join("taken")).unwrap(), "a file");
}

#[test]
fn a_failure_leaves_the_earlier_results_alone() {
    let directory = swept(SCENE);
    let file = directory.path().join("out/scene/states.jsonl");
    let good = fs::read(&file).unwrap();
    fs::write(directory.path().join("scene.toml"), edited("length = 0.1", "length = -0.1")).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "scene.toml"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(fs::read(&file).unwrap(), good);
    assert_eq!(fs::read_dir(directory.path().join("out/scene")).unwrap().count(), 6, "no stage is left behind");
}

#[test]
fn a_sweep_that_stops_early_keeps_what_it_has() {
    let directory = tempfile::tempdir().unwrap();
    // The clamp itself is driven into the solid.
    let into = "from = [0.0, -0.15]\nto = [0.0, 0.05]\nangle = 60.0\nstep = 1e-3\n";
    fs::write(directory.path().join("scene.toml"), SCENE[..SCENE.find("from").unwrap()].to_owned() + into).unwrap();
    let output = vibrissa(directory.path(), &["sweep", "scene.toml"]);
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("scene: the sweep stopped at clamp (0.000000000, "), "{message}");
    let states = lines(&directory.path().join("out/scene/states.jsonl"));
    assert!((50..200).contains(&states.len()), "{}", states.len());
    assert!(fs::read_to_string(directory.path().join("out/scene/sweep.svg")).unwrap().contains("stopped early"));
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(directory.path().join("out/scene/sweep.json")).unwrap()).unwrap();
    assert_eq!((&summary["complete"], &summary["stop"]["kind"]), (&false.into(), &"clamp-inside".into()));
    assert!(message.contains(summary["stop"]["message"].as_str().unwrap()), "{summary}");
}
