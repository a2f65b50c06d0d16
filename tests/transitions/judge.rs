//! A judge of transitions that knows the rod, its springs and Coulomb's law, and nothing of the solver: it integrates shape and energy of a state
//! from its reactions, and the work of the clamp from the states.

use super::scene::Scene;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;
use vibrissa::State;
use vibrissa::contact::{Contact, ContactKind, Event, EventKind, Item, SlipMode, Stop};

/// Steps of the integration along the rod, of order 4: its error is below 1e-11.
const STEPS: usize = 800;

/// A point of the rod, its slope angle, and the energy up to there.
#[derive(Clone, Copy)]
struct At {
    x: f64,
    y: f64,
    phi: f64,
    energy: f64,
}

/// The shape of a state by classical Runge-Kutta steps from its clamp: points at every s = k / `STEPS` and at each contact, and its energy.
pub struct Shape {
    points: Vec<(f64, At)>,
    /// Energy of rod and springs, E I / L.
    pub energy: f64,
    /// Moment at the tip, and how far the rod misses its contacts.
    pub error: f64,
}

impl Shape {
    pub fn of(scene: &Scene, state: &State) -> Self {
        let l = scene.length;
        let felt = Vector3::new(state.reactions.f0x * l, state.reactions.f0y * l, state.reactions.m0z);
        let given =
            scene.springs.map_or(Vector3::zeros(), |k| Matrix3::from_fn(|i, j| k[i][j]).try_inverse().unwrap() * felt);
        let mut here = At {
            x: state.pose.x / l - given[0],
            y: state.pose.y / l - given[1],
            phi: state.pose.phi - given[2],
            energy: 0.5 * given.dot(&felt),
        };
        let (mut a, mut b, mut s) = (felt[1], -felt[0], 0.0);
        // the moment by its balance about the point where the force changed
        let mut origin = (here.x, here.y, -felt[2]);
        let (mut points, mut error) = (vec![(s, here)], 0.0_f64);
        let mut ends: Vec<(f64, Option<usize>)> = (1..=STEPS).map(|k| (k as f64 / STEPS as f64, None)).collect();
        ends.extend(scene.material.joint().map(|joint| (joint, None)));
        ends.extend(state.contacts.iter().enumerate().map(|(j, contact)| (contact.s / l, Some(j))));
        ends.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (to, contact) in ends {
            let rate = |at: &At, s: f64| {
                let moment = origin.2 + a * (at.x - origin.0) + b * (at.y - origin.1);
                // one side of a joint
                let (stiffness, natural) = scene.material.at(s.max(points[points.len() - 1].0 + 1e-13).min(to - 1e-13));
                let phi = moment / stiffness + natural;
                At { x: at.phi.cos(), y: at.phi.sin(), phi, energy: 0.5 * moment * moment / stiffness }
            };
            let moved = |at: &At, by: &At, h: f64| At {
                x: at.x + h * by.x,
                y: at.y + h * by.y,
                phi: at.phi + h * by.phi,
                energy: at.energy + h * by.energy,
            };
            let h = to - s;
            if h > 0.0 {
                let one = rate(&here, s);
                let two = rate(&moved(&here, &one, 0.5 * h), s + 0.5 * h);
                let three = rate(&moved(&here, &two, 0.5 * h), s + 0.5 * h);
                let four = rate(&moved(&here, &three, h), to);
                for (slope, weight) in [(one, 1.0), (two, 2.0), (three, 2.0), (four, 1.0)] {
                    here = moved(&here, &slope, weight * h / 6.0);
                }
                s = to;
                points.push((s, here));
            }
            if let Some(contact) = contact.map(|j| &state.contacts[j]) {
                error = error.max((here.x - contact.x / l).hypot(here.y - contact.y / l));
                let moment = origin.2 + a * (here.x - origin.0) + b * (here.y - origin.1);
                let (sin, cos) = contact.alpha.sin_cos();
                let (f, g) = (contact.force * l, contact.friction.map_or(0.0, |friction| friction.force * l));
                (a, b) = (a - f * cos + g * sin, b - f * sin - g * cos);
                origin = (here.x, here.y, moment);
            }
        }
        let left = origin.2 + a * (here.x - origin.0) + b * (here.y - origin.1);
        Self { energy: here.energy, points, error: error.max(left.abs()) }
    }

