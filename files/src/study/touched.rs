//! How much of the contours contacts go over.

use crate::Scan;
use vibrissa::Composite;
use vibrissa::contact::{Contact, ContactKind, EventKind};
use vibrissa::contour::{Stretch, StretchKind};

/// Gauss-Legendre points and weights on -1 to 1, of degree 9: relative error of the length of a part below 1e-9 where its direction
/// turns by less than a radian.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Parts into which a stretch between two parameters is cut.
const PARTS: usize = 16;

/// The share of the contours between their outermost touched points that contacts went over; of a closed contour, all but its
/// largest untouched part counts. None where nothing was touched. A contact covers the contour between two states of
/// one interval, but not where the tip slips.
pub(super) fn touched_share(scan: &Scan) -> Option<f64> {
    let objects = &scan.scene.objects;
    let mut covered = vec![Vec::new(); objects.len()];
    let slips = scan.outcome.events.iter().filter(|event| event.kind == EventKind::SlipOver);
    let slips: Vec<f64> = slips.map(|event| scan.scene.way(&event.before)).collect();
    for interval in scan.intervals() {
        // a state at the very pose of a transition may be of the phase before
        let states: Vec<_> = interval.states.iter().filter(|state| state.phase() == interval.phase).collect();
        for pair in states.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|state| scan.scene.way(state));
            if slips.iter().any(|slip| (from..=to).contains(slip)) {
                continue;
            }
            for (one, other) in pair[0].contacts.iter().zip(&pair[1].contacts) {
                if one.object == other.object {
                    let ends = [one, other].map(|contact| parameter(&objects[contact.object], contact));
                    if let [Some(from), Some(to)] = ends {
                        covered[one.object].push((from.min(to), from.max(to)));
                    }
                }
            }
        }
    }
    let (mut over, mut all) = (0.0, 0.0);
    for (object, parts) in objects.iter().zip(&mut covered) {
        let parts = union(parts);
        let lengths: Vec<f64> = parts.iter().map(|(from, to)| length(object, *from, *to)).collect();
        let mut gaps: Vec<f64> = parts.windows(2).map(|pair| length(object, pair[0].1, pair[1].0)).collect();
        if let (true, Some(first), Some(last)) = (object.is_closed(), parts.first(), parts.last()) {
            // around the back
            let whole: f64 =
                object.stretches().map(|stretch| length(object, stretch.range.from, stretch.range.to)).sum();
            gaps.push(whole - length(object, first.0, last.1));
            let largest = gaps.iter().copied().fold(0.0, f64::max);
            gaps.push(-largest);
        }
        let covered: f64 = lengths.iter().sum();
        over += covered;
        all += covered + gaps.iter().sum::<f64>();
    }
    (all > 0.0).then(|| over / all)
}

/// The parameter of the composite at a contact.
fn parameter(object: &Composite, contact: &Contact) -> Option<f64> {
    let stretch = |kind| object.find(kind).map(|index| (index, object.stretch(index).range));
    match contact.kind {
        ContactKind::Corner => stretch(StretchKind::Corner { before: contact.piece }).map(|(_, range)| range.from),
        ContactKind::Notch => stretch(StretchKind::Notch { before: contact.piece }).map(|(_, range)| range.from),
        _ => stretch(StretchKind::Piece(contact.piece))
            .map(|(index, _)| object.closest_on(index, contact.x, contact.y).t),
    }
}

/// The same points as intervals that do not overlap, in order.
fn union(parts: &mut [(f64, f64)]) -> Vec<(f64, f64)> {
    parts.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut union: Vec<(f64, f64)> = Vec::new();
    for part in parts {
        match union.last_mut() {
            Some(last) if part.0 <= last.1 => last.1 = last.1.max(part.1),
            _ => union.push(*part),
        }
    }
    union
}

/// Length of the contour between two parameters, m.
fn length(object: &Composite, from: f64, to: f64) -> f64 {
    let of_stretch = |(index, stretch): (usize, Stretch)| {
        let (from, to) = (from.max(stretch.range.from), to.min(stretch.range.to));
        if from >= to {
            return 0.0;
        }
        let half = 0.5 * (to - from) / PARTS as f64;
        let part = |k: usize| {
            let middle = from + (2 * k + 1) as f64 * half;
            GAUSS
                .iter()
                .map(|(at, weight)| half * weight * object.frame_on(index, middle + half * at).speed)
                .sum::<f64>()
        };
        (0..PARTS).map(part).sum()
    };
    object.stretches().enumerate().map(of_stretch).sum()
}
