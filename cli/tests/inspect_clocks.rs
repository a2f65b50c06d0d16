//! A sensor and a stage whose clocks do not begin together: `inspect` asks, and the physics proposes the delay where it can.

use crate::common::{complaint, vibrissa};
use crate::inspect::{inspected, questions, recording, runs, words};
use crate::writer::{Endian, F64, Index, Object, segment};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Rest before and after the motion on the sensor's clock, s.
const REST: [f64; 2] = [2.5, 3.0];
/// Standard deviations of forces, N, and moment, N m.
const NOISE: [f64; 2] = [2.5e-3, 6e-5];

/// The recording of a sensor without noise.
fn two_files(directory: &Path, start: f64) {
    two_noisy_files(directory, start, REST, &mut || 0.0);
}

/// The recording of a sensor that begins before the stage moves and ends after it stopped in contact, and the log of the stage, whose clock begins at
/// the time `start` of the sensor's.
fn two_noisy_files(directory: &Path, start: f64, rest: [f64; 2], normal: &mut impl FnMut() -> f64) {
    let rows = recording();
    // a pose at which the rod is in contact
    let last = rows.iter().rposition(|row| row[4].hypot(row[5]) > 0.1).unwrap();
    let motion = &rows[..=last];
    let end = motion[last][0] + rest[0];
    let at = |t: f64| motion[((t - rest[0]) / 0.01).round().clamp(0.0, last as f64) as usize];
    let mut sensor = "t [s],Fx [N],Fy [N],Fz [N],Tx [N m],Ty [N m],Tz [N m]\n".to_owned();
    for k in 0..((end + rest[1]) / 0.01) as usize {
        let t = 0.01 * k as f64;
        let [_, _, _, _, fx, fy, mz] = at(t);
        let [fx, fy, mz] = [fx + NOISE[0] * normal(), fy + NOISE[0] * normal(), mz + NOISE[1] * normal()];
        let _ = writeln!(sensor, "{t:.2},{},{},0,0,0,{}", -fx, -fy, -mz);
    }
    let mut stage = "t,x0,y0,phi0\n".to_owned();
    for k in 0..((end + 0.5 - start) / 0.05) as usize {
        let t = 0.05 * k as f64;
        let [_, x, y, phi, ..] = at(start + t);
        let _ = writeln!(stage, "{t:.2},{x},{y},{phi}");
    }
    fs::write(directory.join("force.csv"), sensor).unwrap();
    fs::write(directory.join("stage.csv"), stage).unwrap();
}

const FILES: [&str; 4] = ["force.csv", "stage.csv", "--rod", "rod.toml"];

/// The delay that the question proposes first, s.
fn proposed(asked: &str) -> f64 {
    let (_, rest) = asked.split_once("--stage-delay '").unwrap_or_else(|| panic!("{asked}"));
    rest.split_once(" s'").unwrap().0.parse().unwrap()
}

/// The stage's clock begins 1.7 s after that of the sensor, and both begin at 0: the object was shifted by 3.4 mm.
#[test]
fn clocks_that_begin_apart_are_a_question() {
    let directory = tempfile::tempdir().unwrap();
    two_files(directory.path(), 1.7);
    let (found, status) = inspected(directory.path(), &FILES);
    let asked = questions(&found);
    assert!(status == 2 && asked.contains("how are the clocks of the sensor and of the stage related?"), "{found:#}");
    let delay = proposed(&asked);
    assert!((delay - 1.7).abs() < 0.05, "{delay}: {asked}");
    let answer = ["--stage-delay", "1.7 s", "--write-setup", "sensor.toml"];
    let (found, status) = inspected(directory.path(), &[&FILES[..], &answer].concat());
    assert!(status == 0 && words(&found).contains("--stage-delay 1.7 s"), "{found:#}");
    runs(directory.path(), &found);
}

#[test]
fn clocks_that_the_physics_confirms_are_no_question() {
    let directory = tempfile::tempdir().unwrap();
    two_files(directory.path(), 0.0);
    let (found, status) = inspected(directory.path(), &[&FILES[..], &["--write-setup", "sensor.toml"]].concat());
    assert!(status == 0 && questions(&found).is_empty(), "{found:#}");
}

