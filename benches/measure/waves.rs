//! Long contours of many pieces, of which the rod meets about ten, and the same cut off to these ten.
#![allow(dead_code, reason = "each bench or test takes what it needs")]

use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::contact::Outcome;
use vibrissa::contour::SplineEnd;
use vibrissa::{CircularArc, ClampPath, Composite, Contour, Event, Line, Parabola, Pose, Rod, Spline, State, Sweep};

/// Pieces of the contour that is cut off.
pub const FEW: usize = 10;
/// Way of a piece along x, in lengths of the rod: they are 0.06 to 0.1 long where the rod gets.
const ALONG: f64 = 1.0 / 16.0;
/// How far below the crest in the middle the clamp passes: 0.2 of the rod reach into the trough beside it.
const BELOW: f64 = 0.8;
/// From where to where the clamp goes, and reported states.
const WAY: (f64, f64) = (0.55, -0.75);
pub const STATES: usize = 100;
/// Radius of the discs, and distance of those from one another that are far away.
const DISC: (f64, f64) = (0.04, 2.0);

/// What the long contours are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Straight edges.
    Edges,
    /// Parabolas that hang from point to point, with notches between them: ripples on the wave.
    Ripples,
    /// The cubics of one spline.
    Cubics,
    /// Separate discs.
    Discs,
}

/// Point number `k` of waves 2 long and 1 high: y = (1 - cos pi x) / 2, with a crest of the solid above at (0, 0).
fn point(k: i32) -> [f64; 2] {
    let x = f64::from(k) * ALONG;
    // Exact for crests far away as well.
    let phase = (x - 2.0 * (0.5 * x).round()) * PI;
    [x, (0.5 * phase).sin().powi(2)]
}

/// The points of so many pieces, half of them on either side of the crest.
fn points(pieces: usize) -> Vec<[f64; 2]> {
    let half = (pieces / 2) as i32;
    (-half..=half).map(point).collect()
}

/// The parabola from one point to another, bent as much as the crest.
fn ripple([from, to]: [[f64; 2]; 2]) -> Box<dyn Contour> {
    let coefficient = 0.25 * PI * PI;
    let slope = (to[1] - from[1]) / (to[0] - from[0]);
    let x = 0.5 * (from[0] + to[0] - slope / coefficient);
    let y = from[1] - coefficient * (from[0] - x).powi(2);
    Box::new(Parabola::new([x, y], coefficient).unwrap().between(from[0], to[0]).unwrap())
}

/// The cubics of a longer spline from one of its points to another.
fn cut_off(spline: &Spline, from: usize, to: usize) -> Spline {
    let keys = serde_json::to_value(spline).unwrap();
    serde_json::from_value(keys.as_array().unwrap()[from..=to].into()).unwrap()
}

/// Disc number `k` of so many: the ten in the middle of the list hang on the crest, the others far beyond it in rows.
fn disc(k: usize, of: usize) -> Composite {
    let first = (of - FEW) / 2;
    let middle = if (first..first + FEW).contains(&k) {
        point((k - first) as i32 - (FEW / 2) as i32)
    } else {
        let (row, column) = (k / 32, k % 32);
        [DISC.1 * (column as f64 - 16.0), 3.0 + DISC.1 * row as f64]
    };
    Composite::single(CircularArc::new(middle, DISC.0, FRAC_PI_2, FRAC_PI_2 + 2.0 * PI).unwrap()).unwrap()
}

/// The shapes that so many pieces of one contour are made of; [`FEW`] of them are those of the longer ones that the rod meets.
pub fn shapes(kind: Kind, pieces: usize) -> Vec<Box<dyn Contour>> {
    let points = points(pieces);
    match kind {
        Kind::Edges => points.windows(2).map(|pair| Box::new(Line::new(pair[0], pair[1]).unwrap()) as _).collect(),
        Kind::Ripples => points.windows(2).map(|pair| ripple([pair[0], pair[1]])).collect(),
        Kind::Cubics if pieces == FEW => {
            let longer = Spline::through(&self::points(100), SplineEnd::Natural).unwrap();
            vec![Box::new(cut_off(&longer, 50 - FEW / 2, 50 + FEW / 2))]
        }
        Kind::Cubics => vec![Box::new(Spline::through(&points, SplineEnd::Natural).unwrap())],
        Kind::Discs => Vec::new(),
    }
}

/// So many pieces of a kind, as objects.
pub fn objects(kind: Kind, pieces: usize) -> Vec<Composite> {
    match kind {
        Kind::Edges => vec![Composite::polyline(&points(pieces)).unwrap()],
        Kind::Ripples | Kind::Cubics => vec![Composite::new(shapes(kind, pieces)).unwrap()],
        Kind::Discs => (0..pieces).map(|k| disc(k, pieces)).collect(),
    }
}

/// The sweep past the crest; a rod 1 long and of stiffness 1.
pub fn sweep(objects: &[Composite]) -> Outcome {
    let at = |x| Pose { x, y: -BELOW, phi: FRAC_PI_2 };
    let path = ClampPath::new(at(WAY.0), at(WAY.1)).unwrap();
    let step = path.length() / (STATES - 1) as f64;
    let outcome = Sweep::new(&Rod::new(1.0, 1.0).unwrap(), objects, path, step).unwrap().run();
    assert!(outcome.stop.is_none() && outcome.states.len() == STATES, "{:?}", outcome.stop);
    outcome
}

/// Largest difference between two sweeps, in lengths, angles and relative forces; infinite where phases or events differ.
pub fn difference(a: &Outcome, b: &Outcome) -> f64 {
    let kinds = |outcome: &Outcome| outcome.events.iter().map(|event| event.kind).collect::<Vec<_>>();
    if a.states.len() != b.states.len() || kinds(a) != kinds(b) {
        return f64::INFINITY;
    }
    let pairs = a.states.iter().zip(&b.states);
    let sides = |event: &Event| [event.before.clone(), event.after.clone()];
    let events = a.events.iter().zip(&b.events).flat_map(|(a, b)| sides(a).into_iter().zip(sides(b)));
    let states = pairs.map(|(a, b)| between(a, b)).fold(0.0, f64::max);
    events.map(|(a, b)| between(&a, &b)).fold(states, f64::max)
}

fn between(a: &State, b: &State) -> f64 {
    let numbers = |state: &State| {
        let reactions = state.reactions;
        let mut numbers = vec![state.pose.x, state.pose.y, state.energy, reactions.f0x, reactions.f0y, reactions.m0z];
        for contact in &state.contacts {
            numbers.extend([contact.s, contact.x, contact.y, contact.alpha, contact.force]);
        }
        numbers
    };
    if a.phase() != b.phase() {
        return f64::INFINITY;
    }
    let apart = |(a, b): (f64, f64)| (a - b).abs() / (1.0 + b.abs());
    numbers(a).into_iter().zip(numbers(b)).map(apart).fold(0.0, f64::max)
}

/// How many pieces carry a contact in some state or event of a sweep.
pub fn pieces_met(kind: Kind, outcome: &Outcome) -> usize {
    let shift = if kind == Kind::Discs { 0.5 } else { 0.0 };
    let events = outcome.events.iter().flat_map(|event| [&event.before, &event.after]);
    let contacts = outcome.states.iter().chain(events).flat_map(|state| &state.contacts);
    let mut pieces: Vec<_> = contacts.map(|contact| (contact.x / ALONG + shift).floor() as i32).collect();
    pieces.sort_unstable();
    pieces.dedup();
    pieces.len()
}
