//! The comparison of a reconstruction with the scene that the recording is of.

use super::comparison::{Comparison, Transition, TruthError};
use super::result::Reconstructed;
use crate::{Scan, Scene};
use nalgebra::Matrix3;
use rayon::prelude::*;
use vibrissa::contact::EventKind;
use vibrissa::reconstruct::score::{Confusion, Deviation, KinkScore, signed_distance};
use vibrissa::reconstruct::{Touch, one_sample, single};
use vibrissa::rod::AnyRod;
use vibrissa::{Composite, Event, Label, Pose, Sample};

/// Largest distance, rod lengths, of a pose from the path of the scene at which it is compared.
const OFF_PATH: f64 = 1e-3;
/// Distance from a transition, rod lengths, within which a label may be that before or after it.
const EITHER: f64 = 1e-4;
/// Largest distance, m, at which kinks are matched with true ones.
const MARGIN: f64 = 1e-3;
/// Distance, rod lengths, from which on a transition is not matched with a true one.
const FAR: f64 = 0.05;

impl Reconstructed {
    /// Compares with the scene that the recording is of, which is swept for it.
    ///
    /// # Errors
    /// [`TruthError`], also for a scene with a roller.
    pub fn compare(&mut self, scene: Scene) -> Result<(), TruthError> {
        scene.check_no_roller()?;
        self.comparison = Some(Comparison::of(self, scene)?);
        Ok(())
    }
}

impl Comparison {
    fn of(found: &Reconstructed, scene: Scene) -> Result<Self, TruthError> {
        let scan = Scan::run(scene)?;
        let truth = Truth::of(&scan);
        let poses: Vec<Pose> = (0..found.samples.len()).map(|sample| found.pose(sample)).collect();
        let legs = truth.legs(&poses);
        let way = |sample: usize| truth.way(legs[sample]?, poses[sample]);
        let ways: Vec<Option<f64>> = (0..poses.len()).map(way).collect();
        let off_path = ways.iter().filter(|way| way.is_none()).count();
        if off_path == ways.len() {
            return Err(TruthError::Elsewhere { file: found.recording.file.clone(), scene: scan.scene.name });
        }
        let (mut confusion, mut either) = (Confusion::default(), 0);
        for (reading, way) in found.found.readings.iter().zip(&ways) {
            let Some(way) = way else { continue };
            let label = truth.label(*way);
            confusion.add(label, reading.label);
            either += u64::from(label != reading.label && truth.is_either(*way));
        }
        let readings = || found.found.readings.par_iter().filter(|reading| reading.label != Label::Free);
        let objects = &scan.scene.objects;
        let [single, first] = [false, true].map(|several| {
            deviation(objects, readings().filter_map(move |r| r.touch.ok().filter(|_| r.label.several() == several)))
        });
        let second = deviation(objects, readings().filter_map(|reading| reading.second?.ok()));
        let several = found.samples.par_iter().zip(&found.found.readings).filter(|(_, r)| r.label.several());
        let naive = deviation(objects, several.filter_map(|(sample, _)| naive_touch(&found.rod, sample)));
        let kinks = found.found.kinks.iter().zip(found.kink_poses());
        let kinks: Vec<f64> =
            kinks.filter_map(|(kink, pose)| truth.way(*legs.get(kink.next)?.as_ref()?, pose)).collect();
        let kinked: Vec<f64> = truth.events.iter().filter(|event| event.kinks).map(|event| event.way).collect();
        let all: Vec<f64> = truth.events.iter().map(|event| event.way).collect();
        Ok(Self {
            off_path,
            confusion,
            either,
            single,
            first,
            second,
            naive,
            kinks: KinkScore::of(&kinks, &kinked, MARGIN),
            kinks_of_events: KinkScore::of(&kinks, &all, MARGIN),
            transitions: truth.transitions(&found.found.runs, &ways),
            stop: scan.outcome.stop.clone(),
            scene: scan.scene,
        })
    }
}

fn deviation(objects: &[Composite], touches: impl ParallelIterator<Item = Touch>) -> Option<Deviation> {
    let distances: Option<Vec<f64>> = touches.map(|touch| signed_distance(objects, touch.x, touch.y)).collect();
    Deviation::of(distances?)
}

/// The place of the least value.
fn least(values: &[f64]) -> usize {
    (0..values.len()).min_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(0)
}

/// What happened along the path.
struct Truth<'a> {
    scan: &'a Scan,
    /// Length of the rod, m.
    length: f64,
    /// A length of the rod in the unit of ways along the path.
    unit: f64,
    start: Label,
    events: Vec<Happening<'a>>,
}

struct Happening<'a> {
    event: &'a Event,
    /// Along the path: m, or rad where the clamp only turns.
    way: f64,
    from: Label,
    to: Label,
    /// Whether the reactions have a kink or a jump there.
    kinks: bool,
}

