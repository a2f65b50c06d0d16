//! Windows without load and the zeros of them.

use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rod_hw::*;

/// Noise of standard deviation 1 whose neighbours are correlated by `rho`.
fn coloured(rho: f64, seed: u64) -> impl Iterator<Item = f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = move || -> f64 { StandardNormal.sample(&mut generator) };
    let mut state = normal();
    std::iter::from_fn(move || {
        let now = state;
        state = rho * state + (1.0 - rho * rho).sqrt() * normal();
        Some(now)
    })
}

fn all(value: f64) -> Wrench {
    Wrench::from_components([value; 6])
}

/// Of a component Fy at 1 kHz; the others are free of noise.
fn samples(values: impl Iterator<Item = f64>) -> impl Iterator<Item = WrenchSample> {
    let of = |value| Wrench { force: [0.0, value, 0.0], torque: [0.0; 3] };
    (0_u32..).zip(values).map(move |(i, value)| WrenchSample::new(1e-3 * f64::from(i), of(value)))
}

fn zero(limits: TareLimits, values: impl Iterator<Item = f64>) -> Result<Zero, TareError> {
    let mut window = TareWindow::new(limits);
    samples(values).for_each(|sample| {
        let _ = window.push(&sample);
    });
    window.finish()
}

fn limits(change: f64) -> TareLimits {
    TareLimits::new(0.1, all(change)).unwrap()
}

/// Over many windows, the zeros scatter as their standard deviations say, in white noise and in noise that is not, where
/// sigma / sqrt(n) would be far off: by (1 + rho) / (1 - rho) in the variance.
#[test]
fn sigma_is_how_zeros_scatter() {
    for (rho, count, white) in [(0.0, 500, 1.0), (0.46, 500, 2.7), (0.9, 4000, 19.0), (-0.4, 500, 0.43)] {
        let (mut scatter, mut said) = (0.0, 0.0);
        for seed in 0..2000 {
            let zero = zero(limits(10.0), coloured(rho, seed).take(count)).unwrap();
            scatter += zero.wrench().force[1].powi(2) / 2000.0;
            said += zero.sigma().force[1].powi(2) / 2000.0;
        }
        println!(
            "AR(1) of {rho}: variance of zeros times n {:.3} (theory {white}), said {:.3}",
            scatter * count as f64,
            said * count as f64
        );
        assert!((scatter * count as f64 / white - 1.0).abs() < 0.1);
        assert!((said / scatter - 1.0).abs() < 0.15, "{rho}: {said} {scatter}");
    }
}

/// Of windows of noise alone few are refused, even where the limit is hardly more than the standard deviation of the zero.
#[test]
fn noise_is_no_load() {
    for rho in [0.0, 0.46, 0.9] {
        let count = if rho > 0.5 { 4000 } else { 500 };
        let sigma = ((1.0 + rho) / (1.0 - rho) / f64::from(count)).sqrt();
        let refused = |seed| zero(limits(1.5 * sigma), coloured(rho, seed).take(count as usize)).is_err();
        let share = (0..2000).filter(|&seed| refused(seed)).count();
        println!("AR(1) of {rho}: {share} of 2000 windows of noise refused");
        assert!(share <= 20, "{rho}: {share}");
    }
}

