//! Forces from a film.

use super::channels::channels;
use super::error::{AtRestError, FilmError};
use super::options::{Ends, FilmOptions};
use super::points::{self, points};
use super::record::{COLUMNS, CONTACT_COLUMNS, FrameRecord, PoleRecord, RestRecord};
use super::table::Numbers;
use crate::output::{json_line, pretty_json, write_csv};
use crate::{FilmedRod, OutputError, Staged};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use vibrissa::hw::{Frame as Axes, Mounting};
use vibrissa::reconstruct::{Channel, Film, ForceSettings, Frame, FrameVerdict, RestShape, forces, rest_shape};
use vibrissa::rod::{AnyRod, NaturalCurvature, RodError};

/// Forces on a rod from a film.
#[derive(Clone, Debug)]
pub struct FilmForces {
    /// Name of the film: that of its file.
    pub name: String,
    /// The rod, as it is at rest by the film of the free rod.
    pub rod: FilmedRod,
    /// Its shape at rest, where that was found.
    pub rest: Option<RestShape>,
    /// The frames with their numbers.
    pub frames: Vec<(i64, Frame)>,
    /// What they tell.
    pub film: Film,
    /// The frame of the free rod that has another shape than the others, if there is one: by its number, from 0 where the frames have none.
    pub other_at_rest: Option<i64>,
    /// How they were judged.
    pub settings: ForceSettings,
    /// Columns that are not used; of another table than that of the frames with its file.
    pub ignored: Vec<String>,
}

impl FilmForces {
    /// Reads a film and finds the forces in each frame.
    ///
    /// # Errors
    /// [`FilmError`]: a table cannot be read, or the frames of the free rod give no shape.
    pub fn read(file: &Path, rod: FilmedRod, options: &FilmOptions) -> Result<Self, FilmError> {
        let mounting = options.mounting.unwrap_or_else(|| Mounting::new(Axes::same()));
        let table = Numbers::read(file)?;
        let is_points = ["frame", "x", "y"].iter().all(|name| table.column(name).is_some());
        let is_channels = !is_points && ["x", "y"].iter().all(|name| table.column(name).is_none());
        let mut ignored = Vec::new();
        let mut has_sensor = false;
        let frames = if is_channels {
            let measured = channels(table, &rod, &mounting)?;
            has_sensor = measured.has_sensor;
            ignored.extend(measured.ignored);
            measured.rows.into_iter().map(|(of, channels)| (of, Frame { channels, ..Frame::default() })).collect()
        } else {
            ignored.extend(points::ignored(&table));
            let frames = points(table, options)?;
            match &options.channels {
                Some(file) => {
                    let measured = channels(Numbers::read(file)?, &rod, &mounting)?;
                    has_sensor = measured.has_sensor;
                    ignored.extend(of_file(measured.ignored, file));
                    with_channels(frames, measured.rows, options.ends)
                }
                None => frames,
            }
        };
        if !has_sensor && options.mounting.is_some() {
            let file = if is_channels { None } else { options.channels.as_deref() }.unwrap_or(file);
            return Err(FilmError::NoSensor { file: file.to_path_buf() });
        }
        let name = file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
        let rest = match &options.rest {
            Some(file) => {
                let table = Numbers::read(file)?;
                ignored.extend(of_file(points::ignored(&table), file));
                Some(points(table, options)?)
            }
            None => None,
        };
        let numbers: Vec<i64> = rest.iter().flatten().map(|(number, _)| *number).collect();
        let rest: Option<Vec<Frame>> = rest.map(|frames| frames.into_iter().map(|(_, frame)| frame).collect());
        let of_rest = || options.rest.clone().unwrap_or_else(|| file.to_path_buf());
        let found = Self::of(name, frames, rest.as_deref(), rod, &options.settings())
            .map_err(|source| FilmError::Rest { file: of_rest(), source })?;
        let other_at_rest = found.other_at_rest.and_then(|index| numbers.get(index as usize).copied());
        Ok(Self { ignored, other_at_rest, ..found })
    }

    /// Finds the forces in frames with their numbers; `rest` are frames of the free rod.
    ///
    /// # Errors
    /// [`AtRestError`]: the frames of the free rod give no shape at rest. Never without them.
    pub fn of(
        name: String,
        frames: Vec<(i64, Frame)>,
        rest: Option<&[Frame]>,
        rod: FilmedRod,
        settings: &ForceSettings,
    ) -> Result<Self, AtRestError> {
        let (rod, rest, others) = match rest {
            None => (rod, None, Vec::new()),
            Some(rest) => at_rest(rest, rod, settings)?,
        };
        let only: Vec<Frame> = frames.iter().map(|(_, frame)| frame.clone()).collect();
        let mut film = forces(&rod.rod, &only, settings);
        let same_noise = ForceSettings { sigma: Some(film.sigma), ..*settings };
        let others: Vec<Film> = others.iter().map(|other| forces(other, &only, &same_noise)).collect();
        film.add_errors_of_the_rod(&others);
        let other_at_rest = rest.as_ref().and_then(|rest| rest.other).map(|other| other as i64);
        Ok(Self { name, rod, rest, frames, film, other_at_rest, settings: *settings, ignored: Vec::new() })
    }

