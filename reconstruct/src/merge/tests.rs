#![allow(clippy::print_stdout, reason = "the errors that are measured are there to be read")]

use super::*;
use crate::numeric::seeded::Random;
use crate::{Assembly, ContourEstimate, GapReason, Label, Measured, Touch, Trace, TraceKind, TracePoint, single};
use nalgebra::{Matrix2, Matrix3, Vector3};
use proptest::prelude::*;
use rod_contact::{ClampPath, State, Sweep};
use rod_contours::{Composite, Contour, Parabola};
use rod_core::{Pose, Reactions, Rod};
use std::f64::consts::{FRAC_PI_2, PI};

const NOTCH: [f64; 2] = [0.015, 0.01125];

fn rod() -> Rod {
    Rod::from_diameter(0.1, 0.5e-3, 206e9).unwrap()
}

/// Object O1 of Merker et al. (2020).
fn object() -> Composite {
    let parabola = |x: f64| Box::new(Parabola::new([x, 0.0], 50.0).unwrap()) as Box<dyn Contour>;
    Composite::joined(vec![parabola(0.0), parabola(0.03)]).unwrap()
}

fn states(q: f64, step: f64) -> Vec<State> {
    swept(&object(), q, step)
}

fn swept(object: &Composite, q: f64, step: f64) -> Vec<State> {
    let clamp = |x| Pose { x, y: -q, phi: FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.1), clamp(-0.1)).unwrap();
    let outcome = Sweep::new(&rod(), object, path, step).unwrap().run();
    assert!(outcome.stop.is_none(), "{:?}", outcome.stop);
    outcome.states
}

/// The states' labels and contacts, with noise of the position.
fn exact(states: &[State], sigma: f64, seed: u64) -> Vec<(Label, Vec<Touch>)> {
    let mut random = Random::new(seed);
    let touches = |state: &State| {
        let phase = state.phase();
        let touch = |c: &rod_contact::Contact| Touch {
            s: c.s,
            x: c.x + sigma * random.normal(),
            y: c.y + sigma * random.normal(),
            alpha: c.alpha + 10.0 * sigma / (c.force / 0.1).max(0.05) * random.normal(),
            force: c.force,
            covariance: Matrix2::identity() * sigma * sigma,
            systematic: Matrix2::zeros(),
        };
        (Label::of(phase.contacts, phase.tip), state.contacts.iter().map(touch).collect())
    };
    states.iter().map(touches).collect()
}

fn assembled(samples: &[(Label, Vec<Touch>)], assembly: Assembly) -> ContourEstimate {
    assembly.assemble(samples.iter().map(|(label, touches)| Measured::new(*label, touches)))
}

/// All samples as if each had one contact, from reactions with white noise (force N, moment N m).
fn naive(states: &[State], noise: (f64, f64), seed: u64) -> Vec<(Label, Vec<Touch>)> {
    let mut random = Random::new(seed);
    let sigmas = Vector3::new(noise.0, noise.0, noise.1);
    let point = |state: &State| {
        let r = state.reactions;
        let noisy = Vector3::new(r.f0x, r.f0y, r.m0z) + sigmas.map(|sigma| sigma * random.normal());
        // Where the noise is not small beside the force its effect on the point is not linear, nor zero in the mean.
        if r.f0x.hypot(r.f0y) <= 40.0 * noise.0 {
            return (Label::Free, Vec::new());
        }
        let reactions = Reactions { f0x: noisy.x, f0y: noisy.y, m0z: noisy.z };
        let variances = Matrix3::from_diagonal(&sigmas.map(|sigma| sigma * sigma));
        let touch = single(&rod(), state.pose, reactions, &variances).map_or_else(|none| none.touch(), Some);
        (Label::B, touch.into_iter().collect())
    };
    states.iter().map(point).collect()
}

fn worst_of(contour: &ContourEstimate, kind: TraceKind) -> (f64, f64) {
    let object = object();
    let mut gaps: Vec<f64> =
        contour.of_kind(kind).flat_map(|trace| &trace.points).map(|p| object.gap(p.x, p.y).abs()).collect();
    gaps.sort_by(f64::total_cmp);
    (gaps[gaps.len() / 2], gaps[gaps.len() - 1])
}

