//! The command `vibrissa`.

mod arguments;

use arguments::{Arguments, Command, FakeSensor, Simulate};
use clap::Parser;
use indicatif::ProgressBar;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use vibrissa::{NoiseModel, Stop};
use vibrissa_cli::{
    Error, FakeScan, LiveScan, Paper, Played, Reading, Reconstructed, Recording, Scan, Scene, Sensor, SensorAddress,
    Setup, Simulated, Simulation, StageSpec, Staged, read_noise, read_rod, write_profiles,
};

/// A sweep stopped early, or is not what the paper found; a recording does not fit its rod.
const UNFINISHED: u8 = 2;

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Sweep { scene, out } => sweep(&scene, out),
        Command::Contour { scene, out, tolerance, object } => contour(&scene, out, tolerance, object),
        Command::Simulate(arguments) => simulate(arguments),
        Command::Reconstruct { recording, written, rod, truth, out } => {
            reconstruct(&recording, &written.into(), &rod, truth, out)
        }
        Command::Live { sensor, written, rod, stage, path, setup, out } => {
            live(&sensor, written.into(), &rod, stage, path.as_deref(), setup.as_deref(), &out)
        }
        Command::FakeSensor(arguments) => fake_sensor(arguments),
        Command::Paper { out } => paper(&out),
    };
    result.unwrap_or_else(|error| {
        complain(error);
        ExitCode::FAILURE
    })
}

fn sweep(file: &Path, out: Option<PathBuf>) -> Result<ExitCode, Error> {
    let scene = Scene::read(file)?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let staged = Staged::new(&out)?;
    let scan = Scan::run(scene)?;
    scan.write(&staged, Path::new(""))?;
    staged.publish()?;
    say(&scan.report());
    say(&format!("written to {}\n", out.display()));
    Ok(verdict([&scan]))
}

fn contour(
    file: &Path,
    out: Option<PathBuf>,
    tolerance: Option<f64>,
    object: Option<usize>,
) -> Result<ExitCode, Error> {
    let scene = Scene::read(file)?;
    let profiles = scene.profiles(tolerance, object)?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name).join("contour.csv"));
    let drawing = write_profiles(&scene.name, &profiles, &out)?;
    for profile in &profiles {
        let length = profile.points.last().map_or(0.0, |point| point.arc_length);
        let (object, count) = (profile.object, profile.points.len());
        say(&format!("{}: object {object}: {count} points along {:.6} mm\n", scene.name, 1e3 * length));
    }
    say(&format!("written to {} and {}\n", out.display(), drawing.display()));
    Ok(ExitCode::SUCCESS)
}

fn simulate(arguments: Simulate) -> Result<ExitCode, Error> {
    let Simulate { scene, noise, rate, speed, seed, sigmas, out } = arguments;
    let scene = Scene::read(&scene)?;
    let noise = noise.map_or_else(|| Ok(NoiseModel::default()), |file| read_noise(&file))?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name).join("recording.csv"));
    let simulation = Simulation { scene, noise, rate, speed, seed, sigmas };
    let Simulated { samples, lost, stop } = simulation.write(&out)?;
    let name = &simulation.scene.name;
    say(&format!("{name}: {samples} samples, {lost} lost in dropouts\nwritten to {}\n", out.display()));
    Ok(stop.map_or(ExitCode::SUCCESS, |stop| stopped(name, &stop)))
}

fn reconstruct(
    file: &Path,
    how: &Reading,
    rod: &Path,
    truth: Option<PathBuf>,
    out: Option<PathBuf>,
) -> Result<ExitCode, Error> {
    let rod = read_rod(rod)?;
    let truth = truth.map(|scene| Scene::read(&scene)).transpose()?;
    let recording = Recording::read(file, &rod, how)?;
    for warning in recording.warnings() {
        warn(&format!("warning: {warning}\n"));
    }
    let mut found = Reconstructed::new(recording, rod)?;
    if let Some(scene) = truth {
        found.compare(scene)?;
    }
    let out = out.unwrap_or_else(|| Path::new("out").join(&found.name));
    let staged = Staged::new(&out)?;
    found.write(&staged)?;
    staged.publish()?;
    say(&found.summary());
    say(&format!("written to {}\n", out.display()));
    if found.check.fits() {
        return Ok(ExitCode::SUCCESS);
    }
    for finding in found.check.findings.iter().filter(|finding| finding.is_misfit()) {
        warn(&format!("warning: {}: {finding}\n", file.display()));
    }
    Ok(ExitCode::from(UNFINISHED))
}

