#![expect(clippy::print_stdout, reason = "prints the numbers that the page on reconstruction names")]

use super::{ContourFit, FitError, ShapeKind, fit_contour, fit_contours};
use crate::{
    Ar1, Budget, Label, NoiseModel, Reconstruction, Settings, Source, disturb, reconstruct_general, reconstruct_passes,
};
use rod_contact::{ClampPath, State, Sweep};
use rod_contours::{CircularArc, Composite, Contour, Parabola};
use rod_core::{Pose, Reactions, Rod, Sample};

/// Object O2 of Merker et al. (2020).
fn object() -> Composite {
    let (left, right) = (Parabola::new([0.0, 0.0], 50.0).unwrap(), Parabola::new([0.03, 0.01], 50.0).unwrap());
    Composite::joined(vec![Box::new(left), Box::new(right)]).unwrap()
}

/// A steel rod of 0.1 m and 0.5 mm.
fn steel() -> Rod {
    Rod::new(0.1, 206e9 * std::f64::consts::PI * 0.5e-3_f64.powi(4) / 64.0).unwrap()
}

/// Swept past the object at q = 40 mm, a state each 50 um.
fn states(rod: &Rod) -> Vec<State> {
    let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    Sweep::new(rod, &object(), ClampPath::new(clamp(0.08), clamp(-0.09)).unwrap(), 5e-5).unwrap().run().states
}

fn samples(states: &[State]) -> Vec<Sample> {
    states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect()
}

/// With AR(1) noise of 2.5 mN and 0.06 N mm.
fn noisy(samples: &mut [Sample], seed: u64) {
    let sigma = Reactions { f0x: 2.5e-3, f0y: 2.5e-3, m0z: 6e-5 };
    noisy_by(NoiseModel { ar1: Ar1 { sigma, correlation: 0.45 }, ..NoiseModel::default() }, samples, seed);
}

fn noisy_by(model: NoiseModel, samples: &mut [Sample], seed: u64) {
    let mut generator = model.generator(seed).unwrap();
    samples.iter_mut().for_each(|sample| sample.reactions = generator.sample(sample.reactions).unwrap());
}

const AS_IS: Settings = Settings {
    noise: None,
    false_alarms: 0.01,
    largest_sigma: 0.02,
    budget: Some(Budget::NONE),
    known: crate::Known::NOTHING,
    friction: crate::Friction::None,
};

fn fitted(rod: &Rod, samples: &[Sample], settings: &Settings) -> Result<ContourFit, FitError> {
    fit_contour(rod, samples, &reconstruct_passes(rod, samples, settings).unwrap())
}

/// The fit that explains the recording of some states with noise, and the answers that it gives.
fn explained(rod: &Rod, states: &[State], seed: u64) -> (ContourFit, Reconstruction) {
    let mut samples = samples(states);
    noisy(&mut samples, seed);
    let mut found = reconstruct_passes(rod, &samples, &AS_IS).unwrap();
    let fit = fit_contour(rod, &samples, &found).unwrap();
    assert!(fit.goodness.explains, "{:?}", fit.goodness);
    found.adopt(&fit, &AS_IS);
    (fit, found)
}

/// Distances of the true contacts from the contour, m, in order of size.
fn distances(fit: &ContourFit, states: &[State]) -> Vec<f64> {
    let contours: Vec<Composite> = fit.objects.iter().map(|object| object.contour().unwrap()).collect();
    let gap = |x: f64, y: f64| contours.iter().map(|one| one.closest(x, y).gap.abs()).fold(f64::INFINITY, f64::min);
    let contacts = states.iter().flat_map(|state| &state.contacts);
    let mut distances: Vec<f64> = contacts.map(|contact| gap(contact.x, contact.y)).collect();
    distances.sort_by(f64::total_cmp);
    distances
}

/// Samples with several contacts, and how many of them have their label.
fn several(fit: &ContourFit, states: &[State]) -> (usize, usize) {
    let truth = |k: usize| Label::of(states[k].phase().contacts, states[k].phase().tip);
    let labels = fit.blocks.iter().flat_map(|block| block.samples.clone().map(move |k| (k, block.label)));
    let several: Vec<_> = labels.filter(|(k, _)| truth(*k).several()).collect();
    (several.len(), several.iter().filter(|(k, label)| *label == Some(truth(*k))).count())
}