    /// Writes forces.jsonl, forces.csv, contacts.csv, and rest.json and pole.json where a shape at rest and a pole were found.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        let all = self.frames.iter().zip(&self.film.frames);
        let records: Vec<FrameRecord> =
            all.map(|((number, _), judged)| FrameRecord::of(*number, judged, &self.rod)).collect();
        staged
            .write(Path::new("forces.jsonl"), |file| records.iter().try_for_each(|record| json_line(file, record)))?;
        let rows = records.iter().map(FrameRecord::row);
        staged.write(Path::new("forces.csv"), |file| write_csv(file, &COLUMNS, rows))?;
        let rows = records.iter().flat_map(FrameRecord::contact_rows);
        staged.write(Path::new("contacts.csv"), |file| write_csv(file, &CONTACT_COLUMNS, rows))?;
        write_or_remove(staged, "rest.json", self.rest.as_ref().map(RestRecord::of))?;
        write_or_remove(staged, "pole.json", self.film.pole.as_ref().map(|pole| PoleRecord::of(pole, &self.frames)))
    }

    /// How many frames have a fault, and how many no shape explains.
    pub fn failures(&self) -> (usize, usize) {
        let faults = self.film.frames.iter().filter(|judged| judged.is_err()).count();
        let judged = self.film.frames.iter().flatten();
        (faults, judged.filter(|judged| judged.verdict == FrameVerdict::NotExplained).count())
    }

    /// How many frames have a family of contacts, and no force of their own.
    pub fn family_count(&self) -> usize {
        self.film.frames.iter().flatten().filter(|judged| judged.verdict == FrameVerdict::Family).count()
    }
}

/// Writes a result, or removes an earlier one.
fn write_or_remove<T: Serialize>(staged: &Staged, name: &str, result: Option<T>) -> Result<(), OutputError> {
    let file = Path::new(name);
    match result {
        Some(result) => staged.write(file, |file| pretty_json(file, &result)),
        None => staged.remove(file),
    }
}

/// Columns of another table than that of the frames.
fn of_file(columns: Vec<String>, file: &Path) -> impl Iterator<Item = String> {
    columns.into_iter().map(move |column| format!("{column} of {}", file.display()))
}

/// Frames of points with the measured numbers of the same frame.
fn with_channels(frames: Vec<(i64, Frame)>, rows: Vec<(i64, Vec<Channel>)>, ends: Ends) -> Vec<(i64, Frame)> {
    let mut all: BTreeMap<i64, Frame> = frames.into_iter().collect();
    for (number, channels) in rows {
        all.entry(number).or_insert_with(|| ends.empty()).channels.extend(channels);
    }
    all.into_iter().collect()
}

/// The rod with the shape at rest that a film of the free rod shows, and the rods whose shape is off by one standard deviation.
fn at_rest(
    frames: &[Frame],
    rod: FilmedRod,
    settings: &ForceSettings,
) -> Result<(FilmedRod, Option<RestShape>, Vec<AnyRod>), AtRestError> {
    let rest = rest_shape(rod.rod.length(), frames, settings.sigma)?;
    let bent = |coefficients: Vec<f64>| bent(&rod.rod, RestShape { coefficients, ..rest.clone() });
    let others = rest.variations().into_iter().map(bent).collect::<Result<_, _>>()?;
    let rod = FilmedRod { rod: bent(rest.coefficients.clone())?, ..rod };
    Ok((rod, Some(rest), others))
}

/// The rod with this shape at rest.
fn bent(rod: &AnyRod, shape: RestShape) -> Result<AnyRod, RodError> {
    let curvature = match shape.coefficients[..] {
        // a number keeps the closed form
        [constant] => NaturalCurvature::from(constant),
        _ => NaturalCurvature::from(move |s: f64| shape.curvature(s).0),
    };
    let bent = match rod.varying() {
        Some(varying) => varying.clone().with_natural_curvature(curvature),
        None => rod.at_clamp().with_natural_curvature(curvature),
    };
    let bent = AnyRod::from(bent?);
    Ok(match rod.springs() {
        Some(springs) => bent.with_springs(*springs),
        None => bent,
    })
}
