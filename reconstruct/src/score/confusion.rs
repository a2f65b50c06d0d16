//! The confusion matrix of the phases.

use crate::phase::Label;
use std::fmt;
use std::ops::AddAssign;

/// Counts of samples by their true phase and the one found.
///
/// Collected from pairs (truth, found); matrices of several scans add up. Shares are between 0 and 1; they are `None` where the whole
/// is 0.
///
/// ```
/// use rod_reconstruct::{Label, score::Confusion};
/// let pairs = [(Label::A, Label::A), (Label::BA, Label::BB), (Label::B, Label::BB)];
/// let confusion: Confusion = pairs.into_iter().collect();
/// assert_eq!(confusion.accuracy(), Some(1.0 / 3.0));
/// assert_eq!(confusion.several_recall(), Some(1.0)); // BA was taken for BB: several contacts in both
/// assert_eq!(confusion.single_kept(), Some(0.5)); // B was taken for BB: a good point lost
/// assert_eq!(confusion.recall(Label::Free), None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Confusion {
    /// By the true label, then by the one found, both in the order of [`Label::ALL`].
    counts: [[u64; Label::ALL.len()]; Label::ALL.len()],
}

impl Confusion {
    /// Counts one more sample.
    pub fn add(&mut self, truth: Label, found: Label) {
        self.counts[truth as usize][found as usize] += 1;
    }

    /// Samples of phase `truth` that were taken for `found`.
    pub fn count(&self, truth: Label, found: Label) -> u64 {
        self.counts[truth as usize][found as usize]
    }

    /// All samples.
    pub fn total(&self) -> u64 {
        self.sum(|_, _| true)
    }

    /// Share of the samples whose phase was found.
    pub fn accuracy(&self) -> Option<f64> {
        share(self.sum(|truth, found| truth == found), self.total())
    }

    /// Share of the samples of a phase that were found to be of it.
    pub fn recall(&self, label: Label) -> Option<f64> {
        share(self.count(label, label), self.sum(|truth, _| truth == label))
    }

    /// Share of the samples found to be of a phase that are of it.
    pub fn precision(&self, label: Label) -> Option<f64> {
        share(self.count(label, label), self.sum(|_, found| found == label))
    }

    /// Share of the samples with several contacts (BA, BB) that were found to have several, BA or BB.
    pub fn several_recall(&self) -> Option<f64> {
        share(self.sum(|truth, found| truth.several() && found.several()), self.sum(|truth, _| truth.several()))
    }

    /// Share of the samples found to have several contacts that have several, BA or BB.
    pub fn several_precision(&self) -> Option<f64> {
        share(self.sum(|truth, found| truth.several() && found.several()), self.sum(|_, found| found.several()))
    }

    /// Share of the samples with a single contact (A, B) that were found to have one, A or B: the good points that are kept.
    pub fn single_kept(&self) -> Option<f64> {
        let single = |label: Label| matches!(label, Label::A | Label::B);
        share(self.sum(|truth, found| single(truth) && single(found)), self.sum(|truth, _| single(truth)))
    }

    /// The number of samples whose truth and finding fulfil a condition.
    fn sum(&self, choose: impl Fn(Label, Label) -> bool) -> u64 {
        let pairs = Label::ALL.into_iter().flat_map(|truth| Label::ALL.map(|found| (truth, found)));
        pairs.filter(|(truth, found)| choose(*truth, *found)).map(|(truth, found)| self.count(truth, found)).sum()
    }
}

/// The share of a part; none where the whole is 0.
fn share(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

impl Extend<(Label, Label)> for Confusion {
    fn extend<I: IntoIterator<Item = (Label, Label)>>(&mut self, pairs: I) {
        pairs.into_iter().for_each(|(truth, found)| self.add(truth, found));
    }
}

impl FromIterator<(Label, Label)> for Confusion {
    fn from_iter<I: IntoIterator<Item = (Label, Label)>>(pairs: I) -> Self {
        let mut confusion = Self::default();
        confusion.extend(pairs);
        confusion
    }
}

impl AddAssign for Confusion {
    fn add_assign(&mut self, other: Self) {
        let cells = self.counts.as_flattened_mut().iter_mut().zip(other.counts.as_flattened());
        cells.for_each(|(cell, more)| *cell += more);
    }
}

/// Widths of the columns of the table: names, counts, shares.
const NAME: usize = 14;
const COUNT: usize = 9;
const SHARE: usize = 11;

/// A table: a row for each true phase, a column for each found one, recall and precision at the edges, the summary
/// below.
impl fmt::Display for Confusion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<NAME$}", "truth \\ found")?;
        Label::ALL.iter().try_for_each(|found| write!(f, "{found:>COUNT$}"))?;
        writeln!(f, "{:>SHARE$}", "recall")?;
        for truth in Label::ALL {
            write!(f, "{truth:<NAME$}")?;
            Label::ALL.iter().try_for_each(|found| write!(f, "{:>COUNT$}", self.count(truth, *found)))?;
            writeln!(f, "{:>SHARE$}", percent(self.recall(truth)))?;
        }
        write!(f, "{:<NAME$}", "precision")?;
        Label::ALL.iter().try_for_each(|found| write!(f, "{:>COUNT$}", percent(self.precision(*found))))?;
        writeln!(f)?;
        let [accuracy, several, kept] = [self.accuracy(), self.several_recall(), self.single_kept()].map(percent);
        write!(f, "accuracy {accuracy}, several contacts found {several}, single contacts kept {kept}")
    }
}

