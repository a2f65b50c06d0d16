//! Objects that are thin everywhere: ellipses, needles, wedges.

use crate::random::dice::Dice;
use crate::random::shapes::{Object, Piece};
use std::f64::consts::TAU;

/// An ellipse of aspect 2 to 1,000.
pub fn thin_ellipse(dice: &mut Dice) -> Object {
    let radius = dice.fine_between(0.02, 0.5);
    let radii = [radius, radius / dice.fine_between(2.0, 1000.0)];
    let (rotation, from) = (dice.angle(), dice.angle());
    let pieces = vec![Piece::Ellipse { center: [0.0, 0.0], radii, rotation, from, to: from + TAU }];
    Object { pieces, radius, mirror: false }
}

/// A triangle or rectangle as thin as 1e-4.
pub fn needle(dice: &mut Dice) -> Object {
    let (half, width) = (dice.between(0.03, 0.4), dice.fine_between(1e-4, 2e-2));
    let h = 0.5 * width;
    let points = if dice.chance(0.5) {
        vec![[-half, -h], [half, dice.between(-1.0, 1.0) * h], [-half, h]]
    } else {
        vec![[-half, -h], [half, -h], [half, h], [-half, h]]
    };
    Object { pieces: vec![Piece::Polygon { points, closed: true }], radius: half + h, mirror: false }
}

/// A triangle that opens by 0.01 to 10 degrees.
pub fn razor(dice: &mut Dice) -> Object {
    let (half, opening) = (dice.between(0.05, 0.4), dice.fine_between(0.01, 10.0).to_radians());
    let h = 2.0 * half * (0.5 * opening).tan();
    let points = vec![[-half, -h], [half, dice.between(-2.0, 2.0) * h], [-half, h]];
    Object { pieces: vec![Piece::Polygon { points, closed: true }], radius: half + 2.0 * h, mirror: false }
}
