//! The objects as seen by brute force: points along each piece, from its frames, and the nearest of them, found exactly by
//! bisection. Lengths of the rod.

use std::f64::consts::TAU;
use vibrissa::Composite;
use vibrissa::contour::{Frame, StretchKind};

/// Largest turn, rad, and length between two points.
const TURN: f64 = 0.08;
const CHORD: f64 = 0.04;
/// A contour that goes on for ever is looked at up to here.
const FAR: f64 = 6.0;
/// Fewest segments of a box.
const BOXED: usize = 8;

/// A piece of an object.
#[derive(Debug)]
pub struct Strip {
    pub stretch: usize,
    pub piece: usize,
    nodes: Vec<Node>,
    boxes: Vec<[f64; 4]>,
    /// Segments of a box: few in each of few boxes.
    boxed: usize,
    /// What is at its first and at its last point.
    ends: [End; 2],
}

#[derive(Clone, Copy, Debug)]
struct Node {
    u: f64,
    x: f64,
    y: f64,
}

/// How a piece ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    Smooth,
    Corner,
    Notch,
    Open,
}

/// The nearest point of a contour.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// Signed distance, negative inside the solid; that to an open end is positive.
    pub gap: f64,
    pub strip: usize,
    pub u: f64,
    pub alpha: f64,
    /// Where it is an end of its piece.
    pub end: Option<End>,
}

/// A corner or notch.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    pub stretch: usize,
    pub before: usize,
    pub x: f64,
    pub y: f64,
    pub alpha: f64,
    /// How far the angle grows (corner) or falls (notch).
    pub turn: f64,
}

/// One object.
#[derive(Debug)]
pub struct Outline<'a> {
    contour: &'a Composite,
    length: f64,
    pub strips: Vec<Strip>,
    pub vertices: Vec<Vertex>,
}

impl<'a> Outline<'a> {
    pub fn new(contour: &'a Composite, length: f64) -> Self {
        let mut outline = Self { contour, length, strips: Vec::new(), vertices: Vec::new() };
        for stretch in 0..contour.stretches().len() {
            match contour.kind(stretch) {
                StretchKind::Piece(piece) => outline.add_strip(stretch, piece),
                kind => {
                    let start = contour.own_frame(stretch, 0.0);
                    let turn = contour.own_range(stretch).length();
                    let (before, sign) = match kind {
                        StretchKind::Corner { before } => (before, 1.0),
                        StretchKind::Notch { before } => (before, -1.0),
                        StretchKind::Piece(_) => continue,
                    };
                    let (x, y) = (start.x / length, start.y / length);
                    outline.vertices.push(Vertex { stretch, before, x, y, alpha: start.alpha, turn: sign * turn });
                }
            }
        }
        outline
    }

    fn add_strip(&mut self, stretch: usize, piece: usize) {
        let Self { contour, length, .. } = *self;
        let range = contour.own_range(stretch);
        // what goes on for ever is given by x, and is farther than its x
        let far = FAR * length;
        let ends = [(range.from.is_finite(), false), (range.to.is_finite(), true)].map(|(finite, after)| match contour
            .neighbour(stretch, after)
            .map(|next| contour.kind(next))
        {
            _ if !finite => End::Open,
            None => End::Open,
            Some(StretchKind::Piece(_)) => End::Smooth,
            Some(StretchKind::Corner { .. }) => End::Corner,
            Some(StretchKind::Notch { .. }) => End::Notch,
        });
        let from = if range.from.is_finite() { range.from } else { range.to.min(0.0) - far };
        let to = if range.to.is_finite() { range.to } else { range.from.max(0.0) + far };
        let mut nodes = vec![self.node(stretch, from)];
        const CELLS: usize = 48;
        let at = |i: usize| if i == CELLS { to } else { from + (to - from) * i as f64 / CELLS as f64 };
        for i in 0..CELLS {
            self.refine(stretch, at(i), at(i + 1), 0, &mut nodes);
        }
        let bounds = |segments: &[Node]| {
            segments.iter().fold([f64::INFINITY, f64::INFINITY, -f64::INFINITY, -f64::INFINITY], |b, n| {
                [b[0].min(n.x), b[1].min(n.y), b[2].max(n.x), b[3].max(n.y)]
            })
        };
        let boxed = nodes.len().isqrt().max(BOXED);
        let boxes = (0..nodes.len() - 1).step_by(boxed).map(|i| bounds(&nodes[i..=(i + boxed).min(nodes.len() - 1)]));
        let boxes = boxes.collect();
        self.strips.push(Strip { stretch, piece, nodes, boxes, boxed, ends });
    }

