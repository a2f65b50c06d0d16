//! The value of K / (2 |F|) along tangential contacts: sin rho.

use crate::phase::{Evidence, Label, Node, labels, likelihood};
use crate::point::{Clamp, Inverse};
use crate::scan::{Estimate, Noise, Track};
use nalgebra::Vector3;

/// Largest sine of the angle of friction: mu = 3.
const LARGEST: f64 = 0.95;
/// Most places from which the plateau is looked for. More: more time.
const PLACES: usize = 400;
/// Spacing of the values at which the density of places is computed, and the width of a place that is exact.
const SPACING: f64 = 0.005;
const NARROWEST: f64 = 0.01;
/// A place tells nothing where its value has this standard deviation or a larger one.
const VAGUE: f64 = 0.1;
/// Relative standard deviation of the force from which on its direction says nothing.
const WEAK: f64 = 0.1;
/// Values of which the density is at least this part of the largest are tried, and the most of them.
const PART: f64 = 0.2;
const MOST: usize = 4;
/// Turns of labels and least squares at most; they settle in two or three.
const TURNS: usize = 6;
/// Change of the sine below which they have settled.
const SETTLED: f64 = 1e-12;
/// Residuals beyond about this many standard deviations count less and less (Cauchy's weight), because the label may be wrong.
const OUTLYING: f64 = 3.0;
/// Smallest standard deviation of the sine at one place: rounding. Smaller: the noise of noise-free samples decides.
const FINEST: f64 = 1e-9;
/// A plateau this close to 0 is none: sensors, clamps and rods of an ordinary laboratory let K / (2 |F|) be as large.
const NOTHING: f64 = 0.03;
/// Standard deviations by which a place must slide the other way to count as such.
const SIGMAS: f64 = 3.0;

/// K / (2 |F|) of a place without regard to friction, with its standard deviation; none where the force is too weak.
fn ratio<I: Inverse>(rod: &I, estimate: &Estimate, clamp: &Clamp) -> Option<(f64, f64)> {
    let frictionless = Clamp { friction: 0.0, ..*clamp };
    let first = if I::UNIFORM { None } else { Some(rod.first(&frictionless).ok()?) };
    let (k, by) = rod.criterion(&frictionless, first.as_ref())?;
    let force = Vector3::new(clamp.reactions.x, clamp.reactions.y, 0.0);
    let size = force.norm();
    let none = Vector3::zeros();
    let direction = force / size;
    let of_force = estimate.variance(&direction, &none).sqrt();
    let value = k / (2.0 * size);
    let sigma = estimate.variance(&(by / (2.0 * size) - direction * (value / size)), &none).sqrt();
    (size > 0.0 && of_force < WEAK * size && sigma.is_finite() && value.abs() < LARGEST).then_some((value, sigma))
}

/// The estimate at a place, and its clamp: that of the sample itself where samples are clean.
fn place(track: &Track, noise: &Noise, node: &Node) -> (Estimate, Clamp) {
    let estimate = node.fit.at(track.tau[node.index]);
    let clamp = if noise.is_clean() { track.clamps[node.index] } else { estimate.clamp };
    (estimate, clamp)
}

/// How densely the places of a scan lie about each value of K / (2 |F|), by the way of the clamp.
fn density<I: Inverse>(rod: &I, track: &Track, noise: &Noise, nodes: &[Node]) -> Vec<(f64, f64)> {
    let most = (LARGEST / SPACING) as i32;
    let mut density: Vec<(f64, f64)> = (-most..=most).map(|k| (SPACING * f64::from(k), 0.0)).collect();
    let stride = nodes.len().div_ceil(PLACES).max(1);
    for part in nodes.chunks(stride) {
        let (Some(first), Some(last)) = (part.first(), part.last()) else { continue };
        let way = track.tau[last.index] - track.tau[first.index.saturating_sub(1)];
        let (estimate, clamp) = place(track, noise, first);
        let Some((value, sigma)) = ratio(rod, &estimate, &clamp).filter(|(_, sigma)| *sigma < VAGUE) else { continue };
        let width = sigma.hypot(NARROWEST);
        for (at, density) in &mut density {
            let z = (*at - value) / width;
            *density += way / width * (-0.5 * z * z).exp();
        }
    }
    density
}

/// The values about which places are densest, the densest first.
fn peaks(density: &[(f64, f64)]) -> Vec<f64> {
    let top = density.iter().map(|one| one.1).fold(0.0, f64::max);
    let highest = |w: &&[(f64, f64)]| w[1].1 >= w[0].1 && w[1].1 > w[2].1 && w[1].1 > PART * top;
    let mut found: Vec<(f64, f64)> = density.windows(3).filter(highest).map(|w| w[1]).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.truncate(MOST);
    found.into_iter().map(|one| one.0).collect()
}

/// Whether places are dense about a value of K / (2 |F|) that an ordinary laboratory does not explain without friction.
pub(crate) fn rubs<I: Inverse>(rod: &I, track: &Track, noise: &Noise, nodes: &[Node]) -> bool {
    peaks(&density(rod, track, noise, nodes)).iter().any(|peak| peak.abs() > NOTHING)
}

