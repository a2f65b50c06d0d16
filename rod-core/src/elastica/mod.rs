//! The shape of a rod under any number of point forces, and the equilibria of a rod without contacts.

mod equilibria;
pub(crate) mod loads;
mod phase;
mod problem;
mod scan;
mod search;
mod second_variation;
mod tip;

pub use equilibria::{ElasticaEquilibrium, TipLoad, elastica_equilibria};
pub use loads::Load;
pub use tip::{DeadLoad, ElasticaArgument, ElasticaError, Tip, TipEnd};

use crate::error::{RodError, finite};
use crate::model::{Cut, RodModel, Uniform};
use crate::pose::{Pose, Reactions};
use crate::segment::{Section, Segment};
use crate::solve::Root;
use crate::units::Units;
use loads::{clamp_cut, clamp_moment, forces_ahead, march};
use smallvec::SmallVec;

/// The elastica of a clamped rod under n point forces, segment by segment: of a uniform one by the closed form, of another
/// [`RodModel`] by what that offers.
///
/// All lengths, forces and moments that go in and come out share the [`Units`] given (SI for `rod.units()`, or
/// dimensionless for [`Units::ONE`]). Accuracy: that of the model, segment by segment ([`advance`](crate::advance) for a uniform rod).
#[derive(Clone, Debug, PartialEq)]
pub struct Elastica<M = Uniform> {
    rod: M,
    units: Units,
    /// The last one is free. Those of five loads are on the stack.
    segments: SmallVec<[Segment<Cut>; 6]>,
}

impl Elastica {
    /// The elastica that leaves the clamp `pose` with the curvature that the clamp's moment m0z asks for
    /// (kappa(0) = -m0z / E I) and carries `loads`, ordered from clamp to tip: an initial-value problem, so
    /// that the free end is without moment only if m0z belongs to the loads.
    ///
    /// # Errors
    /// [`RodError::LoadOrder`] where the loads are not ordered within the rod, [`RodError::NotFinite`].
    pub fn from_clamp(units: Units, pose: Pose, m0z: f64, loads: &[Load]) -> Result<Self, RodError> {
        Self::of_rod(Uniform, units, pose, m0z, loads)
    }

    /// The elastica of a rod clamped at `pose` under `loads` of fixed magnitude and direction, ordered from clamp to
    /// tip, and how its moment m0z at the clamp was found: the root, the moment left at the last load, the iterations.
    ///
    /// The solution is unique where the force ahead, hypot(A, B), stays below pi^2 / 4 E I / L^2 along the rod,
    /// whatever its direction: the energy is convex there. Beyond, a rod that buckles has several; one of them is
    /// found, not necessarily the stable one. The moment left is zero to rounding.
    ///
    /// ```
    /// use rod_core::{Elastica, Load, Pose, Units};
    /// // a small force across the tip of a horizontal cantilever: deflection F L^3 / 3 E I
    /// let clamp = Pose { x: 0.0, y: 0.0, phi: 0.0 };
    /// let (shape, root) = Elastica::under_loads(Units::ONE, clamp, &[Load { s: 1.0, force: 1e-5, alpha: 0.0 }])?;
    /// assert!((shape.at(1.0).y + 1e-5 / 3.0).abs() < 1e-14);
    /// assert!((root.at - 1e-5).abs() < 1e-14); // m0z
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    ///
    /// # Errors
    /// [`RodError::LoadOrder`], [`RodError::NotFinite`] for what is wrong with the input.
    pub fn under_loads(units: Units, pose: Pose, loads: &[Load]) -> Result<(Self, Root), RodError> {
        let root = clamp_moment(&Uniform, units, pose, loads)?;
        Ok((Self::from_clamp(units, pose, root.at, loads)?, root))
    }
}

impl<M: RodModel> Elastica<M> {
    /// The elastica of dimensionless segments that are known, as [`MultiPoint::cuts`](crate::MultiPoint::cuts) gives them: at least
    /// one, the last one free.
    pub fn of_segments(rod: M, units: Units, segments: impl IntoIterator<Item = Segment<Cut>>) -> Self {
        Self { rod, units, segments: segments.into_iter().collect() }
    }

