//! Rods from SI units as a user makes them, against closed forms of small deflections, shapes at rest, and their own limits.

use rod_core::{GeneralElastica, Load, NaturalCurvature, Pose, Rod, RodError, RodModel, RodSection, VaryingRod};
use std::f64::consts::PI;

const CLAMP: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
const LENGTH: f64 = 0.1;

/// Deflection of the tip towards -y under a small force across it, per force (m / N).
fn compliance(rod: &VaryingRod) -> f64 {
    let force = 1e-6 * rod.units().force;
    let load = Load { s: rod.length(), force, alpha: 0.0 };
    let (shape, _) = GeneralElastica::under_loads(rod, rod.units(), CLAMP, &[load]).unwrap();
    assert!((shape.reactions().f0y / force - 1.0).abs() < 1e-12);
    assert!((shape.reactions().m0z / (force * rod.length()) - 1.0).abs() < 1e-9);
    -shape.at(rod.length()).unwrap().y / force
}

#[test]
fn small_deflections_are_those_of_beam_theory() {
    // a tapered wire: 64 L^3 / (3 pi E base^3 tip), that is L^3 / 3 EI times base / tip
    for (base, tip) in [(1e-3, 1e-3), (1e-3, 0.5e-3), (1e-3, 0.1e-3), (0.2e-3, 1e-3)] {
        let rod = Rod::tapered(LENGTH, base, tip, 206e9).unwrap();
        let exact = 64.0 * LENGTH.powi(3) / (3.0 * PI * 206e9 * base.powi(3) * tip);
        assert!((compliance(&rod) / exact - 1.0).abs() < 1e-9, "{base} {tip}: {} {exact}", compliance(&rod));
    }
    // two sections, by Mohr's integral of (L - s)^2 / EI
    let section = |length, bending_stiffness| RodSection { length, bending_stiffness, natural_curvature: 0.0 };
    let rod = Rod::sections(LENGTH, &[section(0.06, 6e-4), section(0.04, 1e-4)]).unwrap();
    let outer = 0.04_f64.powi(3);
    let exact = (LENGTH.powi(3) - outer) / 3.0 / 6e-4 + outer / 3.0 / 1e-4;
    assert!((compliance(&rod) / exact - 1.0).abs() < 1e-9);
    // a width that falls linearly: w = f L^3 / EI (2 ln 2 - 1) for EI (1 - s / 2 L)
    let rod = Rod::varying(LENGTH, |s| 1e-3 * (1.0 - 5.0 * s), &[]).unwrap();
    let exact = LENGTH.powi(3) / 1e-3 * (2.0 * std::f64::consts::LN_2 - 1.0);
    assert!((compliance(&rod) / exact - 1.0).abs() < 1e-9);
}

/// Where the tip is without a load.
fn tip_at_rest(rod: &VaryingRod) -> [f64; 3] {
    let (shape, root) = GeneralElastica::under_loads(rod, rod.units(), CLAMP, &[]).unwrap();
    assert_eq!(root.at, 0.0);
    let tip = shape.at(rod.length()).unwrap();
    [tip.x, tip.y, tip.phi]
}

