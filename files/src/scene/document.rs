//! The scene file as written: names, types and spans, no physics.

use super::shape::PieceTable;
use crate::toml_file::{Fault, comma_in_list};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use vibrissa::reconstruct::Source;

/// A scene file, the pieces of its objects beside it.
pub(super) struct SceneDocument {
    pub tables: SceneTables,
    /// Those of `[contour]`.
    pub contour: Vec<PieceTable>,
    /// Those of each `[[object]]`.
    pub objects: Vec<Vec<PieceTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneTables {
    pub rod: Spanned<RodTable>,
    pub clamp: Option<Spanned<ClampTable>>,
    pub contact: Option<Spanned<ContactTable>>,
    pub contour: Option<Spanned<ObjectTable>>,
    #[serde(default)]
    pub object: Vec<Spanned<ObjectTable>>,
    pub sweep: Spanned<SweepTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RodTable {
    pub length: Spanned<f64>,
    /// A number, or a list of points.
    pub diameter: Option<Spanned<toml::Value>>,
    pub tip_diameter: Option<Spanned<f64>>,
    pub youngs_modulus: Option<Spanned<f64>>,
    pub bending_stiffness: Option<Spanned<f64>>,
    /// A number, or a list of points.
    pub natural_curvature: Option<Spanned<toml::Value>>,
    pub yield_stress: Option<Spanned<f64>>,
    #[serde(default)]
    pub section: Vec<Spanned<SectionTable>>,
}

/// `[clamp]`: springs between support and rod, or a roller ahead of a rigid clamp.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClampTable {
    pub stiffness_x: Option<Spanned<f64>>,
    pub stiffness_y: Option<Spanned<f64>>,
    pub stiffness_phi: Option<Spanned<f64>>,
    pub roller: Option<Spanned<f64>>,
}

/// `[calibration]`: what is known of each source of errors that all samples of a scan share.
pub(super) type CalibrationTable = BTreeMap<Source, Spanned<EstimateTable>>;

/// What is known of a source.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EstimateTable {
    pub value: Spanned<f64>,
    pub sigma: Spanned<f64>,
    pub unit: Option<Spanned<String>>,
}

/// `[contact]`: what holds for the contacts with all objects.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactTable {
    /// A coefficient, or a table of two.
    pub friction: Option<Spanned<toml::Value>>,
}

/// One `[[rod.section]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SectionTable {
    pub length: Spanned<f64>,
    pub diameter: Option<Spanned<f64>>,
    pub youngs_modulus: Option<Spanned<f64>>,
    pub bending_stiffness: Option<Spanned<f64>>,
    pub natural_curvature: Option<Spanned<f64>>,
}

/// `[contour]` or one `[[object]]`: a contour and where it stands.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectTable {
    pub position: Option<Spanned<PointValue>>,
    pub angle: Option<Spanned<f64>>,
    pub scale: Option<Spanned<f64>>,
    #[serde(default)]
    pub mirror: bool,
    #[serde(default)]
    pub reversed: bool,
    pub hollow: Option<Spanned<bool>>,
    pub file: Option<Spanned<PathBuf>>,
    pub friction: Option<Spanned<toml::Value>>,
    /// Taken out and read before; named here for the list of fields in the message on an unknown one.
    #[serde(default, rename = "piece")]
    _piece: Vec<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepTable {
    pub from: Spanned<PointValue>,
    /// Where the clamp only turns, it may be left out.
    pub to: Option<Spanned<PointValue>>,
    pub angle: Spanned<f64>,
    pub angle_to: Option<Spanned<f64>>,
    pub step: Option<Spanned<f64>>,
    pub step_angle: Option<Spanned<f64>>,
    #[serde(default)]
    pub leg: Vec<Spanned<LegTable>>,
}

/// `[[sweep.leg]]`: where the clamp goes from the end of the leg before.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LegTable {
    pub to: Option<Spanned<PointValue>>,
    pub angle_to: Option<Spanned<f64>>,
    pub pivot: Option<Spanned<PointValue>>,
    pub turn: Option<Spanned<f64>>,
    pub step: Option<Spanned<f64>>,
    pub step_angle: Option<Spanned<f64>>,
}

/// Two coordinates. Not an array of two, of which serde would overlook a third number.
#[derive(Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(super) struct PointValue(pub [f64; 2]);

impl TryFrom<Vec<f64>> for PointValue {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let found = numbers.len();
        let xy = numbers.try_into().map_err(|_| {
            format!("found a list of {found}, expected two numbers: [x, y] in m{}", comma_in_list(found))
        })?;
        Ok(Self(xy))
    }
}

/// The tree as a document.
pub(super) fn document(mut table: Spanned<DeTable<'_>>) -> Result<SceneDocument, Fault> {
    let single = |name: &str| table.get_ref().get(name).filter(|value| value.get_ref().is_array());
    if let Some((name, list)) =
        ["rod", "clamp", "contact", "contour", "sweep"].iter().find_map(|name| Some((name, single(name)?)))
    {
        let message = format!(
            "a list where one table belongs, expected [{name}] once; several may be [[object]], [[object.piece]], \
                               [[contour.piece]], [[sweep.leg]] and [[rod.section]]"
        );
        return Err(Fault::new(list.span(), message));
    }
    let contour = table.get_mut().get_mut("contour").map_or_else(|| Ok(Vec::new()), pieces)?;
    let objects = match table.get_mut().get_mut("object").map(|objects| (objects.span(), objects.get_mut())) {
        Some((_, DeValue::Array(objects))) => objects.iter_mut().map(pieces).collect::<Result<_, _>>()?,
        Some((span, DeValue::Table(_))) => {
            let message =
                "a table where a list belongs, expected [[object]] before the first [[object.piece]] of each object";
            return Err(Fault::new(span, message));
        }
        _ => Vec::new(),
    };
    let tables = SceneTables::deserialize(toml::de::Deserializer::from(table))?;
    Ok(SceneDocument { tables, contour, objects })
}

/// Takes the pieces out of an object. What is not in its place stays there, for serde to complain about.
fn pieces(object: &mut Spanned<DeValue<'_>>) -> Result<Vec<PieceTable>, Fault> {
    let DeValue::Table(object) = object.get_mut() else { return Ok(Vec::new()) };
    match object.get_mut("piece").map(Spanned::get_mut) {
        Some(DeValue::Array(pieces)) => {
            std::mem::replace(pieces, std::iter::empty().collect()).into_iter().map(PieceTable::read).collect()
        }
        _ => Ok(Vec::new()),
    }
}
