//! The command `vibrissa`.

mod accuracy;
mod accuracy_arguments;
mod arguments;
mod error;
mod film;
mod guide;
mod inspection;
mod planning;
mod progress;
mod reconstruction;
mod recording_arguments;
mod signals;
mod values;

use crate::error::{Error, OptionError};
use arguments::{Arguments, Command, FakeSensor, Live, Simulate};
use clap::{CommandFactory, Parser};
use indicatif::ProgressBar;
use progress::Progress;
use recording_arguments::Moved;
use rod_files::output::check_output;
use rod_files::{
    ElasticaScene, Interrupted, LiveScan, OutputError, ReadOptions, Scan, Scene, SceneError, Sensor, SensorAddress,
    Setup, Simulated, Simulation, StageSpec, Staged, Study, StudyRun, read_noise, read_uniform_rod,
    write_profile_table,
};
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use vibrissa::Rod;
use vibrissa::contact::Stop;
use vibrissa::reconstruct::{Budget, Known, NoiseModel};
use vibrissa_cli::{FakeScan, FirstScene, Paper, Played, shapes_list, write_elastica, write_profiles, write_sweep};

/// A sweep stopped early, or is not what the paper found; a recording does not fit its rod.
const UNFINISHED: u8 = 2;

/// The same status that the parser of the command line has for options that are none.
const WRONG_OPTIONS: u8 = 2;

/// Name of the command.
const NAME: &str = "vibrissa";

/// Whether reports are left out.
static QUIET: AtomicBool = AtomicBool::new(false);

fn main() -> ExitCode {
    let Arguments { quiet, command } = Arguments::parse();
    QUIET.store(quiet, Ordering::Relaxed);
    let result = match command {
        Command::Init { file, first } => init(&first.scene(), &file),
        Command::Shapes => print(shapes_list().as_bytes()),
        Command::Completions { shell } => completions(shell),
        Command::Man { command } => man(command.as_deref()),
        Command::Sweep { scene, out } => sweep(&scene, out),
        Command::Elastica { file, out } => elastica(&file, out),
        Command::Contour { scene, file, tolerance, object } => contour(&scene, file, tolerance, object),
        Command::Simulate(arguments) => simulate(arguments),
        Command::Inspect(arguments) => inspection::inspect(arguments),
        Command::Reconstruct(arguments) => reconstruction::reconstruct(arguments),
        Command::Forces(arguments) => film::forces(arguments),
        Command::Budget(arguments) => accuracy::expect(arguments),
        Command::Calibrate(arguments) => accuracy::calibrate(arguments),
        Command::Live(arguments) => live(arguments),
        Command::FakeSensor(arguments) => fake_sensor(arguments),
        Command::Study { study, out, scene, jobs } => run_study(&study, out, scene, jobs),
        Command::Plan(arguments) => planning::plan(arguments),
        Command::Reach(arguments) => planning::reach(arguments),
        Command::Paper { out } => paper(&out),
    };
    result.unwrap_or_else(|error| match error.of_output() {
        // who reads has seen enough, as in `| head`
        Some(OutputError::Standard(source)) if is_broken_pipe(source) => ExitCode::SUCCESS,
        _ => {
            let wrong_options = error.is_of_options();
            complain(error);
            if wrong_options { ExitCode::from(WRONG_OPTIONS) } else { ExitCode::FAILURE }
        }
    })
}

/// Whether the reader of standard output has gone away, also where the table's writer says so.
fn is_broken_pipe(error: &io::Error) -> bool {
    let table = error.get_ref().and_then(|inner| inner.downcast_ref::<csv::Error>()).map(csv::Error::kind);
    match table {
        Some(csv::ErrorKind::Io(inner)) => inner.kind() == ErrorKind::BrokenPipe,
        _ => error.kind() == ErrorKind::BrokenPipe,
    }
}

fn init(first: &FirstScene, file: &Path) -> Result<ExitCode, Error> {
    first.write(file)?;
    let file = file.display();
    say(&format!("written to {file}; next: vibrissa sweep {file}\n"));
    Ok(ExitCode::SUCCESS)
}

fn completions(shell: clap_complete::Shell) -> Result<ExitCode, Error> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), NAME, &mut text);
    print(&text)
}

