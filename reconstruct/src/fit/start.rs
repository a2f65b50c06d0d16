//! Contact points from which a fit starts.

use super::blocks::{Block, Blocks};
use super::curve::Node;
use super::order::Touched;
use super::outline::{Interpretation, outline};
use super::swept::Swept;
use crate::kink::KinkKind;
use crate::phase::Label;
use crate::pipeline::Reconstruction;
use crate::point::{OneSample, Touch, one_sample};
use crate::systematic::Errors;
use nalgebra::{Matrix3, Vector2, Vector3};
use rod_contact::{Contact, ContactKind};
use rod_core::{PhysicalRod, Rod};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Standard deviation of a contact point, rod lengths, up to which all count the same.
const EQUAL: f64 = 1e-3;
/// Largest standard deviation (rod lengths) of the point that a single contact would have where there is no answer. Larger: points that noise
/// throws anywhere enter the order along the contour.
const UNSURE: f64 = 0.05;
/// Way between two points of a trace from which on it has a direction, rod lengths, and in standard deviations; and the cosine of its angle to the
/// tangents, at least. Smaller: single contacts that samples with several would have go into the contour.
const MOVED: f64 = 2e-3;
const WITHIN: f64 = 3.0;
const ALONG: f64 = 0.7;
/// Smallest force of such a contact over its noise. Smaller: blocks of a free rod get contacts.
const CERTAIN: f64 = 6.0;
/// Fewest blocks of the middle of a contact from which a fit starts. Fewer: they do not determine a contour.
const FEWEST: usize = 8;
/// Most such starts.
const MIDDLES: usize = 2;

impl Touched {
    /// By the contact point of a sample, in rod lengths.
    fn by(touch: &Touch, length: f64, trace: usize, sample: usize) -> Self {
        // across the contour and along it: points that lie anywhere on the rod tell of no order
        let sigma = (touch.covariance - touch.systematic).trace().max(0.0).sqrt() / length;
        Self {
            at: Vector2::new(touch.x, touch.y) / length,
            along: Vector2::new(touch.alpha.cos(), touch.alpha.sin()),
            sigma,
            weight: sigma.hypot(EQUAL).powi(-2),
            trace,
            sample,
        }
    }
}

/// Where a fit starts.
#[derive(Clone)]
pub(super) struct Start {
    pub blocks: Blocks,
    /// The contour, rod lengths.
    pub chains: Vec<Vec<Node>>,
    /// Which blocks are explained first.
    pub asked: Vec<bool>,
}

impl Start {
    /// Whether the whole recording is explained at once.
    pub fn is_whole(&self) -> bool {
        !self.asked.contains(&false)
    }
}

/// Where the fit of a recording may start, the most likely first. `given` is a uniform rod of the length and the stiffness at the clamp of `rod`;
/// `errors` are those of the local answers to the recordings.
pub(super) fn starts<R: PhysicalRod>(
    rod: &R,
    given: &Rod,
    locals: &[&Reconstruction],
    mut blocks: Blocks,
    errors: &[Errors],
) -> Vec<Start> {
    let first_sample = |recording: usize| blocks.recordings[recording].samples.start;
    let of_recording =
        |(k, local): (usize, &&Reconstruction)| touched(local, given, first_trace(locals, k), first_sample(k));
    let mut points: Vec<Touched> = locals.iter().enumerate().flat_map(of_recording).collect();
    let answers = Interpretation { is_sure: true, is_joined: false, is_sharp: false };
    let guesses = Interpretation { is_sure: false, ..answers };
    let joined = |reading| Interpretation { is_joined: true, ..reading };
    let of = |(blocks, swept): (&Blocks, &Swept), points: &[Touched], readings: &[Interpretation]| {
        let points = &along_contours(points);
        let start = |reading: &Interpretation| Start {
            chains: outline(points, *reading, swept),
            asked: vec![true; blocks.blocks.len()],
            blocks: blocks.clone(),
        };
        readings.iter().map(start).collect::<Vec<_>>()
    };
    let swept = Swept::of(rod, &blocks, errors);
    let sharp = Interpretation { is_sharp: true, ..answers };
    let mut starts = of((&blocks, &swept), &points, &[answers, joined(answers), sharp]);
    // what the local answer leaves open is explained later
    let is_answered = |block: &Block| block.label == Label::Free || !block.contacts.is_empty();
    let answered: Vec<bool> = blocks.blocks.iter().map(is_answered).collect();
    let parts: Vec<Start> = starts.iter().map(|start| Start { asked: answered.clone(), ..start.clone() }).collect();
    let doubtful: BTreeSet<usize> =
        locals.iter().enumerate().flat_map(|(k, local)| doubtful(local, first_trace(locals, k))).collect();
    let certain: Vec<Touched> = points.iter().filter(|point| !doubtful.contains(&point.trace)).copied().collect();
    if certain.len() < points.len() {
        starts.extend(of((&blocks, &swept), &certain, &[answers]));
    }
    let singles = singles(rod, locals, &mut blocks, errors);
    let swept = if singles.is_empty() { swept } else { Swept::of(rod, &blocks, errors) };
    if !singles.is_empty() {
        points.extend(singles);
        starts.extend(of((&blocks, &swept), &points, &[guesses, joined(guesses)]));
    }
    starts.extend(parts);
    // where a contact begins and ends a local answer goes astray first
    for middle in middles(&blocks) {
        let samples = blocks.blocks[middle.start].samples.start..blocks.blocks[middle.end - 1].samples.end;
        let inside: Vec<Touched> = points.iter().filter(|point| samples.contains(&point.sample)).copied().collect();
        let is_asked = |(k, block): (usize, &Block)| block.label == Label::Free || middle.contains(&k);
        let asked: Vec<bool> = blocks.blocks.iter().enumerate().map(is_asked).collect();
        let begun = of((&blocks, &swept), &inside, &[guesses]);
        starts.extend(begun.into_iter().map(|start| Start { asked: asked.clone(), ..start }));
    }
    let mut tried: Vec<(Vec<Vec<Node>>, Vec<bool>)> = Vec::new();
    starts.retain(|start| {
        let this = (start.chains.clone(), start.asked.clone());
        let is_new = !start.chains.is_empty() && !tried.contains(&this);
        tried.push(this);
        is_new
    });
    starts
}

