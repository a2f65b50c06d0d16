//! Friction of a scene: one coefficient for all, one of an object, one of a piece; the closest one counts.

use super::document::SceneTables;
use super::shape::PieceTable;
use crate::toml_file::{Fault, number};
use std::ops::Range;
use toml::{Spanned, Value};
use vibrissa::Composite;
use vibrissa::contact::{Coefficients, Friction};

/// Coefficient above which a warning is due: rubber on rubber has 1 to 2, and 5 is most often a mistake.
const LARGE: f64 = 5.0;

/// The friction of each object of a scene: that of all its pieces, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFriction(Vec<Vec<Coefficients>>);

impl SceneFriction {
    /// The friction of objects of which each has one item for all its pieces, or one for each. Objects beyond the last have none.
    pub fn new(objects: Vec<Vec<Coefficients>>) -> Self {
        Self(objects)
    }

    /// The friction of each object: one item for all its pieces, or one for each.
    pub fn objects(&self) -> &[Vec<Coefficients>] {
        &self.0
    }

    /// Whether there is any.
    pub fn rubs(&self) -> bool {
        self.0.iter().flatten().any(|found| found.at_rest > 0.0)
    }
}

impl Friction for SceneFriction {
    fn coefficients(&self, object: usize, piece: usize) -> Coefficients {
        let of_object = self.0.get(object).map(Vec::as_slice).unwrap_or_default();
        if let [only] = of_object { *only } else { of_object.get(piece).copied().unwrap_or(Coefficients::NONE) }
    }
}

/// The friction of a scene, none where it is nowhere mentioned or 0, with warnings for values that may be mistakes.
pub(super) fn friction(
    tables: &SceneTables,
    contour: &[PieceTable],
    objects: &[Vec<PieceTable>],
    shapes: &[Composite],
) -> Result<(Option<SceneFriction>, Vec<Fault>), Fault> {
    let mut warnings = Vec::new();
    let mut read = |value: &Spanned<Value>| -> Result<Coefficients, Fault> {
        let found = coefficients(value.span(), value.get_ref())?;
        if found.at_rest > LARGE {
            let message =
                format!("friction is {}, expected at most {LARGE}; a coefficient, not percent?", found.at_rest);
            warnings.push(Fault::new(value.span(), message));
        }
        Ok(found)
    };
    let of_all = match tables.contact.as_ref().and_then(|contact| contact.get_ref().friction.as_ref()) {
        Some(value) => read(value)?,
        None => Coefficients::NONE,
    };
    let own = tables.contour.iter().map(|table| (table, contour));
    let others = tables.object.iter().zip(objects.iter().map(Vec::as_slice));
    let mut all = Vec::new();
    for ((table, pieces), shape) in own.chain(others).zip(shapes) {
        let table = table.get_ref();
        let of_object = table.friction.as_ref().map_or(Ok(of_all), &mut read)?;
        if pieces.iter().all(|piece| piece.friction.is_none()) {
            all.push(vec![of_object]);
            continue;
        }
        let mut of_pieces = Vec::new();
        for piece in pieces {
            let found = piece.friction.as_ref().map_or(Ok(of_object), &mut read)?;
            of_pieces.extend(std::iter::repeat_n(found, piece.count()));
        }
        if of_pieces.len() != shape.pieces() || table.mirror || table.reversed {
            let span = pieces.iter().find_map(|piece| piece.friction.as_ref()).map_or(0..0, Spanned::span);
            let message = "friction of one piece of an object that is mirrored, reversed or cut, \
                           where pieces change their numbers; expected friction of the whole object";
            return Err(Fault::new(span, message));
        }
        all.push(of_pieces);
    }
    Ok((Some(SceneFriction(all)).filter(SceneFriction::rubs), warnings))
}

/// A number, or a table of two.
fn coefficients(span: Range<usize>, value: &Value) -> Result<Coefficients, Fault> {
    let found = match value {
        Value::Table(table) => {
            let field = |name: &str| {
                table.get(name).and_then(number).ok_or_else(|| {
                    let found = table.get(name).map_or("missing", Value::type_str);
                    let message =
                        format!("`{name}` is {found}, expected a number, as in {{ at_rest = 0.5, slipping = 0.4 }}");
                    Fault::new(span.clone(), message)
                })
            };
            if let Some(unknown) = table.keys().find(|key| !["at_rest", "slipping"].contains(&key.as_str())) {
                let message = format!("unknown field `{unknown}`, expected `at_rest` and `slipping`");
                return Err(Fault::new(span, message));
            }
            Coefficients { at_rest: field("at_rest")?, slipping: field("slipping")? }
        }
        Value::Array(_) => {
            let message = "a list, expected a coefficient, such as 0.3, or { at_rest = 0.5, slipping = 0.4 }; that of one object or piece \
                           belongs in its own table";
            return Err(Fault::new(span, message));
        }
        value => Coefficients::equal(number(value).ok_or_else(|| {
            let message = format!(
                "friction is of the type {}, expected a coefficient, such as 0.3, or {{ at_rest = 0.5, slipping = 0.4 }}",
                value.type_str()
            );
            Fault::new(span.clone(), message)
        })?),
    };
    if found.are_valid() {
        return Ok(found);
    }
    let Coefficients { at_rest, slipping } = found;
    let message = if let Some((name, wrong)) = [("at_rest", at_rest), ("slipping", slipping)]
        .into_iter()
        .find(|(_, number)| !(0.0..f64::INFINITY).contains(number))
    {
        let place = if matches!(value, Value::Table(_)) { format!(", for {name}") } else { String::new() };
        format!("friction is {wrong}, expected a finite coefficient, 0 or more{place}")
    } else {
        format!("friction is {slipping} slipping and {at_rest} at rest, expected 0 < slipping <= at_rest")
    };
    Err(Fault::new(span, message))
}
