//! A run of stretches with two contacts: from the trails of the first contact to the least-squares solution.

use super::beyond::Beyond;
use super::choice::{Beside, Choice, End, choices};
use super::envelope::NormalSpeed;
use super::guess::guess;
use super::part::Part;
use super::series::Series;
use super::system::{Solution, System};
use super::trail::{Trail, trails};
use super::unknowns::{Unknown, Unknowns};
use super::unresolved::Unresolved;
use super::weights::Tolerance;
use crate::point::{Clamp, Inverse};
use crate::scan::LocalEstimate;
use nalgebra::{DVector, Vector3};

/// Instants of a stretch that are checked, and the largest t among them: at the ends of a series its rates are uncertain.
const INSTANTS: usize = 13;
const WITHIN: f64 = 0.95;
/// Share of the instants at which the signs must be right. Larger: noise at single instants rejects right solutions.
const MOSTLY: f64 = 0.75;
/// A force below this share of the reactions has no certain sign.
const SMALL: f64 = 0.05;
/// The second contact is beyond the tip if it is by more than this many of its standard deviations, and this length of rounding.
const BEYOND: f64 = 1.5;
const ROUNDING: f64 = 1e-6;
/// Error of the mean of (side of the first contact) times (slope of the normal speed) that is noise, dimensionless.
const SIDE: f64 = 0.1;
/// The same in standard deviations of the contact's speed.
const DOUBT: f64 = 2.0;

/// Whether the forces push, the second contact is on the rod and the first contact is on the side of the solid.
///
/// The side of a moving contact follows from the slope of the normal speed along the rod, which is the speed of the contact times
/// the difference of the curvatures of contour and rod.
pub(super) fn are_right<I: Inverse>(rod: &I, part: &Part, solution: &Solution) -> bool {
    let place = |k: usize| -WITHIN + 2.0 * WITHIN * k as f64 / (INSTANTS - 1) as f64;
    let (mut good, mut side, mut doubt) = (0, 0.0, 0.0);
    for k in 0..INSTANTS {
        let local = part.local(&solution.x, place(k));
        let Unknowns([f0x, f0y, m0z, s1, f1, s2]) = local.values;
        let clamp = |i: usize, v: &Unknowns| Clamp {
            pose: local.pose[i],
            reactions: Vector3::from(Unknown::REACTIONS.map(|unknown| v[unknown])),
            natural: if i == 0 { local.natural } else { 0.0 },
            friction: if i == 0 { local.friction } else { 0.0 },
        };
        let estimate = LocalEstimate::exact(clamp(0, &local.values), clamp(1, &local.rates));
        let speed = NormalSpeed::at(rod, &estimate, s1);
        let (_, gradient) = rod.gradient_at(&estimate.clamp, s1);
        let velocity = gradient.rate(&estimate.rate);
        let (sin, cos) = speed.section.phi.sin_cos();
        let along = cos * velocity[0] + sin * velocity[1] + local.rates[Unknown::S1];
        let small = SMALL * (f0x.hypot(f0y) + m0z.abs());
        if f1.abs() > small {
            side += f1.signum() * speed.by_s * along / INSTANTS as f64;
            doubt += speed.by_s.abs() * part.sigma_of_rate(&local, &solution.covariance) / INSTANTS as f64;
        }
        let beyond = Beyond::new(rod, &estimate.clamp, s1);
        let pushes = !part.tip || beyond.pushes(f1, small);
        if !part.tip {
            let covariance = part.covariance(&local, &solution.covariance);
            let sigma = covariance[(Unknown::S2 as usize, Unknown::S2 as usize)].max(0.0).sqrt();
            if s2 - 1.0 > BEYOND * sigma + ROUNDING {
                return false;
            }
        }
        good += usize::from(pushes && s1 > 0.0 && s1 < s2);
    }
    good as f64 >= MOSTLY * INSTANTS as f64 && side > -SIDE - DOUBT * doubt
}

/// Largest misfit that noise explains, as a normal deviate. Larger: contradictory conditions pass, such as those of a missed transition;
/// smaller: right solutions are rejected, one in 40 at 2.
pub(super) const BY_CHANCE: f64 = 2.0;

