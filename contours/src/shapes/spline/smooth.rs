//! The smoothest spline that passes noisy points as closely as they are known.

use super::fit::{interpolant, knots};
use super::{Spline, SplineEnd};
use crate::point::{dot, minus, plus};
use crate::{ContourError, Point, Vector, check};

/// Weight of the bending beside the rest, relative, below which rounding begins to spoil the system: the curve then is
/// smooth over a thousand points or so.
const LIGHTEST: f64 = 1e-13;

/// Largest relative excess of the residual sum.
const ACCURACY: f64 = 1e-12;

/// Steps after which Newton's iteration for the multiplier gives up; it takes 5 to 30.
const STEPS: usize = 200;

impl Spline {
    /// The smoothest spline near points with noise of standard deviation `sigma` (a length) in each coordinate.
    ///
    /// Of all curves `r` with `sum |r(t_i) - p_i|^2 <= 2 n sigma^2` it has the least `integral |r''|^2 dt`, `t_i` being
    /// the length of the polygon up to the point `p_i` (Reinsch 1967, Numer. Math. 10, 177). With `sigma` 0 it is the
    /// natural spline through the points; with a large one it is the straight line of least squares. The work is linear in
    /// the number of points.
    ///
    /// Noise beyond the distance of the points makes the polygon longer than the curve and the `t_i` uncertain: thin out
    /// such points first.
    ///
    /// # Errors
    ///
    /// A `sigma` that is not finite ([`ContourError::NotFinite`]) or negative ([`ContourError::Negative`]), and those of
    /// [`Spline::through`].
    ///
    /// ```
    /// use rod_contours::{Contour, Spline};
    ///
    /// let noisy = [[0.0, 0.01], [1.0, -0.01], [2.0, 0.01], [3.0, -0.01], [4.0, 0.01]];
    /// let floor = Spline::smoothing(&noisy, 0.01)?;
    /// assert!(floor.frame(2.0).alpha.abs() < 1e-9 && (floor.gap(2.0, -1.0) - 1.0).abs() < 0.01);
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn smoothing(points: &[Point], sigma: f64) -> Result<Self, ContourError> {
        let what = "the noise of the spline's points";
        check::finite([(what, sigma)])?;
        if sigma < 0.0 {
            return Err(ContourError::Negative { what, value: sigma });
        }
        let knots = knots(points)?;
        let allowed = 2.0 * points.len() as f64 * sigma * sigma;
        let fitted = fitted(&knots, points, allowed);
        Self::from_keys(interpolant(&knots, &fitted, SplineEnd::Natural))
    }
}

/// The points at the knots through which the smoothest curve with this residual sum passes.
fn fitted(knots: &[f64], points: &[Point], allowed: f64) -> Vec<Point> {
    if allowed == 0.0 || points.len() < 3 {
        return points.to_vec();
    }
    let line = line(knots, points);
    let residual: f64 = line.iter().zip(points).map(|(&a, &b)| dot(minus(a, b), minus(a, b))).sum();
    if residual <= allowed {
        return line;
    }
    let system = System::new(knots, points);
    let mut weight = LIGHTEST * system.balance();
    let mut best = None;
    for _ in 0..STEPS {
        let Some(factors) = system.factored(weight) else {
            // Rounding won: smooth over fewer points.
            weight *= 10.0;
            continue;
        };
        let tensions = factors.solve(system.right.clone());
        let residuals = system.spread(&tensions);
        let square: f64 = residuals.iter().map(|&residual| dot(residual, residual)).sum();
        // One over the root of the residual sum is a concave function of the weight, so that Newton's iteration for it
        // rises to the solution from below.
        let change = system.spread(&factors.solve(system.stiffness(&tensions)));
        let rate: f64 = residuals.iter().zip(&change).map(|(&a, &b)| dot(a, b)).sum();
        let next = weight + square * ((square / allowed).sqrt() - 1.0) / rate;
        best = Some(residuals);
        if square <= allowed * (1.0 + ACCURACY) || !next.is_finite() || next <= weight {
            break;
        }
        weight = next;
    }
    let Some(residuals) = best else { return points.to_vec() };
    points.iter().zip(residuals).map(|(&point, residual)| minus(point, residual)).collect()
}

/// The points of the straight line of least squares at the knots.
fn line(knots: &[f64], points: &[Point]) -> Vec<Point> {
    let count = points.len() as f64;
    let middle = knots.iter().sum::<f64>() / count;
    let centre = points.iter().fold([0.0; 2], |sum, &point| plus(sum, 1.0 / count, point));
    let (mut square, mut product) = (0.0, [0.0; 2]);
    for (&t, &point) in knots.iter().zip(points) {
        square += (t - middle) * (t - middle);
        product = plus(product, t - middle, minus(point, centre));
    }
    knots.iter().map(|&t| plus(centre, (t - middle) / square, product)).collect()
}