    /// The point at an arc length, between points by their tangents.
    fn at(&self, s: f64) -> (f64, f64) {
        let after = self.points.partition_point(|(at, _)| *at < s).clamp(1, self.points.len() - 1);
        let ((from, p), (to, q)) = (self.points[after - 1], self.points[after]);
        let (h, t) = (to - from, (s - from) / (to - from));
        let [a, b, c, d] =
            [(1.0 + 2.0 * t) * (1.0 - t).powi(2), t * (1.0 - t).powi(2), t * t * (3.0 - 2.0 * t), t * t * (t - 1.0)];
        let along = |x: f64, dx: f64, y: f64, dy: f64| a * x + b * h * dx + c * y + d * h * dy;
        (along(p.x, p.phi.cos(), q.x, q.phi.cos()), along(p.y, p.phi.sin(), q.y, q.phi.sin()))
    }
}

/// Energy (E I / L) that is rounding, relative to 1 + energy + forces.
const ENERGY: f64 = 1e-9;
/// Longest way (L plus rad) of the path from the end of a branch to where the next one begins.
const FARTHEST: f64 = 0.06;
/// Force (E I / L^2) that is rounding.
const FORCE: f64 = 1e-9;
/// Displacement (L) of the rod along a contour that is the error of the integration.
const STILL: f64 = 1e-9;
/// Change of a slip coordinate (L) between two states from which on it counts from another point of the contour.
const ANEW: f64 = 0.2;

/// What is wrong with the transitions of a sweep.
pub fn faults(scene: &Scene, items: &[Result<Item, Stop>]) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut last: Option<&State> = None;
    for item in items.iter().flatten() {
        let (state, event) = match item {
            Item::State(state) => (state, None),
            Item::Event(event) => (&event.before, Some(event)),
        };
        if let Some(last) = last {
            wrong.extend(motion(scene, last, state));
        }
        last = Some(event.map_or(state, |event| &event.after));
        wrong.extend(event.into_iter().flat_map(|event| energy(scene, event)));
    }
    wrong
}

fn modes(state: &State) -> String {
    let mode = |c: &Contact| c.friction.map_or_else(|| c.kind.to_string(), |f| format!("{} {}", c.kind, f.mode));
    state.contacts.iter().map(mode).collect::<Vec<_>>().join(", ")
}

/// Sum of the forces of a state.
fn forces(scene: &Scene, state: &State) -> f64 {
    state.contacts.iter().map(|contact| contact.force * scene.length).sum()
}

/// Whether the tip is in a notch.
fn in_notch(state: &State) -> bool {
    state.contacts.last().is_some_and(|contact| contact.kind == ContactKind::Notch)
}

/// What an event gains or loses that it must not.
fn energy(scene: &Scene, event: &Event) -> Vec<String> {
    let Event { kind, before, after, .. } = event;
    let mut wrong = Vec::new();
    let [one, other] = [before, after].map(|state| Shape::of(scene, state));
    let scale = 1.0 + one.energy + forces(scene, before) + forces(scene, after);
    if one.error.max(other.error) > 1e-7 * scale {
        wrong.push(format!("is none of equilibria: misses contacts by {:e} and {:e}", one.error, other.error));
    }
    if (one.energy - before.energy).abs().max((other.energy - after.energy).abs()) > ENERGY * scale {
        wrong.push(format!(
            "has energies {} and {}, said {} and {}",
            one.energy, other.energy, before.energy, after.energy
        ));
    }
    let gained = other.energy - one.energy;
    // a landing further along the path gains no more than the clamp can push in on the way there
    let way = (after.pose.x - before.pose.x).hypot(after.pose.y - before.pose.y) / scene.length
        + (after.pose.phi - before.pose.phi).abs();
    if gained > ENERGY * scale + way * scale || way > FARTHEST {
        wrong.push(format!("gains {gained:e} from {} on {way:e} of the path", one.energy));
    }
    // a contact that begins to slip, as a tip that leaves a notch does, is held back by less than before where the static coefficient is the larger one
    let loosens = |[at_rest, slipping]: &[f64; 2]| at_rest > slipping;
    let begins = *kind == EventKind::Slip || (*kind == EventKind::Piece && in_notch(before) && !in_notch(after));
    let loosened = begins && scene.friction.as_ref().is_some_and(|all| all.iter().any(loosens));
    let jumps = loosened || matches!(kind, EventKind::Snap | EventKind::SnapOff | EventKind::SlipOver);
    if !jumps && gained.abs() > 1e-7 * scale {
        wrong.push(format!("is no jump and loses {:e}", -gained));
    }
    if *kind == EventKind::FirstContact && (forces(scene, after) > FORCE || !after.certificate.stable) {
        wrong.push(format!("begins with the force {:e}, stable: {}", forces(scene, after), after.certificate.stable));
    }
    let place = format!(
        "{kind} {} ({}) to {} ({}) at {:?}",
        event.from(),
        modes(before),
        event.to(),
        modes(after),
        event.pose()
    );
    wrong.iter().map(|what| format!("{place}: {what}")).collect()
}

