//! Random scenes of thin, sharp, flat and finely divided objects, every state judged without the library.

use crate::sharp::bounds::{FALSE_EVENTS, FALSE_STATES, GAVE_UP, STEPS_DISAGREE};
use crate::sharp::report::table;
use crate::sharp::scene::scene;
use crate::sharp::unit::in_unit;
use crate::sharp::verdict::{Verdict, verdict};
use crate::witness::run::Run;
use rayon::prelude::*;
use rod_files::Scene;
use std::ops::Range;

/// Of so many scenes one is swept at other steps too. It has no divisor in common with the number of kinds, and so goes
/// through all of them.
const ONE_IN: u64 = 7;

fn run(seeds: Range<u64>) -> Vec<Verdict> {
    let verdicts: Vec<_> = seeds.into_par_iter().map(|seed| verdict(scene(seed), seed % ONE_IN == 1)).collect();
    println!("\n{}", table(&verdicts));
    verdicts
}

/// The counts of this run are those of the bounds: a number that falls is lowered there.
#[test]
fn three_hundred_scenes() {
    let verdicts = run(0..300);
    let wrong = verdicts.iter().map(|v| v.false_states.len()).sum::<usize>();
    let wrong_events = verdicts.iter().map(|v| v.false_events.len()).sum::<usize>();
    let gave_up = verdicts.iter().filter(|v| v.gave_up()).count();
    let disagree = verdicts.iter().filter(|v| v.disagrees()).count();
    println!("false states {wrong}, at events {wrong_events}, could not go on {gave_up}, steps disagree {disagree}");
    let counts = [
        ("false states", wrong, FALSE_STATES),
        ("false states at events", wrong_events, FALSE_EVENTS),
        ("sweeps that could not go on", gave_up, GAVE_UP),
        ("scenes that depend on the reporting step", disagree, STEPS_DISAGREE),
    ];
    for (what, count, bound) in counts {
        assert!(count <= bound, "{count} {what}, at most {bound} are known");
    }
    // scenes without contact prove nothing
    let touching = verdicts.iter().filter(|v| v.touching > 0).count();
    assert!(touching as f64 > 0.5 * verdicts.len() as f64, "{touching} scenes with contact");
}

/// What a scene and the same one in another unit of length differ in, if they do.
fn depends_on_the_unit(seed: u64) -> Option<String> {
    let generated = scene(seed);
    let length = Scene::parse("scene.toml".as_ref(), &generated.text).unwrap().rod.length();
    let own = Run::within_time(&generated.text, 1.0);
    // powers of two, so that no number of the scene is rounded
    [-20, 7, 20].into_iter().find_map(|power| {
        let unit = 2f64.powi(power);
        let mut other = Run::within_time(&in_unit(&generated.text, unit), 1.0);
        for event in &mut other.events {
            let pose = &mut event.before.pose;
            (pose.x, pose.y) = (pose.x / unit, pose.y / unit);
        }
        let differs = own.differs(&other, length)?;
        Some(format!("{seed}, {}, in units of 2^{power}: {differs}", generated.kind))
    })
}

/// Scenes of the first sixty in which a contact hangs on the last bits of the numbers, so that a change of the unit changes what
/// comes of it. The number may only be lowered.
const UNIT_MATTERS: usize = 2;

#[test]
fn the_unit_of_length_does_not_matter() {
    let different: Vec<_> = (0..60).into_par_iter().filter_map(depends_on_the_unit).collect();
    println!("{different:#?}");
    assert!(different.len() <= UNIT_MATTERS, "{different:#?}");
}

/// `SEEDS=0..10000 cargo test ... -- --ignored --nocapture these_scenes` prints the table of a range; `SEEDS=12,345` prints
/// single scenes with all that is wrong in them.
#[test]
#[ignore = "for ranges of scenes, and a look at single ones"]
fn these_scenes() {
    let seeds = std::env::var("SEEDS").unwrap_or_else(|_| "0..10000".into());
    for name in seeds.split(',').filter(|name| !name.is_empty()) {
        if let Some((Ok(first), Ok(end))) = name.split_once("..").map(|(first, end)| (first.parse(), end.parse())) {
            run(first..end);
            continue;
        }
        let verdict = verdict(scene(name.parse().unwrap()), true);
        println!("{}\n{:?} {}", verdict.scene.text, verdict.end, verdict.message);
        verdict.false_states.iter().for_each(|found| println!("state {found}"));
        verdict.false_events.iter().for_each(|found| println!("event {found}"));
        verdict.steps.iter().flatten().for_each(|(factor, what)| println!("step x{factor}: {what}"));
    }
}
