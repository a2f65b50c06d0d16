//! `vibrissa study`: scenes in all combinations of some numbers, one row of results for each.

use crate::common::vibrissa;
use rod_files::{Interrupt, Scan, Scene, Study};
use std::fs;
use std::path::{Path, PathBuf};

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name)
}

/// A study of O1 in a directory, in which `parameters` follow.
fn written(directory: &Path, parameters: &str) -> PathBuf {
    fs::copy(scene("O1_q40.toml"), directory.join("O1.toml")).unwrap();
    let file = directory.join("study.toml");
    fs::write(&file, format!("scene = \"O1.toml\"\n{parameters}")).unwrap();
    file
}

const DISTANCE: &str = r#"
[[parameter]]
name = "distance"
values = [0.2, 0.4, 0.6]
set = [{ field = "sweep.from[2]", scale = -0.1 }, { field = "sweep.to[2]", scale = -0.1 }]
"#;

fn rows(out: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(out.join("rows.csv")).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn the_cycles_of_the_paper_and_what_was_touched() {
    let directory = tempfile::tempdir().unwrap();
    written(directory.path(), DISTANCE);
    let output = vibrissa(directory.path(), &["study", "study.toml"]);
    assert!(output.status.success(), "{output:?}");
    let told = "3 scenes: 3 done, 0 stopped early, 0 refused";
    assert!(String::from_utf8_lossy(&output.stdout).contains(&format!("{told}; 0 rows from an earlier run")));
    let again = vibrissa(directory.path(), &["study", "study.toml", "--jobs", "1"]);
    assert!(again.status.success() && String::from_utf8_lossy(&again.stdout).contains(&format!("{told}; 3 rows")));
    let rows = rows(&directory.path().join("out/study"));
    let column = |name: &str| rows[0].iter().position(|column| column == name).unwrap();
    for (row, (cycle, distance)) in rows[1..].iter().zip([("C1", 20), ("C2", 40), ("C3", 60)]) {
        assert_eq!((row[column("status")].as_str(), row[column("cycle")].as_str()), ("done", cycle));
        let scan = Scan::run(Scene::read(&scene(&format!("O1_q{distance}.toml"))).unwrap()).unwrap();
        let number = |name: &str| row[column(name)].parse::<f64>().unwrap();
        // way with several contacts, from the events alone
        let events = &scan.outcome.events;
        let enters = events.iter().filter(|event| event.from().contacts < 2 && event.to().contacts == 2);
        let leaves = events.iter().filter(|event| event.from().contacts == 2 && event.to().contacts < 2);
        let way: f64 = enters.zip(leaves).map(|(enter, leave)| enter.after.pose.x - leave.before.pose.x).sum();
        assert!((number("several") - way).abs() < 1e-12, "{} {way}", number("several"));
        // what was touched, from x of the contacts and the closed form of a parabola's length
        let touched = touched(&scan);
        if cycle == "C3" {
            // a snap jumps over more than the notch
            assert!(number("touched") < touched - 0.01);
        } else {
            assert!((number("touched") - touched).abs() < 1e-9, "{} {touched}", number("touched"));
        }
    }
}

/// The share of O1 that was touched between its outermost touched points: an interval of x without contact is the notch, because
/// both contacts move on from state to state.
fn touched(scan: &Scan) -> f64 {
    let length = |x: f64| {
        let slope = 100.0 * x;
        (slope * slope.hypot(1.0) + slope.asinh()) / 200.0
    };
    // length of O1 up to x: parabolas with vertices at 0 and 0.03, which meet at 0.015
    let along = |x: f64| if x < 0.015 { length(x) } else { length(0.015) + length(x - 0.03) - length(-0.015) };
    let of_events = scan.outcome.events.iter().flat_map(|event| [&event.before, &event.after]);
    let xs = scan.outcome.states.iter().chain(of_events).flat_map(|state| &state.contacts).map(|contact| contact.x);
    let mut xs: Vec<f64> = xs.collect();
    xs.sort_by(f64::total_cmp);
    let notch =
        xs.windows(2).filter(|pair| pair[0] < 0.015 && pair[1] > 0.015).map(|pair| along(pair[1]) - along(pair[0]));
    1.0 - notch.sum::<f64>() / (along(xs[xs.len() - 1]) - along(xs[0]))
}

#[test]
fn a_run_that_was_broken_off_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let many =
        "[[parameter]]\nname = \"x\"\nfrom = 0.05\nto = 0.06\ncount = 1200\nset = [{ field = \"sweep.to[1]\" }]\n";
    let study = Study::read(&written(directory.path(), many)).unwrap();
    let [whole, broken] = ["whole", "broken"].map(|name| directory.path().join(name));
    assert!(study.run(&whole, &Interrupt::default()).unwrap().complete);

    let interrupt = Interrupt::default();
    std::thread::scope(|scope| {
        let run = scope.spawn(|| study.run(&broken, &interrupt).unwrap());
        // a part is there as a whole or not at all
        while !broken.join("parts/00000000.csv").exists() {
            std::thread::yield_now();
        }
        interrupt.raise();
        run.join().unwrap()
    });
    let again = study.run(&broken, &Interrupt::default()).unwrap();
    assert!(again.complete && again.found >= 512, "{again:?}");
    assert_eq!(again.done, 1200);
    let [whole, broken] = [whole, broken].map(|out| fs::read(out.join("rows.csv")).unwrap());
    assert_eq!(whole, broken);
    assert_eq!(whole.iter().filter(|byte| **byte == b'\n').count(), 1201);

    // another study is not mixed in
    let other = Study::read(&written(directory.path(), DISTANCE)).unwrap();
    let error = other.run(&directory.path().join("broken"), &Interrupt::default()).unwrap_err().to_string();
    assert!(error.contains("another study") && error.contains("--out"), "{error}");
}

