//! From simulated states through counts and the signal chain back to reactions.

use crate::support::{Counts, SimulatedSensor};
use proptest::prelude::*;
use rod_core::{Elastica, Load, Pose, Reactions, Rod, find_root};
use rod_hw::{
    Calibration, ChainError, Channels, ConstantSpeed, Frame, Mounting, OutOfPlane, Quality, Rails, RawSample,
    ReactionSample, Scale, Sense, SensorError, SignalChain, StageError, Tare, Timekeeper, Velocity, Wrench,
    WrenchChain, WrenchSample, WrenchUnits, Zero,
};
use rod_reconstruct::{NoiseModel, noise_estimate};

const QUANTUM: Wrench = Wrench { force: [1e-4; 3], torque: [1e-6; 3] };

/// Counts to N and N m, no better than half a count.
fn calibration() -> impl Calibration + Clone {
    let units = WrenchUnits::parse("N", "N m").unwrap();
    let scale = Scale::from_counts_per_axis(QUANTUM.components().map(|quantum| 1.0 / quantum), units).unwrap();
    move |raw: &RawSample| Ok(WrenchSample { systematic: Some(QUANTUM * 0.5), ..scale.wrench(raw)? })
}

fn counts() -> Counts {
    let counts = Counts::per_axis(QUANTUM.components().map(|quantum| 1.0 / quantum), 24).unwrap();
    assert!((counts.quantum() - QUANTUM).components().iter().all(|c| c.abs() < 1e-18));
    counts
}

fn start() -> Pose {
    Pose { x: 0.08, y: -0.04, phi: 1.571 }
}

fn velocity() -> Velocity {
    Velocity { x: -1e-3, y: 0.0, phi: 0.01 }
}

/// Something smooth: a touch, and the size of what such a rod does.
fn states(count: u32, rate: f64) -> impl Iterator<Item = (f64, Pose, Reactions)> + Clone {
    let mut stage = ConstantSpeed::new(start(), velocity(), 0.0).unwrap();
    (0..count).map(move |i| {
        let t = f64::from(i) / rate;
        let reactions =
            Reactions { f0x: -0.4 * (0.3 * t).sin(), f0y: 0.5 * (0.2 * t).sin().powi(2), m0z: 0.02 * (0.25 * t).sin() };
        (t, rod_hw::StageSource::pose_at(&mut stage, t).unwrap(), reactions)
    })
}

/// All frames with axes along the scene's.
fn aligned() -> Vec<Frame> {
    let all = || ["x", "-x", "y", "-y", "z", "-z"].map(|name| name.parse().unwrap()).into_iter();
    let triples = all().flat_map(|x| all().flat_map(move |y| all().map(move |z| [x, y, z])));
    let frames: Vec<Frame> = triples.filter_map(|axes| Frame::from_axes(axes).ok()).collect();
    assert_eq!(frames.len(), 24);
    frames
}

