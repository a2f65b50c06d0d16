//! The table `[rod]` as a rod.

use super::document::{ClampTable, RodTable, SectionTable};
use super::given_rod::GivenRod;
use super::kind::AnyRod;
use crate::toml_file::{Fault, number};
use std::ops::Range;
use toml::{Spanned, Value};
use vibrissa::Rod;
use vibrissa::rod::{ElasticClamp, Guided, Mounted, NaturalCurvature, RodError, RodSection, VaryingRod};

/// What is said where another rod is given than a uniform, straight one.
pub(super) const NOT_UNIFORM: &str = "a rod that is not uniform or not straight at rest, expected length with diameter and youngs_modulus, or \
     with bending_stiffness";

/// What is said where a clamp gives way.
pub(super) const NOT_RIGID: &str = "a clamp that gives way, expected no table [clamp]";

/// What is said where the rod runs through a roller.
pub(super) const NO_ROLLER: &str = "a roller ahead of the clamp, which only `sweep`, `contour`, `study` and `simulate` take, expected no \
     field roller";

/// Sections that are longer together than so many lengths of their rod are in another unit.
const IN_MM: f64 = 100.0;

/// A field of a table, for messages that point at it.
type Field<'a> = (&'static str, Option<&'a Spanned<f64>>);

/// Where an error of the library belongs in the table.
fn placed<'a>(fields: &'a [Field<'a>], table: Range<usize>) -> impl Fn(RodError) -> Fault + 'a {
    move |error| {
        let named = |wanted: &str| fields.iter().find(|(name, _)| *name == wanted).and_then(|(_, field)| *field);
        let field = match &error {
            RodError::NotPositive { what, .. } | RodError::NotFinite { what, .. } => named(what),
            RodError::Section { what, .. } => named(what),
            RodError::SectionsLength { .. } => named("length"),
            RodError::TooThick { diameter, .. } => {
                let tip = named("tip_diameter").filter(|field| field.get_ref() == diameter);
                tip.or_else(|| named("diameter"))
            }
            RodError::TooTapered { .. } => named("tip_diameter"),
            _ => None,
        };
        let message = match &error {
            // the place tells which section it is
            RodError::Section { what, value, expected, .. } => format!("{what} is {value}, expected {expected}"),
            error => error.to_string(),
        };
        Fault::new(field.map_or(table.clone(), Spanned::span), message)
    }
}

/// How stiff a rod or section is, as it is written.
#[derive(Clone, Copy, PartialEq)]
enum Written {
    Stiffness(f64),
    Wire { diameter: f64, youngs_modulus: f64 },
}

impl Written {
    /// A uniform, straight rod of this length, m.
    fn rod(self, length: f64) -> Result<Rod, RodError> {
        match self {
            Self::Stiffness(stiffness) => Rod::new(length, stiffness),
            Self::Wire { diameter, youngs_modulus } => Rod::from_diameter(length, diameter, youngs_modulus),
        }
    }

    fn diameter(self) -> Option<f64> {
        match self {
            Self::Stiffness(_) => None,
            Self::Wire { diameter, .. } => Some(diameter),
        }
    }
}

fn written(table: Range<usize>, [stiffness, diameter, modulus]: [Option<&Spanned<f64>>; 3]) -> Result<Written, Fault> {
    let missing = |what: &str| {
        let message = format!("missing field `{what}`, expected diameter and youngs_modulus, or bending_stiffness");
        Err(Fault::new(table.clone(), message))
    };
    match (stiffness, diameter, modulus) {
        (Some(stiffness), None, None) => Ok(Written::Stiffness(*stiffness.get_ref())),
        (None, Some(diameter), Some(modulus)) => {
            Ok(Written::Wire { diameter: *diameter.get_ref(), youngs_modulus: *modulus.get_ref() })
        }
        (Some(stiffness), ..) => {
            let message = "given beside diameter or youngs_modulus, expected either it or those two";
            Err(Fault::new(stiffness.span(), message))
        }
        (None, Some(_), None) => missing("youngs_modulus"),
        (None, None, Some(_)) => missing("diameter"),
        (None, None, None) => missing("bending_stiffness"),
    }
}

/// A rod with what holds it.
pub(super) enum Held {
    Clamped(AnyRod),
    Guided(Guided<VaryingRod>),
}

impl Held {
    /// Length, m.
    pub fn length(&self) -> f64 {
        match self {
            Self::Clamped(rod) => rod.length(),
            Self::Guided(rod) => rod.rod().length(),
        }
    }
}

/// The rod of a table `[rod]`, on the springs or through the roller of a table `[clamp]`.
pub(super) fn rod(table: &Spanned<RodTable>, clamp: Option<&Spanned<ClampTable>>) -> Result<Held, Fault> {
    if let Some(roller) = clamp.and_then(|clamp| clamp.get_ref().roller.as_ref()) {
        return guided(table, clamp, roller).map(Held::Guided);
    }
    let clamp = springs(clamp)?;
    match alone(table)? {
        Alone::Uniform(rod) if clamp.is_rigid() => Ok(Held::Clamped(AnyRod::Uniform(rod))),
        rod => Ok(Held::Clamped(AnyRod::Mounted(Mounted::new(varying(table, rod)?, clamp)))),
    }
}

/// The rod of a table that runs through a roller ahead of its clamp.
fn guided(
    table: &Spanned<RodTable>,
    clamp: Option<&Spanned<ClampTable>>,
    roller: &Spanned<f64>,
) -> Result<Guided<VaryingRod>, Fault> {
    if let Some(ClampTable { stiffness_x, stiffness_y, stiffness_phi, .. }) = clamp.map(Spanned::get_ref)
        && let Some(stiffness) = [stiffness_x, stiffness_y, stiffness_phi].into_iter().flatten().next()
    {
        return Err(Fault::new(stiffness.span(), "given beside roller, expected springs or a roller"));
    }
    let rod = varying(table, alone(table)?)?;
    let length = rod.length();
    Guided::new(rod, *roller.get_ref()).map_err(|error| {
        let in_mm = (length..1e3 * length).contains(roller.get_ref());
        Fault::new(roller.span(), format!("{error}{}", if in_mm { " m; is it in mm?" } else { "" }))
    })
}

/// The rod of a table as one of any kind.
fn varying(table: &Spanned<RodTable>, rod: Alone) -> Result<VaryingRod, Fault> {
    match rod {
        Alone::Uniform(rod) => {
            if let Some(stress) = &table.get_ref().yield_stress {
                let message =
                    "given for a rod whose clamp gives way or has a roller, expected it with a rigid clamp alone";
                return Err(Fault::new(stress.span(), message));
            }
            rod.with_natural_curvature(0.0).map_err(|error| Fault::new(table.span(), error.to_string()))
        }
        Alone::Varying(rod) => Ok(rod),
    }
}

/// The rod of a table `[rod]` on the springs of a table `[clamp]`, for recordings of it.
pub(super) fn given(table: &Spanned<RodTable>, clamp: Option<&Spanned<ClampTable>>) -> Result<GivenRod, Fault> {
    let clamp = springs(clamp)?;
    match alone(table)? {
        Alone::Uniform(rod) => Ok(GivenRod::Uniform(Mounted::new(rod, clamp))),
        Alone::Varying(rod) => {
            GivenRod::varying(Mounted::new(rod, clamp)).map_err(|error| Fault::new(table.span(), error.to_string()))
        }
    }
}

/// The clamp of a table `[clamp]`, rigid without one.
pub(super) fn springs(table: Option<&Spanned<ClampTable>>) -> Result<ElasticClamp, Fault> {
    let Some(table) = table else { return Ok(ElasticClamp::default()) };
    let ClampTable { stiffness_x, stiffness_y, stiffness_phi, roller } = table.get_ref();
    if let Some(roller) = roller {
        return Err(Fault::new(roller.span(), NO_ROLLER));
    }
    let fields = [("stiffness_x", stiffness_x), ("stiffness_y", stiffness_y), ("stiffness_phi", stiffness_phi)];
    let [x, y, phi] = fields.map(|(_, field)| field.as_ref().map(|field| *field.get_ref()));
    ElasticClamp::springs(x, y, phi).map_err(|error| {
        let at = |what: &str| fields.iter().find(|(name, _)| *name == what).and_then(|(_, field)| field.as_ref());
        let field = match &error {
            RodError::ClampStiffness { what, .. } => at(what),
            _ => None,
        };
        Fault::new(field.map_or(table.span(), Spanned::span), error.to_string())
    })
}

/// A rod without its clamp.
enum Alone {
    Uniform(Rod),
    Varying(VaryingRod),
}

/// The rod of a table. One that is uniform and straight at rest is, however it is written: with a tip as thick as the base, with a curvature of 0,
/// or in sections that are all alike.
fn alone(table: &Spanned<RodTable>) -> Result<Alone, Fault> {
    let RodTable {
        length,
        diameter,
        tip_diameter,
        youngs_modulus,
        bending_stiffness,
        natural_curvature,
        yield_stress,
        section,
    } = table.get_ref();
    let fields: [Field<'_>; 6] = [
        ("length", Some(length)),
        ("diameter", diameter.as_ref()),
        ("tip_diameter", tip_diameter.as_ref()),
        ("youngs_modulus", youngs_modulus.as_ref()),
        ("bending_stiffness", bending_stiffness.as_ref()),
        ("yield_stress", yield_stress.as_ref()),
    ];
    let at = placed(&fields, table.span());
    let long = *length.get_ref();
    let rod = if section.is_empty() {
        let stiff = written(table.span(), [bending_stiffness, diameter, youngs_modulus].map(Option::as_ref))?;
        match (stiff, tip_diameter) {
            (Written::Wire { diameter, youngs_modulus }, Some(tip)) if *tip.get_ref() != diameter => {
                Alone::Varying(Rod::tapered(long, diameter, *tip.get_ref(), youngs_modulus).map_err(&at)?)
            }
            (Written::Stiffness(_), Some(tip)) => {
                let message =
                    "given beside bending_stiffness, expected diameter and youngs_modulus of a wire that tapers";
                return Err(Fault::new(tip.span(), message));
            }
            (stiff, _) => Alone::Uniform(stiff.rod(long).map_err(&at)?),
        }
    } else {
        let others = fields[1..5].iter().find_map(|(name, field)| field.map(|field| (name, field)));
        if let Some((name, field)) = others {
            let message = format!("{name} is given beside [[rod.section]], expected it in the sections alone");
            return Err(Fault::new(field.span(), message));
        }
        of_sections(length, section)?
    };
    let given = section.iter().find_map(|section| section.get_ref().natural_curvature.as_ref());
    if let (Some(_), Some(bent)) = (natural_curvature, given) {
        let message = "given beside rod.natural_curvature, expected one of the two";
        return Err(Fault::new(bent.span(), message));
    }
    let bent = natural_curvature.as_ref().filter(|curvature| number(curvature.get_ref()) != Some(0.0));
    let rod = match (rod, bent) {
        (Alone::Uniform(rod), None) => {
            let Some(stress) = yield_stress else { return Ok(Alone::Uniform(rod)) };
            return rod.with_yield_stress(*stress.get_ref()).map(Alone::Uniform).map_err(&at);
        }
        (Alone::Uniform(rod), Some(_)) => rod.with_natural_curvature(0.0).map_err(&at)?,
        (Alone::Varying(rod), _) => rod,
    };
    // the stress at the surface of a varying rod is not compared with a limit
    if let Some(stress) = yield_stress {
        let message =
            "given for a rod that is not uniform or not straight at rest, expected it with a uniform rod alone";
        return Err(Fault::new(stress.span(), message));
    }
    let Some(curvature) = bent else { return Ok(Alone::Varying(rod)) };
    let wrong = |error: RodError| Fault::new(curvature.span(), error.to_string());
    let curvature = natural(curvature).and_then(|curvature| curvature.map_err(wrong))?;
    rod.with_natural_curvature(curvature).map(Alone::Varying).map_err(wrong)
}

/// The rod of a table, if it is uniform and straight at rest; `instead` is what the user may do with another one.
pub(super) fn uniform(table: &Spanned<RodTable>, instead: &str) -> Result<Rod, Fault> {
    match alone(table)? {
        Alone::Uniform(rod) => Ok(rod),
        Alone::Varying(_) => Err(Fault::new(table.span(), format!("{NOT_UNIFORM}; {instead}"))),
    }
}

fn of_sections(length: &Spanned<f64>, tables: &[Spanned<SectionTable>]) -> Result<Alone, Fault> {
    let (mut sections, mut stiff) = (Vec::with_capacity(tables.len()), Vec::with_capacity(tables.len()));
    for table in tables {
        let SectionTable { length, diameter, youngs_modulus, bending_stiffness, natural_curvature } = table.get_ref();
        let fields: [Field<'_>; 5] = [
            ("length", Some(length)),
            ("diameter", diameter.as_ref()),
            ("youngs_modulus", youngs_modulus.as_ref()),
            ("bending_stiffness", bending_stiffness.as_ref()),
            ("natural_curvature", natural_curvature.as_ref()),
        ];
        let at = placed(&fields, table.span());
        let long = *length.get_ref();
        let written = written(table.span(), [bending_stiffness, diameter, youngs_modulus].map(Option::as_ref))?;
        let bending_stiffness = match written {
            Written::Stiffness(stiffness) => stiffness,
            wire @ Written::Wire { .. } => wire.rod(long).map_err(&at)?.bending_stiffness(),
        };
        let natural_curvature = natural_curvature.as_ref().map_or(0.0, |curvature| *curvature.get_ref());
        let section = RodSection { length: long, bending_stiffness, natural_curvature };
        // each on its own, so that the message points at it
        Rod::sections(long, &[section]).map_err(&at)?;
        sections.push(section);
        stiff.push(written);
    }
    let long = *length.get_ref();
    let wrong = |error: RodError| match (error, tables.first()) {
        (RodError::SectionsLength { total, .. }, Some(first)) if total > IN_MM * long => {
            let message = format!(
                "the lengths of the sections add up to {total} m, expected {long} m, the length of the rod; are they in mm?"
            );
            Fault::new(first.get_ref().length.span(), message)
        }
        (error, _) => Fault::new(length.span(), error.to_string()),
    };
    let rod = Rod::sections(long, &sections).map_err(wrong)?;
    if let Some(first) = stiff.first()
        && stiff.iter().all(|one| one == first)
        && sections.iter().all(|section| section.natural_curvature == 0.0)
    {
        return first.rod(long).map(Alone::Uniform).map_err(wrong);
    }
    // of all sections, or of none
    match stiff.iter().map(|one| one.diameter()).collect::<Option<Vec<_>>>() {
        Some(diameters) => rod.with_section_diameters(&diameters).map(Alone::Varying).map_err(wrong),
        None => Ok(Alone::Varying(rod)),
    }
}

/// A natural curvature as it is written: a number, or points.
fn natural(field: &Spanned<Value>) -> Result<Result<NaturalCurvature, RodError>, Fault> {
    let wrong =
        || Fault::new(field.span(), "expected a number (1/m), or a list of points: [[s, curvature], ...] in m and 1/m");
    let value = field.get_ref();
    if let Some(curvature) = number(value) {
        return Ok(Ok(NaturalCurvature::from(curvature)));
    }
    let list = value.as_array().ok_or_else(wrong)?;
    let point = |point: &Value| match point.as_array()?.as_slice() {
        [s, curvature] => Some([number(s)?, number(curvature)?]),
        _ => None,
    };
    let points = list.iter().map(point).collect::<Option<Vec<_>>>().ok_or_else(wrong)?;
    Ok(NaturalCurvature::points(&points))
}
