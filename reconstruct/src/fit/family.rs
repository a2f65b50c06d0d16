//! Simple shapes on which the nodes of a contour may lie: straight edges, arcs of a circle or an ellipse, parabolas.

use nalgebra::{DVector, Matrix3, Vector2, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::fmt;

/// Newton steps from a node to a shape.
const STEPS: usize = 8;
/// Longest way of a place that is not touched to the shape, rod lengths: ends of a contour are guessed.
const FAR: f64 = 0.1;
/// Ratio of the radii of an ellipse at the start: for equal ones its rotation means nothing.
const OBLONG: f64 = 1.2;

/// The kind of a simple shape, named as the shapes of scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ShapeKind {
    /// A straight line.
    Line,
    /// Straight edges.
    Polygon,
    /// A convex arc of a circle.
    Arc,
    /// A convex arc of an ellipse.
    Ellipse,
    /// A parabola.
    Parabola,
}

impl ShapeKind {
    /// Whether it is of straight edges, whose parameters are the offsets of their corners.
    fn is_straight(self) -> bool {
        matches!(self, Self::Line | Self::Polygon)
    }
}

impl fmt::Display for ShapeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Line => "line",
            Self::Polygon => "polygon",
            Self::Arc => "arc",
            Self::Ellipse => "ellipse",
            Self::Parabola => "parabola",
        })
    }
}

/// A node of a chain: where it is, the directions in which it moves, and the one across the contour.
pub(super) struct Place {
    pub at: Vector2<f64>,
    pub ways: Vec<Vector2<f64>>,
    pub normal: Vector2<f64>,
    pub is_vertex: bool,
    pub is_touched: bool,
}

impl Place {
    /// The offsets that move it to another place.
    fn to(&self, at: Vector2<f64>) -> impl Iterator<Item = f64> {
        self.ways.iter().map(move |way| (at - self.at).dot(way))
    }

    /// The way to a shape, if there is one: a touched place goes any way, another one stays where it is if that is far.
    fn as_far(&self, way: Option<f64>) -> Option<f64> {
        if self.is_touched { way } else { Some(way.filter(|way| way.abs() < FAR).unwrap_or(0.0)) }
    }

    /// The offsets that move it across the contour.
    fn across(&self, offset: f64) -> impl Iterator<Item = f64> {
        self.ways.iter().map(move |way| offset * self.normal.dot(way))
    }
}

/// Simple shapes of a kind, for the places of a chain, in rod lengths.
#[derive(Clone)]
pub(super) struct Family<'a> {
    pub kind: ShapeKind,
    pub places: &'a [Place],
    /// Numbers of the places between which edges are straight: the ends of what is touched, and vertices between them.
    pub corners: Vec<usize>,
}

impl<'a> Family<'a> {
    /// With an edge from vertex to vertex; none where fewer than three places are touched.
    pub fn of(kind: ShapeKind, places: &'a [Place]) -> Option<Self> {
        let touched: Vec<usize> = (0..places.len()).filter(|k| places[*k].is_touched).collect();
        let [first, _, .., last] = touched[..] else { return None };
        let is_corner = |k: &usize| *k == first || *k == last || kind == ShapeKind::Polygon && places[*k].is_vertex;
        Some(Self { kind, places, corners: (first..=last).filter(is_corner).collect() })
    }

    /// The same without a corner each.
    pub fn simpler(&self) -> impl Iterator<Item = Self> {
        let inner = 1..self.corners.len().saturating_sub(1);
        inner.filter(|_| self.kind == ShapeKind::Polygon).map(|k| {
            let mut other = self.clone();
            other.corners.remove(k);
            other
        })
    }

    /// Parameters at which a search starts; none where the places cannot be of this kind.
    pub fn starts(&self) -> Vec<DVector<f64>> {
        match self.kind {
            ShapeKind::Line => vec![self.corners_at_rest()],
            ShapeKind::Polygon if self.corners.len() > 2 => vec![self.corners_at_rest()],
            ShapeKind::Polygon => Vec::new(),
            ShapeKind::Arc => self.circle().map(|(c, r)| DVector::from_vec(vec![c.x, c.y, r])).into_iter().collect(),
            ShapeKind::Ellipse => {
                let Some((c, r)) = self.circle() else { return Vec::new() };
                let turned =
                    |k: i32| DVector::from_vec(vec![c.x, c.y, r * OBLONG, r / OBLONG, f64::from(k) * FRAC_PI_4]);
                (0..4).map(turned).collect()
            }
            ShapeKind::Parabola => self.parabola().into_iter().collect(),
        }
    }

