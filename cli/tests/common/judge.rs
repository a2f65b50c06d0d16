//! Whether a sweep gave nothing but equilibria and transitions between them, from its numbers and the outlines alone.

use super::case::{Case, TOLERANCE};
use super::outline::{Outline, wrapped};
use rod_files::Scene;
use std::f64::consts::PI;
use vibrissa::contact::{ContactKind, EventKind, Outcome};
use vibrissa::{Contour, Event, Pose, State};

/// A transition and its undoing closer together than this, in rod lengths along the path, are no physics.
const NEAR: f64 = 1e-6;
/// Points of the rod at which the contours are asked.
const SAMPLES: usize = 400;

/// Everything that must hold of all that a sweep gave: no early stop, no transition that is undone where it was made, and
/// every state an equilibrium, those at the transitions too.
pub fn judge(scene: &Scene, outcome: &Outcome) -> Result<(), String> {
    let name = &scene.name;
    if let Some(stop) = &outcome.stop {
        return Err(format!("{name}: {stop}"));
    }
    let outlines: Vec<_> = scene.objects.iter().map(|object| Outline::new(object, scene.rod.length())).collect();
    let judge_state = |state| {
        let case = Case::new(scene, state);
        let bad = case.judge(&outlines);
        hold(bad.is_empty(), || format!("{bad:?} in phase {} at {:?}", state.phase(), state.pose))?;
        outside(scene, &case)
    };
    for state in &outcome.states {
        judge_state(state).and_then(|()| stable(state)).map_err(|what| format!("{name}: {what}"))?;
    }
    for event in &outcome.events {
        let lands = matches!(event.kind, EventKind::Snap | EventKind::SnapOff | EventKind::SlipOver);
        for (state, ends) in [(&event.before, lands), (&event.after, false)] {
            // where an equilibrium ends it is on the verge of stability
            let stable = if ends { Ok(()) } else { stable(state) };
            judge_state(state).and(stable).map_err(|what| format!("{name}, at a {}: {what}", event.kind))?;
        }
        // a rod that lands at the pose where it let go has only lost energy, but for the rounding of a straight one's
        let most = event.before.energy + 1e-12 * scene.rod.units().force * scene.rod.length();
        let rises = lands && event.after.pose == event.before.pose && event.after.energy > most;
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

/// The rod is outside of all objects by the contours' own word too, which calls behind an open one inside.
fn outside(scene: &Scene, case: &Case<'_>) -> Result<(), String> {
    let length = scene.rod.length();
    let places = (0..=SAMPLES).map(|i| i as f64 / SAMPLES as f64).chain(case.loads.iter().map(|load| load.s));
    for (s, (object, contour)) in places.flat_map(|s| scene.objects.iter().enumerate().map(move |object| (s, object))) {
        let at = case.rod.at(s);
        let gap = contour.gap(at.x * length, at.y * length) / length;
        hold(gap >= -TOLERANCE, || format!("the rod is {gap:e} inside object {object} at s = {s}"))?;
    }
    Ok(())
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
