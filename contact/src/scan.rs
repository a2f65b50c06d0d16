//! The gap between the whole rod and the contour: smallest value, and where the rod goes through.

use crate::arc::Arc;
use crate::configuration::{Configuration, Span};
use crate::corner::{Corner, Passing};
use crate::path::ClampPath;
use crate::world::{Foot, World};
use rod_contours::{Bounds, Part, StretchKind};
use rod_core::{Hold, Section, advance, walk};
use smallvec::SmallVec;

/// Distance between the points of the rod that are looked at. Between them the gap is bounded by its slope (a rod moves
/// through the plane with unit speed, so the gap is 1-Lipschitz), and the smallest value is searched wherever it could
/// matter.
const SPACING: f64 = 1.0 / 32.0;

/// Largest distance between them in the elastica's own wavelength, in units of the square root of EI over the force; and
/// the smallest one, whatever the force.
const LARGEST_PHASE: f64 = 0.5;
const SMALLEST_SPACING: f64 = 1.0 / 512.0;

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

/// A point of the rod that is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub s: f64,
    pub at: Section,
    span: usize,
    /// The contact that is here.
    contact: Option<usize>,
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

/// Reusable memory of [`scan`](Scanner::scan).
#[derive(Debug, Default)]
pub(crate) struct Scanner {
    nodes: Vec<Node>,
    near: Vec<Near>,
}

