//! Forces from shapes, against a rod that is integrated step by step and shot at its free end.

use rod_core::{
    AnyRod, ClampSpec, CurvatureSpec, ElasticClamp, Elastica, Load, PhysicalRod, Pose, RodSpec, StiffnessSpec, Units,
};
use rod_reconstruct::{Axis, Channel, ForceSettings, Frame, FrameVerdict, Measurand, forces, rest_shape};

/// The laws of a rod: bending stiffness and curvature at rest by the arc length, SI.
pub struct Law {
    pub length: f64,
    stiffness: Box<dyn Fn(f64) -> f64>,
    rest: Box<dyn Fn(f64) -> f64>,
}

/// A force at an arc length: size, and the angle by which friction turns it from the normal.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    pub s: f64,
    pub force: f64,
    pub turn: f64,
}

/// (x, y, phi, m) at the arc lengths `at`, from the base on, by Runge and Kutta's rule; `pushes` with their directions alpha.
fn integrate(law: &Law, base: [f64; 3], m0: f64, pushes: &[Push], alphas: &[f64], at: &[f64]) -> Vec<[f64; 4]> {
    // the rule's error falls with the fourth power: below 1e-11 L, a hundredth of the tightest bound here
    let steps = 1000;
    let rate = |s: f64, v: [f64; 4], [a, b]: [f64; 2]| {
        let (sin, cos) = v[2].sin_cos();
        [cos, sin, v[3] / (law.stiffness)(s) + (law.rest)(s), a * cos + b * sin]
    };
    let mut marks: Vec<f64> = at.iter().copied().chain(pushes.iter().map(|push| push.s)).collect();
    marks.sort_by(f64::total_cmp);
    let (mut s, mut v, mut seen) = (0.0, [base[0], base[1], base[2], m0], Vec::new());
    for mark in marks {
        let count = ((mark - s) / law.length * f64::from(steps)).ceil().max(1.0);
        let h = (mark - s) / count;
        let mut force = [0.0; 2];
        for (push, alpha) in pushes.iter().zip(alphas).filter(|(push, _)| push.s > s + 1e-15) {
            force = [force[0] + push.force * alpha.cos(), force[1] + push.force * alpha.sin()];
        }
        let add = |v: [f64; 4], k: [f64; 4], h: f64| std::array::from_fn(|i| v[i] + h * k[i]);
        for _ in 0..count as usize {
            let k1 = rate(s, v, force);
            let k2 = rate(s + h / 2.0, add(v, k1, h / 2.0), force);
            let k3 = rate(s + h / 2.0, add(v, k2, h / 2.0), force);
            let k4 = rate(s + h, add(v, k3, h), force);
            v = std::array::from_fn(|i| v[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
            s += h;
        }
        s = mark;
        seen.push((mark, v));
    }
    at.iter().map(|at| seen.iter().find(|(mark, _)| mark == at).unwrap().1).collect()
}

/// The rod clamped at `base` under its pushes: moment at the base and directions by Newton's method with differences, the load growing.
pub fn shoot(law: &Law, base: [f64; 3], pushes: &[Push], at: &[f64]) -> (Vec<[f64; 4]>, f64, Vec<f64>) {
    let places: Vec<f64> = pushes.iter().map(|push| push.s).collect();
    let last = *places.last().unwrap();
    let unloaded = integrate(law, base, 0.0, &[], &[], &places);
    let mut u: Vec<f64> =
        [0.0].into_iter().chain(unloaded.iter().zip(pushes).map(|(v, push)| v[2] + push.turn)).collect();
    let unit = (law.stiffness)(0.0) / law.length;
    for part in 1..=10 {
        let scaled: Vec<Push> =
            pushes.iter().map(|push| Push { force: push.force * f64::from(part) / 10.0, ..*push }).collect();
        for _ in 0..12 {
            let left = |u: &[f64]| {
                let mut marks = places.clone();
                marks.push(last);
                let found = integrate(law, base, u[0] * unit, &scaled, &u[1..], &marks);
                let mut left = vec![found[pushes.len()][3] / unit];
                left.extend(found.iter().zip(pushes).enumerate().map(|(k, (v, push))| v[2] + push.turn - u[k + 1]));
                left
            };
            let now = left(&u);
            if now.iter().all(|v| v.abs() < 1e-13) {
                break;
            }
            let n = u.len();
            let mut jacobian = nalgebra::DMatrix::zeros(n, n);
            for k in 0..n {
                let (mut one, mut other) = (u.clone(), u.clone());
                one[k] += 1e-6;
                other[k] -= 1e-6;
                for (i, (a, b)) in left(&one).iter().zip(left(&other)).enumerate() {
                    jacobian[(i, k)] = (a - b) / 2e-6;
                }
            }
            let step = jacobian.lu().solve(&nalgebra::DVector::from_vec(now)).unwrap();
            u.iter_mut().zip(step.iter()).for_each(|(u, step)| *u -= step);
        }
    }
    let m0 = u[0] * unit;
    (integrate(law, base, m0, pushes, &u[1..], at), m0, u[1..].to_vec())
}

/// A uniform rod, a tapered one, and one that tapers and is bent at rest, with their laws.
pub fn rods() -> Vec<(AnyRod, Law)> {
    let (length, base, modulus) = (0.04, 1e-4, 3e9);
    let wire = StiffnessSpec::of_wire(base, modulus);
    let stiffness = move |tip: f64| {
        Box::new(move |s: f64| {
            let d: f64 = base + (tip - base) * s / length;
            modulus * std::f64::consts::PI * d.powi(4) / 64.0
        }) as Box<dyn Fn(f64) -> f64>
    };
    let uniform = RodSpec::new(length, wire);
    let cone = RodSpec { tip_diameter: Some(2e-5), ..uniform.clone() };
    let bent =
        RodSpec { natural_curvature: Some(CurvatureSpec::Points(vec![[0.0, 8.0], [length, 20.0]])), ..cone.clone() };
    let zero = || Box::new(|_: f64| 0.0) as Box<dyn Fn(f64) -> f64>;
    let law = |tip, rest| Law { length, stiffness: stiffness(tip), rest };
    vec![
        (uniform.build().unwrap(), law(base, zero())),
        (cone.build().unwrap(), law(2e-5, zero())),
        (bent.build().unwrap(), law(2e-5, Box::new(move |s| 8.0 + 12.0 * s / length))),
    ]
}

pub fn arcs(length: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| length * k as f64 / (count - 1) as f64).collect()
}

#[test]
fn exact_points_give_exact_forces() {
    for (number, (rod, law)) in rods().iter().enumerate() {
        let unit = rod.units().force;
        for friction in [0.0_f64, 0.4] {
            for (s, force, share) in [(0.35, 3.0, 0.5), (0.6, -1.5, -0.9), (0.82, 0.15, 0.99), (1.0, 0.08, 0.3)] {
                let push = Push { s: s * law.length, force: force * unit, turn: share * friction.atan() };
                let at = arcs(law.length, 40);
                let (found, m0, _) = shoot(law, [0.01, -0.02, 0.8], &[push], &at);
                let points: Vec<[f64; 2]> = found.iter().map(|v| [v[0], v[1]]).collect();
                let settings = ForceSettings { friction, ..ForceSettings::default() };
                let film = forces(rod, &[Frame::from_base(&points)], &settings);
                let judged = film.frames[0].as_ref().unwrap();
                let what = format!("rod {number}, friction {friction}, {push:?}, sigma {:e}: {judged:?}", film.sigma);
                assert_eq!(judged.verdict, FrameVerdict::Determined, "{what}");
                assert_eq!(judged.contacts.len(), 1, "{what}");
                let contact = &judged.contacts[0];
                assert!((contact.s - push.s).abs() < 1e-9 * law.length, "{what}");
                assert!((contact.force - push.force.abs()).abs() < 1e-9 * unit, "{what}");
                assert!((judged.reactions.m0z + m0).abs() < 1e-9 * rod.units().moment, "{what}");
            }
        }
    }
}

/// 20 frames of a rod that tapers to 1/5, whose points do not show the first 12 % of the length: the force is 60 % too large where the first point is
/// taken for the base, and each frame says what it is otherwise. A measured base gives the force.
#[test]
fn a_hidden_base_changes_the_forces_and_is_reported() {
    let (rod, law) = &rods()[1];
    let (unit, sigma) = (rod.units().force, 2e-4 * law.length);
    let push = Push { s: 0.6 * law.length, force: 0.5 * unit, turn: 0.0 };
    let at: Vec<f64> = arcs(law.length, 40).into_iter().filter(|s| *s > 0.12 * law.length).collect();
    let (shape, m0, _) = shoot(law, [0.0; 3], &[push], &at);
    let mut random = Normal(8);
    let mut noisy = |v: &[f64; 4]| [v[0] + sigma * random.next(), v[1] + sigma * random.next()];
    let films: Vec<Vec<[f64; 2]>> = (0..20).map(|_| shape.iter().map(&mut noisy).collect()).collect();
    let settings = ForceSettings { sigma: Some(sigma), ..ForceSettings::default() };
    let film = |frame: &dyn Fn(&[[f64; 2]]) -> Frame| {
        let frames: Vec<Frame> = films.iter().map(|points| frame(points)).collect();
        forces(rod, &frames, &settings).frames.into_iter().map(Result::unwrap).collect::<Vec<_>>()
    };
    let median = |values: &mut dyn Iterator<Item = f64>| {
        let mut values: Vec<f64> = values.collect();
        values.sort_unstable_by(f64::total_cmp);
        values[values.len() / 2]
    };

    let taken = film(&Frame::from_base);
    let others: Vec<_> = taken.iter().map(|judged| judged.if_hidden.unwrap()).collect();
    let base = |axis| Channel { quantity: Measurand::Base(axis), value: 0.0, sigma };
    let measured = film(&|points| Frame {
        base_is_first: false,
        channels: vec![base(Axis::X), base(Axis::Y)],
        ..Frame::from_base(points)
    });
    let determined = taken.iter().filter(|judged| judged.verdict == FrameVerdict::Determined).count();
    let error = |force: f64| force / push.force - 1.0;
    let as_taken = median(&mut taken.iter().map(|judged| error(judged.contacts[0].force)));
    let if_hidden = median(&mut others.iter().map(|other| error(other.force)));
    let moment = median(&mut others.iter().map(|other| -other.m0z / m0 - 1.0));
    let with_base = median(&mut measured.iter().map(|judged| error(judged.contacts[0].force)));
    println!(
        "{determined} of 20 determined; median error of the force {as_taken:+.3}, of force_if_hidden {if_hidden:+.3}, of m0z_if_hidden {moment:+.3}, \
         of the force with a measured base {with_base:+.3}"
    );
    assert!(determined > 15 && as_taken > 0.4, "{determined} {as_taken}");
    // a frame scatters by 0.027, a median of 20 by 0.008
    assert!(
        if_hidden.abs() < 0.03 && moment.abs() < 0.03 && with_base.abs() < 0.03,
        "{if_hidden} {moment} {with_base}"
    );
    assert!(others.iter().all(|other| (other.length - at[0]).abs() < 0.01 * law.length), "{others:?}");
    assert!(measured.iter().all(|judged| judged.if_hidden.is_none()));
}

/// Standard normal numbers by Box and Muller's transform of a xorshift generator.
pub struct Normal(pub u64);

impl Normal {
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    pub fn next(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// What of 1,000 frames with noise is as it should be.
#[derive(Debug, Default)]
struct Tally {
    frames: usize,
    chi_squared: f64,
    freedom: usize,
    /// Within 1, 2, 3 standard deviations: of arc length, force, base moment.
    within: [[usize; 3]; 3],
    worst: f64,
    wrong_count: usize,
    determined: usize,
}

/// Noisy films of rods with one contact, judged against the truth. `friction` is that of the films and known as a limit.
fn tally(rod: &AnyRod, law: &Law, friction: f64, sigma: f64, each: usize) -> Tally {
    let unit = rod.units().force;
    let (at, mut normal, mut tally) = (arcs(law.length, 40), Normal(88_172_645_463_325_252), Tally::default());
    for (s, force, share) in
        [(0.3, 4.0, 0.5), (0.45, -2.5, -0.9), (0.55, 1.5, 0.0), (0.7, 1.0, 0.99), (0.8, -0.4, -0.4)]
    {
        let push = Push { s: s * law.length, force: force * unit, turn: share * friction.atan() };
        let (found, m0, _) = shoot(law, [0.01, -0.02, 0.8], &[push], &at);
        let frames: Vec<Frame> = (0..each)
            .map(|_| {
                let points = found.iter().map(|v| [0, 1].map(|c| v[c] + sigma * law.length * normal.next()));
                Frame::from_base(&points.collect::<Vec<_>>())
            })
            .collect();
        let settings = ForceSettings { friction, sigma: Some(sigma * law.length), ..ForceSettings::default() };
        let film = forces(rod, &frames, &settings);
        for judged in film.frames {
            let judged = judged.unwrap();
            tally.frames += 1;
            tally.chi_squared += judged.chi_squared;
            tally.freedom += judged.freedom;
            let [contact] = &judged.contacts[..] else {
                tally.wrong_count += 1;
                continue;
            };
            if judged.verdict != FrameVerdict::Determined {
                continue;
            }
            tally.determined += 1;
            let off = [
                (contact.s - push.s) / contact.sigmas()[0],
                (contact.force - push.force.abs()) / contact.sigma_force,
                (judged.reactions.m0z + m0) / judged.covariance[5][5].sqrt(),
            ];
            for (within, off) in tally.within.iter_mut().zip(off) {
                for (k, within) in within.iter_mut().enumerate() {
                    *within += usize::from(off.abs() < (k + 1) as f64);
                }
                tally.worst = tally.worst.max(off.abs());
            }
        }
    }
    tally
}

#[test]
fn standard_deviations_are_right() {
    for (number, (rod, law)) in rods().iter().enumerate() {
        for friction in [0.0, 0.4] {
            let each = if friction == 0.0 { 200 } else { 40 };
            let tally = tally(rod, law, friction, 0.0005, each);
            println!("{number} {friction}: {tally:?}");
            let Tally { frames, chi_squared, freedom, within, worst, wrong_count, determined } = tally;
            assert!(
                frames == 5 * each && wrong_count <= 3 && determined >= 3 * frames / 4 && worst < 6.0,
                "{number} {friction}"
            );
            // two-sided band of 99 %
            assert!(
                (chi_squared - freedom as f64).abs() < 2.576 * (2.0 * freedom as f64).sqrt(),
                "{number} {friction}"
            );
            // a share of friction is anywhere within its bounds: five shares are no sample of that
            let least = if friction == 0.0 { [0.60, 0.92, 0.985] } else { [0.50, 0.85, 0.97] };
            for within in within {
                for (within, least) in within.iter().zip(least) {
                    assert!(*within as f64 >= least * determined as f64, "{number} {friction} {within}");
                }
                assert!(friction > 0.0 || within[0] as f64 <= 0.76 * determined as f64, "{number} {within:?}");
            }
        }
    }
}

#[test]
fn free_rods_are_told_free() {
    for (number, (rod, law)) in rods().iter().enumerate() {
        let (at, mut normal) = (arcs(law.length, 40), Normal(77));
        let rest = integrate(law, [0.01, -0.02, 0.8], 0.0, &[], &[], &at);
        let frames: Vec<Frame> = (0..300)
            .map(|_| {
                let points = rest.iter().map(|v| [0, 1].map(|c| v[c] + 5e-4 * law.length * normal.next()));
                Frame::from_base(&points.collect::<Vec<_>>())
            })
            .collect();
        let film = forces(rod, &frames, &ForceSettings::default());
        let free =
            film.frames.iter().filter(|judged| judged.as_ref().is_ok_and(|judged| judged.contacts.is_empty())).count();
        assert!(free >= 297, "{number}: {free}");
    }
}

#[test]
fn the_shape_at_rest_is_found_from_free_frames() {
    let (_, law) = &rods()[2];
    let (at, mut normal) = (arcs(law.length, 40), Normal(5));
    let mut off = [0.0; 3];
    let trials = 30;
    for _ in 0..trials {
        let frames: Vec<Frame> = (0..6)
            .map(|k| {
                let rest = integrate(law, [0.01, -0.02, 0.3 * f64::from(k)], 0.0, &[], &[], &at);
                let points = rest.iter().map(|v| [0, 1].map(|c| v[c] + 5e-4 * law.length * normal.next()));
                Frame::from_base(&points.collect::<Vec<_>>())
            })
            .collect();
        let rest = rest_shape(law.length, &frames, None).unwrap();
        assert!(rest.coefficients.len() <= 3 && (rest.sigma / (5e-4 * law.length) - 1.0).abs() < 0.2, "{rest:?}");
        for (off, s) in off.iter_mut().zip([0.2, 0.5, 0.8]) {
            let (found, sigma) = rest.curvature(s * law.length);
            *off += ((found - (law.rest)(s * law.length)) / sigma).powi(2);
        }
    }
    // 99 % of chi squared of 30
    for off in off {
        assert!(off > 13.8 && off < 53.7, "{off}");
    }
}

/// A cantilever under a dead load P at its tip: Mattiasson (1981), table 1, deflections w across and u along.
#[test]
fn the_tip_load_of_a_cantilever_is_found_from_its_shape() {
    let rod = AnyRod::from(rod_core::Rod::new(1.0, 1.0).unwrap());
    for (load, across, along) in [(1.0, 0.30172, 0.05643), (10.0, 0.81061, 0.55500)] {
        let base = Pose { x: 0.0, y: 0.0, phi: 0.0 };
        let push = Load { s: 1.0, force: load, alpha: 0.0 };
        let shape = Elastica::under_loads(Units::ONE, base, &[push]).unwrap().0;
        let tip = shape.at(1.0);
        assert!((tip.y + across).abs() < 1e-5 && (1.0 - tip.x - along).abs() < 1e-5, "{tip:?}");
        let points: Vec<[f64; 2]> = arcs(1.0, 40).iter().map(|s| shape.at(*s)).map(|at| [at.x, at.y]).collect();
        let film = forces(&rod, &[Frame::from_base(&points)], &ForceSettings::default());
        let judged = film.frames[0].as_ref().unwrap();
        assert_eq!((judged.verdict, judged.contacts.len()), (FrameVerdict::Determined, 1), "{judged:?}");
        let contact = &judged.contacts[0];
        assert!(contact.is_tip && (contact.fy + load).abs() < 1e-9 && contact.fx.abs() < 1e-9, "{contact:?}");
        assert!((judged.reactions.m0z - load * tip.x).abs() < 1e-9 && (judged.reactions.f0y - load).abs() < 1e-9);
    }
}

/// The base of a rod on a torsion spring turns against its moment: support and base together tell the moment.
#[test]
fn the_rotation_of_a_compliant_base_is_a_moment() {
    let springs = ElasticClamp::springs(None, None, Some(5e-4)).unwrap();
    let spec = RodSpec { clamp: ClampSpec::Springs(springs), ..RodSpec::new(0.1, StiffnessSpec::of(1e-5)) };
    let rod = spec.build().unwrap();
    let moment = 2e-5;
    let turned = moment / 5e-4;
    let channel = |measured, value, sigma| Channel { quantity: measured, value, sigma };
    let channels = vec![
        channel(Measurand::Support(Axis::X), 0.0, 1e-7),
        channel(Measurand::Support(Axis::Y), 0.0, 1e-7),
        channel(Measurand::Support(Axis::Angle), 0.3, 1e-6),
        channel(Measurand::Base(Axis::Angle), 0.3 - turned, 1e-6),
    ];
    let base = rod.base(Pose { x: 0.0, y: 0.0, phi: 0.3 }, &rod_core::Reactions { m0z: moment, ..Default::default() });
    assert!((base.phi - (0.3 - turned)).abs() < 1e-12);
    let film = forces(&rod, &[Frame { channels, ..Frame::default() }], &ForceSettings::default());
    let judged = film.frames[0].as_ref().unwrap();
    assert_eq!(judged.verdict, FrameVerdict::Family, "{judged:?}");
    assert!((judged.reactions.m0z - moment).abs() < 1e-8, "{:?}", judged.reactions);
    // the force at half of the length times its lever, hardly bent
    let near = judged.family.iter().find(|member| (member.s - 0.05).abs() < 1e-9).unwrap();
    assert!((near.force - moment / 0.05).abs() < 0.02 * near.force, "{near:?}");
}

/// What is told of frames with random contacts.
#[derive(Debug, Default)]
struct Found {
    determined: usize,
    as_fewer: usize,
    beyond_six_sigma: usize,
    not_explained: usize,
}

/// Frames of all rods with `count` contacts each, by the noise of the points (L).
fn random_contacts(count: usize, noise: f64, frames: usize, random: &mut Normal) -> Found {
    let mut tally = Found::default();
    for (rod, law) in &rods() {
        let (at, unit) = (arcs(law.length, 40), rod.units().force);
        for _ in 0..frames {
            let mut places: Vec<f64> = (0..count).map(|_| 0.15 + 0.8 * random.uniform()).collect();
            places.sort_by(f64::total_cmp);
            let push = |s: &f64| {
                // as much as turns a uniform rod there by up to one radian
                let turn = (0.05 + 0.95 * random.uniform()) * (random.uniform() - 0.5).signum();
                let soft = (law.stiffness)(0.7 * s * law.length) / (law.stiffness)(0.0);
                Push { s: s * law.length, force: 2.0 * turn * soft / (s * s) * unit, turn: 0.0 }
            };
            let pushes: Vec<Push> = places.iter().map(push).collect();
            let (found, m0, _) = shoot(law, [0.01, -0.02, 0.8], &pushes, &at);
            if found.iter().any(|v| (v[2] - 0.8).abs() > 2.5) {
                continue;
            }
            let points = found.iter().map(|v| [0, 1].map(|c| v[c] + noise * law.length * random.next()));
            let points: Vec<[f64; 2]> = points.collect();
            let settings = ForceSettings { sigma: Some(noise * law.length), ..ForceSettings::default() };
            let film = forces(rod, &[Frame::from_base(&points)], &settings);
            let frame = film.frames[0].as_ref().unwrap();
            tally.not_explained += usize::from(frame.verdict == FrameVerdict::NotExplained);
            if frame.verdict != FrameVerdict::Determined {
                continue;
            }
            tally.determined += 1;
            if frame.contacts.len() < count {
                tally.as_fewer += 1;
                continue;
            }
            let mut off = ((frame.reactions.m0z + m0) / frame.covariance[5][5].sqrt()).abs();
            for (contact, push) in frame.contacts.iter().zip(&pushes) {
                off = off.max((contact.force - push.force.abs()).abs() / contact.sigma_force);
                off = off.max((contact.s - push.s).abs() / contact.sigmas()[0]);
            }
            tally.beyond_six_sigma += usize::from(off > 6.0);
        }
    }
    tally
}

#[test]
fn two_contacts_are_found() {
    let found = random_contacts(2, 1e-5, 15, &mut Normal(2_026));
    assert!(found.not_explained == 0 && found.beyond_six_sigma == 0, "{found:?}");
    assert!(found.determined >= 28 && found.as_fewer <= 6, "{found:?}");
}

/// One or two contacts at several levels of noise: the numbers of docs/forces-from-shapes.md.
#[test]
#[ignore = "takes two minutes"]
fn random_contacts_at_any_noise() {
    let mut random = Normal(4_711);
    for count in [1, 2] {
        for noise in [1e-7, 1e-5, 1e-4, 1e-3] {
            println!("{count} contacts, noise {noise:e}: {:?}", random_contacts(count, noise, 100, &mut random));
        }
    }
}

/// Columns have the same names in messages as in tables.
#[test]
fn numbers_that_are_none_are_named_as_in_tables() {
    let rod = &rods()[0].0;
    let message = |quantity, value, sigma| {
        let channels = vec![Channel { quantity, value, sigma }];
        forces(rod, &[Frame { channels, ..Frame::default() }], &ForceSettings::default()).frames[0]
            .clone()
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(Measurand::Marker(0.01, Axis::Y), f64::NAN, 1.0),
        "the value of y@0.01 is NaN, expected a finite number"
    );
    assert_eq!(
        message(Measurand::Reaction([0.0, 0.0, 1.0]), 1.0, 0.0),
        "sigma of m0z is 0, expected a standard deviation larger than 0"
    );
    assert!(message(Measurand::Base(Axis::Angle), 1.0, -1.0).contains("base_phi"));
    assert!(message(Measurand::Support(Axis::X), 1.0, -1.0).contains("sigma of x0"));
}
