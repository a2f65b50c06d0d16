//! The evidence for each phase at a place of a scan.

use super::label::Label;
use crate::point::{Clamp, Inverse, MomentZero, NoContact};
use crate::scan::LocalEstimate;
use nalgebra::{Matrix2x3, Vector2, Vector3};
use std::fmt;

/// Error of the criterion, the arc length and the reactions (dimensionless) that solvers and rounding leave. Smaller: exact samples
/// contradict their own phase.
const FLOOR: f64 = 1e-9;
/// Sine of the angle between the motion of the point and its tangent that counts as zero: the error of rates of noise-free data
/// where the reactions are steep.
const SINE: f64 = 1e-6;
/// Standard deviation of the arc length (rod lengths), and relative standard deviation of the force, from which on the length and
/// the tangent criterion are not used: they are not linear in the noise any more.
const BLUR: f64 = 0.05;
/// Standard deviation of a reaction (dimensionless) below which only the noise of its rate enters the tangent criterion.
const NOISY: f64 = 1e-7;
/// Smallest log-likelihood of a phase at one place, so that one bad place does not outweigh all others.
const UNLIKELIEST: f64 = -40.0;
/// Share of single contacts that stand still, as at a vertex.
const STANDING: f64 = 0.3;
/// Standard deviation of the speed of the others along the contour, per path length of the clamp.
const MOVING: f64 = 1.0;
/// Largest log-likelihood of standing still, for the reason of `UNLIKELIEST`.
const MOST_STILL: f64 = 30.0;
/// Standard deviations of the quantities about 0 in the phases that do not require them to vanish: forces, criterion, arc length and
/// normal speed, dimensionless. Larger: noise counts more in favour of the phase that requires 0.
const SPREAD: [f64; 4] = [5.0, 1.0, 0.3, 0.1];
/// Size of the phase criterion over that of the force, where it does not vanish. Larger: weak contacts at the tip are called tangential.
const MOST_CRITERION: f64 = 2.0;
/// Of several contacts that rub, K is 2 sin rho times the sum of the sizes of their forces, and not times the size of their sum. The
/// difference in parts of that: half of the square of half the angle between two forces, here up to 50 degrees. Larger: the criterion
/// tells BB from BA less well; smaller: BB in deep notches contradicts it.
const DIVERGENT: f64 = 0.1;
/// Standard deviations of a force that counts as strong: a contact may begin as gently as this. Larger: a contact that has just begun is
/// taken for noise of the free rod.
const STRONG: f64 = 100.0;

/// Number of criteria of a place.
pub(crate) const CRITERIA: usize = 10;

/// The criteria of a place by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Criterion {
    F0x,
    F0y,
    M0z,
    /// The phase criterion K.
    K,
    Length,
    Tangent,
    /// Length and tangent of the zero of the moment that is nearest to the tip.
    LengthByTip = 7,
    TangentByTip,
}

/// The criteria at one place of a scan, dimensionless (lengths in L, forces in EI/L^2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// The reactions f0x, f0y, m0z: all 0 where the rod is free.
    pub force: [Quantity; 3],
    /// Phase criterion K = m0z^2 - 2 (f0y sin phi0 + f0x cos phi0): 0 where the last contact is tangential (Merker et al.
    /// 2020, eq. 20), negative where it is at the tip; with friction less 2 |F| sin rho. Of a rod that is not uniform it is what K is with a single contact,
    /// -2 force sin(angle from contour to rod).
    pub criterion: Quantity,
    /// Length criterion: arc length at which the moment vanishes, less 1: 0 where the tip alone is in contact.
    pub length: Quantity,
    /// Tangent criterion: speed, across its own tangent, of the point that a single contact would have, per path length of the
    /// clamp: 0 where there is a single contact, also at a vertex, where the point stands still.
    pub tangent: Quantity,
    /// Speed of that point along its tangent, per path length of the clamp: 0 at a vertex or in a notch.
    pub motion: Quantity,
    /// Length, tangent criterion and motion of a later zero of the moment, where one is nearer to the tip than the first.
    again: Option<[Quantity; 3]>,
    /// Weights of the terms of force, criterion, length and tangent: less where neighbouring places say the same.
    trust: [f64; 4],
    /// Whether a contact may be so weak that the criterion is small in every phase.
    weak: bool,
    /// Whether the criterion tells of the last of several contacts, too.
    tells_last: bool,
    /// What the criterion may be where several contacts rub, positive or negative; 0 without friction.
    rubbing: f64,
}

