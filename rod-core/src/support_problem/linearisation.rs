//! The boundary-value problem about one of its solutions, to first order: how everything changes when clamp and supports move.
//!
//! F(u, p) = 0 gives du/dp = -(dF/du)^-1 dF/dp. The Jacobian dF/du and the sensitivities of the segments are computed once, at the
//! solution itself: that of the last Newton step belongs to the point before it, and is as inexact as that step is long.

mod bend;

use super::Grip;
use super::multipoint::{Hold, MultiPoint, Node, Nodes, Supports, friction_size, natural_sizes, reactions};
use crate::clamp::{Clamp, ClampLaw, Passage, product};
use crate::model::{Cut, CutSensitivities, RodModel};
use crate::pose::{Pose, Reactions};
use crate::solve::jacobian::Jacobian;
use crate::solve::linear::{invert, weighted_condition};
use smallvec::SmallVec;

/// The change of a support's point and tangent angle per unit of something, at a fixed parameter of its curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SupportRate {
    /// Of the position.
    pub x: f64,
    /// Of the position.
    pub y: f64,
    /// Of the tangent angle, radians.
    pub alpha: f64,
}

/// The change of a contact of the rod with a support per unit of something.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactRate {
    /// Of the position.
    pub x: f64,
    /// Of the position.
    pub y: f64,
    /// Of the tangent angle of the support's curve there, radians.
    pub alpha: f64,
    /// Of the slope angle of the rod there, radians.
    pub phi: f64,
    /// Of the arc length.
    pub s: f64,
    /// Of the force.
    pub force: f64,
}

/// The change of a whole equilibrium per unit of something, in the units of what gives it: a [`Linearisation`] is dimensionless, the
/// derivatives of an equilibrium in `rod-contact` have SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    /// Of the reactions at the clamp.
    pub reactions: Reactions,
    /// Of the contacts, from the clamp to the tip.
    pub contacts: Vec<ContactRate>,
}

/// How the path parameter changes at a point of the path that one more equation defines.
#[derive(Clone, Debug, PartialEq)]
pub struct PathRow {
    /// By the negative residual.
    pub by_residual: SmallVec<[f64; 25]>,
    /// By the value of the unknown that is given.
    pub by_value: f64,
    /// Condition number, as [`Linearisation::condition`].
    pub condition: f64,
}

type Vector = SmallVec<[f64; 25]>;

/// A [`MultiPoint`] problem to first order about a solution.
///
/// ```
/// use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, solve};
/// // the tip of an upright rod just touches a frictionless wall x = 0.5
/// struct Wall;
/// impl Supports for Wall {
///     fn count(&self) -> usize { 1 }
///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
///     fn support(&self, _: usize, t: f64) -> Support {
///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
///     }
/// }
/// let up = std::f64::consts::FRAC_PI_2;
/// let problem = MultiPoint { rod: Uniform, clamp: Pose { x: 0.5, y: 0.0, phi: up }, supports: &Wall };
/// let linear = problem.linearise(&[1.0, 0.0, up]);
/// // moved towards the wall it is a cantilever: 3 E I / L^3
/// let moved = linear.response(Pose { x: 1.0, y: 0.0, phi: 0.0 }, &[Default::default()]).ok_or("singular")?;
/// assert!((moved.reactions.f0x - 3.0).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Linearisation {
    /// The base of the rod.
    base: Cut,
    // On the heap: what is this large and moved costs more to copy than to allocate.
    /// How the base gives way.
    law: Option<Box<ClampLaw>>,
    /// How the rod runs through the roller of its clamp.
    passage: Option<Box<Passage>>,
    held: Vec<Held>,
    residual: Vector,
    jacobian: Jacobian,
    /// Condition number; infinite where there is no inverse.
    condition: f64,
    weights: Vector,
}

/// A support with what is ahead of it, and the segment before it.
#[derive(Clone, Debug)]
struct Held {
    node: Node,
    tangent: bool,
    grip: Grip,
    segment: CutSensitivities,
}

impl Held {
    /// How the end of the segment, (x, y, phi), moves with the support where it starts.
    #[inline(always)]
    fn end(&self, NodeRate { contact, a, b, moment }: &NodeRate) -> [f64; 3] {
        let (d, start) = (&self.segment, [contact.x, contact.y, 0.0]);
        [0, 1, 2].map(|i| {
            let held = start[i] + contact.phi * d.by_phi[i] + moment * d.by_moment[i] + a * d.by_a[i] + b * d.by_b[i];
            held + contact.s * d.by_from[i]
        })
    }
}

/// How a support moves in all, with what its contact does on it.
#[derive(Clone, Copy)]
struct NodeRate {
    contact: ContactRate,
    a: f64,
    b: f64,
    moment: f64,
}