/// A share in per cent; a dash for none. Only all of them are 100 %.
fn percent(share: Option<f64>) -> String {
    match share {
        None => "-".into(),
        Some(share) if share < 1.0 => format!("{:.2} %", (100.0 * share).min(99.99)),
        Some(_) => "100 %".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Label::{A, B, BA, BB, Free};
    use proptest::prelude::*;

    #[test]
    fn shares_by_hand() {
        let pairs =
            [(Free, Free), (A, A), (A, A), (A, Free), (B, B), (B, A), (B, BB), (BB, BB), (BB, BA), (BB, B), (BA, BA)];
        let confusion: Confusion = pairs.into_iter().collect();
        assert_eq!((confusion.total(), confusion.count(B, A), confusion.count(A, B)), (11, 1, 0));
        assert_eq!(confusion.accuracy(), Some(6.0 / 11.0));
        assert_eq!(
            [A, B, BA, BB].map(|label| confusion.recall(label).unwrap()),
            [2.0 / 3.0, 1.0 / 3.0, 1.0, 1.0 / 3.0]
        );
        assert_eq!([A, B, BA, BB].map(|label| confusion.precision(label).unwrap()), [2.0 / 3.0, 0.5, 0.5, 0.5]);
        assert_eq!(confusion.several_recall(), Some(0.75));
        assert_eq!(confusion.several_precision(), Some(0.75));
        assert_eq!(confusion.single_kept(), Some(4.0 / 6.0), "B taken for A is kept; for BB, or A for free, it is not");
    }

    #[test]
    fn of_nothing_there_are_no_shares() {
        let empty = Confusion::default();
        assert_eq!((empty.accuracy(), empty.several_recall(), empty.single_kept()), (None, None, None));
        assert!(Label::ALL.iter().all(|label| empty.recall(*label).is_none() && empty.precision(*label).is_none()));
        assert!(!empty.to_string().contains("NaN"));
    }

    #[test]
    fn the_table_is_aligned_and_rounds_nothing_up_to_all() {
        let mut confusion: Confusion = std::iter::repeat_n((A, A), 99_999).collect();
        confusion.add(A, BB);
        let table = confusion.to_string();
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 8);
        assert_eq!(lines[2], "A                     0    99999        0        0        1    99.99 %");
        assert!(lines[..6].iter().all(|line| line.len() == lines[0].len()), "{table}");
        assert_eq!(lines[6], "precision             -    100 %        -        -   0.00 %");
        assert_eq!(lines[7], "accuracy 99.99 %, several contacts found -, single contacts kept 99.99 %");
    }

    fn label() -> impl Strategy<Value = Label> {
        prop::sample::select(Label::ALL.to_vec())
    }

    proptest! {
        #[test]
        fn order_and_division_do_not_matter_and_the_truth_is_perfect(
            pairs in prop::collection::vec((label(), label()), 1..60), cut in 0..60_usize,
        ) {
            let (one, other) = pairs.split_at(cut % pairs.len());
            let mut sum: Confusion = other.iter().copied().collect();
            sum += one.iter().copied().collect();
            let whole: Confusion = pairs.iter().rev().copied().collect();
            prop_assert_eq!(sum, whole);
            let mirrored: Confusion = pairs.iter().map(|(truth, found)| (*found, *truth)).collect();
            for label in Label::ALL {
                prop_assert_eq!(mirrored.recall(label), whole.precision(label));
            }
            let perfect: Confusion = pairs.iter().map(|(truth, _)| (*truth, *truth)).collect();
            prop_assert_eq!(perfect.accuracy(), Some(1.0));
            prop_assert!([perfect.several_recall(), perfect.single_kept()].into_iter().flatten().all(|s| s == 1.0));
        }
    }
}
