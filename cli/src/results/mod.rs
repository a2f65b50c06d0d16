//! The files of results with their figures.

use crate::figure::{self, FigureError};
use rod_files::{
    Approaches, ElasticaRun, FilmForces, OutputError, Planned, Profile, Reached, Reconstructed, Scan, Staged,
    write_profile_table,
};
use std::path::{Path, PathBuf};

/// Why results cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// A file.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A figure.
    #[error(transparent)]
    Figure(#[from] FigureError),
}

/// Writes states.jsonl, states.csv, contacts.csv, events.jsonl, sweep.json and sweep.svg into `folder` of the staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_sweep(scan: &Scan, staged: &Staged, folder: &Path) -> Result<(), WriteError> {
    let figure = figure::sweep(scan)?;
    scan.write(staged, folder)?;
    staged.write(&folder.join("sweep.svg"), |file| file.write_all(figure.as_bytes()))?;
    Ok(())
}

/// Writes points.jsonl, contour.csv, report.json, contour.svg and phases.svg, and where there is a fit fitted.csv and residuals.svg, into `folder` of the
/// staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_reconstruction(found: &Reconstructed, staged: &Staged, folder: &Path) -> Result<(), WriteError> {
    let figures = [("contour.svg", figure::reconstruction(found)?), ("phases.svg", figure::reactions(found)?)];
    let residuals = found.fitted().map(|fit| figure::residuals(found, fit)).transpose()?;
    found.write(staged, folder)?;
    for (name, figure) in figures {
        staged.write(&folder.join(name), |file| file.write_all(figure.as_bytes()))?;
    }
    let file = folder.join("residuals.svg");
    match residuals {
        Some(figure) => staged.write(&file, |file| file.write_all(figure.as_bytes()))?,
        None => staged.remove(&file)?,
    }
    Ok(())
}

/// Writes forces.jsonl, forces.csv, rest.json where a shape at rest was found, frames.svg and forces.svg into the staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_film(found: &FilmForces, staged: &Staged) -> Result<(), WriteError> {
    let figures = [("frames.svg", figure::frames(found)?), ("forces.svg", figure::over_frames(found)?)];
    found.write(staged)?;
    for (name, figure) in figures {
        staged.write(Path::new(name), |file| file.write_all(figure.as_bytes()))?;
    }
    Ok(())
}

/// Writes the points of contours to the CSV file `out`, and a drawing of them beside it, with the extension svg, whose
/// name is returned. Neither appears before both are complete, and neither replaces one of the `inputs`.
///
/// # Errors
/// [`WriteError`].
pub fn write_profiles(
    name: &str,
    profiles: &[Profile],
    out: &Path,
    inputs: Vec<PathBuf>,
) -> Result<PathBuf, WriteError> {
    if out.file_name().is_none_or(|file| Path::new(file).extension().is_some_and(|is| is == "svg")) {
        return Err(OutputError::Name { file: out.to_path_buf() }.into());
    }
    let figure = figure::profile(name, profiles)?;
    let (staged, file) = Staged::of_file(out)?;
    let staged = staged.keeping(inputs);
    staged.write(file, |out| write_profile_table(profiles, out))?;
    staged.write(&file.with_extension("svg"), |out| out.write_all(figure.as_bytes()))?;
    staged.publish()?;
    Ok(out.with_extension("svg"))
}

/// Writes elastica.json, shapes.csv and elastica.svg into the staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_elastica(run: &ElasticaRun, staged: &Staged) -> Result<(), WriteError> {
    let figure = figure::equilibria(run)?;
    run.write(staged)?;
    staged.write(Path::new("elastica.svg"), |file| file.write_all(figure.as_bytes()))?;
    Ok(())
}

/// Writes scans.csv, outline.csv, reach.json and reach.svg into the staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_reach(found: &Reached, staged: &Staged) -> Result<(), WriteError> {
    let figure = figure::reach(found)?;
    found.write(staged)?;
    staged.write(Path::new("reach.svg"), |file| file.write_all(figure.as_bytes()))?;
    Ok(())
}

/// Writes plan.json and plan.svg into the staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_approaches(found: &Approaches, staged: &Staged) -> Result<(), WriteError> {
    let figure = figure::approaches(found)?;
    found.write(staged)?;
    staged.write(Path::new("plan.svg"), |file| file.write_all(figure.as_bytes()))?;
    Ok(())
}

/// Writes candidates.csv, plan.json and plan.svg into the staged directory.
///
/// # Errors
/// [`WriteError`].
pub fn write_plan(found: &Planned, staged: &Staged) -> Result<(), WriteError> {
    let figure = figure::plan(found)?;
    found.write(staged)?;
    staged.write(Path::new("plan.svg"), |file| file.write_all(figure.as_bytes()))?;
    Ok(())
}
