//! From the reactions of one sample back to the contact, for rods that are not uniform and clamps that give way.

use super::scans::{bent, cone, o1, on_a_spring, two_sections};
use std::f64::consts::FRAC_PI_2;
use vibrissa::reconstruct::nalgebra::Matrix3;
use vibrissa::reconstruct::{
    Budget, Known, NoiseModel, OneSample, Settings, Source, noise_estimate, one_sample, reconstruct_general,
    reconstruct_passes,
};
use vibrissa::rod::{ElasticClamp, GeneralElastica, Load, Mounted, PhysicalRod, Pose, Reactions, Rod};
use vibrissa::{ClampPath, Sample, State, Sweep};

fn states(rod: &impl PhysicalRod) -> Vec<State> {
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    Sweep::new(rod, &o1(), ClampPath::new(at(1.0), at(-1.0)).unwrap(), 0.004).unwrap().run().states
}

/// How many states of each phase: of one contact found as such, of one contact not, of several found as such, of several not.
fn judged(rod: &impl PhysicalRod, worst: &mut f64) -> [usize; 4] {
    let mut counts = [0; 4];
    for state in states(rod) {
        let found = one_sample(rod, state.pose, state.reactions, &Matrix3::zeros()).unwrap();
        let phase = state.phase().to_string();
        let right = match (phase.as_str(), &found) {
            ("free", OneSample::Free) => continue,
            ("A", OneSample::Tip(touch)) | ("B", OneSample::Tangent(touch)) => {
                let [contact] = &state.contacts[..] else { panic!("{phase}") };
                let off = (touch.x - contact.x).hypot(touch.y - contact.y).max((touch.s - contact.s).abs());
                *worst = worst.max(off);
                true
            }
            ("A" | "B", _) => false,
            (_, found) => matches!(found, OneSample::Several(_)),
        };
        let several = usize::from(state.contacts.len() > 1);
        counts[2 * several + usize::from(!right)] += 1;
    }
    counts
}

