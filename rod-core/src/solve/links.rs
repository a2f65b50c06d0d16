//! Linear equations of links in a row: each has three equations and three unknowns, and the cost is proportional to the number of links.
//!
//! The equations of link j contain the links ahead of it through three sums alone, to which each link adds, and of the link before it the
//! unknowns 0 and 2:
//!
//! ```text
//! own_j u_j + ahead_j sum_{k > j} adds_k u_k + before_j u_{j-1} = r_j
//! ```
//!
//! Links are eliminated from the last to the first: given the link before it, a link and all ahead of it are determined, and with them the
//! sums (block elimination of a semiseparable matrix; of a boundary-value problem it is the Riccati transformation). One more equation,
//! the *border*, may contain all unknowns and one more unknown, which appears in the equations of the first link.

use super::linear::invert;
use smallvec::SmallVec;

/// The derivatives of three equations, column by column.
type Columns<const N: usize> = [[f64; 3]; N];

/// The equations of one link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Link {
    /// Derivatives by its own three unknowns.
    pub own: Columns<3>,
    /// Derivatives by the three sums over all links ahead.
    pub ahead: Columns<3>,
    /// Derivatives by unknowns 0 and 2 of the link before. The first link has none.
    pub before: Columns<2>,
    /// Derivatives of what the link adds to the sums, by its unknowns 0 and 1.
    pub adds: Columns<2>,
}

/// A link with all ahead of it eliminated.
#[derive(Clone, Copy, Debug)]
struct Eliminated {
    inverse: Columns<3>,
    /// What unknowns 0 and 2 of the link before subtract from its own unknowns.
    before: Columns<2>,
    /// What its unknowns add to the sums, and to the equation of the border, together with the links ahead that they determine.
    adds: Columns<3>,
    border: [f64; 3],
}

/// The matrix of the equations of links in a row, which solves them.
#[derive(Clone, Debug, Default)]
pub struct Links {
    /// The first `count` of them; the memory of the others is used again.
    memory: Vec<Link>,
    count: usize,
    /// Derivatives of the equations of the first link by the unknown of the border.
    by_border: [f64; 3],
    /// Derivatives of the equation of the border by all unknowns; empty without a border.
    border: Vec<f64>,
    /// From the last link to the second one.
    eliminated: Vec<Eliminated>,
    /// The equations of the first link and the border that are left, 3 x 3 or 4 x 4, and their inverse.
    first: [f64; 16],
    inverse: [f64; 16],
}

/// Largest ratio by which the elimination of the links ahead may increase the derivatives of a link, dimensionless. As many digits of a
/// solution are lost, two here, which further corrections of Newton's method restore, and derivatives of an equilibrium do not. Where the
/// ratio is larger, as beside a segment that is far shorter than the one behind it, the whole matrix is inverted.
const MOST_GROWTH: f64 = 1e2;
/// Right-hand sides at a time for the inverse: the three of a link, and one of the border.
const LANES: usize = 4;

impl Links {
    /// Removes all links and the border.
    pub fn clear(&mut self) {
        self.count = 0;
        self.border.clear();
        self.eliminated.clear();
    }

    /// Adds a link behind the last one. It comes with old content: every entry must be written.
    #[inline(always)]
    pub fn add(&mut self) -> &mut Link {
        if self.count == self.memory.len() {
            self.memory.push(Link::default());
        }
        self.count += 1;
        &mut self.memory[self.count - 1]
    }

    /// The links that were added.
    #[inline(always)]
    pub(crate) fn links(&self) -> &[Link] {
        &self.memory[..self.count]
    }

    /// Adds the border: the derivatives of the equations of the first link by its unknown, and those of its equation by all unknowns, its
    /// own last.
    pub fn set_border(&mut self, by_border: [f64; 3], equation: impl Iterator<Item = f64>) {
        self.by_border = by_border;
        self.border.extend(equation);
    }

    /// Number of unknowns.
    fn size(&self) -> usize {
        3 * self.count + usize::from(!self.border.is_empty())
    }

    /// Gets ready to solve; false without links, and where a pivot vanishes or the elimination loses too many digits.
    #[inline(never)]
    pub(super) fn eliminate(&mut self) -> bool {
        if self.count == 0 {
            return false;
        }
        if self.border.is_empty() {
            self.first[..9].copy_from_slice(self.memory[0].own.as_flattened());
        } else {
            let columns = self.memory[0].own.iter().chain([&self.by_border]);
            let row = self.border[..3].iter().chain(self.border.last());
            for ((to, column), bound) in self.first.as_chunks_mut::<4>().0.iter_mut().zip(columns).zip(row) {
                *to = [column[0], column[1], column[2], *bound];
            }
        }
        if !self.eliminate_ahead() {
            return false;
        }
        if self.border.is_empty() {
            invert(3, &self.first[..9], &mut self.inverse[..9])
        } else {
            invert(4, &self.first, &mut self.inverse)
        }
    }

