//! The gap between the whole rod and the contour: smallest value, and where the rod goes through.

use crate::arc::Arc;
use crate::configuration::{Configuration, Span};
use crate::corner::{Corner, Passing};
use crate::path::ClampPath;
use crate::shape::{Node, Shape};
use crate::stability::Judge;
use crate::supporting_line::SupportingLine;
use crate::world::{Foot, World};
use rod_contours::{Bounds, Part, StretchKind};
use rod_core::{Hold, Section, Station, advance};
use smallvec::SmallVec;

/// Deepest penetration at a corner that is looked for: more than a step of the sweep can bring about.
const DEEPEST: f64 = 0.1;

/// Cosine of the largest turn of a part between two feet that are taken to be on the same side of it, or on opposite ones.
const LEAST_COSINE: f64 = 0.8;

/// Distance from the rod at which an end of an open contour is what it cannot go on for.
const BY_END: f64 = 0.02;

/// Distance from the rod of what is on it but for rounding.
const ON_ROD: f64 = 1e-12;

/// Curvatures, angles and distances off a normal that are what rounding leaves of none.
const PARALLEL: f64 = 1e-9;

/// Gaps down to minus this count as closed: what a residual at rounding level leaves.
pub(crate) const GAP_TOLERANCE: f64 = 1e-12;

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

/// What a scan found.
#[derive(Clone, Debug)]
pub(crate) struct Scan {
    /// Smallest gap over the whole rod.
    pub min_gap: f64,
    /// Where the gap is below -[`GAP_TOLERANCE`] at a local minimum away from the contacts.
    pub crossings: SmallVec<[Crossing; 2]>,
    /// The clamp itself is inside the solid.
    pub clamp_inside: bool,
    /// On which side of the rod, and how far, the ends of open contours are; not a number where the rod does not run by.
    sides: SmallVec<[f64; 2]>,
}

