//! What one sample tells of a rod that runs through a roller ahead of its clamp.
//!
//! Four numbers are read, f0x, f0y, m0z and the force R of the roller. All that is beyond the roller acts on the part before it through three
//! numbers, its force and its moment there. So with a known rod the four are not independent: bent by f0x, f0y and m0z alone, it must run
//! through the roller. The three that are left tell one contact, as they do on a clamp without a roller; the fourth is a check.

use super::bent::zeros;
use super::moment_zero::NOISE_SIGMAS;
use super::no_contact::NoContact;
use super::one_sample::{Felt, OneSample, contacts_of_readings};
use crate::numeric::variance;
use nalgebra::{Matrix4, Vector4};
use rod_core::{Cut, Guided, PhysicalRod, Pose, Reactions, RodModel, Roller, Sample, Units};

/// Newton steps to the place where the rod is closest to the roller, or to a stiffness or gain; each doubles the digits.
const MOST_STEPS: usize = 30;
/// Length (L) of a step after which the next is one of rounding.
const LAST_STEP: f64 = 1e-9;
/// Rounds in which readings are brought to where the rod runs through the roller; each squares what is left.
const ROUNDS: usize = 3;
/// Change of the logarithm of stiffness or gain in one step, at most.
const LONGEST_STEP: f64 = 0.5;
/// Logarithm of stiffness or gain beyond which there is no estimate: the readings do not tell it.
const FARTHEST: f64 = 3.0;

/// An estimate from one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard deviation, by the covariance of the readings and exact derivatives.
    pub sigma: f64,
}

/// What one sample of a rod tells that runs through a roller, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThroughRoller {
    /// What it tells of the contacts.
    pub contact: OneSample,
    /// Arc length where the rod is closest to the roller, m.
    pub s: f64,
    /// How far to its left the rod that f0x, f0y and m0z bend leaves the roller, m: zero but for noise and errors of rod, clamp and sensor.
    pub miss: Estimate,
    /// The bending stiffness (at the clamp, N m^2) with which it would run through. None where the rod is bent so little that the readings do
    /// not tell it, as in noise they mostly do not: of a rod that is bent little all forces grow with the stiffness alike.
    pub bending_stiffness: Option<Estimate>,
    /// The factor of m0z with which it would run through: the gain of the forces over that of the moment. None as above.
    pub moment_gain: Option<Estimate>,
}

/// What the `reactions` (N, N m) of a clamp and the force of its `roller` (N) tell: the contact as [`one_sample`](crate::one_sample) does, and
/// the check that the fourth reading is. `covariance` is that of (f0x, f0y, m0z, roller), in N and N m; zero where they are exact.
///
/// In noise the readings are first brought to where the rod runs through the roller, by the least change that the covariance allows. So the
/// point is better than that of three of them.
///
/// ```
/// use nalgebra::Matrix4;
/// use rod_core::{Guided, Pose, Reactions, Rod};
/// use rod_reconstruct::{OneSample, through_roller};
/// let rod = Guided::new(Rod::new(0.1, 1e-3)?, 0.02)?;
/// // a state of a scan, whose contact is known
/// let pose = Pose { x: 0.0, y: 0.0, phi: 0.5 };
/// let (contact, clamp, roller) = rod_reconstruct_example(&rod, pose);
/// let found = through_roller(&rod, pose, clamp, roller, &Matrix4::zeros())?;
/// let OneSample::Tip(touch) = found.contact else { return Err("no tip".into()) };
/// assert!((touch.x - contact[0]).abs() < 1e-12 && (touch.y - contact[1]).abs() < 1e-12);
/// assert!(found.miss.value.abs() < 1e-14);
///
/// # use rod_core::{Hold, MultiPoint, NewtonOptions, NewtonWorkspace, PhysicalRod, Support, Supports, solve};
/// # fn rod_reconstruct_example(rod: &Guided<Rod>, pose: Pose) -> ([f64; 2], Reactions, f64) {
/// #     struct Ceiling;
/// #     impl Supports for Ceiling {
/// #         fn count(&self) -> usize { 1 }
/// #         fn hold(&self, _: usize) -> Hold { Hold::Tip }
/// #         fn support(&self, _: usize, t: f64) -> Support { Support { x: t, y: 0.3, alpha: 0.0, speed: 1.0, turning: 0.0 } }
/// #     }
/// #     let problem = MultiPoint { rod: rod.model(), clamp: rod.clamp(pose), supports: &Ceiling };
/// #     let mut u = [0.93, 1.0, 0.2];
/// #     assert!(solve(&problem, &mut u, &NewtonOptions::default(), &mut NewtonWorkspace::new()).status.is_solved());
/// #     let units = rod.units();
/// #     let roller = problem.roller(&u).map_or(f64::NAN, |hold| hold.force * units.force);
/// #     ([u[0] * units.length, 0.3 * units.length], problem.elastica(&u, units).reactions(), roller)
/// # }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`NoContact::NotFinite`], also where the readings wind the rod up before the roller; [`NoContact::NoMomentZero`] where the moment vanishes
/// nowhere beyond it.
pub fn through_roller<R: PhysicalRod<Clamp = Pose>>(
    rod: &Guided<R>,
    pose: Pose,
    reactions: Reactions,
    roller: f64,
    covariance: &Matrix4<f64>,
) -> Result<ThroughRoller, NoContact> {
    let units = rod.units();
    let held = Held::new(rod, pose);
    let (mut readings, unit) = (dimensionless(units, reactions, roller), sizes(units));
    let mut covariance = Matrix4::from_fn(|i, j| covariance[(i, j)] / (unit[i] * unit[j]));
    if !covariance.iter().chain(&readings).all(|v| v.is_finite()) {
        return Err(NoContact::NotFinite);
    }
    let first = held.follow_to_roller(readings).ok_or(NoContact::NotFinite)?;
    let deviation = |walked: &Walked<'_, R::Model>| variance(&walked.miss_rates, &covariance).sqrt();
    let miss = Estimate { value: first.miss * units.length, sigma: deviation(&first) * units.length };
    let scaled = |estimate: Estimate, by: f64| Estimate { value: estimate.value * by, sigma: estimate.sigma * by };
    let stiffness = held.factor(readings, &covariance, [-1.0; 4]);
    let bending_stiffness = stiffness.map(|factor| scaled(factor, units.moment * units.length));
    let moment_gain = held.factor(readings, &covariance, [0.0, 0.0, 1.0, 0.0]);
    if (0..4).all(|c| readings[c].abs() <= NOISE_SIGMAS * covariance[(c, c)].max(0.0).sqrt()) {
        let s = first.s * units.length;
        return Ok(ThroughRoller { contact: OneSample::Free, s, miss, bending_stiffness, moment_gain });
    }
    let mut best = first;
    for _ in 0..ROUNDS {
        let spread = variance(&best.miss_rates, &covariance);
        if spread == 0.0 {
            break;
        }
        readings -= covariance * best.miss_rates * (best.miss / spread);
        best = held.follow_to_roller(readings).ok_or(NoContact::NotFinite)?;
    }
    let spread = variance(&best.miss_rates, &covariance);
    if spread > 0.0 {
        let told = covariance * best.miss_rates;
        covariance -= told * told.transpose() / spread;
    }
    let contact = contacts_of_readings(&best, readings.norm(), &covariance, units)?;
    Ok(ThroughRoller { contact, s: best.s * units.length, miss, bending_stiffness, moment_gain })
}

