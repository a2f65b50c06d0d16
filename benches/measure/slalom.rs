//! A rod between discs, above it and below it in turn: any number of contacts at a time.
#![allow(dead_code, reason = "each bench takes what it needs")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::hint::black_box;
use vibrissa::contact::{Contact, ContactKind, Equilibrium, Outcome};
use vibrissa::rod::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Support, Supports, Uniform, solve};
use vibrissa::{CircularArc, ClampPath, Composite, Pose, Rod, Sweep, equilibrium};

/// Radius of the discs, and how far each pushes the rod out of its straight line.
const RADIUS: f64 = 0.02;
const AMPLITUDE: f64 = 4e-3;
/// Where the last disc is along the rod.
const LAST: f64 = 0.95;
/// How far the clamp has moved since the solution that a warm solve starts from.
pub const MOVED: f64 = 1e-3;

/// So many discs along the rod, the first one above it.
pub struct Slalom {
    centres: Vec<[f64; 2]>,
}

impl Supports for Slalom {
    fn count(&self) -> usize {
        self.centres.len()
    }
    fn hold(&self, j: usize) -> Hold {
        // the rod runs against the sense of those below
        Hold::Tangent { offset: if j.is_multiple_of(2) { 0.0 } else { -PI } }
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let [x, y] = self.centres[j];
        Support { x: x + RADIUS * t.sin(), y: y - RADIUS * t.cos(), alpha: t, speed: RADIUS, turning: 1.0 }
    }
}

/// The clamp, `up` higher than in the middle.
fn clamp(up: f64) -> Pose {
    Pose { x: 0.0, y: up, phi: 0.0 }
}

impl Slalom {
    /// So many discs that push the rod by `amplitude`.
    fn new(count: usize, amplitude: f64) -> Self {
        let side = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        let centre = |j: usize| [LAST * (j + 1) as f64 / count as f64, side(j) * (RADIUS - amplitude)];
        Self { centres: (0..count).map(centre).collect() }
    }

    /// The solution with the clamp `up` higher, from a guess.
    fn solution(&self, guess: &[f64], up: f64) -> Vec<f64> {
        let mut u = guess.to_vec();
        let problem = MultiPoint { rod: Uniform, clamp: clamp(up), supports: self };
        let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        assert!(report.status.is_solved() && u.chunks(3).all(|contact| contact[1] > 0.0), "{report:?} {u:?}");
        u
    }
}

/// Warm solves between so many discs: from the solution with the clamp [`MOVED`] away.
pub struct Warm {
    slalom: Slalom,
    guess: Vec<f64>,
    objects: Vec<Composite>,
}

impl Warm {
    pub fn new(count: usize) -> Self {
        // pressed little by little: a straight rod touches them all, without force
        let touching =
            |j: usize| [if j.is_multiple_of(2) { 0.0 } else { PI }, 0.0, LAST * (j + 1) as f64 / count as f64];
        let mut guess: Vec<f64> = (0..count).flat_map(touching).collect();
        for part in 1..=8 {
            guess = Slalom::new(count, AMPLITUDE * f64::from(part) / 8.0).solution(&guess, 0.0);
        }
        let slalom = Slalom::new(count, AMPLITUDE);
        let disc = |&centre: &[f64; 2]| CircularArc::new(centre, RADIUS, FRAC_PI_2, FRAC_PI_2 + TAU).unwrap();
        let objects = slalom.centres.iter().map(|centre| Composite::single(disc(centre)).unwrap()).collect();
        Self { slalom, guess, objects }
    }

    /// Solves so many times; `u` and the workspace are kept, so that nothing is allocated. Returns how many times.
    pub fn solve(&self, times: usize, u: &mut Vec<f64>, workspace: &mut NewtonWorkspace) -> usize {
        for _ in 0..times {
            u.clear();
            u.extend_from_slice(&self.guess);
            let problem = MultiPoint { rod: Uniform, clamp: clamp(MOVED), supports: black_box(&self.slalom) };
            assert!(solve(&problem, u, &NewtonOptions::default(), workspace).status.is_solved());
        }
        times
    }

    /// The sweep that goes on from the solution as far again, with so many states.
    pub fn sweep(&self, rod: &Rod, states: usize) -> Outcome {
        let state = self.equilibrium(rod).state;
        let path = ClampPath::new(clamp(MOVED), clamp(2.0 * MOVED)).unwrap();
        let step = path.length() / (states - 1) as f64;
        Sweep::from_state(rod, &self.objects, &state, path, step).unwrap().run()
    }

    /// The same as an equilibrium with its certificate: solved, looked at all along, judged for stability.
    pub fn equilibrium(&self, rod: &Rod) -> Equilibrium {
        let contact = |(j, u): (usize, &[f64])| {
            let Support { x, y, alpha, .. } = self.slalom.support(j, u[0]);
            Contact {
                object: j,
                piece: 0,
                kind: ContactKind::Tangent,
                s: u[2],
                x,
                y,
                alpha,
                force: u[1],
                friction: None,
            }
        };
        let contacts: Vec<Contact> = self.guess.chunks(3).enumerate().map(contact).collect();
        equilibrium(rod, black_box(&self.objects), clamp(MOVED), &contacts).unwrap()
    }
}
