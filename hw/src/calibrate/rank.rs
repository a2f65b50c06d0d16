//! Whether the rows of a matrix tell components apart.

use crate::sample::Component;
use rod_core::Scalar;

/// The row that the others come nearest to giving, and the part of it that they do not give: the sine of the angle between
/// it and them, 0 where it is a combination of them. Rows are scaled to one length first, since N and N m do not compare.
///
/// Gram and Schmidt's method, the row that is left with most taken first, each twice against rounding.
pub(super) fn weakest<const N: usize>(rows: &[[f64; N]; 6], given: [bool; 6]) -> Option<(Component, f64)> {
    let mut left = *rows;
    let mut waiting = given;
    let mut weakest = None;
    for row in &mut left {
        scale(row);
    }
    loop {
        let norms = left.map(|row| norm(&row));
        let candidates = Component::ALL.into_iter().filter(|c| waiting[c.index()]);
        let Some(next) = candidates.max_by(|a, b| norms[a.index()].total_cmp(&norms[b.index()])) else {
            return weakest;
        };
        weakest = Some((next, norms[next.index()]));
        waiting[next.index()] = false;
        let mut direction = left[next.index()];
        scale(&mut direction);
        for row in left.iter_mut().zip(waiting).filter(|(_, waiting)| *waiting).map(|(row, _)| row) {
            for _ in 0..2 {
                let share: f64 = row.iter().zip(&direction).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(&direction).for_each(|(a, b)| *a -= share * b);
            }
        }
    }
}

fn norm<const N: usize>(row: &[f64; N]) -> f64 {
    Scalar::sqrt(row.iter().map(|a| a * a).sum::<f64>())
}

/// To length 1, by the largest element first, whose square may be out of range.
fn scale<const N: usize>(row: &mut [f64; N]) {
    let largest = row.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
    if largest > 0.0 {
        row.iter_mut().for_each(|a| *a /= largest);
        let norm = norm(row);
        row.iter_mut().for_each(|a| *a /= norm);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;
    use proptest::prelude::*;

    proptest! {
        /// Beside the singular values of the matrix of rows of length 1: the smallest is no larger than the part, and not
        /// smaller than it by more than the number of rows can make it (pivoted QR).
        #[test]
        fn as_singular_values_have_it(
            elements in proptest::collection::vec(-1.0..1.0_f64, 48),
            mix in proptest::array::uniform5(-1.0..1.0_f64),
            gap in -9.0..0.0_f64,
            size in -200.0..200.0_f64,
        ) {
            let mut rows: [[f64; 8]; 6] = core::array::from_fn(|i| core::array::from_fn(|j| elements[8 * i + j]));
            let gap = 10_f64.powf(gap);
            let others: [f64; 8] = core::array::from_fn(|j| (0..5).map(|i| mix[i] * rows[i][j]).sum());
            rows[5].iter_mut().zip(others).for_each(|(a, others)| *a = others + gap * *a);
            let mut unit = rows;
            unit.iter_mut().for_each(scale);
            let smallest = SMatrix::<f64, 6, 8>::from_fn(|i, j| unit[i][j]).singular_values().min();
            rows[2].iter_mut().for_each(|a| *a *= 10_f64.powf(size));
            let (_, part) = weakest(&rows, [true; 6]).unwrap();
            prop_assert!(smallest <= part * (1.0 + 1e-6) + 1e-14, "{smallest} {part}");
            prop_assert!(part <= 100.0 * smallest + 1e-14, "{smallest} {part}");
        }
    }

    #[test]
    fn a_repeated_row_has_no_part_of_its_own() {
        let mut rows = [[0.0; 6]; 6];
        (0..6).for_each(|i| rows[i][i] = 1.0);
        assert_eq!(weakest(&rows, [true; 6]).unwrap().1, 1.0);
        rows[4] = rows[1].map(|a| 3.0 * a);
        let (component, part) = weakest(&rows, [true; 6]).unwrap();
        assert!(matches!(component, Component::Ty | Component::Fy) && part == 0.0);
        assert_eq!(weakest(&rows, [true, true, true, true, false, true]).unwrap().1, 1.0);
        assert_eq!(weakest(&rows, [false; 6]), None);
    }
}
