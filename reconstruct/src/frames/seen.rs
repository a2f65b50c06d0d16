//! A smooth curve through the dots: the shape that is seen, whatever forces make it.

use super::observed::{Dot, Observed};
use crate::least_squares::{Damped, NormalMatrix, Problem, iterate};
use crate::numeric::{legendre, wrap_angle};
use nalgebra::DVector;
use rod_core::{Cut, RodModel};

/// Largest number of Legendre terms of the slope angle; fewer for fewer than twice as many dots. More: closer to a kink of the
/// curvature, less close to a straight line in noise.
const MOST_TERMS: usize = 9;
/// Cells in which the position is integrated, by Simpson's rule: with cubic Hermite polynomials in between, errors of 1e-7 L for half a turn.
const CELLS: usize = 48;
/// Gauss-Newton steps.
const STEPS: usize = 5;
/// How far (L) a foot point may go beyond the ends of the curve.
const BEYOND: f64 = 0.05;
/// Number of dots by which arc lengths are measured at first, so that noise does not add to them.
const FEW_CHORDS: usize = 20;

/// A curve of unit speed whose slope angle is a sum of Legendre polynomials of the arc length.
pub(super) struct Seen {
    /// Arc lengths of its ends, L.
    ends: (f64, f64),
    coefficients: Vec<f64>,
    /// At the ends of the cells.
    nodes: Vec<[f64; 2]>,
    /// Arc lengths of the dots, L.
    pub feet: Vec<f64>,
}

impl Seen {
    /// The curve through at least two dots. The known end of the rod has its arc length; the rest of the rod is unseen.
    pub fn new(observed: &Observed) -> Self {
        let dots = &observed.dots;
        let along = arc_lengths(dots);
        let total = along[dots.len() - 1];
        let shift = match observed.ends {
            [true, _] => 0.0,
            [false, true] => 1.0 - total,
            [false, false] => 0.5 * (1.0 - total),
        };
        let feet: Vec<f64> = along.into_iter().map(|foot| foot + shift).collect();
        let terms = (dots.len() / 2).clamp(1, MOST_TERMS);
        let ends = (feet[0], feet[dots.len() - 1]);
        // the end whose arc length is known stays where it is
        let held = if observed.ends == [false, true] { dots.len() - 1 } else { 0 };
        let mut fit = Fit { dots, feet, ends, held, terms };
        let start = fit.start();
        let (at, _) = iterate(&mut fit, start, Damped::lightly(), STEPS);
        let (x, coefficients) = (&at.x, at.x.as_slice()[2..].to_vec());
        let nodes = (0..=CELLS).scan(Walk::new([x[0], x[1]], ends, &coefficients), |walk, k| {
            if k > 0 {
                walk.step(k, &coefficients);
            }
            Some(walk.at)
        });
        Self { nodes: nodes.collect(), ends, feet: fit.feet, coefficients }
    }

    /// Position and direction at an arc length; beyond its ends as the rod at rest goes on.
    pub fn at<M: RodModel>(&self, model: &M, s: f64) -> Cut {
        let (from, to) = self.ends;
        let inside = s.clamp(from.clamp(0.0, 1.0), to.clamp(0.0, 1.0));
        let h = (to - from) / CELLS as f64;
        let angle = |s: f64| slope(&self.coefficients, place(self.ends, s), &mut [0.0; MOST_TERMS]);
        let k = (((inside - from) / h) as usize).min(CELLS - 1);
        let (left, right) = (from + h * k as f64, from + h * (k + 1) as f64);
        let (begin, end) = (angle(left).sin_cos(), angle(right).sin_cos());
        let t = (inside - left) / h;
        let x = hermite(t, [self.nodes[k][0], self.nodes[k + 1][0]], [h * begin.1, h * end.1]);
        let y = hermite(t, [self.nodes[k][1], self.nodes[k + 1][1]], [h * begin.0, h * end.0]);
        let cut = Cut { x, y, phi: angle(inside), moment: 0.0 };
        if s == inside { cut } else { model.carry(inside, &cut, 0.0, 0.0, s - inside) }
    }
}