impl<S: Supports + ?Sized, M: RodModel, C: Clamp> MultiPoint<'_, S, M, C> {
    /// The problem to first order about the solution `u`: one Jacobian, one inverse.
    pub fn linearise(&self, u: &[f64]) -> Linearisation {
        let mut nodes = Nodes::new();
        self.nodes(u, &mut nodes);
        // one more unknown for each that sticks
        let (count, size) = (nodes.len(), u.len());
        let mut residual = Vector::from_elem(0.0, size);
        let mut jacobian = Jacobian::default();
        let mut held = Vec::with_capacity(count);
        let hold = |j: usize, segment| Held {
            node: nodes[j],
            tangent: self.supports.hold(j) != Hold::Tip,
            grip: self.supports.grip(j),
            segment,
        };
        let is_eliminated = self.is_linked()
            && jacobian.take_links(size, |links| {
                held.extend((0..count).map(|j| hold(j, self.link(&nodes, j, &mut residual, links.add()))));
            });
        let is_regular = is_eliminated
            || jacobian.take_matrix(size, |matrix| {
                held.clear();
                held.extend((0..count).map(|j| hold(j, self.segment(&nodes, j, &mut residual, matrix, size))));
                self.sticking_equations(&nodes, u, &mut residual, matrix, size);
            });
        let mut weights: Vector = nodes.iter().flat_map(|node| natural_sizes(&node.at, node.force)).collect();
        weights.extend(u[3 * count..].iter().map(|friction| friction_size(*friction)));
        let (base, law) = (self.base_of(&nodes), self.clamp.law().map(Box::new));
        let passage = self.passage(&nodes).map(Box::new);
        let condition = if is_regular { jacobian.weighted_condition(&weights) } else { f64::INFINITY };
        Linearisation { base, law, passage, held, residual, jacobian, condition, weights }
    }
}

impl Linearisation {
    /// Condition number of the Jacobian in the 1-norm, with the unknowns in their natural sizes (a length of 1, a force of 4 (1 +
    /// force), an angle of 1 rad): about the relative error of the derivatives over that of rounding, 1e-16. It is infinite where
    /// the Jacobian has no inverse.
    pub fn condition(&self) -> f64 {
        self.condition
    }

    /// Largest residual of the equations; NaN where one is.
    pub fn residual(&self) -> f64 {
        self.residual.iter().fold(0.0, |most, r| if r.abs() > most || r.is_nan() { r.abs() } else { most })
    }

    /// The change of the equilibrium when clamp and supports move like this; of a clamp that gives way it is the support that moves,
    /// and the reactions are those at the base of the rod, wherever that goes. None where the Jacobian has no inverse, or there is
    /// not one rate for each support.
    pub fn response(&self, clamp: Pose, supports: &[SupportRate]) -> Option<Response> {
        self.response_to(clamp, supports, &[])
    }