/// Labels but for those next to a transition, points within their standard deviations, at least `within_two` of them within two, and forces.
fn answers_are_true(found: &Reconstruction, states: &[State], within_two: f64) {
    let truth = |k: usize| Label::of(states[k].phase().contacts, states[k].phase().tip);
    let (mut wrong, mut expected, mut doubtful, mut ratios) = (0, 0.0, 0, Vec::new());
    for (k, (reading, state)) in found.readings.iter().zip(states).enumerate() {
        expected += 1.0 - reading.probability;
        if reading.label != truth(k) {
            wrong += 1;
            continue;
        }
        let touches = std::iter::once(reading.touch).chain(reading.second).zip(&state.contacts);
        for (touch, contact) in touches.filter_map(|(touch, contact)| Some((touch.ok()?, contact))) {
            let (sin, cos) = touch.alpha.sin_cos();
            let off = ((touch.x - contact.x) * sin - (touch.y - contact.y) * cos).abs();
            ratios.push(off / touch.sigma_normal());
            // a second contact that begins some samples too late: such a label is more likely wrong than not, and there are few
            let is_off = (touch.force - contact.load().force).abs() >= 0.03;
            assert!(!is_off || reading.probability < 0.5, "sample {k}: {} N for {}", touch.force, contact.force);
            doubtful += usize::from(is_off);
        }
    }
    let share = |most: f64| ratios.iter().filter(|ratio| **ratio < most).count() as f64 / ratios.len() as f64;
    println!(
        "{wrong} labels of {} wrong, {expected:.0} expected; {:.2}, {:.2} and {:.3} of the points within 1, 2 and 3 standard deviations",
        states.len(),
        share(1.0),
        share(2.0),
        share(3.0)
    );
    println!("{doubtful} forces are off by 0.03 N and more");
    assert!(doubtful <= 3, "{doubtful}");
    // a transition that is off makes a whole run of labels wrong
    assert!(
        f64::from(wrong) < 2.5 * expected && share(2.0) > within_two && share(4.0) > 0.99,
        "{wrong} {} {}",
        share(2.0),
        share(4.0)
    );
    assert_eq!(found.runs.first(), Some(&(0, truth(0))));
}

/// One of some errors, 0 where it is not among them.
fn error_of(given: &[(Source, f64)], source: Source) -> f64 {
    given.iter().find(|one| one.0 == source).map_or(0.0, |one| one.1)
}

/// Shared errors within four standard deviations.
fn errors_are_true(fit: &ContourFit, truth: impl Fn(Source) -> f64) {
    for (source, value, sigma) in &fit.errors {
        let off = (value - truth(*source)) / sigma;
        println!("{source}: {value:.2e} +- {sigma:.1e}, {off:.1} standard deviations off");
        assert!(off.abs() < 4.0, "{source}: {value} +- {sigma}, {off} standard deviations off");
    }
}

#[test]
fn a_contour_explains_its_recording_in_noise() {
    let rod = steel();
    let states = states(&rod);
    for seed in [0, 1] {
        let (fit, found) = explained(&rod, &states, seed);
        answers_are_true(&found, &states, 0.85);
        let ratio = fit.goodness.chi_squared / fit.goodness.degrees_of_freedom;
        assert!((0.8..1.2).contains(&ratio), "{ratio}");
        let distances = distances(&fit, &states);
        let (median, most) = (distances[distances.len() / 2], distances[distances.len() * 19 / 20]);
        println!(
            "seed {seed}: chi squared {ratio:.2} of its degrees of freedom, contacts off {median:.1e} m, {most:.1e} m at 95 %"
        );
        assert!(median < 8e-6 && most < 6e-5, "{median} {most}");
        // two contacts are found at seed 1 as well, where the local answer has a single one in their place
        let (all, right) = several(&fit, &states);
        println!("seed {seed}: {right} of {all} samples with two contacts");
        assert!(all > 200 && right * 100 > 95 * all, "{right} of {all}");
    }
}

