//! The multi-point boundary-value problem: a clamped rod held by n supports, for any n.
//!
//! Support j touches the rod at arc length s_j with the force f_j across its tangent angle alpha_j. Each is tangential
//! (the rod lies along it) or, the last one only, at the tip. Unknown are, support by support from the clamp to the tip,
//!
//! ```text
//! t_j  parameter of the support's curve,   f_j  force,   s_j  arc length   (at the tip: the slope angle phi(1) instead)
//! ```
//!
//! Segment j runs backwards from support j to support j - 1 (or the clamp). Its start is known from the unknowns alone:
//! the position and angle of the support, the force (A, B) as the sum over all supports ahead, and the bending moment by
//! moment balance, m_j = - sum_{k > j} (A_k (x_k - x_j) + B_k (y_k - y_j)), so that the closure
//! m(s_n) = 0 holds exactly. Where the segment ends it must meet the support before it, in position and angle: 3
//! equations a support (Merker et al. 2020, eq. 14 to 17 are n = 1 and 2). The segments are independent given the
//! unknowns: no error grows from one to the next.
//!
//! **Friction** ([`Grip`]). A support also pushes along its tangent with f_t, positive in the sense of the curve: the force on the rod is
//! f (sin alpha, -cos alpha) + f_t (cos alpha, sin alpha), so that A gains f cos alpha - f_t sin alpha and B gains f sin alpha + f_t cos alpha.
//! Where the rod slips f_t is a given part of f. Where it sticks or rolls f_t is one more unknown, and one more equation holds: the contact
//! goes as far along the curve as along the rod. These unknowns and equations follow those of all supports, in their order.
//!
//! A roller ahead of the clamp is in the way of segment 0 alone: its two unknowns are eliminated there ([`Roller`](crate::Roller)).
//!
//! A clamp that gives way ([`ClampLaw`]) changes the three equations of segment 0. The moment in them is that at the end of the segment,
//! which is the base of the rod: m0z has the lever of the displaced base.

use super::grip::{Grip, arc_length};
use crate::clamp::{Clamp, ClampLaw, Passage, RollerHold};
use crate::elastica::Elastica;
use crate::model::{Cut, CutSensitivities, RodModel, Uniform, uniform};
use crate::pose::{Pose, Reactions};
use crate::segment::Segment;
use crate::solve::{Link, Links, System};
use crate::units::Units;
use smallvec::SmallVec;

/// A point of a support's curve and its rates by the parameter t: dr/dt = speed (cos alpha, sin alpha),
/// d alpha/dt = turning. The solid is to the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    /// Position.
    pub x: f64,
    /// Position.
    pub y: f64,
    /// Tangent angle, radians.
    pub alpha: f64,
    /// |dr/dt|
    pub speed: f64,
    /// d alpha / dt
    pub turning: f64,
}

/// How a support holds the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// Tangentially: slope angle = alpha + `offset`, a whole multiple of pi (odd where the rod runs against the sense
    /// of the curve, 2 pi and more where it has coiled).
    Tangent {
        /// Slope angle minus tangent angle, radians.
        offset: f64,
    },
    /// At the tip, s = 1. The last support only.
    Tip,
}

/// The supports of a rod, from the clamp to the tip.
pub trait Supports {
    /// How many there are.
    fn count(&self) -> usize;
    /// How number `j` holds the rod.
    fn hold(&self, j: usize) -> Hold;
    /// Number `j` at parameter `t`. Smooth also a little beyond where it ends.
    fn support(&self, j: usize, t: f64) -> Support;
    /// Whether number `j` slips or sticks: without friction unless said otherwise.
    #[inline(always)]
    fn grip(&self, _j: usize) -> Grip {
        Grip::SMOOTH
    }
}

