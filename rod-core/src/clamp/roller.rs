//! A roller ahead of the clamp: the rod runs through a point that is fixed to the clamp.
//!
//! The roller is frictionless and of no size: its force R, of either sign, is across the rod. Where along the rod it is, s_r, is unknown,
//! since a rod that bends between clamp and roller is longer than their distance. Beyond the roller nothing is different from a rigid
//! clamp, so that R and s_r are eliminated: from the cut of the rod at the first contact, and the force there, the rod is carried back to
//! s_r and, with R, on to its base, such that seen from the base it runs through the roller,
//!
//! ```text
//! rotation by -phi(0) of (r(s_r) - r(0)) = place of the roller in the frame of the clamp:      2 equations for s_r and R
//! ```
//!
//! What is left are the three equations of a rigid clamp: the base is where the clamp is. Nothing in these two equations depends on where
//! that is, and the derivatives of the base follow by the implicit function theorem.

use crate::model::{Cut, CutSensitivities, RodModel};
use crate::pose::Pose;

/// A roller, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roller {
    /// Arc length at which the rod runs through it at rest.
    pub at: f64,
    /// Where it is in the frame of the clamp: along phi0, and across it to the left.
    pub place: [f64; 2],
    /// Slope angle of the rod at rest there, less that of the clamp.
    pub lean: f64,
}

/// The rod where it runs through a roller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollerHold {
    /// Arc length.
    pub s: f64,
    /// The force R of the roller, which acts on the rod as R (sin phi, -cos phi).
    pub force: f64,
    /// The rod there.
    pub at: Cut,
}

/// Iterations after which a rod is taken not to run through the roller. Usually it takes three or four.
const MOST_ITERATIONS: u32 = 40;
/// Step of s_r over the distance of the roller, and of R times the square of that distance (rad, in a uniform rod about twice the turn that
/// it makes), below which the next iterate is exact to rounding: the error of one is about the square of that of the one before.
const LAST_STEP: f64 = 1e-9;
/// Longest step of s_r over the distance of the roller. A bent rod is longer than its chord by less than that.
const LONGEST_STEP: f64 = 0.3;

/// Steps to the start for s_r. More are for the iteration.
const CLOSER: usize = 3;
/// Least rate at which the distance along the rod grows with the arc length that a step takes for true.
const LEAST_RATE: f64 = 0.3;

/// Distance across the rod, over that of the roller, by which the rod may miss the roller before both unknowns are iterated, and iterations
/// in which only the force is, at most. Under strong forces the moment changes fast along the rod: a step of s_r would overshoot.
const FAR: f64 = 1e-2;
const FORCE_ALONE: u32 = 8;

/// Number of what a passage depends on, but for where it is: slope angle, moment, force (A, B) and arc length of the cut that it comes from.
const INPUTS: usize = 5;

/// How the rod comes from its first contact through the roller to its base.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage {
    pub hold: RollerHold,
    /// The base of the rod that runs through the roller.
    pub base: Cut,
    /// The force (A, B) between base and roller.
    pub force: [f64; 2],
    /// Of the base.
    pub sensitivities: CutSensitivities,
    /// Of that force by slope angle, moment, A, B and arc length of the first contact.
    pub force_rates: [[f64; INPUTS]; 2],
}

