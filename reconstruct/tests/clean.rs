//! The nine scans of Merker et al. (2020), recorded without noise at 250 Hz and 1 mm/s: which phase, which point.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

use rod_contact::{ClampPath, EventKind, Item, State, Sweep};
use rod_contours::{Composite, Contour, Parabola};
use rod_core::{Pose, Reactions, Rod};
use rod_reconstruct::noise_estimate::ChannelNoise;
use rod_reconstruct::{
    Label, Live, LiveSettings, NoContact, Reading, Reason, Sample, Settings, Unresolved, reconstruct,
};
use std::f64::consts::FRAC_PI_2;

/// Samples this near to a transition may go either way, lengths of the rod.
const EITHER: f64 = 1e-4;
const STEP: f64 = 4e-5;

struct Scan {
    name: String,
    rod: Rod,
    object: Composite,
    states: Vec<State>,
    /// Way of the clamp to each transition that changes the phase.
    transitions: Vec<f64>,
}

impl Scan {
    fn new(number: usize, vertices: [[f64; 2]; 2], q: f64, step: f64) -> Self {
        let pieces = vertices.map(|vertex| Box::new(Parabola::new(vertex, 5.0).unwrap()) as Box<dyn Contour>);
        let object = Composite::joined(Vec::from(pieces)).unwrap();
        let rod = Rod::new(1.0, 1.0).unwrap();
        let clamp = |x| Pose { x, y: -q, phi: FRAC_PI_2 };
        let path = ClampPath::new(clamp(0.8), clamp(-0.9)).unwrap();
        let (mut states, mut transitions) = (Vec::new(), Vec::new());
        for item in Sweep::new(&rod, &object, path, step).unwrap() {
            match item.unwrap() {
                Item::State(state) => states.push(state),
                Item::Event(event) if event.kind != EventKind::Piece => transitions.push(0.8 - event.pose().x),
                Item::Event(_) => {}
            }
        }
        Self { name: format!("O{number}, q = {q}"), rod, object, states, transitions }
    }

    fn of(number: usize, vertices: [[f64; 2]; 2]) -> [Self; 3] {
        [0.2, 0.4, 0.6].map(|q| Self::new(number, vertices, q, STEP))
    }

    fn samples(&self) -> Vec<Sample> {
        self.states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect()
    }

    fn truth(&self, index: usize) -> Label {
        let phase = self.states[index].phase();
        Label::of(phase.contacts, phase.tip)
    }

    fn near_transition(&self, index: usize) -> bool {
        let way = 0.8 - self.states[index].pose.x;
        self.transitions.iter().any(|place| (place - way).abs() <= EITHER)
    }

