//! The pieces of a contour: the library's shapes, whose fields are listed there, with their places in the file.

use crate::toml_file::Fault;
use serde::Deserialize;
use std::cell::Cell;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};
use vibrissa::contour::description::{Pieces, Shape};

/// Name of the field that says which shape a piece is.
const TAG: &str = "shape";
/// Name of the field of a coefficient of friction, which is not the shape's.
const FRICTION: &str = "friction";

/// One `[[contour.piece]]` or `[[object.piece]]`.
pub(super) struct PieceTable {
    pub span: Range<usize>,
    /// Its coefficient of friction, if it has one of its own.
    pub friction: Option<Spanned<toml::Value>>,
    shape: Shape,
    fields: Vec<ShapeField>,
    /// Of how many pieces of contour it consists, once these were made.
    count: Cell<usize>,
}

/// Where a field stands, and its values where it is a list.
struct ShapeField {
    name: String,
    span: Range<usize>,
    items: Vec<Range<usize>>,
}

impl PieceTable {
    /// A piece as written. Without the name of its shape the table holds the fields of the library's description, read by
    /// name: serde loses all places on its way through an enum with the name inside.
    pub fn read(value: Spanned<DeValue<'_>>) -> Result<Self, Fault> {
        let span = value.span();
        let mut table = match value.into_inner() {
            DeValue::Table(table) => table,
            other => {
                return Err(Fault::new(
                    span,
                    format!("the value is of the type {}, expected a table of fields", other.type_str()),
                ));
            }
        };
        let Some(tag) = table.remove(TAG) else {
            return Err(Fault::new(span, format!("missing field `{TAG}`, expected the name of a shape")));
        };
        let at = tag.span();
        let name = match tag.into_inner() {
            DeValue::String(name) => name,
            other => {
                return Err(Fault::new(
                    at,
                    format!("the value is of the type {}, expected the name of a shape", other.type_str()),
                ));
            }
        };
        if !Shape::NAMES.contains(&name.as_ref()) {
            let known: Vec<String> = Shape::NAMES.iter().map(|name| format!("`{name}`")).collect();
            return Err(Fault::new(at, format!("the shape is `{name}`, expected one of {}", known.join(", "))));
        }
        let friction = match table.remove(FRICTION) {
            Some(value) => Some(Spanned::new(value.span(), toml::Value::deserialize(ValueDeserializer::from(value))?)),
            None => None,
        };
        let fields = fields(&table);
        let values = ValueDeserializer::from(Spanned::new(span.clone(), DeValue::Table(table)));
        let shape = Shape::from_fields(&name, values)?;
        Ok(Self { span, friction, shape, fields, count: Cell::new(0) })
    }

    /// The pieces of contour it stands for. Relative files are looked for in `directory`.
    pub fn contours(&self, directory: &Path) -> Result<Pieces, Fault> {
        let pieces = self.shape.pieces(directory).map_err(|error| {
            let field = self.fields.iter().find(|field| Some(field.name.as_str()) == error.field);
            let point = || field?.items.get(error.point?.checked_sub(1)?).cloned();
            let span = point().or_else(|| field.map(|field| field.span.clone())).unwrap_or_else(|| self.span.clone());
            Fault::new(span, error.to_string())
        })?;
        self.count.set(pieces.len());
        Ok(pieces)
    }

    /// What is wrong with an arc whose radius is below `least`, m.
    pub fn too_thin(&self, least: f64) -> Option<Fault> {
        let (name, radius) = match &self.shape {
            Shape::Circle(fields) => ("radius", fields.radius),
            Shape::Arc(fields) => ("radius", fields.radius),
            Shape::Ellipse(fields) => ("radii", fields.radii[0].min(fields.radii[1])),
            _ => return None,
        };
        let field = self.fields.iter().find(|field| field.name == name)?;
        let message = format!("the radius is {radius} m, expected at least {least:.1e} m, 1e-12 lengths of the rod");
        (radius < least).then(|| Fault::new(field.span.clone(), message))
    }

    /// The point of the shape farthest from the origin of the pieces, of those that its fields give: its field, and the distance, m; of circles and
    /// ellipses the nearest point of the curve.
    pub fn farthest(&self) -> Option<(&'static str, Range<usize>, f64)> {
        let size = |[x, y]: [f64; 2]| x.hypot(y);
        let list = |points: &Option<Vec<[f64; 2]>>| points.iter().flatten().copied().map(size).fold(0.0, f64::max);
        let (name, distance) = match &self.shape {
            Shape::Parabola(fields) => ("vertex", size(fields.vertex)),
            Shape::Line(fields) => [("from", size(fields.from)), ("to", size(fields.to))]
                .into_iter()
                .max_by(|one, other| one.1.total_cmp(&other.1))?,
            Shape::Polygon(fields) => ("points", list(&fields.points)),
            Shape::Spline(fields) => ("points", list(&fields.points)),
            Shape::Circle(fields) => ("center", size(fields.center) - fields.radius),
            Shape::Arc(fields) => ("center", size(fields.center) - fields.radius),
            Shape::Ellipse(fields) => ("center", size(fields.center) - fields.radii[0].max(fields.radii[1])),
            Shape::Svg(_) => return None,
        };
        let field = self.fields.iter().find(|field| field.name == name)?;
        Some((name, field.span.clone(), distance))
    }

    /// Of how many pieces of contour it consists: 0 before [`contours`](Self::contours) has made them.
    pub fn count(&self) -> usize {
        self.count.get()
    }

    /// The file that it names.
    pub fn file(&self) -> Option<&Path> {
        match &self.shape {
            Shape::Polygon(fields) => fields.file.as_deref(),
            Shape::Spline(fields) => fields.file.as_deref(),
            Shape::Svg(fields) => fields.file.as_deref(),
            _ => None,
        }
    }

    /// Whether it is a polygon, whose pieces are edges.
    pub fn has_edges(&self) -> bool {
        matches!(self.shape, Shape::Polygon(_))
    }
}

fn fields(table: &DeTable<'_>) -> Vec<ShapeField> {
    let mut fields = Vec::new();
    for (name, value) in table {
        let items = match value.get_ref() {
            DeValue::Array(items) => items.iter().map(Spanned::span).collect(),
            _ => Vec::new(),
        };
        fields.push(ShapeField { name: name.get_ref().to_string(), span: value.span(), items });
    }
    fields
}
