//! Forces on a rod from a film of it.

use super::candidate::Candidate;
use super::choose::{Allowed, Chosen, choose};
use super::family::family;
use super::fault::FrameFault;
use super::noise::{LEAST, first_guess};
use super::observation::{Channel, Frame, Measurand, SeenPoint};
use super::observed::Observed;
use super::problem::reactions;
use super::shape::Contact;
use super::verdict::{FamilyMember, FrameVerdict, verdict};
use crate::numeric::chi_squared::wilson_hilferty;
use crate::numeric::median;
use nalgebra::{DVector, Matrix3};
use rod_core::{PhysicalRod, Pose, Reactions, RodModel, Units};

/// Length of the points along the rod, as a share of the length of the rod, beyond which they are not of this rod, and below which they are in
/// another unit.
const LENGTHS: (f64, f64) = (0.02, 1.3);
/// Number of chords by which the length of a frame is measured.
const FEW_CHORDS: usize = 10;
/// Scatter of the points across the rod (L) from which on they are of more than one rod.
const MOST_SCATTER: f64 = 0.03;
/// Share of the points at which they turn back, from which on they are no curve.
const NO_CURVE: f64 = 0.2;
/// Share of the noise that is left with all points in reverse order, from which on it is asked whether they are so.
const LESS_NOISE: f64 = 0.7;
/// By how much chi squared is less with the points in reverse order, at least.
const CLEARLY: f64 = 30.0;
/// Most frames by which that is found.
const FEW: usize = 20;
/// Cosine of the angle between two chords from which on the points turn back: 120 degrees.
const TURNS_BACK: f64 = -0.5;
/// Chords shorter than so many standard deviations have no direction.
const SHARP: f64 = 8.0;
/// Standard deviations within which a shortening is noise.
const SIGMAS: f64 = 4.0;
/// Most frames by which the noise is found.
const SAMPLE: usize = 50;
/// How many times the noise is found anew, where channels of known noise are weighed against points.
const ROUNDS: usize = 3;

/// What is known of a film beside its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSettings {
    /// Largest coefficient of Coulomb friction: the force of a contact on the side is within its cone.
    pub friction: f64,
    /// Standard deviation of each coordinate of the points, m; found from the film where it is not given.
    pub sigma: Option<f64>,
    /// Largest number of contacts, 0 to 2.
    pub most_contacts: usize,
    /// Largest apparent shortening of a rod of which both ends are seen, as a share of its length.
    pub most_shortening: f64,
}

impl Default for ForceSettings {
    fn default() -> Self {
        Self { friction: 0.0, sigma: None, most_contacts: 2, most_shortening: 0.05 }
    }
}

/// What a film tells.
#[derive(Clone, Debug)]
pub struct Film {
    /// Of each frame its forces, or why there are none.
    pub frames: Vec<Result<FrameForces, FrameFault>>,
    /// Standard deviation of each coordinate of points whose own is not known (m): as given, or found.
    pub sigma: f64,
}

/// A contact with its standard deviations, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameContact {
    /// Arc length, m.
    pub s: f64,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Size of the force, N.
    pub force: f64,
    /// Force on the rod along x, N.
    pub fx: f64,
    /// Force on the rod along y, N.
    pub fy: f64,
    /// Whether it is at the tip.
    pub is_tip: bool,
    /// Covariance of (s, x, y, fx, fy).
    pub covariance: [[f64; 5]; 5],
    /// Standard deviation of the size of the force, N.
    pub sigma_force: f64,
}

impl FrameContact {
    /// Adds to the covariance what another explanation of the same contact differs by.
    pub(super) fn add_difference(&mut self, other: &Self) {
        let of = |c: &Self| [c.s, c.x, c.y, c.fx, c.fy];
        let (one, two) = (of(self), of(other));
        add_square(&mut self.covariance, std::array::from_fn(|i| two[i] - one[i]));
        self.sigma_force = self.sigma_force.hypot(other.force - self.force);
    }

