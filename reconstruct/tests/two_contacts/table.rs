//! Tables over many random scenes.

use super::judge::{Tallies, Tally, judge, wrong};
use super::run::{LEVELS, readings};
use super::scene::{Scan, Scene, of_parabolas};

fn print(title: &str, tallies: &Tallies) {
    println!(
        "{title}: phase, contact | samples | answered | wrong | scans | largest, L | most sigmas | variance | reasons"
    );
    for ((phase, which), t) in tallies {
        let Tally { samples, answered, wrong, scans, largest, most_sigmas, squares, measured, reasons } = t;
        let (share, variance) =
            (100.0 * *answered as f64 / (*samples).max(1) as f64, squares / (*measured).max(1) as f64);
        println!(
            "{title}: {phase} {which} | {samples} | {share:.1} % | {wrong} | {scans} | {largest:.1e} | {most_sigmas:.1} | {variance:.2} | {reasons:?}"
        );
    }
}

/// All levels of noise for these scans.
fn table(scans: impl Iterator<Item = Scan>) -> Vec<Tallies> {
    let only = std::env::var("LEVEL").unwrap_or_default();
    let mut all: Vec<Tallies> = vec![Tallies::new(); LEVELS.len()];
    for (seed, scan) in scans.enumerate() {
        for (k, (name, level)) in LEVELS.into_iter().enumerate().filter(|(_, (name, _))| name.starts_with(&only)) {
            let found = readings(&scan, level, seed as u64);
            for line in wrong(&scan, &found) {
                println!("{}, {name}: {line}", scan.scene.name);
            }
            for (key, tally) in judge(&scan, &found) {
                all[k].entry(key).or_default().join(&tally);
            }
        }
    }
    all
}

/// `SEEDS=0..40 cargo test -p rod-reconstruct --test suite random_scenes -- --ignored --nocapture`; `LEVEL=clean` for one level.
#[test]
#[ignore = "tables of many random scenes"]
fn random_scenes() {
    let seeds = std::env::var("SEEDS").unwrap_or("0..40".into());
    let (from, to) = seeds.split_once("..").unwrap();
    let seeds = from.parse::<u64>().unwrap()..to.parse().unwrap();
    let all = table(seeds.filter_map(Scene::of).map(Scene::scan));
    for ((name, _), tallies) in LEVELS.into_iter().zip(all) {
        print(name, &tallies);
    }
}

/// Clean scenes whose second contacts were wrong by up to 8e-3 L, at a hundredth of that in standard deviations, when the least squares
/// stopped before they converged.
#[test]
fn clean_scenes_that_were_wrong() {
    let wave = of_parabolas(
        "three parabolas",
        &[([0.0, 0.079919], 25.34645), ([0.209536, -0.038237], 32.73971), ([0.397367, -0.00423], 11.40105)],
        [-1.14433, 2.07786, -0.38805],
        81.1694,
    );
    let scenes = [18, 19, 66, 72, 75].into_iter().filter_map(Scene::of).chain([wave]);
    for scene in scenes {
        let scan = scene.scan();
        let found = readings(&scan, 0.0, 0);
        let wrong = wrong(&scan, &found);
        assert!(wrong.is_empty(), "{}: {wrong:#?}", scan.scene.name);
        let tallies = judge(&scan, &found);
        let answered: usize = tallies.values().map(|tally| tally.answered).sum();
        assert!(answered > 0, "{}", scan.scene.name);
    }
}
