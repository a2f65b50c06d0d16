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

/// The same of the pose of a fold, which a sweep locates to 1e-13 of arclength, relative to 0.01 or the derivative.
const FOLD_ERROR: f64 = 5e-12;

/// The same near a fold, over the square of the condition number: a state known to the condition number times rounding is off by
/// that over its distance from the fold, which is about the inverse of the condition number.
const NEAR_FOLDS: f64 = 1e-16;

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
            scans.push((format!("{name} {q}"), Scene::new(rod, &[object], (pose(0.8), pose(-1.0)), 0.05)));
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
fn errors_of_states(name: &str, scene: &Scene, table: &mut Table, conditions: &mut Table) {
    let outcome = scene.run();
    for (k, state) in outcome.states.iter().enumerate().filter(|(_, state)| !state.contacts.is_empty()) {
        let tau = scene.step * k as f64;
        let condition = Derivatives::new(&scene.rod, &scene.composites, state).unwrap().condition();
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
            let accepted = ERROR.max(NEAR_FOLDS * condition * condition);
            assert!(
                error < accepted,
                "{name} at {tau}, {phase}, condition {condition:e}: {quantity} is off by {error:e}"
            );
            let decade = format!("condition 1e{}", condition.log10().ceil());
            note(conditions, decade, String::new(), error);
            note(table, kind(quantity), phase.clone(), error);
        }
    }
}

#[test]
fn of_states_of_the_papers_scans() {
    let (mut table, mut conditions) = (Table::new(), Table::new());
    for (name, scene) in paper() {
        errors_of_states(&name, &scene, &mut table, &mut conditions);
    }
    print("largest relative error of a derivative, number of comparisons", &table);
    print("by condition number", &conditions);
    let phases = ["A", "B", "BA", "BB"];
    assert!(phases.iter().all(|phase| table.keys().any(|(_, column)| column == phase)), "{:?}", table.keys());
}

/// Upwards, from one x to the other at a height.
fn across(from: f64, to: f64, y: f64) -> (Pose, Pose) {
    (Pose { x: from, y, phi: UP }, Pose { x: to, y, phi: UP })
}

/// Scenes with corners, notches, discs on both sides, two objects, and a rod in SI units.
fn others() -> Vec<(String, Scene)> {
    let line = |from: [f64; 2], to: [f64; 2]| (Curve::Line, vec![from[0], from[1], to[0], to[1]]);
    let zigzag = |points: &[[f64; 2]]| points.windows(2).map(|ends| line(ends[0], ends[1])).collect::<Vec<_>>();
    let disc = |x: f64, y: f64, r: f64| vec![(Curve::Disc, vec![x, y, r])];
    let rod = Rod::new(1.0, 1.0).unwrap();
    let teeth = zigzag(&[[-2.0, 0.75], [-0.5, 0.7], [-0.2, 0.3], [0.1, 0.75], [0.35, 0.4], [0.6, 0.8], [2.0, 0.85]]);
    let shallow = zigzag(&[[-2.0, 0.95], [-0.4, 0.9], [0.0, 0.85], [0.3, 0.95], [0.6, 0.9], [2.0, 1.0]]);
    let hollow = zigzag(&[[-0.7, -1.1], [0.0, 0.9], [0.7, -1.1]]);
    let wire = Rod::new(0.1, 2.5e-3).unwrap();
    let parabola = vec![(Curve::Parabola, vec![0.0, 0.0, 50.0])];
    let turning = (Pose { x: 0.05, y: -0.04, phi: 1.2 }, Pose { x: 0.0, y: -0.045, phi: 1.9 });
    let discs = [disc(0.1, 0.45, 0.06), disc(-0.1, 0.62, 0.06), disc(0.1, 0.85, 0.05)];
    vec![
        ("teeth".into(), Scene::new(rod, std::slice::from_ref(&teeth), across(1.0, -1.0, 0.0), 0.04)),
        ("teeth, low".into(), Scene::new(rod, &[teeth], across(1.0, -1.0, -0.1), 0.04)),
        ("shallow".into(), Scene::new(rod, &[shallow], across(0.9, -1.0, 0.0), 0.04)),
        (
            "hollow".into(),
            Scene::new(rod, &[hollow], (Pose { x: 0.05, y: -0.2, phi: UP }, Pose { x: 0.08, y: 0.2, phi: UP }), 0.02),
        ),
        ("wire".into(), Scene::new(wire, &[parabola], turning, 0.002)),
        ("discs".into(), Scene::new(rod, &discs, across(0.02, -0.3, 0.0), 0.01)),
        ("discs, back".into(), Scene::new(rod, &discs, across(0.02, 0.5, 0.0), 0.01)),
    ]
}