/// Prints a manual page: of the whole, or of one command.
fn man(command: Option<&str>) -> Result<ExitCode, Error> {
    let mut whole = Arguments::command();
    whole.build();
    let page = match command {
        None => whole,
        Some(name) => match whole.find_subcommand(name) {
            Some(command) => command.clone().display_name(format!("{NAME}-{name}")),
            None => {
                let names: Vec<&str> = whole.get_subcommands().map(clap::Command::get_name).collect();
                warn(&format!("error: {name} is no command, expected one of {}\n", names.join(", ")));
                return Ok(ExitCode::from(UNFINISHED));
            }
        },
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).map_err(OutputError::Standard)?;
    // what stands behind the help has no name of its own there
    let title = if command.is_none() { "FIRST STEPS AND EXIT STATUS" } else { "EXAMPLES AND NEXT STEPS" };
    let text = String::from_utf8_lossy(&text).replace(".SH EXTRA", &format!(".SH \"{title}\""));
    print(text.as_bytes())
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
    let staged = Staged::new(&out)?.keeping(scene.files.clone());
    let progress = Progress::of(&caught.interrupt);
    let scan = Scan::run_until(scene, &caught.interrupt)?;
    drop(progress);
    if let Some(at) = scan.interrupted.filter(|_| scan.outcome.states.is_empty()) {
        return Ok(interrupted(&scan.scene.name, &at, None, &caught));
    }
    write_sweep(&scan, &staged, Path::new(""))?;
    staged.publish()?;
    say(&scan.report());
    say(&format!("written to {}\n", out.display()));
    Ok(match &scan.interrupted {
        Some(at) => interrupted(&scan.scene.name, at, Some("sweep.json"), &caught),
        None => verdict([&scan]),
    })
}

fn elastica(file: &Path, out: Option<PathBuf>) -> Result<ExitCode, Error> {
    signals::end();
    let scene = ElasticaScene::read(file)?;
    scene.warnings.iter().for_each(|warning| warn(&format!("warning: {warning}\n")));
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let staged = Staged::new(&out)?.keeping(vec![scene.file.clone()]);
    let run = scene.solve()?;
    write_elastica(&run, &staged)?;
    staged.publish()?;
    say(&run.report());
    say(&format!("written to {}\n", out.display()));
    Ok(ExitCode::SUCCESS)
}

fn contour(
    scene: &Path,
    file: Option<PathBuf>,
    tolerance: Option<f64>,
    object: Option<usize>,
) -> Result<ExitCode, Error> {
    signals::end();
    let scene = read_scene(scene)?;
    let profiles = scene.profiles(tolerance, object)?;
    let out = file.unwrap_or_else(|| Path::new("out").join(&scene.name).join("contour.csv"));
    let tell: fn(&str) = if is_standard(&out) { tell_beside } else { say };
    let written = if is_standard(&out) {
        write_profile_table(&profiles, &mut io::stdout().lock()).map_err(OutputError::Standard)?;
        "standard output".to_owned()
    } else {
        let drawing = write_profiles(&scene.name, &profiles, &out, scene.files)?;
        format!("{} and {}", out.display(), drawing.display())
    };
    for profile in &profiles {
        let length = profile.points.last().map_or(0.0, |point| point.arc_length);
        let (object, count) = (profile.object, profile.points.len());
        tell(&format!("{}: object {object}: {count} points along {:.6} mm\n", scene.name, 1e3 * length));
    }
    tell(&format!("written to {written}\n"));
    Ok(ExitCode::SUCCESS)
}

