//! The gap between the whole rod and the contour: smallest value, and where the rod goes through.

use crate::configuration::{Configuration, Span};
use crate::path::ClampPath;
use crate::world::{Foot, World};
use rod_contours::{Stretch, StretchKind};
use rod_core::{Hold, Section, advance, walk};
use smallvec::SmallVec;

/// Distance between the points of the rod that are looked at. Between them the gap is bounded by its slope (a rod moves
/// through the plane with unit speed, so the gap is 1-Lipschitz), and the smallest value is searched wherever it could matter.
const SPACING: f64 = 1.0 / 32.0;

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
}

#[derive(Clone, Copy, Debug)]
struct Node {
    s: f64,
    at: Section,
    span: usize,
    /// The contact that is here.
    contact: Option<usize>,
}

/// A node seen from one stretch.
#[derive(Clone, Copy)]
struct Sight {
    gap: f64,
    /// Slope of the gap along the rod, to the left and to the right of the node.
    left: f64,
    right: f64,
    interior: bool,
}

/// Reusable memory of [`scan`](Scanner::scan).
#[derive(Debug, Default)]
pub(crate) struct Scanner {
    nodes: Vec<Node>,
}

impl Scanner {
    /// Looks at the whole rod in `configuration`.
    pub fn scan(&mut self, world: &World<'_>, path: &ClampPath, configuration: &Configuration) -> Scan {
        let spans = configuration.spans(world, path);
        self.place_nodes(&spans);
        // where there is a contact, there the gap is zero
        let least = if configuration.count() > 0 { 0.0 } else { f64::INFINITY };
        let mut found = Scan { min_gap: least, crossings: SmallVec::new(), clamp_inside: false };
        for (stretch, Stretch { kind, .. }) in world.stretches().iter().enumerate() {
            if matches!(kind, StretchKind::Notch { .. }) {
                self.scan_notch(world, configuration, stretch, &mut found);
            } else {
                self.scan_stretch(world, configuration, &spans, stretch, &mut found);
            }
        }
        found
    }

    /// Only the tip can get into a notch, and only behind both its pieces: a step that went so far was too long.
    fn scan_notch(&self, world: &World<'_>, configuration: &Configuration, stretch: usize, found: &mut Scan) {
        let Some(tip) = self.nodes.last().filter(|_| !configuration.ends_at_tip()) else { return };
        let foot = world.foot(stretch, tip.at.x, tip.at.y);
        if foot.interior && foot.gap < -GAP_TOLERANCE && world.goes_through(&foot, tip.at.x, tip.at.y) {
            found.min_gap = found.min_gap.min(foot.gap);
            found.crossings.push(Crossing { stretch, s: 1.0, phi: tip.at.phi, foot, tip: true });
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
            let steps = (length / SPACING).ceil() as usize;
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

    fn scan_stretch(
        &self,
        world: &World<'_>,
        configuration: &Configuration,
        spans: &[Span],
        stretch: usize,
        found: &mut Scan,
    ) {
        let nodes = &self.nodes;
        let mut before: Option<(usize, Sight)> = None;
        let mut i = 0;
        while let Some(node) = nodes.get(i) {
            let foot = world.foot(stretch, node.at.x, node.at.y);
            let mut sight = see(node, &foot, configuration, stretch);
            if sight.gap < -GAP_TOLERANCE && !world.goes_through(&foot, node.at.x, node.at.y) {
                sight = Sight { gap: -sight.gap, left: f64::NAN, right: f64::NAN, interior: false };
            }
            if sight.interior {
                found.min_gap = found.min_gap.min(sight.gap);
                found.clamp_inside |= i == 0 && sight.gap < -GAP_TOLERANCE;
            }
            if let Some((_, last)) = before.filter(|(k, _)| k + 1 == i) {
                let last_node = &nodes[i - 1];
                let least = 0.5 * (last.gap.abs() + sight.gap.abs() - (node.s - last_node.s));
                let matters = least < found.min_gap.max(0.0) || last.gap < 0.0 || sight.gap < 0.0;
                if last.right < 0.0 && sight.left >= 0.0 && matters {
                    self.search(world, spans, stretch, (last_node, node), (last.right, sight.left), found);
                }
            }
            let at_end = i + 1 == nodes.len();
            let free_end = !configuration.ends_at_tip();
            if at_end && free_end && sight.interior && sight.left < 0.0 && sight.gap < -GAP_TOLERANCE {
                found.crossings.push(Crossing { stretch, s: 1.0, phi: node.at.phi, foot, tip: true });
            }
            before = Some((i, sight));
            // within the distance by which the gap exceeds the smallest one there is nothing smaller
            let safe = node.s + (sight.gap - found.min_gap.max(0.0)).max(0.0);
            i += 1;
            while i + 1 < nodes.len() && nodes[i].s < safe && nodes[i + 1].s < safe {
                i += 1;
            }
        }
    }

    /// The smallest gap between two neighbouring nodes, where its slope changes sign.
    fn search(
        &self,
        world: &World<'_>,
        spans: &[Span],
        stretch: usize,
        nodes: (&Node, &Node),
        slopes: (f64, f64),
        found: &mut Scan,
    ) {
        let span = &spans[nodes.0.span];
        let look = |s: f64| {
            let at = advance(&span.start, span.a, span.b, s - span.s);
            let foot = world.foot(stretch, at.x, at.y);
            (slope(&at, &foot), at, foot)
        };
        // regula falsi, the slope at the end that stays halved each time; the gap is stationary, so half the digits of s give all of its own
        let (mut lo, mut hi) = ((nodes.0.s, slopes.0), (nodes.1.s, slopes.1));
        let mut best = look(0.5 * (lo.0 + hi.0));
        let mut s = 0.5 * (lo.0 + hi.0);
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
            best = look(s);
        }
        let (_, at, foot) = best;
        if foot.interior && (foot.gap > -GAP_TOLERANCE || world.goes_through(&foot, at.x, at.y)) {
            found.min_gap = found.min_gap.min(foot.gap);
            if foot.gap < -GAP_TOLERANCE {
                found.crossings.push(Crossing { stretch, s, phi: at.phi, foot, tip: false });
            }
        }
    }
}

/// Slope of the gap along the rod: of the distance to the foot where that is an end of the stretch.
fn slope(at: &Section, foot: &Foot) -> f64 {
    if foot.interior {
        return -(at.phi - foot.alpha).sin();
    }
    let (sin, cos) = at.phi.sin_cos();
    let (dx, dy) = (at.x - foot.x, at.y - foot.y);
    (dx * cos + dy * sin) / dx.hypot(dy).max(f64::MIN_POSITIVE)
}

fn see(node: &Node, foot: &Foot, configuration: &Configuration, stretch: usize) -> Sight {
    let mut sight = Sight { gap: foot.gap, left: slope(&node.at, foot), right: 0.0, interior: foot.interior };
    sight.right = sight.left;
    if let Some(j) = node.contact
        && configuration.contacts[j].stretch == stretch
        && let Hold::Tangent { offset } = configuration.contacts[j].hold
    {
        // A contact is a minimum of the gap itself, unless the rod is more curved towards the solid than the contour.
        let bend = if foot.interior { foot.curvature - node.at.kappa * offset.cos() } else { 1.0 };
        let sign = if bend >= 0.0 || bend.is_nan() { 1.0 } else { -1.0 };
        (sight.left, sight.right) = (-sign, sign);
    }
    sight
}
