//! Draws docs/edges.svg: a scan of the bent saw, whose edges and vertices break the reactions without a change of
//! phase, and what tells them from a second contact. `cargo run --release -p vibrissa-cli --example edges --
//! docs/edges.svg`

#![allow(clippy::print_stdout, reason = "it is there to be read")]

#[path = "../../benches/speed_error/figure/canvas.rs"]
#[allow(dead_code, reason = "shared with figures that need more of it")]
mod canvas;

use canvas::{BODY, Colour, FAINT, INK, LINE, Point, Sheet, Side};
use rod_files::{Scan, Scene};
use std::error::Error;
use std::ops::Range;
use std::path::Path;
use vibrissa::{Label, Sample, Settings, reconstruct};

/// Part of the clamp's way that is shown, mm.
const SHOWN: Range<f64> = 80.0..215.0;
/// The page, a panel with the gap below it, and the sides of the plots, pixels.
const SIZE: Point = (1530.0, 1270.0);
const PANEL: f64 = 280.0;
const GAP: f64 = 24.0;
const LEFT: f64 = 150.0;
const RIGHT: f64 = 1500.0;
const TOP: f64 = 84.0;
/// A kink with and without a change of phase.
const CHANGES: Colour = "#0072b2";
const STAYS: Colour = "#d55e00";
/// Fewest pixels between two names of phases.
const APART: f64 = 46.0;

/// A line: millimetres along the way, and a value.
type Line = Vec<(f64, f64)>;

fn main() -> Result<(), Box<dyn Error>> {
    let out = std::env::args().nth(1).ok_or("expected the name of the figure")?;
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/saw.toml");
    let mut scene = Scene::read(&file)?;
    scene.step = 5e-6;
    let start = scene.path.at(0.0);
    let scan = Scan::run(scene)?;
    let samples: Vec<Sample> =
        scan.outcome.states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect();
    let found = reconstruct(scan.scene.rod.at_clamp(), &samples, &Settings::default())?;
    let way = |index: usize| samples.get(index).map_or(f64::NAN, |at| 1e3 * (at.pose.x - start.x).abs());
    let line = |value: &dyn Fn(usize) -> f64| -> Line {
        (0..samples.len()).step_by(20).map(|index| (way(index), value(index))).collect()
    };
    let speed = |index: usize| {
        let value = found.evidence(index).map_or(0.0, |evidence| evidence.tangent.value.abs());
        value.max(1e-12).log10()
    };
    let criterion = |index: usize| found.evidence(index).map_or(f64::NAN, |evidence| evidence.criterion.value);
    let panels = [
        ("f0x in mN", line(&|index| 1e3 * samples[index].reactions.f0x)),
        ("f0y in mN", line(&|index| 1e3 * samples[index].reactions.f0y)),
        ("K in (EI/L)²", line(&criterion)),
        ("log10 |vn|", line(&speed)),
    ];
    let at = |x: f64| LEFT + (x - SHOWN.start) / (SHOWN.end - SHOWN.start) * (RIGHT - LEFT);
    let bottom = TOP + PANEL * panels.len() as f64 - GAP;
    let drawing = Sheet::svg(SIZE, |sheet| {
        let mut named = f64::NEG_INFINITY;
        for (number, &(first, label)) in found.runs.iter().enumerate() {
            let last = found.runs.get(number + 1).map_or(samples.len() - 1, |run| run.0);
            let (from, to) = (way(first).max(SHOWN.start), way(last).min(SHOWN.end));
            if from >= to || label == Label::Free {
                continue;
            }
            if label.several() {
                let (left, right) = (at(from), at(to));
                sheet.area(&[(left, TOP), (right, TOP), (right, bottom), (left, bottom)], FAINT);
            }
            // short runs are told apart by colour alone
            let middle = 0.5 * (at(from) + at(to));
            if to - from > 2.0 && middle - named >= APART {
                sheet.write(&label.to_string(), (middle, TOP - 20.0), Side::Middle, BODY, INK);
                named = middle;
            }
        }
        for kink in &found.kinks {
            let x = way(kink.next);
            if SHOWN.contains(&x) {
                let changes = found.runs.iter().any(|run| run.0.abs_diff(kink.next) <= 2);
                sheet.line(&[(at(x), TOP), (at(x), bottom)], if changes { CHANGES } else { STAYS }, 2.0);
            }
        }
        for (number, (name, line)) in panels.into_iter().enumerate() {
            let line: Line = line.into_iter().filter(|point| SHOWN.contains(&point.0) && point.1.is_finite()).collect();
            draw(sheet, name, &line, TOP + PANEL * number as f64, &at);
        }
        for x in ticks(&SHOWN, 8).0 {
            sheet.line(&[(at(x), bottom), (at(x), bottom + 7.0)], INK, 1.0);
            sheet.write(&format!("{x}"), (at(x), bottom + 26.0), Side::Middle, BODY, INK);
        }
        let middle = 0.5 * (LEFT + RIGHT);
        sheet.write("way of the clamp in mm", (middle, bottom + 60.0), Side::Middle, BODY, INK);
        sheet.write("grey: several contacts", (LEFT, 28.0), Side::Left, BODY, INK);
        sheet.write("kink with a change of phase", (0.5 * (LEFT + RIGHT), 28.0), Side::Middle, BODY, CHANGES);
        sheet.write("kink without a change of phase", (RIGHT, 28.0), Side::Right, BODY, STAYS);
    });
    std::fs::write(&out, drawing)?;
    println!("kink (way in mm), change of the rates of f0x and f0y (N/m) and m0z (N), |vn| before and after, labels");
    for kink in found.kinks.iter().filter(|kink| kink.next > 200 && kink.next + 200 < samples.len()) {
        let [before, after] = [kink.next - 100, kink.next + 100];
        println!(
            "{:9.4} {:?} {:10.2e} {:10.2e} {:10.2e}  {:.1e} {:.1e}  {} {}",
            way(kink.next),
            kink.kind,
            kink.change[0],
            kink.change[1],
            kink.change[2],
            10.0_f64.powf(speed(before)),
            10.0_f64.powf(speed(after)),
            found.readings[before].label,
            found.readings[after].label
        );
    }
    Ok(())
}

