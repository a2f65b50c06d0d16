//! Recordings for other programs.

use super::{Clean, Level, Noise, Outcome, RATE};
use serde::Serialize;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use vibrissa::Sample;
use vibrissa::reconstruct::Reconstruction;

/// Recordings as CSV files in a directory, and what is known of them in `kinks.json`.
pub struct Recordings {
    directory: PathBuf,
    entries: Mutex<Vec<Entry>>,
}

/// What is known of one recording; places are ways of the clamp from its first pose, m.
#[derive(Serialize)]
struct Entry {
    file: String,
    scan: String,
    level: String,
    noise: &'static str,
    seed: u64,
    /// Transitions that show, and those that need not be found, but are no false alarms.
    truth: Vec<f64>,
    faint: Vec<f64>,
    /// What the reconstruction found.
    found: Vec<f64>,
    sigma: [f64; 3],
}

impl Recordings {
    /// In a directory, which is made if need be.
    pub fn new(directory: &Path) -> Outcome<Self> {
        fs::create_dir_all(directory)?;
        Ok(Self { directory: directory.to_owned(), entries: Mutex::new(Vec::new()) })
    }

    /// Writes a recording.
    pub fn add(
        &self,
        clean: &Clean,
        level: &Level,
        noise: &Noise,
        seed: u64,
        samples: &[Sample],
        found: &Reconstruction,
    ) -> Outcome<()> {
        let kind = noise.name.replace(['(', ')'], "");
        let file = format!("{}_{}_{kind}_{seed}.csv", clean.scene.name, level.name);
        let mut table = csv::Writer::from_path(self.directory.join(&file))?;
        table.write_record(["t", "x0", "y0", "phi0", "f0x", "f0y", "m0z"])?;
        for (number, Sample { pose, reactions, .. }) in samples.iter().enumerate() {
            let t = number as f64 / RATE;
            let felt = [reactions.f0x, reactions.f0y, reactions.m0z].map(|value| format!("{value:.5e}"));
            let pose = [t, pose.x, pose.y, pose.phi].map(|value| format!("{value:.6}"));
            table.write_record(pose.iter().chain(&felt))?;
        }
        table.flush()?;
        let entry = Entry {
            file,
            scan: clean.scene.name.clone(),
            level: level.title(),
            noise: noise.name,
            seed,
            truth: clean.places(true),
            faint: clean.places(false),
            found: found.kinks.iter().map(|kink| kink.tau).collect(),
            sigma: [level.force, level.force, level.moment],
        };
        self.entries.lock().map_err(|_| "another recording could not be written")?.push(entry);
        Ok(())
    }

    /// Writes what is known of them, by name.
    pub fn finish(self) -> Outcome<()> {
        let mut entries = self.entries.into_inner().map_err(|_| "a recording could not be written")?;
        entries.sort_by(|a, b| a.file.cmp(&b.file));
        let file = fs::File::create(self.directory.join("kinks.json"))?;
        serde_json::to_writer_pretty(std::io::BufWriter::new(file), &entries)?;
        Ok(())
    }
}
