//! Where a profile is how smooth: cells on each of which polynomials describe it.

use super::gauss::{AT, HIGHEST, NODES, WEIGHT};
use crate::error::RodError;
use crate::model::interval::piece_at;
use crate::model::profile::Profile;

/// Largest part of the two highest Legendre coefficients of the compliance in it (of the natural curvature: in 1 / L at least) where
/// a cell is short enough. 8 nodes leave less than its square of the integral. With 1e-4 a whole whisker costs a third more, with 1e-3
/// it is exact to 2e-13 only.
const RESOLVED: f64 = 3e-4;
/// The shortest cell. A profile that needs shorter ones has a jump or a kink that it should be told as a border.
const SHORTEST: f64 = 1e-4;
/// Largest difference between the integrals over a window and over its two halves, relative to the window's length and the largest
/// value. Rounding leaves less; a kink, which the coefficients of a short cell do not show, leaves far more in every cell.
const ALIKE: f64 = 1e-12;
/// What the rounding of arc lengths leaves of it, over the length of the smooth part: more than [`ALIKE`] where that is shorter than 1e-3.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Where the windows of a cell begin, and how long they are, in parts of the cell. They overlap: a kink that hides at the border of one,
/// before the first node, is inside another.
const WINDOWS: [f64; 4] = [0.0, 0.23, 0.47, 0.7];
const WINDOW: f64 = 0.3;
/// How far the window across the border to the cell before reaches back and on, in parts of this cell and of that.
const BACK: [f64; 2] = [0.2, 0.02];
const ON: [f64; 2] = [0.1, 0.01];
/// Slope of what the polynomials leave out, over that of their two highest parts: they fall by a factor of 3 and more from one to the
/// next, their slopes by 2.
const UNRESOLVED: f64 = 2.0;
/// From one cell to the next, and from one trial to the next.
const GROWTH: f64 = 2.0;
const SHRINKAGE: f64 = 0.85;

/// The cells of a rod between its joints. Beyond the ends of the rod there is one more on either side, where stiffness and natural
/// curvature are those of the end.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mesh {
    /// Where the cells end, the ends of the rod included.
    pub ends: Vec<f64>,
    /// 1 / (length on which the profile is resolved) of each cell between two of the ends.
    rates: Vec<f64>,
    /// The number of such lengths from the clamp to each of the ends.
    counts: Vec<f64>,
    /// The largest slopes of compliance and natural curvature in each cell, either way.
    slopes: Vec<[f64; 2]>,
    /// Where the profile may jump, the ends of the rod included.
    pub joints: Vec<f64>,
}

impl Mesh {
    pub fn new(profile: &impl Profile, borders: &[f64]) -> Result<Self, RodError> {
        let mut joints = vec![0.0];
        for &border in borders {
            let least = joints[joints.len() - 1];
            if !(border > least && border < 1.0) {
                return Err(RodError::Border { s: border, least });
            }
            joints.push(border);
        }
        joints.push(1.0);
        let mut mesh = Self { ends: vec![0.0], rates: Vec::new(), counts: vec![0.0], slopes: Vec::new(), joints };
        for i in 1..mesh.joints.len() {
            mesh.add(profile, mesh.joints[i - 1], mesh.joints[i])?;
        }
        Ok(mesh)
    }

    /// The cells from one joint to the next.
    fn add(&mut self, profile: &impl Profile, from: f64, to: f64) -> Result<(), RodError> {
        let (mut at, mut length, mut before) = (from, to - from, 0.0);
        while at < to {
            let left = to - at;
            length = (GROWTH * length).min(left);
            while !is_resolved(profile, [from, to], before, (at, at + length))? {
                length *= SHRINKAGE;
                // rounding may leave no shorter cell
                if length < SHORTEST * (to - from) || at + length <= at {
                    return Err(RodError::NotSmooth { s: at });
                }
            }
            let is_last = length >= left;
            // the last one is only as long as there is room: how long could it be?
            let mut reach = length;
            while is_last
                && reach * GROWTH <= to - from
                && is_resolved(profile, [from, to], 0.0, (to - reach * GROWTH, to))?
            {
                reach *= GROWTH;
            }
            self.rates.push(1.0 / reach);
            self.counts.push(self.counts[self.counts.len() - 1] + length / reach);
            self.slopes.push(Sampled::new(profile, at, at + length)?.slopes());
            at = if is_last { to } else { at + length };
            self.ends.push(at);
            before = length;
        }
        Ok(())
    }

