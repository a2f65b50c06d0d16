//! Counters of a link.

/// Counters of a link. Every frame that arrives is counted as exactly one of: sample, repeated, reordered, malformed, bad
/// checksum, answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkCounters {
    /// Samples returned.
    pub samples: u64,
    /// Samples missing by the device's own counter: never arrived, or arrived too late.
    pub lost: u64,
    /// Places where samples are missing.
    pub gaps: u64,
    /// Frames with the number of the one before, left out.
    pub repeated: u64,
    /// Frames with an earlier number, left out; each of them was counted as lost before.
    pub reordered: u64,
    /// Frames of a wrong length, header or terminator.
    pub malformed: u64,
    /// Frames that fail their checksum.
    pub bad_checksum: u64,
    /// Answers to requests.
    pub answers: u64,
    /// Datagrams from elsewhere, or empty.
    pub foreign: u64,
    /// Bytes of a stream that belong to no good frame: those of damaged frames are among them.
    pub skipped_bytes: u64,
    /// Samples returned that the device reports as wrong or saturated.
    pub device_errors: u64,
    /// Restarts of the device's counter.
    pub restarts: u64,
    /// Samples discarded because the consumer did not take them in time.
    pub untaken: u64,
    /// Requests sent.
    pub requests: u64,
    /// Reconnections.
    pub reconnects: u64,
}

impl core::fmt::Display for LinkCounters {
    /// The samples, and of the others those that are not zero.
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} samples", self.samples)?;
        for (count, name) in [
            (self.lost, "lost"),
            (self.gaps, "gaps"),
            (self.repeated, "repeated"),
            (self.reordered, "reordered"),
            (self.malformed, "malformed"),
            (self.bad_checksum, "with a bad checksum"),
            (self.foreign, "from elsewhere"),
            (self.skipped_bytes, "bytes skipped"),
            (self.device_errors, "called wrong by the device"),
            (self.restarts, "restarts"),
            (self.untaken, "not taken in time"),
            (self.reconnects, "reconnects"),
        ] {
            if count > 0 {
                write!(f, ", {count} {name}")?;
            }
        }
        Ok(())
    }
}
