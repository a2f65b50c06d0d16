//! Scenes of several objects, or with ways of their own.

use super::blades::{needle, razor, thin_ellipse};
use super::corner::cut_corner;
use super::flat::superellipse;
use super::notches::cavity;
use crate::random::dice::Dice;
use crate::random::generator::Placed;
use crate::random::shapes::{Object, Piece, Place};
use crate::random::ways::{self, Way};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A disc on the left of a rod that points up, and further up a cut corner that points at it from the right.
pub fn second_contact(dice: &mut Dice) -> (Vec<Placed>, Way) {
    let radius = dice.between(0.05, 0.2);
    let disc =
        Object { pieces: vec![Piece::Arc { center: [0.0, 0.0], radius, from: 0.0, to: TAU }], radius, mirror: false };
    let (left, right) = (-dice.between(0.005, 0.05), dice.between(0.005, 0.12));
    let low = dice.between(0.15, 0.5);
    let high = low + dice.between(0.15, 0.45);
    let corner = Place { at: [right, high], angle: PI + dice.between(-0.6, 0.6) };
    let objects = vec![(disc, Place { at: [left - radius, low], angle: dice.angle() }), (cut_corner(dice), corner)];
    let phi = FRAC_PI_2 + dice.between(-0.02, 0.02);
    let to = match dice.whole(0, 2) {
        0 => ([-dice.between(0.1, 0.4), dice.between(-0.1, 0.1)], phi),
        1 => ([0.0, 0.0], phi + dice.between(0.1, 0.7)),
        _ => ([-dice.between(0.1, 0.4), dice.between(-0.1, 0.1)], phi + dice.between(-0.3, 0.3)),
    };
    (objects, Way { from: ([0.0, 0.0], phi), to })
}

/// Something thin or flat on either side of a rod.
pub fn channel(dice: &mut Dice) -> (Vec<Placed>, Way) {
    let make = |dice: &mut Dice| match dice.whole(0, 3) {
        0 => needle(dice),
        1 => razor(dice),
        2 => thin_ellipse(dice),
        _ => superellipse(dice),
    };
    let place = |side: f64, dice: &mut Dice| {
        let object = make(dice);
        let at = [side * (object.radius + dice.between(0.005, 0.1)), dice.between(0.1, 0.95)];
        (object, Place { at, angle: dice.angle() })
    };
    (vec![place(-1.0, dice), place(1.0, dice)], ways::between(dice))
}

/// A rod in a cavity: free at first in most.
pub fn hollow(dice: &mut Dice) -> (Vec<Placed>, Way) {
    let least = if dice.chance(0.8) { dice.between(1.02, 1.5) } else { dice.between(0.6, 0.95) };
    let wall = cavity(dice, least);
    let phi = dice.angle();
    let (direction, far) = (dice.angle(), dice.between(0.2, 0.9) * least);
    let turned = dice.between(-1.5, 1.5);
    let to = [far * direction.cos(), far * direction.sin()];
    let way = match dice.whole(0, 2) {
        0 => Way { from: ([0.0, 0.0], phi), to: (to, phi) },
        1 => Way { from: ([0.0, 0.0], phi), to: (to, phi + turned) },
        _ => {
            // turning on the spot, off the middle, from where there is room
            let back = [-0.4 * least * phi.cos(), -0.4 * least * phi.sin()];
            Way { from: (back, phi), to: (back, phi + 2.0 * turned) }
        }
    };
    (vec![(wall, Place { at: [0.0, 0.0], angle: 0.0 })], way)
}
