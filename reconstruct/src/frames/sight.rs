//! The forces at first sight. Where the shape is seen, so are the levers: the bending moment is linear in the forces, and each set of places has
//! its best forces by linear least squares.

use super::linear_rod::{CELLS, COLUMNS, KNOWN, LinearRod, PLACES, Row, STRIDE, TIP, node_of};
use super::observed::Observed;
use super::problem::Start;
use super::seen::Seen;
use super::shape::{Place, unknowns};
use nalgebra::{DMatrix, DVector};
use rod_core::{Cut, RodModel};

/// Share of a diagonal entry below which what the elimination left of it is rounding.
const ROUNDING: f64 = 1e-11;

/// Accuracy of the dots (L) that first sight makes use of at most: that of itself.
const ACCURACY: f64 = 1e-4;
/// How many times chi squared of the best shape another one may have at first sight.
const HOPELESS: f64 = 5.0;
/// Forces (E I / s^2 at the arc length s) beyond which the displacement changes their moment: the prior of each is normal with this standard deviation, so that
/// those that the shape does not tell, along a straight rod, stay small.
const LARGE: f64 = 100.0;

/// The linear least squares of a frame.
pub(super) struct Sight {
    rod: LinearRod,
    /// The foot points of the dots.
    feet: Vec<f64>,
    /// The normal equations, with the pose eliminated.
    matrix: DMatrix<f64>,
    /// The number of residuals.
    count: f64,
    /// The first place that is seen.
    first: usize,
}

/// Places with their forces that are best together.
struct Guess {
    chi_squared: f64,
    /// Column and force, from the outermost contact inwards.
    forces: Vec<(usize, f64)>,
}

impl Sight {
    /// The least squares of a frame whose dots show the shape.
    pub fn of<M: RodModel>(model: &M, observed: &Observed) -> Self {
        let seen = Seen::new(observed);
        let rod = LinearRod::new(model, &seen);
        let mut sight = Self {
            first: (1..=PLACES).find(|p| rod.arcs[p * STRIDE] > seen.feet[0]).unwrap_or(PLACES),
            rod,
            matrix: DMatrix::zeros(COLUMNS, COLUMNS),
            count: 0.0,
            feet: seen.feet.iter().map(|foot| foot.clamp(0.0, 1.0)).collect(),
        };
        let mut rows: Vec<Row> = Vec::new();
        for (dot, foot) in observed.dots.iter().zip(&seen.feet) {
            let s = dot.s.unwrap_or(*foot);
            let at = seen.at(model, s);
            let (sin, cos) = at.phi.sin_cos();
            let (left, ways) = ([at.x - dot.at[0], at.y - dot.at[1]], sight.rod.ways(s));
            let sigma = dot.sigma.max(ACCURACY);
            let mut add = |along: [f64; 2]| {
                let part = |way: [f64; 2]| (along[0] * way[0] + along[1] * way[1]) / sigma;
                let mut row = ways.map(part);
                row[KNOWN] += part(left);
                rows.push(row);
            };
            if dot.s.is_some() {
                add([1.0, 0.0]);
                add([0.0, 1.0]);
            } else {
                add([-sin, cos]);
            }
        }
        for channel in &observed.channels {
            let mut row = sight.rod.channel(model, channel.quantity, &observed.compliance);
            row[KNOWN] -= channel.value;
            rows.push(row.map(|entry| entry / channel.sigma));
        }
        let rows = DMatrix::from_fn(rows.len(), COLUMNS, |i, j| rows[i][j]);
        sight.count = rows.nrows() as f64;
        sight.matrix = rows.tr_mul(&rows);
        for force in 3..KNOWN {
            let s = if force < TIP { sight.rod.arcs[node_of(force)] } else { 1.0 };
            sight.matrix[(force, force)] += (s * s / LARGE).powi(2);
        }
        sight.eliminate_pose();
        sight
    }

    fn eliminate_pose(&mut self) {
        for pivot in 0..3 {
            let diagonal = self.matrix[(pivot, pivot)];
            if diagonal.is_nan() || diagonal <= 0.0 {
                continue;
            }
            for i in pivot + 1..COLUMNS {
                let factor = self.matrix[(i, pivot)] / diagonal;
                for j in i..COLUMNS {
                    let entry = self.matrix[(j, i)] - factor * self.matrix[(j, pivot)];
                    self.matrix[(j, i)] = entry;
                    self.matrix[(i, j)] = entry;
                }
            }
        }
    }

