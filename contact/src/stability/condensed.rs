//! The second variation condensed to the contacts: its sign without an integral.
//!
//! Between two contacts the variation that costs least is a change of the elastica itself, (EI eta')' = -q eta + dA cos phi + dB sin phi
//! with q = A sin phi - B cos phi, and by parts
//!
//! ```text
//! int EI eta'^2 - q eta^2 ds = eta_1 dm_1 - eta_0 dm_0 - dA Dy + dB Dx
//! ```
//!
//! with (Dx, Dy) the way of one end relative to the other: a quadratic form of the ends alone, by the derivatives of the segment.
//! It is the least value as long as the form is positive for variations that vanish at both ends, which it is where P l^2 < pi^2 EI:
//! q is at most P, and the least eigenvalue of -(EI eta')' at least EI (pi / l)^2 with the least EI; or, where EI varies, by comparison with
//! the least EI of each part. Behind the
//! last contact the least value is zero. So Q > 0 for all variations if, and only if, the sum of these forms and of the contacts' own ones is positive definite in the shifts u_j along
//! the contour and the turns eta_j: two unknowns a contact. A clamp on springs adds the ways p of its base, with their own p^2 / softness.
//! A roller counts as the first contact. A contact with friction is held along the contour: there u_j = 0.

use super::{Form, PENALTY, roller};
use crate::contact_set::Configuration;
use crate::gap::shape::Shape;
use crate::scene::Setup;
use crate::scene::rod::holds_between_ends;
use crate::scene::springs::{Spring, springs};
use rod_core::{Clamp, CutSensitivities, Grip, PhysicalRod, RodModel, Supports};
use smallvec::SmallVec;

/// Least pivot, over the diagonal entry that it came from, that proves a sign. The entries are exact to about 1e-13 of the largest
/// one, which on a nearly straight segment is larger than the pivots by as much as [`STIFFEST`]. Closer to a fold the modes decide.
const LEAST_PIVOT: f64 = 1e-8;

/// Largest change of force or moment by a change of an end, of which the digits are right. A straight segment cannot become shorter.
const STIFFEST: f64 = 1e8;

/// Most unknowns that move the ends of a segment: three springs or the two of a contact at its start, and two at its end.
const MOST_MOVES: usize = 5;

/// Turn at the start, turn at the end, way of the end relative to the start.
type Ends = [f64; 4];

/// Whether the second variation is proven to be positive. Where it is not, near a fold or on a segment long enough to buckle
/// between its ends, nothing is said.
pub(super) fn is_positive<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration, shape: &Shape) -> bool {
    let rod = setup.rod.model();
    let (n, lead) = (configuration.count() + shape.lead(), shape.lead());
    let supports = configuration.supports(&setup.world);
    let springs = springs(setup.clamp(configuration.tau()).law());
    let base = springs.len();
    let size = base + 2 * n;
    let mut matrix: SmallVec<[f64; 64]> = SmallVec::from_elem(0.0, size * size);
    for (k, spring) in springs.iter().enumerate() {
        matrix[k * size + k] = 1.0 / spring.softness;
    }
    // what moves the ends of the segment: first the base by its springs, then the contact before by its shift and its turn
    let mut moves: [Ends; MOST_MOVES] = [[0.0; 4]; MOST_MOVES];
    let mut known = base;
    for (own, Spring { way: [x, y, phi], .. }) in moves.iter_mut().zip(&springs) {
        *own = [*phi, 0.0, -x, -y];
    }
    for j in 0..n {
        let (support, form) = match j.checked_sub(lead) {
            None => (roller::support(shape), roller::form(rod, shape)),
            Some(j) => {
                let support = supports.support(j, configuration.t(j));
                (support, super::form(rod, configuration, shape, (j, PENALTY), &support))
            }
        };
        let Form::Moves([uu, uv, vv]) = form else { return false };
        // friction holds the rod along the contour
        let rubs = j.checked_sub(lead).is_some_and(|j| configuration.contacts[j].grip != Grip::SMOOTH);
        let along = if rubs { (0.0, 0.0) } else { support.alpha.sin_cos() };
        let ([uu, uv], (sin, cos)) = (if rubs { [1.0, 0.0] } else { [uu, uv] }, along);
        let Some(stiffness) = stiffness(rod, shape, j) else { return false };
        (moves[known], moves[known + 1]) = ([0.0, 0.0, cos, sin], [0.0, 1.0, 0.0, 0.0]);
        let (u, eta) = (base + 2 * j, base + 2 * j + 1);
        let first = u - known;
        for (row, own) in moves[..known + 2].iter().enumerate() {
            let forces: Ends = std::array::from_fn(|i| dot(&stiffness[i], own));
            for (column, other) in moves[..=row].iter().enumerate() {
                matrix[(first + row) * size + first + column] += dot(&forces, other);
            }
        }
        matrix[u * size + u] += uu;
        matrix[eta * size + u] += uv;
        matrix[eta * size + eta] += vv;
        (moves[0], moves[1], known) = ([0.0, 0.0, -cos, -sin], [1.0, 0.0, 0.0, 0.0], 2);
    }
    has_pivots(&mut matrix, base, size)
}

