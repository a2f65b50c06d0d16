//! Recordings turned back into contact points: what is written, and what is said of recordings that are none.

use crate::common::{complaint, vibrissa};
use rod_files::Scene;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;
use vibrissa::Contour;

const SCENE: &str = include_str!("../../scenes/O1_q40.toml");
const NOISE: &str = "[ar1]\nforce = 2.5e-3\nm0z = 6e-5\ncorrelation = 0.45\n";
const ROD: &str = "[rod]\nlength = 0.1\ndiameter = 0.5e-3\nyoungs_modulus = 206e9\n";
/// In the order in which they are written.
const FIELDS: [&str; 16] = [
    "x0",
    "y0",
    "phi0",
    "x",
    "y",
    "s",
    "alpha",
    "force",
    "sigma_x",
    "sigma_y",
    "reason",
    "label",
    "several",
    "probability",
    "basis",
    "second",
];

/// A directory with a recording r.csv of the scene.
fn recorded(arguments: &[&str]) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    for (name, text) in [("O1_q40.toml", SCENE), ("noise.toml", NOISE), ("rod.toml", ROD)] {
        fs::write(directory.path().join(name), text).unwrap();
    }
    let all = [&["simulate", "O1_q40.toml", "--file", "r.csv"], arguments].concat();
    let output = vibrissa(directory.path(), &all);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    directory
}

fn reconstruct(directory: &Path, arguments: &[&str]) -> Output {
    vibrissa(directory, &[&["reconstruct", "r.csv", "--rod", "rod.toml"], arguments].concat())
}

