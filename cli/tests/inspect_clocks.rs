//! A sensor and a stage whose clocks do not begin together: `inspect` asks, and the physics proposes the delay where it can.

use crate::common::{complaint, vibrissa};
use crate::inspect::{inspected, questions, recording, runs, words};
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
