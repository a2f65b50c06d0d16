//! Framed sensors that are silent: what the protocol sends, and how it marks the first sample after that.

use rod_hw::device::framed::*;
use rod_hw::*;

fn started() -> Framed<Gsv> {
    let mut protocol = Framed::new(Gsv);
    while protocol.request(0.0).is_some() {
        assert_eq!(protocol.decode(&mut &[0xaa, 0x50, 0, 0x85][..], 0.0), None);
    }
    protocol
}

fn sample(protocol: &mut Framed<Gsv>, now: f64) -> Quality {
    let frame = [0xaa, 0x10, 0xb0, 0x3d, 0xcc, 0xcc, 0xcd, 0x85];
    protocol.decode(&mut &frame[..], now).unwrap().unwrap().quality
}

/// A reader that pauses must not have the device stopped and started again.
#[test]
fn that_nobody_asked_is_no_silence_of_the_device() {
    let mut protocol = started();
    assert_eq!(sample(&mut protocol, 0.1), Quality::empty());
    assert_eq!(protocol.request(60.0), None);
    assert_eq!(sample(&mut protocol, 60.1), Quality::empty());
    assert_eq!(protocol.request(60.2), None);
    assert_eq!(protocol.request(62.1), None);
    assert_eq!(protocol.request(62.3).as_deref(), Some(&[0xaa, 0x90, 0x23, 0x85][..]));
}

/// It may have been off, and what it calls zero may be another one.
#[test]
fn after_a_silence_the_tare_is_stale() {
    let mut protocol = started();
    assert_eq!(sample(&mut protocol, 0.1), Quality::empty());
    for now in [0.2, 2.3] {
        protocol.request(now);
    }
    assert_eq!(sample(&mut protocol, 3.0), Quality::GAP_BEFORE | Quality::RESTARTED);
    assert_eq!(sample(&mut protocol, 3.1), Quality::empty());
}
