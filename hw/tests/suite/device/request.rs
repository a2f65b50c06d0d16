//! Requests of RDT.

use rod_hw::device::rdt::*;

#[test]
fn bytes_there_and_back() {
    for (request, bytes) in [
        (RdtRequest::Stop, [0x12, 0x34, 0, 0, 0, 0, 0, 0]),
        // the count in the order of its bytes, which a public driver has wrong
        (RdtRequest::Start { count: 0x0102_0304 }, [0x12, 0x34, 0, 2, 1, 2, 3, 4]),
    ] {
        assert_eq!(request.to_bytes(), bytes, "{request:?}");
        assert_eq!(RdtRequest::from_bytes(&bytes), Some(request));
    }
    for bytes in [&[0x12_u8, 0x34, 0, 9, 0, 0, 0, 0][..], &[0x12, 0x34, 0, 3, 0, 0, 0, 7], &[0x12, 0x34]] {
        assert_eq!(RdtRequest::from_bytes(bytes), None);
    }
}
