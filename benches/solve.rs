//! The boundary-value problem, warm: from the solution 1e-3 rod lengths before, by Newton's method.
//!
//! In phases A, B, BB and BA of the sweep past O1 at q = 0.4; every pose of the phase is solved, so that no branch predictor
//! learns one of them by heart. The kernel's time of the same run makes it a number of segments.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use criterion::{Criterion, Throughput};
use measure::solves::{Case, PHASES, solve_all, warm};
use measure::{Time, interleaved, is_timed, kernel, machine, segments};
use vibrissa::rod::{MultiPoint, NewtonOptions, NewtonWorkspace, Uniform, solve};

/// Solves all cases and returns the mean number of iterations, after a look at the solutions.
fn check(cases: &[Case]) -> f64 {
    let mut iterations = 0;
    for case in cases {
        let mut u = case.guess.clone();
        let problem = MultiPoint { rod: Uniform, clamp: case.clamp, supports: &case.supports };
        let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
        let error = u.iter().zip(&case.solution).map(|(u, v)| (u - v).abs()).fold(0.0, f64::max);
        assert!(error < 1e-9, "{error:e} at x0 = {}", case.clamp.x);
        iterations += report.iterations;
    }
    f64::from(iterations) / cases.len() as f64
}

fn main() {
    let [a, b, bb, ba] = warm();
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

    println!("{}", machine::line());
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
