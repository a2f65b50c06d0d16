//! Many sections of one segment at equal distances, cheaper than one [`advance`] each.

use super::basis::{Basis, basis};
use super::kernel::{Arc, End, LEAST_COIL, Section, advance, axial, in_frame};
use super::scalar::{Scalar, is_finite};

/// Number of steps after which the walk starts anew from the closed form, so that rounding does not accumulate.
const STRIDE: usize = 64;

/// Sections of the segment of `length` (negative: backwards) that starts at `start` and carries the force (A, B), at
/// `length` / `steps`, 2 `length` / `steps`, ..., `length`: what [`advance`] gives at each, within 3e-14 for |A|, |B| <= 20,
/// |kappa| <= 6, |length| <= 1, for any number of steps (typically 1e-15, no worse than [`advance`] itself); in `f32` within
/// 4e-5.
///
/// P and M are constant along the segment, so its basis is computed once and each step is the addition formula only: a
/// fifth of the price of [`advance`], except where a single step may be a whole turn of a coil; there each step is an
/// [`advance`]. Nothing is allocated; without steps there are no sections.
///
/// ```
/// use rod_core::{Section, advance, walk};
/// let start = Section { x: 0.0, y: 0.0, phi: 1.0, kappa: 2.0 };
/// let shape: Vec<Section> = walk(&start, 3.0, -1.0, 0.8, 100).collect();
/// assert_eq!(shape.len(), 100);
/// assert!((shape[49].x - advance(&start, 3.0, -1.0, 0.4).x).abs() < 1e-14);
/// ```
pub fn walk<T: Scalar>(
    start: &Section<T>,
    a: T,
    b: T,
    length: T,
    steps: usize,
) -> impl ExactSizeIterator<Item = Section<T>> + use<T> {
    let mut route = Route::new(start, a, b, length, steps);
    let coils = route.walker.may_coil();
    let mut turned = T::from_f64(0.0);
    (0..steps).map(move |i| {
        let step = i + 1;
        if coils || step % STRIDE == 0 {
            turned = T::from_f64(0.0);
            return *route.start_anew(step);
        }
        turned = turned + route.walker.step().angle();
        let (x, y) = route.position();
        Section { x, y, phi: route.origin.phi + turned, kappa: route.walker.kappa }
    })
}

/// A point of the rod with its direction in place of its slope angle: all that the gap to an object asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station<T = f64> {
    /// Position along x.
    pub x: T,
    /// Position along y.
    pub y: T,
    /// Cosine of the slope angle.
    pub cos: T,
    /// Sine of the slope angle.
    pub sin: T,
    /// Bending moment; of a uniform straight rod it is the curvature d phi / d s.
    pub moment: T,
}

impl<T: Scalar> From<&Section<T>> for Station<T> {
    fn from(&Section { x, y, phi, kappa }: &Section<T>) -> Self {
        let (sin, cos) = phi.sin_cos();
        Self { x, y, cos, sin, moment: kappa }
    }
}

/// The points of [`walk`] with their directions, which cost no arctangent. As accurate.
///
/// ```
/// use rod_core::{Section, Station, stations};
/// let start = Section { x: 0.0, y: 0.0, phi: 1.0, kappa: 2.0 };
/// let half_way: Vec<Station> = stations(&start, 3.0, -1.0, 0.8, 2).collect();
/// let there = Station::from(&rod_core::advance(&start, 3.0, -1.0, 0.4));
/// assert!((half_way[0].x - there.x).abs() < 1e-15 && (half_way[0].sin - there.sin).abs() < 1e-15);
/// ```
pub fn stations<T: Scalar>(
    start: &Section<T>,
    a: T,
    b: T,
    length: T,
    steps: usize,
) -> impl ExactSizeIterator<Item = Station<T>> + use<T> {
    let mut route = Route::new(start, a, b, length, steps);
    (0..steps).map(move |i| {
        let step = i + 1;
        if step % STRIDE == 0 {
            return Station::from(route.start_anew(step));
        }
        route.walker.step();
        let ((x, y), (cos, sin)) = (route.position(), route.direction());
        Station { x, y, cos, sin, moment: route.walker.kappa }
    })
}