impl Roller {
    /// The roller of a clamp through which a rod at rest runs at arc length `at`.
    pub(crate) fn of(rod: &impl RodModel, at: f64) -> Self {
        let Cut { x, y, phi, .. } = rod.carry(0.0, &Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 }, 0.0, 0.0, at);
        Self { at, place: [x, y], lean: phi }
    }

    /// Where it is while the clamp is at `pose`.
    pub fn point(&self, pose: Pose) -> [f64; 2] {
        let ((sin, cos), [along, across]) = (pose.phi.sin_cos(), self.place);
        [pose.x + cos * along - sin * across, pose.y + sin * along + cos * across]
    }

    /// The rod at rest, without load.
    pub fn at_rest(&self, pose: Pose) -> RollerHold {
        let [x, y] = self.point(pose);
        RollerHold { s: self.at, force: 0.0, at: Cut { x, y, phi: pose.phi + self.lean, moment: 0.0 } }
    }

    /// The force that holds a beam which is bent little at the roller, under this moment and this force across it.
    fn force_by_a_beam(&self, moment: f64, across: f64) -> f64 {
        1.5 * moment / self.at - across
    }

    /// Where the rod that comes from its first contact is closest to the roller of a clamp at `pose`, about: a start for s_r.
    fn closest(&self, rod: &impl RodModel, pose: Pose, from: f64, start: &Cut, a: f64, b: f64) -> f64 {
        let ([x, y], mut s) = (self.point(pose), self.at);
        for _ in 0..CLOSER {
            let at = rod.carry(from, start, a, b, s - from);
            let ((sin, cos), dx, dy) = (at.phi.sin_cos(), at.x - x, at.y - y);
            let rate = 1.0 + rod.curvature_at(s, at.moment) * (dy * cos - dx * sin);
            let step = -(dx * cos + dy * sin) / rate.max(LEAST_RATE);
            s += step.clamp(-LONGEST_STEP * self.at, LONGEST_STEP * self.at);
        }
        if s > 0.0 && s < from { s } else { self.at }
    }

    /// The passage of the rod whose first contact is at arc length `from`, to a base near `pose`. None where it does not run through the roller on its way to the
    /// base, or the contact is not beyond the roller.
    pub(crate) fn pass(
        &self,
        rod: &impl RodModel,
        pose: Pose,
        (from, start): (f64, &Cut),
        [a, b]: [f64; 2],
    ) -> Option<Passage> {
        let (mut s, mut force, mut is_last) = (self.closest(rod, pose, from, start, a, b), None, false);
        for iteration in 0..MOST_ITERATIONS {
            let (at, to_roller) = rod.carry_with_sensitivities(from, start, a, b, s - from);
            let (sin, cos) = at.phi.sin_cos();
            let r = *force.get_or_insert_with(|| self.force_by_a_beam(at.moment, a * cos + b * sin));
            let (a0, b0) = (a + r * cos, b + r * sin);
            // from the roller on, so that a roller close to the clamp keeps its digits
            let here = Cut { x: 0.0, y: 0.0, ..at };
            let (end, to_base) = rod.carry_with_sensitivities(s, &here, a0, b0, -s);
            let (sin0, cos0) = end.phi.sin_cos();
            let seen = [-end.x * cos0 - end.y * sin0, end.x * sin0 - end.y * cos0];

            // the change of the base as seen from the roller, and of the force there, with those of the rod at the roller
            let moved = |[_, _, phi, moment]: [f64; 4], [by_a, by_b]: [f64; 2], by_r: f64, by_s: f64| {
                let by_a0 = by_a + by_r * cos - r * sin * phi;
                let by_b0 = by_b + by_r * sin + r * cos * phi;
                let d = &to_base;
                let end: [f64; 4] = std::array::from_fn(|i| {
                    let held = d.by_phi[i] * phi + d.by_moment[i] * moment;
                    held + d.by_a[i] * by_a0 + d.by_b[i] * by_b0 + d.by_from[i] * by_s
                });
                (end, [by_a0, by_b0])
            };
            let missed_by =
                |[x, y, phi, _]: [f64; 4]| [-x * cos0 - y * sin0 + phi * seen[1], x * sin0 - y * cos0 - phi * seen[0]];
            let none = [0.0; 2];
            let by_s = moved(to_roller.by_to, none, 0.0, 1.0);
            let by_r = moved([0.0; 4], none, 1.0, 0.0);
            let columns = [missed_by(by_s.0), missed_by(by_r.0)];
            let solve = |[along, across]: [f64; 2]| {
                let [[p, q], [u, v]] = columns;
                let determinant = p * v - q * u;
                [(u * across - v * along) / determinant, (q * along - p * across) / determinant]
            };
            if is_last {
                let hold = RollerHold { s, force: r, at };
                let beyond = 0.0 < s && s < from;
                let base = Cut { x: at.x + end.x, y: at.y + end.y, ..end };
                let d = &to_roller;
                let inputs = [
                    (d.by_phi, none),
                    (d.by_moment, none),
                    (d.by_a, [1.0, 0.0]),
                    (d.by_b, [0.0, 1.0]),
                    (d.by_from, none),
                ];
                let mut force_rates = [[0.0; INPUTS]; 2];
                let mut rates = [[0.0; 4]; INPUTS];
                for (k, (cut, by_force)) in inputs.into_iter().enumerate() {
                    let (own, own_force) = moved(cut, by_force, 0.0, 0.0);
                    let [s, r] = solve(missed_by(own));
                    rates[k] = std::array::from_fn(|i| own[i] + s * by_s.0[i] + r * by_r.0[i]);
                    rates[k][0] += cut[0] + s * d.by_to[0];
                    rates[k][1] += cut[1] + s * d.by_to[1];
                    for i in 0..2 {
                        force_rates[i][k] = own_force[i] + s * by_s.1[i] + r * by_r.1[i];
                    }
                }
                let [by_phi, by_moment, by_a, by_b, by_from] = rates;
                let sensitivities = CutSensitivities { by_phi, by_moment, by_a, by_b, by_from, by_to: to_base.by_to };
                let is_number = base.x.is_finite() && base.phi.is_finite() && r.is_finite();
                let passage = Passage { hold, base, force: [a0, b0], sensitivities, force_rates };
                return (beyond && is_number).then_some(passage);
            }
            let missed = [seen[0] - self.place[0], seen[1] - self.place[1]];
            let [by_s, by_r] = if missed[1].abs() > FAR * self.at && iteration < FORCE_ALONE {
                [0.0, -missed[1] / columns[1][1]]
            } else {
                solve(missed)
            };
            let long = by_s.abs() / (LONGEST_STEP * self.at);
            let share = 1.0 / long.max(1.0);
            s += share * by_s;
            force = Some(r + share * by_r);
            if !(by_s.is_finite() && by_r.is_finite()) {
                return None;
            }
            is_last = by_s.abs() < LAST_STEP * self.at && (by_r * self.at * self.at).abs() < LAST_STEP;
        }
        None
    }

    /// The rod at the roller where the force (A, B) and this bending moment act on it there, with its clamp at `pose`. None where none is
    /// found that is bent little enough between the two.
    pub fn under(&self, rod: &impl RodModel, pose: Pose, moment: f64, a: f64, b: f64) -> Option<RollerHold> {
        let ([x, y], mut phi) = (self.point(pose), pose.phi + self.lean + 0.25 * moment * self.at);
        let mut s = self.at;
        let mut force = self.force_by_a_beam(moment, a * phi.cos() + b * phi.sin());
        for _ in 0..MOST_ITERATIONS {
            let (sin, cos) = phi.sin_cos();
            let at = Cut { x: 0.0, y: 0.0, phi, moment };
            let (end, d) = rod.carry_with_sensitivities(s, &at, a + force * cos, b + force * sin, -s);
            let missed = [end.x + x - pose.x, end.y + y - pose.y, end.phi - pose.phi];
            let by_s = d.by_from;
            let by_phi: [f64; 4] = std::array::from_fn(|i| d.by_phi[i] + force * (cos * d.by_b[i] - sin * d.by_a[i]));
            let by_force: [f64; 4] = std::array::from_fn(|i| cos * d.by_a[i] + sin * d.by_b[i]);
            let [step_s, step_phi, step_force] = solved([by_s, by_phi, by_force], missed)?;
            let share = 1.0 / (step_s.abs() / (LONGEST_STEP * self.at)).max(step_phi.abs()).max(1.0);
            (s, phi, force) = (s - share * step_s, phi - share * step_phi, force - share * step_force);
            if step_s.abs() < LAST_STEP * self.at && (step_force * self.at * self.at).abs() < LAST_STEP {
                return (s > 0.0).then_some(RollerHold { s, force, at: Cut { x, y, phi, moment } });
            }
        }
        None
    }
}