/// Times since 1970 and a log that begins at 0 have no time in common.
#[test]
fn clocks_without_a_common_time_are_a_question() {
    let directory = tempfile::tempdir().unwrap();
    two_files(directory.path(), 0.0);
    let text = fs::read_to_string(directory.path().join("force.csv")).unwrap();
    let shifted: String = text
        .lines()
        .map(|line| match line.split_once(',') {
            Some((t, rest)) if t.parse::<f64>().is_ok() => format!("{:.2},{rest}\n", 1.7e9 + t.parse::<f64>().unwrap()),
            _ => format!("{line}\n"),
        })
        .collect();
    fs::write(directory.path().join("force.csv"), shifted).unwrap();
    let (found, status) = inspected(directory.path(), &FILES);
    let asked = questions(&found);
    assert!(status == 2 && (proposed(&asked) - 1.7e9).abs() < 0.05, "{found:#}");
}

/// Poses of the table are those of the sensor's clock after the delay; the setup may state it.
#[test]
fn the_delay_of_the_stage_shifts_its_times() {
    let directory = tempfile::tempdir().unwrap();
    two_files(directory.path(), 1.7);
    let (_, _) = inspected(directory.path(), &FILES);
    let poses = |name: &str, options: &[&str]| -> Vec<String> {
        let base =
            ["reconstruct", "force.csv", "--rod", "rod.toml", "--stage", "table:stage.csv", "--local", "--out", name];
        let output = vibrissa(directory.path(), &[&base[..], options].concat());
        assert!(matches!(output.status.code(), Some(0 | 2)), "{}", complaint(&output));
        let points = fs::read_to_string(directory.path().join(name).join("points.jsonl")).unwrap();
        points.lines().skip(1500).take(3).map(str::to_owned).collect()
    };
    fs::write(directory.path().join("setup.toml"), "[stage]\ndelay = \"1700 ms\"\n").unwrap();
    let by_option = poses("a", &["--stage-delay", "1.7"]);
    assert_eq!(by_option, poses("b", &["--setup", "setup.toml"]));
    assert_eq!(by_option, poses("c", &["--setup", "setup.toml", "--stage-delay=1.7 s"]));
    assert_ne!(by_option, poses("d", &["--setup", "setup.toml", "--stage-delay", "0"]));
    for (options, part) in [
        (&["--stage", "constant:1e-3", "--stage-delay", "1 s"][..], "expected --stage table:FILE"),
        (&["--stage", "table:stage.csv", "--stage-delay", "1 mm"], "expected a finite time as \"120 ms\""),
    ] {
        let output =
            vibrissa(directory.path(), &[&["reconstruct", "force.csv", "--rod", "rod.toml"], options].concat());
        assert!(output.status.code() != Some(0) && complaint(&output).contains(part), "{}", complaint(&output));
    }
}

/// Delays that the physics proposes, of files whose motion ends in contact, with noise: docs/recordings.md states what this prints.
#[test]
#[ignore = "a measurement of a minute"]
fn measured_delays() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut uniform = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut errors, mut covered) = (Vec::new(), 0);
    for _ in 0..40 {
        let rest = [1.5 + 4.0 * uniform(), 1.0 + 4.0 * uniform()];
        let start = 0.01 * (100.0 * rest[0] * uniform()).round();
        let directory = tempfile::tempdir().unwrap();
        // a sum of twelve is normal enough
        two_noisy_files(directory.path(), start, rest, &mut || (0..12).map(|_| uniform()).sum::<f64>() - 6.0);
        let (found, _) = inspected(directory.path(), &FILES);
        let said = found.to_string();
        let Some((_, fit)) = said.split_once("The physics fits a delay of ") else { continue };
        let numbers: Vec<f64> = fit.split([' ', '(', ';']).filter_map(|word| word.parse().ok()).collect();
        // the second is that of 95 %
        let [best, least, most] = [numbers[0], numbers[2], numbers[3]];
        errors.push((best - start).abs());
        covered += usize::from((least..=most).contains(&start));
    }
    errors.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
    println!(
        "{} of 40, median {:.4} s, 90 % {:.4} s, largest {:.4} s, in the interval {covered}",
        errors.len(),
        at(0.5),
        at(0.9),
        at(1.0)
    );
    assert!(errors.len() > 30 && at(0.9) < 0.2, "{errors:?}");
}