    /// Every sample is flagged that should be and none that should not, and single contacts are where they are.
    fn judge(&self, readings: &[Reading]) -> Errors {
        assert_eq!(readings.len(), self.states.len());
        let mut errors = Errors::default();
        for (index, reading) in readings.iter().enumerate() {
            let (truth, contacts) = (self.truth(index), &self.states[index].contacts);
            errors.labels += usize::from(reading.label != truth);
            if reading.label.several() != truth.several() {
                errors.flags += 1;
                assert!(self.near_transition(index), "{}: sample {index} is {}, not {truth}", self.name, reading.label);
            }
            if reading.label == truth
                && let Some(second) = reading.second
            {
                // near a transition the fits know little of the rates
                let near = self.near_transition(index);
                errors.several.of += usize::from(!near);
                if let (Ok(first), Ok(second), false) = (reading.touch, second, near) {
                    errors.several.answered += 1;
                    let off = |k: usize, x: f64, y: f64| (x - contacts[k].x).hypot(y - contacts[k].y);
                    errors.several.first = errors.several.first.max(off(0, first.x, first.y));
                    let last = off(contacts.len() - 1, second.x, second.y);
                    if truth == Label::BA {
                        errors.several.tip = errors.several.tip.max(last);
                        errors.several.force = errors.several.force.max((first.force - contacts[0].force).abs());
                    } else if contacts[1].force > 0.1 {
                        errors.several.second = errors.several.second.max(last);
                    }
                }
                continue;
            }
            if reading.label != truth || truth.several() || truth == Label::Free {
                assert!(truth != Label::Free || reading.label != truth || reading.touch == Err(Reason::Free));
                continue;
            }
            let touch = reading.touch.unwrap_or_else(|reason| panic!("{}: sample {index}: {reason}", self.name));
            let off = (touch.x - contacts[0].x).hypot(touch.y - contacts[0].y);
            errors.point = errors.point.max(off);
            errors.contour = errors.contour.max(self.object.closest(touch.x, touch.y).gap.abs());
            assert!((touch.force - contacts[0].force).abs() < 1e-9 * (1.0 + contacts[0].force));
            assert!(reading.probability > 0.5 || self.near_transition(index), "{}: sample {index}", self.name);
        }
        errors
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    labels: usize,
    flags: usize,
    point: f64,
    contour: f64,
    several: Several,
}

/// Of samples with two contacts, how many, how many with both resolved, and the largest errors: of the first contact, of
/// a second at the tip with the force of the first, of a second that is tangential and has a force above 0.1.
#[derive(Clone, Copy, Debug, Default)]
struct Several {
    of: usize,
    answered: usize,
    first: f64,
    tip: f64,
    force: f64,
    second: f64,
}

/// A whole scan at once, and the same sample by sample.
fn check(number: usize, vertices: [[f64; 2]; 2]) {
    for scan in Scan::of(number, vertices) {
        let samples = scan.samples();
        let found = reconstruct(&scan.rod, &samples, &Settings::default()).unwrap();
        let errors = scan.judge(&found.readings);
        println!("{}: {errors:?} of {} samples", scan.name, samples.len());
        // 99.9 % of the labels are asked for, and points within 1e-11
        assert!(errors.labels <= 42 && errors.contour < 1e-11 && errors.point < 1e-9, "{}: {errors:?}", scan.name);

        let Several { of, answered, first, tip, force, second } = errors.several;
        assert!(first < 1e-7 && tip < 1e-6 && force < 1e-6 && second < 1e-5, "{}: {errors:?}", scan.name);
        assert!(answered as f64 > 0.95 * of as f64, "{}: {errors:?}", scan.name);

        let noise = [ChannelNoise::white(1e-13); 3];
        let settings = LiveSettings { half_window: 100.0 * STEP, ..LiveSettings::new(noise, STEP) };
        let mut live = Live::new(&scan.rod, &settings).unwrap();
        let mut readings: Vec<Reading> = Vec::new();
        for (index, sample) in samples.iter().enumerate() {
            readings.extend(live.push(sample));
            assert_eq!(readings.len(), (index + 1).saturating_sub(live.delay()), "each answer comes when it is due");
        }
        readings.extend(std::iter::from_fn(|| live.finish()));
        let errors = scan.judge(&readings);
        println!("{}, live: {errors:?}, {} samples late", scan.name, live.delay());
        assert!(errors.labels <= 42 && errors.contour < 1e-11, "{}, live: {errors:?}", scan.name);
    }
}

#[test]
fn object_1() {
    check(1, [[0.0, 0.0], [0.3, 0.0]]);
}

#[test]
fn object_2() {
    check(2, [[0.0, 0.0], [0.3, 0.1]]);
}

#[test]
fn object_3() {
    check(3, [[0.0, 0.1], [0.3, 0.0]]);
}

/// Five and 25 times as far apart, 6 to 60 samples of a contact phase: the same, only the points are less exact.
#[test]
fn coarse_recordings() {
    for (number, vertices, q) in
        [(1, [[0.0, 0.0], [0.3, 0.0]], 0.2), (1, [[0.0, 0.0], [0.3, 0.0]], 0.4), (3, [[0.0, 0.1], [0.3, 0.0]], 0.6)]
    {
        for step in [2e-4, 1e-3] {
            let scan = Scan::new(number, vertices, q, step);
            let found = reconstruct(&scan.rod, &scan.samples(), &Settings::default()).unwrap();
            let (mut labels, mut gap, mut forceless): (usize, f64, usize) = (0, 0.0, 0);
            for (index, reading) in found.readings.iter().enumerate() {
                labels += usize::from(reading.label != scan.truth(index));
                let touches = [Some(reading.touch), reading.second].into_iter().flatten();
                // where the rod meets the object there may be a contact without a force
                let none =
                    |touch: &Result<_, Reason>| matches!(touch, Err(Reason::Free | Reason::NoContact(NoContact::Free)));
                for touch in touches.filter(|touch| !none(touch)) {
                    // nor where one of two contacts begins or ends
                    let vanishes = |why| matches!(why, Unresolved::ForceVanishes | Unresolved::FirstForceVanishes);
                    if matches!(touch, Err(Reason::Several(why)) if vanishes(why)) {
                        forceless += 1;
                        continue;
                    }
                    let touch =
                        touch.unwrap_or_else(|reason| panic!("{}, {step}: sample {index}: {reason}", scan.name));
                    gap = gap.max(scan.object.closest(touch.x, touch.y).gap.abs());
                }
            }
            println!(
                "{} every {step}: {labels} labels of {}, points within {gap:.0e}",
                scan.name,
                found.readings.len()
            );
            assert!(
                labels <= 2 && gap < 0.21 * step && forceless <= 2,
                "{} {step}: {labels} {gap} {forceless}",
                scan.name
            );
        }
    }
}

/// The same scan in other units, and seen in a mirror: the same labels, points to match.
#[test]
fn units_and_mirrors_do_not_matter() {
    let scan = Scan::new(1, [[0.0, 0.0], [0.3, 0.0]], 0.4, 2e-4);
    let samples = scan.samples();
    let found = reconstruct(&scan.rod, &samples, &Settings::default()).unwrap();
    for (length, stiffness, mirror) in [(0.1, 6.32e-4, 1.0), (100.0, 632.0, 1.0), (1.0, 1.0, -1.0)] {
        let rod = Rod::new(length, stiffness).unwrap();
        let (force, moment) = (stiffness / (length * length), stiffness / length);
        let other = samples.iter().map(|sample| {
            let (pose, felt) = (sample.pose, sample.reactions);
            // x to -x: angles from pi, moments the other way
            let phi = if mirror < 0.0 { std::f64::consts::PI - pose.phi } else { pose.phi };
            let pose = Pose { x: mirror * pose.x * length, y: pose.y * length, phi };
            let felt =
                Reactions { f0x: mirror * felt.f0x * force, f0y: felt.f0y * force, m0z: mirror * felt.m0z * moment };
            Sample::new(pose, felt)
        });
        let other = reconstruct(&rod, &other.collect::<Vec<_>>(), &Settings::default()).unwrap();
        assert_eq!(other.runs, found.runs, "{length} {stiffness} {mirror}");
        assert_eq!(other.kinks.len(), found.kinks.len());
        for (ours, theirs) in found.readings.iter().zip(&other.readings) {
            assert_eq!(ours.touch.is_ok(), theirs.touch.is_ok());
            if let (Ok(ours), Ok(theirs)) = (ours.touch, theirs.touch) {
                let off = (mirror * theirs.x / length - ours.x).hypot(theirs.y / length - ours.y);
                assert!(off < 1e-7, "{length} {mirror}: {off}");
            }
        }
    }
}
