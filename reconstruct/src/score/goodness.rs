//! The goodness of fit of two signals.

/// The normalised mean square error as a goodness of fit, 1 - |x - r|^2 / |r - mean(r)|^2 for the signal x and the
/// reference r: 1 where they are equal, 0 where x is no better than the mean of r, without a lower bound.
///
/// This is what `goodnessOfFit(x, xref, 'NMSE')` of Matlab returned up to R2019b, hence the one of Merker et al.
/// (2020), fig. 5, who used R2019a. From R2020a on that function returns the error alone, |x - r|^2 / |r - mean(r)|^2,
/// so that there 0 is a perfect fit: one minus ours.
///
/// None without samples, for lists of different lengths, for numbers that are not finite, for a constant reference, and where the
/// result is not finite. It is the same for signals that are shifted and scaled together.
///
/// ```
/// use rod_reconstruct::score::goodness_of_fit;
/// let reference = [1.0, 2.0, 3.0];
/// assert_eq!(goodness_of_fit(&reference, &reference), Some(1.0));
/// assert_eq!(goodness_of_fit(&[2.0, 2.0, 2.0], &reference), Some(0.0));
/// assert_eq!(goodness_of_fit(&reference, &[2.0, 2.0, 2.0]), None);
/// ```
pub fn goodness_of_fit(signal: &[f64], reference: &[f64]) -> Option<f64> {
    let (first, count) = (*reference.first()?, reference.len());
    if signal.len() != count || !signal.iter().chain(reference).all(|value| value.is_finite()) {
        return None;
    }
    // In the reference's own range, so that squares neither underflow nor overflow, and a large mean does not drown it.
    let range = reference.iter().map(|value| (value - first).abs()).fold(0.0, f64::max);
    let mean = reference.iter().map(|value| (value - first) / range).sum::<f64>() / count as f64;
    let spread: f64 = reference.iter().map(|value| ((value - first) / range - mean).powi(2)).sum();
    let error: f64 = signal.iter().zip(reference).map(|(x, r)| ((x - r) / range).powi(2)).sum();
    Some(1.0 - error / spread).filter(|fit| fit.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_case_by_hand() {
        // Mean 2, spread 4 + 0 + 4, error 1 + 0 + 1.
        assert_eq!(goodness_of_fit(&[1.0, 2.0, 3.0], &[0.0, 2.0, 4.0]), Some(0.75));
        // As far off as the mean would be, and farther.
        assert_eq!(goodness_of_fit(&[2.0, 0.0], &[0.0, 2.0]), Some(-3.0));
    }

    #[test]
    fn what_cannot_be_said_is_none() {
        assert_eq!(goodness_of_fit(&[], &[]), None);
        assert_eq!(goodness_of_fit(&[1.0], &[1.0]), None, "one sample is constant");
        assert_eq!(goodness_of_fit(&[0.1; 3], &[0.1; 3]), None, "although the mean of the three is not 0.1");
        assert_eq!(goodness_of_fit(&[1.0, 2.0], &[1.0, 2.0, 3.0]), None);
        assert_eq!(goodness_of_fit(&[1.0, f64::NAN], &[1.0, 2.0]), None);
        assert_eq!(goodness_of_fit(&[1.0, 2.0], &[1.0, f64::INFINITY]), None);
        assert_eq!(goodness_of_fit(&[1e300, 2.0], &[1.0, 2.0]), None, "the square is beyond all numbers");
    }

    #[test]
    fn tiny_and_far_off_signals_are_no_worse() {
        let tiny = goodness_of_fit(&[1e-200, 2e-200, 3e-200], &[0.0, 2e-200, 4e-200]).unwrap();
        assert!((tiny - 0.75).abs() < 1e-15, "{tiny}");
        let far = goodness_of_fit(&[1e6 + 1.0, 1e6 + 2.0, 1e6 + 3.0], &[1e6, 1e6 + 2.0, 1e6 + 4.0]);
        assert_eq!(far, Some(0.75));
    }

    proptest! {
        #[test]
        fn order_and_units_do_not_matter(
            pairs in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 2..40),
            turn in 0..40_usize, scale in 1e-9..1e9_f64,
        ) {
            let fit = |pairs: &[(f64, f64)], scale: f64| {
                let (x, r): (Vec<f64>, Vec<f64>) = pairs.iter().map(|(x, r)| (scale * x, scale * r)).unzip();
                goodness_of_fit(&x, &r)
            };
            let mut turned = pairs.clone();
            turned.rotate_left(turn % pairs.len());
            let plain = fit(&pairs, 1.0).unwrap();
            prop_assert!(plain <= 1.0);
            for other in [fit(&turned, 1.0), fit(&pairs, scale), fit(&pairs, -scale)] {
                prop_assert!((other.unwrap() - plain).abs() <= 1e-9 * (1.0 + plain.abs()), "{other:?} {plain}");
            }
            let reference: Vec<f64> = pairs.iter().map(|(_, r)| *r).collect();
            prop_assert_eq!(goodness_of_fit(&reference, &reference), Some(1.0));
        }
    }
}
