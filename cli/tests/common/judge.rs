//! Whether a reported state is an equilibrium of its scene, from its numbers and the contours alone: any shapes, any number of
//! objects, on either side of the rod.

use std::f64::consts::PI;
use vibrissa::{Composite, Contact, ContactKind, Event, EventKind, Outcome, Pose, State, Stretch, StretchKind};
use vibrissa_cli::Scene;

/// Steps of the integration per length of the rod: what the fourth order leaves is below 1e-11 at the forces of the scenes.
const STEPS: f64 = 4000.0;
/// Gaps are measured after every so many steps.
const STRIDE: usize = 10;
/// Lengths in rod lengths, angles, moments, forces: what may be missing, times one plus the contact forces.
const TOLERANCE: f64 = 1e-9;
/// A transition and its undoing closer together than this, in rod lengths along the path, are no physics.
const NEAR: f64 = 1e-6;

/// Everything that must hold of all that a sweep gave: no early stop, no transition that is undone where it was made, and
/// every state an equilibrium, those at the transitions too.
pub fn judge(scene: &Scene, outcome: &Outcome) -> Result<(), String> {
    let name = &scene.name;
    if let Some(stop) = &outcome.stop {
        return Err(format!("{name}: {stop}"));
    }
    for state in &outcome.states {
        judge_state(scene, state).and_then(|()| stable(state)).map_err(|what| format!("{name}: {what}"))?;
    }
    for event in &outcome.events {
        let lands = matches!(event.kind, EventKind::Snap | EventKind::SnapOff | EventKind::Slip);
        for (state, ends) in [(&event.before, lands), (&event.after, false)] {
            // where an equilibrium ends it is on the verge of stability
            let stable = if ends { Ok(()) } else { stable(state) };
            judge_state(scene, state).and(stable).map_err(|what| format!("{name}, at a {}: {what}", event.kind))?;
        }
        // a rod that lands at the pose where it let go has only lost energy
        let rises = lands && event.after.pose == event.before.pose && event.after.energy > event.before.energy;
        hold(!rises, || format!("{name}: {} gains energy", told(event)))?;
    }
    outcome.events.windows(2).try_for_each(|pair| {
        let back = at(&pair[0].before) == at(&pair[1].after) && at(&pair[0].before) != at(&pair[0].after);
        let way = distance(pair[0].pose(), pair[1].pose(), scene.rod.length());
        hold(!back || way > NEAR, || format!("{name}: {} and {} undo each other", told(&pair[0]), told(&pair[1])))
    })
}

fn stable(state: &State) -> Result<(), String> {
    hold(state.certificate.stable, || format!("phase {} at {:?} is not stable", state.phase(), state.pose))
}

/// Everything that must hold of one state but that it is stable.
pub fn judge_state(scene: &Scene, state: &State) -> Result<(), String> {
    let outcome = balances(scene, state)
        .and_then(|()| state.contacts.iter().try_for_each(|contact| lies_on(scene, contact)))
        .and_then(|()| meets(scene, state));
    outcome.map_err(|what| format!("{what}, in phase {} at {:?}", state.phase(), state.pose))
}

fn hold(condition: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if condition { Ok(()) } else { Err(what()) }
}

/// Where the contacts of a state are.
fn at(state: &State) -> Vec<(usize, usize, ContactKind)> {
    state.contacts.iter().map(|c| (c.object, c.piece, c.kind)).collect()
}

fn told(event: &Event) -> String {
    format!("{} {} -> {} at {:?}", event.kind, event.from(), event.to(), event.pose())
}

/// Way between two poses in lengths of the rod, turns counted by what the tip goes.
fn distance(from: Pose, to: Pose, length: f64) -> f64 {
    ((to.x - from.x) / length).hypot((to.y - from.y) / length).hypot(to.phi - from.phi)
}

/// An angle less whole turns, between -pi and pi.
fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

/// One plus the contact forces, dimensionless: what a tolerance is relative to.
fn scale(scene: &Scene, state: &State) -> f64 {
    1.0 + state.contacts.iter().map(|c| c.force.abs()).sum::<f64>() / scene.rod.units().force
}

/// Forces and moments about the clamp add up to nothing, nothing pulls, and the certificate says so.
fn balances(scene: &Scene, state: &State) -> Result<(), String> {
    let (units, slack) = (scene.rod.units(), TOLERANCE * scale(scene, state));
    let (mut fx, mut fy, mut m) = (state.reactions.f0x, state.reactions.f0y, state.reactions.m0z);
    for c in &state.contacts {
        let (px, py) = (c.force * c.alpha.sin(), -c.force * c.alpha.cos());
        (fx, fy) = (fx + px, fy + py);
        m += (c.x - state.pose.x) * py - (c.y - state.pose.y) * px;
        hold(c.force >= -1e-11 * units.force, || format!("a contact pulls with {:e}", c.force))?;
    }
    hold(fx.hypot(fy) <= slack * units.force, || format!("forces leave ({fx:e}, {fy:e})"))?;
    hold(m.abs() <= slack * units.moment, || format!("moments leave {m:e}"))?;
    let certificate = &state.certificate;
    hold(certificate.residual <= 1e-10, || format!("residual {:e}", certificate.residual))?;
    hold(certificate.min_gap >= -TOLERANCE * units.length, || format!("certified gap {:e}", certificate.min_gap))
}

