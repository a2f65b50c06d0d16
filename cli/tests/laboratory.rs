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

mod command;
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
use imperfections::IMPERFECTIONS;
use judge::{Verdict, judge};
use making::{Wrong, make};
use rayon::prelude::*;
use report::{Judged, table, totals};
use settings::Settings;
use truth::Site;

fn judged(site: &Site, wrong: &Wrong, seed: u64, settings: &Settings) -> Judged {
    let made = make(site, wrong, settings.level, seed);
    let temporary = tempfile::tempdir().unwrap();
    let name = format!("{} {} {seed}", wrong.name().replace([' ', ',', '/', '>'], "_"), site.name);
    let directory = settings.keep.as_ref().map_or_else(|| temporary.path().to_owned(), |keep| keep.join(name));
    std::fs::create_dir_all(&directory).unwrap();
    let answer = run(&directory, &made.recording);
    let score = judge(&site.scene, &made, &answer);
    let (said, time) = (answer.said, answer.time);
    Judged { wrong: wrong.name(), level: wrong.level(), scene: site.name, seed, what: made.what, score, said, time }
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
    println!("\n{}\n{}", table(&judged), totals(&judged));
    println!("{} recordings, {:.2} s on average and {longest:.2} s at most", judged.len(), time / judged.len() as f64);
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
        assert!(judged.said.is_empty(), "{}", judged.line());
    }
}
