//! Least squares: the unknowns of a shape from the observations of a frame.

use super::linear_rod::curvature_per_moment;
use super::observation::Measurand;
use super::observed::{Dot, Measured, Observed};
use super::pole::{Centre, Pole};
use super::shape::{Contact, Node, Place, Shape, trace};
use crate::least_squares::{NormalMatrix, Problem};
use nalgebra::DVector;
use rod_core::RodModel;

/// Largest force (E I / s^2 at the arc length s) that a contact is tried with: beyond it a rod is wound up.
const MOST_FORCE: f64 = 400.0;
/// How far (L) beyond an end the rod may go on where that is not seen.
const BEYOND: f64 = 0.2;
/// Largest way (L) of a foot point in one step.
pub(super) const MOST_WAY: f64 = 0.1;

/// Where a solve begins.
#[derive(Clone)]
pub(super) struct Start {
    /// From the outermost inwards.
    pub contacts: Vec<Place>,
    /// The unknowns.
    pub u: DVector<f64>,
    /// The foot points.
    pub feet: Vec<f64>,
    /// Chi squared as far as it is known there.
    pub chi_squared: f64,
}

/// A frame, to be explained by a rod with these contacts.
///
/// A point is on the rod at its foot point, the place that is nearest to it: an unknown of its own that enters no other residual, so that what is
/// left of it is its distance across the rod. Foot points follow from one step to the next.
pub(super) struct FrameProblem<'a, M> {
    model: &'a M,
    observed: &'a Observed,
    pub contacts: &'a [Place],
    /// The foot points, L: one for each dot.
    pub feet: Vec<f64>,
    /// Where the rod is looked at, and for which observation: dots first, then channels.
    stations: Vec<(f64, usize)>,
}

/// What is left of the observations at a shape.
pub(super) struct Left {
    pub normal: NormalMatrix,
    pub shape: Shape,
    /// Number of residuals.
    pub count: usize,
}

impl<'a, M: RodModel> FrameProblem<'a, M> {
    pub fn new(model: &'a M, observed: &'a Observed, contacts: &'a [Place], feet: Vec<f64>) -> Self {
        Self { model, observed, contacts, feet, stations: Vec::new() }
    }

    /// The residuals with the unknowns `u`. None where the rod has no such shape.
    pub fn at(&mut self, u: &DVector<f64>) -> Option<Left> {
        let dots = &self.observed.dots;
        self.stations.clear();
        self.stations.extend(dots.iter().zip(&self.feet).map(|(dot, foot)| dot.s.unwrap_or(*foot)).zip(0..));
        let along = self.observed.channels.iter().enumerate().filter_map(|(k, channel)| match channel.quantity {
            Measurand::Curvature(s) | Measurand::Marker(s, _) => Some((s, dots.len() + k)),
            _ => None,
        });
        self.stations.extend(along);
        self.stations.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let places: Vec<f64> = self.stations.iter().map(|station| station.0).collect();
        let mut rows = Rows { normal: NormalMatrix::empty(u.len()), count: 0, row: Vec::with_capacity(u.len()) };
        let (stations, feet) = (&self.stations, &mut self.feet);
        // ends that are not seen are no bounds of what is seen
        let within = match self.observed.ends {
            [true, _] => (0.0, 1.0),
            [false, true] => (-BEYOND, 1.0),
            [false, false] => (-BEYOND, 1.0 + BEYOND),
        };
        let shape = trace(self.model, self.contacts, u.as_slice(), &places, |k, node| {
            let number = stations[k].1;
            match dots.get(number) {
                Some(dot) => rows.dot(self.model, dot, node, within, &mut feet[number]),
                None => rows.along(self.model, &self.observed.channels[number - dots.len()], node),
            }
        })?;
        let winds =
            |contact: &Contact| contact.force.ab[0].hypot(contact.force.ab[1]) * contact.node.s.powi(2) > MOST_FORCE;
        if shape.contacts.iter().any(winds) {
            return None;
        }
        for channel in &self.observed.channels {
            rows.at_base(channel, &shape, &self.observed.compliance);
        }
        if let (Some(pole), [contact]) = (&self.observed.pole, &shape.contacts[..]) {
            rows.at_pole(pole, contact);
        }
        let Rows { normal, count, .. } = rows;
        normal.cost.is_finite().then_some(Left { normal, shape, count })
    }
}

/// The residuals as they come.
struct Rows {
    normal: NormalMatrix,
    count: usize,
    row: Vec<(usize, f64)>,
}

