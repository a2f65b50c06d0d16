//! The fields of all tables: their quantities, and all that is missing or wrong in a table in one message.

use crate::toml_file::{Fault, Quantities, comma_in_list, meant, written_number};
use Dimension::{Angle, BendingStiffness, Curvature, Force, Length, RotationalStiffness, Stiffness, Stress, Torque};
use Kind::{Along, Any, Number, Point, Points, Share};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use vibrissa::contour::description::{FieldInfo, FieldUnit, Shape};
use vibrissa::hw::Dimension;

/// What is written in a field.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// A number with a unit.
    Number(Dimension),
    /// A number without one.
    Share,
    /// `[x, y]`.
    Point(Dimension),
    /// A list of these.
    Points(Dimension),
    /// A number, or a list of arc lengths and numbers.
    Along(Dimension),
    /// Something else, which is not looked at here.
    Any,
}

/// A field of a table.
#[derive(Clone, Copy, Debug)]
struct FieldRule {
    name: &'static str,
    kind: Kind,
    required: bool,
    positive: bool,
}

const fn optional(name: &'static str, kind: Kind) -> FieldRule {
    FieldRule { name, kind, required: false, positive: false }
}

const fn required(name: &'static str, kind: Kind) -> FieldRule {
    FieldRule { required: true, ..optional(name, kind) }
}

const fn positive(rule: FieldRule) -> FieldRule {
    FieldRule { positive: true, ..rule }
}

const ROD: &[FieldRule] = &[
    positive(required("length", Number(Length))),
    positive(optional("diameter", Along(Length))),
    positive(optional("tip_diameter", Number(Length))),
    positive(optional("youngs_modulus", Number(Stress))),
    positive(optional("bending_stiffness", Number(BendingStiffness))),
    optional("natural_curvature", Along(Curvature)),
    positive(optional("yield_stress", Number(Stress))),
    optional("section", Any),
];

const SECTION: &[FieldRule] = &[
    positive(required("length", Number(Length))),
    positive(optional("diameter", Number(Length))),
    positive(optional("youngs_modulus", Number(Stress))),
    positive(optional("bending_stiffness", Number(BendingStiffness))),
    optional("natural_curvature", Number(Curvature)),
];

const CLAMP: &[FieldRule] = &[
    positive(optional("stiffness_x", Number(Stiffness))),
    positive(optional("stiffness_y", Number(Stiffness))),
    positive(optional("stiffness_phi", Number(RotationalStiffness))),
    positive(optional("roller", Number(Length))),
];

/// Of a rod without contacts.
const CLAMP_POSE: &[FieldRule] = &[optional("place", Point(Length)), optional("angle", Number(Angle))];

const LOAD: &[FieldRule] = &[required("s", Number(Length)), required("force", Point(Force))];

const TIP: &[FieldRule] = &[
    optional("place", Point(Length)),
    optional("x", Number(Length)),
    optional("y", Number(Length)),
    optional("angle", Number(Angle)),
    optional("force", Point(Force)),
    optional("fx", Number(Force)),
    optional("fy", Number(Force)),
    optional("moment", Number(Torque)),
];

const OBJECT: &[FieldRule] = &[
    optional("position", Point(Length)),
    optional("angle", Number(Angle)),
    positive(optional("scale", Share)),
    optional("mirror", Any),
    optional("reversed", Any),
    optional("hollow", Any),
    optional("file", Any),
    optional("friction", Any),
    optional("piece", Any),
];

const SWEEP: &[FieldRule] = &[
    required("from", Point(Length)),
    optional("to", Point(Length)),
    required("angle", Number(Angle)),
    optional("angle_to", Number(Angle)),
    positive(optional("step", Number(Length))),
    positive(optional("step_angle", Number(Angle))),
    optional("leg", Any),
];

const LEG: &[FieldRule] = &[
    optional("to", Point(Length)),
    optional("angle_to", Number(Angle)),
    optional("pivot", Point(Length)),
    optional("turn", Number(Angle)),
    positive(optional("step", Number(Length))),
    positive(optional("step_angle", Number(Angle))),
];

/// A field that is missing unless one of several others is there: what is said of it.
type MissingUnless = (&'static [&'static str], &'static str);

