//! The quadratic programme of one implicit step of the chain.

use super::near::Near;
use super::{Chain, LINKS, Nodes};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

/// Change d of the joints, force at each near node.
///
/// Minimise 1/2 d' D d + q' d subject to A d <= b with a diagonal D, solved by its dual in the forces, which are few:
/// minimise 1/2 f' (A D^-1 A') f + (b + A D^-1 q)' f over f >= 0, then d = -D^-1 (q + A' f). Walls between which,
/// linearised, there is no room are let give way by `yielding` a unit of force: A d <= b + yielding f.
pub(super) fn programme(
    chain: &Chain,
    nodes: &Nodes,
    near: &[Near],
    time_step: f64,
    push: f64,
    yielding: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let damped = 1.0 + 1.0 / time_step;
    let softness = |i: usize| 1.0 / (Chain::stiffness(i) * damped);
    // D^-1 q: every joint gives way by the same share
    let mut change: Vec<f64> = chain.joints.iter().map(|joint| -joint / damped).collect();
    if near.is_empty() {
        return Some((change, Vec::new()));
    }
    // by joint i node turns as (dx, dy) -> (-dy, dx); the gap falls along the normal (-sin, cos)
    let gradient = |&Near { s, x, y, alpha, .. }: &Near| -> [f64; LINKS] {
        let (sin, cos) = alpha.sin_cos();
        std::array::from_fn(|i| if (i as f64) < s { (y - nodes[i][1]) * sin + (x - nodes[i][0]) * cos } else { 0.0 })
    };
    let rows: Vec<[f64; LINKS]> = near.iter().map(gradient).collect();
    let m = near.len();
    let (mut columns, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
    for (j, right) in rows.iter().enumerate() {
        for (i, left) in rows.iter().enumerate().take(j + 1) {
            indices.push(i);
            let given = if i == j { yielding } else { 0.0 };
            values.push(given + (0..LINKS).map(|k| left[k] * right[k] * softness(k)).sum::<f64>());
        }
        columns.push(indices.len());
    }
    let quadratic = CscMatrix::new(m, m, columns, indices, values);
    let linear: Vec<f64> = near
        .iter()
        .zip(&rows)
        .map(|(near, row)| {
            let unforced: f64 = row.iter().zip(&change).map(|(a, d)| a * d).sum();
            near.gap.max(-push) - unforced
        })
        .collect();
    let pushing = CscMatrix::new(m, m, (0..=m).collect(), (0..m).collect(), vec![-1.0; m]);
    let settings = DefaultSettingsBuilder::default().verbose(false).presolve_enable(false).max_iter(60).build().ok()?;
    let cones = [NonnegativeConeT(m)];
    let mut solver = DefaultSolver::new(&quadratic, &linear, &pushing, &vec![0.0; m], &cones, settings).ok()?;
    solver.solve();
    if !matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return None;
    }
    let forces = solver.solution.x.clone();
    for (row, force) in rows.iter().zip(&forces) {
        for (i, d) in change.iter_mut().enumerate() {
            *d -= softness(i) * row[i] * force;
        }
    }
    Some((change, forces))
}