fn simulate(arguments: Simulate) -> Result<ExitCode, Error> {
    let Simulate { scene, noise, rate, speed, seed, sigmas, file } = arguments;
    let scene = read_scene(&scene)?;
    scene.check_start()?;
    let out = file.unwrap_or_else(|| Path::new("out").join(&scene.name).join("recording.csv"));
    let standard = is_standard(&out);
    if !standard {
        check_output(&out, &noise.iter().cloned().collect::<Vec<_>>())?;
    }
    let noise = noise.map_or_else(|| Ok(NoiseModel::default()), |file| read_noise(&file))?;
    let speed = speed.of(&scene)?;
    let simulation = Simulation { scene, noise, rate, speed, seed, sigmas };
    let caught = signals::ask();
    let tell: fn(&str) = if standard { tell_beside } else { say };
    let progress = Progress::of(&caught.interrupt);
    let Simulated { samples, lost, stop, interrupted: at } = if standard {
        simulation.write_to(&mut BufWriter::new(io::stdout().lock()), &caught.interrupt)?
    } else {
        simulation.write(&out, &caught.interrupt)?
    };
    drop(progress);
    let name = &simulation.scene.name;
    if let Some(at) = at.filter(|_| samples == 0) {
        return Ok(interrupted(name, &at, None, &caught));
    }
    let place = if standard { "standard output".to_owned() } else { out.display().to_string() };
    tell(&format!("{name}: {samples} samples, {lost} lost in dropouts\nwritten to {place}\n"));
    Ok(match (at, stop) {
        (Some(at), _) => interrupted(name, &at, Some("the last line of the file"), &caught),
        (None, Some(stop)) => stopped(name, &stop),
        (None, None) => ExitCode::SUCCESS,
    })
}

/// What may be done with a rod that `live` does not take.
const NOT_LIVE: &str = "`live` takes a uniform, straight rod on a rigid clamp only: record the samples, and give the recording to \
     `vibrissa reconstruct --rod`, which takes any rod on any clamp";

/// What may be done with a clamp that `fake-sensor` does not take.
const NOT_PLAYED: &str = "a sensor measures the moment about a point of the support, but the base moves relative to it: write the reactions at the base with \
     `vibrissa simulate`, which takes any clamp, and give them to `vibrissa reconstruct`";

