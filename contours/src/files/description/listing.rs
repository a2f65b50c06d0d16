//! The fields of each shape as a list: names, types, units and meanings, made from the definitions that are read.

use std::path::PathBuf;

use crate::Point;

/// The unit of a field.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum FieldUnit {
    /// The unit of length of the file: m in scene files.
    Length,
    /// One over that unit.
    PerLength,
    /// Degrees.
    Degrees,
    /// None.
    None,
}

/// A field of a shape.
#[derive(Clone, Copy, Debug)]
pub struct FieldInfo {
    /// Its name.
    pub name: &'static str,
    /// The form of the value, such as `number` or `[x, y]`.
    pub kind: &'static str,
    /// Its unit.
    pub unit: FieldUnit,
    /// Whether it must be given.
    pub required: bool,
    /// Its meaning.
    pub meaning: &'static str,
}

/// A shape that has a name.
#[derive(Clone, Copy, Debug)]
pub struct ShapeInfo {
    /// Its name.
    pub name: &'static str,
    /// Its description.
    pub meaning: &'static str,
    /// Its fields.
    pub fields: &'static [FieldInfo],
}

/// How values of a type are written.
pub(super) trait Written {
    /// In a word or an example.
    const KIND: &'static str;
}

macro_rules! written {
    ($($type:ty = $kind:literal;)*) => {
        $(impl Written for $type {
            const KIND: &'static str = $kind;
        })*
    };
}

written! {
    f64 = "number";
    Point = "[x, y]";
    Vec<Point> = "list of [x, y]";
    bool = "true or false";
    String = "text";
    PathBuf = "path";
}

impl<T: Written> Written for Option<T> {
    const KIND: &'static str = T::KIND;
}

/// Whether an attribute of serde supplies a value where the field is missing.
pub(super) const fn has_default(attribute: &str) -> bool {
    let (text, word) = (attribute.as_bytes(), b"default");
    let mut start = 0;
    while start + word.len() <= text.len() {
        let mut same = 0;
        while same < word.len() && text[start + same] == word[same] {
            same += 1;
        }
        if same == word.len() {
            return true;
        }
        start += 1;
    }
    false
}

/// Defines the fields of shapes, and lists them in a constant `FIELDS`. The unit of a field stands behind its type.
macro_rules! fields {
    ($(
        $(#[doc = $about:literal])*
        $shape:ident {
            $(
                $(#[doc = $doc:literal])+
                $(#[serde($($serde:tt)*)])?
                $field:ident: $type:ty => $unit:ident,
            )*
        }
    )*) => {
        $(
            $(#[doc = $about])*
            #[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
            #[serde(deny_unknown_fields)]
            pub struct $shape {
                $(
                    $(#[doc = $doc])+
                    $(#[serde($($serde)*)])?
                    pub $field: $type,
                )*
            }

            impl $shape {
                pub(super) const FIELDS: &'static [FieldInfo] = &[$(FieldInfo {
                    name: stringify!($field),
                    kind: <$type as Written>::KIND,
                    unit: FieldUnit::$unit,
                    required: !has_default(concat!("", $(stringify!($($serde)*))?)),
                    meaning: concat!($($doc),+),
                }),*];
            }
        )*
    };
}
pub(super) use fields;

#[cfg(test)]
mod tests {
    use super::super::Shape;
    use super::*;

    #[test]
    fn the_list_is_that_of_the_shapes() {
        assert_eq!(Shape::ALL.iter().map(|shape| shape.name).collect::<Vec<_>>(), Shape::NAMES);
        let arc = Shape::ALL.iter().find(|shape| shape.name == "arc").unwrap();
        assert_eq!(arc.meaning.trim(), "An arc of a circle, or a whole one.");
        let names: Vec<&str> = arc.fields.iter().map(|field| field.name).collect();
        assert_eq!(names, ["center", "radius", "from_angle", "to_angle"]);
        assert_eq!(arc.fields.iter().map(|field| field.required).collect::<Vec<_>>(), [true, true, false, false]);
        assert_eq!((arc.fields[1].unit, arc.fields[2].unit), (FieldUnit::Length, FieldUnit::Degrees));
    }

    #[test]
    fn what_is_optional_can_be_left_out() {
        let given = serde_json::json!({"vertex": [0, 0], "coefficient": 1});
        assert!(Shape::from_fields("parabola", given).is_ok());
        let parabola = Shape::ALL.iter().find(|shape| shape.name == "parabola").unwrap();
        let required: Vec<&str> =
            parabola.fields.iter().filter(|field| field.required).map(|field| field.name).collect();
        assert_eq!(required, ["vertex", "coefficient"]);
    }
}
