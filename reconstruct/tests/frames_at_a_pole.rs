//! Films of a rod that touches one pole, against shapes of the second solver that are moved to it.

use super::frames::{Law, Normal, Push, arcs, rods, shoot};
use rod_core::AnyRod;
use rod_reconstruct::{Axis, Channel, Film, ForceSettings, Frame, FrameVerdict, Measurand, PolePrior, forces};

const CENTER: [f64; 2] = [0.012, 0.021];
const ANYWHERE: PolePrior = PolePrior { center: None, sigma: None, radius: None };

/// A frame with its truth.
struct Touching {
    points: Vec<[f64; 2]>,
    /// Base: x, y, phi.
    base: [f64; 3],
    push: Push,
    /// Moment at the base.
    moment: f64,
}

/// The rod under a force, moved so that it touches a pole at [`CENTER`] from a direction.
fn touching(law: &Law, push: Push, radius: f64, turned: f64) -> Touching {
    let at: Vec<f64> = arcs(law.length, 40).into_iter().chain([push.s]).collect();
    let (shape, m0, _) = shoot(law, [0.0, 0.0, turned], &[push], &at);
    let contact = shape[40];
    // a positive force pushes to the right: the pole is on the left
    let side = push.force.signum() * radius;
    let (sin, cos) = contact[2].sin_cos();
    let way = [CENTER[0] - contact[0] + side * sin, CENTER[1] - contact[1] - side * cos];
    Touching {
        points: shape[..40].iter().map(|v| [v[0] + way[0], v[1] + way[1]]).collect(),
        base: [way[0], way[1], turned],
        push,
        moment: -m0,
    }
}

/// A film with forces up to a half radian of bending and contacts along the middle of the rod.
fn film_of(rod: &AnyRod, law: &Law, radius: f64, count: usize, random: &mut Normal) -> Vec<Touching> {
    let unit = rod.units().force;
    let frame = |k: usize| {
        let s = 0.35 + 0.4 * random.uniform();
        let push = Push { s: s * law.length, force: (0.3 + 0.7 * random.uniform()) / (s * s) * unit, turn: 0.0 };
        touching(law, push, radius, 1.2 * k as f64 / count as f64)
    };
    (0..count).map(frame).collect()
}

fn noisy(truth: &[Touching], sigma: f64, random: &mut Normal) -> Vec<Frame> {
    let noisy = |point: &[f64; 2]| point.map(|c| c + sigma * random.next());
    let mut noisy = noisy;
    truth.iter().map(|frame| Frame::from_base(&frame.points.iter().map(&mut noisy).collect::<Vec<_>>())).collect()
}

/// How far place, force and moment are off, in standard deviations, and the standard deviation of the force as a share of it.
fn errors(film: &Film, truth: &[Touching]) -> Vec<([f64; 3], f64)> {
    let found = film.frames.iter().zip(truth).filter_map(|(frame, truth)| {
        let frame = frame.as_ref().unwrap();
        let contact = frame.contacts.first()?;
        let moment = (frame.reactions.m0z - truth.moment) / frame.covariance[5][5].sqrt();
        let place = (contact.s - truth.push.s) / contact.sigmas()[0];
        let force = (contact.force - truth.push.force.abs()) / contact.sigma_force;
        Some(([place, force, moment], contact.sigma_force / contact.force))
    });
    found.collect()
}

#[test]
fn frames_at_one_pole_tell_it_and_each_other() {
    let (mut random, mut all) = (Normal(31), Vec::new());
    for (rod, law) in &rods() {
        for radius in [0.0, 3e-3] {
            let sigma = 1e-3 * law.length;
            let truth = film_of(rod, law, radius, 24, &mut random);
            let frames = noisy(&truth, sigma, &mut random);
            let settings = ForceSettings { sigma: Some(sigma), ..ForceSettings::default() };
            let alone = errors(&forces(rod, &frames, &settings), &truth);
            let film = forces(rod, &frames, &ForceSettings { pole: Some(ANYWHERE), ..settings });
            let pole = film.pole.as_ref().unwrap();
            assert!(pole.frames.len() + pole.elsewhere.len() == 24 && pole.elsewhere.len() <= 1, "{pole:?}");
            for axis in [0, 1] {
                let off = (pole.center[axis] - CENTER[axis]) / pole.covariance[axis][axis].sqrt();
                assert!(off.abs() < 4.0, "{pole:?}");
            }
            assert!((pole.radius - radius).abs() <= 4.0 * pole.covariance[2][2].sqrt(), "{pole:?}");
            let together = errors(&film, &truth);
            let worst = together.iter().flat_map(|(off, _)| off).fold(0.0, |worst: f64, off| worst.max(off.abs()));
            assert!(worst < 4.5, "{worst}");
            all.extend(together.iter().flat_map(|(off, _)| *off));
            let median = |of: &[([f64; 3], f64)]| {
                let mut sizes: Vec<f64> = of.iter().map(|(_, size)| *size).collect();
                sizes.sort_by(f64::total_cmp);
                sizes[sizes.len() / 2]
            };
            let (with, without) = (median(&together), median(&alone));
            println!(
                "radius {radius}: standard deviation of the force {:.1} % with the pole, {:.1} % without",
                1e2 * with,
                1e2 * without
            );
            assert!(with < 0.4 * without, "{with} {without}");
        }
    }
    let within = |sigmas: f64| all.iter().filter(|off| off.abs() < sigmas).count() as f64 / all.len() as f64;
    let shares = [1.0, 2.0, 3.0].map(within);
    println!("within 1, 2, 3 standard deviations: {shares:.3?}");
    assert!((0.6..0.78).contains(&shares[0]) && shares[1] > 0.9 && shares[2] > 0.98, "{shares:?}");
}

