//! The fields of each shape, and the pieces they stand for.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer, Serialize};

use super::listing::{FieldInfo, FieldUnit, Written, fields, has_default};
use super::{Pieces, ShapeError};
use crate::composite::polygon;
use crate::files::{FileError, SvgError, csv, path, svg};
use crate::{CircularArc, Contour, ContourError, EllipticArc, Line, Parabola, Point, Spline, SplineEnd};

/// Degrees of a full turn.
const TURN: f64 = 360.0;

impl Written for SplineEndField {
    const KIND: &'static str = "\"natural\", \"clamped\" or \"periodic\"";
}

fn one(shape: impl Contour + 'static) -> Pieces {
    vec![Box::new(shape)]
}

fields! {
    /// `y = vertex.y + coefficient (x - vertex.x)^2`, travelled to +x: the solid is above.
    ParabolaFields {
        /// The vertex.
        #[serde(deserialize_with = "pair")]
        vertex: Point => Length,
        /// The coefficient of the square.
        coefficient: f64 => PerLength,
        /// Where it starts, x; minus infinity unless given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from_x: Option<f64> => Length,
        /// Where it ends, x; infinity unless given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to_x: Option<f64> => Length,
    }
}

impl ParabolaFields {
    pub(super) fn pieces(&self, _: &Path) -> Result<Pieces, ShapeError> {
        let fields = [("vertex", &self.vertex[..]), ("coefficient", &[self.coefficient])];
        let parabola = Parabola::new(self.vertex, self.coefficient)
            .map_err(|error| ShapeError::blaming(error, &fields, Some("coefficient")))?;
        for (field, x) in [("from_x", self.from_x), ("to_x", self.to_x)] {
            if let Some(value) = x.filter(|x| x.is_nan()) {
                return Err(ShapeError::at(field, ContourError::NotFinite { what: field, value }));
            }
        }
        if self.from_x.is_none() && self.to_x.is_none() {
            return Ok(one(parabola));
        }
        let (from, to) = (self.from_x.unwrap_or(f64::NEG_INFINITY), self.to_x.unwrap_or(f64::INFINITY));
        let field = if self.to_x.is_some() { "to_x" } else { "from_x" };
        parabola.between(from, to).map(one).map_err(|error| ShapeError::at(field, error))
    }
}

fields! {
    /// A straight line; the solid is on the left of the way.
    LineFields {
        /// The first point.
        #[serde(deserialize_with = "pair")]
        from: Point => Length,
        /// The last point.
        #[serde(deserialize_with = "pair")]
        to: Point => Length,
    }
}

impl LineFields {
    pub(super) fn pieces(&self, _: &Path) -> Result<Pieces, ShapeError> {
        let fields = [("from", &self.from[..]), ("to", &self.to[..])];
        Line::new(self.from, self.to).map(one).map_err(|error| ShapeError::blaming(error, &fields, Some("to")))
    }
}

fields! {
    /// Straight edges from point to point; the solid is on the left, inside if the points run counterclockwise.
    PolygonFields {
        /// The points; or else `file`.
        #[serde(default, deserialize_with = "pair_list", skip_serializing_if = "Option::is_none")]
        points: Option<Vec<Point>> => Length,
        /// A CSV file of points.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<PathBuf> => None,
        /// Whether an edge leads from the last point to the first, which may be given again as the last one; true unless given.
        #[serde(default = "yes", skip_serializing_if = "is_yes")]
        closed: bool => None,
    }
}

fn yes() -> bool {
    true
}

fn is_yes(closed: &bool) -> bool {
    *closed
}

impl PolygonFields {
    pub(super) fn pieces(&self, directory: &Path) -> Result<Pieces, ShapeError> {
        let points = Points::of(self.points.as_deref(), self.file.as_deref(), directory)?;
        polygon::edges(&points.points, self.closed).map_err(|error| points.blame(error, &[]))
    }
}

fields! {
    /// A whole circle, counterclockwise: the solid is inside.
    CircleFields {
        /// The centre.
        #[serde(deserialize_with = "pair")]
        center: Point => Length,
        /// The radius.
        radius: f64 => Length,
    }
}

impl CircleFields {
    pub(super) fn pieces(&self, _: &Path) -> Result<Pieces, ShapeError> {
        let fields = [("center", &self.center[..]), ("radius", &[self.radius])];
        CircularArc::new(self.center, self.radius, 0.0, TURN.to_radians())
            .map(one)
            .map_err(|error| ShapeError::blaming(error, &fields, Some("radius")))
    }
}

/// The angles of an arc: a whole turn from 0, counterclockwise, unless both are given.
fn angles(from: Option<f64>, to: Option<f64>) -> Result<[f64; 2], ShapeError> {
    match (from, to) {
        (Some(from), Some(to)) => Ok([from, to]),
        (None, None) => Ok([0.0, TURN]),
        (Some(_), None) => Err(ShapeError::says("from_angle", WITHOUT.replace('*', "to_angle"))),
        (None, Some(_)) => Err(ShapeError::says("to_angle", WITHOUT.replace('*', "from_angle"))),
    }
}

