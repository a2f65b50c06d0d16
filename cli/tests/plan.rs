//! `vibrissa plan`: the next scans, and the precision that they will have, against recordings.

use crate::common::vibrissa;
use rod_files::{LargestStress, PlanRequest, Scene, read_known_contours, read_noise};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use vibrissa::plan::{Candidate, Measurement, PlanSettings, plan};
use vibrissa::reconstruct::Knowledge;

const NOISE: &str = "white = { force = 2.5e-3, m0z = 6e-5 }\n";

fn scene(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name)
}

/// Simulates a scan of a scene, reconstructs it into `name`, and returns whether that was done.
fn reconstructed(directory: &Path, file: &Path, noise: &str, seed: u64) -> bool {
    fs::write(directory.join("noise.toml"), noise).unwrap();
    let (scene, seed) = (file.to_str().unwrap(), seed.to_string());
    let recorded = vibrissa(
        directory,
        &["simulate", scene, "--noise", "noise.toml", "--speed", "10 mm/s", "--seed", &seed, "--file", "recording.csv"],
    );
    assert!(recorded.status.success(), "{recorded:?}");
    let arguments =
        ["reconstruct", "recording.csv", "--rod", scene, "--as-is", "--noise", "noise.toml", "--out", "found"];
    vibrissa(directory, &arguments).status.success()
}

/// Predicted standard deviations over those found at the same points: the lower quartile, the median and the upper quartile. The prediction knows the
/// contour of the reconstruction in `known`, and the path of the scene; those found are of the reconstruction in `found`.
fn ratios(known: &Path, found: &Path, file: &Path, noise: &Path) -> [f64; 3] {
    let scene = Scene::read(file).unwrap();
    let (known, found) = (read_known_contours(known).unwrap(), read_known_contours(found).unwrap());
    let request = PlanRequest {
        distances: None,
        angles: None,
        scans: Vec::new(),
        paths: Vec::new(),
        noise: None,
        rate: 500.0,
        speed: 0.01,
        count: 1,
        largest_stress: LargestStress::Any,
        hypotheses: 0,
        seed: 0,
    };
    let measurement = Measurement::of(
        &read_noise(noise).unwrap().channels(),
        request.speed / request.rate,
        &known,
        scene.rod.length(),
    );
    let settings =
        PlanSettings { hypotheses: 0, measurement: Some(measurement), speed: request.speed, ..PlanSettings::default() };
    let candidate = Candidate { scan: None, path: Arc::new(scene.path) };
    let plan = plan(&scene.rod, &known, &[candidate], &settings, &|_| true).unwrap();
    let hypothesis = &plan.hypotheses[0];
    let mut ratios = Vec::new();
    for (point, known) in found.iter().flat_map(|one| one.points.iter().zip(&one.known)) {
        let Knowledge::Touched { sigma } = *known else { continue };
        let distance = |one: &&vibrissa::plan::PlaceSigma| {
            let frame = hypothesis.outlines[one.object].frame(&hypothesis.objects[one.object], one.place);
            (frame.x - point[0]).hypot(frame.y - point[1])
        };
        let sigmas = &plan.forecasts[0].sigmas;
        let nearest = sigmas.iter().min_by(|one, other| distance(one).total_cmp(&distance(other)));
        if let Some(nearest) = nearest.filter(|one| distance(one) < measurement.resolution) {
            ratios.push(nearest.sigma / sigma);
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios.len() > 5, "{}", ratios.len());
    [0.25, 0.5, 0.75].map(|share| ratios[(share * (ratios.len() - 1) as f64) as usize])
}

#[test]
fn scans_are_chosen_and_their_precision_is_that_of_a_recording() {
    let directory = tempfile::tempdir().unwrap();
    let file = scene("O1_q40.toml");
    assert!(reconstructed(directory.path(), &file, NOISE, 1));
    let result = directory.path().join("found");
    let [_, median, _] = ratios(&result, &result, &file, &directory.path().join("noise.toml"));
    assert!((0.7..=1.4).contains(&median), "{median}");
    let arguments = [
        "plan",
        "found",
        "--rod",
        file.to_str().unwrap(),
        "--noise",
        "noise.toml",
        "--hypotheses",
        "2",
        "--angles",
        "60:120:3",
        "--distances",
        "0.03,0.06",
        "--paths",
        "scans.toml",
    ];
    let scans = "[[scan]]\ndistance = 0.05\nangle = 90\npass = \"left\"\n\n\
                 [[path]]\nfrom = [0.15, -0.03]\nangle = 90\npivot = [0.05, -0.03]\nturn = -30\n";
    fs::write(directory.path().join("scans.toml"), scans).unwrap();
    // the rod has a diameter, and no yield stress
    let output = vibrissa(directory.path(), &arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && message.contains("expected the yield_stress of its material"), "{message}");
    let output = vibrissa(directory.path(), &[arguments.as_slice(), &["--stress", "1.2e9"]].concat());
    assert!(output.status.success(), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("largest stress: 1200 MPa"), "{output:?}");
    let out = directory.path().join("out/plan");
    let record: serde_json::Value = serde_json::from_slice(&fs::read(out.join("plan.json")).unwrap()).unwrap();
    let chosen = record["chosen"].as_array().unwrap();
    let gains: Vec<f64> = chosen.iter().map(|one| one["gain"].as_f64().unwrap()).collect();
    assert!(!gains.is_empty() && gains.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12), "{gains:?}");
    assert_eq!(record["stress_limit"], 1.2e9);
    let mut table = csv::Reader::from_path(out.join("candidates.csv")).unwrap();
    let headers = table.headers().unwrap().clone();
    assert_eq!(headers.len(), 19);
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().unwrap();
    let column = |name: &str| headers.iter().position(|one| one == name).unwrap();
    assert_eq!(rows.len(), 14);
    // the given ones come first: the scan, and the arc that a pivot gives
    let row = |number: &str| rows.iter().find(|row| &row[0] == number).unwrap();
    assert_eq!((&row("0")[column("distance")], &row("1")[column("distance")]), ("0.05", ""));
    let end: [f64; 2] = ["x_to", "y_to"].map(|name| row("1")[column(name)].parse().unwrap());
    assert!((end[0] - (0.05 + 0.1 * 30_f64.to_radians().cos())).abs() < 1e-12 && (end[1] + 0.08).abs() < 1e-12);
    let stress = |row: &csv::StringRecord| row[column("largest_stress")].parse::<f64>().unwrap();
    assert!(rows.iter().filter(|row| !row[1].is_empty()).all(|row| stress(row) <= 1.2e9));
    assert!(fs::read_to_string(out.join("plan.svg")).unwrap().contains("hypotheses"));
}