/// Drift, step and touch, each of 30 standard deviations of the zero: seen in 97 of 100 windows, nearly always by name.
#[test]
fn what_is_no_rest_is_seen() {
    let count = 1000;
    let large = 30.0 * (2.7 / f64::from(count)).sqrt();
    let with = |shape: fn(f64) -> f64, seed| {
        let shape = (0..count).map(move |i| large * shape(f64::from(i) / f64::from(count)));
        zero(limits(0.25 * large), coloured(0.46, seed).zip(shape).map(|(noise, signal)| noise + signal))
    };
    let step = |x: f64| if x < 0.3 { 0.0 } else { 1.0 };
    let touch = |x: f64| if (0.4..0.55).contains(&x) { 1.0 } else { 0.0 };
    let counted = |shape, named: fn(&TareError) -> bool| {
        let errors: Vec<TareError> = (0..200).filter_map(|seed| with(shape, seed).err()).collect();
        (errors.len(), errors.iter().filter(|error| named(error)).count())
    };
    let drifts = counted(|x| x, |error| matches!(error, TareError::Drift { component: Component::Fy, .. }));
    let steps = counted(step, |error| matches!(error, TareError::Change { component: Component::Fy, .. }));
    let touches = counted(touch, |error| matches!(error, TareError::Change { component: Component::Fy, .. }));
    println!("of 200 windows seen, and by name: drifts {drifts:?}, steps {steps:?}, touches {touches:?}");
    assert!([drifts, steps, touches].iter().all(|(seen, named)| *seen >= 194 && *named >= 190));
}

#[test]
fn messages_say_what_where_and_what_to_do() {
    let message = |limits, values: Vec<f64>| zero(limits, values.into_iter()).unwrap_err().to_string();
    let noise = |count| coloured(0.0, 1).take(count).map(|v| 1e-3 * v);
    let ramp = noise(1000).zip(0..).map(|(v, i)| v + 2e-5 * f64::from(i)).collect();
    let error = message(limits(5e-3), ramp);
    assert!(error.starts_with("Fy drifts by 2.0") && error.contains("over the 1.000 s of the tare window"), "{error}");
    assert!(
        error.ends_with(
            "N over the 1.000 s of the tare window, expected at most 5.0e-3; let the sensor warm up, or unload it fully"
        ),
        "{error}"
    );
    let touched = noise(1000).zip(0..).map(|(v, i)| v + if i > 700 { 0.02 } else { 0.0 }).collect();
    let error = message(limits(5e-3), touched);
    assert!(error.starts_with("Fy changes by 1.99") && error.contains("N about 0.7"), "{error}");
    assert_eq!(
        message(limits(1e-3), noise(40).collect()),
        "the tare window lasts 0.040 s, expected 0.1 s or more; let it run longer before the rod touches"
    );
    assert_eq!(
        message(limits(1.0), noise(31).collect()),
        "the tare window has 31 samples, expected 32 or more; let it run longer"
    );
    assert!(message(limits(1e-6), noise(200).collect()).starts_with("the zero of Fy has a standard deviation of "));
    for value in [0.0, -1.0, f64::NAN] {
        assert!(matches!(TareLimits::new(value, all(1.0)), Err(TareError::Number { .. })));
        assert!(matches!(TareLimits::new(1.0, all(value)), Err(TareError::Number { .. })));
    }
}

#[test]
fn a_sample_that_is_not_usable_spoils_the_window() {
    let good: Vec<WrenchSample> = samples(std::iter::repeat_n(0.0, 200)).collect();
    let with = |change: fn(&mut WrenchSample)| {
        let (mut samples, mut window) = (good.clone(), TareWindow::new(limits(1.0)));
        change(&mut samples[100]);
        let first = samples.iter().find_map(|sample| window.push(sample).err());
        let message = |error: Option<TareError>| error.map(|error| error.to_string());
        assert_eq!(message(window.finish().err()), message(first));
        message(first).unwrap_or_default()
    };
    assert!(
        with(|s| s.quality = Quality::SATURATED)
            .starts_with("the sample at 0.1 s in the tare window is flagged saturated")
    );
    assert!(with(|s| s.quality = Quality::RESTARTED).starts_with("the device restarted at 0.1 s"));
    assert!(with(|s| s.wrench.torque[2] = f64::INFINITY).starts_with("Tz at 0.1 s is inf, expected a finite number"));
    assert!(with(|s| s.t = 0.099).starts_with("a sample at 0.099 s comes after one at 0.099 s"));
    assert!(with(|s| s.t = f64::NAN).starts_with("a sample at NaN s"));
    assert_eq!(with(|s| s.quality = Quality::GAP_BEFORE | Quality::DEVICE_WARNING), "");
    // the first sample of a run may be the first one of the window
    let mut window = TareWindow::new(limits(1.0));
    for (i, sample) in good.iter().enumerate() {
        let quality = if i == 0 { Quality::RESTARTED } else { Quality::empty() };
        window.push(&WrenchSample { quality, ..*sample }).unwrap();
    }
    assert!(window.finish().is_ok());
    // numbers whose sums are none
    let mut window = TareWindow::new(TareLimits::new(0.1, all(f64::INFINITY)).unwrap());
    for sample in &good {
        let sign = if sample.t < 0.1 { 1.0 } else { -1.0 };
        window.push(&WrenchSample { wrench: all(sign * f64::MAX), ..*sample }).unwrap();
    }
    assert!(matches!(window.finish(), Err(TareError::Number { .. })), "{:?}", window.finish());
}

