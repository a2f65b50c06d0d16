//! The scaling of an RDT sensor, over TCP.

use rod_hw::device::rdt::*;
use rod_hw::{Calibration, Channels, RawSample};
use std::io::{Read, Write};
use std::net::TcpListener;
use std::thread;
use std::time::Duration;

fn answer(force: u8, torque: u8, counts: [u32; 2]) -> Vec<u8> {
    let mut bytes = vec![0x12, 0x34, force, torque];
    bytes.extend(counts.iter().flat_map(|n| n.to_be_bytes()));
    bytes.extend([0, 1].repeat(6));
    bytes
}

#[test]
fn units_of_all_codes() {
    for (code, force, torque) in [
        (1, 4.448_221_615_260_5, 0.112_984_829_027_616_7),
        (2, 1.0, 1.355_817_948_331_400_4),
        (3, 4_448.221_615_260_5, 1.0),
        (4, 1000.0, 1e-3),
        (5, 9.806_65, 0.098_066_5),
        (6, 0.009_806_65, 1000.0),
    ] {
        let scaling = RdtScaling::from_bytes(&answer(code, code, [100, 1000])).unwrap();
        let raw = RawSample::new(0.0, Channels::from([1.0; 6]));
        let factors = scaling.calibration::<f64>().unwrap().wrench(&raw).unwrap().wrench.components();
        assert!((factors[2] * 100.0 / force - 1.0).abs() < 1e-12, "{code}: {factors:?}");
        assert!((factors[3] * 1000.0 / torque - 1.0).abs() < 1e-12, "{code}: {factors:?}");
        assert_eq!(scaling.to_bytes()[..], answer(code, code, [100, 1000]));
    }
}

#[test]
fn refused_with_a_remedy() {
    for (bytes, message) in [
        (
            answer(0, 3, [1, 1]),
            "the sensor sends counts without a unit of force (code 0); set N and N m on its web page",
        ),
        (answer(2, 7, [1, 1]), "unit of torque with code 7, expected 1 to 6 (force: "),
        (answer(2, 3, [0, 1]), "0 counts per unit of force, expected more than 0; set "),
        (answer(2, 3, [1, 0]), "0 counts per unit of torque, expected more than 0; set "),
        (
            answer(2, 3, [1, 1])[..23].into(),
            "the scaling has 23 bytes and begins with 0x1234, expected 24 and 0x1234; is",
        ),
        (vec![], "the scaling has 0 bytes and begins with 0x0000, expected 24"),
    ] {
        let error = RdtScaling::from_bytes(&bytes).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn no_answer_and_half_of_one() {
    let wait = Duration::from_millis(200);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host = listener.local_addr().unwrap().to_string();
    let server = thread::spawn(move || {
        let mut silent = listener.accept().unwrap().0;
        let _ = silent.read(&mut [0; 20]);
        let mut short = listener.accept().unwrap().0;
        let mut request = [9; 20];
        short.read_exact(&mut request).unwrap();
        short.write_all(&answer(2, 3, [1, 1])[..10]).unwrap();
        drop((silent, short));
        request
    });
    let error = read_scaling(&host, wait).unwrap_err().to_string();
    assert!(error.starts_with(&format!("0 of 24 bytes with the scaling came from `{host}` (")), "{error}");
    let error = read_scaling(&host, Duration::from_secs(5)).unwrap_err().to_string();
    assert!(error.starts_with("10 of 24 bytes with the scaling came from"), "{error}");
    let request = server.join().unwrap();
    assert_eq!(request[..2], [1, 0]);
    // nobody listens any more
    let error = read_scaling(&host, wait).unwrap_err().to_string();
    assert!(error.starts_with(&format!("no TCP connection to `{host}` (")), "{error}");
    assert!(matches!(read_scaling("nonsense", wait), Err(RdtError::Connect { .. })));
}

proptest::proptest! {
    #[test]
    fn any_bytes(bytes: Vec<u8>) {
        let _ = RdtScaling::from_bytes(&bytes);
    }
}