impl Scan {
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

/// A node seen from one part of a contour.
#[derive(Clone, Copy)]
struct Sight {
    gap: f64,
    /// Slope of the gap along the rod, to the left and to the right of the node.
    left: f64,
    right: f64,
    interior: bool,
    /// Whether the part's own contact is here.
    contact: bool,
    /// On a straight part the slope of the gap to the line that it is a part of.
    line: Option<f64>,
}

/// A part of a contour and the nodes of the rod (first, last) that are near it.
#[derive(Clone, Copy, Debug)]
struct Near {
    part: Part,
    first: usize,
    last: usize,
}

/// Looks at the rod, in memory that is used again.
#[derive(Debug, Default)]
pub(crate) struct Scanner {
    /// The shape of the rod that was looked at last.
    shape: Shape,
    near: Vec<Near>,
    judge: Judge,
}

impl Scanner {
    /// Looks at the whole rod in `configuration`.
    pub fn scan(&mut self, world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Scan {
        self.shape.follow(world, path, configuration);
        // where there is a contact, there the gap is zero
        let least = if configuration.count() > 0 { 0.0 } else { f64::INFINITY };
        let mut found =
            Scan { min_gap: least, crossings: SmallVec::new(), clamp_inside: false, sides: sides(world, &self.shape) };
        self.look_around(world, least);
        let rod = Looking { world, configuration, shape: &self.shape };
        for near in &self.near {
            match world.kind(near.part.stretch) {
                StretchKind::Piece(_) => rod.scan_part(*near, &mut found),
                StretchKind::Corner { .. } => rod.scan_corner(*near, &mut found),
                StretchKind::Notch { .. } => rod.scan_notch(near.part, &mut found),
            }
        }
        found
    }

    /// Whether the rod is stable in the configuration that was looked at last.
    pub fn is_stable(&mut self, world: &World<'_>, scanned: &Configuration) -> bool {
        self.judge.is_stable(world, scanned, &self.shape)
    }

    /// Lists the parts of the contours that the rod could be nearer to than `least`.
    fn look_around(&mut self, world: &World<'_>, least: f64) {
        let Self { shape: Shape { nodes, .. }, near, .. } = self;
        near.clear();
        let last = nodes.len() - 1;
        if world.is_small() {
            world.parts_near(Bounds::ALL, |part| near.push(Near { part, first: 0, last }));
            return;
        }
        // as far as it could be to what is nearest, or as deep as it could have gone in, and the rounding of boxes
        let reach = |gap: f64| GAP_TOLERANCE + if gap < 0.0 { -2.0 * gap } else { gap };
        if least > 0.0 {
            let gaps = gaps(world, nodes.iter());
            let gap = gaps.iter().copied().fold(f64::INFINITY, f64::min);
            // what is outside and farther than the rest of the rod is not the nearest
            let lengths = nodes.windows(2).map(|pair| pair[1].s - pair[0].s);
            let nearest = gaps.windows(2).zip(lengths).map(|(pair, length)| 0.5 * (pair[0] + pair[1] - length));
            let matters: SmallVec<[bool; 64]> = nearest.map(|nearest| nearest <= gap.max(0.0)).collect();
            look_within(near, world, nodes, reach(gap), |interval| matters[interval]);
        } else {
            look_within(near, world, nodes, 0.0, |_| true);
            // as they come, interval after interval
            let intervals = near.chunk_by(|a, b| a.first == b.first).filter_map(|near| near.first());
            let around = intervals.flat_map(|near| &nodes[near.first..=near.last]);
            let gap = gaps(world, around).into_iter().fold(f64::INFINITY, f64::min);
            if gap < -GAP_TOLERANCE {
                near.clear();
                look_within(near, world, nodes, reach(gap), |_| true);
            }
        }
        // one entry a part, in the order of the contours
        near.sort_unstable_by(|a, b| {
            let by_start = a.part.range.from.total_cmp(&b.part.range.from);
            a.part.stretch.cmp(&b.part.stretch).then(by_start).then(a.first.cmp(&b.first))
        });
        near.dedup_by(|next, kept| {
            let same = next.part == kept.part;
            if same {
                kept.last = next.last;
            }
            same
        });
    }
}

/// Lists the parts that each interval between two nodes that `matters` could be nearer to than `reach`.
fn look_within(near: &mut Vec<Near>, world: &World<'_>, nodes: &[Node], reach: f64, matters: impl Fn(usize) -> bool) {
    for (first, pair) in nodes.windows(2).enumerate().filter(|(interval, _)| matters(*interval)) {
        let arc = Arc::new(&pair[0], &pair[1]);
        world.parts_near(arc.bounds().grown(reach), |part| {
            if arc.comes_near(&world.bounds(part), reach, || world.angle(part)) {
                near.push(Near { part, first, last: first + 1 });
            }
        });
    }
}

/// A rod in some shape, being looked at.
struct Looking<'a> {
    world: &'a World<'a>,
    configuration: &'a Configuration,
    shape: &'a Shape,
}

impl Looking<'_> {
    /// The slope angle at a point, whole turns included.
    fn phi(&self, node: &Node) -> f64 {
        let Span { s, start, a, b } = &self.shape.spans[node.span];
        advance(start, *a, *b, node.s - s).phi
    }

    /// The node before the next contact beyond node `i` on a stretch.
    fn before_contact(&self, stretch: usize, i: usize) -> Option<usize> {
        let contacts = self.configuration.contacts.iter().enumerate();
        let own = contacts.filter(|(_, held)| held.stretch == stretch).map(|(j, _)| self.shape.at_contact(j));
        own.map(|at| at - 1).find(|before| *before > i)
    }

    /// Only the tip can get into a notch, and only behind both its pieces: a step that went so far was too long.
    fn scan_notch(&self, part: Part, found: &mut Scan) {
        let Self { world, configuration, shape } = self;
        let Some(tip) = shape.nodes.last().filter(|_| !configuration.ends_at_tip()) else { return };
        let foot = world.foot_in(part, tip.at.x, tip.at.y);
        if foot.interior && foot.gap < -GAP_TOLERANCE && world.goes_through(part.stretch, &foot, tip.at.x, tip.at.y) {
            found.min_gap = found.min_gap.min(foot.gap);
            found.crossings.push(Crossing { stretch: part.stretch, s: 1.0, phi: self.phi(tip), foot, tip: true });
        }
    }

