//! What two contacts of a rod must obey at one instant of a scan.
//!
//! The rod is known up to its first contact; with the force there it is known up to the second one. Both contacts move
//! along their own tangents, and the second one is without moment.

use nalgebra::Vector3;
use rod_core::{Dual, Scalar, Section, advance};

/// What the conditions depend on: f0x, f0y, m0z; arc length of the first contact, its force (from a solid on the rod's
/// left; negative: right), arc length of the second contact.
pub(crate) const INPUTS: usize = 6;
/// Conditions at one instant.
pub(crate) const ROWS: usize = 4;

/// The two contacts.
pub(crate) struct Two<T> {
    pub first: Section<T>,
    pub second: Section<T>,
    /// The force (A, B) that the second bears.
    pub force: [T; 2],
}

pub(crate) fn two<T: Scalar>(pose: [T; 3], v: &[T; INPUTS]) -> Two<T> {
    let start = Section { x: pose[0], y: pose[1], phi: pose[2], kappa: -v[2] };
    let (a, b) = (v[1], -v[0]);
    let first = advance(&start, a, b, v[3]);
    let (sin, cos) = first.phi.sin_cos();
    let force = [a - v[4] * cos, b - v[4] * sin];
    let second = advance(&first, force[0], force[1], v[5] - v[3]);
    Two { first, second, force }
}

/// By how much the conditions are violated, with derivatives by the inputs and then by their rates: normal speed of the
/// first contact, curvature at the second, normal speed of the second, and, where that is tangential, the phase
/// criterion.
pub(crate) fn conditions(
    pose: &[Vector3<f64>; 2],
    values: &[f64; INPUTS],
    rates: &[f64; INPUTS],
    tip: bool,
) -> [Dual<f64, 12>; ROWS] {
    type Wide = Dual<f64, 12>;
    let timed = |value, rate| Dual::<Wide, 1> { value, derivatives: [rate] };
    let inputs = std::array::from_fn(|i| timed(Wide::variable(values[i], i), Wide::variable(rates[i], INPUTS + i)));
    let clamp = std::array::from_fn(|i| timed(Wide::constant(pose[0][i]), Wide::constant(pose[1][i])));
    let two = two(clamp, &inputs);
    let across = |s: &Section<Dual<Wide, 1>>, cos: Wide, sin: Wide| cos * s.y.derivatives[0] - sin * s.x.derivatives[0];
    let (sin, cos) = two.first.phi.value.sin_cos();
    let first = across(&two.first, cos, sin);
    let kappa = two.second.kappa.value;
    if tip {
        // normal to the force: fades with it, where its direction is lost
        let second = across(&two.second, two.force[0].value, two.force[1].value);
        return [first, kappa, second, Wide::constant(0.0)];
    }
    let (sin, cos) = two.second.phi.value.sin_cos();
    let second = across(&two.second, cos, sin);
    let (sin, cos) = pose[0].z.sin_cos();
    let (fx, fy, m) = (inputs[0].value, inputs[1].value, inputs[2].value);
    let k = m * m - Wide::constant(2.0 * sin) * fy - Wide::constant(2.0 * cos) * fx;
    [first, kappa, second, k]
}

/// Position of the second contact and normal of the contour there (up to its sign), with derivatives by the inputs.
pub(crate) fn second(pose: &Vector3<f64>, values: &[f64; INPUTS], tip: bool) -> [Dual<f64, INPUTS>; 4] {
    let two =
        two(std::array::from_fn(|i| Dual::constant(pose[i])), &std::array::from_fn(|i| Dual::variable(values[i], i)));
    let (sin, cos) = if tip {
        let [a, b] = two.force;
        let f = (a * a + b * b).sqrt();
        (b / f, a / f)
    } else {
        two.second.phi.sin_cos()
    };
    [two.second.x, two.second.y, -sin, cos]
}