fn close(found: &ReactionSample, clean: &Reactions) -> bool {
    let Reactions { f0x, f0y, m0z } = found.systematic.unwrap();
    (found.reactions.f0x - clean.f0x).abs() <= f0x + 1e-14
        && (found.reactions.f0y - clean.f0y).abs() <= f0y + 1e-14
        && (found.reactions.m0z - clean.m0z).abs() <= m0z + 1e-14
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    /// What goes in comes out to half a count of each axis, whatever the mounting.
    #[test]
    fn there_and_back(
        angle in -3.2_f64..3.2, axes: Option<prop::sample::Index>, lever in proptest::array::uniform3(-0.05..0.05),
        reaction: bool, turning: bool,
    ) {
        let frame = match axes {
            None => Frame::planar(angle).unwrap(),
            Some(axes) => *axes.get(&aligned()),
        };
        let frame = frame.with_origin(lever).unwrap();
        let mut mounting = Mounting::new(frame).with_sense(if reaction { Sense::Reaction } else { Sense::Load });
        if turning {
            mounting = mounting.turning_with_clamp(1.5).unwrap();
        }
        let sensor = SimulatedSensor::new(states(50, 5.0), Some, mounting, counts());
        let stage = ConstantSpeed::new(start(), velocity(), 0.0).unwrap();
        let mut chain = SignalChain::new(calibration(), WrenchChain::new(stage, mounting)).with_rails(counts().rails());
        let found: Vec<_> = chain.over(sensor).collect::<Result<_, _>>().unwrap();
        prop_assert_eq!(found.len(), 50);
        for (sample, (t, pose, clean)) in found.iter().zip(states(50, 5.0)) {
            prop_assert!(sample.quality.is_empty() && sample.t == t && sample.pose == pose);
            prop_assert!(close(sample, &clean), "{sample:?} {clean:?}");
        }
    }

    /// With aligned axes and no lever arm that is one quantum at most.
    #[test]
    fn within_a_quantum(f0x in -2.0_f64..2.0, f0y in -2.0_f64..2.0, m0z in -0.05_f64..0.05) {
        let clean = Reactions { f0x, f0y, m0z };
        let mounting = Mounting::new(Frame::same());
        let sensor = SimulatedSensor::new(std::iter::once((0.0, start(), clean)), Some, mounting, counts());
        let mut chain = SignalChain::new(calibration(), WrenchChain::new(|_| Ok(start()), mounting));
        let found = chain.over(sensor).next().unwrap().unwrap().reactions;
        prop_assert!((found.f0x - f0x).abs() <= 1e-4 && (found.f0y - f0y).abs() <= 1e-4 && (found.m0z - m0z).abs() <= 1e-6);
    }
}

/// The forces that bend a rod, on the sensor by statics, are the reactions that its elastica has at the clamp.
#[test]
fn the_sensor_agrees_with_the_elastica() {
    let rod = Rod::new(0.1, 6.32e-4).unwrap();
    let pose = Pose { x: 0.03, y: -0.02, phi: 1.3 };
    let loads = [Load { s: 0.06, force: 0.08, alpha: 0.2 }, Load { s: 0.09, force: 0.05, alpha: 0.5 }];
    let bent = |m0z| Elastica::from_clamp(rod.units(), pose, m0z, &loads);
    let free_end = |m0z| Ok(bent(m0z)?.at(0.1).kappa);
    let rod = bent(find_root("moment at the free end", free_end, -0.02, 0.02, 0.0).unwrap().at).unwrap();

    let (lever, angle) = ([0.004, -0.02, 0.01], 0.7);
    let mounting = Mounting::new(Frame::planar(angle).unwrap().with_origin(lever).unwrap());
    let (sin, cos) = f64::sin_cos(angle);
    let into_sensor = |x: f64, y: f64| [cos * x + sin * y, cos * y - sin * x];
    let mut wrench = Wrench { force: [0.0; 3], torque: [0.0; 3] };
    for Load { s, force, alpha } in loads {
        let at = rod.at(s);
        let [fx, fy] = into_sensor(force * alpha.sin(), -force * alpha.cos());
        let [rx, ry] = into_sensor(at.x - pose.x, at.y - pose.y);
        let [x, y, z] = [lever[0] + rx, lever[1] + ry, lever[2]];
        wrench = wrench + Wrench { force: [fx, fy, 0.0], torque: [-z * fy, z * fx, x * fy - y * fx] };
    }
    let found = mounting.reactions(&WrenchSample::new(0.0, wrench), pose);
    let expected = rod.reactions();
    assert!(expected.m0z.abs() > 1e-3 && expected.f0x.abs() > 1e-2 && expected.f0y.abs() > 1e-2);
    assert!((found.reactions.f0x - expected.f0x).abs() < 1e-15);
    assert!((found.reactions.f0y - expected.f0y).abs() < 1e-15);
    assert!((found.reactions.m0z - expected.m0z).abs() < 1e-15, "{} {}", found.reactions.m0z, expected.m0z);
    let OutOfPlane { f0z, m0x, m0y } = found.out_of_plane;
    assert!([f0z, m0x, m0y].iter().all(|c| c.abs() < 1e-15));
}

