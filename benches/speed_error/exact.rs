//! Numbers known to more digits than a double has.

use serde::Deserialize;

/// Decimal places kept: numbers below 10^4 then fit into 128 bits.
const PLACES: usize = 34;

/// The sum of two doubles, the second of which is what rounding left of the first: 32 digits.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(try_from = "String")]
pub struct Exact {
    pub hi: f64,
    pub lo: f64,
}

impl Exact {
    /// The error of `value`, relative to 1 + |truth|. The difference of nearby doubles is exact, so that no digit is lost.
    pub fn error(&self, value: f64) -> f64 {
        ((value - self.hi) - self.lo).abs() / (1.0 + self.hi.abs())
    }

    /// The exact number `whole + tau * rate` for doubles `whole` and `rate`.
    pub fn along(self, whole: f64, rate: f64) -> Self {
        let product = self.hi * rate;
        let rest = self.hi.mul_add(rate, -product) + self.lo * rate;
        let hi = whole + product;
        let lost = if whole.abs() > product.abs() { (whole - hi) + product } else { (product - hi) + whole };
        Self { hi, lo: lost + rest }
    }
}

impl TryFrom<String> for Exact {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let wrong = |what: &str| format!("{text:?} {what}");
        let hi: f64 = text.parse().map_err(|_| wrong("is no number"))?;
        let digits = fixed(&text).ok_or_else(|| wrong("is too long or too large"))?;
        // of a double all decimal digits can be written out
        let rounded = fixed(&format!("{hi:.80}")).ok_or_else(|| wrong("is too large"))?;
        Ok(Self { hi, lo: (digits - rounded) as f64 * 1e-34 })
    }
}

/// A decimal number in units of 10^-34, what is beyond cut off.
fn fixed(text: &str) -> Option<i128> {
    let (negative, text) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let point = whole.len() as i32 + exponent.parse::<i32>().ok()?;
    let digits = whole.chars().chain(part.chars()).chain(std::iter::repeat('0'));
    let kept = usize::try_from(point + PLACES as i32).unwrap_or(0);
    let magnitude = digits.take(kept).try_fold(0_i128, |sum, digit| {
        let digit = i128::from(digit.to_digit(10)?);
        sum.checked_mul(10)?.checked_add(digit)
    })?;
    Some(if negative { -magnitude } else { magnitude })
}

/// Fails where digits are lost on the way.
pub fn check() {
    let exact = |text: &str| Exact::try_from(text.to_owned()).unwrap();
    let third = exact("0.33333333333333333333333333333333");
    assert!(
        (third.hi + 2.0 * third.hi - 1.0).abs() < 1e-15
            && (third.error(third.hi) * 4.0 / 3.0 - 1.850371707e-17).abs() < 1e-25
    );
    assert_eq!(exact("-1.25e-1"), Exact { hi: -0.125, lo: 0.0 });
    // 1e-20 is seen beside 1, and what is exact has no error
    assert!((exact("1.00000000000000000001").error(1.0) - 5e-21).abs() < 1e-33);
    assert_eq!(exact("3").along(1.0, -0.5).error(-0.5), 0.0);
}