/// The cubic polynomial at `t` from 0 to 1 by its values and slopes there.
pub(super) fn hermite(t: f64, [v0, v1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    let u = 1.0 - t;
    u * u * ((1.0 + 2.0 * t) * v0 + t * d0) + t * t * ((1.0 + 2.0 * u) * v1 - u * d1)
}

/// Arc lengths of the dots by chords between a few of them.
fn arc_lengths(dots: &[Dot]) -> Vec<f64> {
    let (last, stride) = (dots.len() - 1, dots.len().div_ceil(FEW_CHORDS));
    let mut along = vec![0.0; dots.len()];
    let mut from = 0;
    while from < last {
        let to = (from + stride).min(last);
        let [x, y] = [0, 1].map(|c| dots[to].at[c] - dots[from].at[c]);
        let chord = x.hypot(y);
        for k in from + 1..=to {
            let [dx, dy] = [0, 1].map(|c| dots[k].at[c] - dots[from].at[c]);
            along[k] = along[from] + ((dx * x + dy * y) / chord.max(f64::MIN_POSITIVE)).clamp(0.0, chord);
        }
        from = to;
    }
    along
}

/// The argument of the Legendre polynomials at an arc length.
fn place((from, to): (f64, f64), s: f64) -> f64 {
    2.0 * (s - from) / (to - from).max(f64::MIN_POSITIVE) - 1.0
}

/// The slope angle, and the values of the polynomials.
fn slope(coefficients: &[f64], t: f64, values: &mut [f64; MOST_TERMS]) -> f64 {
    legendre::values(t, &mut values[..coefficients.len()]);
    coefficients.iter().zip(values).map(|(c, p)| c * *p).sum()
}

/// Position along the curve with its rates by the coefficients, from cell to cell.
#[derive(Clone)]
struct Walk {
    ends: (f64, f64),
    at: [f64; 2],
    by: [[f64; 2]; MOST_TERMS],
    /// Sine and cosine of the angle, and the polynomials.
    sin_cos: (f64, f64),
    values: [f64; MOST_TERMS],
}

impl Walk {
    fn new(at: [f64; 2], ends: (f64, f64), coefficients: &[f64]) -> Self {
        let mut values = [0.0; MOST_TERMS];
        let sin_cos = slope(coefficients, -1.0, &mut values).sin_cos();
        Self { ends, at, by: [[0.0; 2]; MOST_TERMS], sin_cos, values }
    }

    fn add(&mut self, weight: f64) {
        let (sin, cos) = self.sin_cos;
        self.at = [self.at[0] + weight * cos, self.at[1] + weight * sin];
        for (by, value) in self.by.iter_mut().zip(&self.values) {
            *by = [by[0] - weight * sin * value, by[1] + weight * cos * value];
        }
    }

    fn turn_to(&mut self, t: f64, coefficients: &[f64]) {
        self.sin_cos = slope(coefficients, t, &mut self.values).sin_cos();
    }

    /// On to the end of cell `k`, counted from 1.
    fn step(&mut self, k: usize, coefficients: &[f64]) {
        let h = (self.ends.1 - self.ends.0) / CELLS as f64;
        let t = |part: f64| 2.0 * (k as f64 - part) / CELLS as f64 - 1.0;
        self.add(h / 6.0);
        self.turn_to(t(0.5), coefficients);
        self.add(4.0 * h / 6.0);
        self.turn_to(t(0.0), coefficients);
        self.add(h / 6.0);
    }
}

/// The least squares: unknown are the start (x, y) and the coefficients.
struct Fit<'a> {
    dots: &'a [Dot],
    feet: Vec<f64>,
    ends: (f64, f64),
    /// The dot that keeps its arc length.
    held: usize,
    terms: usize,
}

