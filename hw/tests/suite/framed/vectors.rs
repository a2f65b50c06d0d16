//! Frames whose meaning is known.

use super::{kinds, samples, tell};
use rod_hw::device::framed::{Bota, Framed, Gsv, OptoForce, Robotiq};
use rod_hw::{Protocol, Quality, RawSample};

fn bytes(hex: &str) -> Vec<u8> {
    let digits: Vec<u8> = hex.chars().filter_map(|c| c.to_digit(16)).map(|digit| digit as u8).collect();
    digits.chunks(2).map(|pair| 16 * pair[0] + pair[1]).collect()
}

fn one(mut protocol: impl Protocol, hex: &str) -> RawSample {
    let told = tell(&mut protocol, &bytes(hex), &[1000]);
    assert_eq!(told.len(), 1);
    assert_eq!(protocol.counters().skipped_bytes, 0);
    told[0].unwrap()
}

fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // of f32
        assert!((found - expected).abs() <= 1e-7 * expected.abs(), "{found} {expected}");
    }
}

#[test]
fn gsv() {
    let frame = "aa15b0 3dcccccd be4ccccd 3e99999a 00000000 00000000 3c4ccccd 85";
    let sample = one(Framed::new(Gsv), frame);
    assert_near(&sample.channels, &[0.1, -0.2, 0.3, 0.0, 0.0, 0.0125]);
    assert_eq!((sample.status, sample.quality, sample.sequence), (0xb0, Quality::empty(), None));
    assert_eq!((sample.device_time, sample.host_time), (None, 0.0));
}

#[test]
fn bota() {
    let frame = "aa 0000 0000803f 000000c0 0000003f 0ad7233c 0ad7a3bc a69b443b 40e20100 0000fc41 d2d3";
    let sample = one(Framed::new(Bota), frame);
    assert_near(&sample.channels, &[1.0, -2.0, 0.5, 0.01, -0.02, 0.003]);
    assert_eq!((sample.device_time, sample.temperature), (Some(0.123456), Some(31.5)));
    assert_eq!((sample.status, sample.quality), (0, Quality::empty()));
}

#[test]
fn robotiq() {
    let sample = one(Framed::new(Robotiq), "204e 7b00 38fe 1503 0c00 deff 3800 e45d");
    assert_near(&sample.channels, &[123.0, -456.0, 789.0, 12.0, -34.0, 56.0]);
}

#[test]
fn optoforce() {
    // the first frame of the capture of a real device
    let sample = one(Framed::new(OptoForce), "aa07080a 2d6a 0000 fff7 fffb 0007 0551");
    assert_eq!(sample.channels[..], [-9.0, -5.0, 7.0]);
    assert_eq!((sample.sequence, sample.device_time, sample.status), (Some(0x2d6a), None, 0));
    for (status, quality) in [
        (1 << 4, Quality::SATURATED),
        (1 << 9, Quality::SATURATED),
        (1 << 10, Quality::DEVICE_ERROR),
        (2 << 13, Quality::DEVICE_ERROR),
        (0b11 << 8 | 0b1010 << 10, Quality::SATURATED | Quality::DEVICE_ERROR),
    ] {
        let mut frame = bytes("aa07080a 0000");
        frame.extend(u16::to_be_bytes(status));
        frame.extend([0; 6]);
        let sum: u16 = frame.iter().map(|byte| u16::from(*byte)).sum();
        frame.extend(sum.to_be_bytes());
        let sample = tell(&mut Framed::new(OptoForce), &frame, &[1000])[0].unwrap();
        assert_eq!((sample.status, sample.quality), (u32::from(status), quality));
    }
}

/// Payload that looks like headers and terminators, in frames side by side, is payload.
#[test]
fn payload_may_look_like_anything() {
    let aa85 = f64::from(f32::from_be_bytes([0xaa, 0x15, 0xb0, 0x85]));
    let aa00 = f64::from(f32::from_le_bytes([0xaa, 0x07, 0x08, 0x0a]));
    for mut kind in kinds() {
        let integer = kind.length < 25 || kind.name == "optoforce 12";
        let values = if integer {
            [f64::from(i16::from_be_bytes([0xaa, 0x07])), f64::from(0x080a), f64::from(0x4e20), -21_882.0, 133.0, 0.0]
        } else {
            [aa85, aa00, aa85, aa85, aa00, 2024.0]
        };
        // N and N m
        let values: Vec<f64> =
            if kind.name == "robotiq" { values.iter().map(|value| 1e-3 * value).collect() } else { values.to_vec() };
        let mut stream = Vec::new();
        (0..50).for_each(|_| stream.extend(kind.frame(&values)));
        let told = tell(kind.subject.as_mut(), &stream, &[7]);
        assert_eq!(samples(&told).len(), 50, "{}", kind.name);
        let counters = kind.subject.counters();
        assert_eq!((counters.samples, counters.skipped_bytes, kind.subject.held()), (50, 0, 0), "{}", kind.name);
        if kind.name != "robotiq" {
            let count = values.len().min(samples(&told)[0].channels.len());
            assert_eq!(samples(&told)[49].channels[..count], values[..count], "{}", kind.name);
        }
    }
}
