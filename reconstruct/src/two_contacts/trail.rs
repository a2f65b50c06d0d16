//! Where along the rod the first contact of a stretch may run: straight trails through the roots of the normal speed.

use super::envelope::{NormalSpeed, touches};
use super::series::Series;
use crate::scan::local_cubic::Estimate;
use nalgebra::DVector;

/// Instants of a stretch that are looked at.
const INSTANTS: usize = 15;
/// Trails start and end within this many instants of the ends of the stretch.
const ENDS: usize = 5;
/// How far true trails bend away from a straight line, in lengths of the rod.
const BEND: f64 = 0.015;
/// A root this many tolerances away does not belong to the trail.
const FAR: f64 = 3.0;
/// Trails nearer to each other than this at both ends are one.
const SAME: f64 = 0.04;
/// Trails that miss so many of the roots, in parts of all, are none.
const LOST: f64 = 0.9;
/// So many are kept.
const KEPT: usize = 5;

/// A straight trail of the first contact: arc lengths at the start and the end of the stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trail {
    pub ends: [f64; 2],
    /// How badly roots lie along it, from 0 to 1.
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

/// The likeliest trails along a stretch, best first; `beside`: arc lengths of single contacts at its ends.
pub(crate) fn trails(series: &Series, beside: [Option<f64>; 2]) -> Vec<Trail> {
    let place = |k: usize| -0.98 + 1.96 * k as f64 / (INSTANTS - 1) as f64;
    let roots: Vec<Vec<Root>> = (0..INSTANTS).map(|k| roots(series, place(k))).collect();
    // where a neighbour's contact may go on as the first one, the trail may end there
    let near = |k: usize| roots[k].iter().map(move |root| (place(k), root.s));
    let starts: Vec<_> = (0..ENDS).flat_map(near).chain(beside[0].map(|s| (-1.0, s))).collect();
    let stops: Vec<_> = (INSTANTS - ENDS..INSTANTS).flat_map(near).chain(beside[1].map(|s| (1.0, s))).collect();
    let mut all = Vec::new();
    for &(from, a) in &starts {
        for &(to, b) in &stops {
            let line = |t: f64| a + (b - a) * (t - from) / (to - from);
            let ends = [line(-1.0), line(1.0)];
            if ends.iter().all(|s| (0.0..=1.05).contains(s)) {
                let off = roots.iter().enumerate().map(|(k, roots)| off(roots, line(place(k)))).sum::<f64>();
                all.push(Trail { ends, off: off / INSTANTS as f64 });
            }
        }
    }
    all.sort_by(|a, b| a.off.total_cmp(&b.off));
    let mut kept: Vec<Trail> = Vec::new();
    for trail in all {
        let same = |k: &Trail| (0..2).all(|e| (k.ends[e] - trail.ends[e]).abs() < SAME);
        if kept.len() < KEPT && trail.off < LOST && !kept.iter().any(same) {
            kept.push(trail);
        }
    }
    kept
}

fn off(roots: &[Root], s: f64) -> f64 {
    let far = |root: &Root| ((root.s - s).powi(2) / (BEND * BEND + root.variance)).min(FAR * FAR) / (FAR * FAR);
    roots.iter().map(far).fold(1.0, f64::min)
}

fn roots(series: &Series, t: f64) -> Vec<Root> {
    let [clamp, rate] = series.clamps(t);
    let estimate = Estimate::exact(clamp, rate);
    let (_, d) = series.span.basis(t, series.terms());
    let d = DVector::from_vec(d);
    let spread = d.dot(&(&series.inverse * &d));
    let mut found = Vec::new();
    touches(&estimate, 1.0, |s, speed: NormalSpeed| {
        let noise = speed.by_rate.component_mul(&speed.by_rate).dot(&series.variance) * spread;
        let variance = (noise / (speed.by_s * speed.by_s)).min(0.01);
        if s > 0.02 {
            found.push(Root { s, variance });
        }
    });
    found
}