    /// A rod lies on a corner with a slope angle between those of the two pieces. So it goes through where it runs by
    /// the vertex in such a direction, on the side of the solid, and the solid is there: from a sharp corner it may
    /// have cut off the tip without coming nearer to it than outside.
    fn scan_corner(&self, near: Near, found: &mut Scan) {
        let Self { world, shape: Shape { spans, nodes, .. }, .. } = self;
        let Near { part, first, last } = near;
        let corner = Corner::new(world, part.stretch);
        let mut before: Option<(usize, f64)> = None;
        let mut i = first;
        while i <= last {
            let node = &nodes[i];
            let (dx, dy) = (node.at.x - corner.x, node.at.y - corner.y);
            let distance = dx.hypot(dy);
            if distance < found.min_gap && found.min_gap > 0.0 {
                let foot = world.foot_in(part, node.at.x, node.at.y);
                if foot.interior && foot.gap > 0.0 {
                    found.min_gap = foot.gap;
                }
            }
            let ahead = dx * node.at.cos + dy * node.at.sin;
            let own = node.contact.is_some_and(|j| self.configuration.contacts[j].stretch == part.stretch);
            if let Some((_, was)) = before.filter(|(k, _)| k + 1 == i && !own)
                && was < 0.0
                && ahead >= 0.0
            {
                let (s, at) = pass(spans, (&nodes[i - 1], node), (corner.x, corner.y), was, ahead);
                if let Some(passing) = corner.passing(&at)
                    && (passing.gap >= -GAP_TOLERANCE
                        || (passing.gap > -DEEPEST && corner.is_cut(world, &at, &passing, (s, 1.0 - s))))
                {
                    let Passing { gap, alpha, t } = passing;
                    found.min_gap = found.min_gap.min(gap);
                    if gap < -GAP_TOLERANCE {
                        let (x, y) = (corner.x, corner.y);
                        let foot = Foot { t, gap, alpha, curvature: f64::INFINITY, x, y, interior: true };
                        let stretch = part.stretch;
                        found.crossings.push(Crossing { stretch, s, phi: at.phi, foot, tip: false });
                    }
                }
            }
            before = (!own).then_some((i, ahead));
            let safe = node.s + (distance - found.min_gap.clamp(DEEPEST, 1.0)).max(0.0);
            i = last_before(&nodes[..=last], i, safe).max(i + 1);
        }
    }

