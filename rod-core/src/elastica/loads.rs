//! Dead loads: the clamp's moment that given forces ask for, so that nothing bends the rod beyond the last of them.

use crate::error::{RodError, finite};
use crate::model::{Cut, Propagator};
use crate::pose::Pose;
use crate::solve::{Root, find_root};
use crate::units::Units;

/// A point force on the rod: `force` pushes along (sin alpha, -cos alpha), away from a solid whose tangent angle is alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Arc length where it acts.
    pub s: f64,
    /// Magnitude, positive when it pushes.
    pub force: f64,
    /// Tangent angle of the contact, radians.
    pub alpha: f64,
}

/// Moment m0z at the clamp for which the moment vanishes at the last load.
///
/// The moment there is kappa(0) plus sum f_j times arm, and no arm is longer than s_j: |kappa(0)| <= sum |f_j| s_j for any
/// rod, and at the ends of a bracket twice as wide the signs differ beyond doubt.
pub(crate) fn clamp_moment(rod: &dyn Propagator, units: Units, pose: Pose, loads: &[Load]) -> Result<Root, RodError> {
    let forces = forces_ahead(units, loads)?;
    let bound = 2.0 * loads.iter().map(|l| (l.force / units.force).abs() * (l.s / units.length)).sum::<f64>();
    let end_moment = |moment| Ok(march(rod, clamp_cut(units, pose, moment), &forces, |_, _, _, _| ())?.moment);
    let root = find_root("the moment at the last load", end_moment, -bound, bound, 0.0)?;
    Ok(Root { at: -root.at * units.moment, residual: root.residual * units.moment, ..root })
}

fn check_loads(units: Units, loads: &[Load]) -> Result<(), RodError> {
    let mut least = 0.0;
    for (index, load) in loads.iter().enumerate() {
        if !(load.s >= least && load.s <= units.length) {
            return Err(RodError::LoadOrder { index, s: load.s, least, most: units.length });
        }
        finite("force", load.force)?;
        finite("alpha", load.alpha)?;
        least = load.s;
    }
    Ok(())
}

/// A load, dimensionless: where it acts, and the sum (A, B) of it and all beyond.
pub(crate) struct ForceAhead {
    s: f64,
    a: f64,
    b: f64,
}

/// Sums the loads from the tip to the clamp, so that a small force near the tip is not the difference of large ones.
pub(crate) fn forces_ahead(units: Units, loads: &[Load]) -> Result<Vec<ForceAhead>, RodError> {
    check_loads(units, loads)?;
    let mut forces: Vec<ForceAhead> = loads
        .iter()
        .map(|load| {
            let (sin, cos) = load.alpha.sin_cos();
            let force = load.force / units.force;
            ForceAhead { s: load.s / units.length, a: force * cos, b: force * sin }
        })
        .collect();
    for i in (1..forces.len()).rev() {
        let (a, b) = (forces[i].a, forces[i].b);
        forces[i - 1].a += a;
        forces[i - 1].b += b;
    }
    Ok(forces)
}

/// The cut at the clamp, dimensionless, with the bending moment `moment`.
pub(crate) fn clamp_cut(units: Units, pose: Pose, moment: f64) -> Cut {
    Cut { x: pose.x / units.length, y: pose.y / units.length, phi: pose.phi, moment }
}

