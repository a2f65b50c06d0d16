//! Laws that the contact of a rod obeys, whatever the rod.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use nalgebra::{Matrix2x3, Matrix3, Vector3};
use proptest::prelude::*;
use rod_core::{Dual, Elastica, Load, Pose, Reactions, Rod, Section, advance, find_root, inflection};
use rod_reconstruct::{Label, NoContact, Sample, Settings, Touch, reconstruct, single};
use std::f64::consts::{FRAC_PI_2, PI};

const NONE: Matrix3<f64> = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);

fn turn(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

/// A rod bent by one contact at arc length `s` (in lengths), where it leans by `angle` against the contour's tangent:
/// 0 of a tangential contact.
fn bent(rod: &Rod, clamp: Pose, s: f64, force: f64, angle: f64) -> (Elastica, Load) {
    let units = rod.units();
    let shape = |alpha: f64| {
        let load = Load { s: s * units.length, force: force * units.force, alpha };
        Elastica::under_loads(units, clamp, &[load]).map(|bent| (bent.0, load))
    };
    let off = |alpha: f64| Ok(shape(alpha)?.0.at(s * units.length).phi - alpha - angle);
    shape(find_root("angle", off, clamp.phi - 2.6, clamp.phi + 0.1, 1e-14).unwrap().at).unwrap()
}

fn lines(touch: &Touch) -> [f64; 5] {
    [touch.s, touch.x, touch.y, touch.alpha, touch.force]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_bends_the_rod_is_found_again(
        length in -3.0..1.0_f64, stiffness in -6.0..2.0_f64, x in -2.0..2.0, y in -2.0..2.0, phi in -7.0..7.0,
        force in 0.05..2.0, lean in 0.05..1.0, s in 0.4..1.0, tip: bool,
    ) {
        let rod = Rod::new(10.0_f64.powf(length), 10.0_f64.powf(stiffness)).unwrap();
        let l = rod.length();
        let clamp = Pose { x: x * l, y: y * l, phi };
        let (shape, load) = bent(&rod, clamp, if tip { 1.0 } else { s }, force, if tip { lean } else { 0.0 });
        let found = single(&rod, clamp, shape.reactions(), &NONE).unwrap();
        let truth = shape.at(load.s);
        prop_assert!((found.x - truth.x).hypot(found.y - truth.y) < 1e-11 * l);
        prop_assert!((found.s - load.s).abs() < 1e-11 * l);
        prop_assert!((found.force - load.force).abs() < 1e-11 * load.force);
        prop_assert!(turn(found.alpha - load.alpha).abs() < 1e-11);
        prop_assert_eq!(found.covariance.norm(), 0.0);
    }

    #[test]
    fn the_covariance_is_that_of_the_derivatives_by_dual_numbers(
        phi in -3.0..3.0, force in 0.2..2.0, lean in 0.05..1.0,
    ) {
        let rod = Rod::new(1.0, 1.0).unwrap();
        let clamp = Pose { x: 0.3, y: -0.1, phi };
        let Reactions { f0x, f0y, m0z } = bent(&rod, clamp, 1.0, force, lean).0.reactions();
        let constant = Dual::<f64, 3>::constant;
        let variable = |value: f64, index| Dual::<f64, 3>::variable(value, index);
        let (a, b) = (variable(f0y, 1), -variable(f0x, 0));
        let start = Section { x: constant(clamp.x), y: constant(clamp.y), phi: constant(phi), kappa: -variable(m0z, 2) };
        let end = advance(&start, a, b, inflection(&start, a, b).unwrap());
        let by = Matrix2x3::from_fn(|i, j| [end.x, end.y][i].derivatives[j]);
        let noise = Matrix3::new(1e-8, 2e-9, 0.0, 2e-9, 2e-8, -1e-9, 0.0, -1e-9, 5e-9);
        let found = single(&rod, clamp, Reactions { f0x, f0y, m0z }, &noise).unwrap();
        let expected = by * noise * by.transpose();
        prop_assert!((found.covariance - expected).norm() < 1e-9 * expected.norm());
    }

    /// A rod a times as long and b times as stiff under reactions b / a^2 and b / a as great touches at a times the
    /// place.
    #[test]
    fn scale(a in 1e-3..1e3, b in 1e-3..1e3, force in 0.1..2.0, lean in 0.05..1.0) {
        let (one, other) = (Rod::new(1.0, 1.0).unwrap(), Rod::new(a, b).unwrap());
        let clamp = Pose { x: 0.3, y: -0.1, phi: 1.0 };
        let r = bent(&one, clamp, 1.0, force, lean).0.reactions();
        let found = single(&one, clamp, r, &NONE).unwrap();
        let (f, m) = (b / a / a, b / a);
        let large = Reactions { f0x: r.f0x * f, f0y: r.f0y * f, m0z: r.m0z * m };
        let scaled = single(&other, Pose { x: 0.3 * a, y: -0.1 * a, phi: 1.0 }, large, &NONE).unwrap();
        let expected = [found.s * a, found.x * a, found.y * a, found.alpha, found.force * f];
        for (value, expected) in lines(&scaled).into_iter().zip(expected) {
            prop_assert!((value - expected).abs() < 1e-12 * (1.0 + expected.abs()) + 1e-12 * a, "{value} {expected}");
        }
    }

    /// Seen in a mirror (x to -x) the solid is on the right of its contour's image: to have it on the left again, the
    /// contour is travelled the other way, so that alpha becomes -alpha.
    #[test]
    fn mirror(phi in -3.0..3.0, force in 0.1..2.0, lean in 0.05..1.0) {
        let rod = Rod::new(1.0, 1.0).unwrap();
        let clamp = Pose { x: 0.3, y: -0.1, phi };
        let r = bent(&rod, clamp, 1.0, force, lean).0.reactions();
        let found = single(&rod, clamp, r, &NONE).unwrap();
        let image = Reactions { f0x: -r.f0x, f0y: r.f0y, m0z: -r.m0z };
        let seen = single(&rod, Pose { x: -0.3, y: -0.1, phi: PI - phi }, image, &NONE).unwrap();
        prop_assert!((seen.x + found.x).abs() < 1e-12 && (seen.y - found.y).abs() < 1e-12);
        prop_assert!((seen.s - found.s).abs() < 1e-12 && (seen.force - found.force).abs() < 1e-12);
        prop_assert!(turn(seen.alpha + found.alpha).abs() < 1e-12);
    }

    #[test]
    fn rigid_motion(angle in -7.0..7.0_f64, dx in -3.0..3.0_f64, dy in -3.0..3.0_f64, force in 0.1..2.0, lean in 0.05..1.0) {
        let rod = Rod::new(1.0, 1.0).unwrap();
        let clamp = Pose { x: 0.3, y: -0.1, phi: 1.0 };
        let r = bent(&rod, clamp, 1.0, force, lean).0.reactions();
        let found = single(&rod, clamp, r, &NONE).unwrap();
        let (sin, cos) = angle.sin_cos();
        let turned = |x: f64, y: f64| (x * cos - y * sin, x * sin + y * cos);
        let (x, y) = turned(clamp.x, clamp.y);
        let (f0x, f0y) = turned(r.f0x, r.f0y);
        let pose = Pose { x: x + dx, y: y + dy, phi: 1.0 + angle };
        let moved = single(&rod, pose, Reactions { f0x, f0y, m0z: r.m0z }, &NONE).unwrap();
        let (x, y) = turned(found.x, found.y);
        prop_assert!((moved.x - x - dx).hypot(moved.y - y - dy) < 1e-12);
        prop_assert!((moved.s - found.s).abs() < 1e-12 && (moved.force - found.force).abs() < 1e-12);
        prop_assert!(turn(moved.alpha - found.alpha - angle).abs() < 1e-12);
    }

    /// A rod that buckles, as one does whose tip is pushed into a notch, is straight before its tip too.
    #[test]
    fn a_rod_that_is_straight_twice_touches_with_its_tip(
        force in 5.0..40.0, alpha in -3.0..3.0, amplitude in 0.05..0.6, kappa in 0.3..1.5, left: bool,
    ) {
        let side = if left { 1.0 } else { -1.0 };
        let (a, b) = (force * f64::cos(alpha), force * f64::sin(alpha));
        let start = Section { x: 0.2, y: 0.1, phi: alpha + FRAC_PI_2 + side * amplitude, kappa: -side * kappa };
        let first = inflection(&start, a, b).unwrap();
        // Beyond its first zero the moment vanishes once more, at the end of this rod.
        let moment = |s: f64| Ok(advance(&start, a, b, s).kappa);
        let mut length = first + 0.05;
        while advance(&start, a, b, length + 0.01).kappa * advance(&start, a, b, length).kappa > 0.0 {
            length += 0.01;
        }
        let length = find_root("moment", moment, length, length + 0.01, 0.0).unwrap().at;
        let rod = Rod::new(length, 1.0).unwrap();
        let clamp = Pose { x: 0.2, y: 0.1, phi: start.phi };
        let reactions = Reactions { f0x: -b, f0y: a, m0z: -start.kappa };
        let found = single(&rod, clamp, reactions, &NONE).unwrap();
        let tip = advance(&start, a, b, length);
        prop_assert!((found.s - length).abs() < 1e-11 * length, "{} {}", found.s, length);
        prop_assert!((found.x - tip.x).hypot(found.y - tip.y) < 1e-11 * length);
        // a rod a little longer would need a second contact: what is found is the first place without moment
        let longer = single(&Rod::new(1.01 * length, 1.0).unwrap(), clamp, reactions, &NONE).unwrap();
        prop_assert!((longer.s - first).abs() < 1e-11);
    }
}

#[test]
fn each_reason_for_none() {
    let rod = Rod::new(0.1, 6.3e-4).unwrap();
    let clamp = Pose { x: 0.0, y: 0.0, phi: FRAC_PI_2 };
    let find = |f0x: f64, f0y: f64, m0z: f64, noise: &Matrix3<f64>| {
        single(&rod, clamp, Reactions { f0x, f0y, m0z }, noise).unwrap_err()
    };
    assert_eq!(find(0.0, 0.0, 0.0, &NONE), NoContact::Free);
    let noise = Matrix3::from_diagonal(&Vector3::new(1e-6, 1e-6, 1e-10));
    assert_eq!(find(3e-3, -3e-3, 3e-5, &noise), NoContact::Free);
    // a moment without a force: a circle
    assert_eq!(find(0.0, 0.0, 1e-3, &NONE), NoContact::NoMomentZero);
    for (f0x, m0z) in [(f64::NAN, 1e-3), (1e-3, f64::INFINITY)] {
        assert_eq!(find(f0x, 0.0, m0z, &NONE), NoContact::NotFinite);
    }
    assert_eq!(find(1e-3, 0.0, 1e-3, &Matrix3::from_element(f64::NAN)), NoContact::NotFinite);
    // The tip's load, but felt by a shorter rod of the same kind.
    let units = rod.units();
    let long = Rod::new(0.12, 6.3e-4).unwrap();
    let load = Load { s: 0.12, force: 0.3 * long.units().force, alpha: 0.9 };
    let Reactions { f0x, f0y, m0z } = Elastica::under_loads(long.units(), clamp, &[load]).unwrap().0.reactions();
    let NoContact::BeyondTip(touch) = find(f0x, f0y, m0z, &NONE) else { panic!("not beyond the tip") };
    assert!((touch.s - 0.12).abs() < 1e-12 && units.length == 0.1);
    // A load at the tip from the other side of its contour: the rod leaves what it should press on.
    let load = Load { s: 0.1, force: 0.2 * units.force, alpha: FRAC_PI_2 + 0.8 };
    let Reactions { f0x, f0y, m0z } = Elastica::under_loads(units, clamp, &[load]).unwrap().0.reactions();
    let NoContact::Pulling(touch) = find(f0x, f0y, m0z, &NONE) else { panic!("not pulling") };
    assert!((touch.s - 0.1).abs() < 1e-12);
}

/// A rod that is free, then bent by a dead load that grows at its tip, is labelled by its shape, not by its units.
#[test]
fn labels_are_the_same_in_other_units() {
    let scan = |length: f64, stiffness: f64| -> Vec<Label> {
        let rod = Rod::new(length, stiffness).unwrap();
        let units = rod.units();
        let samples: Vec<Sample> = (0..400)
            .map(|k| {
                let tau = 1e-3 * f64::from(k);
                let clamp = Pose { x: -tau * length, y: 0.0, phi: 1.2 };
                let force = (tau - 0.1).max(0.0) * units.force;
                let load = Load { s: length, force, alpha: 0.4 };
                Sample::new(clamp, Elastica::under_loads(units, clamp, &[load]).unwrap().0.reactions())
            })
            .collect();
        let found = reconstruct(&rod, &samples, &Settings::default()).unwrap();
        found.readings.iter().map(|reading| reading.label).collect()
    };
    let labels = scan(1.0, 1.0);
    assert!(labels.contains(&Label::Free) && labels.iter().any(|label| *label != Label::Free));
    assert_eq!(labels, scan(1000.0, 1.0));
    assert_eq!(labels, scan(0.1, 6.32e-4));
}
