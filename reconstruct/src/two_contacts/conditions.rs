//! The conditions that two contacts fulfil at every instant of a scan.
//!
//! The reactions determine the rod up to its first contact, and with the force there up to the second one. Without friction
//! each contact moves along its own tangent; at the second one the moment vanishes, because it is the last.

use super::part::Local;
use super::unknowns::{Gradient, UNKNOWNS, Unknown, Unknowns};
use rod_core::{Dual, Scalar, Section, advance};

/// A condition: a number that vanishes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Condition {
    pub value: f64,
    pub gradient: Gradient,
}

/// Number of conditions where the second contact is at the tip: the normal speed of the first contact, the curvature at the
/// second contact, and the normal speed of the second contact.
pub(super) const WITH_TIP: usize = 3;
/// Number of conditions where the second contact is tangential: these and the phase criterion K (Merker et al. 2020, eq. 20).
pub(super) const TANGENTIAL: usize = 4;

/// The sections of the rod at its two contacts.
pub(super) struct Two<T> {
    pub first: Section<T>,
    pub second: Section<T>,
    /// The force (A, B) that the second contact bears.
    pub force: [T; 2],
}

/// The two contacts of a rod of this natural curvature with its clamp at `pose` (x0, y0, phi0).
pub(super) fn two<T: Scalar>(pose: [T; 3], natural: T, v: &Unknowns<T>) -> Two<T> {
    let start = Section { x: pose[0], y: pose[1], phi: pose[2], kappa: natural - v[Unknown::M0z] };
    let (a, b) = (v[Unknown::F0y], -v[Unknown::F0x]);
    let first = advance(&start, a, b, v[Unknown::S1]);
    let (sin, cos) = first.phi.sin_cos();
    let force = [a - v[Unknown::F1] * cos, b - v[Unknown::F1] * sin];
    let second = advance(&first, force[0], force[1], v[Unknown::S2] - v[Unknown::S1]);
    Two { first, second, force }
}

/// The conditions, violated by their values: [`WITH_TIP`] of them where the second contact is at the tip, otherwise
/// [`TANGENTIAL`].
pub(super) fn conditions(local: &Local, tip: bool) -> Vec<Condition> {
    let Local { pose, natural, values, rates, .. } = local;
    /// Derivatives by the unknowns and by their rates.
    type Wide = Dual<f64, { 2 * UNKNOWNS }>;
    let timed = |value, rate| Dual::<Wide, 1> { value, derivatives: [rate] };
    let inputs = Unknowns::from_fn(|u| {
        let k = u as usize;
        timed(Wide::variable(values[u], k), Wide::variable(rates[u], UNKNOWNS + k))
    });
    let clamp = std::array::from_fn(|i| timed(Wide::constant(pose[0][i]), Wide::constant(pose[1][i])));
    let natural = Wide::constant(*natural);
    let two = two(clamp, timed(natural, Wide::constant(0.0)), &inputs);
    let across = |s: &Section<Dual<Wide, 1>>, cos: Wide, sin: Wide| cos * s.y.derivatives[0] - sin * s.x.derivatives[0];
    let (sin, cos) = two.first.phi.value.sin_cos();
    let first = across(&two.first, cos, sin);
    let kappa = two.second.kappa.value - natural;
    let condition = |number: Wide| Condition {
        value: number.value,
        gradient: Gradient {
            by_value: Unknowns::from_fn(|u| number.derivatives[u as usize]),
            by_rate: Unknowns::from_fn(|u| number.derivatives[UNKNOWNS + u as usize]),
        },
    };
    if tip {
        // along the contour means across the force; times the force, because its direction is lost where it vanishes
        let second = across(&two.second, two.force[0].value, two.force[1].value);
        return [first, kappa, second].map(condition).into();
    }
    let (sin, cos) = two.second.phi.value.sin_cos();
    let second = across(&two.second, cos, sin);
    let (sin, cos) = pose[0].z.sin_cos();
    let [fx, fy, m] = Unknown::REACTIONS.map(|u| inputs[u].value);
    let k = m * (m - natural - natural) - Wide::constant(2.0 * sin) * fy - Wide::constant(2.0 * cos) * fx;
    [first, kappa, second, k].map(condition).into()
}

/// A point of the contour with the normal there (up to its sign), with derivatives by the unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContourPoint {
    pub x: Dual<f64, UNKNOWNS>,
    pub y: Dual<f64, UNKNOWNS>,
    pub normal: [Dual<f64, UNKNOWNS>; 2],
}

/// The second contact as a point of the contour.
pub(super) fn second(local: &Local, tip: bool) -> ContourPoint {
    let variables = Unknowns::from_fn(|u| Dual::variable(local.values[u], u as usize));
    let pose = std::array::from_fn(|i| Dual::constant(local.pose[0][i]));
    let two = two(pose, Dual::constant(local.natural), &variables);
    let (sin, cos) = if tip {
        let [a, b] = two.force;
        let f = (a * a + b * b).sqrt();
        (b / f, a / f)
    } else {
        two.second.phi.sin_cos()
    };
    ContourPoint { x: two.second.x, y: two.second.y, normal: [-sin, cos] }
}