/// Draws a panel with its axis: `top` in pixels, `at` from the way to pixels.
fn draw(sheet: &mut Sheet, name: &str, line: &Line, top: f64, at: &impl Fn(f64) -> f64) {
    let values = || line.iter().map(|point| point.1);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let margin = 0.06 * (high - low);
    let range = low - margin..high + margin;
    let below = top + PANEL - GAP;
    let height = |value: f64| below - (value - range.start) / (range.end - range.start) * (PANEL - GAP);
    let points: Vec<Point> = line.iter().map(|point| (at(point.0), height(point.1))).collect();
    sheet.line(&points, INK, LINE);
    sheet.line(&[(LEFT, top), (LEFT, below), (RIGHT, below)], INK, 1.0);
    let (values, decimals) = ticks(&range, 5);
    for value in values {
        sheet.line(&[(LEFT - 7.0, height(value)), (LEFT, height(value))], INK, 1.0);
        let text = format!("{value:.decimals$}").replace('-', "\u{2212}");
        sheet.write(&text, (LEFT - 12.0, height(value)), Side::Right, BODY, INK);
    }
    sheet.write_upwards(name, (28.0, 0.5 * (top + below)), BODY);
}

/// At most about so many round numbers in a range, and the decimals that they have.
fn ticks(range: &Range<f64>, most: u32) -> (Vec<f64>, usize) {
    let least = (range.end - range.start) / f64::from(most);
    let power = 10.0_f64.powf(least.log10().floor());
    let step = [1.0, 2.0, 5.0].map(|factor| factor * power).into_iter().find(|step| *step >= least);
    let step = step.unwrap_or(10.0 * power);
    let (first, last) = ((range.start / step).ceil() as i64, (range.end / step).floor() as i64);
    let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    ((first..=last).map(|k| k as f64 * step).collect(), decimals)
}
