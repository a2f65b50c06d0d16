//! The contact forces of a step of the chain, by block pivoting.

use super::programme::Programme;
use nalgebra::{DMatrix, DVector};

/// Limit of rounds of block pivoting, which may cycle.
const MOST_ROUNDS: usize = 12;
/// Rounding of a closed gap (L).
const CLOSED: f64 = 1e-13;
/// Least pivot of the factorisation, relative. Below it two of the nodes are one by rounding.
pub(super) const LEAST_PIVOT: f64 = 1e-10;

/// Contact forces with: no penetration, no adhesion, complementarity. Block pivoting (Portugal, Judice and Vicente 1994) begins without contacts.
/// In each round all nodes that pull are released and all that penetrate are held, until there are neither: the unique solution. With the few
/// contacts of nearly every step this is cheaper than the active-set method, which adds one contact at a time. None where the rounds cycle or
/// the matrix is ill-conditioned.
pub(super) fn solve_by_pivoting(programme: &Programme) -> Option<Vec<f64>> {
    let m = programme.rows.len();
    let mut forces = vec![0.0; m];
    let mut held: Vec<usize> = Vec::new();
    for _ in 0..MOST_ROUNDS {
        let bent = programme.change_by(&forces);
        let gap = |j: usize| programme.gaps[j] + programme.closing(j, &bent) + programme.yielding * forces[j];
        let holds = |j: usize| if forces[j] == 0.0 { gap(j) < -CLOSED } else { forces[j] > 0.0 };
        let next: Vec<usize> = (0..m).filter(|j| holds(*j)).collect();
        if next == held {
            return Some(forces);
        }
        held = next;
        let pressing = solve(programme, &held)?;
        forces.fill(0.0);
        held.iter().zip(pressing.iter()).for_each(|(j, force)| forces[*j] = *force);
    }
    None
}

/// The forces that close the gaps of the held nodes.
fn solve(programme: &Programme, held: &[usize]) -> Option<DVector<f64>> {
    let n = held.len();
    let matrix = DMatrix::from_fn(n, n, |i, j| if i < j { 0.0 } else { programme.coupling(held[i], held[j]) });
    let own = matrix.diagonal();
    let factor = matrix.cholesky()?;
    let lost = own.iter().zip(factor.l_dirty().diagonal().iter()).any(|(own, pivot)| pivot * pivot < LEAST_PIVOT * own);
    let gaps = DVector::from_fn(n, |i, _| -programme.gaps[held[i]]);
    (!lost).then(|| factor.solve(&gaps))
}