    /// Standard deviations of s, x, y, fx, fy.
    pub fn sigmas(&self) -> [f64; 5] {
        std::array::from_fn(|i| self.covariance[i][i].max(0.0).sqrt())
    }
}

/// What a frame tells, SI units. Standard deviations are infinite where the frame does not determine a number.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameForces {
    /// What of it can be relied on.
    pub verdict: FrameVerdict,
    /// The contacts from the base to the tip.
    pub contacts: Vec<FrameContact>,
    /// Where the base of the rod is.
    pub base: Pose,
    /// What the base feels.
    pub reactions: Reactions,
    /// Covariance of (x, y, phi) of the base and (f0x, f0y, m0z).
    pub covariance: [[f64; 6]; 6],
    /// Chi squared of the frame.
    pub chi_squared: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// The probability that chance leaves as much.
    pub p_value: f64,
    /// Apparent shortening of a rod of which both ends are seen, as a share of its length, with its standard deviation.
    pub shortening: Option<(f64, f64)>,
    /// Other contacts that explain the frame too.
    pub rivals: Vec<Vec<FrameContact>>,
    /// Places and forces that explain the frame, where they are not told apart.
    pub family: Vec<FamilyMember>,
}

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

fn allowed(settings: &ForceSettings) -> Allowed {
    Allowed { contacts: settings.most_contacts, friction: settings.friction.max(0.0) }
}

/// The noise of the points (L). Shapes with one contact tell it; where they leave much more than the scatter of neighbouring points, a few frames are
/// asked with as many contacts as are allowed. Where points in reverse order leave much less, the noise is that: then no shape explains them
/// as they are.
fn found_noise<R: PhysicalRod>(rod: &R, frames: &[Frame], settings: &ForceSettings) -> f64 {
    let of_few = |turn: &dyn Fn(&Frame) -> Frame| -> Vec<Frame> {
        frames.iter().step_by(frames.len().div_ceil(FEW).max(1)).map(turn).collect()
    };
    let one = ForceSettings { most_contacts: settings.most_contacts.min(1), ..*settings };
    let (all, few) = (noise(rod, frames, &one), of_few(&Frame::clone));
    let (same, less) = (noise(rod, &few, &one), noise(rod, &of_few(&reversed), &one));
    if less > LEAST && less < LESS_NOISE * same {
        return all.min(less);
    }
    let scatter = first_guess(few.iter(), rod.units().length);
    if settings.most_contacts > 1 && LESS_NOISE * same > scatter {
        return all.min(noise(rod, &few, settings));
    }
    all
}

fn reversed(frame: &Frame) -> Frame {
    let mut reversed = frame.clone();
    reversed.points.reverse();
    reversed
}

/// The noise of the points (L), from what the best shapes leave of a sample of the frames.
fn noise<R: PhysicalRod>(rod: &R, frames: &[Frame], settings: &ForceSettings) -> f64 {
    let needs = |frame: &&Frame| frame.points.len() > 3 && frame.points.iter().any(|point| point.sigma.is_none());
    let usable: Vec<&Frame> =
        frames.iter().filter(needs).filter(|frame| check(rod.units().length, frame, f64::INFINITY).is_ok()).collect();
    let mut sigma = first_guess(usable.iter().copied(), rod.units().length);
    let stride = usable.len().div_ceil(SAMPLE).max(1);
    for _ in 0..ROUNDS {
        let left = usable.iter().step_by(stride).filter_map(|frame| {
            let Chosen { best, .. } = choose(rod.model(), &Observed::new(frame, rod, sigma), allowed(settings))?;
            // by the median of chi squared
            (best.freedom > 0).then(|| best.chi_squared / wilson_hilferty(best.freedom as usize, 0.0))
        });
        let Some(ratio) = median(left.collect()) else { break };
        let next = (sigma * ratio.sqrt()).max(LEAST);
        let is_settled = (next / sigma - 1.0).abs() < 0.02;
        sigma = next;
        if is_settled {
            break;
        }
    }
    sigma
}

