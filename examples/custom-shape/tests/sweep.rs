//! The program, run as a user runs it: it comes to the end of its path, and passes equal crests alike.

use std::f64::consts::TAU;
use std::process::Command;

/// The numbers of a table's line: position, and the reactions.
fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn the_rod_snaps_over_equal_crests_alike() {
    let output = Command::new(env!("CARGO_BIN_EXE_custom-shape")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).unwrap();
    let snaps: Vec<_> = table.lines().filter(|line| line.contains(" snap ")).map(numbers).collect();
    assert_eq!(snaps.len(), 3, "{table}");
    for pair in snaps.windows(2) {
        // The crests are a turn of the disc apart; printed are 6 decimals, and 7 of the moment.
        assert!((pair[0][0] - pair[1][0] - TAU * 0.006).abs() < 2e-6, "{table}");
        assert!(pair[0][1..].iter().zip(&pair[1][1..]).all(|(one, other)| (one - other).abs() < 2e-6), "{table}");
    }
    assert!(table.lines().last().is_some_and(|line| line.contains("snap-off")), "{table}");
}