#[test]
fn nothing_is_allocated_on_the_way_of_a_sample() {
    let stage = ConstantSpeed::new(start(), velocity(), 0.0).unwrap();
    let mounting = Mounting::new(Frame::planar(0.3).unwrap()).turning_with_clamp(1.5).unwrap();
    let mut chain = SignalChain::new(calibration(), WrenchChain::new(stage, mounting))
        .with_rails(counts().rails())
        .with_timekeeper(Timekeeper::counted(None));
    let source = SimulatedSensor::new(states(100, 500.0), Some, mounting, counts());
    let mut handed_on = 0;
    let allocated = allocation_counter::measure(|| {
        handed_on = chain.over(source).map(Result::unwrap).count();
    });
    assert_eq!((allocated.count_total, handed_on), (0, 100));
}

#[test]
fn the_noise_that_goes_in_is_found() {
    let model: NoiseModel =
        NoiseModel { white: Reactions { f0x: 2.5e-3, f0y: 2.0e-3, m0z: 6e-5 }, ..NoiseModel::default() };
    let mut generator = model.generator(7).unwrap();
    let mounting = Mounting::new(Frame::planar(0.4).unwrap().with_origin([0.0, 0.0, 0.03]).unwrap());
    let sensor = SimulatedSensor::new(states(20_000, 500.0), |clean| generator.sample(clean), mounting, counts());
    let stage = ConstantSpeed::new(start(), velocity(), 0.0).unwrap();
    let mut chain = SignalChain::new(calibration(), WrenchChain::new(stage, mounting))
        .with_timekeeper(Timekeeper::counted(Some(2e-3)));
    let found: Vec<_> = chain.over(sensor).collect::<Result<_, _>>().unwrap();
    assert!((chain.timekeeper().period().unwrap() - 2e-3).abs() < 1e-12 && chain.timekeeper().jitter() < 1e-9);
    let t: Vec<f64> = found.iter().map(|sample| sample.t).collect();
    for (name, put_in, of) in [
        ("f0x", model.white.f0x, (|r| r.f0x) as fn(&Reactions) -> f64),
        ("f0y", model.white.f0y, |r| r.f0y),
        ("m0z", model.white.m0z, |r| r.m0z),
    ] {
        let channel: Vec<f64> = found.iter().map(|sample| of(&sample.reactions)).collect();
        let noise = noise_estimate::estimate(&t, &channel);
        println!("{name}: {put_in} in, {} out, long-run {}", noise.sigma, noise.long_run);
        assert!((noise.sigma / put_in - 1.0).abs() < 0.03 && (noise.long_run - 1.0).abs() < 0.2);
    }
}

#[test]
fn lost_samples_and_saturation() {
    let states = (0..40_u32).map(|i| {
        let f0y = if (20..25).contains(&i) { 900.0 } else { 0.1 };
        (2e-3 * f64::from(i), start(), Reactions { f0x: 0.0, f0y, m0z: 0.0 })
    });
    let mut number = 0;
    let noise = |clean: Reactions| {
        number += 1;
        (number % 8 != 0).then_some(clean)
    };
    let mounting = Mounting::new(Frame::same());
    let sensor = SimulatedSensor::new(states, noise, mounting, counts());
    let mut chain =
        SignalChain::new(calibration(), WrenchChain::new(|_| Ok(start()), mounting)).with_rails(counts().rails());
    let found: Vec<_> = chain.over(sensor).collect::<Result<_, _>>().unwrap();
    let with = |quality| found.iter().filter(move |s| s.quality.contains(quality)).map(|s| s.raw.sequence.unwrap());
    assert_eq!(with(Quality::GAP_BEFORE).collect::<Vec<_>>(), [8, 16, 24, 32]);
    assert_eq!(with(Quality::SATURATED).collect::<Vec<_>>(), [20, 21, 22, 24]);
    assert_eq!(found.len(), 35);
}

