//! The shape of any rod under point forces, through any [`Propagator`].

use crate::elastica::loads::{Load, clamp_cut, clamp_moment, forces_ahead, march};
use crate::error::{RodError, finite};
use crate::model::{Cut, Propagator};
use crate::pose::{Pose, Reactions};
use crate::segment::{Section, Segment};
use crate::solve::Root;
use crate::units::Units;

/// The elastica of a clamped rod of any kind under n point forces: what [`Elastica`](crate::Elastica) is to the uniform
/// rod, at the price of its [`Propagator`]. All quantities share the [`Units`] given, which those of a rod with the
/// reference stiffness are.
///
/// ```
/// use rod_core::{GeneralElastica, Load, Method, Ode, Pose, Units};
/// // stiffness falls to a tenth towards the tip, which a force pushes on
/// let whisker = Ode::with_law(|s, m| m / (1.0 - 0.9 * s), Method::Dop853, 1e-12)?;
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 0.0 };
/// let (shape, _) =
///     GeneralElastica::under_loads(&whisker, Units::ONE, clamp, &[Load { s: 1.0, force: 0.5, alpha: 0.0 }])?;
/// assert!(shape.at(1.0)?.y < -0.2 && shape.at(1.0)?.kappa.abs() < 1e-9);
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone)]
pub struct GeneralElastica<'rod> {
    rod: &'rod dyn Propagator,
    units: Units,
    /// The last one is free.
    segments: Vec<Segment<Cut>>,
}

impl std::fmt::Debug for GeneralElastica<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("GeneralElastica").field("units", &self.units).field("segments", &self.segments.len()).finish()
    }
}

impl<'rod> GeneralElastica<'rod> {
    /// The elastica that leaves the clamp `pose` with the moment -`m0z` and carries `loads`, as
    /// [`Elastica::from_clamp`](crate::Elastica::from_clamp).
    ///
    /// # Errors
    /// [`RodError::LoadOrder`], [`RodError::NotFinite`], and what the propagator reports.
    pub fn from_clamp(
        rod: &'rod dyn Propagator,
        units: Units,
        pose: Pose,
        m0z: f64,
        loads: &[Load],
    ) -> Result<Self, RodError> {
        let forces = forces_ahead(units, loads)?;
        let clamp = clamp_cut(units, pose, -m0z / units.moment);
        clamp.check()?;
        let mut segments = Vec::with_capacity(loads.len() + 1);
        march(rod, clamp, &forces, |s, start, a, b| segments.push(Segment { s, start, a, b }))?;
        Ok(Self { rod, units, segments })
    }

    /// The elastica under dead loads, as [`Elastica::under_loads`](crate::Elastica::under_loads).
    ///
    /// # Errors
    /// As [`GeneralElastica::from_clamp`].
    pub fn under_loads(
        rod: &'rod dyn Propagator,
        units: Units,
        pose: Pose,
        loads: &[Load],
    ) -> Result<(Self, Root), RodError> {
        let root = clamp_moment(rod, units, pose, loads)?;
        Ok((Self::from_clamp(rod, units, pose, root.at, loads)?, root))
    }

    fn cut(&self, s: f64) -> Result<Cut, RodError> {
        let i = self.segments.partition_point(|segment| segment.s <= s).saturating_sub(1);
        let Segment { s: from, start, a, b } = self.segments[i];
        self.rod.advance(from, &start, a, b, s - from)
    }

    /// Position, slope angle and curvature at arc length `s` (0 at the clamp).
    ///
    /// # Errors
    /// [`RodError::NotFinite`], and what the propagator reports.
    pub fn at(&self, s: f64) -> Result<Section, RodError> {
        finite("arc length", s)?;
        let s = s / self.units.length;
        let cut = self.cut(s)?;
        Ok(Section {
            x: cut.x * self.units.length,
            y: cut.y * self.units.length,
            phi: cut.phi,
            kappa: self.rod.curvature(s, cut.moment) * self.units.curvature,
        })
    }

    /// What the clamp feels.
    pub fn reactions(&self) -> Reactions {
        let Segment { start, a, b, .. } = self.segments[0];
        Reactions { f0x: -b * self.units.force, f0y: a * self.units.force, m0z: -start.moment * self.units.moment }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ode::{Method, Ode};
    use super::*;
    use crate::elastica::Elastica;
    use crate::model::Uniform;
    use crate::rod::Rod;

    fn scene() -> (Units, Pose, Vec<Load>) {
        let units = Rod::new(0.1, 6.3e-4).unwrap().units();
        let load = |s: f64, force: f64, alpha| Load { s: s * units.length, force: force * units.force, alpha };
        let loads = vec![load(0.3, 3.0, 0.2), load(0.55, -1.0, -1.0), load(0.55, 2.0, 2.0), load(0.9, 1.5, 0.7)];
        (units, Pose { x: 0.01, y: 0.02, phi: 1.4 }, loads)
    }

    #[test]
    fn every_propagator_gives_the_same_elastica() {
        let (units, pose, loads) = scene();
        let (exact, root) = Elastica::under_loads(units, pose, &loads).unwrap();
        let ode = Ode::uniform(Method::Dop853, 1e-13).unwrap();
        let routes: [(&dyn Propagator, f64); 2] = [(&Uniform, 1e-14), (&ode, 1e-11)];
        for (rod, bound) in routes {
            let (shape, found) = GeneralElastica::under_loads(rod, units, pose, &loads).unwrap();
            assert!((found.at - root.at).abs() < bound * units.moment);
            assert!((shape.reactions().m0z - exact.reactions().m0z).abs() < bound * units.moment);
            assert_eq!(shape.reactions().f0x, exact.reactions().f0x);
            for i in 0..=20 {
                let s = 0.005 * f64::from(i);
                let (u, v) = (shape.at(s).unwrap(), exact.at(s));
                assert!((u.x - v.x).abs() < bound * units.length && (u.y - v.y).abs() < bound * units.length);
                assert!((u.phi - v.phi).abs() < bound * 10.0);
            }
        }
    }

    #[test]
    fn a_rod_bent_at_rest_takes_its_shape_when_its_loads_go() {
        let bent = Ode::with_law(|_, m| 1.0 + m, Method::Dop853, 1e-13).unwrap();
        let pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
        let (shape, root) = GeneralElastica::under_loads(&bent, Units::ONE, pose, &[]).unwrap();
        let tip = shape.at(1.0).unwrap();
        assert_eq!(root.at, 0.0);
        assert!((tip.x - 1.0_f64.sin()).abs() < 1e-12 && tip.kappa == 1.0);
        assert!(shape.at(f64::NAN).is_err());
    }
}
