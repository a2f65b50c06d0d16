//! Random scenes with friction: discs, polygons and parabolas, and clamps that go forth and back, turn and dither, judged by [`Judge`].

use super::judge::{Counts, Judge, Shape};
use crate::common::numbers::Numbers;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use vibrissa::contact::{Chain, EventKind, Item, Path, Stop};
use vibrissa::contour::{Jet, Range};
use vibrissa::rod::Pose;
use vibrissa::{CircularArc, Composite, Graph, Parabola, Rod, Sweep};

struct Scene {
    shapes: Vec<Shape>,
    objects: Vec<Composite>,
    mu: Vec<f64>,
    path: Chain,
    /// Steps of the states of each leg.
    steps: Vec<f64>,
}

pub fn composite(shape: &Shape) -> Composite {
    match shape {
        Shape::Disc(centre, radius) => {
            Composite::single(CircularArc::new(*centre, *radius, 0.0, TAU).unwrap()).unwrap()
        }
        Shape::Polygon(points) => Composite::polygon(points).unwrap(),
        Shape::Quartic([c0, c1, c2, c3, c4]) => {
            let (c0, c1, c2, c3, c4) = (*c0, *c1, *c2, *c3, *c4);
            let graph = move |x: Jet| x * x * x * (x * c4 + c3) + x * (x * c2 + c1) + c0;
            Composite::single(Graph::new(Range { from: -2.0, to: 0.7 }, graph).unwrap()).unwrap()
        }
        Shape::Parabolas(all) => {
            let parabola = |(vertex, c): &([f64; 2], f64)| Box::new(Parabola::new(*vertex, *c).unwrap()) as _;
            Composite::joined(all.iter().map(parabola).collect()).unwrap()
        }
    }
}

/// A convex polygon in a circle.
fn polygon(numbers: &mut Numbers, [x, y]: [f64; 2], radius: f64) -> Shape {
    let (count, start) = (3 + numbers.below(4), numbers.within(0.0, TAU));
    let turn = |k: u64, numbers: &mut Numbers| start + (k as f64 + numbers.within(-0.3, 0.3)) * TAU / count as f64;
    Shape::Polygon(
        (0..count).map(|k| turn(k, numbers)).map(|at| [x + radius * at.cos(), y + radius * at.sin()]).collect(),
    )
}

/// The scene of a seed, with states at about this distance (L or rad).
fn scene(seed: u64, distance: f64) -> Scene {
    let mut numbers = Numbers(seed);
    let rotates = numbers.below(3) == 0;
    let mut shapes = Vec::new();
    if !rotates && numbers.below(3) == 0 {
        let mut at = numbers.within(-0.3, 0.0);
        let mut all = Vec::new();
        for _ in 0..1 + numbers.below(2) {
            all.push(([at, numbers.within(0.45, 0.55)], numbers.within(2.0, 8.0)));
            at += numbers.within(0.25, 0.4);
        }
        shapes.push(Shape::Parabolas(all));
    } else {
        let mut rounds: Vec<([f64; 2], f64)> = Vec::new();
        for _ in 0..1 + numbers.below(3) {
            let radius = numbers.within(0.03, 0.2);
            let centre = if rotates {
                let (far, turn) = (numbers.within(0.5, 1.0), FRAC_PI_2 + numbers.within(-0.7, 0.7));
                [far * turn.cos(), far * turn.sin()]
            } else {
                [numbers.within(-0.5, 0.5), numbers.within(0.3, 1.0)]
            };
            let clear =
                |([x, y], other): &([f64; 2], f64)| (x - centre[0]).hypot(y - centre[1]) > radius + other + 0.02;
            if !rounds.iter().all(clear) {
                continue;
            }
            rounds.push((centre, radius));
            shapes.push(match numbers.below(2) {
                0 => Shape::Disc(centre, radius),
                _ => polygon(&mut numbers, centre, radius),
            });
        }
    }
    let mu =
        shapes.iter().map(|_| if numbers.below(12) == 0 { 0.0 } else { 10.0_f64.powf(numbers.within(-2.0, 0.176)) });
    let mu = mu.collect();
    // on a line of poses, with some way along the rod in between
    let (sign, lean) = (if numbers.below(2) == 0 { 1.0 } else { -1.0 }, numbers.within(-0.4, 0.4));
    let farthest = if rotates { 0.45 * PI } else { 1.6 };
    let at = |part: f64, up: f64| {
        let way = part * sign * farthest;
        let place = if rotates { (0.0, FRAC_PI_2 + way) } else { (way, FRAC_PI_2 + lean) };
        Pose { x: place.0, y: up, phi: place.1 }
    };
    let mut poses = vec![at(1.0, 0.0)];
    let mut part = numbers.within(-0.5, 0.5);
    poses.push(at(part, 0.0));
    for _ in 0..numbers.below(4) {
        let sideways = numbers.below(2) == 0;
        let way = 10.0_f64.powf(numbers.within(-3.0, -0.7));
        for turn in [1.0, -1.0, 1.0] {
            if sideways {
                part += turn * way;
                poses.push(at(part, 0.0));
            } else {
                // forth and back along the rod, within a dither
                poses.push(at(part + 0.1 * turn * way, 0.2 * turn * way));
            }
        }
        poses.push(at(part, 0.0));
    }
    poses.push(at(-1.0, 0.0));
    poses.dedup();
    let path = Chain::polyline(&poses).unwrap();
    // at least ten states a leg
    let step = |leg: f64| leg / (leg / distance).ceil().max(10.0);
    let steps = path.legs().iter().map(|leg| step(leg.length())).collect();
    let objects = shapes.iter().map(composite).collect();
    Scene { shapes, objects, mu, path, steps }
}

