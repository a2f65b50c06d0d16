//! A corner between two straight sides, cut off by a short edge or rounded by a small arc.

use crate::random::dice::Dice;
use crate::random::shapes::{Object, Piece, Point};
use std::f64::consts::{FRAC_PI_2, PI};

/// Shortest and longest edge or radius.
const SIZES: [f64; 2] = [1e-9, 1e-2];

/// The corner points to +x from the origin; its sides are 0.1 to 0.4 long.
pub fn cut_corner(dice: &mut Dice) -> Object {
    let (half, lean) = (dice.between(0.15, 1.4), dice.between(-0.3, 0.3));
    let side = dice.between(0.1, 0.4);
    let size = dice.fine_between(SIZES[0], SIZES[1]);
    // directions from the corner along its two sides, the lower one first: the solid is on the left of the way up
    let [below, above] = [PI + half + lean, PI - half + lean];
    let along = |angle: f64, r: f64| -> Point { [r * angle.cos(), r * angle.sin()] };
    let (low, high) = (along(below, side), along(above, side));
    let pieces = if dice.chance(0.5) {
        // two edges, or three: the short one in the middle is divided
        let cut = 0.5 * size / half.sin();
        let mut points = vec![low, along(below, cut), along(above, cut), high];
        if dice.chance(0.3) {
            points.insert(2, along(PI + lean, 0.8 * cut * half.cos()));
        }
        vec![Piece::Polygon { points, closed: true }]
    } else {
        // an arc about a point on the bisector
        let (center, touch) = (along(PI + lean, size / half.sin()), size / half.tan());
        let (from, to) = (below + FRAC_PI_2, above - FRAC_PI_2);
        let turn = (to - from).rem_euclid(2.0 * PI);
        vec![
            Piece::Line { from: low, to: along(below, touch) },
            Piece::Arc { center, radius: size, from, to: from + turn },
            Piece::Line { from: along(above, touch), to: high },
            Piece::Line { from: high, to: low },
        ]
    };
    Object { pieces, radius: side, mirror: false }
}

/// A convex polygon, each of whose corners is cut off or rounded alike: whatever corner is met, it is one of these.
pub fn cut_polygon(dice: &mut Dice) -> Object {
    let (n, radius) = (dice.whole(3, 5), dice.between(0.1, 0.4));
    let (flat, size) = (dice.between(0.3, 1.0), dice.fine_between(SIZES[0], SIZES[1]));
    let angle = |k: usize, dice: &mut Dice| (k as f64 + dice.between(-0.25, 0.25)) * 2.0 * PI / n as f64;
    let angles: Vec<f64> = (0..n).map(|k| angle(k, dice)).collect();
    let corners: Vec<Point> = angles.into_iter().map(|a| [radius * a.cos(), flat * radius * a.sin()]).collect();
    let rounded = dice.chance(0.5);
    let direction = |k: usize| {
        let (a, b) = (corners[k % n], corners[(k + 1) % n]);
        (b[1] - a[1]).atan2(b[0] - a[0])
    };
    let off = |p: Point, angle: f64, way: f64| [p[0] + way * angle.cos(), p[1] + way * angle.sin()];
    // way along both sides from a corner to where it is cut
    let cut = |turn: f64| if rounded { size * (0.5 * turn).tan() } else { 0.5 * size / (0.5 * turn).cos() };
    let turn = |k: usize| (direction(k) - direction(k + n - 1)).rem_euclid(2.0 * PI);
    let (mut pieces, mut points) = (Vec::new(), Vec::new());
    for (k, corner) in corners.iter().enumerate() {
        let (before, after) = (direction(k + n - 1), direction(k));
        let (start, stop) = (off(*corner, before, -cut(turn(k))), off(*corner, after, cut(turn(k))));
        points.extend([start, stop]);
        let center = off(start, before + FRAC_PI_2, size);
        pieces.push(Piece::Arc { center, radius: size, from: before - FRAC_PI_2, to: before - FRAC_PI_2 + turn(k) });
        let next = corners[(k + 1) % n];
        pieces.push(Piece::Line { from: stop, to: off(next, after, -cut(turn(k + 1))) });
    }
    let pieces = if rounded { pieces } else { vec![Piece::Polygon { points, closed: true }] };
    Object { pieces, radius, mirror: false }
}