#[test]
fn a_result_that_cannot_be_planned_from_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let file = scene("O1_q40.toml");
    let message = || {
        let output = vibrissa(directory.path(), &["plan", "found", "--rod", file.to_str().unwrap(), "--stress", "1e9"]);
        assert!(!output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    assert!(message().contains("fitted.csv") && message().contains("expected a directory of `vibrissa reconstruct`"));
    fs::create_dir(directory.path().join("found")).unwrap();
    let table = |row: &str| {
        let text = format!("object,x,y,known,sigma,room,vertex\n{row}\n");
        fs::write(directory.path().join("found/fitted.csv"), text).unwrap();
    };
    table("1,0.0,0.0,seen,,,false");
    assert!(message().contains("line 2: known is seen, expected touched, bounded or unknown"), "{}", message());
    table("1,0.0,0.0,touched,-1.0,,false");
    assert!(message().contains("line 2: sigma is -1, expected a number, 0 or larger, m"), "{}", message());
    table("1,0.0,0.0,unknown,,,false");
    assert!(message().contains("no point of the contour is touched or bounded"), "{}", message());
}

/// Scans from all sides, the clamp outside of the box and the tip in it, each from another side.
#[test]
fn an_object_in_a_box_is_approached() {
    let directory = tempfile::tempdir().unwrap();
    let file = scene("O1_q40.toml");
    let arguments = ["plan", "--box", "-0.06,0.0,0.06,0.12", "--rod", file.to_str().unwrap(), "--scans", "2"];
    let output = vibrissa(directory.path(), &arguments);
    assert!(!output.status.success());
    let output = vibrissa(directory.path(), &[arguments.as_slice(), &["--stress", "1.5e9"]].concat());
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("scan 2: ") && text.contains("those before it touched nothing"), "{text}");
    let out = directory.path().join("out/plan");
    let record: serde_json::Value = serde_json::from_slice(&fs::read(out.join("plan.json")).unwrap()).unwrap();
    let chosen = record["chosen"].as_array().unwrap();
    assert_eq!((chosen.len(), &record["box"]), (2, &serde_json::json!([[-0.06, 0.0], [0.06, 0.12]])));
    for scan in chosen {
        let number = |end: &str, k: usize| scan[end][k].as_f64().unwrap();
        // from far beyond the box on one side to far beyond it on the other
        let [dx, dy] = [0, 1].map(|k| number("to", k) - number("from", k));
        let way = dx.hypot(dy);
        assert!(way > 0.24, "{scan}");
        // all corners on the side of the rod
        let (sin, cos) = number("from", 2).sin_cos();
        for corner in [[-0.06, 0.0], [0.06, 0.0], [0.06, 0.12], [-0.06, 0.12]] {
            let ahead = (corner[0] - number("from", 0)) * cos + (corner[1] - number("from", 1)) * sin;
            assert!(ahead > 0.0, "{scan}");
        }
        // 1.5 GPa at the surface of the wire of 0.5 mm
        let moment = scan["stop_moment"].as_f64().unwrap();
        assert!((moment / (1.5e9 * std::f64::consts::PI * 0.5e-3_f64.powi(3) / 32.0) - 1.0).abs() < 1e-9);
    }
    assert!(fs::read_to_string(out.join("plan.svg")).unwrap().contains("box"));
}

/// The precision that is predicted from one reconstruction, against those of other recordings of the same scan.
#[test]
#[ignore = "minutes: prints the ratios of docs/plan.md"]
fn predicted_and_found_sigmas() {
    let names = std::env::var("SCENES").unwrap_or_else(|_| "O1_q20 O1_q40 O1_q60 O2_q40 O3_q40 O3_q60".into());
    for name in names.split_whitespace() {
        let file = scene(&format!("{name}.toml"));
        let directory = tempfile::tempdir().unwrap();
        let noise = directory.path().join("noise.toml");
        let mut first = None;
        for seed in 10..13 {
            if !reconstructed(directory.path(), &file, NOISE, seed) {
                println!("{name} seed {seed}: not explained");
                continue;
            }
            let own = directory.path().join(format!("found{seed}"));
            fs::rename(directory.path().join("found"), &own).unwrap();
            let known = first.get_or_insert_with(|| own.clone()).clone();
            println!("{name} seed {seed}: {:.2?}", ratios(&known, &own, &file, &noise));
        }
    }
}
