//! The phase of a rod, int EI^(-1/2) ds: what the square root of a force is multiplied by to count buckling modes, and by which nodes and
//! sections are spread.

use crate::model::{RodModel, RodSection, Sections};

/// Shortest of these sections, L.
const SHORTEST: f64 = 1e-6;
/// Parts of an integral.
pub(super) const PARTS: usize = 16;
/// Points of the midpoint rule for the mean of the stiffness.
const POINTS: usize = 4;

/// The rod in `count` uniform sections of equal phase, cut at its joints too: the closed form instead of a differential equation.
pub(super) fn in_sections(rod: &impl RodModel, count: usize) -> Option<Sections> {
    let mut ends = of_equal_phase(rod, [0.0, 1.0], count);
    ends.extend(rod.joints());
    ends.extend([0.0, 1.0]);
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|later, earlier| *later - *earlier < SHORTEST);
    // the tip may be the later of two
    if let Some(last) = ends.last_mut() {
        *last = 1.0;
    }
    let section = |ends: &[f64]| RodSection {
        length: ends[1] - ends[0],
        bending_stiffness: 1.0 / mean(rod, ends, |compliance| compliance),
        natural_curvature: rod.curvature_at(0.5 * (ends[0] + ends[1]), 0.0),
    };
    Sections::new(&ends.windows(2).map(section).collect::<Vec<_>>()).ok()
}

/// The `count` - 1 places between two arc lengths that divide them into parts of equal phase, int EI^(-1/2) ds, nearly.
pub(super) fn of_equal_phase(rod: &impl RodModel, [from, to]: [f64; 2], count: usize) -> Vec<f64> {
    if rod.is_uniform() || count < 2 {
        return (1..count).map(|k| from + (to - from) * k as f64 / count as f64).collect();
    }
    let steps = 16 * count;
    let at = |k: usize| from + (to - from) * k as f64 / steps as f64;
    let mut phases = vec![0.0];
    for k in 0..steps {
        phases.push(phases[k] + mean(rod, &[at(k), at(k + 1)], f64::sqrt));
    }
    (1..count).map(|k| at(phases.partition_point(|phase| *phase < phases[steps] * k as f64 / count as f64))).collect()
}

/// The integral of a function of 1 / EI between two arc lengths.
pub(super) fn integral(rod: &impl RodModel, ends: &[f64], f: impl Fn(f64) -> f64 + Copy) -> f64 {
    let (from, length) = (ends[0], (ends[1] - ends[0]) / PARTS as f64);
    (0..PARTS).map(|k| length * mean(rod, &[from + length * k as f64, from + length * (k + 1) as f64], f)).sum()
}

/// 1 / EI.
pub(super) fn compliance(rod: &impl RodModel, s: f64) -> f64 {
    rod.curvature_at(s, 1.0) - rod.curvature_at(s, 0.0)
}

/// The mean of a function of 1 / EI between two arc lengths.
fn mean(rod: &impl RodModel, ends: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    let at = |k: usize| ends[0] + (ends[1] - ends[0]) * (k as f64 + 0.5) / POINTS as f64;
    (0..POINTS).map(at).map(|s| f(compliance(rod, s))).sum::<f64>() / POINTS as f64
}
