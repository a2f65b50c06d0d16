//! Memory in proportion to what is read.

use allocation_counter::measure;

/// Whatever the length, bytes.
const ROOM: u64 = 1 << 16;

/// Runs it, and checks that it never holds more than `most` bytes for each of `length`, beside a little.
pub fn bounded<R>(length: usize, most: u64, run: impl FnOnce() -> R) -> R {
    let mut result = None;
    let used = measure(|| result = Some(run()));
    assert!(used.bytes_max <= most * length as u64 + ROOM, "{} bytes for a file of {length}", used.bytes_max);
    result.expect("it ran")
}
