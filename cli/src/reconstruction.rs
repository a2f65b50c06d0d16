//! The command `reconstruct`.

use crate::arguments::{Reconstruct, Trust};
use crate::error::Error;
use crate::progress::stage;
use crate::{UNFINISHED, complain, read_scene, read_setup, say, scan_of, signals, warn};
use rod_files::{
    CalibratedRod, LiveScan, Reconstructed, Recording, Scene, Setup, Staged, Together, read_calibrated_rod, read_noise,
};
use std::path::Path;
use std::process::ExitCode;
use vibrissa::reconstruct::{Budget, Known};
use vibrissa::rod::AnyRod;
use vibrissa::{Rod, Settings};
use vibrissa_cli::{Merged, write_reconstruction};

pub fn reconstruct(arguments: Reconstruct) -> Result<ExitCode, Error> {
    let Reconstruct { recordings, rod, truth, out, align, local, moved, trust, written } = arguments;
    signals::end();
    let given = read_calibrated_rod(&rod)?;
    let setup = trust.setup.as_deref().map_or_else(|| Ok(Setup::default()), read_setup)?;
    let settings = settings(&trust, &given, &setup)?;
    let mut scan = scan_of(*given.rod.at_clamp(), given.known, rod, moved, setup, written.into())?;
    scan.inputs.extend(recordings.iter().chain(&trust.noise).cloned());
    if let Some(file) = &truth {
        let scene = read_scene(file)?;
        scene.check_start()?;
        scan.inputs.extend(scene.files.iter().cloned());
    }
    if align.is_some() && recordings.len() == 1 {
        warn("warning: --align is for several recordings: it is not used\n");
    }
    let mut found = Vec::with_capacity(recordings.len());
    let mut left_out = Vec::new();
    for file in &recordings {
        match one(file, &scan, &given.rod, &settings) {
            Ok(one) => found.push(one),
            Err(error) => left_out.push(error),
        }
    }
    // what can be computed of the others is not lost
    if found.is_empty()
        && let Some(error) = left_out.pop()
    {
        return Err(error);
    }
    let together = match &mut found[..] {
        _ if local => None,
        // scans that are to be moved are not in one frame
        several @ [_, _, ..] if align.is_none() => Together::fit(several, &settings, |what| stage(&what)),
        apart => {
            for one in apart {
                stage(&format!("{}: fitting one contour to the whole recording", one.recording.file.display()));
                one.fit(&settings);
            }
            None
        }
    };
    for one in &mut found {
        if let Err(error) = judge(one, &settings, truth.as_deref()) {
            left_out.push(error);
        }
    }
    if recordings.len() == 1
        && let Some(error) = left_out.pop()
    {
        return Err(error);
    }
    let complete = left_out.is_empty();
    left_out.into_iter().for_each(complain);
    if let ([one], 1) = (&found[..], recordings.len()) {
        let out = out.unwrap_or_else(|| Path::new("out").join(&one.name));
        let staged = Staged::new(&out)?.keeping(scan.inputs);
        write_reconstruction(one, &staged, Path::new(""))?;
        staged.publish()?;
        say(&one.summary());
        say(&format!("written to {}\n", out.display()));
    } else {
        let out = out.unwrap_or_else(|| Path::new("out").join("merged"));
        let staged = Staged::new(&out)?.keeping(scan.inputs);
        let merged = Merged::of(&mut found, align.map(f64::to_radians), together);
        found.iter().try_for_each(|one| write_reconstruction(one, &staged, Path::new(&one.name)))?;
        merged.write(&staged)?;
        staged.publish()?;
        found.iter().for_each(|one| say(&format!("{}\n", one.summary())));
        say(&merged.summary());
        say(&format!("written to {}\n", out.display()));
        let contradictions = merged.contradictions();
        contradictions.iter().for_each(|why| warn(&format!("warning: {why}\n")));
        let code = verdict(&found);
        return Ok(match (complete, contradictions.is_empty()) {
            (false, _) => ExitCode::FAILURE,
            (_, false) => ExitCode::from(UNFINISHED),
            _ => code,
        });
    }
    Ok(verdict(&found))
}

/// Reads one recording, and reconstructs its samples.
fn one(file: &Path, scan: &LiveScan, rod: &AnyRod, settings: &Settings) -> Result<Reconstructed, Error> {
    let name = file.display();
    stage(&format!("{name}: reading"));
    let recording = read(file, scan)?;
    stage(&format!("{name}: kinks, phases, errors and contact points of {} samples", recording.samples().count()));
    Ok(Reconstructed::new(recording, rod.clone(), settings)?)
}

/// Looks for the cause of a misfit, and compares with the truth.
fn judge(found: &mut Reconstructed, settings: &Settings, truth: Option<&Path>) -> Result<(), Error> {
    let name = found.recording.file.display().to_string();
    if !found.fits() {
        stage(&format!("{name}: looking for the cause of the misfit"));
        found.explain(settings);
    }
    if let Some(scene) = truth {
        stage(&format!("{name}: comparing with the scene"));
        found.compare(Scene::read(scene)?)?;
    }
    Ok(())
}

/// Reads a recording of any kind, and tells of what cannot be used of it.
pub fn read(file: &Path, scan: &LiveScan) -> Result<Recording, Error> {
    let recording = scan.recording(file)?;
    recording.warnings().iter().for_each(|warning| warn(&format!("warning: {warning}\n")));
    Ok(recording)
}

/// Tells of what does not fit.
fn verdict(found: &[Reconstructed]) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for found in found {
        let file = found.recording.file.display();
        for finding in found.warnings() {
            warn(&format!("warning: {file}: {finding}\n"));
        }
        for doubt in found.doubts() {
            warn(&format!("warning: {file}: {doubt}\n"));
        }
        if let Some(why) = found.contradiction() {
            warn(&format!("warning: {file}: {why}\n"));
            code = ExitCode::from(UNFINISHED);
        }
        if found.fits() {
            continue;
        }
        if let Some(causes) = found.explained() {
            warn(&format!("warning: {file}: {causes}\n"));
        }
        code = ExitCode::from(UNFINISHED);
    }
    code
}

/// The settings of a reconstruction.
fn settings(trust: &Trust, given: &CalibratedRod, setup: &Setup) -> Result<Settings, Error> {
    let Trust { as_is, noise, friction, false_alarms, largest_sigma, .. } = trust;
    let noise = noise.as_deref().map(read_noise).transpose()?;
    let default = Settings::default();
    if *as_is && setup.errors.is_some() {
        warn("warning: --as-is corrects nothing: the table [errors] of --setup is not used\n");
    }
    Ok(Settings {
        noise: noise.map(|model| model.channels()),
        false_alarms: false_alarms.unwrap_or(default.false_alarms),
        largest_sigma: largest_sigma.unwrap_or(default.largest_sigma),
        budget: if *as_is { Some(Budget::NONE) } else { budget(setup, given.rod.at_clamp()) },
        known: if *as_is { Known::NOTHING } else { given.known },
        friction: *friction,
    })
}

/// The budget of a setup, if it has one.
pub fn budget(setup: &Setup, rod: &Rod) -> Option<Budget> {
    setup.errors.map(|errors| errors.budget(rod))
}