#[test]
fn without_a_load_a_rod_has_its_natural_curvature() {
    let uniform = Rod::new(LENGTH, 1e-3).unwrap();
    let cone = || Rod::tapered(LENGTH, 1e-3, 2e-4, 206e9).unwrap();
    let turn = 40.0 * LENGTH;
    let arc = [turn.sin() / 40.0, (1.0 - turn.cos()) / 40.0, turn];
    for rod in [uniform.with_natural_curvature(40.0), cone().with_natural_curvature(40.0)] {
        let tip = tip_at_rest(&rod.unwrap());
        assert!(tip.iter().zip(&arc).all(|(tip, arc)| (tip - arc).abs() < 1e-12), "{tip:?} {arc:?}");
    }
    // more than a full turn; a spiral that is bent more and more does not come back to itself
    let loops = [uniform.with_natural_curvature(100.0), cone().with_natural_curvature(70.0)];
    assert!(cone().with_natural_curvature(|s: f64| 90.0 + 100.0 * s).is_ok());
    assert!(loops.into_iter().all(|rod| matches!(rod, Err(RodError::CrossesItself { .. }))));
    // coils that the chords of the check do not show
    for curvature in [2e3, -1e9, 1e300] {
        let coils = [uniform.with_natural_curvature(curvature), cone().with_natural_curvature(curvature)];
        assert!(coils.into_iter().all(|rod| matches!(rod, Err(RodError::Coiled { .. }))), "{curvature}");
    }
    // kappa = pi s / L^2: the Fresnel integrals, C(1) and S(1) (Abramowitz and Stegun, table 7.7)
    let clothoid = |s: f64| PI * s / (LENGTH * LENGTH);
    let two = RodSection { length: 0.5 * LENGTH, bending_stiffness: 1e-3, natural_curvature: 7.0 };
    for rod in [
        uniform.with_natural_curvature(clothoid),
        cone().with_natural_curvature(clothoid),
        Rod::varying(LENGTH, |s| 1.0 + s, &[0.03]).unwrap().with_natural_curvature(clothoid),
        Rod::sections(LENGTH, &[two, two]).unwrap().with_natural_curvature(clothoid),
    ] {
        let [x, y, phi] = tip_at_rest(&rod.unwrap());
        let off = [x / LENGTH - 0.779_893_400_376_823, y / LENGTH - 0.438_259_147_390_354_8, phi - 0.5 * PI];
        assert!(off.iter().all(|v| v.abs() < 1e-13), "{off:?}");
    }
    // an arc and its counter-arc, by a curvature that jumps where two sections meet
    let back = Rod::sections(LENGTH, &[two, two]).unwrap();
    let back = back.with_natural_curvature(|s: f64| if s < 0.5 * LENGTH { 20.0 } else { -20.0 }).unwrap();
    let [x, y, phi] = tip_at_rest(&back);
    assert!((x - 0.1 * 1.0_f64.sin()).abs() + (y - 0.1 * (1.0 - 1.0_f64.cos())).abs() + phi.abs() < 1e-14);
}

#[test]
fn the_same_rod_made_in_different_ways_is_the_same() {
    let clamp = rod_core::Cut { x: 0.0, y: 0.0, phi: 0.2, moment: 0.7 };
    let end = |rod: &dyn RodModel| rod.carry(0.0, &clamp, 0.3, -0.9, 1.0);
    let uniform = end(&rod_core::Uniform);
    let rod = Rod::new(LENGTH, 1e-3).unwrap();
    let section = RodSection { length: 0.5 * LENGTH, bending_stiffness: 1e-3, natural_curvature: 0.0 };
    let ways = [
        ("no curvature", rod.with_natural_curvature(0.0)),
        ("no curvature anywhere", rod.with_natural_curvature(|_| 0.0)),
        ("equal sections", Rod::sections(LENGTH, &[section, section])),
        ("no taper", Rod::tapered(LENGTH, 1e-3, 1e-3, 1e9)),
        ("a constant", Rod::varying(LENGTH, |_| 3.0, &[])),
    ];
    for (name, rod) in ways {
        let ours = end(&rod.unwrap());
        let off = (ours.x - uniform.x).hypot(ours.y - uniform.y) + (ours.phi - uniform.phi).abs();
        assert!(off < 1e-12, "{name}: {off:e}");
    }
    // a cone, and the function that it is
    let cone = Rod::tapered(LENGTH, 1e-3, 2e-4, 206e9).unwrap();
    let function = Rod::varying(LENGTH, |s| 7.0 * (1.0 - 8.0 * s).powi(4), &[]).unwrap();
    let (cone, function) = (end(&cone), end(&function));
    assert!((cone.x - function.x).abs() + (cone.phi - function.phi).abs() < 1e-11, "{cone:?} {function:?}");
}