    /// [`from_clamp`](Elastica::from_clamp) of a rod of any model.
    ///
    /// # Errors
    /// As [`from_clamp`](Elastica::from_clamp), and [`RodError::Integration`] where the rod turns too fast.
    pub fn of_rod(rod: M, units: Units, pose: Pose, m0z: f64, loads: &[Load]) -> Result<Self, RodError> {
        let forces = forces_ahead(units, loads)?;
        finite("m0z", m0z)?;
        let clamp = clamp_cut(units, pose, -m0z / units.moment);
        clamp.check()?;
        let mut segments = SmallVec::new();
        march(&rod, clamp, &forces, |s, start, a, b| segments.push(Segment { s, start, a, b }))?;
        Ok(Self { rod, units, segments })
    }

    /// Largest change of the first integral kappa^2 / 2 - (A sin phi - B cos phi), dimensionless, from the start of a segment
    /// to the start of the next: rounding where the one leads to the other, as it does in a solution. No segment is evaluated again.
    /// None for a rod whose stiffness or natural curvature varies: along it nothing of that kind is constant.
    pub fn first_integral_error(&self) -> Option<f64> {
        let change = |(&Segment { start, a, b, .. }, next): (&Segment<Cut>, &Segment<Cut>)| {
            let invariant = |at: &Cut| {
                let (sin, cos) = at.phi.sin_cos();
                0.5 * at.moment * at.moment - (a * sin - b * cos)
            };
            (invariant(&start) - invariant(&next.start)).abs()
        };
        let changes = self.segments.iter().zip(&self.segments[1..]).map(change);
        self.rod.is_uniform().then(|| changes.fold(0.0, f64::max))
    }

    /// Length of the rod.
    pub fn length(&self) -> f64 {
        self.units.length
    }

    /// The cut at an arc length, both dimensionless.
    fn cut(&self, s: f64) -> Cut {
        let i = self.segments.partition_point(|segment| segment.s <= s).saturating_sub(1);
        let segment = &self.segments[i];
        self.rod.carry(segment.s, &segment.start, segment.a, segment.b, s - segment.s)
    }

    /// Position, slope angle and curvature at arc length `s` (0 at the clamp). Where the curvature jumps it is that on the side of
    /// the tip.
    pub fn at(&self, s: f64) -> Section {
        let s = s / self.units.length;
        let Cut { x, y, phi, moment } = self.cut(s);
        Section {
            x: x * self.units.length,
            y: y * self.units.length,
            phi,
            kappa: self.rod.curvature_at(s, moment) * self.units.curvature,
        }
    }

    /// Bending moment at arc length `s`: E I (kappa - kappa at rest).
    pub fn moment(&self, s: f64) -> f64 {
        self.cut(s / self.units.length).moment * self.units.moment
    }