/// The sum of the weighted squares of a solution, without those that only ask for smoothness, and what noise makes of it on average.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misfit {
    pub squares: f64,
    pub freedom: f64,
}

impl Misfit {
    /// The reactions of a solution have as many degrees of freedom as they have coefficients, less those that the solution takes up: the
    /// trace of what it passes on of each coefficient's error.
    pub fn of<I: Inverse>(system: &System<'_, I>, solution: &Solution) -> Self {
        let free = |part: &Part| -> f64 {
            let weight = &part.series.normal;
            let taken = |unknown: Unknown| {
                let (from, n) = part.columns(unknown);
                // both are symmetric: the trace of their product
                solution.covariance.view((from, from), (n, n)).dot(weight) / part.series.variance[unknown as usize]
            };
            3.0 * part.series.terms() as f64 - Unknown::REACTIONS.into_iter().map(taken).sum::<f64>()
        };
        let squares = (solution.cost - system.roughness(&solution.x)).max(0.0);
        Self { squares, freedom: system.parts.iter().map(free).sum::<f64>().max(1.0) }
    }

    /// The squares as a deviate of the normal distribution (Wilson and Hilferty 1931).
    pub fn deviate(&self) -> f64 {
        let spread = 2.0 / (9.0 * self.freedom);
        ((self.squares / self.freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
    }

    /// Factor by which the variance of the noise is larger than it is taken to be; 1 where the misfit may be chance.
    pub fn excess(&self) -> f64 {
        if self.deviate() < BY_CHANCE { 1.0 } else { self.squares / self.freedom }
    }
}

/// Terms of arc lengths and forces in the first solution.
const FEW_TERMS: usize = 4;
/// By how many terms arc lengths and forces exceed the reactions later: they vary more, because they depend on rates.
const MORE_TERMS: usize = 2;
/// How tightly the conditions are kept in the first, the second and the last solution.
const ROUGH: Tolerance = Tolerance { share: 1.0, floor: 1e-2, steps: 20 };
const MIDDLE: Tolerance = Tolerance { share: 0.5, floor: 1e-3, steps: 20 };
const FINE: Tolerance = Tolerance { share: 0.2, floor: 1e-9, steps: 40 };
/// Most terms of the reactions in the first and the second solution.
const SHORT: [usize; 2] = [8, 14];
/// Smallest standard deviation of a reaction's mean in the first and the second solution, relative to 1 + the force.
const BLURS: [f64; 2] = [3e-4, 1e-5];
/// Steps from the second to the last solution where one is too long: the blur as above, and the floor of the tolerance.
const SHORTER_STEPS: [(f64, f64); 5] = [(1e-6, 1e-4), (1e-6, 1e-5), (1e-7, 1e-6), (1e-9, 1e-7), (0.0, 1e-9)];
/// Choices of trails that go on from the first solution to the second, best first.
const REFINED: usize = 3;
/// Largest sum of weighted squares per measured coefficient of a start from which shorter steps are tried. Smaller: right choices of
/// trails are given up.
const MOST_OFF: f64 = 2.0;
/// Largest misfit of a solution without noise, as a normal deviate: truncated series and rounding.
const MOST_MISFIT_CLEAN: f64 = 6.0;

/// A solution whose sum of weighted squares exceeds that of another by less than this cannot be excluded: a likelihood ratio of
/// exp(-12). Larger: more stretches are given up as ambiguous; smaller: wrong contacts pass.
pub(crate) const AS_GOOD: f64 = 24.0;
/// Distance of the first contacts of two first solutions along the rod, rod lengths, up to which only the better one goes on.
const SAME: f64 = 0.005;
/// Distance of the first contacts of two solutions along the rod, rod lengths, from which on they are not the same.
const ANOTHER: f64 = 0.02;

/// Both contacts of a run.
#[derive(Clone, Debug)]
pub(super) struct Resolved {
    pub parts: Vec<Part>,
    pub solution: Solution,
    /// What is assumed at the ends of the run.
    pub ends: [End; 2],
    /// How tightly the conditions are kept.
    pub tolerance: Tolerance,
    /// Factor on the covariance: the sum of weighted squares per degree of freedom, at least 1.
    pub excess: f64,
}

/// Both contacts along a run of stretches; `true` marks a stretch whose second contact is at the tip.
///
/// The least squares start from a trail of the first contact and are solved three times: with few terms, loose conditions and blurred
/// reactions; with more of each; and as they are.
pub(super) fn solve<I: Inverse>(
    rod: &I,
    stretches: Vec<(Series, bool)>,
    beside: [Option<Beside>; 2],
    clean: bool,
) -> Result<Resolved, Unresolved> {
    let last = stretches.len() - 1;
    let ends = |k: usize| [beside[0].filter(|_| k == 0), beside[1].filter(|_| k == last)].map(|b| b.map(|b| b.s));
    let found: Vec<Vec<Trail>> =
        stretches.iter().enumerate().map(|(k, (series, _))| trails(rod, series, ends(k))).collect();
    let mut choices = choices(&found, beside);
    if choices.is_empty() {
        return Err(Unresolved::NoTouch);
    }
    // the force is determined where the moment at the tip vanishes, or at an end of the run where the first contact comes or goes
    let anchored = |choice: &Choice| choice.ends.iter().any(|end| matches!(end, End::Last { .. }));
    if !stretches.iter().any(|(_, tip)| *tip) {
        choices.retain(anchored);
    }
    // in noise nothing else tells two contacts from three, nor do reactions that leave their series, where the label is not known either
    let exact = clean && (rod.tells_last() || stretches.iter().all(|(series, _)| series.is_exact()));
    if !exact {
        choices.retain(|choice| choice.ends.iter().any(|end| !matches!(end, End::Open)));
    }
    if choices.is_empty() {
        return Err(Unresolved::NoAnchor);
    }
    let mut rough: Vec<(Choice, Vec<Part>, Solution)> = choices
        .into_iter()
        .filter_map(|choice| {
            let parts = blurred(parts(&stretches, SHORT[0], |_| FEW_TERMS), BLURS[0]);
            let guess = guess(rod, &parts, &choice)?;
            let system = System { rod, parts: &parts, ends: choice.ends, tolerance: ROUGH };
            let solution = system.solve(guess)?;
            Some((choice, parts, solution))
        })
        .collect();
    rough.sort_by(|a, b| a.2.cost.total_cmp(&b.2.cost));
    // several trails may lead to one solution
    let mut distinct: Vec<(Choice, Vec<Part>, Solution)> = Vec::new();
    for one in rough {
        let same = |other: &(Choice, Vec<Part>, Solution)| {
            other.0.ends == one.0.ends && !elsewhere((&other.1, &other.2), (&one.1, &one.2), SAME)
        };
        if !distinct.iter().any(same) {
            distinct.push(one);
        }
    }
    let rough = distinct;
    let mut middle: Vec<(Choice, Vec<Part>, Solution)> = rough
        .into_iter()
        .take(REFINED)
        .filter_map(|(choice, few, rough)| {
            let parts = blurred(parts(&stretches, SHORT[1], |series| series.terms() + MORE_TERMS), BLURS[1]);
            let system = System { rod, parts: &parts, ends: choice.ends, tolerance: MIDDLE };
            let solution = system.solve(longer(&few, &parts, &rough.x))?;
            Some((choice, parts, solution))
        })
        .collect();
    middle.sort_by(|a, b| a.2.cost.total_cmp(&b.2.cost));
    let parts = parts(&stretches, usize::MAX, |series| series.terms() + MORE_TERMS);
    let truncated = stretches.iter().any(|(series, _)| series.truncated);
    let measured: usize = parts.iter().map(|part| 3 * part.series.terms()).sum();
    let judged = |system: &System<'_, I>, solution: Solution| {
        let System { parts, ends, tolerance, .. } = *system;
        let misfit = Misfit::of(system, &solution);
        let good = solution.converged
            && misfit.deviate() < if clean { MOST_MISFIT_CLEAN } else { BY_CHANCE }
            && parts.iter().all(|part| are_right(rod, part, &solution));
        good.then(|| Resolved { parts: parts.to_vec(), solution, ends, tolerance, excess: misfit.excess() })
    };
    for (rank, (choice, short, start)) in middle.iter().enumerate() {
        let mut x = longer(short, &parts, &start.x);
        let fine = System { rod, parts: &parts, ends: choice.ends, tolerance: FINE };
        if let Some(found) = fine.solve(x.clone()).and_then(|solution| judged(&fine, solution)) {
            for (_, (choice, short, middle)) in middle.iter().enumerate().filter(|(other, _)| *other != rank) {
                let fine = System { rod, parts: &parts, ends: choice.ends, tolerance: FINE };
                let other = match fine.gauss_newton(longer(short, &parts, &middle.x)) {
                    Some(solution) => judged(&fine, solution).filter(|other| as_good(&other.solution, &found.solution)),
                    // it cannot be excluded by an iteration that does not converge
                    None => {
                        let rough = System { rod, parts: short, ends: choice.ends, tolerance: MIDDLE };
                        judged(&rough, middle.clone()).filter(|_| as_good(middle, start))
                    }
                };
                let there = |other: &Resolved| {
                    elsewhere((&found.parts, &found.solution), (&other.parts, &other.solution), ANOTHER)
                };
                if other.is_some_and(|other| there(&other)) {
                    return Err(Unresolved::Ambiguous);
                }
            }
            return Ok(found);
        }
        // If the choice is right, the last step was too long for the least squares: go there in shorter steps. Where the series are
        // too short for the reactions, keep the last one that succeeds. Otherwise all must: contradictory conditions, such as those
        // of three contacts, agree if they are loose.
        if start.cost > MOST_OFF * measured as f64 {
            continue;
        }
        let mut best = None;
        for (blur, floor) in SHORTER_STEPS {
            let parts = blurred(parts.clone(), blur);
            let system = System { rod, parts: &parts, ends: choice.ends, tolerance: Tolerance { floor, ..FINE } };
            let Some(solution) = system.solve(x.clone()) else { break };
            x = solution.x.clone();
            let Some(found) = judged(&system, solution) else { break };
            best = Some(found).filter(|_| truncated || floor <= FINE.floor);
        }
        if let Some(found) = best {
            return Ok(found);
        }
    }
    Err(Unresolved::Inconsistent)
}

/// Whether a solution explains the reactions nearly as well as another.
fn as_good(other: &Solution, found: &Solution) -> bool {
    other.cost < found.cost + AS_GOOD
}

/// Whether two solutions of a run differ in the first contact by more than this somewhere.
fn elsewhere(a: (&[Part], &Solution), b: (&[Part], &Solution), by: f64) -> bool {
    let s1 =
        |(parts, solution): (&[Part], &Solution), k: usize, t: f64| parts[k].local(&solution.x, t).values[Unknown::S1];
    (0..a.0.len()).any(|k| [-0.8, 0.0, 0.8].into_iter().any(|t| (s1(a, k, t) - s1(b, k, t)).abs() > by))
}

/// The stretches with series of the reactions of at most `short` terms, and this many terms of the others.
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

/// The same with reactions of at least this standard deviation (relative to 1 + the force): with blurred reactions the least squares
/// converge from a distant start.
fn blurred(mut parts: Vec<Part>, blur: f64) -> Vec<Part> {
    for part in &mut parts {
        let series = &mut part.series;
        let size = 1.0 + series.reactions[(0, 0)].hypot(series.reactions[(0, 1)]);
        let least = (blur * size).powi(2) * series.normal[(0, 0)];
        series.variance.apply(|v| *v = v.max(least));
    }
    parts
}

/// The coefficients x of `from` in the longer series of `to`; new terms of the reactions are as measured, others 0.
fn longer(from: &[Part], to: &[Part], x: &DVector<f64>) -> DVector<f64> {
    let mut out = DVector::zeros(to.iter().map(Part::width).sum());
    for (a, b) in from.iter().zip(to) {
        for unknown in Unknown::REACTIONS {
            let (at, terms) = b.columns(unknown);
            out.rows_mut(at, terms).copy_from(&b.series.reactions.column(unknown as usize));
        }
        for unknown in Unknown::ALL {
            let ((source, terms), (at, _)) = (a.columns(unknown), b.columns(unknown));
            out.rows_mut(at, terms).copy_from(&x.rows(source, terms));
        }
    }
    out
}