    /// 1 / (length on which the profile is resolved) at a place within the rod.
    pub fn rate(&self, s: f64) -> f64 {
        self.rates[self.cell(s)]
    }

    /// The arc length that is `count` of the lengths on which the profile is resolved away from `s`, towards the tip if positive: in
    /// what lies between, no cell is overlooked. It may be beyond the ends of the rod.
    pub fn away(&self, s: f64, count: f64) -> f64 {
        let at = self.cell(s);
        let goal = self.counts[at] + (s - self.ends[at]) * self.rates[at] + count;
        let cell = piece_at(&self.counts, goal).clamp(1, self.rates.len()) - 1;
        self.ends[cell] + (goal - self.counts[cell]) / self.rates[cell]
    }

    /// What the slopes of compliance and natural curvature do not exceed between two places within the rod.
    pub fn steepest(&self, from: f64, to: f64) -> [f64; 2] {
        let slopes = &self.slopes[self.cell(from)..=self.cell(to).max(self.cell(from))];
        slopes.iter().fold([0.0; 2], |most: [f64; 2], slopes| [most[0].max(slopes[0]), most[1].max(slopes[1])])
    }

    fn cell(&self, s: f64) -> usize {
        piece_at(&self.ends, s).clamp(1, self.rates.len()) - 1
    }
}

/// Compliance and natural curvature at the nodes of a cell.
struct Sampled {
    length: f64,
    compliance: [f64; NODES],
    natural: [f64; NODES],
}

impl Sampled {
    fn new(profile: &impl Profile, from: f64, to: f64) -> Result<Self, RodError> {
        let (mut compliance, mut natural) = ([0.0; NODES], [0.0; NODES]);
        for i in 0..NODES {
            let s = from + AT[i] * (to - from);
            let stiffness = profile.stiffness(s);
            compliance[i] = 1.0 / stiffness;
            natural[i] = profile.natural_curvature(s);
            if !(stiffness > 0.0 && stiffness.is_finite() && compliance[i].is_finite()) {
                return Err(RodError::Stiffness { s, value: stiffness });
            }
            if !natural[i].is_finite() {
                return Err(RodError::NaturalCurvature { s, value: natural[i] });
            }
        }
        Ok(Self { length: to - from, compliance, natural })
    }

    /// The largest values; those of the natural curvature matter from 1 / L on.
    fn largest(&self) -> [f64; 2] {
        let of = |values: &[f64; NODES], least: f64| values.iter().fold(least, |most: f64, v| most.max(v.abs()));
        [of(&self.compliance, 0.0), of(&self.natural, 1.0)]
    }

    /// The parts of the two highest Legendre coefficients.
    fn highest(&self) -> [f64; 2] {
        [&self.compliance, &self.natural].map(|values| {
            let part = |row: &[f64; NODES]| row.iter().zip(values).map(|(w, v)| w * v).sum::<f64>().abs();
            part(&HIGHEST[0]) + part(&HIGHEST[1])
        })
    }

    /// What the slopes do not exceed: by the Legendre coefficients, since the slope of the n-th Legendre polynomial is at most
    /// n (n + 1) / 2. What the two highest leave out is taken for no more than [`UNRESOLVED`] times their own part.
    fn slopes(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        // the Legendre polynomials at the nodes, by their recurrence
        let x = AT.map(|at| 2.0 * at - 1.0);
        let (mut before, mut here) = ([1.0; NODES], x);
        for n in 1..NODES {
            let degree = n as f64;
            let steepest = 0.5 * degree * (degree + 1.0) * if n + 2 < NODES { 1.0 } else { 1.0 + UNRESOLVED };
            for (sum, values) in sums.iter_mut().zip([&self.compliance, &self.natural]) {
                let projected: f64 = (0..NODES).map(|i| WEIGHT[i] * here[i] * values[i]).sum();
                *sum += steepest * (2.0 * degree + 1.0) * projected.abs();
            }
            let next = |i: usize| ((2.0 * degree + 1.0) * x[i] * here[i] - degree * before[i]) / (degree + 1.0);
            (before, here) = (here, std::array::from_fn(next));
        }
        sums.map(|sum| 2.0 * sum / self.length)
    }