/// A flank that a contact passes within some samples, and another along which it rolls slowly. Two contacts at the ends of a shallow hollow have
/// nearly the reactions of one that passes a flank.
#[test]
fn one_contact_passes_a_straight_flank() {
    let rod = steel();
    let corners = [
        [0.02677, 0.012],
        [0.00998, 0.025],
        [-0.00299, 0.02645],
        [-0.0236, 0.02412],
        [-0.01281, 0.00289],
        [-0.00594, -0.01207],
        [0.01736, -0.01079],
    ];
    let polygon = Composite::polygon(&corners).unwrap();
    let clamp = |x, y, phi: f64| Pose { x, y, phi: phi.to_radians() };
    let way = ClampPath::new(clamp(0.09, -0.05711, 84.5576), clamp(-0.1, -0.04711, 100.5449)).unwrap();
    let states = Sweep::new(&rod, &polygon, way, 2e-4).unwrap().run().states;
    for seed in [0, 1] {
        let (fit, found) = explained(&rod, &states, seed);
        assert!(fit.blocks.iter().all(|block| block.label.is_none_or(|label| !label.several())), "{:?}", fit.runs());
        // most contacts are at two corners, whose errors they share
        answers_are_true(&found, &states, 0.3);
    }
}

#[test]
fn shared_errors_come_out_with_the_contour() {
    let given = [
        (Source::BiasF0x, 0.004),
        (Source::BiasF0y, -0.003),
        (Source::BiasM0z, 2e-4),
        (Source::DriftF0x, 0.003),
        (Source::DriftM0z, -2e-4),
        (Source::GainF0x, 0.008),
        (Source::GainF0y, -0.006),
        (Source::GainM0z, 0.01),
        (Source::ClampAngle, 0.007),
        (Source::Stiffness, 0.03),
    ];
    let truth = |source| error_of(&given, source);
    let rod = steel();
    let states = states(&rod);
    let (rod, mut disturbed) = disturb(&rod, &samples(&states), truth).unwrap();
    noisy(&mut disturbed, 0);
    let fit = fitted(&rod, &disturbed, &Settings { budget: None, ..AS_IS }).unwrap();
    assert!(fit.goodness.explains, "{:?}", fit.goodness);
    assert!(fit.errors.len() >= 5 && fit.friction_beside_errors().is_none(), "{:?}", fit.errors);
    errors_are_true(&fit, truth);
    let (all, right) = several(&fit, &states);
    assert!(right * 100 > 95 * all, "{right} of {all}");
}

/// Its local answer takes the beginning of the contact for free, and loses the contact towards the tip: the fit starts from the middle.
#[test]
fn a_short_contact_in_strong_noise_is_explained() {
    let given = [
        (Source::BiasF0x, -3.5e-3),
        (Source::BiasF0y, 4.4e-3),
        (Source::DriftF0y, -4.8e-3),
        (Source::M0zInF0x, 0.0108),
        (Source::ClampAngle, -9.1e-3),
        (Source::Stiffness, -0.029),
    ];
    let rod = steel();
    let disc = Composite::single(CircularArc::new([0.0, 9.1e-3], 9.1e-3, 0.0, std::f64::consts::TAU).unwrap()).unwrap();
    let clamp = |x| Pose { x, y: -0.056, phi: std::f64::consts::FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.1), clamp(-0.096)).unwrap();
    let states = Sweep::new(&rod, &disc, path, 6e-4).unwrap().run().states;
    let (rod, exact) = disturb(&rod, &samples(&states), |source| error_of(&given, source)).unwrap();
    let white = Reactions { f0x: 0.01, f0y: 0.01, m0z: 2.4e-4 };
    let is_explained = |seed: u64| {
        let mut samples = exact.clone();
        noisy_by(NoiseModel { white, ..NoiseModel::default() }, &mut samples, seed);
        let fit = fitted(&rod, &samples, &Settings { budget: None, ..AS_IS });
        println!("seed {seed}: {:?}", fit.as_ref().map(|fit| fit.goodness.explains));
        fit.is_ok_and(|fit| fit.goodness.explains)
    };
    assert_eq!((0..3).filter(|seed| is_explained(*seed)).count(), 3);
}

