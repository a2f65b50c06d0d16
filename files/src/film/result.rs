//! Forces from a film.

use super::channels::channels;
use super::error::{AtRestError, FilmError};
use super::points::{empty, points};
use super::record::{COLUMNS, CONTACT_COLUMNS, FrameRecord, contact_rows, row};
use super::table::Numbers;
use crate::output::{json_line, pretty_json, write_csv};
use crate::{FilmedRod, OutputError, Staged};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use vibrissa::reconstruct::{Film, ForceSettings, Frame, FrameVerdict, RestShape, forces, rest_shape};
use vibrissa::rod::{AnyRod, NaturalCurvature, RodError};

/// Which ends of the rod the points show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// The first point is the base; the tip may not be seen.
    #[default]
    Base,
    /// The last point is the tip; the base may not be seen.
    Tip,
    /// Both: then the apparent shortening of the rod is known.
    Both,
    /// Neither.
    Neither,
}

/// How a film is read.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmOptions {
    /// Metres per unit of the coordinates.
    pub scale: f64,
    /// Whether y counts down, as in images.
    pub image: bool,
    /// Which ends of the rod are seen.
    pub ends: Ends,
    /// A second table, of measured numbers by frame.
    pub channels: Option<PathBuf>,
    /// A film of the free rod.
    pub rest: Option<PathBuf>,
    /// Friction, noise and number of contacts.
    pub settings: ForceSettings,
}

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
    /// Whether the noise of the points was given.
    pub is_noise_given: bool,
    /// Columns of the table that are not used.
    pub ignored: Vec<String>,
}

impl FilmForces {
    /// Reads a film and finds the forces in each frame.
    ///
    /// # Errors
    /// [`FilmError`]: a table cannot be read, or the frames of the free rod give no shape.
    pub fn read(file: &Path, rod: FilmedRod, options: &FilmOptions) -> Result<Self, FilmError> {
        let length = rod.rod.length();
        let table = Numbers::read(file)?;
        let is_points = ["frame", "x", "y"].iter().all(|name| table.column(name).is_some());
        let is_channels = !is_points && ["x", "y"].iter().all(|name| table.column(name).is_none());
        let known = |name: &String| {
            let name = name.as_str();
            let name = name.strip_prefix("sigma_").unwrap_or(name);
            matches!(name, "frame" | "x" | "y" | "sigma" | "t") || is_channels
        };
        let ignored = table.names().iter().filter(|name| !known(name)).cloned().collect();
        let frames = if is_channels {
            let rows = channels(table, length)?;
            rows.into_iter().map(|(of, channels)| (of, Frame { channels, ..Frame::default() })).collect()
        } else {
            let frames = points(table, options)?;
            match &options.channels {
                Some(file) => with_channels(frames, channels(Numbers::read(file)?, length)?, options.ends),
                None => frames,
            }
        };
        let name = file.file_stem().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
        let rest = options.rest.as_ref().map(|file| points(Numbers::read(file)?, options)).transpose()?;
        let numbers: Vec<i64> = rest.iter().flatten().map(|(number, _)| *number).collect();
        let rest: Option<Vec<Frame>> = rest.map(|frames| frames.into_iter().map(|(_, frame)| frame).collect());
        let of_rest = || options.rest.clone().unwrap_or_else(|| file.to_path_buf());
        let found = Self::of(name, frames, rest.as_deref(), rod, &options.settings)
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
        let is_noise_given = settings.sigma.is_some();
        let settings = ForceSettings { sigma: Some(film.sigma), ..*settings };
        let others: Vec<Film> = others.iter().map(|other| forces(other, &only, &settings)).collect();
        film.add_errors_of_the_rod(&others);
        let other_at_rest = rest.as_ref().and_then(|rest| rest.other).map(|other| other as i64);
        Ok(Self { name, rod, rest, frames, film, other_at_rest, is_noise_given, ignored: Vec::new() })
    }

    /// Writes forces.jsonl, forces.csv, contacts.csv, and rest.json where a shape at rest was found.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, staged: &Staged) -> Result<(), OutputError> {
        let all = || self.frames.iter().zip(&self.film.frames);
        staged.write(Path::new("forces.jsonl"), |file| {
            all().try_for_each(|((number, _), told)| json_line(file, &FrameRecord::of(*number, told, &self.rod)))
        })?;
        staged.write(Path::new("forces.csv"), |file| {
            write_csv(file, &COLUMNS, all().map(|((number, _), told)| row(*number, told, &self.rod)))
        })?;
        staged.write(Path::new("contacts.csv"), |file| {
            let rows = all().flat_map(|((number, _), told)| contact_rows(*number, told, &self.rod));
            write_csv(file, &CONTACT_COLUMNS, rows)
        })?;
        let file = Path::new("rest.json");
        match &self.rest {
            Some(rest) => staged.write(file, |file| pretty_json(file, &super::record::RestRecord::of(rest))),
            None => staged.remove(file),
        }
    }

    /// How many frames have a fault, and how many no shape explains.
    pub fn failures(&self) -> (usize, usize) {
        let faults = self.film.frames.iter().filter(|told| told.is_err()).count();
        let unexplained = |told: &&Result<_, _>| {
            matches!(told, Ok(vibrissa::reconstruct::FrameForces { verdict: FrameVerdict::NotExplained, .. }))
        };
        (faults, self.film.frames.iter().filter(unexplained).count())
    }
}

/// Frames of points with the measured numbers of the same frame.
fn with_channels(
    frames: Vec<(i64, Frame)>,
    rows: Vec<(i64, Vec<vibrissa::reconstruct::Channel>)>,
    ends: Ends,
) -> Vec<(i64, Frame)> {
    let mut all: BTreeMap<i64, Frame> = frames.into_iter().collect();
    for (number, channels) in rows {
        all.entry(number).or_insert_with(|| empty(ends)).channels.extend(channels);
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