fn lines(directory: &Path) -> Vec<Value> {
    let text = fs::read_to_string(directory.join("out/r/points.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn report(directory: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(directory.join("out/r/report.json")).unwrap()).unwrap()
}

fn rows(directory: &Path) -> Vec<Vec<f64>> {
    let mut table = csv::Reader::from_path(directory.join("r.csv")).unwrap();
    table.records().map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// Replaces the recording by an edited one: each data row (from 0) through `edit`.
fn edit(directory: &Path, edit: impl Fn(usize, Vec<f64>) -> String) {
    let rows = rows(directory);
    let text: Vec<String> = rows.into_iter().enumerate().map(|(k, row)| edit(k, row)).collect();
    fs::write(directory.join("r.csv"), format!("t,x0,y0,phi0,f0x,f0y,m0z\n{}\n", text.join("\n"))).unwrap();
}

fn joined(row: &[f64]) -> String {
    row.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// Distance of a written contact from the contour.
fn distance(scene: &Scene, contact: &Value) -> Option<f64> {
    let [x, y] = ["x", "y"].map(|field| contact[field].as_f64());
    Some(scene.objects[0].closest(x?, y?).gap.abs())
}

#[test]
fn a_clean_recording_gives_the_contour_back() {
    let directory = recorded(&["--rate", "100"]);
    let output = reconstruct(directory.path(), &["--truth", "O1_q40.toml"]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    let kinks = "of 6 changes of contact that cause one, 6 were found within 1 mm";
    assert!(said.contains(kinks) && said.contains("belong to a change of contact and 0 to none"), "{said}");
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    assert!(output.stderr.is_empty(), "{}", complaint(&output));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.starts_with("r: free A B BB BA B A free; 17001 of 17001 rows used\n"), "{said}");
    let physics =
        said.lines().position(|line| line.starts_with("physics: the reactions fit the rod, nothing to do; ")).unwrap();
    assert_eq!(said.lines().nth(physics + 1), Some("corrections: none needed"), "{said}");
    assert!(said.contains("\n  naive: one contact assumed ") && said.ends_with("written to out/r\n"), "{said}");

    let text = fs::read_to_string(directory.path().join("out/r/points.jsonl")).unwrap();
    let first = text.lines().next().unwrap();
    let places: Vec<usize> = FIELDS.iter().map(|field| first.find(&format!("\"{field}\":")).expect(field)).collect();
    assert!(places.is_sorted() && places[0] == 1, "{first}");
    let scene = Scene::parse("O1_q40.toml".as_ref(), SCENE).unwrap();
    let (lines, rows) = (lines(directory.path()), rows(directory.path()));
    assert_eq!(lines.len(), rows.len());
    let (mut single, mut several, mut worst) = (0, 0, 0.0_f64);
    for (line, row) in lines.iter().zip(&rows) {
        assert_eq!(line.as_object().unwrap().len(), 18);
        // Numbers survive the round trip.
        for (field, value) in ["x0", "y0", "phi0"].iter().zip(&row[1..]) {
            assert_eq!(line[*field].as_f64().unwrap().to_bits(), value.to_bits());
        }
        assert!((0.0..=1.0).contains(&line["probability"].as_f64().unwrap()));
        assert!(["force", "criterion", "length", "tangent", "diagram"].contains(&line["basis"].as_str().unwrap()));
        match line["label"].as_str().unwrap() {
            "free" => {
                assert!(line["x"].is_null() && line["force"].is_null() && line["second"].is_null());
                assert_eq!((&line["reason"], &line["several"]), (&"the rod is free".into(), &false.into()));
            }
            "A" | "B" => {
                single += 1;
                worst = worst.max(distance(&scene, line).expect("a point"));
                assert!(line["reason"].is_null() && line["second"].is_null() && line["several"] == false);
                assert!(line["s"].as_f64().unwrap() <= 0.1 * (1.0 + 1e-9) && line["sigma_x"].as_f64().unwrap() >= 0.0);
            }
            label => {
                assert!(["BA", "BB"].contains(&label) && line["several"] == true);
                several += 1;
                // The first contact is where the line has its own, the second is an object of the same fields.
                let second = line["second"].as_object().expect("the second contact");
                let fields: Vec<&str> = second.keys().map(String::as_str).collect();
                assert_eq!(fields.len(), 10, "{fields:?}");
                assert!(FIELDS[3..11].iter().all(|field| second.contains_key(*field)));
                for contact in [line, &line["second"]] {
                    assert_eq!(contact["x"].is_null(), contact["reason"].is_string(), "{contact}");
                    if let Some(distance) = distance(&scene, contact) {
                        assert!(distance < 1e-7, "{distance}");
                    }
                }
            }
        }
    }
    assert!(single > 13_000 && several > 1300, "{single} {several}");
    assert!(worst < 1e-12, "{worst}");

    let report = report(directory.path());
    assert_eq!(report["rows"]["total"], 17_001);
    assert_eq!(report["rows"]["usable"], 17_001);
    let runs: Vec<&str> = report["runs"].as_array().unwrap().iter().map(|run| run["label"].as_str().unwrap()).collect();
    assert_eq!(runs, ["free", "A", "B", "BB", "BA", "B", "A", "free"]);
    let mut next = 0;
    for run in report["runs"].as_array().unwrap() {
        assert_eq!(run["from"].as_u64().unwrap(), next);
        next = run["to"].as_u64().unwrap() + 1;
        assert_eq!(run["to_pose"]["x0"].as_f64().unwrap(), rows[next as usize - 1][1]);
        assert!(lines[next as usize - 1]["label"] == run["label"]);
    }
    assert_eq!(next, 17_001);
    assert!((report["physics"]["line"]["slope_by_bending_stiffness"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    assert_eq!(report["physics"]["fits"], true);
    let truth = &report["truth"];
    assert!(truth["accuracy"].as_f64().unwrap() > 0.999, "{truth}");
    assert_eq!((&truth["kinks"]["recall"], &truth["kinks"]["precision"]), (&1.0.into(), &1.0.into()));
    assert!(truth["single"]["largest"].as_f64().unwrap() < 1e-12);
    assert!(truth["naive"]["largest"].as_f64().unwrap() > 5e-3, "without several contacts it is some mm off");
    let transitions = truth["transitions"].as_array().unwrap();
    assert_eq!(transitions.len(), 7);
    assert!(transitions.iter().all(|t| t["error"].as_f64().unwrap().abs() < 2e-5), "{transitions:?}");

    let contour = fs::read_to_string(directory.path().join("out/r/contour.csv")).unwrap();
    assert!(contour.starts_with("stretch,kind,x,y,alpha,sigma,sigma_systematic\n0,single,"), "{}", &contour[..200]);
    for (figure, parts) in [
        ("contour.svg", ["true contour", "second of several"]),
        ("phases.svg", ["K in (N mm)", "7 kinks and jumps; K = m"]),
    ] {
        let drawing = fs::read_to_string(directory.path().join("out/r").join(figure)).unwrap();
        assert!(parts.iter().all(|part| drawing.contains(part)), "{figure}");
        assert!(!drawing.contains("NaN") && !drawing.contains("inf"), "{figure}");
    }
}

#[test]
fn a_noisy_one_gives_it_within_its_noise() {
    let directory = recorded(&["--noise", "noise.toml", "--seed", "3"]);
    let output = reconstruct(directory.path(), &["--truth", "O1_q40.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let report = report(directory.path());
    for (channel, sigma) in [("f0x", 2.5e-3), ("f0y", 2.5e-3), ("m0z", 6e-5)] {
        let noise = &report["noise"][channel];
        assert!((noise["sigma"].as_f64().unwrap() / sigma - 1.0).abs() < 0.05, "{noise}");
        assert!((noise["lag1"].as_f64().unwrap() - 0.45).abs() < 0.05, "{noise}");
    }
    let truth = &report["truth"];
    assert!(truth["accuracy"].as_f64().unwrap() > 0.998, "{}", truth["accuracy"]);
    assert!(truth["single"]["median"].as_f64().unwrap() < 2e-6, "{}", truth["single"]);
    assert!(truth["kinks"]["recall"].as_f64().unwrap() > 0.8, "{}", truth["kinks"]);
    assert!((report["physics"]["line"]["slope_by_bending_stiffness"].as_f64().unwrap() - 1.0).abs() < 5e-3);
    let lines = lines(directory.path());
    let answered = lines.iter().filter(|line| line["x"].is_f64());
    assert!(answered.clone().count() > 60_000);
    assert!(answered.clone().all(|line| line["sigma_x"].as_f64().unwrap() > 0.0));
}

/// Far from the object the forces are small, and few places are independent: what chance leaves of a criterion is no misfit.
#[test]
fn noise_alone_is_no_misfit() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("noise.toml"), NOISE).unwrap();
    for (name, scene) in
        [("O1_q60", include_str!("../../scenes/O1_q60.toml")), ("O3_q60", include_str!("../../scenes/O3_q60.toml"))]
    {
        let file = format!("{name}.toml");
        fs::write(directory.path().join(&file), scene).unwrap();
        for seed in ["3", "10", "13"] {
            let simulated = ["simulate", &file, "--noise", "noise.toml", "--rate", "100", "--seed", seed];
            assert!(vibrissa(directory.path(), &[&simulated[..], &["--out", "r.csv"]].concat()).status.success());
            let output = vibrissa(directory.path(), &["reconstruct", "r.csv", "--rod", &file, "--local"]);
            assert_eq!(output.status.code(), Some(0), "{name} {seed}: {}", complaint(&output));
        }
    }
}

/// A coarse scan in noise: two contacts are taken for one between two kinks. The points there are off, and the kinks tell where.
#[test]
fn kinks_within_a_phase_are_told() {
    let directory = tempfile::tempdir().unwrap();
    for (name, text) in [("scene.toml", include_str!("../../scenes/O2_q40.toml")), ("noise.toml", NOISE)] {
        fs::write(directory.path().join(name), text).unwrap();
    }
    let simulate = "simulate scene.toml --noise noise.toml --rate 100 --speed 0.005 --seed 3 --file r.csv";
    assert!(vibrissa(directory.path(), &simulate.split(' ').collect::<Vec<_>>()).status.success());
    let reconstruct = ["reconstruct", "r.csv", "--rod", "scene.toml", "--truth", "scene.toml"];
    let output = vibrissa(directory.path(), &[&reconstruct[..], &["--local"]].concat());
    assert!(
        complaint(&output).contains("2 kinks within phase B, the first before sample 2125"),
        "{}",
        complaint(&output)
    );
    // it is more than the standard deviations say
    let truth = &report(directory.path())["truth"];
    assert!(truth["single"]["largest"].as_f64().unwrap() > 5e-3, "{truth}");
    // the whole recording tells them apart
    let output = vibrissa(directory.path(), &reconstruct);
    assert!(!complaint(&output).contains("within phase B"), "{}", complaint(&output));
    let found = report(directory.path());
    let labels: Vec<&str> =
        found["runs"].as_array().unwrap().iter().map(|run| run["label"].as_str().unwrap()).collect();
    assert_eq!(labels, ["free", "A", "B", "BB", "B", "A", "free"]);
    assert!(found["truth"]["single"]["largest"].as_f64().unwrap() < 5e-4, "{}", found["truth"]);
    let exact =
        vibrissa(directory.path(), &["simulate", "scene.toml", "--rate", "100", "--speed", "0.005", "--file", "r.csv"]);
    assert!(exact.status.success());
    let output = vibrissa(directory.path(), &["reconstruct", "r.csv", "--rod", "scene.toml"]);
    assert!(!complaint(&output).contains("within phase B"), "{}", complaint(&output));
}

#[test]
fn rows_that_cannot_be_used_keep_their_place() {
    let directory = recorded(&["--rate", "20"]);
    edit(directory.path(), |k, row| match k {
        1000 => "oops,0,0,0,0,0,0".to_owned(),
        1500 => joined(&row).replace(&row[6].to_string(), "NaN"),
        1501 => joined(&[&row[..1], &[row[1] + 1e-4], &row[2..]].concat()),
        1502 => "1,2,3".to_owned(),
        _ => joined(&row),
    });
    let output = reconstruct(directory.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let lines = lines(directory.path());
    assert_eq!(lines.len(), 3401);
    let reasons = [
        (1000, "line 1002: t is `oops`, expected a number", true),
        (1500, "line 1502: m0z is NaN, expected a finite number", true),
        (1501, "line 1503: the pose of line 1501 is repeated, expected a clamp that moves", true),
        (1502, "line 1504: the number of cells is 3, expected 7", false),
    ];
    for (place, reason, pose) in reasons {
        let line = &lines[place];
        assert!(line["reason"].as_str().unwrap().starts_with(reason), "{line}");
        assert_eq!(line["x0"].is_f64(), pose, "{line}");
        let rest = ["x", "y", "s", "alpha", "force", "label", "several", "probability", "sigma_x", "basis", "second"];
        assert!(rest.iter().all(|field| line[*field].is_null()), "{line}");
    }
    assert!(lines[999]["x"].is_f64() && lines[1503]["x"].is_f64(), "their neighbours are answered");
    let report = report(directory.path());
    assert_eq!(report["rows"]["usable"], 3397);
    let faults = [("no number", 1), ("not finite", 1), ("pose repeated", 1), ("number of cells", 1)];
    for (fault, count) in faults {
        assert_eq!(report["rows"]["faults"][fault], count, "{fault}");
    }
    assert_eq!(report["runs"].as_array().unwrap().last().unwrap()["to"], 3400);
    let warnings = complaint(&output);
    assert!(warnings.contains("warning: r.csv: 1 of 3401 rows cannot be used, line 1504: "), "{warnings}");
}

#[test]
fn wrong_units_and_another_rod_are_told_and_everything_is_written() {
    let directory = recorded(&["--rate", "20"]);
    let original = fs::read(directory.path().join("r.csv")).unwrap();
    let scaled = |force: f64, moment: f64| {
        fs::write(directory.path().join("r.csv"), &original).unwrap();
        edit(directory.path(), |_, r| joined(&[r[0], r[1], r[2], r[3], force * r[4], force * r[5], moment * r[6]]));
    };
    for (force, moment, said, cause) in [
        (1.0, 1e3, "as if moments are in N mm (or mN m); expected N and N m", "moments are in N mm (or mN m)"),
        (1e3, 1.0, "as if forces are in mN; expected N and N m", "forces are in mN"),
        (-1.0, -1.0, "f0x and f0y have the wrong sign", "f0x and f0y and m0z have the wrong sign"),
        (
            1.0,
            0.8,
            "the bending stiffness is 6.3200e-4 N m^2, the recording gives 4.04",
            "m0z is 0.800 times the true value",
        ),
    ] {
        scaled(force, moment);
        let output = reconstruct(directory.path(), &["--truth", "O1_q40.toml"]);
        let message = complaint(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        let line = message.lines().find(|line| line.contains(said)).unwrap_or_else(|| panic!("{said}: {message}"));
        assert!(line.starts_with("warning: r.csv: "), "{line}");
        assert_eq!(lines(directory.path()).len(), 3401);
        let findings = report(directory.path())["physics"]["findings"].to_string();
        assert!(findings.contains(said), "{findings}");
        assert!(message.contains(&format!("likely causes among the tested ones: {cause}: ")), "{message}");
        assert!(message.contains("; not tested: a rod that tapers or is bent at rest (`tip_diameter`,"), "{message}");
        let causes = &report(directory.path())["physics"]["causes"];
        assert!(causes[0]["cause"] == cause && causes[0]["likelihood"].as_f64() > Some(0.9), "{causes}");
        assert!(String::from_utf8(output.stdout).unwrap().contains(said));
    }
}

#[test]
fn a_recording_without_a_contact_says_why_it_has_no_contour() {
    let directory = tempfile::tempdir().unwrap();
    let free = SCENE.replace("to = [-0.09, -0.04]", "to = [0.07, -0.04]");
    fs::write(directory.path().join("free.toml"), free).unwrap();
    fs::write(directory.path().join("noise.toml"), NOISE).unwrap();
    let run = |arguments: &[&str]| vibrissa(directory.path(), arguments).status.code();
    let simulate =
        ["simulate", "free.toml", "--noise", "noise.toml", "--rate", "100", "--speed", "0.001", "--file", "r.csv"];
    assert_eq!(run(&simulate), Some(0));
    assert_eq!(run(&["reconstruct", "r.csv", "--rod", "free.toml"]), Some(0));
    let figure = fs::read_to_string(directory.path().join("out/r/contour.svg")).unwrap();
    assert!(figure.contains("no sample has a contact point, so there is no contour"));
    assert!(!figure.contains("<circle"));
}

/// Checks that nothing is written, and that one line on standard error holds all these parts.
fn refuses(directory: &Path, arguments: &[&str], parts: &[&str]) {
    let output = reconstruct(directory, arguments);
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    let errors: Vec<&str> = message.lines().filter(|line| !line.starts_with("warning: ")).collect();
    assert_eq!(errors.len(), 1, "one line where nobody looks at a terminal: {message}");
    for part in parts {
        assert!(errors[0].contains(part), "`{part}` is not in: {message}");
    }
    assert!(!directory.join("out").exists(), "nothing is written");
}

#[test]
fn recordings_that_are_none() {
    let directory = recorded(&["--rate", "2"]);
    let (path, rows) = (directory.path(), rows(directory.path()));
    let file = path.join("r.csv");
    let write = |text: String| fs::write(&file, text).unwrap();
    write("# by hand\nx0,y0,phi0,f0x,f0y\n".to_owned());
    refuses(path, &[], &["error: r.csv:2: no column m0z, found x0, y0, phi0, f0x, f0y; expected "]);
    let table = |rows: &[Vec<f64>]| {
        let body: Vec<String> = rows.iter().map(|row| joined(row)).collect();
        format!("t,x0,y0,phi0,f0x,f0y,m0z\n{}\n", body.join("\n"))
    };
    write(table(&rows[..5]));
    refuses(path, &[], &["r.csv: 5 usable rows, expected at least 10"]);
    write(table(&vec![rows[7].clone(); 30]));
    refuses(path, &[], &["r.csv: 1 usable samples of 30, expected at least 10: along one path"]);
    write(table(&rows).replace("0.", "NaN"));
    refuses(path, &[], &["r.csv: ", "rows cannot be used, expected at most half of them; line "]);
    write(String::new());
    refuses(path, &[], &["r.csv: no line that names columns"]);
    fs::remove_file(&file).unwrap();
    refuses(path, &[], &["cannot read the recording r.csv: "]);
}

#[test]
fn recordings_written_in_another_way() {
    let directory = recorded(&["--rate", "20"]);
    let (path, rows) = (directory.path(), rows(directory.path()));
    assert_eq!(reconstruct(path, &[]).status.code(), Some(0));
    let expected = fs::read(path.join("out/r/points.jsonl")).unwrap();
    let write = |header: &str, delimiter: &str, comma: bool| {
        let body = rows.iter().map(|row| joined(row).replace(',', delimiter));
        let body = body.map(|row| if comma { row.replace('.', ",") } else { row }).collect::<Vec<_>>().join("\n");
        fs::write(path.join("r.csv"), format!("Messung 3\n\n{header}\n{body}\n")).unwrap();
    };
    let same = |arguments: &[&str]| {
        let output = reconstruct(path, arguments);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        assert!(fs::read(path.join("out/r/points.jsonl")).unwrap() == expected);
    };
    write("t [s];x0 [m];y0 [m];phi0 [rad];f0x [N];f0y [N];m0z [Nm]", ";", true);
    same(&[]);
    write("t x0 y0 phi0 f0x f0y m0z", " ", true);
    same(&[]);
    write("Zeit;x0;y0;phi0;f0x;Kraft y (N);Moment", "\t", false);
    fs::write(path.join("r.csv"), fs::read_to_string(path.join("r.csv")).unwrap().replace(';', "\t")).unwrap();
    fs::remove_dir_all(path.join("out")).unwrap();
    refuses(path, &[], &["r.csv:3: no column f0y, m0z, found Zeit, x0, "]);
    refuses(
        path,
        &["--column", "f0y=Kraft y", "--column", "m0z=Moment"],
        &["r.csv:3: no unit of Moment, expected one of torque"],
    );
    let meaning = [
        "--column",
        "f0y=Kraft y",
        "--column",
        "m0z=Moment",
        "--unit",
        "Moment=N m",
        "--column",
        "t=Zeit",
        "--unit",
        "Zeit=s",
    ];
    same(&meaning);
    fs::remove_dir_all(path.join("out")).unwrap();
    write("t,x0,y0,phi0,f0x,f0y,m0z", ",", true);
    refuses(path, &[], &["could be numbers with decimal commas or numbers separated by commas"]);
    let output = reconstruct(path, &["--column", "moment=m0z"]);
    assert!(complaint(&output).contains("`moment` means nothing, expected x0, y0"), "{}", complaint(&output));
}

#[test]
fn rods_and_truths_that_are_none() {
    let directory = recorded(&["--rate", "2"]);
    let path = directory.path();
    fs::write(path.join("rod.toml"), "[rod]\nlength = -0.1\nbending_stiffness = 1\n").unwrap();
    refuses(path, &[], &["rod.toml:2:10: rod.length: length is -0.1, expected a positive"]);
    fs::write(path.join("rod.toml"), ROD).unwrap();
    refuses(path, &["--truth", "no.toml"], &["cannot read the scene no.toml: "]);
    let elsewhere = SCENE.replace("[0.08, -0.04]", "[0.08, -0.06]").replace("[-0.09, -0.04]", "[-0.09, -0.06]");
    fs::write(path.join("other.toml"), elsewhere).unwrap();
    let parts = ["r.csv: no sample is on the path of the scene other, expected the scene that the recording is of"];
    refuses(path, &["--truth", "other.toml"], &parts);
}

#[test]
fn help_names_files_units_and_exit_statuses() {
    let directory = tempfile::tempdir().unwrap();
    let help = |arguments: &[&str]| {
        let output = vibrissa(directory.path(), arguments);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let command = help(&["reconstruct", "--help"]);
    for part in ["points.jsonl", "contour.csv", "report.json", "--rod <FILE>", "--truth <SCENE>", "m0z (N m)"] {
        assert!(command.contains(part), "`{part}` is not in: {command}");
    }
    let all = help(&["--help"]);
    assert!(all.contains("reconstruct Reconstruct contact points, phases and the contour"), "{all}");
    assert!(
        all.contains("2 a sweep that stopped early") && all.contains("a recording that does not fit its rod"),
        "{all}"
    );
}

#[test]
fn one_contour_explains_a_recording_or_the_place_is_named_where_none_does() {
    let directory = recorded(&["--noise", "noise.toml", "--rate", "20", "--speed", "1e-3"]);
    let output = reconstruct(directory.path(), &["--as-is"]);
    let fit = &report(directory.path())["fit"];
    assert!(output.status.success(), "{}: {fit}", complaint(&output));
    assert_eq!(fit["explains"], true);
    let labels: Vec<&str> = fit["runs"].as_array().unwrap().iter().filter_map(|run| run["label"].as_str()).collect();
    assert_eq!((labels.first(), labels.last()), (Some(&"free"), Some(&"free")), "{labels:?}");
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.contains("fit: one contour explains the recording, chi squared"), "{printed}");
    let table = fs::read_to_string(directory.path().join("out/r/fitted.csv")).unwrap();
    let points: Vec<Vec<&str>> = table.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let off = |row: &&Vec<&str>| {
        let [x, y, sigma] = [1, 2, 4].map(|column| row[column].parse::<f64>().unwrap());
        // of the parabola that is lower there
        let (x, slope) = if x < 0.015 { (x, 100.0 * x) } else { (x - 0.03, 100.0 * (x - 0.03)) };
        (y - 50.0 * x * x).abs() / slope.hypot(1.0) / sigma
    };
    let is_known = |row: &Vec<&str>| [row[3] == "touched", row[3] == "bounded"] == [4, 5].map(|k| !row[k].is_empty());
    assert!(table.starts_with("object,x,y,known,sigma,room,vertex\n") && points.iter().all(is_known), "{table}");
    assert!(points.iter().any(|row| row[3] == "bounded"), "{table}");
    let touched: Vec<f64> = points.iter().filter(|row| row[3] == "touched").map(|row| off(&row)).collect();
    assert!(touched.len() > 5 && touched.len() < points.len() && touched.iter().all(|off| *off < 5.0), "{touched:?}");
    let shapes = fit["shapes"].as_array().unwrap();
    assert!(shapes.iter().all(|shape| shape["evidence"] != 0.0 || shape["shape"] == "parabola"), "{shapes:?}");
    assert!(printed.contains(": parabola, vertex.x "), "{printed}");
    let residuals = directory.path().join("out/r/residuals.svg");
    let figure = fs::read_to_string(&residuals).unwrap();
    assert!(figure.contains("the contour explains the recording") && figure.contains("residual / σ"), "{figure}");
    // what a run with a fit left does not stay beside one without
    reconstruct(directory.path(), &["--as-is", "--local"]);
    assert!(!residuals.exists() && !directory.path().join("out/r/fitted.csv").exists());

    // somebody leans on the rod for a while
    let directory = recorded(&["--noise", "noise.toml", "--rate", "5", "--speed", "1e-3"]);
    edit(directory.path(), |k, mut row| {
        if (375..475).contains(&k) {
            row[5] += 0.04 * (std::f64::consts::PI * (k as f64 - 375.0) / 100.0).sin();
        }
        joined(&row)
    });
    let output = reconstruct(directory.path(), &["--as-is"]);
    assert_eq!(output.status.code(), Some(2));
    let complaint = complaint(&output);
    assert!(
        complaint.contains("no contour was found that explains the whole recording; it fails worst in"),
        "{complaint}"
    );
    let rows = &report(directory.path())["fit"]["worst"]["rows"];
    assert!(rows[0].as_u64().unwrap() > 325 && rows[1].as_u64().unwrap() < 525, "{rows}");
}
