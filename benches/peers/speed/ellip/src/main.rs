//! Legendre's elliptic integrals (the crate `ellip`) on segments and on phase B of the reference set, timed.
//!
//! `ellip-peer FOLDER` reads the problems of the folder and writes rows of task, problem, method, setting, error, seconds and note
//! to standard output. `benches/peers/speed/run` calls it.

mod amplitude;
mod segment;
mod tangential;

use segment::Section;
use serde_json::Value;
use std::error::Error;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;
use tangential::{Answer, Parabola};

const METHOD: &str = "ellip (Legendre integrals)";
/// The problem of phase B, of which the contact lies on a parabola.
const TANGENTIAL: &str = "b-parabola";
/// Segments that lose more digits than this tell of themselves more than of the method.
const MODERATE: f64 = 100.0;
/// Rounds of which the fastest counts, and repetitions in each.
const ROUNDS: usize = 50;
const REPEATED: usize = 100;

type Outcome<T> = Result<T, Box<dyn Error>>;

struct Segment {
    start: Section,
    a: f64,
    b: f64,
    length: f64,
    end: Section,
}

fn number(value: &Value) -> Outcome<f64> {
    match value {
        Value::String(text) => Ok(text.parse()?),
        other => other.as_f64().ok_or_else(|| format!("{other} is no number").into()),
    }
}

fn section(value: &Value) -> Outcome<Section> {
    Ok([number(&value["x"])?, number(&value["y"])?, number(&value["phi"])?, number(&value["kappa"])?])
}

fn read(path: &Path) -> Outcome<Value> {
    Ok(serde_json::from_str(&std::fs::read_to_string(path)?)?)
}

fn segments(folder: &Path) -> Outcome<Vec<Segment>> {
    let mut segments = Vec::new();
    for file in std::fs::read_dir(folder)? {
        let problem = read(&file?.path())?;
        if problem["kind"] != "segment" || number(&problem["condition"])? > MODERATE {
            continue;
        }
        segments.push(Segment {
            start: section(&problem["start"])?,
            a: number(&problem["force"]["a"])?,
            b: number(&problem["force"]["b"])?,
            length: number(&problem["length"])?,
            end: section(&problem["end"])?,
        });
    }
    Ok(segments)
}

fn error(found: &[f64], truth: &[f64]) -> f64 {
    let errors = found.iter().zip(truth).map(|(found, truth)| (found - truth).abs() / (1.0 + truth.abs()));
    errors.fold(0.0, |worst, error| if error.is_nan() { f64::INFINITY } else { worst.max(error) })
}

/// Least time of `act` in all rounds, seconds, divided by how much it does.
fn least(work: usize, mut act: impl FnMut()) -> f64 {
    let round = |act: &mut dyn FnMut()| {
        let start = Instant::now();
        (0..REPEATED).for_each(|_| act());
        start.elapsed().as_secs_f64() / (REPEATED * work) as f64
    };
    (0..ROUNDS).map(|_| round(&mut act)).fold(f64::INFINITY, f64::min)
}

/// A row; the setting of a closed form is its arithmetic.
type Row = (String, String, String, f64, f64, String);

fn measure_segments(folder: &Path) -> Outcome<Vec<Row>> {
    let segments = segments(folder)?;
    let act = |Segment { start, a, b, length, .. }: &Segment| segment::advance(black_box(*start), *a, *b, *length);
    let mut errors: Vec<f64> =
        segments.iter().map(|segment| act(segment).map_or(f64::INFINITY, |end| error(&end, &segment.end))).collect();
    errors.sort_by(f64::total_cmp);
    let seconds = least(segments.len(), || {
        segments.iter().for_each(|segment| {
            let _ = black_box(act(segment));
        });
    });
    let count = errors.len();
    let row = |which: &str, error| {
        let problem = format!("{which} of {count}");
        ("segment".to_owned(), problem, "f64".to_owned(), error, seconds, "four cases".to_owned())
    };
    Ok(vec![row("median", errors[count / 2]), row("worst", errors[count - 1])])
}

fn measure_tangential(folder: &Path) -> Outcome<Vec<Row>> {
    let problem = read(&folder.join(TANGENTIAL).with_extension("json"))?;
    let (clamp, contact, reactions) = (&problem["clamp"], &problem["contacts"][0], &problem["reactions"]);
    let touched = contact["support"].as_u64().ok_or("no support")? as usize;
    let support = &problem["supports"][touched];
    let vertex = [number(&support["vertex"][0])?, number(&support["vertex"][1])?];
    let parabola = Parabola { vertex, coefficient: number(&support["coefficient"])? };
    let clamp = [number(&clamp["x"])?, number(&clamp["y"])?, number(&clamp["phi"])?];
    let truth: Answer = [
        number(&reactions["f0x"])?,
        number(&reactions["f0y"])?,
        number(&reactions["m0z"])?,
        number(&contact["x"])?,
        number(&contact["y"])?,
    ];
    let t = truth[3] - vertex[0];

    // with the clamp moved in eight directions, and the contact's place to a tenth
    let moved = (0..8).map(|k| {
        let (sin, cos) = (f64::from(k) * TAU / 8.0).sin_cos();
        let near = [clamp[0] + 1e-3 * cos, clamp[1] + 1e-3 * sin, clamp[2]];
        let found = tangential::solve(parabola, near, t, 1e-2, 1e-15).ok_or("no neighbour")?;
        Ok(found[3] - vertex[0])
    });
    let warm: Vec<f64> = moved.collect::<Outcome<_>>()?;
    let cold = vec![(10.0 * t).round() / 10.0];

    let mut rows = Vec::new();
    for (task, guesses, reach) in [("B warm", warm, 1e-3), ("B cold", cold, 0.05)] {
        for digits in (3..=15).step_by(2) {
            let setting = format!("1e-{digits}");
            let tolerance: f64 = setting.parse()?;
            let act = |guess: &f64| tangential::solve(parabola, black_box(clamp), *guess, reach, tolerance);
            let errors = guesses.iter().map(|guess| act(guess).map_or(f64::INFINITY, |found| error(&found, &truth)));
            let worst = errors.fold(0.0, f64::max);
            let seconds = least(guesses.len(), || {
                guesses.iter().for_each(|guess| {
                    black_box(act(guess));
                });
            });
            let note = "Brent's method, one unknown".to_owned();
            rows.push((task.to_owned(), TANGENTIAL.to_owned(), setting, worst, seconds, note));
        }
    }
    Ok(rows)
}

fn main() -> Outcome<()> {
    let folder = std::env::args_os().nth(1).ok_or("the folder of the reference problems?")?;
    let folder = Path::new(&folder);
    let mut rows = measure_segments(folder)?;
    rows.extend(measure_tangential(folder)?);
    let mut table = csv::Writer::from_writer(std::io::stdout());
    for (task, problem, setting, error, seconds, note) in rows {
        let [error, seconds] = [error, seconds].map(|value| format!("{value:.4e}"));
        table.write_record([&*task, &problem, METHOD, &setting, &error, &seconds, &note])?;
    }
    table.flush()?;
    Ok(())
}