/// The constant pass of the recording as a sensor of 100 Hz and a stage of 20 Hz, whose clock began `apart` later; both files begin and end together, at
/// `origin`.
fn pass(directory: &Path, apart: f64, origin: f64, stage_rows: impl Fn(f64) -> bool) {
    let rows = recording();
    let end = rows.len() - 1;
    let at = |t: f64| rows[((100.0 * t).round().max(0.0) as usize).min(end)];
    let mut noise = 7_u32;
    let mut normal = || {
        let mut one = || {
            noise ^= noise << 13;
            noise ^= noise >> 17;
            noise ^= noise << 5;
            f64::from(noise) / f64::from(u32::MAX)
        };
        (0..12).map(|_| one()).sum::<f64>() - 6.0
    };
    let mut sensor = "t [s],Fx [N],Fy [N],Tz [N m]\n".to_owned();
    for [t, _, _, _, fx, fy, mz] in rows {
        let (fx, fy, mz) = (fx + NOISE[0] * normal(), fy + NOISE[0] * normal(), mz + NOISE[1] * normal());
        let _ = writeln!(sensor, "{:.3},{fx},{fy},{mz}", origin + t);
    }
    let mut stage = "t [s],x0,y0,phi0\n".to_owned();
    for t in (0..=end / 5).map(|k| 0.05 * k as f64).filter(|t| stage_rows(*t)) {
        let [_, x, y, phi, ..] = at(t + apart);
        let _ = writeln!(stage, "{:.3},{x},{y},{phi}", origin + t);
    }
    fs::write(directory.join("force.csv"), sensor).unwrap();
    fs::write(directory.join("stage.csv"), stage).unwrap();
}

/// Nothing in a pass at constant speed tells clocks apart by less than the free parts of the way: files that begin and end together were taken for one
/// clock, and the object was off by speed times delay.
#[test]
fn files_that_begin_and_end_together_may_have_two_clocks() {
    for apart in [0.0, 0.3, -1.0] {
        let directory = tempfile::tempdir().unwrap();
        pass(directory.path(), apart, 0.0, |_| true);
        let (found, status) = inspected(directory.path(), &FILES);
        let asked = questions(&found);
        assert!(
            status == 2 && asked.contains("within this range the object is shifted by up to"),
            "{apart}: {found:#}"
        );
        assert!(asked.contains("--stage-delay '0 s' (both have one clock)"), "{apart}: {asked}");
        let options = ["--stage-delay", "0", "--write-setup", "sensor.toml"];
        let (found, status) = inspected(directory.path(), &[&FILES[..], &options].concat());
        assert_eq!(status, 0, "{apart}: {found:#}");
    }
}

/// Times since 1970 of two computers: the stage starts after the reactions change.
#[test]
fn reactions_that_change_before_the_stage_moves_refute_one_clock() {
    let directory = tempfile::tempdir().unwrap();
    pass(directory.path(), 0.0, 1.7e9, |_| true);
    let text = fs::read_to_string(directory.path().join("stage.csv")).unwrap();
    let later = |line: &str| match line.split_once(',') {
        Some((t, rest)) if t.parse::<f64>().is_ok() => format!("{:.3},{rest}\n", 15.0 + t.parse::<f64>().unwrap()),
        _ => format!("{line}\n"),
    };
    fs::write(directory.path().join("stage.csv"), text.lines().map(later).collect::<String>()).unwrap();
    let (found, status) = inspected(directory.path(), &FILES);
    let asked = questions(&found);
    assert!(status == 2 && asked.contains("With one clock the reactions change at"), "{found:#}");
    assert!(asked.contains("although the clamp does not move, before it starts at 1700000015.000 s"), "{found:#}");
}

/// A stage that stands in contact: reactions that change meanwhile refute even a delay that was stated.
#[test]
fn a_stop_in_contact_refutes_a_stated_delay() {
    let directory = tempfile::tempdir().unwrap();
    two_noisy_files(directory.path(), 0.0, REST, &mut || 0.0);
    let text = fs::read_to_string(directory.path().join("stage.csv")).unwrap();
    // the clamp stands in contact for 3 s, and the log goes on
    let rows: Vec<&str> = text.lines().collect();
    let last: Vec<&str> = rows[rows.len() - 1].split(',').collect();
    let mut longer = text.clone();
    let end: f64 = last[0].parse().unwrap();
    for k in 1..=50 {
        let _ = writeln!(longer, "{:.2},{}", end + 0.05 * f64::from(k), last[1..].join(","));
    }
    // and comes back a little
    let back: f64 = last[1].parse::<f64>().unwrap() + 1e-3;
    let _ = writeln!(longer, "{:.2},{back},{}", end + 3.0, last[2..].join(","));
    fs::write(directory.path().join("stage.csv"), longer).unwrap();
    let (found, status) = inspected(directory.path(), &[&FILES[..], &["--stage-delay=-1"]].concat());
    let asked = questions(&found);
    assert!(status == 2 && asked.contains("With a delay of -1.0000 s the reactions change at"), "{found:#}");
    assert!(!asked.contains("'-1 s'"), "{asked}");
}

