//! `vibrissa reach`: what scans can touch.

use crate::common::vibrissa;
use std::fs;
use std::path::Path;

/// A row of outline.csv: object, from, to, how it is touched, and its ends.
type Part = (usize, f64, f64, String, f64, f64, f64, f64);

fn copied(directory: &Path, name: &str) {
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name), directory.join(name)).unwrap();
}

#[test]
fn each_part_of_the_outline_is_touched_in_one_way() {
    let directory = tempfile::tempdir().unwrap();
    copied(directory.path(), "O1_q40.toml");
    let arguments = ["reach", "O1_q40.toml", "--distances", "0.02:0.08:4", "--angles", "85,90,95"];
    let output = vibrissa(directory.path(), &arguments);
    assert!(output.status.success(), "{output:?}");
    let out = directory.path().join("out/O1_q40");
    let mut outline = csv::Reader::from_path(out.join("outline.csv")).unwrap();
    let rows: Vec<Part> = outline.deserialize().collect::<Result<_, _>>().unwrap();
    // one after the other without gaps, on both parabolas
    assert!(rows.windows(2).all(|pair| (pair[0].2 - pair[1].1).abs() < 1e-15), "{rows:?}");
    for (_, _, _, _, x, y, ..) in &rows {
        let height = 50.0 * x * x;
        assert!((y - height.min(50.0 * (x - 0.03) * (x - 0.03))).abs() < 1e-12);
    }
    // the notch
    let notch = rows.iter().find(|row| row.3 == "never" && row.4 < 0.015 && row.6 > 0.015).unwrap();
    assert!(notch.6 - notch.4 > 1e-3);
    let report: serde_json::Value = serde_json::from_slice(&fs::read(out.join("reach.json")).unwrap()).unwrap();
    let share = |name: &str| report[name].as_f64().unwrap();
    assert!((share("single") + share("several") + share("never") - 1.0).abs() < 1e-12);
    assert_eq!(csv::Reader::from_path(out.join("scans.csv")).unwrap().records().count(), 24);
    let figure = fs::read_to_string(out.join("reach.svg")).unwrap();
    assert!(figure.contains("several contacts only") && figure.ends_with("</svg>\n"));
    assert!(String::from_utf8_lossy(&output.stdout).contains("24 scans"));
}

#[test]
fn wrong_scans_are_named() {
    let directory = tempfile::tempdir().unwrap();
    copied(directory.path(), "O1_q40.toml");
    for (option, value, expected) in [
        ("--distances", "0.05,0.2", "distances has 0.2 m, expected more than 0 and less than the rod's length, 0.1 m"),
        ("--distances", "1:2", "expected from:to:count"),
        ("--angles", "-90", "from where object 0 has no nearest place"),
    ] {
        let output = vibrissa(directory.path(), &["reach", "O1_q40.toml", option, value]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message}");
    }
    let scene = fs::read_to_string(directory.path().join("O1_q40.toml")).unwrap();
    fs::write(directory.path().join("rubs.toml"), format!("{scene}\n[contact]\nfriction = 0.2\n")).unwrap();
    let output = vibrissa(directory.path(), &["reach", "rubs.toml"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("contact.friction") && message.contains("take it away"), "{message}");
}