/// What is wrong with the motion of the rod over its contacts from one state to the next on the same branch.
fn motion(scene: &Scene, a: &State, b: &State) -> Vec<String> {
    if a.contacts.len() != b.contacts.len() {
        return vec![format!("from {} to {} without an event at {:?}", a.phase(), b.phase(), b.pose)];
    }
    let l = scene.length;
    let mut shape: Option<Shape> = None;
    let mut wrong = Vec::new();
    for (j, (from, to)) in a.contacts.iter().zip(&b.contacts).enumerate() {
        if (from.object, from.kind, from.piece) != (to.object, to.kind, to.piece) {
            wrong.push(format!("contact {j} goes from {} to {} without an event at {:?}", from.kind, to.kind, b.pose));
            continue;
        }
        let (Some(before), Some(told)) = (from.friction, to.friction) else { continue };
        let slip = (told.slip - before.slip) / l;
        if from.kind == ContactKind::Notch || slip.abs() > ANEW {
            continue;
        }
        // the material point that was the contact, along the contour's mean direction there
        let (x, y) = shape.get_or_insert_with(|| Shape::of(scene, b)).at(from.s / l);
        let turn = to.alpha - from.alpha;
        let turn = turn - TAU * (turn / TAU).round();
        let alpha = from.alpha + 0.5 * turn;
        let moved = (x - from.x / l) * alpha.cos() + (y - from.y / l) * alpha.sin();
        let ways = (to.s - from.s).abs() / l + (to.x - from.x).hypot(to.y - from.y) / l;
        let error = STILL * (1.0 + from.force * l) + ways * (3.0 * ways + turn.abs()).powi(2);
        if (slip - moved).abs() > 10.0 * error {
            wrong.push(format!("contact {j} slips by {moved:e} +- {error:e}, said {slip:e}, at {:?}", b.pose));
        }
        let against = match told.mode {
            SlipMode::Forward => -slip,
            SlipMode::Backward => slip,
            _ => slip.abs(),
        };
        if against > STILL {
            wrong.push(format!("contact {j}, said to {}, slips by {slip:e} at {:?}", told.mode, b.pose));
        }
    }
    wrong
}

/// Work of the clamp less the change of energy of a whole sweep, by the trapezoidal rule between its states, and its error by the same rule with
/// every other state.
pub fn balance<'a>(items: &'a [Result<Item, Stop>]) -> (f64, f64) {
    let work = |a: &State, b: &State| {
        let [f, g] = [a, b].map(|state| state.reactions);
        let (x, y) = (b.pose.x - a.pose.x, b.pose.y - a.pose.y);
        0.5 * ((f.f0x + g.f0x) * x + (f.f0y + g.f0y) * y + (f.m0z + g.m0z) * (b.pose.phi - a.pose.phi))
    };
    // of a stretch without events on one leg
    let of_stretch = |stretch: &[&'a State]| {
        let (Some(first), Some(last)) = (stretch.first(), stretch.last()) else { return [0.0; 2] };
        let sum = |states: &[&'a State]| states.windows(2).map(|pair| work(pair[0], pair[1])).sum::<f64>();
        let every_other = |(k, state): (usize, &&'a State)| (k % 2 == 0 || k + 1 == stretch.len()).then_some(*state);
        let kept: Vec<_> = stretch.iter().enumerate().filter_map(every_other).collect();
        [sum(stretch) - (last.energy - first.energy), (sum(stretch) - sum(&kept)).abs()]
    };
    let (mut all, mut jumps, mut stretch) = (Vec::new(), 0.0, Vec::new());
    for item in items.iter().flatten() {
        match item {
            Item::State(state) => {
                if let Some(&corner) = stretch.last().filter(|last: &&&State| last.leg != state.leg) {
                    all.push(of_stretch(&stretch));
                    stretch = vec![corner];
                }
                stretch.push(state);
            }
            Item::Event(event) => {
                stretch.push(&event.before);
                all.push(of_stretch(&stretch));
                jumps += event.before.energy - event.after.energy;
                stretch = vec![&event.after];
            }
        }
    }
    all.push(of_stretch(&stretch));
    all.iter().fold((jumps, 0.0), |(rest, error), [more, off]| (rest + more, error + off))
}
