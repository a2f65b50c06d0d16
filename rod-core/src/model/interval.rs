//! Intervals of a rod: how the cut at the end changes with start, force and ends, one part after the other; the pieces between
//! joints that an interval passes; bounds of moment and curvature within it.

use crate::model::Cut;
use core::f64::consts::PI;

/// Derivatives of the cut at the end of an interval, each as (x, y, phi, moment). Position moves along with that of the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutSensitivities {
    /// By the slope angle at the start.
    pub by_phi: [f64; 4],
    /// By the bending moment at the start.
    pub by_moment: [f64; 4],
    /// By the force component A.
    pub by_a: [f64; 4],
    /// By the force component B.
    pub by_b: [f64; 4],
    /// By the arc length where the interval starts, its end and the cut at its start kept.
    pub by_from: [f64; 4],
    /// By the arc length where the interval ends: the differential equation itself.
    pub by_to: [f64; 4],
}

/// How a cut along an interval changes with angle, moment and force at the start of the interval.
pub(crate) struct Chain {
    /// As (x, y, phi, moment): by the moment at the start, and by the force components A and B.
    by: [[f64; 4]; 3],
}

impl Chain {
    pub fn new() -> Self {
        Self { by: [[0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4]] }
    }

    /// The changes of angle and moment at the end of the last part, by the moment at the start, A and B.
    pub fn directions(&self) -> [[f64; 2]; 3] {
        self.by.map(|[_, _, phi, moment]| [phi, moment])
    }

    /// All of them: (x, y, phi, moment) by the moment at the start, A and B.
    pub fn all(&self) -> [[f64; 4]; 3] {
        self.by
    }

    /// One part more, by what it adds to the position, and angle and moment at its end.
    pub fn extend(&mut self, ends: [[f64; 4]; 3]) {
        for (by, [x, y, phi, moment]) in self.by.iter_mut().zip(ends) {
            *by = [by[0] + x, by[1] + y, phi, moment];
        }
    }

    /// One part more, by its own sensitivities.
    pub fn then(&mut self, part: &CutSensitivities) {
        let by_force = [[0.0; 4], part.by_a, part.by_b];
        let directions = self.directions();
        self.extend(std::array::from_fn(|i| {
            let [phi, moment] = directions[i];
            std::array::from_fn(|k| phi * part.by_phi[k] + moment * part.by_moment[k] + by_force[i][k])
        }));
    }

    /// The sensitivities of the whole interval from `start`, where the curvature is `kappa_start`, to `end` with `kappa_end`.
    ///
    /// Turning the rod and the force together turns everything: that gives the derivative by the angle. Moving the start along the
    /// rod, the cut there kept, is moving the cut back by the differential equation.
    pub fn finish(self, start: (&Cut, f64), end: (&Cut, f64), a: f64, b: f64) -> CutSensitivities {
        let [by_moment, by_a, by_b] = self.by;
        let ((start, kappa_start), (end, kappa_end)) = (start, end);
        let (dx, dy) = (end.x - start.x, end.y - start.y);
        let turned = [-dy, dx, 1.0, 0.0];
        let by_phi: [f64; 4] = std::array::from_fn(|k| turned[k] + b * by_a[k] - a * by_b[k]);
        let (sin, cos) = start.phi.sin_cos();
        let moment_rate = a * cos + b * sin;
        let moved = [cos, sin, 0.0, 0.0];
        let by_from = std::array::from_fn(|k| -(moved[k] + kappa_start * by_phi[k] + moment_rate * by_moment[k]));
        let (sin, cos) = end.phi.sin_cos();
        CutSensitivities { by_phi, by_moment, by_a, by_b, by_from, by_to: [cos, sin, kappa_end, a * cos + b * sin] }
    }
}

/// Shows the pieces that the interval from `from` to `to` (either way) passes, each with its number and the part of it that belongs
/// to the interval: piece i lies between joint i - 1 and joint i, the first and the last have no end. An interval that starts at a
/// joint starts in the piece on its side; one without length counts as going to the tip.
#[inline]
pub(crate) fn pieces(joints: &[f64], from: f64, to: f64, mut show: impl FnMut(usize, f64, f64)) {
    let mut at = from;
    if to >= from {
        for i in joints.partition_point(|&joint| joint <= from)..=joints.len() {
            let end = joints.get(i).map_or(to, |&joint| joint.min(to));
            show(i, at, end);
            at = end;
            if at >= to {
                return;
            }
        }
    } else {
        for i in (0..=joints.partition_point(|&joint| joint < from)).rev() {
            // an end that is no number stays so
            let end = if i > 0 && joints[i - 1] > to { joints[i - 1] } else { to };
            show(i, at, end);
            at = end;
            if at <= to || at.is_nan() {
                return;
            }
        }
    }
}

