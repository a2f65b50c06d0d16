//! A capture of a real OptoForce sensor, and one of its kind that is made here.

use super::{samples, tell};
use rod_fake_sensor::{FakeDevice, FakeOptoForce};
use rod_hw::device::framed::{Framed, OptoForce};
use rod_hw::{Protocol, Quality};
use std::path::Path;

/// What a capture tells: valid, damaged, gaps, all of them of one.
fn assert_told(capture: &[u8], piece: usize, valid: usize, damaged: u64) {
    let mut protocol = Framed::new(OptoForce);
    let told = tell(&mut protocol, capture, &[piece]);
    let samples = samples(&told);
    let counters = protocol.counters();
    assert_eq!((samples.len(), counters.bad_checksum), (valid, damaged));
    assert_eq!((counters.gaps, counters.lost), (damaged, damaged));
    assert_eq!((counters.repeated, counters.reordered, counters.malformed, counters.restarts), (0, 0, 0, 0));
    assert!(samples.iter().all(|sample| sample.status == 0));
    let numbers: Vec<u64> = samples.iter().map(|sample| sample.sequence.unwrap()).collect();
    let steps: Vec<u64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(steps.iter().filter(|step| **step == 2).count() as u64, damaged);
    assert!(steps.iter().all(|step| matches!(step, 1 | 2)));
    let flagged = samples.iter().filter(|sample| sample.quality == Quality::GAP_BEFORE).count();
    assert_eq!(flagged as u64, damaged);
    let answers = 7 * counters.answers;
    assert_eq!(16 * valid as u64 + answers + counters.skipped_bytes + protocol.held() as u64, capture.len() as u64);
}

#[test]
fn of_a_real_sensor() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/sensors/optoforce-capture.bin");
    let capture = match std::fs::read(&path) {
        Ok(capture) => capture,
        Err(error) => {
            println!("skipped, for there is no capture at {}: {error}", path.display());
            return;
        }
    };
    assert_eq!(capture.len(), 550_220);
    for piece in [1, 16, 1009, 1 << 20] {
        assert_told(&capture, piece, 34_320, 54);
    }
}

/// Four foreign bytes every 10,004, as in the real one, which fall anywhere but on a header.
#[test]
fn of_a_fake_one() {
    let mut device = FakeOptoForce::new(3).with_count(0x2d6a);
    let mut clean = vec![0xaa, 0, 0x50, 1, 0, 0, 0xfb];
    for i in 0..20_000 {
        device.measure(&[f64::from(i % 100), -5.0, 7.0], Quality::empty(), &mut clean);
    }
    let mut capture = Vec::new();
    let mut hit = 0;
    for (i, byte) in clean.iter().enumerate() {
        // where the frame goes on behind its header
        if i % 10_000 == 9_999 && i < 310_000 && (i - 7) % 16 > 4 {
            capture.extend(b"'\nb'");
            hit += 1;
        }
        capture.push(*byte);
    }
    assert!(hit > 20, "{hit}");
    for piece in [1, 997, 1 << 20] {
        assert_told(&capture, piece, 20_000 - hit, hit as u64);
    }
}

/// The counter wraps; what is repeated, late or missing is told.
#[test]
fn counts() {
    let mut protocol = Framed::new(OptoForce);
    let mut stream = Vec::new();
    for count in [65_534, 65_535, 0, 4, 4, 3, 5] {
        FakeOptoForce::new(6).with_count(count).measure(&[], Quality::empty(), &mut stream);
    }
    let numbers: Vec<_> = samples(&tell(&mut protocol, &stream, &[5])).iter().map(|s| s.sequence.unwrap()).collect();
    assert_eq!(numbers, [65_534, 65_535, 65_536, 65_540, 65_541]);
    let counters = protocol.counters();
    assert_eq!((counters.gaps, counters.lost, counters.repeated, counters.reordered), (1, 3, 1, 1));
}

/// After the connection was made anew, the numbers go on growing, whatever the counter.
#[test]
fn numbers_grow_over_a_new_connection() {
    let mut protocol = Framed::new(OptoForce);
    let mut numbers = Vec::new();
    for count in [5000, 3, 60_000] {
        let mut stream = Vec::new();
        let mut device = FakeOptoForce::new(3).with_count(count);
        (0..2).for_each(|_| device.measure(&[], Quality::empty(), &mut stream));
        stream.extend([0xaa, 7]);
        numbers.extend(samples(&tell(&mut protocol, &stream, &[5])).iter().map(|s| s.sequence.unwrap()));
        protocol.reset();
    }
    assert_eq!(numbers, [5000, 5001, 5002, 5003, 60_000, 60_001]);
    assert_eq!(protocol.counters().skipped_bytes, 6, "what was held when the connection broke");
}