#[test]
fn scenes_that_are_none_are_rows_with_their_reason() {
    let directory = tempfile::tempdir().unwrap();
    let lengths = "[[parameter]]\nname = \"length\"\nvalues = [-1.0, 0.1]\nset = [{ field = \"rod.length\" }]\n";
    let study = Study::read(&written(directory.path(), lengths)).unwrap();
    let out = directory.path().join("out");
    let run = study.run(&out, &Interrupt::default()).unwrap();
    assert_eq!((run.done, run.refused), (1, 1));
    let rows = rows(&out);
    assert_eq!(rows[1][2], "refused");
    let reason = rows[1].last().unwrap();
    assert!(reason.starts_with("rod.length: length is -1, expected a positive"), "{reason}");
}

#[test]
fn the_studies_of_the_repository_are_some() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies");
    let mut counts = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        if fs::read_to_string(&file).unwrap().contains("[[parameter]]") {
            let study = Study::read(&file).unwrap();
            counts.push(study.count());
            let row = study.row(study.count() - 1);
            assert!(row.measured.is_some(), "{}: {row:?}", file.display());
        }
    }
    assert_eq!((counts.len(), counts.iter().sum()), (5, 30_360));
}

#[test]
fn one_scene_is_printed() {
    let directory = tempfile::tempdir().unwrap();
    written(directory.path(), DISTANCE);
    let output = vibrissa(directory.path(), &["study", "study.toml", "--scene", "1"]);
    let printed = Scene::parse("one.toml".as_ref(), &String::from_utf8(output.stdout).unwrap()).unwrap();
    let of_paper = Scene::read(&scene("O1_q40.toml")).unwrap();
    let off = printed.path.at(0.0).y - of_paper.path.at(0.0).y;
    assert!(off.abs() < 1e-15 && printed.step == of_paper.step, "{off:e}");
    let output = vibrissa(directory.path(), &["study", "study.toml", "--scene", "3"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--scene is 3, expected a number from 0 to 2"));
}

#[test]
fn contributions_to_one_field_add() {
    let directory = tempfile::tempdir().unwrap();
    let two = r#"
        [[parameter]]
        name = "a"
        values = [1.0, 2.0]
        set = [{ field = "sweep.from[2]", offset = -0.04, scale = 1e-3 }]
        [[parameter]]
        name = "b"
        values = [10.0, 20.0, 30.0]
        set = [{ field = "sweep.from[2]", scale = 1e-3 }]
    "#;
    let study = Study::read(&written(directory.path(), two)).unwrap();
    assert_eq!((study.count(), study.values(4)), (6, vec![2.0, 20.0]));
    let text: toml::Table = study.text(4).unwrap().parse().unwrap();
    let y = text["sweep"]["from"][1].as_float().unwrap();
    assert!((y - (-0.04 + 2e-3 + 20e-3)).abs() < 1e-15, "{y}");
}

#[test]
fn mistakes_have_their_places() {
    let directory = tempfile::tempdir().unwrap();
    for (parameters, message) in [
        ("", "missing field `parameter`"),
        (
            "[[parameter]]\nname = \"a b\"\nvalues = [1.0]\nset = []",
            "study.toml:3:8: parameter[1].name: the name is \"a b\"",
        ),
        (
            "[[parameter]]\nname = \"a\"\nvalues = []\nset = [{ field = \"rod.length\" }]",
            "no values, expected at least one",
        ),
        ("[[parameter]]\nname = \"a\"\nvalues = [1.0]\nset = []", "`set` is empty, expected a field"),
        (
            "[[parameter]]\nname = \"a\"\nfrom = 1.0\nset = [{ field = \"rod.length\" }]",
            "either `values`, or `from`, `to` and `count`",
        ),
        (
            "[[parameter]]\nname = \"a\"\nfrom = 1.0\nto = 2.0\ncount = 1\nset = [{ field = \"rod.length\" }]",
            "count is 1, expected a number from 2",
        ),
        (
            "[[parameter]]\nname = \"a\"\nvalues = [1.0]\nset = [{ field = \"contour.piece[3].coefficient\" }]",
            "contour.piece[3].coefficient: the scene has 2, expected a number from 1 to 2",
        ),
        ("[[parameter]]\nname = \"a\"\nvalues = [1.0]\nset = [{ field = \"rod..length\" }]", "expected a name such as"),
        (
            "[[parameter]]\nname = \"status\"\nvalues = [1.0]\nset = [{ field = \"rod.length\" }]",
            "\"status\" is that of another parameter or of a column",
        ),
        (
            "[[parameter]]\nname = \"a\"\nvalues = [nan]\nset = [{ field = \"rod.length\" }]",
            "a value is NaN, expected finite",
        ),
    ] {
        let error = Study::read(&written(directory.path(), parameters)).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    let output = vibrissa(directory.path(), &["study", "nowhere.toml"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot read the study nowhere.toml"));
}

/// The second run said that none was refused, and ended with status 0.
#[test]
fn a_study_of_refused_scenes_ends_with_the_same_status_again() {
    let directory = tempfile::tempdir().unwrap();
    let study = "[[parameter]]\nname = \"step\"\nvalues = [-1.0, -2.0]\nset = [{ field = \"sweep.step\" }]\n";
    written(directory.path(), study);
    for _ in 0..2 {
        let output = vibrissa(directory.path(), &["study", "study.toml"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stdout).contains("0 done, 0 stopped early, 2 refused"), "{output:?}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains("the first refused scene is 0: ") && message.contains("step is -1"), "{message}");
    }
}

/// Tables that the scene does not have were refused.
#[test]
fn friction_and_clamp_are_varied_where_the_scene_has_none() {
    let directory = tempfile::tempdir().unwrap();
    let parameter = |name: &str, values: &str, fields: &[&str]| {
        let set: Vec<String> = fields.iter().map(|field| format!("{{ field = \"{field}\" }}")).collect();
        format!("[[parameter]]\nname = \"{name}\"\nvalues = {values}\nset = [{}]\n", set.join(", "))
    };
    let swept = |parameters: &str, way: &str| {
        written(directory.path(), parameters);
        let output = vibrissa(directory.path(), &["study", "study.toml", "--out", way]);
        assert!(String::from_utf8_lossy(&output.stdout).contains(": 2 done, 0 stopped early, 0 refused"), "{output:?}");
        let rows = rows(&directory.path().join(way));
        let column = rows[0].iter().position(|column| column == "largest_moment").unwrap();
        [1, 2].map(|row| rows[row][column].parse::<f64>().unwrap())
    };
    let [none, rubs] = swept(&parameter("mu", "[0.0, 0.3]", &["contact.friction"]), "mu");
    assert!((rubs - none).abs() > 0.02 * none, "{none} {rubs}");
    let both = ["contact.friction.at_rest", "contact.friction.slipping"];
    assert_eq!(swept(&parameter("mu", "[0.0, 0.3]", &both), "laws"), [none, rubs]);
    let [soft, hard] = swept(&parameter("k", "[0.05, 1e9]", &["clamp.stiffness_phi"]), "k");
    assert!((hard - none).abs() < 1e-6 * none && (soft - none).abs() > 0.02 * none, "{soft} {hard}");
    // a name that no scene knows is refused with its place
    written(directory.path(), &parameter("mu", "[0.3]", &["contact.frction"]));
    let output = vibrissa(directory.path(), &["study", "study.toml", "--out", "no"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("did you mean `friction`?"), "{output:?}");
}
