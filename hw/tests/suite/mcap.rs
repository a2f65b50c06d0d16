//! MCAP files, as ROS and Python write them, and as they end up on a disk.

use proptest::prelude::*;
use rod_hw::recording::mcap::{McapError, McapFault, McapFile};
use rod_hw::{Wrench, WrenchSample};

/// Written by `hw/peers/mcap/run vectors`; `hw/peers/mcap/run` compares more of them with what went in.
const PLAIN: &[u8] = include_bytes!("../vectors/wrench.mcap");
const BIG_ENDIAN: &[u8] = include_bytes!("../vectors/big_endian.mcap");
const ROS1: &[u8] = include_bytes!("../vectors/ros1.mcap");
const ZSTD: &[u8] = include_bytes!("../vectors/zstd.mcap");

const TOPIC: &str = "/ft_sensor/wrench";

fn all(file: &McapFile<'_>) -> Vec<WrenchSample> {
    file.wrenches(TOPIC).unwrap().map(Result::unwrap).collect()
}

#[test]
fn wrenches_in_three_serializations() {
    for bytes in [PLAIN, BIG_ENDIAN, ROS1] {
        let file = McapFile::parse(bytes).unwrap();
        assert_eq!(file.fault(), None);
        assert_eq!(file.topics().iter().map(|topic| topic.messages).collect::<Vec<_>>(), [2, 2, 2]);

        let wrenches = all(&file);
        assert_eq!(wrenches[0].wrench, Wrench { force: [0.1, -0.2, 0.3], torque: [0.0, 0.0, 0.0125] });
        // the header's time is a microsecond before the log's
        assert_eq!((wrenches[0].raw.host_time, wrenches[0].raw.device_time), (0.0, None));
        assert_eq!((wrenches[1].raw.host_time, wrenches[1].t), (1e-3, 1e-3 - 1e-6));
    }
}

#[test]
fn wrenches_are_a_source() {
    let file = McapFile::parse(PLAIN).unwrap();
    let samples: Vec<_> = file.wrenches(TOPIC).unwrap().map(Result::unwrap).collect();
    assert_eq!((samples[1].t, samples[1].raw.host_time), (1e-3 - 1e-6, 1e-3));
    assert_eq!(samples[0].raw.channels[..], [0.1, -0.2, 0.3, 0.0, 0.0, 0.0125]);
    assert!(samples[0].quality.is_empty());
}

#[test]
fn topics_that_are_not_there_or_of_another_type() {
    let file = McapFile::parse(PLAIN).unwrap();
    let error = |found: Result<(), McapError>| found.unwrap_err().to_string();
    assert_eq!(
        error(file.wrenches("/wrench").map(drop)),
        "no topic `/wrench`; there are `/ft_sensor/wrench` of geometry_msgs/msg/WrenchStamped, `/stage` of \
         geometry_msgs/msg/PoseStamped, `/joints` of sensor_msgs/msg/JointState"
    );
    assert_eq!(
        error(file.wrenches("/stage").map(drop)),
        "topic `/stage` is of geometry_msgs/msg/PoseStamped in the encoding `cdr`, expected geometry_msgs/msg/WrenchStamped \
         in `cdr` or `ros1`"
    );
    let mut other = PLAIN.to_vec();
    replace(&mut other, b"cdr", b"jsn");
    let file = McapFile::parse(&other).unwrap();
    // the chunk's checksum is told, too, at its end
    assert!(error(file.wrenches(TOPIC).map(drop)).contains("in the encoding `jsn`"));
    let error = McapFile::parse(b"#ROSBAG V2.0").unwrap_err().to_string();
    assert!(error.starts_with("the file begins with [23, 52, 4f, 53, 42, 41, 47, 20], expected [89, 4d"), "{error}");
    let error = McapFile::read("/nowhere/scan.mcap").unwrap_err().to_string();
    assert!(error.starts_with("cannot read /nowhere/scan.mcap: "), "{error}");
}

fn replace(bytes: &mut [u8], from: &[u8], to: &[u8]) {
    let places: Vec<usize> = (0..=bytes.len() - from.len()).filter(|&at| bytes[at..].starts_with(from)).collect();
    for at in places {
        bytes[at..at + to.len()].copy_from_slice(to);
    }
}