/// What is wrong at first sight with a frame of a rod of `length` (m) whose points have the noise `sigma` (L).
pub(super) fn check(length: f64, frame: &Frame, sigma: f64) -> Result<(), FrameFault> {
    let number = |what, of: String, value: f64, expected| FrameFault::Number { what, of, value, expected };
    for (k, SeenPoint { x, y, sigma }) in frame.points.iter().enumerate() {
        let of = || format!("point {k} (from 0)");
        if let Some((what, value)) = [("x", *x), ("y", *y)].into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(number(what, of(), value, "a finite number (m)"));
        }
        if let Some(sigma) = sigma.filter(|sigma| !(*sigma > 0.0 && sigma.is_finite())) {
            return Err(number("sigma", of(), sigma, "a standard deviation larger than 0 (m)"));
        }
    }
    for Channel { quantity, value, sigma } in &frame.channels {
        let of = || format!("the channel {quantity:?}");
        if !value.is_finite() {
            return Err(number("the value", of(), *value, "a finite number"));
        }
        if !(*sigma > 0.0 && sigma.is_finite()) {
            return Err(number("sigma", of(), *sigma, "a standard deviation larger than 0"));
        }
    }
    let poses =
        frame.channels.iter().filter(|c| matches!(c.quantity, Measurand::Base(_) | Measurand::Support(_))).count();
    if frame.points.len() < 3 && (poses < 3 || frame.channels.len() + frame.points.len() < 4) {
        return Err(FrameFault::TooFew { points: frame.points.len(), channels: frame.channels.len() });
    }
    if frame.points.len() < 3 {
        return Ok(());
    }
    let chords: Vec<[f64; 2]> =
        frame.points.windows(2).map(|pair| [pair[1].x - pair[0].x, pair[1].y - pair[0].y]).collect();
    let turns_back = |sharp: f64| {
        let turns = move |pair: &[[f64; 2]]| {
            let [[ax, ay], [bx, by]] = [pair[0], pair[1]];
            let (a, b) = (ax.hypot(ay), bx.hypot(by));
            a > sharp && b > sharp && ax * bx + ay * by < TURNS_BACK * a * b
        };
        chords.windows(2).map(turns)
    };
    // along a few of the points, so that their noise does not add to the length
    let few = frame.points.iter().step_by(frame.points.len().div_ceil(FEW_CHORDS)).chain(frame.points.last());
    let few: Vec<&SeenPoint> = few.collect();
    let measured: f64 = few.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y)).sum();
    let ratio = measured / length;
    let scatter = first_guess(std::iter::once(frame), length);
    if LENGTHS.1 >= ratio && scatter > MOST_SCATTER {
        return Err(FrameFault::Scatter { share: 1e2 * scatter });
    }
    if !(LENGTHS.0..=LENGTHS.1).contains(&ratio) {
        let back = turns_back(0.0).filter(|turns| *turns).count() as f64;
        let hint = match ratio {
            _ if back > NO_CURVE * chords.len() as f64 => "they turn back all along: are two rods mixed?".to_owned(),
            300.0..3000.0 => "are the points in mm?".to_owned(),
            3000.0.. => "are the points in pixels, without a scale?".to_owned(),
            3e-4..3e-3 => "is the rod's length in mm?".to_owned(),
            _ => "is the scale that of the image, and the rod that of the film?".to_owned(),
        };
        return Err(FrameFault::Length { measured, length, hint });
    }
    let back = turns_back(SHARP * sigma * length).position(|turns| turns);
    back.map_or(Ok(()), |k| Err(FrameFault::Order { point: k + 1 }))
}

