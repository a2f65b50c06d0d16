//! The conditions that two contacts fulfil at every instant of a scan.
//!
//! The reactions determine the rod up to its first contact, and with the force there up to the second one. Each contact moves along its own
//! tangent; at the second one the moment vanishes, because it is the last. Friction turns the forces, and nothing else.

use super::part::Local;
use super::unknowns::{Gradient, UNKNOWNS, Unknown, Unknowns};
use crate::point::{Carried, CrossSection, Inverse, RodInterval, normal_part, tangential};
use rod_core::{Dual, Scalar};

/// A condition: a number that vanishes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Condition {
    pub value: f64,
    pub gradient: Gradient,
}

/// Number of conditions where the second contact is at the tip: the normal speed of the first contact, the moment at the
/// second contact, and the normal speed of the second contact.
pub(super) const WITH_TIP: usize = 3;
/// Number of conditions where the second contact is tangential: these, and the direction of the force there. Of a uniform rod the phase
/// criterion K (Merker et al. 2020, eq. 20) says the same.
pub(super) const TANGENTIAL: usize = 4;

/// The sections of the rod at its two contacts.
pub(super) struct Two<T> {
    pub first: CrossSection<T>,
    pub second: CrossSection<T>,
    /// The force (A, B) that the second contact bears.
    pub force: [T; 2],
}

/// The two contacts of a rod of this natural curvature with its clamp at `pose` (x0, y0, phi0), where friction turns the first force by an
/// angle with this tangent.
fn two_of<I: Inverse, T: Carried>(rod: &I, pose: [T; 3], natural: T, friction: T, v: &Unknowns<T>) -> Two<T> {
    let start = rod.base(pose, Unknown::REACTIONS.map(|u| v[u]), natural);
    let (a, b) = (v[Unknown::F0y], -v[Unknown::F0x]);
    let first = rod.carry(&start, &RodInterval { from: T::from_f64(0.0), to: v[Unknown::S1], force: [a, b] });
    let [of_a, of_b] = tangential(v[Unknown::F1], first.phi.sin_cos(), friction);
    let force = [a - of_a, b - of_b];
    let second = rod.carry(&first, &RodInterval { from: v[Unknown::S1], to: v[Unknown::S2], force });
    Two { first, second, force }
}

/// The two contacts at one instant.
pub(super) fn two<I: Inverse>(rod: &I, local: &Local) -> Two<f64> {
    two_of(rod, local.pose[0].into(), local.natural, local.friction, &local.values)
}

/// The same with derivatives by the unknowns.
pub(super) fn two_by<I: Inverse>(rod: &I, local: &Local) -> Two<Dual<f64, UNKNOWNS>> {
    let variables = Unknowns::from_fn(|u| Dual::variable(local.values[u], u as usize));
    let pose = std::array::from_fn(|i| Dual::constant(local.pose[0][i]));
    two_of(rod, pose, Dual::constant(local.natural), Dual::constant(local.friction), &variables)
}

/// The same with the rate along the scan.
pub(super) fn two_moving<I: Inverse>(rod: &I, local: &Local) -> Two<Dual<f64, 1>> {
    let inputs = Unknowns::from_fn(|u| Dual { value: local.values[u], derivatives: [local.rates[u]] });
    let pose = std::array::from_fn(|i| Dual { value: local.pose[0][i], derivatives: [local.pose[1][i]] });
    two_of(rod, pose, Dual::constant(local.natural), Dual::constant(local.friction), &inputs)
}

