//! A rod that slides over one parabola with any coefficient of friction: Newton's method on the segment between clamp and contact. It
//! shares nothing with the inversion but the closed form of a segment.

use nalgebra::{DMatrix, DVector};
use rod_core::{Pose, Reactions, Section, advance};
use rod_reconstruct::{Label, Sample};
use std::f64::consts::FRAC_PI_2;

/// Curvature and vertex of the parabola y = CURVED (x - VERTEX)^2, which is solid above; height of the clamp.
const CURVED: f64 = 5.0;
const VERTEX: f64 = 0.3;
const BELOW: f64 = -0.4;
/// Step of the numerical derivatives, and residual of the solution.
const DIFFERENCE: f64 = 1e-6;
const RESIDUAL: f64 = 1e-14;
const ITERATIONS: usize = 30;

/// A state: the sample, its label, and the contact (s, x, y, alpha).
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub sample: Sample,
    pub label: Label,
    pub contact: Option<[f64; 4]>,
}

/// Height and tangent angle of the parabola.
fn parabola(x: f64) -> (f64, f64) {
    (CURVED * (x - VERTEX).powi(2), (2.0 * CURVED * (x - VERTEX)).atan())
}

/// What vanishes for m0z, force, x of the contact and its arc length; that is 1 at the tip.
fn residual(x0: f64, mu: f64, unknowns: &DVector<f64>) -> (DVector<f64>, Section) {
    let [m0z, force, x] = [unknowns[0], unknowns[1], unknowns[2]];
    let s = unknowns.get(3).copied().unwrap_or(1.0);
    let (y, alpha) = parabola(x);
    let along = alpha + mu.atan();
    let start = Section { x: x0, y: BELOW, phi: FRAC_PI_2, kappa: -m0z };
    let end = advance(&start, force * along.cos(), force * along.sin(), s);
    let mut residual = vec![end.x - x, end.y - y, end.kappa];
    if unknowns.len() > 3 {
        residual.push(end.phi - alpha);
    }
    (DVector::from_vec(residual), end)
}

fn solved(x0: f64, mu: f64, guess: &DVector<f64>) -> Option<DVector<f64>> {
    let mut unknowns = guess.clone();
    for _ in 0..ITERATIONS {
        let (here, _) = residual(x0, mu, &unknowns);
        if here.amax() < RESIDUAL {
            break;
        }
        let n = unknowns.len();
        let jacobian = DMatrix::from_fn(n, n, |i, j| {
            let at = |step: f64| {
                let mut moved = unknowns.clone();
                moved[j] += step;
                residual(x0, mu, &moved).0[i]
            };
            (at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * DIFFERENCE)
        });
        unknowns -= jacobian.lu().solve(&here)?;
    }
    (residual(x0, mu, &unknowns).0.amax() < 1e-12).then_some(unknowns)
}

/// A scan from x0 = 0.75 to `to` in such steps, with the coefficient `mu` at each x0: free, the tip slides, the side slides.
pub fn scan(step: f64, to: f64, mu: impl Fn(f64) -> f64) -> Vec<State> {
    let count = ((0.75 - to) / step).round() as usize;
    let mut before: Option<DVector<f64>> = None;
    let mut earlier: Option<DVector<f64>> = None;
    (0..=count)
        .map(|k| {
            let x0 = 0.75 - step * k as f64;
            let mu = mu(x0);
            let pose = Pose { x: x0, y: BELOW, phi: FRAC_PI_2 };
            let free = State { sample: Sample::new(pose, Reactions::default()), label: Label::Free, contact: None };
            // the straight rod reaches y = 0.6
            let depth = VERTEX + (0.6 / CURVED).sqrt() - x0;
            if depth <= 0.0 {
                return free;
            }
            let first = || DVector::from_vec(vec![3.0 * depth, 3.0 * depth, x0 + depth]);
            let last = before.clone().unwrap_or_else(first);
            // as far beyond the last state as that is beyond the one before
            let guess = match &earlier {
                Some(earlier) if earlier.len() == last.len() => &last * 2.0 - earlier,
                _ => last.clone(),
            };
            let mut found = solved(x0, mu, &guess).unwrap_or_else(|| panic!("no state at {x0}"));
            if found.len() == 3 {
                let (_, end) = residual(x0, mu, &found);
                if end.phi < parabola(found[2]).1 {
                    found = solved(x0, mu, &found.push(1.0)).unwrap();
                }
            }
            (earlier, before) = (before.take(), Some(found.clone()));
            let (y, alpha) = parabola(found[2]);
            let along = alpha + mu.atan();
            let (tip, s) = (found.len() == 3, found.get(3).copied().unwrap_or(1.0));
            let reactions = Reactions { f0x: -found[1] * along.sin(), f0y: found[1] * along.cos(), m0z: found[0] };
            State {
                sample: Sample::new(pose, reactions),
                label: if tip { Label::A } else { Label::B },
                contact: Some([s, found[2], y, alpha]),
            }
        })
        .collect()
}

/// The states of the reference with mu = 0.1 at x0 = 0.3 and 0, where its other parabola is not touched, and the change from tip to side.
#[test]
fn the_generator_agrees_with_the_reference() {
    let states = scan(1e-3, -0.3, |_| 0.1);
    for (x0, expected) in [
        (0.3, [-2.286466861642, 0.906727936128, 1.517548331101]),
        (0.0, [-3.754490854696, 5.418078824528, 3.485394405505]),
    ] {
        let at =
            states.iter().min_by(|a, b| (a.sample.pose.x - x0).abs().total_cmp(&(b.sample.pose.x - x0).abs())).unwrap();
        let Reactions { f0x, f0y, m0z } = at.sample.reactions;
        for (found, expected) in [f0x, f0y, m0z].into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-10, "{x0}: {found} for {expected}");
        }
    }
    let side = states.iter().find(|state| state.label == Label::B).unwrap().sample.pose.x;
    assert!(side < 0.451176713717 && side > 0.451176713717 - 1e-3, "{side}");
}
