//! From a document to a scene: every number checked where it stands.

use super::document::{PointValue, RodTable, SceneDocument, SceneTables, SectionTable, SweepTable};
use super::numbers::{check_step_count, not, too_large};
use super::{Scene, friction, leg, object, rod_table};
use crate::toml_file::{Fault, SourceText};
use serde_json::Value;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use toml::Spanned;
use vibrissa::contact::ContactError;
use vibrissa::{ClampPath, Pose};

/// Least radius of an arc, lengths of the rod: rounding leaves nothing of a smaller one.
const LEAST_RADIUS: f64 = 1e-12;

/// Files that the objects name are looked for in `directory`. What is wrong may come from a number of another field that is not plausible: the
/// message then names that one, too.
pub(super) fn scene(
    name: String,
    source: SourceText,
    document: SceneDocument,
    directory: &Path,
) -> Result<Scene, Fault> {
    let unlikely = implausible(&document.tables);
    let also = unlikely.first().map(|also| (also.clone(), source.place(also.clone()).without_place()));
    scene_of_document(name, source, document, directory, unlikely).map_err(|fault| match also {
        Some((also, said)) => fault.beside(&also, &said),
        None => fault,
    })
}

fn scene_of_document(
    name: String,
    source: SourceText,
    document: SceneDocument,
    directory: &Path,
    unlikely: Vec<Fault>,
) -> Result<Scene, Fault> {
    let files = std::iter::once(source.file().to_path_buf()).chain(named_files(&document, directory)).collect();
    let SceneDocument { tables, contour, objects: pieces } = document;
    let rod = rod_table::rod(&tables.rod, tables.clamp.as_ref())?;
    let objects = object::all(&tables, &contour, &pieces, directory)?;
    let least = LEAST_RADIUS * rod.length();
    if let Some(fault) = contour.iter().chain(pieces.iter().flatten()).find_map(|piece| piece.too_thin(least)) {
        return Err(fault);
    }
    let path = path(tables.sweep.get_ref())?;
    let step = step(&tables.sweep, &path)?;
    let legs = leg::all(tables.sweep.get_ref(), path.at(path.length()), rod.length())?;
    let (friction, large) = friction::friction(&tables, &contour, &pieces, &objects)?;
    let warnings = unlikely.into_iter().chain(large).map(|fault| source.place(fault).to_string()).collect();
    let roller = tables.clamp.as_ref().and_then(|clamp| clamp.get_ref().roller.as_ref());
    if let Some(roller) = roller.filter(|_| friction.is_some()) {
        return Err(Fault::new(roller.span(), "a roller ahead of the clamp beside friction, expected one of the two"));
    }
    Ok(Scene { name, rod, objects, path, step, legs, friction, warnings, files, source })
}

fn path(sweep: &SweepTable) -> Result<ClampPath, Fault> {
    let SweepTable { from, to, angle, angle_to, .. } = sweep;
    let angle_to = angle_to.as_ref().unwrap_or(angle);
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
                (to.span(), message.to_owned())
            }
            _ => (to.span(), error.to_string()),
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
/// Straight path, lengths of the rod, beyond which positions are most likely in another unit than m.
const LONG_WAY: f64 = 100.0;

/// A number, its name, where it is, its plausible range and unit.
type Field = (&'static str, Option<(Range<usize>, f64)>, RangeInclusive<f64>, &'static str);

/// A warning for each number of a scene outside of its plausible range.
fn implausible(tables: &SceneTables) -> Vec<Fault> {
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