    fn scan_part(&self, near: Near, found: &mut Scan) {
        let Self { world, configuration, shape: Shape { spans, nodes: all, .. } } = self;
        let Near { part, first, last } = near;
        let (nodes, convex) = (&all[..=last], world.is_convex(part));
        let mut feet = Feet { world, part, nodes, ahead: None };
        let mut before: Option<(usize, Sight, Foot)> = None;
        let mut i = first;
        while let Some(node) = nodes.get(i) {
            let foot = feet.at(i);
            if let Some((_, _, was)) = before.filter(|(k, ..)| k + 1 == i)
                && pierces(&was, &foot)
                && world.is_inside(&part, was.t)
                && world.is_inside(&part, foot.t)
            {
                found.min_gap = found.min_gap.min(-was.gap.abs().min(foot.gap.abs()));
            }
            let mut sight = see(world, node, &foot, configuration, &part);
            if sight.gap < -GAP_TOLERANCE && !world.goes_through(part.stretch, &foot, node.at.x, node.at.y) {
                let none = f64::NAN;
                sight = Sight { gap: -sight.gap, left: none, right: none, interior: false, contact: false, ..sight };
            }
            if sight.interior {
                found.min_gap = found.min_gap.min(sight.gap);
                found.clamp_inside |= i == 0 && sight.gap < -GAP_TOLERANCE;
            } else if sight.gap < found.min_gap && world.is_open_end(part.stretch, &foot) {
                found.min_gap = sight.gap;
            }
            if let Some((_, last, was)) = before.filter(|(k, ..)| k + 1 == i) {
                let last_node = &nodes[i - 1];
                let least = 0.5 * (last.gap.abs() + sight.gap.abs() - (node.s - last_node.s));
                let matters = least < found.min_gap.max(0.0) || last.gap < 0.0 || sight.gap < 0.0;
                // What passes by an end of a straight part passes by the corner there; what meets it between its ends is
                // parallel to it there, and curved: a straight rod lies on a straight edge by the corners.
                let own = last.contact || sight.contact;
                let slopes = match (last.line, sight.line) {
                    (Some(_), Some(_)) if last_node.at.kappa.abs().max(node.at.kappa.abs()) < PARALLEL => None,
                    (Some(right), Some(left)) if !own => Some((right, left, true)),
                    _ => Some((last.right, sight.left, false)),
                };
                if let Some((right, left, line)) = slopes.filter(|_| matters) {
                    let search = Search { world, part, span: &spans[last_node.span], line };
                    let ends = ((last_node.s, right), (node.s, left));
                    if let Some(ends) = search.bracket(ends, [(&last_node.at, &was), (&node.at, &foot)]) {
                        search.run(ends, found);
                    }
                }
            }
            let at_end = i + 1 == all.len();
            let free_end = !configuration.ends_at_tip();
            if at_end && free_end && sight.interior && sight.left < 0.0 && sight.gap < -GAP_TOLERANCE {
                let stretch = part.stretch;
                found.crossings.push(Crossing { stretch, s: 1.0, phi: self.phi(node), foot, tip: true });
            }
            before = Some((i, sight, foot));
            let least = found.min_gap.max(0.0);
            let mut outside = i;
            if convex && sight.interior && !sight.contact {
                let next = self.before_contact(part.stretch, i).filter(|next| *next <= last);
                outside = feet.outside(i, &foot, next, least);
            }
            if outside == last && last > i {
                break;
            }
            // Within the distance by which the gap exceeds the smallest one there is nothing smaller. But the end is looked at
            // in any case: it may be deep inside, where the distance tells nothing.
            let clear = outside.max(last_before(nodes, i, node.s + (sight.gap - least).max(0.0)));
            i = clear.max(i + 1);
        }
    }
}

/// The closest points of a part to nodes of the rod.
struct Feet<'a> {
    world: &'a World<'a>,
    part: Part,
    nodes: &'a [Node],
    /// One that was looked at before its turn.
    ahead: Option<(usize, Foot)>,
}

impl Feet<'_> {
    fn at(&self, i: usize) -> Foot {
        let Node { at, .. } = self.nodes[i];
        let known = self.ahead.filter(|(k, _)| *k == i);
        known.map_or_else(|| self.world.foot_in(self.part, at.x, at.y), |(_, foot)| foot)
    }

    /// The node up to which, from node `i` on, the rod is outside of the part, and farther from it than `least`.
    fn outside(&mut self, i: usize, foot: &Foot, next: Option<usize>, least: f64) -> usize {
        let outside = self.cleared((i, foot), i, least);
        // what is next to a contact tells of all the rod before it, which comes down to there
        let Some(next) = next.filter(|next| outside < *next) else { return outside };
        let foot = self.at(next);
        self.ahead = Some((next, foot));
        self.cleared((next, &foot), outside, least)
    }

    /// The node up to which, from node `from` on, the line at the foot of some node clears the rod of the part.
    fn cleared(&self, (i, foot): (usize, &Foot), from: usize, least: f64) -> usize {
        let line = SupportingLine::new(&self.nodes[i], foot);
        let count = line.map_or(0, |line| line.clears(&self.nodes[from..], least));
        from + count.saturating_sub(1)
    }
}

/// On which side of the rod, and how far, the ends of open contours are.
fn sides(world: &World<'_>, shape: &Shape) -> SmallVec<[f64; 2]> {
    let side = |&(x, y): &(f64, f64)| {
        let sides = shape.nodes.windows(2).filter_map(|pair| {
            let ahead = |Node { at, .. }: &Node| (at.x - x) * at.cos + (at.y - y) * at.sin;
            let (before, after) = (ahead(&pair[0]), ahead(&pair[1]));
            (before < 0.0 && after >= 0.0).then(|| {
                let (_, at) = pass(&shape.spans, (&pair[0], &pair[1]), (x, y), before, after);
                let (sin, cos) = at.phi.sin_cos();
                (y - at.y) * cos - (x - at.x) * sin
            })
        });
        sides.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
    };
    world.open_ends().iter().map(side).collect()
}

