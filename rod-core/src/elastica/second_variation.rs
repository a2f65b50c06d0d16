//! Whether an equilibrium without contacts is stable: in how many directions the second variation of its energy is negative.
//!
//! For a variation eta of the slope angle with eta(0) = 0, held coordinates of the tip and dead loads,
//!
//! ```text
//! Q = int_0^1 EI eta'^2 - (A sin phi - B cos phi) eta^2 ds
//! ```
//!
//! subject to int -sin phi eta = 0 where x is held, int cos phi eta = 0 where y is held, and eta(1) = 0 where the angle is. Between two
//! nodes so close together that nothing buckles between them, Q is least for the Jacobi field through the values of eta at the nodes,
//! which the exact derivatives of the segment give. With a multiplier for each held coordinate, the second variation becomes the
//! symmetric matrix of the values at the nodes and the multipliers; it has one negative eigenvalue for each multiplier, and one for each
//! unstable direction. No discretisation error: the sign is right up to rounding.

use super::problem::{Multiple, Problem, Shape};
use super::tip::TipEnd;
use crate::model::RodModel;
use nalgebra::{DMatrix, Matrix2, SymmetricEigen};

/// Phase of the Jacobi field between two nodes, rad: below pi, so that no segment buckles between them.
const PHASE: f64 = 1.0;
/// Least number of nodes: the angles there determine which constraints the rod fulfils anyway.
const NODES: usize = 8;
/// Eigenvalues below this part of the largest one are zero.
const ZERO: f64 = 1e-12;
/// Square of the way of the tip (L per rad) below which a constraint is none: a straight rod does not move along its axis.
const NO_WAY: f64 = 1e-18;

/// The number of unstable directions, and whether the second variation vanishes in a further one.
pub(super) fn unstable_directions<M: RodModel>(
    problem: &Problem<'_, M>,
    shape: &Shape<'_, M>,
    force: [f64; 2],
) -> (usize, bool) {
    let mesh = Multiple::new(problem, force, PHASE).refined(NODES);
    let n = mesh.len() - 1;
    // dE / d(phi_i), dE / d(force): nodes 1 to n, then both components
    let mut hessian = DMatrix::<f64>::zeros(n + 2, n + 2);
    let mut ways = Matrix2::<f64>::zeros();
    for i in 0..n {
        let start = shape.cut(mesh[i]);
        let (a, b) = shape.force(mesh[i]);
        let (_, d) = problem.rod.carry_with_sensitivities(mesh[i], &start, a, b, mesh[i + 1] - mesh[i]);
        let by_force = [d.by_b, d.by_a.map(|v| -v)];
        let own = [i.checked_sub(1), Some(i)];
        let [p, q, r, s] = [d.by_phi[2], d.by_moment[2], d.by_phi[3], d.by_moment[3]];
        // the moment at the start as a function of both angles and the force
        let start_by = [-p / q, 1.0 / q, -by_force[0][2] / q, -by_force[1][2] / q];
        let end_by =
            [r + s * start_by[0], s * start_by[1], by_force[0][3] + s * start_by[2], by_force[1][3] + s * start_by[3]];
        let columns = [own[0], own[1], Some(n), Some(n + 1)];
        for (k, column) in columns.iter().enumerate() {
            let Some(column) = *column else { continue };
            if let Some(row) = own[0] {
                hessian[(row, column)] -= start_by[k];
            }
            hessian[(i, column)] += end_by[k];
            let turned = if k == 0 { d.by_phi } else { [0.0; 4] };
            for (row, entry) in [(n, 0), (n + 1, 1)] {
                let pushed = if k >= 2 { by_force[k - 2][entry] } else { 0.0 };
                hessian[(row, column)] -= turned[entry] + pushed + d.by_moment[entry] * start_by[k];
            }
        }
        let middle = shape.cut(0.5 * (mesh[i] + mesh[i + 1])).phi;
        let (way, length) = (nalgebra::Vector2::new(-middle.sin(), middle.cos()), mesh[i + 1] - mesh[i]);
        ways += length * way * way.transpose();
    }
    let (free, multipliers) = free_directions(problem, n, ways);
    let matrix = free.transpose() * &hessian * &free;
    let matrix = 0.5 * (&matrix + matrix.transpose());
    let eigenvalues = SymmetricEigen::new(matrix).eigenvalues;
    let largest = eigenvalues.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let negative = eigenvalues.iter().filter(|value| **value < -ZERO * largest).count();
    let zero = eigenvalues.iter().any(|value| value.abs() <= ZERO * largest);
    (negative.saturating_sub(multipliers), zero)
}

/// The columns that vary: the angles at the nodes, without that of the tip where it is held, and the multipliers of the constraints that
/// are any.
fn free_directions<M: RodModel>(problem: &Problem<'_, M>, n: usize, ways: Matrix2<f64>) -> (DMatrix<f64>, usize) {
    let angles = if matches!(problem.tip.phi, TipEnd::Held(_)) { n - 1 } else { n };
    let held: Vec<usize> = problem.held().collect();
    let directions: Vec<[f64; 2]> = match held[..] {
        [] => Vec::new(),
        [one] if ways[(one, one)] > NO_WAY => vec![[f64::from(one == 0), f64::from(one == 1)]],
        [_] => Vec::new(),
        _ => {
            let axes = SymmetricEigen::new(ways);
            let kept = (0..2).filter(|k| axes.eigenvalues[*k] > NO_WAY);
            kept.map(|k| [axes.eigenvectors[(0, k)], axes.eigenvectors[(1, k)]]).collect()
        }
    };
    let mut free = DMatrix::zeros(n + 2, angles + directions.len());
    (0..angles).for_each(|k| free[(k, k)] = 1.0);
    for (k, direction) in directions.iter().enumerate() {
        (free[(n, angles + k)], free[(n + 1, angles + k)]) = (direction[0], direction[1]);
    }
    (free, directions.len())
}
