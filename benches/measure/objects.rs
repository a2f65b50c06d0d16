//! The objects of Merker et al. (2020), two parabolas each, in lengths of the rod, and the sweeps past them.
#![allow(dead_code, reason = "each bench takes what it needs")]

use std::f64::consts::FRAC_PI_2;
use vibrissa::contact::Outcome;
use vibrissa::{ClampPath, Composite, Parabola, Pose, Rod, Sweep};

/// Coefficient of the parabolas.
pub const COEFFICIENT: f64 = 5.0;

/// Name and vertices.
#[derive(Clone, Copy)]
pub struct Object {
    pub name: &'static str,
    pub vertices: [[f64; 2]; 2],
}

pub const OBJECTS: [Object; 3] = [
    Object { name: "O1", vertices: [[0.0, 0.0], [0.3, 0.0]] },
    Object { name: "O2", vertices: [[0.0, 0.0], [0.3, 0.1]] },
    Object { name: "O3", vertices: [[0.0, 0.1], [0.3, 0.0]] },
];

impl Object {
    pub fn pieces(&self) -> [Parabola; 2] {
        self.vertices.map(|vertex| Parabola::new(vertex, COEFFICIENT).unwrap())
    }

    pub fn contour(&self) -> Composite {
        let [left, right] = self.pieces();
        Composite::joined(vec![Box::new(left), Box::new(right)]).unwrap()
    }
}

/// The rod whose units are the dimensionless ones.
pub fn rod() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

/// The clamp goes from `from` to `to` in -x, `q` below the lowest vertex (at y = 0), and points up.
pub fn path(q: f64, from: f64, to: f64) -> ClampPath {
    let at = |x| Pose { x, y: -q, phi: FRAC_PI_2 };
    ClampPath::new(at(from), at(to)).unwrap()
}

/// Sweeps along `path`, with a given number of states reported at equal distances from its start to its end.
pub fn sweep(contour: &Composite, path: ClampPath, states: usize) -> Outcome {
    let step = path.length() / (states - 1) as f64;
    let outcome = Sweep::new(&rod(), contour, path, step).unwrap().run();
    assert!(outcome.stop.is_none() && outcome.states.len() == states);
    outcome
}