/// The sample (of a rod that runs through a roller) that the same rod would give on a clamp without one, whatever is beyond the roller: the
/// rod from there on, carried back to where its base would be. From a recording of such samples everything follows as on a rigid clamp, with
/// the rod alone ([`Guided::rod`]). `roller` is the force of the roller, N.
///
/// It is exact but for rounding. Of the standard deviations nothing is left: they would need that of the roller's force.
///
/// # Errors
/// [`NoContact::NotFinite`], also where the readings wind the rod up before the roller.
pub fn beyond_roller<R: PhysicalRod<Clamp = Pose>>(
    rod: &Guided<R>,
    sample: &Sample,
    roller: f64,
) -> Result<Sample, NoContact> {
    let units = rod.units();
    let readings = dimensionless(units, sample.reactions, roller);
    if !readings.iter().all(|v| v.is_finite()) {
        return Err(NoContact::NotFinite);
    }
    let walked = Held::new(rod, sample.pose).follow_to_roller(readings).ok_or(NoContact::NotFinite)?;
    let [a, b] = walked.force;
    let Cut { x, y, phi, moment } = walked.model.carry(walked.s, &walked.at, a, b, -walked.s);
    let pose = Pose { x: x * units.length, y: y * units.length, phi };
    let reactions = Reactions { f0x: -b * units.force, f0y: a * units.force, m0z: -moment * units.moment };
    Ok(Sample { t: sample.t, pose, reactions, sigma: None })
}

/// What one of each reading is in SI.
fn sizes(units: Units) -> Vector4<f64> {
    Vector4::new(units.force, units.force, units.moment, units.force)
}

fn dimensionless(units: Units, Reactions { f0x, f0y, m0z }: Reactions, roller: f64) -> Vector4<f64> {
    Vector4::new(f0x, f0y, m0z, roller).component_div(&sizes(units))
}

/// A rod with its clamp and its roller, dimensionless.
struct Held<'a, M> {
    model: &'a M,
    pose: Pose,
    roller: Roller,
}

/// The rod walked from the clamp to where it is closest to the roller, with derivatives by (f0x, f0y, m0z, R).
struct Walked<'a, M> {
    model: &'a M,
    s: f64,
    at: Cut,
    /// How far to the left of the roller it is.
    miss: f64,
    miss_rates: Vector4<f64>,
    /// Of `at`, which slides along the rod, and of its arc length.
    rates: [[f64; 4]; 4],
    s_rates: [f64; 4],
    /// The force (A, B) beyond the roller.
    force: [f64; 2],
    force_rates: [[f64; 2]; 4],
}

