//! The seam between the mechanics of a rod and everything above: what a rod of any kind has to answer.
//!
//! Above this seam (boundary-value problem, its linearisation, shapes) nothing knows whether a rod is uniform, tapered or bent at
//! rest. Which model it is, is a type parameter, so that the uniform rod costs what it costs without a seam.

mod constant;
mod interval;
mod profile;
mod propagator;
mod sections;
mod smooth;
pub(crate) mod uniform;

pub(crate) use interval::Chain;
pub use interval::CutSensitivities;
use interval::sign_of_range;
pub use profile::{Bent, Cone, Profile};
pub(crate) use propagator::check;
pub use propagator::{Cut, Propagator};
pub(crate) use sections::check_sections;
pub use sections::{RodSection, Sections};
pub use smooth::Smooth;
pub(crate) use smooth::gauss::{AT, WEIGHT};
pub use uniform::Uniform;

use crate::error::RodError;
use crate::segment::{Segment, Station};

/// A rod that carries a [`Cut`] along an interval under a constant force, with exact derivatives:
///
/// ```text
/// x' = cos phi   y' = sin phi   phi' = curvature_at(s, m)   m' = A cos phi + B sin phi
/// ```
///
/// (Merker et al. 2020, eq. 10, for m = E I (kappa - kappa0).) All quantities are dimensionless: lengths in the length of the rod,
/// moments in E I / L with a reference stiffness E I, which by convention is that at the clamp.
///
/// # For users
/// [`Uniform`] is the uniform straight rod, [`Sections`] one of uniform sections that may be bent at rest, [`Smooth`] any rod whose
/// stiffness and natural curvature vary ([`Profile`]; [`Cone`] is a taper).
/// [`VaryingRod`](crate::VaryingRod) makes them from SI units. Every model is a [`Propagator`] too:
/// [`GeneralElastica`](crate::GeneralElastica) puts point forces on it.
///
/// # For rod authors
/// 1. A length of 0 gives the start, exactly.
/// 2. A length in two parts gives what it gives in one. A negative length goes back.
/// 3. The moment changes by A dx + B dy (balance of moments).
/// 4. The sensitivities are the derivatives of what [`carry`](Self::carry) gives.
/// 5. Beyond its ends, s < 0 and s > 1, the rod goes on, with continuous curvature and sensitivities: a solver may try a contact there.
/// 6. The curvature between two places of a segment stays within [`curvature_bounds`](Self::curvature_bounds). The bounds close in on the
///    curvature where the places do. It keeps the sign that [`one_bend`](Self::one_bend) tells.
/// 7. No part of the rod between two places is less stiff than [`least_stiffness`](Self::least_stiffness) says. On 6 and 7 rest the proofs of
///    a sweep.
/// 8. What is not finite, or cannot be computed, gives NaN: never a panic, never an endless loop.
///
/// At a place where stiffness or natural curvature jump, an interval that ends or begins there belongs to the side on which it lies,
/// and [`curvature_at`](Self::curvature_at) to the side of the tip.
pub trait RodModel {
    /// The cut at arc length `s + length` from the cut `start` at arc length `s`, along a piece that carries the force
    /// (A, B) = (`a`, `b`), with its derivatives.
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities);

    /// The curvature (1/L) at arc length `s` under the bending moment `moment`.
    fn curvature_at(&self, s: f64, moment: f64) -> f64;

    /// The bending energy (E I / L) of a segment that ends at arc length `to` with the cut `end`.
    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64;

    /// The same; and shows what is left of the segment at each place that the computation passes, in order from the start: nowhere, unless a model says otherwise.
    fn bending_energy_by_parts(
        &self,
        segment: &Segment<Cut>,
        to: f64,
        end: &Cut,
        _show: &mut dyn FnMut(Segment<Cut>),
    ) -> f64 {
        self.bending_energy(segment, to, end)
    }

    /// The largest |curvature| (1/L) along a segment that ends at arc length `to` with the cut `end`.
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64;

    /// The largest |curvature| (1/L) from the cut `start` at arc length `s` to `to`, where no force acts: of the free end of a rod.
    fn largest_free_curvature(&self, s: f64, start: &Cut, to: f64) -> f64 {
        let end = self.carry(s, start, 0.0, 0.0, to - s);
        self.largest_curvature(&Segment { s, start: *start, a: 0.0, b: 0.0 }, to, &end)
    }

    /// Least and largest curvature (1/L) between two places of a segment that carries a force of size `force`, |(A, B)|, each given as
    /// arc length and moment, the one next to the clamp first. On these bounds rests the proof that a rod stays outside of an object.
    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64);

    /// The sense in which the rod bends all along between two places of a segment that carries a force of size `force`, each given as arc
    /// length and moment, the one next to the clamp first: 1 or -1, or 0 where it is straight. None where it is not proven that the curvature
    /// keeps its sign. On it rests the proof that a segment stays within the triangle of its chord and of the tangents at its ends.
    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        sign_of_range(self.curvature_bounds(from, to, force))
    }

    /// The least bending stiffness (E I) between two arc lengths: on it rests the proof that a segment does not buckle between its ends.
    fn least_stiffness(&self, from: f64, to: f64) -> f64;

    /// Whether the rod is straight at rest. Where it says so, a part without load is one line.
    fn is_straight(&self) -> bool {
        false
    }

    /// Arc lengths, growing, at which stiffness or natural curvature may jump: a contact that slides over one turns the rod at once.
    fn joints(&self) -> &[f64] {
        &[]
    }

    /// Whether the rod is uniform with E I = 1 and straight at rest: then its moment is its curvature.
    fn is_uniform(&self) -> bool {
        false
    }

    /// Visits the first `count` points after the start of a segment, at equal distances of which `steps` make `length` (not negative).
    fn stations(
        &self,
        segment: &Segment<Cut>,
        (length, steps): (f64, usize),
        count: usize,
        mut visit: impl FnMut(Station),
    ) where
        Self: Sized,
    {
        let (mut cut, h) = (segment.start, length / steps as f64);
        for k in 0..count {
            cut = self.carry(segment.s + h * k as f64, &cut, segment.a, segment.b, h);
            visit(Station::from(&cut));
        }
    }

    /// The cut alone.
    fn carry(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        self.carry_with_sensitivities(s, start, a, b, length).0
    }

    /// The curvature at rest, 1/L.
    fn natural_curvature(&self, s: f64) -> f64 {
        self.curvature_at(s, 0.0)
    }
}

