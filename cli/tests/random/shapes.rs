//! Random objects, in lengths of the rod: pieces about the origin, written as a scene file has them.

use super::dice::Dice;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write;

pub type Point = [f64; 2];

/// A piece of a contour, angles in radians.
#[derive(Clone, Debug)]
pub enum Piece {
    Parabola { vertex: Point, coefficient: f64 },
    Line { from: Point, to: Point },
    Polygon { points: Vec<Point>, closed: bool },
    Arc { center: Point, radius: f64, from: f64, to: f64 },
    Ellipse { center: Point, radii: Point, rotation: f64, from: f64, to: f64 },
    Spline { points: Vec<Point>, end: &'static str },
}

/// A rotation, then a translation.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub at: Point,
    pub angle: f64,
}

impl Place {
    pub fn apply(&self, [x, y]: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        [self.at[0] + x * cos - y * sin, self.at[1] + x * sin + y * cos]
    }

    /// This one first, then the other.
    pub fn then(&self, other: &Self) -> Self {
        Self { at: other.apply(self.at), angle: self.angle + other.angle }
    }
}

impl Piece {
    fn moved(&self, place: &Place) -> Self {
        let to = |p: &Point| place.apply(*p);
        let turn = place.angle;
        match self {
            Self::Parabola { .. } => unreachable!("a parabola stands where its object's fields say"),
            Self::Line { from, to: end } => Self::Line { from: to(from), to: to(end) },
            Self::Polygon { points, closed } => {
                Self::Polygon { points: points.iter().map(to).collect(), closed: *closed }
            }
            Self::Arc { center, radius, from, to: end } => {
                Self::Arc { center: to(center), radius: *radius, from: from + turn, to: end + turn }
            }
            Self::Ellipse { center, radii, rotation, from, to: end } => {
                Self::Ellipse { center: to(center), radii: *radii, rotation: rotation + turn, from: *from, to: *end }
            }
            Self::Spline { points, end } => Self::Spline { points: points.iter().map(to).collect(), end },
        }
    }

    /// The lines of a scene file, lengths times `scale`.
    fn write(&self, scale: f64, out: &mut String) {
        let pair = |p: &Point| format!("[{:?}, {:?}]", p[0] * scale, p[1] * scale);
        let list = |points: &[Point]| points.iter().map(pair).collect::<Vec<_>>().join(", ");
        let text = match self {
            Self::Parabola { vertex, coefficient } => {
                format!("shape = \"parabola\"\nvertex = {}\ncoefficient = {:?}", pair(vertex), coefficient / scale)
            }
            Self::Line { from, to } => format!("shape = \"line\"\nfrom = {}\nto = {}", pair(from), pair(to)),
            Self::Polygon { points, closed } => {
                format!("shape = \"polygon\"\npoints = [{}]\nclosed = {closed}", list(points))
            }
            Self::Arc { center, radius, from, to } => format!(
                "shape = \"arc\"\ncenter = {}\nradius = {:?}\nfrom_angle = {:?}\nto_angle = {:?}",
                pair(center),
                radius * scale,
                from.to_degrees(),
                to.to_degrees()
            ),
            Self::Ellipse { center, radii, rotation, from, to } => format!(
                "shape = \"ellipse\"\ncenter = {}\nradii = {}\nrotation = {:?}\nfrom_angle = {:?}\nto_angle = {:?}",
                pair(center),
                pair(radii),
                rotation.to_degrees(),
                from.to_degrees(),
                to.to_degrees()
            ),
            Self::Spline { points, end } => {
                format!("shape = \"spline\"\npoints = [{}]\nend = \"{end}\"", list(points))
            }
        };
        writeln!(out, "{text}").unwrap();
    }
}

/// Pieces, and how far from the origin they reach.
#[derive(Clone, Debug)]
pub struct Object {
    pub pieces: Vec<Piece>,
    pub radius: f64,
    pub mirror: bool,
}

impl Object {
    fn of(pieces: Vec<Piece>, radius: f64) -> Self {
        Self { pieces, radius, mirror: false }
    }

