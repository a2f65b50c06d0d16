//! The forces of the chain's programme from a supposed contact set.

use super::programme::Programme;
use nalgebra::{DMatrix, DVector};

/// Limit of rounds of block pivoting, which may cycle.
const MOST_ROUNDS: usize = 12;
/// Rounding of a closed gap (L).
const CLOSED: f64 = 1e-13;
/// Least pivot of the factorisation, relative. Below it two of the nodes are one by rounding.
pub(super) const LEAST_PIVOT: f64 = 1e-10;

/// The forces under which no node goes through a wall, none pulls, and only closed gaps press. Nearly every step has so few
/// contacts that supposing them is cheaper than finding them one by one (`active_set`): none at first, then what
/// pulls lets go and what goes through is held, all at once, until both is nowhere the case (block pivoting, Portugal, Judice
/// and Vicente 1994). That is the solution, for there is only one. None where it does not settle.
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

/// The forces that close the gaps of what is held.
fn solve(programme: &Programme, held: &[usize]) -> Option<DVector<f64>> {
    let n = held.len();
    let matrix = DMatrix::from_fn(n, n, |i, j| if i < j { 0.0 } else { programme.coupling(held[i], held[j]) });
    let own = matrix.diagonal();
    let factor = matrix.cholesky()?;
    let lost = own.iter().zip(factor.l_dirty().diagonal().iter()).any(|(own, pivot)| pivot * pivot < LEAST_PIVOT * own);
    let gaps = DVector::from_fn(n, |i, _| -programme.gaps[held[i]]);
    (!lost).then(|| factor.solve(&gaps))
}
