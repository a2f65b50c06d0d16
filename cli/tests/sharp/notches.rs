//! A block with notches and channels in its lower side, and walls around the rod.

use crate::random::dice::Dice;
use crate::random::shapes::{Object, Piece, Point};
use std::f64::consts::TAU;

/// Notches like a V, some of them channels with a flat end, in the side at y = 0 of a block above.
pub fn notched_block(dice: &mut Dice) -> Object {
    let half = 0.5;
    let uneven = |dice: &mut Dice| if dice.chance(0.5) { dice.between(-0.025, 0.03) } else { 0.0 };
    let mut points: Vec<Point> = vec![[-half, 0.0]];
    let mut x = -half + dice.between(0.05, 0.4);
    while x < half - 0.05 {
        let wide = dice.fine_between(0.004, 0.3).min(half - 0.01 - x);
        let deep = dice.fine_between(0.01, 0.3);
        points.push([x, uneven(dice)]);
        if dice.chance(0.3) {
            let lean = dice.between(-0.3, 0.3) * wide;
            points.extend([[x + 0.2 * wide + lean, deep], [x + 0.8 * wide + lean, deep]]);
        } else {
            points.push([x + dice.between(0.1, 0.9) * wide, deep]);
        }
        points.push([x + wide, uneven(dice)]);
        x += wide + dice.between(0.01, 0.3);
    }
    points.extend([[half, 0.0], [half, 0.5], [-half, 0.5]]);
    Object { pieces: vec![Piece::Polygon { points, closed: true }], radius: half, mirror: false }
}

/// A cavity around the origin, travelled clockwise, whose wall is nowhere nearer than `least`.
pub fn cavity(dice: &mut Dice, least: f64) -> Object {
    let n = dice.whole(5, 40);
    let (rough, smooth) = (dice.between(0.0, 0.25), dice.chance(0.4));
    let point = |k: usize, dice: &mut Dice| {
        // an edge comes nearer than its ends
        let near = if smooth { 1.1 } else { 1.0 / (0.5 * TAU / n as f64).cos() + 0.05 };
        let r = least * (near + dice.between(0.0, rough));
        let a = -TAU * k as f64 / n as f64;
        [r * a.cos(), r * a.sin()]
    };
    let points: Vec<Point> = (0..n).map(|k| point(k, dice)).collect();
    let piece =
        if smooth { Piece::Spline { points, end: "periodic" } } else { Piece::Polygon { points, closed: true } };
    Object { pieces: vec![piece], radius: 1.7 * least, mirror: false }
}
