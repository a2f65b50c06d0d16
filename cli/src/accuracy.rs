//! The commands about accuracy: `calibrate` and `budget`.

use crate::accuracy_arguments::Calibrate;
use crate::{UNFINISHED, read_setup, say, signals, warn};
use std::path::Path;
use std::process::ExitCode;
use vibrissa::reconstruct::Budget;
use vibrissa::{Rod, Settings};
use vibrissa_cli::{Error, OutputError, Recording, RodCalibration, read_known_rod, read_noise};

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
    let drawing = found.write(&out, inputs)?;
    say(&found.report());
    say(&format!("written to {} and {}\n", out.display(), drawing.display()));
    found.findings.iter().for_each(|finding| warn(&format!("warning: {finding}\n")));
    Ok(if found.findings.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}
