//! Decimals of more digits than a double has.

/// A number as the sum of two doubles: the nearest one, and the rest.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    pub high: f64,
    low: f64,
}

/// Significant digits that an i128 holds in any case, and that are looked at.
const DIGITS: i32 = 36;

impl Exact {
    /// From a decimal such as "-1.25e-3".
    pub fn parse(text: &str) -> Self {
        let high: f64 = text.parse().expect("a decimal number");
        if high == 0.0 {
            return Self { high, low: 0.0 };
        }
        let decimals = DIGITS - 1 - high.abs().log10().floor() as i32;
        // a double has an end as a decimal, after a thousand digits at most
        let rest = integer(text, decimals) - integer(&format!("{high:.1100}"), decimals);
        Self { high, low: rest as f64 * 10_f64.powi(-decimals) }
    }

    /// What `ours` is off, relative to 1 + |the number|.
    pub fn error(self, ours: f64) -> f64 {
        ((ours - self.high) - self.low).abs() / (1.0 + self.high.abs())
    }
}

/// A decimal times 10^`decimals`, cut off there.
fn integer(text: &str, decimals: i32) -> i128 {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let point = whole.len() as i32 + exponent.parse::<i32>().expect("an exponent");
    let mut digits = format!("{whole}{fraction}");
    let wanted = usize::try_from(point + decimals).unwrap_or(0);
    digits.truncate(wanted);
    format!("{digits:0<wanted$}").parse().expect("digits")
}
