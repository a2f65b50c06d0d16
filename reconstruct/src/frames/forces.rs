//! Forces on a rod from a film of it.

use super::candidate::Candidate;
use super::check::check;
use super::choose::{Allowed, Chosen, choose};
use super::family::family;
use super::fault::FrameFault;
use super::judge::verdict;
use super::noise::found_noise;
use super::observation::Frame;
use super::observed::Observed;
use super::result::{Film, FrameContact, FrameForces, contacts};
use super::settings::ForceSettings;
use super::verdict::FrameVerdict;
use rod_core::{PhysicalRod, RodModel};

/// By how much chi squared is less with the points in reverse order, at least.
const CLEARLY: f64 = 30.0;
/// Standard deviations within which a shortening is noise.
const SIGMAS: f64 = 4.0;

/// The forces on `rod` in each frame, by the elastica through its observations with the fewest contacts that explain them.
///
/// Contacts are without friction, or with a force within the cone of [`ForceSettings::friction`]. With exact points place and force are exact to
/// 1e-9 of the length and of E I / L^2 where the frame determines them. Frames do not depend on each other but for the noise of the points, if
/// that is not known.
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
    let frames = frames.iter().map(|frame| of_frame(rod, frame, settings, sigma)).collect();
    Film { frames, sigma: sigma * rod.units().length }
}

fn of_frame<R: PhysicalRod>(
    rod: &R,
    frame: &Frame,
    settings: &ForceSettings,
    sigma: f64,
) -> Result<FrameForces, FrameFault> {
    let units = rod.units();
    check(units.length, frame, sigma)?;
    let observed = Observed::new(frame, rod, sigma);
    let Chosen { best, rivals, unseen } =
        choose(rod.model(), &observed, Allowed::of(settings)).ok_or(FrameFault::NoShape)?;
    if !best.explains() && is_explained_reversed(rod, frame, settings, sigma, best.chi_squared) {
        return Err(FrameFault::Reversed);
    }
    let shortening = shortening(&best, &observed);
    if let Some((share, sigma)) = shortening
        && share > settings.most_shortening + SIGMAS * sigma
    {
        return Err(FrameFault::OutOfPlane { shortening: 1e2 * share, most: 1e2 * settings.most_shortening });
    }
    let own = contacts(&best, &units);
    let of_rivals: Vec<Vec<FrameContact>> = rivals.iter().map(|rival| contacts(rival, &units)).collect();
    let is_placed = !rod.model().is_uniform() || observed.ends != [false; 2] || !observed.channels.is_empty();
    let verdict = verdict(&best, is_placed, &own, of_rivals.iter().flatten(), units.length);
    let mut told = FrameForces { shortening, ..FrameForces::of(&best, verdict, own, &units) };
    // what another explanation says differs from this one by an error of this one
    for (rival, contacts) in rivals.iter().zip(of_rivals) {
        let other = FrameForces::of(rival, verdict, contacts, &units);
        told.add_difference(&other);
        told.rivals.push(other.contacts);
    }
    if let Some(unseen) = &unseen {
        told.add_unseen(&FrameForces::of(unseen, verdict, contacts(unseen, &units), &units));
    }
    if verdict == FrameVerdict::Family && told.contacts.len() < 2 {
        told.family = family(rod.model(), &observed, &units, Allowed::of(settings));
    }
    Ok(told)
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

/// By how much a rod of which both ends are seen looks too short (share of its length), with its standard deviation.
fn shortening(best: &Candidate, observed: &Observed) -> Option<(f64, f64)> {
    let ([true, true], [first, .., last]) = (observed.ends, &observed.dots[..]) else { return None };
    Some((1.0 - best.feet.last()?, first.sigma.hypot(last.sigma)))
}