/// A sensor that is not tared, beside a clamp at a wrong angle, holds a rod that tapers to half its diameter and is not quite straight.
#[test]
fn shared_errors_of_a_cone_come_out_with_the_contour() {
    let given = [
        (Source::BiasF0x, 0.004),
        (Source::BiasF0y, -0.003),
        (Source::BiasM0z, 2e-4),
        (Source::DriftF0y, 0.003),
        (Source::GainF0x, 0.008),
        (Source::ClampAngle, 0.007),
        (Source::NaturalCurvature, 0.03),
    ];
    let truth = |source| error_of(&given, source);
    let cone = Rod::tapered(0.1, 0.6e-3, 0.3e-3, 206e9).unwrap();
    let at_clamp = Rod::from_diameter(0.1, 0.6e-3, 206e9).unwrap();
    let disc = CircularArc::new([0.0, 0.015], 0.015, 0.0, std::f64::consts::TAU).unwrap();
    let disc = Composite::single(disc).unwrap();
    let clamp = |x| Pose { x, y: -0.045, phi: std::f64::consts::FRAC_PI_2 };
    let swept = cone.clone().with_natural_curvature(truth(Source::NaturalCurvature) / 0.1).unwrap();
    let states =
        Sweep::new(&swept, &disc, ClampPath::new(clamp(0.1), clamp(-0.1)).unwrap(), 4e-4).unwrap().run().states;
    let (_, mut disturbed) = disturb(&at_clamp, &samples(&states), truth).unwrap();
    // the mean noise of seed 0 over the 91 free samples at the end happens to be 3.4 of its standard deviations
    noisy(&mut disturbed, 1);
    let settings = Settings { budget: None, ..AS_IS };
    let mut found = reconstruct_general(&cone, &disturbed, &settings).unwrap();
    let fit = fit_contour(&cone, &disturbed, &found).unwrap();
    assert!(fit.goodness.explains && fit.errors.len() >= 3, "{:?} {:?}", fit.goodness, fit.errors);
    errors_are_true(&fit, truth);
    found.adopt(&fit, &settings);
    answers_are_true(&found, &states, 0.85);
}

/// All of 26 errors moved the contour by as much as noise and their budgets let them.
#[test]
fn an_offset_of_the_sensor_frees_few_other_errors() {
    let given = [(Source::BiasF0x, 0.004), (Source::BiasF0y, -0.003), (Source::BiasM0z, 2e-4)];
    let truth = |source| error_of(&given, source);
    let rod = steel();
    let states = states(&rod);
    let (rod, mut disturbed) = disturb(&rod, &samples(&states), truth).unwrap();
    noisy(&mut disturbed, 0);
    let settings = Settings { budget: None, ..AS_IS };
    let mut found = reconstruct_passes(&rod, &disturbed, &settings).unwrap();
    let fit = fit_contour(&rod, &disturbed, &found).unwrap();
    assert!(fit.goodness.explains, "{:?}", fit.goodness);
    let off = distances(&fit, &states);
    println!("contacts off {:.1e} m in the median, free: {:?}", off[off.len() / 2], fit.errors);
    assert!(fit.errors.len() < 8, "{:?}", fit.errors);
    errors_are_true(&fit, truth);
    found.adopt(&fit, &settings);
    let taken = &found.calibration().unwrap().sources;
    let is_free = |source: Source| fit.errors.iter().any(|error| error.0 == source);
    assert!(taken.iter().all(|one| is_free(one.source) || one.taken == one.known), "{taken:?}");
}

#[test]
fn what_no_contour_explains_is_said_with_its_place() {
    let rod = steel();
    let states = states(&rod);
    let mut samples = samples(&states);
    noisy(&mut samples, 0);
    // a hand on the rod, while it lies on the object with one contact
    for (k, sample) in samples.iter_mut().enumerate().take(1900).skip(1600) {
        let push = (std::f64::consts::PI * (k - 1600) as f64 / 300.0).sin();
        sample.reactions.f0y += 0.03 * push;
    }
    let fit = fitted(&rod, &samples, &AS_IS).unwrap();
    let worst = fit.goodness.worst.clone().unwrap();
    assert!(!fit.goodness.explains && worst.p_value < 1e-4, "{:?}", fit.goodness);
    assert!(worst.samples.start >= 1500 && worst.samples.end <= 2000, "{worst:?}");
}

/// A recording, and its errors.
type Disturbed = (Vec<Sample>, [(Source, f64); 3]);

/// Three scans of one object whose sensor was tared anew before each, while its clamp stayed at a wrong angle.
fn three_scans(rod: &Rod) -> Vec<Disturbed> {
    let scan = |(k, height): (usize, f64)| {
        let clamp = |x| Pose { x, y: height, phi: std::f64::consts::FRAC_PI_2 };
        let path = ClampPath::new(clamp(0.08), clamp(-0.09)).unwrap();
        let bias = 1e-2 * (1.0 - k as f64);
        let errors = [(Source::BiasF0x, bias), (Source::BiasF0y, -0.5 * bias), (Source::ClampAngle, 8e-3)];
        let states = Sweep::new(rod, &object(), path, 2.5e-4).unwrap().run().states;
        let size = |source| errors.iter().find(|error| error.0 == source).map_or(0.0, |error| error.1);
        let mut samples = disturb(rod, &samples(&states), size).unwrap().1;
        noisy(&mut samples, 5 + k as u64);
        (samples, errors)
    };
    [-0.06, -0.045, -0.025].into_iter().enumerate().map(scan).collect()
}

