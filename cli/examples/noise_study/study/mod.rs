//! The nine scans of Merker et al. (2020), recorded by sensors of several noise levels, reconstructed and judged.

mod clean;
mod files;
mod limit;
mod noise;
mod score;
mod table;

pub use clean::Clean;
pub use files::Recordings;
pub use limit::{kinks_below, limits};
pub use noise::{LEVELS, Level, NOISES, Noise};
pub use score::Score;
pub use table::{by_scan, compared, frictions, tables};

use rayon::prelude::*;
use std::error::Error;
use std::ops::Range;
use std::path::Path;
use vibrissa::reconstruct::{Friction, fit_contour};

/// Samples in a second, 1/s, and speed of the clamp, m/s.
pub const RATE: f64 = 500.0;
pub const SPEED: f64 = 1e-3;
/// Way of the clamp from one sample to the next, m.
pub const STEP: f64 = SPEED / RATE;
/// A kink found is that one if it is no farther from it, m.
pub const MARGIN: f64 = 1e-3;

/// What the library functions of the study return: any error ends it.
pub type Outcome<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// The names of the nine scans.
pub fn scans() -> Vec<String> {
    (1..=3).flat_map(|object| [20, 40, 60].map(|q| format!("O{object}_q{q}"))).collect()
}

/// Sweeps scenes of the directory `scenes` with this coefficient of friction.
pub fn sweep(scenes: &Path, names: &[String], friction: f64) -> Outcome<Vec<Clean>> {
    names.par_iter().map(|name| Clean::sweep(&scenes.join(format!("{name}.toml")), friction)).collect()
}

/// Records and reconstructs each scan with these seeds of a noise, by one contour for the whole recording where it `fits` one; a score for each
/// scan. The recordings are kept if there is a place for them.
pub fn judge(
    scans: &[Clean],
    level: &Level,
    noise: &Noise,
    seeds: Range<u64>,
    fits: bool,
    keep: Option<&Recordings>,
    done: &(dyn Fn() + Sync),
) -> Outcome<Vec<Score>> {
    let model = level.model(noise);
    let work: Vec<(usize, u64)> =
        (0..scans.len()).flat_map(|scan| seeds.clone().map(move |seed| (scan, seed))).collect();
    let judged: Outcome<Vec<(usize, Score)>> = work
        .into_par_iter()
        .map(|(scan, seed)| {
            let clean = &scans[scan];
            // no two scans with the same noise
            let samples = clean.recorded(&model, 1000 * scan as u64 + seed)?;
            let friction = if clean.friction == 0.0 { Friction::None } else { Friction::Estimate };
            let settings = vibrissa::Settings { friction, ..vibrissa::Settings::default() };
            let mut found = vibrissa::reconstruct(clean.scene.rod.at_clamp(), &samples, &settings)?;
            let fit = fits.then(|| fit_contour(clean.scene.rod.at_clamp(), &samples, &found)).transpose()?;
            if let Some(fit) = &fit {
                found.adopt(fit, &settings);
            }
            if let Some(keep) = keep {
                keep.add(clean, level, noise, seed, &samples, &found)?;
            }
            let mut score = Score::of(clean, &samples, &found);
            fit.iter().for_each(|fit| score.explained.count(fit.goodness.explains));
            done();
            Ok((scan, score))
        })
        .collect();
    let mut scores = vec![Score::default(); scans.len()];
    for (scan, score) in judged? {
        scores[scan].merge(score);
    }
    Ok(scores)
}
