//! The rod near a seen curve: displaced by the pose of its base and by forces, each by so much per unit.
//!
//! The angle at s is that of the base, plus the integral of kappa0 + m / EI, with the moment m of the forces about the seen curve. Errors are of the
//! second order in the displacement.

use super::observation::{Axis, Measurand};
use super::seen::{Seen, hermite};
use rod_core::{Cut, RodModel};

/// Cells of the grid along the rod, and cells from one place to the next. Cells in pairs of equal ones, for Simpson's rule.
pub(super) const CELLS: usize = 64;
pub(super) const STRIDE: usize = 2;
/// Number of places on the side: all but the ends.
pub(super) const PLACES: usize = CELLS / STRIDE - 1;
/// Columns: pose of the base, force at each place, both components of that at the tip, and what is not unknown.
pub(super) const TIP: usize = 3 + PLACES;
pub(super) const KNOWN: usize = TIP + 2;
pub(super) const COLUMNS: usize = KNOWN + 1;
pub(super) type Row = [f64; COLUMNS];

/// The linear model.
pub(super) struct LinearRod {
    /// Arc lengths of the nodes, L: closer to each other where the rod is soft.
    pub arcs: Vec<f64>,
    /// The seen curve.
    nodes: Vec<Cut>,
    /// Sine and cosine of its angles.
    directions: Vec<(f64, f64)>,
    /// What a unit of each column does.
    columns: Vec<Response>,
}

/// What a force, or the pose, does to the rod along the grid.
struct Response {
    moment: Vec<f64>,
    turn: Vec<f64>,
    way: Vec<[f64; 2]>,
}

impl LinearRod {
    pub fn new<M: RodModel>(model: &M, seen: &Seen) -> Self {
        let arcs = grid(model);
        let nodes: Vec<Cut> = arcs.iter().map(|s| seen.at(model, *s)).collect();
        let directions: Vec<(f64, f64)> = nodes.iter().map(|node| node.phi.sin_cos()).collect();
        Self { columns: columns(model, &arcs, &nodes, &directions), arcs, nodes, directions }
    }

    /// The displacement at an arc length by a unit of each column.
    pub fn ways(&self, s: f64) -> [[f64; 2]; COLUMNS] {
        std::array::from_fn(|column| self.way(&self.columns[column], s))
    }

    fn way(&self, response: &Response, s: f64) -> [f64; 2] {
        let (k, t, h) = self.cell(s);
        let slope = |k: usize| {
            let (sin, cos) = self.directions[k];
            [-h * sin * response.turn[k], h * cos * response.turn[k]]
        };
        let (first, last) = (slope(k), slope(k + 1));
        [0, 1].map(|c| hermite(t, [response.way[k][c], response.way[k + 1][c]], [first[c], last[c]]))
    }

    /// The cell of the grid at an arc length, where in it, and its length.
    fn cell(&self, s: f64) -> (usize, f64, f64) {
        let inside = s.clamp(0.0, 1.0);
        let k = self.arcs.partition_point(|arc| *arc <= inside).clamp(1, CELLS) - 1;
        let h = self.arcs[k + 1] - self.arcs[k];
        (k, (inside - self.arcs[k]) / h, h)
    }

    /// A number along the grid at an arc length.
    fn between(&self, values: &[f64], s: f64) -> f64 {
        let (k, t, _) = self.cell(s);
        (1.0 - t) * values[k] + t * values[k + 1]
    }

    /// What a channel reads, by column.
    pub fn channel<M: RodModel>(&self, model: &M, quantity: Measurand, compliance: &[[f64; 3]; 3]) -> Row {
        let base = self.nodes[0];
        let reactions = |k: usize, weights: [f64; 3]| {
            let [a, b] = self.force(k);
            weights[0] * -b + weights[1] * a - weights[2] * self.columns[k].moment[0]
        };
        let pose = |k: usize, axis: Axis| match axis {
            Axis::Angle => self.columns[k].turn[0] + if k == KNOWN { base.phi } else { 0.0 },
            Axis::X => self.columns[k].way[0][0] + if k == KNOWN { base.x } else { 0.0 },
            Axis::Y => self.columns[k].way[0][1] + if k == KNOWN { base.y } else { 0.0 },
        };
        std::array::from_fn(|k| match quantity {
            Measurand::Reaction(weights) => reactions(k, weights),
            Measurand::Base(axis) => pose(k, axis),
            Measurand::Support(axis) => pose(k, axis) + reactions(k, compliance[axis.index()]),
            Measurand::Curvature(s) => {
                let rest = if k == KNOWN { model.natural_curvature(s) } else { 0.0 };
                curvature_per_moment(model, s) * self.between(&self.columns[k].moment, s) + rest
            }
            Measurand::Marker(s, axis) => {
                let index = axis.index();
                let own = if k == KNOWN { self.at(s, &[]) } else { [0.0; 3] };
                let moved = match index {
                    2 => self.between(&self.columns[k].turn, s),
                    _ => self.way(&self.columns[k], s)[index],
                };
                own[index] + moved
            }
        })
    }

    /// The force (A, B) of a unit of a column.
    fn force(&self, column: usize) -> [f64; 2] {
        match column {
            TIP => [1.0, 0.0],
            _ if column == TIP + 1 => [0.0, 1.0],
            3..TIP => {
                let (sin, cos) = self.directions[node_of(column)];
                [cos, sin]
            }
            _ => [0.0, 0.0],
        }
    }

