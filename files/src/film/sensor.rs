//! What a force/torque sensor that is turned or sits at a lever measures, by the reactions at the base.

use vibrissa::hw::{Mounting, OutOfPlane};
use vibrissa::reconstruct::Measurand;
use vibrissa::rod::{Pose, Reactions};

/// The components of a sensor, N and N m, in its own axes about its own origin.
const COMPONENTS: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];
/// Weights of the reactions (1 and m) up to here are rounding.
const ROUNDING: f64 = 1e-12;

/// The number of a component by its name.
pub(super) fn component(name: &str) -> Option<usize> {
    COMPONENTS.iter().position(|own| *own == name)
}

/// Whether what it measures depends on the angle of the clamp.
pub(super) fn turns(mounting: &Mounting) -> bool {
    mounting.frame(0.0) != mounting.frame(1.0)
}

/// A component of a sensor whose clamp has the angle `phi`, as a combination of the reactions; none of one that is across the plane of the rod.
pub(super) fn combination(mounting: &Mounting, component: usize, phi: f64) -> Option<Measurand> {
    let pose = Pose { x: 0.0, y: 0.0, phi };
    // it is linear in each of them
    let weight = |[f0x, f0y, m0z]: [f64; 3]| {
        mounting.wrench(&Reactions { f0x, f0y, m0z }, &OutOfPlane::default(), pose).components()[component]
    };
    let weights = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(weight);
    weights.iter().any(|weight| weight.abs() > ROUNDING).then_some(Measurand::Reaction(weights))
}

/// By how much the weights of the two forces differ between two combinations.
pub(super) fn change(one: Option<Measurand>, other: Option<Measurand>) -> f64 {
    match (one, other) {
        (Some(Measurand::Reaction([ax, ay, _])), Some(Measurand::Reaction([bx, by, _]))) => (ax - bx).hypot(ay - by),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::hw::{Frame, Sense};

    fn measured(mounting: &Mounting, phi: f64) -> [Option<f64>; 6] {
        let of = |k| match combination(mounting, k, phi)? {
            Measurand::Reaction([x, y, z]) => Some(1.0 * x + 2.0 * y + 0.5 * z),
            _ => None,
        };
        std::array::from_fn(of)
    }

    fn alike(found: [Option<f64>; 6], [fx, fy, tz]: [f64; 3]) {
        let expected = [Some(fx), Some(fy), None, None, None, Some(tz)];
        let is_near = |(one, other): (&Option<f64>, &Option<f64>)| match (one, other) {
            (Some(one), Some(other)) => (one - other).abs() < 1e-12,
            (one, other) => one == other,
        };
        assert!(found.iter().zip(&expected).all(is_near), "{found:?} {expected:?}");
    }

    /// Reactions (1, 2) N and 0.5 N m on the rod: the rod loads the sensor with the opposite of them.
    #[test]
    fn turned_and_at_a_lever() {
        let same = Mounting::new(Frame::same());
        alike(measured(&same, 0.3), [-1.0, -2.0, -0.5]);
        alike(measured(&same.with_sense(Sense::Reaction), 0.3), [1.0, 2.0, 0.5]);
        // its x along y of the scene, the clamp 12 mm along its y: the torque about its origin is -0.5 + d x F
        let frame = Frame::planar(std::f64::consts::FRAC_PI_2).unwrap().with_origin([0.0, 0.012, 0.0]).unwrap();
        let turned = Mounting::new(frame);
        alike(measured(&turned, 0.3), [-2.0, 1.0, -0.5 - 0.012 * -2.0]);
        // a quarter of a turn further with the clamp
        let with_clamp = turned.turning_with_clamp(0.3).unwrap();
        alike(measured(&with_clamp, 0.3 + std::f64::consts::FRAC_PI_2), [1.0, 2.0, -0.5 - 0.012]);
        assert!(turns(&with_clamp) && !turns(&turned));
    }
}