/// `[[scan]]` and `[[path]]` of a list of scans.
const SCAN: &[FieldRule] =
    &[required("distance", Number(Length)), required("angle", Number(Angle)), optional("pass", Any)];

const SCAN_PATH: &[FieldRule] = &[
    required("from", Point(Length)),
    required("angle", Number(Angle)),
    optional("to", Point(Length)),
    optional("angle_to", Number(Angle)),
    optional("pivot", Point(Length)),
    optional("turn", Number(Angle)),
];

const STIFFNESS: &[MissingUnless] = &[
    (
        &["bending_stiffness", "diameter", "youngs_modulus", "section"],
        "missing `diameter` and `youngs_modulus`, or `bending_stiffness`",
    ),
    (&["bending_stiffness", "diameter", "section"], "missing `diameter`"),
    (&["bending_stiffness", "youngs_modulus", "section"], "missing `youngs_modulus`"),
];

const PATH: &[MissingUnless] = &[
    (&["to", "angle_to"], "missing `to`, or `angle_to` for a clamp that turns on the spot"),
    (&["step", "step_angle"], "missing `step` (m), or `step_angle` (degrees) for a clamp that turns on the spot"),
];

/// The quantities of a scene.
///
/// # Errors
/// All that is missing or wrong in the first table with several such fields, or with a wrong unit. A single missing or wrong field is left
/// to those who read it, and say more about it.
pub(super) fn scene(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    let tables = table.get_ref();
    let is_missing = |name: &&str| !tables.contains_key(*name);
    let missing: Vec<&str> = ["rod", "sweep"].into_iter().filter(is_missing).collect();
    check_list(tables, "object")?;
    let nothing = ["contour", "object"].iter().all(is_missing);
    if missing.len() + usize::from(nothing) > 1 {
        let names = missing.into_iter().map(|name| format!("[{name}]")).chain(nothing.then(|| "[[object]]".to_owned()));
        let names = names.collect::<Vec<_>>().join(", ");
        let message = format!("missing tables {names}; `vibrissa init` writes a scene with all tables");
        return Err(Fault::new(0..0, message));
    }
    let mut quantities = rod_file(table)?;
    for object in tables_of(tables, "contour").into_iter().chain(tables_of(tables, "object")) {
        check(object, OBJECT, &[], &mut quantities)?;
        for piece in object.get_ref().as_table().map(|object| tables_of(object, "piece")).unwrap_or_default() {
            let rules = piece_rules(piece);
            // a piece without a shape that is known has no fields of its own
            if rules.len() > OF_ALL_PIECES.len() {
                check(piece, &rules, &[], &mut quantities)?;
            }
        }
    }
    for sweep in tables_of(tables, "sweep") {
        check(sweep, SWEEP, PATH, &mut quantities)?;
        for leg in sweep.get_ref().as_table().map(|sweep| tables_of(sweep, "leg")).unwrap_or_default() {
            check(leg, LEG, &[], &mut quantities)?;
        }
    }
    Ok(quantities)
}

/// The quantities of the rod and the clamp of a file; the rest is not looked at.
///
/// # Errors
/// As [`scene`].
pub(super) fn rod_file(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    of_rod(table, STIFFNESS)
}

/// The same of a rod that need not have a stiffness.
///
/// # Errors
/// As [`scene`].
pub(super) fn filmed_rod(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    of_rod(table, &[])
}

/// The quantities of a rod without contacts.
///
/// # Errors
/// As [`scene`].
pub(super) fn elastica(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    let mut quantities = of_rod_alone(table, STIFFNESS)?;
    check_list(table.get_ref(), "load")?;
    for clamp in tables_of(table.get_ref(), "clamp") {
        let fields = clamp.get_ref().as_table().into_iter().flatten();
        if let Some((key, _)) = fields.into_iter().find(|(key, _)| CLAMP.iter().any(|rule| rule.name == key.get_ref()))
        {
            let message =
                format!("unknown field `{}`, expected `place` or `angle`: the clamp is rigid here", key.get_ref());
            return Err(Fault::new(key.span(), message));
        }
    }
    for (name, rules) in [("clamp", CLAMP_POSE), ("load", LOAD), ("tip", TIP)] {
        let tables = tables_of(table.get_ref(), name);
        let faults = tables.iter().filter_map(|one| check(one, rules, &[], &mut quantities).err()).collect();
        let first = tables.first().map_or(0..0, |one| one.span());
        if let Some(fault) = Fault::all(first, faults) {
            return Err(fault);
        }
    }
    Ok(quantities)
}

