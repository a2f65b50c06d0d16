//! The quadratic programme of one implicit step of the chain.

use super::active_set::active_set;
use super::near::Near;
use super::pressed::pressed;
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
    free: Joints,
}

impl Programme {
    pub fn new(chain: &Chain, nodes: &Nodes, near: &[Near], time_step: f64, push: f64) -> Self {
        let damped = 1.0 + 1.0 / time_step;
        // every joint gives way by the same share
        let free = chain.joints.map(|joint| -joint / damped);
        // by joint i node turns as (dx, dy) -> (-dy, dx); the gap falls along the normal (-sin, cos)
        let gradient = |&Near { s, x, y, alpha, .. }: &Near| -> Joints {
            let (sin, cos) = alpha.sin_cos();
            std::array::from_fn(
                |i| if (i as f64) < s { (y - nodes[i][1]) * sin + (x - nodes[i][0]) * cos } else { 0.0 },
            )
        };
        let rows: Vec<Joints> = near.iter().map(gradient).collect();
        let gaps = near.iter().zip(&rows).map(|(near, row)| near.gap.max(-push) - dot(row, &free)).collect();
        let softness = std::array::from_fn(|i| 1.0 / (Chain::stiffness(i) * damped));
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

    /// Change d of the joints, force at each near node; none where there is none, none was found, or the `work` that is left
    /// does not do for it (in units of the cube of the number of near nodes).
    pub fn solve(&self, work: &mut f64) -> Option<(Joints, Vec<f64>)> {
        let forces = pressed(self).or_else(|| {
            *work -= (self.rows.len() as f64).powi(3);
            (*work >= 0.0).then(|| active_set(self)).flatten()
        })?;
        let bent = self.bent(&forces);
        Some((std::array::from_fn(|i| self.free[i] - bent[i]), forces))
    }
}

pub(super) fn dot(left: &Joints, right: &Joints) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use rod_core::Pose;
    use std::f64::consts::PI;

    /// A straight chain above a wavy floor that has come up to it in places.
    fn floored(seed: u32) -> Programme {
        let chain = Chain::straight(Pose { x: 0.0, y: 0.0, phi: 0.0 }, 0.02 * f64::from(seed % 7));
        let (nodes, _) = chain.nodes();
        let waves = 2.0 + f64::from(seed) * 0.7;
        let near: Vec<Near> = (1..=LINKS)
            .filter(|i| i % (1 + seed as usize % 3) == 0)
            .map(|i| {
                let ([x, y], phase) = (nodes[i], waves * i as f64 / LINKS as f64);
                let (gap, alpha) = (0.01 * phase.cos() + 0.002, 0.3 * phase.sin());
                Near { s: i as f64, x, y, stretch: 0, gap, alpha }
            })
            .collect();
        Programme::new(&chain, &nodes, &near, 1.0, 0.03)
    }

    /// No wall is gone through by more than rounding, none pulls, and only closed gaps press.
    fn solves(programme: &Programme, forces: &[f64]) -> bool {
        let bent = programme.bent(forces);
        let slack = 1e-10 + 1e-15 * forces.iter().copied().fold(0.0, f64::max);
        programme.rows.iter().zip(&programme.gaps).zip(forces).all(|((row, gap), force)| {
            let gap = gap + dot(row, &bent) + programme.yielding * force;
            gap > -slack && *force >= 0.0 && (*force == 0.0 || gap < slack)
        })
    }

    #[test]
    fn contacts_that_hold_are_those_of_the_active_set() {
        let mut settled = 0;
        for seed in 0..60 {
            let programme = floored(seed);
            let exact = active_set(&programme).unwrap();
            assert!(solves(&programme, &exact), "{seed}");
            let Some(forces) = pressed(&programme) else { continue };
            settled += 1;
            assert!(solves(&programme, &forces), "{seed}");
            let largest = exact.iter().copied().fold(0.0, f64::max);
            for (force, exact) in forces.iter().zip(&exact) {
                assert!((force - exact).abs() < 1e-6 * (1.0 + largest), "{seed}: {force} {exact}");
            }
        }
        assert!(settled > 40, "{settled}");
    }

    /// A wall in the way of the node `s`: where it is and how it lies.
    fn walls() -> impl Strategy<Value = Vec<(usize, f64, f64)>> {
        vec((1..=LINKS, -0.02..0.06_f64, -0.3..0.3_f64), 1..100)
    }

    proptest! {
        #[test]
        fn the_active_set_solves_what_has_a_solution(
            (bend, base, walls, time_step) in (-6.0..6.0_f64, -3.0..3.0_f64, walls(), -3.0..3.0_f64),
            both_sides in any::<bool>(),
            yields in any::<bool>(),
        ) {
            let chain = Chain::straight(Pose { x: 0.0, y: 0.0, phi: 0.0 }, bend);
            let (nodes, _) = chain.nodes();
            let wall = |(k, (i, gap, turned)): (usize, (usize, f64, f64))| {
                let [x, y] = nodes[i];
                let turned = if both_sides && k % 3 == 0 { turned + PI } else { turned };
                Near { s: i as f64, x, y, stretch: 0, gap, alpha: base + turned }
            };
            let near: Vec<Near> = walls.into_iter().enumerate().map(wall).collect();
            let mut programme = Programme::new(&chain, &nodes, &near, 10_f64.powf(time_step), 0.03);
            programme.yielding = if yields { 1e-5 } else { 0.0 };
            let found = active_set(&programme);
            prop_assert!(found.is_some() || !yields);
            prop_assert!(found.is_none_or(|forces| solves(&programme, &forces)));
        }
    }

    #[test]
    fn nothing_near_gives_way_freely() {
        let chain = Chain::straight(Pose { x: 0.0, y: 0.0, phi: 0.0 }, 1.0);
        let (nodes, _) = chain.nodes();
        let (change, forces) = Programme::new(&chain, &nodes, &[], 1.0, 0.03).solve(&mut { f64::INFINITY }).unwrap();
        assert!(forces.is_empty());
        assert!(change.iter().zip(&chain.joints).all(|(change, joint)| (change + 0.5 * joint).abs() < 1e-15));
    }

    #[test]
    fn walls_without_room_give_way_only_where_they_may() {
        let chain = Chain::straight(Pose { x: 0.0, y: 0.0, phi: 0.0 }, 0.0);
        let (nodes, _) = chain.nodes();
        let [x, y] = nodes[LINKS];
        let wall = |alpha| Near { s: LINKS as f64, x, y, stretch: 0, gap: -0.01, alpha };
        let walls = [wall(0.0), wall(PI)];
        let mut programme = Programme::new(&chain, &nodes, &walls, 1.0, 0.03);
        assert!(programme.solve(&mut { f64::INFINITY }).is_none());
        programme.yielding = 1e-5;
        let (_, forces) = programme.solve(&mut { f64::INFINITY }).unwrap();
        assert!((forces[0] - forces[1]).abs() < 1e-3 * forces[0] && forces[0] > 100.0, "{forces:?}");
    }
}
