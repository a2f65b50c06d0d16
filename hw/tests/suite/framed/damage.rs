//! Streams with faults that are known: what is told is what they left.

use super::{Kind, Noise, kinds, samples, tell};
use proptest::prelude::*;
use rod_hw::Quality;

/// Values of frame i that tell its number, in counts as in floats.
fn values(i: usize) -> [f64; 6] {
    let number = (i % 300) as f64;
    [number, 1.0, 2.0, 3.0, 4.0, number]
}

/// The number of a sample.
fn number(kind: &Kind, first: f64) -> f64 {
    if kind.name == "robotiq" { first / 100.0 } else { first }
}

/// Faults far from each other, so that each is one.
#[test]
fn counters_add_up_to_what_was_done() {
    const FRAMES: usize = 2000;
    for mut kind in kinds().into_iter() {
        let has_counter = kind.name.starts_with("optoforce");
        let (mut stream, mut expected, mut damaged, mut lost, mut garbage, mut skipped) =
            (Vec::new(), Vec::new(), 0, 0, 0, 0);
        for i in 0..FRAMES {
            let mut frame = kind.frame(&values(i));
            // the last byte is a checksum or a terminator, of all kinds
            let last = frame.len() - 1;
            // bytes of a check that look like a sync byte, moved beyond the length of the frame, pass for another one
            let ambiguous = frame[last - 2..].contains(&0xaa);
            let fault = if ambiguous { 0 } else { i % 100 };
            match fault {
                20 => frame[last] ^= 0x10,
                40 => frame.truncate(kind.length - 5),
                60 => _ = frame.splice(9..9, [0x11, 0x22, 0x33]),
                80 => frame.clear(),
                90 => {
                    stream.extend([0x11; 5]);
                    garbage += 1;
                }
                _ => {}
            }
            match fault {
                20 | 40 | 60 => {
                    damaged += 1;
                    skipped += frame.len();
                }
                80 => lost += 1,
                90 => {
                    skipped += 5;
                    expected.push((i % 300) as f64);
                }
                _ => expected.push((i % 300) as f64),
            }
            stream.extend(frame);
        }
        let told = tell(kind.subject.as_mut(), &stream, &[61]);
        let found: Vec<f64> = samples(&told).iter().map(|sample| number(&kind, sample.channels[0])).collect();
        assert_eq!(found, expected, "{}", kind.name);
        let counters = kind.subject.counters();
        assert_eq!(counters.samples, expected.len() as u64, "{}", kind.name);
        assert_eq!(counters.malformed + counters.bad_checksum, damaged, "{}", kind.name);
        assert_eq!(told.iter().filter(|one| one.is_err()).count() as u64, damaged, "{}", kind.name);
        assert_eq!(counters.skipped_bytes, skipped as u64, "{}", kind.name);
        assert_eq!(kind.subject.held(), 0, "{}", kind.name);
        let gaps = if has_counter { damaged + lost } else { 0 };
        assert_eq!((counters.gaps, counters.lost), (gaps, gaps), "{}", kind.name);
        // without a counter, only what left bytes behind is seen
        let flags = samples(&told).iter().filter(|sample| sample.quality.contains(Quality::GAP_BEFORE)).count() as u64;
        assert_eq!(flags, if has_counter { gaps } else { damaged + garbage }, "{}", kind.name);
        println!("{}: {counters}", kind.name);
    }
}