/// The boundary-value problem of a clamped rod of any kind on given supports, dimensionless.
///
/// ```
/// use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, solve};
/// // the tip on a frictionless wall x = 0.5 that is travelled upwards, the solid to its left: it pushes the tip to +x
/// struct Wall;
/// impl Supports for Wall {
///     fn count(&self) -> usize { 1 }
///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
///     fn support(&self, _: usize, t: f64) -> Support {
///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
///     }
/// }
/// let clamp = Pose { x: 0.45, y: 0.0, phi: std::f64::consts::FRAC_PI_2 };
/// let problem = MultiPoint { rod: Uniform, clamp, supports: &Wall };
/// let mut u = [1.0, 0.1, 1.5]; // t, f, phi(1)
/// let report = solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new());
/// assert!(report.status.is_solved() && report.residual < 1e-14);
/// assert!((u[1] - 3.0 * 0.05).abs() < 1e-3); // a cantilever's 3 EI w / L^3
/// ```
#[derive(Clone, Copy, Debug)]
pub struct MultiPoint<'a, S: ?Sized, M = Uniform, C = Pose> {
    /// The rod: a [`RodModel`], or a reference to one.
    pub rod: M,
    /// The clamp, dimensionless: a [`Pose`] is the rigid one.
    pub clamp: C,
    /// What holds the rod.
    pub supports: &'a S,
}

/// One support and what is ahead of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub at: Support,
    pub sin: f64,
    pub cos: f64,
    pub force: f64,
    /// Tangential force, where the rod sticks; 0 where it slips, since it follows from the normal one there.
    pub friction: f64,
    /// Slope angle of the rod there.
    pub phi: f64,
    /// Arc length.
    pub s: f64,
    /// Force on the segment before: sums over this support and all ahead.
    pub a: f64,
    pub b: f64,
    /// Bending moment.
    pub moment: f64,
}

impl Node {
    pub(crate) fn cut(&self) -> Cut {
        Cut { x: self.at.x, y: self.at.y, phi: self.phi, moment: self.moment }
    }

    /// The force of this support alone, as (A, B), and how that changes by the normal force. What has no friction does not pay for it.
    #[inline(always)]
    pub(crate) fn push(&self, grip: Grip) -> [(f64, f64); 2] {
        let Self { sin, cos, force, friction, .. } = *self;
        match grip {
            Grip::SMOOTH => [(force * cos, force * sin), (cos, sin)],
            Grip::Slips { ratio } => {
                // by the operations of a rod that sticks: at the instant at which it begins to slip both are equal to the last bit
                let friction = ratio * force;
                let own = (force * cos - friction * sin, force * sin + friction * cos);
                [own, (cos - ratio * sin, sin + ratio * cos)]
            }
            Grip::Sticks { .. } => [(force * cos - friction * sin, force * sin + friction * cos), (cos, sin)],
        }
    }

    /// The sense in which the rod runs along the curve: 1 along it, -1 against it.
    pub(crate) fn sense(&self) -> f64 {
        1.0_f64.copysign((self.phi - self.at.alpha).cos())
    }
}

/// Weights of the unknowns of a support: t by the way it moves and turns the contact, f (the stiffest of them) relative, s and phi as
/// they are.
#[inline(always)]
pub(crate) fn natural_sizes(at: &Support, force: f64) -> [f64; 3] {
    [at.speed + at.turning.abs(), 0.25 / (1.0 + force.abs()), 1.0]
}

/// Weight of the tangential force of a contact that sticks: that of a normal force.
#[inline(always)]
pub(crate) fn friction_size(friction: f64) -> f64 {
    0.25 / (1.0 + friction.abs())
}

/// Number of contacts from which on the Jacobian is that of links. The inverse of a smaller matrix has a fixed size and is nearly as fast or
/// faster, and its rounding is known.
const LEAST_LINKS: usize = 4;

pub(crate) type Nodes = SmallVec<[Node; 8]>;