/// A walk along a segment: a walker, and where it started from last.
struct Route<T> {
    start: Section<T>,
    force: (T, T),
    h: T,
    origin: Section<T>,
    sin: T,
    cos: T,
    walker: Walker<T>,
}

impl<T: Scalar> Route<T> {
    #[inline(always)]
    fn new(start: &Section<T>, a: T, b: T, length: T, steps: usize) -> Self {
        let h = length / T::from_f64(steps as f64);
        let (sin, cos) = start.phi.sin_cos();
        let (c, d) = in_frame((a, b), (sin, cos));
        let walker = Walker::new(start.kappa, c, d, h);
        Self { start: *start, force: (a, b), h, origin: *start, sin, cos, walker }
    }

    /// Takes the section after so many steps from the closed form, to go on from there.
    fn start_anew(&mut self, step: usize) -> &Section<T> {
        let (a, b) = self.force;
        self.origin = advance(&self.start, a, b, self.h * T::from_f64(step as f64));
        (self.sin, self.cos) = self.origin.phi.sin_cos();
        let (c, d) = in_frame(self.force, (self.sin, self.cos));
        self.walker.restart(self.origin.kappa, c, d);
        &self.origin
    }

    #[inline(always)]
    fn position(&self) -> (T, T) {
        let Self { origin, sin, cos, walker, .. } = self;
        let (x, y) = (walker.x, walker.y);
        (origin.x + (*cos * x - *sin * y), origin.y + (*sin * x + *cos * y))
    }

    #[inline(always)]
    fn direction(&self) -> (T, T) {
        let Self { sin, cos, walker, .. } = self;
        (*cos * walker.cos - *sin * walker.sin, *sin * walker.cos + *cos * walker.sin)
    }
}

/// Equal steps along one segment, in the frame of the section where they start. P and M are constant, hence one basis for
/// all of them.
///
/// What is carried from step to step grows by increments with an error relative to themselves, and the curvature follows
/// from the balance of moments, so that rounding hardly adds up.
pub(crate) struct Walker<T> {
    /// The square of half the turning angle of a step at most.
    reach: T,
    at: Basis<T>,
    p: T,
    over_p: T,
    /// Curvature and force components of the origin, as in [`Arc`].
    origin: (T, T, T),
    /// Where the walker is: position, direction and curvature.
    pub x: T,
    pub y: T,
    sin: T,
    cos: T,
    pub kappa: T,
}

impl<T: Scalar> Walker<T> {
    /// Steps of length `h` from a section with curvature `kappa` and the force (c, d) in its frame, as in [`Arc`].
    #[inline]
    pub fn new(kappa: T, c: T, d: T, h: T) -> Self {
        let n = T::from_f64;
        let (zero, one) = (n(0.0), n(1.0));
        let p = (c * c + d * d).sqrt();
        let excess = n(0.25) * kappa * kappa - axial(c, d, p);
        let inverse = one / p;
        let over_p = if is_finite(inverse) { inverse } else { zero };
        let (at, origin) = (basis(p, excess, h), (kappa, c, d));
        let reach = (p + excess) * h * h;
        Self { reach, at, p, over_p, origin, x: zero, y: zero, sin: zero, cos: one, kappa }
    }

    /// Whether a single step may turn by more than an angle is known to.
    #[inline]
    pub fn may_coil(&self) -> bool {
        self.reach >= T::from_f64(LEAST_COIL)
    }

    /// The same steps from another section of the segment.
    #[inline]
    pub fn restart(&mut self, kappa: T, c: T, d: T) {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        *self = Self { origin: (kappa, c, d), x: zero, y: zero, sin: zero, cos: one, kappa, ..*self };
    }