/// Two rows say nothing of the speed between them.
#[test]
fn the_two_ends_of_a_motion_are_a_question() {
    let directory = tempfile::tempdir().unwrap();
    let last = 0.05 * ((recording().len() - 1) / 5) as f64;
    pass(directory.path(), 0.0, 0.0, |t| t == 0.0 || t > last - 0.01);
    let options = [&FILES[..], &["--stage-delay", "0", "--write-setup", "sensor.toml"]].concat();
    let (found, status) = inspected(directory.path(), &options);
    assert!(status == 2 && questions(&found).contains("is the speed of the clamp constant"), "{found:#}");
    assert_eq!(found["commands"][0]["reads"], false);
    // the row in the middle states it
    pass(directory.path(), 0.0, 0.0, |t| t == 0.0 || (t - 0.5 * last).abs() < 0.03 || t > last - 0.01);
    let (found, status) = inspected(directory.path(), &options);
    assert_eq!(status, 0, "{found:#}");
}

/// The sensor's program was started anew: its rows got the poses of other times, and most were left out without a word.
#[test]
fn a_clock_that_begins_anew_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    pass(directory.path(), 0.0, 0.0, |_| true);
    let text = fs::read_to_string(directory.path().join("force.csv")).unwrap();
    let anew = text.lines().enumerate().map(|(k, line)| match line.split_once(',') {
        Some((t, rest)) if k > 800 => format!("{:.3},{rest}\n", t.parse::<f64>().unwrap() - 8.0),
        _ => format!("{line}\n"),
    });
    fs::write(directory.path().join("force.csv"), anew.collect::<String>()).unwrap();
    let (found, status) = inspected(directory.path(), &[&FILES[..], &["--stage-delay", "0"]].concat());
    let fault = &found["files"][0]["faults"][0];
    assert!(status == 2 && fault["line"] == 802 && fault["prevents"] == true, "{found:#}");
    let command =
        ["reconstruct", "force.csv", "--rod", "rod.toml", "--stage", "table:stage.csv", "--setup", "s.toml", "--local"];
    let setup = "[sensor]\ncomponents = [\"Fx\", \"Fy\", \"Tz\"]\nmatrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\nforce_unit = \"N\"\n\
                 torque_unit = \"N m\"\n[mounting]\nsense = \"reaction\"\n[recording]\ncolumns = [\"Fx\", \"Fy\", \"Tz\"]\n";
    fs::write(directory.path().join("s.toml"), setup).unwrap();
    let output = vibrissa(directory.path(), &command);
    assert_eq!(output.status.code(), Some(1));
    let said = complaint(&output);
    assert!(said.contains("1201 of 2001 rows cannot be used") && said.contains("line 802: the time 0 s"), "{said}");
}

/// A logger that writes each row twice.
#[test]
fn rows_of_a_stage_that_are_there_twice_are_read_once() {
    let directory = tempfile::tempdir().unwrap();
    pass(directory.path(), 0.0, 0.0, |_| true);
    let text = fs::read_to_string(directory.path().join("stage.csv")).unwrap();
    let twice = text.lines().enumerate().map(|(k, line)| format!("{line}\n").repeat(if k == 0 { 1 } else { 2 }));
    fs::write(directory.path().join("stage.csv"), twice.collect::<String>()).unwrap();
    let options = ["--stage-delay", "0", "--write-setup", "sensor.toml"];
    let (found, status) = inspected(directory.path(), &[&FILES[..], &options].concat());
    assert!(status == 0 && found["commands"][0]["reads"] == true, "{found:#}");
}

/// A slow sensor: the tare takes the samples that it needs, not those of the first contact.
#[test]
fn a_slow_sensor_is_tared_before_it_touches() {
    let directory = tempfile::tempdir().unwrap();
    pass(directory.path(), 0.0, 0.0, |_| true);
    let text = fs::read_to_string(directory.path().join("force.csv")).unwrap();
    let free = recording().iter().position(|row| row[6].abs() > 1e-7).unwrap();
    // 40 samples before the contact
    let slow: String = text
        .lines()
        .enumerate()
        .filter(|(k, _)| *k == 0 || k % (free / 40) == 0)
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    fs::write(directory.path().join("force.csv"), slow).unwrap();
    let options = ["--stage-delay", "0", "--write-setup", "sensor.toml"];
    let (found, status) = inspected(directory.path(), &[&FILES[..], &options].concat());
    assert_eq!(status, 0, "{found:#}");
}

/// The time 0 of files that keep absolute times, s since 1970.
const EPOCH: f64 = 1.764e9;