fn live(arguments: Live) -> Result<ExitCode, Error> {
    let Live { sensor: address, rod, moved, setup, as_is, out, written } = arguments;
    let setup = setup.map_or_else(|| Ok(Setup::default()), |file| read_setup(&file))?;
    let (uniform, known) = read_uniform_rod(&rod, NOT_LIVE)?;
    let mut scan = scan_of(uniform, known, rod, moved, setup, written.into())?;
    if as_is {
        (scan.budget, scan.known) = (Budget::NONE, Known::NOTHING);
    }
    if let SensorAddress::File(file) = &address {
        scan.inputs.push(file.clone());
    }
    let sensor = Sensor::open(&address, &scan.setup, &scan.read)?;
    let interrupt = signals::ask().interrupt;
    let report = scan.run(sensor, &out, &mut |line| say(&format!("{line}\n")), &|| interrupt.is_raised())?;
    say(&report.text());
    say(&format!("written to {}\n", out.display()));
    Ok(if report.is_complete() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}

/// A scan with a sensor whose rod stands in `file`.
fn scan_of(
    rod: Rod,
    known: Known,
    file: PathBuf,
    moved: Moved,
    setup: Setup,
    read: ReadOptions,
) -> Result<LiveScan, Error> {
    let Moved { stage, stage_delay, path } = moved;
    if stage_delay.is_some() && !matches!(stage, Some(StageSpec::Table(_))) {
        let why = "it shifts the times of a table, expected --stage table:FILE; a constant speed starts with the first sample".to_owned();
        return Err(OptionError { option: "--stage-delay", why }.into());
    }
    let told = match (&path, &stage) {
        (Some(scene), _) => {
            let scene = read_scene(scene)?;
            scene.check_single_leg()?;
            Some(scene.path)
        }
        // a file with nothing but a rod is no scene: then the path is missed where it is needed
        (None, Some(StageSpec::Constant(_))) => read_scene(&file).ok().map(|scene| scene.path),
        (None, _) => None,
    };
    let table = if let Some(StageSpec::Table(table)) = &stage { Some(table.clone()) } else { None };
    let inputs = [file].into_iter().chain(setup.files.iter().cloned()).chain(path).chain(table).collect();
    let budget = setup.errors.unwrap_or_default().budget(&rod);
    Ok(LiveScan { rod, budget, known, setup, stage, stage_delay, path: told, read, inputs })
}

fn fake_sensor(arguments: FakeSensor) -> Result<ExitCode, Error> {
    let FakeSensor { scene, protocol, rate, speed, faster, noise, seed, setup, port, scaling_port } = arguments;
    let scene = read_scene(&scene)?;
    scene.check_rigid(NOT_PLAYED)?;
    scene.check_single_leg()?;
    scene.check_start()?;
    let noise = noise.map_or_else(|| Ok(NoiseModel::default()), |file| read_noise(&file))?;
    let setup = setup.map_or_else(|| Ok(Setup::default()), |file| read_setup(&file))?;
    let (name, speed) = (scene.name.clone(), speed.of(&scene)?);
    let interrupt = signals::ask().interrupt;
    let tell: &mut dyn FnMut(&str) = &mut |line| say(&format!("{line}\n"));
    let is_over = || interrupt.is_raised();
    let simulation = Simulation { scene, noise, rate, speed, seed, sigmas: false };
    let Played { samples, sent, stop } =
        FakeScan { simulation, setup, protocol, faster, port, scaling_port }.run(tell, &is_over)?;
    say(&format!("{sent} of {samples} samples sent\n"));
    Ok(stop.map_or(ExitCode::SUCCESS, |stop| stopped(&name, &stop)))
}

fn run_study(file: &Path, out: Option<PathBuf>, scene: Option<usize>, jobs: Option<usize>) -> Result<ExitCode, Error> {
    if let Some(jobs) = jobs {
        // fails only where the threads are there already
        let _ = rayon::ThreadPoolBuilder::new().num_threads(jobs).build_global();
    }
    let study = Study::read(file)?;
    if let Some(number) = scene {
        return print(study.text(number)?.as_bytes());
    }
    let name = file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
    let out = out.unwrap_or_else(|| Path::new("out").join(&name));
    let caught = signals::ask();
    let progress = Progress::of(&caught.interrupt);
    let run = study.run(&out, &caught.interrupt)?;
    drop(progress);
    let StudyRun { scenes, found, done, stopped, refused, first_refusal, complete } = run;
    say(&format!(
        "{name}: {scenes} scenes: {done} done, {stopped} stopped early, {refused} refused; {found} rows from an earlier run\nwritten to {}\n",
        out.display()
    ));
    if let Some((number, reason)) = first_refusal {
        warn(&format!("{name}: the first refused scene is {number}: {reason}\n"));
    }
    if !complete {
        warn(&format!("{name}: interrupted; the same command continues\n"));
        return Ok(caught.status());
    }
    Ok(if done + stopped == 0 { ExitCode::from(UNFINISHED) } else { ExitCode::SUCCESS })
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
    warn(&format!("warning: {name}: {stop}; the results up to there are written\n"));
    ExitCode::from(UNFINISHED)
}

/// Tells of an interruption; `marked` is what says so among the results, if there are any.
fn interrupted(name: &str, at: &Interrupted, marked: Option<&str>, caught: &signals::Caught) -> ExitCode {
    let written = marked.map_or_else(
        || "nothing is written".to_owned(),
        |place| format!("the results up to there are written, and {place} marks them as incomplete"),
    );
    warn(&format!("warning: {name}: {at}; {written}\n"));
    caught.status()
}

/// Shows an error: with the place in the scene for people, on one line for everything else.
fn complain(error: Error) {
    let error = error.named();
    let hint = error.unread_table().map(|file| format!("`vibrissa inspect {file}` shows what the file holds."));
    if io::stderr().is_terminal() {
        warn(&format!("{:?}\n", miette::Report::new(error)));
        hint.iter().for_each(|hint| warn(&format!("{hint}\n")));
    } else {
        let hint = hint.map_or_else(String::new, |hint| format!("; {hint}"));
        warn(&format!("error: {error}{hint}\n"));
    }
}

/// Whether a table goes to standard output.
fn is_standard(out: &Path) -> bool {
    out == Path::new("-")
}

/// To standard output; a reader that has gone away is no reason to fail, for the files are written.
fn say(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        let _ = io::stdout().write_all(text.as_bytes());
    }
}

/// To standard error, while a table takes standard output.
fn tell_beside(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        warn(text);
    }
}

/// What was asked for, to standard output.
fn print(text: &[u8]) -> Result<ExitCode, Error> {
    io::stdout().write_all(text).map_err(OutputError::Standard)?;
    Ok(ExitCode::SUCCESS)
}

fn warn(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}
