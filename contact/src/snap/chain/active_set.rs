//! The contact forces of a step of the chain, by a dual active-set method.

use super::pressed::LEAST_PIVOT;
use super::programme::Programme;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Gap below which a wall is violated, L. The rounding of a gap is below 1e-12; the chain looks at ten thousand times as much.
const VIOLATED: f64 = -1e-10;
/// Most steps a near node. One or two are usual; only rounding can make them repeat.
const MOST_STEPS: usize = 20;

/// Contact forces with: no penetration, no adhesion, complementarity. The method of Goldfarb and Idnani (Mathematical Programming 27, 1983) solves
/// the dual programme in finitely many steps. It starts without forces.
/// In each round the force at the deepest violated gap rises until that gap closes, while the gaps that are held stay closed; a
/// held node whose force falls to zero meanwhile lets go. None where the walls leave no room.
pub(super) fn solve_by_active_set(programme: &Programme) -> Option<Vec<f64>> {
    let m = programme.rows.len();
    let (mut forces, mut held, mut steps) = (vec![0.0; m], Vec::new(), MOST_STEPS * m);
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