#[test]
fn the_merged_contour_of_three_distances_is_that_of_the_object() {
    for (sigma, median, worst) in [(0.0, 1e-9, 1e-7), (3e-4, 3e-5, 3e-4)] {
        let scans: Vec<_> = [0.02, 0.04, 0.06]
            .into_iter()
            .zip(0..)
            .map(|(q, seed)| assembled(&exact(&states(q, 2e-5), sigma, seed), Assembly::default()))
            .collect();
        for scan in &scans {
            let several: Vec<_> = scan.gaps.iter().filter(|gap| gap.reason == GapReason::Several).collect();
            assert!(!several.is_empty() && several.iter().all(|gap| gap.from.is_some() && gap.to.is_some()));
            assert!(scan.of_kind(TraceKind::First).count() > 0 && scan.of_kind(TraceKind::Second).count() > 0);
        }
        let merged = merge(&scans);
        let others: Vec<_> = [1, 2, 0].map(|k: usize| scans[k].clone()).into();
        assert_eq!(merged, merge(&others));
        let errors = worst_of(&merged, TraceKind::Single);
        let notch = |scan: &ContourEstimate| {
            let points = scan.of_kind(TraceKind::Single).flat_map(|trace| &trace.points);
            points.map(|p| (p.x - NOTCH[0]).hypot(p.y - NOTCH[1])).fold(f64::INFINITY, f64::min)
        };
        println!("sigma {sigma}: {} traces, {} gaps, error {errors:?}", merged.traces.len(), merged.gaps.len());
        for scan in scans.iter().chain([&merged]) {
            println!("  comes within {:.2} mm of the notch", notch(scan) * 1e3);
        }
        assert!(errors.0 < median && errors.1 < worst);
        // The two sides of the notch, and a gap between them.
        assert_eq!(merged.of_kind(TraceKind::Single).count(), 2);
        assert_eq!(merged.gaps.len(), 1);
        let (from, to) = (merged.gaps[0].from.unwrap(), merged.gaps[0].to.unwrap());
        assert!(from[0] < NOTCH[0] && NOTCH[0] < to[0], "{from:?} {to:?}");
        // As deep as the scan that came deepest.
        let deepest = scans.iter().map(&notch).fold(f64::INFINITY, f64::min);
        assert!((notch(&merged) - deepest).abs() < 2.0 * sigma + 1e-9);
        assert!(Comparison::default().disagreements(&scans).is_empty());
        for kind in [TraceKind::First, TraceKind::Second] {
            assert!(worst_of(&merged, kind).0 < median.max(1e-7));
        }
    }
}

#[test]
fn edges_and_vertices_are_one_trace() {
    let corners = [[-0.1, 0.17], [-0.015, 0.0], [0.01, 0.0], [0.02, 0.005], [0.08, 0.125]];
    let polygon = Composite::polyline(&corners).unwrap();
    let states = swept(&polygon, 0.04, 2e-5);
    for (sigma, within) in [(0.0, 1e-9), (2e-4, 6e-5)] {
        let scan = assembled(&exact(&states, sigma, 1), Assembly::default());
        let traces: Vec<&Trace> = scan.of_kind(TraceKind::Single).collect();
        assert_eq!((traces.len(), scan.gaps.len()), (1, 2));
        assert!(scan.gaps.iter().all(|gap| gap.reason == GapReason::Free));
        let points = &traces[0].points;
        let worst = points.iter().map(|p| polygon.gap(p.x, p.y).abs()).fold(0.0, f64::max);
        println!("sigma {sigma}: {} points, off by {:.2} um at most", points.len(), worst * 1e6);
        assert!(worst < within);
        let found = Composite::polyline(&points.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>()).unwrap();
        for [x, y] in &corners[1..4] {
            assert!(found.gap(*x, *y).abs() < within, "{x} {y}");
        }
    }
}

