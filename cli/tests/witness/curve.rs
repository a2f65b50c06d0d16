//! The shapes of a boundary: each a curve over the parameters 0 to 1, the solid on its left.

use super::vector::{Point, distance, dot, minus, plus};

/// One smooth piece of a boundary.
#[derive(Clone, Debug)]
pub enum Curve {
    Line {
        from: Point,
        to: Point,
    },
    /// center + u cos a + v sin a, `a` from the first angle to the second: arcs of circles and ellipses, however turned.
    Oval {
        center: Point,
        u: Point,
        v: Point,
        from: f64,
        to: f64,
    },
    /// The four control points of a cubic.
    Cubic([Point; 4]),
}

impl Curve {
    pub fn point(&self, t: f64) -> Point {
        match self {
            Self::Line { from, to } => {
                // the last point is exact
                if t == 1.0 { *to } else { plus(*from, t, minus(*to, *from)) }
            }
            Self::Oval { center, u, v, from, to } => {
                let (sin, cos) = (from + t * (to - from)).sin_cos();
                plus(plus(*center, cos, *u), sin, *v)
            }
            Self::Cubic(p) => {
                let r = 1.0 - t;
                let weights = [r * r * r, 3.0 * r * r * t, 3.0 * r * t * t, t * t * t];
                weights.iter().zip(p).fold([0.0; 2], |sum, (weight, point)| plus(sum, *weight, *point))
            }
        }
    }

    /// The derivative by the parameter.
    pub fn rate(&self, t: f64) -> Point {
        match self {
            Self::Line { from, to } => minus(*to, *from),
            Self::Oval { u, v, from, to, .. } => {
                let (sin, cos) = (from + t * (to - from)).sin_cos();
                let rate = plus(u.map(|side| -sin * side), cos, *v);
                rate.map(|side| side * (to - from))
            }
            Self::Cubic(p) => {
                let r = 1.0 - t;
                let sides = [minus(p[1], p[0]), minus(p[2], p[1]), minus(p[3], p[2])];
                let weights = [3.0 * r * r, 6.0 * r * t, 3.0 * t * t];
                weights.iter().zip(&sides).fold([0.0; 2], |sum, (weight, side)| plus(sum, *weight, *side))
            }
        }
    }

    /// An upper bound of the second derivative between two parameters.
    pub fn bend(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Line { .. } => 0.0,
            // |u cos + v sin|^2 is at most u^2 + v^2 and, where u and v are axes, the larger of the two squares
            Self::Oval { u, v, from, to, .. } => {
                let (uu, vv) = (dot(*u, *u), dot(*v, *v));
                let square = if dot(*u, *v).abs() <= 1e-12 * uu.max(vv) { uu.max(vv) } else { uu + vv };
                1.000_001 * square.sqrt() * (to - from) * (to - from)
            }
            // linear in t
            Self::Cubic(p) => {
                let second = |k: usize| plus(plus(p[k], -2.0, p[k + 1]), 1.0, p[k + 2]);
                let (first, last) = (second(0), second(1));
                let at = |t: f64| 6.0 * dot2(plus(first, t, minus(last, first)));
                at(from).max(at(to))
            }
        }
    }

    /// The curve under an affine map that keeps the direction of travel.
    pub fn mapped(&self, map: &dyn Fn(Point) -> Point) -> Self {
        let origin = map([0.0, 0.0]);
        let direction = |v: &Point| minus(map(*v), origin);
        match self {
            Self::Line { from, to } => Self::Line { from: map(*from), to: map(*to) },
            Self::Oval { center, u, v, from, to } => {
                Self::Oval { center: map(*center), u: direction(u), v: direction(v), from: *from, to: *to }
            }
            Self::Cubic(p) => Self::Cubic(p.map(map)),
        }
    }

    pub fn reversed(&self) -> Self {
        match self.clone() {
            Self::Line { from, to } => Self::Line { from: to, to: from },
            Self::Oval { center, u, v, from, to } => Self::Oval { center, u, v, from: to, to: from },
            Self::Cubic([a, b, c, d]) => Self::Cubic([d, c, b, a]),
        }
    }

    /// A box around it: lower left, upper right.
    pub fn bounds(&self) -> [f64; 4] {
        let off = 0.125 * self.bend(0.0, 1.0);
        let (a, b) = (self.point(0.0), self.point(1.0));
        [a[0].min(b[0]) - off, a[1].min(b[1]) - off, a[0].max(b[0]) + off, a[1].max(b[1]) + off]
    }

    /// Whether it is longer than rounding.
    pub fn is_something(&self) -> bool {
        distance(self.point(0.0), self.point(1.0)) > 1e-13 || self.bend(0.0, 1.0) > 1e-13
    }
}

fn dot2(v: Point) -> f64 {
    v[0].hypot(v[1])
}
