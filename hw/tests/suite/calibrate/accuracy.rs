//! Bounds and standard deviations of a sensor.

use proptest::prelude::*;
use rod_hw::*;

fn of(components: [f64; 6]) -> Wrench {
    Wrench::from_components(components)
}

#[test]
fn what_is_no_accuracy_is_refused() {
    let rated = RatedLoad::new(of([1.0, 1.0, f64::INFINITY, 1.0, 1.0, 1.0])).unwrap();
    let message = |percent| Accuracy::of_class(&rated, of(percent)).unwrap_err().to_string();
    assert_eq!(message([0.1; 6]), "the rated load of Fz is inf, expected a number, to take percents of");
    assert_eq!(
        message([0.1, 0.1, 0.0, 0.1, 101.0, 0.1]),
        "the class of Ty is 101, expected percent of the rated load, from 0 to 100"
    );
    let accuracy = Accuracy::of_class(&rated, of([0.1, 0.1, 0.0, 0.1, 0.1, 0.1])).unwrap();
    assert_eq!(accuracy.systematic().force[2], 0.0);
    let error = accuracy.with_sigma(of([-1.0; 6])).unwrap_err().to_string();
    assert_eq!(error, "the standard deviation of Fx is -1, expected a finite number, not negative");
}

proptest! {
    /// Twice filled is once filled, and what a sample knows of itself is not made better.
    #[test]
    fn filling_twice_is_filling_once(known in proptest::array::uniform6(0.0..2.0_f64)) {
        let accuracy = Accuracy::new(of([1.0; 6])).unwrap().with_sigma(of([1.0; 6])).unwrap();
        let sample = WrenchSample { sigma: Some(of(known)), ..WrenchSample::new(0.0, of([1.0; 6])) };
        let filled = accuracy.fill(&sample);
        prop_assert_eq!(accuracy.fill(&filled), filled);
        prop_assert_eq!(filled.sigma, Some(of(known.map(|s| s.max(1.0)))));
    }
}
