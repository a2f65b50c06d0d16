//! Kinks of a recording that the contour which explains it does not tell of.

use super::ContourFit;
use crate::check::Finding;
use crate::kink::{Kink, KinkKind};
use crate::phase::Label;
use crate::pipeline::Reading;

/// Blocks on either side of a kink, and distance of its contact from a vertex, rod lengths, within which the contour explains the kink: in noise it is
/// known to some samples. Smaller: warnings about kinks that are explained; larger: kinks of a hidden contact count as those of another place.
const NEAR_KINK: usize = 3;
const AT_VERTEX: f64 = 0.01;

impl ContourFit {
    /// The kinks within a phase B of the answers that this contour gives: noise may hide another contact there. The contour explains those at which
    /// the phase changes, and those at its vertices.
    pub fn unexplained_kinks(&self, kinks: &[Kink], readings: &[Reading]) -> Option<Finding> {
        let mut kinks = kinks.iter().filter(|kink| kink.kind == KinkKind::Kink && !self.explains(kink, readings));
        let from = kinks.next()?.next;
        Some(Finding::KinksWithin { count: 1 + kinks.count(), from })
    }

    fn explains(&self, kink: &Kink, readings: &[Reading]) -> bool {
        let block = self.blocks.partition_point(|block| block.samples.end <= kink.next);
        let near = block.saturating_sub(NEAR_KINK)..self.blocks.len().min(block + NEAR_KINK + 1);
        let blocks = self.blocks.get(near).unwrap_or_default();
        let around = blocks.first().zip(blocks.last()).map_or(0..0, |(a, b)| a.samples.start..b.samples.end);
        let readings = readings.get(around).unwrap_or_default();
        let is_told = |reading: &Reading| {
            reading.label != Label::B || reading.touch.is_ok_and(|touch| self.has_vertex_near([touch.x, touch.y]))
        };
        readings.is_empty() || readings.iter().any(is_told)
    }

    fn has_vertex_near(&self, [x, y]: [f64; 2]) -> bool {
        let is_near = |point: &[f64; 2]| (point[0] - x).hypot(point[1] - y) < AT_VERTEX * self.length;
        let of_object = |object: &super::FittedObject| {
            object.vertices.iter().filter_map(|vertex| object.points.get(*vertex)).any(is_near)
        };
        self.objects.iter().any(of_object)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FittedBlock, FittedObject, Goodness, Knowledge};
    use super::*;
    use crate::point::Touch;
    use nalgebra::Matrix2;

    /// The fit to a phase B of 210 samples along a line, in blocks of ten, with these vertices.
    fn fit(vertices: Vec<usize>) -> ContourFit {
        let points: Vec<[f64; 2]> = (0..22).map(|k| [0.01 * f64::from(k), 0.0]).collect();
        let block = |k: usize| FittedBlock { samples: 10 * k..10 * (k + 1), label: Some(Label::B), residuals: None };
        let goodness = Goodness {
            chi_squared: 1.0,
            degrees_of_freedom: 1.0,
            noise_spread: 0.0,
            p_value: 0.5,
            worst: None,
            unreached: 0.0,
            farthest_error: None,
            explains: true,
        };
        ContourFit {
            objects: vec![FittedObject { known: vec![Knowledge::Touched { sigma: 1e-6 }; 22], points, vertices }],
            shapes: Vec::new(),
            errors: Vec::new(),
            goodness,
            blocks: (0..21).map(block).collect(),
            ringing: 0,
            readings: Vec::new(),
            length: 0.1,
        }
    }

    /// What it finds at a kink before sample 105, where the label is A from sample `changes` on.
    fn unexplained(fit: &ContourFit, changes: usize) -> Option<Finding> {
        let touch = |k: usize| Touch {
            s: 0.05,
            x: 1e-3 * k as f64,
            y: 0.0,
            alpha: 0.0,
            force: 0.1,
            covariance: Matrix2::zeros(),
            systematic: Matrix2::zeros(),
        };
        let label = |k: usize| if k < changes { Label::B } else { Label::A };
        let (kind, zeros) = (KinkKind::Kink, [0.0; 3]);
        let kink = Kink { kind, next: 105, tau: 0.0, sigma_tau: 0.0, change: zeros, sigma: zeros, score: 100.0 };
        let readings: Vec<Reading> = (0..210).map(|k| Reading::of_model(label(k), 0.99, &[Ok(touch(k))])).collect();
        fit.unexplained_kinks(&[kink], &readings)
    }

    #[test]
    fn a_kink_is_explained_by_a_vertex_or_a_change_of_phase() {
        let told = Some(Finding::KinksWithin { count: 1, from: 105 });
        assert_eq!(unexplained(&fit(Vec::new()), 210), told);
        assert_eq!(unexplained(&fit(vec![10]), 210), None);
        assert_eq!(unexplained(&fit(Vec::new()), 120), None);
        // too far away for either
        assert_eq!(unexplained(&fit(vec![2, 18]), 210), told);
        assert_eq!(unexplained(&fit(Vec::new()), 160), told);
    }
}
