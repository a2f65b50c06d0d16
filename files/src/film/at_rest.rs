//! The rod of a film as it is at rest, by a film of the free rod.

use super::error::AtRestError;
use crate::FilmedRod;
use vibrissa::reconstruct::{ForceSettings, Frame, RestShape, rest_shape};
use vibrissa::rod::{AnyRod, NaturalCurvature, RodError};

/// The rod with the shape at rest that a film of the free rod shows, and the rods whose shape is off by one standard deviation.
pub(super) fn at_rest(
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
