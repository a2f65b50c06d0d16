//! The numbers on an axis.

use std::ops::Range;

/// Powers of ten of the largest value that are written as they are: 0.01 to 99,999. All others have a common power in the
/// name of the axis.
const PLAIN: Range<i32> = -2..5;

/// The power of ten that the numbers on an axis share, a multiple of 3.
#[derive(Clone, Copy)]
pub(super) struct AxisScale(i32);

impl AxisScale {
    /// Of an axis with this range.
    pub fn of(range: &Range<f64>) -> Self {
        let power = range.start.abs().max(range.end.abs()).log10().floor();
        match power.is_finite().then_some(power as i32) {
            Some(power) if !PLAIN.contains(&power) => Self(3 * power.div_euclid(3)),
            _ => Self(0),
        }
    }

    /// At most about so many round numbers in a range, and what to write there.
    pub fn ticks(self, range: &Range<f64>, most: usize) -> Vec<(f64, String)> {
        let least = (range.end - range.start) / most.max(1) as f64;
        if !(least.is_finite() && least > 0.0) {
            return Vec::new();
        }
        let power = 10.0_f64.powf(least.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| *step >= least);
        let step = step.unwrap_or(10.0 * power);
        let (first, last) = ((range.start / step).ceil() as i64, (range.end / step).floor() as i64);
        // as many decimals as the step has; 1e-9 is for the rounding of its logarithm
        let decimals = (f64::from(self.0) - (step.log10() + 1e-9).floor()).max(0.0) as usize;
        let text = |value: f64| format!("{:.decimals$}", value / 10.0_f64.powi(self.0)).replace('-', "\u{2212}");
        (first..=last).map(|k| k as f64 * step).map(|value| (value, text(value))).collect()
    }

    /// The name of an axis with the power: `f in N` becomes `f in mN`, `margin` becomes `margin in 10⁻³`.
    pub fn name(self, name: &str) -> String {
        let power: String = self.0.to_string().chars().map(superscript).collect();
        let Some((quantity, unit)) = name.split_once(" in ").filter(|_| self.0 != 0) else {
            return if self.0 == 0 { name.to_owned() } else { format!("{name} in 10{power}") };
        };
        // prefixes are shorter than powers, and beside a low plot there is little room
        let unit = match (unit.strip_prefix('('), prefix(self.0), prefix(self.0 / 2)) {
            (None, Some(prefix), _) if unit.starts_with('N') => format!("{prefix}{unit}"),
            (Some(squared), _, Some(prefix)) if squared.starts_with('N') && self.0 % 2 == 0 => {
                format!("({prefix}{squared}")
            }
            _ => format!("10{power} {unit}"),
        };
        format!("{quantity} in {unit}")
    }
}

/// The prefix of a unit for a power of ten.
fn prefix(power: i32) -> Option<char> {
    [(-12, 'p'), (-9, 'n'), (-6, 'µ'), (-3, 'm'), (3, 'k'), (6, 'M')]
        .into_iter()
        .find_map(|(known, prefix)| (known == power).then_some(prefix))
}

fn superscript(letter: char) -> char {
    match letter {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        other => other.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: Range<f64>, most: usize) -> Vec<String> {
        AxisScale::of(&range).ticks(&range, most).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(texts(-0.1..10.0, 6), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(texts(-55.0..61.0, 5), ["\u{2212}50", "0", "50"]);
        assert_eq!(texts(0.0..0.21, 5), ["0.00", "0.05", "0.10", "0.15", "0.20"]);
        assert!(texts(1.0..1.0, 5).is_empty());
    }

    #[test]
    fn small_and_large_numbers_share_a_power_of_ten() {
        assert_eq!(texts(-1e-7..4.1e-6, 5), ["0", "1", "2", "3", "4"]);
        assert_eq!(AxisScale::of(&(-1e-7..4.1e-6)).name("f_{0x} in N"), "f_{0x} in µN");
        assert_eq!(texts(0.0..4.1e-4, 5), ["0", "100", "200", "300", "400"]);
        assert_eq!(AxisScale::of(&(0.0..2e5)).name("margin"), "margin in 10³");
        assert_eq!(AxisScale::of(&(0.0..2e-5)).name("K in (N mm)²"), "K in (mN mm)²");
        assert_eq!(AxisScale::of(&(0.0..2e-3)).name("K in (N mm)²"), "K in 10⁻³ (N mm)²");
        assert_eq!(AxisScale::of(&(0.0..2e-3)).name("x in mm"), "x in 10⁻³ mm");
        assert_eq!(AxisScale::of(&(0.0..0.02)).name("f_{0x} in N"), "f_{0x} in N");
        assert_eq!(AxisScale::of(&(0.0..0.0)).name("K"), "K");
    }
}
