//! A look at the rod in a configuration: its shape, its gap to the objects, its stability.

use crate::contact_set::{Configuration, Span};
use crate::gap::passing::{self, Passing};
use crate::gap::shape::{Node, Shape};
use crate::gap::{AT_TRANSITION, Crossing, GAP_TOLERANCE, Proof, Prover};
use crate::path::ClampPath;
use crate::scene::world::World;
use crate::stability::Judge;
use crate::state::GapBounds;
use rod_core::{Section, advance};
use smallvec::SmallVec;

/// Distance (L) from an end of an open contour within which a rod that has swept over that end is known to have done so.
const DEEPEST: f64 = 0.1;

/// Distance from the rod at which an end of an open contour is what it cannot go on for.
const BY_END: f64 = 0.02;

/// Distance from the rod of what is on it but for rounding.
const ON_ROD: f64 = 1e-12;

/// What a scan found.
#[derive(Clone, Debug)]
pub(crate) struct Scan {
    /// Bounds of the smallest gap over the whole rod.
    pub gap: GapBounds,
    /// Where the rod goes through a contour.
    pub crossings: SmallVec<[Crossing; 2]>,
    /// The clamp itself is inside the solid.
    pub clamp_inside: bool,
    /// Where the tip is.
    pub tip: (f64, f64),
    /// On which side of the rod, and how far, the ends of open contours are; NaN where the rod does not run by.
    sides: SmallVec<[f64; 2]>,
}

impl Scan {
    /// Whether the rod is outside of all objects: proven.
    pub fn is_outside(&self) -> bool {
        self.crossings.is_empty() && !self.clamp_inside && self.gap.lower > f64::NEG_INFINITY
    }

    /// Whether the rod is next to an end of an open contour.
    pub fn is_by_an_end(&self) -> bool {
        self.sides.iter().any(|side| side.abs() < BY_END)
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
    /// The shape of the rod that was looked at last.
    shape: Shape,
    prover: Prover,
    judge: Judge,
}

impl Scanner {
    /// Looks at the whole rod in `configuration`.
    pub fn scan(&mut self, world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Scan {
        self.scan_to(GAP_TOLERANCE, world, path, configuration)
    }

    /// The same of a rod at a transition, where another contact, about to form, may be deeper.
    pub fn scan_transition(&mut self, world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Scan {
        let scan = self.scan(world, path, configuration);
        if scan.is_outside() { scan } else { self.scan_to(AT_TRANSITION, world, path, configuration) }
    }

    fn scan_to(&mut self, depth: f64, world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Scan {
        self.shape.follow(world, path, configuration);
        let proof = self.prover.prove(world, configuration, &self.shape, depth);
        let Proof { lower, seen, crossings, clamp_inside } = proof;
        let gap = GapBounds { lower, seen, proven: world.is_proven() };
        let (_, tip) = self.shape.ends();
        Scan { gap, crossings, clamp_inside, tip, sides: sides(world, &self.shape) }
    }

    /// What the rod has gone through, and is beside now, on its way from a configuration and what was seen there to the one that
    /// was looked at last.
    pub fn passes(
        &mut self,
        world: &World<'_>,
        path: &ClampPath,
        from: &Configuration,
        before: &Scan,
    ) -> Option<Passing> {
        let (clamp, tip) = self.shape.ends();
        let was = path.at(from.tau());
        if self.prover.is_crossed(world, ((was.x, was.y), clamp), |_| false) {
            return Some(Passing::Clamp);
        }
        let skip = |run: usize| passing::holds(world, from, run);
        if self.prover.is_crossed(world, (before.tip, tip), skip) {
            return Some(Passing::Rod);
        }
        let clear = world.objects() == 1 && from.count() > 0;
        let swept = !clear && {
            let mut was = Shape::default();
            was.follow(world, path, from);
            passing::swept_over(world, &was, &self.shape, from)
        };
        swept.then_some(Passing::Rod)
    }

    /// Whether the rod is stable in the configuration that was looked at last.
    pub fn is_stable(&mut self, world: &World<'_>, scanned: &Configuration) -> bool {
        self.judge.is_stable(world, scanned, &self.shape)
    }
}

/// On which side of the rod, and how far, the ends of open contours are.
fn sides(world: &World<'_>, shape: &Shape) -> SmallVec<[f64; 2]> {
    let side = |&(x, y): &(f64, f64)| {
        let sides = shape.nodes.windows(2).filter_map(|pair| {
            let ahead = |Node { at, .. }: &Node| (at.x - x) * at.cos + (at.y - y) * at.sin;
            let (before, after) = (ahead(&pair[0]), ahead(&pair[1]));
            (before < 0.0 && after >= 0.0).then(|| {
                let at = pass(&shape.spans, (&pair[0], &pair[1]), (x, y), before, after);
                let (sin, cos) = at.phi.sin_cos();
                (y - at.y) * cos - (x - at.x) * sin
            })
        });
        sides.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
    };
    world.open_ends().iter().map(side).collect()
}

/// Where between two nodes the rod runs by a point; (r - point) . tangent is given at both.
fn pass(spans: &[Span], nodes: (&Node, &Node), point: (f64, f64), before: f64, after: f64) -> Section {
    let span = &spans[nodes.0.span];
    let mut s = nodes.0.s + (nodes.1.s - nodes.0.s) * before / (before - after);
    let mut at = span.start;
    for _ in 0..6 {
        at = advance(&span.start, span.a, span.b, s - span.s);
        let (sin, cos) = at.phi.sin_cos();
        let (dx, dy) = (at.x - point.0, at.y - point.1);
        let rate = (1.0 + at.kappa * (dy * cos - dx * sin)).max(0.1);
        let step = -(dx * cos + dy * sin) / rate;
        if step.abs() < 1e-15 {
            break;
        }
        s = (s + step).clamp(nodes.0.s, nodes.1.s);
    }
    at
}
