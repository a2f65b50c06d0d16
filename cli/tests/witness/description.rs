//! The objects of a scene file, read as TOML, without the library.

use super::boundary::Boundary;
use super::curve::Curve;
use super::pieces::{curves, number, pair, parabolas};
use super::vector::Point;
use toml::Table;
use toml::Value;

/// A contour that goes on for ever is looked at up to here, in lengths of the rod.
const REACH: f64 = 6.0;

/// The boundaries of all objects in lengths of the rod; none where the scene has a shape that this judge does not know.
pub fn boundaries(text: &str) -> Option<Vec<Boundary>> {
    let scene: Table = text.parse().ok()?;
    let length = number(scene.get("rod")?.as_table()?, "length")?;
    let others = scene.get("object").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let objects = scene.get("contour").into_iter().chain(others);
    objects.map(|object| boundary(object.as_table()?, length)).collect()
}

fn boundary(object: &Table, length: f64) -> Option<Boundary> {
    let pieces: Vec<&Table> = object.get("piece")?.as_array()?.iter().map(Value::as_table).collect::<Option<_>>()?;
    let is_parabola = |table: &&Table| table.get("shape").and_then(Value::as_str) == Some("parabola");
    let own: Vec<Curve> = if pieces.iter().all(is_parabola) {
        parabolas(&pieces, REACH * length)?
    } else {
        pieces.into_iter().map(curves).collect::<Option<Vec<_>>>()?.concat()
    };
    let flag = |name: &str| object.get(name).and_then(Value::as_bool) == Some(true);
    let (at, scale) = (pair(object, "position").unwrap_or_default(), number(object, "scale").unwrap_or(1.0));
    let (sin, cos) = number(object, "angle").unwrap_or(0.0).to_radians().sin_cos();
    let side = if flag("mirror") { -1.0 } else { 1.0 };
    let map = |[x, y]: Point| {
        let (x, y) = (scale * x, scale * side * y);
        [(at[0] + x * cos - y * sin) / length, (at[1] + x * sin + y * cos) / length]
    };
    let mut placed: Vec<Curve> = own.iter().map(|curve| curve.mapped(&map)).collect();
    // a mirrored contour is travelled backwards, so that the solid stays on its left
    if flag("mirror") != flag("reversed") {
        placed = placed.iter().rev().map(Curve::reversed).collect();
    }
    Some(Boundary::new(placed))
}