/// The banded matrices of the problem, in Reinsch's notation: `q'` takes the change of slope at each inner point, `r`
/// (his T) is the stiffness, and the tensions `u` solve `(q' q + weight r) u = q' y`. The residuals are `q u`.
struct System {
    /// One over the distance between knots.
    slope: Vec<f64>,
    /// Distance between knots.
    width: Vec<f64>,
    /// `q' y`.
    right: Vec<Vector>,
}

/// A symmetric matrix with two diagonals beside the main one as the product of triangles.
struct Factors {
    rows: Vec<Pivot>,
}

struct Pivot {
    pivot: f64,
    below: f64,
    second: f64,
}

impl System {
    fn new(knots: &[f64], points: &[Point]) -> Self {
        let width: Vec<_> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let slope: Vec<_> = width.iter().map(|width| 1.0 / width).collect();
        let chord = |k: usize| minus(points[k + 1], points[k]).map(|side| side * slope[k]);
        let right = (1..points.len() - 1).map(|k| minus(chord(k), chord(k - 1))).collect();
        Self { slope, width, right }
    }

    /// Diagonals of `q' q` at an inner point: its own entry and those with the next two.
    fn square(&self, k: usize) -> [f64; 3] {
        let slope = |k: usize| self.slope.get(k).copied().unwrap_or(0.0);
        let [a, b, c] = [slope(k), slope(k + 1), slope(k + 2)];
        [a * a + (a + b) * (a + b) + b * b, -b * (a + b) - b * (b + c), b * c]
    }

    /// Diagonals of `r` at an inner point.
    fn bending(&self, k: usize) -> Vector {
        [(self.width[k] + self.width[k + 1]) / 3.0, self.width[k + 1] / 6.0]
    }

    /// The weight at which the two matrices are alike where the points are farthest apart.
    fn balance(&self) -> f64 {
        (0..self.right.len()).map(|k| self.square(k)[0] / self.bending(k)[0]).fold(f64::INFINITY, f64::min)
    }

    /// `q' q + weight r`, none where rounding leaves it without a positive pivot.
    fn factored(&self, weight: f64) -> Option<Factors> {
        let mut rows: Vec<Pivot> = Vec::with_capacity(self.right.len());
        for k in 0..self.right.len() {
            let ([own, next, second], [stiff, stiff_next]) = (self.square(k), self.bending(k));
            let (mut pivot, mut below) = (own + weight * stiff, next + weight * stiff_next);
            if let Some(before) = k.checked_sub(1).map(|k| &rows[k]) {
                pivot -= before.below * before.below * before.pivot;
                below -= before.below * before.second * before.pivot;
            }
            if let Some(before) = k.checked_sub(2).map(|k| &rows[k]) {
                pivot -= before.second * before.second * before.pivot;
            }
            if pivot <= 0.0 || pivot.is_nan() {
                return None;
            }
            rows.push(Pivot { pivot, below: below / pivot, second: second / pivot });
        }
        Some(Factors { rows })
    }

    /// `q u`.
    fn spread(&self, tensions: &[Vector]) -> Vec<Vector> {
        let tension = |k: Option<usize>| k.and_then(|k| tensions.get(k)).copied().unwrap_or([0.0; 2]);
        // The change of tension per length, before and after each point.
        let slope = |k: Option<usize>| {
            let Some(k) = k.filter(|&k| k < self.slope.len()) else { return [0.0; 2] };
            minus(tension(Some(k)), tension(k.checked_sub(1))).map(|side| side * self.slope[k])
        };
        (0..=self.slope.len()).map(|k| minus(slope(Some(k)), slope(k.checked_sub(1)))).collect()
    }

    /// `r u`.
    fn stiffness(&self, tensions: &[Vector]) -> Vec<Vector> {
        let mut product: Vec<_> =
            tensions.iter().enumerate().map(|(k, tension)| tension.map(|side| side * self.bending(k)[0])).collect();
        for k in 1..tensions.len() {
            let beside = self.bending(k - 1)[1];
            product[k] = plus(product[k], beside, tensions[k - 1]);
            product[k - 1] = plus(product[k - 1], beside, tensions[k]);
        }
        product
    }
}

impl Factors {
    fn solve(&self, mut right: Vec<Vector>) -> Vec<Vector> {
        let rows = &self.rows;
        for k in 1..right.len() {
            right[k] = plus(right[k], -rows[k - 1].below, right[k - 1]);
            if k > 1 {
                right[k] = plus(right[k], -rows[k - 2].second, right[k - 2]);
            }
        }
        for k in (0..right.len()).rev() {
            right[k] = right[k].map(|side| side / rows[k].pivot);
            for (ahead, factor) in [(1, rows[k].below), (2, rows[k].second)] {
                if let Some(&later) = right.get(k + ahead) {
                    right[k] = plus(right[k], -factor, later);
                }
            }
        }
        right
    }
}
