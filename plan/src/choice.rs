//! Which candidates to take together: greedily, and by trying all sets.
//!
//! For a value that no candidate lowers and whose gains fall the more is taken (monotone and submodular), `count` candidates taken greedily have
//! at least the share 1 - (1 - 1 / count)^count > 1 - 1/e = 0.632 of the best value of any `count` candidates (Nemhauser, Wolsey and
//! Fisher 1978). The length of a union of intervals is such a value, and so is a mean of such lengths.

/// A candidate that was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Number of the candidate, from 0.
    pub candidate: usize,
    /// What it adds to the value of those taken before it.
    pub gain: f64,
    /// The value of all taken so far.
    pub value: f64,
}

/// Takes up to `count` of the candidates, each time the one that adds most to the value; of several the first. Ends where none adds anything.
pub fn greedy(candidates: usize, count: usize, value: impl Fn(&[usize]) -> f64) -> Vec<Choice> {
    let mut taken: Vec<usize> = Vec::new();
    let mut choices: Vec<Choice> = Vec::new();
    while choices.len() < count {
        let before = choices.last().map_or(0.0, |choice| choice.value);
        let mut best: Option<Choice> = None;
        for candidate in 0..candidates {
            if taken.contains(&candidate) {
                continue;
            }
            taken.push(candidate);
            let value = value(&taken);
            taken.pop();
            if value > best.map_or(before, |best| best.value) {
                best = Some(Choice { candidate, gain: value - before, value });
            }
        }
        let Some(best) = best else { break };
        taken.push(best.candidate);
        choices.push(best);
    }
    choices
}

/// The best set of at most `count` candidates, by trying all of them, and its value: for small numbers of candidates.
pub fn exhaustive(candidates: usize, count: usize, value: &impl Fn(&[usize]) -> f64) -> (Vec<usize>, f64) {
    fn extend(
        taken: &mut Vec<usize>,
        from: usize,
        left: (usize, usize),
        value: &impl Fn(&[usize]) -> f64,
        best: &mut (Vec<usize>, f64),
    ) {
        let own = value(taken);
        if own > best.1 {
            *best = (taken.clone(), own);
        }
        if taken.len() < left.1 {
            for candidate in from..left.0 {
                taken.push(candidate);
                extend(taken, candidate + 1, left, value, best);
                taken.pop();
            }
        }
    }
    let mut best = (Vec::new(), f64::NEG_INFINITY);
    extend(&mut Vec::new(), 0, (candidates, count), value, &mut best);
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::IntervalSet;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn covered(sets: &[IntervalSet], taken: &[usize]) -> f64 {
        let mut union = IntervalSet::default();
        taken.iter().for_each(|one| union.extend(&sets[*one]));
        union.length()
    }

    /// Random unions of intervals: gains fall, and the greedy value is within its bound of the best one.
    #[test]
    fn greedy_choices_keep_their_bound() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut least: f64 = 1.0;
        for _ in 0..300 {
            let sets: Vec<IntervalSet> = (0..9)
                .map(|_| {
                    let mut set = IntervalSet::default();
                    for _ in 0..2 {
                        let from = random.random::<f64>();
                        set.insert(from, from + 0.3 * random.random::<f64>());
                    }
                    set
                })
                .collect();
            let value = |taken: &[usize]| covered(&sets, taken);
            for count in 1..4 {
                let choices = greedy(sets.len(), count, value);
                let best = exhaustive(sets.len(), count, &value).1;
                let share = choices[count - 1].value / best;
                least = least.min(share);
                assert!(share >= 1.0 - (1.0 - 1.0 / count as f64).powi(count as i32) - 1e-12);
                assert!(choices.windows(2).all(|pair| pair[1].gain <= pair[0].gain + 1e-12));
            }
        }
        assert!(least < 1.0, "the greedy choice is not always the best one");
    }

    #[test]
    fn what_adds_nothing_is_not_taken() {
        let sets = [IntervalSet::of(0.0, 1.0), IntervalSet::of(0.2, 0.4), IntervalSet::of(2.0, 2.5)];
        let choices = greedy(3, 3, |taken| covered(&sets, taken));
        assert_eq!(choices.iter().map(|choice| choice.candidate).collect::<Vec<_>>(), [0, 2]);
    }
}
