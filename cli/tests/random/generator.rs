//! Scenes as scene files, each from its seed.

use super::dice::Dice;
use super::shapes::{CLOSED, OPEN, Object, Place, closed};
use super::ways::{self, Way};
use std::fmt::Write;

/// A scene file, and what is in it.
#[derive(Clone, Debug)]
pub struct Generated {
    pub seed: u64,
    pub kind: &'static str,
    pub text: String,
}

/// Number of states asked for, about.
const STATES: f64 = 60.0;

/// All kinds, in the order in which seeds go through them.
pub const KINDS: [&str; 16] = [
    "open spline",
    "closed spline",
    "convex polygon",
    "star polygon",
    "open polygon",
    "gear",
    "circle",
    "ellipse",
    "capsule",
    "rounded polygon",
    "arcs between corners",
    "bays",
    "parabolas",
    "two objects",
    "three objects",
    "between two objects",
];

/// The scene of a seed, for ever the same.
pub fn scene(seed: u64) -> Generated {
    let mut dice = Dice::new(seed);
    let kind = KINDS[(seed % KINDS.len() as u64) as usize];
    let dice = &mut dice;
    let (objects, way) = match kind {
        "two objects" => group(dice, 2),
        "three objects" => group(dice, 3),
        "between two objects" => both_sides(dice),
        "parabolas" => (alone(OPEN[3].1(dice), dice, false), ways::under_bumps(dice)),
        _ => match OPEN.iter().find(|(name, _)| *name == kind) {
            Some((_, make)) => (alone(make(dice), dice, false), ways::below(dice)),
            None => {
                let make = CLOSED.iter().find(|(name, _)| *name == kind).unwrap().1;
                let object = make(dice);
                let way = ways::past(dice, object.radius);
                (alone(object, dice, true), way)
            }
        },
    };
    let way = if dice.chance(0.1) { way.backwards() } else { way };
    Generated { seed, kind, text: text(dice, seed, kind, &objects, &way) }
}

/// An object, and where it stands.
pub type Placed = (Object, Place);

fn alone(object: Object, dice: &mut Dice, turned: bool) -> Vec<Placed> {
    let angle = if turned { dice.angle() } else { 0.0 };
    vec![(object, Place { at: [0.0, 0.0], angle })]
}

/// Objects side by side, none within the reach of another.
fn group(dice: &mut Dice, n: usize) -> (Vec<Placed>, Way) {
    let mut placed: Vec<Placed> = Vec::new();
    while placed.len() < n {
        let object = closed(dice);
        if object.radius > 0.6 {
            continue;
        }
        let Some((other, beside)) = placed.last() else {
            placed.push((object, Place { at: [0.0, 0.0], angle: dice.angle() }));
            continue;
        };
        let (apart, direction) = (other.radius + object.radius + dice.between(0.03, 0.4), dice.angle());
        let at = [beside.at[0] + apart * direction.cos(), beside.at[1] + apart * direction.sin()];
        let clear = |(other, place): &Placed| {
            (place.at[0] - at[0]).hypot(place.at[1] - at[1]) > other.radius + object.radius + 0.01
        };
        if placed.iter().all(clear) {
            placed.push((object, Place { at, angle: dice.angle() }));
        }
    }
    let middle = [0, 1].map(|k| placed.iter().map(|(_, place)| place.at[k]).sum::<f64>() / n as f64);
    for (_, place) in &mut placed {
        place.at = [place.at[0] - middle[0], place.at[1] - middle[1]];
    }
    let reach = |(object, place): &Placed| place.at[0].hypot(place.at[1]) + object.radius;
    let radius = placed.iter().map(reach).fold(0.0, f64::max);
    (placed, ways::past(dice, radius))
}

/// One object on the left of the rod and one on its right.
fn both_sides(dice: &mut Dice) -> (Vec<Placed>, Way) {
    loop {
        let mut place = |side: f64| {
            let object = closed(dice);
            let at = [side * (object.radius + dice.between(0.015, 0.2)), dice.between(0.1, 0.9)];
            (object, Place { at, angle: dice.angle() })
        };
        let (left, right) = (place(-1.0), place(1.0));
        if left.0.radius < 0.6 && right.0.radius < 0.6 {
            return (vec![left, right], ways::between(dice));
        }
    }
}

/// The scene file, all of it put at some place in the plane.
pub fn text(dice: &mut Dice, seed: u64, kind: &str, objects: &[Placed], way: &Way) -> String {
    let length = if dice.chance(0.5) { 1.0 } else { 0.1 };
    let stiffness = dice.log_between(1e-3, 10.0);
    // nothing depends on where all of it stands
    let all = Place { at: [dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)], angle: dice.angle() };
    let mut out =
        format!("# Random scene {seed}: {kind}\n[rod]\nlength = {length:?}\nbending_stiffness = {stiffness:?}\n");
    for (object, place) in objects {
        object.write(&place.then(&all), dice.chance(0.5), length, &mut out);
    }
    let moved = way.moved(&all);
    let pair = |[x, y]: [f64; 2]| format!("[{:?}, {:?}]", x * length, y * length);
    writeln!(out, "\n[sweep]\nfrom = {}\nto = {}", pair(moved.from.0), pair(moved.to.0)).unwrap();
    writeln!(out, "angle = {:?}\nangle_to = {:?}", moved.from.1.to_degrees(), moved.to.1.to_degrees()).unwrap();
    if way.turns_only() {
        writeln!(out, "step_angle = {:?}", way.length().to_degrees() / STATES).unwrap();
    } else {
        writeln!(out, "step = {:?}", way.length() * length / STATES).unwrap();
    }
    out
}