    /// Position and angle at an arc length: the seen curve with so much of some columns.
    pub fn at(&self, s: f64, parts: &[(usize, f64)]) -> [f64; 3] {
        let (k, t, h) = self.cell(s);
        let [from, to] = [k, k + 1].map(|k| (self.nodes[k], self.directions[k]));
        let x = hermite(t, [from.0.x, to.0.x], [h * from.1.1, h * to.1.1]);
        let y = hermite(t, [from.0.y, to.0.y], [h * from.1.0, h * to.1.0]);
        let mut at = [x, y, (1.0 - t) * from.0.phi + t * to.0.phi];
        for (column, size) in parts {
            let response = &self.columns[*column];
            let [x, y] = self.way(response, s);
            at = [at[0] + size * x, at[1] + size * y, at[2] + size * self.between(&response.turn, s)];
        }
        at
    }
}

/// The node of a place.
pub(super) fn node_of(column: usize) -> usize {
    STRIDE * (column - 2)
}

/// What pose, forces and the curvature at rest do to the rod.
fn columns<M: RodModel>(model: &M, arcs: &[f64], nodes: &[Cut], directions: &[(f64, f64)]) -> Vec<Response> {
    let integral = |values: &[f64]| integral(arcs, values);
    let rest: Vec<f64> = arcs.iter().map(|s| model.natural_curvature(*s)).collect();
    let compliance: Vec<f64> = arcs.iter().map(|s| curvature_per_moment(model, *s)).collect();
    let displaced = |moment: Vec<f64>, turn: Vec<f64>, start: [f64; 2]| {
        let part = |c: usize| -> Vec<f64> {
            let along = turn.iter().zip(directions).map(|(turn, (sin, cos))| turn * [-sin, *cos][c]);
            integral(&along.collect::<Vec<_>>()).into_iter().map(|way| start[c] + way).collect()
        };
        let way = part(0).into_iter().zip(part(1)).map(|(x, y)| [x, y]).collect();
        Response { moment, turn, way }
    };
    let zeros = || vec![0.0; CELLS + 1];
    let mut columns = vec![
        displaced(zeros(), zeros(), [1.0, 0.0]),
        displaced(zeros(), zeros(), [0.0, 1.0]),
        displaced(zeros(), vec![1.0; CELLS + 1], [0.0, 0.0]),
    ];
    let bent = |end: usize, [a, b]: [f64; 2]| {
        let tip = nodes[end];
        let lever = |node: &Cut| -(a * (tip.x - node.x) + b * (tip.y - node.y));
        let moment: Vec<f64> =
            nodes.iter().enumerate().map(|(k, node)| if k < end { lever(node) } else { 0.0 }).collect();
        let turn = integral(&moment.iter().zip(&compliance).map(|(m, c)| m * c).collect::<Vec<_>>());
        displaced(moment, turn, [0.0; 2])
    };
    for column in 3..TIP {
        let (sin, cos) = directions[node_of(column)];
        columns.push(bent(node_of(column), [cos, sin]));
    }
    columns.push(bent(CELLS, [1.0, 0.0]));
    columns.push(bent(CELLS, [0.0, 1.0]));
    // the rod at rest, less what is seen
    let turned = integral(&rest);
    let known = nodes.iter().zip(&turned).map(|(node, turn)| nodes[0].phi + turn - node.phi).collect();
    columns.push(displaced(zeros(), known, [0.0; 2]));
    columns
}

/// The curvature per moment.
pub(super) fn curvature_per_moment<M: RodModel>(model: &M, s: f64) -> f64 {
    model.curvature_at(s, 1.0) - model.natural_curvature(s)
}

/// Pairs of equal cells, over each of which the fourth root of the compliance, the inverse of the diameter, has the same integral: a cone is divided
/// in parts of one proportion.
fn grid<M: RodModel>(model: &M) -> Vec<f64> {
    let pairs = CELLS / 2;
    // the integral from the base on, by the midpoints of four parts for each pair
    let fine = 4 * pairs;
    let mut sums = vec![0.0];
    for k in 0..fine {
        sums.push(sums[k] + curvature_per_moment(model, (k as f64 + 0.5) / fine as f64).sqrt().sqrt());
    }
    let ends = (0..=pairs).map(|pair| {
        let sought = sums[fine] * pair as f64 / pairs as f64;
        let k = sums.partition_point(|sum| *sum <= sought).clamp(1, fine) - 1;
        (k as f64 + (sought - sums[k]) / (sums[k + 1] - sums[k])) / fine as f64
    });
    let ends: Vec<f64> = ends.collect();
    let mut arcs = vec![0.0];
    arcs.extend(ends.windows(2).flat_map(|ends| [0.5 * (ends[0] + ends[1]), ends[1]]));
    arcs[CELLS] = 1.0;
    arcs
}

/// The integral from the first node to each, by Simpson's rule over pairs of cells.
fn integral(arcs: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; values.len()];
    for k in (0..CELLS).step_by(2) {
        let h = arcs[k + 1] - arcs[k];
        let [a, b, c] = [values[k], values[k + 1], values[k + 2]];
        sums[k + 1] = sums[k] + h / 12.0 * (5.0 * a + 8.0 * b - c);
        sums[k + 2] = sums[k] + h / 3.0 * (a + 4.0 * b + c);
    }
    sums
}