impl<M: RodModel + ?Sized> RodModel for &M {
    #[inline(always)]
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        (**self).carry_with_sensitivities(s, start, a, b, length)
    }
    fn curvature_at(&self, s: f64, moment: f64) -> f64 {
        (**self).curvature_at(s, moment)
    }
    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        (**self).bending_energy(segment, to, end)
    }
    fn bending_energy_by_parts(
        &self,
        segment: &Segment<Cut>,
        to: f64,
        end: &Cut,
        show: &mut dyn FnMut(Segment<Cut>),
    ) -> f64 {
        (**self).bending_energy_by_parts(segment, to, end, show)
    }
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        (**self).largest_curvature(segment, to, end)
    }
    fn largest_free_curvature(&self, s: f64, start: &Cut, to: f64) -> f64 {
        (**self).largest_free_curvature(s, start, to)
    }
    #[inline(always)]
    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        (**self).curvature_bounds(from, to, force)
    }
    #[inline(always)]
    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        (**self).one_bend(from, to, force)
    }
    fn least_stiffness(&self, from: f64, to: f64) -> f64 {
        (**self).least_stiffness(from, to)
    }
    fn is_straight(&self) -> bool {
        (**self).is_straight()
    }
    fn is_uniform(&self) -> bool {
        (**self).is_uniform()
    }
    fn joints(&self) -> &[f64] {
        (**self).joints()
    }
    #[inline(always)]
    fn carry(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        (**self).carry(s, start, a, b, length)
    }
}

/// Whatever carries cuts with derivatives carries them without; what is not finite becomes an error.
impl<M: RodModel> Propagator for M {
    fn advance(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Result<Cut, RodError> {
        check(s, start, a, b, length)?;
        let end = self.carry(s, start, a, b, length);
        let stopped = |_| RodError::Integration { s, reason: "the rod turns too fast under this force".into() };
        end.check().map_err(stopped)?;
        Ok(end)
    }

    fn curvature(&self, s: f64, moment: f64) -> f64 {
        self.curvature_at(s, moment)
    }
}
