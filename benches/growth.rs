//! How cost and memory grow with what is in a scene: contacts, pieces, separate objects, reported states, threads: `-- contacts pieces objects
//! states threads`, or some of them.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use allocation_counter::measure as allocated;
use measure::objects::{OBJECTS, path};
use measure::slalom::Warm;
use measure::waves::{FEW, Kind, difference, objects, pieces_met, sweep};
use measure::{Time, interleaved, is_timed, machine, verdict};
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;
use vibrissa::rod::NewtonWorkspace;
use vibrissa::{Composite, Rod};

/// Numbers of pieces, the first one those that the rod meets.
const SIZES: [usize; 6] = [FEW, 100, 1000, 10_000, 100_000, 1_000_000];
/// Numbers of separate objects.
const COUNTS: [usize; 3] = [FEW, 100, 1000];
/// Reported states.
const STATES: [usize; 5] = [2, 10, 100, 1000, 10_000];
const ROUNDS: usize = 20;
/// Scans of a batch, for threads.
const BATCH: usize = 36;

/// From 1 to 8 contacts: a warm solve, and an equilibrium with its certificate.
fn contacts() {
    let rod = Rod::new(1.0, 1.0).unwrap();
    let cases: [Warm; 8] = std::array::from_fn(|i| Warm::new(i + 1));
    let mut solves = cases.each_ref().map(|case| {
        let (mut u, mut workspace) = (Vec::new(), NewtonWorkspace::new());
        move || case.solve(200, &mut u, &mut workspace)
    });
    let solves = interleaved(ROUNDS, solves.each_mut().map(|work| work as &mut dyn FnMut() -> usize));
    let rod = &rod;
    let mut states = cases.each_ref().map(|case| {
        move || {
            (0..50).for_each(|_| _ = black_box(case.equilibrium(rod)));
            50_usize
        }
    });
    let states = interleaved(ROUNDS, states.each_mut().map(|work| work as &mut dyn FnMut() -> usize));
    println!(
        "Contacts at a time, a rod between discs\n  contacts  Jacobians  warm solve, over one contact    state with certificate, over one contact     bytes a state, at most"
    );
    for (i, case) in cases.iter().enumerate() {
        let found = case.equilibrium(rod);
        assert!(
            found.report.status.is_solved() && found.state.certificate.stable && found.state.contacts.len() == i + 1
        );
        let bytes = allocated(|| drop(black_box(case.equilibrium(rod)))).bytes_max;
        let line = |times: &[Time; 8]| format!("{}  {:18}", times[i].show(1e6, "us"), times[i].over(&times[0]));
        println!("  {:8}  {:9}  {}  {}  {bytes}", i + 1, found.report.iterations, line(&solves), line(&states));
    }
    println!("{}", verdict("8 contacts cost less than 20 times 1, solve", solves[7].least / solves[0].least, ..20.0));
    println!("{}", verdict("8 contacts cost less than 20 times 1, state", states[7].least / states[0].least, ..20.0));
}

/// One sweep; returns 1, the number of sweeps done.
fn scan(objects: &[Composite]) -> usize {
    black_box(sweep(black_box(objects)));
    1
}

/// More and more pieces of a kind, of which the rod meets the same few.
fn pieces<const N: usize>(kind: Kind, sizes: [usize; N]) {
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
    let claim = format!("{} pieces cost less than 2 times {FEW}", sizes[N - 1]);
    println!("{}", verdict(&claim, times[N - 1].least / times[0].least, ..2.0));
}

/// More and more reported states of one scan.
fn states() {
    let contour = &OBJECTS[0].contour();
    let scan = |states: usize| measure::objects::sweep(black_box(contour), path(0.4, 0.8, -0.9), states);
    let mut works = STATES.map(|states| {
        move || {
            black_box(scan(states));
            1_usize
        }
    });
    let times = interleaved(ROUNDS, works.each_mut().map(|work| work as &mut dyn FnMut() -> usize));
    println!(
        "Reported states, O1 at q = 0.4\n  states  scan                             a further state in us  bytes a state, kept"
    );
    for (n, count) in STATES.into_iter().enumerate() {
        let mut kept = None;
        let bytes = allocated(|| kept = Some(scan(count))).bytes_current as f64 / count as f64;
        let further = (times[n].least - times[0].least) / (count - STATES[0]).max(1) as f64 * 1e6;
        println!("{count:8}  {}  {further:12.2}  {bytes:12.0}", times[n].show(1e3, "ms"));
        drop(kept);
    }
}

/// The same scans on one thread and on two.
fn threads() {
    let contours = &OBJECTS.map(|object| object.contour());
    let scans = |pool: &rayon::ThreadPool| {
        pool.install(|| {
            (0..BATCH).into_par_iter().for_each(|k| {
                black_box(measure::objects::sweep(&contours[k % 3], path(0.4, 0.8, -0.9), 1000));
            });
        });
        BATCH
    };
    let pools = [1, 2].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
    let mut works = pools.each_ref().map(|pool| move || scans(pool));
    let [one, two] = interleaved(ROUNDS, works.each_mut().map(|work| work as &mut dyn FnMut() -> usize));
    println!(
        "Threads, {BATCH} scans of 1000 states\n  one  {} a scan\n  two  {}",
        one.show(1e3, "ms"),
        two.show(1e3, "ms")
    );
    println!("{}", verdict("two threads give at least 1.8 times one", one.least / two.least, 1.8..));
}

fn main() {
    if !is_timed() {
        return;
    }
    println!("{}", machine::line());
    // all tables, or those that are named
    let named: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let wanted = |table: &str| named.is_empty() || named.iter().any(|name| name == table);
    if wanted("contacts") {
        contacts();
    }
    if wanted("pieces") {
        for kind in [Kind::Edges, Kind::Ripples, Kind::Cubics] {
            pieces(kind, SIZES);
        }
    }
    if wanted("objects") {
        pieces(Kind::Discs, COUNTS);
    }
    if wanted("states") {
        states();
    }
    if wanted("threads") {
        threads();
    }
}
