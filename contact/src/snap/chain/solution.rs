//! The solution of the quadratic programme of a step: by block pivoting, or by the active-set method where block pivoting fails.

use super::programme::{Change, Programme};
use nalgebra::{Cholesky, DMatrix, DVector};
use smallvec::SmallVec;

/// Change d of the chain and the force at each near node. None where the walls leave no room, or where the `work` that is left (in
/// units of the cube of the number of near nodes) does not suffice.
pub(super) fn solve(programme: &Programme, work: &mut f64) -> Option<(Change, Vec<f64>)> {
    let forces = solve_by_pivoting(programme).or_else(|| {
        *work -= (programme.rows.len() as f64).powi(3);
        (*work >= 0.0).then(|| solve_by_active_set(programme)).flatten()
    })?;
    let (free, bent) = (&programme.free, programme.change_by(&forces));
    let joints = std::array::from_fn(|i| free.joints[i] - bent.joints[i]);
    let base = std::array::from_fn(|k| free.base[k] - bent.base[k]);
    Some((Change { joints, base }, forces))
}

/// Near nodes for which memory is on the stack.
const FEW: usize = 8;
/// Limit of rounds of block pivoting, which may cycle.
const MOST_ROUNDS: usize = 12;
/// Rounding of a closed gap (L).
const CLOSED: f64 = 1e-13;
/// Least pivot of the factorisation, relative. Below it two of the nodes are one by rounding.
const LEAST_PIVOT: f64 = 1e-10;

/// Contact forces with: no penetration, no adhesion, complementarity. Block pivoting (Portugal, Judice and Vicente 1994) begins without contacts.
/// In each round all nodes that pull are released and all that penetrate are held, until there are neither: the unique solution. With the few
/// contacts of nearly every step this is cheaper than the active-set method, which adds one contact at a time. None where the rounds cycle or
/// the matrix is ill-conditioned.
fn solve_by_pivoting(programme: &Programme) -> Option<Vec<f64>> {
    let m = programme.rows.len();
    let mut forces = vec![0.0; m];
    let mut held: SmallVec<[usize; FEW]> = SmallVec::new();
    // the columns of the matrix of all nodes that have been held
    let mut columns: SmallVec<[(usize, SmallVec<[f64; FEW]>); FEW]> = SmallVec::new();
    for _ in 0..MOST_ROUNDS {
        let mut gaps: SmallVec<[f64; FEW]> = SmallVec::from_slice(&programme.gaps);
        for (k, column) in columns.iter().filter(|(k, _)| forces[*k] != 0.0) {
            gaps.iter_mut().zip(column).for_each(|(gap, coupling)| *gap += coupling * forces[*k]);
        }
        let holds = |j: usize| if forces[j] == 0.0 { gaps[j] < -CLOSED } else { forces[j] > 0.0 };
        let next: SmallVec<[usize; FEW]> = (0..m).filter(|j| holds(*j)).collect();
        if next == held {
            return Some(forces);
        }
        held = next;
        for &j in &held {
            if columns.iter().all(|(k, _)| *k != j) {
                columns.push((j, (0..m).map(|i| programme.coupling(i, j)).collect()));
            }
        }
        let pressing = solve_held(programme, &held, &columns)?;
        forces.fill(0.0);
        held.iter().zip(pressing.iter()).for_each(|(j, force)| forces[*j] = *force);
    }
    None
}

/// The forces that close the gaps of the held nodes, whose columns are among those given.
fn solve_held(
    programme: &Programme,
    held: &[usize],
    columns: &[(usize, SmallVec<[f64; FEW]>)],
) -> Option<DVector<f64>> {
    let n = held.len();
    let mut matrix = DMatrix::zeros(n, n);
    for (mut entries, j) in matrix.column_iter_mut().zip(held) {
        let (_, column) = columns.iter().find(|(k, _)| k == j)?;
        entries.iter_mut().zip(held).for_each(|(entry, i)| *entry = column[*i]);
    }
    let own = matrix.diagonal();
    let factor = matrix.cholesky()?;
    let lost = own.iter().zip(factor.l_dirty().diagonal().iter()).any(|(own, pivot)| pivot * pivot < LEAST_PIVOT * own);
    let gaps = DVector::from_fn(n, |i, _| -programme.gaps[held[i]]);
    (!lost).then(|| factor.solve(&gaps))
}

/// Gap below which a wall is violated, L. The rounding of a gap is below 1e-12; the chain looks at ten thousand times as much.
const VIOLATED: f64 = -1e-10;
/// Most steps a near node. One or two are usual; only rounding can make them repeat.
const MOST_STEPS_A_NODE: usize = 20;

