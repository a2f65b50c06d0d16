//! A run of stretches with several contacts: which trails the first contact takes, and what least squares makes of
//! them.

use super::beyond::Beyond;
use super::conditions::INPUTS;
use super::envelope::NormalSpeed;
use super::series::Series;
use super::system::{End, Part, Solution, System, Tolerance};
use super::trail::{Trail, trails};
use super::unresolved::Unresolved;
use crate::point::clamp::Clamp;
use crate::point::single::MomentZero;
use crate::scan::local_cubic::Estimate;
use nalgebra::{DVector, Matrix3, Vector3};

/// Terms of arc lengths and forces at first, and by how many they exceed those of the reactions in the end.
const FEW: usize = 4;
const MORE: usize = 2;
/// How tightly the conditions are kept at first, and in the end.
const ROUGH: Tolerance = Tolerance { share: 1.0, floor: 1e-2, steps: 20 };
const MIDDLE: Tolerance = Tolerance { share: 0.5, floor: 1e-3, steps: 20 };
const FINE: Tolerance = Tolerance { share: 0.2, floor: 1e-9, steps: 40 };
/// Terms of the reactions at first, and then.
const SHORT: [usize; 2] = [8, 14];
/// Standard deviations of the reactions' coefficients then, at least, in parts of the force.
const BLUR: [f64; 2] = [3e-4, 1e-5];
/// Steps from there to the end where one is too long: standard deviations, as above, and how tightly conditions are kept.
const PARTS: [(f64, f64); 4] = [(1e-6, 1e-4), (1e-7, 1e-6), (1e-9, 1e-7), (0.0, 1e-9)];
/// Choices of trails along a run that are tried, and of them those that are worked out.
const CHOICES: usize = 6;
const WORKED_OUT: usize = 3;
/// How far apart, in lengths of the rod, trails may be where one stretch follows another.
const GAP: f64 = 0.1;
/// Instants at which forces are guessed and signs are judged.
const JUDGED: usize = 13;
/// Share of them that must have the right signs.
const RIGHT: f64 = 0.75;
/// The mean of the first contact's side, as the normal speed's slope tells it, may be wrong by so much within noise.
const SIDE: f64 = 0.1;
/// And by so many standard deviations of the contact's speed.
const DOUBT: f64 = 2.0;
/// Squared misfit, in units of the noise, of each number measured beyond which conditions are not met.
const MISFIT: f64 = 2.0;

/// A neighbour's single contact next to the run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beside {
    pub last: End,
    pub s: f64,
    pub sigma_s: f64,
    pub way: f64,
}

/// What a run turned out to be.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub parts: Vec<Part>,
    pub solution: Solution,
    /// Variance of what was measured as a multiple of what was told.
    pub excess: f64,
}

/// One choice: a trail for each stretch, and what goes on at the ends.
#[derive(Clone)]
struct Choice {
    trails: Vec<Trail>,
    ends: [End; 2],
    off: f64,
}

