//! Everything that must hold of a reported state, by this judge.

use super::boundary::Boundary;
use super::depth::deepest;
use super::nearest::nearest;
use super::strand::Elastic;
use super::vector::{Point, dot};
use crate::common::case::{Bad, Case, TOLERANCE};
use crate::common::outline::wrapped;
use rod_files::Scene;
use vibrissa::State;

/// What falls short, and where along the rod.
#[derive(Clone, Debug)]
pub struct Fault {
    pub bad: Bad,
    pub s: f64,
}

/// The name of the fault that makes a state false.
pub const CROSSES: &str = "the rod crosses the object";
/// Angles of forces are known to this.
const ANGLE: f64 = 1e-7;

/// All that falls short.
pub fn faults(scene: &Scene, state: &State, boundaries: &[Boundary]) -> Vec<Fault> {
    let case = Case::new(scene, state).allowing_for_sensitivity();
    let mut faults: Vec<Fault> = case.equilibrium().into_iter().map(|bad| Fault { bad, s: f64::NAN }).collect();
    for (contact, (load, point)) in state.contacts.iter().zip(case.loads.iter().zip(&case.points)) {
        let bad = boundaries.get(contact.object).map_or_else(
            || Some(Bad { what: "no such object", off: 1.0 }),
            |boundary| rests(boundary, *point, load.alpha),
        );
        faults.extend(bad.map(|bad| Fault { bad, s: load.s }));
    }
    let force = case.loads.iter().map(|load| load.force.abs()).sum::<f64>();
    let strand = Elastic { rod: &case.rod, force: 1.01 * force + 1e-9 };
    for boundary in boundaries {
        match deepest(&strand, boundary) {
            Ok(None) => {}
            Ok(Some(place)) => {
                if place.depth > case.tolerance() {
                    faults.push(Fault { bad: Bad { what: CROSSES, off: place.depth }, s: place.s });
                }
            }
            Err(()) => faults.push(Fault { bad: Bad { what: "WITNESS: cannot tell", off: 1.0 }, s: f64::NAN }),
        }
    }
    faults
}

/// Whether a contact is on the boundary and its force normal there, or between the normals where it is not smooth.
fn rests(boundary: &Boundary, point: Point, alpha: f64) -> Option<Bad> {
    let near = nearest(boundary, point);
    if near.distance > TOLERANCE {
        return Some(Bad { what: "a contact is off the boundary", off: near.distance });
    }
    let angles = directions(boundary, near.curve, near.t, point);
    let between = |pair: &[f64]| {
        let turn = wrapped(pair[1] - pair[0]);
        let (middle, half) = (pair[0] + 0.5 * turn, 0.5 * turn.abs());
        wrapped(alpha - middle).abs() - half
    };
    let off = angles.windows(2).map(between).fold(f64::INFINITY, f64::min);
    (off > ANGLE).then_some(Bad { what: "a force is not normal to the boundary", off })
}

/// Directions of the boundary in order where it is no farther from a point than rounding of contacts.
fn directions(boundary: &Boundary, curve: usize, t: f64, point: Point) -> Vec<f64> {
    const NEAR: f64 = 3.0 * TOLERANCE;
    const MOST: usize = 2000;
    let n = boundary.curves.len();
    let angle = |curve: usize, t: f64| {
        let [x, y] = boundary.curves[curve].rate(t);
        y.atan2(x)
    };
    let walk = |forward: bool| {
        let (mut angles, mut at, mut t) = (Vec::new(), curve, t);
        while angles.len() < MOST {
            let rate = boundary.curves[at].rate(t);
            let step = NEAR / dot(rate, rate).sqrt();
            let to = if forward { (t + step).min(1.0) } else { (t - step).max(0.0) };
            let end = boundary.curves[at].point(to);
            angles.extend([0.25, 0.5, 0.75, 1.0].map(|share| angle(at, t + share * (to - t))));
            let (stops, next) = if forward { (to < 1.0, (at + 1) % n) } else { (to > 0.0, (at + n - 1) % n) };
            if stops || (end[0] - point[0]).hypot(end[1] - point[1]) > NEAR {
                break;
            }
            if !boundary.closed && ((forward && next == 0) || (!forward && next == n - 1)) {
                break;
            }
            (at, t) = (next, if forward { 0.0 } else { 1.0 });
            angles.push(angle(at, t));
        }
        angles
    };
    let (mut angles, ahead) = (walk(false), walk(true));
    angles.reverse();
    angles.push(angle(curve, t));
    angles.extend(ahead);
    angles
}
