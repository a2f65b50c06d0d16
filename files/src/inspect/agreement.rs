//! How well samples in one frame agree with a single frictionless contact, and with the work of the clamp.

use nalgebra::Matrix3;
use vibrissa::reconstruct::single;
use vibrissa::rod::{Elastica, Load, Reactions};
use vibrissa::{Pose, Rod, Sample};

/// Energy of bending from the clamp to the arc length `s`, where the rod carries the force of the clamp, J; none where `s` is no length of a rod.
pub(super) fn bending_energy(sample: &Sample, stiffness: f64, s: f64) -> Option<f64> {
    let Reactions { f0x, f0y, m0z } = sample.reactions;
    let units = Rod::new(s, stiffness).ok()?.units();
    // the force that the contact takes away
    let load = Load { s, force: f0x.hypot(f0y), alpha: (-f0x).atan2(f0y) };
    Elastica::from_clamp(units, sample.pose, m0z, &[load]).ok().map(|bent| bent.bending_energy())
}

/// Standard deviations within which a reaction is noise.
pub(super) const SIGMAS: f64 = 4.0;
/// Fewest averages in contact.
pub(super) const FEWEST: usize = 12;
/// Averages over which energy and work are compared. Larger: less noise, fewer comparisons.
pub(super) const LAG: usize = 4;
/// Error allowed in the length of the rod and, relative to m0z^2, in the phase criterion.
const SLACK: f64 = 0.03;
/// Largest error allowed in the place of a contact, however large the noise, in lengths of the rod.
const WIDEST: f64 = 0.3;

/// How well samples agree with a single frictionless contact.
#[derive(Clone, Debug)]
pub(super) struct Agreement {
    /// Share of the averages in contact that satisfy one of the two conditions.
    pub explained: f64,
    /// Share that some single contact explains.
    pub possible: f64,
    /// The farthest contact but for a twentieth, in lengths of the rod; 1 where the length is not known.
    pub reach: f64,
    /// Steps of the scan in contact: work of the clamp along x, y and its angle, and the change of the elastic energy, J.
    steps: Vec<[f64; 4]>,
}

/// The agreement of samples; none where too few are in contact.
pub(super) fn agreement(samples: &[Sample], noise: [f64; 2], stiffness: f64, length: Option<f64>) -> Option<Agreement> {
    let contact = in_contact(samples, noise);
    let rod = some_rod(samples, stiffness, length)?;
    let touched =
        |(sample, is_in_contact): (&Sample, &bool)| is_in_contact.then(|| Touched::of(&rod, sample, noise, stiffness));
    let found: Vec<Option<Touched>> = samples.iter().zip(&contact).map(touched).collect();
    let contacts: Vec<&Touched> = found.iter().flatten().collect();
    if contacts.len() < FEWEST {
        return None;
    }
    let known = length;
    let length = known.or_else(|| length_of(&contacts))?;
    let share = |holds: &dyn Fn(&Touched) -> bool| {
        contacts.iter().filter(|touched| holds(touched)).count() as f64 / contacts.len() as f64
    };
    let possible = |touched: &Touched| touched.excess <= touched.slack && touched.s <= (1.0 + touched.reach) * length;
    let explained = share(&|touched| {
        possible(touched)
            && (touched.excess.abs() <= touched.slack || (touched.s / length - 1.0).abs() <= touched.reach)
    });
    let mut places: Vec<f64> = contacts.iter().map(|touched| touched.s).filter(|s| s.is_finite()).collect();
    places.sort_unstable_by(f64::total_cmp);
    let farthest = *places.get(places.len() * 19 / 20)?;
    let reach = known.map_or(1.0, |length| farthest / length);
    let energies: Vec<f64> = found
        .iter()
        .zip(samples)
        .map(|(touched, sample)| {
            touched.as_ref().and_then(|touched| bending_energy(sample, stiffness, touched.s)).unwrap_or(0.0)
        })
        .collect();
    Some(Agreement { explained, possible: share(&possible), reach, steps: steps(samples, &contact, &energies) })
}

fn force(sample: &Sample) -> f64 {
    sample.reactions.f0x.hypot(sample.reactions.f0y)
}

fn largest_force(samples: &[Sample]) -> f64 {
    samples.iter().map(force).fold(0.0, f64::max)
}

/// Whether each of some averages is in contact, by the noise of forces and moments.
pub(super) fn in_contact(samples: &[Sample], noise: [f64; 2]) -> Vec<bool> {
    let largest = largest_force(samples);
    let touches = |sample: &Sample| {
        let force = force(sample);
        force > 1e-6 * largest && (force > SIGMAS * noise[0] || sample.reactions.m0z.abs() > SIGMAS * noise[1])
    };
    samples.iter().map(touches).collect()
}

/// A rod of this stiffness, of any length where none is known: that does not matter to where the moment vanishes.
pub(super) fn some_rod(samples: &[Sample], stiffness: f64, length: Option<f64>) -> Option<Rod> {
    Rod::new(length.unwrap_or((stiffness / largest_force(samples)).sqrt()), stiffness).ok()
}