/// Both contacts along a run of stretches, each with its tip in contact or not.
pub(crate) fn solve(stretches: Vec<(Series, bool)>, beside: [Option<Beside>; 2]) -> Result<Found, Unresolved> {
    let last = stretches.len() - 1;
    let ends = |k: usize| [beside[0].filter(|_| k == 0), beside[1].filter(|_| k == last)].map(|b| b.map(|b| b.s));
    let found: Vec<Vec<Trail>> = stretches.iter().enumerate().map(|(k, (series, _))| trails(series, ends(k))).collect();
    let mut choices = choices(&found, beside);
    if choices.is_empty() {
        return Err(Unresolved::NoTouch);
    }
    // a force is known where the tip is without moment, or where the first contact comes or goes
    let anchored = |choice: &Choice| choice.ends.iter().any(|end| matches!(end, End::Last { .. }));
    if !stretches.iter().any(|(_, tip)| *tip) {
        choices.retain(anchored);
    }
    if choices.is_empty() {
        return Err(Unresolved::NoAnchor);
    }
    let mut rough: Vec<(Choice, Vec<Part>, Solution)> = choices
        .into_iter()
        .filter_map(|choice| {
            let parts = blurred(parts(&stretches, SHORT[0], |_| FEW), BLUR[0]);
            let guess = guess(&parts, &choice)?;
            let system = System { parts: &parts, ends: choice.ends, tolerance: ROUGH };
            let solution = system.solve(guess)?;
            Some((choice, parts, solution))
        })
        .collect();
    rough.sort_by(|a, b| a.2.cost.total_cmp(&b.2.cost));
    let mut middle: Vec<(Choice, Vec<Part>, Solution)> = rough
        .into_iter()
        .take(WORKED_OUT)
        .filter_map(|(choice, few, rough)| {
            let parts = blurred(parts(&stretches, SHORT[1], |series| series.terms() + MORE), BLUR[1]);
            let system = System { parts: &parts, ends: choice.ends, tolerance: MIDDLE };
            let solution = system.solve(longer(&few, &parts, &rough.x))?;
            Some((choice, parts, solution))
        })
        .collect();
    middle.sort_by(|a, b| a.2.cost.total_cmp(&b.2.cost));
    let parts = parts(&stretches, usize::MAX, |series| series.terms() + MORE);
    let measured: usize = parts.iter().map(|part| 3 * part.series.terms()).sum();
    let judged = |parts: &[Part], solution: Solution| {
        let excess = solution.cost / measured as f64;
        let good = excess < MISFIT && parts.iter().all(|part| right(part, &solution));
        good.then(|| Found { parts: parts.to_vec(), solution, excess: excess.max(1.0) })
    };
    for (choice, short, middle) in middle {
        let mut x = longer(&short, &parts, &middle.x);
        let fine = System { parts: &parts, ends: choice.ends, tolerance: FINE };
        if let Some(found) = fine.solve(x.clone()).and_then(|solution| judged(&parts, solution)) {
            return Ok(found);
        }
        // Too long a step for least squares, if the choice is right: take it in parts, and stay where the last one that
        // succeeds leads.
        if middle.cost > MISFIT * measured as f64 {
            continue;
        }
        let mut best = None;
        for (blur, floor) in PARTS {
            let parts = blurred(parts.clone(), blur);
            let system = System { parts: &parts, ends: choice.ends, tolerance: Tolerance { floor, ..FINE } };
            let Some(solution) = system.solve(x.clone()) else { break };
            x = solution.x.clone();
            let Some(found) = judged(&parts, solution) else { break };
            best = Some(found);
        }
        if let Some(found) = best {
            return Ok(found);
        }
    }
    Err(Unresolved::Inconsistent)
}

fn parts(stretches: &[(Series, bool)], short: usize, terms: impl Fn(&Series) -> usize) -> Vec<Part> {
    let mut start = 0;
    let place = |(series, tip): &(Series, bool)| {
        let series = series.shortened(short);
        let part = Part { terms: terms(&series), series, tip: *tip, start };
        start += part.width();
        part
    };
    stretches.iter().map(place).collect()
}

/// The same with reactions that are known no better than this: least squares converge from afar then.
fn blurred(mut parts: Vec<Part>, blur: f64) -> Vec<Part> {
    for part in &mut parts {
        let series = &mut part.series;
        let size = 1.0 + series.reactions[(0, 0)].hypot(series.reactions[(0, 1)]);
        let least = (blur * size).powi(2) * series.normal[(0, 0)];
        series.variance.apply(|v| *v = v.max(least));
    }
    parts
}

/// The likeliest ways to choose a trail for each stretch, and what happens at the ends then.
fn choices(found: &[Vec<Trail>], beside: [Option<Beside>; 2]) -> Vec<Choice> {
    let mut open = vec![Choice { trails: Vec::new(), ends: [End::Open; 2], off: 0.0 }];
    for trails in found {
        let longer = |choice: &Choice| {
            let end = choice.trails.last().map(|t| t.ends[1]);
            let off = choice.off;
            let mut all = Vec::new();
            for trail in trails {
                let gap = end.map_or(0.0, |e| (e - trail.ends[0]).abs());
                if gap < GAP {
                    let mut choice = choice.clone();
                    choice.trails.push(*trail);
                    choice.off = off + trail.off + gap / GAP;
                    all.push(choice);
                }
            }
            all
        };
        open = open.iter().flat_map(longer).collect();
        open.sort_by(|a, b| a.off.total_cmp(&b.off));
        open.truncate(CHOICES);
    }
    for (side, beside) in beside.into_iter().enumerate() {
        let Some(beside) = beside else { continue };
        let ended = |choice: &Choice| {
            let trail = if side == 0 { choice.trails.first() } else { choice.trails.last() };
            let off = trail.map_or(f64::INFINITY, |t| (t.ends[side] - beside.s).abs());
            let near = GAP + 2.0 * beside.sigma_s;
            let mut all = Vec::new();
            for (end, possible) in
                [(End::First { s: beside.s, way: beside.way }, off < near), (beside.last, off > 0.3 * GAP)]
            {
                if possible {
                    let mut choice = choice.clone();
                    choice.ends[side] = end;
                    all.push(choice);
                }
            }
            all
        };
        open = open.iter().flat_map(ended).collect();
    }
    open.truncate(2 * CHOICES);
    open
}

