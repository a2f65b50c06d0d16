//! What is looked for crossings with a boundary: the rod, or a straight line.

use super::vector::{Point, minus, plus};
use crate::common::rod::Rod;

/// A curve with a bound of its second derivative.
pub trait Strand {
    fn at(&self, s: f64) -> Point;
    fn bend(&self, from: f64, to: f64) -> f64;
}

/// The rod by its arc length, integrated by Taylor's series.
pub struct Elastic<'a> {
    pub rod: &'a Rod,
    /// The largest force in it: the curvature changes no faster.
    pub force: f64,
}

impl Strand for Elastic<'_> {
    fn at(&self, s: f64) -> Point {
        let at = self.rod.at(s);
        [at.x, at.y]
    }

    fn bend(&self, from: f64, to: f64) -> f64 {
        let ends = self.rod.at(from).kappa.abs().max(self.rod.at(to).kappa.abs());
        ends + 0.5 * (to - from) * self.force
    }
}

/// A straight way.
pub struct Straight {
    pub from: Point,
    pub to: Point,
}

impl Strand for Straight {
    fn at(&self, s: f64) -> Point {
        plus(self.from, s, minus(self.to, self.from))
    }

    fn bend(&self, _: f64, _: f64) -> f64 {
        0.0
    }
}
