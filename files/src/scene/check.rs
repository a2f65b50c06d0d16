//! From a document to a scene: every number checked where it stands.

use super::document::{PointValue, RodTable, SceneDocument, SectionTable, SweepTable};
use super::numbers::{check_step_count, not, too_large};
use super::{Scene, friction, leg, object, rod_table};
use crate::toml_file::{Fault, SourceText};
use serde_json::Value;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use toml::{Spanned, Table};
use vibrissa::contact::ContactError;
use vibrissa::{ClampPath, Pose};

/// Least radius of an arc, lengths of the rod: rounding leaves nothing of a smaller one.
const LEAST_RADIUS: f64 = 1e-12;

/// Files that the objects name are looked for in `directory`. What is wrong may come from a number that is not plausible: the message then names
/// that one first.
pub(super) fn scene(
    name: String,
    source: SourceText,
    document: SceneDocument,
    tables: Table,
    directory: &Path,
) -> Result<Scene, Fault> {
    let unlikely = implausible(&document);
    let first = unlikely.first().cloned();
    let in_words = source.clone();
    scene_of_document(name, source, document, tables, directory, unlikely).map_err(|fault| match first {
        Some(first) if first.fault.span() == fault.span() => fault.and(&first.hint),
        Some(first) if !first.is_first => {
            let said = in_words.place(first.warning()).without_place();
            fault.and(&format!("; besides, {said}"))
        }
        Some(first) => {
            let said = in_words.place(fault).without_place();
            first.warning().and(&format!("; besides, {said}"))
        }
        None => fault,
    })
}

fn scene_of_document(
    name: String,
    source: SourceText,
    document: SceneDocument,
    read: Table,
    directory: &Path,
    unlikely: Vec<Unlikely>,
) -> Result<Scene, Fault> {
    let files = std::iter::once(source.file().to_path_buf()).chain(named_files(&document, directory)).collect();
    let SceneDocument { tables, contour, objects: pieces } = document;
    let rod = rod_table::rod(&tables.rod, tables.clamp.as_ref())?;
    let objects = object::all(&tables, &contour, &pieces, directory)?;
    let least = LEAST_RADIUS * rod.length();
    if let Some(fault) = contour.iter().chain(pieces.iter().flatten()).find_map(|piece| piece.too_thin(least)) {
        return Err(fault);
    }
    let path = path(&tables.sweep)?;
    let step = step(&tables.sweep, &path)?;
    let legs = leg::all(tables.sweep.get_ref(), path.at(path.length()), rod.length())?;
    let (friction, large) = friction::friction(&tables, &contour, &pieces, &objects)?;
    let warnings =
        unlikely.iter().map(Unlikely::warning).chain(large).map(|fault| source.place(fault).to_string()).collect();
    let roller = tables.clamp.as_ref().and_then(|clamp| clamp.get_ref().roller.as_ref());
    if let Some(roller) = roller.filter(|_| friction.is_some()) {
        return Err(Fault::new(roller.span(), "a roller ahead of the clamp beside friction, expected one of the two"));
    }
    Ok(Scene { name, rod, objects, path, step, legs, friction, warnings, files, tables: read, source })
}

fn path(sweep: &Spanned<SweepTable>) -> Result<ClampPath, Fault> {
    let SweepTable { from, to, angle, angle_to, .. } = sweep.get_ref();
    if to.is_none() && angle_to.is_none() {
        let message = "missing field `to`, expected it, or angle_to for a clamp that turns on the spot";
        return Err(Fault::new(sweep.span(), message));
    }
    // where the path ends: of a clamp that only turns, its last angle says it
    let end = to.as_ref().map(Spanned::span).or(angle_to.as_ref().map(Spanned::span)).unwrap_or(from.span());
    let (to, angle_to) = (to.as_ref().unwrap_or(from), angle_to.as_ref().unwrap_or(angle));
    let pose = |point: &Spanned<PointValue>, angle: &Spanned<f64>| {
        let [x, y] = point.get_ref().0;
        Pose { x, y, phi: angle.get_ref().to_radians() }
    };
    ClampPath::new(pose(from, angle), pose(to, angle_to)).map_err(|error| {
        let (span, message) = match &error {
            ContactError::NotFinite { what: "from.phi", .. } => (angle.span(), not("angle", *angle.get_ref())),
            ContactError::NotFinite { what: "to.phi", .. } => (angle_to.span(), not("angle_to", *angle_to.get_ref())),
            ContactError::Angle { what: "from.phi", .. } => (angle.span(), too_large("angle", *angle.get_ref())),
            ContactError::Angle { .. } => (angle_to.span(), too_large("angle_to", *angle_to.get_ref())),
            ContactError::NotFinite { what, .. } if what.starts_with("from") => (from.span(), error.to_string()),
            ContactError::NoPath { .. } => {
                let message = "the path ends where it starts, expected two different positions, or angle_to for a clamp that turns";
                (end, message.to_owned())
            }
            _ => (end, error.to_string()),
        };
        Fault::new(span, message)
    })
}