impl<'a, M: RodModel> Held<'a, M> {
    fn new<R: PhysicalRod<Clamp = Pose, Model = M>>(rod: &'a Guided<R>, Pose { x, y, phi }: Pose) -> Self {
        let length = rod.units().length;
        let held = rod.clamp(Pose { x: x / length, y: y / length, phi });
        Self { model: rod.model(), pose: held.pose, roller: held.roller }
    }

    /// None where the rod is wound up before the roller.
    fn follow_to_roller(&self, readings: Vector4<f64>) -> Option<Walked<'a, M>> {
        let [f0x, f0y, m0z, r] = readings.into();
        let (Pose { x, y, phi }, [px, py]) = (self.pose, self.roller.point(self.pose));
        let base = Cut { x, y, phi, moment: -m0z };
        let (a0, b0, mut s) = (f0y, -f0x, self.roller.at);
        let mut is_closest = false;
        let found = (0..MOST_STEPS).find_map(|_| {
            let (at, d) = self.model.carry_with_sensitivities(0.0, &base, a0, b0, s);
            let (sin, cos) = at.phi.sin_cos();
            let (dx, dy) = (at.x - px, at.y - py);
            let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
            if is_closest {
                return Some((at, d, across));
            }
            let step = -along / (1.0 + across * d.by_to[2]);
            is_closest = step.abs() < LAST_STEP;
            s += step.clamp(-0.5 * self.roller.at, 0.5 * self.roller.at);
            None
        });
        let (at, d, miss) = found.filter(|(_, d, miss)| s > 0.0 && 1.0 + miss * d.by_to[2] > 0.0)?;
        let (sin, cos) = at.phi.sin_cos();
        let rate = 1.0 + miss * d.by_to[2];
        let direct = [d.by_b.map(|v| -v), d.by_a, d.by_moment.map(|v| -v), [0.0; 4]];
        // the point of the rod that is closest stays the closest
        let s_rates = direct.map(|[x, y, phi, _]| -(x * cos + y * sin + miss * phi) / rate);
        let miss_rates = Vector4::from(direct.map(|[x, y, ..]| y * cos - x * sin));
        let rates: [[f64; 4]; 4] =
            std::array::from_fn(|k| std::array::from_fn(|i| direct[k][i] + s_rates[k] * d.by_to[i]));
        let own = [[0.0, -1.0], [1.0, 0.0], [0.0, 0.0], [-cos, -sin]];
        let force_rates = std::array::from_fn(|k| {
            let turn = rates[k][2];
            [own[k][0] + r * sin * turn, own[k][1] - r * cos * turn]
        });
        let force = [a0 - r * cos, b0 - r * sin];
        Some(Walked { model: self.model, s, at, miss, miss_rates, rates, s_rates, force, force_rates })
    }

    /// The factor c for which the rod runs through the roller with each reading times c to this power. None where the readings do not tell it.
    fn factor(&self, readings: Vector4<f64>, covariance: &Matrix4<f64>, powers: [f64; 4]) -> Option<Estimate> {
        let powers = Vector4::from(powers);
        // readings that become small bend nothing: the miss in relation to them is what vanishes
        let whole = powers.min();
        let mut log = 0.0_f64;
        for _ in 0..MOST_STEPS {
            let factors = powers.map(|power| (power * log).exp());
            let scaled = readings.component_mul(&factors);
            let walked = self.follow_to_roller(scaled)?;
            let by_log = walked.miss_rates.dot(&scaled.component_mul(&powers)) - whole.min(0.0) * walked.miss;
            let step = -walked.miss / by_log;
            if !step.is_finite() {
                return None;
            }
            if step.abs() < LAST_STEP {
                log += step;
                let gradient = walked.miss_rates.component_mul(&factors);
                let sigma = variance(&gradient, covariance).sqrt() / by_log.abs();
                return (log.abs() < FARTHEST).then(|| Estimate { value: log.exp(), sigma: sigma * log.exp() });
            }
            log += step.clamp(-LONGEST_STEP, LONGEST_STEP);
            if log.abs() > FARTHEST {
                return None;
            }
        }
        None
    }
}

impl<M: RodModel> Felt<4> for Walked<'_, M> {
    fn model(&self) -> &impl RodModel {
        self.model
    }

    fn force(&self) -> ([f64; 2], [[f64; 2]; 4]) {
        (self.force, self.force_rates)
    }

    fn by_readings(&self, s: f64) -> (Cut, [[f64; 4]; 4]) {
        let [a, b] = self.force;
        let (end, d) = self.model.carry_with_sensitivities(self.s, &self.at, a, b, s - self.s);
        let column = |k: usize| {
            let ([x, y, phi, moment], [by_a, by_b], by_s) = (self.rates[k], self.force_rates[k], self.s_rates[k]);
            let shift = [x, y, 0.0, 0.0];
            std::array::from_fn(|i| {
                let turned = shift[i] + phi * d.by_phi[i] + moment * d.by_moment[i];
                turned + by_a * d.by_a[i] + by_b * d.by_b[i] + by_s * d.by_from[i]
            })
        };
        (end, std::array::from_fn(column))
    }

    fn moment_zeros(&self) -> Vec<f64> {
        zeros(self.model, self.s, self.at, self.force).collect()
    }
}
