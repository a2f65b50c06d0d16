//! Rods on which sweeps went wrong: joints that mean nothing, cones with a very thin tip, sections of very different stiffness.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use vibrissa::contact::Outcome;
use vibrissa::rod::{ElasticClamp, Mounted, NaturalCurvature, PhysicalRod, RodSection, VaryingRod};
use vibrissa::{CircularArc, ClampPath, Composite, Pose, Rod, Sweep};

fn disc(x: f64, y: f64, radius: f64) -> Composite {
    Composite::single(CircularArc::new([x, y], radius, 0.0, TAU).unwrap()).unwrap()
}

fn upright(x: f64, y: f64) -> Pose {
    Pose { x, y, phi: FRAC_PI_2 }
}

fn swept(rod: &impl PhysicalRod, object: &Composite, path: ClampPath, step: f64) -> Outcome {
    Sweep::new(rod, object, path, step).unwrap().run()
}

fn same_events(one: &Outcome, other: &Outcome) {
    assert_eq!(one.stop, None);
    assert_eq!(other.stop, None);
    assert_eq!(one.events.len(), other.events.len());
    for (one, other) in one.events.iter().zip(&other.events) {
        assert_eq!((one.kind, one.from(), one.to()), (other.kind, other.from(), other.to()));
        assert!((one.pose().x - other.pose().x).abs() < 1e-9, "{:?} {:?}", one.pose(), other.pose());
    }
}

/// A joint between two parts of one wire, which the contact would come to behind the fold.
#[test]
fn a_fold_comes_before_a_joint() {
    let section = |length, bending_stiffness| RodSection { length, bending_stiffness, natural_curvature: 0.0 };
    let whole = Rod::sections(1.0, &[section(0.6, 1.0), section(0.4, 0.1)]).unwrap();
    let path = ClampPath::new(upright(-0.2, 0.0), upright(0.9, 0.0)).unwrap();
    let peg = disc(0.1, 0.5, 0.03);
    let expected = swept(&whole, &peg, path, 0.05);
    for joint in [0.757, 0.765, 0.78] {
        let parts = [section(0.6, 1.0), section(joint - 0.6, 0.1), section(1.0 - joint, 0.1)];
        same_events(&swept(&Rod::sections(1.0, &parts).unwrap(), &peg, path, 0.05), &expected);
    }
    let last = expected.events.last().unwrap();
    assert!((last.pose().x - 0.58500113).abs() < 1e-8, "{:?}", last.pose());
}

/// Points of a natural curvature that is 0 everywhere.
#[test]
fn a_straight_rod_stays_one() {
    let points = NaturalCurvature::points(&[[0.0, 0.0], [0.37, 0.0], [1.0, 0.0]]).unwrap();
    let rod = Rod::new(1.0, 1.0).unwrap();
    let bent = rod.with_natural_curvature(points).unwrap();
    let object = disc(0.5126979454876581, 0.3131792805728448, 0.22833430242070812);
    let (from, to) = (357.7487419839139_f64.to_radians(), 402.5779443689556_f64.to_radians());
    let to = Pose { x: 0.30762838053234765, y: 0.726735118108173, phi: to };
    let path = ClampPath::new(Pose { x: 0.0, y: 0.0, phi: from }, to).unwrap();
    same_events(&swept(&bent, &object, path, 0.05), &swept(&rod, &object, path, 0.05));
}

fn cone(length: f64, tip: f64) -> VaryingRod {
    let base = 0.01 * length;
    Rod::tapered(length, base, tip * base, 64.0 / (PI * 1e-8)).unwrap()
}

/// A rod that just touches is stable, however thin its tip is.
#[test]
fn a_thin_tip_comes_into_contact() {
    let peg = disc(0.100_000_000_000_000_02, 1.0113689561192184, 0.03);
    for tip in [0.0101, 0.02, 0.03, 0.05] {
        let path = ClampPath::new(upright(-0.02, 0.0), upright(0.12, 0.0)).unwrap();
        let outcome = swept(&cone(1.0, tip), &peg, path, 2e-3);
        assert_eq!(outcome.stop, None, "{tip}");
        let first = &outcome.events[0];
        assert_eq!(
            (first.to().to_string().as_str(), first.before.pose, first.after.pose),
            ("A", first.pose(), first.pose())
        );
    }
    // the tip lies down soon after
    let path = ClampPath::new(upright(-0.02, 0.0), upright(0.12, 0.0)).unwrap();
    let outcome = swept(&cone(1.0, 0.03), &disc(0.1, 1.01, 0.03), path, 2e-3);
    let phases: Vec<_> = outcome.events.iter().map(|event| event.to().to_string()).collect();
    assert_eq!(phases, ["A", "B"]);
    assert_eq!(outcome.states.len(), 71, "a state at every pose");
}

/// Pressed end-on by a spring the straight cone is stable until it buckles.
#[test]
fn a_thin_column_stands() {
    let spring = ElasticClamp::springs(None, Some(0.8), None).unwrap();
    let wall = Composite::polygon(&[[-3.0, 1.0], [3.0, 1.0], [3.0, 2.0], [-3.0, 2.0]]).unwrap();
    let path = ClampPath::new(upright(0.0, -0.01), upright(0.0, 0.003)).unwrap();
    let outcome = swept(&Mounted::new(cone(1.0, 0.02), spring), &wall, path, 3e-4);
    assert_eq!(outcome.stop, None);
    let pressed = outcome.states.last().unwrap();
    assert!(pressed.phase().to_string() == "A" && (pressed.contacts[0].force - 0.8 * 0.003).abs() < 1e-9);
}

/// Sections may differ as the ends of a cone may.
#[test]
fn sections_are_of_comparable_stiffness() {
    let section = |bending_stiffness| RodSection { length: 0.5, bending_stiffness, natural_curvature: 0.0 };
    assert!(Rod::sections(1.0, &[section(1.0), section(1e-8)]).is_ok());
    for wrong in [1e-9, 1e9, 1e-295] {
        let message = Rod::sections(1.0, &[section(1.0), section(wrong)]).unwrap_err().to_string();
        assert!(message.contains("expected between 1e-8 and 1e8 times that of the first section"), "{message}");
    }
}

/// Points that end elsewhere than the rod, as fractions or in mm would, are told.
#[test]
fn points_of_a_curvature_go_from_clamp_to_tip() {
    for (points, number) in [
        ([[0.0, 2.0], [1.0, 12.0]], 2),
        ([[-0.01, 2.0], [0.02, 12.0]], 1),
        ([[0.0, 2.0], [0.02, 12.0]], 2),
        ([[0.01, 2.0], [0.03, 12.0]], 1),
    ] {
        let points = NaturalCurvature::points(&points).unwrap();
        let message = Rod::new(0.03, 1e-6).unwrap().with_natural_curvature(points).unwrap_err().to_string();
        assert!(message.starts_with(&format!("point {number} of natural_curvature has the arc length")), "{message}");
    }
}