#[test]
fn naive_points_disagree_where_the_object_is_concave() {
    let clean = (0.0, 0.0);
    for noise in [clean, (2.5e-3, 6e-5)] {
        let scans: Vec<_> = [0.02, 0.04, 0.06]
            .into_iter()
            .zip(0..)
            .map(|(q, seed)| assembled(&naive(&states(q, 2e-5), noise, seed), Assembly::naive()))
            .collect();
        let concave = Comparison::default().disagreements(&scans);
        println!("noise {noise:?}");
        for found in &concave {
            let Disagreement { from, to, gap, .. } = found;
            println!(
                "  {:.2} to {:.2} mm, by {:.2} mm, {:.0} sigma",
                from * 1e3,
                to * 1e3,
                gap * 1e3,
                found.significance()
            );
        }
        // Between the vertices of the two parabolas, and about the notch.
        let covered: f64 = concave.iter().map(|found| found.to - found.from).sum();
        assert!(covered > 8e-3, "{covered}");
        assert!(concave.iter().all(|found| found.from > 0.0 && found.to < 0.03));
        assert!(concave.iter().any(|found| found.gap > 1e-3));
    }
}

#[test]
fn offsets_of_scans_are_found_where_naive_points_disagree_too() {
    for (noise, within) in [((0.0, 0.0), 1e-5), ((2.5e-3, 6e-5), 1e-4)] {
        let moved = [0.0, 3e-3, -2e-3];
        let scans: Vec<_> = [0.02, 0.04, 0.06]
            .into_iter()
            .zip(moved)
            .map(|(q, value)| {
                let scan = assembled(&naive(&states(q, 2e-5), noise, 7), Assembly::naive());
                Offset { value, group: 0 }.applied(&scan, FRAC_PI_2)
            })
            .collect();
        let offsets = align(&scans, FRAC_PI_2);
        for (k, offset) in offsets.iter().enumerate() {
            let error = offset.value - offsets[0].value + moved[k];
            println!("{noise:?}: offset of scan {k} off by {:.2} um", error * 1e6);
            assert!(error.abs() < within && offset.group == 0);
        }
        assert!(offsets.iter().map(|offset| offset.value).sum::<f64>().abs() < 1e-12);
        // Whichever comes first.
        let turned: Vec<_> = scans.iter().rev().cloned().collect();
        for (a, b) in align(&turned, FRAC_PI_2).iter().rev().zip(&offsets) {
            assert!((a.value - b.value).abs() < 1e-9);
        }
    }
}

/// A trace of the parabola between two places, as a scan with an error of its own would give it.
fn part(from: f64, to: f64, error: f64, sigma: f64) -> ContourEstimate {
    let count = 2 + ((to - from).abs() / 3e-4) as i32;
    let points = (0..=count).map(|k| from + (to - from) * f64::from(k) / f64::from(count)).map(|x| {
        let alpha = (100.0 * x).atan();
        TracePoint { x: x - error * alpha.sin(), y: 50.0 * x * x + error * alpha.cos(), alpha, sigma, systematic: 0.0 }
    });
    let trace = Trace { kind: TraceKind::Single, samples: 0..9, reversed: false, points: points.collect() };
    ContourEstimate { traces: vec![trace], gaps: Vec::new() }
}

#[test]
fn scans_apart_stay_apart() {
    let scans = [part(-0.02, -0.01, 0.0, 1e-5), part(0.0, 0.02, 0.0, 1e-5)];
    assert_eq!(merge(&scans).traces.len(), 2);
    let offsets = align(&scans, FRAC_PI_2);
    assert_eq!(offsets, [Offset { value: 0.0, group: 0 }, Offset { value: 0.0, group: 1 }]);
    assert!(Comparison::default().disagreements(&scans).is_empty());
}

#[test]
fn nothing_and_points_that_are_none() {
    assert_eq!(merge(&[]), ContourEstimate::default());
    assert_eq!(align(&[], 0.0), []);
    assert_eq!(Comparison::default().disagreements(&[]), []);
    for bad in [f64::NAN, f64::INFINITY, 1e300, 0.0] {
        let mut scans = [part(-0.02, 0.01, 0.0, 1e-5), part(-0.01, 0.02, 0.0, 0.0), ContourEstimate::default()];
        for (k, point) in scans[0].traces[0].points.iter_mut().enumerate().step_by(7) {
            match k % 4 {
                0 => point.x = bad,
                1 => point.y = bad,
                2 => point.alpha = bad,
                _ => point.sigma = bad,
            }
        }
        assert!(!merge(&scans).traces.is_empty());
        assert_eq!(align(&scans, FRAC_PI_2).len(), 3);
        let _ = Comparison::default().disagreements(&scans);
    }
}