/// The step in the unit of the path's parameter.
fn step(table: &Spanned<SweepTable>, path: &ClampPath) -> Result<f64, Fault> {
    let SweepTable { step, step_angle, leg, .. } = table.get_ref();
    // with legs, one of them may be meant for these
    let (step, step_angle) = match (leg.is_empty(), path.turns_only(), step, step_angle) {
        (false, true, _, angle @ Some(_)) => (&None, angle),
        (false, false, step @ Some(_), _) => (step, &None),
        (.., step, angle) => (step, angle),
    };
    let missing =
        |what: &str| Fault::new(table.span(), format!("missing field {what}, the distance between reported states"));
    match (path.turns_only(), step, step_angle) {
        (false, Some(step), None) => check_step_count(step.span(), "step", *step.get_ref(), path.length()),
        (true, None, Some(step)) => {
            let angle = *step.get_ref();
            check_step_count(step.span(), "step_angle", angle, path.length().to_degrees()).map(f64::to_radians)
        }
        (true, Some(step), _) => {
            let (span, step) = (step.span(), step.get_ref());
            let message =
                format!("step is {step}, but the clamp turns without moving, expected step_angle in degrees instead");
            Err(Fault::new(span, message))
        }
        (false, _, Some(step)) => {
            let (span, step) = (step.span(), step.get_ref());
            Err(Fault::new(span, format!("step_angle is {step}, but the clamp moves, expected only step in m")))
        }
        (false, None, None) => Err(missing("`step` (m)")),
        (true, None, None) => Err(missing("`step_angle` (degrees)")),
    }
}

/// Files of points, drawings and shapes, and those that a file of shapes names in turn. Relative ones are looked for in the
/// directory of the file that names them.
fn named_files(document: &SceneDocument, directory: &Path) -> Vec<PathBuf> {
    let SceneDocument { tables, contour, objects } = document;
    let pieces = contour.iter().chain(objects.iter().flatten()).filter_map(|piece| piece.file());
    let mut files: Vec<PathBuf> = pieces.map(|file| directory.join(file)).collect();
    let tables = tables.contour.iter().chain(&tables.object);
    for file in tables.filter_map(|table| table.get_ref().file.as_ref()).map(|file| directory.join(file.get_ref())) {
        let shapes = std::fs::read(&file).ok().and_then(|text| serde_json::from_slice::<Value>(&text).ok());
        let beside = file.parent().unwrap_or(directory).to_path_buf();
        if let Some(shapes) = shapes {
            in_shapes(&shapes, &beside, &mut files);
        }
        files.push(file);
    }
    files
}

fn in_shapes(value: &Value, directory: &Path, files: &mut Vec<PathBuf>) {
    match value {
        Value::Object(fields) => {
            files.extend(fields.get("file").and_then(Value::as_str).map(|file| directory.join(file)));
            fields.values().for_each(|value| in_shapes(value, directory, files));
        }
        Value::Array(values) => values.iter().for_each(|value| in_shapes(value, directory, files)),
        _ => {}
    }
}

/// From a single fibre to a mast, m.
const LENGTH: RangeInclusive<f64> = 1e-4..=10.0;
/// From a carbon nanotube bundle to a bar, m.
const DIAMETER: RangeInclusive<f64> = 1e-7..=0.1;
/// From the softest silicone to above diamond, Pa.
const MODULUS: RangeInclusive<f64> = 1e4..=2e12;
/// Distance, lengths of the rod, beyond which positions are most likely in another unit than m.
const LONG_WAY: f64 = 100.0;

/// A number that is most likely in another unit.
#[derive(Clone)]
struct Unlikely {
    fault: Fault,
    /// The end of the message: the unit that is most likely meant.
    hint: String,
    /// Whether it is the likeliest reason for an error elsewhere: the rod and the path, not the objects.
    is_first: bool,
}

impl Unlikely {
    fn warning(&self) -> Fault {
        self.fault.clone().and(&self.hint)
    }
}

/// A number, its name, where it is, its plausible range and unit.
type Field = (&'static str, Option<(Range<usize>, f64)>, RangeInclusive<f64>, &'static str);