impl Rows {
    fn add(&mut self, rate: impl Fn(usize) -> f64, residual: f64, sigma: f64) {
        self.row.clear();
        self.row.extend((0..self.normal.gradient.len()).map(|k| (k, rate(k))));
        self.normal.add(&self.row, residual, sigma);
        self.count += 1;
    }

    /// A dot at its foot point, which moves on.
    fn dot<M: RodModel>(&mut self, model: &M, dot: &Dot, node: &Node, within: (f64, f64), foot: &mut f64) {
        let (sin, cos) = node.cut.phi.sin_cos();
        let (x, y) = (node.cut.x - dot.at[0], node.cut.y - dot.at[1]);
        let ahead = -(x * cos + y * sin);
        let is_end = (node.s <= within.0 && ahead <= 0.0) || (node.s >= within.1 && ahead >= 0.0);
        if dot.s.is_some() || is_end {
            self.add(|k| node.by[k][0], x, dot.sigma);
            self.add(|k| node.by[k][1], y, dot.sigma);
            return;
        }
        // the rod turns away from its tangent on the way to the foot point
        let kappa = model.curvature_at(node.s, node.cut.moment);
        let across = y * cos - x * sin + 0.5 * kappa * ahead * ahead;
        self.add(|k| cos * node.by[k][1] - sin * node.by[k][0] + ahead * node.by[k][2], across, dot.sigma);
        *foot = (*foot + ahead.clamp(-MOST_WAY, MOST_WAY)).clamp(within.0, within.1);
    }

    /// A channel somewhere along the rod.
    fn along<M: RodModel>(&mut self, model: &M, channel: &Measured, node: &Node) {
        let Measured { quantity, value, sigma } = *channel;
        match quantity {
            Measurand::Curvature(s) => {
                let compliance = curvature_per_moment(model, s);
                self.add(|k| compliance * node.by[k][3], model.curvature_at(s, node.cut.moment) - value, sigma);
            }
            Measurand::Marker(_, axis) => {
                let of = [node.cut.x, node.cut.y, node.cut.phi];
                self.add(|k| node.by[k][axis.index()], of[axis.index()] - value, sigma);
            }
            _ => {}
        }
    }

    /// A channel at the base.
    fn at_base(&mut self, channel: &Measured, shape: &Shape, compliance: &[[f64; 3]; 3]) {
        let Measured { quantity, value, sigma } = *channel;
        let Shape { base, .. } = shape;
        let (reactions, by_reactions) = reactions(shape);
        let dot = |weights: &[f64; 3], of: &[f64; 3]| weights.iter().zip(of).map(|(w, v)| w * v).sum::<f64>();
        let pose = [base.cut.x, base.cut.y, base.cut.phi];
        match quantity {
            Measurand::Reaction(weights) => {
                self.add(|k| dot(&weights, &by_reactions(k)), dot(&weights, &reactions) - value, sigma);
            }
            Measurand::Base(axis) => self.add(|k| base.by[k][axis.index()], pose[axis.index()] - value, sigma),
            Measurand::Support(axis) => {
                let row = &compliance[axis.index()];
                let at = pose[axis.index()] + dot(row, &reactions);
                self.add(|k| base.by[k][axis.index()] + dot(row, &by_reactions(k)), at - value, sigma);
            }
            Measurand::Curvature(_) | Measurand::Marker(..) => {}
        }
    }
}

impl Rows {
    /// The contact is on the rim of a pole.
    fn at_pole(&mut self, pole: &Pole, contact: &Contact) {
        let centre = Centre::of(contact, pole.radius, self.normal.gradient.len());
        for axis in [0, 1] {
            self.add(|k| centre.by(k)[axis], centre.at[axis] - pole.center[axis], pole.sigma);
        }
    }
}

/// The reactions (f0x, f0y, m0z) at the base, and their rates by an unknown.
pub(super) fn reactions(shape: &Shape) -> ([f64; 3], impl Fn(usize) -> [f64; 3] + '_) {
    let Shape { base, force, .. } = shape;
    let [a, b] = force.ab;
    let rates = |k: usize| [-force.by[k][1], force.by[k][0], -base.by[k][3]];
    // 0, not -0
    ([0.0 - b, a, 0.0 - base.cut.moment], rates)
}

impl<M: RodModel> Problem for FrameProblem<'_, M> {
    type Equations = NormalMatrix;

    fn equations(&mut self, u: &DVector<f64>) -> NormalMatrix {
        self.at(u)
            .map_or_else(|| NormalMatrix { cost: f64::INFINITY, ..NormalMatrix::empty(u.len()) }, |left| left.normal)
    }
}