/// The moment at the base alone leaves a family in each frame; a pole that all frames touch resolves it.
#[test]
fn moments_of_a_rod_at_a_pole_tell_places_and_forces() {
    let mut random = Normal(17);
    let (rod, law) = &rods()[0];
    let truth = film_of(rod, law, 0.0, 30, &mut random);
    let frames: Vec<Frame> = truth
        .iter()
        .map(|frame| {
            let sigma = 1e-3 * rod.units().moment;
            let channel = |quantity, value, sigma| Channel { quantity, value, sigma };
            let channels = vec![
                channel(Measurand::Base(Axis::X), frame.base[0], 1e-6 * law.length),
                channel(Measurand::Base(Axis::Y), frame.base[1], 1e-6 * law.length),
                channel(Measurand::Base(Axis::Angle), frame.base[2], 1e-6),
                channel(Measurand::Reaction([0.0, 0.0, 1.0]), frame.moment + sigma * random.next(), sigma),
            ];
            Frame { channels, ..Frame::default() }
        })
        .collect();
    let alone = forces(rod, &frames, &ForceSettings::default());
    assert!(alone.frames.iter().all(|frame| frame.as_ref().unwrap().verdict == FrameVerdict::Family));
    let film = forces(rod, &frames, &ForceSettings { pole: Some(ANYWHERE), ..ForceSettings::default() });
    let pole = film.pole.as_ref().unwrap();
    assert!((0..2).all(|axis| (pole.center[axis] - CENTER[axis]).abs() < 4.0 * pole.covariance[axis][axis].sqrt()));
    let judged = film.frames.iter().filter(|frame| frame.as_ref().unwrap().verdict == FrameVerdict::Determined).count();
    assert!(judged >= 28, "{judged}");
    let worst =
        errors(&film, &truth).into_iter().flat_map(|(off, _)| off).fold(0.0, |worst: f64, off| worst.max(off.abs()));
    assert!(worst < 4.5, "{worst}");
}

/// Free frames of the film say of their reactions as much as without the pole.
#[test]
fn free_frames_are_as_without_a_pole() {
    let mut random = Normal(8);
    let (rod, law) = &rods()[2];
    let sigma = 5e-4 * law.length;
    let mut truth = film_of(rod, law, 0.0, 6, &mut random);
    let rest = touching(law, Push { s: 0.5 * law.length, force: 0.0, turn: 0.0 }, 0.0, 0.2);
    truth.push(Touching { points: rest.points.iter().map(|[x, y]| [x - 0.01, y - 0.03]).collect(), ..rest });
    let frames = noisy(&truth, sigma, &mut random);
    let settings = ForceSettings { sigma: Some(sigma), ..ForceSettings::default() };
    let (alone, film) =
        (forces(rod, &frames, &settings), forces(rod, &frames, &ForceSettings { pole: Some(ANYWHERE), ..settings }));
    assert_eq!(film.pole.as_ref().map(|pole| pole.frames.len()), Some(6));
    let (one, other) = (alone.frames[6].as_ref().unwrap(), film.frames[6].as_ref().unwrap());
    assert_eq!((one.verdict, other.verdict), (FrameVerdict::Free, FrameVerdict::Free));
    for k in 0..6 {
        let (one, other) = (one.covariance[k][k], other.covariance[k][k]);
        assert!((one - other).abs() < 1e-6 * one, "{k}: {one} {other}");
    }
}

#[test]
fn a_frame_that_touches_something_else_is_named() {
    let mut random = Normal(5);
    let (rod, law) = &rods()[1];
    let sigma = 2e-4 * law.length;
    let mut truth = film_of(rod, law, 0.0, 12, &mut random);
    for point in &mut truth[7].points {
        point[0] += 0.1 * law.length;
    }
    let frames = noisy(&truth, sigma, &mut random);
    let settings = ForceSettings { sigma: Some(sigma), pole: Some(ANYWHERE), ..ForceSettings::default() };
    let film = forces(rod, &frames, &settings);
    let pole = film.pole.as_ref().unwrap();
    assert!(pole.elsewhere == [7] && pole.frames.len() == 11, "{pole:?}");
    let worst =
        errors(&film, &truth).into_iter().flat_map(|(off, _)| off).fold(0.0, |worst: f64, off| worst.max(off.abs()));
    assert!(worst < 4.5, "{worst}");
    // half of the frames elsewhere: no pole
    for frame in &mut truth[..6] {
        frame.points.iter_mut().for_each(|point| point[1] += 0.15 * law.length * (frame.base[2] + 0.2));
    }
    let film = forces(rod, &noisy(&truth, sigma, &mut random), &settings);
    assert!(film.pole.is_none(), "{:?}", film.pole);
}
