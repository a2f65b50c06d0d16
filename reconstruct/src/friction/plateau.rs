//! The value of K / (2 |F|) along tangential contacts: sin rho.

use crate::least_squares::Loss;
use crate::numeric::{CHANCE, median, robust_sigma};
use crate::phase::{Evidence, Place, label_log_likelihood};
use crate::point::{Clamp, Inverse};
use crate::scan::{LocalEstimate, Noise, Track};
use crate::systematic::Correction;
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
/// Values farther from a peak than this belong to another one.
const NEAR: f64 = 0.02;
/// Turns of medians and least squares about a peak; they settle in three or four.
const TURNS: usize = 8;
/// Residuals beyond about this many standard deviations count less and less (Cauchy's loss), because the label may be wrong.
const OUTLYING: f64 = 3.0;
/// Share of the places by which it is judged whether the plateau is flat, and the size of a standard normal variable that this share does
/// not exceed. Larger: places with several contacts, which noise lets pass for tangential ones, count; smaller: friction that changes along a
/// part of the scan is not told.
const INNER: f64 = 0.8;
const OF_INNER: f64 = 1.2816;
/// Another plateau is one this far from the first: errors of an ordinary laboratory let K / (2 |F|) vary by 0.01 along a scan.
const APART: f64 = 0.015;
/// Smallest part of the path along which another plateau is told. Larger: one piece of an object with another coefficient is missed;
/// smaller: places with several contacts, which noise lets pass for tangential ones, are taken for one.
const ANOTHER: f64 = 0.1;
/// Smallest standard deviation of the sine at one place: rounding. Smaller: the noise of noise-free samples decides.
const FINEST: f64 = 1e-9;
/// A plateau this close to 0 is none: sensors, clamps and rods of an ordinary laboratory let K / (2 |F|) be as large.
const NOTHING: f64 = 0.03;
/// The same absolutely, per way of the clamp: the error of rates of noise-free samples. Smaller: exact samples are no plateau.
const RATE: f64 = 1e-6;

