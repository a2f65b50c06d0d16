//! One piece of a scene file as curves, in the units and axes of its object.

use super::curve::Curve;
use super::spline::spline;
use super::vector::Point;
use toml::Table;
use toml::Value;

pub fn number(table: &Table, name: &str) -> Option<f64> {
    value(table.get(name)?)
}

fn value(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

pub fn pair(table: &Table, name: &str) -> Option<Point> {
    coordinates(table.get(name)?)
}

fn coordinates(item: &Value) -> Option<Point> {
    let list = item.as_array()?;
    Some([value(list.first()?)?, value(list.get(1)?)?])
}

fn points(table: &Table) -> Option<Vec<Point>> {
    let mut points: Vec<Point> = table.get("points")?.as_array()?.iter().map(coordinates).collect::<Option<_>>()?;
    let is_closed = points.len() > 2 && points.first() == points.last();
    if is_closed && table.get("end").is_none_or(|end| end.as_str() == Some("periodic")) {
        points.pop();
    }
    Some(points)
}

/// The curves of a piece; none where this judge does not know the shape.
pub fn curves(table: &Table) -> Option<Vec<Curve>> {
    let angle = |name: &str| number(table, name).map(f64::to_radians);
    match table.get("shape")?.as_str()? {
        "line" => Some(vec![Curve::Line { from: pair(table, "from")?, to: pair(table, "to")? }]),
        "polygon" => {
            let points = points(table)?;
            let closed = table.get("closed").is_none_or(|closed| closed.as_bool() == Some(true));
            let edges = points.len() - usize::from(!closed);
            let edge = |k: usize| Curve::Line { from: points[k], to: points[(k + 1) % points.len()] };
            Some((0..edges).map(edge).collect())
        }
        "arc" | "ellipse" => {
            let [a, b] = pair(table, "radii").or_else(|| number(table, "radius").map(|radius| [radius, radius]))?;
            let (sin, cos) = angle("rotation").unwrap_or(0.0).sin_cos();
            let (u, v) = ([a * cos, a * sin], [-b * sin, b * cos]);
            let center = pair(table, "center")?;
            Some(vec![Curve::Oval { center, u, v, from: angle("from_angle")?, to: angle("to_angle")? }])
        }
        "spline" => match table.get("end").and_then(Value::as_str) {
            Some("periodic") => Some(spline(&points(table)?, true)),
            Some("natural") => Some(spline(&points(table)?, false)),
            _ => None,
        },
        _ => None,
    }
}

/// Parabolas in a row as cubics, each cut where the next one crosses it; the outer ones go on beyond all reach.
pub fn parabolas(tables: &[&Table], reach: f64) -> Option<Vec<Curve>> {
    let row: Vec<(Point, f64)> = tables
        .iter()
        .map(|table| Some((pair(table, "vertex")?, number(table, "coefficient")?)))
        .collect::<Option<_>>()?;
    let mut from = row.first()?.0[0] - reach;
    let mut out = Vec::new();
    for (k, &([x, y], c)) in row.iter().enumerate() {
        let to = match row.get(k + 1) {
            None => x + reach,
            Some(&([u, v], d)) => crossing(([x, y], c), ([u, v], d))?,
        };
        let at = |x1: f64| [x1, y + c * (x1 - x) * (x1 - x)];
        let slope = |x1: f64| 2.0 * c * (x1 - x);
        let third = (to - from) / 3.0;
        let (a, b) = (at(from), at(to));
        let handles = [[a[0] + third, a[1] + third * slope(from)], [b[0] - third, b[1] - third * slope(to)]];
        out.push(Curve::Cubic([a, handles[0], handles[1], b]));
        from = to;
    }
    Some(out)
}

/// The x at which the second parabola comes below the first one.
fn crossing((p, c): (Point, f64), (q, d): (Point, f64)) -> Option<f64> {
    // the difference, first less second, as a polynomial of the way from the first vertex: it must rise through 0
    let w = q[0] - p[0];
    let (square, linear, constant) = (c - d, 2.0 * d * w, p[1] - q[1] - d * w * w);
    let root = (linear * linear - 4.0 * square * constant).sqrt();
    // rises where 2 square x + linear = root
    let x = if linear > 0.0 { -2.0 * constant / (linear + root) } else { (root - linear) / (2.0 * square) };
    x.is_finite().then_some(p[0] + x)
}
