//! Objects of very many short edges: fine teeth, and polygons that are nearly round.

use crate::random::dice::Dice;
use crate::random::shapes::{Object, Piece, Point};
use std::f64::consts::TAU;

/// A bar with teeth closer than 1/64 along one side.
pub fn fine_teeth(dice: &mut Dice) -> Object {
    let pitch = dice.fine_between(2e-3, 1.0 / 64.0);
    let (half, thick) = (pitch * dice.between(1.6, 5.0), dice.between(0.02, 0.1));
    let deep = pitch * dice.between(0.2, 3.0);
    let n = (2.0 * half / pitch).floor() as usize;
    let (lean, flat) = (dice.between(0.05, 0.95), dice.chance(0.3));
    let mut points: Vec<Point> = Vec::new();
    for tooth in 0..n {
        let x = -half + pitch * tooth as f64;
        // the solid is above: the teeth point down
        points.push([x, 0.0]);
        if flat {
            points.extend([[x + 0.3 * pitch, -deep], [x + 0.6 * pitch, -deep]]);
        } else {
            points.push([x + lean * pitch, -deep]);
        }
    }
    points.extend([[-half + pitch * n as f64, 0.0], [half, thick], [-half, thick]]);
    Object {
        pieces: vec![Piece::Polygon { points, closed: true }],
        radius: half + thick + deep,
        mirror: dice.chance(0.3),
    }
}

/// A convex polygon of 30 to 1,000 edges; once in a while of 10,000, seldom of 100,000.
pub fn many_edges(dice: &mut Dice) -> Object {
    let n = match dice.whole(0, 999) {
        0..=2 => 100_000,
        3..=39 => dice.fine_between(1e3, 1e4) as usize,
        _ => dice.fine_between(30.0, 1e3) as usize,
    };
    let radius = dice.fine_between(0.05, 0.6);
    let flat = if dice.chance(0.5) { 1.0 } else { dice.between(0.2, 1.0) };
    let regular = dice.chance(0.5);
    let angle = |k: usize, dice: &mut Dice| {
        let off = if regular { 0.0 } else { dice.between(-0.49, 0.49) };
        (k as f64 + off) * TAU / n as f64
    };
    let points = (0..n).map(|k| angle(k, dice)).map(|a| [radius * a.cos(), flat * radius * a.sin()]).collect();
    Object { pieces: vec![Piece::Polygon { points, closed: true }], radius, mirror: false }
}
