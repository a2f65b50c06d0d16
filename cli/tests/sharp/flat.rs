//! Smooth closed splines: those with curls, and those that are nearly flat.

use crate::random::dice::Dice;
use crate::random::shapes::{Object, Piece, Point};
use std::f64::consts::TAU;

fn closed(points: Vec<Point>, radius: f64) -> Object {
    Object { pieces: vec![Piece::Spline { points, end: "periodic" }], radius: 1.05 * radius, mirror: false }
}

/// A star of smooth arms, twisted the more the farther out: it never crosses itself, for the twist is one to one.
pub fn curls(dice: &mut Dice) -> Object {
    let (radius, arms) = (dice.between(0.1, 0.6), dice.whole(2, 5));
    let (deep, twist) = (dice.between(0.1, 0.4), dice.sign() * dice.between(0.3, 2.5));
    let (uneven, phase) = (dice.between(0.0, 0.1), dice.angle());
    let n = 40 * arms;
    let point = |k: usize| {
        let a = TAU * k as f64 / n as f64;
        let r = 1.0 - deep - uneven + deep * (arms as f64 * a).cos() + uneven * (a + phase).cos();
        let turned = a + twist * r;
        [radius * r * turned.cos(), radius * r * turned.sin()]
    };
    closed((0..n).map(point).collect(), radius)
}

/// |x / a|^n + |y / b|^n = 1 for n = 4, 5, 6, 8, through many points.
pub fn superellipse(dice: &mut Dice) -> Object {
    let power = [4.0, 5.0, 6.0, 8.0][dice.whole(0, 3)];
    let radius = dice.fine_between(0.04, 0.45);
    let flat = dice.between(0.15, 1.0);
    let n = dice.whole(80, 400);
    let start = dice.between(0.0, 1.0);
    let point = |k: usize| {
        let (sin, cos) = (TAU * (k as f64 + start) / n as f64).sin_cos();
        let r = radius * (cos.abs().powf(power) + sin.abs().powf(power)).powf(-1.0 / power);
        [r * cos, flat * r * sin]
    };
    closed((0..n).map(point).collect(), 1.42 * radius)
}
