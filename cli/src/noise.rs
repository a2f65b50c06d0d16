//! Noise in place of a measurement.

use vibrissa::Reactions;

/// Reactions with white Gaussian noise of these standard deviations (N, N, N m): the same for the same seed.
pub(crate) fn noisy(clean: impl IntoIterator<Item = Reactions>, sigma: Reactions, seed: u64) -> Vec<Reactions> {
    let mut dice = Dice(seed);
    let add = |clean: Reactions| Reactions {
        f0x: clean.f0x + sigma.f0x * dice.normal(),
        f0y: clean.f0y + sigma.f0y * dice.normal(),
        m0z: clean.m0z + sigma.m0z * dice.normal(),
    };
    clean.into_iter().map(add).collect()
}

/// Steele, Lea and Flood (2014), splitmix64.
struct Dice(u64);

impl Dice {
    /// Evenly in (0, 1).
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Normally, with mean 0 and standard deviation 1 (Box and Muller 1958).
    fn normal(&mut self) -> f64 {
        (-2.0 * self.even().ln()).sqrt() * (std::f64::consts::TAU * self.even()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_its_standard_deviation_and_comes_again_with_its_seed() {
        let sigma = Reactions { f0x: 2.0, f0y: 0.5, m0z: 0.0 };
        let clean = vec![Reactions { f0x: 1.0, f0y: -1.0, m0z: 3.0 }; 100_000];
        let noise = noisy(clean.clone(), sigma, 7);
        assert_eq!(noise, noisy(clean.clone(), sigma, 7));
        assert_ne!(noise[0], noisy(clean.clone(), sigma, 8)[0]);
        let n = noise.len() as f64;
        let moments = |value: fn(&Reactions) -> f64, mean: f64| {
            let off = |power| noise.iter().map(|r| (value(r) - mean).powi(power)).sum::<f64>() / n;
            (off(1), off(2), off(4))
        };
        // Five standard deviations of each estimate.
        let (mean, variance, fourth) = moments(|r| r.f0x, 1.0);
        assert!(mean.abs() < 5.0 * 2.0 / n.sqrt(), "{mean}");
        assert!((variance / 4.0 - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{variance}");
        assert!((fourth / 16.0 - 3.0).abs() < 5.0 * (96.0 / n).sqrt(), "{fourth}");
        assert!((moments(|r| r.f0y, -1.0).1 / 0.25 - 1.0).abs() < 5.0 * (2.0 / n).sqrt());
        assert!(noise.iter().all(|r| r.m0z == 3.0));
        let together = noise.iter().map(|r| (r.f0x - 1.0) * (r.f0y + 1.0)).sum::<f64>() / n;
        assert!(together.abs() < 5.0 / n.sqrt(), "the channels are independent: {together}");
    }
}