    /// Eliminates all links but the first one.
    fn eliminate_ahead(&mut self) -> bool {
        let Self { memory, count, border, eliminated, first, .. } = self;
        let rows = 3 + usize::from(!border.is_empty());
        // the sums and the equation of the border, by unknowns 0 and 2 of the link at hand through the links ahead of it
        let (mut sums, mut bound) = ([[0.0; 3]; 2], [0.0; 2]);
        for (j, link) in memory[..*count].iter().enumerate().rev() {
            let through = sums.map(|sums| product(&link.ahead, sums));
            if (0..2).any(|k| largest(&through[k]) > MOST_GROWTH * largest(&link.own[2 * k])) {
                return false;
            }
            if j == 0 {
                for (k, (through, bound)) in through.iter().zip(bound).enumerate() {
                    let column = &mut first[2 * k * rows..][..rows];
                    column.iter_mut().zip(through.iter().chain([&bound])).for_each(|(entry, more)| *entry += more);
                }
                break;
            }
            let mut row = border.get(3 * j..3 * j + 3).map_or([0.0; 3], |row| [row[0], row[1], row[2]]);
            (row[0], row[2]) = (row[0] + bound[0], row[2] + bound[1]);
            let own = [sum(link.own[0], through[0]), link.own[1], sum(link.own[2], through[1])];
            let Some(inverse) = inverse(&own) else { return false };
            let before = link.before.map(|column| product(&inverse, column));
            let adds = [sum(link.adds[0], sums[0]), link.adds[1], sums[1]];
            sums = before.map(|column| product(&adds, column.map(|entry| -entry)));
            bound = before.map(|[a, b, c]| -(row[0] * a + row[1] * b + row[2] * c));
            eliminated.push(Eliminated { inverse, before, adds, border: row });
        }
        true
    }

    /// Writes minus the solution for this right-hand side.
    #[inline(never)]
    pub(super) fn correction(&self, right: &[f64], step: &mut [f64]) {
        step.iter_mut().zip(right).for_each(|(step, right)| *step = -right);
        self.solve(step.as_chunks_mut::<1>().0, self.count);
    }

    /// Solves in place for N right-hand sides at a time. `x` holds them, which are zero in all equations of links from number `zero` on.
    #[inline(always)]
    pub(super) fn solve<const N: usize>(&self, x: &mut [[f64; N]], zero: usize) {
        let [first, links @ ..] = self.links() else { return };
        let (own, rest) = x.split_at_mut(3);
        let (behind, last) = rest.as_chunks_mut::<3>();
        let (mut sums, mut bound) = ([[0.0; N]; 3], [0.0; N]);
        let (count, rights) = (self.eliminated.len(), zero.saturating_sub(1).min(self.eliminated.len()));
        for ((link, x), eliminated) in
            links.iter().zip(&mut *behind).take(rights).rev().zip(&self.eliminated[count - rights..])
        {
            subtract(x, &link.ahead, &sums);
            let right = *x;
            *x = [[0.0; N]; 3];
            add(x, &eliminated.inverse, &right);
            add(&mut sums, &eliminated.adds, x);
            add(std::slice::from_mut(&mut bound), &eliminated.border.map(|entry| [entry]), x);
        }
        subtract(own, &first.ahead, &sums);
        match last {
            [] => {
                let right = [own[0], own[1], own[2]];
                own.fill([0.0; N]);
                add(own, self.inverse.as_chunks::<3>().0, &right);
            }
            [last, ..] => {
                (0..N).for_each(|n| last[n] -= bound[n]);
                let right = [own[0], own[1], own[2], *last];
                let mut solved = [[0.0; N]; 4];
                add(&mut solved, self.inverse.as_chunks::<4>().0, &right);
                own.copy_from_slice(&solved[..3]);
                *last = solved[3];
            }
        }
        self.go_forward([own[0], own[2]], behind);
    }

    /// Takes from the unknowns of all links but the first, which are those of the link before at 0, what the link before subtracts.
    #[inline(always)]
    fn go_forward<const N: usize>(&self, mut before: [[f64; N]; 2], behind: &mut [[[f64; N]; 3]]) {
        for (x, eliminated) in behind.iter_mut().zip(self.eliminated.iter().rev()) {
            subtract(x, &eliminated.before, &before);
            before = [x[0], x[2]];
        }
    }

