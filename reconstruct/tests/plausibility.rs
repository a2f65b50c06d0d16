//! The check by the physics: recordings in wrong units, of another rod, with offsets.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use rod_contact::{ClampPath, Sweep};
use rod_contours::{Composite, Parabola};
use rod_core::{Pose, Reactions, Rod};
use rod_reconstruct::{Finding, NoiseModel, Plausibility, Sample, plausibility};
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// The wire of the paper.
const LENGTH: f64 = 0.1;
const STIFFNESS: f64 = 6.32e-4;

fn rod(length: f64, stiffness: f64) -> Rod {
    Rod::new(length, stiffness).unwrap()
}

/// A scan of two parabolas at so many mm, noise-free, with several contacts on its way.
fn scan(distance: f64, angle: f64) -> Vec<Sample> {
    let pieces: Vec<Composite> =
        [0.0, 0.03].map(|x| Composite::single(Parabola::new([x, 0.0], 50.0).unwrap()).unwrap()).into();
    let at = |x| Pose { x, y: -1e-3 * distance, phi: angle };
    let path = ClampPath::new(at(0.08), at(-0.09)).unwrap();
    let outcome = Sweep::new(&rod(LENGTH, STIFFNESS), &pieces, path, 2e-5).unwrap().run();
    assert!(outcome.stop.is_none());
    outcome.states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect()
}

static MIDDLE: LazyLock<Vec<Sample>> = LazyLock::new(|| scan(40.0, FRAC_PI_2));

/// The scan with the middle level of noise, seeded.
fn noisy(samples: &[Sample], seed: u64) -> Vec<Sample> {
    let model: NoiseModel = toml::from_str("[ar1]\nforce = 2.5e-3\nm0z = 6e-5\ncorrelation = 0.45").unwrap();
    let mut sensor = model.generator(seed).unwrap();
    samples.iter().map(|s| Sample { reactions: sensor.sample(s.reactions).unwrap(), ..*s }).collect()
}

/// The samples as another sensor would give them.
fn changed(samples: &[Sample], change: impl Fn(Reactions) -> Reactions) -> Vec<Sample> {
    samples.iter().map(|s| Sample { reactions: change(s.reactions), ..*s }).collect()
}

fn check(samples: &[Sample]) -> Plausibility {
    plausibility(&rod(LENGTH, STIFFNESS), samples)
}

fn ratio(check: &Plausibility) -> f64 {
    check.line.expect("there is a line").slope / STIFFNESS
}

#[test]
fn a_clean_scan_gives_the_stiffness_to_rounding() {
    for (distance, angle) in [(40.0, FRAC_PI_2), (60.0, FRAC_PI_2), (40.0, 1.8)] {
        let check = check(&scan(distance, angle));
        let line = check.line.unwrap();
        assert!((line.slope / STIFFNESS - 1.0).abs() < 1e-9, "{line:?}");
        assert!(line.intercept.abs() < 1e-12 && line.share > 0.5, "{line:?}");
        assert!(check.findings.is_empty() && check.fits(), "{check:?}");
    }
}

#[test]
fn noise_leaves_it_within_a_hundredth() {
    for seed in 0..5 {
        let check = check(&noisy(&MIDDLE, seed));
        assert!((ratio(&check) - 1.0).abs() < 1e-2, "{:?}", check.line);
        assert!(check.fits() && check.findings.is_empty(), "{check:?}");
    }
}

#[test]
fn units_are_told_by_powers_of_ten() {
    for (force, moment, power) in [(1.0, 1e3, 6), (1e3, 1.0, -3), (1e3, 1e3, 3), (1.0, 1e2, 4), (1e3, 1e6, 9)] {
        for samples in [MIDDLE.clone(), noisy(&MIDDLE, 7)] {
            let other =
                changed(&samples, |r| Reactions { f0x: force * r.f0x, f0y: force * r.f0y, m0z: moment * r.m0z });
            let check = check(&other);
            assert!((ratio(&check) / 10_f64.powi(power) - 1.0).abs() < 1e-2, "{check:?}");
            let units = |f: &Finding| matches!(f, Finding::Units { power: found, .. } if *found == power);
            assert!(check.findings.iter().any(units) && !check.fits(), "{check:?}");
            assert!(!check.findings.iter().any(|f| matches!(f, Finding::Stiffness { .. } | Finding::Sign)));
        }
    }
}

