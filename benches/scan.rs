//! Whole sweeps: O1 at q = 0.4 with 1000 reported states and all events, the nine scans, and what a snap costs.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use criterion::Criterion;
use measure::objects::{OBJECTS, path, sweep};
use measure::{Time, interleaved, is_timed, kernel, machine, segments};
use std::hint::black_box;
use vibrissa::Composite;

/// Distances of the clamp.
const DISTANCES: [f64; 3] = [0.2, 0.4, 0.6];
/// From where to where the clamp goes in a full scan, and reported states.
const WAY: (f64, f64) = (0.8, -0.9);
const STATES: usize = 1000;
/// Just before and just behind the fold of O1 at q = 0.4, where the rod snaps off.
const BEFORE_FOLD: f64 = -0.8172;
const BEHIND_FOLD: f64 = -0.8174;

/// One scan; returns 1, the number of scans done.
fn scan(contour: &Composite, q: f64, to: f64, states: usize) -> usize {
    black_box(sweep(black_box(contour), path(q, WAY.0, to), states));
    1
}

fn main() {
    let contours = OBJECTS.map(|object| object.contour());
    let o1 = &contours[0];

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("scan");
    group.sample_size(20);
    group.bench_function("O1 q = 0.4, 1000 states", |b| b.iter(|| scan(o1, 0.4, WAY.1, STATES)));
    group.bench_function("the nine scans, 1000 states each", |b| {
        b.iter(|| {
            for contour in &contours {
                DISTANCES.iter().for_each(|&q| {
                    scan(contour, q, WAY.1, STATES);
                });
            }
        });
    });
    group.finish();
    criterion.final_summary();
    if !is_timed() {
        return;
    }

    println!("{}", machine::line());
    let segments = segments();
    let [kernel, full, sparse, before, behind]: [Time; 5] = interleaved(
        40,
        [
            &mut || kernel(&segments),
            &mut || scan(o1, 0.4, WAY.1, STATES),
            &mut || scan(o1, 0.4, WAY.1, 2),
            &mut || scan(o1, 0.4, BEFORE_FOLD, STATES),
            &mut || scan(o1, 0.4, BEHIND_FOLD, STATES),
        ],
    );
    println!("O1 at q = 0.4, least of 40 interleaved rounds; kernel {}", kernel.show(1e6, "us"));
    let line = |what: &str, time: &Time| {
        println!("  {what:44} {}   {} kernels", time.show(1e3, "ms"), time.over(&kernel));
    };
    line("full scan, 1000 states, 7 events", &full);
    line("full scan, 2 states: what the events cost", &sparse);
    line("1000 states up to the fold: no snap", &before);
    line("1000 states to behind the fold: one snap", &behind);
    let difference = |u: f64, v: f64| (u - v) / full.least * 100.0;
    println!("  the snap alone: {:.0} % of a full scan", difference(behind.least, before.least));
    println!("  a reported state: {:.1} kernels", (full.least - sparse.least) / 1000.0 / kernel.least);

    println!("The nine scans, 1000 states each, least of 10 interleaved rounds, in full scans of O1 at q = 0.4");
    for (object, contour) in OBJECTS.iter().zip(&contours) {
        let times = interleaved(
            10,
            [&mut || scan(contour, 0.2, WAY.1, STATES), &mut || scan(contour, 0.4, WAY.1, STATES), &mut || {
                scan(contour, 0.6, WAY.1, STATES)
            }],
        );
        for (q, time) in DISTANCES.iter().zip(times) {
            let snaps = sweep(contour, path(*q, WAY.0, WAY.1), 2).events;
            let snaps = snaps.iter().filter(|event| event.kind.to_string().starts_with("snap")).count();
            let ratio = time.over(&full);
            println!("  {} q = {q}, {snaps} snaps: {}   {ratio}", object.name, time.show(1e3, "ms"));
        }
    }
}