impl Scanner {
    /// Looks at the whole rod in `configuration`.
    pub fn scan(&mut self, world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Scan {
        let spans = configuration.spans(world, path);
        self.place_nodes(&spans);
        // where there is a contact, there the gap is zero
        let least = if configuration.count() > 0 { 0.0 } else { f64::INFINITY };
        let mut found =
            Scan { min_gap: least, crossings: SmallVec::new(), clamp_inside: false, sides: self.sides(world, &spans) };
        self.look_around(world, least);
        for near in &self.near {
            match world.kind(near.part.stretch) {
                StretchKind::Piece(_) => self.scan_part(world, configuration, &spans, *near, &mut found),
                StretchKind::Corner { .. } => self.scan_corner(world, configuration, &spans, *near, &mut found),
                StretchKind::Notch { .. } => self.scan_notch(world, configuration, near.part, &mut found),
            }
        }
        found
    }

    /// On which side of the rod, and how far, the ends of open contours are.
    fn sides(&self, world: &World<'_>, spans: &[Span]) -> SmallVec<[f64; 2]> {
        let side = |&(x, y): &(f64, f64)| {
            let sides = self.nodes.windows(2).filter_map(|pair| {
                let ahead = |node: &Node| {
                    let (sin, cos) = node.at.phi.sin_cos();
                    (node.at.x - x) * cos + (node.at.y - y) * sin
                };
                let (before, after) = (ahead(&pair[0]), ahead(&pair[1]));
                (before < 0.0 && after >= 0.0).then(|| {
                    let (_, at) = pass(spans, (&pair[0], &pair[1]), (x, y), before, after);
                    let (sin, cos) = at.phi.sin_cos();
                    (y - at.y) * cos - (x - at.x) * sin
                })
            });
            sides.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(f64::NAN)
        };
        world.open_ends().iter().map(side).collect()
    }

    /// Lists the parts of the contours that the rod could be nearer to than `least`.
    fn look_around(&mut self, world: &World<'_>, least: f64) {
        self.near.clear();
        let last = self.nodes.len() - 1;
        if world.is_small() {
            world.parts_near(Bounds::ALL, |part| self.near.push(Near { part, first: 0, last }));
            return;
        }
        // as far as it could be to what is nearest, or as deep as it could have gone in
        let reach = |gap: f64| if gap < 0.0 { -2.0 * gap } else { gap };
        if least > 0.0 {
            let gap = least_gap(world, self.nodes.iter());
            self.look_within(world, reach(gap));
        } else {
            self.look_within(world, 0.0);
            // as they come, interval after interval
            let intervals = self.near.chunk_by(|a, b| a.first == b.first).filter_map(|near| near.first());
            let gap = least_gap(world, intervals.flat_map(|near| &self.nodes[near.first..=near.last]));
            if gap < -GAP_TOLERANCE {
                self.near.clear();
                self.look_within(world, reach(gap));
            }
        }
        let near = &mut self.near;
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

    /// Lists the parts that each interval between two nodes could be nearer to than `reach`.
    fn look_within(&mut self, world: &World<'_>, reach: f64) {
        let Self { nodes, near } = self;
        for (first, pair) in nodes.windows(2).enumerate() {
            let arc = Arc::new(&pair[0], &pair[1]);
            world.parts_near(arc.bounds().grown(reach), |part| {
                if arc.comes_near(&world.bounds(part), reach, || world.angle(part)) {
                    near.push(Near { part, first, last: first + 1 });
                }
            });
        }
    }

    /// Only the tip can get into a notch, and only behind both its pieces: a step that went so far was too long.
    fn scan_notch(&self, world: &World<'_>, configuration: &Configuration, part: Part, found: &mut Scan) {
        let Some(tip) = self.nodes.last().filter(|_| !configuration.ends_at_tip()) else { return };
        let foot = world.foot_in(part, tip.at.x, tip.at.y);
        if foot.interior && foot.gap < -GAP_TOLERANCE && world.goes_through(part.stretch, &foot, tip.at.x, tip.at.y) {
            found.min_gap = found.min_gap.min(foot.gap);
            found.crossings.push(Crossing { stretch: part.stretch, s: 1.0, phi: tip.at.phi, foot, tip: true });
        }
    }

    fn place_nodes(&mut self, spans: &[Span]) {
        self.nodes.clear();
        for (i, span) in spans.iter().enumerate() {
            let contact = i.checked_sub(1);
            let end = spans.get(i + 1).map_or(1.0, |next| next.s);
            let length = end - span.s;
            self.nodes.push(Node { s: span.s, at: span.start, span: i, contact });
            if length <= 0.0 {
                continue;
            }
            let steps = ((length / spacing(span)).ceil() as usize).max(1);
            // the last section of a span is the first of the next, where it is known better
            let keep = if i + 1 < spans.len() { steps - 1 } else { steps };
            let h = length / steps as f64;
            let sections = walk(&span.start, span.a, span.b, length, steps).take(keep).enumerate();
            self.nodes.extend(sections.map(|(k, at)| Node {
                s: span.s + h * (k + 1) as f64,
                at,
                span: i,
                contact: None,
            }));
        }
    }

    /// A rod lies on a corner with a slope angle between those of the two pieces. So it goes through where it runs by
    /// the vertex in such a direction, on the side of the solid, and the solid is there: from a sharp corner it may
    /// have cut off the tip without coming nearer to it than outside.
    fn scan_corner(
        &self,
        world: &World<'_>,
        configuration: &Configuration,
        spans: &[Span],
        near: Near,
        found: &mut Scan,
    ) {
        let Near { part, first, last } = near;
        let corner = Corner::new(world, part.stretch);
        let mut before: Option<(usize, f64)> = None;
        let mut i = first;
        while i <= last {
            let node = &self.nodes[i];
            let (dx, dy) = (node.at.x - corner.x, node.at.y - corner.y);
            let distance = dx.hypot(dy);
            if distance < found.min_gap && found.min_gap > 0.0 {
                let foot = world.foot_in(part, node.at.x, node.at.y);
                if foot.interior && foot.gap > 0.0 {
                    found.min_gap = foot.gap;
                }
            }
            let (sin, cos) = node.at.phi.sin_cos();
            let ahead = dx * cos + dy * sin;
            let own = node.contact.is_some_and(|j| configuration.contacts[j].stretch == part.stretch);
            if let Some((_, was)) = before.filter(|(k, _)| k + 1 == i && !own)
                && was < 0.0
                && ahead >= 0.0
            {
                let (s, at) = pass(spans, (&self.nodes[i - 1], node), (corner.x, corner.y), was, ahead);
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
            i = next_beyond(&self.nodes[..=last], i, safe);
        }
    }

    fn scan_part(
        &self,
        world: &World<'_>,
        configuration: &Configuration,
        spans: &[Span],
        near: Near,
        found: &mut Scan,
    ) {
        let Near { part, first, last } = near;
        let nodes = &self.nodes[..=last];
        let mut before: Option<(usize, Sight, Foot)> = None;
        let mut i = first;
        while let Some(node) = nodes.get(i) {
            let foot = world.foot_in(part, node.at.x, node.at.y);
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
            let at_end = i + 1 == self.nodes.len();
            let free_end = !configuration.ends_at_tip();
            if at_end && free_end && sight.interior && sight.left < 0.0 && sight.gap < -GAP_TOLERANCE {
                let stretch = part.stretch;
                found.crossings.push(Crossing { stretch, s: 1.0, phi: node.at.phi, foot, tip: true });
            }
            before = Some((i, sight, foot));
            // within the distance by which the gap exceeds the smallest one there is nothing smaller
            let safe = node.s + (sight.gap - found.min_gap.max(0.0)).max(0.0);
            i = next_beyond(nodes, i, safe);
        }
    }
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
        (if self.line { -(at.phi - foot.alpha).sin() } else { slope(&at, &foot) }, at, foot)
    }

    /// Where the slope changes from falling to rising. Under a large force the gap may fall, rise and fall again
    /// between two nodes: a slope of one sign that comes nearer to zero at both ends, by its own changes there, is
    /// looked at in between.
    fn bracket(&self, (first, last): (Sloped, Sloped), seen: [(&Section, &Foot); 2]) -> Option<(Sloped, Sloped)> {
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

/// Distance between the nodes of a span.
fn spacing(span: &Span) -> f64 {
    (LARGEST_PHASE / span.a.hypot(span.b).sqrt()).clamp(SMALLEST_SPACING, SPACING)
}

/// The node after node `i`, or the last one after which an interval goes beyond the arc length `safe`.
fn next_beyond(nodes: &[Node], mut i: usize, safe: f64) -> usize {
    i += 1;
    while i + 1 < nodes.len() && nodes[i].s < safe && nodes[i + 1].s < safe {
        i += 1;
    }
    i
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

/// An upper bound of the smallest gap: that of the nodes.
fn least_gap<'n>(world: &World<'_>, nodes: impl Iterator<Item = &'n Node>) -> f64 {
    let (mut least, mut safe) = (f64::INFINITY, f64::NEG_INFINITY);
    for node in nodes {
        // the gap changes no faster than the rod runs
        if node.s >= safe {
            let gap = world.gap(node.at.x, node.at.y);
            least = gap.min(least);
            safe = node.s + gap - least.max(0.0);
        }
    }
    least
}

/// Slope of the gap along the rod: of the distance to the foot where that is an end of the part.
fn slope(at: &Section, foot: &Foot) -> f64 {
    if foot.interior {
        return -(at.phi - foot.alpha).sin();
    }
    let (sin, cos) = at.phi.sin_cos();
    let (dx, dy) = (at.x - foot.x, at.y - foot.y);
    (dx * cos + dy * sin) / dx.hypot(dy).max(f64::MIN_POSITIVE)
}

/// Change of the slope of the gap along the rod.
fn bend(at: &Section, foot: &Foot) -> f64 {
    let cos = (at.phi - foot.alpha).cos();
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
    let line = (foot.curvature == 0.0).then(|| -(node.at.phi - foot.alpha).sin());
    let left = slope(&node.at, foot);
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
