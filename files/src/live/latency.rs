//! Delays.

/// Number of bins: each is longer by a factor of 2^(1/8), from 1 us to 17 minutes.
const BINS: usize = 240;
const PER_OCTAVE: f64 = 8.0;
const LEAST: f64 = 1e-6;

/// Quantiles of delays, accurate to 9 %, in constant memory.
#[derive(Clone, Debug)]
pub struct Latency {
    bins: [u64; BINS],
    count: u64,
    largest: f64,
}

impl Default for Latency {
    fn default() -> Self {
        Self { bins: [0; BINS], count: 0, largest: 0.0 }
    }
}

impl Latency {
    /// Takes a delay, s.
    pub fn push(&mut self, seconds: f64) {
        let bin = (PER_OCTAVE * (seconds / LEAST).max(1.0).log2()) as usize;
        self.bins[bin.min(BINS - 1)] += 1;
        self.count += 1;
        self.largest = self.largest.max(seconds);
    }

    /// The delay (s) that this share of them does not exceed, to 9 %; none without delays.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let rank = (share * self.count as f64).ceil().max(1.0) as u64;
        let mut seen = 0;
        let bin = self.bins.iter().position(|count| {
            seen += count;
            seen >= rank
        })?;
        let upper = LEAST * ((bin + 1) as f64 / PER_OCTAVE).exp2();
        (self.count > 0).then_some(upper.min(self.largest))
    }

    /// The largest one, s.
    pub fn largest(&self) -> f64 {
        self.largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles() {
        let mut latency = Latency::default();
        assert_eq!(latency.quantile(0.5), None);
        for k in 1..=1000 {
            latency.push(1e-5 * f64::from(k));
        }
        for (share, expected) in [(0.5, 5e-3), (0.999, 9.99e-3), (1.0, 1e-2)] {
            let found = latency.quantile(share).unwrap();
            assert!(found >= expected && found < 1.1 * expected, "{share}: {found}");
        }
        latency.push(1e9);
        latency.push(0.0);
        assert_eq!((latency.largest(), latency.quantile(0.0)), (1e9, Some(LEAST * 2.0_f64.powf(0.125))));
    }
}