/// The message for one angle of an arc without the other, `*`.
const WITHOUT: &str = "given without *, expected both, or neither for a closed curve";

fields! {
    /// An arc of a circle. Counterclockwise (`to_angle` larger) the solid is inside, clockwise outside.
    ArcFields {
        /// The centre.
        #[serde(deserialize_with = "pair")]
        center: Point => Length,
        /// The radius.
        radius: f64 => Length,
        /// Polar angle where it starts; a whole circle unless both are given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from_angle: Option<f64> => Degrees,
        /// Polar angle where it ends.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to_angle: Option<f64> => Degrees,
    }
}

impl ArcFields {
    pub(super) fn pieces(&self, _: &Path) -> Result<Pieces, ShapeError> {
        let Self { center, radius, from_angle, to_angle } = self;
        let [from_angle, to_angle] = angles(*from_angle, *to_angle)?;
        let fields =
            [("center", &center[..]), ("radius", &[*radius]), ("from_angle", &[from_angle]), ("to_angle", &[to_angle])];
        CircularArc::new(*center, *radius, from_angle.to_radians(), to_angle.to_radians())
            .map(one)
            .map_err(|error| arc(error, &fields, "radius", [from_angle, to_angle]))
    }
}

fields! {
    /// An arc of an ellipse. Counterclockwise (`to_angle` larger) the solid is inside, clockwise outside.
    EllipseFields {
        /// The centre.
        #[serde(deserialize_with = "pair")]
        center: Point => Length,
        /// The radii along its own axes.
        #[serde(deserialize_with = "pair")]
        radii: [f64; 2] => Length,
        /// The angle of its first axis; 0 unless given.
        #[serde(default)]
        rotation: f64 => Degrees,
        /// Eccentric angle where it starts: the polar angle on the circle of which it is the picture. A whole ellipse unless both are given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from_angle: Option<f64> => Degrees,
        /// Eccentric angle where it ends.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to_angle: Option<f64> => Degrees,
    }
}

impl EllipseFields {
    pub(super) fn pieces(&self, _: &Path) -> Result<Pieces, ShapeError> {
        let Self { center, radii, rotation, from_angle, to_angle } = self;
        let [from_angle, to_angle] = angles(*from_angle, *to_angle)?;
        let fields = [
            ("center", &center[..]),
            ("radii", &radii[..]),
            ("rotation", &[*rotation]),
            ("from_angle", &[from_angle]),
            ("to_angle", &[to_angle]),
        ];
        let [rotation, from, to] = [*rotation, from_angle, to_angle].map(f64::to_radians);
        EllipticArc::new(*center, *radii, rotation, from, to)
            .map(one)
            .map_err(|error| arc(error, &fields, "radii", [from_angle, to_angle]))
    }
}

