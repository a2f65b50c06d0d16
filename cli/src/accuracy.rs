//! The commands about accuracy: `calibrate` and `budget`.

use crate::accuracy_arguments::{Calibrate, Expect};
use crate::{UNFINISHED, read_scene, read_setup, say, signals, stopped, warn};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use vibrissa::reconstruct::Budget;
use vibrissa::{Rod, Settings};
use vibrissa_cli::{BudgetStudy, Error, OutputError, Recording, RodCalibration, Staged, read_known_rod, read_noise};

/// The budget of a setup, if it has one.
pub fn budget(setup: Option<&Path>, rod: &Rod) -> Result<Option<Budget>, Error> {
    let setup = setup.map(read_setup).transpose()?;
    Ok(setup.and_then(|setup| setup.errors).map(|errors| errors.budget(rod)))
}

pub fn calibrate(arguments: Calibrate) -> Result<ExitCode, Error> {
    let Calibrate { recordings, rod, setup, noise, free, out, written } = arguments;
    signals::end();
    if crate::is_standard(&out) {
        return Err(OutputError::NoFile { file: out }.into());
    }
    let inputs: Vec<_> = recordings.iter().chain([&rod]).chain(&setup).chain(&noise).cloned().collect();
    vibrissa_cli::check_output(&out, &inputs)?;
    let given = read_known_rod(&rod)?;
    let noise = noise.map(|file| read_noise(&file)).transpose()?;
    let settings = Settings {
        noise: noise.map(|model| model.channels()),
        budget: budget(setup.as_deref(), &given.rod)?,
        known: given.known,
        ..Settings::default()
    };
    let how = written.into();
    let mut read = Vec::with_capacity(recordings.len());
    for file in &recordings {
        let recording = Recording::read(file, &given.rod, &how)?;
        recording.warnings().iter().for_each(|warning| warn(&format!("warning: {warning}\n")));
        read.push(recording);
    }
    let found = RodCalibration::new(&read, &given, &settings, &free)?;
    say(&found.report());
    if found.combined.contradicts() {
        say("nothing is written\n");
    } else {
        let drawing = found.write(&out, inputs)?;
        say(&format!("written to {} and {}\n", out.display(), drawing.display()));
    }
    found.findings.iter().for_each(|finding| warn(&format!("warning: {finding}\n")));
    Ok(if found.findings.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}

pub fn expect(arguments: Expect) -> Result<ExitCode, Error> {
    let Expect { scene, setup, noise, rate, speed, runs, seed, out } = arguments;
    signals::end();
    let scene = read_scene(&scene)?;
    scene.check_start()?;
    let inputs: Vec<PathBuf> = scene.files.iter().chain(&setup).chain(&noise).cloned().collect();
    let budget = budget(setup.as_deref(), &scene.rod)?;
    let noise = noise.map(|file| read_noise(&file)).transpose()?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let staged = Staged::new(&out)?.keeping(inputs);
    let expected = BudgetStudy { scene, budget, noise, rate, speed, runs, seed }.run()?;
    expected.write(&staged)?;
    staged.publish()?;
    say(&expected.report());
    say(&format!("written to {}\n", out.display()));
    Ok(expected.stop.as_ref().map_or(ExitCode::SUCCESS, |stop| stopped(&expected.scene.name, stop)))
}
