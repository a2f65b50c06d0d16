//! Files that are not what they should be.

use crate::writer::Endian::{Big, Little};
use crate::writer::{DAQMX, F64, I16, INTERLEAVED, Index, KEEP_LIST, NO_METADATA, Object, segment};
use proptest::prelude::*;
use tdms_file::{TdmsError, TdmsFault, TdmsFile, TdmsTime};

/// A bit of everything.
fn sound() -> Vec<u8> {
    let plain = |count| {
        [
            Object::new("/", Index::None).with_text(Little, "name", "sweep"),
            Object::new("/'m'/'a'", Index::Values(F64, count)).with(Little, "wf_increment", 0.5),
            Object::new("/'m'/'b'", Index::Values(I16, count))
                .with_text(Little, "NI_Scale[0]_Scale_Type", "Linear")
                .with(Little, "NI_Scale[0]_Linear_Slope", 2.0)
                .with(Little, "NI_Scale[0]_Linear_Y_Intercept", 1.0),
        ]
    };
    let text = Object::new("/'m'/'t'", Index::Texts(2, 13));
    let card = |place, id| Index::Daqmx(false, 2, vec![[3, 0, place, id]], vec![4]);
    let cards = [Object::new("/'d'/'x'", card(0, 0)), Object::new("/'d'/'y'", card(2, 0))];
    [
        segment(Little, 0, &plain(3), &[7; 60]),
        segment(Little, NO_METADATA, &[], &[8; 35]),
        segment(Little, INTERLEAVED, &plain(3)[1..], &[9; 50]),
        segment(Big, KEEP_LIST, &[Object::new("/'m'/'b'", Index::None)], &[10; 48]),
        segment(Little, 0, &[text], b"\x02\0\0\0\x05\0\0\0hallo"),
        segment(Little, DAQMX, &cards, &[11; 23]),
    ]
    .concat()
}

/// Reads everything there is to read; how many values that were.
fn read_all(bytes: &[u8]) -> usize {
    let Ok(file) = TdmsFile::parse(bytes) else { return 0 };
    let mut count = 0;
    for channel in file.channels() {
        count += channel.raw().map_or(0, Iterator::count);
        count += channel.values().map_or(0, Iterator::count);
        count += channel.texts().map_or(0, |texts| texts.map(|text| text.len()).sum());
        count += channel.timestamps().map_or(0, Iterator::count);
        let _ = (channel.time_axis(), channel.unit());
        for time in [TdmsTime::Waveform, TdmsTime::Channel(channel.name()), TdmsTime::Rate(1.0)] {
            count += file.rows(channel.group(), &[channel.name()], time).map_or(0, |s| s.filter(Result::is_ok).count());
        }
    }
    count
}

/// Most bytes of memory that reading took at once.
fn memory(bytes: &[u8]) -> u64 {
    allocation_counter::measure(|| {
        std::hint::black_box(read_all(bytes));
    })
    .bytes_max
}

/// Memory per byte of a file, whatever is in it, beside what even an empty one takes.
const PER_BYTE: u64 = 150;
const FREE: u64 = 10_000;

proptest! {
    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        read_all(&[b"TDSm", &*bytes].concat());
    }

    #[test]
    fn bytes_changed_at_some_places(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut bytes = sound();
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        prop_assert!(memory(&bytes) < PER_BYTE * bytes.len() as u64 + FREE);
    }

    #[test]
    fn large_numbers_at_some_place(place in any::<prop::sample::Index>(), value in prop::sample::select(vec![
        u64::MAX, u64::MAX - 1, 1 << 63, (1 << 63) - 1, 1 << 61, 1 << 32, u64::from(u32::MAX), 1 << 31, 0,
    ])) {
        let mut bytes = sound();
        let place = place.index(bytes.len() - 8);
        bytes[place..place + 8].copy_from_slice(&value.to_le_bytes());
        prop_assert!(memory(&bytes) < PER_BYTE * bytes.len() as u64 + FREE);
    }
}

