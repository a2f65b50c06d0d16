//! The noise of points, where nobody tells it.

use super::check::check;
use super::choose::{Allowed, Chosen, choose};
use super::observation::Frame;
use super::observed::Observed;
use super::scatter::{LEAST, scatter};
use super::settings::ForceSettings;
use crate::numeric::chi_squared::wilson_hilferty;
use crate::numeric::median;
use rod_core::PhysicalRod;

/// Most frames by which the noise is found.
const SAMPLE: usize = 50;
/// How many times it is found anew, and the share by which it changes no more.
const ROUNDS: usize = 3;
pub(super) const SETTLED: f64 = 0.02;
/// Share of the noise that is left with all points in reverse order, from which on it is asked whether they are so.
const LESS_NOISE: f64 = 0.7;
/// Most frames by which that is found.
const FEW: usize = 20;

/// The noise of the points (L). Shapes with one contact tell it; where they leave much more than the scatter of neighbouring points, a few frames are
/// asked with as many contacts as are allowed. Where points in reverse order leave much less, the noise is that: then no shape explains them
/// as they are.
pub(super) fn found_noise<R: PhysicalRod>(rod: &R, frames: &[Frame], settings: &ForceSettings) -> f64 {
    let of_few = |turn: &dyn Fn(&Frame) -> Frame| -> Vec<Frame> {
        frames.iter().step_by(frames.len().div_ceil(FEW).max(1)).map(turn).collect()
    };
    let one = ForceSettings { most_contacts: settings.most_contacts.min(1), ..*settings };
    let (all, few) = (noise(rod, frames, &one), of_few(&Frame::clone));
    let (same, less) = (noise(rod, &few, &one), noise(rod, &of_few(&Frame::reversed), &one));
    if less > LEAST && less < LESS_NOISE * same {
        return all.min(less);
    }
    if settings.most_contacts > 1 && LESS_NOISE * same > scatter(few.iter(), rod.units().length) {
        return all.min(noise(rod, &few, settings));
    }
    all
}

/// The noise of the points (L), from what the best shapes leave of a sample of the frames.
fn noise<R: PhysicalRod>(rod: &R, frames: &[Frame], settings: &ForceSettings) -> f64 {
    let needs = |frame: &&Frame| frame.points.len() > 3 && frame.points.iter().any(|point| point.sigma.is_none());
    let length = rod.units().length;
    let usable: Vec<&Frame> =
        frames.iter().filter(needs).filter(|frame| check(length, frame, f64::INFINITY).is_ok()).collect();
    let mut sigma = scatter(usable.iter().copied(), length);
    let stride = usable.len().div_ceil(SAMPLE).max(1);
    for _ in 0..ROUNDS {
        let left = usable.iter().step_by(stride).filter_map(|frame| {
            let Chosen { best, .. } = choose(rod.model(), &Observed::new(frame, rod, sigma), Allowed::of(settings))?;
            // by the median of chi squared
            (best.freedom > 0).then(|| best.chi_squared / wilson_hilferty(best.freedom as usize, 0.0))
        });
        let Some(ratio) = median(left.collect()) else { break };
        let next = (sigma * ratio.sqrt()).max(LEAST);
        let is_settled = (next / sigma - 1.0).abs() < SETTLED;
        sigma = next;
        if is_settled {
            break;
        }
    }
    sigma
}