#[test]
fn recordings_of_one_object_share_a_contour_and_the_errors_of_rod_and_clamp() {
    let rod = steel();
    let settings = Settings { budget: Some(Budget::laboratory(&rod)), ..AS_IS };
    let scans = three_scans(&rod);
    let found: Vec<Reconstruction> =
        scans.iter().map(|(samples, _)| reconstruct_passes(&rod, samples, &settings).unwrap()).collect();
    let recordings: Vec<(&[Sample], &Reconstruction)> =
        scans.iter().zip(&found).map(|((samples, _), local)| (&samples[..], local)).collect();
    let fits = fit_contours(&rod, &recordings).unwrap();
    let of_angle = |fit: &ContourFit| fit.errors.iter().find(|error| error.0 == Source::ClampAngle).map(|one| one.2);
    for (fit, (local, (samples, errors))) in fits.iter().zip(found.iter().zip(&scans)) {
        assert!(fit.goodness.explains, "{:?}", fit.goodness);
        assert_eq!((fit.readings.len(), &fit.objects), (samples.len(), &fits[0].objects));
        let worst = fit.goodness.worst.as_ref().unwrap();
        assert!(worst.samples.end <= samples.len() && fit.blocks[0].samples.start == 0, "{worst:?}");
        for (source, value, sigma) in &fit.errors {
            let truth = errors.iter().find(|error| error.0 == *source).map_or(0.0, |error| error.1);
            println!("{source}: {value:.2e} +- {sigma:.1e}, true {truth:.2e}");
            assert!((value - truth).abs() < 3.0 * sigma, "{source}: {value} +- {sigma}, true {truth}");
        }
        let alone = fit_contour(&rod, samples, local).unwrap();
        assert!(alone.goodness.explains, "{:?}", alone.goodness);
        assert!(of_angle(&alone).is_none_or(|alone| of_angle(fit).unwrap() < 0.5 * alone), "{:?}", alone.errors);
    }
}

#[test]
fn a_recording_without_contacts_has_no_fit() {
    let rod = steel();
    let clamp = |k: i32| Pose { x: 0.08 - 1e-4 * f64::from(k), y: -0.3, phi: std::f64::consts::FRAC_PI_2 };
    let mut samples: Vec<Sample> =
        (0..400).map(|k| Sample::new(clamp(k), Reactions { f0x: 0.0, f0y: 0.0, m0z: 0.0 })).collect();
    noisy(&mut samples, 3);
    assert_eq!(fitted(&rod, &samples, &AS_IS), Err(FitError::NoContacts));
}

/// The gradient of the cost against differences, at contours with a vertex at which the rod lies and beside it.
#[test]
fn derivatives_of_the_cost_are_its_differences() {
    use super::curve::{Curve, Node};
    use super::problem::{Fit, Sources};
    use crate::least_squares::Problem;
    use crate::systematic::Errors;
    use nalgebra::{DVector, Vector2};
    let rod = steel();
    let corner = Composite::polyline(&[[-0.0705, 0.15], [-0.003, 0.001], [0.0825, 0.15]]).unwrap();
    let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    let states =
        Sweep::new(&rod, &corner, ClampPath::new(clamp(0.06), clamp(-0.06)).unwrap(), 1e-4).unwrap().run().states;
    let mut samples = samples(&states);
    noisy(&mut samples, 0);
    let local = reconstruct_passes(&rod, &samples, &AS_IS).unwrap();
    let blocks = super::Blocks::of(&rod, &samples, &local).unwrap();
    let sources = Sources { known: vec![Errors::zeros()], ..Sources::default() };
    for shift in [0.0, 2e-4] {
        let node = |x: f64, y: f64, is_vertex| Node { at: Vector2::new(x, y + shift), is_vertex, sigma: 0.01 };
        let chain = [
            node(-0.0705, 0.15, false),
            node(-0.012, 0.0209, false),
            node(-0.003, 0.001, true),
            node(0.011, 0.0254, false),
            node(0.0825, 0.15, false),
        ];
        let curve = Curve::through(&[chain.to_vec()]).unwrap();
        let unknowns = curve.count();
        let mut fit = Fit::new(&rod, curve, &blocks, &sources);
        fit.bend = 1e3;
        let at = DVector::zeros(unknowns);
        let here = fit.equations(&at);
        let reached = fit.states.iter().flatten().count();
        assert!(reached > blocks.blocks.len() / 2, "{reached} of {}", blocks.blocks.len());
        for i in 0..unknowns {
            let mut cost = |h: f64| {
                let mut x = at.clone();
                x[i] += h;
                fit.equations(&x).cost
            };
            let h = 1e-8;
            let difference = (cost(h) - cost(-h)) / (2.0 * h);
            let off = (2.0 * here.gradient[i] - difference).abs() / (1e3 + difference.abs());
            assert!(off < 0.01, "unknown {i}: {} {difference}", 2.0 * here.gradient[i]);
        }
    }
}

