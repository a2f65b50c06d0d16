//! How likely the labels of a model are right, by the uncertainty of its contacts.
//!
//! A label changes where a contact lets go (its force is 0) and where the last contact comes to the tip (s = L). How far a block is from either, in standard
//! deviations of the fit, gives the probability that it is not beyond. On the other side of such a transition there is nothing to measure: a block there is as
//! far from it as the block that lies as far before it.

use super::contact_rates::ContactRates;
use super::distinct::Distinct;
use crate::numeric::chi_squared::beyond;
use crate::phase::Label;
use nalgebra::{DMatrix, Matrix2, Vector2};
use rod_contact::ContactKind;
use std::cmp::Ordering;
use std::ops::Range;

/// Probability of a label that is far from all transitions: the share that is right in random scenes that were explained.
const FAR: f64 = 0.998;

/// How far a block is from where its label changes, standard deviations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margins {
    /// From where its weakest contact lets go.
    release: f64,
    /// From where its last contact comes to the tip.
    tip: f64,
}

impl Margins {
    /// Of a free rod, and of what is not known.
    pub const NONE: Self = Self { release: f64::INFINITY, tip: f64::INFINITY };

    /// Of the contacts that are told apart of a state, for a rod of this length. `shared` is the covariance of their points by errors that all samples
    /// share.
    pub fn of(
        distinct: &[Distinct],
        rates: &[ContactRates],
        covariance: &DMatrix<f64>,
        shared: &Matrix2<f64>,
        length: f64,
    ) -> Self {
        let ratio = |value: f64, sigma: f64| if sigma > 0.0 { value / sigma } else { f64::INFINITY };
        let release = |one: &Distinct| {
            let sigma = rates.get(one.like).map_or(0.0, |by| by.sigma(covariance, |rate| rate.force));
            ratio(one.contact.force, sigma)
        };
        let last = distinct.last().filter(|last| !matches!(last.contact.kind, ContactKind::Tip | ContactKind::Notch));
        let tip = last.and_then(|last| {
            // errors that all samples share move the contact along rod and contour alike
            let along = Vector2::new(last.contact.alpha.cos(), last.contact.alpha.sin());
            let sigma =
                rates.get(last.like)?.sigma(covariance, |rate| rate.s).hypot(along.dot(&(shared * along)).sqrt());
            Some(ratio(length - last.contact.s, sigma))
        });
        Self { release: distinct.iter().map(release).fold(f64::INFINITY, f64::min), tip: tip.unwrap_or(f64::INFINITY) }
    }
}

/// The probabilities that the labels of the blocks are right. `segments` are the ranges of blocks between jumps, whose poses the recording shows.
pub(super) fn probabilities(labels: &[Option<Label>], margins: &[Margins], segments: &[Range<usize>]) -> Vec<f64> {
    let mut probabilities = vec![FAR; labels.len()];
    for segment in segments {
        let mut from = segment.start;
        let mut runs: Vec<Range<usize>> = Vec::new();
        for to in segment.start + 1..=segment.end {
            if to == segment.end || labels[to] != labels[from] {
                runs.push(from..to);
                from = to;
            }
        }
        for (i, run) in runs.iter().enumerate() {
            for k in run.clone() {
                let margin = |j: usize| across(labels[k], labels[j], margins[j]);
                let after =
                    runs.get(i + 1).map(|next| mirrored(run.end - 1 - k, next.len(), |j| margin(next.start + j)));
                let before = i.checked_sub(1).map(|i| &runs[i]);
                let before = before.map(|last| mirrored(k - run.start, last.len(), |j| margin(last.end - 1 - j)));
                let Margins { release, tip } = margins[k];
                probabilities[k] =
                    FAR * [release, tip].into_iter().chain(after).chain(before).map(|z| beyond(-z)).product::<f64>();
            }
        }
    }
    probabilities
}

/// The margin of a block that is so many blocks before a transition, by those of the run beyond it, counted from there: that of the block as far beyond, and
/// from the middle of the run on, where another transition is nearer, in proportion.
fn mirrored(away: usize, run: usize, margin: impl Fn(usize) -> f64) -> f64 {
    let at = away.min((run - 1) / 2);
    (0..=at).map(margin).fold(0.0, f64::max) * (away as f64 + 0.5) / (at as f64 + 0.5)
}

/// The margin at which a block beyond a transition is from it, if its contact exists there only.
fn across(here: Option<Label>, there: Option<Label>, margins: Margins) -> f64 {
    let (Some(here), Some(there)) = (here, there) else { return f64::INFINITY };
    let contacts = |label: Label| if label.several() { 2 } else { usize::from(label != Label::Free) };
    match contacts(here).cmp(&contacts(there)) {
        Ordering::Less => margins.release,
        Ordering::Equal => margins.tip,
        Ordering::Greater => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_as_sure_as_blocks_are_far_from_transitions() {
        use Label::{A, B, BB, Free};
        let label = |k: usize| Some([Free, A, B, BB, B][k / 10]);
        let labels: Vec<Option<Label>> = (0..50).map(label).collect();
        // the tip comes to the shaft half a block before block 20, the second contact half a block before block 30
        let margin = |k: usize| match label(k) {
            Some(B) if k < 30 => Margins { release: f64::INFINITY, tip: 0.2 * (k as f64 - 19.5) },
            Some(BB) => Margins { release: (k as f64 - 29.5).min(39.5 - k as f64), tip: f64::INFINITY },
            _ => Margins::NONE,
        };
        let margins: Vec<Margins> = (0..50).map(margin).collect();
        let found = probabilities(&labels, &margins, &[0..40, 40..50]);
        let expected = |z: f64| FAR * beyond(-z);
        let is = |k: usize, p: f64| assert!((found[k] - p).abs() < 1e-5, "{k} {} {p}", found[k]);
        is(5, FAR);
        // on both sides of a transition alike
        for i in 0..5 {
            is(20 + i, expected(0.2 * (i as f64 + 0.5)));
            is(19 - i, expected(0.2 * (i as f64 + 0.5)));
        }
        is(29, FAR * beyond(-0.2 * 9.5) * beyond(-0.5));
        is(30, expected(0.5));
        // beyond a jump nothing is mirrored
        is(39, expected(0.5));
        is(40, FAR);
    }
}
