//! Forces on a rod from a film of it.

use super::candidate::{MOST_STEPS, solve};
use super::check::check;
use super::choose::{Allowed, Chosen, choose};
use super::ends::{hidden_base, shortening};
use super::fault::FrameFault;
use super::judge::{family, verdict};
use super::noise::found_noise;
use super::observation::Frame;
use super::observed::Observed;
use super::pole::{FilmPole, PolePrior};
use super::pole_search::{PoleSearch, Touch};
use super::result::{Film, FrameContact, FrameForces, contacts};
use super::settings::ForceSettings;
use super::verdict::FrameVerdict;
use crate::numeric::CHANCE;
use rod_core::{PhysicalRod, RodModel};

/// By how much chi squared is less with the points in reverse order, at least.
const CLEARLY: f64 = 30.0;
/// Distance of the rim of a pole from the contact, in the noise of the points and in L at least: as good as none. Smaller: a narrower valley
/// for the least squares.
const EXACT: (f64, f64) = (1e-2, 1e-6);

/// The forces on `rod` in each frame, by the elastica through its observations with the fewest contacts that explain them.
///
/// Contacts are without friction, or with a force within the cone of [`ForceSettings::friction`]. With exact points place and force are exact to
/// 1e-9 of the length and of E I / L^2 where the frame determines them. Frames do not depend on each other but for the noise of the points, if
/// that is not known, and the pole that they touch, if the settings have one.
///
/// ```
/// use rod_core::{Elastica, Load, Pose, Rod};
/// use rod_reconstruct::{ForceSettings, Frame, forces};
/// let rod = Rod::new(0.1, 6.3e-4)?; // m, N m^2
/// let load = Load { s: 0.07, force: 0.1, alpha: 0.0 };
/// // the direction across the rod at the contact, by a few rounds
/// let base = Pose { x: 0.0, y: 0.0, phi: 0.3 };
/// let mut shape = Elastica::under_loads(rod.units(), base, &[load])?.0;
/// for _ in 0..60 {
///     shape = Elastica::under_loads(rod.units(), base, &[Load { alpha: shape.at(load.s).phi, ..load }])?.0;
/// }
/// let points: Vec<[f64; 2]> = (0..40).map(|k| shape.at(0.1 * f64::from(k) / 39.0)).map(|at| [at.x, at.y]).collect();
/// let film = forces(&rod, &[Frame::from_base(&points)], &ForceSettings::default());
/// let found = film.frames[0].as_ref().map_err(Clone::clone)?;
/// let contact = &found.contacts[0];
/// assert!((contact.s - 0.07).abs() < 1e-10 && (contact.force - 0.1).abs() < 1e-10 && !contact.is_tip);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn forces<R: PhysicalRod>(rod: &R, frames: &[Frame], settings: &ForceSettings) -> Film {
    let sigma = settings.sigma.map_or_else(|| found_noise(rod, frames, settings), |sigma| sigma / rod.units().length);
    let pole = settings.pole.and_then(|prior| film_pole(rod, frames, settings, sigma, &prior));
    let without = ForceSettings { pole: None, ..*settings };
    let of = |(index, frame): (usize, &Frame)| match &pole {
        Some(pole) if !pole.elsewhere.contains(&index) => of_frame(rod, frame, settings, sigma, Some(pole)),
        _ => of_frame(rod, frame, &without, sigma, None),
    };
    let mut judged: Vec<_> = frames.iter().enumerate().map(of).collect();
    name_reversed(rod, frames, settings, sigma, &mut judged);
    Film { frames: judged, sigma: sigma * rod.units().length, pole }
}

/// Names the frames whose points are in reverse order, if no shape explains most of the frames of the film: all were tracked in one way.
fn name_reversed<R: PhysicalRod>(
    rod: &R,
    frames: &[Frame],
    settings: &ForceSettings,
    sigma: f64,
    judged: &mut [Result<FrameForces, FrameFault>],
) {
    let is_lost = |judged: &Result<FrameForces, FrameFault>| {
        judged.as_ref().map_or_else(
            |fault| matches!(fault, FrameFault::NoShape),
            |judged| judged.verdict == FrameVerdict::NotExplained,
        )
    };
    if 2 * judged.iter().filter(|judged| is_lost(judged)).count() <= judged.len() {
        return;
    }
    for (judged, frame) in judged.iter_mut().zip(frames).filter(|(judged, _)| is_lost(judged)) {
        let forward = judged.as_ref().map_or(f64::INFINITY, |judged| judged.chi_squared);
        if is_explained_reversed(rod, frame, settings, sigma, forward) {
            *judged = Err(FrameFault::Reversed);
        }
    }
}

