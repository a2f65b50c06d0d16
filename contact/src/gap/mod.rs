//! The gap between the whole rod and the objects: proven from below, or the places where the rod goes through. A scan of the rod in a
//! configuration gives its shape, its gap to the objects and its stability.

mod interval;
pub(crate) mod passing;
mod prover;
mod separator;
pub(crate) mod shape;
mod touch;

pub(crate) use prover::{Proof, Prover};

use crate::contact_set::Configuration;
use crate::scene::Setup;
use crate::scene::rod::{self, Segment};
use crate::scene::world::{Foot, World};
use crate::stability::{Judge, wraps};
use crate::state::GapBounds;
use passing::Passing;
use rod_core::{Cut, PhysicalRod, RodModel};
use shape::{Node, Shape};
use smallvec::SmallVec;

/// Depth (L) that counts as a closed gap: the residual of a solve leaves so much.
pub(crate) const GAP_TOLERANCE: f64 = 1e-12;

/// The same at a located transition, where another contact may be about to form. Ten times this is proven there.
pub(crate) const AT_TRANSITION: f64 = 1e-10;

/// A place where the rod goes through the contour: a local minimum of the gap along the rod.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub stretch: usize,
    pub s: f64,
    pub phi: f64,
    pub foot: Foot,
    /// At the end of the rod, where the gap still falls.
    pub tip: bool,
}

/// Distance (L) between the rod and an end of an open contour up to which a change of sides means that the rod went over the
/// end. Farther away the rod has gone around it.
const DEEPEST: f64 = 0.1;

/// Distance (L) between the rod and an end of an open contour below which that end is taken for the reason of a stop.
const BY_END: f64 = 0.02;

/// Distance (L) from the rod that is rounding.
const ON_ROD: f64 = 1e-12;

/// What a scan found.
#[derive(Clone, Debug)]
pub(crate) struct Scan {
    shape: Shape,
    /// Bounds of the smallest gap over the whole rod.
    pub gap: GapBounds,
    /// Where the rod goes through a contour.
    pub crossings: SmallVec<[Crossing; 2]>,
    /// The clamp itself is inside the solid.
    pub clamp_inside: bool,
    /// On which side of the rod, and how far, the ends of open contours are; NaN where the rod does not run by.
    sides: SmallVec<[f64; 2]>,
}

impl Scan {
    /// The segments of the rod that was scanned.
    pub fn segments(&self) -> &[Segment] {
        &self.shape.segments
    }

    /// Whether the rod is outside of all objects: proven.
    pub fn is_outside(&self) -> bool {
        self.crossings.is_empty() && !self.clamp_inside && self.gap.lower > f64::NEG_INFINITY
    }

    /// Whether the rod is next to an end of an open contour.
    pub fn is_by_an_end(&self) -> bool {
        self.sides.iter().any(|side| side.abs() < BY_END)
    }

    /// Keeps the side on which an end of an open contour was `before`, where the rod is now on that end: which side it is on then
    /// is rounding.
    pub fn keep_sides(&mut self, before: &Self) {
        for (now, was) in self.sides.iter_mut().zip(&before.sides) {
            if now.abs() <= ON_ROD && !was.is_nan() {
                *now = ON_ROD.copysign(*was);
            }
        }
    }

    /// Whether the rod, from where it was, has swept over an end of an open contour.
    pub fn has_swept_over_an_end(&self, before: &Self) -> bool {
        // an end that the rod lies on is on either side by rounding; a far one has been gone around
        let near = |side: f64| (ON_ROD..DEEPEST).contains(&side.abs());
        self.sides.iter().zip(&before.sides).any(|(now, was)| near(*now) && near(*was) && now.signum() != was.signum())
    }
}

/// Looks at the rod, in memory that is used again.
#[derive(Debug, Default)]
pub(crate) struct Scanner {
    prover: Prover,
    judge: Judge,
    /// Of the points of a shape.
    memory: Vec<Node>,
}

impl Scanner {
    /// Looks at the whole rod in `configuration`.
    #[inline(never)]
    pub fn scan<R: PhysicalRod>(&mut self, setup: &Setup<'_, R>, configuration: &Configuration) -> Scan {
        let shape = Shape::of(std::mem::take(&mut self.memory), setup, configuration);
        self.scan_shape(shape, setup, configuration, GAP_TOLERANCE)
    }