    fn node(&self, stretch: usize, u: f64) -> Node {
        let Frame { x, y, .. } = self.contour.own_frame(stretch, u);
        Node { u, x: x / self.length, y: y / self.length }
    }

    fn refine(&self, stretch: usize, from: f64, to: f64, depth: usize, nodes: &mut Vec<Node>) {
        let [a, b] = [from, to].map(|u| self.contour.own_frame(stretch, u));
        let middle = 0.5 * (from + to);
        let m = self.contour.own_frame(stretch, middle);
        let chord = (b.x - a.x).hypot(b.y - a.y) / self.length;
        let turn = (m.alpha - a.alpha).abs() + (b.alpha - m.alpha).abs();
        if depth < 12 && (turn > TURN || (chord > CHORD && turn > 1e-12) || chord > 0.5) {
            self.refine(stretch, from, middle, depth + 1, nodes);
            self.refine(stretch, middle, to, depth + 1, nodes);
        } else {
            nodes.push(self.node(stretch, to));
        }
    }

    /// The frame of a strip, in lengths of the rod.
    fn frame(&self, strip: usize, u: f64) -> Frame {
        let frame = self.contour.own_frame(self.strips[strip].stretch, u);
        Frame { x: frame.x / self.length, y: frame.y / self.length, ..frame }
    }

    /// The nearest point of the whole contour.
    pub fn foot(&self, x: f64, y: f64) -> Foot {
        // How far an arc may be from its chord, and then some: CHORD * TURN / 8.
        const OFF: f64 = 1e-3;
        // no box is farther than the farthest of its corners
        let boxes = self.strips.iter().flat_map(|strip| &strip.boxes);
        let farthest = |b: &[f64; 4]| (x - b[0]).max(b[2] - x).hypot((y - b[1]).max(b[3] - y));
        let mut least = boxes.map(farthest).fold(f64::INFINITY, f64::min);
        for strip in &self.strips {
            for (k, bounds) in strip.boxes.iter().enumerate() {
                if box_distance(bounds, x, y) < least {
                    for pair in segments(strip, k) {
                        least = least.min(segment_distance(pair, x, y));
                    }
                }
            }
        }
        let mut best: Option<(f64, Foot)> = None;
        for (index, strip) in self.strips.iter().enumerate() {
            for (k, bounds) in strip.boxes.iter().enumerate() {
                if box_distance(bounds, x, y) > least + OFF {
                    continue;
                }
                for pair in segments(strip, k) {
                    if segment_distance(pair, x, y) <= least + OFF {
                        let (distance, foot) = self.exact(index, pair, x, y);
                        if best.is_none_or(|(d, _)| distance < d) {
                            best = Some((distance, foot));
                        }
                    }
                }
            }
        }
        best.unwrap().1
    }

    /// The nearest point of one piece.
    pub fn foot_on(&self, strip: usize, x: f64, y: f64) -> Foot {
        let nodes = &self.strips[strip].nodes;
        let feet = nodes.windows(2).map(|pair| self.exact(strip, pair, x, y));
        feet.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1
    }