/// The contact is on the piece or joint that it names, and its force along the normal there.
fn lies_on(scene: &Scene, c: &Contact) -> Result<(), String> {
    let slack = TOLERANCE * scene.rod.length();
    let object: &Composite = scene.objects.get(c.object).ok_or("a contact with no object")?;
    let kind = match c.kind {
        ContactKind::Tangent | ContactKind::Tip => StretchKind::Piece(c.piece),
        ContactKind::Corner => StretchKind::Corner { before: c.piece },
        ContactKind::Notch => StretchKind::Notch { before: c.piece },
    };
    let stretch = object.stretches().position(|stretch| stretch.kind == kind).ok_or(format!("no {kind:?}"))?;
    let closest = object.closest_on(stretch, c.x, c.y);
    let off = (closest.frame.x - c.x).hypot(closest.frame.y - c.y);
    hold(off <= slack, || format!("{off:e} off {kind:?} of object {}", c.object))?;
    let Stretch { range, .. } = object.stretch(stretch);
    let (angle, turn) = match kind {
        StretchKind::Piece(_) => (closest.frame.alpha, 0.0),
        _ => {
            let [from, to] = [range.from, range.to].map(|end| object.frame_on(stretch, end).alpha);
            (from, to - from)
        }
    };
    let beyond = wrapped(c.alpha - angle - 0.5 * turn).abs() - 0.5 * turn.abs();
    // the closest point is known to rounding of the coordinates, its angle to that over the radius
    hold(beyond <= 1e-8, || format!("alpha {} on {kind:?} of object {}: {beyond:e} off", c.alpha, c.object))
}

/// The rod, integrated from the clamp by its reactions alone, meets its contacts in order, lies along them, ends without moment
/// and goes through no object.
fn meets(scene: &Scene, state: &State) -> Result<(), String> {
    let (units, slack) = (scene.rod.units(), TOLERANCE * scale(scene, state));
    let (pose, reactions) = (state.pose, state.reactions);
    let mut rod = Section {
        x: pose.x / units.length,
        y: pose.y / units.length,
        phi: pose.phi,
        kappa: -reactions.m0z / units.moment,
    };
    let (mut a, mut b) = (reactions.f0y / units.force, -reactions.f0x / units.force);
    let mut s = 0.0;
    for (j, c) in state.contacts.iter().enumerate() {
        let end = c.s / units.length;
        hold(s < end && end <= 1.0 + 1e-12, || format!("contact {j} at s = {end} after {s}"))?;
        rod = along(scene, rod, end - s, [a, b])?;
        s = end;
        let off = (rod.x - c.x / units.length).hypot(rod.y - c.y / units.length);
        hold(off <= slack, || format!("the rod misses contact {j} by {off:e}"))?;
        match c.kind {
            ContactKind::Tangent | ContactKind::Corner => {
                let crossing = (rod.phi - c.alpha).sin().abs();
                hold(crossing <= slack, || format!("the rod crosses at contact {j} by {crossing:e}"))?;
            }
            ContactKind::Tip | ContactKind::Notch => {
                let last = j + 1 == state.contacts.len() && (s - 1.0).abs() <= 1e-12;
                hold(last, || format!("contact {j}, {:?}, is not the tip", c.kind))?;
            }
        }
        let force = c.force / units.force;
        (a, b) = (a - force * c.alpha.cos(), b - force * c.alpha.sin());
    }
    hold(rod.kappa.abs() <= slack, || format!("the moment {:e} is left at the last contact", rod.kappa))?;
    along(scene, Section { kappa: 0.0, ..rod }, 1.0 - s, [0.0, 0.0]).map(drop)
}

/// Position, slope angle and curvature, in lengths of the rod.
#[derive(Clone, Copy)]
struct Section {
    x: f64,
    y: f64,
    phi: f64,
    kappa: f64,
}

/// The section `length` further on under the forces ahead; an error where the way there leads through an object.
fn along(scene: &Scene, from: Section, length: f64, [a, b]: [f64; 2]) -> Result<Section, String> {
    let rates = |v: [f64; 4]| {
        let (sin, cos) = v[2].sin_cos();
        [cos, sin, v[3], a * cos + b * sin]
    };
    let steps = (length * STEPS).ceil().max(1.0);
    let h = length / steps;
    let plus = |v: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| v[i] + h * k[i]);
    let mut v = [from.x, from.y, from.phi, from.kappa];
    for step in 0..steps as usize {
        if step % STRIDE == 0 {
            outside(scene, v)?;
        }
        let k1 = rates(v);
        let k2 = rates(plus(v, k1, 0.5 * h));
        let k3 = rates(plus(v, k2, 0.5 * h));
        let k4 = rates(plus(v, k3, h));
        v = std::array::from_fn(|i| v[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    outside(scene, v)?;
    let [x, y, phi, kappa] = v;
    Ok(Section { x, y, phi, kappa })
}

/// The point is outside of every object.
fn outside(scene: &Scene, [x, y, ..]: [f64; 4]) -> Result<(), String> {
    let length = scene.rod.length();
    scene.objects.iter().enumerate().try_for_each(|(object, contour)| {
        let gap = vibrissa::Contour::gap(contour, x * length, y * length) / length;
        hold(gap >= -TOLERANCE, || format!("the rod is {gap:e} inside object {object} at ({x}, {y}) rod lengths"))
    })
}

/// Whether the objects push the rod of some state from both of its sides.
pub fn is_pushed_from_both_sides(state: &State, scene: &Scene) -> bool {
    let Ok(rod) = state.elastica(&scene.rod) else { return false };
    let sides = state.contacts.iter().filter(|c| c.force > 0.0).map(|c| {
        // travelled along the contour, the rod has the solid on its left; against it, on its right
        wrapped(rod.at(c.s).phi - c.alpha).abs() < 0.5 * PI
    });
    let (left, right): (Vec<bool>, Vec<bool>) = sides.partition(|left| *left);
    !left.is_empty() && !right.is_empty()
}