/// The quantities of a list of scans.
///
/// # Errors
/// All that is missing or wrong in its tables, as [`scene`].
pub(super) fn scans(table: &Spanned<DeTable<'_>>) -> Result<Quantities, Fault> {
    let (mut quantities, mut faults, mut first) = (Quantities::default(), Vec::new(), 0..0);
    let (mut count, mut is_final) = (0, false);
    for (name, rules) in [("scan", SCAN), ("path", SCAN_PATH)] {
        check_list(table.get_ref(), name)?;
        for one in tables_of(table.get_ref(), name) {
            let found = faults_of(one, rules, &[], &mut quantities);
            if faults.is_empty() {
                first = one.span();
            }
            (count, is_final) = (count + found.count, is_final || found.is_final);
            faults.extend(found.faults);
        }
    }
    // a single one is left to those who read the table, and say more about it
    if count < 2 && !is_final {
        return Ok(quantities);
    }
    Fault::all(first, faults).map_or(Ok(quantities), Err)
}

/// Refuses a single table where a list of them belongs.
fn check_list(table: &DeTable<'_>, name: &str) -> Result<(), Fault> {
    match table.get(name) {
        // of an object with pieces that is no list, more is said where it is read
        Some(value) if value.get_ref().is_table() && value.get_ref().get("piece").is_none() => {
            Err(Fault::new(value.span(), single(name)))
        }
        _ => Ok(()),
    }
}

fn single(name: &str) -> String {
    let header = match name {
        "leg" => "sweep.leg",
        "section" => "rod.section",
        "piece" => "contour.piece]] or [[object.piece",
        name => name,
    };
    format!("{name} is a table, expected a list of tables: [[{header}]] with two brackets")
}

fn of_rod(table: &Spanned<DeTable<'_>>, unless: &[MissingUnless]) -> Result<Quantities, Fault> {
    let mut quantities = of_rod_alone(table, unless)?;
    for clamp in tables_of(table.get_ref(), "clamp") {
        check(clamp, CLAMP, &[], &mut quantities)?;
    }
    Ok(quantities)
}

fn of_rod_alone(table: &Spanned<DeTable<'_>>, unless: &[MissingUnless]) -> Result<Quantities, Fault> {
    let mut quantities = Quantities::default();
    for rod in tables_of(table.get_ref(), "rod") {
        check(rod, ROD, unless, &mut quantities)?;
        for section in rod.get_ref().as_table().map(|rod| tables_of(rod, "section")).unwrap_or_default() {
            check(section, SECTION, unless, &mut quantities)?;
        }
    }
    Ok(quantities)
}

/// Tables of which there may be several.
const LISTS: [&str; 7] = ["object", "piece", "section", "leg", "load", "scan", "path"];

/// The table, or the tables of a list, of that name, if it is what it should be.
fn tables_of<'a, 'b>(table: &'a DeTable<'b>, name: &str) -> Vec<&'a Spanned<DeValue<'b>>> {
    let found = match table.get(name) {
        Some(value) if LISTS.contains(&name) => value.get_ref().as_array().into_iter().flatten().collect(),
        value => Vec::from_iter(value),
    };
    found.into_iter().filter(|value| value.get_ref().is_table()).collect()
}

/// Fields of all pieces.
const OF_ALL_PIECES: [&str; 2] = ["shape", "friction"];

/// The fields of a piece: those of its shape.
fn piece_rules(piece: &Spanned<DeValue<'_>>) -> Vec<FieldRule> {
    let name = piece.get_ref().get("shape").and_then(|name| name.get_ref().as_str());
    let shape = Shape::ALL.iter().find(|shape| Some(shape.name) == name);
    let rule = |field: &FieldInfo| {
        let kind = match (field.unit, field.kind) {
            (FieldUnit::None, _) => Any,
            (FieldUnit::Length, "[x, y]") => Point(Length),
            (FieldUnit::Length, "list of [x, y]") => Points(Length),
            (FieldUnit::Length, _) => Number(Length),
            (FieldUnit::PerLength, _) => Number(Curvature),
            (FieldUnit::Degrees, _) => Number(Angle),
        };
        FieldRule { required: field.required, ..optional(field.name, kind) }
    };
    let own = shape.into_iter().flat_map(|shape| shape.fields).map(rule);
    own.chain(OF_ALL_PIECES.map(|name| optional(name, Any))).collect()
}

