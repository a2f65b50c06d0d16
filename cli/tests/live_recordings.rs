//! Recordings of volts, played back through a calibration: the way from a table, TDMS or MCAP file to contact points, and what is
//! said where that cannot be.

use crate::common::{SCENE, complaint, vibrissa};
use crate::writer::{Endian, F64, Index, Object, segment};
use nalgebra::{Matrix6, Vector6};
use rod_files::{ReadOptions, Recording, Scene};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use vibrissa::hw::{AtiFile, Frame, Mounting, OutOfPlane};

const NOISE: &str = "[white]\nforce = 1e-5\nm0z = 1e-7\n";
const TARE: &str = "[tare]\nseconds = 0.1\n";

fn data(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../hw/tests").join(file)
}

/// Times, wrenches in N and N m, and the volts of the gauges of turned.cal that these are of.
struct Felt {
    directory: tempfile::TempDir,
    rows: Vec<(f64, [f64; 6], Vector6<f64>)>,
    matrix: Matrix6<f64>,
}

/// A noisy scan along the scene, in a directory with the scene and the calibration file.
fn felt() -> Felt {
    let directory = tempfile::tempdir().unwrap();
    let dir = directory.path();
    fs::write(dir.join("scene.toml"), SCENE).unwrap();
    fs::write(dir.join("noise.toml"), NOISE).unwrap();
    fs::copy(data("data/turned.cal"), dir.join("turned.cal")).unwrap();
    let output = vibrissa(
        dir,
        &["simulate", "scene.toml", "--noise", "noise.toml", "--rate", "1000", "--speed", "0.02", "--file", "felt.csv"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let scene = Scene::read(&dir.join("scene.toml")).unwrap();
    let recording = Recording::read(&dir.join("felt.csv"), scene.rod.at_clamp(), &ReadOptions::default()).unwrap();
    let file = AtiFile::read(&data("data/turned.cal")).unwrap();
    let matrix = file.calibration(None).unwrap().matrix::<6, f64>().unwrap();
    let matrix = Matrix6::from_fn(|i, j| matrix.rows()[i][j]);
    let inverse = matrix.try_inverse().unwrap();
    let mounting = Mounting::new(Frame::same());
    let rows = recording.samples().map(|sample| {
        let wrench = mounting.wrench(&sample.reactions, &OutOfPlane::default(), sample.pose).components();
        (sample.t.unwrap(), wrench, inverse * Vector6::from(wrench))
    });
    Felt { rows: rows.collect(), directory, matrix }
}

/// Listens to a recording with a setup, and returns what it said, label and contact point of each sample, and the summary.
type Heard = (String, Vec<(Option<String>, [Option<f64>; 2])>, Value);

fn listen(directory: &Path, file: &str, setup: &str, arguments: &[&str]) -> Heard {
    fs::write(directory.join("setup.toml"), format!("{setup}\n{TARE}")).unwrap();
    let sensor = format!("file:{file}");
    let always = ["live", "--sensor", &sensor, "--rod", "scene.toml", "--setup", "setup.toml", "--out", "out"];
    let output = vibrissa(directory, &[&always, arguments].concat());
    let said = String::from_utf8(output.stdout.clone()).unwrap() + &complaint(&output);
    let read = |name: &str| fs::read_to_string(directory.join("out").join(name)).unwrap_or_else(|_| panic!("{said}"));
    let points = read("points.jsonl");
    let points = points.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    let points =
        points.map(|point| (point["label"].as_str().map(str::to_owned), [point["x"].as_f64(), point["y"].as_f64()]));
    let (points, summary) = (points.collect(), serde_json::from_str(&read("summary.json")).unwrap());
    (said, points, summary)
}

fn same(found: &Heard, expected: &Heard) {
    assert_eq!(found.1.len(), expected.1.len(), "{}", found.0);
    let mut points = 0;
    for (k, (found, expected)) in found.1.iter().zip(&expected.1).enumerate() {
        assert_eq!(found.0, expected.0, "{k}");
        for (found, expected) in found.1.iter().zip(expected.1) {
            assert_eq!(found.is_some(), expected.is_some(), "{k}");
            if let (Some(found), Some(expected)) = (found, expected) {
                // the estimate of shared errors ends within 1e-4 of what is known of them before
                assert!((found - expected).abs() < 1e-8, "{k}: {found} {expected}");
                points += 1;
            }
        }
    }
    assert!(points > found.1.len(), "{points} coordinates of {} samples", found.1.len());
}

/// The volts as a TDMS file.
fn tdms(rows: &[(f64, [f64; 6], Vector6<f64>)]) -> Vec<u8> {
    let mut objects = vec![Object::new("/'Measured'/'Time'", Index::Values(F64, rows.len() as u64))];
    let mut raw = Endian::Little.f64s(&rows.iter().map(|row| row.0).collect::<Vec<_>>());
    for (i, path) in [
        "/'Measured'/'Ai0'",
        "/'Measured'/'Ai1'",
        "/'Measured'/'Ai2'",
        "/'Measured'/'Ai3'",
        "/'Measured'/'Ai4'",
        "/'Measured'/'Ai5'",
    ]
    .iter()
    .enumerate()
    {
        objects.push(Object::new(path, Index::Values(F64, rows.len() as u64)).with(
            Endian::Little,
            "wf_increment",
            1e-3,
        ));
        raw.extend(Endian::Little.f64s(&rows.iter().map(|row| row.2[i]).collect::<Vec<_>>()));
    }
    segment(Endian::Little, 0, &objects, &raw)
}

const STAGE: [&str; 2] = ["--stage", "constant:0.02"];

#[test]
fn volts_give_the_points_of_the_wrench() {
    let Felt { directory, rows, matrix } = felt();
    let dir = directory.path();
    let mut wrenches = "t [s],Fx [N],Fy [N],Fz [N],Tx [N m],Ty [N m],Tz [N m]\n".to_owned();
    // times without a unit, decimal commas, columns in another order
    let mut volts = "Zeit;Ai5;Ai4;Ai3;Ai2;Ai1;Ai0;Temp\n".to_owned();
    for (t, [fx, fy, fz, tx, ty, tz], v) in &rows {
        wrenches += &format!("{t},{fx},{fy},{fz},{tx},{ty},{tz}\n");
        volts += &format!("{t};{};{};{};{};{};{};21\n", v[5], v[4], v[3], v[2], v[1], v[0]).replace('.', ",");
    }
    fs::write(dir.join("wrench.csv"), wrenches).unwrap();
    fs::write(dir.join("volts.csv"), volts).unwrap();
    let expected = listen(dir, "wrench.csv", "", &STAGE);
    assert_eq!((expected.1.len(), &expected.2["end"]), (rows.len(), &Value::from("source")));

    let columns = "columns = ['Ai0', 'Ai1', 'Ai2', 'Ai3', 'Ai4', 'Ai5']";
    let of_file = format!("[sensor]\ncalibration = 'turned.cal'\n[recording]\ntime = 'Zeit'\n{columns}");
    let written = ["--unit", "Zeit=s", "--decimal", "comma", "--delimiter", "semicolon"];
    same(&listen(dir, "volts.csv", &of_file, &[&STAGE[..], &written].concat()), &expected);

    // the same matrix as rows; a stage from a table that is written like the recording
    let rows_of = |factor: f64, from: usize| {
        (from..from + 3)
            .map(|i| format!("{:?}", (0..6).map(|j| matrix[(i, j)] / factor).collect::<Vec<_>>()))
            .collect::<Vec<_>>()
    };
    let all = [rows_of(1.0, 0), rows_of(1e-3, 3)].concat().join(", ");
    let of_rows = format!(
        "[sensor]\nforce_unit = 'N'\ntorque_unit = 'N mm'\ncomponents = ['Fx', 'Fy', 'Fz', 'Tx', 'Ty', 'Tz']\nmatrix = [{all}]\n\
         [recording]\n{columns}\ntime = 'Zeit'"
    );
    let t = rows.last().unwrap().0;
    let stage = format!(
        "Zeit;x0;y0;phi0\n{};0,07;-0,04;{p}\n{};0,03;-0,04;{p}\n",
        rows[0].0,
        rows[0].0 + 2.0,
        p = std::f64::consts::FRAC_PI_2
    )
    .replace('.', ",");
    assert!(t <= rows[0].0 + 2.0);
    fs::write(dir.join("stage.csv"), stage).unwrap();
    let table = ["--stage", "table:stage.csv", "--column", "t=Zeit"];
    same(&listen(dir, "volts.csv", &of_rows, &[&table[..], &written].concat()), &expected);

    fs::write(dir.join("volts.tdms"), tdms(&rows)).unwrap();
    for time in ["time = 'Time'", "time = 'waveform'", "time = { rate = 1000 }", ""] {
        let setup = of_file.replace("time = 'Zeit'", time) + "\ngroup = 'Measured'";
        same(&listen(dir, "volts.tdms", &setup, &STAGE), &expected);
    }
}

/// Checks that `live` with this recording and setup fails like this.
fn refuses(file: &Path, setup: &str, parts: &[&str]) {
    let directory = tempfile::tempdir().unwrap();
    let dir = directory.path();
    fs::write(dir.join("scene.toml"), SCENE).unwrap();
    fs::write(dir.join("setup.toml"), setup).unwrap();
    let name = file.file_name().unwrap();
    fs::copy(file, dir.join(name)).unwrap();
    let sensor = format!("file:{}", name.to_string_lossy());
    let always = ["live", "--sensor", &sensor, "--rod", "scene.toml", "--setup", "setup.toml"];
    let output = vibrissa(dir, &[&always[..], &STAGE].concat());
    let message = complaint(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    for part in parts {
        assert!(message.contains(part), "{part}: {message}");
    }
}

#[test]
fn what_of_a_recording_is_meant_must_be_said() {
    let tdms = data("../tdms/tests/vectors/waveforms.tdms");
    let choose =
        "waveforms.tdms: expected group = .. in the table [recording] of a setup (--setup FILE), of those there are: ";
    refuses(&tdms, "", &[choose, "`Measured`"]);
    refuses(&tdms, "[recording]\ngroup = 'measured'", &[choose, "`Measured`"]);
    refuses(&tdms, "[recording]\ngroup = 'Measured'", &["waveforms.tdms: expected columns = ..", "`Fx`, `Fy`"]);
    let of = |columns: &str| format!("[recording]\ngroup = 'Measured'\ncolumns = [{columns}]\n");
    refuses(
        &tdms,
        &of("'Fx', 'Fw'"),
        &["file:waveforms.tdms: no channel `Fw` in group `Measured`; there are `Fx` in `Measured`"],
    );
    refuses(
        &tdms,
        &of("'Fx', 'Fy'"),
        &["file:waveforms.tdms: the units of its numbers are unknown", "calibration or matrix"],
    );
    let scale = "[sensor]\nforce_unit = 'mN'\ntorque_unit = 'N m'\nchannels = ['Fx', 'Fy']\n";
    refuses(&tdms, &(of("'Fx', 'Fy'") + scale), &["samples before the end, expected at least 100"]);
    // as many columns as nothing is for
    refuses(&tdms, &(of("'Fx'") + scale), &["0 samples before the end", "expected 2"]);

    let mcap = data("vectors/wrench.mcap");
    refuses(&mcap, "", &["wrench.mcap: expected topic = ..", "`/ft_sensor/wrench` of geometry_msgs/msg/WrenchStamped"]);
    refuses(&mcap, "[recording]\ntopic = '/ft'", &["file:wrench.mcap: no topic `/ft`; there are"]);
    refuses(&mcap, "[recording]\ntopic = '/ft_sensor/wrench'", &["2 samples before the end, expected at least 100"]);
    let calibrated = format!("{scale}[recording]\ntopic = '/ft_sensor/wrench'");
    refuses(&mcap, &calibrated, &["wrench.mcap: its wrenches are in N and N m already"]);
    refuses(&data("vectors/zstd.mcap"), "", &["zstd.mcap: expected topic", "none (the chunk at byte", "zstd"]);

    let directory = tempfile::tempdir().unwrap();
    let table = |text: &str| {
        let file = directory.path().join("t.csv");
        fs::write(&file, text).unwrap();
        file
    };
    refuses(
        &table("t,a,b\n0,1,2\n1,2,3\n"),
        "",
        &["t.csv:1: found t, a, b; expected times and reactions", "columns = [..]"],
    );
    refuses(
        &table("t,a,b\n0,1,2\n1,2,3\n"),
        "[recording]\ncolumns = ['a', 'c']",
        &["t.csv:1: no column `c`, found t, a, b"],
    );
    refuses(&table("t,a,b\n0,1,2\n1,2,3\n"), "[recording]\ntime = { rate = 3 }", &["t.csv: a rate is for TDMS files"]);
    refuses(&table("t,Fx,Fy,Fz,Tx,Ty,Tz\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n"), "", &["t.csv:1: no unit of Fx"]);
    fs::write(directory.path().join("no.tdms"), "RIFF").unwrap();
    refuses(&directory.path().join("no.tdms"), "", &["file:no.tdms: the file begins with", "is it a TDMS file?"]);
}

#[test]
fn gauges_cannot_be_played() {
    let directory = tempfile::tempdir().unwrap();
    let dir = directory.path();
    fs::write(dir.join("scene.toml"), SCENE).unwrap();
    fs::write(dir.join("setup.toml"), "[sensor]\ncalibration = 'turned.cal'").unwrap();
    fs::copy(data("data/turned.cal"), dir.join("turned.cal")).unwrap();
    let output =
        vibrissa(dir, &["fake-sensor", "scene.toml", "--protocol", "rdt", "--setup", "setup.toml", "--port", "0"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        complaint(&output).contains("a calibration from gauges to a wrench, which has no inverse"),
        "{}",
        complaint(&output)
    );
}

/// Labels and contact points in the points.jsonl of `reconstruct`.
fn points(out: &Path) -> Vec<(Option<String>, [Option<f64>; 2])> {
    let text = fs::read_to_string(out.join("points.jsonl")).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
    lines.map(|line| (line["label"].as_str().map(str::to_owned), [line["x"].as_f64(), line["y"].as_f64()])).collect()
}

/// `reconstruct` takes volts by the way of `live`: tare, calibration, stage.
#[test]
fn volts_are_reconstructed_as_the_reactions_that_they_are_of() {
    let Felt { directory, rows, .. } = felt();
    let dir = directory.path();
    fs::write(dir.join("volts.tdms"), tdms(&rows)).unwrap();
    let setup = |first: &str| {
        format!(
            "[sensor]\ncalibration = 'turned.cal'\n[recording]\ngroup = 'Measured'\ncolumns = ['{first}', 'Ai1', 'Ai2', 'Ai3', \
             'Ai4', 'Ai5']\n{TARE}"
        )
    };
    fs::write(dir.join("setup.toml"), setup("Ai0")).unwrap();
    fs::write(dir.join("wrong.toml"), setup("Ai9")).unwrap();
    let run = |file: &str, arguments: &[&str]| {
        let always = ["reconstruct", file, "--rod", "scene.toml", "--as-is"];
        vibrissa(dir, &[&always[..], arguments].concat())
    };
    let output = run("felt.csv", &["--out", "of_reactions"]);
    assert!(matches!(output.status.code(), Some(0 | 2)), "{}", complaint(&output));
    let status = output.status.code();
    let output = run("volts.tdms", &[&["--setup", "setup.toml", "--out", "of_volts"], &STAGE[..]].concat());
    assert_eq!(output.status.code(), status, "{}", complaint(&output));
    let (found, expected) = (points(&dir.join("of_volts")), points(&dir.join("of_reactions")));
    assert_eq!(found.len(), rows.len());
    let (mut same, mut near, mut all) = (0, 0, 0);
    for (found, expected) in found.iter().zip(&expected) {
        same += usize::from(found.0 == expected.0);
        if let (([Some(x), Some(y)], [Some(u), Some(v)]), true) = ((found.1, expected.1), found.0 == expected.0) {
            all += 1;
            near += usize::from((x - u).hypot(y - v) < 1e-4);
        }
    }
    assert!(100 * same > 99 * rows.len() && all > rows.len() / 3 && 100 * near > 99 * all, "{same} {all} {near}");

    for (arguments, parts) in [
        (&["--setup", "setup.toml"][..], &["file:volts.tdms: the poses of the clamp are missing; give --stage"][..]),
        (&STAGE[..], &["volts.tdms: expected group = .. in the table [recording] of a setup", "`Measured`"]),
        (
            &["--setup", "wrong.toml", "--stage", "constant:0.02"],
            &["file:volts.tdms: no channel `Ai9` in group `Measured`; there are"],
        ),
    ] {
        let output = run("volts.tdms", arguments);
        assert_eq!(output.status.code(), Some(1), "{}", complaint(&output));
        parts.iter().for_each(|part| assert!(complaint(&output).contains(part), "{part}: {}", complaint(&output)));
    }
    let output = run("felt.csv", &STAGE);
    assert!(complaint(&output).contains("felt.csv: its rows have poses of the clamp, expected no --stage"));
}
