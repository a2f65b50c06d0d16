//! Records of IIO devices: any types, by their texts and by their fields, and any bytes.
#![no_main]

use allocation_counter::measure;
use rod_hw::{IioRecord, ScanType};
use rod_hw_fuzz::Choices;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let used = measure(|| {
        let mut parts = data.split(|byte| *byte == b'\n');
        let mut elements = [ScanType::TIMESTAMP; 18];
        let mut count = 0;
        while let Some(found) = parts.next().and_then(|text| ScanType::parse(str::from_utf8(text).ok()?).ok()) {
            assert!(found.bits + found.shift <= found.storage_bits && found.size() <= 8);
            if let Some(place) = elements.get_mut(count) {
                *place = found;
                count += 1;
            }
        }
        records(&elements[..count], data);
        let mut choices = Choices(data);
        let count = choices.one([1, 2, 16, 18]);
        for element in &mut elements[..count] {
            let number = |choices: &mut Choices<'_>| match choices.byte() {
                0xff => choices.word(),
                byte => u32::from(byte),
            };
            *element = ScanType {
                is_big_endian: choices.one([false, true]),
                is_signed: choices.one([false, true]),
                bits: number(&mut choices),
                storage_bits: number(&mut choices),
                repeat: number(&mut choices),
                shift: number(&mut choices),
            };
        }
        records(&elements[..count], data);
    });
    assert_eq!(used.count_total, 0);
});

fn records(elements: &[ScanType], data: &[u8]) {
    for element in elements {
        let _ = element.value(data);
    }
    for has_time in [false, true] {
        let Ok(record) = IioRecord::new(elements, has_time) else { continue };
        let found = record.read(data);
        assert!(found.is_none() || data.len() >= record.size());
        if let Some((values, time)) = found {
            assert!(!values.is_empty() && time.is_some() == has_time);
        }
    }
}
