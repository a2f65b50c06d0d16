//! Bytes that mean nothing.

use super::{Noise, kinds, samples, tell};
use proptest::prelude::*;

/// Random bytes pass for frames as often as sync and check let them, and no more.
#[test]
fn random_bytes_are_no_frames() {
    const BYTES: usize = 4_000_000;
    for mut kind in kinds() {
        let told = tell(kind.subject.as_mut(), &Noise(0x9e37_79b9).bytes(BYTES), &[4096]);
        // Bota: sync byte and CRC are 24 bits, 0.24 expected; GSV: sync, kind, type and terminator, 28 bits, 0.015; the others
        // have 32 bits and more
        let most = if kind.name == "bota" || kind.name == "gsv" { 3 } else { 0 };
        let found = samples(&told).len();
        let counters = kind.subject.counters();
        println!("{}: {found} of {BYTES} random bytes; {counters}", kind.name);
        assert!(found <= most, "{}: {found}", kind.name);
        assert!(counters.skipped_bytes > BYTES as u64 - 1000, "{}", kind.name);
    }
}

/// Bytes that look like beginnings of frames more often than not.
fn tempting() -> impl Strategy<Value = u8> {
    prop_oneof![
        any::<u8>(),
        prop::sample::select(vec![
            0xaa_u8, 0x85, 7, 8, 10, 16, 28, 0x15, 0x5f, 0xb0, 0x9f, 0x20, 0x4e, 0x09, 0x10, 0x90, 0, 0x50
        ]),
        prop::sample::select(b"r,0\r\n".to_vec()),
    ]
}

proptest! {
    #[test]
    fn no_panic_and_bounded_memory(bytes in prop::collection::vec(tempting(), 0..2000), lengths in prop::collection::vec(1_usize..200, 1..5)) {
        for mut kind in kinds() {
            let told = tell(kind.subject.as_mut(), &bytes, &lengths);
            // at most one thing for each byte
            prop_assert!(told.len() <= bytes.len());
            prop_assert!(kind.subject.held() <= rod_hw::device::framed::LONGEST_FRAME);
            kind.subject.reset();
            prop_assert_eq!(kind.subject.held(), 0);
            // and it reads what comes then
            let frame = kind.frame(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
            prop_assert_eq!(samples(&tell(kind.subject.as_mut(), &frame, &[1])).len(), 1);
        }
    }
}