#[test]
fn a_restart_makes_it_stale() {
    let mut window = TareWindow::new(limits(1.0));
    for sample in samples(std::iter::repeat_n(0.5, 200)) {
        window.push(&sample).unwrap();
    }
    let mut tare = Tare::single(window.finish().unwrap());
    // a recording is tared from its beginning: the start of the run that the zero is of is none anew
    let mut start = WrenchSample::new(0.0, all(0.0));
    start.quality = Quality::RESTARTED;
    assert_eq!(tare.apply(&start).quality, Quality::RESTARTED);
    assert_eq!(tare.apply(&WrenchSample::new(0.3, all(0.0))).quality, Quality::empty());
    // the device's clock begins anew, too; the host's does not
    let mut again = WrenchSample::new(0.0, all(0.0));
    (again.raw.host_time, again.quality) = (0.4, Quality::RESTARTED);
    assert_eq!(tare.apply(&again).quality, Quality::RESTARTED | Quality::TARE_STALE);
    let later = WrenchSample::new(0.1, all(0.0));
    assert_eq!(tare.apply(&later).quality, Quality::TARE_STALE);
}

#[test]
fn bounds_grow_by_the_zeros_own() {
    let zero = Zero::known(all(0.0), all(0.2), 0.0).unwrap();
    let mut sample = WrenchSample::new(5.5, all(1.0));
    (sample.systematic, sample.sigma) = (Some(all(0.1)), Some(all(0.3)));
    let tared = Tare::single(zero).apply(&sample);
    assert!((tared.systematic.unwrap().force[0] - 0.7).abs() < 1e-15 && tared.sigma == sample.sigma);
    sample.systematic = None;
    assert_eq!(Tare::single(zero).apply(&sample).systematic, None);
    for (wrench, sigma, at) in [(f64::NAN, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, f64::INFINITY)] {
        assert!(matches!(Zero::known(all(wrench), all(sigma), at), Err(TareError::Number { .. })));
    }
}

proptest! {
    /// The tare of a window that is tared is none.
    #[test]
    fn twice_tared_is_once_tared(values in proptest::collection::vec(-1.0..1.0_f64, 32..300), offset in -100.0..100.0_f64) {
        let limits = TareLimits::new(1e-3, all(f64::INFINITY)).unwrap();
        let samples: Vec<_> = samples(values.into_iter().map(|v| v + offset)).collect();
        let of = |samples: &[WrenchSample]| {
            let mut window = TareWindow::new(limits);
            samples.iter().for_each(|sample| window.push(sample).unwrap());
            window.finish().unwrap()
        };
        let zero = of(&samples);
        let mut tare = Tare::single(zero);
        let tared: Vec<_> = samples.iter().map(|sample| tare.apply(sample)).collect();
        let again = of(&tared);
        prop_assert!(again.wrench().force[1].abs() < 1e-12, "{}", again.wrench().force[1]);
        prop_assert!((again.sigma().force[1] - zero.sigma().force[1]).abs() < 1e-12);
    }
}
