//! Warm solves: every pose of a phase of the sweep past O1 at q = 0.4, from the solution 1e-3 rod lengths before.
#![allow(dead_code, reason = "each bench takes what it needs")]

use super::objects::{OBJECTS, path, rod, sweep};
use std::f64::consts::PI;
use std::hint::black_box;
use vibrissa::contact::ContactKind;
use vibrissa::contour::Frame;
use vibrissa::rod::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Support, Supports, Uniform, solve};
use vibrissa::{Contour, Parabola, Pose, State};

/// The phases of that sweep with their contacts from the clamp to the tip.
pub const PHASES: [&str; 4] = ["A", "B", "BB", "BA"];

/// The cases of [`PHASES`], in their order: every pose is solved, so that no branch predictor learns one of them by heart.
pub fn warm() -> [Vec<Case>; 4] {
    let object = OBJECTS[0];
    let outcome = sweep(&object.contour(), path(0.4, 0.8, -0.9), 1701);
    PHASES.map(|phase| cases(&outcome.states, phase, &object.pieces()))
}

/// Contacts on bare parabolas: no composite, no dispatch.
pub struct OnParabolas {
    pub contacts: Vec<(Parabola, Hold)>,
}

impl Supports for OnParabolas {
    fn count(&self) -> usize {
        self.contacts.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.contacts[j].1
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let Frame { x, y, alpha, speed, turning } = self.contacts[j].0.frame(t);
        Support { x, y, alpha, speed, turning }
    }
}

/// A solve: where, on what, from where, and what must come out.
pub struct Case {
    pub clamp: Pose,
    pub supports: OnParabolas,
    pub guess: Vec<f64>,
    pub solution: Vec<f64>,
}

/// Contact set and unknowns of a state.
fn unknowns(state: &State, pieces: &[Parabola]) -> (OnParabolas, Vec<f64>) {
    let elastica = state.elastica(&rod()).unwrap();
    let (mut contacts, mut u) = (Vec::new(), Vec::new());
    for contact in &state.contacts {
        let piece = pieces[contact.piece];
        let phi = elastica.at(contact.s).phi;
        let (hold, third) = match contact.kind {
            ContactKind::Tip => (Hold::Tip, phi),
            _ => (Hold::Tangent { offset: ((phi - contact.alpha) / PI).round() * PI }, contact.s),
        };
        contacts.push((piece, hold));
        u.extend([contact.x - piece.frame(0.0).x, contact.force, third]);
    }
    (OnParabolas { contacts }, u)
}

/// All pairs of neighbouring states in one phase.
fn cases(states: &[State], phase: &str, pieces: &[Parabola]) -> Vec<Case> {
    let in_phase = |state: &State| state.phase().to_string() == phase;
    let pieces_of = |state: &State| state.contacts.iter().map(|contact| contact.piece).collect::<Vec<_>>();
    let pairs =
        states.windows(2).filter(|pair| pair.iter().all(in_phase) && pieces_of(&pair[0]) == pieces_of(&pair[1]));
    let case = |pair: &[State]| {
        let (supports, guess) = unknowns(&pair[0], pieces);
        Case { clamp: pair[1].pose, supports, guess, solution: unknowns(&pair[1], pieces).1 }
    };
    pairs.map(case).collect()
}

/// Solves all cases; `u` and the workspace are kept, so that nothing is allocated.
pub fn solve_all(cases: &[Case], u: &mut Vec<f64>, workspace: &mut NewtonWorkspace) -> usize {
    let options = NewtonOptions::default();
    for case in cases {
        u.clear();
        u.extend_from_slice(&case.guess);
        let problem = MultiPoint { rod: Uniform, clamp: case.clamp, supports: &case.supports };
        let report = solve(black_box(&problem), u, &options, workspace);
        assert!(report.status.is_solved());
        black_box(&u);
    }
    cases.len()
}
