//! The judge of an answer: it knows the true sweep and the contour, and nothing of the inversion.

use super::command::{Answer, Line, Point};
use super::making::Made;
use rod_files::Scene;
use std::fmt;
use vibrissa::{Contour, Label};

/// Labels within this way of a true change of label are not counted, m.
const NEAR_A_CHANGE: f64 = 0.5e-3;
/// A recording is right if at least this share of the labels is.
const LABELS: f64 = 0.99;
/// The same for contact points: at most this share is beyond [`SIGMAS`] of their standard deviations.
const BEYOND: f64 = 0.005;
const SIGMAS: f64 = 6.0;
/// Distance across the contour that counts as none, m: rounding.
const ROUNDING: f64 = 1e-9;

/// What to think of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Status 0; labels and points are right.
    Right,
    /// Another exit status, or no contact point at all and a message. Of a mistake: status 2.
    Refused,
    /// Status 0, labels or points are wrong, and there is a message.
    Warned,
    /// The same without a message.
    Silent,
}

impl Verdict {
    pub const ALL: [Self; 4] = [Self::Right, Self::Refused, Self::Warned, Self::Silent];
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Right => "right",
            Self::Refused => "refused",
            Self::Warned => "wrong, warned",
            Self::Silent => "wrong, silent",
        })
    }
}

/// The score of an answer. Shares are none where there is nothing to count.
#[derive(Clone, Debug)]
pub struct Score {
    pub verdict: Verdict,
    pub status: Option<i32>,
    /// Share of the labels that are right.
    pub labels: Option<f64>,
    /// Median, and the distance that 99.9 % do not exceed, of the points labelled A or B from the contour, m.
    pub median: Option<f64>,
    pub p999: Option<f64>,
    /// Share of the points of single contacts and of second contacts that are beyond 6 standard deviations.
    pub beyond: Option<f64>,
    /// Share of the samples with one contact in truth that have no point.
    pub unanswered: Option<f64>,
    pub reliability: Reliability,
}

/// Lower ends of the ranges of probability for which labels are counted.
pub const RANGES: [f64; 11] = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999, 0.9999, 0.99999];

/// For each range of reported probability the number of labels, of those that are right, and the sum of the probabilities.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reliability(pub [[f64; 3]; RANGES.len()]);

impl Reliability {
    fn count(&mut self, probability: f64, right: bool) {
        let range = RANGES.iter().rposition(|least| probability >= *least).unwrap_or(0);
        let [all, of_them, sum] = &mut self.0[range];
        *all += 1.0;
        *of_them += f64::from(u8::from(right));
        *sum += probability;
    }

    pub fn add(&mut self, other: &Self) {
        for (sum, other) in self.0.iter_mut().flatten().zip(other.0.iter().flatten()) {
            *sum += other;
        }
    }
}

/// Judges an answer.
pub fn judge(scene: &Scene, made: &Made, answer: &Answer) -> Score {
    let (mut right, mut counted) = (0, 0);
    let (mut single, mut points) = (0, 0);
    let (mut distances, mut beyond, mut tested) = (Vec::new(), 0, 0);
    let mut reliability = Reliability::default();
    assert!(answer.lines.is_empty() || answer.lines.len() == made.recording.rows.len(), "a line for each row");
    let mut test = |point: &Point| {
        let (distance, sigma) = across(scene, point);
        tested += 1;
        beyond += usize::from(sigma.is_nan() || distance > SIGMAS * sigma + ROUNDING);
        distance
    };
    for (line, row) in answer.lines.iter().zip(&made.recording.rows) {
        let state = &made.truth.states[row.truth];
        if !made.truth.is_near_a_change(state.way) {
            counted += 1;
            let is_right = line.label.as_deref() == Some(state.label.to_string().as_str());
            right += usize::from(is_right);
            line.probability.into_iter().for_each(|probability| reliability.count(probability, is_right));
        }
        if matches!(state.label, Label::A | Label::B) {
            single += 1;
            points += usize::from(line.point.is_some());
        }
        if let Some(point) = line.point.filter(|_| is_single(line)) {
            distances.push(test(&point));
        }
        line.second.iter().for_each(|point| _ = test(point));
    }
    let answered = answer.lines.iter().any(|line| line.point.is_some() || line.second.is_some());
    let share = |part: usize, whole: usize| (whole > 0).then(|| part as f64 / whole as f64);
    let (labels, beyond) = (share(right, counted), share(beyond, tested));
    let good = labels.is_some_and(|share| share >= LABELS) && beyond.is_some_and(|share| share <= BEYOND);
    let verdict = match (answer.status, answer.said.is_empty()) {
        (Some(0), _) if good => Verdict::Right,
        (Some(0), true) => Verdict::Silent,
        (Some(0), false) if answered || made.must_be_refused => Verdict::Warned,
        (status, _) if made.must_be_refused && status != Some(2) => Verdict::Silent,
        _ => Verdict::Refused,
    };
    distances.sort_unstable_by(f64::total_cmp);
    let quantile = |share: f64| distances.get((share * (distances.len().max(1) - 1) as f64).ceil() as usize).copied();
    Score {
        verdict,
        status: answer.status,
        labels,
        median: quantile(0.5),
        p999: quantile(0.999),
        beyond,
        unanswered: share(single - points, single),
        reliability,
    }
}

fn is_single(line: &Line) -> bool {
    line.label.as_deref().is_some_and(|label| label == "A" || label == "B")
}

/// Distance of a point from the nearest object and its reported standard deviation in that direction, m.
fn across(scene: &Scene, point: &Point) -> (f64, f64) {
    let nearest = scene.objects.iter().map(|object| object.closest(point.x, point.y));
    let foot = nearest.min_by(|a, b| a.gap.abs().total_cmp(&b.gap.abs())).unwrap();
    let (x, y) = (point.x - foot.frame.x, point.y - foot.frame.y);
    let distance = x.hypot(y);
    let normal = if distance > 0.0 {
        [x / distance, y / distance]
    } else {
        let (sin, cos) = foot.frame.alpha.sin_cos();
        [-sin, cos]
    };
    (distance, point.sigma_across(normal))
}

impl super::truth::Truth {
    /// Whether the label changes within [`NEAR_A_CHANGE`] of this place.
    fn is_near_a_change(&self, way: f64) -> bool {
        let next = self.changes.partition_point(|change| *change < way);
        let near =
            |k: Option<usize>| k.and_then(|k| self.changes.get(k)).is_some_and(|c| (c - way).abs() <= NEAR_A_CHANGE);
        near(Some(next)) || near(next.checked_sub(1))
    }
}