    /// The offsets by which each place comes to lie on the shape, one for each direction in which it moves; none where a touched one does not reach it.
    /// Others that do not stay where they are.
    pub fn offsets(&self, parameters: &DVector<f64>) -> Option<Vec<f64>> {
        if self.kind.is_straight() {
            return self.on_edges(parameters);
        }
        let mut offsets = Vec::new();
        for place in self.places {
            offsets.extend(place.across(place.as_far(self.on_curve(place, parameters))?));
        }
        Some(offsets)
    }

    /// The touched places, from the first to the last.
    fn touched(&self) -> impl DoubleEndedIterator<Item = &Place> {
        self.places.iter().filter(|place| place.is_touched)
    }

    /// What the values mean. Of straight edges they are the corners.
    pub fn names(&self) -> Vec<String> {
        let names: &[&str] = match self.kind {
            ShapeKind::Line => &["from.x", "from.y", "to.x", "to.y"],
            ShapeKind::Polygon => {
                let names = |k: usize| [format!("points[{k}].x"), format!("points[{k}].y")];
                return (0..self.corners.len()).flat_map(names).collect();
            }
            ShapeKind::Arc => &["center.x", "center.y", "radius"],
            ShapeKind::Ellipse => &["center.x", "center.y", "radii[0]", "radii[1]", "rotation"],
            ShapeKind::Parabola => &["vertex.x", "vertex.y", "coefficient", "rotation"],
        };
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    /// The values of what `names` names; rotations in radians.
    pub fn values(&self, parameters: &DVector<f64>) -> DVector<f64> {
        if !self.kind.is_straight() {
            return parameters.clone();
        }
        let corners = self.moved_corners(parameters);
        DVector::from_iterator(2 * corners.len(), corners.iter().flat_map(|(_, at)| [at.x, at.y]))
    }

    /// The parameters, of places that have come to lie on the shape.
    pub fn arrived(&self, parameters: &DVector<f64>) -> DVector<f64> {
        if self.kind.is_straight() { self.corners_at_rest() } else { parameters.clone() }
    }

    /// Whether the shape is one: its sizes are positive, and the solid is inside.
    pub fn is_shape(&self, parameters: &DVector<f64>) -> bool {
        match self.kind {
            ShapeKind::Line | ShapeKind::Polygon => true,
            ShapeKind::Parabola => parameters[2] != 0.0,
            ShapeKind::Arc => parameters[2] > 0.0 && self.is_convex(),
            ShapeKind::Ellipse => parameters[2] > 0.0 && parameters[3] > 0.0 && self.is_convex(),
        }
    }

    fn corners_at_rest(&self) -> DVector<f64> {
        DVector::zeros(self.corners.iter().map(|k| self.places[*k].ways.len()).sum())
    }

    fn moved_corners(&self, parameters: &DVector<f64>) -> Vec<(usize, Vector2<f64>)> {
        let mut offsets = parameters.iter();
        let moved = |k: &usize| {
            let place = &self.places[*k];
            (*k, place.ways.iter().zip(offsets.by_ref()).fold(place.at, |at, (way, offset)| at + way * *offset))
        };
        self.corners.iter().map(moved).collect()
    }

    fn on_edges(&self, parameters: &DVector<f64>) -> Option<Vec<f64>> {
        let corners = self.moved_corners(parameters);
        let mut offsets = Vec::new();
        for (k, place) in self.places.iter().enumerate() {
            if let Some((_, at)) = corners.iter().find(|corner| corner.0 == k) {
                offsets.extend(place.to(*at));
                continue;
            }
            // beyond the ends the edges go on
            let edge = corners.partition_point(|corner| corner.0 < k).clamp(1, corners.len() - 1);
            let (from, to) = (corners[edge - 1].1, corners[edge].1);
            let way = (from - place.at).perp(&(to - from)) / place.normal.perp(&(to - from));
            offsets.extend(place.across(place.as_far(Some(way))?));
        }
        offsets.iter().all(|offset| offset.is_finite()).then_some(offsets)
    }

    /// The way from a place across the contour to the curve.
    fn on_curve(&self, Place { at, normal: way, .. }: &Place, parameters: &DVector<f64>) -> Option<f64> {
        let mut offset = 0.0;
        for _ in 0..STEPS {
            let (value, rate) = self.implicit(at + way * offset, parameters);
            offset -= value / rate.dot(way);
        }
        let (value, rate) = self.implicit(at + way * offset, parameters);
        (offset.is_finite() && value.abs() < 1e-9 * rate.norm()).then_some(offset)
    }

    /// A function that vanishes on the curve, and its gradient.
    fn implicit(&self, at: Vector2<f64>, p: &DVector<f64>) -> (f64, Vector2<f64>) {
        let from = at - Vector2::new(p[0], p[1]);
        let turned = |angle: f64| (Vector2::new(angle.cos(), angle.sin()), Vector2::new(-angle.sin(), angle.cos()));
        match self.kind {
            ShapeKind::Ellipse => {
                let (first, second) = turned(p[4]);
                let (u, v) = (from.dot(&first) / p[2], from.dot(&second) / p[3]);
                let size = u.hypot(v);
                (size - 1.0, (first * (u / p[2]) + second * (v / p[3])) / size)
            }
            ShapeKind::Parabola => {
                let (first, second) = turned(p[3]);
                let u = from.dot(&first);
                (from.dot(&second) - p[2] * u * u, second - first * (2.0 * p[2] * u))
            }
            _ => (from.norm() - p[2], from.normalize()),
        }
    }

    /// The circle near all touched places (Kåsa 1976); none where they are on a line.
    fn circle(&self) -> Option<(Vector2<f64>, f64)> {
        let middle = self.touched().map(|place| place.at).sum::<Vector2<f64>>() / self.touched().count() as f64;
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for place in self.touched() {
            let at = place.at - middle;
            let row = Vector3::new(2.0 * at.x, 2.0 * at.y, 1.0);
            (matrix, right) = (matrix + row * row.transpose(), right + row * at.norm_squared());
        }
        let found = matrix.lu().solve(&right)?;
        let radius = (found.z + found.x * found.x + found.y * found.y).sqrt();
        radius.is_finite().then_some((middle + found.xy(), radius))
    }

    /// The parabola near all touched places whose axis is across their chord, to the solid.
    fn parabola(&self) -> Option<DVector<f64>> {
        let (first, last) = (self.touched().next()?.at, self.touched().next_back()?.at);
        let along = (last - first).try_normalize(1e-12)?;
        let inwards = Vector2::new(-along.y, along.x);
        let (mut matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for place in self.touched() {
            let (u, v) = ((place.at - first).dot(&along), (place.at - first).dot(&inwards));
            let row = Vector3::new(1.0, u, u * u);
            (matrix, right) = (matrix + row * row.transpose(), right + row * v);
        }
        let found = matrix.lu().solve(&right)?;
        let u = -found.y / (2.0 * found.z);
        let vertex = first + along * u + inwards * (found.x + found.y * u + found.z * u * u);
        let rotation = along.y.atan2(along.x);
        let start = DVector::from_vec(vec![vertex.x, vertex.y, found.z, rotation]);
        start.iter().all(|value| value.is_finite()).then_some(start)
    }

    /// The largest distance of two touched places.
    pub fn extent(&self) -> f64 {
        let pairs =
            self.touched().enumerate().flat_map(|(k, one)| self.touched().skip(k + 1).map(move |other| (one, other)));
        pairs.map(|(one, other)| (one.at - other.at).norm()).fold(0.0, f64::max)
    }

    /// Whether what is touched bends as an outline that is convex does: the solid is on the left.
    fn is_convex(&self) -> bool {
        let touched: Vec<&Place> = self.touched().collect();
        let last = touched.len() - 1;
        let [from, middle, to] = [0, last / 2, last].map(|k| touched[k].at);
        (middle - from).perp(&(to - middle)) > 0.0
    }
}

/// A rotation that says the same, from -90 to 90 degrees for an ellipse, of which the first radius is the larger one.
pub(super) fn in_order(kind: ShapeKind, mut parameters: DVector<f64>) -> DVector<f64> {
    if kind == ShapeKind::Ellipse {
        if parameters[2] < parameters[3] {
            parameters.swap_rows(2, 3);
            parameters[4] += FRAC_PI_2;
        }
        parameters[4] -= std::f64::consts::PI * (parameters[4] / std::f64::consts::PI).round();
    }
    parameters
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(points: &[(f64, f64)]) -> Vec<Place> {
        let at = |k: usize| Vector2::new(points[k].0, points[k].1);
        let place = |k: usize| {
            let along = (at((k + 1).min(points.len() - 1)) - at(k.saturating_sub(1))).normalize();
            let normal = Vector2::new(-along.y, along.x);
            Place { at: at(k), ways: vec![normal], normal, is_vertex: false, is_touched: true }
        };
        (0..points.len()).map(place).collect()
    }

    #[test]
    fn places_of_a_shape_are_on_it() {
        let circle: Vec<_> = (0..9)
            .map(|k| (-2.2 + 0.2 * f64::from(k)).sin_cos())
            .map(|(s, c)| (0.4 + 0.3 * c, 0.1 + 0.3 * s))
            .collect();
        let parabola: Vec<_> = (-4..5).map(|k| 0.05 * f64::from(k)).map(|u| (u, 0.2 + 3.0 * u * u)).collect();
        for (kind, points, expected) in
            [(ShapeKind::Arc, &circle, vec![0.4, 0.1, 0.3]), (ShapeKind::Parabola, &parabola, vec![0.0, 0.2, 3.0, 0.0])]
        {
            let places = places(points);
            let family = Family::of(kind, &places).unwrap();
            let start = &family.starts()[0];
            assert!((start - DVector::from_vec(expected)).amax() < 1e-9, "{kind}: {start}");
            assert!(family.offsets(start).unwrap().iter().all(|offset| offset.abs() < 1e-9), "{kind}");
            assert!(family.is_shape(start), "{kind}");
        }
    }

    #[test]
    fn edges_go_through_their_corners() {
        let mut places = places(&[(0.0, 0.01), (0.1, 0.0), (0.2, 0.0), (0.3, 0.0), (0.4, 0.2), (0.5, 0.4), (0.6, 0.5)]);
        (places[3].is_vertex, places[3].ways) = (true, vec![Vector2::x(), Vector2::y()]);
        (places[0].is_touched, places[6].is_touched) = (false, false);
        let family = Family::of(ShapeKind::Polygon, &places).unwrap();
        assert_eq!(family.corners, [1, 3, 5]);
        let start = family.starts().pop().unwrap();
        let moved = family.offsets(&start).unwrap();
        // of the ends, which are not touched, too: they come to lie on the edges
        let at = |k: usize, first: usize| places[k].at + places[k].ways[0] * moved[first];
        assert!(at(0, 0).y.abs() < 1e-15 && moved[1..7].iter().all(|offset| offset.abs() < 1e-15), "{moved:?}");
        assert!((at(6, 7).y - 2.0 * (at(6, 7).x - 0.3)).abs() < 1e-15, "{moved:?}");
        let simpler: Vec<_> = family.simpler().map(|family| family.corners).collect();
        assert_eq!(simpler, [vec![1, 5]]);
    }

    #[test]
    fn no_touched_place_is_left_beside_a_line() {
        let places = places(&[(0.0, 0.0), (0.1, 0.25), (0.2, 0.3), (0.3, 0.25), (0.4, 0.0)]);
        let family = Family::of(ShapeKind::Line, &places).unwrap();
        let moved = family.offsets(&family.starts()[0]).unwrap();
        assert!((moved[2].abs() - 0.3).abs() < 1e-12, "{moved:?}");
    }

    #[test]
    fn a_hollow_is_no_disc() {
        let hollow: Vec<_> =
            (0..9).map(|k| (2.2 - 0.2 * f64::from(k)).sin_cos()).map(|(s, c)| (0.3 * c, 0.3 * s)).collect();
        let places = places(&hollow);
        let family = Family::of(ShapeKind::Arc, &places).unwrap();
        assert!(!family.is_shape(&family.starts()[0]));
    }

    #[test]
    fn the_larger_radius_is_the_first() {
        let turned = in_order(ShapeKind::Ellipse, DVector::from_vec(vec![0.0, 0.0, 1.0, 2.0, 0.3]));
        assert_eq!([turned[2], turned[3]], [2.0, 1.0]);
        assert!((turned[4] - (0.3 + FRAC_PI_2 - std::f64::consts::PI)).abs() < 1e-15);
    }
}
