//! Derivatives of states and of the poses of transitions, against central differences of a solver in double-double numbers
//! (`problem.rs`), whose error is below 1e-16: the bound of the comparison is the library's own.

mod double;
mod problem;

use crate::common::{OBJECTS, UP};
use double::{Double, double};
use problem::{Curve, Defining, Found, Object, Problem, STEP, Shape};
use std::collections::BTreeMap;
use vibrissa::contact::{
    ContactError, ContactKind, Derivatives, Event, EventKind, Outcome, Quantity, TransitionDerivatives,
};
use vibrissa::contour::Contour;
use vibrissa::{CircularArc, ClampPath, Composite, Line, Parabola, Pose, Rod, State, Sweep};

/// Largest error of a derivative, relative to the largest of its kind (reactions, points, arc lengths, forces) of the same
/// state and quantity.
const ERROR: f64 = 1e-12;

/// Way of the clamp to a fold (L) below which a state counts as next to it: the derivatives grow there without bound.
const NEXT_TO_FOLD: f64 = 1e-3;

/// A scene in the library's types and in the judge's.
struct Scene {
    rod: Rod,
    composites: Vec<Composite>,
    objects: Vec<Object>,
    path: ClampPath,
    step: f64,
}

/// A piece of an object, by its curve and parameters.
type Piece = (Curve, Vec<f64>);

fn contour((curve, p): &Piece) -> Box<dyn Contour> {
    match curve {
        Curve::Parabola => Box::new(Parabola::new([p[0], p[1]], p[2]).unwrap()),
        Curve::Disc => {
            Box::new(CircularArc::new([p[0], p[1]], p[2], -std::f64::consts::PI, std::f64::consts::PI).unwrap())
        }
        Curve::Line => Box::new(Line::new([p[0], p[1]], [p[2], p[3]]).unwrap()),
    }
}

impl Scene {
    fn new(rod: Rod, objects: &[Vec<Piece>], (from, to): (Pose, Pose), step: f64) -> Self {
        let composites = objects.iter().map(|pieces| {
            let all: Vec<_> = pieces.iter().map(contour).collect();
            Composite::joined(all).unwrap()
        });
        let judged = objects.iter().map(|pieces| {
            Object::new(pieces.iter().map(|(curve, parameters)| Shape::new(*curve, parameters)).collect())
        });
        let path = ClampPath::new(from, to).unwrap();
        Self { rod, composites: composites.collect(), objects: judged.collect(), path, step }
    }

    fn run(&self) -> Outcome {
        Sweep::new(&self.rod, &self.composites, self.path, self.step).unwrap().run()
    }

    /// All that the scene depends on.
    fn quantities(&self) -> Vec<Quantity<'static>> {
        let mut all =
            vec![Quantity::ClampX, Quantity::ClampY, Quantity::ClampAngle, Quantity::Stiffness, Quantity::Length];
        for (object, judged) in self.objects.iter().enumerate() {
            all.extend([Quantity::ObjectX(object), Quantity::ObjectY(object)]);
            all.extend([Quantity::ObjectAngle(object), Quantity::ObjectScale(object)]);
            for (piece, shape) in judged.pieces.iter().enumerate() {
                all.extend(shape.names().iter().map(|parameter| Quantity::Shape { object, piece, parameter }));
            }
        }
        all
    }

    fn rate(&self) -> [f64; 3] {
        let Pose { x, y, phi } = self.path.rate();
        [x, y, phi]
    }
}

/// The nine scans of the paper.
fn paper() -> Vec<(String, Scene)> {
    let mut scans = Vec::new();
    for (name, first, second) in OBJECTS {
        for q in [0.2, 0.4, 0.6] {
            let y = f64::min(first, second) - q;
            let pose = |x| Pose { x, y, phi: UP };
            let parabola = |x: f64, y: f64| (Curve::Parabola, vec![x, y, 5.0]);
            let object = vec![parabola(0.0, first), parabola(0.3, second)];
            let rod = Rod::new(1.0, 1.0).unwrap();
            scans.push((format!("{name} {q}"), Scene::new(rod, &[object], (pose(0.8), pose(-1.0)), 0.03)));
        }
    }
    scans
}

/// A name without the numbers of object and piece.
fn kind(quantity: Quantity<'_>) -> String {
    match quantity {
        Quantity::Shape { parameter, .. } => format!("shape: {parameter}"),
        Quantity::ObjectX(_) => "object: x".into(),
        Quantity::ObjectY(_) => "object: y".into(),
        Quantity::ObjectAngle(_) => "object: angle".into(),
        Quantity::ObjectScale(_) => "object: scale".into(),
        other => other.to_string(),
    }
}

