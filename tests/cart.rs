//! The simulator of examples/cart.rs keeps its energy but for what the whisker loses when it slips off.

#[allow(dead_code, reason = "the program draws and prints")]
#[path = "../examples/cart.rs"]
mod example;

use example::{MASS, report, roll, scene};

#[test]
fn the_cart_bounces_or_passes_and_the_energy_is_accounted_for() {
    let (rod, post) = scene().unwrap();
    for (start, passes) in [(0.3, false), (0.6, true)] {
        let moments = roll(&rod, &post, -start).unwrap();
        let last = moments.last().unwrap();
        assert_eq!(last.speed < 0.0, passes, "{start}: {}", last.speed);
        let kinetic = |speed: f64| 0.5 * MASS * speed * speed;
        let mut lost = 0.0;
        for moment in &moments {
            lost += moment.events.iter().map(|event| event.before.energy - event.after.energy).sum::<f64>();
            let share = (kinetic(moment.speed) + moment.whisker.energy + lost) / kinetic(start);
            assert!((share - 1.0).abs() < 0.01, "{start}, {} s: {share}", moment.time);
        }
        assert_eq!(lost > 1e-3, passes, "{start}: {lost} J");
    }
}

#[test]
fn the_tutorial_shows_what_the_program_prints() {
    let page = include_str!("../docs/tutorials/simulator.md");
    let (rod, post) = scene().unwrap();
    for start in [0.3, 0.6] {
        let text = report(&roll(&rod, &post, -start).unwrap()).unwrap();
        assert!(page.contains(&format!("```text\n{text}```")), "{start}:\n{text}");
    }
}