    /// The change of the equilibrium per unit of something by which the tangential force of each contact that slips becomes so many times
    /// its normal force larger, with clamp and supports at rest. None where the Jacobian has no inverse, or there is not one rate for each
    /// support.
    ///
    /// ```
    /// use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, solve};
    /// // the tip of an upright rod on a wall x = 0.5 that is travelled upwards
    /// struct Wall;
    /// impl Supports for Wall {
    ///     fn count(&self) -> usize { 1 }
    ///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
    ///     fn support(&self, _: usize, t: f64) -> Support {
    ///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
    ///     }
    /// }
    /// let clamp = Pose { x: 0.5, y: 0.0, phi: std::f64::consts::FRAC_PI_2 };
    /// let problem = MultiPoint { rod: Uniform, clamp, supports: &Wall };
    /// // a straight rod without a force feels no friction
    /// let rubs = problem.linearise(&[1.0, 0.0, clamp.phi]).response_to_grips(&[1.0]).ok_or("singular")?;
    /// assert_eq!(rubs.reactions.f0y, 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn response_to_grips(&self, ratios: &[f64]) -> Option<Response> {
        if ratios.len() != self.held.len() {
            return None;
        }
        let rubs: SmallVec<[f64; 8]> = self.held.iter().zip(ratios).map(|(held, by)| held.node.force * by).collect();
        self.response_to(Pose { x: 0.0, y: 0.0, phi: 0.0 }, &self.still(), &rubs)
    }

    /// The response where besides clamp and supports the tangential forces change like this.
    fn response_to(&self, clamp: Pose, supports: &[SupportRate], rubs: &[f64]) -> Option<Response> {
        let rates = self.rates_of_residual(clamp, supports, rubs)?;
        let nodes = self.solved_with(&rates, supports, rubs)?;
        let reactions = self.reactions(clamp, &nodes);
        Some(Response { reactions, contacts: nodes.into_iter().map(|node| node.contact).collect() })
    }

    /// The change of the equilibrium per unit of a change of the compliance of the clamp ([`ClampLaw`]; of a rigid one, from 0), with
    /// clamp and supports at rest. None where the Jacobian has no inverse, and for a clamp with a roller.
    pub fn response_to_compliance(&self, change: &[[f64; 3]; 3]) -> Option<Response> {
        if self.passage.is_some() {
            return None;
        }
        let first = self.held.first()?;
        let mut rows = product(change, &reactions(&first.node, &self.base));
        if self.law.as_ref().is_some_and(|law| law.torque.is_some()) {
            rows[2] = 0.0;
        }
        self.response_to_equations(rows)
    }

    /// The change of the equilibrium per unit of the torque of a [`Pivot`](crate::Pivot). None for other clamps, and where the
    /// Jacobian has no inverse.
    pub fn response_to_torque(&self) -> Option<Response> {
        self.law.as_ref()?.torque?;
        self.response_to_equations([0.0, 0.0, -1.0])
    }

    /// The response where the three equations of the clamp, and nothing else, have these rates.
    fn response_to_equations(&self, rows: [f64; 3]) -> Option<Response> {
        let mut rates = Vector::from_elem(0.0, self.residual.len());
        rates.iter_mut().zip(rows).for_each(|(rate, row)| *rate = row);
        let nodes = self.solved(&rates, &self.still())?;
        // a rigid clamp would have to go where the equations say
        let reactions = self.reactions(Pose { x: -rows[0], y: -rows[1], phi: -rows[2] }, &nodes);
        Some(Response { reactions, contacts: nodes.into_iter().map(|node| node.contact).collect() })
    }

    fn still(&self) -> SmallVec<[SupportRate; 8]> {
        SmallVec::from_elem(SupportRate::default(), self.held.len())
    }

    /// The reactions of the [`response`](Self::response) where the clamp moves and nothing else does.
    pub fn reactions_to_clamp(&self, clamp: Pose) -> Option<Reactions> {
        let mut rates = Vector::from_elem(0.0, self.residual.len());
        rates.iter_mut().zip(self.target_rates(clamp)).for_each(|(rate, moves)| *rate = -moves);
        Some(self.reactions(clamp, &self.solved(&rates, &self.still())?))
    }

    /// The motion of the contacts by the rates of the residual, and by those of the supports that they come from.
    fn solved(&self, rates: &[f64], supports: &[SupportRate]) -> Option<Vec<NodeRate>> {
        self.solved_with(rates, supports, &[])
    }

    fn solved_with(&self, rates: &[f64], supports: &[SupportRate], rubs: &[f64]) -> Option<Vec<NodeRate>> {
        if !self.condition.is_finite() {
            return None;
        }
        let mut unknowns = Vector::from_elem(0.0, rates.len());
        self.jacobian.correction(rates, &mut unknowns);
        Some(self.node_rates(supports, rubs, Some(&unknowns)))
    }

    /// The change of the reactions at a clamp that moves like this.
    fn reactions(&self, clamp: Pose, nodes: &[NodeRate]) -> Reactions {
        nodes.first().map_or_else(Reactions::default, |first| {
            let (x, y) = match self.law {
                None => (clamp.x, clamp.y),
                Some(_) => {
                    let [x, y, _] = self.held[0].end(first);
                    (x, y)
                }
            };
            self.reactions_of(first, x, y)
        })
    }

    /// The change of the reactions where the base moves like this.
    fn reactions_of(&self, first: &NodeRate, x: f64, y: f64) -> Reactions {
        if let Some(passage) = &self.passage {
            let NodeRate { contact, a, b, moment } = first;
            let [a, b, moment] = passage.felt([contact.phi, *moment, *a, *b, contact.s]);
            return Reactions { f0x: -b, f0y: a, m0z: -moment };
        }
        let (node, moves) = (&self.held[0].node, first.contact);
        let (dx, dy) = (self.base.x - node.at.x, self.base.y - node.at.y);
        let moment = first.moment + first.a * dx + node.a * (x - moves.x) + first.b * dy + node.b * (y - moves.y);
        Reactions { f0x: -first.b, f0y: first.a, m0z: -moment }
    }

    /// What the equations of a clamp that moves like this lose by it.
    fn target_rates(&self, clamp: Pose) -> [f64; 3] {
        let turns_freely = self.law.as_ref().is_some_and(|law| law.torque.is_some());
        [clamp.x, clamp.y, if turns_freely { 0.0 } else { clamp.phi }]
    }

    /// The change of the path parameter, along which the clamp moves like `path`, at the point of the path where one unknown has a
    /// given value, as a linear function of the [rates of the residual](Self::residual_rates): the last row of the inverse of the
    /// Jacobian bordered by `path` and that unknown.
    ///
    /// Unknowns are counted as in [`MultiPoint`]. None where the bordered matrix has no inverse.
    pub fn path_row(&self, path: Pose, unknown: usize) -> Option<PathRow> {
        let by_path = self.residual_rates(path, &self.still())?;
        let (size, whole) = (by_path.len(), by_path.len() + 1);
        let mut bordered = SmallVec::<[f64; 64]>::from_elem(0.0, whole * whole);
        self.jacobian.write(&mut bordered, whole);
        bordered[size * whole..][..size].copy_from_slice(&by_path);
        *bordered.get_mut(unknown * whole + size)? = 1.0;
        let mut inverse = SmallVec::<[f64; 64]>::from_elem(0.0, whole * whole);
        if unknown >= size || !invert(whole, &bordered, &mut inverse) {
            return None;
        }
        let mut weights = self.weights.clone();
        weights.push(1.0);
        let condition = weighted_condition(&bordered, &inverse, &weights);
        let mut by_residual: SmallVec<[f64; 25]> = inverse.chunks_exact(whole).map(|column| column[size]).collect();
        let by_value = by_residual.pop()?;
        Some(PathRow { by_residual, by_value, condition })
    }

    /// The change of the residual, at fixed unknowns, when clamp and supports move like this; none where there is not one rate for
    /// each support.
    pub fn residual_rates(&self, clamp: Pose, supports: &[SupportRate]) -> Option<SmallVec<[f64; 25]>> {
        self.rates_of_residual(clamp, supports, &[])
    }

    fn rates_of_residual(&self, clamp: Pose, supports: &[SupportRate], rubs: &[f64]) -> Option<Vector> {
        if supports.len() != self.held.len() {
            return None;
        }
        let nodes = self.node_rates(supports, rubs, None);
        let mut rates = Vector::with_capacity(3 * nodes.len());
        let mut target = self.target_rates(clamp);
        for (j, (rate, held)) in nodes.iter().zip(&self.held).enumerate() {
            let mut end = held.end(rate);
            if j == 0
                && let Some(law) = &self.law
            {
                end = law.rates(end, &self.reactions_of(rate, end[0], end[1]));
            }
            rates.extend((0..3).map(|i| end[i] - target[i]));
            target = [rate.contact.x, rate.contact.y, rate.contact.phi];
        }
        // a contact that sticks moves with its support
        rates.resize(self.residual.len(), 0.0);
        Some(rates)
    }

    /// How the supports move, and force and moment with them, where the tangential forces change by `rubs` (0 beyond its end); with the rates of
    /// the unknowns, if any, how the contacts do.
    fn node_rates(&self, supports: &[SupportRate], rubs: &[f64], unknowns: Option<&[f64]>) -> Vec<NodeRate> {
        let mut rates: Vec<NodeRate> = Vec::with_capacity(supports.len());
        let mut tangential = 3 * self.held.len();
        for (j, (Held { node, tangent, grip, .. }, moves)) in self.held.iter().zip(supports).enumerate() {
            let [t, force, third] = unknowns.map_or([0.0; 3], |u| [u[3 * j], u[3 * j + 1], u[3 * j + 2]]);
            let along = node.at.speed * t;
            let alpha = moves.alpha + node.at.turning * t;
            let (phi, s) = if *tangent { (alpha, third) } else { (third, 0.0) };
            let (x, y) = (moves.x + along * node.cos, moves.y + along * node.sin);
            let [(own_a, own_b), (push_a, push_b)] = node.push(*grip);
            let mut friction = rubs.get(j).copied().unwrap_or_default();
            if grip.sticks() {
                friction = unknowns.map_or(0.0, |u| u[tangential]);
                tangential += 1;
            }
            rates.push(NodeRate {
                contact: ContactRate { x, y, alpha, phi, s, force },
                a: force * push_a - friction * node.sin - alpha * own_b,
                b: force * push_b + friction * node.cos + alpha * own_a,
                moment: 0.0,
            });
        }
        for j in (1..rates.len()).rev() {
            let (ahead, node, before) = (rates[j], &self.held[j].node, &self.held[j - 1].node);
            let (dx, dy) = (before.at.x - node.at.x, before.at.y - node.at.y);
            let rate = &mut rates[j - 1];
            let (x, y) = (rate.contact.x - ahead.contact.x, rate.contact.y - ahead.contact.y);
            rate.moment = ahead.moment + ahead.a * dx + node.a * x + ahead.b * dy + node.b * y;
            rate.a += ahead.a;
            rate.b += ahead.b;
        }
        rates
    }
}

#[cfg(test)]
mod tests;
