//! Status words of RDT sensors.

use rod_hw::device::rdt::RdtProfile::{Axia, NetFt, OnRobot};
use rod_hw::*;

#[test]
fn status_words() {
    let (good, saturated, warning, error) =
        (Quality::empty(), Quality::SATURATED, Quality::DEVICE_WARNING, Quality::DEVICE_ERROR);
    for (profile, status, expected) in [
        (NetFt, 0, good),
        (NetFt, 0x8001_0000, warning),
        (NetFt, 0x8002_0000, saturated),
        (NetFt, 0x8003_0000, saturated | warning),
        (NetFt, 0xC000_0000, error),
        (NetFt, 0x8010_0000, error),
        (NetFt, 0x8000_0000, error),
        (NetFt, 0x8000_0002, error),
        (NetFt, 0x0000_8000, warning),
        (NetFt, 0x8000_8000, warning | error),
        (Axia, 0, good),
        (Axia, 0xC000_0000, saturated),
        (Axia, 0x8800_0000, saturated),
        (Axia, 0x8000_0002, error),
        (Axia, 0x8001_0000, warning),
        (Axia, 0x0002_0000, warning),
        (OnRobot, 0, good),
        (OnRobot, 0x0011, saturated),
        (OnRobot, 0x0200, saturated),
        (OnRobot, 0x0400, error),
        (OnRobot, 0x2000, error),
        (OnRobot, 0x0001, error),
        (OnRobot, 0x0001_0000, warning),
    ] {
        assert_eq!(profile.quality(status), expected, "{profile:?} {status:#010x}");
    }
}

#[test]
fn no_set_bit_goes_unnoticed() {
    for profile in [NetFt, Axia, OnRobot] {
        for bit in 0..32 {
            assert!(!profile.quality(1 << bit).is_empty(), "{profile:?} {bit}");
        }
    }
}