#[test]
fn compressed() {
    let file = McapFile::parse(ZSTD).unwrap();
    if cfg!(feature = "mcap-compression") {
        assert_eq!(file.fault(), None);
        let plain = McapFile::parse(PLAIN).unwrap();
        assert_eq!(all(&file), all(&plain));
    } else {
        let fault = file.fault().unwrap().to_string();
        assert!(fault.contains("is compressed with `zstd`, expected one of: none (`lz4` and `zstd` with"), "{fault}");
        let error = file.wrenches(TOPIC).map(drop).unwrap_err().to_string();
        assert!(error.starts_with("no topic `/ft_sensor/wrench`; there are none (the chunk at byte"), "{error}");
    }
}

#[test]
fn cut_anywhere() {
    let data_end = 1 + PLAIN.windows(4).rposition(|bytes| bytes == b"yaw_").unwrap_or(0);
    let mut before = 0;
    for end in 8..PLAIN.len() {
        let file = McapFile::parse(&PLAIN[..end]).unwrap();
        let count: usize = file.topics().iter().map(|topic| topic.messages).sum();
        assert!(count >= before, "{end} bytes: {count} messages after {before}");
        before = count;
        match file.fault() {
            None => assert!(count == 6 && end > data_end),
            Some(McapFault::Truncated { end: at, .. } | McapFault::Unfinished { end: at }) => assert_eq!(*at, end),
            Some(other) => panic!("{end} bytes: {other}"),
        }
        let found = file.wrenches(TOPIC).into_iter().flatten().filter(Result::is_ok).count();
        assert_eq!(found, file.topics().first().map_or(0, |topic| topic.messages));
    }
    assert_eq!(before, 6);
}

#[test]
fn what_breaks_off_is_told_last() {
    // in the last message of the chunk
    let at = (0..PLAIN.len()).rfind(|&at| PLAIN[at..].starts_with(&0.0125_f64.to_le_bytes())).unwrap();
    let file = McapFile::parse(&PLAIN[..at + 12]).unwrap();
    let found: Vec<_> = file.wrenches(TOPIC).unwrap().collect();
    assert_eq!(found.len(), 2);
    assert!(found[0].is_ok() && matches!(found[1], Err(McapError::Fault(McapFault::Truncated { .. }))));
}