/// A warning for each number of a scene outside of its plausible range, and for positions far away.
fn implausible(document: &SceneDocument) -> Vec<Unlikely> {
    let rod = document.tables.rod.get_ref();
    let sections = rod.section.iter().flat_map(|section| section_fields(section.get_ref()));
    let fields = rod_fields(rod).into_iter().chain(sections);
    let mut found: Vec<Unlikely> = fields.filter_map(unlikely).collect();
    // the unit of the rod is the likelier mistake
    if found.iter().all(|one| one.fault.span() != rod.length.span()) {
        found.extend(far_away(document));
    }
    found
}

fn rod_fields(table: &RodTable) -> Vec<Field> {
    let RodTable { length, tip_diameter, youngs_modulus, .. } = table;
    let most = DIAMETER.end().min(*length.get_ref());
    let diameters_below = if most > *DIAMETER.start() { *DIAMETER.start()..=most } else { DIAMETER };
    // the first of a list that is not plausible
    let (place, diameters) = rod_table::diameters(table).unwrap_or_default();
    let diameter = diameters.iter().find(|diameter| !diameters_below.contains(diameter));
    vec![
        ("length", place_of(Some(length)), LENGTH, "m"),
        ("diameter", diameter.map(|diameter| (place, *diameter)), diameters_below, "m"),
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

/// Units in which lengths and moduli are often written, in the order in which they are tried, and how many make one of SI.
const OTHER_UNITS: [(&str, &str, f64); 4] =
    [("m", "mm", 1e3), ("m", "um", 1e6), ("Pa", "GPa", 1e-9), ("Pa", "MPa", 1e-6)];

fn unlikely((name, field, range, unit): Field) -> Option<Unlikely> {
    let (span, value) = field?;
    let (least, most) = (range.start(), range.end());
    let text = format!("{name} is {value} {unit}, expected {least:e} to {most:e} {unit}");
    let meant = OTHER_UNITS.iter().find(|(si, _, count)| *si == unit && range.contains(&(value / count)));
    let hint = match meant {
        Some((_, other, count)) => {
            let number = value / count;
            let number = if (1e-3..1e5).contains(&number) { number.to_string() } else { format!("{number:e}") };
            format!("; {value} {other} would be {number}, or \"{value} {other}\"")
        }
        None => "; is the unit right?".to_owned(),
    };
    (!range.contains(&value)).then(|| Unlikely { fault: Fault::new(span, text), hint, is_first: true })
}

/// Positions that are most likely not in m: the path, or else objects beside it.
fn far_away(document: &SceneDocument) -> Vec<Unlikely> {
    let SceneDocument { tables, contour, objects: pieces } = document;
    let (sweep, length) = (tables.sweep.get_ref(), *tables.rod.get_ref().length.get_ref());
    let PointValue(start) = *sweep.from.get_ref();
    let too_far = |lengths: f64| lengths > LONG_WAY && lengths.is_finite();
    let far = |name: &str, span: Range<usize>, lengths: f64| {
        let text = format!("{name} is {lengths:.0} lengths of the rod away from sweep.from");
        Unlikely { fault: Fault::new(span, text), hint: "; are both in m?".to_owned(), is_first: false }
    };
    if let Some(to) = &sweep.to {
        let lengths = distance(start, to.get_ref().0) / length;
        if too_far(lengths) {
            let text = format!("the path is {lengths:.0} lengths of the rod long");
            let fault = Fault::new(to.span(), text);
            return vec![Unlikely { fault, hint: "; are from and to in m?".to_owned(), is_first: true }];
        }
    }
    let mut found = Vec::new();
    let legs = sweep.leg.iter().map(Spanned::get_ref);
    let points = legs.flat_map(|leg| [("to", leg.to.as_ref()), ("pivot", leg.pivot.as_ref())]);
    let positions = tables.contour.iter().chain(&tables.object).map(|object| object.get_ref().position.as_ref());
    for (name, point) in points.chain(positions.map(|position| ("position", position))) {
        let Some(point) = point else { continue };
        let lengths = distance(start, point.get_ref().0) / length;
        found.extend(too_far(lengths).then(|| far(name, point.span(), lengths)));
    }
    let own = tables.contour.iter().map(|table| (table, contour));
    for (table, pieces) in own.chain(tables.object.iter().zip(pieces)) {
        let table = table.get_ref();
        let position = table.position.as_ref().map_or([0.0, 0.0], |position| position.get_ref().0);
        let scale = table.scale.as_ref().map_or(1.0, |scale| *scale.get_ref());
        let away = distance(start, position);
        // one for each object: its other points are as far away
        let point = pieces.iter().find_map(|piece| {
            let (name, span, distance) = piece.farthest()?;
            let lengths = (distance * scale - away) / length;
            too_far(lengths).then(|| far(name, span, lengths))
        });
        found.extend(point);
    }
    found
}

fn distance([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    (x1 - x0).hypot(y1 - y0)
}