#[test]
fn a_tare_goes_stale_with_the_device() {
    let mounting = Mounting::new(Frame::same());
    let wrenches = WrenchChain::new(|_| Ok(start()), mounting);
    let mut chain = SignalChain::new(calibration(), wrenches);
    let raw = |t: f64, quality| RawSample {
        quality,
        ..RawSample::new(t, Channels::from([0.0, -3000.0, 0.0, 0.0, 0.0, 50.0]))
    };
    let good = Quality::empty();
    let untared = chain.take(&raw(0.0, good)).unwrap();
    assert!((untared.reactions.f0y - 0.3).abs() < 1e-15 && untared.quality.is_empty());
    let none = Wrench { force: [0.0; 3], torque: [0.0; 3] };
    let unloaded = chain.wrench(&raw(0.1, good)).unwrap();
    let tare = |t: f64| Some(Tare::single(Zero::known(unloaded.wrench, none, t).unwrap()));
    chain.wrenches().set_tare(tare(0.1));
    let tared = chain.take(&raw(0.2, good)).unwrap();
    assert_eq!((tared.reactions, tared.quality), (Reactions { f0x: -0.0, f0y: 0.0, m0z: 0.0 }, good));
    for (t, quality) in [(0.3, Quality::RESTARTED), (0.4, good)] {
        let found = chain.take(&raw(t, quality)).unwrap();
        assert!(found.quality.contains(Quality::TARE_STALE), "{t}");
    }
    chain.wrenches().set_tare(tare(0.4));
    assert_eq!(chain.take(&raw(0.5, good)).unwrap().quality, good);
}

/// The first sample after a restart may be one that goes no further; the next one brings the news.
#[test]
fn a_restart_is_not_lost_with_its_sample() {
    let good = Channels::from([0.0; 6]);
    let zero = Zero::known(Wrench::default(), Wrench::default(), 0.0).unwrap();
    let news = Quality::RESTARTED | Quality::GAP_BEFORE;
    for broken in [
        RawSample::new(1.0, Channels::from([f64::NAN; 6])),
        RawSample::new(1.0, Channels::from([0.0; 3])),
        RawSample::new(f64::NAN, good),
        RawSample::new(1.5, good),
    ] {
        let stage = |t| if t == 1.5 { Err(StageError::NotFinite { t }) } else { Ok(start()) };
        let mut wrenches = WrenchChain::new(stage, Mounting::new(Frame::same()));
        wrenches.set_tare(Some(Tare::single(zero)));
        let mut chain = SignalChain::new(calibration(), wrenches).with_timekeeper(Timekeeper::paced(0.5));
        assert_eq!(chain.take(&RawSample::new(0.5, good)).unwrap().quality, Quality::empty());
        let broken = RawSample { quality: news | Quality::SATURATED, ..broken };
        assert!(chain.take(&broken).is_err(), "{broken:?}");
        let first = chain.take(&RawSample::new(2.0, good)).unwrap();
        assert_eq!((first.t, first.quality), (2.0, news | Quality::TARE_STALE), "{broken:?}");
        assert_eq!(chain.take(&RawSample::new(3.0, good)).unwrap().quality, Quality::TARE_STALE);
    }
    // of wrenches, too
    let mut chain = WrenchChain::new(|_| Ok(start()), Mounting::new(Frame::same()));
    chain.set_tare(Some(Tare::single(zero)));
    let sample = WrenchSample::new(1.0, Wrench::default());
    let broken = Wrench { force: [f64::NAN; 3], torque: [0.0; 3] };
    assert!(chain.take(&WrenchSample { wrench: broken, quality: news, ..sample }).is_err());
    assert_eq!(chain.take(&sample).unwrap().quality, news | Quality::TARE_STALE);
}

