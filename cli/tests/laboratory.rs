//! Recordings as a laboratory makes them: the true sweep of a scene with one imperfection, or with several, and a judge of what
//! `vibrissa reconstruct` makes of them.
//!
//! The table of all imperfections (`laboratory/imperfections.rs`):
//!
//! ```sh
//! cargo test -p vibrissa-cli --test suite laboratory -- --ignored --nocapture
//! ```
//!
//! Environment variables: `ONLY="bias;combined"` and `SCENES="O1;disc"` choose rows and scenes by parts of their names,
//! `SEEDS=0..4` the seeds of noise, signs and combinations, `LEVEL=0.5` a multiple of the ordinary levels, `RATE=100` the samples
//! in a second. `KEEP=directory` keeps all files.

mod bent;
mod command;
mod following;
mod imperfections;
mod judge;
mod making;
mod mistakes;
mod recording;
mod report;
mod sensor;
mod settings;
mod truth;
mod world;

use command::run;
use imperfections::{Acts, IMPERFECTIONS};
use judge::{Verdict, judge};
use making::{Wrong, make};
use rayon::prelude::*;
use report::{Judged, reliability, table, totals};
use settings::Settings;
use truth::{SCENES, Site, TrueState, Truth};
use world::World;

fn judged(site: &Site, wrong: &Wrong, seed: u64, settings: &Settings) -> Judged {
    let made = make(site, wrong, settings.level, seed);
    let temporary = tempfile::tempdir().unwrap();
    let name = format!("{} {} {seed}", wrong.name().replace([' ', ',', '/', '>'], "_"), site.name);
    let directory = settings.keep.as_ref().map_or_else(|| temporary.path().to_owned(), |keep| keep.join(name));
    std::fs::create_dir_all(&directory).unwrap();
    let answer = run(&directory, &made.recording);
    let score = judge(&site.scene, &made, &answer);
    let (level, cycle) = (wrong.level(), made.truth.cycle());
    let (wrong, what, said, time) = (wrong.name(), made.what, answer.said, answer.time);
    Judged { wrong, level, scene: site.name, seed, what, cycle, score, said, time }
}

/// `cargo test -p vibrissa-cli --test suite laboratory -- --ignored --nocapture` prints the table.
#[test]
#[ignore = "minutes; it measures, and asserts nothing"]
fn the_laboratory_table() {
    let settings = Settings::read();
    let sites: Vec<Site> = settings.scenes.iter().map(|name| Site::new(name, settings.rate)).collect();
    let seeds = || settings.seeds.clone();
    let work: Vec<(&Wrong, &Site, u64)> = (settings.wrong.iter())
        .flat_map(|wrong| sites.iter().flat_map(move |site| seeds().map(move |seed| (wrong, site, seed))))
        .collect();
    let one = |(wrong, site, seed): (&Wrong, &Site, u64)| {
        let judged = judged(site, wrong, seed, &settings);
        println!("{}", judged.line());
        judged
    };
    let judged: Vec<Judged> = work.into_par_iter().map(one).collect();
    let time: f64 = judged.iter().map(|one| one.time.as_secs_f64()).sum();
    let longest = judged.iter().map(|one| one.time.as_secs_f64()).fold(0.0, f64::max);
    println!("\n{}\n{}\n{}", table(&judged), totals(&judged), reliability(&judged));
    println!("{} recordings, {:.2} s on average and {longest:.2} s at most", judged.len(), time / judged.len() as f64);
}

/// Reactions f0x, f0y, m0z of the rod past O1 at q = 0.4 in EI/L^2 and EI/L, at x0 / L, from an independent
/// solver.
const REFERENCES: [(World, f64, [f64; 3]); 8] = [
    (CURVED, 0.3, [-2.785698279755, 1.218997678102, 2.137491282986]),
    (CURVED, 0.0, [-4.204288865478, 6.580938205935, 4.162222878508]),
    (CURVED, -0.3, [-0.963583429261, 5.732712179341, 3.922780208936]),
    (ELASTIC, 0.3, [-1.709195456109, 0.837558159120, 1.210487286007]),
    (ELASTIC, 0.0, [-2.873008653501, 4.499686760355, 2.844972401020]),
    (ELASTIC, -0.3, [-0.613623959138, 4.297863119451, 2.886155271247]),
    (ROUGH, 0.0, [-3.754490854696, 5.418078824528, 3.485394405505]),
    (ROUGH, -0.55, [-0.272925653455, 4.964780755503, 3.121456817185]),
];
const NONE: World = World { turned: 0.0, curvature: 0.0, compliance: 0.0, friction: 0.0 };
const CURVED: World = World { curvature: 0.5, ..NONE };
const ELASTIC: World = World { compliance: 1.0 / 20.0, ..NONE };
const ROUGH: World = World { friction: 0.1, ..NONE };

#[test]
fn bent_rods_agree_with_an_independent_solver() {
    let site = Site::new("O1_q40", COARSE);
    let units = site.scene.rod.units();
    for (world, x0, expected) in REFERENCES {
        // from the first pose to this one
        let step = (site.path.at(0.0).x - x0 * units.length) / 400.0;
        let truth = following::sweep(&site, world, step);
        let state = truth.states.iter().find(|state| (state.pose.x - x0 * units.length).abs() < 1e-9).unwrap();
        let felt = state.reactions;
        let found = [felt.f0x / units.force, felt.f0y / units.force, felt.m0z / units.moment];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{world:?} at {x0}: {found} for {expected}");
        }
    }
}