fn of_frame<R: PhysicalRod>(
    rod: &R,
    frame: &Frame,
    settings: &ForceSettings,
    sigma: f64,
) -> Result<FrameForces, FrameFault> {
    check(rod.units().length, frame, sigma)?;
    let observed = Observed::new(frame, rod, sigma);
    let chosen = choose(rod.model(), &observed, allowed(settings)).ok_or(FrameFault::NoShape)?;
    if !chosen.best.explains() && is_explained_reversed(rod, frame, settings, sigma, chosen.best.chi_squared) {
        return Err(FrameFault::Reversed);
    }
    let shortening = shortening(&chosen.best, &observed);
    if let Some((share, sigma)) = shortening
        && share > settings.most_shortening + SIGMAS * sigma
    {
        return Err(FrameFault::OutOfPlane { shortening: 1e2 * share, most: 1e2 * settings.most_shortening });
    }
    let units = rod.units();
    let Chosen { best, rivals, unseen } = chosen;
    let mut contacts = contacts(&best, &units);
    let vague = |contact: &FrameContact| {
        let share = if contact.force > 0.0 { contact.sigma_force / contact.force } else { f64::INFINITY };
        (contact.sigmas()[0] / units.length, share)
    };
    let sigmas = contacts.iter().map(vague);
    let rival_contacts: Vec<Vec<FrameContact>> = rivals.iter().map(|rival| self::contacts(rival, &units)).collect();
    let of_rivals = rival_contacts.iter().flatten().map(vague);
    let is_placed = !rod.model().is_uniform() || observed.ends != [false; 2] || !observed.channels.is_empty();
    let verdict = verdict(&best, is_placed, sigmas, of_rivals);
    let (pose, reactions, mut covariance) = at_base(&best, &units);
    // what another explanation says differs from this one by an error of this one; of a free rod that is what chance shows, with its own error
    for other in rivals.iter().chain(&unseen) {
        let (base, felt, its_own) = at_base(other, &units);
        let of = |base: &Pose, felt: &Reactions| [base.x, base.y, base.phi, felt.f0x, felt.f0y, felt.m0z];
        let (one, two) = (of(&pose, &reactions), of(&base, &felt));
        add_square(&mut covariance, std::array::from_fn(|i| two[i] - one[i]));
        if unseen.is_some() {
            for i in 3..6 {
                (3..6).for_each(|j| covariance[i][j] += its_own[i][j]);
            }
        }
        let others = self::contacts(other, &units);
        if others.len() == contacts.len() {
            contacts.iter_mut().zip(&others).for_each(|(contact, other)| contact.add_difference(other));
        }
    }
    let is_family = verdict == FrameVerdict::Family && contacts.len() < 2;
    Ok(FrameForces {
        verdict,
        contacts,
        base: pose,
        reactions,
        covariance,
        chi_squared: best.chi_squared,
        freedom: best.freedom.max(0) as usize,
        p_value: best.p_value(),
        shortening,
        rivals: rival_contacts,
        family: if is_family { family(rod.model(), &observed, &units, allowed(settings).friction) } else { Vec::new() },
    })
}

/// Whether the points in reverse order are of a shape of the rod.
fn is_explained_reversed<R: PhysicalRod>(
    rod: &R,
    frame: &Frame,
    settings: &ForceSettings,
    sigma: f64,
    forward: f64,
) -> bool {
    let chosen = choose(rod.model(), &Observed::new(&reversed(frame), rod, sigma), allowed(settings));
    chosen.is_some_and(|chosen| chosen.best.explains() && chosen.best.chi_squared + CLEARLY < forward)
}

/// By how much a rod of which both ends are seen looks too short (share of its length), with its standard deviation.
fn shortening(best: &Candidate, observed: &Observed) -> Option<(f64, f64)> {
    let ([true, true], [first, .., last]) = (observed.ends, &observed.dots[..]) else { return None };
    Some((1.0 - best.feet.last()?, first.sigma.hypot(last.sigma)))
}

