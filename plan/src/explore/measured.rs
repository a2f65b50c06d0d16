//! What one recording tells.

use super::{ExploreError, ExplorerSettings};
use rod_contact::{ClampPath, Item, Sweep};
use rod_contours::Composite;
use rod_core::{Rod, Sample};
use rod_reconstruct::{Assembly, FittedObject, Knowledge, Settings, TraceKind, fit_contour, reconstruct_passes};

/// Standard deviations of the noise within which all reactions are those of a rod that touches nothing: of 10,000 samples of white noise one in a million recordings
/// is beyond.
const FREE: f64 = 6.0;

/// Points of the shapes of the rod.
const POINTS: usize = 100;

/// What one recording tells.
pub(super) struct Measured {
    /// The contours that were touched.
    pub objects: Vec<FittedObject>,
    /// Whether a contour explains the recording, or the rod touched nothing.
    pub is_explained: bool,
}

impl Measured {
    pub fn of(rod: &Rod, settings: &ExplorerSettings, samples: &[Sample]) -> Result<Self, ExploreError> {
        let noise = &settings.noise;
        let reactions = |sample: &Sample| [sample.reactions.f0x, sample.reactions.f0y, sample.reactions.m0z];
        let is_free = |sample: &Sample| (0..3).all(|c| reactions(sample)[c].abs() <= FREE * noise[c].sigma);
        if samples.iter().all(is_free) {
            return Ok(Self { objects: Vec::new(), is_explained: true });
        }
        let reconstruction = Settings { noise: Some(*noise), ..settings.reconstruction };
        let found = reconstruct_passes(rod, samples, &reconstruction)?;
        if let Ok(fit) = fit_contour(rod, samples, &found)
            && fit.goodness.explains
        {
            return Ok(Self { objects: fit.objects, is_explained: true });
        }
        // points of single contacts hold without a contour that explains everything
        let contour = found.contour(&Assembly::default());
        let resolution = 0.02 * rod.length();
        let objects = contour.of_kind(TraceKind::Single).filter_map(|trace| {
            let points: Vec<_> = trace.points.iter().filter(|point| point.sigma < resolution).collect();
            (points.len() > 1).then(|| FittedObject {
                points: points.iter().map(|point| [point.x, point.y]).collect(),
                vertices: Vec::new(),
                known: points.iter().map(|point| Knowledge::Touched { sigma: point.sigma }).collect(),
            })
        });
        Ok(Self { objects: objects.collect(), is_explained: false })
    }

    /// The shapes of the rod along the way of the samples, points in m, as the contour gives them; none where the way is not straight.
    pub fn shapes(&self, rod: &Rod, samples: &[Sample], step: f64) -> Vec<Vec<[f64; 2]>> {
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Vec::new() };
        let Ok(path) = ClampPath::new(first.pose, last.pose) else { return Vec::new() };
        let is_beside = |sample: &Sample| {
            let (pose, rate) = (sample.pose, path.rate());
            let way = (pose.x - first.pose.x) * rate.x + (pose.y - first.pose.y) * rate.y;
            let at = path.at(way);
            (pose.x - at.x).hypot(pose.y - at.y) > step || (pose.phi - at.phi).abs() * rod.length() > step
        };
        if path.turns_only() || samples.iter().any(is_beside) {
            return Vec::new();
        }
        let objects: Vec<Composite> = self.objects.iter().filter_map(|object| object.contour().ok()).collect();
        let Ok(sweep) = Sweep::new(rod, &objects, path, step) else { return Vec::new() };
        let shape = |item| match item {
            Ok(Item::State(state)) => {
                let bent = state.elastica(rod).ok()?;
                Some(bent.sample(POINTS).map(|at| [at.x, at.y]).collect())
            }
            _ => None,
        };
        sweep.filter_map(shape).collect()
    }
}
