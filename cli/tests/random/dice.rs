//! Random numbers that never change their meaning: splitmix64, and a few draws from it.

use std::f64::consts::TAU;

/// A stream of numbers that depends on its seed alone.
#[derive(Clone, Debug)]
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        // neighbouring seeds must not start with neighbouring numbers
        let mut dice = Self(seed.wrapping_mul(0xD134_2543_DE82_EF95));
        dice.next();
        dice
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Evenly between 0 and 1, to all digits.
    pub fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normally distributed with mean 0 and standard deviation 1 (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.share()).ln()).sqrt();
        radius * (TAU * self.share()).cos()
    }

    /// Evenly between `from` and `to`, rounded to 1e-4 so that scene files are short.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        let share = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        ((from + share * (to - from)) * 1e4).round() / 1e4
    }

    /// Evenly in the logarithm.
    pub fn log_between(&mut self, from: f64, to: f64) -> f64 {
        let share = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        let value = from * (to / from).powf(share);
        (value * 1e5).round() / 1e5
    }

    /// Evenly in the logarithm, to all digits: for lengths far below 1e-5.
    #[allow(dead_code, reason = "only sharp scenes have such lengths")]
    pub fn fine_between(&mut self, from: f64, to: f64) -> f64 {
        let share = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        from * (to / from).powf(share)
    }

    /// One of `from`, ..., `to`.
    pub fn whole(&mut self, from: usize, to: usize) -> usize {
        from + (self.next() % (to - from + 1) as u64) as usize
    }

    /// True once in a while.
    pub fn chance(&mut self, share: f64) -> bool {
        self.between(0.0, 1.0) < share
    }

    pub fn angle(&mut self) -> f64 {
        self.between(0.0, TAU)
    }

    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }
}

#[test]
fn seeds_never_change_their_meaning() {
    let mut dice = Dice::new(7);
    let drawn = [dice.whole(0, 999_999), dice.whole(0, 999_999), dice.whole(0, 999_999)];
    assert_eq!(drawn, [968_899, 341_757, 11_516]);
}
