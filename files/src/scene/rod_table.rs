//! The table `[rod]` as a rod.

use super::document::{ClampTable, RodTable, SectionTable};
use crate::toml_file::{Fault, number};
use std::ops::Range;
use toml::{Spanned, Value};
use vibrissa::Rod;
use vibrissa::rod::{
    AnyRod, ClampSpec, CurvatureSpec, ElasticClamp, RodError, RodFault, RodSpec, SectionSpec, StiffnessSpec,
};

/// What is said where another rod is given than a uniform, straight one.
pub(super) const NOT_UNIFORM: &str = "a rod that is not uniform or not straight at rest, expected length with diameter and youngs_modulus, or \
     with bending_stiffness";

/// What is said where a clamp gives way.
pub(super) const NOT_RIGID: &str = "a clamp that gives way, expected no table [clamp]";

/// What is said where the rod runs through a roller.
pub(super) const NO_ROLLER: &str = "a roller ahead of the clamp, which only `sweep`, `contour`, `study` and `simulate` take, expected no \
     field roller";

/// The rod of a table `[rod]`, on the springs or through the roller of a table `[clamp]`.
pub(super) fn rod(table: &Spanned<RodTable>, clamp: Option<&Spanned<ClampTable>>) -> Result<AnyRod, Fault> {
    let roller = clamp.and_then(|clamp| clamp.get_ref().roller.as_ref());
    let held = match roller {
        None => ClampSpec::Springs(springs(clamp)?),
        Some(roller) => {
            if let Some(ClampTable { stiffness_x, stiffness_y, stiffness_phi, .. }) = clamp.map(Spanned::get_ref)
                && let Some(stiffness) = [stiffness_x, stiffness_y, stiffness_phi].into_iter().flatten().next()
            {
                return Err(Fault::new(stiffness.span(), "given beside roller, expected springs or a roller"));
            }
            ClampSpec::Roller(*roller.get_ref())
        }
    };
    let spec = RodSpec { clamp: held, ..spec(table)? };
    spec.build().map_err(|fault| match roller.filter(|_| fault.field == Some("clamp.roller")) {
        Some(roller) => {
            let in_mm = (spec.length..1e3 * spec.length).contains(roller.get_ref());
            Fault::new(roller.span(), format!("{fault}{}", if in_mm { "; is it in mm?" } else { "" }))
        }
        None => fault_in_table(table, fault),
    })
}

/// The rod of a table `[rod]` on the springs of a table `[clamp]`, for recordings of it.
pub(super) fn rod_for_recordings(
    table: &Spanned<RodTable>,
    clamp: Option<&Spanned<ClampTable>>,
) -> Result<AnyRod, Fault> {
    let springs = springs(clamp)?;
    Ok(alone(table)?.with_springs(springs))
}

/// The rod of a table for films of it, perhaps of another length, and whether its stiffness is given: if not, it is 1 N m^2 at the base.
pub(super) fn filmed_rod(
    table: &Spanned<RodTable>,
    clamp: Option<&Spanned<ClampTable>>,
    length: Option<f64>,
) -> Result<(AnyRod, bool), Fault> {
    let mut spec = spec(table)?;
    spec.length = length.unwrap_or(spec.length);
    let StiffnessSpec { bending_stiffness, diameter, youngs_modulus } = spec.stiffness;
    let base = match &spec.diameters {
        Some(points) => Some(points.first().map_or(f64::NAN, |point| point[1])),
        None => diameter,
    };
    let is_known = bending_stiffness.is_some() || youngs_modulus.is_some() || !spec.sections.is_empty();
    if let (None, Some(tip)) = (base, table.get_ref().tip_diameter.as_ref())
        && !is_known
    {
        let message = "tip_diameter is given without diameter, expected both for a wire that tapers";
        return Err(Fault::new(tip.span(), message));
    }
    if !is_known {
        spec.stiffness = match base {
            Some(base) => {
                let wire = StiffnessSpec::of_wire(base, 64.0 / (std::f64::consts::PI * base.powi(4)));
                StiffnessSpec { diameter, ..wire }
            }
            None => StiffnessSpec::of(1.0),
        };
    }
    if let Some(clamp) = clamp.filter(|_| !is_known) {
        let message = "springs beside a rod without a stiffness, expected bending_stiffness or youngs_modulus in [rod]";
        return Err(Fault::new(clamp.span(), message));
    }
    let rod = spec.build().map_err(|fault| fault_in_table(table, fault))?;
    Ok((rod.with_springs(springs(clamp)?), is_known))
}

/// The rod of a table, if it is uniform and straight at rest; `instead` is what the user may do with another one.
pub(super) fn uniform(table: &Spanned<RodTable>, instead: &str) -> Result<Rod, Fault> {
    let rod = alone(table)?;
    rod.uniform().copied().ok_or_else(|| Fault::new(table.span(), format!("{NOT_UNIFORM}; {instead}")))
}

/// The rod of a table, clamped rigidly.
pub(super) fn alone(table: &Spanned<RodTable>) -> Result<AnyRod, Fault> {
    spec(table)?.build().map_err(|fault| fault_in_table(table, fault))
}

/// The clamp of a table `[clamp]`, rigid without one.
pub(super) fn springs(table: Option<&Spanned<ClampTable>>) -> Result<ElasticClamp, Fault> {
    let Some(table) = table else { return Ok(ElasticClamp::default()) };
    let ClampTable { stiffness_x, stiffness_y, stiffness_phi, roller } = table.get_ref();
    if let Some(roller) = roller {
        return Err(Fault::new(roller.span(), NO_ROLLER));
    }
    let fields = [("stiffness_x", stiffness_x), ("stiffness_y", stiffness_y), ("stiffness_phi", stiffness_phi)];
    let [x, y, phi] = fields.map(|(_, field)| value(field));
    ElasticClamp::springs(x, y, phi).map_err(|error| {
        let at = |what: &str| fields.iter().find(|(name, _)| *name == what).and_then(|(_, field)| field.as_ref());
        let field = match &error {
            RodError::ClampStiffness { what, .. } => at(what),
            _ => None,
        };
        Fault::new(field.map_or(table.span(), Spanned::span), error.to_string())
    })
}

