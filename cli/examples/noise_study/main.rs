//! How well scans are reconstructed from noisy sensors: the tables of docs/reconstruction.md.
//!
//! ```sh
//! cargo run --release -p vibrissa-cli --example noise_study
//! ```
#![allow(clippy::print_stdout, reason = "the tables are what it is for")]

mod study;

use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::PathBuf;
use study::{Clean, LEVELS, Level, NOISES, Noise, Outcome, Recordings, Score};

/// Records the nine scans of Merker et al. (2020) with sensors of three noise levels, white and AR(1), and prints how well
/// they are reconstructed.
#[derive(Parser)]
struct Arguments {
    /// Recordings of each scan with each noise.
    #[arg(long, default_value_t = 20)]
    seeds: u64,
    /// The first of their seeds.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Fits one contour to each recording, which takes seconds; a contour that explains it gives the answers.
    #[arg(long)]
    fit: bool,
    /// Only these levels: clean, 0.2mN, 2.5mN, 10mN.
    #[arg(long, num_args = 1.., value_parser = ["clean", "0.2mN", "2.5mN", "10mN"])]
    level: Vec<String>,
    /// Coefficients of friction of rod and objects, one study after the other; each is estimated from each recording, unless it is 0. Several are
    /// compared in a table.
    #[arg(long, num_args = 1.., default_values_t = [0.0])]
    friction: Vec<f64>,
    /// Only these scans: O1_q20 and so on.
    #[arg(long, num_args = 1..)]
    scan: Vec<String>,
    /// Writes the recordings, and the kinks that are there and that were found, to this directory, 6 MB a recording.
    #[arg(long)]
    write: Option<PathBuf>,
    /// A table for each noise by scan, with the transitions missed and invented and the confusion of phases.
    #[arg(long)]
    by_scan: bool,
    /// Where the scenes are.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes"))]
    scenes: PathBuf,
}

fn main() -> Outcome<()> {
    let arguments = Arguments::parse();
    let mut compared = Vec::new();
    for friction in &arguments.friction {
        let rows = of_friction(&arguments, *friction)?;
        compared.extend(rows.into_iter().map(|(level, noise, score)| (*friction, level, noise, score)));
    }
    if arguments.friction.len() > 1 {
        println!("{}", study::compared(&compared));
    }
    Ok(())
}

/// A noise, and how well the scans are reconstructed with it.
type Row = (&'static Level, Option<&'static Noise>, Score);

/// The study with one coefficient of friction, printed.
fn of_friction(arguments: &Arguments, friction: f64) -> Outcome<Vec<Row>> {
    let names = if arguments.scan.is_empty() { study::scans() } else { arguments.scan.clone() };
    let wanted = |level: &Level| arguments.level.is_empty() || arguments.level.iter().any(|only| only == level.name);
    let scans = study::sweep(&arguments.scenes, &names, friction)?;
    let keep = arguments.write.as_deref().map(Recordings::new).transpose()?;

    let noisy = LEVELS.iter().flat_map(|level| NOISES.iter().map(move |noise| (level, noise)));
    let noisy: Vec<(&'static Level, &'static Noise)> = noisy.filter(|(level, _)| wanted(level)).collect();
    let clean = wanted(&Level::CLEAN).then_some((&Level::CLEAN, &NOISES[0]));
    let work = if clean.is_some() { 1 } else { 0 } + arguments.seeds * noisy.len() as u64;
    let bar = ProgressBar::new(work * scans.len() as u64)
        .with_style(ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} recordings, {eta} left")?);
    let mut rows = Vec::new();
    let mut details = String::new();
    for &(level, noise) in clean.iter().chain(&noisy) {
        let without = level.force == 0.0;
        let (seeds, keep) = if without { (1, None) } else { (arguments.seeds, keep.as_ref()) };
        let seeds = arguments.first..arguments.first + seeds;
        let scores = study::judge(&scans, level, noise, seeds, arguments.fit && !without, keep, &|| bar.inc(1))?;
        let noise = (!without).then_some(noise);
        if arguments.by_scan {
            details += &detail(&scans, level, noise, &scores);
        }
        let mut all = Score::default();
        scores.into_iter().for_each(|score| all.merge(score));
        rows.push((level, noise, all));
    }
    bar.finish_and_clear();
    if let Some(keep) = keep {
        keep.finish()?;
    }
    println!("{} scans, {} seeds, friction {friction}\n", scans.len(), arguments.seeds);
    println!("{}", study::tables(rows.iter().map(|(level, noise, score)| (*level, *noise, score))));
    if friction != 0.0 {
        println!("{}", study::frictions(rows.iter().map(|(level, noise, score)| (*level, *noise, score))));
    }
    println!("Least changes of slope that stand out by 5 standard deviations, forces in mN/mm / moment in mN m/mm:\n");
    println!("{}", study::limits(noisy.iter().copied()));
    println!(
        "Kinks by transition, their changes of slope, and how many of them no half-window up to 4 mm lets stand out:\n"
    );
    println!("{}{details}", study::kinks_below(&scans, &noisy)?);
    Ok(rows)
}

fn detail(scans: &[Clean], level: &Level, noise: Option<&Noise>, scores: &[Score]) -> String {
    let mut text = format!("\n{} {}\n\n", level.title(), noise.map_or("", |noise| noise.name));
    text += &study::by_scan(scans.iter().zip(scores).map(|(clean, score)| (clean.scene.name.as_str(), score)));
    let mut phases = vibrissa::reconstruct::score::Confusion::default();
    for (clean, score) in scans.iter().zip(scores) {
        phases += score.phases;
        if score.phases.accuracy().is_some_and(|accuracy| accuracy < 0.998) {
            text += &format!("\n{}\n{}\n\n", clean.scene.name, score.phases);
        }
        let lists = [("missed", &score.missed), ("invented", &score.invented), ("taken:", &score.mistaken)];
        for (what, counts) in lists {
            counts.iter().for_each(|(name, count)| text += &format!("{what} {count} x {name}\n"));
        }
    }
    text + &format!("\n{phases}\n")
}
