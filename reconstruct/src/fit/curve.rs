//! The contour of a fit: a cubic spline whose points move along the normals of the start.

use nalgebra::{DMatrix, DVector, Vector2};
use rod_contours::{Composite, Contour, Frame, Spline, SplineEnd};
use rod_core::SupportRate;

/// A free-form contour, m. Its unknowns are the distances by which its points lie off those of the start.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    base: Vec<Vector2<f64>>,
    normals: Vec<Vector2<f64>>,
    pub offsets: DVector<f64>,
    spline: Spline,
    /// Column j: second derivatives at all knots of the natural spline that is 1 at knot j and 0 at the others.
    second: DMatrix<f64>,
    knots: Vec<f64>,
}

impl Curve {
    /// Through points, in the direction of contours.
    pub fn through(base: Vec<Vector2<f64>>) -> Option<Self> {
        let n = base.len();
        if n < 3 {
            return None;
        }
        let normals = (0..n)
            .map(|i| {
                let along = base[(i + 1).min(n - 1)] - base[i.saturating_sub(1)];
                Vector2::new(-along.y, along.x).normalize()
            })
            .collect();
        Self::of(base, normals, DVector::zeros(n))
    }

    fn of(base: Vec<Vector2<f64>>, normals: Vec<Vector2<f64>>, offsets: DVector<f64>) -> Option<Self> {
        let points: Vec<[f64; 2]> =
            base.iter().zip(&normals).zip(offsets.iter()).map(|((p, n), d)| (p + n * *d).into()).collect();
        let spline = Spline::through(&points, SplineEnd::Natural).ok()?;
        let knots: Vec<f64> = spline.knots().collect();
        let second = second_derivatives(&knots);
        Some(Self { base, normals, offsets, spline, second, knots })
    }

    /// With other offsets of its points along their normals.
    pub fn moved(&self, offsets: DVector<f64>) -> Option<Self> {
        Self::of(self.base.clone(), self.normals.clone(), offsets)
    }

    pub fn count(&self) -> usize {
        self.base.len()
    }

    /// The same curve with each interval cut in two.
    pub fn refined(&self) -> Option<Self> {
        let mut points = Vec::new();
        for pair in self.knots.windows(2) {
            for t in [pair[0], 0.5 * (pair[0] + pair[1])] {
                let frame = self.spline.frame(t);
                points.push(Vector2::new(frame.x, frame.y));
            }
        }
        let last = self.spline.frame(*self.knots.last()?);
        points.push(Vector2::new(last.x, last.y));
        Self::through(points)
    }

    pub fn composite(&self) -> Option<Composite> {
        Composite::single(self.spline.clone()).ok()
    }

    /// The frame at the point closest to (x, y).
    pub fn frame_near(&self, x: f64, y: f64) -> Frame {
        self.spline.frame(self.spline.closest(x, y).t)
    }

    /// The points.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.spline.points()
    }

    /// [`rates`](Self::rates) at the point closest to (x, y).
    pub fn rates_near(&self, x: f64, y: f64) -> Vec<SupportRate> {
        self.rates(self.spline.closest(x, y).t)
    }

    /// The values, first and second derivatives of all cardinal splines at `t`.
    fn cardinal(&self, t: f64) -> [DVector<f64>; 3] {
        let n = self.knots.len();
        let j = self.knots.partition_point(|k| *k <= t).clamp(1, n - 1) - 1;
        let h = self.knots[j + 1] - self.knots[j];
        let b = (t - self.knots[j]) / h;
        let a = 1.0 - b;
        let (lower, upper) = (self.second.row(j).transpose(), self.second.row(j + 1).transpose());
        let mut value = &lower * ((a * a * a - a) * h * h / 6.0) + &upper * ((b * b * b - b) * h * h / 6.0);
        value[j] += a;
        value[j + 1] += b;
        let mut first = &upper * ((3.0 * b * b - 1.0) * h / 6.0) - &lower * ((3.0 * a * a - 1.0) * h / 6.0);
        first[j] -= 1.0 / h;
        first[j + 1] += 1.0 / h;
        [value, first, lower * a + upper * b]
    }

    /// How point and tangent at `t` change with each offset.
    fn rates(&self, t: f64) -> Vec<SupportRate> {
        let [value, first, _] = self.cardinal(t);
        let tangent = self.tangent(&first);
        let speed = tangent.norm();
        let rate = |i: usize| {
            let n = self.normals[i];
            let across = (tangent.x * n.y - tangent.y * n.x) / speed;
            SupportRate { x: n.x * value[i], y: n.y * value[i], alpha: across * first[i] / speed }
        };
        (0..self.count()).map(rate).collect()
    }

    fn tangent(&self, by: &DVector<f64>) -> Vector2<f64> {
        (0..self.count())
            .fold(Vector2::zeros(), |sum, i| sum + (self.base[i] + self.normals[i] * self.offsets[i]) * by[i])
    }

    /// Change of the curvature from each knot to the next over the root of their distance, and its derivatives by the offsets.
    pub fn bends(&self) -> Vec<(f64, DVector<f64>)> {
        let n = self.count();
        let at: Vec<(f64, DVector<f64>)> = self
            .knots
            .iter()
            .map(|t| {
                let [_, first, second] = self.cardinal(*t);
                let (p, q) = (self.tangent(&first), self.tangent(&second));
                let speed = p.norm();
                let cross = p.x * q.y - p.y * q.x;
                let kappa = cross / speed.powi(3);
                let rates = DVector::from_fn(n, |i, _| {
                    let nn = self.normals[i];
                    let (dp, dq) = (nn * first[i], nn * second[i]);
                    (dp.x * q.y - dp.y * q.x + p.x * dq.y - p.y * dq.x) / speed.powi(3)
                        - 3.0 * kappa * p.dot(&dp) / (speed * speed)
                });
                (kappa, rates)
            })
            .collect();
        (0..n - 1)
            .map(|i| {
                let root = (self.knots[i + 1] - self.knots[i]).sqrt();
                ((at[i + 1].0 - at[i].0) / root, (&at[i + 1].1 - &at[i].1) / root)
            })
            .collect()
    }
}

/// The second derivatives at the knots of the natural cubic splines that are 1 at one knot and 0 at the others, a column each.
fn second_derivatives(knots: &[f64]) -> DMatrix<f64> {
    let n = knots.len();
    let h: Vec<f64> = knots.windows(2).map(|k| k[1] - k[0]).collect();
    let (mut matrix, mut right) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
    for i in 1..n - 1 {
        matrix[(i, i - 1)] = h[i - 1] / 6.0;
        matrix[(i, i)] = (h[i - 1] + h[i]) / 3.0;
        matrix[(i, i + 1)] = h[i] / 6.0;
        right[(i, i - 1)] = 1.0 / h[i - 1];
        right[(i, i)] = -1.0 / h[i - 1] - 1.0 / h[i];
        right[(i, i + 1)] = 1.0 / h[i];
    }
    matrix.lu().solve(&right).unwrap_or(right)
}