#[test]
fn bad_input_names_field_value_and_expectation() {
    let wire = |base, tip| Rod::tapered(LENGTH, base, tip, 206e9);
    let section =
        |length, bending_stiffness, natural_curvature| RodSection { length, bending_stiffness, natural_curvature };
    let rod = Rod::new(LENGTH, 1e-3).unwrap();
    for (result, expected) in [
        (wire(1e-3, 0.0), ["tip_diameter", "is 0,", "positive"]),
        (wire(1e-3, -1e-4), ["tip_diameter", "is -0.0001,", "positive"]),
        (wire(1e-3, f64::NAN), ["tip_diameter", "is NaN,", "positive"]),
        (wire(0.0, 1e-3), ["diameter at the clamp", "is 0,", "positive"]),
        (wire(0.5e-3, 0.2), ["diameter is 0.2 m", "at most the length", "0.1 m"]),
        (wire(1e-3, 0.9e-5), ["tip_diameter is 9e-6 m", "between 0.01 and 100", "the diameter at the clamp, 0.001 m"]),
        (Rod::tapered(LENGTH, 1e-3, 1e-4, 0.0), ["youngs_modulus", "is 0,", "positive"]),
        (Rod::tapered(-1.0, 1e-3, 1e-4, 1e9), ["length", "is -1,", "positive"]),
        (Rod::sections(LENGTH, &[]), ["number of sections", "is 0,", "positive"]),
        (
            Rod::sections(LENGTH, &[section(0.06, 1.0, 0.0), section(0.03, 1.0, 0.0)]),
            ["add up to 0.09", "expected 0.1", "length"],
        ),
        (
            Rod::sections(LENGTH, &[section(0.1, -1e-3, 0.0)]),
            ["bending_stiffness of section 0", "is -0.001,", "positive"],
        ),
        (
            Rod::sections(LENGTH, &[section(0.1, 1.0, f64::INFINITY)]),
            ["natural_curvature of section 0", "is inf,", "finite"],
        ),
        (Rod::sections(0.0, &[section(0.1, 1.0, 0.0)]), ["length", "is 0,", "positive"]),
        (Rod::varying(LENGTH, |s| 1.0 - 20.0 * s, &[]), ["stiffness is -", "at arc length 0.0", "positive"]),
        (Rod::varying(LENGTH, |_| -2.0, &[]), ["bending_stiffness at arc length 0", "is -2,", "positive"]),
        (Rod::varying(LENGTH, |_| 1.0, &[0.12]), ["border at arc length 0.12", "more than 0 ", "less than the length"]),
        (Rod::varying(f64::NAN, |_| 1.0, &[]), ["length", "is NaN,", "positive"]),
        (rod.with_natural_curvature(f64::NAN), ["natural_curvature", "is NaN,", "finite"]),
        (
            rod.with_natural_curvature(|s: f64| 1.0 / (s - s)),
            ["natural curvature is inf", "at arc length 0.0", "finite"],
        ),
        (
            rod.with_natural_curvature(|s: f64| if s < 0.05 { 1.0 } else { 9.0 }),
            ["not smooth", "arc length 0.0", "border"],
        ),
    ] {
        let message = result.unwrap_err().to_string();
        assert!(expected.iter().all(|part| message.contains(part)), "{message} {expected:?}");
    }
    // points go from 0 to the length, but for rounding
    let points = |from: f64, to: f64| {
        let points = NaturalCurvature::points(&[[from, 1.0], [0.04, 2.0], [to, 3.0]]).unwrap();
        rod.with_natural_curvature(points).map_err(|error| error.to_string()).err()
    };
    let expected = |number, s, end| {
        Some(format!(
            "point {number} of natural_curvature has the arc length {s} m, expected {end} m: the points go from 0 to the length of the rod, 0.1 m"
        ))
    };
    assert_eq!(points(0.01, 0.1), expected(1, "0.01", "0.0"));
    assert_eq!(points(-0.01, 0.1), expected(1, "-0.01", "0.0"));
    assert_eq!(points(0.0, 0.09), expected(3, "0.09", "0.1"));
    assert_eq!(points(0.0, 100.0), expected(3, "100.0", "0.1"));
    assert_eq!([points(1e-12, 0.1 - 1e-12), points(0.0, 0.1)], [None, None]);
    assert!(rod.with_natural_curvature(NaturalCurvature::points(&[[0.0, 1.0]]).unwrap()).is_err());
    // the place of a jump is told in m
    let jump = Rod::varying(LENGTH, |s| if s < 0.05 { 1.0 } else { 0.5 }, &[]).unwrap_err();
    assert!(matches!(jump, RodError::NotSmooth { s } if (s - 0.05).abs() < 1e-3), "{jump}");
    // the steepest cones there are
    for (base, tip) in [(1e-3, 1e-5), (1e-5, 1e-3)] {
        // a moment m turns the tip by m int (1 - t s)^-4 ds = m ((1 - t)^-3 - 1) / 3 t
        let (rod, taper): (_, f64) = (wire(base, tip).unwrap(), 1.0 - tip / base);
        let start = rod_core::Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 1e-6 };
        let exact = 1e-6 * ((1.0 - taper).powi(-3) - 1.0) / (3.0 * taper);
        let off = rod.carry(0.0, &start, 0.0, 0.0, 1.0).phi - exact;
        assert!(off.abs() < 1e-13 * (1.0 + exact), "{base} {tip}: {off:e} {exact}");
    }
}
