//! Contact points from which a fit starts.

use super::blocks::Blocks;
use super::outline::Touched;
use crate::pipeline::Reconstruction;
use crate::point::{OneSample, Touch, one_sample};
use crate::systematic::{Correction, Errors, still};
use nalgebra::{Matrix3, Vector2, Vector3};
use rod_contact::{Contact, ContactKind};
use rod_core::{PhysicalRod, Rod};

/// Smallest standard deviation of a contact point, rod lengths: none counts more than others by much.
const SURE: f64 = 1e-3;
/// Largest standard deviation (rod lengths) of the point that a single contact would have where there is no answer. Larger: points that noise
/// throws anywhere enter the order along the contour.
const UNSURE: f64 = 0.05;
/// Smallest force of such a contact over its noise. Smaller: blocks of a free rod get contacts.
const CERTAIN: f64 = 6.0;

impl Touched {
    /// By a contact point, in rod lengths.
    fn by(touch: &Touch, length: f64) -> Self {
        Self {
            at: Vector2::new(touch.x, touch.y) / length,
            along: Vector2::new(touch.alpha.cos(), touch.alpha.sin()),
            weight: (touch.sigma_normal() / length).hypot(SURE).powi(-2),
        }
    }
}

/// The contact points of the local answer, in lengths of its rod.
pub(super) fn touched(local: &Reconstruction, given: &Rod) -> Vec<Touched> {
    let length = local.calibration().map_or(given.length(), |calibration| calibration.rod(given).length());
    let touches = local.readings.iter().flat_map(|reading| {
        let second = reading.second.and_then(Result::ok);
        reading.touch.ok().into_iter().chain(second)
    });
    touches.map(|touch| Touched::by(&touch, length)).collect()
}

/// Gives blocks without an answer the single contact that their reactions, without these errors, would have, and returns those points.
pub(super) fn fill_with_singles<R: PhysicalRod>(rod: &R, blocks: &mut Blocks, errors: &Errors) -> Vec<Touched> {
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
        found.push(Touched::by(&touch, units.length));
    }
    found
}