    /// Writes the last column of the inverse.
    pub(super) fn last_column(&self, column: &mut [f64]) {
        column.fill(0.0);
        if let [a, b, c, behind @ .., last] = column
            && !self.border.is_empty()
        {
            [*a, *b, *c, *last] = [12, 13, 14, 15].map(|k| self.inverse[k]);
            self.go_forward([[*a], [*c]], behind.as_chunks_mut::<1>().0.as_chunks_mut::<3>().0);
        } else if let Some(last) = column.last_mut() {
            *last = 1.0;
            self.solve(column.as_chunks_mut::<1>().0, self.count);
        }
    }

    /// Condition number in the 1-norm, with each unknown in units of 1 / `weight`.
    #[inline(never)]
    pub(super) fn condition(&self, weight: impl Fn(usize) -> f64) -> f64 {
        let (size, count) = (self.size(), self.count);
        let (mut most, mut most_of_inverse) = (0.0_f64, 0.0_f64);
        if let Some(last) = self.border.last() {
            most = (sizes(&self.by_border) + last.abs()) / weight(size - 1);
        }
        let mut x = SmallVec::<[[f64; LANES]; 32]>::from_elem([0.0; LANES], size);
        for k in 0..count {
            for unknown in 0..3 {
                let column = 3 * k + unknown;
                let border = self.border.get(column).map_or(0.0, |entry| entry.abs());
                most = most.max((self.column(k, unknown) + border) / weight(column));
            }
            x.fill([0.0; LANES]);
            (0..3).for_each(|i| x[3 * k + i][i] = 1.0);
            if k == 0 && !self.border.is_empty() {
                x[size - 1][3] = 1.0;
            }
            self.solve(&mut x, k + 1);
            let mut sums = [0.0; LANES];
            for (row, x) in x.iter().enumerate() {
                let weight = weight(row);
                sums.iter_mut().zip(x).for_each(|(sum, x)| *sum += (x * weight).abs());
            }
            most_of_inverse = sums.into_iter().fold(most_of_inverse, f64::max);
        }
        most * most_of_inverse
    }

    /// Sum of the derivatives of the equations of all links by an unknown of link `k`.
    fn column(&self, k: usize, unknown: usize) -> f64 {
        let link = &self.links()[k];
        let mut all = sizes(&link.own[unknown]);
        if unknown != 1
            && let Some(next) = self.links().get(k + 1)
        {
            all += sizes(&next.before[unknown / 2]);
        }
        if let Some(adds) = link.adds.get(unknown) {
            all += self.memory[..k].iter().map(|behind| sizes(&product(&behind.ahead, *adds))).sum::<f64>();
        }
        all
    }

    /// Writes the matrix of links without a border into the leading block of a column-major matrix with `stride` rows.
    pub(crate) fn write(links: &[Link], matrix: &mut [f64], stride: usize) {
        for (j, link) in links.iter().enumerate() {
            let mut put = |column: usize, rows: [f64; 3]| matrix[column * stride + 3 * j..][..3].copy_from_slice(&rows);
            (0..3 * j).for_each(|column| put(column, [0.0; 3]));
            if j > 0 {
                put(3 * j - 3, link.before[0]);
                put(3 * j - 1, link.before[1]);
            }
            (0..3).for_each(|unknown| put(3 * j + unknown, link.own[unknown]));
            for (k, other) in links.iter().enumerate().skip(j + 1) {
                put(3 * k, product(&link.ahead, other.adds[0]));
                put(3 * k + 1, product(&link.ahead, other.adds[1]));
                put(3 * k + 2, [0.0; 3]);
            }
        }
    }
}

/// Adds the product of a matrix, given by its columns, and rows of N numbers.
#[inline(always)]
fn add<const M: usize, const N: usize>(to: &mut [[f64; N]], columns: &[[f64; M]], by: &[[f64; N]]) {
    for (column, by) in columns.iter().zip(by) {
        for (to, entry) in to.iter_mut().zip(column) {
            to.iter_mut().zip(by).for_each(|(to, by)| *to += entry * by);
        }
    }
}

/// Subtracts it.
#[inline(always)]
fn subtract<const M: usize, const N: usize>(from: &mut [[f64; N]], columns: &[[f64; M]], by: &[[f64; N]]) {
    for (column, by) in columns.iter().zip(by) {
        for (from, entry) in from.iter_mut().zip(column) {
            from.iter_mut().zip(by).for_each(|(from, by)| *from -= entry * by);
        }
    }
}