    /// The object as a table of a scene file: where it stands is written as such (`by_fields`), or put into the pieces.
    pub fn write(&self, place: &Place, by_fields: bool, scale: f64, out: &mut String) {
        writeln!(out, "\n[[object]]").unwrap();
        let by_fields = by_fields || self.mirror || matches!(self.pieces[0], Piece::Parabola { .. });
        if by_fields {
            let [x, y] = place.at;
            writeln!(out, "position = [{:?}, {:?}]", x * scale, y * scale).unwrap();
            writeln!(out, "angle = {:?}", place.angle.to_degrees()).unwrap();
            if self.mirror {
                writeln!(out, "mirror = true").unwrap();
            }
        }
        for piece in &self.pieces {
            writeln!(out, "\n[[object.piece]]").unwrap();
            if by_fields {
                piece.write(scale, out);
            } else {
                piece.moved(place).write(scale, out);
            }
        }
    }
}

/// Angles all round, in order, neighbours at least 0.4 shares apart.
fn around(dice: &mut Dice, n: usize) -> Vec<f64> {
    let jitter = if dice.chance(0.4) { 0.0 } else { 0.3 };
    (0..n).map(|i| (i as f64 + dice.between(-jitter, jitter)) * TAU / n as f64).collect()
}

fn polar(radius: f64, angle: f64) -> Point {
    [radius * angle.cos(), radius * angle.sin()]
}

fn convex(dice: &mut Dice, radius: f64, n: usize) -> Vec<Point> {
    let flat = if dice.chance(0.5) { 1.0 } else { dice.between(0.3, 1.0) };
    around(dice, n).into_iter().map(|a| [radius * a.cos(), flat * radius * a.sin()]).collect()
}

/// Half the size of an object: from a twentieth of the rod to all of it.
fn size(dice: &mut Dice) -> f64 {
    dice.log_between(0.05, 1.0)
}

pub fn convex_polygon(dice: &mut Dice) -> Object {
    let (radius, n) = (size(dice), dice.whole(3, 9));
    let points = convex(dice, radius, n);
    Object::of(vec![Piece::Polygon { points, closed: true }], radius)
}

pub fn star_polygon(dice: &mut Dice) -> Object {
    let (radius, n) = (size(dice), dice.whole(5, 12));
    let deep = dice.between(0.4, 0.9);
    let angles = around(dice, n);
    let points = angles.into_iter().map(|a| polar(radius * dice.between(deep, 1.0), a)).collect();
    Object::of(vec![Piece::Polygon { points, closed: true }], radius)
}

pub fn gear(dice: &mut Dice) -> Object {
    let radius = dice.log_between(0.15, 1.0);
    // teeth at least 0.02 wide
    let most = ((TAU * radius / 0.06) as usize).clamp(5, 16);
    let (n, inner) = (dice.whole(4, most), dice.between(0.65, 0.92));
    let (foot, head) = (dice.between(0.5, 0.7), dice.between(0.25, 0.45));
    let mut points = Vec::new();
    for tooth in 0..n {
        let at = |share: f64| (tooth as f64 + share) * TAU / n as f64;
        points.push(polar(inner * radius, at(-0.5 * foot)));
        points.push(polar(radius, at(-0.5 * head)));
        points.push(polar(radius, at(0.5 * head)));
        points.push(polar(inner * radius, at(0.5 * foot)));
    }
    Object::of(vec![Piece::Polygon { points, closed: true }], radius)
}

pub fn circle(dice: &mut Dice) -> Object {
    let (radius, parts, start) = (size(dice), dice.whole(1, 3), dice.angle());
    let at = |k: usize| start + TAU * k as f64 / parts as f64;
    let arc = |k| Piece::Arc { center: [0.0, 0.0], radius, from: at(k), to: at(k + 1) };
    Object::of((0..parts).map(arc).collect(), radius)
}

pub fn ellipse(dice: &mut Dice) -> Object {
    let radius = size(dice);
    let other = radius * dice.log_between(0.15, 1.0);
    let radii = if dice.chance(0.5) { [radius, other] } else { [other, radius] };
    let (rotation, from) = (dice.angle(), dice.angle());
    Object::of(vec![Piece::Ellipse { center: [0.0, 0.0], radii, rotation, from, to: from + TAU }], radius)
}

