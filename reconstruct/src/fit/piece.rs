//! A smooth piece of the contour of a fit: a natural cubic spline and what changes with its points.

use nalgebra::{DMatrix, Vector2};
use rod_contours::{Closest, Contour, ContourError, Frame, Line, Spline, SplineEnd};
use std::cell::OnceCell;

/// A natural spline through the nodes of a curve from `first` on.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Number of its object, and its own number in it.
    pub object: usize,
    pub number: usize,
    /// Its first node.
    pub first: usize,
    pub spline: Spline,
    points: Vec<Vector2<f64>>,
    knots: Vec<f64>,
    /// Row j: second derivatives at all knots of the natural spline that is 1 at knot j and 0 at the others; not before it is asked for.
    second: OnceCell<DMatrix<f64>>,
}

/// How a place of a piece changes with the coordinates of one of its nodes: the point in proportion to `value`, its derivatives by the
/// parameter in proportion to the others.
pub(super) struct Cardinal {
    pub node: usize,
    pub value: f64,
    pub first: f64,
    pub second: f64,
}

impl Piece {
    pub fn through(points: &[Vector2<f64>], first: usize, object: usize, number: usize) -> Result<Self, ContourError> {
        let coordinates: Vec<[f64; 2]> = points.iter().map(|point| (*point).into()).collect();
        let spline = Spline::through(&coordinates, SplineEnd::Natural)?;
        let knots: Vec<f64> = spline.knots().collect();
        let second = OnceCell::new();
        Ok(Self { object, number, first, spline, points: points.to_vec(), knots, second })
    }

    /// The piece as a contour.
    pub fn contour(&self) -> Result<Box<dyn Contour>, ContourError> {
        Ok(match self.points[..] {
            // exactly straight: a rod may lie along it
            [from, to] => Box::new(Line::new(from.into(), to.into())?),
            _ => Box::new(self.spline.clone()),
        })
    }

    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    pub fn points(&self) -> &[Vector2<f64>] {
        &self.points
    }

    pub fn start(&self) -> Frame {
        self.spline.frame(self.knots[0])
    }

    pub fn end(&self) -> Frame {
        self.spline.frame(self.knots[self.knots.len() - 1])
    }

    /// The point closest to (x, y).
    pub fn closest(&self, x: f64, y: f64) -> Closest {
        self.spline.closest(x, y)
    }

    /// What each node does at `t`.
    pub fn cardinals(&self, t: f64) -> impl Iterator<Item = Cardinal> {
        let n = self.knots.len();
        let j = self.knots.partition_point(|k| *k <= t).clamp(1, n - 1) - 1;
        let h = self.knots[j + 1] - self.knots[j];
        let b = (t - self.knots[j]) / h;
        let a = 1.0 - b;
        let second = self.second.get_or_init(|| second_derivatives(&self.knots));
        (0..n).map(move |i| {
            let (lower, upper) = (second[(i, j)], second[(i, j + 1)]);
            let [here, next] = [f64::from(u8::from(i == j)), f64::from(u8::from(i == j + 1))];
            Cardinal {
                node: self.first + i,
                value: a * here + b * next + (lower * (a * a * a - a) + upper * (b * b * b - b)) * h * h / 6.0,
                first: (next - here) / h + (upper * (3.0 * b * b - 1.0) - lower * (3.0 * a * a - 1.0)) * h / 6.0,
                second: lower * a + upper * b,
            }
        })
    }

    /// First and second derivative of the point by the parameter.
    pub fn derivatives(&self, t: f64) -> (Vector2<f64>, Vector2<f64>) {
        self.cardinals(t).fold((Vector2::zeros(), Vector2::zeros()), |(first, second), at| {
            let point = self.points[at.node - self.first];
            (first + point * at.first, second + point * at.second)
        })
    }
}

/// The second derivatives at the knots of the natural cubic splines that are 1 at one knot and 0 at the others: a row for each, by elimination in
/// its tridiagonal equations.
fn second_derivatives(knots: &[f64]) -> DMatrix<f64> {
    let n = knots.len();
    let h: Vec<f64> = knots.windows(2).map(|k| k[1] - k[0]).collect();
    let mut second = DMatrix::zeros(n, n);
    let mut pivot = vec![1.0; n];
    for i in 1..n - 1 {
        second[(i - 1, i)] = 1.0 / h[i - 1];
        second[(i, i)] = -1.0 / h[i - 1] - 1.0 / h[i];
        second[(i + 1, i)] = 1.0 / h[i];
        // the first equation has no other unknown
        let (below, above) = (h[i - 1] / 6.0, if i > 1 { h[i - 1] / 6.0 } else { 0.0 });
        let factor = below / pivot[i - 1];
        pivot[i] = (h[i - 1] + h[i]) / 3.0 - factor * above;
        let (before, mut rest) = second.columns_range_pair_mut(i - 1, i..);
        rest.column_mut(0).axpy(-factor, &before, 1.0);
    }
    for i in (1..n - 1).rev() {
        let (mut here, after) = second.columns_range_pair_mut(i, i + 1);
        here.axpy(-h[i] / 6.0, &after, 1.0);
        here /= pivot[i];
    }
    second
}