#[test]
fn loads_instead_of_reactions() {
    for samples in [MIDDLE.clone(), noisy(&MIDDLE, 3)] {
        let check = check(&changed(&samples, |r| Reactions { f0x: -r.f0x, f0y: -r.f0y, m0z: -r.m0z }));
        assert!((ratio(&check) + 1.0).abs() < 1e-2, "{:?}", check.line);
        assert!(check.findings.contains(&Finding::Sign) && !check.fits(), "{check:?}");
    }
}

#[test]
fn a_moment_of_the_other_sign() {
    let check = check(&changed(&MIDDLE, |r| Reactions { m0z: -r.m0z, ..r }));
    assert!((ratio(&check) - 1.0).abs() < 1e-9);
    assert!(check.findings.contains(&Finding::MomentSign) && !check.fits(), "{check:?}");
}

#[test]
fn another_stiffness_is_suggested() {
    for (samples, precision) in [(MIDDLE.clone(), 1e-9), (noisy(&MIDDLE, 5), 1e-2)] {
        for factor in [0.7, 1.3] {
            let check = plausibility(&rod(LENGTH, factor * STIFFNESS), &samples);
            let suggested = check.findings.iter().find_map(|finding| match finding {
                Finding::Stiffness { suggested, .. } => Some(*suggested),
                _ => None,
            });
            assert!((suggested.unwrap() / STIFFNESS - 1.0).abs() < precision, "{check:?}");
            assert!(!check.fits());
        }
        // Somewhat off does not fit either, but is no gross mistake: the errors that samples share are told from such a recording.
        let check = plausibility(&rod(LENGTH, 0.94 * STIFFNESS), &samples);
        assert!(!check.fits() && !check.findings.iter().any(Finding::is_gross), "{check:?}");
        assert!(matches!(check.findings[..], [Finding::Stiffness { .. }]), "{check:?}");
    }
}

#[test]
fn another_length_is_suggested() {
    for length in [0.08, 0.13] {
        let check = plausibility(&rod(length, STIFFNESS), &MIDDLE);
        let suggested = check.findings.iter().find_map(|finding| match finding {
            Finding::Length { suggested, .. } => Some(*suggested),
            _ => None,
        });
        assert!((suggested.unwrap_or_else(|| panic!("{length} {check:?}")) / LENGTH - 1.0).abs() < 1e-2, "{check:?}");
        assert!(!check.fits());
    }
    // In noise the tip's contacts cannot be told from others; that some are beyond the tip can.
    let check = plausibility(&rod(0.8 * LENGTH, STIFFNESS), &noisy(&MIDDLE, 2));
    assert!(
        matches!(check.findings[..], [Finding::Unexplained { shares, tangential: true }] if shares.beyond_tip > 0.3),
        "{check:?}"
    );
    assert!(!check.fits());
}

#[test]
fn forces_that_were_not_tared() {
    let off = 5e-3;
    let check = check(&changed(&MIDDLE, |r| Reactions { f0y: r.f0y + off, ..r }));
    let force = check.findings.iter().find_map(|finding| match finding {
        Finding::Intercept { force, .. } => Some(*force),
        _ => None,
    });
    assert!((ratio(&check) - 1.0).abs() < 1e-6, "{check:?}");
    assert!((force.unwrap() / off - 1.0).abs() < 1e-6, "{check:?}");
}

#[test]
fn moments_that_were_not_tared() {
    for off in [1e-3, -1e-3] {
        let check = check(&changed(&MIDDLE, |r| Reactions { m0z: r.m0z + off, ..r }));
        let moment = check.findings.iter().find_map(|finding| match finding {
            Finding::MomentOffset { moment, .. } => Some(*moment),
            _ => None,
        });
        assert!((moment.unwrap_or_else(|| panic!("{check:?}")) / off - 1.0).abs() < 1e-2, "{check:?}");
    }
}

