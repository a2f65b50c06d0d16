//! Which rod reaches an accuracy: scenes that differ in their rods, ranked by the standard deviation that the noise leaves.

use crate::WriteError;
use rayon::prelude::*;
use rod_files::output::{csv_writer, pretty_json};
use rod_files::table::{Table, counted};
use rod_files::{Scene, Speed, Staged, Study};
use serde::Serialize;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use vibrissa::plan::KnownScan;
use vibrissa::reconstruct::NoiseModel;

/// Rods in the report; rods.csv has all.
const SHOWN: usize = 20;

/// What may be done with a scene that has friction.
const FRICTION: &str = "take it away: rods are compared without friction";

/// The scenes of a study, which differ in their rods, and how they are measured.
#[derive(Debug)]
pub struct RodComparison {
    /// What it is called.
    pub name: String,
    /// The scenes.
    pub study: Study,
    /// The sensor.
    pub noise: NoiseModel,
    /// Samples in a second, 1/s.
    pub rate: f64,
    /// Speed of the clamp.
    pub speed: Speed,
    /// The standard deviation that is asked for, m.
    pub sigma: f64,
}

/// The scenes, the most exact one first; those without a contact, and those that cannot be swept, are the last.
#[derive(Debug)]
pub struct ComparedRods {
    name: String,
    scene: String,
    parameters: Vec<String>,
    /// m
    sigma: f64,
    rows: Vec<Row>,
}

/// One scene.
#[derive(Debug)]
struct Row {
    scene: usize,
    values: Vec<f64>,
    found: Result<Found, String>,
}

/// What comes of a scan.
#[derive(Clone, Copy, Debug)]
struct Found {
    /// Median standard deviation where the object is touched, m.
    sigma: Option<f64>,
    /// How many times the noise may be.
    noise_factor: Option<f64>,
    /// m
    touched: f64,
    /// Pa
    largest_stress: Option<f64>,
    /// N m
    largest_moment: f64,
}

/// rods.json.
#[derive(Serialize)]
struct Record<'a> {
    version: &'static str,
    study: &'a str,
    scene: &'a str,
    sigma: f64,
    scenes: usize,
    reached: usize,
    best: Option<usize>,
}

impl RodComparison {
    /// Sweeps all scenes, on all cores.
    pub fn run(&self) -> ComparedRods {
        let row = |scene: usize| Row { scene, values: self.study.values(scene), found: self.found(scene) };
        let mut rows: Vec<Row> = (0..self.study.count()).into_par_iter().map(row).collect();
        rows.sort_by(|one, other| one.sigma().total_cmp(&other.sigma()));
        ComparedRods {
            name: self.name.clone(),
            scene: self.study.scene.display().to_string(),
            parameters: self.study.names().map(str::to_owned).collect(),
            sigma: self.sigma,
            rows,
        }
    }

    fn found(&self, number: usize) -> Result<Found, String> {
        let text = self.study.text(number).map_err(|error| error.to_string())?;
        let scene = Scene::parse(&self.study.scene, &text).map_err(|error| error.to_string())?;
        scene.check_no_friction(FRICTION).map_err(|error| error.to_string())?;
        scene.check_single_leg().map_err(|error| error.to_string())?;
        let speed = self.speed.of(&scene).map_err(|error| error.to_string())?;
        let path = Arc::new(scene.path) as Arc<dyn vibrissa::contact::Path>;
        let scan = KnownScan::new(&scene.rod, &scene.objects, &path).map_err(|error| error.to_string())?;
        if let Some(stop) = &scan.found.stop {
            return Err(stop.to_string());
        }
        let measurement = scan.measurement(&self.noise.channels(), speed / self.rate);
        Ok(Found {
            sigma: scan.sigma(&measurement),
            noise_factor: scan.noise_factor(&measurement, self.sigma),
            touched: (0..scene.objects.len()).map(|object| scan.found.touched.all(object).length()).sum(),
            largest_stress: scan.found.largest_stress,
            largest_moment: scan.found.largest_moment,
        })
    }
}

