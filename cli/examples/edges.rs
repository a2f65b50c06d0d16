//! Draws docs/edges.svg: a scan of the bent saw, whose edges and vertices break the reactions without a change of
//! phase, and what tells them from a second contact. `cargo run --release -p vibrissa-cli --example edges --
//! docs/edges.svg`

#![allow(clippy::print_stdout, reason = "it is there to be read")]

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::error::Error;
use std::path::Path;
use vibrissa::{Label, Sample, Settings, reconstruct};
use vibrissa_cli::{Scan, Scene};

/// Part of the clamp's way that is shown, mm.
const SHOWN: (f64, f64) = (80.0, 215.0);
const SIZE: (u32, u32) = (1400, 1120);
const PANEL: i32 = 240;
const LEFT: i32 = 190;
const RIGHT: i32 = 1370;
const TOP: i32 = 70;

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
    let found = reconstruct(&scan.scene.rod, &samples, &Settings::default())?;
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
        ("f0x, mN", vec![line(&|index| 1e3 * samples[index].reactions.f0x)]),
        ("f0y, mN", vec![line(&|index| 1e3 * samples[index].reactions.f0y)]),
        ("K, (EI/L)²", vec![line(&criterion)]),
        ("log10 |vn|", vec![line(&speed)]),
    ];
    let root = SVGBackend::new(&out, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let at = |x: f64| LEFT + ((x - SHOWN.0) / (SHOWN.1 - SHOWN.0) * f64::from(RIGHT - LEFT)) as i32;
    let text = |text: String, place: (i32, i32), side: HPos| {
        let style = ("sans-serif", 24).into_font().color(&BLACK).pos(Pos::new(side, VPos::Center));
        root.draw(&Text::new(text, place, style))
    };
    // several contacts grey, with the label of each run
    for (number, &(first, label)) in found.runs.iter().enumerate() {
        let last = found.runs.get(number + 1).map_or(samples.len() - 1, |run| run.0);
        let (from, to) = (way(first).max(SHOWN.0), way(last).min(SHOWN.1));
        if from >= to || label == Label::Free {
            continue;
        }
        if label.several() {
            let grey = RGBColor(225, 225, 225).filled();
            root.draw(&Rectangle::new([(at(from), TOP), (at(to), TOP + 4 * PANEL)], grey))?;
        }
        if to - from > 2.0 {
            text(label.to_string(), ((at(from) + at(to)) / 2, TOP - 25), HPos::Center)?;
        }
    }
    // orange where a kink is no change of phase
    for kink in &found.kinks {
        let x = way(kink.next);
        if (SHOWN.0..SHOWN.1).contains(&x) {
            let changes = found.runs.iter().any(|run| run.0.abs_diff(kink.next) <= 2);
            let colour = if changes { RGBColor(0, 114, 178) } else { RGBColor(213, 94, 0) };
            root.draw(&PathElement::new([(at(x), TOP), (at(x), TOP + 4 * PANEL)], colour.stroke_width(2)))?;
        }
    }
    for (number, (name, lines)) in panels.into_iter().enumerate() {
        let base = TOP + PANEL * (number as i32 + 1) - 10;
        let shown: Vec<Line> = lines
            .into_iter()
            .map(|line| line.into_iter().filter(|p| p.0 >= SHOWN.0 && p.0 <= SHOWN.1 && p.1.is_finite()).collect())
            .collect();
        let values = || shown.iter().flatten().map(|point| point.1);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let height = |value: f64| base - ((value - low) / (high - low) * f64::from(PANEL - 20)) as i32;
        for line in &shown {
            let points: Vec<(i32, i32)> = line.iter().map(|point| (at(point.0), height(point.1))).collect();
            root.draw(&PathElement::new(points, BLACK.stroke_width(2)))?;
        }
        text(name.to_owned(), (12, base - PANEL / 2 + 10), HPos::Left)?;
        for value in [low, high] {
            text(format!("{value:.2}"), (LEFT - 8, height(value)), HPos::Right)?;
        }
    }
    for x in [80.0, 100.0, 120.0, 140.0, 160.0, 180.0, 200.0] {
        text(format!("{x}"), (at(x), TOP + 4 * PANEL + 20), HPos::Center)?;
    }
    let foot = "way of the clamp, mm; grey: several contacts; kinks: orange without, blue with a change of phase";
    text(foot.to_owned(), (LEFT, SIZE.1 as i32 - 20), HPos::Left)?;
    root.present()?;
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