/// Reads the quantities of a table. A single fault is left to those who read the table, unless it is final.
fn check(
    table: &Spanned<DeValue<'_>>,
    rules: &[FieldRule],
    unless: &[MissingUnless],
    quantities: &mut Quantities,
) -> Result<(), Fault> {
    let Found { faults, count, is_final } = faults_of(table, rules, unless, quantities);
    if count < 2 && !is_final {
        return Ok(());
    }
    Fault::all(table.span(), faults).map_or(Ok(()), Err)
}

/// What is wrong with a table.
struct Found {
    faults: Vec<Fault>,
    /// How many fields are missing or wrong: the first fault may name several that are missing.
    count: usize,
    /// Whether one of the faults is said nowhere else so well.
    is_final: bool,
}

/// Reads the quantities of a table, and finds all that is missing or wrong.
fn faults_of(
    table: &Spanned<DeValue<'_>>,
    rules: &[FieldRule],
    unless: &[MissingUnless],
    quantities: &mut Quantities,
) -> Found {
    let Some(fields) = table.get_ref().as_table() else {
        return Found { faults: Vec::new(), count: 0, is_final: false };
    };
    let mut reader = Reader { quantities, faults: Vec::new(), is_final: false };
    let names: Vec<&str> = rules.iter().map(|rule| rule.name).collect();
    let mut mistyped = Vec::new();
    for (key, value) in fields {
        let name: &str = key.get_ref();
        match rules.iter().find(|rule| rule.name == name) {
            Some(rule) => reader.field(rule, value),
            None => {
                let hint = meant(name, &names);
                let nearest = hint.as_ref().and_then(|hint| hint.split('`').nth(1));
                mistyped.extend(nearest.map(str::to_owned));
                let expected = || format!("expected one of `{}`", names.join("`, `"));
                let hint = hint.unwrap_or_else(expected);
                reader.faults.push(Fault::new(key.span(), format!("unknown field `{name}`, {hint}")));
            }
        }
    }
    let is_there = |name: &str| fields.contains_key(name) || mistyped.iter().any(|meant| meant == name);
    let missing = rules.iter().filter(|rule| rule.required && !is_there(rule.name));
    let missing: Vec<String> = missing.map(|rule| format!("`{}`", rule.name)).collect();
    let others = unless.iter().filter(|(names, _)| !names.iter().any(|name| is_there(name)));
    let others: Vec<&str> = others.map(|(_, said)| *said).take(if unless == STIFFNESS { 1 } else { 2 }).collect();
    let Reader { faults, is_final, .. } = reader;
    let count = missing.len() + others.len() + faults.len();
    let of_all = match missing.as_slice() {
        [] => None,
        [one] => Some(format!("missing field {one}")),
        several => Some(format!("missing fields {}", several.join(", "))),
    };
    let missing = of_all.into_iter().chain(others.into_iter().map(str::to_owned));
    let missing = missing.map(|message| Fault::new(table.span(), message));
    Found { faults: missing.chain(faults).collect(), count, is_final }
}

struct Reader<'a> {
    quantities: &'a mut Quantities,
    faults: Vec<Fault>,
    /// Whether one of them is said nowhere else so well.
    is_final: bool,
}

