//! Quantities with a unit: `"40 mm"` in place of 0.04, `"90 deg"` in place of 90.

use super::error::Fault;
use std::ops::Range;
use toml::de::{DeTable, DeValue};
use vibrissa::hw::{Dimension, Unit};

/// Units of mass. Devices and their calibrations name the force so, too; in a file of a user it is a mistake.
const MASSES: [&str; 6] = ["kg", "g", "mg", "t", "lb", "lbs"];

/// Values of a file that are texts with a unit: where they stand, and the numbers that take their places, as TOML writes them.
#[derive(Debug, Default)]
pub(crate) struct Quantities(Vec<(Range<usize>, String)>);

impl Quantities {
    /// The number that stands for the text of a field, in SI units, angles in degrees; none for a text that is no number with a unit.
    ///
    /// # Errors
    /// For the unit of another dimension, or one that is not known: the message names the field, the unit and those expected.
    pub fn read(
        &mut self,
        name: &str,
        text: &str,
        span: Range<usize>,
        dimension: Dimension,
    ) -> Option<Result<f64, Fault>> {
        let (number, unit) = split(text)?;
        if unit.starts_with(',') {
            if !unit.contains(char::is_alphabetic) {
                return None;
            }
            let message = format!("{name} is \"{text}\", expected a decimal point: \"{}\"", text.replace(',', "."));
            return Some(Err(Fault::new(span, message)));
        }
        if MASSES.contains(&unit) {
            let weight = if dimension == Dimension::Force { "; the weight of 1 kg is 1 kgf" } else { "" };
            let expected = format!("expected one of {dimension}: {}{weight}", dimension.units());
            let message = format!("{name} is \"{text}\": `{unit}` is a unit of mass, {expected}");
            return Some(Err(Fault::new(span, message)));
        }
        Some(match Unit::parse(unit, dimension) {
            Ok(unit) => {
                let number = in_file(number, &unit);
                self.0.push((span, format!("{number:?}")));
                Ok(number)
            }
            Err(error) => Err(Fault::new(span, format!("{name} is \"{text}\": {error}"))),
        })
    }

    /// Puts the numbers into the tree.
    pub fn put<'a>(&'a self, table: &mut DeTable<'a>) {
        if !self.0.is_empty() {
            table.iter_mut().for_each(|(_, value)| self.put_value(value));
        }
    }

    fn put_value<'a>(&'a self, value: &mut toml::Spanned<DeValue<'a>>) {
        let span = value.span();
        match value.get_mut() {
            DeValue::Table(table) => table.iter_mut().for_each(|(_, value)| self.put_value(value)),
            DeValue::Array(values) => values.iter_mut().for_each(|value| self.put_value(value)),
            DeValue::String(_) => {
                let number = self.0.iter().find(|(place, _)| *place == span);
                if let Some(Ok(number)) = number.map(|(_, number)| DeValue::parse(number)) {
                    *value.get_mut() = number.into_inner();
                }
            }
            _ => {}
        }
    }
}

/// The number and the unit of a text.
pub(super) fn split(text: &str) -> Option<(&str, &str)> {
    let text = text.trim();
    let is_part = |letter: char| letter.is_ascii_digit() || matches!(letter, '+' | '-' | '.' | 'e' | 'E');
    let mut end = text.find(|letter| !is_part(letter)).unwrap_or(text.len());
    // the `e` of a unit is not that of an exponent
    while end > 0 && text[..end].parse::<f64>().is_err() {
        end -= 1;
    }
    let unit = text[end..].trim();
    (end > 0 && !unit.is_empty()).then_some((&text[..end], unit))
}

/// The number in the unit of the file: SI, and degrees for an angle.
fn in_file(number: &str, unit: &Unit) -> f64 {
    let value = number.parse().unwrap_or(f64::NAN);
    if unit.dimension == Dimension::Angle {
        return if unit.name == "deg" { value } else { (value * unit.factor).to_degrees() };
    }
    let power = unit.factor.log10().round() as i32;
    if (unit.factor / 10_f64.powi(power) - 1.0).abs() > 1e-12 {
        return value * unit.factor;
    }
    // 35 mm is 35e-3 m to the last digit, which 35 times 1e-3 is not
    let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let shifted = exponent.parse::<i32>().ok().and_then(|exponent| exponent.checked_add(power));
    shifted.and_then(|exponent| format!("{digits}e{exponent}").parse().ok()).unwrap_or(value * unit.factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, dimension: Dimension) -> Option<Result<f64, String>> {
        let mut quantities = Quantities::default();
        let read = quantities.read("length", text, 0..1, dimension)?;
        Some(read.map_err(|fault| fault.message().to_owned()))
    }

    #[test]
    fn a_number_with_a_unit_is_the_number_to_the_last_digit() {
        use Dimension::{Angle, BendingStiffness, Curvature, Force, Length, Stress, Torque};
        for (text, dimension, expected) in [
            ("35 mm", Length, 0.035),
            ("0.3mm", Length, 0.3e-3),
            (" 1.5e2 um ", Length, 150e-6),
            ("-4 cm", Length, -0.04),
            ("0.1 m", Length, 0.1),
            ("206 GPa", Stress, 206e9),
            ("206e3 N/mm^2", Stress, 206e9),
            ("90 deg", Angle, 90.0),
            ("90°", Angle, 90.0),
            ("20 1/m", Curvature, 20.0),
            ("2.5 mN", Force, 2.5e-3),
            ("60 uN m", Torque, 60e-6),
            ("632 N mm^2", BendingStiffness, 632e-6),
        ] {
            assert_eq!(read(text, dimension), Some(Ok(expected)), "{text}");
        }
        let Some(Ok(degrees)) = read("1.5707963267948966 rad", Angle) else { panic!() };
        assert!((degrees - 90.0).abs() < 1e-13);
        let Some(Ok(inches)) = read("2 in", Length) else { panic!() };
        assert!((inches - 0.0508).abs() < 1e-16);
        for text in ["", "long", "0.1", "0,1", "mm", "e3 mm", "-"] {
            assert_eq!(read(text, Length), None, "{text}");
        }
    }

    #[test]
    fn a_wrong_unit_is_named_with_those_expected() {
        let message = |text: &str| read(text, Dimension::Length).unwrap().unwrap_err();
        assert_eq!(
            message("40 mN"),
            "length is \"40 mN\": `mN` is a unit of force, expected one of length: m, mm, um, cm, in, ft"
        );
        let unknown = "length is \"40 furlongs\": `furlongs` is not a known unit, expected one of length: m, mm";
        assert!(message("40 furlongs").starts_with(unknown));
        let mass = "length is \"40 kg\": `kg` is a unit of mass, expected one of length: m, mm, um, cm, in, ft";
        assert_eq!(message("40 kg"), mass);
        let force = read("3 kg", Dimension::Force).unwrap().unwrap_err();
        assert!(
            force.contains("`kg` is a unit of mass, expected one of force: N, mN") && force.ends_with("1 kgf"),
            "{force}"
        );
        assert!(
            message("100 mm^1").contains("`mm^1` is not a known unit")
                && message("100 m m").contains("`m m` is not a known unit")
        );
        assert_eq!(message("0,5 mm"), "length is \"0,5 mm\", expected a decimal point: \"0.5 mm\"");
    }
}
