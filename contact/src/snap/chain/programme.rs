//! The quadratic programme of one implicit step of the chain.

use super::near::Near;
use super::{Chain, LINKS, Nodes};

/// One number a joint.
pub(super) type Joints = [f64; LINKS];

/// Minimise 1/2 d' D d + q' d over the change d of the joints subject to A d <= b, with a diagonal D; of its dual in the forces
/// f >= 0 at the near nodes, which are few: minimise 1/2 f' (A D^-1 A') f + (b + A D^-1 q)' f, then d = -D^-1 (q + A' f).
/// Walls between which, linearised, there is no room are let give way by `yielding` a unit of force: A d <= b + yielding f.
pub(super) struct Programme {
    /// A, a row a near node: how its gap falls with the joints.
    pub rows: Vec<Joints>,
    /// b + A D^-1 q: its gap after the step if nothing pressed.
    pub gaps: Vec<f64>,
    /// The diagonal of D^-1.
    pub softness: Joints,
    pub yielding: f64,
    /// -D^-1 q: the change if nothing pressed.
    pub free: Joints,
}

impl Programme {
    pub fn new(chain: &Chain, nodes: &Nodes, near: &[Near], time_step: f64, push: f64) -> Self {
        let damped = 1.0 + 1.0 / time_step;
        // every joint gives way by the same share
        let free = std::array::from_fn(|i| -(chain.joints[i] - chain.rest[i]) / damped);
        // by joint i node turns as (dx, dy) -> (-dy, dx); the gap falls along the normal (-sin, cos)
        let gradient = |&Near { s, x, y, alpha, .. }: &Near| -> Joints {
            let (sin, cos) = alpha.sin_cos();
            std::array::from_fn(
                |i| if (i as f64) < s { (y - nodes[i][1]) * sin + (x - nodes[i][0]) * cos } else { 0.0 },
            )
        };
        let rows: Vec<Joints> = near.iter().map(gradient).collect();
        let gaps = near.iter().zip(&rows).map(|(near, row)| near.gap.max(-push) - dot(row, &free)).collect();
        let softness = chain.softness.map(|softness| softness / damped);
        Self { rows, gaps, softness, yielding: 0.0, free }
    }

    /// An entry of the matrix A D^-1 A' of the dual, or what gives way in its place.
    pub fn coupling(&self, i: usize, j: usize) -> f64 {
        let given = if i == j { self.yielding } else { 0.0 };
        let products = self.rows[i].iter().zip(&self.rows[j]).zip(&self.softness);
        given + products.map(|((left, right), softness)| left * right * softness).sum::<f64>()
    }

    /// How the joints give way to forces at the near nodes.
    pub fn bent(&self, forces: &[f64]) -> Joints {
        let mut bent = [0.0; LINKS];
        for (row, force) in self.rows.iter().zip(forces).filter(|(_, force)| **force != 0.0) {
            for ((bent, softness), row) in bent.iter_mut().zip(&self.softness).zip(row) {
                *bent += softness * row * force;
            }
        }
        bent
    }
}

pub(super) fn dot(left: &Joints, right: &Joints) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}
