//! The response to a change of the rod itself: of its stiffness, or of its shape at rest.
//!
//! Both bend the rod by g(s, m) = d kappa / dp, where p is what changes. By the variation of constants the end of a segment then moves by
//!
//! ```text
//! int (derivative of the end by the slope angle at s) g(s, m(s)) ds
//! ```
//!
//! which takes Gauss points along the segment, halved until they agree, and two carries a point: whatever the model of the rod. A uniform rod
//! that is bent evenly by g begins the segment with a curvature that is larger by g, and phi'' does not change: the derivative is that by the
//! moment where the segment starts.

use super::{Held, Linearisation, Response, Vector};
use crate::model::{AT, RodModel, WEIGHT};
use crate::pose::{Pose, Reactions};
use crate::support_problem::multipoint::Node;
use smallvec::SmallVec;

/// Change of an integral by halving, relative to 1 + the integral, below which it is taken.
const CONVERGED: f64 = 1e-14;
/// Most halvings.
const HALVINGS: u32 = 12;
/// Largest distance (L, rad) between where a segment of the rod ends and where that of the linearised problem does.
const SAME: f64 = 1e-6;

impl Linearisation {
    /// The change of the residual, at fixed unknowns, per unit of something by which the curvature of the rod changes by
    /// `rate(s, moment)`, all dimensionless. It is smooth between the joints of the rod. None for another rod than that of the problem,
    /// and for a clamp with a roller.
    pub fn bend_rates(&self, rod: &impl RodModel, rate: impl Fn(f64, f64) -> f64) -> Option<SmallVec<[f64; 25]>> {
        Some(self.rates_of(&self.bent_ends(rod, rate)?))
    }

    /// The change of the equilibrium per unit of something by which the curvature of the rod changes by `rate(s, moment)`, all
    /// dimensionless, with clamp and supports at rest. It is smooth between the joints of the rod. None where the Jacobian has no inverse,
    /// for another rod than that of the problem, and for a clamp with a roller.
    ///
    /// ```
    /// use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, Pose, Support, Supports, Uniform, solve};
    /// struct Wall; // x = 0.5, pushes the tip to +x
    /// impl Supports for Wall {
    ///     fn count(&self) -> usize { 1 }
    ///     fn hold(&self, _: usize) -> Hold { Hold::Tip }
    ///     fn support(&self, _: usize, t: f64) -> Support {
    ///         Support { x: 0.5, y: t, alpha: std::f64::consts::FRAC_PI_2, speed: 1.0, turning: 0.0 }
    ///     }
    /// }
    /// let up = std::f64::consts::FRAC_PI_2;
    /// let problem = MultiPoint { rod: Uniform, clamp: Pose { x: 0.5, y: 0.0, phi: up }, supports: &Wall };
    /// // a rod that begins to bend at rest, by 1 / L to the left, presses with 3 / 2 E I / L^2
    /// let bends = problem.linearise(&[1.0, 0.0, up]).response_to_bend(&Uniform, |_, _| 1.0).ok_or("singular")?;
    /// assert!((bends.contacts[0].force - 1.5).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn response_to_bend(&self, rod: &impl RodModel, rate: impl Fn(f64, f64) -> f64) -> Option<Response> {
        self.response_to_ends(&self.bent_ends(rod, rate)?)
    }

    /// The same where the curvature changes by `rate` all along: of a uniform rod without an integral.
    pub fn response_to_even_bend(&self, rod: &impl RodModel, rate: f64) -> Option<Response> {
        if !rod.is_uniform() {
            return self.response_to_bend(rod, |_, _| rate);
        }
        let by_moment = |Held { segment, .. }: &Held, _| [0, 1, 2].map(|i| rate * segment.by_moment[i]);
        self.response_to_ends(&self.ends_by(rod, by_moment)?)
    }

    /// The change of the equilibrium where the ends of the segments move like this.
    fn response_to_ends(&self, ends: &Vector) -> Option<Response> {
        let nodes = self.solved(&self.rates_of(ends), &self.still())?;
        let reactions = match (&self.law, nodes.first()) {
            // the base goes where the rod ends
            (Some(_), Some(first)) => {
                let [x, y, _] = self.held[0].end(first);
                self.reactions_of(first, x + ends[0], y + ends[1])
            }
            _ => self.reactions(Pose { x: 0.0, y: 0.0, phi: 0.0 }, &nodes),
        };
        Some(Response { reactions, contacts: nodes.into_iter().map(|node| node.contact).collect() })
    }

    /// How the end of each segment, (x, y, phi) on the side of the clamp, moves as the rod bends.
    fn bent_ends(&self, rod: &impl RodModel, rate: impl Fn(f64, f64) -> f64) -> Option<Vector> {
        self.ends_by(rod, |Held { node, .. }, to| bent_end(rod, node, to, &rate))
    }

    /// The same by `end_of` a segment, which ends at an arc length.
    fn ends_by(&self, rod: &impl RodModel, end_of: impl Fn(&Held, f64) -> [f64; 3]) -> Option<Vector> {
        if self.passage.is_some() {
            return None;
        }
        let mut ends = Vector::with_capacity(3 * self.held.len());
        let (mut to, mut target) = (0.0, [self.base.x, self.base.y, self.base.phi]);
        for held in &self.held {
            let node = &held.node;
            let end = rod.carry(node.s, &node.cut(), node.a, node.b, to - node.s);
            let misses = [end.x - target[0], end.y - target[1], end.phi - target[2]];
            if !misses.iter().all(|miss| miss.abs() < SAME) {
                return None;
            }
            ends.extend(end_of(held, to));
            (to, target) = (node.s, [node.at.x, node.at.y, node.phi]);
        }
        Some(ends)
    }

    /// The rates of the residual where the ends of the segments move like this.
    fn rates_of(&self, ends: &Vector) -> Vector {
        let mut rates = ends.clone();
        if let (Some(law), [x, y, phi, ..]) = (&self.law, ends.as_slice()) {
            // the moment about a base that moves, under forces that do not change
            let (a, b) = (self.held[0].node.a, self.held[0].node.b);
            let felt = Reactions { f0x: 0.0, f0y: 0.0, m0z: -(a * x + b * y) };
            rates[..3].copy_from_slice(&law.rates([*x, *y, *phi], &felt));
        }
        rates
    }
}