/// Covariance J C J^T of numbers with these gradients by the unknowns; infinite where the unknowns are not determined.
fn propagate<const N: usize>(best: &Candidate, gradients: [DVector<f64>; N]) -> [[f64; N]; N] {
    let Some(covariance) = &best.covariance else { return [[f64::INFINITY; N]; N] };
    let spread = gradients.each_ref().map(|gradient| covariance * gradient);
    std::array::from_fn(|i| std::array::from_fn(|j| gradients[i].dot(&spread[j])))
}

fn contacts(best: &Candidate, units: &Units) -> Vec<FrameContact> {
    best.shape.contacts.iter().rev().map(|contact| in_units(best, contact, units)).collect()
}

fn in_units(best: &Candidate, contact: &Contact, units: &Units) -> FrameContact {
    let Contact { node, force, is_tip, .. } = contact;
    let count = best.u.len();
    let gradient = |rate: &dyn Fn(usize) -> f64| DVector::from_fn(count, |k, _| rate(k));
    let [a, b] = force.ab;
    let size = a.hypot(b);
    let covariance = propagate(
        best,
        [
            gradient(&|k| units.length * f64::from(u8::from(node.s_unknown == Some(k)))),
            gradient(&|k| units.length * node.by[k][0]),
            gradient(&|k| units.length * node.by[k][1]),
            gradient(&|k| units.force * force.by[k][1]),
            gradient(&|k| -units.force * force.by[k][0]),
        ],
    );
    FrameContact {
        s: node.s * units.length,
        x: node.cut.x * units.length,
        y: node.cut.y * units.length,
        force: size * units.force,
        fx: b * units.force,
        fy: -a * units.force,
        is_tip: *is_tip,
        covariance,
        sigma_force: sigma_of_size([b, -a].map(|part| part * units.force), &covariance),
    }
}

/// Adds the square of a change, as of one standard deviation.
pub(super) fn add_square<const N: usize>(covariance: &mut [[f64; N]; N], change: [f64; N]) {
    for (row, a) in covariance.iter_mut().zip(change) {
        row.iter_mut().zip(change).for_each(|(entry, b)| *entry += a * b);
    }
}

/// Standard deviation of the size of a force, to second order: a force whose direction is not well known is longer than it looks.
fn sigma_of_size([fx, fy]: [f64; 2], covariance: &[[f64; 5]; 5]) -> f64 {
    if !covariance[3][3].is_finite() {
        return f64::INFINITY;
    }
    let size = fx.hypot(fy);
    let variance =
        |x: f64, y: f64| x * x * covariance[3][3] + 2.0 * x * y * covariance[3][4] + y * y * covariance[4][4];
    let (along, across) = (variance(fx / size, fy / size), variance(-fy / size, fx / size));
    // |f| = along + across^2 / (2 along): half of the squared second term is its spread, a quarter its mean, which is not added
    (along + 0.75 * (across / size).powi(2)).max(0.0).sqrt()
}

fn at_base(best: &Candidate, units: &Units) -> (Pose, Reactions, [[f64; 6]; 6]) {
    let base = &best.shape.base;
    let ([f0x, f0y, m0z], rates) = reactions(&best.shape);
    let Units { length, force, moment, .. } = *units;
    let sizes = [length, length, 1.0, force, force, moment];
    let gradients = std::array::from_fn(|i| {
        DVector::from_fn(best.u.len(), |k, _| sizes[i] * if i < 3 { base.by[k][i] } else { rates(k)[i - 3] })
    });
    (
        Pose { x: base.cut.x * length, y: base.cut.y * length, phi: base.cut.phi },
        Reactions { f0x: f0x * force, f0y: f0y * force, m0z: m0z * moment },
        propagate(best, gradients),
    )
}

impl FrameForces {
    /// Covariance of (f0x, f0y, m0z).
    pub fn reactions_covariance(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.covariance[i + 3][j + 3])
    }
}
