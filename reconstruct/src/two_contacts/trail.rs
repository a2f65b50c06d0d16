//! Where along the rod the first contact of a stretch may move: straight trails through the roots of the normal speed.

use super::envelope::{NormalSpeed, touches};
use super::series::Series;
use crate::point::Inverse;
use crate::scan::LocalEstimate;
use nalgebra::DVector;

/// Instants of a stretch at which roots are computed, and the largest t among them: at the ends the rates are uncertain.
const INSTANTS: usize = 15;
const WITHIN: f64 = 0.98;
/// Trails start and end at roots of this many instants at the ends of the stretch.
const ENDS: usize = 5;
/// Standard deviation of a trail from a straight line, rod lengths: trails bend by 0.01 at most in the nine scans of the paper.
const BEND: f64 = 0.015;
/// A root farther from the trail than this many standard deviations does not belong to it.
const FAR: f64 = 3.0;
/// Largest arc length of a trail, rod lengths: the tip and its noise.
const FARTHEST: f64 = 1.05;
/// Smallest arc length of a root, rod lengths: at the clamp itself the normal speed is that of the clamp.
const NEAREST: f64 = 0.02;
/// Largest variance of a root, rod lengths squared: that of a root that may be anywhere nearby.
const MOST_VARIANCE: f64 = 0.01;
/// Trails nearer to each other than this at both ends (rod lengths) count as one.
const SAME: f64 = 0.04;
/// A trail that misses this share of the instants, or more, is rejected.
const LOST: f64 = 0.9;
/// Most trails that are kept.
const MOST_TRAILS: usize = 5;

/// A straight trail of the first contact: arc lengths at the start and the end of the stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trail {
    pub ends: [f64; 2],
    /// How badly the roots fit it: mean of the squared distances, in units of `FAR`, from 0 to 1.
    pub off: f64,
}

impl Trail {
    pub fn at(&self, t: f64) -> f64 {
        0.5 * ((1.0 - t) * self.ends[0] + (1.0 + t) * self.ends[1])
    }
}

/// A root of the normal speed and its variance.
struct Root {
    s: f64,
    variance: f64,
}

/// The likeliest trails along a stretch, best first; `beside`: arc lengths of single contacts at its ends. That the first contact stays
/// where such a single contact is, is always among them: noise may hide its roots.
pub(super) fn trails<I: Inverse>(rod: &I, series: &Series, beside: [Option<f64>; 2]) -> Vec<Trail> {
    let place = |k: usize| -WITHIN + 2.0 * WITHIN * k as f64 / (INSTANTS - 1) as f64;
    let roots: Vec<Vec<Root>> = (0..INSTANTS).map(|k| roots(rod, series, place(k))).collect();
    // where the neighbour's contact may go on as the first one, the trail may end there
    let near = |k: usize| roots[k].iter().map(move |root| (place(k), root.s));
    let starts: Vec<_> = (0..ENDS).flat_map(near).chain(beside[0].map(|s| (-1.0, s))).collect();
    let stops: Vec<_> = (INSTANTS - ENDS..INSTANTS).flat_map(near).chain(beside[1].map(|s| (1.0, s))).collect();
    let mut all = Vec::new();
    for &(from, a) in &starts {
        for &(to, b) in &stops {
            let line = |t: f64| a + (b - a) * (t - from) / (to - from);
            let ends = [line(-1.0), line(1.0)];
            if ends.iter().all(|s| (0.0..=FARTHEST).contains(s)) {
                let off = roots.iter().enumerate().map(|(k, roots)| off(roots, line(place(k)))).sum::<f64>();
                all.push(Trail { ends, off: off / INSTANTS as f64 });
            }
        }
    }
    all.sort_by(|a, b| a.off.total_cmp(&b.off));
    let mut kept: Vec<Trail> = Vec::new();
    for trail in all {
        let same = |k: &Trail| (0..2).all(|e| (k.ends[e] - trail.ends[e]).abs() < SAME);
        if kept.len() < MOST_TRAILS && trail.off < LOST && !kept.iter().any(same) {
            kept.push(trail);
        }
    }
    for s in beside.into_iter().flatten() {
        let near = |k: &Trail| k.ends.iter().all(|end| (end - s).abs() < SAME);
        if !kept.iter().any(near) {
            kept.push(Trail { ends: [s, s], off: LOST });
        }
    }
    kept
}

/// The squared distance of a place to the nearest root, in units of `FAR` standard deviations, 1 at most.
fn off(roots: &[Root], s: f64) -> f64 {
    let far = |root: &Root| ((root.s - s).powi(2) / (BEND * BEND + root.variance)).min(FAR * FAR) / (FAR * FAR);
    roots.iter().map(far).fold(1.0, f64::min)
}

/// The roots of the normal speed at t.
fn roots<I: Inverse>(rod: &I, series: &Series, t: f64) -> Vec<Root> {
    let [clamp, rate] = series.clamps(t);
    let estimate = LocalEstimate::exact(clamp, rate);
    let (_, d) = series.interval.basis(t, series.terms());
    let d = DVector::from_vec(d);
    let spread = d.dot(&(&series.inverse * &d));
    let mut found = Vec::new();
    touches(rod, &estimate, 1.0, |s, speed: NormalSpeed| {
        let noise = speed.by_rate.component_mul(&speed.by_rate).dot(&series.variance) * spread;
        let variance = (noise / (speed.by_s * speed.by_s)).min(MOST_VARIANCE);
        if s > NEAREST {
            found.push(Root { s, variance });
        }
    });
    found
}
