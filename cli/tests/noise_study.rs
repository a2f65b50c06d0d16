//! A part of the study of docs/reconstruction.md, small enough to be run each time.

use crate::study::{LEVELS, NOISES, Score, judge, scans, sweep};
use std::path::Path;
use vibrissa::reconstruct::score::Deviation;

const SEEDS: u64 = 1;

/// The nine scans by an industrial sensor, 2.5 mN and 0.06 mN m: what the reconstruction must give.
#[test]
fn an_industrial_sensor_gives_kinks_phases_and_both_contacts() {
    let scans = sweep(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes")), &scans(), 0.0).unwrap();
    for noise in &NOISES {
        let mut score = Score::default();
        judge(&scans, &LEVELS[1], noise, 0..SEEDS, false, None, &|| ())
            .unwrap()
            .into_iter()
            .for_each(|scan| score.merge(scan));
        println!("{}", crate::study::tables([(&LEVELS[1], Some(noise), &score)]));

        assert_eq!(score.scans, 9 * SEEDS as usize);
        let false_alarms = score.kinks.false_alarms() as f64 / score.scans as f64;
        assert!(
            score.kinks.recall().unwrap() >= 0.98 && false_alarms <= 0.5,
            "{:?} {:?}",
            score.missed,
            score.invented
        );
        assert!(score.phases.several_recall().unwrap() >= 0.95, "{}", score.phases);
        assert!(score.phases.accuracy().unwrap() >= 0.99, "{}", score.phases);
        assert!(score.answered.value().unwrap() >= 0.99, "{:?}", score.answered);
        let off = |distances: &[f64]| Deviation::of(distances.iter().copied()).unwrap();
        assert!(off(&score.contour).median <= 1e-4 && off(&score.points).median <= 1e-4);
        for (several, resolved) in score.several.iter().zip(&score.resolved) {
            let off = off(several);
            assert!(off.median <= 1e-4 && off.percentile_95 <= 1e-3, "{off:?}");
            // the check of a stretch by chance fails in one of 40
            assert!(resolved.value().unwrap() >= 0.8, "{resolved:?}");
        }
        // what the points would be if every sample had one contact
        assert!(off(&score.naive).median > 1e-3);
    }
}
