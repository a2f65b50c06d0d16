//! The same sweep past contours of ten pieces, and of up to 10^5 of which the rod meets these ten.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use allocation_counter::measure as allocated;
use measure::waves::{FEW, Kind, difference, objects, pieces_met, sweep};
use measure::{interleaved, is_timed};
use std::hint::black_box;
use std::time::Instant;
use vibrissa::Composite;

/// Numbers of pieces, the first one those that the rod meets.
const SIZES: [usize; 5] = [FEW, 100, 1000, 10_000, 100_000];
/// Numbers of separate objects.
const COUNTS: [usize; 3] = [FEW, 100, 1000];
const ROUNDS: usize = 20;

/// One sweep; returns 1, the number of sweeps done.
fn scan(objects: &[Composite]) -> usize {
    black_box(sweep(black_box(objects)));
    1
}

fn table<const N: usize>(kind: Kind, sizes: [usize; N]) {
    let built = sizes.map(|size| {
        let mut found = None;
        let start = Instant::now();
        let kept = allocated(|| found = Some(objects(kind, size)));
        (found.unwrap(), start.elapsed().as_secs_f64(), kept.bytes_current as f64 / size as f64)
    });
    let few = sweep(&built[0].0);
    let differences = built.each_ref().map(|(objects, ..)| difference(&sweep(objects), &few));
    let mut works = built.each_ref().map(|(objects, ..)| move || scan(objects));
    let times = interleaved(ROUNDS, works.each_mut().map(|work| work as &mut dyn FnMut() -> usize));
    println!("{kind:?}, of which the rod meets {}; {} events", pieces_met(kind, &few), few.events.len());
    println!("  pieces  sweep in ms             over {FEW} pieces       bytes a piece  built in ms  difference");
    for (n, (_, build, bytes)) in built.iter().enumerate() {
        println!(
            "{:8} {}  {:22} {bytes:8.0}  {:14.2}  {:11.1e}",
            sizes[n],
            times[n].show(1e3, ""),
            times[n].over(&times[0]),
            build * 1e3,
            differences[n]
        );
    }
}

fn main() {
    if !is_timed() {
        return;
    }
    for kind in [Kind::Edges, Kind::Ripples, Kind::Cubics] {
        table(kind, SIZES);
    }
    table(Kind::Discs, COUNTS);
}