/// The piece at an arc length: at a joint that on the side of the tip.
pub(crate) fn piece_at(joints: &[f64], s: f64) -> usize {
    joints.partition_point(|&joint| joint <= s)
}

/// A range of numbers: least and largest.
pub(crate) type Range = (f64, f64);

/// The range of the curvature m g + k over `length`, where the moment goes from one end of `moments` to the other under a force of size
/// `force`, and compliance g and natural curvature k stay within their ranges.
///
/// m' = A cos phi + B sin phi, hence |m'| <= P and |m''| <= P |kappa| with the force P = |(A, B)|: the moment leaves the range of its
/// end values by no more than P l / 2, nor than P |kappa| l^2 / 8.
#[inline(always)]
pub(crate) fn curvature_range(moments: [f64; 2], force: f64, length: f64, compliance: Range, natural: Range) -> Range {
    let bent = largest_curvature(moments, force, length, compliance.1, natural);
    let moment = moment_range(moments, force, length, bent);
    let (low, high) = product(moment, compliance);
    (low + natural.0, high + natural.1)
}

/// What |curvature| does not exceed, by |m'| <= P alone.
#[inline(always)]
pub(crate) fn largest_curvature([m0, m1]: [f64; 2], force: f64, length: f64, compliance: f64, natural: Range) -> f64 {
    (m0.abs().max(m1.abs()) + 0.5 * force * length) * compliance + natural.0.abs().max(natural.1.abs())
}

/// The range of the moment where |curvature| is at most `bent`.
#[inline(always)]
pub(crate) fn moment_range([m0, m1]: [f64; 2], force: f64, length: f64, bent: f64) -> Range {
    let slack = (0.5 * force * length).min(0.125 * force * bent * length * length);
    (m0.min(m1) - slack, m0.max(m1) + slack)
}

/// The sign that the moment has all along a `length` at whose ends it has these values, under a force of size `force` per unit of the least
/// stiffness, for a rod that is straight at rest. None where it is not proven.
///
/// m'' = -q m with q = (A sin phi - B cos phi) / EI: by Sturm's comparison theorem two zeros of m are at least pi / sqrt(force) apart, so that
/// on a shorter length there is one at most, where m changes its sign. So has the curvature of a part whose stiffness and natural curvature are
/// constant: it is proportional to the moment of a straight rod under the same force.
#[inline(always)]
pub(crate) fn sign_between([m0, m1]: [f64; 2], force: f64, length: f64) -> Option<f64> {
    let both = m0 + m1;
    let keeps = m0 * m1 >= 0.0 && force * length * length < PI * PI;
    keeps.then(|| if both == 0.0 { 0.0 } else { both.signum() })
}

/// Cells in which [`sign_by_cells`] bounds the compliance. More cost more, fewer overestimate a compliance that grows.
const CELLS: usize = 8;

/// [`sign_between`] for a rod whose largest compliance between two distances from the start is given. Two zeros of the solution of m'' = -q m at the
/// distances 0 and l need an integral of max(q, 0) x (l - x) / l over x of more than 1 (Hartman and Wintner 1951), so that a rod may be soft
/// next to the ends.
pub(crate) fn sign_by_cells(
    [m0, m1]: [f64; 2],
    force: f64,
    length: f64,
    compliance: impl Fn(f64, f64) -> f64,
) -> Option<f64> {
    if m0 * m1 < 0.0 || force * length * length > 6.0 * CELLS as f64 {
        return None;
    }
    let cell = length / CELLS as f64;
    let integral: f64 = (0..CELLS)
        .map(|k| {
            let (from, to) = (cell * k as f64, cell * (k + 1) as f64);
            // int x (l - x) / l, of the primitive x^2 / 2 - x^3 / 3 l
            let weight = |x: f64| x * x * (0.5 - x / (3.0 * length));
            compliance(from, to) * (weight(to) - weight(from))
        })
        .sum();
    let both = m0 + m1;
    (force * integral < 1.0).then(|| if both == 0.0 { 0.0 } else { both.signum() })
}

/// The sign of all numbers of a range; none where it holds both.
#[inline(always)]
pub(crate) fn sign_of_range((least, largest): Range) -> Option<f64> {
    if least >= 0.0 { Some(f64::from(u8::from(largest > 0.0))) } else { (largest <= 0.0).then_some(-1.0) }
}

/// The range of a number of the first range times a positive one of the second.
#[inline(always)]
pub(crate) fn product((low, high): Range, (least, most): Range) -> Range {
    (low * if low < 0.0 { most } else { least }, high * if high < 0.0 { least } else { most })
}

/// The range of both.
pub(crate) fn union(one: Range, other: Range) -> Range {
    (one.0.min(other.0), one.1.max(other.1))
}