/// Where to start from: trails as they are, forces from what the ends tell.
fn guess(parts: &[Part], choice: &Choice) -> Option<DVector<f64>> {
    let mut x = DVector::zeros(parts.iter().map(Part::width).sum());
    let count = parts.len();
    // the force at the ends of each part, as far as it is known
    let mut known: Vec<[Option<f64>; 2]> = vec![[None; 2]; count];
    for (side, end) in choice.ends.iter().enumerate() {
        let k = if side == 0 { 0 } else { count - 1 };
        known[k][side] = match *end {
            End::Open => None,
            End::Last { .. } => Some(0.0),
            End::First { s, .. } => {
                let [clamp, _] = parts[k].series.clamps(if side == 0 { -1.0 } else { 1.0 });
                let [a, b] = clamp.force();
                let phi = clamp.at(s).phi;
                Some(a.hypot(b) * (a * phi.cos() + b * phi.sin()).signum())
            }
        };
    }
    let place = |k: usize| -1.0 + 2.0 * k as f64 / (JUDGED - 1) as f64;
    let mut forces: Vec<Vec<f64>> = vec![Vec::new(); count];
    for (k, part) in parts.iter().enumerate().filter(|(_, p)| p.tip) {
        forces[k] = by_tip(part, &choice.trails[k], known[k]);
        let (first, last) = (forces[k][0], forces[k][JUDGED - 1]);
        if k > 0 {
            known[k - 1][1] = Some(first);
        }
        if k + 1 < count {
            known[k + 1][0] = Some(last);
        }
    }
    for (k, part) in parts.iter().enumerate() {
        if !part.tip {
            let (from, to) = match known[k] {
                [Some(a), Some(b)] => (a, b),
                [Some(a), None] | [None, Some(a)] => (a, a),
                _ => (0.0, 0.0),
            };
            forces[k] = (0..JUDGED).map(|i| 0.5 * ((1.0 - place(i)) * from + (1.0 + place(i)) * to)).collect();
        }
        let series = &part.series;
        let n = series.terms();
        for c in 0..3 {
            x.rows_mut(part.start + c * n, n).copy_from(&series.reactions.column(c));
        }
        let u = part.start + 3 * n;
        let trail = choice.trails[k];
        let straight = |x: &mut DVector<f64>, at: usize, ends: [f64; 2]| {
            x[at] = 0.5 * (ends[0] + ends[1]);
            x[at + 1] = 0.5 * (ends[1] - ends[0]);
        };
        straight(&mut x, u, trail.ends);
        // least squares of the forces by Legendre polynomials
        let rows = nalgebra::DMatrix::from_fn(JUDGED, part.terms, |i, j| series.span.basis(place(i), part.terms).0[j]);
        let f = DVector::from_vec(forces[k].clone());
        let coefficients = (rows.tr_mul(&rows)).cholesky()?.solve(&rows.tr_mul(&f));
        x.rows_mut(u + part.terms, part.terms).copy_from(&coefficients);
        if !part.tip {
            let end = |side: usize| -> Option<f64> {
                let other = if side == 0 { k.checked_sub(1) } else { Some(k + 1).filter(|&k| k < count) };
                if other.is_some_and(|other| parts[other].tip) {
                    return Some(1.0);
                }
                let [clamp, _] = series.clamps(if side == 0 { -1.0 } else { 1.0 });
                let last = matches!(choice.ends[side], End::Last { .. });
                last.then(|| MomentZero::of(&clamp, &Matrix3::zeros()).ok().map(|m| m.s)).flatten()
            };
            let beyond = |f: f64, t: f64| {
                let [clamp, _] = series.clamps(t);
                Beyond::new(&clamp, trail.at(t)).second(f).filter(|s| *s < 1.0)
            };
            let ends = match [end(0), end(1)] {
                [Some(a), Some(b)] => [a, b],
                // the rod slides past both contacts
                [Some(a), None] => [a, a + trail.ends[1] - trail.ends[0]],
                [None, Some(b)] => [b + trail.ends[0] - trail.ends[1], b],
                _ => {
                    let s = beyond(forces[k][JUDGED / 2], 0.0).unwrap_or(0.5 * (1.0 + trail.at(0.0)));
                    [s, s]
                }
            };
            straight(&mut x, u + 2 * part.terms, ends);
        }
    }
    Some(x)
}

