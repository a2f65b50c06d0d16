//! Whether a sensor suits a rod.

use rod_core::Rod;
use rod_hw::*;

/// The wire of Merker et al. (2020).
fn check(force: f64, torque: f64) -> SensorCheck {
    let rod = Rod::new(0.1, 6.32e-4).unwrap();
    let rated = RatedLoad::in_units([force, force, force, torque, torque, torque], WrenchUnits::SI).unwrap();
    SensorCheck::new(rod.units(), &rated, Wrench { force: [0.5; 3], torque: [0.1; 3] }).unwrap()
}

fn found(check: &SensorCheck) -> Vec<(bool, String)> {
    check.findings().map(|finding| (finding.is_misfit(), finding.to_string())).collect()
}

/// +-2 N of class 0.5 and +-50 N m of class 0.1 are what the paper states.
#[test]
fn the_papers_sensors() {
    let class = |component| {
        format!(
            "{component}: class 0.5 of +-2 N is 1.00e-2 N, 0.16 times E I / L^2 = 6.32e-2 N: systematic errors of the \
             sensor will be seen in the contour, expected below 3.2e-3 N; measured bounds of its errors, or a \
             calibration of your own, may be better than the class"
        )
    };
    let torque = "Tz: class 0.1 of +-50 N m is 5.00e-2 N m, 7.91 times E I / L = 6.32e-3 N m: this hides most of the load of \
                  the rod, expected below 3.2e-4 N m. Is +-50 mN m meant? That would be 7.9e-3 times. Otherwise \
                  take a sensor of a range of 3.2e-1 N m or less at this class";
    assert_eq!(found(&check(2.0, 50.0)), [(false, class("Fx")), (false, class("Fy")), (true, torque.to_owned())]);
    assert_eq!(found(&check(2.0, 0.05)), [(false, class("Fx")), (false, class("Fy"))]);
}

#[test]
fn a_range_that_the_rod_exceeds() {
    let expected = "Tz: the sensor is rated for 0.006 N m, 0.95 times E I / L = 6.32e-3 N m, but the rod may give 4.42e-2 \
                    N m; take a larger range or a softer rod, or state how large the reactions of your scans are";
    assert_eq!(found(&check(2.0, 6e-3)).pop(), Some((true, expected.to_owned())));
    let force = check(0.5, 0.05);
    assert!(matches!(force.findings().next(), Some(SensorFinding::Range { .. })));
    assert!(!found(&force)[0].0);
}

#[test]
fn no_milli_where_that_does_not_help() {
    // a thousandth of it still dominates; a thousandth is less than the rod gives
    for (torque, percent) in [(5000.0, 0.1), (6.0, 1.0)] {
        let rated = RatedLoad::in_units([2.0, 2.0, 2.0, torque, torque, torque], WrenchUnits::SI).unwrap();
        let percent = Wrench { force: [0.0; 3], torque: [percent; 3] };
        let check = SensorCheck::new(Rod::new(0.1, 6.32e-4).unwrap().units(), &rated, percent).unwrap();
        let (misfit, message) = found(&check).remove(0);
        assert!(misfit && !message.contains("meant?"), "{message}");
    }
}
