//! How the clamp and the contours at the contacts move with a quantity, dimensionless, per SI unit of the quantity.

use crate::derivatives::quantity::Quantity;
use crate::derivatives::restored::Restored;
use crate::error::ContactError;
use crate::scene::world::World;
use rod_core::{Pose, SupportRate, Units};
use smallvec::SmallVec;

/// The motion of clamp and contours, these at fixed parameters.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub clamp: Pose,
    pub supports: SmallVec<[SupportRate; 8]>,
}

const STILL: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };

/// The motion by `quantity` of a rod with these `units`. By the length of the rod everything else moves to where it is in lengths of the
/// rod. A clamp that gives way by more is one whose support moves.
pub(crate) fn motion(
    world: &World<'_>,
    Restored { configuration, clamp, given, .. }: &Restored,
    units: &Units,
    quantity: Quantity<'_>,
) -> Result<Motion, ContactError> {
    let per_length = 1.0 / units.length;
    let clamp = match quantity {
        Quantity::ClampX => Pose { x: per_length, ..STILL },
        Quantity::ClampY => Pose { y: per_length, ..STILL },
        Quantity::ClampAngle => Pose { phi: 1.0, ..STILL },
        Quantity::Length => Pose { x: -clamp.x * per_length, y: -clamp.y * per_length, phi: 0.0 },
        _ => STILL,
    };
    let [x, y, phi] = given.as_ref().map_or([0.0; 3], |given| given.rates(units, quantity));
    let clamp = Pose { x: clamp.x - x, y: clamp.y - y, phi: clamp.phi - phi };
    let missing = || ContactError::NoQuantity { what: quantity.to_string() };
    if let Quantity::ObjectX(object)
    | Quantity::ObjectY(object)
    | Quantity::ObjectAngle(object)
    | Quantity::ObjectScale(object)
    | Quantity::Shape { object, .. } = quantity
        && object >= world.objects()
    {
        return Err(missing());
    }
    if let Quantity::Shape { object, piece, parameter } = quantity
        && !world.has_parameter(object, piece, parameter)
    {
        return Err(missing());
    }
    let of_contact = |j: usize| {
        let (stretch, t) = (configuration.contacts[j].stretch, configuration.t(j));
        let at = |on: usize| world.object(stretch) == on;
        Ok(match quantity {
            Quantity::Length => {
                let at = world.support(stretch, t);
                SupportRate { x: -at.x * per_length, y: -at.y * per_length, alpha: 0.0 }
            }
            Quantity::ObjectX(object) if at(object) => SupportRate { x: per_length, ..SupportRate::default() },
            Quantity::ObjectY(object) if at(object) => SupportRate { y: per_length, ..SupportRate::default() },
            Quantity::ObjectAngle(object) if at(object) => {
                let at = world.support(stretch, t);
                SupportRate { x: -at.y, y: at.x, alpha: 1.0 }
            }
            Quantity::ObjectScale(object) if at(object) => {
                let at = world.support(stretch, t);
                SupportRate { x: at.x, y: at.y, alpha: 0.0 }
            }
            Quantity::Shape { object, piece, parameter } if at(object) => {
                world.support_rate(stretch, t, piece, parameter).ok_or_else(missing)?
            }
            _ => SupportRate::default(),
        })
    };
    let supports = (0..configuration.count()).map(of_contact).collect::<Result<_, _>>()?;
    Ok(Motion { clamp, supports })
}

/// The change of the parameter of the upper or lower border of a stretch with a quantity.
pub(crate) fn border_rate(
    world: &World<'_>,
    stretch: usize,
    upper: bool,
    quantity: Quantity<'_>,
) -> Result<f64, ContactError> {
    match quantity {
        Quantity::Shape { object, piece, parameter } if world.object(stretch) == object => world
            .border_rate(stretch, upper, piece, parameter)
            .ok_or_else(|| ContactError::NoQuantity { what: format!("{quantity} that tells where the piece ends") }),
        // an object moves as a whole
        _ => Ok(0.0),
    }
}
