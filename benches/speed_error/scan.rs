//! A whole sweep: its transitions against the reference set, and what more reported states cost.

use crate::held::largest;
use crate::measure::objects::{COEFFICIENT, OBJECTS, path, sweep};
use crate::point::Point;
use crate::problem::{Placed, Problem, Shape};
use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;

pub const TASK: &str = "scan";
pub const SWEEP: &str = "sweep";
/// Distance of the clamp, the object O1, and the way of a full scan.
const DISTANCE: f64 = 0.4;
const WAY: (f64, f64) = (0.8, -0.9);
/// Reported states, the only control there is: transitions are located, not stepped over. A state every 0.1, 0.01, ... of the way.
const STATES: [usize; 5] = [2, 18, 171, 1701, 17_001];
/// Transitions farther from the truth than this are others.
const NEAR: f64 = 1e-3;

/// Whether a reference problem is a transition of this scan.
fn is_of_this_scan(problem: &Problem) -> bool {
    let here = |shape: &Shape| match shape {
        Shape::Parabola { vertex, coefficient } => *coefficient == COEFFICIENT && OBJECTS[0].vertices.contains(vertex),
        _ => false,
    };
    let upright = |clamp: Placed| clamp.y == -DISTANCE && clamp.phi == FRAC_PI_2;
    let sideways = |motion: Placed| motion.x != 0.0 && motion.y == 0.0 && motion.phi == 0.0;
    problem.kind == "transition"
        && problem.clamp.is_some_and(upright)
        && problem.motion.is_some_and(sideways)
        && problem.supports.iter().all(here)
}

/// The sweep at every number of reported states; none where the reference set has no transition of it.
pub fn points<'a>(problems: &[Problem]) -> Vec<Point<'a>> {
    let truths: Vec<_> = problems.iter().filter(|problem| is_of_this_scan(problem)).collect();
    if truths.is_empty() {
        return Vec::new();
    }
    let point = |states: usize| {
        let contour = OBJECTS[0].contour();
        let outcome = sweep(&contour, path(DISTANCE, WAY.0, WAY.1), states);
        let found: Vec<f64> = outcome.events.iter().map(|event| event.pose().x).collect();
        let errors = truths.iter().map(|truth| {
            let x = truth.tau.unwrap().along(truth.clamp.unwrap().x, truth.motion.unwrap().x);
            let nearest = found.iter().map(|at| x.error(*at)).fold(f64::INFINITY, f64::min);
            if nearest < NEAR { nearest } else { f64::NAN }
        });
        let error = Some(largest(errors)).filter(|error| error.is_finite());
        let work = move || {
            black_box(sweep(black_box(&contour), path(DISTANCE, WAY.0, WAY.1), states));
            1
        };
        Point {
            method: SWEEP,
            setting: states.to_string(),
            errors: vec![(format!("O1, q = {DISTANCE}"), error)],
            note: format!("worst of {} transitions of {}", truths.len(), found.len()),
            work: Some(Box::new(work)),
        }
    };
    STATES.map(point).into()
}
