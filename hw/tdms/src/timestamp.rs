//! Times of a file.

use crate::bytes::Order;

/// A time, exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TdmsTimestamp {
    /// Whole seconds since 1904-01-01 00:00 UTC, without leap seconds.
    pub seconds: i64,
    /// The fraction of a second, in units of 2^-64 s.
    pub fraction: u64,
}

impl TdmsTimestamp {
    /// Seconds since 1970-01-01 00:00 UTC; at today's dates to 0.2 us.
    #[expect(clippy::cast_precision_loss, reason = "the accuracy is stated")]
    pub fn unix_seconds(self) -> f64 {
        const FROM_1904_TO_1970: i64 = 2_082_844_800;
        self.seconds.saturating_sub(FROM_1904_TO_1970) as f64 + self.fraction as f64 * 2.0_f64.powi(-64)
    }

    /// The fraction comes first where the bytes are in little-endian order.
    pub(super) fn read(bytes: &[u8], at: usize, order: Order) -> Option<Self> {
        let second = at.checked_add(8)?;
        let (fraction, seconds) = match order {
            Order::Little => (at, second),
            Order::Big => (second, at),
        };
        Some(Self { seconds: order.i64(bytes, seconds)?, fraction: order.u64(bytes, fraction)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_since_1970() {
        // 2020-01-01 00:00:00.25 UTC
        let time = TdmsTimestamp { seconds: 2_082_844_800 + 1_577_836_800, fraction: 1 << 62 };
        assert_eq!(time.unix_seconds(), 1_577_836_800.25);
    }
}