impl Passage {
    /// The change of the force (A, B) and of the moment at the base with that of the cut at the first contact: of its slope angle, moment,
    /// force (A, B) and arc length.
    pub fn felt(&self, inputs: [f64; INPUTS]) -> [f64; 3] {
        let d = &self.sensitivities;
        let of = |rates: &[f64; INPUTS]| rates.iter().zip(inputs).map(|(rate, input)| rate * input).sum();
        let moment = [d.by_phi[3], d.by_moment[3], d.by_a[3], d.by_b[3], d.by_from[3]];
        [of(&self.force_rates[0]), of(&self.force_rates[1]), of(&moment)]
    }
}

/// The solution of three equations with these columns, of which the first three entries count, by Cramer's rule.
fn solved([p, q, r]: [[f64; 4]; 3], [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
    let cross =
        |u: &[f64; 4], v: &[f64; 4]| [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let rows = [cross(&q, &r), cross(&r, &p), cross(&p, &q)];
    let determinant = p[0] * rows[0][0] + p[1] * rows[0][1] + p[2] * rows[0][2];
    let solution = rows.map(|row| (row[0] * x + row[1] * y + row[2] * z) / determinant);
    solution.iter().all(|v| v.is_finite()).then_some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Uniform;

    const NEAR: Pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
    const CUT: Cut = Cut { x: 0.55, y: 0.1, phi: 0.5, moment: 0.4 };

    #[test]
    fn the_rod_runs_through_the_roller() {
        let roller = Roller::of(&Uniform, 0.2);
        let passage = roller.pass(&Uniform, NEAR, (0.6, &CUT), [-1.0, 2.0]).unwrap();
        let Cut { x, y, phi, .. } = passage.base;
        let [px, py] = roller.point(Pose { x, y, phi });
        let at = passage.hold.at;
        assert!((px - at.x).abs() < 1e-15 && (py - at.y).abs() < 1e-15);
        assert!(passage.hold.s > 0.2 && passage.hold.s < 0.21);
        // balance of moments between roller and base
        let [a0, b0] = passage.force;
        let moment = at.moment + a0 * (x - at.x) + b0 * (y - at.y);
        assert!((moment - passage.base.moment).abs() < 1e-14);
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let roller = Roller::of(&Uniform, 0.3);
        let inputs = [CUT.phi, CUT.moment, -1.0, 2.0, 0.6];
        let of = |v: [f64; 5]| {
            let cut = Cut { phi: v[0], moment: v[1], ..CUT };
            let passage = roller.pass(&Uniform, NEAR, (v[4], &cut), [v[2], v[3]]).unwrap();
            let Cut { x, y, phi, moment } = passage.base;
            ([x, y, phi, moment, passage.force[0], passage.force[1]], passage)
        };
        let exact = of(inputs).1;
        let d = exact.sensitivities;
        for (k, column) in [d.by_phi, d.by_moment, d.by_a, d.by_b, d.by_from].into_iter().enumerate() {
            let h = 1e-3;
            let shifted = |by: f64| {
                let mut v = inputs;
                v[k] += by;
                of(v).0
            };
            let pairs = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
            let ours = [column[0], column[1], column[2], column[3], exact.force_rates[0][k], exact.force_rates[1][k]];
            for (i, ours) in ours.into_iter().enumerate() {
                let difference: f64 = pairs.iter().map(|(n, w)| w * (shifted(n * h)[i] - shifted(-n * h)[i]) / h).sum();
                assert!((ours - difference).abs() < 1e-9 * (1.0 + ours.abs()), "{k} {i}: {ours} {difference}");
            }
        }
    }

    #[test]
    fn the_same_rod_is_found_from_the_clamp() {
        let roller = Roller::of(&Uniform, 0.2);
        let passage = roller.pass(&Uniform, NEAR, (0.6, &CUT), [-1.0, 2.0]).unwrap();
        let Cut { x, y, phi, .. } = passage.base;
        let found = roller.under(&Uniform, Pose { x, y, phi }, passage.hold.at.moment, -1.0, 2.0).unwrap();
        assert!((found.s - passage.hold.s).abs() < 1e-14 && (found.force - passage.hold.force).abs() < 1e-12);
        assert!((found.at.phi - passage.hold.at.phi).abs() < 1e-14);
    }

    #[test]
    fn a_contact_before_the_roller_is_none() {
        let roller = Roller::of(&Uniform, 0.2);
        assert!(roller.pass(&Uniform, NEAR, (0.15, &CUT), [-1.0, 2.0]).is_none());
        assert!(roller.pass(&Uniform, NEAR, (0.6, &Cut { moment: f64::NAN, ..CUT }), [-1.0, 2.0]).is_none());
    }
}
