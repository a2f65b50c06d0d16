//! How sure the labels of live scans are, at the noise of the README: 2.5 mN and 0.06 mN m with correlation 0.45, 500 Hz, 1 mm/s.

use crate::common::noise::Noise;
use rod_contact::{ClampPath, Item, Sweep};
use rod_contours::{Composite, Contour, Parabola};
use rod_core::{Pose, Reactions, Rod, Sample};
use rod_reconstruct::{Budget, Known, Label, Live, LiveSession, LiveSettings, Reading, Source, disturb};
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

/// m between samples.
const SPACING: f64 = 2e-6;
/// Samples of the free rod before the scan, from which the noise is estimated.
const FREE: usize = 500;
const SIGMA: [f64; 3] = [2.5e-3, 2.5e-3, 6e-5];
const CORRELATION: f64 = 0.45;
/// Lower ends of the classes of probabilities.
const CLASSES: [f64; 7] = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98];
/// The first class from which on labels are sure.
const SURE: usize = 4;
/// Samples near a second contact in which one is not invented: a quarter of a window.
const NEAR: usize = 250;

struct Scan {
    samples: Vec<Sample>,
    labels: Vec<Label>,
}

fn rod() -> Rod {
    Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap()
}

/// Object 1, 2 or 3 of Merker et al. (2020), clamp 40 mm below its lowest vertex, from x = 80 mm.
fn scan(object: usize, to: f64, spacing: f64) -> Scan {
    let vertices = [[[0.0, 0.0], [0.03, 0.0]], [[0.0, 0.0], [0.03, 0.01]], [[0.0, 0.01], [0.03, 0.0]]][object - 1];
    let pieces = vertices.map(|v| Box::new(Parabola::new(v, 50.0).unwrap()) as Box<dyn Contour>);
    let contour = Composite::joined(pieces.into()).unwrap();
    let pose = |x| Pose { x, y: -0.04, phi: FRAC_PI_2 };
    let path = ClampPath::new(pose(0.08), pose(to)).unwrap();
    let (mut samples, mut labels) = (Vec::new(), Vec::new());
    for item in Sweep::new(&rod(), &contour, path, spacing).unwrap() {
        if let Item::State(state) = item.unwrap() {
            let phase = state.phase();
            samples.push(Sample::new(state.pose, state.reactions));
            labels.push(Label::of(phase.contacts, phase.tip));
        }
    }
    Scan { samples, labels }
}

/// Bias 1 mN and 0.02 mN m, angle 0.5 degrees, stiffness 5 %, gain 1 %, each with a sign of its own.
fn error(source: Source, seed: u64) -> f64 {
    let size = match source {
        Source::BiasF0x | Source::BiasF0y => 1e-3,
        Source::BiasM0z => 2e-5,
        Source::ClampAngle => 0.5_f64.to_radians(),
        Source::Stiffness => 0.05,
        Source::GainF0x | Source::GainF0y | Source::GainM0z => 0.01,
        _ => 0.0,
    };
    if Noise::new(1000 * seed + source as u64, 0.0).uniform() < 0.5 { -size } else { size }
}

/// The rod as it is given, and the samples of a scan with noise and, perhaps, shared errors.
fn recorded(scan: &Scan, seed: u64, shared: bool) -> (Rod, Vec<Sample>) {
    let (rod, mut samples) = if shared {
        disturb(&rod(), &scan.samples, |source| error(source, seed)).unwrap()
    } else {
        (rod(), scan.samples.clone())
    };
    let mut noise: [Noise; 3] = std::array::from_fn(|c| Noise::new(3 * seed + c as u64, CORRELATION));
    for sample in &mut samples {
        let off: [f64; 3] = std::array::from_fn(|c| SIGMA[c] * noise[c].sample());
        let Reactions { f0x, f0y, m0z } = sample.reactions;
        sample.reactions = Reactions { f0x: f0x + off[0], f0y: f0y + off[1], m0z: m0z + off[2] };
    }
    (rod, samples)
}

fn answers((rod, samples): &(Rod, Vec<Sample>), budget: &Budget) -> Vec<Reading> {
    let settings = LiveSettings::of_free_rod(rod, &samples[..FREE], Reactions::default()).unwrap();
    let mut session = LiveSession::with_errors(rod, &settings, budget, &Known::NOTHING).unwrap();
    let mut found = Vec::with_capacity(samples.len());
    for sample in samples {
        session.push((), Some(sample), |(), reading| found.extend(reading));
    }
    session.finish(|(), reading| found.extend(reading));
    found
}

#[derive(Default)]
struct Tally {
    scans: usize,
    /// Scans with samples that are called BB with a probability beyond 0.95 where there is no second contact.
    invented: usize,
    /// Scans whose first contact is not called A.
    wrong_first: usize,
    right: usize,
    counted: usize,
    points: usize,
    /// Of each class of probabilities: labels, right ones, and the sum of the probabilities.
    classes: [(usize, usize, f64); CLASSES.len()],
}

impl Tally {
    fn add(&mut self, scan: &Scan, found: &[Reading]) {
        let labels = &scan.labels;
        assert_eq!(found.len(), labels.len());
        let near = |k: usize, of: &dyn Fn(Label) -> bool| {
            labels[k.saturating_sub(NEAR)..(k + NEAR).min(labels.len())].iter().any(|label| of(*label))
        };
        let sure = |reading: &Reading| reading.probability > 0.95;
        let invents = |k: usize| found[k].label.several() && sure(&found[k]) && !near(k, &Label::several);
        self.scans += 1;
        self.invented += usize::from((0..found.len()).any(invents));
        let first = found.iter().find(|reading| reading.label != Label::Free).map(|reading| reading.label);
        self.wrong_first += usize::from(first != Some(Label::A));
        self.points += found.iter().filter(|reading| reading.touch.is_ok()).count();
        for (k, reading) in found.iter().enumerate() {
            let (right, probability) = (reading.label == labels[k], reading.probability);
            self.counted += 1;
            self.right += usize::from(right);
            let class = CLASSES.iter().rposition(|from| probability >= *from).unwrap_or(0);
            let (count, rights, claimed) = &mut self.classes[class];
            *count += 1;
            *rights += usize::from(right);
            *claimed += probability;
        }
    }