impl Fit<'_> {
    /// From the directions of the chords.
    fn start(&self) -> DVector<f64> {
        let stride = self.dots.len().div_ceil(FEW_CHORDS);
        let mut normal = NormalMatrix::empty(self.terms);
        let (mut from, mut before) = (0, None);
        while from + 1 < self.dots.len() {
            let to = (from + stride).min(self.dots.len() - 1);
            let [x, y] = [0, 1].map(|c| self.dots[to].at[c] - self.dots[from].at[c]);
            let angle = before.map_or_else(|| y.atan2(x), |before| before + wrap_angle(y.atan2(x) - before));
            let mut values = [0.0; MOST_TERMS];
            let t = place(self.ends, 0.5 * (self.feet[from] + self.feet[to]));
            legendre::values(t, &mut values[..self.terms]);
            let row: Vec<(usize, f64)> = values[..self.terms].iter().copied().enumerate().collect();
            normal.add_weighted(&row, -angle, self.feet[to] - self.feet[from]);
            (from, before) = (to, Some(angle));
        }
        // the chords alone may not tell all terms apart
        let coefficients = normal.damped_step(1e-6).unwrap_or_else(|| DVector::zeros(self.terms));
        let [x, y] = self.dots[0].at;
        DVector::from_iterator(self.terms + 2, [x, y].into_iter().chain(coefficients.iter().copied()))
    }

    /// A dot in the cell from `begin` to `end`.
    fn add(
        &mut self,
        number: usize,
        t: f64,
        (begin, end): (&Walk, &Walk),
        coefficients: &[f64],
        normal: &mut NormalMatrix,
    ) {
        let (h, s) = ((self.ends.1 - self.ends.0) / CELLS as f64, self.feet[number]);
        let of = |walk: &Walk| [h * walk.sin_cos.1, h * walk.sin_cos.0];
        let slopes = [of(begin), of(end)];
        let at: [f64; 2] = [0, 1].map(|c| hermite(t, [begin.at[c], end.at[c]], [slopes[0][c], slopes[1][c]]));
        let mut values = [0.0; MOST_TERMS];
        let (sin, cos) = slope(coefficients, place(self.ends, s), &mut values).sin_cos();
        let Dot { at: dot, sigma, .. } = self.dots[number];
        let left = [at[0] - dot[0], at[1] - dot[1]];
        let ahead = -(left[0] * cos + left[1] * sin);
        let by = |j: usize, c: usize| {
            let turned = [-1.0, 1.0][c];
            let rates = [begin, end].map(|walk| turned * h * [walk.sin_cos.0, walk.sin_cos.1][c] * walk.values[j]);
            hermite(t, [begin.by[j][c], end.by[j][c]], rates)
        };
        let mut add = |along: [f64; 2], slope: f64| {
            let terms =
                (0..coefficients.len()).map(|j| (j + 2, along[0] * by(j, 0) + along[1] * by(j, 1) + slope * values[j]));
            let row: Vec<(usize, f64)> = [(0, along[0]), (1, along[1])].into_iter().chain(terms).collect();
            normal.add(&row, along[0] * left[0] + along[1] * left[1], sigma);
        };
        if number == self.held {
            add([1.0, 0.0], 0.0);
            add([0.0, 1.0], 0.0);
        } else {
            add([-sin, cos], ahead);
            self.feet[number] = (s + ahead.clamp(-BEYOND, BEYOND)).clamp(self.ends.0 - BEYOND, self.ends.1 + BEYOND);
        }
    }
}

impl Problem for Fit<'_> {
    type Equations = NormalMatrix;

    fn equations(&mut self, x: &DVector<f64>) -> NormalMatrix {
        let coefficients = &x.as_slice()[2..];
        let mut normal = NormalMatrix::empty(x.len());
        let mut walk = Walk::new([x[0], x[1]], self.ends, coefficients);
        let mut nodes = vec![walk.clone()];
        nodes.extend((1..=CELLS).map(|k| {
            walk.step(k, coefficients);
            walk.clone()
        }));
        let h = (self.ends.1 - self.ends.0) / CELLS as f64;
        for number in 0..self.dots.len() {
            let way = (self.feet[number] - self.ends.0) / h;
            let k = (way.max(0.0) as usize).min(CELLS - 1);
            self.add(number, way - k as f64, (&nodes[k], &nodes[k + 1]), coefficients, &mut normal);
        }
        normal
    }
}