impl Reader<'_> {
    fn field(&mut self, rule: &FieldRule, value: &Spanned<DeValue<'_>>) {
        let FieldRule { name, kind, positive, .. } = *rule;
        match kind {
            Any if LISTS.contains(&name) && value.get_ref().is_table() => {
                self.is_final = true;
                self.faults.push(Fault::new(value.span(), single(name)));
            }
            Any => {}
            Share => {
                self.number(name, value, None, positive);
            }
            Number(dimension) => {
                self.number(name, value, Some(dimension), positive);
            }
            Point(dimension) => self.point(name, value, [dimension; 2]),
            Points(dimension) => match value.get_ref() {
                DeValue::Array(points) => points.iter().for_each(|point| self.point(name, point, [dimension; 2])),
                other => self.wrong(name, value.span(), other, "a list of points: [[x, y], ...]"),
            },
            Along(dimension) => match value.get_ref() {
                DeValue::Array(points) => points.iter().for_each(|point| {
                    if let DeValue::Array(numbers) = point.get_ref() {
                        for (number, dimension) in numbers.iter().zip([Length, dimension]) {
                            self.number(name, number, Some(dimension), false);
                        }
                    }
                }),
                _ => {
                    self.number(name, value, Some(dimension), positive);
                }
            },
        }
    }

    fn point(&mut self, name: &str, value: &Spanned<DeValue<'_>>, dimensions: [Dimension; 2]) {
        match value.get_ref() {
            DeValue::Array(numbers) if numbers.len() == 2 => {
                for (number, dimension) in numbers.iter().zip(dimensions) {
                    self.number(name, number, Some(dimension), false);
                }
            }
            DeValue::Array(numbers) => {
                let found = numbers.len();
                let message =
                    format!("{name} is a list of {found}, expected two numbers: [x, y]{}", comma_in_list(found));
                self.faults.push(Fault::new(value.span(), message));
            }
            other => self.wrong(name, value.span(), other, "two numbers: [x, y]"),
        }
    }

    fn number(&mut self, name: &str, value: &Spanned<DeValue<'_>>, dimension: Option<Dimension>, positive: bool) {
        let (span, value) = (value.span(), value.get_ref());
        let number = match (value, dimension) {
            (DeValue::String(text), Some(dimension)) => {
                match self.quantities.read(name, text, span.clone(), dimension) {
                    Some(Ok(number)) => Some(number),
                    Some(Err(fault)) => {
                        self.is_final = true;
                        return self.faults.push(fault);
                    }
                    None => None,
                }
            }
            _ => written_number(value),
        };
        match number {
            None => self.wrong(name, span, value, "a number"),
            Some(number) if positive && !(number > 0.0 && number.is_finite()) => {
                let message = format!("{name} is {number}, expected a positive, finite number");
                self.faults.push(Fault::new(span, message));
            }
            Some(_) => {}
        }
    }

    fn wrong(&mut self, name: &str, span: Range<usize>, value: &DeValue<'_>, expected: &str) {
        let found = match value {
            DeValue::String(text) => format!("the text \"{text}\""),
            DeValue::Array(_) => "a list".to_owned(),
            DeValue::Table(_) => "a table".to_owned(),
            DeValue::Boolean(value) => value.to_string(),
            value => written_number(value).map_or_else(|| "a date".to_owned(), |number| number.to_string()),
        };
        // the deserializer calls a date a table, and a point any list
        self.is_final |= found == "a date" || expected.starts_with("two numbers");
        self.faults.push(Fault::new(span, format!("{name} is {found}, expected {expected}")));
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::{ClampTable, LegTable, ObjectTable, RodTable, SectionTable, SweepTable};
    use super::*;
    use serde::de::DeserializeOwned;

    /// Names of the fields of a table, as the deserializer lists them where it does not know one.
    fn names<T: DeserializeOwned>() -> Vec<String> {
        let error = toml::from_str::<T>("zzz = 1").err().unwrap().message().to_owned();
        let list = error.split("expected").nth(1).unwrap();
        list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    }

    #[test]
    fn the_rules_are_those_of_the_tables_that_are_read() {
        let check = |rules: &[FieldRule], names: Vec<String>| {
            let mut sorted = names;
            sorted.sort();
            let mut own: Vec<&str> = rules.iter().map(|rule| rule.name).collect();
            own.sort_unstable();
            assert_eq!(own, sorted);
        };
        check(ROD, names::<RodTable>());
        check(SECTION, names::<SectionTable>());
        check(CLAMP, names::<ClampTable>());
        check(OBJECT, names::<ObjectTable>());
        check(SWEEP, names::<SweepTable>());
        check(LEG, names::<LegTable>());
    }
}