    /// The best forces in these columns, and the chi squared that they leave. None where they are not determined.
    fn best(&self, columns: &[usize]) -> Option<Guess> {
        let count = columns.len();
        let index = |k: usize| if k < count { columns[k] } else { KNOWN };
        let mut small: [[f64; 4]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|j| self.matrix[(index(i), index(j))]));
        for pivot in 0..count {
            let diagonal = small[pivot][pivot];
            let is_told = diagonal > ROUNDING * self.matrix[(columns[pivot], columns[pivot])];
            if !is_told {
                return None;
            }
            for i in pivot + 1..=count {
                let factor = small[i][pivot] / diagonal;
                (pivot..=count).for_each(|j| small[i][j] -= factor * small[pivot][j]);
            }
        }
        let mut forces = [0.0; 3];
        for i in (0..count).rev() {
            let known: f64 = (i + 1..count).map(|j| small[i][j] * forces[j]).sum();
            forces[i] = (-small[i][count] - known) / small[i][i];
        }
        Some(Guess { chi_squared: small[count][count].max(0.0), forces: columns.iter().copied().zip(forces).collect() })
    }

    /// The pose that goes with forces.
    fn pose(&self, forces: &[(usize, f64)]) -> [f64; 3] {
        let mut pose = [0.0; 3];
        for i in (0..3).rev() {
            let known: f64 = (i + 1..3).map(|j| self.matrix[(j, i)] * pose[j]).sum();
            let pulled: f64 = forces.iter().map(|(column, size)| self.matrix[(*column, i)] * size).sum();
            let diagonal = self.matrix[(i, i)];
            pose[i] = if diagonal > 0.0 { -(self.matrix[(KNOWN, i)] + pulled + known) / diagonal } else { 0.0 };
        }
        pose
    }

    /// The start of the least squares with these contacts and forces, the outermost first; a contact at the arc length `s`, if that is given.
    fn start(&self, contacts: Vec<Place>, guess: &Guess) -> Start {
        let Guess { forces, chi_squared } = guess;
        let pose = self.pose(forces);
        let parts: Vec<(usize, f64)> =
            pose.into_iter().enumerate().chain(forces.iter().copied()).chain([(KNOWN, 1.0)]).collect();
        let arc = |place: &Place, column: usize| match place {
            Place::Tip => 1.0,
            Place::Side { s, .. } => s.unwrap_or(self.rod.arcs[node_of(column)]),
        };
        let mut left = forces.iter();
        let mut u: Vec<f64> = Vec::with_capacity(unknowns(&contacts));
        for place in &contacts {
            let Some(&(column, size)) = left.next() else { break };
            let s = arc(place, column);
            if u.is_empty() {
                u.extend(self.rod.at(s, &parts));
            }
            match place {
                Place::Tip => u.extend([size, left.next().map_or(0.0, |(_, size)| *size)]),
                Place::Side { s: given, rub } => {
                    if given.is_none() {
                        u.push(s);
                    }
                    u.push(size);
                    if rub.is_none() {
                        u.push(0.0);
                    }
                }
            }
        }
        Start { contacts, u: DVector::from_vec(u), feet: self.feet.clone(), chi_squared: *chi_squared }
    }

    /// Whether so much left at first sight is too much for the shape that explains as much as one that leaves `least`.
    pub fn is_hopeless(&self, chi_squared: f64, least: f64) -> bool {
        chi_squared > HOPELESS * (least + self.count)
    }

    /// The rod at rest, in place and direction as its middle.
    pub fn free<M: RodModel>(&self, model: &M) -> Start {
        let [x, y, phi] = self.rod.at(0.5, &[]);
        let base = model.carry(0.5, &Cut { x, y, phi, moment: 0.0 }, 0.0, 0.0, -0.5);
        let u = DVector::from_column_slice(&[base.x, base.y, base.phi]);
        let chi_squared = self.matrix[(KNOWN, KNOWN)].max(0.0);
        Start { contacts: Vec::new(), u, feet: self.feet.clone(), chi_squared }
    }

    /// Starts with one contact, the best first: where the cost along the rod is least.
    pub fn one(&self, place: Place) -> Vec<Start> {
        let columns: &[usize] = match place {
            Place::Tip => {
                return self.best(&[TIP, TIP + 1]).map(|tip| self.start(vec![place], &tip)).into_iter().collect();
            }
            Place::Side { s: Some(s), .. } => {
                let near = self.rod.arcs.partition_point(|arc| *arc < s).div_ceil(STRIDE);
                &[2 + near.clamp(1, PLACES)]
            }
            Place::Side { s: None, .. } => &std::array::from_fn::<usize, PLACES, _>(|k| 3 + k)[self.first - 1..],
        };
        let costs: Vec<Option<Guess>> = columns.iter().map(|column| self.best(&[*column])).collect();
        let cost =
            |k: Option<usize>| k.and_then(|k| costs.get(k)?.as_ref()).map_or(f64::INFINITY, |guess| guess.chi_squared);
        let is_least = |k: usize| cost(Some(k)) <= cost(k.checked_sub(1)) && cost(Some(k)) <= cost(Some(k + 1));
        let mut least: Vec<&Guess> =
            costs.iter().enumerate().filter(|(k, _)| is_least(*k)).filter_map(|(_, guess)| guess.as_ref()).collect();
        least.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
        let starts = least.into_iter().map(|guess| self.start(vec![place], guess));
        starts.chain(self.beside_the_tip(place)).collect()
    }

    /// A contact on the side next to the tip, from that at the tip: between them there is no place.
    fn beside_the_tip(&self, place: Place) -> Option<Start> {
        let Place::Side { s: None, rub } = place else { return None };
        let at_tip = self.start(vec![Place::Tip], &self.best(&[TIP, TIP + 1])?);
        let [x, y, phi, a, b] = at_tip.u.as_slice()[..] else { return None };
        let (s, (sin, cos)) = (0.5 * (1.0 + self.rod.arcs[CELLS - 1]), phi.sin_cos());
        let back = 1.0 - s;
        let u =
            [x - back * cos, y - back * sin, phi, s, a * cos + b * sin].into_iter().chain(rub.is_none().then_some(0.0));
        Some(Start { contacts: vec![place], u: DVector::from_iterator(unknowns(&[place]), u), ..at_tip })
    }

    /// Starts with two contacts, the best first: where the cost over all pairs of places is least.
    pub fn two(&self, side: Place) -> Vec<Start> {
        // the outer one may be at the tip: that is the place behind the last
        let count = PLACES + 1;
        let mut guesses: Vec<Option<Guess>> = Vec::with_capacity(count * count);
        for outer in 0..count {
            for inner in 0..count {
                let is_pair = inner < outer && inner + 1 >= self.first;
                let guess = is_pair.then(|| {
                    let (inner, outer) = (3 + inner, 3 + outer);
                    if outer == TIP { self.best(&[TIP, TIP + 1, inner]) } else { self.best(&[outer, inner]) }
                });
                guesses.push(guess.flatten());
            }
        }
        let cost = |outer: isize, inner: isize| {
            let is_there = (0..count as isize).contains(&outer) && (0..count as isize).contains(&inner);
            let guess = is_there.then(|| guesses[outer as usize * count + inner as usize].as_ref()).flatten();
            guess.map_or(f64::INFINITY, |guess| guess.chi_squared)
        };
        let mut starts = Vec::new();
        for outer in 0..count {
            for inner in 0..outer {
                let Some(guess) = &guesses[outer * count + inner] else { continue };
                let is_at_tip = outer + 1 == count;
                // a force at the tip has one unknown more: its cost is not that of its neighbours
                let around = |i: isize, j: isize| {
                    let outer = outer as isize + i;
                    if i != 0 && (is_at_tip || outer + 1 == count as isize) {
                        f64::INFINITY
                    } else {
                        cost(outer, inner as isize + j)
                    }
                };
                if (-1..=1).all(|i| (-1..=1).all(|j| guess.chi_squared <= around(i, j))) {
                    let contacts = vec![if is_at_tip { Place::Tip } else { side }, side];
                    let chi_squared = least_between(around).clamp(0.0, guess.chi_squared);
                    starts.push(Start { chi_squared, ..self.start(contacts, guess) });
                }
            }
        }
        starts.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
        starts
    }
}

