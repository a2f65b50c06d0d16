//! Wires whose diameter is measured in several places, against an independent solution for each cone, and against other ways to write them.

use super::judge::{Exact, Tapered, carried, errors, exact_cut};
use crate::reference::Random;
use rod_core::{
    CurvatureSpec, Cut, Elastica, GeneralElastica, Load, NaturalCurvature, PhysicalRod, Pose, Rod, RodError, RodFault,
    RodModel, RodSpec, StiffnessSpec, VaryingRod,
};
use std::f64::consts::PI;
use twofloat::TwoFloat;

const LENGTH: f64 = 0.04;
const MODULUS: f64 = 3e9;
/// Arc lengths and diameters, m: of a thick root, a waist, a bulge and a tip.
const POINTS: [[f64; 2]; 4] = [[0.0, 1e-4], [0.011, 0.7e-4], [0.023, 0.8e-4], [LENGTH, 2e-5]];

fn wire(points: &[[f64; 2]]) -> VaryingRod {
    Rod::from_diameters(LENGTH, points, MODULUS).unwrap()
}

/// The exact cut at `to`, in units of the rod, of what begins at the clamp: cone by cone, each in units of its own stiffness.
fn exact(points: &[[f64; 2]], bend: [f64; 2], start: &Cut, [a, b]: [f64; 2], to: f64) -> Exact {
    let mut cut = exact_cut(start);
    for pair in points.windows(2) {
        let ([from, thick], [end, thin]) = (pair[0], pair[1]);
        let (from, end) = (from / LENGTH, end / LENGTH);
        if from >= to {
            break;
        }
        let stiffness = (thick / points[0][1]).powi(4);
        let cone = Tapered { taper: (1.0 - thin / thick) / (end - from), bend: [bend[0] + bend[1] * from, bend[1]] };
        let scaled = |v: TwoFloat| v / stiffness;
        let own = [cut[0], cut[1], cut[2], scaled(cut[3])];
        let zero = TwoFloat::from(0.0);
        let force = [a, b].map(|v| scaled(TwoFloat::from(v)));
        cut = carried(&cone, zero, own, force, TwoFloat::from(end.min(to) - from));
        cut[3] *= stiffness;
    }
    cut
}

#[test]
fn cones_in_a_row_are_those_of_an_independent_solution() {
    let step = [[0.0, 1e-4], [0.02, 1e-4], [0.02 + 4e-8, 0.8e-4], [LENGTH, 0.8e-4]];
    let mut random = Random::new(14);
    for (points, bend) in [(&POINTS, [0.0, 0.0]), (&POINTS, [0.5, 1.0]), (&step, [0.0, 0.0])] {
        let rod = wire(points);
        let bent = rod.clone().with_natural_curvature(move |s| (bend[0] + bend[1] * s / LENGTH) / LENGTH).unwrap();
        let mut worst: f64 = 0.0;
        for _ in 0..40 {
            let start = Cut { x: 0.0, y: 0.0, phi: random.within(PI), moment: random.within(0.3) };
            let force = [random.within(0.5), random.within(0.5)];
            for to in [0.2, 0.4, 0.8, 1.0] {
                let cut = bent.carry(0.0, &start, force[0], force[1], to);
                let off = errors(&cut, &exact(points, bend, &start, force, to));
                worst = off.into_iter().fold(worst, f64::max);
                if bend == [0.0, 0.0] {
                    assert_eq!(cut, rod.carry(0.0, &start, force[0], force[1], to));
                }
            }
        }
        println!("{bend:?}: off by {worst:.1e}");
        assert!(worst < 1e-12, "{worst:e}");
    }
}

#[test]
fn two_points_are_the_cone() {
    let cone = Rod::tapered(LENGTH, 1e-4, 2e-5, MODULUS).unwrap();
    // the last point may be off by rounding
    for end in [LENGTH, 0.1 * 0.4, LENGTH * (1.0 - 1e-12)] {
        let table = wire(&[[0.0, 1e-4], [end, 2e-5]]);
        let start = Cut { x: 0.0, y: 0.0, phi: 0.3, moment: 0.2 };
        assert_eq!(table.carry(0.0, &start, 0.4, -0.3, 1.0), cone.carry(0.0, &start, 0.4, -0.3, 1.0));
        assert_eq!(table.units(), cone.units());
        assert_eq!(table.bending_stress(0.013, 1e-7), cone.bending_stress(0.013, 1e-7));
    }
}