/// Forces of the first contact for which the tip is without moment, from the end where it is known.
fn by_tip(part: &Part, trail: &Trail, known: [Option<f64>; 2]) -> Vec<f64> {
    let place = |k: usize| -1.0 + 2.0 * k as f64 / (JUDGED - 1) as f64;
    let beyond = |k: usize| {
        let [clamp, _] = part.series.clamps(place(k));
        Beyond::new(&clamp, trail.at(place(k)))
    };
    let mut forces = vec![0.0; JUDGED];
    let backwards = known[0].is_none();
    let mut guess = known[0].or(known[1]).unwrap_or_else(|| scanned(&beyond(JUDGED - 1)));
    for k in 0..JUDGED {
        let k = if backwards { JUDGED - 1 - k } else { k };
        let reach = 0.3 * beyond(k).force[0].hypot(beyond(k).force[1]) + 0.3 * guess.abs() + 0.5;
        if let Some(f) = beyond(k).force_of_tip(guess).filter(|f| (f - guess).abs() < reach) {
            guess = f;
        }
        forces[k] = guess;
    }
    forces
}

/// The smallest force for which the tip is without moment and pushes.
fn scanned(beyond: &Beyond) -> f64 {
    let size = 4.0 * beyond.force[0].hypot(beyond.force[1]) + 1.0;
    let places = 81;
    let force = |k: usize| -size + 2.0 * size * k as f64 / f64::from(places - 1);
    let mut best: Option<f64> = None;
    let mut before = beyond.tip(force(0)).0.kappa;
    for k in 1..places as usize {
        let here = beyond.tip(force(k)).0.kappa;
        if here * before <= 0.0
            && let Some(f) = beyond.force_of_tip(0.5 * (force(k) + force(k - 1)))
        {
            let ([a, b], phi) = (beyond.left(f), beyond.tip(f).0.phi);
            let pushes = a * phi.sin() - b * phi.cos() >= 0.0;
            if pushes && best.is_none_or(|b| f.abs() < b.abs()) {
                best = Some(f);
            }
        }
        before = here;
    }
    best.unwrap_or(0.0)
}

/// The same unknowns in longer series.
fn longer(from: &[Part], to: &[Part], x: &DVector<f64>) -> DVector<f64> {
    let mut out = DVector::zeros(to.iter().map(Part::width).sum());
    for (a, b) in from.iter().zip(to) {
        let (m, n) = (a.series.terms(), b.series.terms());
        for c in 0..3 {
            out.rows_mut(b.start + c * n, n).copy_from(&b.series.reactions.column(c));
            out.rows_mut(b.start + c * n, m).copy_from(&x.rows(a.start + c * m, m));
        }
        for i in 0..if a.tip { 2 } else { 3 } {
            let few = x.rows(a.start + 3 * m + i * a.terms, a.terms).into_owned();
            out.rows_mut(b.start + 3 * n + i * b.terms, a.terms).copy_from(&few);
        }
    }
    out
}

/// Whether forces push and the first contact is on the side of the solid: a moving contact's side is told by the slope
/// of the normal speed, which is the contact's speed times the difference of the curvatures of contour and rod.
fn right(part: &Part, solution: &Solution) -> bool {
    let place = |k: usize| -0.95 + 1.9 * k as f64 / (JUDGED - 1) as f64;
    let (mut good, mut side, mut doubt) = (0, 0.0, 0.0);
    for k in 0..JUDGED {
        let local = part.local(&solution.x, place(k));
        let [f0x, f0y, m0z, s1, f1, s2]: [f64; INPUTS] = local.values;
        let clamp =
            |i: usize, v: &[f64; INPUTS]| Clamp { pose: local.pose[i], reactions: Vector3::new(v[0], v[1], v[2]) };
        let estimate = Estimate::exact(clamp(0, &local.values), clamp(1, &local.rates));
        let speed = NormalSpeed::at(&estimate, s1);
        let (_, gradient) = estimate.clamp.gradient_at(s1);
        let velocity = gradient.rate(&estimate.rate);
        let (sin, cos) = speed.section.phi.sin_cos();
        let along = cos * velocity[0] + sin * velocity[1] + local.rates[3];
        let small = 0.05 * (f0x.hypot(f0y) + m0z.abs());
        if f1.abs() > small {
            side += f1.signum() * speed.by_s * along / JUDGED as f64;
            doubt += speed.by_s.abs() * part.sigma_of_rate(&local, &solution.covariance) / JUDGED as f64;
        }
        let beyond = Beyond::new(&estimate.clamp, s1);
        let ([a, b], phi) = (beyond.left(f1), beyond.tip(f1).0.phi);
        let pushes = !part.tip || a * phi.sin() - b * phi.cos() >= -small;
        good += usize::from(pushes && s1 > 0.0 && s1 < s2 && s2 < 1.05);
    }
    good as f64 >= RIGHT * JUDGED as f64 && side > -SIDE - DOUBT * doubt
}
