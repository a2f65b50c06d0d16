//! How curved the contour is at the contacts: by its curvature an error along the contour becomes one across.

use super::choice::End;
use super::conditions::two_by;
use super::part::{INSTANTS, Local, Part, place};
use super::run::Resolved;
use super::unknowns::{Gradient, UNKNOWNS, Unknown, Unknowns};
use crate::point::{CrossSection, Inverse};
use nalgebra::{DMatrix, DVector, Vector2};
use rod_core::Dual;

/// Instants to either side between which the curvature of the contour is computed. More: sharp places are averaged away; fewer: noise
/// hides the path of the contact.
const NEARBY: usize = 4;
/// The curvature at an instant is at most this multiple of the mean where the path is known best. Larger: where noise hides the path within some
/// instants, good points are given up; smaller: an apex within a flat stretch is missed.
const SHARPER: f64 = 1.0;
/// The contact passes at least its path less this many standard deviations. Larger: the curvature is overestimated, and points at sharp
/// places are given up; smaller: it is underestimated where noise lengthens the path.
pub(super) const UNSURE: f64 = 4.0;

/// Where a contact is at an instant.
struct Place {
    at: Vector2<f64>,
    /// Angle of the tangent.
    alpha: f64,
    /// Derivative of the position along the tangent by the coefficients of the part.
    along: DVector<f64>,
}

fn both<I: Inverse>(rod: &I, part: &Part, local: &Local) -> [Place; 2] {
    let two = two_by(rod, local);
    let [a, b] = two.force;
    let turn = if part.tip { b.value.atan2(a.value) } else { two.second.phi.value };
    let of = |s: &CrossSection<Dual<f64, UNKNOWNS>>, alpha: f64| {
        let (sin, cos) = alpha.sin_cos();
        let by = Unknowns::from_fn(|u: Unknown| cos * s.x.derivatives[u as usize] + sin * s.y.derivatives[u as usize]);
        let mut row = Vec::new();
        part.spread(local, &Gradient::of_values(by), &mut row);
        let mut along = DVector::zeros(part.width());
        row.iter().for_each(|&(j, by)| along[j - part.start] += by);
        Place { at: Vector2::new(s.x.value, s.y.value), alpha, along }
    };
    [of(&two.first, two.first.phi.value), of(&two.second, turn)]
}

/// The path of the two contacts along a part.
struct Paths {
    places: Vec<[Place; 2]>,
    covariance: DMatrix<f64>,
}

impl Paths {
    fn new<I: Inverse>(rod: &I, found: &Resolved, part: &Part) -> Self {
        let (start, width) = (part.start, part.width());
        Self {
            places: (0..INSTANTS).map(|k| both(rod, part, &part.local(&found.solution.x, place(k)))).collect(),
            covariance: found.solution.covariance.view((start, start), (width, width)) * found.excess,
        }
    }

    /// The largest mean curvature between two instants, given the noise of the path, and the path in its standard deviations.
    fn between(&self, i: usize, from: usize, to: usize) -> (f64, f64) {
        let (p, q) = (&self.places[from][i], &self.places[to][i]);
        // the two places have most of their errors in common
        let by = &q.along - &p.along;
        let sigma = by.dot(&(&self.covariance * &by)).max(0.0).sqrt();
        let way = (q.at - p.at).norm();
        let least = way - UNSURE * sigma;
        let bend = if least > 0.0 { (q.alpha - p.alpha).sin().abs() / least } else { f64::INFINITY };
        (bend, way / sigma.max(f64::MIN_POSITIVE))
    }

    /// The same along the window in which the path is known best.
    fn mean(&self, i: usize) -> f64 {
        let last = INSTANTS - 1;
        let windows = |width: usize| (0..=last - width).step_by(NEARBY).map(move |from| (from, from + width));
        let all =
            [2 * NEARBY, last / 2, last].into_iter().flat_map(windows).map(|(from, to)| self.between(i, from, to));
        all.fold((f64::INFINITY, 0.0), |best, here| if here.1 > best.1 { here } else { best }).0
    }
}

/// The curvature of the contour at the two contacts at each instant of a part, 1/L.
///
/// It is the angle by which the contact's tangent turns over the least length that the contact passes, given its noise: within some
/// instants, or, where noise hides that path, where the same contact's path is known best, in this part, in the other parts of the run,
/// or where it goes on as the single contact beside the run. Infinite where noise hides everywhere whether the contact moves: it may
/// be at a vertex.
pub(super) fn bends<I: Inverse>(rod: &I, found: &Resolved, part: &Part) -> Vec<[f64; 2]> {
    let paths = Paths::new(rod, found, part);
    let others: Vec<Paths> = found
        .parts
        .iter()
        .filter(|other| other.start != part.start)
        .map(|other| Paths::new(rod, found, other))
        .collect();
    let mean = [0, 1].map(|i| {
        let beside = found.ends.iter().map(|end| match *end {
            End::First { bend, .. } if i == 0 => bend,
            End::Last { bend, .. } if i == 1 => bend,
            _ => f64::INFINITY,
        });
        let others = others.iter().map(|paths| paths.mean(i));
        beside.chain(others).fold(paths.mean(i), f64::min)
    });
    let at = |k: usize| {
        let (from, to) = (k.saturating_sub(NEARBY), (k + NEARBY).min(INSTANTS - 1));
        [0, 1].map(|i| paths.between(i, from, to).0.min(SHARPER * mean[i]))
    };
    (0..INSTANTS).map(at).collect()
}
