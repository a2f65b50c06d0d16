//! The controller of examples/follow_contour.rs does what it says.

#[allow(dead_code, reason = "the program prints what the test looks at")]
#[path = "../examples/follow_contour.rs"]
mod example;

use vibrissa::Contour;

#[test]
fn the_force_is_held_and_what_is_felt_is_the_contour() {
    let felt = example::follow(100).unwrap();
    let ceiling = example::ceiling().unwrap();
    let mut heights = Vec::new();
    for (pose, f0y, [x, y]) in &felt {
        assert!((f0y - 0.02).abs() <= 2e-5, "{pose:?}: {f0y}");
        assert!(ceiling.gap(*x, *y).abs() < 1e-9, "{pose:?}: ({x}, {y}) is off the contour");
        heights.push(*y);
    }
    let (least, most) = heights.iter().fold((f64::MAX, f64::MIN), |(least, most), y| (y.min(least), y.max(most)));
    assert!(felt.len() == 100 && most - least > 0.004, "it went over crests and troughs: {least} to {most}");
}
