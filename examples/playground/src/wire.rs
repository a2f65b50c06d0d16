//! The rod of the page: a round wire that may taper and be bent at rest.

use vibrissa::rod::{CurvatureSpec, RodSpec, StiffnessSpec};

/// Length and diameter at the clamp (m), Young's modulus (Pa), diameter of the tip over that of the clamp, curvature at rest (1/m).
pub fn spec(length: f64, diameter: f64, modulus: f64, taper: f64, curvature: f64) -> RodSpec {
    RodSpec {
        tip_diameter: Some(diameter * taper),
        natural_curvature: Some(CurvatureSpec::Constant(curvature)),
        ..RodSpec::new(length, StiffnessSpec::of_wire(diameter, modulus))
    }
}
