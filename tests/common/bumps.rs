//! Upward parabolas in a row, the solid above the lower of neighbours, by elementary means: crossings from the quadratic
//! formula, distances by sampling.

use super::golden::golden;
use vibrissa::contour::ContourError;
use vibrissa::{Composite, Parabola};

/// y = `y` + `coefficient` (x - `x`)^2
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bump {
    pub x: f64,
    pub y: f64,
    pub coefficient: f64,
}

impl Bump {
    pub fn height(&self, x: f64) -> f64 {
        self.y + self.coefficient * (x - self.x).powi(2)
    }

    pub fn slope(&self, x: f64) -> f64 {
        2.0 * self.coefficient * (x - self.x)
    }

    /// First x beyond `from` where this one, outside the solid of `next` before, enters it.
    fn enters(&self, next: &Self, from: f64) -> Option<f64> {
        let (c, d, w) = (self.coefficient, next.coefficient, next.x - self.x);
        // height over that of the next one: a u^2 + 2 b u + k, u = x - self.x
        let (a, b, k) = (c - d, d * w, self.y - next.y - d * w * w);
        let mut roots = Vec::new();
        if a.abs() < 1e-14 * (c.abs() + d.abs()) {
            roots.push(-0.5 * k / b);
        } else {
            let root = (b * b - a * k).sqrt();
            let q = -(b + root.copysign(b));
            roots.extend([q / a, k / q]);
        }
        let enters = |u: &f64| a * u + b > 0.0 && u + self.x > from;
        roots.into_iter().filter(enters).map(|u| u + self.x).min_by(f64::total_cmp)
    }
}

/// Bumps from left to right, each up to where it enters the next one's solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Bumps {
    pub pieces: Vec<Bump>,
    /// x where one piece gives way to the next.
    pub breaks: Vec<f64>,
}

impl Bumps {
    /// From (x, y, coefficient) of each; none where neighbours do not cross in order.
    pub fn new(pieces: &[(f64, f64, f64)]) -> Option<Self> {
        let pieces: Vec<_> = pieces.iter().map(|&(x, y, coefficient)| Bump { x, y, coefficient }).collect();
        let mut breaks = Vec::new();
        for pair in pieces.windows(2) {
            let from = breaks.last().copied().unwrap_or(f64::NEG_INFINITY);
            breaks.push(pair[0].enters(&pair[1], from)?);
        }
        Some(Self { pieces, breaks })
    }

    pub fn contour(&self) -> Result<Composite, ContourError> {
        let mut pieces: Vec<Box<dyn vibrissa::Contour>> = Vec::new();
        for b in &self.pieces {
            pieces.push(Box::new(Parabola::new([b.x, b.y], b.coefficient)?));
        }
        Composite::joined(pieces)
    }

    pub fn scaled(&self, scale: f64) -> Self {
        let bump = |b: &Bump| Bump { x: b.x * scale, y: b.y * scale, coefficient: b.coefficient / scale };
        Self { pieces: self.pieces.iter().map(bump).collect(), breaks: self.breaks.iter().map(|x| x * scale).collect() }
    }

    pub fn mirrored(&self) -> Self {
        let bump = |b: &Bump| Bump { x: -b.x, ..*b };
        Self {
            pieces: self.pieces.iter().rev().map(bump).collect(),
            breaks: self.breaks.iter().rev().map(|x| -x).collect(),
        }
    }

    /// Lowest height of the solid over the vertices.
    pub fn lowest(&self) -> f64 {
        self.pieces.iter().map(|b| b.y).fold(f64::INFINITY, f64::min)
    }

    /// Height of the solid's lower side at `x`.
    pub fn height(&self, x: f64) -> f64 {
        self.pieces[self.breaks.partition_point(|b| *b <= x)].height(x)
    }

    /// Signed distance of a point by brute force, positive outside: over-estimated in size, if anything.
    pub fn gap(&self, x: f64, y: f64) -> f64 {
        const CELLS: usize = 64;
        let above = self.height(x) - y;
        // the nearest point is no farther than the one straight above or below
        let reach = above.abs();
        let distance = |t: f64| (t - x).hypot(self.height(t) - y);
        let at = |i: usize| x + reach * (2.0 * i as f64 / CELLS as f64 - 1.0);
        let best = (0..=CELLS).min_by(|i, j| distance(at(*i)).total_cmp(&distance(at(*j)))).unwrap_or(0);
        let t = golden(at(best.saturating_sub(1)), at((best + 1).min(CELLS)), distance);
        distance(t).min(distance(at(best))).copysign(above)
    }
}