/// Contact forces with: no penetration, no adhesion, complementarity. The method of Goldfarb and Idnani (Mathematical Programming 27, 1983) solves
/// the dual programme in finitely many steps. It starts without forces.
/// In each round the force at the deepest violated gap rises until that gap closes, while the gaps that are held stay closed; a
/// held node whose force falls to zero meanwhile lets go. None where the walls leave no room.
fn solve_by_active_set(programme: &Programme) -> Option<Vec<f64>> {
    let m = programme.rows.len();
    let (mut forces, mut held, mut steps) = (vec![0.0; m], Vec::new(), MOST_STEPS_A_NODE * m);
    let mut factor = Cholesky::new(DMatrix::<f64>::zeros(0, 0))?;
    loop {
        let bent = programme.change_by(&forces);
        let open = (0..m).filter(|j| !held.contains(j));
        let gaps = open.map(|j| (j, programme.gaps[j] + programme.closing(j, &bent)));
        let Some((deepest, mut gap)) =
            gaps.filter(|(_, gap)| *gap < VIOLATED).min_by(|(_, left), (_, right)| left.total_cmp(right))
        else {
            return Some(forces);
        };
        let own = programme.coupling(deepest, deepest);
        loop {
            steps = steps.checked_sub(1)?;
            let column = DVector::from_iterator(held.len(), held.iter().map(|j| programme.coupling(*j, deepest)));
            // by a unit of force at the deepest gap the held forces fall, and it opens
            let falls = factor.solve(&column);
            let opens = own - column.dot(&falls);
            let closed = if opens > LEAST_PIVOT * own { -gap / opens } else { f64::INFINITY };
            let spent = held.iter().zip(falls.iter()).enumerate().filter(|(_, (_, fall))| **fall > 0.0);
            let first = spent.map(|(k, (j, fall))| (k, forces[*j] / fall)).min_by(|(_, l), (_, r)| l.total_cmp(r));
            let rise = first.map_or(closed, |(_, spent)| spent.min(closed));
            if !rise.is_finite() {
                return None;
            }
            for (j, fall) in held.iter().zip(falls.iter()) {
                forces[*j] = (forces[*j] - rise * fall).max(0.0);
            }
            forces[deepest] += rise;
            gap += rise * opens;
            match first {
                Some((k, spent)) if spent < closed => {
                    forces[held.remove(k)] = 0.0;
                    factor = factor.remove_column(k);
                }
                _ => {
                    factor = factor.insert_column(held.len(), column.push(own));
                    held.push(deepest);
                    break;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::near::Near;
    use super::super::{Chain, LINKS, Place};
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use rod_core::{Pose, Uniform};
    use std::f64::consts::PI;

    /// A straight chain above a wavy floor that has come up to it in places.
    fn programme_above_floor(seed: u32) -> Programme {
        let chain = Chain::at_rest(&Uniform, &Pose { x: 0.0, y: 0.0, phi: 0.0 }, 0.02 * f64::from(seed % 7));
        let Place { nodes, .. } = chain.place();
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
        let bent = programme.change_by(forces);
        let slack = 1e-10 + 1e-15 * forces.iter().copied().fold(0.0, f64::max);
        programme.gaps.iter().zip(forces).enumerate().all(|(i, (gap, force))| {
            let gap = gap + programme.closing(i, &bent) + programme.yielding * force;
            gap > -slack && *force >= 0.0 && (*force == 0.0 || gap < slack)
        })
    }

    #[test]
    fn contacts_that_hold_are_those_of_the_active_set() {
        let mut settled = 0;
        for seed in 0..60 {
            let programme = programme_above_floor(seed);
            let exact = solve_by_active_set(&programme).unwrap();
            assert!(solves(&programme, &exact), "{seed}");
            let Some(forces) = solve_by_pivoting(&programme) else { continue };
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
            let chain = Chain::at_rest(&Uniform, &Pose { x: 0.0, y: 0.0, phi: 0.0 }, bend);
            let Place { nodes, .. } = chain.place();
            let wall = |(k, (i, gap, turned)): (usize, (usize, f64, f64))| {
                let [x, y] = nodes[i];
                let turned = if both_sides && k % 3 == 0 { turned + PI } else { turned };
                Near { s: i as f64, x, y, stretch: 0, gap, alpha: base + turned }
            };
            let near: Vec<Near> = walls.into_iter().enumerate().map(wall).collect();
            let mut programme = Programme::new(&chain, &nodes, &near, 10_f64.powf(time_step), 0.03);
            programme.yielding = if yields { 1e-5 } else { 0.0 };
            let found = solve_by_active_set(&programme);
            prop_assert!(found.is_some() || !yields);
            prop_assert!(found.is_none_or(|forces| solves(&programme, &forces)));
        }
    }

    #[test]
    fn nothing_near_gives_way_freely() {
        let chain = Chain::at_rest(&Uniform, &Pose { x: 0.0, y: 0.0, phi: 0.0 }, 1.0);
        let Place { nodes, .. } = chain.place();
        let (change, forces) = solve(&Programme::new(&chain, &nodes, &[], 1.0, 0.03), &mut { f64::INFINITY }).unwrap();
        assert!(forces.is_empty());
        assert!(change.joints.iter().zip(&chain.joints).all(|(change, joint)| (change + 0.5 * joint).abs() < 1e-15));
    }

    #[test]
    fn walls_without_room_give_way_only_where_they_may() {
        let chain = Chain::at_rest(&Uniform, &Pose { x: 0.0, y: 0.0, phi: 0.0 }, 0.0);
        let Place { nodes, .. } = chain.place();
        let [x, y] = nodes[LINKS];
        let wall = |alpha| Near { s: LINKS as f64, x, y, stretch: 0, gap: -0.01, alpha };
        let walls = [wall(0.0), wall(PI)];
        let mut programme = Programme::new(&chain, &nodes, &walls, 1.0, 0.03);
        assert!(solve(&programme, &mut { f64::INFINITY }).is_none());
        programme.yielding = 1e-5;
        let (_, forces) = solve(&programme, &mut { f64::INFINITY }).unwrap();
        assert!((forces[0] - forces[1]).abs() < 1e-3 * forces[0] && forces[0] > 100.0, "{forces:?}");
    }
}
