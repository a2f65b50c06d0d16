//! The boundary-value problem, warm: from the solution 1e-3 rod lengths before, by Newton's method.
//!
//! In phases A, B, BB and BA of the sweep past O1 at q = 0.4; every pose of the phase is solved, so that no branch predictor
//! learns one of them by heart. The kernel's time of the same run makes it a number of segments.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use criterion::{Criterion, Throughput};
use measure::objects::{OBJECTS, path, rod, sweep};
use measure::{Time, interleaved, is_timed, kernel, segments};
use std::f64::consts::PI;
use std::hint::black_box;
use vibrissa::{
    ContactKind, Contour, Frame, Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Parabola, Pose, State, Support,
    Supports, solve,
};

const PHASES: [&str; 4] = ["A", "B", "BB", "BA"];

/// Contacts on bare parabolas: no composite, no dispatch.
struct OnParabolas {
    contacts: Vec<(Parabola, Hold)>,
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
struct Case {
    clamp: Pose,
    supports: OnParabolas,
    guess: Vec<f64>,
    solution: Vec<f64>,
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
        u.extend([contact.x - piece.vertex()[0], contact.force, third]);
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
fn solve_all(cases: &[Case], u: &mut Vec<f64>, workspace: &mut NewtonWorkspace) -> usize {
    let options = NewtonOptions::default();
    for case in cases {
        u.clear();
        u.extend_from_slice(&case.guess);
        let problem = MultiPoint { clamp: case.clamp, supports: &case.supports };
        let report = solve(black_box(&problem), u, &options, workspace);
        assert!(report.status.is_solved());
        black_box(&u);
    }
    cases.len()
}

/// Solves all cases and returns the mean number of iterations, after a look at the solutions.
fn check(cases: &[Case]) -> f64 {
    let mut iterations = 0;
    for case in cases {
        let mut u = case.guess.clone();
        let problem = MultiPoint { clamp: case.clamp, supports: &case.supports };
        let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        let error = u.iter().zip(&case.solution).map(|(u, v)| (u - v).abs()).fold(0.0, f64::max);
        assert!(error < 1e-9, "{error:e} at x0 = {}", case.clamp.x);
        iterations += report.iterations;
    }
    f64::from(iterations) / cases.len() as f64
}

fn main() {
    let object = OBJECTS[0];
    let outcome = sweep(&object.contour(), path(0.4, 0.8, -0.9), 1701);
    let [a, b, bb, ba] = PHASES.map(|phase| cases(&outcome.states, phase, &object.pieces()));
    let (mut u, mut workspace) = (Vec::new(), NewtonWorkspace::new());

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("solve");
    for (phase, cases) in PHASES.iter().zip([&a, &b, &bb, &ba]) {
        group.throughput(Throughput::Elements(cases.len() as u64));
        group.bench_function(*phase, |bencher| bencher.iter(|| solve_all(cases, &mut u, &mut workspace)));
    }
    group.finish();
    criterion.final_summary();
    if !is_timed() {
        return;
    }

    let segments = segments();
    let mut memory: [(Vec<f64>, NewtonWorkspace); 4] = std::array::from_fn(|_| Default::default());
    let [m0, m1, m2, m3] = &mut memory;
    let [kernel, times @ ..]: [Time; 5] = interleaved(
        200,
        [
            &mut || kernel(&segments),
            &mut || solve_all(&a, &mut m0.0, &mut m0.1),
            &mut || solve_all(&b, &mut m1.0, &mut m1.1),
            &mut || solve_all(&bb, &mut m2.0, &mut m2.1),
            &mut || solve_all(&ba, &mut m3.0, &mut m3.1),
        ],
    );
    println!("Warm-started solves, least of 200 interleaved rounds; kernel {}", kernel.show(1e6, "us"));
    for ((phase, cases), time) in PHASES.iter().zip([&a, &b, &bb, &ba]).zip(times) {
        let (poses, iterations) = (cases.len(), check(cases));
        let (time, ratio) = (time.show(1e6, "us"), time.over(&kernel));
        println!("  {phase:2} {poses:4} poses, {iterations:.2} iterations: {time}   {ratio} kernels");
    }
}
