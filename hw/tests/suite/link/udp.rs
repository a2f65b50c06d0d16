//! Datagrams to and from a device.

use rod_hw::*;
use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

const SOON: Duration = Duration::from_secs(5);

fn pair() -> (UdpSocket, Udp, SocketAddr) {
    let device = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut udp = Udp::connect(&device.local_addr().unwrap().to_string()).unwrap();
    udp.send(&[1]).unwrap();
    let (_, host) = device.recv_from(&mut [0]).unwrap();
    (device, udp, host)
}

#[test]
fn too_long_empty_and_foreign_datagrams() {
    let (device, mut udp, host) = pair();
    let other = UdpSocket::bind("127.0.0.1:0").unwrap();
    other.send_to(&[9; 4], host).unwrap();
    device.send_to(&[], host).unwrap();
    device.send_to(&[7; 100], host).unwrap();
    let mut buffer = [0; 36];
    assert_eq!(udp.receive(&mut buffer, SOON).unwrap(), Some(100));
    assert_eq!((buffer, udp.foreign()), ([7; 36], 2));
}

#[test]
fn nothing_comes() {
    let (_device, mut udp, _) = pair();
    assert_eq!(udp.receive(&mut [0; 36], Duration::ZERO).unwrap(), None);
    assert_eq!(udp.receive(&mut [0; 36], Duration::from_millis(20)).unwrap(), None);
}

#[test]
fn a_new_socket() {
    let (device, mut udp, host) = pair();
    udp.reconnect().unwrap();
    udp.send(&[2]).unwrap();
    let (_, again) = device.recv_from(&mut [0]).unwrap();
    assert_ne!(host, again);
    device.send_to(&[3], again).unwrap();
    assert_eq!(udp.receive(&mut [0], SOON).unwrap(), Some(1));
}

#[test]
fn names() {
    assert!(Udp::connect("localhost:49152").unwrap().peer().is_ipv4());
    assert!(Udp::connect("[::1]:49152").is_ok_and(|udp| udp.peer().is_ipv6()) || UdpSocket::bind("[::1]:0").is_err());
    let error = Udp::connect("192.168.1.1").unwrap_err().to_string();
    assert!(error.starts_with("`192.168.1.1` has no address ("), "{error}");
    assert!(error.contains("expected host:port like `192.168.1.1:49152`"), "{error}");
}
