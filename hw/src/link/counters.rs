//! What came over a link and what did not.

/// What came over a link and what did not. Every frame that came is exactly one of: handed on, repeated, reordered,
/// malformed, of a bad checksum, an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkCounters {
    /// Samples handed on.
    pub samples: u64,
    /// Samples missing by the device's own counter: never came, or came too late.
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
    /// Samples handed on that the device calls wrong or saturated.
    pub device_errors: u64,
    /// Times that the device's counter began anew.
    pub restarts: u64,
    /// Samples handed on that the consumer did not take in time, thrown away.
    pub untaken: u64,
    /// Requests sent.
    pub requests: u64,
    /// Times that the connection was made anew.
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
