//! The command `vibrissa`.

mod arguments;
mod signals;

use arguments::{Arguments, Command, FakeSensor, Simulate};
use clap::Parser;
use indicatif::ProgressBar;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use vibrissa::{NoiseModel, Stop};
use vibrissa_cli::{
    Error, FakeScan, Interrupted, LiveScan, Paper, Played, Reading, Reconstructed, Recording, Scan, Scene, SceneError,
    Sensor, SensorAddress, Setup, Simulated, Simulation, StageSpec, Staged, read_noise, read_rod, write_profiles,
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

/// Reads a scene, and tells of what may be a mistake in it.
fn read_scene(file: &Path) -> Result<Scene, SceneError> {
    let scene = Scene::read(file)?;
    scene.warnings.iter().for_each(|warning| warn(&format!("warning: {warning}\n")));
    Ok(scene)
}

fn read_setup(file: &Path) -> Result<Setup, SceneError> {
    let setup = Setup::read(file)?;
    setup.warnings.iter().for_each(|warning| warn(&format!("warning: {warning}\n")));
    Ok(setup)
}

fn sweep(file: &Path, out: Option<PathBuf>) -> Result<ExitCode, Error> {
    let scene = read_scene(file)?;
    scene.check_start()?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let caught = signals::ask();
    let staged = Staged::new(&out)?;
    let scan = Scan::run_until(scene, &caught.interrupt)?;
    if let Some(at) = scan.interrupted.filter(|_| scan.outcome.states.is_empty()) {
        return Ok(interrupted(&scan.scene.name, &at, None, &caught));
    }
    scan.write(&staged, Path::new(""))?;
    staged.publish()?;
    say(&scan.report());
    say(&format!("written to {}\n", out.display()));
    Ok(match &scan.interrupted {
        Some(at) => interrupted(&scan.scene.name, at, Some("sweep.json"), &caught),
        None => verdict([&scan]),
    })
}

fn contour(
    file: &Path,
    out: Option<PathBuf>,
    tolerance: Option<f64>,
    object: Option<usize>,
) -> Result<ExitCode, Error> {
    signals::end();
    let scene = read_scene(file)?;
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
    let scene = read_scene(&scene)?;
    scene.check_start()?;
    let noise = noise.map_or_else(|| Ok(NoiseModel::default()), |file| read_noise(&file))?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name).join("recording.csv"));
    let simulation = Simulation { scene, noise, rate, speed, seed, sigmas };
    let caught = signals::ask();
    let Simulated { samples, lost, stop, interrupted: at } = simulation.write(&out, &caught.interrupt)?;
    let name = &simulation.scene.name;
    if let Some(at) = at.filter(|_| samples == 0) {
        return Ok(interrupted(name, &at, None, &caught));
    }
    say(&format!("{name}: {samples} samples, {lost} lost in dropouts\nwritten to {}\n", out.display()));
    Ok(match (at, stop) {
        (Some(at), _) => interrupted(name, &at, Some("the last line of the file"), &caught),
        (None, Some(stop)) => stopped(name, &stop),
        (None, None) => ExitCode::SUCCESS,
    })
}

fn reconstruct(
    file: &Path,
    how: &Reading,
    rod: &Path,
    truth: Option<PathBuf>,
    out: Option<PathBuf>,
) -> Result<ExitCode, Error> {
    signals::end();
    let rod = read_rod(rod)?;
    let truth = truth.map(|scene| read_scene(&scene)).transpose()?;
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
    let setup = setup.map_or_else(|| Ok(Setup::default()), read_setup)?;
    let path = match (path, &stage) {
        (Some(scene), _) => Some(read_scene(scene)?.path),
        // a file with nothing but a rod is no scene: then the path is missed where it is needed
        (None, Some(StageSpec::Constant(_))) => read_scene(rod).ok().map(|scene| scene.path),
        (None, _) => None,
    };
    let scan = LiveScan { rod: read_rod(rod)?, setup, stage, path, reading };
    let sensor = Sensor::open(address, &scan.setup, &scan.reading)?;
    let interrupt = signals::ask().interrupt;
    let report = scan.run(sensor, out, &mut |line| say(&format!("{line}\n")), &|| interrupt.is_raised())?;
    say(&report.text());
    say(&format!("written to {}\n", out.display()));
    Ok(if report.is_complete() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}

fn fake_sensor(arguments: FakeSensor) -> Result<ExitCode, Error> {
    let FakeSensor { scene, protocol, rate, speed, faster, noise, seed, setup, port, scaling_port } = arguments;
    let scene = read_scene(&scene)?;
    scene.check_start()?;
    let noise = noise.map_or_else(|| Ok(NoiseModel::default()), |file| read_noise(&file))?;
    let setup = setup.map_or_else(|| Ok(Setup::default()), |file| read_setup(&file))?;
    let name = scene.name.clone();
    let simulation = Simulation { scene, noise, rate, speed, seed, sigmas: false };
    let interrupt = signals::ask().interrupt;
    let scan = FakeScan { simulation, setup, protocol, faster, port, scaling_port };
    let Played { samples, sent, stop } = scan.run(&mut |line| say(&format!("{line}\n")), &|| interrupt.is_raised())?;
    say(&format!("{sent} of {samples} samples sent\n"));
    Ok(stop.map_or(ExitCode::SUCCESS, |stop| stopped(&name, &stop)))
}

fn paper(out: &Path) -> Result<ExitCode, Error> {
    let caught = signals::ask();
    let staged = Staged::new(out)?;
    // Hidden by itself where stderr is no terminal.
    let bar = ProgressBar::new(Paper::SCANS as u64).with_message("scans");
    bar.tick();
    let paper = Paper::run(&caught.interrupt, || bar.inc(1))?;
    bar.finish_and_clear();
    let done = paper.scans.len();
    if done == 0 {
        warn("warning: paper: interrupted before the first scan was done; nothing is written\n");
        return Ok(caught.status());
    }
    let complete = paper.write(&staged, &caught.interrupt)?;
    staged.publish()?;
    say(&paper.report());
    say(&format!("written to {}\n", out.display()));
    if !complete {
        let written = if paper.is_complete() {
            "interrupted while the figures of all scans were drawn; the scans are written without these figures"
                .to_owned()
        } else {
            format!("interrupted with {done} of {} scans done; these are written", Paper::SCANS)
        };
        warn(&format!("warning: paper: {written}, and paper.json says that the results are incomplete\n"));
        return Ok(caught.status());
    }
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

/// Tells of an interruption; `marked` is what says so among the results, if there are any.
fn interrupted(name: &str, at: &Interrupted, marked: Option<&str>, caught: &signals::Caught) -> ExitCode {
    let written = marked.map_or_else(
        || "nothing is written".to_owned(),
        |place| format!("everything before that is written, and {place} says that it is incomplete"),
    );
    warn(&format!("warning: {name}: {at}; {written}\n"));
    caught.status()
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
