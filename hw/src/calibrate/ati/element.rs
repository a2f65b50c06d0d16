//! Elements of a calibration file and their attributes: the seam to `roxmltree`.

use super::AtiFileError;
use crate::sample::{Dimension, Unit};
use roxmltree::{Document, Node, ParsingOptions};

/// The document of a text. One that declares entities is refused: a short text can have them mean any amount of memory.
pub(super) fn document(text: &str) -> Result<Document<'_>, AtiFileError> {
    if let Some(at) = text.find("<!ENTITY") {
        let line = text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1;
        return Err(AtiFileError::Malformed {
            line: u32::try_from(line).unwrap_or(u32::MAX),
            message: "an entity is declared, expected none".to_owned(),
        });
    }
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text.trim_start_matches('\u{feff}'), options)
        .map_err(|error| AtiFileError::Malformed { line: error.pos().row, message: error.to_string() })
}

/// An element.
#[derive(Clone, Copy)]
pub(super) struct Element<'a>(pub Node<'a, 'a>);

impl<'a> Element<'a> {
    pub(super) fn line(self) -> u32 {
        self.0.document().text_pos_at(self.0.range().start).row
    }

    pub(super) fn name(self) -> &'a str {
        self.0.tag_name().name()
    }

    pub(super) fn children(self, name: &'static str) -> impl Iterator<Item = Self> {
        self.0.children().filter(move |node| node.has_tag_name(name)).map(Self)
    }

    /// The only child of this name, if there is one.
    pub(super) fn child(self, name: &'static str) -> Result<Option<Self>, AtiFileError> {
        let mut found = self.children(name);
        let first = found.next();
        match found.next() {
            Some(second) => Err(AtiFileError::Element {
                line: second.line(),
                found: format!("a second `{name}`"),
                expected: "one at most",
            }),
            None => Ok(first),
        }
    }

    pub(super) fn attribute(self, name: &str) -> Option<&'a str> {
        self.0.attribute(name).map(str::trim).filter(|value| !value.is_empty())
    }

    /// A fault of an attribute.
    pub(super) fn wrong(self, attribute: &'static str, expected: impl Into<String>) -> AtiFileError {
        AtiFileError::Attribute {
            line: self.line(),
            element: self.name().to_owned(),
            attribute,
            value: self.attribute(attribute).map(str::to_owned),
            expected: expected.into(),
        }
    }

    /// A text that must be there.
    pub(super) fn text(self, attribute: &'static str) -> Result<String, AtiFileError> {
        self.attribute(attribute).map(str::to_owned).ok_or_else(|| self.wrong(attribute, "a text"))
    }

    /// A finite number, if the attribute is there.
    pub(super) fn number(self, attribute: &'static str) -> Result<Option<f64>, AtiFileError> {
        let number = |text| finite(text).ok_or_else(|| self.wrong(attribute, "a number with a decimal point"));
        self.attribute(attribute).map(number).transpose()
    }

    /// So many finite numbers, and to how many decimals the one with least is given.
    pub(super) fn numbers(self, attribute: &'static str, count: usize) -> Result<(Vec<f64>, i32), AtiFileError> {
        let text = self.attribute(attribute).unwrap_or_default();
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(finite).collect();
        let decimals = text.split_whitespace().map(decimals).min().unwrap_or(0);
        let expected = || self.wrong(attribute, format!("{count} numbers with blanks in between, as many as gauges"));
        numbers.filter(|numbers| numbers.len() == count).map(|numbers| (numbers, decimals)).ok_or_else(expected)
    }

    /// A unit of this dimension; this one where the attribute is missing.
    pub(super) fn unit(
        self,
        attribute: &'static str,
        dimension: Dimension,
        default: Option<&'static str>,
    ) -> Result<Unit, AtiFileError> {
        let text = self.attribute(attribute).or(default).unwrap_or_default();
        Unit::parse(text, dimension).map_err(|error| self.wrong(attribute, format!("a unit: {error}")))
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// How many decimals a number is given to.
fn decimals(text: &str) -> i32 {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let digits = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    i32::try_from(digits).unwrap_or(i32::MAX).saturating_sub(exponent.parse().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_of_numbers() {
        for (text, expected) in [("1", 0), ("-0.12", 2), ("1.50e-3", 5), ("2E2", -2), ("3.", 0)] {
            assert_eq!(decimals(text), expected, "{text}");
        }
    }
}
