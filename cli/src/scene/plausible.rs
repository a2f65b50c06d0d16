//! Numbers of a rod that are valid, but no rod has them: most often a wrong unit.

use super::document::RodTable;
use crate::toml_file::Fault;
use std::ops::RangeInclusive;
use toml::Spanned;

/// From a single fibre to a mast, m.
const LENGTH: RangeInclusive<f64> = 1e-4..=10.0;
/// From a carbon nanotube bundle to a bar, m.
const DIAMETER: RangeInclusive<f64> = 1e-7..=0.1;
/// From the softest silicone to above diamond, Pa.
const MODULUS: RangeInclusive<f64> = 1e4..=2e12;

/// A warning for each number of a rod outside of its plausible range.
pub(super) fn rod(table: &RodTable) -> Vec<Fault> {
    let RodTable { length, diameter, tip_diameter, youngs_modulus, .. } = table;
    let fields = [
        ("length", Some(length), LENGTH, "m"),
        ("diameter", diameter.as_ref(), DIAMETER, "m"),
        ("tip_diameter", tip_diameter.as_ref(), DIAMETER, "m"),
        ("youngs_modulus", youngs_modulus.as_ref(), MODULUS, "Pa"),
    ];
    let check = |(name, field, range, unit): (&str, Option<&Spanned<f64>>, RangeInclusive<f64>, &str)| {
        let (span, value) = field.map(|field| (field.span(), *field.get_ref()))?;
        let (least, most) = (range.start(), range.end());
        let text = format!("{name} is {value} {unit}, expected {least:e} to {most:e} {unit}; is the unit right?");
        (!range.contains(&value)).then(|| Fault::new(span, text))
    };
    fields.into_iter().filter_map(check).collect()
}