#[test]
fn one_sample_tells_one_contact_from_two() {
    let mut worst = 0.0;
    // all of one contact and all of two: a cone has phase BB, the bent rod and that on a spring BA
    let soft = Mounted::new(cone(0.5), ElasticClamp::springs(Some(40.0), Some(30.0), Some(8.0)).unwrap());
    for (name, counts) in [
        ("cone", judged(&cone(0.8), &mut worst)),
        ("bent", judged(&bent(), &mut worst)),
        ("spring", judged(&on_a_spring(), &mut worst)),
        ("soft cone", judged(&soft, &mut worst)),
    ] {
        println!("{name}: states of one contact, missed, of several, missed: {counts:?}");
        let [one, one_missed, several, several_missed] = counts;
        assert!(one > 200 && one_missed == 0, "{name}: {counts:?}");
        // the reactions of BB on a uniform rod are those of B
        let told = name != "spring";
        assert!(!told || several > 0 && several_missed == 0, "{name}: {counts:?}");
    }
    // both contacts behind the joint are on a uniform rod
    let [one, one_missed, ..] = judged(&two_sections(), &mut worst);
    assert!(one > 200 && one_missed == 0);
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn the_covariance_is_that_of_the_point() {
    let soft = Mounted::new(cone(0.6), ElasticClamp::springs(Some(40.0), None, Some(8.0)).unwrap());
    let covariance = 1e-6 * Matrix3::new(1e-6, 2e-7, 0.0, 2e-7, 2e-6, -1e-7, 0.0, -1e-7, 5e-7);
    let mut compared = 0;
    // the differences are those of a force that changes little
    for state in states(&soft).iter().filter(|s| s.contacts.len() == 1 && s.contacts[0].force > 0.1).step_by(30) {
        let found = one_sample(&soft, state.pose, state.reactions, &covariance).unwrap().touch().unwrap();
        let h = 1e-5;
        let moved = |c: usize| {
            let by = |h: f64| {
                let Reactions { f0x, f0y, m0z } = state.reactions;
                let mut felt = [f0x, f0y, m0z];
                felt[c] += h;
                let [f0x, f0y, m0z] = felt;
                let touch = one_sample(&soft, state.pose, Reactions { f0x, f0y, m0z }, &covariance).unwrap();
                touch.touch().map(|touch| [touch.x, touch.y]).unwrap()
            };
            let (up, down) = (by(h), by(-h));
            [0, 1].map(|i| (up[i] - down[i]) / (2.0 * h))
        };
        let columns = [moved(0), moved(1), moved(2)];
        for i in 0..2 {
            for j in 0..2 {
                let sum: f64 = (0..9).map(|k| columns[k / 3][i] * covariance[(k / 3, k % 3)] * columns[k % 3][j]).sum();
                assert!((found.covariance[(i, j)] - sum).abs() < 1e-6 * found.covariance.trace(), "{state:?}");
            }
        }
        compared += 1;
    }
    assert!(compared > 5);
}

/// A force along the end of the rod: its moment vanishes at the tip without a change of sign.
#[test]
fn a_tip_that_is_pressed_on_end_is_found() {
    let rod = cone(0.5).with_natural_curvature(-1.0).unwrap();
    let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
    for along in [-1e-3, -1e-6, 0.0, 1e-6, 1e-3, 0.02] {
        let slope = GeneralElastica::under_loads(&rod, rod.units(), pose, &[]).unwrap().0.at(1.0).unwrap().phi;
        // loads are given by the tangent angle of the contour: across it the force is along the rod
        let mut alpha = slope - FRAC_PI_2;
        let mut bent = None;
        for _ in 0..60 {
            let load = Load { s: 1.0, force: 0.2, alpha };
            let shape = GeneralElastica::under_loads(&rod, rod.units(), pose, &[load]).unwrap().0;
            alpha = shape.at(1.0).unwrap().phi - FRAC_PI_2 + along;
            bent = Some((shape, load));
        }
        let (shape, load) = bent.unwrap();
        let found = one_sample(&rod, pose, shape.reactions(), &Matrix3::zeros()).unwrap();
        let (OneSample::Tip(touch), tip) = (found, shape.at(1.0).unwrap()) else {
            panic!("{along}: {found:?} {load:?}")
        };
        assert!((touch.x - tip.x).hypot(touch.y - tip.y) < 1e-9, "{along}: {touch:?}");
    }
}

#[test]
fn what_gives_no_point() {
    let rod = Rod::new(1.0, 1.0).unwrap();
    let at = |f0x, f0y, m0z| {
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        one_sample(&rod, pose, Reactions { f0x, f0y, m0z }, &Matrix3::zeros())
    };
    assert_eq!(at(0.0, 0.0, 0.0).unwrap(), OneSample::Free);
    assert!(at(0.0, 0.0, 1.0).unwrap_err().to_string().contains("vanishes nowhere"));
    assert!(at(f64::NAN, 0.0, 1.0).unwrap_err().to_string().contains("not finite"));
    assert!(at(1e300, 1e300, 1e300).is_err());
    // a force on an inner point that is not across the rod is of no single contact
    assert!(matches!(at(-2.0, 1.0, 1.5).unwrap(), OneSample::Several(_)));
}

/// A scan of O1 by `swept`, whose samples have the pose of the base, as the recording of a uniform rod: how many samples there are, how many
/// labels are right, how many points there are, and by how much they miss.
fn reconstructed(swept: &impl PhysicalRod, known: Known) -> (usize, usize, usize, f64) {
    let rod = Rod::new(1.0, 1.0).unwrap();
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let path = ClampPath::new(at(1.0), at(-0.9)).unwrap();
    let states = Sweep::new(swept, &o1(), path, 2e-4).unwrap().run().states;
    let sample = |state: &State| Sample::new(swept.base(state.pose, &state.reactions), state.reactions);
    let samples: Vec<Sample> = states.iter().map(sample).collect();
    let settings = Settings { budget: Some(Budget::NONE), known, ..Settings::default() };
    // where the rod snaps, its base may turn back: what follows is another pass
    let found = reconstruct_passes(&rod, &samples, &settings).unwrap();
    let (mut right, mut points, mut worst) = (0, 0, 0.0_f64);
    for (state, reading) in states.iter().zip(&found.readings) {
        right += usize::from(state.phase().to_string() == reading.label.to_string());
        let touches = [reading.touch.as_ref().ok(), reading.second.as_ref().and_then(|second| second.as_ref().ok())];
        for (touch, contact) in touches.iter().zip(&state.contacts) {
            let Some(touch) = touch else { continue };
            worst = worst.max((touch.x - contact.x).hypot(touch.y - contact.y));
            points += 1;
        }
    }
    println!("{right} of {} labels right, {points} points within {worst:.1e}", states.len());
    (states.len(), right, points, worst)
}

/// The springs of a clamp tell from each sample where the base is: then the scan is that of a rigid clamp.
#[test]
fn a_scan_on_springs_is_reconstructed() {
    let three = ElasticClamp::springs(Some(60.0), Some(40.0), Some(9.0)).unwrap();
    for swept in [on_a_spring(), Mounted::new(Rod::new(1.0, 1.0).unwrap(), three)] {
        let (samples, right, points, worst) = reconstructed(&swept, Known::NOTHING);
        assert!(right == samples && points > 7000 && worst < 1e-7, "{right} of {samples}, {points}, {worst:e}");
    }
}

/// The recording of a rod that is bent at rest as an arc, whose curvature is known.
#[test]
fn a_scan_of_a_bent_rod_is_reconstructed() {
    let known = Known::NOTHING.with(Source::NaturalCurvature, 0.5, 0.0);
    let (samples, right, points, worst) = reconstructed(&bent(), known);
    assert!(right == samples && points > 9000 && worst < 3e-9, "{right} of {samples}, {points}, {worst:e}");
}

/// What became of a scan of O1 by a rod of any kind: samples, labels that are right (BA and BB count as one), points of one contact, how
/// far they miss at most, and contacts that are alone without a point.
#[derive(Debug, Default)]
struct Told {
    samples: usize,
    right: usize,
    points: usize,
    worst: f64,
    missing: usize,
    /// Points off the truth by more than six of their standard deviations and 1e-7 L.
    wrong: usize,
    /// The same of points that are given where there are several contacts.
    misled: usize,
    misled_by: f64,
}

fn told(rod: &impl PhysicalRod, noise: Option<u64>) -> Told {
    let at = |x| Pose { x, y: -0.4, phi: FRAC_PI_2 };
    let path = ClampPath::new(at(1.0), at(-0.9)).unwrap();
    let states = Sweep::new(rod, &o1(), path, 2e-4).unwrap().run().states;
    let exact: Vec<Sample> = states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect();
    let sigma = Reactions { f0x: 1e-3, f0y: 1e-3, m0z: 3e-4 };
    let samples: Vec<Sample> = match noise {
        None => exact,
        Some(seed) => {
            let mut sensor = NoiseModel { white: sigma, ..NoiseModel::default() }.generator(seed).unwrap();
            exact
                .iter()
                .map(|sample| Sample { reactions: sensor.sample(sample.reactions).unwrap(), ..*sample })
                .collect()
        }
    };
    // next to a fold the reactions change so fast that exact ones look noisy
    let exact = [noise_estimate::ChannelNoise::white(0.0); 3];
    // two contacts 1e-6 L apart are one contact of a sensor with the smallest of errors
    let (exact, no_errors) = (noise.is_none().then_some(exact), noise.is_none().then_some(Budget::NONE));
    let settings = Settings { noise: exact, budget: no_errors, ..Settings::default() };
    let found = reconstruct_general(rod, &samples, &settings).unwrap();
    let name = |several: bool, name: String| if several { "several".to_owned() } else { name };
    let mut told = Told { samples: states.len(), ..Told::default() };
    for (state, reading) in states.iter().zip(&found.readings) {
        let truth = name(state.contacts.len() > 1, state.phase().to_string());
        told.right += usize::from(truth == name(reading.label.several(), reading.label.to_string()));
        if let (Ok(touch), true) = (&reading.touch, state.contacts.len() > 1) {
            let miss = |contact: &vibrissa::contact::Contact| {
                ((contact.x - touch.x) * touch.alpha.sin() - (contact.y - touch.y) * touch.alpha.cos()).abs()
            };
            let off = state.contacts.iter().map(miss).fold(f64::INFINITY, f64::min);
            if off > 6.0 * touch.sigma_normal() + 1e-7 {
                (told.misled, told.misled_by) = (told.misled + 1, told.misled_by.max(off));
            }
        }
        let ([contact], false) = (&state.contacts[..], reading.label.several()) else { continue };
        match &reading.touch {
            Ok(touch) => {
                let (dx, dy) = (touch.x - contact.x, touch.y - contact.y);
                let across = (dx * touch.alpha.sin() - dy * touch.alpha.cos()).abs();
                told.points += 1;
                told.worst = told.worst.max(dx.hypot(dy));
                told.wrong += usize::from(across > 6.0 * touch.sigma_normal() + 1e-7);
            }
            Err(_) => told.missing += 1,
        }
    }
    println!("{told:?}");
    told
}

/// Whole scans of rods that are not uniform, on rigid clamps and soft ones: the labels, but for BA and BB, and all points of one contact.
#[test]
fn whole_scans_of_any_rod() {
    let soft = Mounted::new(cone(0.5), ElasticClamp::springs(Some(40.0), Some(30.0), Some(8.0)).unwrap());
    let whisker = cone(0.9).with_natural_curvature(0.4).unwrap();
    for (what, told) in [
        ("cone", told(&cone(0.8), None)),
        ("bent", told(&bent(), None)),
        ("sections", told(&two_sections(), None)),
        ("soft cone", told(&soft, None)),
        ("whisker", told(&whisker, None)),
    ] {
        let Told { samples, right, points, worst, missing, wrong, misled, .. } = told;
        assert!(points > 500 && wrong == 0 && misled == 0 && worst < 1e-12, "{what}: {worst:e}");
        assert!(right == samples && missing <= 2, "{what}");
    }
}

/// The same in noise. Where a rod that is bent at rest turns from its tip onto its side, two contacts close to each other on one piece may
/// be hidden in it: points there miss by some times their standard deviations, and by little.
#[test]
fn whole_scans_of_any_rod_in_noise() {
    let whisker = cone(0.6).with_natural_curvature(0.4).unwrap();
    for seed in 1..4 {
        let Told { samples, right, points, worst, wrong, misled, .. } = told(&cone(0.8), Some(seed));
        // some points beside the border of A and B are computed as of the other one
        assert!(right as f64 > 0.99 * samples as f64 && misled == 0 && wrong < points / 200 && worst < 0.01);
        let Told { samples, right, points, wrong, misled, misled_by, .. } = told(&whisker, Some(seed));
        assert!(right as f64 > 0.9 * samples as f64 && wrong == 0 && points > 4000);
        assert!(misled < points / 15 && misled_by < 5e-4);
    }
}
