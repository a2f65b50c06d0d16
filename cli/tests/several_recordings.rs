//! Several recordings of one object, reconstructed together.

use crate::common::{SCENE, complaint, vibrissa};
use rod_files::Scene;
use serde_json::Value;
use std::fs;
use std::path::Path;
use vibrissa::Contour;

/// Contour points of a folder, and their standard deviations.
fn contour(out: &Path) -> Vec<([f64; 2], f64)> {
    let text = fs::read_to_string(out.join("contour.csv")).unwrap();
    let rows = text.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    rows.map(|row| ([2, 3].map(|k| row[k].parse().unwrap()), row[5].parse().unwrap())).collect()
}

#[test]
fn contours_of_several_recordings_become_one() {
    let directory = tempfile::tempdir().unwrap();
    let dir = directory.path();
    let run = |arguments: &[&str], status: i32| {
        let output = vibrissa(dir, arguments);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {}", complaint(&output));
        String::from_utf8(output.stdout.clone()).unwrap() + &complaint(&output)
    };
    fs::write(dir.join("noise.toml"), "[white]\nforce = 1e-5\nm0z = 1e-7\n").unwrap();
    // the second one is from nearer, and sees other parts of the object
    let near = SCENE.replace("-0.04]", "-0.035]");
    for (name, scene, recording) in [("a", SCENE, "a.csv"), ("b", &near, "b/a.csv")] {
        fs::create_dir_all(dir.join("b")).unwrap();
        fs::write(dir.join(format!("{name}.toml")), scene).unwrap();
        let scene = format!("{name}.toml");
        let noise = ["--noise", "noise.toml", "--rate", "500", "--speed", "0.02"];
        run(&[&["simulate", &scene, "--file", recording][..], &noise].concat(), 0);
    }
    let both = ["reconstruct", "a.csv", "b/a.csv", "--rod", "a.toml", "--as-is"];
    run(&[&both[..], &["--out", "out"]].concat(), 0);
    let out = dir.join("out");
    for file in ["a/points.jsonl", "a-2/points.jsonl", "a/report.json", "contour.svg"] {
        assert!(out.join(file).exists(), "{file}");
    }
    let (merged, [one, other]) = (contour(&out), ["a", "a-2"].map(|name| contour(&out.join(name))));
    let ends = |points: &[([f64; 2], f64)]| {
        points.iter().fold((f64::INFINITY, -f64::INFINITY), |(a, b), (p, _)| (a.min(p[0]), b.max(p[0])))
    };
    let (all, one, other) = (ends(&merged), ends(&one), ends(&other));
    assert!((all.0 - one.0.min(other.0)).abs() < 1e-6 && (all.1 - one.1.max(other.1)).abs() < 1e-6);
    let scene = Scene::read(&dir.join("a.toml")).unwrap();
    let gap = |p: [f64; 2]| scene.objects.iter().map(|o| o.closest(p[0], p[1]).gap.abs()).fold(f64::INFINITY, f64::min);
    let far = merged.iter().filter(|(p, sigma)| gap(*p) > 6.0 * sigma + 2e-6).count();
    assert!(20 * far <= merged.len(), "{far} of {} points are off the object", merged.len());

    let record = || serde_json::from_str::<Value>(&fs::read_to_string(out.join("merged.json")).unwrap()).unwrap();
    assert_eq!(
        (record()["scans"][1]["folder"].as_str(), record()["scans"][1]["offset"].as_f64()),
        (Some("a-2"), Some(0.0))
    );

    // the second one 0.4 mm too high: its scan and that of the first are moved onto each other
    let text = fs::read_to_string(dir.join("b/a.csv")).unwrap();
    fs::write(dir.join("b/a.csv"), text.replace(",-0.035,", ",-0.0346,")).unwrap();
    run(&[&both[..], &["--local", "--out", "out", "--align", "90"]].concat(), 0);
    let offsets = [0, 1].map(|k| record()["scans"][k]["offset"].as_f64().unwrap());
    assert!((offsets[0] - 2e-4).abs() < 1e-5 && (offsets[1] + 2e-4).abs() < 1e-5, "{offsets:?}");

    // one of another rod is left out
    let header = text.lines().find(|line| line.starts_with('t')).unwrap();
    let wrong = text.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if line != header
            && let Some(value) = cells.get(6).and_then(|cell| cell.parse::<f64>().ok())
        {
            cells[6] = (1e3 * value).to_string();
        }
        cells.join(",") + "\n"
    });
    fs::write(dir.join("b/a.csv"), wrong.collect::<String>()).unwrap();
    let said = run(&[&both[..], &["--local", "--out", "out"]].concat(), 2);
    assert!(said.contains("b/a.csv: ") && said.contains("no, left out"), "{said}");
    assert_eq!(
        (record()["scans"][0]["fits"].as_bool(), record()["scans"][1]["fits"].as_bool()),
        (Some(true), Some(false))
    );
    assert_eq!(contour(&out), contour(&out.join("a")));
}