    fn table(&self) -> String {
        let mut text = format!(
            "{} scans: {} invent several contacts with p > 0.95, {} begin with a wrong label; {:.2} % of the labels right, {:.2} % \
             with a point\n\n| p from | labels | mean p | right |\n|---|---|---|---|\n",
            self.scans,
            self.invented,
            self.wrong_first,
            100.0 * self.right as f64 / self.counted as f64,
            100.0 * self.points as f64 / self.counted as f64,
        );
        for (from, (count, right, claimed)) in CLASSES.iter().zip(self.classes) {
            let by = 100.0 / count.max(1) as f64;
            let _ = writeln!(text, "| {from} | {count} | {:.2} % | {:.2} % |", claimed * by, right as f64 * by);
        }
        text
    }
}

#[test]
#[ignore = "measures labels over many scans, for docs/sensors.md"]
fn labels_are_as_sure_as_they_claim() {
    let scans = [1, 2, 3].map(|object| scan(object, -0.09, SPACING));
    for (name, budget, shared) in [
        ("without shared errors", Budget::laboratory(&rod()), false),
        ("with shared errors", Budget::laboratory(&rod()), true),
        ("without shared errors, `--as-is`", Budget::NONE, false),
        ("with shared errors, `--as-is`", Budget::NONE, true),
    ] {
        let mut all = Tally::default();
        for scan in &scans {
            (0..5).for_each(|seed| all.add(scan, &answers(&recorded(scan, seed, shared), &budget)));
        }
        println!("\n{name}\n{}", all.table());
        if !budget.is_none() {
            let (count, right, claimed) = all.classes[SURE..]
                .iter()
                .fold((0, 0, 0.0), |sum, class| (sum.0 + class.0, sum.1 + class.1, sum.2 + class.2));
            let (right, claimed) = (right as f64 / count as f64, claimed / count as f64);
            assert!((right - claimed).abs() < 0.02, "{right} {claimed}");
        }
    }
}

#[test]
fn errors_are_found_while_the_scan_goes_on() {
    // free, A, B at 100 Hz
    let scan = scan(1, 0.035, 1e-5);
    let (rod, samples) = recorded(&scan, 7, true);
    let settings = LiveSettings::of_free_rod(&rod, &samples[..FREE], Reactions::default()).unwrap();
    let budget = Budget::laboratory(&rod);
    let mut session = LiveSession::with_errors(&rod, &settings, &budget, &Known::NOTHING).unwrap();
    let mut found = Vec::new();
    for sample in &samples {
        session.push((), Some(sample), |(), reading| found.extend(reading));
    }
    session.finish(|(), reading| found.extend(reading));
    let right =
        |found: &[Reading]| found.iter().zip(&scan.labels).filter(|(reading, label)| reading.label == **label).count();
    let as_is = answers(&(rod, samples.clone()), &Budget::NONE);
    println!("{} with a budget, {} without, of {}", right(&found), right(&as_is), samples.len());
    assert!(right(&found) as f64 > 0.97 * samples.len() as f64 && right(&as_is) < right(&found));
    assert!(found.iter().all(|reading| (0.0..=1.0).contains(&reading.probability)));
    let calibration = session.calibration().unwrap();
    for source in [Source::BiasF0x, Source::BiasF0y, Source::BiasM0z] {
        let bias = calibration.source(source).unwrap();
        let off = (bias.value - error(source, 7)).abs();
        assert!(bias.sigma < bias.budget && off < 4.0 * bias.sigma, "{bias:?}");
    }
    assert!(calibration.sources.iter().all(|source| !source.is_beyond()));
    let systematic = found.iter().filter_map(|reading| reading.touch.ok()).map(|touch| touch.sigma_systematic());
    assert!(systematic.fold(0.0, f64::max) > 1e-5);
}

#[test]
fn without_errors_labels_and_points_are_those_of_samples_as_they_are() {
    let scan = scan(1, -0.09, SPACING);
    let (rod, samples) = recorded(&scan, 3, false);
    let settings = LiveSettings::of_free_rod(&rod, &samples[..FREE], Reactions::default()).unwrap();
    let mut live = Live::new(&rod, &settings).unwrap();
    let mut direct: Vec<Reading> = samples.iter().filter_map(|sample| live.push(sample)).collect();
    direct.extend(std::iter::from_fn(|| live.finish()));
    let found = answers(&(rod, samples), &Budget::NONE);
    assert_eq!(direct, found);
    // as they were before errors were estimated
    let runs = found.chunk_by(|u, v| u.label == v.label).map(|run| (run[0].label, run.len()));
    use Label::{A, B, BA, BB, Free};
    let expected =
        [(Free, 7687), (B, 625), (A, 8625), (B, 44573), (BB, 3203), (BA, 3678), (B, 10984), (A, 1490), (Free, 4136)];
    assert_eq!(runs.collect::<Vec<_>>(), expected);
    let sum: f64 = found.iter().filter_map(|reading| reading.touch.ok()).map(|touch| touch.x + 2.0 * touch.y).sum();
    assert!((sum - 4150.586213931032).abs() < 1e-6, "{sum:?}");
}
