//! One segment: the closed form against its derivatives, the walk along it and the integration by Dop853.
//!
//! Random segments, |A|, |B| <= 20, |kappa| <= 6, |phi| <= pi, s <= 1: the range in which the kernel's accuracy is claimed.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use criterion::{Criterion, Throughput};
use measure::{Random, interleaved, is_timed};
use std::f64::consts::PI;
use std::hint::black_box;
use vibrissa::{Cut, Method, Ode, Propagator, Section, advance, advance_with_sensitivities, walk};

const SEGMENTS: usize = 512;
/// Steps of a walk.
const STEPS: usize = 100;
/// Tolerance of the integration, relative and absolute.
const TOLERANCE: f64 = 1e-12;
/// What the closed form must be worth.
const LEAST_RATIO: f64 = 40.0;

struct Segment {
    start: Section,
    a: f64,
    b: f64,
    s: f64,
}

fn segments() -> Vec<Segment> {
    let mut random = Random(1);
    let segment = |_| Segment {
        start: Section { x: random.within(1.0), y: random.within(1.0), phi: random.within(PI), kappa: random.within(6.0) },
        a: random.within(20.0),
        b: random.within(20.0),
        s: random.within(1.0).abs(),
    };
    (0..SEGMENTS).map(segment).collect()
}

fn plain(segments: &[Segment]) -> usize {
    for Segment { start, a, b, s } in segments {
        black_box(advance(black_box(start), *a, *b, *s));
    }
    segments.len()
}

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
    let ode = Ode::uniform(Method::Dop853, TOLERANCE).unwrap();

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("kernel");
    group.throughput(Throughput::Elements(SEGMENTS as u64));
    group.bench_function("advance", |b| b.iter(|| plain(&segments)));
    group.bench_function("advance with sensitivities", |b| b.iter(|| with_sensitivities(&segments)));
    group.bench_function("Dop853 at 1e-12", |b| b.iter(|| integrated(&segments, &ode)));
    group.throughput(Throughput::Elements((SEGMENTS * STEPS) as u64));
    group.bench_function("walk, a step", |b| b.iter(|| walked(&segments)));
    group.finish();
    criterion.final_summary();
    if !is_timed() {
        return;
    }

    let [kernel, derivatives, step, dop853] = interleaved(
        100,
        [
            &mut || (0..8).map(|_| plain(&segments)).sum(),
            &mut || (0..4).map(|_| with_sensitivities(&segments)).sum(),
            &mut || walked(&segments),
            &mut || integrated(&segments, &ode),
        ],
    );
    println!("One segment of {SEGMENTS} random ones, least of 100 interleaved rounds");
    println!("  advance                     {}", kernel.show(1e6, "us"));
    println!("  advance with sensitivities  {}   {} kernels", derivatives.show(1e6, "us"), derivatives.over(&kernel));
    println!("  walk, a step of {STEPS}         {}   {} kernels", step.show(1e6, "us"), step.over(&kernel));
    println!("  Dop853 at {TOLERANCE:e}             {}   {} kernels", dop853.show(1e6, "us"), dop853.over(&kernel));
    let ratio = dop853.least / kernel.least;
    let verdict = if ratio >= LEAST_RATIO { "holds" } else { "DOES NOT HOLD" };
    println!("  at least {LEAST_RATIO} times faster than Dop853: {verdict} ({ratio:.1})");
}
