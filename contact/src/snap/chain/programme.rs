//! The quadratic programme of one implicit step of the chain.

use super::near::Near;
use super::{Base, Chain, LINKS, Nodes};
use crate::scene::springs::Spring;
use smallvec::SmallVec;

/// One number a joint.
pub(super) type Joints = [f64; LINKS];

/// The change of the chain in a step: of its joints, and of the way of its base along each spring.
#[derive(Clone, Copy)]
pub(super) struct Change {
    pub joints: Joints,
    pub base: Base,
}

/// Minimise 1/2 d' D d + q' d over the change d of joints and base subject to A d <= b, with a diagonal D; of its dual in the forces
/// f >= 0 at the near nodes, which are few: minimise 1/2 f' (A D^-1 A') f + (b + A D^-1 q)' f, then d = -D^-1 (q + A' f).
/// Walls between which, linearised, there is no room are let give way by `yielding` a unit of force: A d <= b + yielding f.
pub(super) struct Programme {
    /// A, a row a near node: how its gap falls with the joints.
    pub rows: Vec<Joints>,
    /// The same with the springs of the base; without rows where that is rigid.
    base_rows: Vec<Base>,
    /// b + A D^-1 q: its gap after the step if nothing pressed.
    pub gaps: Vec<f64>,
    /// The diagonal of D^-1.
    pub softness: Joints,
    base_softness: SmallVec<Base>,
    pub yielding: f64,
    /// -D^-1 q: the change if nothing pressed.
    pub free: Change,
}

impl Programme {
    pub fn new(chain: &Chain, nodes: &Nodes, near: &[Near], time_step: f64, push: f64) -> Self {
        let damped = 1.0 + 1.0 / time_step;
        // every joint gives way by the same share
        let free = Change {
            joints: std::array::from_fn(|i| -(chain.joints[i] - chain.rest[i]) / damped),
            base: chain.given.map(|given| -given / damped),
        };
        // by joint i node turns as (dx, dy) -> (-dy, dx); the gap falls along the normal (-sin, cos)
        let gradient = |&Near { s, x, y, alpha, .. }: &Near| -> Joints {
            let (sin, cos) = alpha.sin_cos();
            std::array::from_fn(
                |i| if (i as f64) < s { (y - nodes[i][1]) * sin + (x - nodes[i][0]) * cos } else { 0.0 },
            )
        };
        let rows: Vec<Joints> = near.iter().map(gradient).collect();
        let base_gradient = |&Near { x, y, alpha, .. }: &Near| -> Base {
            let ((sin, cos), mut row) = (alpha.sin_cos(), [0.0; 3]);
            for (entry, Spring { way, .. }) in row.iter_mut().zip(&chain.springs) {
                let (dx, dy) = (way[0] - way[2] * (y - nodes[0][1]), way[1] + way[2] * (x - nodes[0][0]));
                *entry = dy * cos - dx * sin;
            }
            row
        };
        let is_rigid = chain.springs.is_empty();
        let base_rows: Vec<Base> = near.iter().filter(|_| !is_rigid).map(base_gradient).collect();
        let softness = chain.softness.map(|softness| softness / damped);
        let base_softness = chain.springs.iter().map(|spring| spring.softness / damped).collect();
        let mut programme = Self { rows, base_rows, gaps: Vec::new(), softness, base_softness, yielding: 0.0, free };
        programme.gaps =
            near.iter().enumerate().map(|(i, near)| near.gap.max(-push) - programme.closing(i, &free)).collect();
        programme
    }

    /// By how much a change of the chain closes the gap of a near node.
    pub fn closing(&self, i: usize, change: &Change) -> f64 {
        let by_base = self.base_rows.get(i).map_or(0.0, |row| row.iter().zip(change.base).map(|(r, d)| r * d).sum());
        dot(&self.rows[i], &change.joints) + by_base
    }

    /// An entry of the matrix A D^-1 A' of the dual, or what gives way in its place.
    pub fn coupling(&self, i: usize, j: usize) -> f64 {
        let given = if i == j { self.yielding } else { 0.0 };
        let products = self.rows[i].iter().zip(&self.rows[j]).zip(&self.softness);
        let of_joints = given + products.map(|((left, right), softness)| left * right * softness).sum::<f64>();
        let of_base = |(k, softness): (usize, &f64)| softness * self.base_rows[i][k] * self.base_rows[j][k];
        of_joints + self.base_softness.iter().enumerate().map(of_base).sum::<f64>()
    }

    /// How the chain gives way to forces at the near nodes.
    pub fn change_by(&self, forces: &[f64]) -> Change {
        let mut bent = Change { joints: [0.0; LINKS], base: [0.0; 3] };
        for (i, force) in forces.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            for ((bent, softness), row) in bent.joints.iter_mut().zip(&self.softness).zip(&self.rows[i]) {
                *bent += softness * row * force;
            }
            for (k, softness) in self.base_softness.iter().enumerate() {
                bent.base[k] += softness * self.base_rows[i][k] * force;
            }
        }
        bent
    }
}

fn dot(left: &Joints, right: &Joints) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}