/// Friction as the plateau tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Start {
    /// The coefficient, with the sign of [`FrictionEstimate::mu`](super::FrictionEstimate::mu).
    pub mu: f64,
    /// Its standard deviation by the noise.
    pub sigma: f64,
    /// Residuals of the plateau in standard deviations of their noise, 1 at least.
    pub scatter: f64,
    /// Share of the tangential path along which the rod slides the other way.
    pub against: f64,
    /// Logarithm of the likelihood of the labels with it, and of those without friction.
    pub likelihood: f64,
    pub without: f64,
}

/// The likeliest friction: of size `mu`, if it is known, and of either sign.
pub(crate) fn start<I: Inverse>(rod: &I, track: &Track, noise: &Noise, nodes: &[Node], mu: Option<f64>) -> Start {
    let mut judged = nodes.to_vec();
    judge(rod, track, &mut judged, 0.0);
    let without = likelihood(&judged);
    let tried: Vec<f64> = match mu {
        Some(mu) => vec![mu, -mu],
        None => peaks(&density(rod, track, noise, nodes)).into_iter().map(|sine| tangent(sine)).chain([0.0]).collect(),
    };
    let mut best: Option<Start> = None;
    for first in tried {
        judge(rod, track, &mut judged, first);
        let mut found = level(rod, track, noise, &judged, first, without);
        for _ in 0..if mu.is_some() { 0 } else { TURNS } {
            let before = found.mu;
            judge(rod, track, &mut judged, before);
            found = level(rod, track, noise, &judged, before, without);
            if (found.mu - before).abs() < SETTLED {
                break;
            }
        }
        if let Some(mu) = mu {
            found.mu = mu.copysign(first);
        }
        judge(rod, track, &mut judged, found.mu);
        found.likelihood = likelihood(&judged);
        if best.is_none_or(|best| found.likelihood > best.likelihood) {
            best = Some(found);
        }
    }
    best.unwrap_or(Start { mu: 0.0, sigma: 0.0, scatter: 1.0, against: 0.0, likelihood: without, without })
}

fn tangent(sine: f64) -> f64 {
    sine / (1.0 - sine * sine).sqrt()
}

/// Gives places the evidence that they have with this friction.
fn judge<I: Inverse>(rod: &I, track: &Track, nodes: &mut [Node], friction: f64) {
    for node in nodes {
        node.fit.rub(friction);
        let evidence = Evidence::of(rod, &node.fit.at(track.tau[node.index]));
        node.judged(evidence);
    }
}

/// Least squares of K / (2 |F|) = sin rho over the places that are labelled B; `before` where there are none.
fn level<I: Inverse>(rod: &I, track: &Track, noise: &Noise, nodes: &[Node], before: f64, without: f64) -> Start {
    let labels = labels(nodes);
    let of = |(node, label): (&Node, &(Label, f64))| {
        let (estimate, clamp) = place(track, noise, node);
        let (value, sigma) = ratio(rod, &estimate, &clamp).filter(|_| label.0 == Label::B)?;
        Some((value, sigma.max(FINEST), node.weight, slides(rod, &estimate)))
    };
    let values: Vec<(f64, f64, f64, Option<(f64, f64)>)> = nodes.iter().zip(&labels).filter_map(of).collect();
    let mut sine = before / before.hypot(1.0);
    let (mut information, mut scatter) = (0.0, 1.0);
    for _ in 0..TURNS {
        let (mut sums, mut squares) = ((0.0, 0.0), Vec::with_capacity(values.len()));
        for (value, sigma, weight, _) in &values {
            let z = (value - sine) / (sigma * scatter);
            let weight = weight / (1.0 + (z / OUTLYING).powi(2)) / (sigma * sigma);
            sums = (sums.0 + weight, sums.1 + weight * value);
            squares.push((value - sine) / sigma);
        }
        if sums.0 > 0.0 {
            (information, sine) = (sums.0, sums.1 / sums.0);
        }
        scatter = crate::numeric::robust_sigma(squares.into_iter()).unwrap_or(1.0).max(1.0);
    }
    sine = sine.clamp(-LARGEST, LARGEST);
    let mu = tangent(sine);
    // by derivative of the tangent by the sine
    let sigma = if information > 0.0 { scatter / information.sqrt() * (1.0 - sine * sine).powf(-1.5) } else { f64::INFINITY };
    let way = |all: bool| {
        let counted = values.iter().filter(|(.., slides)| all || slides.is_some_and(|(v, s)| v * mu > SIGMAS * s * mu.abs()));
        counted.map(|value| value.2).sum::<f64>()
    };
    let against = if values.is_empty() || mu == 0.0 { 0.0 } else { way(false) / way(true) };
    Start { mu, sigma, scatter, against, likelihood: without, without }
}

/// The speed of the rod's matter along the rod where the moment vanishes, per way of the clamp, and its standard deviation by the noise
/// of the rates.
fn slides<I: Inverse>(rod: &I, estimate: &Estimate) -> Option<(f64, f64)> {
    let found = rod.first(&estimate.clamp).ok()?;
    let gradient = rod.gradient_at(&estimate.clamp, found.s);
    let rate = gradient.rate(&estimate.rate);
    let (sin, cos) = found.section.phi.sin_cos();
    let by_rate = gradient.by_reactions.row(0).transpose() * cos + gradient.by_reactions.row(1).transpose() * sin;
    let sigma = estimate.variance(&Vector3::zeros(), &by_rate).sqrt();
    Some((cos * rate[0] + sin * rate[1], sigma))
}