/// The rows of the sensor's table: t, Fx, Fy, Fz, Tx, Ty, Tz.
fn rows(directory: &Path) -> Vec<[f64; 7]> {
    let text = fs::read_to_string(directory.join("force.csv")).unwrap();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().ok()).collect::<Option<Vec<f64>>>()?.try_into().ok();
    text.lines().filter_map(row).collect()
}

/// The sensor's table as messages of ROS, logged from [`EPOCH`] on.
fn mcap(directory: &Path) {
    let text = |text: &str| [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat();
    let record = |code: u8, body: Vec<u8>| [vec![code], (body.len() as u64).to_le_bytes().to_vec(), body].concat();
    let id = 1_u16.to_le_bytes().to_vec();
    let schema = [id.clone(), text("geometry_msgs/msg/WrenchStamped"), text("ros2msg"), vec![0; 4]].concat();
    let channel = [id.clone(), id.clone(), text("/wrench"), text("cdr"), vec![0; 4]].concat();
    let mut bytes = [b"\x89MCAP0\r\n".to_vec(), record(3, schema), record(4, channel)].concat();
    for [t, wrench @ ..] in rows(directory) {
        let logged = ((EPOCH as u64) * 1_000_000_000 + (1e9 * t).round() as u64).to_le_bytes();
        // no time in the header, and a frame without a name
        let mut message = vec![0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0];
        wrench.iter().for_each(|value| message.extend(value.to_le_bytes()));
        bytes.extend(record(5, [id.clone(), vec![0; 4], logged.to_vec(), logged.to_vec(), message].concat()));
    }
    bytes.extend(record(15, vec![0; 4]));
    fs::write(directory.join("force.mcap"), bytes).unwrap();
}

/// The sensor's table as channels of LabVIEW that begin at [`EPOCH`], with the setup that reads them.
fn tdms(directory: &Path) {
    let (rows, endian) = (rows(directory), Endian::Little);
    let (mut objects, mut raw) = (Vec::new(), Vec::new());
    for (path, column) in [("/'Measured'/'Fx'", 1), ("/'Measured'/'Fy'", 2), ("/'Measured'/'Tz'", 6)] {
        let mut object = Object::new(path, Index::Values(F64, rows.len() as u64)).with(endian, "wf_increment", 0.01);
        let start = [endian.bytes(0, 8), endian.bytes(2_082_844_800 + EPOCH as u128, 8)].concat();
        object.properties.push(("wf_start_time".to_owned(), 0x44, start));
        objects.push(object);
        raw.extend(endian.f64s(&rows.iter().map(|row| row[column]).collect::<Vec<_>>()));
    }
    fs::write(directory.join("force.tdms"), segment(endian, 0, &objects, &raw)).unwrap();
    let columns = "['Fx', 'Fy', 'Tz']";
    let setup = format!(
        "[sensor]\nforce_unit = 'N'\ntorque_unit = 'N m'\nchannels = {columns}\n[recording]\ngroup = 'Measured'\ncolumns = {columns}\n"
    );
    fs::write(directory.join("labview.toml"), setup).unwrap();
}

/// A file of ROS or LabVIEW beside a log of the stage that counts from 0 was joined as if both had one clock, and one beside a log with dates had no time in
/// common with it.
#[test]
fn binary_recordings_have_clocks_too() {
    let directory = tempfile::tempdir().unwrap();
    let dir = directory.path();
    for (file, setup) in [("force.mcap", None), ("force.tdms", Some("labview.toml"))] {
        let options = || {
            let setup = setup.map_or(["--write-setup", "made.toml"], |setup| ["--setup", setup]);
            [&[file, "stage.csv", "--rod", "rod.toml"][..], &setup].concat()
        };
        two_files(dir, 1.7);
        mcap(dir);
        tdms(dir);
        let (found, status) = inspected(dir, &options());
        let asked = questions(&found);
        assert!(status == 2 && (proposed(&asked) - 1.7).abs() < 0.05, "{file}: {found:#}");

        two_files(dir, 0.0);
        mcap(dir);
        tdms(dir);
        let dated = |line: &str| match line.split_once(',') {
            Some((t, rest)) if t != "t" => format!("{:.2},{rest}\n", EPOCH + t.parse::<f64>().unwrap()),
            _ => format!("{line}\n"),
        };
        let stage: String = fs::read_to_string(dir.join("stage.csv")).unwrap().lines().map(dated).collect();
        fs::write(dir.join("stage.csv"), stage).unwrap();
        let (found, status) = inspected(dir, &options());
        assert!(status == 0 && questions(&found).is_empty(), "{file}: {found:#}");
        runs(dir, &found);
    }
}