#[test]
fn no_object_reaches_beyond_where_the_rod_passed() {
    let rod = steel();
    let (fit, _) = explained(&rod, &states(&rod), 3);
    // the solid of object O2
    let is_solid = |x: f64, y: f64| [[0.0, 0.0], [0.03, 0.01]].iter().any(|[a, b]| y > b + 50.0 * (x - a).powi(2));
    let (mut touched, mut bounded) = (0, 0);
    for object in &fit.objects {
        let at = |k: usize| object.points[k.min(object.points.len() - 1)];
        for (k, known) in object.known.iter().enumerate() {
            let ([x, y], [from, to]) = (at(k), [at(k.saturating_sub(1)), at(k + 1)]);
            touched += usize::from(known.sigma().is_some_and(|sigma| sigma > 0.0));
            let Some(room) = known.room() else { continue };
            let way = (to[0] - from[0]).hypot(to[1] - from[1]);
            for share in [1.0, 1.5, 2.0] {
                // 0.001 L for the noise of the shape of a hardly loaded rod
                let out = (room + 1e-4) * share / way;
                let (x, y) = (x + out * (to[1] - from[1]), y - out * (to[0] - from[0]));
                assert!(!is_solid(x, y), "at {x}, {y}, {room} beyond the contour");
            }
            bounded += 1;
        }
    }
    assert!(touched > 20 && bounded > 2, "{touched} touched, {bounded} bounded");
}

#[test]
fn the_parabolas_of_an_object_are_found() {
    let rod = steel();
    let (fit, _) = explained(&rod, &states(&rod), 3);
    // (vertex x, vertex y, coefficient, rotation) of the two parts
    let truth = [[0.0, 0.0, 50.0, 0.0], [0.03, 0.01, 50.0, 0.0]];
    assert_eq!(fit.objects.len(), 2);
    for object in 0..2 {
        let best = fit.shapes.iter().find(|shape| shape.object == object).unwrap();
        assert_eq!((best.kind, best.evidence), (ShapeKind::Parabola, 0.0), "{:?}", fit.shapes);
        let is_its = |truth: &&[f64; 4]| (truth[0] - best.parameters[0].1).abs() < 0.01;
        let truth = truth.iter().find(is_its).unwrap();
        for ((name, value, sigma), truth) in best.parameters.iter().zip(truth) {
            println!("{name}: {value} +- {sigma}, true {truth}");
            assert!((value - truth).abs() < 4.0 * sigma, "{name}: {value} +- {sigma}, true {truth}");
        }
    }
}

/// Parts in front of a flank explained a recording with it, and stayed.
#[test]
fn a_part_that_the_recording_does_not_ask_for_is_left_out() {
    use super::curve::Node;
    use super::problem::Sources;
    use super::solve::Search;
    use super::start::Start;
    use nalgebra::{DVector, Vector2};
    let rod = steel();
    let mut samples = samples(&states(&rod));
    noisy(&mut samples, 0);
    let local = reconstruct_passes(&rod, &samples, &AS_IS).unwrap();
    let blocks = super::Blocks::of(&rod, &samples, &local).unwrap();
    // in rod lengths, where the parabolas are y = 5 x^2
    let flank = |vertex: [f64; 2], xs: std::ops::Range<i32>, off: f64| -> Vec<Node> {
        let at = |x: f64| Vector2::new(vertex[0] + x, vertex[1] + 5.0 * x * x - off);
        xs.map(|k| Node::smooth(at(0.02 * f64::from(k)), 0.03)).collect()
    };
    let [left, right] = [[0.0, 0.0], [0.3, 0.1]];
    let chains = vec![flank(left, -18..6, 0.0), flank(right, -4..18, 0.0), flank(right, 8..14, 1e-3)];
    let sources = Sources { known: vec![crate::systematic::Errors::zeros()], ..Sources::default() };
    let start = Start { asked: vec![true; blocks.blocks.len()], blocks, chains };
    let mut search =
        Search { rod: &rod, sources: &sources, errors: &DVector::zeros(0), evaluations: super::MOST_EVALUATIONS };
    let mut best = None;
    let begun = search.begun(&start).unwrap();
    search.improve(begun, &mut best);
    let (best, _) = best.unwrap();
    assert!(best.goodness.explains, "{:?}", best.goodness);
    assert_eq!(best.curve.nodes_of_chains().len(), 2);
}

