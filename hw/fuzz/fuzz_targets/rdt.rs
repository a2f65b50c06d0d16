//! A sensor that speaks RDT: any datagrams at any times, requests in between.
#![no_main]

use allocation_counter::measure;
use rod_hw::Protocol;
use rod_hw::device::rdt::{Rdt, RdtProfile, RdtRecord, RdtRequest, RdtSettings};
use rod_hw_fuzz::Choices;

/// Records of a datagram at most.
const MOST: usize = 8;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    if let Some(request) = RdtRequest::from_bytes(data.get(..8).unwrap_or(data)) {
        assert_eq!(RdtRequest::from_bytes(&request.to_bytes()), Some(request));
    }
    let settings = RdtSettings {
        clock_rate: choices.one([None, Some(7000.0), Some(1.0), Some(0.0), Some(-1.0), Some(f64::INFINITY)]),
        silence: choices.one([1.0, 0.0, f64::NAN]),
        ..RdtSettings::new(choices.one([RdtProfile::NetFt, RdtProfile::Axia, RdtProfile::OnRobot]))
    };
    let used = measure(|| run(settings, choices));
    assert_eq!(used.count_total, 0);
});

/// A datagram, and how many of its bytes there are.
struct Datagram([u8; MOST * RdtRecord::BYTES], usize);

/// Records that follow those before, or bytes as they come.
fn datagram(choices: &mut Choices<'_>, last: &mut RdtRecord) -> Datagram {
    let mut datagram = Datagram([0; MOST * RdtRecord::BYTES], 0);
    let kind = choices.byte();
    if kind == 0xff {
        let length = usize::from(choices.byte());
        let bytes = choices.take(length.min(datagram.0.len()));
        datagram.0[..bytes.len()].copy_from_slice(bytes);
        datagram.1 = bytes.len();
        return datagram;
    }
    let count = 1 + usize::from(kind) % MOST;
    for place in datagram.0.chunks_exact_mut(RdtRecord::BYTES).take(count) {
        let step = |choices: &mut Choices<'_>| match choices.byte() {
            0x80 => choices.word(),
            byte => i32::from(i8::from_be_bytes([byte])).cast_unsigned(),
        };
        last.packet = last.packet.wrapping_add(step(choices));
        last.sample = last.sample.wrapping_add(step(choices));
        last.status = choices.one([0, 0, 0, 0x8001_0000, 0x8002_0000, 0xC000_0000, 0x0010, 0xFFFF_FFFF]);
        last.counts = [i32::MIN, -1, 0, 1, i32::MAX, last.sample.cast_signed()];
        place.copy_from_slice(&last.to_bytes());
    }
    datagram.1 = count * RdtRecord::BYTES;
    datagram
}

fn run(settings: RdtSettings, mut choices: Choices<'_>) {
    let mut rdt = Rdt::new(settings);
    let (mut last, mut now) = (RdtRecord::default(), 0.0);
    let (mut records, mut malformed) = (0, 0);
    let mut before: Option<(u64, Option<f64>)> = None;
    while !choices.is_empty() {
        now += choices.wait();
        match choices.byte() % 8 {
            0 => drop(rdt.request(now)),
            1 => rdt.reset(),
            _ => {
                let Datagram(bytes, length) = datagram(&mut choices, &mut last);
                let mut bytes = &bytes[..length];
                let is_whole = length == RdtRecord::BYTES;
                let mut told = 0;
                while let Some(one) = rdt.decode(&mut bytes, now) {
                    told += 1;
                    assert!(told <= length, "at most one thing for each byte");
                    assert_eq!(one.is_ok(), is_whole);
                    let Ok(sample) = one else { continue };
                    assert!(sample.channels.len() == 6 && sample.channels.iter().all(|value| value.is_finite()));
                    let number = sample.sequence.expect("it is numbered");
                    if let Some((earlier, time)) = before {
                        assert!(number > earlier, "{number} after {earlier}");
                        assert!(sample.device_time >= time, "{:?} after {time:?}", sample.device_time);
                    }
                    before = Some((number, sample.device_time));
                }
                assert!(bytes.is_empty(), "all is consumed when there is nothing to tell");
                if is_whole {
                    records += 1;
                } else if length > 0 {
                    malformed += 1;
                }
                let counters = rdt.counters();
                assert_eq!(counters.samples + counters.repeated + counters.reordered, records);
                assert_eq!(counters.malformed, malformed);
            }
        }
    }
}
