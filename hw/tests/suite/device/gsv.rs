//! Frames and set-up of a GSV.

use rod_hw::device::framed::*;
use rod_hw::*;

#[test]
fn integers_are_offset_binary() {
    let mut protocol = Framed::new(Gsv { values: GsvValues::I16, ..Gsv::default() });
    let frame = [0xaa, 0x12, 0x90, 0x80, 0x00, 0x85, 0xaa, 0x7f, 0xff, 0x85];
    let sample = protocol.decode(&mut &frame[..], 0.0).unwrap().unwrap();
    assert_eq!(sample.channels[..], [0.0, f64::from(0x85aa - 0x8000), -1.0]);
    assert_eq!(sample.quality, Quality::empty());
    let rail = protocol.decode(&mut &[0xaa, 0x10, 0x90, 0xff, 0xff, 0x85][..], 0.0).unwrap().unwrap();
    assert_eq!((rail.channels[0], rail.quality), (32_767.0, Quality::SATURATED));

    let mut protocol = Framed::new(Gsv { values: GsvValues::I24, ..Gsv::default() });
    let frame = [0xaa, 0x11, 0xa2, 0x80, 0x00, 0x01, 0, 0, 0, 0x85];
    let sample = protocol.decode(&mut &frame[..], 0.0).unwrap().unwrap();
    assert_eq!(sample.channels[..], [1.0, -8_388_608.0]);
    assert_eq!(sample.quality, Quality::SATURATED | Quality::DEVICE_ERROR);
}

#[test]
fn another_mode_or_number_of_channels_is_a_fault() {
    let mut protocol = Framed::new(Gsv { channels: Some(6), ..Gsv::default() });
    let fault = protocol.decode(&mut &[0xaa, 0x11, 0xb0, 0, 0, 0, 0, 0, 0, 0, 0, 0x85][..], 0.0).unwrap().unwrap_err();
    assert_eq!(fault, FrameFault::Marker { at: 1, found: 0x11, expected: 0x15 });
    let mut protocol = Framed::new(Gsv::default());
    let fault = protocol.decode(&mut &[0xaa, 0x11, 0x91, 0, 0, 0, 0, 0x85][..], 0.0).unwrap().unwrap_err();
    assert_eq!(fault, FrameFault::Marker { at: 2, found: 0x91, expected: 0xb1 });
    assert_eq!(protocol.counters().malformed, 1);
}

#[test]
fn set_up_step_by_step() {
    let mut protocol = Framed::new(Gsv { rate: Some(100.0), zero: true, channels: Some(2), ..Gsv::default() });
    let answer = [0xaa, 0x50, 0, 0x85];
    let due = [
        &[0xaa, 0x90, 0x23, 0x85][..],
        &[0xaa, 0x93, 0x81, 1, 0, 0x10, 0x85],
        &[0xaa, 0x94, 0x8b, 0x42, 0xc8, 0, 0, 0x85],
        &[0xaa, 0x91, 0x0c, 1, 0x85],
        &[0xaa, 0x91, 0x0c, 2, 0x85],
        &[0xaa, 0x90, 0x24, 0x85],
    ];
    for (i, expected) in due.into_iter().enumerate() {
        let now = i as f64;
        assert_eq!(*protocol.request(now).unwrap(), *expected);
        assert_eq!(protocol.request(now + 0.1), None, "no answer, but not long ago");
        assert_eq!(*protocol.request(now + 0.6).unwrap(), *expected, "again");
        if i == 2 {
            let refused = protocol.decode(&mut &[0xaa, 0x50, 0x54, 0x85][..], now).unwrap();
            assert_eq!(refused, Err(FrameFault::Refused { request: 0x8b, code: 0x54 }));
        }
        assert_eq!(protocol.decode(&mut &answer[..], now + 0.7), None);
    }
    assert_eq!(protocol.request(7.0), None);
    assert_eq!(protocol.request(8.9), None);
    assert_eq!(*protocol.request(9.1).unwrap(), *due[0], "silent for 2 s: from the start");
    assert_eq!(protocol.counters().answers, 7);
}
