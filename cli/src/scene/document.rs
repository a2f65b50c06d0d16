//! The scene file as written: names, types and spans, no physics.

use super::{Fault, shape::Shape};
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Name of the field that says which shape a piece is.
const TAG: &str = "shape";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    pub rod: Spanned<RodTable>,
    pub contour: Spanned<ContourTable>,
    pub sweep: Spanned<SweepTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RodTable {
    pub length: Spanned<f64>,
    pub diameter: Option<Spanned<f64>>,
    pub youngs_modulus: Option<Spanned<f64>>,
    pub bending_stiffness: Option<Spanned<f64>>,
    pub yield_stress: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContourTable {
    #[serde(default)]
    pub piece: Vec<Spanned<Shape>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepTable {
    pub from: Spanned<Point>,
    pub to: Spanned<Point>,
    pub angle: Spanned<f64>,
    pub angle_to: Option<Spanned<f64>>,
    pub step: Option<Spanned<f64>>,
    pub step_angle: Option<Spanned<f64>>,
}

/// Two coordinates. Not an array of two, of which serde would overlook a third number.
#[derive(Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(super) struct Point(pub [f64; 2]);

impl TryFrom<Vec<f64>> for Point {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let found = numbers.len();
        let xy =
            numbers.try_into().map_err(|_| format!("found a list of {found}, expected two numbers: [x, y] in m"))?;
        Ok(Self(xy))
    }
}

/// The text as a tree of values that know where they stand.
pub(super) fn table(text: &str) -> Result<Spanned<DeTable<'_>>, Fault> {
    DeTable::parse(text).map_err(Fault::from)
}

/// The tree as a document.
pub(super) fn document(mut table: Spanned<DeTable<'_>>) -> Result<Document, Fault> {
    let contour = table.get_mut().get_mut("contour").map(Spanned::get_mut);
    if let Some(DeValue::Table(contour)) = contour
        && let Some(DeValue::Array(pieces)) = contour.get_mut("piece").map(Spanned::get_mut)
    {
        pieces.iter_mut().try_for_each(tag_outside)?;
    }
    Document::deserialize(toml::de::Deserializer::from(table)).map_err(Fault::from)
}

/// Rewrites `{ shape = "name", .. }` as `{ name = { .. } }`: serde loses all spans on its way through an enum with the tag
/// inside. What is no table stays as it is, for serde to complain about.
fn tag_outside(piece: &mut Spanned<DeValue<'_>>) -> Result<(), Fault> {
    let span = piece.span();
    let DeValue::Table(table) = piece.get_mut() else { return Ok(()) };
    let Some(tag) = table.remove(TAG) else {
        return Err(Fault::new(span, format!("missing field `{TAG}`, expected the name of a shape")));
    };
    let at = tag.span();
    let name = match tag.into_inner() {
        DeValue::String(name) => name,
        other => {
            return Err(Fault::new(at, format!("invalid type: {}, expected the name of a shape", other.type_str())));
        }
    };
    let fields = std::mem::take(table);
    table.insert(Spanned::new(at, name), Spanned::new(span, DeValue::Table(fields)));
    Ok(())
}