    /// One step on. By which angle it turned costs an arctangent, for those who ask.
    #[inline(always)]
    pub fn step(&mut self) -> End<T> {
        let (half, two) = (T::from_f64(0.5), T::from_f64(2.0));
        let (kappa0, c0, d0) = self.origin;
        let Self { ref at, p, over_p, sin, cos, .. } = *self;
        let (c, d) = (c0 * cos - d0 * sin, d0 * cos + c0 * sin);
        let scaled = c * over_p;
        let arc = Arc { q: half * self.kappa, c, d, p, w: axial(c, d, p), cc: c * scaled, cd: d * scaled };
        let end = arc.end(at);
        let (half_sin, half_cos) = (end.sin * end.inverse, end.cos * end.inverse);
        let (turn, versine) = (two * half_sin * half_cos, two * half_sin * half_sin);
        self.x = self.x + (cos * end.x - sin * end.y);
        self.y = self.y + (sin * end.x + cos * end.y);
        self.sin = self.sin + (cos * turn - sin * versine);
        self.cos = self.cos - (cos * versine + sin * turn);
        self.kappa = kappa0 - (d0 * self.x + c0 * self.y);
        end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are the same in every run.
    struct Random(u64);

    impl Random {
        fn within(&mut self, most: f64) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            most * ((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
        }
    }

    fn furthest(u: &Section, v: &Section) -> f64 {
        [u.x - v.x, u.y - v.y, u.phi - v.phi, u.kappa - v.kappa].into_iter().fold(0.0, |m, e| m.max(e.abs()))
    }

    #[test]
    fn each_section_is_what_advance_gives() {
        let mut random = Random(7);
        let mut worst: f64 = 0.0;
        for _ in 0..2000 {
            let start = Section { x: 0.1, y: -0.2, phi: random.within(3.2), kappa: random.within(6.0) };
            let (a, b, length) = (random.within(20.0), random.within(20.0), random.within(1.0));
            let steps = 1 + (149.0 + random.within(149.0)) as usize;
            let both = walk(&start, a, b, length, steps).zip(stations(&start, a, b, length, steps));
            for (i, (at, station)) in both.enumerate() {
                let exact = advance(&start, a, b, length * (i + 1) as f64 / steps as f64);
                worst = worst.max(furthest(&at, &exact));
                let there = Station::from(&exact);
                assert_eq!((at.x, at.y, at.kappa), (station.x, station.y, station.moment));
                worst = worst.max((station.cos - there.cos).abs()).max((station.sin - there.sin).abs());
            }
        }
        assert!(worst < 3e-14, "{worst:e}");
    }

    #[test]
    fn degenerate_walks() {
        let start = Section { x: 0.0, y: 0.0, phi: 0.3, kappa: 40.0 };
        assert_eq!(walk(&start, 1.0, 1.0, 1.0, 0).count(), 0);
        assert_eq!(walk(&start, 1.0, 1.0, 1.0, 7).len(), 7);
        // coils that turn more than once in a step, circles, straight lines, no length
        for (kappa, a, b, length) in [
            (40.0, 3.0, 1.0, 1.0),
            (7.0, 0.0, 0.0, 1.0),
            (0.0, 0.0, 0.0, 1.0),
            (1.0, 2.0, 3.0, 0.0),
            (0.0, 1e-300, 0.0, 1.0),
        ] {
            let start = Section { kappa, ..start };
            for steps in [1, 2, 130] {
                let last = walk(&start, a, b, length, steps).last().unwrap();
                let exact = advance(&start, a, b, length);
                assert!(furthest(&last, &exact) < 1e-13, "{kappa} {steps}");
                let (last, there) = (stations(&start, a, b, length, steps).last().unwrap(), Station::from(&exact));
                assert!((last.cos - there.cos).abs() + (last.sin - there.sin).abs() < 1e-13, "{kappa} {steps}");
                assert!((last.x - there.x).abs() + (last.y - there.y).abs() < 1e-13, "{kappa} {steps}");
            }
        }
        assert!(walk(&start, f64::NAN, 0.0, 1.0, 3).all(|at| at.x.is_nan()));
    }
}