/// K / (2 |F|) of a place without regard to friction, with its standard deviation; none where the force is too weak.
fn ratio<I: Inverse>(rod: &I, estimate: &LocalEstimate, clamp: &Clamp) -> Option<(f64, f64)> {
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

/// The estimate at a place after a correction, if there is one, and its clamp: that of the sample itself where samples are clean.
fn estimate_at(track: &Track, noise: &Noise, place: &Place, tare: Option<&Correction>) -> (LocalEstimate, Clamp) {
    let tau = track.tau[place.index];
    let measured = place.fit.at(tau);
    let sample = if noise.is_clean() { track.clamps[place.index] } else { measured.clamp };
    let Some(tare) = tare else { return (measured, sample) };
    let (clamp, rate) = tare.apply(tau, &measured.clamp, &measured.rate);
    (measured.moved(clamp, rate), tare.apply(tau, &sample, &measured.rate).0)
}

/// A place that kinematics alone tell to be of one contact along the rod's side, whatever its friction: the moment vanishes before the tip,
/// and the rod does not move across itself there.
#[derive(Clone, Copy, Debug)]
struct TangentialPlace {
    /// K / (2 |F|), and its standard deviation.
    value: f64,
    sigma: f64,
    /// Its share of the samples of its window.
    weight: f64,
    /// Way of the clamp to the next one.
    way: f64,
    /// Speed of the rod's matter along the rod per way of the clamp, and its standard deviation.
    slides: (f64, f64),
}

impl TangentialPlace {
    fn of<I: Inverse>(
        rod: &I,
        (track, noise): (&Track, &Noise),
        tare: Option<&Correction>,
        place: &Place,
        way: f64,
    ) -> Option<Self> {
        let (estimate, clamp) = estimate_at(track, noise, place, tare);
        let (value, sigma) = ratio(rod, &estimate, &clamp).filter(|(_, sigma)| *sigma < VAGUE)?;
        let found = rod.first(&estimate.clamp).ok()?;
        let none = Vector3::zeros();
        let before_tip = 1.0 - found.s - CHANCE * estimate.variance(&found.s_by_reactions, &none).sqrt();
        let (_, gradient) = rod.gradient_at(&estimate.clamp, found.s);
        let rate = gradient.rate(&estimate.rate);
        let (sin, cos) = found.section.phi.sin_cos();
        let along = |x: f64, y: f64| {
            let by_rate = gradient.by_reactions.row(0).transpose() * x + gradient.by_reactions.row(1).transpose() * y;
            (x * rate[0] + y * rate[1], estimate.variance(&none, &by_rate).sqrt())
        };
        let (across, of_across) = along(-sin, cos);
        let slides = along(cos, sin);
        let is_one = before_tip > RATE && across.abs() < CHANCE * of_across + RATE * (1.0 + slides.0.abs());
        is_one.then_some(Self { value, sigma: sigma.max(FINEST), weight: place.weight, way, slides })
    }

    /// Of the places of a scan after a correction, if there is one, at most [`PLACES`] of them.
    fn all<I: Inverse>(
        rod: &I,
        track: &Track,
        noise: &Noise,
        places: &[Place],
        tare: Option<&Correction>,
    ) -> Vec<Self> {
        let stride = places.len().div_ceil(PLACES).max(1);
        let of = |part: &[Place]| {
            let (first, last) = (part.first()?, part.last()?);
            let way = track.tau[last.index] - track.tau[first.index.saturating_sub(1)];
            Self::of(rod, (track, noise), tare, first, way)
        };
        places.chunks(stride).filter_map(of).collect()
    }
}

/// How densely places lie about each value of K / (2 |F|), by the way of the clamp.
fn density(sides: &[TangentialPlace]) -> Vec<(f64, f64)> {
    let most = (LARGEST / SPACING) as i32;
    let mut density: Vec<(f64, f64)> = (-most..=most).map(|k| (SPACING * f64::from(k), 0.0)).collect();
    for side in sides {
        let width = side.sigma.hypot(NARROWEST);
        for (at, density) in &mut density {
            let z = (*at - side.value) / width;
            *density += side.way / width * (-0.5 * z * z).exp();
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

/// Whether places, after a correction if there is one, are dense about a value of K / (2 |F|) that an ordinary laboratory does not explain
/// without friction.
pub(crate) fn shows_friction<I: Inverse>(
    rod: &I,
    track: &Track,
    noise: &Noise,
    places: &[Place],
    tare: Option<&Correction>,
) -> bool {
    peaks(&density(&TangentialPlace::all(rod, track, noise, places, tare))).iter().any(|peak| peak.abs() > NOTHING)
}

/// How far places, after a correction, are from the plateau of a coefficient, in standard deviations of their noise (1 at least), and in terms of the coefficient.
pub(crate) fn flatness<I: Inverse>(
    rod: &I,
    track: &Track,
    noise: &Noise,
    places: &[Place],
    correction: &Correction,
    mu: f64,
) -> (f64, f64) {
    off_plateau(&TangentialPlace::all(rod, track, noise, places, Some(correction)), mu)
}

fn off_plateau(sides: &[TangentialPlace], mu: f64) -> (f64, f64) {
    let sine = mu / mu.hypot(1.0);
    let off = |side: &TangentialPlace| side.value - sine;
    let scatter = inner_sigma(sides.iter().map(|side| off(side) / side.sigma)).max(1.0);
    let (size, own) = (inner_sigma(sides.iter().map(off)), median(sides.iter().map(|side| side.sigma).collect()));
    let spread = (size.powi(2) - own.unwrap_or(0.0).powi(2)).max(0.0).sqrt() * (1.0 - sine * sine).powf(-1.5);
    match another_plateau(sides, sine) {
        Some((value, sigma)) => (scatter.max((value - sine).abs() / sigma), spread.max((tangent(value) - mu).abs())),
        None => (scatter, spread),
    }
}

/// Friction as the plateau tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlateauFriction {
    /// The coefficient, with the sign of [`FrictionEstimate::mu`](super::FrictionEstimate::mu).
    pub mu: f64,
    /// Its standard deviation by the noise.
    pub sigma: f64,
    /// Residuals of the plateau in standard deviations of their noise, 1 at least.
    pub scatter: f64,
    /// How much the coefficient varies beyond the noise.
    pub spread: f64,
    /// Share of the tangential path along which the rod slides the other way.
    pub against: f64,
    /// Logarithm of the likelihood of the labels with it, and of those without friction.
    pub likelihood: f64,
    pub without: f64,
}

/// The likeliest friction of places that are judged without, and these places judged with it. Its size is `mu`, if that is known; its sign is the
/// one that the direction of the rod asks for, or the likelier one where no place tells the direction.
pub(crate) fn plateau_friction<I: Inverse>(
    rod: &I,
    track: &Track,
    noise: &Noise,
    places: Vec<Place>,
    mu: Option<f64>,
) -> (PlateauFriction, Vec<Place>) {
    let sides = TangentialPlace::all(rod, track, noise, &places, None);
    let tried: Vec<f64> = match mu {
        Some(mu) => signs(&sides).iter().map(|sign| sign * mu).collect(),
        None => peaks(&density(&sides)).into_iter().map(|peak| tangent(plateau_value(&sides, peak).0)).collect(),
    };
    let without = label_log_likelihood(&places);
    let with_evidence = tried.into_iter().map(|mu| {
        let mut with_evidence = places.clone();
        set_friction(rod, track, &mut with_evidence, mu);
        (mu, label_log_likelihood(&with_evidence), with_evidence)
    });
    let best = with_evidence.max_by(|a, b| a.1.total_cmp(&b.1));
    let (found, likelihood, with_evidence) = best.unwrap_or((0.0, without, places));
    let sine = found / found.hypot(1.0);
    let information = plateau_value(&sides, sine).1;
    let tangent_by_sine = (1.0 - sine * sine).powf(-1.5);
    let (scatter, spread) = off_plateau(&sides, found);
    let backwards = |side: &&TangentialPlace| found * side.slides.0 > CHANCE * side.slides.1 * found.abs() + RATE;
    let all = path_length(sides.iter());
    let against = if all > 0.0 && found != 0.0 { path_length(sides.iter().filter(backwards)) / all } else { 0.0 };
    let sigma = tangent_by_sine / information.sqrt();
    (PlateauFriction { mu: found, sigma, scatter, spread, against, likelihood, without }, with_evidence)
}

fn path_length<'a>(sides: impl Iterator<Item = &'a TangentialPlace>) -> f64 {
    sides.map(|side| side.way).sum()
}

/// The signs that friction may have: against the way in which the rod slides along most of the path.
fn signs(sides: &[TangentialPlace]) -> &'static [f64] {
    let slides =
        |sign: f64| path_length(sides.iter().filter(|side| sign * side.slides.0 > CHANCE * side.slides.1 + RATE));
    let (on, back) = (slides(1.0), slides(-1.0));
    if on == back {
        &[1.0, -1.0]
    } else if on > back {
        &[-1.0]
    } else {
        &[1.0]
    }
}

/// The value of another plateau than that at `sine`, and the standard deviation of one of its places, if a part of the path has one.
fn another_plateau(sides: &[TangentialPlace], sine: f64) -> Option<(f64, f64)> {
    let exact: Vec<TangentialPlace> = sides.iter().copied().filter(|side| side.sigma < NARROWEST).collect();
    let is_off = |side: &TangentialPlace| (side.value - sine).abs() > APART.hypot(CHANCE * side.sigma);
    let off: Vec<TangentialPlace> = exact.iter().copied().filter(is_off).collect();
    let peak = *peaks(&density(&off)).first()?;
    let near = |side: &&TangentialPlace| (side.value - peak).abs() < NARROWEST.hypot(CHANCE * side.sigma);
    let values = off.iter().filter(near).map(|side| side.value).collect();
    let sigmas = off.iter().filter(near).map(|side| side.sigma).collect();
    let found = median(values).zip(median(sigmas));
    found.filter(|_| path_length(off.iter().filter(near)) > ANOTHER * path_length(exact.iter()))
}

/// The standard deviation of normal variables about 0 of which [`INNER`] are no larger than those; 0 without values.
fn inner_sigma(values: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = values.map(f64::abs).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    sizes.get((INNER * sizes.len() as f64) as usize).map_or(0.0, |size| size / OF_INNER)
}

fn tangent(sine: f64) -> f64 {
    sine / (1.0 - sine * sine).sqrt()
}

/// Gives places the evidence that they have with this friction.
fn set_friction<I: Inverse>(rod: &I, track: &Track, places: &mut [Place], friction: f64) {
    for place in places {
        place.fit.set_friction(friction);
        let evidence = Evidence::of(rod, &place.fit.at(track.tau[place.index]));
        place.set_evidence(evidence);
    }
}

/// The value of a plateau about a peak, by medians of what is ever nearer and then by least squares, and how much is known of it.
fn plateau_value(sides: &[TangentialPlace], peak: f64) -> (f64, f64) {
    let (mut sine, mut near) = (peak, NEAR);
    for _ in 0..TURNS {
        let about: Vec<&TangentialPlace> =
            sides.iter().filter(|side| (side.value - sine).abs() < near.hypot(CHANCE * side.sigma)).collect();
        let Some(middle) = median(about.iter().map(|side| side.value).collect()) else { break };
        sine = middle;
        near = CHANCE * robust_sigma(about.iter().map(|side| side.value - sine)).unwrap_or(0.0);
    }
    // a weighted mean whose loss has the scale of the residuals one turn before
    let (mut information, mut scatter) = (0.0, 1.0);
    for _ in 0..TURNS {
        let z = |side: &TangentialPlace| (side.value - sine) / side.sigma;
        let near = sides.iter().filter(|side| (side.value - sine).abs() < NEAR.hypot(CHANCE * side.sigma));
        let next = robust_sigma(near.map(z)).unwrap_or(1.0).max(1.0);
        let loss = Loss::Cauchy(OUTLYING * scatter);
        let mut sums = (0.0, 0.0);
        for side in sides {
            let weight = loss.weight(side.weight, z(side)) / (side.sigma * scatter).powi(2);
            sums = (sums.0 + weight, sums.1 + weight * side.value);
        }
        if sums.0 > 0.0 {
            (information, sine) = (sums.0, sums.1 / sums.0);
        }
        scatter = next;
    }
    (sine.clamp(-LARGEST, LARGEST), information)
}
