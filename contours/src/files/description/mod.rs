//! Shapes as data: the fields that scene files and JSON write, angles in DEGREES.
//!
//! A [`Shape`] is one piece of a contour, or several in a row (a polygon gives its edges, an SVG path its segments).
//! Lengths have the unit of the file. This is the single list of shapes that have a name, and of their fields.

mod fields;
mod listing;

pub use fields::{
    ArcFields, CircleFields, EllipseFields, LineFields, ParabolaFields, PolygonFields, SplineEndField, SplineFields,
    SvgFields,
};

pub use listing::{FieldInfo, FieldUnit, ShapeInfo};

pub use super::error::{ShapeError, ShapeFault};

use std::path::Path;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use crate::Contour;

/// Pieces of a contour in order.
pub type Pieces = Vec<Box<dyn Contour>>;

/// One row a shape: the enum, the names, and what depends on the name are all made from these.
macro_rules! shapes {
    ($($(#[doc = $doc:literal])* $name:literal $variant:ident $fields:ident;)*) => {
        /// A shape by its name and fields.
        ///
        /// ```
        /// use rod_contours::Contour;
        /// use rod_contours::description::Shape;
        ///
        /// let text = r#"{"shape": "arc", "center": [0, 1], "radius": 0.5, "from_angle": -180, "to_angle": 0}"#;
        /// let arc: Shape = serde_json::from_str(text)?;
        /// let pieces = arc.pieces("".as_ref())?;
        /// assert_eq!(pieces[0].gap(0.0, 0.0), 0.5);
        /// # Ok::<(), Box<dyn std::error::Error>>(())
        /// ```
        #[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
        #[serde(tag = "shape")]
        pub enum Shape {
            $($(#[doc = $doc])* #[serde(rename = $name)] $variant($fields),)*
        }

        impl Shape {
            /// The names of all shapes.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// All shapes with their fields, in order.
            pub const ALL: &'static [ShapeInfo] =
                &[$(ShapeInfo { name: $name, meaning: concat!($($doc),*), fields: $fields::FIELDS }),*];

            /// The shape of this name with fields that are still to be read, for formats that keep the name elsewhere.
            ///
            /// # Errors
            ///
            /// Those of the deserializer: an unknown name, a missing or unknown field, a value of the wrong type.
            pub fn from_fields<'de, D: Deserializer<'de>>(name: &str, fields: D) -> Result<Self, D::Error> {
                match name {
                    $($name => $fields::deserialize(fields).map(Self::$variant),)*
                    _ => Err(D::Error::unknown_variant(name, Self::NAMES)),
                }
            }

            /// The pieces it stands for, in order, at least one. Relative files are looked for in `directory`.
            ///
            /// # Errors
            ///
            /// [`ShapeError`] names the field whose value is wrong.
            pub fn pieces(&self, directory: &Path) -> Result<Pieces, ShapeError> {
                match self {
                    $(Self::$variant(fields) => fields.pieces(directory),)*
                }
            }
        }
    };
}

shapes! {
    /// `y = vertex.y + coefficient (x - vertex.x)^2`, to +x, the solid above.
    "parabola" Parabola ParabolaFields;
    /// A straight line.
    "line" Line LineFields;
    /// Straight edges from point to point.
    "polygon" Polygon PolygonFields;
    /// A circle, the solid inside.
    "circle" Circle CircleFields;
    /// An arc of a circle, or a whole one.
    "arc" Arc ArcFields;
    /// An arc of an ellipse, or a whole one.
    "ellipse" Ellipse EllipseFields;
    /// A smooth curve through points, or near them.
    "spline" Spline SplineFields;
    /// A path of an SVG drawing.
    "svg" Svg SvgFields;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(json: &str) -> Shape {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn names_and_tags_agree() {
        let line = r#"{"shape": "line", "from": [0, 0], "to": [1, 0]}"#;
        let fields = serde_json::json!({"from": [0, 0], "to": [1, 0]});
        assert_eq!(Shape::from_fields("line", fields.clone()).unwrap(), shape(line));
        let error = Shape::from_fields("lime", fields).unwrap_err().to_string();
        assert!(error.contains("unknown variant `lime`") && error.contains("`polygon`"), "{error}");
        assert_eq!(
            serde_json::to_string(&shape(line)).unwrap(),
            line.replace(": ", ":").replace(", ", ",").replace('0', "0.0").replace("[1,", "[1.0,")
        );
    }

    #[test]
    fn every_shape_survives_a_round_trip() {
        for json in [
            r#"{"shape": "parabola", "vertex": [0, 1], "coefficient": 5, "to_x": 2}"#,
            r#"{"shape": "polygon", "points": [[0, 0], [1, 0], [0, 1]]}"#,
            r#"{"shape": "circle", "center": [0, 1], "radius": 2}"#,
            r#"{"shape": "arc", "center": [0, 1], "radius": 2}"#,
            r#"{"shape": "polygon", "file": "points.csv", "closed": false}"#,
            r#"{"shape": "ellipse", "center": [0, 0], "radii": [2, 1], "from_angle": 0, "to_angle": 360}"#,
            r#"{"shape": "spline", "file": "points.csv", "end": "clamped", "from_angle": 3}"#,
            r#"{"shape": "svg", "path": "M0 0H1", "scale": 1e-3}"#,
        ] {
            let shape = shape(json);
            let text = serde_json::to_string(&shape).unwrap();
            assert_eq!(serde_json::from_str::<Shape>(&text).unwrap(), shape, "{text}");
            assert!(Shape::NAMES.iter().any(|name| text.contains(name)));
        }
    }

    #[test]
    fn a_circle_is_an_arc_and_an_ellipse_without_angles() {
        let directory = "".as_ref();
        for fields in [
            r#""circle", "center": [1, 2], "radius": 2"#,
            r#""arc", "center": [1, 2], "radius": 2"#,
            r#""ellipse", "center": [1, 2], "radii": [2, 2]"#,
        ] {
            let circle =
                crate::Composite::new(shape(&format!("{{\"shape\": {fields}}}")).pieces(directory).unwrap()).unwrap();
            assert!(circle.is_closed() && !circle.is_cavity(), "{fields}");
            assert!((circle.gap(1.0, 5.0) - 1.0).abs() < 1e-14 && circle.gap(1.0, 2.5) < 0.0, "{fields}");
        }
        let half = shape(r#"{"shape": "arc", "center": [0, 1], "radius": 2, "to_angle": 9}"#);
        let error = half.pieces(directory).unwrap_err();
        assert_eq!(
            (error.field, error.to_string().as_str()),
            (Some("to_angle"), "given without from_angle, expected both, or neither for a closed curve")
        );
        let error = shape(r#"{"shape": "circle", "center": [0, 1], "radius": -2}"#).pieces(directory).unwrap_err();
        assert_eq!(error.field, Some("radius"));
    }

    #[test]
    fn what_is_no_shape() {
        let message = |json: &str| serde_json::from_str::<Shape>(json).unwrap_err().to_string();
        assert!(message(r#"{"from": [0, 0], "to": [1, 0]}"#).contains("missing field `shape`"));
        assert!(message(r#"{"shape": "line", "from": [0, 0], "two": [1, 0]}"#).contains("unknown field `two`"));
        let three = message(r#"{"shape": "line", "from": [0, 0, 1], "to": [1, 0]}"#);
        assert!(three.contains("found a list of 3, expected two numbers: [x, y]"), "{three}");
    }
}