/// The search of the smallest gap to a part between two neighbouring nodes of a span of the rod.
struct Search<'a> {
    world: &'a World<'a>,
    part: Part,
    span: &'a Span,
    /// Whether the slope is that of the gap to the line that the part belongs to.
    line: bool,
}

/// An arc length, and the slope of the gap there.
type Sloped = (f64, f64);

impl Search<'_> {
    /// Slope of the gap along the rod, where the rod is, and the closest point of the part.
    fn look(&self, s: f64) -> (f64, Section, Foot) {
        let Span { s: from, start, a, b } = self.span;
        let at = advance(start, *a, *b, s - from);
        let foot = self.world.foot_in(self.part, at.x, at.y);
        let station = Station::from(&at);
        (if self.line { towards(&station, &foot) } else { slope(&station, &foot) }, at, foot)
    }

    /// Where the slope changes from falling to rising. Under a large force the gap may fall, rise and fall again
    /// between two nodes: a slope of one sign that comes nearer to zero at both ends, by its own changes there, is
    /// looked at in between.
    fn bracket(&self, (first, last): (Sloped, Sloped), seen: [(&Station, &Foot); 2]) -> Option<(Sloped, Sloped)> {
        if first.1 < 0.0 && last.1 >= 0.0 {
            return Some((first, last));
        }
        let curved = seen.map(|(at, foot)| at.kappa.abs() + foot.curvature.abs());
        if first.1.abs().min(last.1.abs()) > (last.0 - first.0) * curved[0].max(curved[1]) {
            return None;
        }
        let [bend, last_bend] = seen.map(|(at, foot)| bend(at, foot));
        let (falls, rises) = (first.1 < 0.0 && last.1 < 0.0, first.1 >= 0.0 && last.1 >= 0.0);
        let dips = (falls && bend > 0.0 && last_bend < 0.0) || (rises && bend < 0.0 && last_bend > 0.0);
        if !dips {
            return None;
        }
        let s = first.0 + (last.0 - first.0) * bend / (bend - last_bend);
        let (slope, ..) = self.look(s);
        match (falls, slope < 0.0) {
            (true, false) => Some((first, (s, slope))),
            (false, true) => Some(((s, slope), last)),
            _ => None,
        }
    }

    /// The smallest gap between two points, where its slope changes sign.
    fn run(&self, (mut lo, mut hi): (Sloped, Sloped), found: &mut Scan) {
        // regula falsi, the slope at the end that stays halved each time; the gap is stationary, so half the digits of
        // s give all of its own
        let mut s = 0.5 * (lo.0 + hi.0);
        let mut best = self.look(s);
        for _ in 0..40 {
            if best.0.abs() < 1e-9 || hi.0 - lo.0 < 1e-10 {
                break;
            }
            if best.0 < 0.0 {
                lo = (s, best.0);
                hi.1 *= 0.5;
            } else {
                hi = (s, best.0);
                lo.1 *= 0.5;
            }
            s = (lo.0 * hi.1 - hi.0 * lo.1) / (hi.1 - lo.1);
            best = self.look(s);
        }
        let Self { world, part, .. } = self;
        let (_, at, foot) = best;
        if is_square(world, part.stretch, &at, &foot)
            && (foot.gap > -GAP_TOLERANCE || world.goes_through(part.stretch, &foot, at.x, at.y))
        {
            found.min_gap = found.min_gap.min(foot.gap);
            if foot.gap < -GAP_TOLERANCE {
                found.crossings.push(Crossing { stretch: part.stretch, s, phi: at.phi, foot, tip: false });
            }
        } else if world.goes_on(part.stretch, &foot) {
            // across something thin, whose other side is the next part: it has gone too deep to tell where it went in
            found.min_gap = found.min_gap.min(world.gap(at.x, at.y));
        }
    }
}