#[test]
fn time_that_runs_back_is_refused() {
    let good = Channels::from([0.0; 6]);
    let wrenches = WrenchChain::new(|_| Ok(start()), Mounting::new(Frame::same()));
    let mut chain = SignalChain::new(calibration(), wrenches);
    let times = [1.0, 0.9, 1.0, 1.1].map(|t| chain.take(&RawSample::new(t, good)).map(|sample| sample.t));
    assert_eq!((times[0], times[2], times[3]), (Ok(1.0), Ok(1.0), Ok(1.1)));
    assert_eq!(
        times[1].unwrap_err().to_string(),
        "time: the host's time is 0.9 s after one of 1 s, expected increasing times; sort the recording, or leave the \
         sample out"
    );
    let mut chain = WrenchChain::new(|_| Ok(start()), Mounting::new(Frame::same()));
    let times =
        [1.0, 0.9, 1.1].map(|t| chain.take(&WrenchSample::new(t, Wrench::<f64>::default())).map(|sample| sample.t));
    assert_eq!((times[0], times[2]), (Ok(1.0), Ok(1.1)));
    assert_eq!(
        times[1].unwrap_err().to_string(),
        "the wrench at 0.9 s comes after that at 1 s, expected increasing times; sort the recording, or leave it out"
    );
}

#[test]
fn what_goes_wrong_is_named_and_the_next_sample_is_good() {
    let good = Channels::from([0.0; 6]);
    let source = [
        Ok(RawSample::new(0.0, good)),
        Err(std::io::ErrorKind::TimedOut),
        Ok(RawSample::new(1.0, Channels::from([0.0, 0.0, 0.0, f64::NAN, 0.0, 0.0]))),
        Ok(RawSample::new(2.0, Channels::from([0.0; 3]))),
        Ok(RawSample::new(f64::NAN, good)),
        Ok(RawSample::new(3.0, good)),
        Ok(RawSample::new(99.0, good)),
    ];
    let end = Pose { x: -0.08, ..start() };
    let stage = ConstantSpeed::within(start(), end, 0.0, 10.0).unwrap();
    let mut chain = SignalChain::new(calibration(), WrenchChain::new(stage, Mounting::new(Frame::same())));
    let found: Vec<_> = chain.over(source.into_iter()).collect();
    let messages: Vec<String> = found.iter().filter_map(|item| item.as_ref().err()).map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "timed out",
            "raw values: channel 4 is NaN, expected a finite number",
            "calibration: the sample has 3 channels, expected 6; check the channels of the calibration",
            "time: the host's time is NaN, expected a finite number of seconds",
            "stage: the stage is known from 0 s to 10 s, expected to cover the sample at 99 s; record the stage longer, or \
             shift its clock",
        ]
    );
    assert!(found[0].is_ok() && found[5].is_ok() && matches!(found[1], Err(SensorError::Source(_))));
    assert!(matches!(found[6], Err(SensorError::Chain(ChainError::Stage(StageError::Outside { .. })))));
}

#[test]
fn wrenches_come_without_calibration() {
    let samples =
        [0.0, 1.0, f64::NAN].map(|f| WrenchSample::new(1.0, Wrench { force: [f, 0.0, 0.0], torque: [0.0; 3] }));
    let mut chain = WrenchChain::new(|_| Ok(start()), Mounting::new(Frame::same()).with_sense(Sense::Reaction));
    let found = samples.map(|sample| chain.take(&sample));
    assert_eq!(found[1].unwrap().reactions.f0x, 1.0);
    assert_eq!(
        found[2].unwrap_err().to_string(),
        "the wrench at 1 s is not finite after the sensor, expected finite numbers of N and N m"
    );
}

/// The chain is the same in single precision.
#[test]
fn single_precision() {
    let calibration = |raw: &RawSample| {
        let torque = [0.0, 0.0, raw.channels[0] as f32 * 1e-6];
        Ok(WrenchSample::of(raw, Wrench { force: [0.0; 3], torque }))
    };
    let mounting = Mounting::new(Frame::planar(0.3_f32).unwrap());
    let mut chain = SignalChain::new(calibration, WrenchChain::new(|_| Ok(start()), mounting))
        .with_rails(Rails::of_bits(24, 1).unwrap());
    let found = chain.take(&RawSample::new(0.0, Channels::from([1234.0]))).unwrap();
    assert!((found.reactions.m0z + 1.234e-3).abs() < 1e-9);
    assert_eq!(found.pose.phi, 1.571_f32);
}
