//! Rods without contacts: the files of the documentation, what is written, and mistakes.

use crate::common::{complaint, vibrissa};
use rod_files::ElasticaScene;
use std::fs;
use std::path::Path;

const COLUMN: &str = "branches = \"all\"\npoints = 11\n[rod]\nlength = 0.1\nbending_stiffness = 6.3e-4\n\
                      [clamp]\nangle = 90.0\n[tip]\nforce = [0.0, -0.1865]\n";

fn run(text: &str) -> (tempfile::TempDir, std::process::Output) {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("column.toml"), text).unwrap();
    let output = vibrissa(directory.path(), &["elastica", "column.toml"]);
    (directory, output)
}

#[test]
fn a_column_is_written_as_json_table_and_figure() {
    let (directory, output) = run(COLUMN);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.starts_with("column: 3 equilibria found\n") && said.contains("no (1)"), "{said}");
    let out = directory.path().join("out/column");
    let json: serde_json::Value = serde_json::from_slice(&fs::read(out.join("elastica.json")).unwrap()).unwrap();
    let all = json["equilibria"].as_array().unwrap();
    assert!(all.len() == 3 && json["found"] == 3 && all[0]["stable"] == true && all[2]["stable"] == false);
    assert_eq!(all[1]["tip"]["fy"].as_f64(), Some(-0.1865));
    assert!((all[0]["m0z"].as_f64().unwrap() + all[1]["m0z"].as_f64().unwrap()).abs() < 1e-14);
    let mut table = csv::Reader::from_path(out.join("shapes.csv")).unwrap();
    assert_eq!(table.headers().unwrap(), vec!["branch", "s", "x", "y", "phi", "kappa", "moment"]);
    let rows: Vec<(usize, f64, f64, f64, f64, f64, f64)> = table.deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 33);
    assert!(rows.iter().all(|row| (row.5 * 6.3e-4 - row.6).abs() < 1e-15));
    let figure = fs::read_to_string(out.join("elastica.svg")).unwrap();
    assert_eq!(figure.matches("stroke-dasharray").count(), 1);
    assert!(figure.contains("column: equilibria") && !figure.contains("NaN"));
    let (_, output) = run(&COLUMN.replace("\"all\"", "1"));
    assert!(
        String::from_utf8(output.stdout).unwrap().starts_with("column: 3 equilibria found; 1 shown, see `branches`\n")
    );
}

#[test]
fn a_clamped_tip_has_a_plate_as_the_clamp_has() {
    // a plate and its five strokes
    let lines = |text: &str| {
        let (directory, output) = run(text);
        assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
        let figure = fs::read_to_string(directory.path().join("out/column/elastica.svg")).unwrap();
        figure.matches("stroke=\"#000000\" stroke-width=\"2\"").count()
    };
    assert_eq!(lines(COLUMN), 6);
    assert_eq!(lines(&COLUMN.replace("force = [0.0, -0.1865]", "place = [0.03, 0.07]")), 6);
    assert_eq!(lines(&COLUMN.replace("force = [0.0, -0.1865]", "place = [0.03, 0.07]\nangle = 90.0")), 12);
}

#[test]
fn mistakes_name_their_place_and_write_nothing() {
    for (from, to, message) in [
        ("[0.0, -0.1865]", "[0.0, -999]", "column.toml:9:9: tip.force: the forces add up to 999.0 N, expected at most"),
        (
            "angle = 90.0",
            "angle = 1.5708",
            "warning: column.toml:7:9: clamp.angle: angle is 1.5708 degrees; is 90 degrees meant?",
        ),
        (
            "force = [0.0, -0.1865]",
            "place = [0.0, 0.1]",
            "column.toml:9:9: tip.place: place is (0.0, 0.1) m, 0.1 m from the clamp",
        ),
    ] {
        assert!(COLUMN.contains(from));
        let (directory, output) = run(&COLUMN.replace(from, to));
        assert!(complaint(&output).contains(message), "{}", complaint(&output));
        assert_eq!(directory.path().join("out").exists(), message.starts_with("warning"));
    }
}

#[test]
fn the_files_of_the_documentation_can_be_solved() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/elastica.md")).unwrap();
    let blocks: Vec<&str> = page.split("```toml\n").skip(1).filter_map(|block| block.split("```").next()).collect();
    assert_eq!(blocks.len(), 2);
    for block in blocks {
        let run = ElasticaScene::parse("elastica.md".as_ref(), block).unwrap().solve().unwrap();
        assert!(run.equilibria[0].stable && run.scene.warnings.is_empty(), "{block}");
    }
}