/// The inverse by its cofactors; none where the determinant vanishes.
#[inline(always)]
fn inverse([a, b, c]: &Columns<3>) -> Option<Columns<3>> {
    let cross =
        |a: &[f64; 3], b: &[f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let rows = [cross(b, c), cross(c, a), cross(a, b)];
    let scale = 1.0 / (a[0] * rows[0][0] + a[1] * rows[0][1] + a[2] * rows[0][2]);
    scale.is_finite().then(|| [0, 1, 2].map(|k| rows.map(|row| scale * row[k])))
}

#[inline(always)]
fn product<const M: usize>(columns: &Columns<M>, by: [f64; M]) -> [f64; 3] {
    let mut all = [0.0; 3];
    for (column, by) in columns.iter().zip(by) {
        all.iter_mut().zip(column).for_each(|(all, entry)| *all += entry * by);
    }
    all
}

#[inline(always)]
fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn largest(a: &[f64; 3]) -> f64 {
    a.iter().fold(0.0, |most, entry| most.max(entry.abs()))
}

#[inline(always)]
fn sizes(a: &[f64; 3]) -> f64 {
    a[0].abs() + a[1].abs() + a[2].abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::linear::{multiply, norm_1, weighted_condition};
    use proptest::prelude::*;

    const MOST: usize = 9;

    fn links(entries: &[f64], count: usize, is_bordered: bool) -> (Links, Vec<f64>, usize) {
        let mut links = Links::default();
        let mut columns = entries.as_chunks::<3>().0.iter().copied();
        let mut next = || columns.next().unwrap();
        for _ in 0..count {
            *links.add() = Link {
                own: [next(), next(), next()],
                ahead: [next(), next(), next()],
                before: [next(), next()],
                adds: [next(), next()],
            };
        }
        if is_bordered {
            let by_border = next();
            links.set_border(by_border, entries[..=3 * count].iter().rev().copied());
        }
        let size = links.size();
        let mut matrix = vec![f64::NAN; size * size];
        Links::write(links.links(), &mut matrix, size);
        if is_bordered {
            (0..size).for_each(|column| matrix[column * size + size - 1] = links.border[column]);
            matrix[(size - 1) * size..][..size - 1].fill(0.0);
            matrix[(size - 1) * size..][..3].copy_from_slice(&links.by_border);
        }
        (links, matrix, size)
    }

    proptest! {
        #[test]
        fn links_solve_what_the_whole_matrix_does(
            entries in prop::collection::vec(-1.0..1.0_f64, 30 * MOST + 3),
            right in prop::collection::vec(-1.0..1.0_f64, 3 * MOST + 1),
            count in 1..=MOST,
            is_bordered: bool,
        ) {
            let (mut links, matrix, size) = links(&entries, count, is_bordered);
            let mut inverse = vec![0.0; size * size];
            prop_assume!(links.eliminate() && invert(size, &matrix, &mut inverse));
            let weights: Vec<f64> = (0..size).map(|i| 1.0 + i as f64).collect();
            let expected = weighted_condition(&matrix, &inverse, &weights);
            // digits that the condition leaves, and the growth of the elimination
            let error = 1e-11 * norm_1(size, &matrix) * norm_1(size, &inverse);
            prop_assume!(error < 1e-4);
            let (mut x, mut solution) = (vec![0.0; size], vec![0.0; size]);
            links.correction(&right[..size], &mut x);
            multiply(&inverse, &right[..size], -1.0, &mut solution);
            let scale = 1.0 + solution.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            for (x, solution) in x.iter().zip(&solution) {
                prop_assert!((x - solution).abs() <= error * scale, "{x} {solution}, {error:e}");
            }
            let found = links.condition(|i| weights[i]);
            prop_assert!((found / expected - 1.0).abs() <= error, "{found} {expected}, {error:e}");
        }
    }

    /// The second link alone is singular, but not the whole matrix.
    #[test]
    fn an_elimination_that_loses_digits_is_refused() {
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for own in [0.0, 1e-8, 1e-3, 0.1] {
            let mut links = Links::default();
            let ahead = Link { own: unit, ahead: unit, before: [unit[0], unit[2]], adds: [unit[0], unit[1]] };
            *links.add() = ahead;
            *links.add() = Link { own: [[own, 0.0, 0.0], unit[1], unit[2]], ..ahead };
            assert_eq!(links.eliminate(), own == 0.1, "{own}");
        }
    }
}