fn value(field: &Option<Spanned<f64>>) -> Option<f64> {
    field.as_ref().map(|field| *field.get_ref())
}

/// The fields of a rod as they are written.
fn spec(table: &Spanned<RodTable>) -> Result<RodSpec, Fault> {
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
    let (diameter, diameters) = match diameter.as_ref().map(|field| along(field, "diameter", "m")).transpose()? {
        None => (None, None),
        Some(Along::Number(diameter)) => (Some(diameter), None),
        Some(Along::Points(points)) => (None, Some(points)),
    };
    let curvature = natural_curvature.as_ref().map(|field| along(field, "curvature", "1/m")).transpose()?;
    Ok(RodSpec {
        length: *length.get_ref(),
        stiffness: StiffnessSpec { diameter, ..stiffness([bending_stiffness, &None, youngs_modulus]) },
        tip_diameter: value(tip_diameter),
        diameters,
        natural_curvature: curvature.map(|curvature| match curvature {
            Along::Number(curvature) => CurvatureSpec::Constant(curvature),
            Along::Points(points) => CurvatureSpec::Points(points),
        }),
        sections: section.iter().map(|section| section_spec(section.get_ref())).collect(),
        yield_stress: value(yield_stress),
        clamp: ClampSpec::Rigid,
    })
}

fn section_spec(table: &SectionTable) -> SectionSpec {
    let SectionTable { length, diameter, youngs_modulus, bending_stiffness, natural_curvature } = table;
    SectionSpec {
        length: *length.get_ref(),
        stiffness: stiffness([bending_stiffness, diameter, youngs_modulus]),
        natural_curvature: value(natural_curvature),
    }
}

fn stiffness(fields: [&Option<Spanned<f64>>; 3]) -> StiffnessSpec {
    let [bending_stiffness, diameter, youngs_modulus] = fields.map(value);
    StiffnessSpec { bending_stiffness, diameter, youngs_modulus }
}

/// A quantity along the rod as it is written.
enum Along {
    Number(f64),
    /// Arc lengths and values.
    Points(Vec<[f64; 2]>),
}

fn along(field: &Spanned<Value>, quantity: &str, unit: &str) -> Result<Along, Fault> {
    let value = field.get_ref();
    let wrong = || {
        let found = value.as_str().map_or_else(String::new, |text| format!("the value is the text \"{text}\", "));
        let is_quoted = value.as_str().is_some_and(|text| text.trim().parse::<f64>().is_ok());
        let hint = if is_quoted { "; write it without quotes" } else { "" };
        let expected =
            format!("expected a number ({unit}), or a list of points: [[s, {quantity}], ...] in m and {unit}");
        Fault::new(field.span(), format!("{found}{expected}{hint}"))
    };
    if let Some(number) = number(value) {
        return Ok(Along::Number(number));
    }
    let list = value.as_array().ok_or_else(wrong)?;
    let point = |point: &Value| match point.as_array()?.as_slice() {
        [s, value] => Some([number(s)?, number(value)?]),
        _ => None,
    };
    list.iter().map(point).collect::<Option<_>>().ok_or_else(wrong).map(Along::Points)
}

/// The diameters of a rod that are written, all in one place.
pub(super) fn diameters(table: &RodTable) -> Option<(Range<usize>, Vec<f64>)> {
    let field = table.diameter.as_ref()?;
    let values = match along(field, "diameter", "m").ok()? {
        Along::Number(diameter) => vec![diameter],
        Along::Points(points) => points.iter().map(|point| point[1]).collect(),
    };
    Some((field.span(), values))
}

/// What is wrong with a rod, where that stands in its table.
fn fault_in_table(table: &Spanned<RodTable>, fault: RodFault) -> Fault {
    let place = match fault.section.and_then(|index| table.get_ref().section.get(index)) {
        Some(section) => fault.field.and_then(|field| of_section(section.get_ref(), field)).unwrap_or(section.span()),
        None => fault.field.and_then(|field| of_rod(table.get_ref(), field)).unwrap_or(table.span()),
    };
    Fault::new(place, fault.message.replace("beside sections", "beside [[rod.section]]"))
}

fn of_rod(table: &RodTable, field: &str) -> Option<Range<usize>> {
    let span = |field: &Option<Spanned<f64>>| field.as_ref().map(Spanned::span);
    match field {
        "length" => Some(table.length.span()),
        "diameter" => table.diameter.as_ref().map(Spanned::span),
        "tip_diameter" => span(&table.tip_diameter),
        "youngs_modulus" => span(&table.youngs_modulus),
        "bending_stiffness" => span(&table.bending_stiffness),
        "natural_curvature" => table.natural_curvature.as_ref().map(Spanned::span),
        "yield_stress" => span(&table.yield_stress),
        _ => None,
    }
}

fn of_section(table: &SectionTable, field: &str) -> Option<Range<usize>> {
    let span = |field: &Option<Spanned<f64>>| field.as_ref().map(Spanned::span);
    match field {
        "length" => Some(table.length.span()),
        "diameter" => span(&table.diameter),
        "youngs_modulus" => span(&table.youngs_modulus),
        "bending_stiffness" => span(&table.bending_stiffness),
        "natural_curvature" => span(&table.natural_curvature),
        _ => None,
    }
}