impl<S: Supports + ?Sized, M: RodModel, C: Clamp> MultiPoint<'_, S, M, C> {
    /// Appends the supports, each with what is ahead of it.
    #[inline(always)]
    pub(crate) fn nodes(&self, u: &[f64], nodes: &mut Nodes) {
        let n = self.supports.count();
        let mut tangential = 3 * n;
        // in place, one by one: a list that is handed on is copied, and costs as much as a tenth of a solve
        for (j, unknowns) in u.chunks_exact(3).take(n).enumerate() {
            let (t, force, third) = (unknowns[0], unknowns[1], unknowns[2]);
            let at = self.supports.support(j, t);
            let (sin, cos) = at.alpha.sin_cos();
            let (phi, s) = match self.supports.hold(j) {
                Hold::Tangent { offset } => (at.alpha + offset, third),
                Hold::Tip => (third, 1.0),
            };
            let (grip, mut friction) = (self.supports.grip(j), 0.0);
            if grip.sticks() {
                friction = u[tangential];
                tangential += 1;
            }
            let mut node = Node { at, sin, cos, force, friction, phi, s, a: 0.0, b: 0.0, moment: 0.0 };
            [(node.a, node.b), _] = node.push(grip);
            nodes.push(node);
        }
        for j in (1..n).rev() {
            let ahead = nodes[j];
            let node = &mut nodes[j - 1];
            node.moment = ahead.moment + ahead.a * (node.at.x - ahead.at.x) + ahead.b * (node.at.y - ahead.at.y);
            node.a += ahead.a;
            node.b += ahead.b;
        }
    }

    /// Writes the residual (3 a support, and 1 more for each that sticks) and, where asked for, the Jacobian into the leading block of
    /// a column-major matrix with `stride` rows.
    ///
    /// Where the support of the clamp moves, and the unknowns do not, the first three equations change by minus its rate, (x, y, phi):
    /// on springs too, since the reactions follow from the unknowns alone. Only on a pivot the third does not change.
    pub fn evaluate_into(&self, u: &[f64], residual: &mut [f64], jacobian: Option<(&mut [f64], usize)>) {
        let mut nodes = Nodes::new();
        self.nodes(u, &mut nodes);
        match jacobian {
            None => {
                for j in 0..nodes.len() {
                    let (node, s) = (&nodes[j], self.s_before(&nodes, j));
                    let end = match self.clamp.roller() {
                        Some(_) if j == 0 => through_roller(self.passage(&nodes)).0,
                        _ => self.rod.carry(node.s, &node.cut(), node.a, node.b, s - node.s),
                    };
                    self.residual_of(&nodes, j, &end, residual);
                }
                if self.any_sticks(u, &nodes) {
                    self.sticking_residual(&nodes, u, residual);
                }
            }
            Some((matrix, stride)) => {
                for j in 0..nodes.len() {
                    self.segment(&nodes, j, residual, matrix, stride);
                }
                self.sticking_equations(&nodes, u, residual, matrix, stride);
            }
        }
    }

    fn s_before(&self, nodes: &Nodes, j: usize) -> f64 {
        if j == 0 { 0.0 } else { nodes[j - 1].s }
    }

    #[inline(always)]
    fn residual_of(&self, nodes: &Nodes, j: usize, end: &Cut, residual: &mut [f64]) {
        let Pose { x, y, phi } = match j {
            0 => self.clamp.pose(),
            _ => Pose { x: nodes[j - 1].at.x, y: nodes[j - 1].at.y, phi: nodes[j - 1].phi },
        };
        let mut missed = [end.x - x, end.y - y, end.phi - phi];
        if j == 0
            && let Some(law) = self.clamp.law()
        {
            missed = law.residual(missed, &reactions(&nodes[0], end));
        }
        residual[3 * j..3 * j + 3].copy_from_slice(&missed);
    }

    /// The three equations of segment j with their derivatives by all unknowns, and those of the segment.
    #[inline(always)]
    pub(crate) fn segment(
        &self,
        nodes: &Nodes,
        j: usize,
        residual: &mut [f64],
        matrix: &mut [f64],
        stride: usize,
    ) -> CutSensitivities {
        let (end, d) = self.end(nodes, j, residual);
        let node = &nodes[j];
        let mut put = |column: usize, v: [f64; 3]| matrix[column * stride + 3 * j..][..3].copy_from_slice(&v);
        for k in 0..j {
            for column in 3 * k..3 * k + 3 {
                put(column, [0.0; 3]);
            }
        }
        if j > 0 {
            let [by_t, by_s] = by_support_behind(&nodes[j - 1], &d);
            put(3 * (j - 1), by_t);
            put(3 * (j - 1) + 2, by_s);
        }
        for (unknown, column) in self.by_own_support(nodes, j, &d).into_iter().enumerate() {
            put(3 * j + unknown, column);
        }

        // Supports ahead: through the force and the moment they leave here.
        for (k, other) in nodes.iter().enumerate().skip(j + 1) {
            let (dx, dy) = (other.at.x - node.at.x, other.at.y - node.at.y);
            let [(own_a, own_b), (push_a, push_b)] = other.push(self.supports.grip(k));
            let Support { speed, turning, .. } = other.at;
            let moment_by_f = -(dx * push_a + dy * push_b);
            let moment_by_t = -speed * other.force - turning * (dy * own_a - dx * own_b);
            let force_by_t = |i: usize| turning * (own_a * d.by_b[i] - own_b * d.by_a[i]);
            put(3 * k, three(&|i| moment_by_t * d.by_moment[i] + force_by_t(i)));
            put(3 * k + 1, three(&|i| push_a * d.by_a[i] + push_b * d.by_b[i] + moment_by_f * d.by_moment[i]));
            put(3 * k + 2, [0.0; 3]);
        }
        if j == 0
            && let Some(law) = self.clamp.law()
        {
            self.give_way(&law, nodes, &end, matrix, stride);
        }
        d
    }

    /// The end of segment j with its derivatives; writes the three equations.
    #[inline(always)]
    fn end(&self, nodes: &Nodes, j: usize, residual: &mut [f64]) -> (Cut, CutSensitivities) {
        let node = &nodes[j];
        let length = self.s_before(nodes, j) - node.s;
        let (end, d) = match self.clamp.roller() {
            Some(_) if j == 0 => through_roller(self.passage(nodes)),
            _ => self.rod.carry_with_sensitivities(node.s, &node.cut(), node.a, node.b, length),
        };
        self.residual_of(nodes, j, &end, residual);
        (end, d)
    }

    /// The derivatives of the end of segment j by the unknowns of its own support: its point moves the start, its angle turns start and
    /// force.
    #[inline(always)]
    fn by_own_support(&self, nodes: &Nodes, j: usize, d: &CutSensitivities) -> [[f64; 3]; 3] {
        let node = &nodes[j];
        let Support { speed, turning, .. } = node.at;
        let (sin, cos) = (node.sin, node.cos);
        let [(own_a, own_b), (push_a, push_b)] = node.push(self.supports.grip(j));
        let (ahead_a, ahead_b) = nodes.get(j + 1).map_or((0.0, 0.0), |k| (k.a, k.b));
        let moment_by_t = speed * (ahead_a * cos + ahead_b * sin);
        let tangent = matches!(self.supports.hold(j), Hold::Tangent { .. });
        let phi_by_t = if tangent { turning } else { 0.0 };
        let shift = [speed * cos, speed * sin, 0.0];
        let force_by_t = |i: usize| turning * (own_a * d.by_b[i] - own_b * d.by_a[i]);
        [
            three(&|i| shift[i] + phi_by_t * d.by_phi[i] + moment_by_t * d.by_moment[i] + force_by_t(i)),
            three(&|i| push_a * d.by_a[i] + push_b * d.by_b[i]),
            three(&|i| if tangent { d.by_from[i] } else { d.by_phi[i] }),
        ]
    }

    /// Whether the Jacobian is that of [links](Links), which [`link`](Self::link) writes, rather than a matrix. A contact that sticks has
    /// an unknown more than a link.
    #[inline(always)]
    pub(crate) fn is_linked(&self) -> bool {
        self.supports.count() >= LEAST_LINKS && self.sticking().next().is_none()
    }

    /// Writes the three equations of segment j, and their derivatives as a link; returns those of the segment. The sums over the supports
    /// ahead are those of their moments about the first support, of A and of B.
    #[inline(always)]
    pub(crate) fn link(&self, nodes: &Nodes, j: usize, residual: &mut [f64], link: &mut Link) -> CutSensitivities {
        let (end, d) = self.end(nodes, j, residual);
        let (node, first) = (&nodes[j], &nodes[0].at);
        let (x, y) = (node.at.x - first.x, node.at.y - first.y);
        let [(own_a, own_b), (push_a, push_b)] = node.push(self.supports.grip(j));
        let Support { speed, turning, .. } = node.at;
        *link = Link {
            own: self.by_own_support(nodes, j, &d),
            ahead: [
                three(&|i| d.by_moment[i]),
                three(&|i| d.by_a[i] + x * d.by_moment[i]),
                three(&|i| d.by_b[i] + y * d.by_moment[i]),
            ],
            before: if j > 0 { by_support_behind(&nodes[j - 1], &d) } else { [[0.0; 3]; 2] },
            adds: [
                [turning * (own_b * x - own_a * y) - speed * node.force, -turning * own_b, turning * own_a],
                [-(push_a * x + push_b * y), push_a, push_b],
            ],
        };
        if j == 0
            && let Some(law) = self.clamp.law()
        {
            give_way(&law, node, &end, link);
        }
        d
    }

    /// Turns the derivatives of the end of segment 0 in the leading three rows into those of the equations of a clamp that gives way. All
    /// unknowns change the reactions: m(0) = sum f_k ((x(0) - x_k) cos alpha_k + (y(0) - y_k) sin alpha_k).
    fn give_way(&self, law: &ClampLaw, nodes: &Nodes, base: &Cut, matrix: &mut [f64], stride: usize) {
        let (a, b) = (nodes[0].a, nodes[0].b);
        for (k, node) in nodes.iter().enumerate() {
            let (at, [(own_a, own_b), (push_a, push_b)]) = (&node.at, node.push(self.supports.grip(k)));
            let (dx, dy) = (base.x - at.x, base.y - at.y);
            let moment_by_t = at.turning * (dy * own_a - dx * own_b) - node.force * at.speed;
            let by_t = [-at.turning * own_b, at.turning * own_a, moment_by_t];
            let by_force = [push_a, push_b, dx * push_a + dy * push_b];
            for (column, rates) in [by_t, by_force, [0.0; 3]].into_iter().enumerate() {
                give_way_by(law, (a, b), rates, &mut matrix[(3 * k + column) * stride..][..3]);
            }
        }
    }

    /// How the rod comes from its first contact through the roller of its clamp. None without a roller or a contact, and where it does not
    /// run through the roller.
    pub(crate) fn passage(&self, nodes: &Nodes) -> Option<Passage> {
        let (roller, first) = (self.clamp.roller()?, nodes.first()?);
        roller.pass(&self.rod, self.clamp.pose(), (first.s, &first.cut()), [first.a, first.b])
    }

    /// The rod at the roller of its clamp. None without one, and where the rod that the unknowns define does not run through it.
    pub fn roller(&self, u: &[f64]) -> Option<RollerHold> {
        let roller = self.clamp.roller()?;
        let mut nodes = Nodes::new();
        self.nodes(u, &mut nodes);
        if nodes.is_empty() { Some(roller.at_rest(self.clamp.pose())) } else { Some(self.passage(&nodes)?.hold) }
    }

    /// Whether a support sticks: not asked where none can.
    #[inline(always)]
    fn any_sticks(&self, u: &[f64], nodes: &Nodes) -> bool {
        u.len() > 3 * nodes.len() && self.sticking().next().is_some()
    }

    /// The supports that stick, in order.
    fn sticking(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        (0..self.supports.count()).filter_map(|j| match self.supports.grip(j) {
            Grip::Sticks { t, s } => Some((j, t, s)),
            Grip::Slips { .. } => None,
        })
    }

    /// The equations of the supports that stick, if any, with their derivatives and those by their tangential forces.
    #[inline(always)]
    pub(crate) fn sticking_equations(
        &self,
        nodes: &Nodes,
        u: &[f64],
        residual: &mut [f64],
        matrix: &mut [f64],
        stride: usize,
    ) {
        if self.any_sticks(u, nodes) {
            self.sticking_residual(nodes, u, residual);
            self.sticking_columns(nodes, matrix, stride);
        }
    }

    /// How much farther each contact that sticks has gone along its curve than along the rod.
    fn sticking_residual(&self, nodes: &Nodes, u: &[f64], residual: &mut [f64]) {
        for ((j, t, s), left) in self.sticking().zip(&mut residual[3 * nodes.len()..]) {
            let along = arc_length(|t| self.supports.support(j, t).speed, t, u[3 * j]);
            *left = along - nodes[j].sense() * (nodes[j].s - s);
        }
    }

    /// The columns of the tangential forces of supports that stick, and the rows of their equations.
    #[cold]
    fn sticking_columns(&self, nodes: &Nodes, matrix: &mut [f64], stride: usize) {
        let n = nodes.len();
        let rows = n * 3..n * 3 + self.sticking().count();
        for column in 0..rows.end {
            matrix[column * stride..][rows.clone()].fill(0.0);
        }
        for (index, (k, ..)) in self.sticking().enumerate() {
            let (other, column) = (&nodes[k], 3 * n + index);
            let (sin, cos) = (other.sin, other.cos);
            for j in 0..n {
                let rows = &mut matrix[column * stride + 3 * j..][..3];
                if j > k {
                    rows.fill(0.0);
                    continue;
                }
                let node = &nodes[j];
                let (dx, dy) = (other.at.x - node.at.x, other.at.y - node.at.y);
                let length = self.s_before(nodes, j) - node.s;
                let (end, d) = match self.clamp.roller() {
                    Some(_) if j == 0 => through_roller(self.passage(nodes)),
                    _ => self.rod.carry_with_sensitivities(node.s, &node.cut(), node.a, node.b, length),
                };
                let by_moment = dx * sin - dy * cos;
                for (i, row) in rows.iter_mut().enumerate() {
                    *row = cos * d.by_b[i] - sin * d.by_a[i] + by_moment * d.by_moment[i];
                }
                if j == 0
                    && let Some(law) = self.clamp.law()
                {
                    let (dx, dy) = (end.x - other.at.x, end.y - other.at.y);
                    give_way_by(&law, (node.a, node.b), [-sin, cos, dy * cos - dx * sin], rows);
                }
            }
            let row = 3 * n + index;
            matrix[3 * k * stride + row] = other.at.speed;
            if self.supports.hold(k) != Hold::Tip {
                matrix[(3 * k + 2) * stride + row] = -other.sense();
            }
        }
    }

    /// Bending moment at the base of the rod, -m0z, by moment balance over all supports.
    pub fn clamp_moment(&self, u: &[f64]) -> f64 {
        self.base(u).moment
    }

    /// The base of the rod, s = 0: where the clamp is, or, if that gives way, where the rod ends that the unknowns define. Its moment
    /// is -m0z. The slope angle of a rod without supports on a pivot is NaN: nothing determines it.
    pub fn base(&self, u: &[f64]) -> Cut {
        let mut nodes = Nodes::new();
        self.nodes(u, &mut nodes);
        self.base_of(&nodes)
    }

    pub(crate) fn base_of(&self, nodes: &Nodes) -> Cut {
        let Pose { x, y, phi } = self.clamp.pose();
        match (nodes.first(), self.clamp.law()) {
            (None, Some(ClampLaw { torque: Some(torque), .. })) => Cut { x, y, phi: f64::NAN, moment: -torque },
            (None, _) => Cut { x, y, phi, moment: 0.0 },
            (Some(_), None) if self.clamp.roller().is_some() => {
                Cut { x, y, phi, moment: through_roller(self.passage(nodes)).0.moment }
            }
            (Some(first), None) => {
                let moment = first.moment + first.a * (x - first.at.x) + first.b * (y - first.at.y);
                Cut { x, y, phi, moment }
            }
            (Some(first), Some(_)) => self.rod.carry(first.s, &first.cut(), first.a, first.b, -first.s),
        }
    }

    /// The segments from the clamp to the last support, and the rod beyond that, which is free of force and moment. A roller, where a
    /// contact holds the rod, parts the first one in two.
    pub fn cuts(&self, u: &[f64], mut visit: impl FnMut(Segment<Cut>)) {
        let mut nodes = Nodes::new();
        self.nodes(u, &mut nodes);
        let (mut s, mut start) = (0.0, self.base_of(&nodes));
        if let Some(Passage { hold: RollerHold { s: roller, at, .. }, force: [a, b], .. }) = self.passage(&nodes) {
            visit(Segment { s, start, a, b });
            (s, start) = (roller, at);
        }
        for node in &nodes {
            visit(Segment { s, start, a: node.a, b: node.b });
            (s, start) = (node.s, node.cut());
        }
        visit(Segment { s, start, a: 0.0, b: 0.0 });
    }

    /// The shape of the rod whose problem `u` solves, in `units`. Each segment starts where its support holds the rod: what is
    /// left of the residual is between one and the next.
    ///
    /// ```
    /// use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, Units, solve};
    /// struct Floor; // y = 0, the rod's tip on it
    /// impl Supports for Floor {
    ///     fn count(&self) -> usize { 1 }
    ///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
    ///     fn support(&self, _: usize, t: f64) -> Support {
    ///         Support { x: -t, y: 0.0, alpha: std::f64::consts::PI, speed: 1.0, turning: 0.0 }
    ///     }
    /// }
    /// let problem = MultiPoint { rod: Uniform, clamp: Pose { x: 0.0, y: 0.1, phi: -0.2 }, supports: &Floor };
    /// let mut u = [-0.9, 0.1, 0.0];
    /// assert!(solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new()).status.is_solved());
    /// let shape = problem.elastica(&u, Units::ONE);
    /// assert!(shape.at(1.0).y.abs() < 1e-14 && shape.first_integral_error().unwrap() < 1e-14);
    /// assert!((shape.reactions().f0y + u[1]).abs() < 1e-14); // the floor pushes up, the clamp holds down
    /// ```
    pub fn elastica(&self, u: &[f64], units: Units) -> Elastica<M>
    where
        M: Clone,
    {
        let mut segments = SmallVec::<[Segment<Cut>; 6]>::new();
        self.cuts(u, |segment| segments.push(segment));
        Elastica::of_segments(self.rod.clone(), units, segments)
    }
}