#[test]
fn cut_anywhere() {
    let whole = sound();
    assert!(TdmsFile::parse(&whole).unwrap().fault().is_none());
    let mut before = 0;
    for end in 4..whole.len() {
        let bytes = &whole[..end];
        let count = read_all(bytes);
        assert!(count >= before, "{end} bytes: {count} values after {before}");
        before = count;
        let starts: Vec<usize> = whole.windows(4).enumerate().filter(|(_, w)| w == b"TDSm").map(|(at, _)| at).collect();
        let fault = TdmsFile::parse(bytes).unwrap().fault().cloned();
        assert_eq!(fault.is_none(), starts.contains(&end), "{end}: {fault:?}");
        let last = *starts.iter().rfind(|&&at| at < end).unwrap();
        if let Some(fault) = fault {
            assert!(
                matches!(fault, TdmsFault::Truncated { segment, end: at, .. } if segment == last && at == end),
                "{fault}"
            );
        }
    }
}

#[test]
fn never_finished() {
    let mut bytes =
        segment(Little, 0, &[Object::new("/'m'/'a'", Index::Values(F64, 4))], &Little.f64s(&[1.0, 2.0, 3.0]));
    bytes[12..20].fill(0xff);
    let file = TdmsFile::parse(&bytes).unwrap();
    assert_eq!(crate::values(&file, "m", "a"), [1.0, 2.0, 3.0]);
    assert_eq!(file.fault(), Some(&TdmsFault::Unfinished { segment: 0, end: bytes.len() }));
    let mut samples = file.rows("m", &["a"], TdmsTime::Rate(1.0)).unwrap().skip(3);
    let fault = samples.next().unwrap().unwrap_err();
    assert!(matches!(fault, TdmsError::Fault(TdmsFault::Unfinished { .. })), "{fault}");
}

#[test]
fn counts_beyond_the_file_take_no_memory() {
    let hostile = [
        Index::Values(F64, u64::MAX),
        Index::Texts(u64::MAX, u64::MAX),
        Index::Texts(u64::from(u32::MAX), 8),
        Index::Daqmx(false, u64::MAX, vec![[3, 0, 0, 0]], vec![u32::MAX]),
    ];
    for index in hostile {
        let bytes = segment(Little, 0, &[Object::new("/'m'/'a'", index)], &[1; 8]);
        assert!(memory(&bytes) < PER_BYTE * bytes.len() as u64 + FREE);
    }
    // counts of objects, of properties, of scalers, of widths, lengths of texts
    let sound = segment(
        Little,
        DAQMX,
        &[Object::new("/'m'/'a'", Index::Daqmx(false, 1, vec![[3, 0, 0, 0]], vec![2]))],
        &[1; 2],
    );
    for place in 28..sound.len() - 4 {
        let mut bytes = sound.clone();
        bytes[place..place + 4].fill(0xff);
        assert!(memory(&bytes) < PER_BYTE * bytes.len() as u64 + FREE, "byte {place}");
    }
}

#[test]
fn texts_that_share_their_bytes() {
    let ends: Vec<u8> = (0..100_u32).flat_map(|i| (if i % 2 == 0 { 100 } else { 0_u32 }).to_le_bytes()).collect();
    let raw = [ends, vec![b'x'; 100]].concat();
    let bytes = segment(Little, 0, &[Object::new("/'m'/'t'", Index::Texts(100, raw.len() as u64))], &raw);
    let file = TdmsFile::parse(&bytes).unwrap();
    let texts: Vec<String> = file.channel("m", "t").unwrap().texts().unwrap().collect();
    assert_eq!((texts.len(), texts[0].len(), texts.concat().len()), (100, 100, 100));
}

/// Thousands of digital lines, all the same bit.
fn lines() -> Vec<Object> {
    let path = |i: usize| -> &'static str { Box::leak(format!("/'d'/'{i}'").into_boxed_str()) };
    (0..3000).map(|i| Object::new(path(i), Index::Daqmx(true, 1, vec![[0, 0, 0, 0]], vec![1]))).collect()
}