/// The conditions, violated by their values: [`WITH_TIP`] of them where the second contact is at the tip, otherwise
/// [`TANGENTIAL`].
pub(super) fn conditions<I: Inverse>(rod: &I, local: &Local, tip: bool) -> Vec<Condition> {
    let Local { pose, natural, friction, values, rates, .. } = local;
    /// A number with its derivatives by the unknowns.
    type By = Dual<f64, UNKNOWNS>;
    // the one derivative of these is the rate along the scan
    let inputs = Unknowns::from_fn(|u| Dual::<By, 1> {
        value: By::variable(values[u], u as usize),
        derivatives: [By::constant(rates[u])],
    });
    let clamp = std::array::from_fn(|i| Dual::<By, 1> {
        value: By::constant(pose[0][i]),
        derivatives: [By::constant(pose[1][i])],
    });
    let (natural, friction) = (By::constant(*natural), By::constant(*friction));
    let two = two_of(rod, clamp, Dual::<By, 1>::constant(natural), Dual::<By, 1>::constant(friction), &inputs);
    let still = |number: By| Condition {
        value: number.value,
        gradient: Gradient::of_values(Unknowns::from_fn(|u| number.derivatives[u as usize])),
    };
    // the velocity is linear in the rates of the unknowns: by these it has the derivatives that the place has by the unknowns
    let across = |s: &CrossSection<Dual<By, 1>>, cos: By, sin: By| {
        let speed = still(cos * s.y.derivatives[0] - sin * s.x.derivatives[0]);
        let by =
            |u: Unknown| cos.value * s.y.value.derivatives[u as usize] - sin.value * s.x.value.derivatives[u as usize];
        Condition { gradient: Gradient { by_rate: Unknowns::from_fn(by), ..speed.gradient }, ..speed }
    };
    let (sin, cos) = two.first.phi.value.sin_cos();
    let first = across(&two.first, cos, sin);
    let moment = still(rod.moment(&two.second.map(|number| number.value), natural));
    if tip {
        // along the contour means across the normal force; times that force, because its direction is lost where it vanishes
        let [a, b] = normal_part(two.force.map(|force| force.value), two.second.phi.value.sin_cos(), friction);
        let second = across(&two.second, a, b);
        return vec![first, moment, second];
    }
    let (sin, cos) = two.second.phi.value.sin_cos();
    let second = across(&two.second, cos, sin);
    if !I::UNIFORM {
        let [a, b] = two.force.map(|force| force.value);
        let (along, normal) = (b * cos - a * sin, a * cos + b * sin);
        let pushes = if normal.value < 0.0 { -normal } else { normal };
        return vec![first, moment, second, still((along - pushes * friction) * By::constant(2.0))];
    }
    let (sin, cos) = pose[0].z.sin_cos();
    let [fx, fy, m] = Unknown::REACTIONS.map(|u| inputs[u].value);
    let mut k = m * (m - natural - natural) - By::constant(2.0 * sin) * fy - By::constant(2.0 * cos) * fx;
    if friction.value != 0.0 {
        // each contact adds twice its force along the rod
        let [a, b] = two.force.map(|force| force.value);
        let (sin, cos) = two.second.phi.value.sin_cos();
        for normal in [inputs[Unknown::F1].value, a * cos + b * sin] {
            let pushes = if normal.value < 0.0 { -normal } else { normal };
            k = k - pushes * friction * By::constant(2.0);
        }
    }
    vec![first, moment, second, still(k)]
}

/// A point of the contour with the normal there (up to its sign), with derivatives by the unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContourPoint {
    pub x: Dual<f64, UNKNOWNS>,
    pub y: Dual<f64, UNKNOWNS>,
    pub normal: [Dual<f64, UNKNOWNS>; 2],
}

/// The second contact as a point of the contour.
pub(super) fn second<I: Inverse>(rod: &I, local: &Local, tip: bool) -> ContourPoint {
    let two = two_by(rod, local);
    let (sin, cos) = if tip {
        let [a, b] = normal_part(two.force, two.second.phi.sin_cos(), Dual::constant(local.friction));
        let f = (a * a + b * b).sqrt();
        (b / f, a / f)
    } else {
        two.second.phi.sin_cos()
    };
    ContourPoint { x: two.second.x, y: two.second.y, normal: [-sin, cos] }
}