impl<S: Supports + ?Sized, C: Clamp> MultiPoint<'_, S, Uniform, C> {
    /// Curvature of the uniform rod at the clamp: -m0z.
    pub fn clamp_curvature(&self, u: &[f64]) -> f64 {
        self.clamp_moment(u)
    }

    /// The segments of the uniform rod, as [`MultiPoint::cuts`].
    pub fn segments(&self, u: &[f64], mut visit: impl FnMut(Segment)) {
        self.cuts(u, |Segment { s, start, a, b }| visit(Segment { s, start: uniform::section(&start), a, b }));
    }
}

impl<S: Supports + ?Sized, M: RodModel, C: Clamp> System for MultiPoint<'_, S, M, C> {
    fn dimension(&self) -> usize {
        3 * self.supports.count() + self.sticking().count()
    }

    fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        let stride = self.dimension();
        self.evaluate_into(u, residual, jacobian.map(|j| (j, stride)));
    }

    #[inline(always)]
    fn is_linked(&self) -> bool {
        self.is_linked()
    }

    #[inline(never)]
    fn evaluate_links(&self, u: &[f64], residual: &mut [f64], links: &mut Links) {
        let mut nodes = Nodes::new();
        self.nodes(u, &mut nodes);
        for j in 0..nodes.len() {
            self.link(&nodes, j, residual, links.add());
        }
    }

    #[inline(always)]
    fn weights(&self, u: &[f64], weights: &mut [f64]) {
        let (of_all, of_sticking) = weights.split_at_mut(3 * self.supports.count());
        for (j, w) in of_all.chunks_exact_mut(3).enumerate() {
            w.copy_from_slice(&natural_sizes(&self.supports.support(j, u[3 * j]), u[3 * j + 1]));
        }
        for (w, friction) in of_sticking.iter_mut().zip(&u[of_all.len()..]) {
            *w = friction_size(*friction);
        }
    }
}

