//! Random scenes in lengths of the rod: smooth bumps, combs, vertices, stars, channels, pegs.

use super::dice::Dice;
use rod_contact::{ClampPath, Item, State, Sweep};
use rod_contours::{CircularArc, Composite, Contour, Parabola, Spline, SplineEnd};
use rod_core::{Pose, Rod};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Path length between samples: 500 a second at 5 mm/s on a rod of 100 mm.
pub const STEP: f64 = 1e-4;

/// The kinds of scenes; seeds go through them in this order.
pub const KINDS: [&str; 8] = ["bumps", "wave", "comb", "saw", "star", "blob", "channel", "pegs"];

pub struct Scene {
    pub name: String,
    pub objects: Vec<Composite>,
    pub path: ClampPath,
    pub step: f64,
}

/// A scene and what a rod meets there.
pub struct Scan {
    pub scene: Scene,
    pub rod: Rod,
    pub states: Vec<State>,
}

impl Scene {
    /// The scene of a seed; none where the random object crosses itself.
    pub fn of(seed: u64) -> Option<Self> {
        let mut dice = Dice::new(seed);
        let dice = &mut dice;
        let kind = KINDS[(seed % KINDS.len() as u64) as usize];
        // the object is above, its lowest place near y = 0
        let (objects, half) = match kind {
            "bumps" => bumps(dice, 2, 3, [25.0, 1.0 / 40.0])?,
            "wave" => wave(dice)?,
            "comb" => comb(dice)?,
            "saw" => saw(dice)?,
            "star" => star(dice)?,
            "blob" => blob(dice)?,
            "channel" => channel(dice)?,
            _ => pegs(dice)?,
        };
        let (y, angle) = (-dice.between(0.15, 0.85), FRAC_PI_2 + dice.between(-0.45, 0.45));
        let side = if dice.whole(0, 1) == 0 { 1.0 } else { -1.0 };
        let from = Pose { x: side * (half + 1.05), y, phi: angle };
        let to = Pose { x: -side * (half + 0.3), y, phi: angle };
        let path = ClampPath::new(from, to).ok()?;
        Some(Self { name: format!("{kind} {seed}"), objects, path, step: STEP })
    }

    pub fn scan(self) -> Scan {
        let rod = Rod::new(1.0, 1.0).unwrap();
        let mut states = Vec::new();
        for item in Sweep::new(&rod, &self.objects, self.path, self.step).unwrap().with_most_steps(100_000) {
            match item {
                // a sensor samples at equal times, not at the end of the path
                Ok(Item::State(state)) if is_whole(self.path.at(0.0), state.pose, self.step) => states.push(state),
                Ok(Item::State(_)) => {}
                Ok(Item::Event(_)) => {}
                Err(_) => break,
            }
        }
        Scan { scene: self, rod, states }
    }
}

type Objects = Option<(Vec<Composite>, f64)>;

fn parabolas(all: &[([f64; 2], f64)]) -> Option<Composite> {
    let piece = |(vertex, c): &([f64; 2], f64)| Parabola::new(*vertex, *c).map(|p| Box::new(p) as Box<dyn Contour>);
    Composite::joined(all.iter().map(piece).collect::<Result<_, _>>().ok()?).ok()
}

/// Parabolas; their coefficients are between the first number and the second times the first.
fn bumps(dice: &mut Dice, least: usize, most: usize, [sharpest, share]: [f64; 2]) -> Objects {
    let mut x = 0.0;
    let all: Vec<_> = (0..dice.whole(least, most))
        .map(|_| {
            let vertex = [x, dice.between(-0.05, 0.12)];
            x += dice.between(0.08, 0.45);
            (vertex, dice.log_between(share * sharpest, sharpest))
        })
        .collect();
    Some((vec![parabolas(&all)?], x))
}

/// Many narrow parabolas on an arch: three contacts.
fn comb(dice: &mut Dice) -> Objects {
    let (count, apart, sharp) = (dice.whole(3, 7), dice.between(0.06, 0.2), dice.between(20.0, 200.0));
    let arch = dice.between(-0.3, 0.8);
    let tooth = |k: usize| {
        let x = (k as f64 - 0.5 * (count - 1) as f64) * apart;
        ([x, arch * x * x + dice.between(-0.01, 0.01)], sharp)
    };
    let all: Vec<_> = (0..count).map(tooth).collect();
    Some((vec![parabolas(&all)?], 0.5 * apart * count as f64))
}

fn wave(dice: &mut Dice) -> Objects {
    let (count, apart, high) = (dice.whole(6, 12), dice.between(0.08, 0.25), dice.between(0.01, 0.15));
    let half = 0.5 * apart * (count - 1) as f64;
    let point = |k: usize| [k as f64 * apart - half, dice.between(0.0, high)];
    let mut points: Vec<_> = (0..count).map(point).collect();
    points.insert(0, [-half - 1.5, 0.6]);
    points.push([half + 1.5, 0.6]);
    let spline = Spline::through(&points, SplineEnd::Natural).ok()?;
    Some((vec![Composite::single(spline).ok()?], half))
}

