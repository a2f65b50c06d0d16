//! The example of the guide to fits, run with other noise and from other guesses.

#[path = "../examples/fit.rs"]
mod example;

use example::{fit, recording};

/// Largest number of solves, of which by differences there were 735 to 910: 35 times 1 + 5 for each of 4 or 5 iterations.
const MOST_SOLVES: usize = 210;

#[test]
fn parameters_come_out_within_their_standard_deviations() {
    let truth = [0.002, 0.001, 50.0, 6.3e-4];
    let (mut most, mut scores, mut chis) = (0, Vec::new(), 0.0);
    let guesses = [[-0.001, 0.0, 40.0, 5e-4], [0.004, 0.002, 60.0, 8e-4], [0.002, 0.003, 45.0, 7e-4]];
    for seed in 1..=20 {
        for guess in guesses {
            let found =
                fit(recording(truth, seed).unwrap(), guess).unwrap_or_else(|error| panic!("{seed} {guess:?}: {error}"));
            most = most.max(found.solves);
            assert!(found.solves <= MOST_SOLVES, "{seed} {guess:?}: {found:?}");
            let off = |k: usize| (found.parameters[k] - truth[k]) / found.sigmas[k];
            scores.extend((0..4).map(off));
            chis += found.chi_squared.0 / found.chi_squared.1 as f64;
        }
    }
    let count = scores.len() as f64;
    let deviation = (scores.iter().map(|score| score * score).sum::<f64>() / count).sqrt();
    let largest = scores.iter().fold(0.0, |most: f64, score| most.max(score.abs()));
    let chi = chis * 4.0 / count;
    println!(
        "most solves {most}, largest error {largest:.2} sigma, deviation {deviation:.2} sigma, chi squared {chi:.3} a degree"
    );
    assert!(largest < 4.0 && (0.7..1.3).contains(&deviation) && (0.9..1.1).contains(&chi));
}

#[test]
fn the_example_runs() {
    example::main().unwrap();
}