/// The base of the rod beyond a roller, with its derivatives; NaN where the rod does not run through that.
fn through_roller(passage: Option<Passage>) -> (Cut, CutSensitivities) {
    let no = [f64::NAN; 4];
    let none = Cut { x: f64::NAN, y: f64::NAN, phi: f64::NAN, moment: f64::NAN };
    let unknown = CutSensitivities { by_phi: no, by_moment: no, by_a: no, by_b: no, by_from: no, by_to: no };
    passage.map_or((none, unknown), |passage| (passage.base, passage.sensitivities))
}

/// What the clamp feels where the first segment ends.
pub(crate) fn reactions(first: &Node, base: &Cut) -> Reactions {
    Reactions { f0x: -first.b, f0y: first.a, m0z: -base.moment }
}

#[inline(always)]
fn three(f: &dyn Fn(usize) -> f64) -> [f64; 3] {
    [f(0), f(1), f(2)]
}

/// The derivatives of the end of a segment by t and s of the support behind, where it ends: by no other unknown of the supports behind.
#[inline(always)]
fn by_support_behind(Node { at, sin, cos, .. }: &Node, d: &CutSensitivities) -> [[f64; 3]; 2] {
    [[-at.speed * cos, -at.speed * sin, -at.turning], three(&|i| d.by_to[i])]
}