#[test]
fn objects_that_share_their_bytes_take_no_square_of_memory() {
    let mut bytes = segment(Little, DAQMX, &lines(), &[1; 375]);
    for _ in 0..6000 {
        // as before, on a single byte
        bytes.extend(segment(Little, NO_METADATA | DAQMX, &[], &[1]));
    }
    let found = allocation_counter::measure(|| {
        let file = TdmsFile::parse(&bytes).unwrap();
        let what = "more channels than bits";
        let fault = file.fault();
        assert!(matches!(fault, Some(TdmsFault::Layout { what: found, .. }) if *found == what), "{fault:?}");
        assert_eq!(file.channels().map(|channel| channel.len()).sum::<usize>(), 3000 * 375);
    });
    assert!(found.bytes_max < PER_BYTE * bytes.len() as u64, "{} bytes for {}", found.bytes_max, bytes.len());
}

#[test]
fn lists_used_again_and_again_take_no_square_of_time() {
    let mut objects = lines();
    objects.iter_mut().for_each(|object| object.index = Index::None);
    objects.push(Object::new("/'d'/'a'", Index::Values(I16, 1)));
    let mut bytes = segment(Little, 0, &objects, &[1; 2]);
    for _ in 0..20_000 {
        bytes.extend(segment(Little, NO_METADATA, &[], &[1; 2]));
    }
    let file = TdmsFile::parse(&bytes).unwrap();
    let fault = file.fault();
    let what = "the file has far more objects than data";
    assert!(matches!(fault, Some(TdmsFault::Layout { what: found, .. }) if *found == what), "{fault:?}");
}

#[test]
fn what_is_wrong_is_told() {
    let fault = |objects: &[Object], raw: &[u8], flags| {
        TdmsFile::parse(&segment(Little, flags, objects, raw)).unwrap().fault().expect("a fault").to_string()
    };
    let a = |index| Object::new("/'m'/'a'", index);
    for (found, expected) in [
        (fault(&[a(Index::Same)], &[], 0), "byte 44: the raw data index is 0x0, expected one of its own"),
        (fault(&[a(Index::Values(11, 1))], &[0; 8], 0), "byte 48: the type of a channel is 0xb, expected 1 to 10"),
        (fault(&[Object::new("m", Index::None)], &[], 0), "byte 32: the object path `m` is not of the form"),
        (fault(&[], &[0; 8], 0), "the segment at byte 0: there are raw data, but no object that has values"),
        (fault(&[], &[0; 8], NO_METADATA), "the segment at byte 0: there are raw data, but no object that has values"),
        (
            fault(&[a(Index::Values(I16, 1)), Object::new("/'m'/'b'", Index::Values(I16, 2))], &[0; 6], INTERLEAVED),
            "the segment at byte 0: interleaved channels of different lengths",
        ),
        (
            fault(
                &[a(Index::Values(I16, 1)), Object::new("/'m'/'b'", Index::Daqmx(false, 1, vec![], vec![2]))],
                &[0; 6],
                0,
            ),
            "the segment at byte 0: data as a card delivers them are mixed with others",
        ),
    ] {
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    let mut bytes = segment(Little, 0, &[a(Index::Values(I16, 1))], &[1, 0]);
    bytes.extend(b"and then something else, which is no segment");
    let file = TdmsFile::parse(&bytes).unwrap();
    assert_eq!(crate::values(&file, "m", "a"), [1.0]);
    assert!(matches!(file.fault(), Some(TdmsFault::Tag { found: [b'a', b'n', b'd', b' '], .. })));

    let error = TdmsFile::parse(b"TDSh").unwrap_err().to_string();
    assert!(error.contains("`TDSh` begins a .tdms_index"), "{error}");
    let error = TdmsFile::read("/nowhere/scan.tdms").unwrap_err().to_string();
    assert!(error.starts_with("cannot read /nowhere/scan.tdms: "), "{error}");
}
