//! What must hold for every segment, whatever computes it.
#![allow(clippy::unwrap_used, reason = "a test may")]

use num_dual::{Dual64, DualNum};
use proptest::prelude::*;
use rod_core::{
    Cut, Method, Ode, Propagator, Scalar, Section, Sensitivities, Uniform, advance, advance_with_sensitivities,
};
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Rem, Sub};

/// Dual numbers of another crate in the kernel: its derivatives without a line of ours.
#[derive(Clone, Copy, PartialEq)]
struct Foreign(Dual64);

macro_rules! forward {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator for Foreign {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}
forward!(Add add, Sub sub, Mul mul, Div div, Rem rem);

impl Neg for Foreign {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl PartialOrd for Foreign {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.re.partial_cmp(&other.0.re)
    }
}

impl Scalar for Foreign {
    fn from_f64(value: f64) -> Self {
        Self(value.into())
    }
    fn to_f64(self) -> f64 {
        self.0.re
    }
    fn sqrt(self) -> Self {
        Self(DualNum::sqrt(&self.0))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = DualNum::sin_cos(&self.0);
        (Self(sin), Self(cos))
    }
    fn atan2(self, x: Self) -> Self {
        Self(DualNum::atan2(&self.0, x.0))
    }
}

fn values<T: Copy>(section: &Section<T>) -> [T; 4] {
    [section.x, section.y, section.phi, section.kappa]
}

fn columns(d: &Sensitivities) -> [[f64; 4]; 5] {
    [d.by_phi, d.by_kappa, d.by_a, d.by_b, d.by_s]
}

fn distance(u: &Section, v: &Section) -> f64 {
    values(u).into_iter().zip(values(v)).map(|(u, v)| (u - v).abs()).fold(0.0, f64::max)
}

fn section() -> impl Strategy<Value = Section> {
    (-1.0..1.0, -1.0..1.0, -PI..PI, prop_oneof![4 => -6.0..6.0, 1 => Just(0.0)])
        .prop_map(|(x, y, phi, kappa)| Section { x, y, phi, kappa })
}

/// Forces of every size, none among them.
fn force() -> impl Strategy<Value = (f64, f64)> {
    (-PI..PI, prop_oneof![4 => 0.0..20.0, 1 => Just(0.0), 1 => (-18.0..0.0).prop_map(|e: f64| e.exp())])
        .prop_map(|(direction, size)| (size * direction.cos(), size * direction.sin()))
}

/// As large as rounding grows in the range of the strategies; see tests/kernel.rs for the error itself.
const ROUNDING: f64 = 2e-12;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn in_two_parts_as_in_one(start in section(), (a, b) in force(), s1 in -1.0..1.0, s2 in -1.0..1.0) {
        let parts = advance(&advance(&start, a, b, s1), a, b, s2);
        prop_assert!(distance(&parts, &advance(&start, a, b, s1 + s2)) < 10.0 * ROUNDING);
    }

    #[test]
    fn no_length_no_change(start in section(), (a, b) in force()) {
        prop_assert_eq!(advance(&start, a, b, 0.0), start);
    }

    #[test]
    fn there_and_back_again(start in section(), (a, b) in force(), s in -1.0..1.0) {
        let end = advance(&start, a, b, s);
        prop_assert!(distance(&advance(&end, a, b, -s), &start) < 10.0 * ROUNDING);
        // the same rod from its other end: travelled the other way, tangent and bending change sign
        let turned = advance(&Section { phi: end.phi + PI, kappa: -end.kappa, ..end }, -a, -b, s);
        let same = Section { phi: turned.phi - PI, kappa: -turned.kappa, ..turned };
        prop_assert!(distance(&same, &start) < 10.0 * ROUNDING);
    }

    #[test]
    fn a_turned_scene_gives_the_turned_shape(start in section(), (a, b) in force(), s in -1.0..1.0, angle in -PI..PI) {
        let (sin, cos) = angle.sin_cos();
        let turn = |v: Section| Section {
            x: cos * v.x - sin * v.y, y: sin * v.x + cos * v.y, phi: v.phi + angle, kappa: v.kappa,
        };
        let ours = advance(&turn(start), cos * a - sin * b, sin * a + cos * b, s);
        prop_assert!(distance(&ours, &turn(advance(&start, a, b, s))) < ROUNDING);
    }

    #[test]
    fn a_mirrored_scene_gives_the_mirrored_shape(start in section(), (a, b) in force(), s in -1.0..1.0) {
        // y -> -y: phi and kappa change sign; kappa' = A cos phi + B sin phi asks for A -> -A
        let mirror = |v: Section| Section { x: v.x, y: -v.y, phi: -v.phi, kappa: -v.kappa };
        let ours = advance(&mirror(start), -a, b, s);
        prop_assert!(distance(&ours, &mirror(advance(&start, a, b, s))) < ROUNDING);
    }

    #[test]
    fn a_larger_scene_gives_the_larger_shape(start in section(), (a, b) in force(), s in -1.0..1.0, scale in 0.1..10.0) {
        let grow = |v: Section| Section { x: v.x * scale, y: v.y * scale, phi: v.phi, kappa: v.kappa / scale };
        let ours = advance(&grow(start), a / (scale * scale), b / (scale * scale), s * scale);
        prop_assert!(distance(&ours, &grow(advance(&start, a, b, s))) < 10.0 * ROUNDING);
    }

    #[test]
    fn moments_balance(start in section(), (a, b) in force(), s in -1.0..1.0) {
        let end = advance(&start, a, b, s);
        let balance = end.kappa - start.kappa - a * (end.x - start.x) - b * (end.y - start.y);
        prop_assert!(balance.abs() < ROUNDING, "{balance:e}");
    }

    #[test]
    fn energy_is_conserved(start in section(), (a, b) in force(), s in -1.0..1.0) {
        let energy = |v: &Section| 0.5 * v.kappa * v.kappa - a * v.phi.sin() + b * v.phi.cos();
        let end = advance(&start, a, b, s);
        prop_assert!((energy(&end) - energy(&start)).abs() < 10.0 * ROUNDING);
    }

    #[test]
    fn closed_form_and_integrator_agree(
        phi in -PI..PI, kappa in -4.0..4.0, direction in -PI..PI, size in 0.0..6.0, s in -1.0..1.0,
    ) {
        let (a, b) = (size * f64::cos(direction), size * f64::sin(direction));
        let start = Cut { x: 0.0, y: 0.0, phi, moment: kappa };
        let u = Uniform.advance(0.0, &start, a, b, s).unwrap();
        let v = Ode::uniform(Method::Dop853, 1e-14).unwrap().advance(0.0, &start, a, b, s).unwrap();
        for (u, v) in [(u.x, v.x), (u.y, v.y), (u.phi, v.phi), (u.moment, v.moment)] {
            // the integrator's error, up to 1.7e-12 in two million cases; the closed form's is 1e-15
            prop_assert!((u - v).abs() < 5e-12, "{u} {v}");
        }
    }

    #[test]
    fn sensitivities_are_those_of_foreign_dual_numbers(start in section(), (a, b) in force(), s in -1.0..1.0) {
        // at A = B = 0 the norm of the force has no derivative, and dual numbers fail where ours do not
        if a == 0.0 && b == 0.0 {
            return Ok(());
        }
        let (_, ours) = advance_with_sensitivities(&start, a, b, s);
        for (k, column) in columns(&ours).into_iter().enumerate() {
            let seed = |value, index| Foreign(Dual64::new(value, f64::from(u8::from(k == index))));
            let start = Section {
                x: seed(start.x, 9), y: seed(start.y, 9), phi: seed(start.phi, 0), kappa: seed(start.kappa, 1),
            };
            let end = advance(&start, seed(a, 2), seed(b, 3), seed(s, 4));
            for (ours, theirs) in column.into_iter().zip(values(&end)) {
                prop_assert!((ours - theirs.0.eps).abs() < 1e-11 * (1.0 + ours.abs()), "{k}: {ours} {}", theirs.0.eps);
            }
        }
    }

    #[test]
    fn sensitivities_are_continuous_where_the_force_vanishes(start in section(), direction in -PI..PI, s in -1.0..1.0) {
        let (_, none) = advance_with_sensitivities(&start, 0.0, 0.0, s);
        let (_, tiny) = advance_with_sensitivities(&start, 1e-13 * direction.cos(), 1e-13 * direction.sin(), s);
        for (u, v) in columns(&none).into_iter().flatten().zip(columns(&tiny).into_iter().flatten()) {
            // the integrator's error, up to 1.7e-12 in two million cases; the closed form's is 1e-15
            prop_assert!((u - v).abs() < 5e-12, "{u} {v}");
        }
    }
}
