//! A rod at rest whose curvature is a sum of Legendre polynomials, with its rates by their coefficients.

use crate::numeric::legendre;

/// Cells in which position is integrated: by Simpson's rule, errors of 1e-12 for curvatures of a few turns.
const CELLS: usize = 256;

/// The rod at rest, from its base at the origin along x.
pub(super) struct Curve<'a> {
    coefficients: &'a [f64],
    /// At the ends of all cells.
    nodes: Vec<Spot>,
}

/// Where it is at an arc length, and how that changes with the coefficients.
#[derive(Clone)]
pub(super) struct Spot {
    pub x: f64,
    pub y: f64,
    pub phi: f64,
    /// Rates of (x, y) by each coefficient.
    pub by: Vec<[f64; 2]>,
    /// Rates of phi by each coefficient.
    pub turns: Vec<f64>,
}

impl<'a> Curve<'a> {
    /// The rod whose curvature has these coefficients of P_j(2 s - 1), lengths in L.
    pub fn of(coefficients: &'a [f64]) -> Self {
        let terms = coefficients.len();
        let base = Spot { x: 0.0, y: 0.0, phi: 0.0, by: vec![[0.0; 2]; terms], turns: vec![0.0; terms] };
        let mut curve = Self { coefficients, nodes: vec![base] };
        for k in 0..CELLS {
            let next = curve.beyond(k, 1.0 / CELLS as f64);
            curve.nodes.push(next);
        }
        curve
    }

    /// The rod at an arc length from 0 to 1.
    pub fn at(&self, s: f64) -> Spot {
        let k = ((s * CELLS as f64) as usize).min(CELLS - 1);
        self.beyond(k, s - k as f64 / CELLS as f64)
    }

    /// The rod so far beyond a node, by Simpson's rule.
    fn beyond(&self, k: usize, h: f64) -> Spot {
        let mut spot = self.nodes[k].clone();
        for (at, weight) in [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)] {
            spot.phi = angle(self.coefficients, k as f64 / CELLS as f64 + at * h, &mut spot.turns);
            let (sin, cos) = spot.phi.sin_cos();
            (spot.x, spot.y) = (spot.x + h * weight * cos, spot.y + h * weight * sin);
            for (by, turn) in spot.by.iter_mut().zip(&spot.turns) {
                *by = [by[0] - h * weight * sin * turn, by[1] + h * weight * cos * turn];
            }
        }
        spot
    }
}

/// Angle and its rates by the coefficients at an arc length: integrals of Legendre polynomials, of which P_j is the difference of two
/// neighbours.
fn angle(coefficients: &[f64], s: f64, rates: &mut [f64]) -> f64 {
    let t = 2.0 * s - 1.0;
    let mut p = vec![0.0; coefficients.len() + 1];
    legendre::values(t, &mut p);
    for (j, rate) in rates.iter_mut().enumerate() {
        // int_-1^t P_j = (P_j+1 - P_j-1) / (2 j + 1), and t + 1 for j = 0; half of it by s
        *rate = 0.5 * if j == 0 { t + 1.0 } else { (p[j + 1] - p[j - 1]) / (2 * j + 1) as f64 };
    }
    coefficients.iter().zip(rates.iter()).map(|(c, rate)| c * rate).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_those_of_differences() {
        let c = [2.0, -1.5, 0.7, 0.3];
        let at = |c: &[f64], s: f64| Curve::of(c).at(s);
        for s in [0.0, 0.31, 0.777, 1.0] {
            let Spot { by, turns, .. } = at(&c, s);
            for j in 0..c.len() {
                let moved = |h: f64| {
                    let spot = at(&std::array::from_fn::<f64, 4, _>(|i| c[i] + if i == j { h } else { 0.0 }), s);
                    [spot.x, spot.y, spot.phi]
                };
                let (one, other) = (moved(1e-5), moved(-1e-5));
                let difference = [0, 1, 2].map(|i| (one[i] - other[i]) / 2e-5);
                for (found, exact) in difference.into_iter().zip([by[j][0], by[j][1], turns[j]]) {
                    assert!((found - exact).abs() < 1e-9, "{s} {j}: {found} {exact}");
                }
            }
        }
        // an arc of curvature 2
        let Spot { x, y, phi, .. } = at(&[2.0], 0.77);
        assert!((x - 1.54_f64.sin() / 2.0).abs() < 1e-12 && (y - (1.0 - 1.54_f64.cos()) / 2.0).abs() < 1e-12);
        assert!((phi - 1.54).abs() < 1e-14);
    }
}