pub fn capsule(dice: &mut Dice) -> Object {
    let half = size(dice);
    let r = (half * dice.log_between(0.1, 0.9)).max(0.01);
    let arc = |x, from, to| Piece::Arc { center: [x, 0.0], radius: r, from, to };
    let line = |from, to| Piece::Line { from, to };
    let pieces = vec![
        line([-half, -r], [half, -r]),
        arc(half, -FRAC_PI_2, FRAC_PI_2),
        line([half, r], [-half, r]),
        arc(-half, FRAC_PI_2, 3.0 * FRAC_PI_2),
    ];
    Object::of(pieces, half + r)
}

/// A convex polygon grown by discs at its corners.
pub fn rounded_polygon(dice: &mut Dice) -> Object {
    let (radius, n) = (size(dice), dice.whole(3, 7));
    let points = convex(dice, radius, n);
    let r = (radius * dice.log_between(0.1, 0.6)).max(0.01);
    let mut pieces = Vec::new();
    let normal = |i: usize| {
        let (a, b) = (points[i % n], points[(i + 1) % n]);
        (b[1] - a[1]).atan2(b[0] - a[0]) - FRAC_PI_2
    };
    let off = |p: Point, angle: f64| [p[0] + r * angle.cos(), p[1] + r * angle.sin()];
    for i in 0..n {
        let here = normal(i);
        let next = here + (normal(i + 1) - here).rem_euclid(TAU);
        pieces.push(Piece::Line { from: off(points[i], here), to: off(points[(i + 1) % n], here) });
        pieces.push(Piece::Arc { center: points[(i + 1) % n], radius: r, from: here, to: next });
    }
    Object::of(pieces, radius + r)
}

/// An arc from `a` to `b` that leaves the chord by `bulge` chords to the right: convex where positive.
fn bulged(a: Point, b: Point, bulge: f64) -> Piece {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let chord = dx.hypot(dy);
    if bulge.abs() < 0.01 {
        return Piece::Line { from: a, to: b };
    }
    // sagitta h: radius = (chord^2 / 4 + h^2) / 2 h
    let h = bulge.abs() * chord;
    let radius = (0.25 * chord * chord + h * h) / (2.0 * h);
    let half = (0.5 * chord / radius).asin();
    let along = dy.atan2(dx);
    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let side = bulge.signum();
    // a convex arc has its centre on the left of the chord
    let center = [middle[0] - side * (radius - h) * along.sin(), middle[1] + side * (radius - h) * along.cos()];
    let out = along - side * FRAC_PI_2;
    Piece::Arc { center, radius, from: out - side * half, to: out + side * half }
}

pub fn bulged_polygon(dice: &mut Dice) -> Object {
    let (radius, n) = (dice.log_between(0.08, 1.0), dice.whole(4, 8));
    let points = convex(dice, radius, n);
    let pieces = (0..n).map(|i| bulged(points[i], points[(i + 1) % n], dice.between(-0.09, 0.3)));
    Object::of(pieces.collect(), 1.3 * radius)
}

pub fn closed_spline(dice: &mut Dice) -> Object {
    let (radius, n) = (dice.log_between(0.08, 1.0), dice.whole(5, 12));
    let deep = dice.between(0.6, 0.95);
    let angles = around(dice, n);
    let points = angles.into_iter().map(|a| polar(radius * dice.between(deep, 1.0), a)).collect();
    Object::of(vec![Piece::Spline { points, end: "periodic" }], 1.15 * radius)
}

/// Any closed object.
pub fn closed(dice: &mut Dice) -> Object {
    let mut object = match dice.whole(0, 8) {
        0 => convex_polygon(dice),
        1 => star_polygon(dice),
        2 => gear(dice),
        3 => circle(dice),
        4 => ellipse(dice),
        5 => capsule(dice),
        6 => rounded_polygon(dice),
        7 => bulged_polygon(dice),
        _ => closed_spline(dice),
    };
    object.mirror = dice.chance(0.1);
    object
}

/// Half the width of an open contour: out of the rod's reach mostly.
fn width(dice: &mut Dice) -> f64 {
    if dice.chance(0.8) { 2.5 } else { dice.between(0.5, 1.0) }
}