impl<'a> Truth<'a> {
    fn of(scan: &'a Scan) -> Self {
        let happening = |event: &'a Event| {
            let [from, to] = [event.from(), event.to()].map(|phase| Label::of(phase.contacts, phase.tip));
            let jumps = matches!(event.kind, EventKind::Snap | EventKind::SnapOff | EventKind::SlipOver);
            let kinks = jumps || (from != to && event.kind != EventKind::TipToTangent);
            Happening { event, way: scan.scene.way(&event.before), from, to, kinks }
        };
        let events: Vec<Happening<'a>> = scan.outcome.events.iter().map(happening).collect();
        let phase = scan.outcome.states.first().map(|state| state.phase()).unwrap_or_default();
        let start = Label::of(phase.contacts, phase.tip);
        let length = scan.scene.rod.length();
        Self { scan, length, unit: if scan.scene.turns_only() { 1.0 } else { length }, start, events }
    }

    /// How far along the path a pose on a leg is, if it is on that and the sweep came so far.
    fn way(&self, leg: usize, pose: Pose) -> Option<f64> {
        let path = self.scan.scene.all_legs().nth(leg)?.path;
        let way = path.way(pose);
        let end = match (&self.scan.outcome.stop, self.scan.outcome.states.last()) {
            (Some(_), Some(state)) if state.leg < leg => return None,
            (Some(_), Some(state)) if state.leg == leg => path.way(state.pose),
            _ => path.length(),
        };
        let there = path.at(way);
        let off = (pose.x - there.x).hypot(pose.y - there.y).max(self.length * (pose.phi - there.phi).abs());
        let unit = if path.turns_only() { self.length } else { 1.0 };
        let off = off.max(unit * (-way).max(way - end));
        (off <= OFF_PATH * self.length).then(|| self.scan.scene.way_at(leg, pose))
    }

    /// The leg that each pose is on; none of poses off the path. Poses that may be on several, as on the way there and back, are given to legs
    /// so that they go back along the path as little as possible.
    fn legs(&self, poses: &[Pose]) -> Vec<Option<usize>> {
        let count = self.scan.scene.legs.len() + 1;
        // of each leg: how far the poses go back, if the last one is there, and the way of that
        let mut last = vec![(0.0, 0.0); count];
        let mut chosen = Vec::with_capacity(poses.len());
        for &pose in poses {
            let ways: Vec<Option<f64>> = (0..count).map(|leg| self.way(leg, pose)).collect();
            if ways.iter().all(Option::is_none) {
                chosen.push(None);
                continue;
            }
            let from = |way: &Option<f64>| {
                // bounded, because a recording may begin anew
                let back = |&(before, last): &(f64, f64)| {
                    way.map_or(f64::INFINITY, |way| before + (last - way).clamp(0.0, OFF_PATH * self.unit))
                };
                let backs: Vec<f64> = last.iter().map(back).collect();
                let from = least(&backs);
                (from, (backs[from], way.unwrap_or_default()))
            };
            let (froms, next): (Vec<usize>, Vec<(f64, f64)>) = ways.iter().map(from).unzip();
            last = next;
            chosen.push(Some(froms));
        }
        let mut leg = least(&last.iter().map(|last| last.0).collect::<Vec<_>>());
        let mut legs: Vec<Option<usize>> = Vec::with_capacity(poses.len());
        for froms in chosen.iter().rev() {
            legs.push(froms.as_ref().map(|froms| {
                let from = froms[leg];
                std::mem::replace(&mut leg, from)
            }));
        }
        legs.reverse();
        legs
    }

    fn label(&self, way: f64) -> Label {
        let before = self.events.partition_point(|event| event.way <= way);
        before.checked_sub(1).map_or(self.start, |last| self.events[last].to)
    }

    fn is_either(&self, way: f64) -> bool {
        let slack = EITHER * self.unit;
        self.events.iter().any(|event| event.from != event.to && (event.way - way).abs() <= slack)
    }

    fn transitions(&self, runs: &[(usize, Label)], ways: &[Option<f64>]) -> Vec<Transition> {
        let borders: Vec<(Label, Label, f64)> = runs
            .windows(2)
            .filter_map(|pair| {
                let [before, after] = [pair[1].0 - 1, pair[1].0].map(|k| ways[k]);
                Some((pair[0].1, pair[1].1, 0.5 * (before? + after?)))
            })
            .collect();
        let far = FAR * self.unit;
        let changes = self.events.iter().filter(|event| event.from != event.to);
        changes
            .map(|event| {
                let alike = borders.iter().filter(|border| (border.0, border.1) == (event.from, event.to));
                let errors = alike.map(|border| border.2 - event.way).filter(|error| error.abs() < far);
                Transition {
                    from: event.from,
                    to: event.to,
                    kind: event.event.kind,
                    pose: event.event.pose(),
                    error: errors.min_by(|a, b| a.abs().total_cmp(&b.abs())),
                }
            })
            .collect()
    }
}

/// The contact point of a sample as if it were a single one: where the moment vanishes first. For a uniform rod the pose is that of the base,
/// for another one that of the support.
pub fn naive_touch(rod: &AnyRod, sample: &Sample) -> Option<Touch> {
    let (Sample { pose, reactions, .. }, exact) = (*sample, Matrix3::zeros());
    match rod.uniform() {
        Some(rod) => single(rod, pose, reactions, &exact).map_or_else(|none| none.touch(), Some),
        None => one_sample(rod, pose, reactions, &exact).ok()?.touch(),
    }
}
