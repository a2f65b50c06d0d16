//! Frames and set-up of a GSV.

use rod_hw::device::framed::*;
use rod_hw::*;

#[test]
fn integers_are_a_fault() {
    let mut protocol = Framed::new(Gsv);
    let fault = protocol.decode(&mut &[0xaa, 0x11, 0x91, 0, 0, 0, 0, 0x85][..], 0.0).unwrap().unwrap_err();
    assert_eq!(fault, FrameFault::Marker { at: 2, found: 0x91, expected: 0xb1 });
    assert_eq!(protocol.counters().malformed, 1);
}

#[test]
fn set_up_step_by_step() {
    let mut protocol = Framed::new(Gsv);
    let answer = [0xaa, 0x50, 0, 0x85];
    let due = [&[0xaa, 0x90, 0x23, 0x85][..], &[0xaa, 0x93, 0x81, 1, 0, 0x10, 0x85], &[0xaa, 0x90, 0x24, 0x85]];
    for (i, expected) in due.into_iter().enumerate() {
        let now = i as f64;
        assert_eq!(*protocol.request(now).unwrap(), *expected);
        assert_eq!(protocol.request(now + 0.1), None, "no answer, but not long ago");
        assert_eq!(*protocol.request(now + 0.6).unwrap(), *expected, "again");
        if i == 1 {
            let refused = protocol.decode(&mut &[0xaa, 0x50, 0x54, 0x85][..], now).unwrap();
            assert_eq!(refused, Err(FrameFault::Refused { request: 0x81, code: 0x54 }));
        }
        assert_eq!(protocol.decode(&mut &answer[..], now + 0.7), None);
    }
    assert_eq!(protocol.request(4.0), None);
    assert_eq!(protocol.request(5.9), None);
    assert_eq!(*protocol.request(6.1).unwrap(), *due[0], "silent for 2 s: from the start");
    assert_eq!(protocol.counters().answers, 4);
}