/// How the end at arc length `to` of the segment that starts at `node` moves.
fn bent_end(rod: &impl RodModel, node: &Node, to: f64, rate: &impl Fn(f64, f64) -> f64) -> [f64; 3] {
    let integrand = |s: f64| {
        let cut = rod.carry(node.s, &node.cut(), node.a, node.b, s - node.s);
        let by_phi = rod.carry_with_sensitivities(s, &cut, node.a, node.b, to - s).1.by_phi;
        let rate = rate(s, cut.moment);
        [rate * by_phi[0], rate * by_phi[1], rate * by_phi[2]]
    };
    let mut sum = [0.0; 3];
    // backwards, from joint to joint
    let mut from = node.s;
    for joint in rod.joints().iter().rev().filter(|joint| **joint < node.s && **joint > to).chain([&to]) {
        let part = halved(&integrand, from, *joint, gauss(&integrand, from, *joint), HALVINGS);
        sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        from = *joint;
    }
    sum
}

/// An integral that is known by `whole`, by its halves.
fn halved(integrand: &impl Fn(f64) -> [f64; 3], from: f64, to: f64, whole: [f64; 3], halvings: u32) -> [f64; 3] {
    let middle = 0.5 * (from + to);
    let [left, right] = [gauss(integrand, from, middle), gauss(integrand, middle, to)];
    let both = [0, 1, 2].map(|i| left[i] + right[i]);
    let is_close = |i: usize| (both[i] - whole[i]).abs() <= CONVERGED * (1.0 + both[i].abs());
    if halvings == 0 || (0..3).all(is_close) {
        return both;
    }
    let left = halved(integrand, from, middle, left, halvings - 1);
    let right = halved(integrand, middle, to, right, halvings - 1);
    [0, 1, 2].map(|i| left[i] + right[i])
}

/// An integral by 8 Gauss points.
fn gauss(integrand: &impl Fn(f64) -> [f64; 3], from: f64, to: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (at, weight) in AT.into_iter().zip(WEIGHT) {
        let value = integrand(from + at * (to - from));
        sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * (to - from) * value);
    }
    sum
}