/// Central differences of all that is compared, in groups: reactions, points, arc lengths, forces, angles.
fn differences(up: &Found, down: &Found) -> [Vec<f64>; 5] {
    let by = |up: Double, down: Double| f64::from((up - down) / (2.0 * STEP));
    let mut groups: [Vec<f64>; 5] = Default::default();
    groups[0] = up.reactions.iter().zip(down.reactions).map(|(up, down)| by(*up, down)).collect();
    for ((up, ahead), (down, behind)) in up.contacts.iter().zip(&down.contacts) {
        for (k, group) in [1, 1, 2, 3].into_iter().enumerate() {
            groups[group].push(by(up[k], down[k]));
        }
        groups[4].push(by(behind[0] * ahead[1], behind[1] * ahead[0]));
    }
    groups
}

/// The largest error of the derivatives of a state by a quantity, each relative to the largest of its group.
fn error(scene: &Scene, state: &State, problem: &(Problem, Vec<Double>), quantity: Quantity<'_>) -> f64 {
    let ours = Derivatives::new(&scene.rod, &scene.composites, state).unwrap().by(quantity).unwrap();
    let (problem, unknowns) = problem;
    let [up, down] = [STEP, -STEP].map(|h| problem.changed(quantity, double(h)).solved(unknowns).1);
    let groups = differences(&up, &down);
    let reactions = [ours.reactions.f0x, ours.reactions.f0y, ours.reactions.m0z];
    let mut found: [Vec<f64>; 5] = Default::default();
    found[0] = reactions.to_vec();
    for contact in &ours.contacts {
        found[1].extend([contact.x, contact.y]);
        found[2].push(contact.s);
        found[3].push(contact.force);
        found[4].push(contact.alpha);
    }
    let largest = |group: &[f64]| group.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let of_group = |(ours, exact): (&Vec<f64>, &Vec<f64>)| {
        let off = ours.iter().zip(exact).map(|(ours, exact)| (ours - exact).abs()).fold(0.0, f64::max);
        // what does not change at all is compared with 1
        if largest(exact) < 1e-9 { off } else { off / largest(exact) }
    };
    found.iter().zip(&groups).map(of_group).fold(0.0, f64::max)
}

type Table = BTreeMap<(String, String), (f64, usize)>;

fn note(table: &mut Table, row: String, column: String, error: f64) {
    let entry = table.entry((row, column)).or_default();
    *entry = (entry.0.max(error), entry.1 + 1);
}

fn print(title: &str, table: &Table) {
    println!("{title}");
    for ((row, column), (error, count)) in table {
        println!("{row:24} {column:16} {error:8.1e} {count:5}");
    }
}

/// The errors of the derivatives of all states of a scene in contact, by quantity and phase.
fn errors_of_states(name: &str, scene: &Scene, table: &mut Table) {
    let outcome = scene.run();
    let folds: Vec<f64> = outcome
        .events
        .iter()
        .filter(|event| matches!(event.kind, EventKind::Snap | EventKind::SnapOff))
        .map(|event| (event.pose().x, event.pose().y))
        .map(|(x, y)| (x - scene.path.at(0.0).x).hypot(y - scene.path.at(0.0).y))
        .collect();
    for (k, state) in outcome.states.iter().enumerate().filter(|(_, state)| !state.contacts.is_empty()) {
        let tau = scene.step * k as f64;
        let at = (state.pose.x - scene.path.at(0.0).x).hypot(state.pose.y - scene.path.at(0.0).y);
        if folds.iter().any(|fold| (fold - at).abs() < NEXT_TO_FOLD) {
            continue;
        }
        let problem = Problem::new(&scene.rod, &scene.objects, state);
        let solved = problem.0.solved(&problem.1);
        let problem = (problem.0, solved.0);
        let kinds = state.contacts.iter().map(|contact| match contact.kind {
            ContactKind::Corner => 'c',
            ContactKind::Notch => 'n',
            ContactKind::Tip => 'A',
            _ => 'B',
        });
        let phase: String = kinds.collect();
        for quantity in scene.quantities() {
            let error = error(scene, state, &problem, quantity);
            assert!(error < ERROR, "{name} at {tau}, {phase}: {quantity} is off by {error:e}");
            note(table, kind(quantity), phase.clone(), error);
        }
    }
}

#[test]
fn of_states_of_the_papers_scans() {
    let mut table = Table::new();
    for (name, scene) in paper() {
        errors_of_states(&name, &scene, &mut table);
    }
    print("largest relative error of a derivative, number of comparisons", &table);
    let phases = ["A", "B", "BA", "BB"];
    assert!(phases.iter().all(|phase| table.keys().any(|(_, column)| column == phase)), "{:?}", table.keys());
}
