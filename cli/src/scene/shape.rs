//! The shapes a piece of contour can have.
//!
//! A new one takes a variant here, with a struct of its fields as they are written in the file, and an arm in [`Shape::contour`].

use super::Fault;
use super::document::Point;
use serde::Deserialize;
use toml::Spanned;
use vibrissa::{Contour, Parabola};

/// One `[[contour.piece]]`.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Shape {
    Parabola(ParabolaFields),
}

/// y = vertex.y + coefficient (x - vertex.x)^2, the solid above.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParabolaFields {
    /// m
    vertex: Spanned<Point>,
    /// 1/m
    coefficient: Spanned<f64>,
}

impl Shape {
    /// The shape as a contour.
    pub fn contour(&self) -> Result<Box<dyn Contour>, Fault> {
        match self {
            Self::Parabola(ParabolaFields { vertex, coefficient }) => {
                let parabola = Parabola::new(vertex.get_ref().0, *coefficient.get_ref()).map_err(|error| {
                    let vertex_is_wrong = !vertex.get_ref().0.iter().all(|number| number.is_finite());
                    let span = if vertex_is_wrong { vertex.span() } else { coefficient.span() };
                    Fault::new(span, error.to_string())
                })?;
                Ok(Box::new(parabola))
            }
        }
    }
}