/// The least value between the nodes of a grid around one with the least, by the quadratic polynomial through its neighbours; the
/// value there where some have none.
fn least_between(at: impl Fn(isize, isize) -> f64) -> f64 {
    let here = at(0, 0);
    let slopes = [(at(1, 0) - at(-1, 0)) / 2.0, (at(0, 1) - at(0, -1)) / 2.0];
    let bends = [at(1, 0) - 2.0 * here + at(-1, 0), at(0, 1) - 2.0 * here + at(0, -1)];
    let mixed = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / 4.0;
    let along_one = here - 0.5 * slopes[1] * slopes[1] / bends[1];
    let determinant = bends[0] * bends[1] - mixed * mixed;
    if determinant > 0.0 && determinant.is_finite() {
        let [x, y] = slopes;
        return here - 0.5 * (x * x * bends[1] - 2.0 * x * y * mixed + y * y * bends[0]) / determinant;
    }
    if along_one.is_finite() { along_one } else { here }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::observed::Dot;
    use crate::frames::shape::trace;
    use rod_core::{Cone, Smooth};

    /// Points of a cone under two forces show both at once: places to half of the way between two of the grid, forces to a fifth.
    #[test]
    fn two_forces_are_seen_at_first_sight() {
        let cone = Smooth::new(Cone { taper: 0.7 }).unwrap();
        let side = Place::Side { s: None, rub: Some(0.0) };
        let truth = [0.5, 0.1, 0.6, 0.81, 0.25, 0.31, -4.0];
        let stations: Vec<f64> = (0..40).map(|k| f64::from(k) / 39.0).collect();
        let mut dots = vec![Dot { at: [0.0; 2], sigma: 1e-6, s: None }; 40];
        trace(&cone, &[side, side], &truth, &stations, |k, node| dots[k].at = [node.cut.x, node.cut.y]).unwrap();
        dots[0].s = Some(0.0);
        let observed =
            Observed { dots, channels: Vec::new(), compliance: [[0.0; 3]; 3], ends: [true, true], pole: None };
        let start = &Sight::of(&cone, &observed).two(side)[0];
        let close = [0.01, 0.01, 2e-3, 0.02, 0.04, 0.025, 0.8];
        for ((found, truth), close) in start.u.iter().zip(truth).zip(close) {
            assert!((found - truth).abs() < close, "{:?}", start.u.as_slice());
        }
    }
}
