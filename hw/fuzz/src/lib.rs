//! What the targets share: choices made by the bytes of the fuzzer, the check of framed devices, the bound of memory.

mod choices;
mod framed;
mod memory;

pub use choices::Choices;
pub use framed::check;
pub use memory::bounded;

use rod_hw::RawSample;

/// Whether two samples are the same, those that are no number included.
pub fn is_same(a: &RawSample, b: &RawSample) -> bool {
    let rest = |sample: &RawSample| RawSample { channels: Default::default(), ..*sample };
    a.channels.len() == b.channels.len()
        && a.channels.iter().zip(b.channels.iter()).all(|(a, b)| a.to_bits() == b.to_bits())
        && rest(a) == rest(b)
}