/// Vertices and notches.
fn saw(dice: &mut Dice) -> Objects {
    let (count, apart) = (dice.whole(2, 5), dice.between(0.1, 0.3));
    let half = 0.5 * apart * count as f64;
    let mut points = vec![[-half - 0.05, 0.6]];
    for k in 0..count {
        let x = k as f64 * apart - half;
        points.push([x + dice.between(0.0, 0.15) * apart, dice.between(0.1, 0.3)]);
        points.push([x + dice.between(0.35, 0.65) * apart, dice.between(0.0, 0.06)]);
    }
    points.push([half + 0.05, 0.6]);
    Some((vec![Composite::polygon(&points).ok()?], half))
}

fn around(dice: &mut Dice, count: usize, radius: f64, deep: f64) -> Vec<[f64; 2]> {
    let place = |k: usize| {
        let (angle, r) =
            ((k as f64 + dice.between(-0.25, 0.25)) * TAU / count as f64, radius * dice.between(deep, 1.0));
        [r * angle.cos(), r * angle.sin() + radius]
    };
    (0..count).map(place).collect()
}

fn star(dice: &mut Dice) -> Objects {
    let (radius, count) = (dice.between(0.15, 0.6), dice.whole(5, 11));
    let points = around(dice, count, radius, 0.5);
    Some((vec![Composite::polygon(&points).ok()?], radius))
}

fn blob(dice: &mut Dice) -> Objects {
    let (radius, count) = (dice.between(0.15, 0.6), dice.whole(6, 12));
    let points = around(dice, count, radius, 0.65);
    let spline = Spline::through(&points, SplineEnd::Periodic).ok()?;
    Some((vec![Composite::single(spline).ok()?], radius))
}

fn disc(center: [f64; 2], radius: f64) -> Option<Composite> {
    let start = FRAC_PI_2;
    Composite::single(CircularArc::new(center, radius, start, start + TAU).ok()?).ok()
}

/// Discs on alternate sides of a channel that the rod is dragged along.
fn channel(dice: &mut Dice) -> Objects {
    let (low, high) = (dice.between(0.04, 0.15), dice.between(0.04, 0.15));
    let gap = dice.between(0.02, 0.2);
    let objects = vec![disc([0.0, low], low)?, disc([low + high + gap, dice.between(0.1, 0.5)], high)?];
    Some((objects, 0.4))
}

/// Two or three discs side by side, all on one side of the rod.
fn pegs(dice: &mut Dice) -> Objects {
    let (count, apart) = (dice.whole(2, 3), dice.between(0.12, 0.4));
    let peg = |k: usize| disc([k as f64 * apart, dice.between(0.05, 0.2)], dice.between(0.01, 0.45 * apart));
    let objects = (0..count).map(peg).collect::<Option<Vec<_>>>()?;
    Some((objects, 0.5 * apart * count as f64))
}

/// The comb of `scenes/comb.toml`, on which three teeth touch the rod at once.
pub fn nine_teeth() -> Scene {
    let teeth = [
        [-0.724, 0.038],
        [-0.598, -0.124],
        [-0.57, -0.113],
        [-0.599, 0.091],
        [-0.567, 0.103],
        [-0.458, -0.071],
        [-0.429, -0.063],
        [-0.437, 0.143],
        [-0.404, 0.151],
        [-0.313, -0.033],
        [-0.283, -0.027],
        [-0.271, 0.178],
        [-0.237, 0.183],
        [-0.165, -0.009],
        [-0.135, -0.006],
        [-0.102, 0.197],
        [-0.068, 0.199],
        [-0.015, 0.0],
    ];
    let right = teeth.iter().rev().map(|[x, y]| [-x, *y]);
    let points: Vec<_> = teeth.iter().copied().chain(right).chain([[0.75, 0.28], [-0.75, 0.28]]).collect();
    let pose = |x| Pose { x, y: -0.45, phi: 110.0_f64.to_radians() };
    let path = ClampPath::new(pose(1.3), pose(-1.5)).unwrap();
    let objects = vec![Composite::polygon(&points).unwrap()];
    Scene { name: "nine teeth".into(), objects, path, step: STEP }
}

/// Parabolas in lengths of the rod past which a rod is swept along a line.
pub fn of_parabolas(name: &str, all: &[([f64; 2], f64)], [from, to, y]: [f64; 3], degrees: f64) -> Scene {
    let pose = |x| Pose { x, y, phi: degrees.to_radians() };
    let path = ClampPath::new(pose(from), pose(to)).unwrap();
    Scene { name: name.into(), objects: vec![parabolas(all).unwrap()], path, step: STEP }
}

/// Whether the clamp has come a whole number of steps.
fn is_whole(from: Pose, at: Pose, step: f64) -> bool {
    let steps = (at.x - from.x).hypot(at.y - from.y) / step;
    (steps - steps.round()).abs() < 1e-6
}