#[test]
fn degrees_and_millimetres() {
    let mut degrees = MIDDLE.clone();
    degrees.iter_mut().for_each(|s| s.pose.phi = s.pose.phi.to_degrees());
    let angle = check(&degrees);
    assert!(matches!(angle.findings[0], Finding::Angle { largest } if largest == 90.0), "{angle:?}");
    let mut millimetres = MIDDLE.clone();
    millimetres.iter_mut().for_each(|s| (s.pose.x, s.pose.y) = (1e3 * s.pose.x, 1e3 * s.pose.y));
    let way = check(&millimetres);
    assert!(way.findings.iter().any(|f| matches!(f, Finding::Way { lengths } if (1690.0..1710.0).contains(lengths))));
}

#[test]
fn odd_numbers_do_no_harm() {
    for value in [0.0, 1.0, -1e-300, 1e155, 1e308, f64::NAN, f64::INFINITY] {
        for other in [0.0, 1.0, 1e-308, -1e308] {
            for count in [1, 2, 9, 100, 2500] {
                let sample = |k: i32| {
                    let r = Reactions { f0x: other, f0y: value * f64::from(k % 7), m0z: value };
                    Sample::new(Pose { x: f64::from(k), y: other, phi: value }, r)
                };
                let check = check(&(0..count).map(sample).collect::<Vec<_>>());
                let Plausibility { shares, .. } = check;
                let sum = shares.explained + shares.beyond_tip + shares.pulling + shares.no_moment_zero;
                assert!(sum == 0.0 || (sum - 1.0).abs() < 1e-9, "{sum}");
            }
        }
    }
}

#[test]
fn nothing_to_check() {
    let free = changed(&MIDDLE, |_| Reactions::default());
    assert_eq!(check(&free).findings, [Finding::NoContact]);
    assert_eq!(check(&[]).findings, [Finding::NoContact]);
    assert_eq!(
        check(&MIDDLE[..0]),
        check(&[Sample::new(Pose { x: f64::NAN, y: 0.0, phi: 0.0 }, Reactions::default())])
    );
    // The tip alone gives no line.
    let tip: Vec<Sample> = MIDDLE
        .iter()
        .filter(|s| s.reactions.phase_criterion(s.pose.phi, STIFFNESS) < -1e-9)
        .take_while(|s| s.pose.x > 0.0)
        .copied()
        .collect();
    assert!(tip.len() > 300);
    let check = check(&tip);
    assert!(check.line.is_none() && check.findings.contains(&Finding::NoLine), "{check:?}");
    assert!(check.fits(), "nothing speaks against it");
}

/// Such samples panicked: their squares overflow, and no place of the scan could be evaluated.
#[test]
fn numbers_that_overflow_are_refused() {
    use rod_core::{Pose, Reactions, Rod, Sample};
    use rod_reconstruct::{Settings, reconstruct};
    let rod = Rod::new(0.1, 6.3e-4).unwrap();
    for size in [1e140, 1e160, 1e200, 1e300] {
        let sample = |k: u32| {
            let t = f64::from(k);
            let pose = Pose { x: 1e-4 * t, y: 0.0, phi: 1.5 };
            let bent = size * (0.01 * t).sin();
            Sample::new(pose, Reactions { f0x: bent, f0y: 0.5 * bent, m0z: 0.1 * bent + 1e-3 * size })
        };
        let samples: Vec<_> = (0..2000).map(sample).collect();
        // whatever the answer, it is one
        drop(reconstruct(&rod, &samples, &Settings::default()));
        let scaled: Vec<_> = samples
            .iter()
            .map(|sample| Sample { pose: Pose { x: size * sample.pose.x, ..sample.pose }, ..*sample })
            .collect();
        drop(reconstruct(&rod, &scaled, &Settings::default()));
    }
}
