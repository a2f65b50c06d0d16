//! The zero-phase low-pass against SciPy.
#![cfg(feature = "std")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use rod_hw::LowPass;

/// What the command in tests/vectors/low_pass.py printed.
const VECTORS: &str = include_str!("vectors/low_pass.csv");

#[test]
fn agrees_with_scipy() {
    let cases = VECTORS.split("case,").skip(1);
    assert_eq!(cases.clone().count(), 5);
    for case in cases {
        let mut lines = case.lines();
        let header: Vec<f64> = lines.next().unwrap().split(',').map(|n| n.parse().unwrap()).collect();
        let filter = LowPass::new(header[0] as usize, header[1], header[2]).unwrap();
        let (input, expected): (Vec<f64>, Vec<f64>) = lines
            .map(|line| {
                let (input, output) = line.split_once(',').unwrap();
                (input.parse::<f64>().unwrap(), output.parse::<f64>().unwrap())
            })
            .unzip();
        let found = filter.apply(&input, &[]).unwrap();
        let worst = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("order {}, {} Hz at {} Hz: {worst:.1e}", header[0], header[1], header[2]);
        assert!(worst < 1e-11, "{header:?}: {worst}");
    }
}