impl Evidence {
    /// The criteria at a place where the reactions and their rates are estimated.
    pub(crate) fn of<I: Inverse>(rod: &I, estimate: &LocalEstimate) -> Self {
        let none = Vector3::zeros();
        let speed = |found: &MomentZero, later| speed(rod, estimate, found, later);
        Self::new(rod, &estimate.clamp, speed, |gradient| estimate.variance(gradient, &none))
    }

    /// The criteria of one sample with noise of this variance. Without rates there is no tangent criterion.
    pub(crate) fn of_sample<I: Inverse>(rod: &I, clamp: &Clamp, variance: &Vector3<f64>) -> Self {
        let unknown = |_: &MomentZero, _| [Quantity::UNKNOWN; 2];
        Self::new(rod, clamp, unknown, |gradient| gradient.component_mul(gradient).dot(variance))
    }

    fn new<I: Inverse>(
        rod: &I,
        clamp: &Clamp,
        speed: impl Fn(&MomentZero, bool) -> [Quantity; 2],
        variance: impl Fn(&Vector3<f64>) -> f64,
    ) -> Self {
        let found = rod.first(clamp);
        let size = 1.0 + clamp.reactions.norm();
        let criterion = rod
            .criterion(clamp, found.as_ref().ok())
            .map_or(Quantity::UNKNOWN, |(k, by_reactions)| Quantity::new(k, variance(&by_reactions), FLOOR * size));
        let length_of = |found: &MomentZero| {
            Quantity::new(found.s - 1.0, variance(&found.s_by_reactions), FLOOR * (1.0 + 1.0 / found.force))
        };
        let length = match &found {
            Ok(found) => length_of(found),
            Err(NoContact::NoMomentZero) => Quantity { value: f64::INFINITY, sigma: 1.0 },
            Err(_) => Quantity::UNKNOWN,
        };
        let [tangent, motion] = found.as_ref().map_or([Quantity::UNKNOWN; 2], |found| speed(found, false));
        let unit = |c: usize| Vector3::from_fn(|i, _| f64::from(u8::from(i == c)));
        let mut evidence = Self {
            force: [0, 1, 2].map(|c| Quantity::new(clamp.reactions[c], variance(&unit(c)), FLOOR)),
            criterion,
            length,
            tangent,
            motion,
            again: found.as_ref().ok().and_then(|found| rod.by_tip(found, clamp)).map(|found| {
                let [tangent, motion] = speed(&found, true);
                [length_of(&found), tangent, motion]
            }),
            trust: [1.0; 4],
            weak: false,
            tells_last: rod.tells_last(),
            rubbing: DIVERGENT * clamp.rubbing().0,
        };
        let force = Vector3::new(clamp.reactions.x, clamp.reactions.y, 0.0);
        let size = force.norm();
        if evidence.length.sigma > BLUR || variance(&(force / size)).sqrt() > BLUR * size {
            evidence.length = Quantity::UNKNOWN;
            (evidence.tangent, evidence.motion, evidence.again) = (Quantity::UNKNOWN, Quantity::UNKNOWN, None);
        }
        evidence
    }

