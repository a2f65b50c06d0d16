//! Random ways of the clamp, in lengths of the rod.

use super::dice::Dice;
use super::shapes::{Place, Point};
use std::f64::consts::{FRAC_PI_2, PI};

/// The first and the last pose of the clamp: position and angle.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    pub from: (Point, f64),
    pub to: (Point, f64),
}

impl Way {
    pub fn turns_only(&self) -> bool {
        self.from.0 == self.to.0
    }

    pub fn length(&self) -> f64 {
        let ([ax, ay], [bx, by]) = (self.from.0, self.to.0);
        if self.turns_only() { (self.to.1 - self.from.1).abs() } else { (bx - ax).hypot(by - ay) }
    }

    pub fn moved(&self, place: &Place) -> Self {
        let pose = |(at, angle): (Point, f64)| (place.apply(at), angle + place.angle);
        Self { from: pose(self.from), to: pose(self.to) }
    }

    pub fn backwards(&self) -> Self {
        Self { from: self.to, to: self.from }
    }
}

/// Distance at which the rod reaches nothing.
const CLEAR: f64 = 1.05;

/// A way past what lies within `radius` of the origin.
pub fn past(dice: &mut Dice, radius: f64) -> Way {
    let far = radius + CLEAR;
    // seen from the object, before it is turned: the clamp is below, the rod points up
    let way = match dice.whole(0, 19) {
        // by and by, sometimes turning
        0..=12 => {
            let near = if dice.chance(0.9) { radius + 0.03 } else { 0.3 * radius };
            let y = -dice.between(near, radius + 0.9);
            let phi = FRAC_PI_2 + dice.between(-0.8, 0.8);
            let turned = if dice.chance(0.3) { dice.between(-1.2, 1.2) } else { 0.0 };
            let tilt = dice.between(-0.2, 0.2) * (far + y).max(0.0);
            let end = dice.between(0.2, far);
            let side = dice.sign();
            Way { from: ([side * far, y], phi), to: ([-side * end, y - tilt.max(0.0)], phi + turned) }
        }
        // into it
        13..=15 => {
            let x = radius * dice.between(-1.1, 1.1);
            let phi = FRAC_PI_2 + dice.between(-0.5, 0.5);
            let drift = dice.between(-0.3, 0.3);
            let end = dice.between(radius + 0.05, radius + 0.8);
            Way { from: ([x, -far], phi), to: ([x + drift, -end], phi) }
        }
        // turning on the spot
        16 | 17 => {
            let at = [0.0, -dice.between(radius + 0.05, radius + 0.9)];
            let (before, after) = (dice.between(1.2, 2.5), dice.between(0.0, 2.5));
            let side = dice.sign();
            Way { from: (at, FRAC_PI_2 + side * before), to: (at, FRAC_PI_2 - side * after) }
        }
        // in contact at once, mostly
        _ => {
            let y = -dice.between(radius + 0.03, radius + 0.7);
            let phi = FRAC_PI_2 + dice.between(-0.5, 0.5);
            let x = dice.between(-0.5, 0.5);
            Way { from: ([x, y], phi), to: ([x + dice.sign() * dice.between(0.3, 1.0), y], phi) }
        }
    };
    way.moved(&Place { at: [0.0, 0.0], angle: dice.angle() })
}

/// A way below a wall at y = 0 and above.
pub fn below(dice: &mut Dice) -> Way {
    let h = dice.between(0.05, 0.95);
    let x = dice.between(-0.8, 0.8);
    let phi = FRAC_PI_2 + dice.between(-0.9, 0.9);
    let turned = if dice.chance(0.2) { dice.between(-1.0, 1.0) } else { 0.0 };
    let drift = dice.sign() * dice.between(0.1, 1.2);
    match dice.whole(0, 9) {
        // up to it and along
        0..=5 => Way { from: ([x, -CLEAR], phi), to: ([x + drift, -h], phi + turned) },
        // turning up to it
        6 | 7 => {
            let at = [x, -h];
            let from = if dice.chance(0.5) { -0.2 } else { PI + 0.2 };
            Way { from: (at, from), to: (at, phi) }
        }
        // along it, in contact at once mostly
        _ => Way { from: ([x, -h], phi), to: ([x + drift, -h], phi + turned) },
    }
}

/// A way under bumps that rise to both sides.
pub fn under_bumps(dice: &mut Dice) -> Way {
    if dice.chance(0.4) {
        return below(dice);
    }
    let (h, side) = (dice.between(0.1, 0.9), dice.sign());
    let phi = FRAC_PI_2 + dice.between(-0.5, 0.5);
    Way { from: ([1.3 * side, -h], phi), to: ([-dice.between(0.2, 1.5) * side, -h], phi) }
}

/// A rod that points up from the origin, between what is on its left and right.
pub fn between(dice: &mut Dice) -> Way {
    let phi = FRAC_PI_2 + dice.between(-0.1, 0.1);
    let side = dice.sign();
    let x = side * dice.between(0.2, 0.7);
    match dice.whole(0, 3) {
        0 => Way { from: ([0.0, 0.0], phi), to: ([x, 0.0], phi) },
        1 => Way { from: ([0.0, 0.0], phi), to: ([0.0, 0.0], phi + side * dice.between(0.3, 1.2)) },
        2 => Way { from: ([0.0, 0.0], phi), to: ([x, dice.between(-0.5, 0.1)], phi + dice.between(-0.8, 0.8)) },
        _ => Way { from: ([0.1 * side, -CLEAR], phi), to: ([x, -0.05], phi) },
    }
}
