//! What the recording tells of the contour at each of its points: it is touched, or the rod bounds it from outside, or nothing is known.

use super::bent::bent;
use super::contact_rates::ContactRates;
use super::curve::Node;
use super::problem::{Corrected, Fit, Model};
use super::swept::Swept;
use crate::phase::Label;
use nalgebra::{DMatrix, Vector2};
use rod_contact::State;
use rod_core::{PhysicalRod, Reactions};
use std::collections::{BTreeMap, BTreeSet};

/// How far outside of a contour the rod may have passed to bound it, rod lengths.
const FAR: f64 = 1.0;

/// Standard deviations of a contact's place that the way from a node to the next has at least, where the contact touches that node. Smaller: contacts of hardly loaded
/// rods, which may be anywhere; larger: the ends of what is touched are not known.
const SURE: f64 = 3.0;
/// Force of the contacts that touch a node, standard deviations, all together. Its share of the noise is that of the lever of the moment: less, and the contact
/// may as well be elsewhere on the rod, or not be there.
const LOADED: f64 = 5.0;

/// What is known of the contour at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Knowledge {
    /// The rod touches the contour there, or nearer to there than to a neighbour, at a contact whose place has less than a third of the way to
    /// that as its standard deviation.
    Touched {
        /// Standard deviation across the contour, in the worst direction at a vertex, m.
        sigma: f64,
    },
    /// The rod passed outside and touched nothing there. How deep the object is hollow is not known.
    Bounded {
        /// How far the object may reach beyond the point, across the contour, at most, m.
        room: f64,
    },
    /// The rod was not there.
    Unknown,
}

impl Knowledge {
    /// Standard deviation of a point that is touched, m.
    pub fn sigma(self) -> Option<f64> {
        if let Self::Touched { sigma } = self { Some(sigma) } else { None }
    }

    /// How far the object may reach beyond a point that is bounded, m.
    pub fn room(self) -> Option<f64> {
        if let Self::Bounded { room } = self { Some(room) } else { None }
    }

    /// In another unit of length.
    pub(super) fn scaled(self, unit: f64) -> Self {
        match self {
            Self::Touched { sigma } => Self::Touched { sigma: sigma * unit },
            Self::Bounded { room } => Self::Bounded { room: room * unit },
            Self::Unknown => Self::Unknown,
        }
    }

    /// Of the untouched node `k` of a chain, m.
    fn of_untouched(chain: &[Node], k: usize, swept: &Swept, length: f64) -> Self {
        let (before, after) = (chain[k.saturating_sub(1)].at, chain[(k + 1).min(chain.len() - 1)].at);
        if (chain[k].at - before).dot(&(after - chain[k].at)) < 0.0 {
            // it turns back: no side is outside
            return Self::Unknown;
        }
        let along = after - before;
        // the solid is on the left
        let outwards = Vector2::new(along.y, -along.x).try_normalize(0.0);
        let share = outwards.and_then(|outwards| swept.first_on_ray(chain[k].at / length, outwards * FAR));
        share.map_or(Self::Unknown, |share| Self::Bounded { room: share * FAR * length })
    }
}

impl<R: PhysicalRod> Fit<'_, R> {
    /// What is known at each node of each chain of a model whose contacts have these rates and whose blocks these labels.
    pub fn known(
        &self,
        model: &Model,
        rates: &[Option<Vec<ContactRates>>],
        covariance: &DMatrix<f64>,
        labels: &[Option<Label>],
    ) -> Vec<Vec<Knowledge>> {
        let (curve, length) = (&model.curve, self.rod.units().length);
        let swept = self.swept(model, labels);
        let by_noise = self.by_errors(covariance).map_or_else(|| covariance.clone(), |shared| covariance - shared);
        let touched = self.touched(model, rates, &by_noise);
        let of_chain = |chain: Vec<(usize, Node)>| {
            let (numbers, nodes): (Vec<usize>, Vec<Node>) = chain.into_iter().unzip();
            let of_node = |(k, node): (usize, &usize)| match touched.contains(node) {
                true => Knowledge::Touched { sigma: curve.variance(*node, covariance).max(0.0).sqrt() },
                false => Knowledge::of_untouched(&nodes, k, &swept, length),
            };
            numbers.iter().enumerate().map(of_node).collect()
        };
        curve.chains().map(|chain| of_chain(chain.collect())).collect()
    }

    /// The nodes that contacts touch whose place is known: a hardly loaded rod is straight, and does not tell where along it that is. `by_noise` is the
    /// covariance of the unknowns without errors that all samples share: these move all places alike.
    pub fn touched(
        &self,
        model: &Model,
        rates: &[Option<Vec<ContactRates>>],
        by_noise: &DMatrix<f64>,
    ) -> BTreeSet<usize> {
        let curve = &model.curve;
        let (mut sure, mut likely) = (BTreeSet::new(), BTreeSet::new());
        let mut load = BTreeMap::new();
        for (block, state) in
            model.states.iter().enumerate().filter_map(|(block, state)| Some((block, state.as_ref()?)))
        {
            for (contact, by) in state.contacts.iter().zip(rates[block].iter().flatten()) {
                let Some(node) = curve.node_at(contact) else { continue };
                let noise = self.blocks.blocks[block].sigma.xy().mean() * self.rod.units().force;
                *load.entry(node).or_insert(0.0) += (contact.force / noise).powi(2);
                let own = by.of_point(by_noise);
                let (sigma, way) = (own.symmetric_eigenvalues().max().sqrt(), curve.spacing(node));
                if sigma < way {
                    likely.insert(node);
                }
                if SURE * sigma < way {
                    sure.insert(node);
                }
            }
        }
        sure.retain(|node| load[node] > LOADED * LOADED);
        // those that are likely count between sure ones
        let mut touched = BTreeSet::new();
        for chain in curve.chains() {
            let nodes: Vec<usize> = chain.map(|(node, _)| node).collect();
            for run in nodes.chunk_by(|one, other| likely.contains(one) == likely.contains(other)) {
                let is_sure = |node: &usize| sure.contains(node);
                let ends = run.iter().position(is_sure).zip(run.iter().rposition(is_sure));
                touched.extend(ends.into_iter().flat_map(|(first, last)| &run[first..=last]));
            }
        }
        touched
    }

    /// Where the rod was.
    fn swept(&self, Model { corrected, states, .. }: &Model, labels: &[Option<Label>]) -> Swept {
        let shape = |(block, (state, label)): (&Corrected, (&Option<State>, &Option<Label>))| match state {
            Some(state) => state.elastica(self.rod).ok(),
            None if *label == Some(Label::Free) => bent(self.rod, block.pose, &Reactions::default(), &[]),
            None => None,
        };
        Swept::finely(corrected.iter().zip(states.iter().zip(labels)).filter_map(shape))
    }
}