impl Row {
    /// To rank it.
    fn sigma(&self) -> f64 {
        self.found.as_ref().ok().and_then(|found| found.sigma).unwrap_or(f64::INFINITY)
    }
}

impl ComparedRods {
    /// Whether no scene could be swept.
    pub fn is_refused(&self) -> bool {
        self.rows.iter().all(|row| row.found.is_err())
    }

    /// Writes rods.csv and rods.json.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write(&self, staged: &Staged) -> Result<(), WriteError> {
        staged.write(Path::new("rods.csv"), |file| {
            let mut table = csv_writer(file);
            let after = ["sigma", "noise_factor", "touched", "largest_stress", "largest_moment", "reason"];
            table.write_record(["scene"].into_iter().chain(self.parameters.iter().map(String::as_str)).chain(after))?;
            for row in &self.rows {
                let shown = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
                let numbers = match &row.found {
                    Ok(found) => [
                        shown(found.sigma),
                        shown(found.noise_factor),
                        found.touched.to_string(),
                        shown(found.largest_stress),
                        found.largest_moment.to_string(),
                        String::new(),
                    ],
                    Err(reason) => std::array::from_fn(|k| if k == 5 { reason.clone() } else { String::new() }),
                };
                let values = row.values.iter().map(f64::to_string);
                table.write_record([row.scene.to_string()].into_iter().chain(values).chain(numbers))?;
            }
            table.flush()
        })?;
        staged.write(Path::new("rods.json"), |file| pretty_json(file, &self.record()))?;
        Ok(())
    }

    fn record(&self) -> Record<'_> {
        Record {
            version: env!("CARGO_PKG_VERSION"),
            study: &self.name,
            scene: &self.scene,
            sigma: self.sigma,
            scenes: self.rows.len(),
            reached: self.rows.iter().filter(|row| row.sigma() <= self.sigma).count(),
            best: self.rows.first().filter(|row| row.sigma().is_finite()).map(|row| row.scene),
        }
    }

    /// The best rods, in words.
    pub fn report(&self) -> String {
        let mut text = String::new();
        // writing to a String cannot fail
        let _ = self.tell(&mut text);
        text
    }

    fn tell(&self, text: &mut String) -> std::fmt::Result {
        let Record { scenes, reached, .. } = self.record();
        let um = 1e6 * self.sigma;
        writeln!(
            text,
            "{}: {}, {reached} with a median standard deviation of at most {um} um by the noise alone",
            self.name,
            counted(scenes, "scene")
        )?;
        let head = ["sigma um", "noise for it", "touched mm", "stress MPa"];
        let names = self.parameters.iter().map(String::as_str);
        let mut table = Table::new(["scene"].into_iter().chain(names).chain(head));
        let swept = self.rows.iter().filter_map(|row| Some((row, row.found.as_ref().ok()?)));
        for (row, found) in swept.take(SHOWN) {
            let shown = |value: Option<f64>, unit: f64, digits: usize| {
                value.map_or_else(|| "-".to_owned(), |value| format!("{:.digits$}", unit * value))
            };
            let numbers = [
                shown(found.sigma, 1e6, 2),
                found.noise_factor.map_or_else(|| "-".to_owned(), |factor| format!("x {factor:.3}")),
                shown(Some(found.touched), 1e3, 2),
                shown(found.largest_stress, 1e-6, 0),
            ];
            let values = row.values.iter().map(|value| format!("{value:.6}"));
            table.row([row.scene.to_string()].into_iter().chain(values).chain(numbers));
        }
        write!(text, "{table}")?;
        let mut refused = self.rows.iter().filter_map(|row| Some((row.scene, row.found.as_ref().err()?)));
        if let Some((first, reason)) = refused.next() {
            let scenes = counted(1 + refused.count(), "scene");
            writeln!(text, "{scenes} without a result, the first one is {first}: {reason}")?;
        }
        Ok(())
    }
}
