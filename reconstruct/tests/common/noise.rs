//! Seeded normal noise, white or AR(1).

use std::f64::consts::TAU;

/// SplitMix64 (Steele, Lea and Flood 2014) and the transform of Box and Muller.
pub struct Noise {
    state: u64,
    spare: Option<f64>,
    last: f64,
    correlation: f64,
}

impl Noise {
    /// Noise of variance 1 whose neighbours have this correlation.
    pub fn new(seed: u64, correlation: f64) -> Self {
        let mut noise = Self { state: seed, spare: None, last: 0.0, correlation };
        // seeds that differ by little must not give the same numbers one place further on
        noise.state = (0..2).fold(0, |mixed: u64, _| mixed.rotate_left(32) ^ noise.next());
        noise.last = noise.normal();
        noise
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        let (sin, cos) = (TAU * self.uniform()).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }

    pub fn sample(&mut self) -> f64 {
        let fresh = (1.0 - self.correlation * self.correlation).sqrt() * self.normal();
        self.last = self.correlation * self.last + fresh;
        self.last
    }

    pub fn add(&mut self, sigma: f64, clean: &[f64]) -> Vec<f64> {
        clean.iter().map(|y| y + sigma * self.sample()).collect()
    }
}