    /// Looks at the rod in a `configuration` between both ends of a step: without points of the rod, if its arcs prove the gap.
    #[inline(never)]
    pub fn scan_between<R: PhysicalRod>(&mut self, setup: &Setup<'_, R>, configuration: &Configuration) -> Scan {
        let (rod, world) = (setup.rod.model(), &setup.world);
        let shape = Shape::bare(std::mem::take(&mut self.memory), setup, configuration);
        match self.prover.prove_by_arcs(rod, world, configuration, &shape) {
            None => self.scan_shape(shape.with_points(rod), setup, configuration, GAP_TOLERANCE),
            Some(lower) => Scan {
                shape,
                gap: GapBounds { lower: lower.min(0.0), seen: 0.0, proven: world.is_proven() },
                crossings: SmallVec::new(),
                clamp_inside: false,
                sides: SmallVec::new(),
            },
        }
    }

    /// Keeps the memory of a scan that has been of use, for the next one.
    pub fn recycle(&mut self, scan: Scan) {
        self.memory = scan.shape.nodes;
    }

    /// The same of a rod at a transition, where another contact, about to form, may be deeper.
    pub fn scan_transition<R: PhysicalRod>(&mut self, setup: &Setup<'_, R>, configuration: &Configuration) -> Scan {
        let scan = self.scan(setup, configuration);
        if scan.is_outside() { scan } else { self.scan_shape(scan.shape, setup, configuration, AT_TRANSITION) }
    }

    fn scan_shape<R: PhysicalRod>(
        &mut self,
        shape: Shape,
        setup: &Setup<'_, R>,
        configuration: &Configuration,
        depth: f64,
    ) -> Scan {
        let world = &setup.world;
        let Proof { lower, seen, crossings, clamp_inside } =
            self.prover.prove(setup.rod.model(), world, configuration, &shape, depth);
        let gap = GapBounds { lower, seen, proven: world.is_proven() };
        let sides = sides(setup.rod.model(), world, &shape);
        Scan { shape, gap, crossings, clamp_inside, sides }
    }

    /// What the rod has gone through, and is beside now, on its way from a configuration and what was seen there to what is seen
    /// `now`.
    pub fn passes<R: PhysicalRod>(
        &mut self,
        setup: &Setup<'_, R>,
        from: &Configuration,
        before: &Scan,
        now: &Scan,
    ) -> Option<Passing> {
        let world = &setup.world;
        let ((clamp_before, tip_before), (clamp, tip)) = (before.shape.ends(), now.shape.ends());
        if self.prover.is_crossed(world, (clamp_before, clamp), |_| false) {
            return Some(Passing::Clamp);
        }
        let skip = |run: usize| passing::holds(world, from, run);
        if self.prover.is_crossed(world, (tip_before, tip), skip) {
            return Some(Passing::Rod);
        }
        let clear = world.objects() == 1 && from.count() > 0;
        let swept = !clear && passing::swept_over(setup.rod.model(), world, &before.shape, &now.shape, from);
        swept.then_some(Passing::Rod)
    }

    /// Whether no contact of a configuration that was scanned wraps around the contour.
    pub fn wraps_nowhere<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration, scan: &Scan) -> bool {
        wraps(setup, configuration, &scan.shape.segments).is_none()
    }

    /// Whether the rod is stable in a configuration that was scanned.
    pub fn is_stable<R: PhysicalRod>(
        &mut self,
        setup: &Setup<'_, R>,
        configuration: &Configuration,
        scan: &Scan,
    ) -> bool {
        self.judge.is_stable(setup, configuration, &scan.shape)
    }
}

/// On which side of the rod, and how far, the ends of open contours are.
fn sides(rod: &impl RodModel, world: &World<'_>, shape: &Shape) -> SmallVec<[f64; 2]> {
    let side = |&(x, y): &(f64, f64)| {
        let sides = shape.nodes.windows(2).filter_map(|pair| {
            let ahead = |Node { at, .. }: &Node| (at.x - x) * at.cos + (at.y - y) * at.sin;
            let (before, after) = (ahead(&pair[0]), ahead(&pair[1]));
            (before < 0.0 && after >= 0.0).then(|| {
                let at = pass(rod, &shape.segments, (&pair[0], &pair[1]), (x, y), before, after);
                let (sin, cos) = at.phi.sin_cos();
                (y - at.y) * cos - (x - at.x) * sin
            })
        });
        sides.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
    };
    world.open_ends().iter().map(side).collect()
}