/// The standard deviation of a pole, L, that is an observation of frames with the noise `sigma`.
fn exact(sigma: f64) -> f64 {
    (EXACT.0 * sigma).max(EXACT.1)
}

/// The pole that the frames touch.
fn film_pole<R: PhysicalRod>(
    rod: &R,
    frames: &[Frame],
    settings: &ForceSettings,
    sigma: f64,
    prior: &PolePrior,
) -> Option<FilmPole> {
    let (units, allowed) = (rod.units(), Allowed::of(settings));
    let usable = frames.iter().enumerate().filter(|(_, frame)| check(units.length, frame, sigma).is_ok());
    let touches: Vec<Touch> = usable
        .filter_map(|(index, frame)| Touch::of(rod.model(), index, Observed::new(frame, rod, sigma), allowed))
        .collect();
    let search = PoleSearch { model: rod.model(), allowed, prior: prior.in_lengths(units.length), exact: exact(sigma) };
    search.pole(touches, &units)
}

fn of_frame<R: PhysicalRod>(
    rod: &R,
    frame: &Frame,
    settings: &ForceSettings,
    sigma: f64,
    pole: Option<&FilmPole>,
) -> Result<FrameForces, FrameFault> {
    let (units, allowed, exact) = (rod.units(), Allowed::of(settings), exact(sigma));
    check(units.length, frame, sigma)?;
    let mut observed = Observed::new(frame, rod, sigma);
    observed.pole = pole.map(|pole| pole.in_lengths(&units, exact));
    let Chosen { best, rivals, unseen } = choose(rod.model(), &observed, allowed).ok_or(FrameFault::NoShape)?;
    let shortening = shortening(&best, &observed);
    if let Some((share, sigma)) = shortening
        && share > settings.most_shortening + CHANCE * sigma
    {
        return Err(FrameFault::OutOfPlane { shortening: 1e2 * share, most: 1e2 * settings.most_shortening });
    }
    let if_hidden = hidden_base(rod.model(), &best, &observed, allowed, &units);
    let mut judged = FrameForces {
        shortening,
        if_hidden,
        ..FrameForces::of(&best, FrameVerdict::Determined, contacts(&best, &units), &units)
    };
    for moved in pole.map(FilmPole::moved).into_iter().flatten() {
        observed.pole = Some(moved.in_lengths(&units, exact));
        if let Some(other) = solve(rod.model(), &observed, &best.start(), allowed.friction, MOST_STEPS) {
            judged.add_difference(&FrameForces::of(&other, FrameVerdict::Determined, contacts(&other, &units), &units));
        }
    }
    let of_rivals: Vec<Vec<FrameContact>> = rivals.iter().map(|rival| contacts(rival, &units)).collect();
    let is_placed = !rod.model().is_uniform() || observed.ends != [false; 2] || !observed.channels.is_empty();
    let verdict = verdict(&best, is_placed, &judged.contacts, of_rivals.iter().flatten(), units.length);
    judged.verdict = verdict;
    if verdict == FrameVerdict::Determined && !best.is_quadratic(rod.model(), &observed, allowed.friction) {
        judged.verdict = FrameVerdict::Uncertain;
    }
    // what another explanation says differs from this one by an error of this one
    for (rival, contacts) in rivals.iter().zip(of_rivals) {
        let other = FrameForces::of(rival, verdict, contacts, &units);
        judged.add_difference(&other);
        judged.rivals.push(other.contacts);
    }
    if let Some(unseen) = &unseen {
        judged.add_unseen(&FrameForces::of(unseen, verdict, contacts(unseen, &units), &units));
    }
    if verdict == FrameVerdict::Family && judged.contacts.len() < 2 {
        judged.family = family(rod.model(), &observed, &units, allowed);
    }
    Ok(judged)
}

/// Whether the points in reverse order are of a shape of the rod.
fn is_explained_reversed<R: PhysicalRod>(
    rod: &R,
    frame: &Frame,
    settings: &ForceSettings,
    sigma: f64,
    forward: f64,
) -> bool {
    let chosen = choose(rod.model(), &Observed::new(&frame.reversed(), rod, sigma), Allowed::of(settings));
    chosen.is_some_and(|chosen| chosen.best.explains() && chosen.best.chi_squared + CLEARLY < forward)
}
