//! The rod as its reactions bend it up to its first contact: any rod on any clamp, dimensionless.

use super::clamp::Clamp;
use rod_core::{Clamp as Held, Cut, PhysicalRod, Pose, Reactions, RodModel, find_root};

/// Length of the steps (rod lengths) in which the moment is followed. Two zeros within one step may be missed; the work grows
/// with its inverse.
pub(super) const STEP: f64 = 1.0 / 64.0;
/// Arc length (L) behind the tip up to which it is: noise puts the zero of a contact at the tip there.
const BEYOND_TIP: f64 = 6.0 / 64.0;

/// The zeros of the moment beyond the cut `start` at arc length `from`, a little beyond the tip too.
pub(super) fn zeros<M: RodModel>(model: &M, from: f64, start: Cut, [a, b]: [f64; 2]) -> impl Iterator<Item = f64> {
    let (mut end, steps) = (start, ((1.0 + BEYOND_TIP - from) / STEP).ceil() as usize);
    (0..steps).filter_map(move |k| {
        let (s, start) = (from + k as f64 * STEP, end);
        let along = |length: f64| model.carry(s, &start, a, b, length);
        end = along(STEP);
        if start.moment == 0.0 {
            return Some(s);
        }
        let crosses = start.moment * end.moment < 0.0;
        let root = || find_root("moment", |length| Ok(along(length).moment), 0.0, STEP, 0.0).ok();
        crosses.then(root).flatten().map(|root| s + root.at)
    })
}

/// The rod as its reactions bend it, as if nothing touched it before.
pub(super) struct Bent<'a, M> {
    pub model: &'a M,
    base: Cut,
    pub a: f64,
    pub b: f64,
    compliance: [[f64; 3]; 3],
}

impl<'a, M: RodModel> Bent<'a, M> {
    /// The support of its clamp and the reactions are those of `clamp`.
    pub fn new<R: PhysicalRod<Model = M>>(rod: &'a R, clamp: &Clamp) -> Self {
        let ([x, y, phi], [f0x, f0y, m0z]): ([f64; 3], [f64; 3]) = (clamp.pose.into(), clamp.reactions.into());
        let held = rod.clamp(Pose { x, y, phi });
        let compliance = held.law().map_or([[0.0; 3]; 3], |law| law.compliance);
        let Pose { x, y, phi } = held.base(&Reactions { f0x, f0y, m0z });
        Self { model: rod.model(), base: Cut { x, y, phi, moment: -m0z }, a: f0y, b: -f0x, compliance }
    }

    /// The zeros of the moment from the clamp on, a little beyond the tip too.
    pub fn zeros(&self) -> impl Iterator<Item = f64> {
        zeros(self.model, 0.0, self.base, [self.a, self.b])
    }

    /// (x, y, phi, moment) at an arc length, its derivatives by the reactions, of which the base of a rod on springs depends too, and those
    /// by the angle of the clamp.
    pub fn by_reactions(&self, s: f64) -> (Cut, [[f64; 4]; 3], [f64; 4]) {
        let (end, d) = self.model.carry_with_sensitivities(0.0, &self.base, self.a, self.b, s);
        let direct = [d.by_b.map(|v| -v), d.by_a, d.by_moment.map(|v| -v)];
        let columns = [0, 1, 2].map(|c| {
            let [x, y, phi] = self.compliance.map(|row| -row[c]);
            let shift = [x, y, 0.0, 0.0];
            [0, 1, 2, 3].map(|i| direct[c][i] + shift[i] + phi * d.by_phi[i])
        });
        (end, columns, d.by_phi)
    }

    /// How the moment changes along the rod.
    pub fn moment_rate(&self, at: &Cut) -> f64 {
        self.a * at.phi.cos() + self.b * at.phi.sin()
    }
}