    /// The log-likelihood of a label by each criterion, up to constants common to all labels.
    fn terms(&self, label: Label) -> [(Basis, f64); 4] {
        let [force, criterion, length, tangent] = SPREAD;
        // the criterion is -2 f at most
        let size = self.force[0].value.hypot(self.force[1].value);
        let criterion = if self.weak { criterion * (MOST_CRITERION * size).min(1.0) } else { criterion };
        let of_force =
            |quantity: &Quantity| quantity.vanishes(if self.weak { force.min(STRONG * quantity.sigma) } else { force });
        let (tip, touch) = (self.criterion.not_positive(), self.criterion.vanishes(criterion));
        // A single contact moves along its tangent, or, at a vertex or in a notch, not at all. The point computed from two
        // contacts does neither.
        let single = |across: &Quantity, along: &Quantity| {
            let standing = STANDING * along.vanishes(MOVING).min(MOST_STILL).exp();
            across.vanishes(tangent) + (1.0 - STANDING + standing).ln()
        };
        let last = |of_criterion: f64| if self.tells_last { of_criterion } else { 0.0 };
        let (tip_of_several, touch_of_several) = if self.rubbing * self.criterion.value > 0.0 {
            let wide = Quantity { sigma: self.criterion.sigma.hypot(self.rubbing), ..self.criterion };
            (wide.not_positive(), wide.vanishes(criterion))
        } else {
            (tip, touch)
        };
        let [free, k, s, v] = match label {
            Label::Free => [self.force.iter().map(of_force).sum::<f64>(), 0.0, 0.0, 0.0],
            Label::A => {
                let [s, v, along] = self.again.unwrap_or([self.length, self.tangent, self.motion]);
                [0.0, tip, s.vanishes(length), single(&v, &along)]
            }
            Label::B => [0.0, touch, self.length.not_positive(), single(&self.tangent, &self.motion)],
            Label::BA => [0.0, last(tip_of_several), 0.0, 0.0],
            Label::BB => [0.0, last(touch_of_several), 0.0, 0.0],
        };
        let [force, criterion, length, tangent] = self.trust;
        [
            (Basis::Force, force * free),
            (Basis::Criterion, criterion * k),
            (Basis::Length, length * s),
            (Basis::Tangent, tangent * v),
        ]
    }

    /// The criteria in the order of [`Criterion`].
    pub(crate) fn quantities(&self) -> [Quantity; CRITERIA] {
        let [f0x, f0y, m0z] = self.force;
        let [length, tangent, motion] = self.again.unwrap_or([Quantity::UNKNOWN; 3]);
        [f0x, f0y, m0z, self.criterion, self.length, self.tangent, self.motion, length, tangent, motion]
    }

    /// Whether there is a zero of the moment nearer to the tip than the first.
    pub(crate) fn again(&self) -> bool {
        self.again.is_some()
    }

    /// Adds variances of errors that are not of the noise. So many `places` have the same errors: where these exceed the noise, the
    /// places together tell little more than one.
    pub(crate) fn widen(&mut self, variances: &[f64; CRITERIA], places: f64) {
        let trust = |c: usize, quantity: &Quantity| {
            let (own, shared) = (quantity.sigma * quantity.sigma, variances[c]);
            if own.is_finite() && shared > 0.0 { (own + shared) / (own + places * shared) } else { 1.0 }
        };
        let by_tip = self.again.unwrap_or([self.length, self.tangent, self.motion]);
        let force = [0, 1, 2].map(|c| trust(c, &self.force[c]));
        self.trust = [
            force.into_iter().fold(1.0, f64::min),
            trust(Criterion::K as usize, &self.criterion),
            trust(Criterion::Length as usize, &self.length).min(trust(Criterion::LengthByTip as usize, &by_tip[0])),
            trust(Criterion::Tangent as usize, &self.tangent).min(trust(Criterion::TangentByTip as usize, &by_tip[1])),
        ];
        let own =
            self.force.iter_mut().chain([&mut self.criterion, &mut self.length, &mut self.tangent, &mut self.motion]);
        for (quantity, variance) in own.chain(self.again.iter_mut().flatten()).zip(variances) {
            quantity.sigma = (quantity.sigma * quantity.sigma + variance).sqrt();
        }
    }

    /// The same for a scan that goes on, of whose contacts nothing is known beforehand: they may be weak.
    pub(crate) fn weak(self) -> Self {
        Self { weak: true, ..self }
    }

    /// Log-likelihood of each label, in the order of [`Label::ALL`], up to a common constant.
    pub(crate) fn scores(&self) -> [f64; 5] {
        Label::ALL.map(|label| self.terms(label).iter().map(|term| term.1).sum::<f64>().max(UNLIKELIEST))
    }

    /// The criterion that a single contact of this label contradicts most, with its size in standard deviations.
    pub(crate) fn against(&self, label: Label) -> Option<(Basis, f64)> {
        let [k, one_sided_k] = [self.criterion.z().abs(), self.criterion.z().max(0.0)];
        let of =
            |k: f64, s: f64, v: &Quantity| [(Basis::Criterion, k), (Basis::Length, s), (Basis::Tangent, v.z().abs())];
        let all = match label {
            Label::A => {
                let [s, v, _] = self.again.unwrap_or([self.length, self.tangent, self.motion]);
                of(one_sided_k, s.z().abs(), &v)
            }
            Label::B => of(k, self.length.z().max(0.0), &self.tangent),
            Label::Free => self.force.each_ref().map(|force| (Basis::Force, force.z().abs())),
            Label::BA | Label::BB => return None,
        };
        all.into_iter().filter(|(_, z)| z.is_finite()).max_by(|u, v| u.1.total_cmp(&v.1))
    }