/// The last node from node `i` on before the arc length `s`.
fn last_before(nodes: &[Node], i: usize, s: f64) -> usize {
    let beyond = nodes[i..].iter().take_while(|node| node.s < s).count();
    i + beyond.saturating_sub(1)
}

/// Where between two nodes the rod runs by a point: the arc length, and the section; (r - point) . tangent is given at
/// both.
fn pass(spans: &[Span], nodes: (&Node, &Node), point: (f64, f64), before: f64, after: f64) -> (f64, Section) {
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
    (s, at)
}

/// The gap at each of some nodes, or, where that is far from the smallest one, no more than that.
fn gaps<'n>(world: &World<'_>, nodes: impl Iterator<Item = &'n Node>) -> SmallVec<[f64; 64]> {
    let (mut least, mut seen) = (f64::INFINITY, (f64::NAN, f64::NAN));
    let gap = |node: &Node| {
        // the gap changes no faster than the rod runs
        let known = seen.1 - (node.s - seen.0);
        if known > least.max(0.0) {
            return known;
        }
        let gap = world.gap(node.at.x, node.at.y);
        (least, seen) = (gap.min(least), (node.s, gap));
        gap
    };
    nodes.map(gap).collect()
}

/// Slope of the gap along the rod: of the distance to the foot where that is an end of the part.
fn slope(at: &Station, foot: &Foot) -> f64 {
    let (nx, ny) = foot.uphill(at.x, at.y);
    nx * at.cos + ny * at.sin
}

/// Slope of the gap to the contour's tangent: minus the sine of the angle between rod and contour.
fn towards(at: &Station, foot: &Foot) -> f64 {
    let (nx, ny) = foot.normal();
    nx * at.cos + ny * at.sin
}

/// Change of the slope of the gap along the rod.
fn bend(at: &Station, foot: &Foot) -> f64 {
    let (sin_alpha, cos_alpha) = foot.alpha.sin_cos();
    let cos = at.cos * cos_alpha + at.sin * sin_alpha;
    cos * (foot.curvature * cos / (1.0 + foot.curvature * foot.gap) - at.kappa)
}

/// Whether the rod goes through a part between two of its nodes, from one side to the other: through something thin,
/// that is behind it again at the next node.
fn pierces(was: &Foot, foot: &Foot) -> bool {
    let sides = was.gap.min(foot.gap) < -PARALLEL && was.gap.max(foot.gap) > PARALLEL;
    sides && was.interior && foot.interior && (was.alpha - foot.alpha).cos() > LEAST_COSINE
}

/// Whether the foot is a perpendicular one; where the contour goes on smoothly beyond the part and rounding decides
/// which of the two it is on, for both.
fn is_square(world: &World<'_>, stretch: usize, at: &Section, foot: &Foot) -> bool {
    let (sin, cos) = foot.alpha.sin_cos();
    let square = ((at.x - foot.x) * cos + (at.y - foot.y) * sin).abs() < PARALLEL;
    foot.interior || (square && world.goes_on(stretch, foot))
}

fn see(world: &World<'_>, node: &Node, foot: &Foot, configuration: &Configuration, part: &Part) -> Sight {
    // beyond an end the sign is that of the tangent there, and says nothing
    let gap = if foot.interior { foot.gap } else { foot.gap.abs() };
    let left = slope(&node.at, foot);
    let line = (foot.curvature == 0.0).then(|| if foot.interior { left } else { towards(&node.at, foot) });
    let mut sight = Sight { gap, left, right: left, interior: foot.interior, contact: false, line };
    if let Some(j) = node.contact
        && configuration.contacts[j].stretch == part.stretch
        && world.holds(part, configuration.t(j))
        && let Hold::Tangent { offset } = configuration.contacts[j].hold
    {
        // A contact is a minimum of the gap itself, unless the rod is more curved towards the solid than the contour.
        let bend = if foot.interior { foot.curvature - node.at.kappa * offset.cos() } else { 1.0 };
        let sign = if bend >= 0.0 || bend.is_nan() { 1.0 } else { -1.0 };
        (sight.left, sight.right, sight.contact) = (-sign, sign, true);
    }
    sight
}
