//! One pose in contact of which nothing is known but the object: what other programs relax a moving rod for.

use crate::held::{Case, largest};
use crate::point::Point;
use crate::problem::Shape;
use crate::row::NONE;
use std::hint::black_box;
use vibrissa::contact::Item;
use vibrissa::{ClampPath, Composite, Contour, Line, Parabola, Pose, Rod, State, Sweep};

pub const TASK: &str = "static contact";

/// The path begins at the pose and need not go anywhere. Its direction, down to the floor, tells where the rod came from.
const BEYOND: f64 = 1e-3;

/// The reference problem: the tip on a floor.
pub const FLOOR: &str = "a-floor";

/// Half the length of a straight line, which has ends here.
const REACH: f64 = 4.0;

/// The object of a problem; none where a support is no shape of its own.
fn object(case: &Case<'_>) -> Option<Composite> {
    let piece = |shape: &Shape| -> Option<Box<dyn Contour>> {
        match *shape {
            Shape::Parabola { vertex, coefficient } => Some(Box::new(Parabola::new(vertex, coefficient).unwrap())),
            Shape::Line { point: [x, y], angle } => {
                let (sin, cos) = angle.sin_cos();
                let end = |way: f64| [x + way * cos, y + way * sin];
                Some(Box::new(Line::new(end(-REACH), end(REACH)).unwrap()))
            }
            Shape::Circle { .. } | Shape::Vertex { .. } => None,
        }
    };
    let pieces: Option<Vec<_>> = case.problem.supports.iter().map(piece).collect();
    Composite::joined(pieces?).ok()
}

/// The first state of a sweep that starts at the pose, if it is in contact.
fn state(object: &Composite, clamp: Pose) -> Option<State> {
    let path = ClampPath::new(clamp, Pose { y: clamp.y - BEYOND, ..clamp }).unwrap();
    match Sweep::new(&Rod::new(1.0, 1.0).unwrap(), object, path, BEYOND).unwrap().next() {
        Some(Ok(Item::State(state))) => Some(state),
        _ => None,
    }
}

fn error(case: &Case<'_>, state: &State) -> f64 {
    let (truth, found) = (case.problem.reactions.unwrap(), state.reactions);
    let reactions = [truth.f0x.error(found.f0x), truth.f0y.error(found.f0y), truth.m0z.error(found.m0z)].into_iter();
    if state.contacts.len() != case.problem.contacts.len() {
        return f64::NAN;
    }
    let pairs = case.problem.contacts.iter().zip(&state.contacts);
    largest(reactions.chain(pairs.flat_map(|(truth, at)| [truth.x.error(at.x), truth.y.error(at.y)])))
}

/// The start of a sweep at the pose of a problem.
pub fn point<'a>(case: &Case<'_>) -> Option<Point<'a>> {
    let (object, clamp) = (object(case)?, case.clamp);
    let error = error(case, &state(&object, clamp)?);
    let work = move || {
        black_box(state(&object, black_box(clamp)));
        1
    };
    let work: Box<dyn FnMut() -> usize> = Box::new(work);
    let errors = vec![(case.problem.name.clone(), Some(error).filter(|error| error.is_finite()))];
    Some(Point { method: "start of a sweep", setting: NONE.to_owned(), errors, note: String::new(), work: Some(work) })
}