/// Work of the clamp along x, y and its angle from one average to the next, J. Reactions of an average that is not in contact are noise.
pub(super) fn work_between(poses: [Pose; 2], reactions: [&Reactions; 2], contact: [bool; 2]) -> [f64; 3] {
    let mean = |of: fn(&Reactions) -> f64| {
        let one = |k: usize| if contact[k] { of(reactions[k]) } else { 0.0 };
        0.5 * (one(0) + one(1))
    };
    let [from, to] = poses;
    [mean(|r| r.f0x) * (to.x - from.x), mean(|r| r.f0y) * (to.y - from.y), mean(|r| r.m0z) * (to.phi - from.phi)]
}

/// An average in contact.
struct Touched {
    /// Where the moment vanishes; infinite where it does not.
    s: f64,
    /// The phase criterion, N^2 m^2, and how much noise and rod may change it.
    excess: f64,
    slack: f64,
    /// Relative error of the place that is allowed.
    reach: f64,
}

/// Energy of bending of a rod whose moment vanishes at its only contact, J; none where no moment vanishes on the rod.
pub(super) fn energy(rod: &Rod, sample: &Sample, stiffness: f64) -> Option<f64> {
    bending_energy(sample, stiffness, place(rod, sample))
}

/// Arc length at which the moment vanishes, m; infinite where it does not.
fn place(rod: &Rod, sample: &Sample) -> f64 {
    let touch = single(rod, sample.pose, sample.reactions, &Matrix3::zeros());
    touch.map_or_else(|none| none.touch().map_or(f64::INFINITY, |touch| touch.s), |touch| touch.s)
}

impl Touched {
    fn of(rod: &Rod, sample: &Sample, noise: [f64; 2], stiffness: f64) -> Self {
        let Reactions { f0x, f0y, m0z } = sample.reactions;
        let s = place(rod, sample);
        let relative = |noise: f64, value: f64| SIGMAS * noise / value.abs().max(f64::MIN_POSITIVE);
        Self {
            s,
            excess: sample.reactions.phase_criterion(sample.pose.phi, stiffness),
            slack: SLACK * m0z * m0z + SIGMAS * (2.0 * m0z.abs() * noise[1] + 2.8 * stiffness * noise[0]),
            reach: (SLACK + relative(noise[1], m0z) + relative(noise[0], f0x.hypot(f0y))).min(WIDEST),
        }
    }
}

/// The length of the rod, from the contacts that are not tangential: half of them are at the tip, or more.
fn length_of(contacts: &[&Touched]) -> Option<f64> {
    let finite = contacts.iter().filter(|touched| touched.s.is_finite());
    let mut off: Vec<f64> =
        finite.clone().filter(|touched| touched.excess < -touched.slack).map(|touched| touched.s).collect();
    if 10 * off.len() < contacts.len() {
        return finite.map(|touched| touched.s).max_by(f64::total_cmp).map(|most| (1.0 + SLACK) * most);
    }
    off.sort_unstable_by(f64::total_cmp);
    off.get(off.len() / 2).copied()
}

fn steps(samples: &[Sample], contact: &[bool], energies: &[f64]) -> Vec<[f64; 4]> {
    let work = |k: usize| {
        let (a, b) = (&samples[k], &samples[k + 1]);
        work_between([a.pose, b.pose], [&a.reactions, &b.reactions], [contact[k], contact[k + 1]])
    };
    (0..samples.len().saturating_sub(LAG))
        .step_by(LAG)
        .filter(|&k| contact[k] || contact[k + LAG])
        .map(|k| {
            let [x, y, phi] = (k..k + LAG).map(work).fold([0.0; 3], |[a, b, c], [x, y, z]| [a + x, b + y, c + z]);
            [x, y, phi, energies[k + LAG] - energies[k]]
        })
        .collect()
}

impl Agreement {
    /// Concordance of the work of the clamp and the change of the elastic energy (Lin 1989, about 0), each component in another unit or with
    /// another sign by its factor: 1 where they are equal, -1 where they are opposite, 0 where one is much larger or they are independent.
    /// Jumps, in which energy is lost, count little.
    pub fn concordance(&self, factors: [f64; 4]) -> f64 {
        let [x, y, phi, energy] = factors;
        let both: Vec<[f64; 2]> =
            self.steps.iter().map(|step| [x * step[0] + y * step[1] + phi * step[2], energy * step[3]]).collect();
        let limits = [0, 1].map(|of: usize| {
            let mut sizes: Vec<f64> = both.iter().map(|step| step[of].abs()).collect();
            sizes.sort_unstable_by(f64::total_cmp);
            sizes.get(sizes.len() * 9 / 10).copied().unwrap_or_default()
        });
        let [product, squares] = both.iter().fold([0.0; 2], |[product, squares], [work, energy]| {
            let (work, energy) = (work.clamp(-limits[0], limits[0]), energy.clamp(-limits[1], limits[1]));
            [product + work * energy, squares + work * work + energy * energy]
        });
        if squares > 0.0 { 2.0 * product / squares } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vibrissa::Pose;

    #[test]
    fn energy_is_that_of_the_whole_rod() {
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        let bent = Elastica::under_loads(rod.units(), pose, &[Load { s: 0.08, force: 0.2, alpha: 1.2 }]).unwrap().0;
        let sample = Sample::new(pose, bent.reactions());
        let found = bending_energy(&sample, rod.bending_stiffness(), 0.08).unwrap();
        assert!((found / bent.bending_energy() - 1.0).abs() < 1e-12, "{found} {}", bent.bending_energy());
    }
}