/// The middle halves of the longest runs of blocks with a single contact.
fn middles(blocks: &Blocks) -> impl Iterator<Item = Range<usize>> + use<> {
    let is_single: Vec<bool> = blocks.blocks.iter().map(|block| block.contacts.len() == 1).collect();
    let mut runs = blocks.runs(&is_single);
    runs.sort_by_key(|run| Reverse(run.len()));
    let middle = |Range { start, end }: Range<usize>| {
        let quarter = (end - start) / 4;
        start + quarter..end - quarter
    };
    runs.into_iter().map(middle).filter(|middle| middle.len() >= FEWEST).take(MIDDLES)
}

/// The number of the first trace of a recording. Between two of its kinks, each contact of the rod is one trace.
fn first_trace(locals: &[&Reconstruction], recording: usize) -> usize {
    locals[..recording].iter().map(|local| 2 * (local.kinks.len() + 1)).sum()
}

/// The contact points of the local answer to a recording with this first trace and sample, in lengths of its rod.
fn touched(local: &Reconstruction, given: &Rod, first_trace: usize, first_sample: usize) -> Vec<Touched> {
    let length = local.calibration().map_or(given.length(), |calibration| calibration.rod(given).length());
    let mut points = Vec::new();
    for (number, reading) in local.readings.iter().enumerate() {
        let first = first_trace + 2 * kinks_before(local, number);
        let second = reading.second.and_then(Result::ok);
        let by = |touch: &Touch, trace: usize| Touched::by(touch, length, trace, first_sample + number);
        points.extend(reading.touch.ok().map(|touch| by(&touch, first)));
        points.extend(second.map(|touch| by(&touch, first + 1)));
    }
    points
}

/// The traces of a phase of one contact that a kink parts from a longer one of the same phase: a second contact may come or go there, which noise hides
/// from the local answer.
fn doubtful(local: &Reconstruction, first_trace: usize) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for (Range { start, end }, label) in local.phases().filter(|(_, label)| !label.several()) {
        let inner =
            local.kinks.iter().filter(|kink| kink.kind == KinkKind::Kink && kink.next > start && kink.next < end);
        let cuts: Vec<usize> = std::iter::once(start).chain(inner.map(|kink| kink.next)).chain([end]).collect();
        let longest = cuts.windows(2).max_by_key(|cut| cut[1] - cut[0]).map(|cut| cut[0]);
        let others = cuts[..cuts.len() - 1].iter().filter(|from| label != Label::Free && Some(**from) != longest);
        found.extend(others.map(|from| first_trace + 2 * kinks_before(local, *from)));
    }
    found
}