/// The fault of an arc, in degrees.
fn arc(
    error: ContourError,
    fields: &[(&'static str, &[f64])],
    radius: &'static str,
    [from, to]: [f64; 2],
) -> ShapeError {
    match error {
        ContourError::ArcAngle { .. } => ShapeError::says(
            "to_angle",
            format!(
                "the arc runs from {from} to {to} degrees, expected two different angles at most {TURN} degrees apart"
            ),
        ),
        error => ShapeError::blaming(error, fields, Some(radius)),
    }
}

fields! {
    /// A smooth curve through points, or near them; the solid is on the left of the way.
    SplineFields {
        /// The points; or else `file`.
        #[serde(default, deserialize_with = "pair_list", skip_serializing_if = "Option::is_none")]
        points: Option<Vec<Point>> => Length,
        /// A CSV file of points.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<PathBuf> => None,
        /// The condition at the ends; natural unless given.
        #[serde(default)]
        end: SplineEndField => None,
        /// Tangent angle at the start of a clamped one; estimated unless given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from_angle: Option<f64> => Degrees,
        /// Tangent angle at the end of a clamped one; estimated unless given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to_angle: Option<f64> => Degrees,
        /// Standard deviation of the noise in each coordinate: then the curve passes near the points.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        smoothing: Option<f64> => Length,
    }
}

/// The conditions at the ends of a spline.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SplineEndField {
    /// No curvature.
    #[default]
    Natural,
    /// A direction, given or estimated.
    Clamped,
    /// The curve is closed.
    Periodic,
}

impl SplineFields {
    pub(super) fn pieces(&self, directory: &Path) -> Result<Pieces, ShapeError> {
        let angles = [("from_angle", self.from_angle), ("to_angle", self.to_angle)];
        let end = match self.end {
            SplineEndField::Natural => SplineEnd::Natural,
            SplineEndField::Periodic => SplineEnd::Periodic,
            SplineEndField::Clamped => {
                let [from, to] = angles.map(|(_, angle)| angle.map(f64::to_radians));
                SplineEnd::Clamped { from, to }
            }
        };
        let given = angles.iter().find(|(_, angle)| angle.is_some() && self.end != SplineEndField::Clamped);
        if let Some((field, _)) = given {
            return Err(ShapeError::says(
                field,
                "given for an end without a direction, expected end = \"clamped\" beside it",
            ));
        }
        if self.smoothing.is_some() && self.end != SplineEndField::Natural {
            let message = "given beside end, expected natural ends: a smoothed curve has no others";
            return Err(ShapeError::says("smoothing", message));
        }
        let points = Points::of(self.points.as_deref(), self.file.as_deref(), directory)?;
        let spline = match self.smoothing {
            Some(sigma) => Spline::smoothing(&points.points, sigma),
            None => Spline::through(&points.points, end),
        };
        let [from, to, smoothing] =
            [self.from_angle, self.to_angle, self.smoothing].map(|number| number.unwrap_or(0.0));
        let fields = [("from_angle", &[from][..]), ("to_angle", &[to]), ("smoothing", &[smoothing])];
        spline.map(one).map_err(|error| points.blame(error, &fields))
    }
}

fields! {
    /// A path of an SVG drawing, upright: lines, Bezier curves, and arcs as such. Closed, it is made to run counterclockwise.
    SvgFields {
        /// The drawing; or else `path`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        file: Option<PathBuf> => None,
        /// The data of the path, as in its attribute `d`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        path: Option<String> => None,
        /// Which path of the drawing, where it has several.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        id: Option<String> => None,
        /// Length of one unit of the drawing.
        scale: f64 => Length,
    }
}

impl SvgFields {
    pub(super) fn pieces(&self, directory: &Path) -> Result<Pieces, ShapeError> {
        if !(self.scale.is_finite() && self.scale > 0.0) {
            let message =
                format!("scale is {}, expected a positive, finite number: m per unit of the drawing", self.scale);
            return Err(ShapeError::says("scale", message));
        }
        let (field, path) = match (&self.file, &self.path) {
            (Some(file), None) => {
                let file = directory.join(file);
                let path = svg::data(&file, self.id.as_deref());
                let id_is_wrong = matches!(&path, Err(FileError::Svg { source: SvgError::NoSuchPath { .. }, .. }));
                ("file", path.map_err(|error| ShapeError::at(if id_is_wrong { "id" } else { "file" }, error))?)
            }
            (None, Some(path)) => match self.id {
                Some(_) => return Err(ShapeError::says("id", "given beside path, expected it beside file only")),
                None => ("path", path.clone()),
            },
            (Some(_), Some(_)) => return Err(ShapeError::says("path", "given beside file, expected one of them")),
            (None, None) => return Err(ShapeError::of_all("missing field `file` or `path`, expected one of them")),
        };
        path::piece(&path, self.scale).map_err(|source| match &self.file {
            Some(file) => ShapeError::at(field, FileError::Svg { file: directory.join(file), source }),
            None => ShapeError::at(field, source),
        })
    }
}

/// Points, and where they come from.
struct Points<'a> {
    points: Cow<'a, [Point]>,
    /// The file, and the line of each point.
    source: Option<(PathBuf, Vec<u64>)>,
}

impl<'a> Points<'a> {
    fn of(points: Option<&'a [Point]>, file: Option<&Path>, directory: &Path) -> Result<Self, ShapeError> {
        match (points, file) {
            (Some(points), None) => Ok(Self { points: Cow::Borrowed(points), source: None }),
            (None, Some(file)) => {
                let file = directory.join(file);
                let (points, lines) =
                    csv::points_with_lines(&file).map_err(|error| ShapeError::at("file", error))?.into_iter().unzip();
                Ok(Self { points: Cow::Owned(points), source: Some((file, lines)) })
            }
            (Some(_), Some(_)) => Err(ShapeError::says("file", "given beside points, expected one of them")),
            (None, None) => Err(ShapeError::of_all("missing field `points` or `file`, expected one of them")),
        }
    }

    /// The fault, in the list or in the file.
    fn blame(self, error: ContourError, fields: &[(&'static str, &[f64])]) -> ShapeError {
        let smoothing = matches!(error, ContourError::Negative { .. }).then_some("smoothing");
        let blamed = ShapeError::blaming(error.clone(), fields, smoothing);
        if blamed.field.is_some() {
            return blamed;
        }
        let Some((file, lines)) = self.source else { return ShapeError { field: Some("points"), ..blamed } };
        let line = blamed.point.and_then(|point| lines.get(point.checked_sub(1)?).copied());
        ShapeError::at("file", FileError::Points { file, line, source: error })
    }
}

/// Two numbers `[x, y]`: of an array of two serde would overlook a third one.
fn pair<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Point, D::Error> {
    let numbers = Vec::<f64>::deserialize(deserializer)?;
    let found = numbers.len();
    numbers
        .try_into()
        .map_err(|_| serde::de::Error::custom(format!("found a list of {found}, expected two numbers: [x, y]")))
}

/// A list of such pairs.
fn pair_list<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<Point>>, D::Error> {
    let points = Vec::<Vec<f64>>::deserialize(deserializer)?;
    let pair = |(index, numbers): (usize, Vec<f64>)| {
        let (point, found) = (index + 1, numbers.len());
        let fault =
            |_| serde::de::Error::custom(format!("point {point} is a list of {found}, expected two numbers: [x, y]"));
        numbers.try_into().map_err(fault)
    };
    points.into_iter().enumerate().map(pair).collect::<Result<_, _>>().map(Some)
}