#[test]
fn of_states_on_corners_in_notches_and_between_discs() {
    let (mut table, mut conditions) = (Table::new(), Table::new());
    // in the hollow the rod lies along a wall, between two contacts: nearly a touch along a line
    for (name, scene) in others().into_iter().filter(|(name, _)| name != "hollow") {
        errors_of_states(&name, &scene, &mut table, &mut conditions);
    }
    print("largest relative error of a derivative, number of comparisons", &table);
    print("by condition number", &conditions);
}

/// The state that tells a transition, and the equation that defines it, by what the event says.
fn defining(scene: &Scene, event: &Event) -> Option<(State, Defining)> {
    let (before, after) = (event.before.clone(), event.after.clone());
    let idle = |state: &State| state.contacts.iter().position(|contact| contact.force.abs() < 1e-9);
    let vertex = |state: &State| {
        state.contacts.iter().enumerate().find_map(|(contact, at)| {
            let object = &scene.composites[at.object];
            let is_near = |other: &vibrissa::contact::Contact| (at.x - other.x).hypot(at.y - other.y) < 1e-9;
            let moved =
                after.contacts.iter().find(|other| is_near(other) && (other.kind, other.piece) != (at.kind, at.piece));
            match at.kind {
                ContactKind::Tangent | ContactKind::Tip => {
                    let upper = |upper: bool| {
                        let stretch = object.find(vibrissa::contour::StretchKind::Piece(at.piece)).unwrap();
                        let range = object.stretch(stretch).range;
                        let end = object.frame_on(stretch, if upper { range.to } else { range.from });
                        (end.x - at.x).hypot(end.y - at.y) < 1e-9
                    };
                    let upper = [false, true].into_iter().find(|side| upper(*side))?;
                    Some(Defining::Vertex { contact, upper })
                }
                _ => moved.map(|other| Defining::Across { contact, piece: other.piece }),
            }
        })
    };
    Some(match event.kind {
        EventKind::FirstContact | EventKind::Touch => match idle(&after) {
            Some(j) if after.contacts[j].kind == ContactKind::Corner => return None,
            Some(j) => (after, Defining::Force(j)),
            None => {
                let contact = before.contacts.len().checked_sub(1)?;
                let piece = after.contacts[contact].piece;
                (before, Defining::Along { contact, piece })
            }
        },
        EventKind::Release => match idle(&before) {
            Some(j) if before.contacts[j].kind == ContactKind::Corner => return None,
            Some(j) => (before, Defining::Force(j)),
            None => {
                let defining = vertex(&before)?;
                (before, defining)
            }
        },
        EventKind::TipToTangent => (after, Defining::AtTip),
        EventKind::TangentToTip => (before, Defining::AtTip),
        EventKind::Piece | EventKind::SlipOver => {
            let defining = vertex(&before)?;
            (before, defining)
        }
        EventKind::Snap | EventKind::SnapOff => {
            // a vertex comes to the tip and slips off it
            let slips_off = before
                .contacts
                .last()
                .is_some_and(|c| c.kind == ContactKind::Corner && (c.s - scene.rod.length()).abs() < 1e-9);
            let wall = lies_on_wall(scene, &before);
            let jump = if let Some(defining) = wall {
                defining
            } else if slips_off {
                Defining::AtTip
            } else {
                Defining::Fold
            };
            let defining = vertex(&before).unwrap_or(jump);
            (before, defining)
        }
        _ => return None,
    })
}

/// The wall of its notch that the rod lies on with its tip, by the slope of the rod there.
fn lies_on_wall(scene: &Scene, state: &State) -> Option<Defining> {
    let contact = state.contacts.len().checked_sub(1)?;
    let at = state.contacts[contact];
    let phi = state.elastica(&scene.rod).unwrap().at(at.s).phi;
    let count = scene.composites[at.object].pieces();
    let walls = [at.piece, (at.piece + 1) % count].into_iter().filter(|_| at.kind == ContactKind::Notch);
    let lies_on = |piece: &usize| {
        let object = &scene.composites[at.object];
        let range = object.stretch(object.find(vibrissa::contour::StretchKind::Piece(*piece)).unwrap()).range;
        let end = object.frame(0.5 * (range.from + range.to));
        (phi - end.alpha).sin().abs() < 1e-9
    };
    walls.into_iter().find(lies_on).map(|piece| Defining::Along { contact, piece })
}