    /// The nearest point between two neighbouring nodes: distance, and foot.
    fn exact(&self, strip: usize, pair: &[Node], x: f64, y: f64) -> (f64, Foot) {
        let along = |u: f64| {
            let f = self.frame(strip, u);
            let (sin, cos) = f.alpha.sin_cos();
            ((f.x - x) * cos + (f.y - y) * sin, f)
        };
        let (mut lo, mut hi) = (pair[0].u, pair[1].u);
        let ((mut at_lo, first), (mut at_hi, last)) = (along(lo), along(hi));
        let (u, f) = if at_lo >= 0.0 {
            (lo, first)
        } else if at_hi <= 0.0 {
            (hi, last)
        } else {
            // regula falsi with halving
            let mut side = 0;
            let mut best = (lo, first);
            for _ in 0..60 {
                let u = (lo * at_hi - hi * at_lo) / (at_hi - at_lo);
                let (value, f) = along(u);
                best = (u, f);
                if value.abs() < 1e-15 || (hi - lo).abs() < 1e-15 {
                    break;
                }
                if value < 0.0 {
                    (lo, at_lo) = (u, value);
                    if side == -1 {
                        at_hi *= 0.5;
                    }
                    side = -1;
                } else {
                    (hi, at_hi) = (u, value);
                    if side == 1 {
                        at_lo *= 0.5;
                    }
                    side = 1;
                }
            }
            best
        };
        let distance = (f.x - x).hypot(f.y - y);
        let nodes = &self.strips[strip].nodes;
        let end = if u == nodes[0].u {
            Some(self.strips[strip].ends[0])
        } else if u == nodes[nodes.len() - 1].u {
            Some(self.strips[strip].ends[1])
        } else {
            None
        };
        let (sin, cos) = f.alpha.sin_cos();
        let outside = (x - f.x) * sin - (y - f.y) * cos;
        let gap = match end {
            Some(End::Corner | End::Open) => distance,
            Some(End::Notch) => -distance,
            _ => distance.copysign(outside),
        };
        (distance, Foot { gap, strip, u, alpha: f.alpha, end })
    }

    /// How far along a piece its point nearest to this one is, as a share of its parameter.
    pub fn share(&self, strip: usize, x: f64, y: f64) -> f64 {
        let nodes = &self.strips[strip].nodes;
        (self.foot_on(strip, x, y).u - nodes[0].u) / (nodes[nodes.len() - 1].u - nodes[0].u)
    }

    /// Whether a point is inside a closed contour, by how often a ray crosses its nodes' polygon.
    pub fn encloses(&self, x: f64, y: f64) -> Option<bool> {
        if !self.contour.is_closed() {
            return None;
        }
        let mut inside = self.contour.is_cavity();
        for strip in &self.strips {
            let met = |b: &[f64; 4]| b[1] <= y && y <= b[3] && x <= b[2];
            let boxes = strip.boxes.iter().enumerate().filter(|(_, b)| met(b));
            for pair in boxes.flat_map(|(k, _)| segments(strip, k)) {
                let (a, b) = (pair[0], pair[1]);
                if (a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x) {
                    inside = !inside;
                }
            }
        }
        Some(inside)
    }

    /// Whether the curvature changes its sign on the piece of a foot no farther away than this.
    pub fn inflects_near(&self, foot: &Foot, distance: f64) -> bool {
        let here = self.frame(foot.strip, foot.u);
        let turnings =
            self.strips[foot.strip].nodes.iter().filter(|node| (node.x - here.x).hypot(node.y - here.y) < distance);
        let (mut convex, mut concave) = (here.turning > 0.0, here.turning < 0.0);
        for node in turnings {
            let turning = self.frame(foot.strip, node.u).turning;
            (convex, concave) = (convex || turning > 0.0, concave || turning < 0.0);
        }
        convex && concave
    }

    /// Distance from the ends of an open contour.
    pub fn distance_to_open_end(&self, x: f64, y: f64) -> f64 {
        let ends = self.strips.iter().flat_map(|strip| {
            let nodes = [strip.nodes[0], strip.nodes[strip.nodes.len() - 1]];
            nodes.into_iter().zip(strip.ends).filter(|(_, end)| *end == End::Open)
        });
        ends.map(|(node, _)| (node.x - x).hypot(node.y - y)).fold(f64::INFINITY, f64::min)
    }
}

fn segments(strip: &Strip, k: usize) -> impl Iterator<Item = &[Node]> {
    let from = k * strip.boxed;
    strip.nodes[from..=(from + strip.boxed).min(strip.nodes.len() - 1)].windows(2)
}

fn box_distance(b: &[f64; 4], x: f64, y: f64) -> f64 {
    let dx = (b[0] - x).max(x - b[2]).max(0.0);
    let dy = (b[1] - y).max(y - b[3]).max(0.0);
    dx.hypot(dy)
}

fn segment_distance(pair: &[Node], x: f64, y: f64) -> f64 {
    let (a, b) = (pair[0], pair[1]);
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 { (((x - a.x) * dx + (y - a.y) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (a.x + t * dx - x).hypot(a.y + t * dy - y)
}

/// The smallest of the angles that are the same as this one.
pub fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
