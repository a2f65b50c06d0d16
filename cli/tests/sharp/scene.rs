//! The scene of a seed.

use super::blades::{needle, razor, thin_ellipse};
use super::corner::cut_polygon;
use super::edges::{fine_teeth, many_edges};
use super::flat::{curls, superellipse};
use super::notches::notched_block;
use super::walls::{channel, hollow, second_contact};
use crate::random::dice::Dice;
use crate::random::generator::{Generated, Placed, text};
use crate::random::shapes::{Maker, Place};
use crate::random::ways::{self, Way};

/// All kinds, in the order in which seeds go through them.
pub const KINDS: [&str; 12] = [
    "cut corners",
    "cut corner, 2nd contact",
    "thin ellipse",
    "needle",
    "razor",
    "fine teeth",
    "many edges",
    "curls",
    "notches",
    "channel",
    "hollow",
    "superellipse",
];

/// Those of one closed object that stands in the open.
const ALONE: [(&str, Maker); 8] = [
    ("cut corners", cut_polygon),
    ("thin ellipse", thin_ellipse),
    ("needle", needle),
    ("razor", razor),
    ("fine teeth", fine_teeth),
    ("many edges", many_edges),
    ("curls", curls),
    ("superellipse", superellipse),
];

/// Seeds of other generators must not start with the same numbers.
const OWN: u64 = 1 << 40;

/// The scene of a seed, for ever the same.
pub fn scene(seed: u64) -> Generated {
    let mut dice = Dice::new(OWN + seed);
    let dice = &mut dice;
    let kind = KINDS[(seed % KINDS.len() as u64) as usize];
    let (objects, way): (Vec<Placed>, Way) = match kind {
        "cut corner, 2nd contact" => second_contact(dice),
        "channel" => channel(dice),
        "hollow" => hollow(dice),
        "notches" => {
            let block = notched_block(dice);
            let way = if dice.chance(0.6) { ways::below(dice) } else { ways::past(dice, block.radius) };
            (vec![(block, Place { at: [0.0, 0.0], angle: 0.0 })], way)
        }
        _ => {
            let make = ALONE.iter().find(|(name, _)| *name == kind).unwrap().1;
            let object = make(dice);
            let way = ways::past(dice, object.radius);
            (vec![(object, Place { at: [0.0, 0.0], angle: dice.angle() })], way)
        }
    };
    let text = text(dice, seed, kind, &objects, &way);
    let text = if kind == "hollow" { text.replace("[[object]]\n", "[[object]]\nhollow = true\n") } else { text };
    Generated { seed, kind, text }
}