/// The points without those that move across their own tangents, which no contact does on a contour: the single contact of samples that have
/// several. The points of a trace are in the order of time.
fn along_contours(points: &[Touched]) -> Vec<Touched> {
    let mut traces: BTreeMap<usize, Vec<Touched>> = BTreeMap::new();
    points.iter().for_each(|point| traces.entry(point.trace).or_default().push(*point));
    let agrees = |one: &Touched, other: &Touched| {
        let way = other.at - one.at;
        let far = (WITHIN * one.sigma.hypot(other.sigma)).max(MOVED);
        (way.norm() > far).then(|| [one, other].iter().any(|at| way.dot(&at.along).abs() > ALONG * way.norm()))
    };
    let of_trace = |points: &Vec<Touched>| {
        let is_along = |k: &usize| {
            // farther away by a quarter each time: a contact at a vertex stays for long
            let away =
                || std::iter::successors(Some(1), |way| Some(way + 1 + way / 4)).take_while(|way| *way < points.len());
            let after = away().filter_map(|way| points.get(k + way)).find_map(|other| agrees(&points[*k], other));
            let before =
                away().filter_map(|way| points.get(k.checked_sub(way)?)).find_map(|other| agrees(&points[*k], other));
            before != Some(false) && after != Some(false)
        };
        (0..points.len()).filter(is_along).map(|k| points[k]).collect::<Vec<_>>()
    };
    traces.values().flat_map(of_trace).collect()
}

fn kinks_before(local: &Reconstruction, sample: usize) -> usize {
    local.kinks.partition_point(|kink| kink.next <= sample)
}

/// Gives blocks without an answer the single contact that their reactions, without these errors, would have, and returns those points.
fn singles<R: PhysicalRod>(
    rod: &R,
    locals: &[&Reconstruction],
    blocks: &mut Blocks,
    errors: &[Errors],
) -> Vec<Touched> {
    let units = rod.units();
    let Some(corrections) = blocks.corrections(errors) else { return Vec::new() };
    let starts: Vec<usize> = blocks.recordings.iter().map(|part| part.samples.start).collect();
    let mut found = Vec::new();
    for block in blocks.blocks.iter_mut().filter(|block| block.contacts.is_empty()) {
        let recording = block.recording;
        let clamp = block.corrected(&block.clamp, &corrections[recording]);
        if clamp.reactions.component_div(&block.sigma).xy().norm() < CERTAIN {
            continue;
        }
        let sigma = block.sigma.component_mul(&Vector3::new(units.force, units.force, units.moment));
        let covariance = Matrix3::from_diagonal(&sigma.component_mul(&sigma));
        let (pose, reactions) = clamp.in_units(units);
        let Ok(contact) = one_sample(rod, pose, reactions, &covariance) else { continue };
        let Some(touch) = contact.touch().filter(|touch| touch.sigma_normal() <= UNSURE * units.length) else {
            continue;
        };
        let kind = if matches!(contact, OneSample::Tip(_)) { ContactKind::Tip } else { ContactKind::Tangent };
        block.contacts = vec![Contact { kind, s: touch.s.min(units.length), ..touch.into() }];
        let kinks = kinks_before(locals[recording], block.samples.start - starts[recording]);
        let trace = first_trace(locals, recording) + 2 * kinks;
        let point = Touched::by(&touch, units.length, trace, block.samples.start);
        found.push(Touched { weight: point.weight * block.samples.len() as f64, ..point });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_move_across_their_tangents_are_left_out() {
        // along a line, at a vertex, and away from it across the tangents
        let at = |x: f64, y: f64, angle: f64| Touched {
            at: Vector2::new(x, y),
            along: Vector2::new(angle.cos(), angle.sin()),
            sigma: 1e-5,
            weight: 1.0,
            trace: 0,
            sample: 0,
        };
        let line = (0..100).map(|k| at(1e-3 * f64::from(k), 0.0, 0.0));
        let vertex = (0..1000).map(|k| at(0.1, 0.0, 1e-3 * f64::from(k)));
        let onwards = (0..100).map(|k| at(0.1 + 5e-4 * f64::from(k), 8e-4 * f64::from(k), 1.0));
        let contour: Vec<Touched> = line.chain(vertex).chain(onwards).collect();
        assert_eq!(along_contours(&contour).len(), contour.len());
        let across = (0..100).map(|k| at(0.15 + 1e-3 * f64::from(k), 0.08, 1.4));
        let whole: Vec<Touched> = contour.iter().copied().chain(across).collect();
        let kept = along_contours(&whole).len();
        assert!(kept <= contour.len() && kept > contour.len() - 10, "{kept}");
    }
}