#[test]
fn many_points_on_a_line_are_the_cone() {
    let cone = Rod::tapered(LENGTH, 1e-4, 2e-5, MODULUS).unwrap();
    for count in [3, 40, 1000] {
        let point = |k: usize| {
            let part = k as f64 / (count - 1) as f64;
            [LENGTH * part, 1e-4 - 0.8e-4 * part]
        };
        let table = wire(&(0..count).map(point).collect::<Vec<_>>());
        let start = Cut { x: 0.0, y: 0.0, phi: 0.3, moment: 0.1 };
        let (one, other) = (table.carry(0.0, &start, 0.2, -0.3, 1.0), cone.carry(0.0, &start, 0.2, -0.3, 1.0));
        let off = (one.x - other.x).abs() + (one.y - other.y).abs() + (one.phi - other.phi).abs();
        assert!(off < 1e-12, "{count}: {off:e}");
        let stress = |rod: &VaryingRod| rod.bending_stress(0.03, 1e-7).unwrap();
        assert!((stress(&table) / stress(&cone) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_largest_stress_is_that_of_samples() {
    let diameter = |s: f64| {
        let k = POINTS[1..3].iter().filter(|point| point[0] <= s).count();
        let ([from, first], [to, last]) = (POINTS[k], POINTS[k + 1]);
        first + (last - first) * (s - from) / (to - from)
    };
    let rod = wire(&POINTS);
    let measured = NaturalCurvature::points(&[[0.0, 10.0], [0.023, 5.0], [LENGTH, 30.0]]).unwrap();
    let bent = rod.clone().with_natural_curvature(measured).unwrap();
    let clamp = Pose { x: 0.0, y: 0.0, phi: 0.0 };
    let mut inside = 0;
    for rod in [&rod, &bent] {
        for (s, force) in [(0.01, 3.0), (0.02, 1.0), (0.03, -0.4), (LENGTH, 0.05), (LENGTH, 0.5)] {
            let load = Load { s, force: force * rod.units().force, alpha: 0.1 };
            let (_, root) = GeneralElastica::under_loads(rod, rod.units(), clamp, &[load]).unwrap();
            let shape = Elastica::of_rod(rod.clone(), rod.units(), clamp, root.at, &[load]).unwrap();
            let count = 40_000;
            let stress = |s: f64| 32.0 * shape.moment(s).abs() / (PI * diameter(s).powi(3));
            let places = (0..=count).map(|k| LENGTH * f64::from(k) / f64::from(count));
            let (at, most) =
                places.map(|s| (s, stress(s))).fold((0.0, 0.0), |best, one| if one.1 > best.1 { one } else { best });
            inside += usize::from(at > 0.0);
            let found = rod.largest_stress(&shape).unwrap();
            assert!(
                (found / most - 1.0).abs() < 1e-6 && found >= most * (1.0 - 1e-9),
                "{s} {force}: {found} {most} at {at}"
            );
        }
    }
    assert!(inside >= 4, "{inside}");
}

fn spec(points: &[[f64; 2]]) -> RodSpec {
    let stiffness = StiffnessSpec { youngs_modulus: Some(MODULUS), ..StiffnessSpec::default() };
    RodSpec { diameters: Some(points.to_vec()), ..RodSpec::new(LENGTH, stiffness) }
}

#[test]
fn a_rod_is_written_with_them() {
    let rod = spec(&POINTS).build().unwrap();
    let start = Cut { x: 0.0, y: 0.0, phi: 0.3, moment: 0.2 };
    let end = |rod: &VaryingRod| rod.carry(0.0, &start, 0.4, -0.3, 1.0);
    assert_eq!(end(rod.varying().unwrap()), end(&wire(&POINTS)));
    let measured = vec![[0.0, 8.0], [0.02, 10.0], [LENGTH, 20.0]];
    let bent = RodSpec { natural_curvature: Some(CurvatureSpec::Points(measured)), ..spec(&POINTS) };
    assert!(bent.build().unwrap().varying().is_some());
    // one that is uniform is so, however it is written
    let alike = spec(&[[0.0, 1e-4], [0.01, 1e-4], [LENGTH, 1e-4]]).build().unwrap();
    assert_eq!(alike.uniform(), Some(&Rod::from_diameter(LENGTH, 1e-4, MODULUS).unwrap()));
}

#[test]
fn what_is_no_table_of_diameters() {
    let fault = |spec: RodSpec| -> RodFault { spec.build().unwrap_err() };
    for (points, expected) in [
        (&[][..], &["diameter has 0 points, expected two or more"][..]),
        (&[[0.0, 1e-4]], &["diameter has 1 points"]),
        (&[[0.001, 1e-4], [LENGTH, 1e-5]], &["point 1 of diameter has the arc length 0.001 m, expected 0, the base"]),
        (&[[0.0, 1e-4], [0.03, 1e-5]], &["point 2 of diameter has the arc length 0.03 m, expected 0.04 m, the length"]),
        (&[[0.0, 1e-4], [0.05, 1e-5]], &["point 2 of diameter has the arc length 0.05 m, expected 0.04 m, the length"]),
        (
            &[[0.0, 1e-4], [0.02, -1e-5], [0.02, 2e-5], [f64::NAN, 0.9e-6], [LENGTH, 0.05]],
            &[
                "diameter of point 2 is -1e-5 m, expected a positive, finite number; ",
                "point 3 of diameter has the arc length 0.02 m, expected more than that of the point before; ",
                "point 4 of diameter has the arc length NaN m, expected more",
                "diameter of point 4 is 9e-7 m, expected between 0.01 and 100 times that at the clamp, 0.0001 m; ",
                "diameter of point 5 is 0.05 m, expected at most the length, 0.04 m",
            ],
        ),
        (
            &[[0.0, 0.0], [0.02, f64::INFINITY], [LENGTH, f64::NAN]],
            &["point 1 is 0.0", "point 2 is inf", "point 3 is NaN"],
        ),
        (&[[-1.0, 0.0]; 9], &["; and 13 more"]),
        (
            &[[0.0, 1e-4], [0.02, 1e-4], [0.02 + 1e-15, 2e-5], [LENGTH, 2e-5]],
            &["diameter changes from 0.0001 to 2e-5 m between the points 2 and 3, expected points further apart"],
        ),
    ] {
        let fault = fault(spec(points));
        assert_eq!((fault.section, fault.field), (None, Some("diameter")), "{fault}");
        assert!(expected.iter().all(|part| fault.message.contains(part)), "{expected:?} is not in: {fault}");
    }
    for (spec, field, expected) in [
        (RodSpec { tip_diameter: Some(1e-5), ..spec(&POINTS) }, Some("tip_diameter"), "beside the diameters of points"),
        (
            RodSpec { stiffness: StiffnessSpec::of_wire(1e-4, MODULUS), ..spec(&POINTS) },
            Some("diameter"),
            "expected one of the two",
        ),
        (
            RodSpec { stiffness: StiffnessSpec::of(1.0), ..spec(&POINTS) },
            Some("bending_stiffness"),
            "either it or those two",
        ),
        (RodSpec { stiffness: StiffnessSpec::default(), ..spec(&POINTS) }, None, "missing field `youngs_modulus`"),
        (
            RodSpec {
                sections: vec![rod_core::SectionSpec {
                    length: LENGTH,
                    stiffness: StiffnessSpec::of(1.0),
                    natural_curvature: None,
                }],
                ..spec(&POINTS)
            },
            Some("diameter"),
            "diameter is given beside sections",
        ),
        (RodSpec { yield_stress: Some(1e9), ..spec(&POINTS) }, Some("yield_stress"), "uniform rod alone"),
    ] {
        let fault = fault(spec);
        assert!(fault.field == field && fault.message.contains(expected), "{field:?}: {fault}");
    }
    let error = Rod::from_diameters(LENGTH, &POINTS, -1.0).unwrap_err();
    assert_eq!(error, RodError::NotPositive { what: "youngs_modulus", value: -1.0 });
}
