//! What a frame and a film tell, in SI units.

use super::candidate::Candidate;
use super::ends::HiddenBase;
use super::fault::FrameFault;
use super::pole::FilmPole;
use super::problem::reactions;
use super::shape::Contact;
use super::verdict::{FamilyMember, FrameVerdict};
use nalgebra::DVector;
use rod_core::{Pose, Reactions, Units};

/// What a film tells.
#[derive(Clone, Debug)]
pub struct Film {
    /// Of each frame its forces, or why there are none.
    pub frames: Vec<Result<FrameForces, FrameFault>>,
    /// Standard deviation of each coordinate of points whose own is not known (m): as given, or found.
    pub sigma: f64,
    /// The pole that the rod touches, where the settings have one: none where no pole explains the frames.
    pub pole: Option<FilmPole>,
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
    fn add_difference(&mut self, other: &Self) {
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
    /// The forces if the base is hidden, where the first point is only taken for it and the points do not show all of the rod.
    pub if_hidden: Option<HiddenBase>,
    /// Other contacts that explain the frame too.
    pub rivals: Vec<Vec<FrameContact>>,
    /// Places and forces that explain the frame, where they are not told apart.
    pub family: Vec<FamilyMember>,
}

impl FrameForces {
    /// Base and reactions, in the order of their covariance.
    fn numbers(&self) -> [f64; 6] {
        let (base, felt) = (&self.base, &self.reactions);
        [base.x, base.y, base.phi, felt.f0x, felt.f0y, felt.m0z]
    }

    /// What one shape says.
    pub(super) fn of(shape: &Candidate, verdict: FrameVerdict, contacts: Vec<FrameContact>, units: &Units) -> Self {
        let (base, reactions, covariance) = at_base(shape, units);
        Self {
            verdict,
            contacts,
            base,
            reactions,
            covariance,
            chi_squared: shape.chi_squared,
            freedom: shape.freedom.max(0) as usize,
            p_value: shape.p_value(),
            shortening: None,
            if_hidden: None,
            rivals: Vec::new(),
            family: Vec::new(),
        }
    }

    /// Adds to the covariances of a free rod what a contact that chance shows says of the reactions, with its own error.
    pub(super) fn add_unseen(&mut self, chance: &Self) {
        self.add_difference(chance);
        for i in 3..6 {
            (3..6).for_each(|j| self.covariance[i][j] += chance.covariance[i][j]);
        }
    }

    /// Adds to the covariances what another explanation of the frame differs by.
    pub(super) fn add_difference(&mut self, other: &Self) {
        let (one, two) = (self.numbers(), other.numbers());
        add_square(&mut self.covariance, std::array::from_fn(|i| two[i] - one[i]));
        if self.contacts.len() == other.contacts.len() {
            self.contacts.iter_mut().zip(&other.contacts).for_each(|(one, two)| one.add_difference(two));
        }
    }
}

/// Covariance J C J^T of numbers with these gradients by the unknowns; infinite where the unknowns are not determined.
fn propagate<const N: usize>(best: &Candidate, gradients: [DVector<f64>; N]) -> [[f64; N]; N] {
    let Some(covariance) = &best.covariance else { return [[f64::INFINITY; N]; N] };
    let spread = gradients.each_ref().map(|gradient| covariance * gradient);
    std::array::from_fn(|i| std::array::from_fn(|j| gradients[i].dot(&spread[j])))
}

/// The contacts of a shape, from the base to the tip.
pub(super) fn contacts(best: &Candidate, units: &Units) -> Vec<FrameContact> {
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
fn add_square<const N: usize>(covariance: &mut [[f64; N]; N], change: [f64; N]) {
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

/// The base of a shape, what it feels, and the covariance of both.
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

impl Film {
    /// Adds to the covariances what the films of rods that are off by one standard deviation each, in independent directions, differ by.
    pub fn add_errors_of_the_rod(&mut self, others: &[Self]) {
        for (number, frame) in self.frames.iter_mut().enumerate() {
            let Ok(frame) = frame else { continue };
            for other in others.iter().filter_map(|other| other.frames.get(number)?.as_ref().ok()) {
                if other.contacts.len() == frame.contacts.len() {
                    frame.add_difference(other);
                }
            }
        }
    }
}