fn errors_of_transitions(name: &str, scene: &Scene, table: &mut Table) {
    let outcome = scene.run();
    for event in &outcome.events {
        let known = TransitionDerivatives::new(&scene.rod, &scene.composites, event, scene.path.rate());
        let Some((state, defining)) = defining(scene, event) else { continue };
        let ours = match known {
            // the rod lies along a wall, between two contacts
            Err(ContactError::NoCondition { .. }) if name == "hollow" => {
                note(table, "lies flat".into(), String::new(), 0.0);
                continue;
            }
            known => known.unwrap_or_else(|error| panic!("{name}: {} at {:?}: {error}", event.kind, event.before)),
        };
        let label = format!("{} ({})", event.kind, format!("{defining:?}").split([' ', '(']).next().unwrap());
        let (problem, unknowns) = Problem::new(&scene.rod, &scene.objects, &state);
        for quantity in scene.quantities() {
            let found = ours.by(quantity).unwrap();
            let [up, down] = [STEP, -STEP]
                .map(|h| problem.changed(quantity, double(h)).transition(&unknowns, scene.rate(), defining));
            let exact = f64::from((up - down) / (2.0 * STEP));
            let error = (found - exact).abs() / exact.abs().max(1e-2);
            let accepted = if defining == Defining::Fold { FOLD_ERROR } else { ERROR };
            assert!(error < accepted, "{name}: {label} by {quantity}: {found} for {exact}");
            note(table, label.clone(), String::new(), error);
        }
    }
}

#[test]
fn of_the_poses_of_transitions() {
    let mut table = Table::new();
    for (name, scene) in paper().into_iter().chain(others()) {
        errors_of_transitions(&name, &scene, &mut table);
    }
    print("largest relative error of the derivative of a pose, number of comparisons", &table);
    let kinds = [
        "first-contact",
        "touch",
        "release",
        "tip-to-tangent",
        "tangent-to-tip",
        "piece",
        "slip-over",
        "snap",
        "snap-off",
    ];
    for kind in kinds {
        assert!(table.keys().any(|(row, _)| row.split(' ').next() == Some(kind)), "{kind}: {:?}", table.keys());
    }
}

#[test]
fn what_has_no_derivatives_says_so() {
    let (_, scene) = paper().swap_remove(2);
    let outcome = scene.run();
    let folds = outcome.events.iter().filter(|event| matches!(event.kind, EventKind::Snap | EventKind::SnapOff));
    let mut count = 0;
    for fold in folds {
        let error = Derivatives::new(&scene.rod, &scene.composites, &fold.before).map(|found| found.condition());
        assert!(matches!(error, Err(ContactError::Fold { condition }) if condition > 1e10), "{error:?}");
        count += 1;
    }
    assert_eq!(count, 2);
    let state = outcome.states.iter().find(|state| !state.contacts.is_empty()).unwrap();
    let derivatives = Derivatives::new(&scene.rod, &scene.composites, state).unwrap();
    for quantity in [
        Quantity::ObjectScale(1),
        Quantity::Shape { object: 0, piece: 2, parameter: "coefficient" },
        Quantity::Shape { object: 0, piece: 0, parameter: "radius" },
    ] {
        let error = derivatives.by(quantity).unwrap_err();
        assert_eq!(error, ContactError::NoQuantity { what: quantity.to_string() });
        assert_eq!(error.to_string(), format!("there is no {quantity}"));
    }
    let softer = Rod::new(1.0, 0.5).unwrap();
    let error = Derivatives::new(&softer, &scene.composites, state).map(|found| found.condition());
    assert!(matches!(error, Err(ContactError::NotEquilibrium { .. })), "{error:?}");
    let none: Vec<Composite> = Vec::new();
    assert!(Derivatives::new(&scene.rod, &none, state).is_err());
}

/// Forces of a frictionless, elastic system come from its energy: the stiffness is symmetric, and the energy's derivatives are the
/// reactions.
#[test]
fn the_stiffness_is_symmetric() {
    let mut worst: f64 = 0.0;
    for (_, scene) in paper().into_iter().chain(others()) {
        for state in scene.run().states.iter().filter(|state| !state.contacts.is_empty()) {
            let Ok(derivatives) = Derivatives::new(&scene.rod, &scene.composites, state) else { continue };
            let k = derivatives.stiffness().unwrap();
            // moments over lengths of the rod are forces
            let length = scene.rod.length();
            let size = [k[0][0], k[1][1], k[2][2] / length.powi(2)].into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            for (i, j, lever) in [(0, 1, 1.0), (0, 2, length), (1, 2, length)] {
                worst = worst.max((k[i][j] - k[j][i]).abs() / lever / size);
            }
        }
    }
    println!("asymmetry, relative to the largest entry: {worst:e}");
    assert!(worst < 1e-12, "{worst:e}");
}