    /// The criterion that decided for this label against the next best one; the diagram, where no criterion does.
    pub fn basis(&self, label: Label) -> Basis {
        let scores = self.scores();
        let others = Label::ALL.into_iter().filter(|other| *other != label);
        let Some(other) = others.max_by(|u, v| scores[*u as usize].total_cmp(&scores[*v as usize])) else {
            return Basis::Diagram;
        };
        let gains = self.terms(label).into_iter().zip(self.terms(other)).map(|(own, their)| (own.0, own.1 - their.1));
        match gains.max_by(|u, v| u.1.total_cmp(&v.1)) {
            Some((basis, gain)) if gain > 1.0 && scores[label as usize] >= scores[other as usize] => basis,
            _ => Basis::Diagram,
        }
    }
}

/// The speed of the moment zero across its tangent and along it, with standard deviations.
fn speed<I: Inverse>(rod: &I, estimate: &LocalEstimate, found: &MomentZero, later: bool) -> [Quantity; 2] {
    let of = |found: &MomentZero| Vector2::from(found.speeds(&found.velocity(&estimate.rate)));
    let value = of(found);
    // The dependence on the reactions themselves matters in noise only: differences over one standard deviation.
    let covariance = estimate.covariance();
    let mut by_value = Matrix2x3::zeros();
    for c in 0..3 {
        let step = covariance[(c, c)].sqrt();
        if step < NOISY {
            continue;
        }
        let mut clamp = estimate.clamp;
        clamp.reactions[c] += step;
        let found = if later { rod.of_tip(&clamp) } else { rod.first(&clamp) };
        let Ok(found) = found else { return [Quantity::UNKNOWN; 2] };
        by_value.set_column(c, &((of(&found) - value) / step));
    }
    let (normal, by_reactions) = (found.normal(), found.by_reactions.fixed_rows::<2>(0).into_owned());
    let floor = FLOOR * (1.0 + 10.0 / found.force) + SINE * value.norm();
    [(0, normal), (1, Vector2::new(normal.y, -normal.x))].map(|(row, direction)| {
        let by_rate: Vector3<f64> = by_reactions.tr_mul(&direction);
        let by_value = by_value.row(row).transpose();
        let speed = Quantity::new(value[row], estimate.variance(&by_value, &by_rate), floor);
        if speed.sigma.is_finite() { speed } else { Quantity::UNKNOWN }
    })
}

/// The criterion that decided a label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Basis {
    /// The size of the reactions.
    Force,
    /// The phase criterion K (Merker et al. 2020, eq. 20).
    Criterion,
    /// The arc length at which the moment vanishes.
    Length,
    /// The direction in which the reconstructed point moves.
    Tangent,
    /// Kinks and the phase diagram: the phases before and after.
    Diagram,
}

impl fmt::Display for Basis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Force => "force",
            Self::Criterion => "criterion",
            Self::Length => "length",
            Self::Tangent => "tangent",
            Self::Diagram => "diagram",
        })
    }
}

/// A quantity that a phase requires to vanish, and its standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantity {
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

impl Quantity {
    /// A quantity of infinite uncertainty.
    pub const UNKNOWN: Self = Self { value: 0.0, sigma: f64::INFINITY };

    /// From a variance, and an error that it has in any case.
    pub(super) fn new(value: f64, variance: f64, floor: f64) -> Self {
        Self { value, sigma: (variance + floor * floor).sqrt() }
    }

    /// Value over standard deviation.
    pub fn z(&self) -> f64 {
        self.value / self.sigma
    }

    /// Log of the odds of "it is 0" against "it is spread about 0 by this standard deviation": 0 where the noise is much wider.
    pub(super) fn vanishes(&self, spread: f64) -> f64 {
        if self.sigma.is_infinite() {
            return 0.0;
        }
        let wide = self.sigma.hypot(spread);
        (wide / self.sigma).ln() - 0.5 * (self.z() * self.z() - (self.value / wide).powi(2))
    }

    /// Log of the likelihood that it is not positive.
    pub(super) fn not_positive(&self) -> f64 {
        let z = self.z().max(0.0);
        -0.5 * z * z
    }
}