    /// The integrals, and those with the lever to a place that lies by `middle` after the middle of the cell, in `unit`.
    fn integrals(&self, middle: f64, unit: f64) -> [[f64; 2]; 2] {
        [&self.compliance, &self.natural].map(|values| {
            let sum = |weight: &dyn Fn(usize) -> f64| {
                self.length * (0..NODES).map(|i| WEIGHT[i] * weight(i) * values[i]).sum::<f64>()
            };
            [sum(&|_| 1.0), sum(&|i| ((AT[i] - 0.5) * self.length - middle) / unit)]
        })
    }
}

/// Whether the polynomials through the nodes from `from` to `to` describe the profile, which is smooth in `smooth`. The cell before is
/// so long.
fn is_resolved(
    profile: &impl Profile,
    smooth: [f64; 2],
    before: f64,
    (from, to): (f64, f64),
) -> Result<bool, RodError> {
    let cell = Sampled::new(profile, from, to)?;
    let (highest, largest) = (cell.highest(), cell.largest());
    if (0..2).any(|k| highest[k] > RESOLVED * largest[k]) {
        return Ok(false);
    }
    let length = to - from;
    let far = |[part, of_before]: [f64; 2]| (part * length).max(of_before * before);
    let across = [(from - far(BACK)).max(smooth[0]), (from + far(ON)).min(smooth[1])];
    let inside = WINDOWS.map(|part| [from + part * length, (from + (part + WINDOW) * length).min(to)]);
    for [first, last] in inside.into_iter().chain([across]) {
        let (whole, middle) = (Sampled::new(profile, first, last)?, first + 0.5 * (last - first));
        let unit = whole.length;
        let halves = [
            Sampled::new(profile, first, middle)?.integrals(0.25 * unit, unit),
            Sampled::new(profile, middle, last)?.integrals(-0.25 * unit, unit),
        ];
        let whole = whole.integrals(0.0, unit);
        let differ = |k: usize, i: usize| (whole[k][i] - halves[0][k][i] - halves[1][k][i]).abs();
        if (0..2)
            .any(|k| differ(k, 0).max(differ(k, 1)) > (ALIKE + ROUNDING / (smooth[1] - smooth[0])) * unit * largest[k])
        {
            return Ok(false);
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_kinks_wherever_they_are() {
        for i in 1..200 {
            let place = f64::from(i) / 201.0;
            for size in [1.0, 1e-3] {
                let kinked = |s: f64| 1.0 + size * (s - place).abs();
                let found = Mesh::new(&kinked, &[]);
                assert!(
                    matches!(found, Err(RodError::NotSmooth { s }) if (s - place).abs() < 1e-2),
                    "{place}: {found:?}"
                );
                assert!(Mesh::new(&kinked, &[place]).is_ok(), "{place}");
                let bent = crate::model::profile::Bent::new(|_| 1.0, |s: f64| size * (s - place).abs());
                assert!(matches!(Mesh::new(&bent, &[]), Err(RodError::NotSmooth { .. })), "{place}");
            }
        }
    }

    /// Rounding of arc lengths is no kink.
    #[test]
    fn short_parts_are_smooth() {
        for place in [0.01, 0.37, 0.9] {
            for length in [1e-3, 1e-4, 1e-6, 1e-9] {
                let (from, to) = (place, place + length);
                let ramp = |s: f64| 1.0 - 0.5 * ((s - from) / (to - from)).clamp(0.0, 1.0);
                assert!(Mesh::new(&ramp, &[from, to]).is_ok(), "{place} {length}");
            }
        }
    }

    #[test]
    fn goes_away_by_cells() {
        let mesh = Mesh::new(&|s: f64| (1.0 - 0.9 * s).powi(4), &[0.3]).unwrap();
        for (s, count) in [(0.1, 0.0), (0.1, 1.4), (0.7, -2.5), (0.95, 7.0)] {
            let to = mesh.away(s, count);
            assert!((mesh.away(to, -count) - s).abs() < 1e-12, "{s} {count} {to}");
            assert!((to - s) * count >= 0.0);
        }
        // no further than the cells in between, whose numbers are integers at their ends
        let last = mesh.ends.len() - 1;
        assert!(
            mesh.away(mesh.ends[1], 1.0) <= mesh.ends[2] + 1e-12
                && mesh.away(mesh.ends[last - 1], -1.0) >= mesh.ends[last - 2] - 1e-12
        );
    }
}