/// Where between two nodes the rod runs by a point; (r - point) . tangent is given at both.
fn pass(
    rod: &impl RodModel,
    segments: &[Segment],
    nodes: (&Node, &Node),
    point: (f64, f64),
    before: f64,
    after: f64,
) -> Cut {
    let segment = &segments[nodes.0.segment];
    let mut s = nodes.0.s + (nodes.1.s - nodes.0.s) * before / (before - after);
    let mut at = segment.start;
    for _ in 0..6 {
        at = rod::at(rod, segment, s);
        let (sin, cos) = at.phi.sin_cos();
        let (dx, dy) = (at.x - point.0, at.y - point.1);
        let rate = (1.0 + rod.curvature_at(s, at.moment) * (dy * cos - dx * sin)).max(0.1);
        let step = -(dx * cos + dy * sin) / rate;
        if step.abs() < 1e-15 {
            break;
        }
        // a guess may have its last contact beyond the tip, from where the nodes run back to it
        s = (s + step).max(nodes.0.s.min(nodes.1.s)).min(nodes.0.s.max(nodes.1.s));
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::ClampPath;
    use rod_contours::{Composite, Parabola};
    use rod_core::{Pose, Rod};

    /// A straight rod along y = `y` from x = -0.5 to 0.5.
    fn level(objects: &Composite, y: f64) -> Scan {
        let path = ClampPath::standing(Pose { x: -0.5, y, phi: 0.0 });
        let setup = Setup::new(&Rod::new(1.0, 1.0).unwrap(), objects.as_ref(), path);
        Scanner::default().scan(&setup, &Configuration::free(0.0))
    }

    #[test]
    fn the_gap_of_a_free_rod_lies_between_its_bounds() {
        // solid above y = x^2: the vertex is nearest
        let ceiling = Composite::single(Parabola::new([0.0, 0.0], 1.0).unwrap()).unwrap();
        for gap in [0.3, 0.01, 1e-6, 1e-11] {
            let scan = level(&ceiling, -gap);
            let GapBounds { lower, seen, proven } = scan.gap;
            assert!(scan.is_outside() && proven);
            assert!(lower <= gap && gap <= seen * (1.0 + 1e-12), "{gap}: {lower} {seen}");
            assert!(lower > (1.0 - 1.1e-3) * gap - 2e-11, "{gap}: {lower}");
        }
    }

    #[test]
    fn a_rod_that_goes_through_is_seen_at_the_deepest_place() {
        let ceiling = Composite::single(Parabola::new([0.0, 0.0], 1.0).unwrap()).unwrap();
        let scan = level(&ceiling, 0.04);
        assert!(!scan.is_outside() && scan.gap.lower == f64::NEG_INFINITY && !scan.clamp_inside);
        let [Crossing { s, foot, tip, .. }] = scan.crossings[..] else { panic!("{:?}", scan.crossings) };
        assert!(!tip && (s - 0.5).abs() < 1e-8 && (foot.gap + 0.04).abs() < 1e-8 && foot.t.abs() < 1e-8);
        assert!(level(&ceiling, 0.3).clamp_inside);
    }

    /// It goes in and out through notches, where no run of the contour is crossed, within one interval.
    #[test]
    fn a_rod_through_a_small_tooth_is_seen() {
        for (from, way, height) in [(0.1, 1e-3, 1e-4), (0.13, 1e-5, 4e-6), (-0.2, 2e-6, 1e-6)] {
            // solid above y = 0, but for the tooth, which hangs down
            let tooth = [[from, 0.0], [from + 0.4 * way, -height], [from + way, 0.0]];
            let points: Vec<_> =
                [[-1.0, 0.0]].into_iter().chain(tooth).chain([[1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]]).collect();
            let object = Composite::polygon(&points).unwrap();
            assert!(!level(&object, -1e-14).is_outside() && level(&object, -1.1 * height).is_outside(), "{from}");
        }
    }

    #[test]
    fn an_end_that_changes_sides_was_swept_over() {
        // an arm of the contour ends at (0, 0); the solid is above
        let arm = Parabola::new([0.0, 0.0], 1.0).unwrap().between(0.0, 1.0).unwrap();
        let arm = Composite::single(arm).unwrap();
        let (below, above) = (level(&arm, -0.01), level(&arm, 0.01));
        assert!(above.has_swept_over_an_end(&below) && !below.has_swept_over_an_end(&level(&arm, -0.02)));
        assert!(below.is_by_an_end() && !level(&arm, -0.5).is_by_an_end());
        let mut on = level(&arm, 0.0);
        on.keep_sides(&below);
        assert!(!on.has_swept_over_an_end(&below));
    }
}