proptest! {
    #[test]
    fn the_order_of_scans_does_not_matter(
        parts in prop::collection::vec((-0.03..0.03_f64, 0.002..0.03_f64, -2.0..2.0_f64, 1e-6..3e-5_f64), 1..7),
        order in any::<prop::sample::Index>(),
        turned in any::<bool>(),
    ) {
        let scans: Vec<_> =
            parts.iter().map(|&(from, length, error, sigma)| part(from, from + length, error * sigma, sigma)).collect();
        let mut others = scans.clone();
        others.rotate_left(order.index(scans.len()));
        if turned {
            others.reverse();
        }
        let merged = merge(&scans);
        prop_assert_eq!(&merged, &merge(&others));
        let comparison = Comparison { direction: 0.3, significance: 2.0, least: 0.0 };
        prop_assert_eq!(comparison.disagreements(&scans), comparison.disagreements(&others));
        // Nothing is lost, and no error grows.
        let truth = Composite::single(Parabola::new([0.0, 0.0], 50.0).unwrap()).unwrap();
        let most = parts.iter().map(|&(_, _, error, sigma)| (error * sigma).abs()).fold(0.0, f64::max);
        for point in merged.traces.iter().flat_map(|trace| &trace.points) {
            prop_assert!(truth.gap(point.x, point.y).abs() < most + 2e-6);
            prop_assert!(point.alpha.abs() <= PI);
        }
        let ends = |contours: &[ContourEstimate]| {
            let xs = contours.iter().flat_map(|c| &c.traces).flat_map(|t| &t.points).map(|p| p.x);
            xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
        };
        let (of_all, of_merged) = (ends(&scans), ends(std::slice::from_ref(&merged)));
        prop_assert!((of_all.0 - of_merged.0).abs() < 2e-4 && (of_all.1 - of_merged.1).abs() < 2e-4);
    }
}

#[test]
fn noise_of_the_reactions_is_averaged_out_and_stated() {
    for (q, within) in [(0.02, 2e-5), (0.04, 4e-5), (0.06, 1e-4)] {
        let states = states(q, 1e-5);
        let mut samples = naive(&states, (2.5e-3, 6e-5), 3);
        for (sample, state) in samples.iter_mut().zip(&states) {
            let phase = state.phase();
            if phase.contacts > 1 {
                *sample = (Label::of(phase.contacts, phase.tip), Vec::new());
            }
        }
        let scan = assembled(&samples, Assembly::default());
        assert_eq!((scan.traces.len(), scan.gaps.len()), (2, 3));
        let object = object();
        for trace in &scan.traces {
            let errors = trace.points.iter().map(|p| (object.gap(p.x, p.y).abs(), p.sigma));
            let (mut errors, ratios): (Vec<f64>, Vec<f64>) =
                errors.map(|(error, sigma)| (error, error / sigma)).unzip();
            let ratio = (ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / ratios.len() as f64).sqrt();
            errors.sort_by(f64::total_cmp);
            let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
            let ends = [(trace.entered(), trace.samples.start), (trace.left(), trace.samples.end - 1)];
            let off = ends.map(|(end, k)| {
                let (end, contact) = (end.unwrap(), &states[k].contacts[0]);
                (end[0] - contact.x).hypot(end[1] - contact.y)
            });
            println!(
                "q {q}, {:.1} mm: median {:.1}, worst {:.1} um, {ratio:.2} of what is stated; ends off {:.2}, {:.2} mm",
                trace.length() * 1e3,
                median * 1e6,
                worst * 1e6,
                off[0] * 1e3,
                off[1] * 1e3
            );
            assert!(median < within && worst < 3.0 * within && ratio < 3.0);
            assert!(off[0].max(off[1]) < 2e-3);
        }
    }
}
