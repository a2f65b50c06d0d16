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

/// What is known of the contour at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Knowledge {
    /// The rod touches the contour there, or nearer to there than to a neighbour.
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
        let along = chain[(k + 1).min(chain.len() - 1)].at - chain[k.saturating_sub(1)].at;
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
        let contacts = states.iter().flatten().flat_map(|state| &state.contacts);
        let touched: BTreeSet<usize> = contacts.filter_map(|contact| curve.node_at(contact)).collect();
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
