//! The linearisation against differences of the residual.

use super::*;
use crate::clamp::{Elastic, Pivot};
use crate::model::Uniform;
use crate::solve::System;
use crate::support_problem::Support;
use proptest::prelude::*;

/// Circles r = centre + radius (sin t, -cos t), each moved by `amount` of its rate: translated, and turned about its centre; with friction that
/// changes, too.
struct Circles {
    all: Vec<(Hold, [f64; 3], SupportRate)>,
    amount: f64,
}

/// How the friction of a circle changes.
fn by_grip(j: usize) -> f64 {
    0.7 - 0.4 * j as f64
}

impl Supports for Circles {
    fn count(&self) -> usize {
        self.all.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.all[j].0
    }
    fn support(&self, j: usize, t: f64) -> Support {
        let (_, [x, y, radius], rate) = self.all[j];
        let at = |v: f64| self.amount * v;
        let (x, y, alpha) = (x + radius * t.sin() + at(rate.x), y - radius * t.cos() + at(rate.y), t + at(rate.alpha));
        Support { x, y, alpha, speed: radius, turning: 1.0 }
    }
    fn grip(&self, j: usize) -> Grip {
        Grip::Slips { ratio: 0.1 * j as f64 - 0.2 + self.amount * by_grip(j) }
    }
}

proptest! {
    #[test]
    fn rates_of_the_residual_are_its_derivatives(
        contacts in prop::collection::vec(
            (-1.0..1.0_f64, -4.0..4.0_f64, 0.1..0.4_f64, 0.05..2.0_f64, [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0]),
            1..5,
        ),
        tip: bool,
        path in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        springs in prop::array::uniform3(prop::array::uniform3(-0.3..0.3_f64)),
    ) {
        let n = contacts.len();
        let mut s = 0.0;
        let (mut u, mut all) = (Vec::new(), Vec::new());
        for (j, (t, f, ds, radius, [x, y, alpha])) in contacts.into_iter().enumerate() {
            s += ds;
            let at_tip = tip && j + 1 == n;
            u.extend([t, f, if at_tip { 0.7 } else { s }]);
            let offset = if j % 2 == 0 { 0.0 } else { std::f64::consts::PI };
            let hold = if at_tip { Hold::Tip } else { Hold::Tangent { offset } };
            all.push((hold, [0.3 * j as f64, 0.2, radius], SupportRate { x, y, alpha }));
        }
        let path = Pose { x: path[0], y: path[1], phi: path[2] };
        let compliance = springs;
        the_rates_are_derivatives(&all, &u, path, |pose| pose)?;
        the_rates_are_derivatives(&all, &u, path, |pose| Elastic { pose, compliance })?;
        the_rates_are_derivatives(&all, &u, path, |pose| Pivot { pose, torque: 0.7 })?;
    }
}

fn the_rates_are_derivatives<C: Clamp>(
    all: &[(Hold, [f64; 3], SupportRate)],
    u: &[f64],
    path: Pose,
    held: impl Fn(Pose) -> C,
) -> Result<(), TestCaseError> {
    let residual = |amount: f64| {
        let circles = Circles { all: all.to_vec(), amount };
        let clamp = held(Pose { x: amount * path.x, y: amount * path.y, phi: 1.5 + amount * path.phi });
        let mut residual = vec![0.0; u.len()];
        MultiPoint { rod: Uniform, clamp, supports: &circles }.evaluate(u, &mut residual, None);
        residual
    };
    let circles = Circles { all: all.to_vec(), amount: 0.0 };
    let clamp = held(Pose { x: 0.0, y: 0.0, phi: 1.5 });
    let linear = MultiPoint { rod: Uniform, clamp, supports: &circles }.linearise(u);
    let moves: Vec<_> = all.iter().map(|one| one.2).collect();
    let rubs: Vec<_> = (0..all.len()).map(|j| u[3 * j + 1] * by_grip(j)).collect();
    let rates = linear.rates_of_residual(path, &moves, &rubs).unwrap();
    let (up, down) = (residual(1e-5), residual(-1e-5));
    for (row, ours) in rates.iter().enumerate() {
        let difference = (up[row] - down[row]) / 2e-5;
        prop_assert!((difference - ours).abs() < 1e-6 * (1.0 + ours.abs()), "{row}: {ours} {difference}");
    }
    prop_assert!(linear.residual_rates(path, &moves[1..]).is_none());
    Ok(())
}

#[test]
fn a_rod_that_touches_nothing_feels_nothing() {
    let none = Circles { all: Vec::new(), amount: 0.0 };
    let linear = MultiPoint { rod: Uniform, clamp: Pose { x: 0.0, y: 0.0, phi: 0.0 }, supports: &none }.linearise(&[]);
    let moved = linear.response(Pose { x: 1.0, y: 2.0, phi: 3.0 }, &[]).unwrap();
    assert_eq!(linear.response_to_grips(&[]), Some(Response::default()));
    assert_eq!((moved, linear.condition(), linear.residual()), (Response::default(), 1.0, 0.0));
}
