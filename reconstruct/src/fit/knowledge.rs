//! What the recording tells of the contour at each of its points: it is touched, or the rod bounds it from outside, or nothing is known.

use super::bent::bent;
use super::curve::{Curve, Node};
use super::problem::Fit;
use super::swept::Swept;
use crate::phase::Label;
use nalgebra::{DMatrix, DVector, Vector2};
use rod_contact::State;
use rod_core::{PhysicalRod, Reactions};
use std::collections::BTreeSet;

/// How far outside of a contour the rod may have passed to bound it, rod lengths.
const FAR: f64 = 1.0;

/// Standard deviations of a contact's place that the way from a node to the next has at least, where the contact touches that node. Smaller: contacts of hardly loaded
/// rods, which may be anywhere; larger: the ends of what is touched are not known.
const SURE: f64 = 3.0;

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
    /// What is known at each node of each chain of a contour, of the unknowns `x` with this covariance, by the states of the blocks.
    pub fn known(
        &self,
        x: &DVector<f64>,
        curve: &Curve,
        states: &[Option<State>],
        labels: &[Option<Label>],
        covariance: &DMatrix<f64>,
    ) -> Vec<Vec<Knowledge>> {
        let (chains, length) = (curve.nodes_of_chains(), self.rod.units().length);
        let swept = self.swept(x, states, labels);
        let touched = self.touched(x, curve, states, covariance).unwrap_or_default();
        let of_node = |node: usize, k: usize, chain: &[Node]| match touched.contains(&node) {
            true => Knowledge::Touched { sigma: curve.variance(node, covariance).max(0.0).sqrt() },
            false => Knowledge::of_untouched(chain, k, &swept, length),
        };
        let mut first = 0;
        let of_chain = |chain: &Vec<Node>| {
            let known = (0..chain.len()).map(|k| of_node(first + k, k, chain)).collect();
            first += chain.len();
            known
        };
        chains.iter().map(of_chain).collect()
    }

    /// The nodes that contacts touch whose place is known: a hardly loaded rod is straight, and does not tell where along it that is.
    fn touched(
        &self,
        x: &DVector<f64>,
        curve: &Curve,
        states: &[Option<State>],
        covariance: &DMatrix<f64>,
    ) -> Option<BTreeSet<usize>> {
        let model = self.model_with(x, curve.clone(), states.to_vec())?;
        let stepped = self.stepped(x)?;
        let (mut sure, mut likely) = (BTreeSet::new(), BTreeSet::new());
        for (block, state) in states.iter().enumerate().filter_map(|(block, state)| Some((block, state.as_ref()?))) {
            let known = self.covariances(x, &model, block, &stepped, [covariance; 2]).unwrap_or_default();
            for (contact, [own, _]) in state.contacts.iter().zip(known) {
                let Some(node) = curve.node_at(contact) else { continue };
                let sigma = own.symmetric_eigenvalues().max().sqrt();
                sure.extend(Some(node).filter(|node| SURE * sigma < curve.spacing(*node)));
                likely.extend(Some(node).filter(|node| sigma < curve.spacing(*node)));
            }
        }
        let mut touched = BTreeSet::new();
        for chain in curve.chains() {
            let nodes: Vec<usize> = chain.map(|(node, _)| node).collect();
            for run in nodes.chunk_by(|one, other| likely.contains(one) == likely.contains(other)) {
                // those that are likely count between sure ones
                let ends = run
                    .iter()
                    .position(|node| sure.contains(node))
                    .zip(run.iter().rposition(|node| sure.contains(node)));
                touched.extend(ends.into_iter().flat_map(|(first, last)| &run[first..=last]));
            }
        }
        Some(touched)
    }

    /// Where the rod was.
    fn swept(&self, x: &DVector<f64>, states: &[Option<State>], labels: &[Option<Label>]) -> Swept {
        let poses = self.poses(x).unwrap_or_default();
        let shape = |(pose, (state, label)): (_, (&Option<State>, &Option<Label>))| match state {
            Some(state) => state.elastica(self.rod).ok(),
            None if *label == Some(Label::Free) => bent(self.rod, pose, &Reactions::default(), &[]),
            None => None,
        };
        Swept::finely(poses.into_iter().zip(states.iter().zip(labels)).filter_map(shape))
    }
}