/// The form of segment `j` of its ends; none where the segment is long enough to buckle between them.
fn stiffness(rod: &impl RodModel, shape: &Shape, j: usize) -> Option<[Ends; 4]> {
    let (segment, next) = (&shape.segments[j], &shape.segments[j + 1]);
    if !holds_between_ends(rod, segment.s, next.s, shape.force(j)) {
        return None;
    }
    // backwards, as it is solved, from the contact, where it is known
    let back = rod.carry_with_sensitivities(next.s, &next.start, segment.a, segment.b, segment.s - next.s);
    let (_, CutSensitivities { by_phi, by_moment, by_a, by_b, .. }) = back;
    let inverse = inverse([by_moment, by_a, by_b])?;
    let column = |turn_before: f64, turn: f64, (x, y): (f64, f64)| {
        let ends = [-x - turn * by_phi[0], -y - turn * by_phi[1], turn_before - turn * by_phi[2]];
        let [moment, a, b] = inverse.map(|row| row[0] * ends[0] + row[1] * ends[1] + row[2] * ends[2]);
        let moment_before = by_phi[3] * turn + by_moment[3] * moment + by_a[3] * a + by_b[3] * b;
        [-moment_before, moment, b, -a]
    };
    Some([
        column(1.0, 0.0, (0.0, 0.0)),
        column(0.0, 1.0, (0.0, 0.0)),
        column(0.0, 0.0, (1.0, 0.0)),
        column(0.0, 0.0, (0.0, 1.0)),
    ])
}

/// The rows of the inverse of the matrix with these columns, of which the first three entries count.
fn inverse([p, q, r]: [[f64; 4]; 3]) -> Option<[[f64; 3]; 3]> {
    let cross =
        |u: &[f64; 4], v: &[f64; 4]| [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let rows = [cross(&q, &r), cross(&r, &p), cross(&p, &q)];
    let determinant = p[0] * rows[0][0] + p[1] * rows[0][1] + p[2] * rows[0][2];
    let inverse = rows.map(|row| row.map(|entry| entry / determinant));
    // NaN is none
    inverse.iter().flatten().all(|entry| entry.abs() < STIFFEST).then_some(inverse)
}

fn dot(u: &Ends, v: &Ends) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2] + u[3] * v[3]
}

