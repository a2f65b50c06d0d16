//! Gauges to a wrench by a matrix.

use proptest::prelude::*;
use rod_hw::*;
use std::array::from_fn;

const EYE: [[f64; 6]; 6] = {
    let mut rows = [[0.0; 6]; 6];
    let mut i = 0;
    while i < 6 {
        rows[i][i] = 1.0;
        i += 1;
    }
    rows
};

/// The rows of Fx, Fy, Fz, Tx, Ty, Tz.
fn of_six<const N: usize, T: Number>(
    rows: [[f64; N]; 6],
    units: WrenchUnits,
) -> Result<GaugeMatrix<N, T>, CalibrationDataError> {
    GaugeMatrix::new(&Component::ALL.map(|component| (component, rows[component.index()])), units)
}

fn message(rows: [[f64; 6]; 6]) -> String {
    of_six::<6, f64>(rows, WrenchUnits::SI).unwrap_err().to_string()
}

#[test]
fn what_is_no_matrix_is_refused() {
    let mut rows = EYE;
    rows[3][1] = f64::NAN;
    assert_eq!(message(rows), "the element of Tx and gauge 2 is NaN, expected a finite number");
    rows = EYE;
    rows[2] = [0.0; 6];
    assert!(message(rows).starts_with("the row of Fz is zero throughout; leave out"));
    rows = EYE;
    // a combination, rounded to five digits as in a file
    rows[5] = [0.33333, 0.66667, 0.0, 0.0, 1.0, 1e-5];
    let error = message(rows);
    assert!(
        error.contains("is a combination of the other rows: only a part of 8.") && error.contains("at least 1e-4"),
        "{error}"
    );
    let two = [(Component::Fx, [1.0]), (Component::Fy, [2.0])];
    let error = GaugeMatrix::<1>::new(&two, WrenchUnits::SI).unwrap_err().to_string();
    assert_eq!(error, "1 gauges for 2 components, expected at least as many gauges as components");
    let twice = [(Component::Fx, [1.0, 0.0]), (Component::Fx, [0.0, 2.0])];
    assert_eq!(
        GaugeMatrix::<2>::new(&twice, WrenchUnits::SI),
        Err(CalibrationDataError::Twice { component: Component::Fx })
    );
    assert_eq!(GaugeMatrix::<2>::new(&[], WrenchUnits::SI), Err(CalibrationDataError::Nothing));
    let large = [(Component::Fx, [1e60])];
    assert!(GaugeMatrix::<1>::new(&large, WrenchUnits::SI).is_ok());
    assert!(GaugeMatrix::<1, f32>::new(&large, WrenchUnits::SI).is_err());
}

#[test]
fn a_bias_is_checked() {
    let matrix = of_six::<6, f64>(EYE, WrenchUnits::SI).unwrap();
    assert_eq!(matrix.with_bias([f64::NAN; 6]).unwrap_err().to_string(), "a bias is NaN, expected a finite number");
}

/// Against numbers worked out by hand with the formula of the maker's library; the thermistor is the seventh channel.
#[test]
fn temperature_is_compensated() {
    let slopes = ([0.01, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
    let compensation = Compensation::new(slopes.0, slopes.1, 2.0).unwrap();
    let matrix = of_six::<6, f64>(EYE, WrenchUnits::SI).unwrap();
    let bias = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    let error = matrix.with_bias(bias).unwrap().with_compensation(compensation).unwrap_err();
    assert_eq!(error, CalibrationDataError::BiasTemperature);
    // at 2 above: (3 + 0.02) and 3 / (1 - 0.2)
    let matrix = matrix.with_compensation(compensation).unwrap();
    let raw = RawSample::new(0.0, Channels::from([3.0, 3.0, 0.0, 0.0, 0.0, 0.0, 4.0]));
    let found = matrix.wrench(&raw).unwrap().wrench.force;
    assert!((found[0] - 3.02).abs() < 1e-14 && (found[1] - 3.75).abs() < 1e-14, "{found:?}");
    let hot = RawSample::new(0.0, Channels::from([3.0, 3.0, 0.0, 0.0, 0.0, 0.0, 12.0]));
    let error = matrix.wrench(&hot).unwrap_err().to_string();
    assert!(error.starts_with("a temperature of 12 gives gauge 2 a gain of 1 / 0, expected a positive one"), "{error}");
}

fn wrench(matrix: &GaugeMatrix<7, f64>, gauges: [f64; 7]) -> Wrench {
    matrix.wrench(&RawSample::new(0.0, Channels::from(gauges))).unwrap().wrench
}

proptest! {
    #[test]
    fn it_is_linear(
        elements in proptest::collection::vec(-1.0..1.0_f64, 42),
        x in proptest::array::uniform7(-10.0..10.0_f64),
        y in proptest::array::uniform7(-10.0..10.0_f64),
        (a, b) in (-3.0..3.0_f64, -3.0..3.0_f64),
        bias in proptest::array::uniform7(-1.0..1.0_f64),
    ) {
        let rows: [[f64; 7]; 6] = from_fn(|i| from_fn(|j| elements[7 * i + j]));
        let units = WrenchUnits::parse("N", "N mm").unwrap();
        // rows at random may be too near a combination of the others: those are refused
        let Ok(matrix) = of_six::<7, f64>(rows, units) else { return Ok(()) };
        let sum = wrench(&matrix, from_fn(|i| a * x[i] + b * y[i]));
        let parts = wrench(&matrix, x) * a + wrench(&matrix, y) * b;
        for component in Component::ALL {
            let scale = units.factor(component) * 7.0 * 60.0;
            prop_assert!((component.of(&sum) - component.of(&parts)).abs() < 4.0 * f64::EPSILON * scale);
        }
        // a bias is taken off each gauge: what reads as the bias is no load
        let biased = matrix.with_bias(bias).unwrap();
        prop_assert_eq!(wrench(&biased, bias), Wrench::default());
        let shifted = wrench(&biased, from_fn(|i| x[i] + bias[i]));
        for component in Component::ALL {
            let scale = units.factor(component) * 7.0 * 11.0;
            prop_assert!((component.of(&shifted) - component.of(&wrench(&matrix, x))).abs() < 4.0 * f64::EPSILON * scale);
        }
    }

    /// An f32 calibration is the f64 one to rounding, however large the bias.
    #[test]
    fn in_single_precision(x in proptest::array::uniform6(-1.0..1.0_f64), bias in -1e6..1e6_f64) {
        let (single, double) = (of_six::<6, f32>(EYE, WrenchUnits::SI), of_six::<6, f64>(EYE, WrenchUnits::SI));
        let raw = RawSample::new(0.0, Channels::from(x.map(|v| v + bias)));
        let single = single.unwrap().with_bias([bias; 6]).unwrap().wrench(&raw).unwrap().wrench;
        let double = double.unwrap().with_bias([bias; 6]).unwrap().wrench(&raw).unwrap().wrench;
        for component in Component::ALL {
            let (a, b) = (f64::from(component.of(&single)), component.of(&double));
            prop_assert!((a - b).abs() <= 6e-8 * b.abs(), "{} {}", a, b);
        }
    }
}