#[test]
fn a_disc_is_known_by_its_centre_and_radius() {
    let rod = steel();
    let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.07), clamp(-0.07)).unwrap();
    let disc = Composite::single(CircularArc::new([0.003, 0.02], 0.02, 0.0, std::f64::consts::TAU).unwrap()).unwrap();
    let (fit, _) = explained(&rod, &Sweep::new(&rod, &disc, path, 5e-5).unwrap().run().states, 1);
    let arc = fit.shapes.iter().find(|shape| shape.kind == ShapeKind::Arc).expect("an arc");
    for ((name, value, sigma), truth) in arc.parameters.iter().zip([0.003, 0.02, 0.02]) {
        assert!((value - truth).abs() < 4.0 * sigma, "{name}: {value} +- {sigma}, true {truth}");
    }
}

/// An ellipse with radii of 277 +- 78 mm explained the 40 mm of a parabola that were touched.
#[test]
fn no_shape_is_reported_that_a_short_stretch_does_not_determine() {
    let rod = steel();
    let clamp = |x| Pose { x, y: -0.02, phi: std::f64::consts::FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.08), clamp(0.024)).unwrap();
    let states = Sweep::new(&rod, &object(), path, 2e-5).unwrap().run().states;
    for seed in [0, 1] {
        let (fit, _) = explained(&rod, &states, seed);
        assert!(fit.shapes.iter().any(|shape| shape.kind == ShapeKind::Parabola), "{:?}", fit.shapes);
        let is_vague = |(name, _, sigma): &&(String, f64, f64)| {
            !["coefficient", "rotation"].contains(&name.as_str()) && *sigma > 0.03
        };
        for shape in &fit.shapes {
            assert_eq!(shape.parameters.iter().find(is_vague), None, "{}", shape.kind);
        }
    }
}

/// How often the true shape is found, and how far its parameters are off.
#[test]
#[ignore = "prints the numbers that the page on reconstruction names; a minute in release"]
fn shapes_of_many_seeds() {
    let rod = steel();
    let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.07), clamp(-0.07)).unwrap();
    let disc = Composite::single(CircularArc::new([0.003, 0.02], 0.02, 0.0, std::f64::consts::TAU).unwrap()).unwrap();
    let of_disc = Sweep::new(&rod, &disc, path, 5e-5).unwrap().run().states;
    let scans = [
        (ShapeKind::Parabola, states(&rod), vec![vec![0.0, 0.0, 50.0, 0.0], vec![0.03, 0.01, 50.0, 0.0]]),
        (ShapeKind::Arc, of_disc, vec![vec![0.003, 0.02, 0.02]]),
    ];
    for (kind, states, truths) in scans {
        let (mut objects, mut found, mut first, mut off) = (0, 0, 0, Vec::new());
        for seed in 0..20 {
            let mut samples = samples(&states);
            noisy(&mut samples, seed);
            let Ok(fit) = fitted(&rod, &samples, &AS_IS) else { continue };
            objects += fit.objects.len();
            for shape in fit.shapes.iter().filter(|shape| shape.kind == kind) {
                let far = |truth: &&Vec<f64>| (truth[0] - shape.parameters[0].1).abs();
                let truth = truths.iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
                found += 1;
                first += usize::from(shape.evidence == 0.0);
                off.extend(
                    shape.parameters.iter().zip(truth).map(|((_, value, sigma), truth)| (value - truth).abs() / sigma),
                );
            }
        }
        let within = |most: f64| 100.0 * off.iter().filter(|off| **off < most).count() as f64 / off.len() as f64;
        println!(
            "{kind}: of {objects} objects {found} are one, {first} best of all; {:.0}, {:.0} and {:.0} % of the parameters within 1, 2 and 3 \
             standard deviations, the largest {:.1} off",
            within(1.0),
            within(2.0),
            within(3.0),
            off.iter().fold(0.0, |most: f64, off| most.max(*off)),
        );
    }
}

