//! Numbers of a scene that are valid, but no rod and no scan have them: most often a wrong unit.

use super::document::{PointValue, RodTable, SceneTables, SectionTable};
use super::rod_table;
use crate::toml_file::Fault;
use std::ops::{Range, RangeInclusive};
use toml::Spanned;

/// From a single fibre to a mast, m.
const LENGTH: RangeInclusive<f64> = 1e-4..=10.0;
/// From a carbon nanotube bundle to a bar, m.
const DIAMETER: RangeInclusive<f64> = 1e-7..=0.1;
/// From the softest silicone to above diamond, Pa.
const MODULUS: RangeInclusive<f64> = 1e4..=2e12;
/// Straight path, lengths of the rod, beyond which positions are most likely in another unit than m.
const LONG_WAY: f64 = 100.0;

/// A number, its name, where it is, its plausible range and unit.
type Field = (&'static str, Option<(Range<usize>, f64)>, RangeInclusive<f64>, &'static str);

/// A warning for each number of a scene outside of its plausible range.
pub(super) fn scene(tables: &SceneTables) -> Vec<Fault> {
    let rod = tables.rod.get_ref();
    let sections = rod.section.iter().flat_map(|section| section_fields(section.get_ref()));
    let fields = rod_fields(rod).into_iter().chain(sections);
    fields.filter_map(unlikely).chain(long_way(tables)).collect()
}

fn rod_fields(table: &RodTable) -> Vec<Field> {
    let RodTable { length, tip_diameter, youngs_modulus, .. } = table;
    // the first of a list that is not plausible
    let (place, diameters) = rod_table::diameters(table).unwrap_or_default();
    let diameter = diameters.iter().find(|diameter| !DIAMETER.contains(diameter));
    vec![
        ("length", place_of(Some(length)), LENGTH, "m"),
        ("diameter", diameter.map(|diameter| (place, *diameter)), DIAMETER, "m"),
        ("tip_diameter", place_of(tip_diameter.as_ref()), DIAMETER, "m"),
        ("youngs_modulus", place_of(youngs_modulus.as_ref()), MODULUS, "Pa"),
    ]
}

fn section_fields(table: &SectionTable) -> Vec<Field> {
    let SectionTable { diameter, youngs_modulus, .. } = table;
    vec![
        ("diameter", place_of(diameter.as_ref()), DIAMETER, "m"),
        ("youngs_modulus", place_of(youngs_modulus.as_ref()), MODULUS, "Pa"),
    ]
}

fn place_of(field: Option<&Spanned<f64>>) -> Option<(Range<usize>, f64)> {
    field.map(|field| (field.span(), *field.get_ref()))
}

fn unlikely((name, field, range, unit): Field) -> Option<Fault> {
    let (span, value) = field?;
    let (least, most) = (range.start(), range.end());
    let text = format!("{name} is {value} {unit}, expected {least:e} to {most:e} {unit}; is the unit right?");
    (!range.contains(&value)).then(|| Fault::new(span, text))
}

/// A first leg that is very long beside the rod.
fn long_way(tables: &SceneTables) -> Option<Fault> {
    let (sweep, rod) = (tables.sweep.get_ref(), tables.rod.get_ref());
    let [PointValue([x0, y0]), PointValue([x1, y1])] = [sweep.from.get_ref(), sweep.to.get_ref()];
    let lengths = (x1 - x0).hypot(y1 - y0) / rod.length.get_ref();
    let text = format!("the path is {lengths:.0} lengths of the rod long; are from and to in m?");
    (lengths > LONG_WAY && lengths.is_finite()).then(|| Fault::new(sweep.to.span(), text))
}