/// Goes from the clamp to the last load, shows each piece where it starts (arc length, cut, A, B), the free end last, and
/// returns the cut where that begins.
#[inline]
pub(crate) fn march(
    rod: &(impl Propagator + ?Sized),
    clamp: Cut,
    forces: &[ForceAhead],
    mut show: impl FnMut(f64, Cut, f64, f64),
) -> Result<Cut, RodError> {
    let (mut s, mut cut) = (0.0, clamp);
    for force in forces {
        show(s, cut, force.a, force.b);
        cut = rod.advance(s, &cut, force.a, force.b, force.s - s)?;
        s = force.s;
    }
    show(s, cut, 0.0, 0.0);
    Ok(cut)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elastica::Elastica;
    use crate::rod::Rod;
    use proptest::prelude::*;

    const CLAMP: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };

    #[test]
    fn a_strong_tip_force_bends_as_tabulated() {
        // Bisshopp and Drucker (1945), P L^2 / E I = 1 and 10: deflection 0.30172, 0.81061; height 0.94357, 0.44500
        for (force, deflection, projection) in [(1.0, 0.301_720_774, 0.943_566), (10.0, 0.810_609, 0.445_0)] {
            let (shape, root) =
                Elastica::under_loads(Units::ONE, CLAMP, &[Load { s: 1.0, force, alpha: 0.0 }]).unwrap();
            let tip = shape.at(1.0);
            assert!((tip.y + deflection).abs() < 1e-4 && (tip.x - projection).abs() < 1e-4, "{tip:?}");
            assert!(root.residual.abs() < 1e-13 && tip.kappa.abs() < 1e-13);
        }
    }

    #[test]
    fn buckles_at_euler_load() {
        // compressed along its axis with an imperfection of 1e-3 rad: hardly bent below pi^2 / 4, far beyond it
        let tip = |force: f64| {
            let load = Load { s: 1.0, force, alpha: -std::f64::consts::FRAC_PI_2 + 1e-3 };
            Elastica::under_loads(Units::ONE, CLAMP, &[load]).unwrap().0.at(1.0)
        };
        let euler = std::f64::consts::PI.powi(2) / 4.0;
        assert!(tip(0.9 * euler).y.abs() < 0.02);
        assert!(tip(1.2 * euler).x.abs() < 1.0);
    }

    #[test]
    fn no_load_no_moment() {
        for loads in
            [vec![], vec![Load { s: 0.5, force: 0.0, alpha: 1.0 }], vec![Load { s: 0.0, force: 3.0, alpha: 1.0 }]]
        {
            let (shape, root) = Elastica::under_loads(Units::ONE, CLAMP, &loads).unwrap();
            assert_eq!((root.at, shape.at(1.0).x), (0.0, 1.0));
        }
    }

    #[test]
    fn tiny_and_huge_forces() {
        for force in [1e-300, 1e-30, 1e-12, 1e3, -1e3] {
            let (shape, root) =
                Elastica::under_loads(Units::ONE, CLAMP, &[Load { s: 1.0, force, alpha: 0.3 }]).unwrap();
            assert!(root.residual.abs() <= 1e-11 * force.abs(), "{force} {root:?}");
            assert!(shape.at(1.0).x.is_finite());
        }
        let bad = [Load { s: 1.0, force: f64::NAN, alpha: 0.0 }];
        assert!(matches!(Elastica::under_loads(Units::ONE, CLAMP, &bad), Err(RodError::NotFinite { .. })));
        let order = [Load { s: 0.7, force: 1.0, alpha: 0.0 }, Load { s: 0.3, force: 1.0, alpha: 0.0 }];
        assert!(matches!(Elastica::under_loads(Units::ONE, CLAMP, &order), Err(RodError::LoadOrder { index: 1, .. })));
        let lost = Pose { x: f64::NAN, ..CLAMP };
        assert!(matches!(Elastica::under_loads(Units::ONE, lost, &bad), Err(RodError::NotFinite { .. })));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn the_free_end_is_straight_and_the_clamp_balances(
            loads in prop::collection::vec((0.0..1.0, -6.0..6.0, -3.2..3.2), 1..6), phi in -3.2..3.2,
        ) {
            let rod = Rod::new(0.1, 6.3e-4).unwrap();
            let units = rod.units();
            let mut loads: Vec<Load> = loads
                .into_iter()
                .map(|(s, force, alpha)| Load { s: s * units.length, force: force * units.force, alpha })
                .collect();
            loads.sort_by(|u, v| u.s.total_cmp(&v.s));
            let pose = Pose { x: 0.02, y: -0.03, phi };
            let (shape, root) = Elastica::under_loads(units, pose, &loads).unwrap();
            let last = loads[loads.len() - 1].s;
            prop_assert!(root.residual.abs() < 1e-11 * units.moment);
            prop_assert!(shape.moment(last).abs() < 1e-11 * units.moment);
            // m0z = sum f_j [(x_j - x0) cos alpha_j + (y_j - y0) sin alpha_j]
            let balance: f64 = loads
                .iter()
                .map(|l| {
                    let at = shape.at(l.s);
                    l.force * ((at.x - pose.x) * l.alpha.cos() + (at.y - pose.y) * l.alpha.sin())
                })
                .sum();
            prop_assert!((shape.reactions().m0z - balance).abs() < 1e-11 * units.moment);
        }
    }
}