    /// `n` >= 2 sections at equal distances from clamp to tip.
    pub fn sample(&self, n: usize) -> impl Iterator<Item = Section> + '_ {
        let last = n.max(2) - 1;
        (0..=last).map(move |i| self.at(self.units.length * i as f64 / last as f64))
    }

    /// What the clamp feels.
    pub fn reactions(&self) -> Reactions {
        let first = &self.segments[0];
        Reactions {
            f0x: 0.0 - first.b * self.units.force,
            f0y: first.a * self.units.force,
            m0z: 0.0 - first.start.moment * self.units.moment,
        }
    }

    /// Bending energy 1/2 int m^2 / E I ds, in J for SI units. That of the uniform rod is exact but for rounding, about 1e-15 of
    /// the sum of |A|, |B| and kappa^2, and no segment is evaluated again.
    pub fn bending_energy(&self) -> f64 {
        let loaded: f64 = self.loaded().map(|(segment, to, end)| self.rod.bending_energy(segment, to, end)).sum();
        (loaded + self.free_energy()) * self.units.energy
    }

    /// [`bending_energy`](Self::bending_energy); and cuts the segments at the places that its computation passes, so that later questions about the whole
    /// rod start there, and not at the ends of long segments. Shape and forces stay as they are.
    pub fn split(&mut self) -> f64 {
        if self.rod.is_uniform() {
            return self.bending_energy();
        }
        let (mut energy, mut i) = (self.free_energy(), 0);
        while let [segment, next, ..] = &self.segments[i..] {
            let mut parts: SmallVec<[Segment<Cut>; 4]> = SmallVec::new();
            energy += self.rod.bending_energy_by_parts(segment, next.s, &next.start, &mut |part| parts.push(part));
            let after = i + 1 + parts.len();
            self.segments.insert_many(i + 1, parts);
            i = after;
        }
        energy * self.units.energy
    }

    /// Bending energy beyond the last load, dimensionless.
    fn free_energy(&self) -> f64 {
        let free = self.free();
        // without force and moment nothing is bent but as at rest
        if free.start.moment == 0.0 { 0.0 } else { self.rod.bending_energy(free, 1.0, &self.cut(1.0)) }
    }

    /// Largest |kappa| along the rod, in 1/m for SI units: what bends a wire past its yield stress
    /// ([`Rod::bending_stress`](crate::Rod::bending_stress)). That of the uniform rod is exact but for rounding, and no segment is
    /// evaluated again.
    pub fn largest_curvature(&self) -> f64 {
        let loaded = self.loaded().map(|(segment, to, end)| self.rod.largest_curvature(segment, to, end));
        let Segment { s, start, .. } = self.free();
        let free = self.rod.largest_free_curvature(*s, start, 1.0);
        loaded.fold(free, f64::max) * self.units.curvature
    }

    /// The segments, the last one beyond the last load.
    pub(crate) fn segments(&self) -> &[Segment<Cut>] {
        &self.segments
    }

    /// Every segment under load with the arc length and the cut where it ends: the start of the next.
    fn loaded(&self) -> impl Iterator<Item = (&Segment<Cut>, f64, &Cut)> {
        self.segments.iter().zip(&self.segments[1..]).map(|(segment, next)| (segment, next.s, &next.start))
    }

    /// The segment beyond the last load.
    fn free(&self) -> &Segment<Cut> {
        &self.segments[self.segments.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Cone, Smooth};
    use crate::rod::Rod;
    use proptest::prelude::*;

    fn scene() -> (Units, Pose, Vec<Load>) {
        let units = Rod::new(0.1, 6.3e-4).unwrap().units();
        let load = |s: f64, force: f64, alpha| Load { s: s * units.length, force: force * units.force, alpha };
        (
            units,
            Pose { x: 0.01, y: 0.02, phi: 1.4 },
            vec![load(0.3, 3.0, 0.2), load(0.55, -1.0, -1.0), load(0.9, 1.5, 0.7)],
        )
    }

    #[test]
    fn cutting_a_rod_changes_neither_shape_nor_energy() {
        let (units, pose, loads) = scene();
        let cone = Smooth::new(Cone { taper: 0.5 }).unwrap();
        let whole = Elastica::of_rod(cone, units, pose, 1e-3, &loads).unwrap();
        let mut parts = whole.clone();
        let energy = parts.split();
        assert!(parts.segments.len() > whole.segments.len() && parts.free() == whole.free());
        assert!((energy - whole.bending_energy()).abs() < 1e-14 * energy);
        assert!((parts.bending_energy() - energy).abs() < 1e-12 * energy);
        for (one, other) in parts.sample(50).zip(whole.sample(50)) {
            assert!((one.x - other.x).abs() + (one.y - other.y).abs() < 1e-13, "{one:?} {other:?}");
        }
    }

    #[test]
    fn moments_balance_along_the_rod() {
        let (units, pose, loads) = scene();
        let shape = Elastica::from_clamp(units, pose, 1e-3, &loads).unwrap();
        assert_eq!(shape.length(), 0.1);
        assert!((shape.at(0.0).x - pose.x).abs() < 1e-17 && (shape.moment(0.0) + 1e-3).abs() < 1e-18);
        let reactions = shape.reactions();
        let (fx, fy) =
            loads.iter().fold((0.0, 0.0), |(x, y), l| (x + l.force * l.alpha.sin(), y - l.force * l.alpha.cos()));
        assert!((reactions.f0x + fx).abs() < 1e-15 && (reactions.f0y + fy).abs() < 1e-15);
        // beyond the first load, the moment at s is that of the clamp and of the load before it
        let (at, first) = (shape.at(0.05), shape.at(0.03));
        let moment = 1e-3 - reactions.f0y * (at.x - pose.x)
            + reactions.f0x * (at.y - pose.y)
            + loads[0].force * (loads[0].alpha.cos() * (at.x - first.x) + loads[0].alpha.sin() * (at.y - first.y));
        assert!((shape.moment(0.05) + moment).abs() < 1e-17, "{} {moment}", shape.moment(0.05));
        assert_eq!(shape.sample(5).count(), 5);
    }

    #[test]
    fn refuses_loads_out_of_order() {
        let (units, pose, mut loads) = scene();
        loads.swap(0, 1);
        let error = Elastica::from_clamp(units, pose, 0.0, &loads).unwrap_err();
        assert!(matches!(error, RodError::LoadOrder { index: 1, .. }), "{error}");
        let nan = Elastica::from_clamp(units, pose, f64::NAN, &[]);
        assert!(matches!(nan, Err(RodError::NotFinite { what: "m0z", .. })));
    }

    /// Largest |kappa| and energy by sampling: maximum of parabolas through, and Simpson's rule over, `n` intervals.
    fn sampled(shape: &Elastica, n: usize) -> (f64, f64) {
        let (mut most, mut energy): (f64, f64) = (0.0, 0.0);
        let ends = shape.segments.iter().skip(1).map(|next| next.s).chain([1.0]);
        for (segment, end) in shape.segments.iter().zip(ends) {
            let h = (end - segment.s) / n as f64;
            let kappa = |i: usize| Uniform.carry(segment.s, &segment.start, segment.a, segment.b, h * i as f64).moment;
            for i in (0..n).step_by(2) {
                let (u, v, w) = (kappa(i), kappa(i + 1), kappa(i + 2));
                most = most.max(u.abs()).max(v.abs()).max(w.abs());
                energy += h / 6.0 * (u * u + 4.0 * v * v + w * w);
            }
        }
        (most, energy)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn largest_curvature_and_energy_are_those_of_samples(
            loads in prop::collection::vec((0.0..1.0, -30.0..30.0, -3.2..3.2), 0..4),
            phi in -3.2..3.2, m0z in -12.0..12.0, strength in prop_oneof![Just(1.0), Just(10.0), Just(0.01)],
        ) {
            let mut loads: Vec<Load> =
                loads.into_iter().map(|(s, force, alpha)| Load { s, force: strength * force, alpha }).collect();
            loads.sort_by(|u, v| u.s.total_cmp(&v.s));
            let shape = Elastica::from_clamp(Units::ONE, Pose { x: 0.1, y: 0.2, phi }, m0z, &loads).unwrap();
            let (most, energy) = sampled(&shape, 2000);
            let exact = shape.largest_curvature();
            // the maximum between two samples 1/2000 apart is missed by at most |kappa''| h^2 / 8
            let scale = 1.0 + strength * 90.0 * (1.0 + most);
            prop_assert!(exact >= most - 1e-12 * scale && exact - most < 1e-7 * scale, "{exact} {most}");
            prop_assert!((shape.bending_energy() - energy).abs() < 1e-9 * (1.0 + energy) * scale, "{} {energy}", shape.bending_energy());
        }
    }

    #[test]
    fn largest_curvature_at_turning_points_and_over_the_top() {
        // a pendulum swung for many periods; one that ends where it began; circles; nothing
        for (kappa, force, s) in [
            (0.1, 900.0, 1.0),
            (0.0, 400.0, 0.9),
            (41.0, 400.0, 1.0),
            (39.99, 400.0, 1.0),
            (3.0, 0.0, 0.5),
            (0.0, 0.0, 0.0),
        ] {
            for phi in [0.1, 1.6, -3.0] {
                let loads = [Load { s, force, alpha: 0.0 }];
                let shape = Elastica::from_clamp(Units::ONE, Pose { x: 0.0, y: 0.0, phi }, -kappa, &loads).unwrap();
                let (most, exact) = (sampled(&shape, 20_000).0, shape.largest_curvature());
                assert!(exact >= most - 1e-11 && exact - most < 1e-3, "{kappa} {force} {phi}: {exact} {most}");
            }
        }
    }
}
