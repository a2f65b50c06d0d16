//! Jumps of the reactions from one sample to the next.

use crate::point::Clamp;
use crate::scan::Track;
use crate::scan::noise_estimate::ChannelNoise;

/// Samples on either side of a difference that tell how much the reactions change without a jump.
const AROUND: usize = 12;
/// Ratio of the norms of a jump and of the largest difference around it. Jumps of the nine scans of Merker et al. (2020) under noise of 10 mN have 6 to 37,
/// all other differences 2.1 at most. Larger: small jumps are missed; smaller: kinks, and noise, count as jumps.
const STANDS_OUT: f64 = 3.0;
/// Smallest jump, standard deviations of a difference: by chance one in 10^9 samples.
const SMALLEST: f64 = 7.0;
/// Ratio of the ways from sample to sample above which a difference is that of a gap.
const GAP: f64 = 3.0;

/// The first samples after jumps, by their index in the track: differences of neighbouring samples that stand out of those around them. The search for
/// kinks takes a jump at the end of a steep curve for a kink: there a hinge and a step explain a window of samples equally well.
pub(super) fn jumps(track: &Track, noise: &[ChannelNoise; 3]) -> Vec<usize> {
    let sigma = noise.map(|channel| channel.sigma * (2.0 * (1.0 - channel.lag1).max(0.1)).sqrt());
    let size = |pair: &[Clamp]| {
        let change = pair[1].reactions - pair[0].reactions;
        (0..3).map(|c| (change[c] / sigma[c].max(f64::MIN_POSITIVE)).powi(2)).sum::<f64>().sqrt()
    };
    let sizes: Vec<f64> = track.clamps.windows(2).map(size).collect();
    let ways: Vec<f64> = track.tau.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let stands_out = |k: &usize| {
        let around = (k.saturating_sub(AROUND)..(k + AROUND + 1).min(sizes.len())).filter(|i| i != k);
        let (size, way) = around.fold((0.0, 0.0), |(size, way): (f64, f64), i| (size.max(sizes[i]), way.max(ways[i])));
        sizes[*k] > SMALLEST.max(STANDS_OUT * size) && ways[*k] < GAP * way
    };
    (0..sizes.len()).filter(stands_out).map(|k| k + 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::seeded::Random;
    use nalgebra::Vector3;

    const NOISE: f64 = 0.01;
    const COUNT: usize = 400;
    const JUMP: usize = 250;

    /// The jumps of a track whose reactions are these at each sample, with noise.
    fn found(tau: impl Fn(usize) -> f64, force: impl Fn(f64) -> f64) -> Vec<usize> {
        let mut random = Random::new(3);
        let tau: Vec<f64> = (0..COUNT).map(tau).collect();
        let clamp = |tau: &f64| {
            let reactions = Vector3::from_fn(|_, _| force(*tau) + NOISE * random.normal());
            Clamp { pose: Vector3::zeros(), reactions, natural: 0.0, friction: 0.0 }
        };
        let clamps = tau.iter().map(clamp).collect();
        jumps(&Track { tau, clamps, ..Track::default() }, &[ChannelNoise::white(NOISE); 3])
    }

    /// As steep as a rod gets before it snaps at the sample `JUMP`, and flat after.
    fn snap(tau: f64) -> f64 {
        let left = JUMP as f64 - 0.5 - tau;
        if left > 0.0 { 0.3 - 0.02 * left.sqrt() } else { 0.45 }
    }

    #[test]
    fn the_jump_of_a_snap_is_found_and_its_steep_curve_is_none() {
        assert_eq!(found(|k| k as f64, snap), [JUMP]);
        // as slow that the jump is the end of a steep curve, or hidden by the noise
        assert!(found(|k| k as f64, |tau| snap(tau).min(0.3)).is_empty());
    }

    #[test]
    fn kinks_spikes_and_gaps_are_no_jumps() {
        assert!(found(|k| k as f64, |tau| 0.3 * (tau - JUMP as f64).max(0.0)).is_empty());
        assert!(found(|k| k as f64, |tau| if tau == JUMP as f64 { 1.0 } else { 0.0 }).is_empty());
        assert!(found(|k| (k + if k < JUMP { 0 } else { 30 }) as f64, |tau| 0.01 * tau).is_empty());
    }
}