/// Drawn past O2 at q = 40 mm with friction.
fn rubbing_states(rod: &Rod, mu: f64, step: f64) -> Vec<State> {
    let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.08), clamp(-0.09)).unwrap();
    Sweep::new(rod, &object(), path, step).unwrap().with_friction(mu).unwrap().run().states
}

#[test]
fn friction_comes_out_with_the_contour() {
    let (rod, mu) = (steel(), 0.2);
    let states = rubbing_states(&rod, mu, 5e-5);
    let mut samples = samples(&states);
    noisy(&mut samples, 1);
    let settings = Settings { friction: crate::Friction::Estimate, ..AS_IS };
    let mut found = reconstruct_passes(&rod, &samples, &settings).unwrap();
    let fit = fit_contour(&rod, &samples, &found).unwrap();
    assert!(fit.goodness.explains, "{:?}", fit.goodness);
    errors_are_true(&fit, |source| error_of(&[(Source::Friction, mu)], source));
    assert_eq!(fit.errors.len(), 1);
    found.adopt(&fit, &settings);
    answers_are_true(&found, &states, 0.85);
    assert!((found.passes[0].used_friction - mu).abs() < 2e-3, "{}", found.passes[0].used_friction);
}

/// Three recordings of an outside test had mu 6 to 12 standard deviations off.
#[test]
fn the_uncertainty_of_friction_contains_other_errors() {
    let (rod, mu) = (steel(), 0.2);
    let states = rubbing_states(&rod, mu, 3e-4);
    let bias = [(Source::BiasF0x, 0.003), (Source::ClampAngle, 0.006)];
    let (rod, mut disturbed) = disturb(&rod, &samples(&states), |source| error_of(&bias, source)).unwrap();
    noisy(&mut disturbed, 0);
    let settings = Settings { friction: crate::Friction::Estimate, budget: None, ..AS_IS };
    let found = reconstruct_passes(&rod, &disturbed, &settings).unwrap();
    let fit = fit_contour(&rod, &disturbed, &found).unwrap();
    assert!(fit.goodness.explains, "{:?}", fit.goodness);
    let (_, value, sigma) = fit.errors.iter().find(|error| error.0 == Source::Friction).unwrap();
    println!("{value} +- {sigma}");
    assert!(
        (value - mu).abs() < 3.0 * sigma && *sigma >= found.passes[0].friction.unwrap().sigma,
        "{value} +- {sigma}"
    );
}

/// A coefficient that is known exactly is no unknown: it was left out of the model.
#[test]
fn a_known_coefficient_is_that_of_the_fit() {
    let (rod, mu) = (steel(), 0.2);
    let states = rubbing_states(&rod, mu, 3e-4);
    let mut samples = samples(&states);
    noisy(&mut samples, 0);
    let settings = Settings { friction: crate::Friction::Known { mu, sigma: 0.0 }, ..AS_IS };
    let fit = fitted(&rod, &samples, &settings).unwrap();
    assert!(fit.goodness.explains && fit.errors.is_empty(), "{:?} {:?}", fit.goodness, fit.errors);
}

/// Errors of the sensor and of the clamp could take the place of friction that is not asked for.
#[test]
fn friction_that_is_not_asked_for_is_told_from_errors() {
    let given = [(Source::BiasF0x, 0.004), (Source::GainF0y, 0.006), (Source::ClampAngle, 0.005)];
    let rod = steel();
    let (mu, states) = (0.1, rubbing_states(&rod, 0.1, 2e-4));
    let (rod, mut disturbed) = disturb(&rod, &samples(&states), |source| error_of(&given, source)).unwrap();
    noisy(&mut disturbed, 0);
    let fit = fitted(&rod, &disturbed, &Settings { budget: None, ..AS_IS }).unwrap();
    assert!(fit.goodness.explains, "{:?}", fit.goodness);
    let (found, sigma) = fit.friction_beside_errors().unwrap();
    assert!((found - mu).abs() < 4.0 * sigma, "{found} +- {sigma}");
}
