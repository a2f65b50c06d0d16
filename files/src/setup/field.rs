//! Fields of a setup that several tables have: components, units, positive numbers.

use super::document::SensorTable;
use crate::toml_file::Fault;
use std::ops::Range;
use toml::Spanned;
use vibrissa::hw::{Component, Dimension, Unit};

pub(super) fn component(name: &str, place: Range<usize>, expected: &str) -> Result<Component, Fault> {
    let fault = || Fault::new(place, format!("`{name}` is no component, expected {expected}"));
    Component::parse(name).ok_or_else(fault)
}

/// Both units, or none where one is not given.
pub(super) fn units(table: &SensorTable) -> Result<Option<[Unit; 2]>, Fault> {
    let unit = |text: &Spanned<String>, dimension| {
        Unit::parse(text.get_ref(), dimension).map_err(|error| Fault::new(text.span(), error.to_string()))
    };
    let (Some(force), Some(torque)) = (&table.force_unit, &table.torque_unit) else { return Ok(None) };
    Ok(Some([unit(force, Dimension::Force)?, unit(torque, Dimension::Torque)?]))
}

pub(super) fn positive(what: &str, value: &Spanned<f64>, unit: &str) -> Result<f64, Fault> {
    let number = *value.get_ref();
    if number.is_finite() && number > 0.0 {
        Ok(number)
    } else {
        Err(Fault::new(value.span(), format!("{what} is {number}, expected a positive, finite number of {unit}")))
    }
}