/// Leg, kind, pose and work of friction of each event, and why the sweep stopped.
type Told = (Vec<(usize, EventKind, [f64; 3], f64)>, String);

fn told(scene: &Scene, share: f64) -> Told {
    let steps: Vec<f64> = scene.steps.iter().map(|step| step * share).collect();
    let sweep = Sweep::with_steps(&Rod::new(1.0, 1.0).unwrap(), &scene.objects, scene.path.clone(), &steps).unwrap();
    told_by(&sweep.with_friction(scene.mu.clone()).unwrap().collect::<Vec<_>>())
}

fn told_by(items: &[Result<Item, Stop>]) -> Told {
    let (mut events, mut stop) = (Vec::new(), String::new());
    for item in items {
        match item {
            Ok(Item::Event(event)) => {
                let Pose { x, y, phi } = event.pose();
                events.push((event.leg(), event.kind, [x, y, phi], event.dissipated.unwrap_or(f64::NAN)));
            }
            Ok(Item::State(_)) => {}
            Err(why) => stop = why.reason.to_string(),
        }
    }
    (events, stop)
}

fn differ(a: &Told, b: &Told) -> Option<String> {
    if a.1 != b.1 || a.0.len() != b.0.len() {
        return Some(format!("{} and {} events, stops {:?} and {:?}", a.0.len(), b.0.len(), a.1, b.1));
    }
    a.0.iter().zip(&b.0).find_map(|(a, b)| {
        let far = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9;
        let other = (a.0, a.1) != (b.0, b.1) || a.2.iter().zip(&b.2).any(far);
        let work = (a.3 - b.3).abs() > 1e-8 * (1.0 + a.3.abs()) || a.3.is_nan() != b.3.is_nan();
        (other || work).then(|| format!("{a:?} and {b:?}"))
    })
}

fn these(seeds: std::ops::Range<u64>, distance: f64) -> (Counts, Vec<String>) {
    let (mut counts, mut wrong) = (Counts::default(), Vec::new());
    for seed in seeds {
        let scene = scene(seed, distance);
        let judge = Judge { law: &|_, m| m, compliance: [[0.0; 3]; 3], shapes: &scene.shapes, mu: &scene.mu };
        let sweep =
            Sweep::with_steps(&Rod::new(1.0, 1.0).unwrap(), &scene.objects, scene.path.clone(), &scene.steps).unwrap();
        let items: Vec<_> = sweep.with_friction(scene.mu.clone()).unwrap().collect();
        let once = told_by(&items);
        let (seen, faults) = judge.run(items.into_iter());
        counts.add(seen);
        wrong.extend(faults.into_iter().take(4).map(|what| format!("{seed}: {what}")));
        for share in [0.5, 1e3] {
            if let Some(difference) = differ(&once, &told(&scene, share)) {
                wrong.push(format!("{seed}: with {share} of the step {difference}"));
            }
        }
        if std::env::var("EACH").is_ok() {
            println!("{seed}: {:?} {}", once.0.iter().map(|event| event.1.to_string()).collect::<Vec<_>>(), once.1);
        }
    }
    (counts, wrong)
}

#[test]
fn every_motion_obeys_coulomb() {
    let (counts, wrong) = these(0..16, 0.02);
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(counts.slips > 500 && counts.sticks + counts.rolls > 60 && counts.balanced > 30, "{counts:?}");
    assert!(counts.events["stick"] > 2 && counts.events["slip"] > 10, "{counts:?}");
}

/// A straight rod that turns upon a corner is drawn over it: it cannot stick there, whatever the friction.
#[test]
fn a_turning_rod_slips_over_a_corner() {
    let (counts, wrong) = these(191..192, 0.01);
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(counts.stops.is_empty() && counts.events["first-contact"] == 1 && counts.slips > 20, "{counts:?}");
}

/// `SEEDS=0..400 cargo test -p vibrissa --test suite friction::random::many -- --ignored --nocapture`; with `EACH=1` the events of each scene.
#[test]
#[ignore = "takes minutes"]
fn many() {
    let seeds = std::env::var("SEEDS").unwrap_or_else(|_| "0..400".into());
    let (from, to) = seeds.split_once("..").unwrap();
    let (counts, wrong) = these(from.parse().unwrap()..to.parse().unwrap(), 0.01);
    println!("{counts:#?}");
    println!("wrong {}: {wrong:#?}", wrong.len());
    assert!(wrong.is_empty());
}
