//! Records of RDT.

use proptest::prelude::*;
use rod_hw::device::rdt::*;

#[test]
fn known_record() {
    let text = "00000001 00000064 00000000 00000064 ffffff38 0000012c 0000000a ffffffec 0000001e";
    let hex: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
    let bytes: Vec<u8> =
        hex.chunks(2).map(|two| u8::from_str_radix(&two.iter().collect::<String>(), 16).unwrap()).collect();
    let record = RdtRecord { packet: 1, sample: 100, status: 0, counts: [100, -200, 300, 10, -20, 30] };
    assert_eq!(RdtRecord::from_bytes(bytes[..].try_into().unwrap()), record);
    assert_eq!(record.to_bytes()[..], bytes);
}

proptest! {
    #[test]
    fn bytes_there_and_back(bytes: [u8; 36]) {
        prop_assert_eq!(RdtRecord::from_bytes(&bytes).to_bytes(), bytes);
    }
}
