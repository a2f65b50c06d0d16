//! One segment: the closed form against its derivatives, the walk along it and the integration by Dop853.
//!
//! On random segments, |A|, |B| <= 20, |kappa| <= 6, s <= 1: the range in which the kernel's accuracy is claimed.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use criterion::{Criterion, Throughput};
use measure::{Segment, Time, interleaved, is_timed, kernel, machine, segments, verdict};
use std::hint::black_box;
use vibrissa::rod::{Cut, Method, Ode, Propagator, Section, advance_with_sensitivities, walk};

/// Interleaved rounds.
const ROUNDS: usize = 60;
/// Steps of a walk.
const STEPS: usize = 100;
/// Tolerance of the integration, relative and absolute.
const TOLERANCE: f64 = 1e-12;
/// What the closed form must be worth.
const LEAST_RATIO: f64 = 40.0;

fn with_sensitivities(segments: &[Segment]) -> usize {
    for Segment { start, a, b, s } in segments {
        black_box(advance_with_sensitivities(black_box(start), *a, *b, *s));
    }
    segments.len()
}

fn walked(segments: &[Segment]) -> usize {
    for Segment { start, a, b, s } in segments {
        walk(black_box(start), *a, *b, *s, STEPS).for_each(|section| {
            black_box(section);
        });
    }
    segments.len() * STEPS
}

fn integrated(segments: &[Segment], ode: &Ode) -> usize {
    for Segment { start, a, b, s } in segments {
        let Section { x, y, phi, kappa } = *start;
        black_box(ode.advance(0.0, black_box(&Cut { x, y, phi, moment: kappa }), *a, *b, *s).unwrap());
    }
    segments.len()
}

fn main() {
    let segments = segments();
    let few = &segments[..256];
    let ode = Ode::uniform(Method::Dop853, TOLERANCE).unwrap();

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("kernel");
    group.throughput(Throughput::Elements(segments.len() as u64));
    group.bench_function("advance", |b| b.iter(|| kernel(&segments)));
    group.bench_function("advance with sensitivities", |b| b.iter(|| with_sensitivities(&segments)));
    group.bench_function("Dop853 at 1e-12", |b| b.iter(|| integrated(&segments, &ode)));
    group.throughput(Throughput::Elements((few.len() * STEPS) as u64));
    group.bench_function("walk, a step", |b| b.iter(|| walked(few)));
    group.finish();
    criterion.final_summary();
    if !is_timed() {
        return;
    }

    println!("{}", machine::line());
    let again = &segments[..512];
    let [cold, warm, derivatives, step, dop853, dop853_again] = interleaved(
        ROUNDS,
        [
            &mut || kernel(&segments),
            &mut || (0..16).map(|_| kernel(again)).sum(),
            &mut || with_sensitivities(&segments),
            &mut || walked(few),
            &mut || integrated(&segments, &ode),
            &mut || integrated(again, &ode),
        ],
    );
    let line = |what: &str, time: &Time, unit: &Time| {
        println!("  {what:32} {}   {} kernels", time.show(1e6, "us"), time.over(unit));
    };
    println!("One segment, of {} different ones, least of {ROUNDS} interleaved rounds", segments.len());
    line("advance, the kernel", &cold, &cold);
    line("advance with sensitivities", &derivatives, &cold);
    line(&format!("walk, a step of {STEPS}"), &step, &cold);
    line(&format!("Dop853 at {TOLERANCE:e}"), &dop853, &cold);
    println!("One segment, of {} over and over, which a branch predictor gets to know", again.len());
    line("advance, the kernel", &warm, &warm);
    line(&format!("Dop853 at {TOLERANCE:e}"), &dop853_again, &warm);
    for (which, ratio) in [("different", dop853.least / cold.least), ("recurring", dop853_again.least / warm.least)] {
        println!(
            "{}",
            verdict(&format!("Dop853 over the kernel, at least {LEAST_RATIO}, {which} segments"), ratio, LEAST_RATIO..)
        );
    }
}
