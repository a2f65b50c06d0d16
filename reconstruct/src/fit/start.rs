//! Contact points from which a fit starts.

use super::blocks::Blocks;
use super::curve::Node;
use super::order::Touched;
use super::outline::{Interpretation, outline};
use super::swept::Swept;
use crate::pipeline::Reconstruction;
use crate::point::{OneSample, Touch, one_sample};
use crate::systematic::{Correction, Errors, still};
use nalgebra::{Matrix3, Vector2, Vector3};
use rod_contact::{Contact, ContactKind};
use rod_core::{PhysicalRod, Rod};

/// Standard deviation of a contact point, rod lengths, up to which all count the same.
const EQUAL: f64 = 1e-3;
/// Largest standard deviation (rod lengths) of the point that a single contact would have where there is no answer. Larger: points that noise
/// throws anywhere enter the order along the contour.
const UNSURE: f64 = 0.05;
/// Smallest force of such a contact over its noise. Smaller: blocks of a free rod get contacts.
const CERTAIN: f64 = 6.0;

impl Touched {
    /// By a contact point, in rod lengths.
    fn by(touch: &Touch, length: f64, trace: usize) -> Self {
        // across the contour and along it: points that lie anywhere on the rod tell of no order
        let sigma = (touch.covariance - touch.systematic).trace().max(0.0).sqrt() / length;
        Self {
            at: Vector2::new(touch.x, touch.y) / length,
            along: Vector2::new(touch.alpha.cos(), touch.alpha.sin()),
            sigma,
            weight: sigma.hypot(EQUAL).powi(-2),
            trace,
        }
    }
}

/// Where a fit starts.
pub(super) struct Start {
    pub blocks: Blocks,
    /// The contour, rod lengths.
    pub chains: Vec<Vec<Node>>,
}

/// Where the fit of a recording may start, the most likely first. `given` is a uniform rod of the length and the stiffness at the clamp of `rod`;
/// `errors` are those of the local answer.
pub(super) fn starts<R: PhysicalRod>(
    rod: &R,
    given: &Rod,
    local: &Reconstruction,
    mut blocks: Blocks,
    errors: Errors,
) -> Vec<Start> {
    let mut points = touched(local, given);
    let answers = Interpretation { is_sure: true, is_joined: false, is_sharp: false };
    let guesses = Interpretation { is_sure: false, ..answers };
    let joined = |reading| Interpretation { is_joined: true, ..reading };
    let of = |blocks: &Blocks, points: &[Touched], readings: &[Interpretation]| {
        let swept = Swept::of(rod, blocks, &errors);
        let start =
            |reading: &Interpretation| Start { blocks: blocks.clone(), chains: outline(points, *reading, &swept) };
        readings.iter().map(start).collect::<Vec<_>>()
    };
    let mut starts = of(&blocks, &points, &[answers, joined(answers), Interpretation { is_sharp: true, ..answers }]);
    let singles = singles(rod, local, &mut blocks, &errors);
    if !singles.is_empty() {
        points.extend(singles);
        starts.extend(of(&blocks, &points, &[guesses, joined(guesses)]));
    }
    let mut tried: Vec<Vec<Vec<Node>>> = Vec::new();
    starts.retain(|start| {
        let is_new = !start.chains.is_empty() && !tried.contains(&start.chains);
        tried.push(start.chains.clone());
        is_new
    });
    starts
}

/// The contact points of the local answer, in lengths of its rod. Between two kinks, each contact of the rod is one trace.
fn touched(local: &Reconstruction, given: &Rod) -> Vec<Touched> {
    let length = local.calibration().map_or(given.length(), |calibration| calibration.rod(given).length());
    let mut points = Vec::new();
    for (number, reading) in local.readings.iter().enumerate() {
        let first = 2 * kinks_before(local, number);
        let second = reading.second.and_then(Result::ok);
        points.extend(reading.touch.ok().map(|touch| Touched::by(&touch, length, first)));
        points.extend(second.map(|touch| Touched::by(&touch, length, first + 1)));
    }
    points
}

fn kinks_before(local: &Reconstruction, sample: usize) -> usize {
    local.kinks.partition_point(|kink| kink.next <= sample)
}

/// Gives blocks without an answer the single contact that their reactions, without these errors, would have, and returns those points.
fn singles<R: PhysicalRod>(rod: &R, local: &Reconstruction, blocks: &mut Blocks, errors: &Errors) -> Vec<Touched> {
    let units = rod.units();
    let Some(correction) = Correction::new(blocks.frame, errors) else { return Vec::new() };
    let mut found = Vec::new();
    for block in blocks.blocks.iter_mut().filter(|block| block.contacts.is_empty()) {
        let clamp = correction.apply(block.tau, &block.clamp, &still(block.motion)).0;
        if clamp.reactions.component_div(&block.sigma).xy().norm() < CERTAIN {
            continue;
        }
        let sigma = block.sigma.component_mul(&Vector3::new(units.force, units.force, units.moment));
        let covariance = Matrix3::from_diagonal(&sigma.component_mul(&sigma));
        let (pose, reactions) = clamp.in_units(units);
        let Ok(contact) = one_sample(rod, pose, reactions, &covariance) else { continue };
        let Some(touch) = contact.touch().filter(|touch| touch.sigma_normal() <= UNSURE * units.length) else {
            continue;
        };
        let kind = if matches!(contact, OneSample::Tip(_)) { ContactKind::Tip } else { ContactKind::Tangent };
        block.contacts = vec![Contact { kind, s: touch.s.min(units.length), ..touch.into() }];
        let point = Touched::by(&touch, units.length, 2 * kinks_before(local, block.samples.start));
        found.push(Touched { weight: point.weight * block.samples.len() as f64, ..point });
    }
    found
}