/// Open contours have the solid above; what is lowest is at about y = 0.
pub fn open_spline(dice: &mut Dice) -> Object {
    let (half, pitch) = (width(dice), dice.log_between(0.1, 0.5));
    let deep = pitch * dice.log_between(0.05, 0.8);
    let n = (2.0 * half / pitch).ceil() as usize;
    let points = (0..=n).map(|i| [2.0 * half * i as f64 / n as f64 - half, dice.between(0.0, deep)]).collect();
    Object::of(vec![Piece::Spline { points, end: "natural" }], half)
}

pub fn open_polygon(dice: &mut Dice) -> Object {
    let (half, pitch) = (width(dice), dice.log_between(0.06, 0.4));
    let deep = dice.log_between(0.02, 0.3).min(1.5 * pitch);
    let n = (2.0 * half / pitch) as usize;
    let start = -0.5 * pitch * n as f64;
    let (kind, wide, lean) = (dice.whole(0, 3), dice.between(0.35, 0.7), dice.between(0.1, 0.9));
    let mut points = Vec::new();
    for tooth in 0..n {
        let x = start + pitch * tooth as f64;
        match kind {
            // a saw
            0 => points.extend([[x, deep], [x + lean * pitch, 0.0]]),
            // a comb, its teeth down
            1 => points.extend([
                [x, deep],
                [x + (1.0 - wide) * pitch, deep],
                [x + (1.0 - wide) * pitch, 0.0],
                [x + pitch, 0.0],
            ]),
            // stairs
            2 => {
                let y = deep * 0.3 * (tooth % 4) as f64;
                points.extend([[x, y], [x + wide * pitch, y]]);
            }
            // anything
            _ => points.push([x + pitch * dice.between(0.0, 0.6), dice.between(0.0, deep)]),
        }
    }
    Object::of(vec![Piece::Polygon { points, closed: false }], half)
}

/// Straight stretches, with arcs into the solid and out of it between them.
pub fn bays(dice: &mut Dice) -> Object {
    let n = dice.whole(1, 5);
    let (mut pieces, mut x) = (Vec::new(), -2.5);
    let mut at = -dice.between(0.2, 0.9);
    for _ in 0..n {
        let (radius, half) = (dice.log_between(0.03, 0.5), dice.between(0.35, 1.5));
        let chord = 2.0 * radius * half.sin();
        pieces.push(Piece::Line { from: [x, 0.0], to: [at, 0.0] });
        // convex ones have their centre above
        let side = if dice.chance(0.6) { -1.0 } else { 1.0 };
        let out = -side * FRAC_PI_2;
        pieces.push(Piece::Arc {
            center: [at + 0.5 * chord, side * radius * half.cos()],
            radius,
            from: out - side * half,
            to: out + side * half,
        });
        x = at + chord;
        at = x + dice.between(0.03, 0.4);
    }
    pieces.push(Piece::Line { from: [x, 0.0], to: [at.max(2.5), 0.0] });
    Object::of(pieces, 2.5)
}

/// One to three parabolas that cross one after the other.
pub fn parabolas(dice: &mut Dice) -> Object {
    let (n, steep) = (dice.whole(1, 3), dice.log_between(1.0, 30.0));
    let gap = dice.between(0.15, 0.5);
    let lift = (0.5 * steep * gap * gap).min(0.2);
    let piece = |i: usize, dice: &mut Dice| Piece::Parabola {
        vertex: [gap * (i as f64 - 0.5 * (n - 1) as f64), dice.between(0.0, lift)],
        coefficient: steep * dice.between(0.8, 1.25),
    };
    let pieces = (0..n).map(|i| piece(i, dice)).collect();
    Object { pieces, radius: 1.0, mirror: dice.chance(0.2) }
}

/// Makes an object.
pub type Maker = fn(&mut Dice) -> Object;

/// What the names of kinds stand for: one closed object.
pub const CLOSED: [(&str, Maker); 9] = [
    ("convex polygon", convex_polygon),
    ("star polygon", star_polygon),
    ("gear", gear),
    ("circle", circle),
    ("ellipse", ellipse),
    ("capsule", capsule),
    ("rounded polygon", rounded_polygon),
    ("arcs between corners", bulged_polygon),
    ("closed spline", closed_spline),
];

/// And one open one.
pub const OPEN: [(&str, Maker); 4] =
    [("open spline", open_spline), ("open polygon", open_polygon), ("bays", bays), ("parabolas", parabolas)];