fn live(
    address: &SensorAddress,
    reading: Reading,
    rod: &Path,
    stage: Option<StageSpec>,
    path: Option<&Path>,
    setup: Option<&Path>,
    out: &Path,
) -> Result<ExitCode, Error> {
    let setup = setup.map_or_else(|| Ok(Setup::default()), Setup::read)?;
    let path = match (path, &stage) {
        (Some(scene), _) => Some(Scene::read(scene)?.path),
        // a file with nothing but a rod is no scene: then the path is missed where it is needed
        (None, Some(StageSpec::Constant(_))) => Scene::read(rod).ok().map(|scene| scene.path),
        (None, _) => None,
    };
    let scan = LiveScan { rod: read_rod(rod)?, setup, stage, path, reading };
    let sensor = Sensor::open(address, &scan.setup, &scan.reading)?;
    let interrupted = interrupted();
    let report =
        scan.run(sensor, out, &mut |line| say(&format!("{line}\n")), &|| interrupted.load(Ordering::Relaxed))?;
    say(&report.text());
    say(&format!("written to {}\n", out.display()));
    Ok(if report.is_complete() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}

fn fake_sensor(arguments: FakeSensor) -> Result<ExitCode, Error> {
    let FakeSensor { scene, protocol, rate, speed, faster, noise, seed, setup, port, scaling_port } = arguments;
    let scene = Scene::read(&scene)?;
    let noise = noise.map_or_else(|| Ok(NoiseModel::default()), |file| read_noise(&file))?;
    let setup = setup.map_or_else(|| Ok(Setup::default()), |file| Setup::read(&file))?;
    let name = scene.name.clone();
    let simulation = Simulation { scene, noise, rate, speed, seed, sigmas: false };
    let interrupted = interrupted();
    let scan = FakeScan { simulation, setup, protocol, faster, port, scaling_port };
    let Played { samples, sent, stop } =
        scan.run(&mut |line| say(&format!("{line}\n")), &|| interrupted.load(Ordering::Relaxed))?;
    say(&format!("{sent} of {samples} samples sent\n"));
    Ok(stop.map_or(ExitCode::SUCCESS, |stop| stopped(&name, &stop)))
}

/// Set once somebody presses Ctrl-C; a second time ends the process.
fn interrupted() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    // without a handler Ctrl-C ends the process at once, which loses the summary only
    let _ = ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    flag
}

fn paper(out: &Path) -> Result<ExitCode, Error> {
    let staged = Staged::new(out)?;
    // Hidden by itself where stderr is no terminal.
    let bar = ProgressBar::new(Paper::SCANS as u64).with_message("scans");
    bar.tick();
    let paper = Paper::run(|| bar.inc(1))?;
    bar.finish_and_clear();
    paper.write(&staged)?;
    staged.publish()?;
    say(&paper.report());
    say(&format!("written to {}\n", out.display()));
    let finished = verdict(paper.scans.iter().map(|scan| &scan.scan));
    let agrees = paper.scans.iter().all(|scan| scan.matches());
    Ok(if agrees { finished } else { ExitCode::from(UNFINISHED) })
}

/// Tells of the sweeps that stopped early.
fn verdict<'a>(scans: impl IntoIterator<Item = &'a Scan>) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for scan in scans {
        if let Some(stop) = &scan.outcome.stop {
            code = stopped(&scan.scene.name, stop);
        }
    }
    code
}

fn stopped(name: &str, stop: &Stop) -> ExitCode {
    warn(&format!("warning: {name}: {stop}; everything before that is written\n"));
    ExitCode::from(UNFINISHED)
}

/// Shows an error: with the place in the scene for people, on one line for everything else.
fn complain(error: Error) {
    if io::stderr().is_terminal() {
        warn(&format!("{:?}\n", miette::Report::new(error)));
    } else {
        warn(&format!("error: {error}\n"));
    }
}

/// To standard output; a reader that has gone away is no reason to fail, for the files are written.
fn say(text: &str) {
    let _ = io::stdout().write_all(text.as_bytes());
}

fn warn(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}