#[test]
fn bits_that_flipped_are_noticed() {
    let mut bytes = PLAIN.to_vec();
    replace(&mut bytes, &0.0125_f64.to_le_bytes(), &0.0126_f64.to_le_bytes());
    let file = McapFile::parse(&bytes).unwrap();
    let fault = file.fault().unwrap().to_string();
    assert!(fault.contains("Chunk CRC failed"), "{fault}");
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

fn record(code: u8, body: Vec<u8>) -> Vec<u8> {
    [vec![code], (body.len() as u64).to_le_bytes().to_vec(), body].concat()
}

/// A file of messages on the topic, without chunks.
fn file_of(encoding: &str, messages: &[&[u8]]) -> Vec<u8> {
    let id = 1_u16.to_le_bytes().to_vec();
    let schema = [id.clone(), text("geometry_msgs/msg/WrenchStamped"), text("ros2msg"), vec![0; 4]].concat();
    let channel = [id.clone(), id.clone(), text(TOPIC), text(encoding), vec![0; 4]].concat();
    let mut bytes = [b"\x89MCAP0\r\n".to_vec(), record(3, schema), record(4, channel)].concat();
    for message in messages {
        bytes.extend(record(5, [id.clone(), vec![0; 20], message.to_vec()].concat()));
    }
    bytes.extend(record(15, vec![0; 4]));
    bytes
}

#[test]
fn memory_for_many_channels_of_a_long_type() {
    let id = 1_u16.to_le_bytes().to_vec();
    let schema = [id.clone(), text(&"a".repeat(50_000)), text("ros2msg"), vec![0; 4]].concat();
    let mut bytes = [b"\x89MCAP0\r\n".to_vec(), record(3, schema)].concat();
    for i in 0..1000_u16 {
        let channel = [i.to_le_bytes().to_vec(), id.clone(), text(&i.to_string()), text("cdr"), vec![0; 4]].concat();
        bytes.extend(record(4, channel));
    }
    let used = allocation_counter::measure(|| {
        let file = McapFile::parse(&bytes).unwrap();
        assert_eq!(file.topics().len(), 1000);
        let error = file.wrenches(TOPIC).map(drop).unwrap_err().to_string();
        assert!(error.contains(" and 980 more ("), "{}", error.len());
    });
    assert!(used.bytes_max < 100 * bytes.len() as u64, "{} bytes for {}", used.bytes_max, bytes.len());
}

/// Stamp 1.5 s, frame `ft`, six numbers, as ROS 2 has it: the numbers begin at byte 4 + 16.
fn cdr(numbers: [f64; 6]) -> Vec<u8> {
    let head = [0, 1, 0, 0, 1, 0, 0, 0, 0, 0x65, 0xcd, 0x1d, 3, 0, 0, 0, b'f', b't', 0, 0xee];
    [head.to_vec(), numbers.iter().flat_map(|number| number.to_le_bytes()).collect()].concat()
}

#[test]
fn bytes_of_a_message() {
    let numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let good = cdr(numbers);
    let padded = [good.clone(), vec![0; 2]].concat();
    let nan = cdr([1.0, 2.0, f64::NAN, 4.0, 5.0, 6.0]);
    let mut other = good.clone();
    other[1] = 7;
    let long = [good.clone(), vec![0; 8]].concat();
    let mut name = good.clone();
    name[12..16].fill(0xff);
    let bytes = file_of("cdr", &[&good, &nan, &other, &long, &name, &good[..20], &[], &good]);
    let file = McapFile::parse(&bytes).unwrap();
    assert_eq!(file.fault(), None);
    let mut found = file.wrenches(TOPIC).unwrap();
    let first = found.next().unwrap().unwrap();
    assert_eq!((first.wrench.components(), first.raw.device_time), (numbers, Some(1.5)));
    let mut fault = || match found.next().unwrap() {
        Err(McapError::Message { what, .. }) => what,
        other => panic!("{other:?}"),
    };
    assert!(matches!(fault(), McapFault::NotFinite(value) if value.is_nan()));
    assert_eq!(fault(), McapFault::Encapsulation(7));
    assert_eq!(fault(), McapFault::Length { found: 76, expected: 68 });
    assert_eq!(fault(), McapFault::End { end: 68, at: 16 });
    assert_eq!(fault(), McapFault::End { end: 20, at: 20 });
    assert_eq!(fault(), McapFault::End { end: 0, at: 0 });
    assert_eq!(found.next().unwrap().unwrap(), first);
    assert!(found.next().is_none());
    let padded = file_of("cdr", &[&padded]);
    assert!(McapFile::parse(&padded).unwrap().wrenches(TOPIC).unwrap().all(|found| found.is_err()));
}

/// Reads everything there is to read.
fn read_all(bytes: &[u8]) {
    let Ok(file) = McapFile::parse(bytes) else { return };
    for topic in file.topics() {
        let name = &topic.name;
        let _ = file.wrenches(name).map(Iterator::count);
    }
}

proptest! {
    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read_all(&[b"\x89MCAP0\r\n", &*bytes].concat());
    }

    #[test]
    fn any_message(encoding in prop::sample::select(vec!["cdr", "ros1"]), message in prop::collection::vec(any::<u8>(), 0..120)) {
        read_all(&file_of(encoding, &[&message]));
        read_all(&file_of(encoding, &[&[&[0, 1, 0, 0], &*message].concat()]));
    }

    #[test]
    fn bytes_changed_at_some_places(
        which in 0..4_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = [PLAIN, BIG_ENDIAN, ROS1, ZSTD][which].to_vec();
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        read_all(&bytes);
    }

    #[test]
    fn large_numbers_at_some_place(
        which in 0..3_usize,
        place in any::<prop::sample::Index>(),
        value in prop::sample::select(vec![u64::MAX, 1 << 63, 1 << 62, 1 << 32, u64::from(u32::MAX), 1 << 31]),
    ) {
        let mut bytes = [PLAIN, BIG_ENDIAN, ROS1][which].to_vec();
        let place = place.index(bytes.len() - 8);
        bytes[place..place + 8].copy_from_slice(&value.to_le_bytes());
        let found = allocation_counter::measure(|| read_all(&bytes));
        prop_assert!(found.bytes_max < 10 * bytes.len() as u64, "{} bytes for {}", found.bytes_max, bytes.len());
    }
}