/// Whether the factors L D L^T of a symmetric matrix, of which the lower half counts, show that it is positive definite. Its first
/// `base` rows are those of the clamp, the others two a contact.
fn has_pivots(matrix: &mut [f64], base: usize, size: usize) -> bool {
    for k in 0..size {
        // row k of L and D, from the rows above
        let own = matrix[k * size + k];
        // the matrix is a band: a contact knows the one before it, the first one the clamp
        let contact = k.saturating_sub(base) / 2;
        let first = if contact == 0 { 0 } else { base + 2 * contact - 2 };
        for i in first..k {
            let known: f64 =
                (first..i).map(|m| matrix[k * size + m] * matrix[i * size + m] * matrix[m * size + m]).sum();
            matrix[k * size + i] = (matrix[k * size + i] - known) / matrix[i * size + i];
        }
        let known: f64 = (first..k).map(|m| matrix[k * size + m].powi(2) * matrix[m * size + m]).sum();
        let pivot = own - known;
        // NaN proves nothing
        let proven = pivot > LEAST_PIVOT * own;
        if !proven || own <= 0.0 {
            return false;
        }
        matrix[k * size + k] = pivot;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_set::{ActiveContact, tangent_hold};
    use crate::path::ClampPath;
    use crate::stability::Judge;
    use proptest::prelude::*;
    use rod_contours::{CircularArc, Composite};
    use rod_core::{Hold, Pose, Rod, Section, advance};
    use std::f64::consts::{PI, TAU};

    /// A rod that bends from its tip on: at each contact a disc that touches it on the side of its force, until the clamp, which is
    /// where it ends. Whether it is proven stable, and stable by its modes.
    fn verdicts(parts: &[(f64, f64, f64)], tip: Option<f64>, turn: f64) -> [bool; 2] {
        let length: f64 = parts.iter().map(|(_, length, _)| length).sum();
        let mut at = Section { x: 0.0, y: 0.0, phi: turn, kappa: 0.0 };
        let (mut a, mut b, mut s) = (0.0, 0.0, 1.0);
        if tip.is_none() {
            s = 0.9;
        }
        let unit = s / length;
        let (mut discs, mut held) = (Vec::new(), Vec::new());
        for (j, (force, length, radius)) in parts.iter().enumerate() {
            // the contour runs with the rod, the solid on its left, or against it; at the tip at an angle of its own
            let side = if *force > 0.0 { 0.0 } else { PI };
            let alpha = at.phi + side + if j == 0 { tip.unwrap_or(0.0) } else { 0.0 };
            let (sin, cos) = alpha.sin_cos();
            let (x, y) = (at.x - radius * sin, at.y + radius * cos);
            discs.push(Composite::single(CircularArc::new([x, y], *radius, 0.0, TAU).unwrap()).unwrap());
            let hold = if j == 0 && tip.is_some() { Hold::Tip } else { tangent_hold(-side) };
            let third = if hold == Hold::Tip { at.phi } else { s };
            held.push((hold, (at.x, at.y), force.abs(), third, alpha));
            (a, b) = (a + force.abs() * cos, b + force.abs() * sin);
            at = advance(&at, a, b, -length * unit);
            s -= length * unit;
        }
        discs.reverse();
        held.reverse();
        let path = ClampPath::standing(Pose { x: at.x, y: at.y, phi: at.phi });
        let setup = Setup::new(&Rod::new(1.0, 1.0).unwrap(), &discs, path);
        let mut configuration = Configuration::free(0.0);
        for (j, (hold, (x, y), force, third, alpha)) in held.into_iter().enumerate() {
            let stretch = setup.world.find(j, rod_contours::StretchKind::Piece(0)).unwrap();
            let foot = setup.world.foot(stretch, x, y);
            // the whole turns of the contour's angle go to the hold
            let turns = TAU * ((alpha - foot.alpha) / TAU).round();
            let hold = match hold {
                Hold::Tangent { offset } => Hold::Tangent { offset: offset + turns },
                Hold::Tip => Hold::Tip,
            };
            configuration.insert(j, ActiveContact::smooth(stretch, hold), [foot.t, force, third]);
        }
        let shape = Shape::of(Vec::new(), &setup, &configuration);
        let miss = (shape.segments[0].start.x - at.x).hypot(shape.segments[0].start.y - at.y);
        assert!(miss < 1e-12, "{miss}");
        let modes = Judge::default().is_positive_by_modes(&setup, &configuration, &shape);
        [is_positive(&setup, &configuration, &shape), modes]
    }

    #[test]
    fn a_bent_rod_is_proven_stable_and_one_that_snaps_is_not() {
        // pressed along its side by one disc, by two on either side, with hardly a bend between them; against a disc that its tip
        // slips from
        let stiff = [(0.1, 0.5, 0.3), (2.0, 0.5, 0.3)];
        for parts in [&[(1.0, 1.0, 0.5)][..], &[(2.0, 0.5, 0.3), (-2.0, 0.5, 0.3)], &stiff] {
            assert_eq!(verdicts(parts, None, 0.3), [true; 2], "{parts:?}");
        }
        assert_eq!(verdicts(&[(6.0, 1.0, 0.02)], Some(1.4), 0.3), [false; 2]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// What is proven, the modes find too; and it is proven up to a percent of the load at which the modes lose it.
        #[test]
        fn the_modes_agree(
            parts in prop::collection::vec((-3.0..3.0_f64, 0.2..1.0_f64, 0.05..3.0_f64), 1..5),
            (tips, lean, turn) in (any::<bool>(), -0.7..0.7_f64, -3.0..3.0_f64),
        ) {
            let under = |load: f64| {
                let parts: Vec<_> = parts.iter().map(|(f, length, radius)| (load * f, *length, *radius)).collect();
                verdicts(&parts, tips.then_some(lean + 1.2), turn)
            };
            let loads = (1..=80).map(|k| 0.05 * f64::from(k));
            let [mut last, mut lost] = [0.0, f64::INFINITY];
            for load in loads {
                let [proven, modes] = under(load);
                prop_assert!(!proven || modes, "proven, not found: {load}");
                if modes && lost.is_infinite() { last = load } else { lost = lost.min(load) }
            }
            if lost.is_finite() && last > 0.0 {
                let (mut low, mut high) = (last, lost);
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    if under(middle)[1] { low = middle } else { high = middle }
                }
                prop_assert!(!under(1.01 * high)[0], "beyond the fold: {high}");
                prop_assert!(!under(1.001 * high)[0] || under(1.001 * high)[1], "at the fold: {high}");
            }
        }
    }
}