/// A bit that flips anywhere in a checked frame costs that frame and no other, and no wrong value is handed on. Where there is
/// no checksum, a wrong value may be, but no other frame is lost.
#[test]
fn one_bit_costs_one_frame() {
    for bit in 0..37 * 8 {
        for mut kind in kinds().into_iter().filter(|kind| bit < 8 * kind.length) {
            let mut stream = Vec::new();
            for i in 0..12 {
                let mut frame = kind.frame(&values(i));
                if i == 5 {
                    frame[bit / 8] ^= 1 << (bit % 8);
                }
                stream.extend(frame);
            }
            let told = tell(kind.subject.as_mut(), &stream, &[1000]);
            let found: Vec<f64> = samples(&told).iter().map(|sample| number(&kind, sample.channels[0])).collect();
            let checked = kind.name != "gsv";
            let others: Vec<f64> = (0..12).filter(|i| *i != 5).map(f64::from).collect();
            if checked || found.len() == 11 {
                assert_eq!(found, others, "{} bit {bit}", kind.name);
            } else {
                assert_eq!(found.len(), 12, "{} bit {bit}", kind.name);
                assert!(
                    found.iter().enumerate().all(|(i, value)| i == 5 || i as f64 == *value),
                    "{} bit {bit}",
                    kind.name
                );
            }
        }
    }
}

/// A stream of good frames, damaged ones and garbage.
fn messy(kind: &mut Kind, noise: &mut Noise) -> Vec<u8> {
    let mut stream = Vec::new();
    for i in 0..200 {
        let mut frame = kind.frame(&values(i));
        match noise.below(12) {
            0 => stream.extend({
                let count = noise.below(100);
                noise.bytes(count)
            }),
            1 => frame.truncate(noise.below(kind.length)),
            2 => {
                let bit = noise.below(8 * kind.length);
                frame[bit / 8] ^= 1 << (bit % 8);
            }
            3 => {
                let (at, count) = (noise.below(kind.length), noise.below(9));
                frame.splice(at..at, noise.bytes(count));
            }
            // a sync byte too many
            4 => stream.extend(&frame[..1 + noise.below(3)]),
            _ => {}
        }
        stream.extend(frame);
    }
    stream
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn bytes_one_at_a_time_are_as_all_at_once(seed in 1_u64.., lengths in prop::collection::vec(1_usize..300, 1..8)) {
        for (((mut all, mut one), mut some), i) in kinds().into_iter().zip(kinds()).zip(kinds()).zip(0..) {
            let stream = messy(&mut all, &mut Noise(seed.rotate_left(i)));
            // as text, for NaN is not NaN
            let at_once = format!("{:?}", tell(all.subject.as_mut(), &stream, &[usize::MAX]));
            prop_assert!(format!("{:?}", tell(one.subject.as_mut(), &stream, &[1])) == at_once, "{}", all.name);
            prop_assert!(format!("{:?}", tell(some.subject.as_mut(), &stream, &lengths)) == at_once, "{}", all.name);
            let counters = all.subject.counters();
            prop_assert_eq!(one.subject.counters(), counters);
            prop_assert_eq!(some.subject.counters(), counters);
            prop_assert_eq!((one.subject.held(), some.subject.held()), (all.subject.held(), all.subject.held()));
            prop_assert!(all.subject.held() <= rod_hw::device::framed::LONGEST_FRAME);
        }
    }

    #[test]
    fn every_byte_is_of_a_frame_skipped_or_held(seed in 1_u64..) {
        for (mut kind, i) in kinds().into_iter().zip(0..) {
            let stream = messy(&mut kind, &mut Noise(seed.rotate_left(i)));
            let told = tell(kind.subject.as_mut(), &stream, &[100]);
            let counters = kind.subject.counters();
            let frames = counters.samples + counters.repeated + counters.reordered;
            if kind.name == "gsv" {
                // damaged heads may tell another length that fits
                prop_assert!(counters.skipped_bytes <= stream.len() as u64);
            } else if counters.answers == 0 {
                let accounted = frames * kind.length as u64 + counters.skipped_bytes + kind.subject.held() as u64;
                prop_assert_eq!(accounted, stream.len() as u64, "{}", kind.name);
            }
            prop_assert_eq!(samples(&told).len() as u64, counters.samples);
            prop_assert_eq!(told.len() as u64, counters.samples + counters.malformed + counters.bad_checksum);
        }
    }
}
