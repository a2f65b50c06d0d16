//! The commands about accuracy: `calibrate` and `budget`.

use crate::accuracy_arguments::{Calibrate, Expect};
use crate::error::Error;
use crate::reconstruction::{budget, read};
use crate::{UNFINISHED, read_scene, read_setup, say, scan_of, signals, stopped, warn};
use rod_files::{OutputError, Recording, Setup, Staged, Study, read_noise, read_uniform_rod};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use vibrissa::Settings;
use vibrissa_cli::{BudgetStudy, RodCalibration, RodComparison};

/// What may be done with a rod that `calibrate` does not take.
const NOT_CALIBRATED: &str = "`calibrate` takes a uniform, straight rod on a rigid clamp only: `vibrissa reconstruct --rod` takes any rod, without \
     corrections";

pub fn calibrate(arguments: Calibrate) -> Result<ExitCode, Error> {
    let Calibrate { recordings, rod, setup, noise, free, friction, file: out, moved, written } = arguments;
    signals::end();
    if crate::is_standard(&out) {
        return Err(OutputError::NoFile { file: out }.into());
    }
    let (uniform, known) = read_uniform_rod(&rod, NOT_CALIBRATED)?;
    let setup = setup.as_deref().map_or_else(|| Ok(Setup::default()), read_setup)?;
    let mut scan = scan_of(uniform, known, rod, moved, setup, written.into())?;
    scan.inputs.extend(recordings.iter().chain(&noise).cloned());
    rod_files::output::check_output(&out, &scan.inputs)?;
    let noise = noise.map(|file| read_noise(&file)).transpose()?;
    let settings = Settings {
        noise: noise.map(|model| model.channels()),
        budget: budget(&scan.setup, &uniform),
        known,
        friction,
        ..Settings::default()
    };
    let recordings: Vec<Recording> = recordings.iter().map(|file| read(file, &scan)).collect::<Result<_, Error>>()?;
    let found = RodCalibration::new(&recordings, uniform, known, &settings, &free)?;
    say(&found.report());
    if found.combined.contradicts() {
        say("nothing is written\n");
    } else {
        let drawing = found.write(&out, scan.inputs)?;
        say(&format!("written to {} and {}\n", out.display(), drawing.display()));
    }
    found.findings.iter().for_each(|finding| warn(&format!("warning: {finding}\n")));
    Ok(if found.findings.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}

pub fn expect(arguments: Expect) -> Result<ExitCode, Error> {
    if arguments.rods {
        return compare_rods(arguments);
    }
    let Expect { scene, rods: _, sigma: _, setup, noise, friction, rate, speed, runs, seed, out } = arguments;
    signals::end();
    let scene = read_scene(&scene)?;
    let rod = BudgetStudy::rod(&scene)?;
    scene.check_single_leg()?;
    scene.check_start()?;
    let inputs: Vec<PathBuf> = scene.files.iter().chain(&setup).chain(&noise).cloned().collect();
    let read = setup.as_deref().map(read_setup).transpose()?;
    let budget = read.and_then(|setup| budget(&setup, &rod));
    let noise = noise.map(|file| read_noise(&file)).transpose()?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let staged = Staged::new(&out)?.keeping(inputs);
    let speed = speed.of(&scene)?;
    let expected = BudgetStudy { scene, budget, noise, friction, rate, speed, runs, seed }.run()?;
    expected.write(&staged)?;
    staged.publish()?;
    say(&expected.report());
    say(&format!("written to {}\n", out.display()));
    Ok(expected.stop.as_ref().map_or(ExitCode::SUCCESS, |stop| stopped(&expected.scene.name, stop)))
}

/// The rods of a study, ranked.
fn compare_rods(arguments: Expect) -> Result<ExitCode, Error> {
    let Expect { scene: file, sigma, noise, rate, speed, out, .. } = arguments;
    signals::end();
    let study = Study::read(&file)?;
    let name = file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
    let out = out.unwrap_or_else(|| Path::new("out").join(&name));
    let inputs = [file, study.scene.clone()].into_iter().chain(noise.clone()).collect();
    // without noise there is none: the arguments say so
    let noise = read_noise(&noise.unwrap_or_default())?;
    let staged = Staged::new(&out)?.keeping(inputs);
    let found = RodComparison { name, study, noise, rate, speed, sigma }.run();
    found.write(&staged)?;
    staged.publish()?;
    say(&found.report());
    say(&format!("written to {}\n", out.display()));
    Ok(if found.is_refused() { ExitCode::from(UNFINISHED) } else { ExitCode::SUCCESS })
}
