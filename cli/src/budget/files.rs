//! The files of a study.

use super::needed::TARGET;
use super::study::Expected;
use super::trials::Trial;
use crate::{WriteError, figure};
use rod_files::Staged;
use rod_files::output::pretty_json;
use serde::Serialize;
use std::path::Path;
use vibrissa::reconstruct::{Budget, Source};

/// budget.json.
#[derive(Serialize)]
struct BudgetRecord<'a> {
    scene: &'a str,
    samples: usize,
    stopped: Option<String>,
    budget: &'a Budget,
    noise: [f64; 3],
    sources: Vec<SourceRecord>,
    shared_before: f64,
    shared_after: f64,
    shared_with_known_friction: Option<f64>,
    noise_points: f64,
    total_after: f64,
    needed: Option<NeededRecord>,
    runs: &'a [Trial],
}

#[derive(Serialize)]
struct SourceRecord {
    source: Source,
    unit: &'static str,
    budget: f64,
    left: f64,
    before: f64,
    after: f64,
}

#[derive(Serialize)]
struct NeededRecord {
    target: f64,
    sensor_factor: Option<f64>,
    stiffness_factor: Option<f64>,
}

impl Expected {
    /// Writes budget.json and budget.svg.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write(&self, staged: &Staged) -> Result<(), WriteError> {
        staged.write(Path::new("budget.json"), |file| pretty_json(file, &self.record()))?;
        let drawing = figure::budget(&self.scene.name, &self.forecast)?;
        staged.write(Path::new("budget.svg"), |file| file.write_all(drawing.as_bytes()))?;
        Ok(())
    }

    fn record(&self) -> BudgetRecord<'_> {
        let forecast = &self.forecast;
        let sources = forecast.sources.iter().map(|share| SourceRecord {
            source: share.source,
            unit: share.source.name().1,
            budget: share.sigma[0],
            left: share.sigma[1],
            before: share.displacement[0],
            after: share.displacement[1],
        });
        BudgetRecord {
            scene: &self.scene.name,
            samples: self.samples,
            stopped: self.stop.as_ref().map(ToString::to_string),
            budget: &self.budget,
            noise: [self.sigma.f0x, self.sigma.f0y, self.sigma.m0z],
            sources: sources.collect(),
            shared_before: forecast.shared[0],
            shared_after: forecast.shared[1],
            shared_with_known_friction: forecast.with_known_friction,
            noise_points: forecast.noise,
            total_after: forecast.total(),
            needed: self.needed.map(|needed| NeededRecord {
                target: TARGET,
                sensor_factor: needed.sensor.value(),
                stiffness_factor: needed.stiffness.value(),
            }),
            runs: &self.runs,
        }
    }
}