/// Turns the derivatives of the end of segment 0 into those of the equations of a clamp that gives way, as [`MultiPoint::give_way`]: m(0)
/// is the sum of the moments about the first support plus the moment of (A, B) about it.
fn give_way(law: &ClampLaw, node: &Node, base: &Cut, link: &mut Link) {
    let (dx, dy) = (base.x - node.at.x, base.y - node.at.y);
    let rates = |[moment, a, b]: [f64; 3]| [a, b, moment + a * dx + b * dy];
    let [by_t, by_force] = link.adds.map(rates);
    for (column, rates) in link.own.iter_mut().zip([by_t, by_force, [0.0; 3]]) {
        give_way_by(law, (node.a, node.b), rates, column);
    }
    for (column, unit) in link.ahead.iter_mut().zip([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) {
        give_way_by(law, (node.a, node.b), rates(unit), column);
    }
}

/// One unknown of [`MultiPoint::give_way`], by which A, B and the moment at the base change at these rates: `rows` holds how the end moves.
fn give_way_by(law: &ClampLaw, (a, b): (f64, f64), [a_rate, b_rate, moment_rate]: [f64; 3], rows: &mut [f64]) {
    let end = [rows[0], rows[1], rows[2]];
    let moment_rate = moment_rate + a * end[0] + b * end[1];
    rows.copy_from_slice(&law.rates(end, &Reactions { f0x: -b_rate, f0y: a_rate, m0z: -moment_rate }));
}

#[cfg(test)]
mod tests;
