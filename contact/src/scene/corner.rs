//! A convex corner under the rod: which side of it the rod passes on.

use crate::scene::world::World;
use rod_contours::{Part, Range};
use rod_core::{Section, Support};
use std::f64::consts::{FRAC_PI_2, PI};

/// Angle (rad) by which the rod may lean beyond the directions of a corner: the rounding of a rod along one of its edges.
const PARALLEL: f64 = 1e-9;

/// Halvings in the search for a direction on a part: 20 find it to a millionth of the part.
const HALVINGS: usize = 20;

/// A vertex, and the angles with which a rod can lie on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub x: f64,
    pub y: f64,
    /// The middle of the tangent angles.
    alpha: f64,
    /// Half the turn.
    half: f64,
    /// The parameter of the stretch in the middle.
    middle: f64,
}

/// The rod running by a vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passing {
    /// Distance of the rod's tangent from the vertex: negative where the vertex is on the wrong side.
    pub gap: f64,
    /// The tangent angle of the corner along the rod, and its parameter.
    pub alpha: f64,
    pub t: f64,
}

impl Corner {
    pub fn new(world: &World<'_>, stretch: usize) -> Self {
        let range = world.range(stretch);
        let middle = 0.5 * (range.from + range.to);
        let at = world.support(stretch, middle);
        Self { x: at.x, y: at.y, alpha: at.alpha, half: 0.5 * range.length(), middle }
    }

    /// The point where a part of a piece, which bends outwards more sharply than `sharpest` (1 / L) there, has the direction `phi`
    /// or its opposite, as a corner of the directions of the whole part. None where there is no such point.
    pub fn of_bend(world: &World<'_>, part: Part, phi: f64, sharpest: f64) -> Option<Self> {
        if world.largest_curvature(part) <= sharpest {
            return None;
        }
        let Range { from, to } = world.own_range_of(part);
        let [first, last] = [from, to].map(|t| world.support(part.stretch, t).alpha);
        let (alpha, half) = (0.5 * (first + last), 0.5 * (last - first));
        let lean = (phi - alpha) - PI * ((phi - alpha) / PI).round();
        if !(half > PARALLEL && half < FRAC_PI_2 && lean.abs() <= half) {
            return None;
        }
        let (mut low, mut high) = (from, to);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if world.support(part.stretch, middle).alpha < alpha + lean {
                low = middle;
            } else {
                high = middle;
            }
        }
        let middle = 0.5 * (low + high);
        let Support { x, y, speed, turning, .. } = world.support(part.stretch, middle);
        (turning > sharpest * speed).then_some(Self { x, y, alpha, half, middle })
    }

    /// How a rod runs by whose point nearest to the vertex is `at`; none where it could not lie on the vertex in that
    /// direction.
    pub fn passing(&self, at: &Section) -> Option<Passing> {
        let lean = (at.phi - self.alpha) - PI * ((at.phi - self.alpha) / PI).round();
        let (sin, cos) = (self.alpha + lean).sin_cos();
        let gap = (at.x - self.x) * sin - (at.y - self.y) * cos;
        let t = self.middle + lean.clamp(-self.half, self.half);
        (lean.abs() <= self.half + PARALLEL).then_some(Passing { gap, alpha: self.alpha + lean, t })
    }

    /// Whether the rod, on the wrong side of the vertex, goes through the solid there, and does not just run along the
    /// far side of the object. It is told by the point where the rod crosses the line that halves the solid's angle:
    /// that point is inside by about the sine of half the angle. `ahead` and `behind` is how far the rod goes on.
    pub fn is_cut(&self, world: &World<'_>, at: &Section, passing: &Passing, (behind, ahead): (f64, f64)) -> bool {
        let along = -passing.gap / (passing.alpha - self.alpha).cos().max(PARALLEL);
        let (sin, cos) = self.alpha.sin_cos();
        let (x, y) = (self.x - along * sin, self.y + along * cos);
        let (sin, cos) = at.phi.sin_cos();
        let way = (x - at.x) * cos + (y - at.y) * sin;
        -behind <= way && way <= ahead && world.gap(x, y) < 1e-12 - 0.5 * along * self.half.cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_contours::{CircularArc, Composite};

    /// A square with its lower corner, a right angle, at the origin.
    fn square() -> Composite {
        Composite::polygon(&[[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [-1.0, 1.0]]).unwrap()
    }

    fn corner(world: &World<'_>) -> Corner {
        let corners = (0..8).filter(|stretch| world.is_corner(*stretch)).map(|stretch| Corner::new(world, stretch));
        corners.min_by(|a, b| a.y.total_cmp(&b.y)).unwrap()
    }

    fn level(y: f64, phi: f64) -> Section {
        Section { x: 0.0, y, phi, kappa: 0.0 }
    }

    #[test]
    fn a_rod_passes_below_a_corner_or_through_it() {
        let square = square();
        let world = World::new(square.as_ref(), 1.0);
        let corner = corner(&world);
        assert_eq!((corner.x, corner.y), (0.0, 0.0));
        for phi in [0.0, PI] {
            let below = corner.passing(&level(-0.1, phi)).unwrap();
            assert!((below.gap - 0.1).abs() < 1e-15, "{below:?}");
            let through = corner.passing(&level(0.1, phi)).unwrap();
            assert!((through.gap + 0.1).abs() < 1e-15);
            assert!(corner.is_cut(&world, &level(0.1, phi), &through, (1.0, 1.0)));
        }
        // steeper than the edges, a rod cannot lie on it
        assert!(corner.passing(&level(-0.1, 0.3 * PI)).is_none());
    }

    #[test]
    fn a_sharp_bend_is_a_corner_where_it_is_parallel() {
        let radius = 1e-3;
        let arc = CircularArc::new([0.0, radius], radius, -0.75 * PI, -0.25 * PI).unwrap();
        let contour = Composite::single(arc).unwrap();
        let world = World::new(contour.as_ref(), 1.0);
        let part = contour.parts().next().unwrap();
        let bend = Corner::of_bend(&world, part, 0.1, 32.0).unwrap();
        assert!(
            (bend.x - radius * 0.1_f64.sin()).abs() < 1e-8 && (bend.y - radius * (1.0 - 0.1_f64.cos())).abs() < 1e-8
        );
        assert!(Corner::of_bend(&world, part, 0.1, 2e3).is_none(), "too gentle");
        assert!(Corner::of_bend(&world, part, 1.0, 32.0).is_none(), "no such direction");
    }
}