#[test]
fn a_straight_rod_agrees_with_the_sweep() {
    for name in SCENES {
        let site = Site::new(name, COARSE);
        let step = 4.0 * site.step(0);
        let (swept, followed) = (Truth::sweep(&site.scene, site.path, step, 0.0), following::sweep(&site, NONE, step));
        let of = |state: &TrueState| [state.reactions.f0x, state.reactions.f0y, 10.0 * state.reactions.m0z];
        let mut wrong = 0;
        for (a, b) in swept.states.iter().zip(&followed.states) {
            assert!((a.way - b.way).abs() < 1e-9, "{name}: a state is missing at {}", a.way);
            let differs = of(a).iter().zip(of(b)).any(|(a, b)| (a - b).abs() > 1e-7);
            if differs || a.label != b.label {
                println!("{name} at {}: {:?} {:?} for {:?} {:?}", b.pose.x, b.label, of(b), a.label, of(a));
                wrong += 1;
            }
        }
        assert!(wrong <= 2, "{name}: {wrong}");
    }
}

/// Samples in a second for the ordinary tests, 1/s.
const COARSE: f64 = 20.0;

#[test]
fn an_imperfection_of_level_zero_changes_nothing() {
    let site = Site::new("O1_q40", COARSE);
    for one in IMPERFECTIONS {
        let usual = Wrong::One(one);
        let [none, some] = [0.0, 1.0].map(|level| make(&site, &usual, level, 3));
        let clean = make(&site, &Wrong::Nothing { fast: one.fast }, 1.0, 3);
        assert_eq!(none.recording, clean.recording, "{}", one.name);
        assert_ne!(some.recording, clean.recording, "{}", one.name);
        let again = make(&site, &usual, 1.0, 3);
        assert_eq!(some.recording, again.recording, "{}: a seed gives one recording", one.name);
    }
}

#[test]
fn clean_recordings_are_right() {
    let settings = Settings { rate: COARSE, level: 1.0, ..Settings::read() };
    for name in ["O1_q40", "disc"] {
        let judged = judged(&Site::new(name, COARSE), &Wrong::Nothing { fast: false }, 1, &settings);
        assert_eq!(judged.score.verdict, Verdict::Right, "{} {:?}", judged.line(), judged.score);
        // at this rate labels next to transitions are uncertain
        assert!(judged.said.iter().all(|said| said.contains("labels may be wrong")), "{}", judged.line());
    }
}

/// What the ordinary level does to the readings and poses, by hand.
#[test]
fn imperfections_are_what_they_say() {
    let site = Site::new("disc", COARSE);
    let clean = make(&site, &Wrong::Nothing { fast: false }, 1.0, 5).recording;
    let made = |name: &str| {
        let one = IMPERFECTIONS.iter().find(|one| one.name == name).unwrap();
        make(&site, &Wrong::One(one), 1.0, 5).recording
    };
    let rows = clean.rows.len();
    let change = |name: &str, row: usize| -> [f64; 3] {
        let made = made(name);
        std::array::from_fn(|c| (made.rows[row].felt[c] - clean.rows[row].felt[c]).abs())
    };
    let near = |found: [f64; 3], expected: [f64; 3]| {
        assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-12), "{found:?} for {expected:?}");
    };
    near(change("bias, before tare", 7), [5e-3, 5e-3, 0.3e-3]);
    near(change("drift, after tare", 0), [0.0; 3]);
    near(change("drift, after tare", rows - 1), [1e-3, 1e-3, 0.05e-3]);
    let touching = (0..rows).find(|row| clean.rows[*row].felt[2] > 5e-3).unwrap();
    let truth = site.truth(0, &World::default()).states[touching];
    near(change("gain m0z", touching), [0.0, 0.0, 0.01 * truth.reactions.m0z]);
    // the rod points along y: the lever is along y, too
    near(change("lever, along", touching), [0.0, 0.0, 1e-3 * truth.reactions.f0x.abs()]);
    near(change("lever, across", touching), [0.0, 0.0, 1e-3 * truth.reactions.f0y.abs()]);
    let dropped = rows - made("dropped samples").rows.len();
    assert!(dropped > rows / 200 && dropped < rows / 50, "{dropped} of {rows}");
    for row in &made("encoder steps").rows {
        assert!((row.pose[0] / 5e-6 - (row.pose[0] / 5e-6).round()).abs() < 1e-6);
    }
}

/// The tare and the noise are looked for where the rod is free.
#[test]
fn scans_begin_and_end_with_a_free_rod() {
    let worlds = IMPERFECTIONS.iter().filter(|one| matches!(one.acts, Acts::World(_)));
    let work: Vec<_> = worlds.flat_map(|one| SCENES.map(|name| (one, name))).collect();
    work.into_par_iter().for_each(|(one, name)| {
        let site = Site::new(name, 0.25 * COARSE);
        let truth = make(&site, &Wrong::One(one), 1.0, 1).truth;
        let (first, last) = (truth.changes[0], truth.changes[truth.changes.len() - 1]);
        let free = first.min(site.path.length() - last);
        assert!(free >= 2e-3, "{}, {name}: {free} m", one.name);
        assert!(truth.cycle().starts_with("free ") && truth.cycle().ends_with(" free"), "{}", truth.cycle());
        let expected = (site.path.length() / site.step(0)) as usize;
        assert!(truth.states.len() >= expected, "{}, {name}: states are missing", one.name);
    });
}
