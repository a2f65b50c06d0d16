//! The contour of a scene as points, and its drawing.

use crate::common::{SCENE, complaint, vibrissa, with_objects};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fs;
use std::path::Path;

/// Length of the rod of all scenes here, m.
const LENGTH: f64 = 0.1;

/// A row of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    x: f64,
    y: f64,
    alpha: f64,
    curvature: f64,
    arc_length: f64,
    object: usize,
}

fn rows(file: &Path) -> Vec<Row> {
    let mut table = csv::Reader::from_path(file).unwrap();
    let header: Vec<_> = table.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(header, ["x", "y", "tangent_angle", "curvature", "arc_length", "object"]);
    table
        .deserialize()
        .map(|row| {
            let (x, y, alpha, curvature, arc_length, object): (f64, f64, f64, f64, f64, usize) = row.unwrap();
            assert!([x, y, alpha, curvature, arc_length].iter().all(|number| number.is_finite()));
            Row { x, y, alpha, curvature, arc_length, object }
        })
        .collect()
}

/// The contour of a scene, with further arguments.
fn contour(scene: &str, arguments: &[&str]) -> Vec<Row> {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), scene).unwrap();
    let output = vibrissa(directory.path(), &[&["contour", "scene.toml", "--file", "here.csv"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let drawing = fs::read_to_string(directory.path().join("here.svg")).unwrap();
    assert!(drawing.contains("x in mm") && drawing.trim_end().ends_with("</svg>"));
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 3, "no stage is left behind");
    rows(&directory.path().join("here.csv"))
}

fn distance(one: &Row, other: &Row) -> f64 {
    (one.x - other.x).hypot(one.y - other.y)
}

/// What holds for every contour: arc lengths are those of the chords and a little more, no two neighbours are one point.
fn check(rows: &[Row]) {
    for pair in rows.windows(2).filter(|pair| pair[0].object == pair[1].object) {
        let (chord, arc) = (distance(&pair[0], &pair[1]), pair[1].arc_length - pair[0].arc_length);
        assert!(chord > 0.0 && arc > 0.0, "{pair:?}");
        // At a vertex the way goes once there and once on.
        let corner = arc < 3e-9 * LENGTH;
        assert!(corner || (arc - chord).abs() < 1e-4 * arc, "{pair:?}");
    }
}

fn closed(rows: &[Row]) -> bool {
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    (first.x, first.y) == (last.x, last.y)
}

#[test]
fn a_parabola_ends_where_the_rod_does_not_reach() {
    let rows =
        contour(&with_objects("[[contour.piece]]\nshape = \"parabola\"\nvertex = [0.05, 0.0]\ncoefficient = 50"), &[]);
    check(&rows);
    assert!(!closed(&rows) && rows.windows(2).all(|pair| pair[0].x < pair[1].x));
    let arc_length = |t: f64| {
        let slope = 100.0 * t;
        0.5 * (t * slope.hypot(1.0) + slope.asinh() / 100.0)
    };
    for row in &rows {
        let t = row.x - 0.05;
        let stretch = 1.0 + 1e4 * t * t;
        assert!((row.y - 50.0 * t * t).abs() < 1e-16);
        assert!((row.alpha - (100.0 * t).atan()).abs() < 1e-15);
        assert!((row.curvature - 100.0 / stretch.powf(1.5)).abs() < 1e-13);
        let from_first = arc_length(t) - arc_length(rows[0].x - 0.05);
        assert!((row.arc_length - from_first).abs() < 1e-14, "{} {from_first}", row.arc_length);
    }
    for pair in rows.windows(2) {
        // Where the tangent is that of the chord the parabola is farthest from it.
        let width = pair[1].x - pair[0].x;
        let slope = (pair[1].y - pair[0].y) / width;
        let sagitta = 50.0 * width * width / 4.0 / slope.hypot(1.0);
        assert!(sagitta <= 1e-6 * LENGTH, "{sagitta}");
    }
    // The path leads from (0.07, -0.04) to (0.03, -0.04).
    for (end, clamp) in [(rows[0], 0.03), (rows[rows.len() - 1], 0.07)] {
        assert!(((end.x - clamp).hypot(end.y + 0.04) - 1.5 * LENGTH).abs() < 1e-12);
    }
}

#[test]
fn a_square_has_two_points_at_each_corner() {
    let points = "points = [[0, 0], [0.01, 0], [0.01, 0.01], [0, 0.01]]";
    let rows = contour(&with_objects(&format!("[[object]]\n[[object.piece]]\nshape = \"polygon\"\n{points}")), &[]);
    check(&rows);
    assert!(closed(&rows));
    assert_eq!(rows.len(), 9);
    let aside = 1e-9 * LENGTH;
    for (side, pair) in rows.chunks_exact(2).enumerate() {
        assert!(pair.iter().all(|row| (row.alpha - side as f64 * FRAC_PI_2).abs() < 1e-15 && row.curvature == 0.0));
        assert!((distance(&pair[0], &pair[1]) - (0.01 - 2.0 * aside)).abs() < 1e-17);
    }
    assert!((rows[0].x - aside).abs() < 1e-22 && rows[0].y == 0.0);
    assert!((rows[1].x - (0.01 - aside)).abs() < 1e-17 && (rows[2].y - aside).abs() < 1e-17);
    let last = rows[8];
    assert!((last.arc_length - 0.04).abs() < 1e-16 && (last.alpha - TAU).abs() < 1e-15);
}

#[test]
fn a_circle_comes_back_to_its_first_point() {
    let circle = "shape = \"arc\"\ncenter = [0.02, 0.0]\nradius = 0.01\nfrom_angle = -90\nto_angle = 270";
    let scene = with_objects(&format!("[[object]]\nposition = [0.0, 0.03]\n[[object.piece]]\n{circle}"));
    for tolerance in [1e-7, 1e-9] {
        let rows = contour(&scene, &["--tolerance", &tolerance.to_string()]);
        check(&rows);
        assert!(closed(&rows));
        for row in &rows {
            let (dx, dy) = (row.x - 0.02, row.y - 0.03);
            assert!((dx.hypot(dy) - 0.01).abs() < 1e-16);
            assert!((row.curvature - 100.0).abs() < 1e-12);
            assert!((row.arc_length - 0.01 * row.alpha).abs() < 1e-15, "{row:?}");
        }
        let last = rows[rows.len() - 1];
        assert!((last.alpha - TAU).abs() < 1e-15 && (last.arc_length - 0.01 * TAU).abs() < 1e-15);
        let longest = rows.windows(2).map(|pair| distance(&pair[0], &pair[1])).fold(0.0, f64::max);
        let sagitta = 0.01 - (1e-4 - 0.25 * longest * longest).sqrt();
        // Close enough, and not much closer.
        assert!(sagitta <= tolerance && sagitta > 0.05 * tolerance, "{sagitta}");
    }
}

#[test]
fn a_hole_is_walked_the_other_way() {
    let circle = "shape = \"arc\"\ncenter = [0.0, 0.0]\nradius = 0.01\nfrom_angle = 0\nto_angle = 360";
    let scene = with_objects(&format!("[[object]]\nreversed = true\nhollow = true\n[[object.piece]]\n{circle}"));
    let rows = contour(&scene, &[]);
    check(&rows);
    assert!(closed(&rows) && rows.iter().all(|row| (row.curvature + 100.0).abs() < 1e-12));
    assert!((rows[rows.len() - 1].alpha - rows[0].alpha + TAU).abs() < 1e-15);
}

#[test]
fn objects_are_told_apart_and_may_be_asked_for() {
    let line = |x: f64| {
        format!(
            "[[object]]\nposition = [{x}, 0.0]\n[[object.piece]]\nshape = \"line\"\nfrom = [0, 0]\nto = [0.01, 0]\n"
        )
    };
    let scene = with_objects(&(line(0.0) + &line(0.5)));
    let rows = contour(&scene, &[]);
    assert_eq!(rows.iter().map(|row| row.object).collect::<Vec<_>>(), [0, 0, 1, 1]);
    assert_eq!((rows[2].x, rows[2].arc_length), (0.5, 0.0));
    assert_eq!(contour(&scene, &["--object", "1"]), rows[2..]);
}

#[test]
fn a_notch_and_smooth_joints() {
    let rows = contour(SCENE, &[]);
    check(&rows);
    let notch = rows.windows(2).find(|pair| pair[1].alpha < pair[0].alpha - 0.5).unwrap();
    assert!((notch[0].x - 0.015).abs() < 1e-10 && distance(&notch[0], &notch[1]) < 3e-9 * LENGTH);
    // A line that goes on as an arc: one point where they meet.
    let line = "[[contour.piece]]\nshape = \"line\"\nfrom = [-0.01, 0]\nto = [0, 0]\n";
    let arc = "[[contour.piece]]\nshape = \"arc\"\ncenter = [0, 0.01]\nradius = 0.01\nfrom_angle = -90\nto_angle = 0\n";
    let rows = contour(&with_objects(&format!("{line}{arc}")), &[]);
    check(&rows);
    assert_eq!(rows.iter().filter(|row| row.x == 0.0).count(), 1);
}

#[test]
fn by_default_it_goes_to_the_directory_of_the_scene() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let output = vibrissa(directory.path(), &["contour", "scene.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("scene: object 0: ") && said.contains("out/scene/contour.svg"), "{said}");
    assert!(!rows(&directory.path().join("out/scene/contour.csv")).is_empty());
}

#[test]
fn requests_that_cannot_be_met() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let refused = |arguments: &[&str]| {
        let output = vibrissa(directory.path(), &[&["contour", "scene.toml"], arguments].concat());
        assert_eq!(output.status.code(), Some(2));
        complaint(&output)
    };
    let message = refused(&["--tolerance", "0"]);
    assert!(message.contains("--tolerance is 0 m, expected at least 1e-13 m"), "{message}");
    assert!(refused(&["--tolerance=-1"]).contains("--tolerance is -1 m, expected"));
    let message = refused(&["--object", "1"]);
    assert!(message.contains("--object is 1, expected a number from 0 to 0: the scene has 1"), "{message}");
    assert!(refused(&["--object", "-1"]).contains("expected a whole number, 0 or larger"));
    let message = refused(&["--tolerance", "1.1e-13"]);
    assert!(message.contains("more than 1000000 points") && message.contains("larger --tolerance"), "{message}");
    let message = refused(&["--out", "drawing.svg"]);
    assert!(message.contains("drawing.svg is no name for a CSV file"), "{message}");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1, "nothing is written");
}
