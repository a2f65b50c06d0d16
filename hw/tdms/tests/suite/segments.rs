//! Segments: what they take over from those before, and how their values lie.

use crate::values;
use crate::writer::Endian::{Big, Little};
use crate::writer::{Endian, F64, I16, INTERLEAVED, Index, KEEP_LIST, NO_METADATA, Object, TEXT, segment};
use tdms_file::{DataType, TdmsError, TdmsFile, TdmsTime, TdmsValue};

/// Two channels, three values of each in a chunk.
fn two(endian: Endian) -> Vec<Object> {
    let axis = |object: Object| object.with(endian, "wf_increment", 0.5).with(endian, "wf_start_offset", 2.0);
    vec![
        Object::new("/", Index::None).with_text(endian, "name", "sweep"),
        axis(Object::new("/'m'/'a'", Index::Values(F64, 3))).with_text(endian, "unit_string", "N"),
        axis(Object::new("/'m'/'b'", Index::Values(I16, 3))),
    ]
}

fn chunk(endian: Endian, a: [f64; 3], b: [i16; 3]) -> Vec<u8> {
    [endian.f64s(&a), endian.i16s(&b)].concat()
}

#[test]
fn chunks_and_segments_that_say_nothing_new() {
    for endian in [Little, Big] {
        let twice = [chunk(endian, [1.0, 2.0, 3.0], [1, -2, 3]), chunk(endian, [4.0, 5.0, 6.0], [4, 5, 6])].concat();
        let bytes = [
            segment(endian, 0, &two(endian), &twice),
            segment(endian, NO_METADATA, &[], &chunk(endian, [7.0, 8.0, 9.0], [7, 8, 9])),
            // as before by name, of b alone
            segment(endian, 0, &[Object::new("/'m'/'b'", Index::Same)], &endian.i16s(&[10, 11, 12])),
            // the list goes on with a, which comes after b now
            segment(
                endian,
                KEEP_LIST,
                &[Object::new("/'m'/'a'", Index::Values(F64, 1))],
                &[endian.i16s(&[13, 14, 15]), endian.f64s(&[10.0])].concat(),
            ),
            // b pauses
            segment(endian, KEEP_LIST, &[Object::new("/'m'/'b'", Index::None)], &endian.f64s(&[11.0, 12.0])),
        ]
        .concat();
        let file = TdmsFile::parse(&bytes).unwrap();
        assert_eq!(file.fault(), None);
        let count = |from: i32, to: i32| (from..=to).map(f64::from).collect::<Vec<_>>();
        assert_eq!(values(&file, "m", "a"), count(1, 12));
        assert_eq!(values(&file, "m", "b"), [vec![1.0, -2.0], count(3, 15)].concat());
        let a = file.channel("m", "a").unwrap();
        assert_eq!((a.unit(), a.data_type(), a.is_daqmx(), a.len()), (Some("N"), Some(DataType::F64), false, 12));
        assert_eq!(a.time_axis().unwrap().at(3), 3.5);
        assert_eq!(file.properties()["name"], TdmsValue::Text("sweep".into()));
    }
}

#[test]
fn orders_of_bytes_can_change_from_segment_to_segment() {
    let bytes = [
        segment(Big, 0, &two(Big), &chunk(Big, [1.0, 2.0, 3.0], [1, 2, 3])),
        segment(Little, NO_METADATA, &[], &chunk(Little, [4.0, 5.0, 6.0], [4, 5, 6])),
    ]
    .concat();
    let file = TdmsFile::parse(&bytes).unwrap();
    assert_eq!(values(&file, "m", "a"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(values(&file, "m", "b"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

#[test]
fn interleaved() {
    for endian in [Little, Big] {
        let row = |i: i16| [endian.f64s(&[f64::from(i)]), endian.i16s(&[-i])].concat();
        let raw: Vec<u8> = (1..=6).flat_map(row).collect();
        let bytes = segment(endian, INTERLEAVED, &two(endian), &raw);
        let file = TdmsFile::parse(&bytes).unwrap();
        assert_eq!(values(&file, "m", "a"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(values(&file, "m", "b"), [-1.0, -2.0, -3.0, -4.0, -5.0, -6.0]);
        // cut in a row: whole rows remain
        let file = TdmsFile::parse(&bytes[..bytes.len() - 1]).unwrap();
        assert!(file.fault().is_some());
        assert_eq!((values(&file, "m", "a").len(), values(&file, "m", "b").len()), (5, 5));
    }
}

#[test]
fn texts_times_and_booleans() {
    let texts = ["", "up", "größer"];
    let ends = texts.iter().scan(0, |end, text| {
        *end += text.len() as u128;
        Some(*end)
    });
    for endian in [Little, Big] {
        let ends: Vec<u8> = ends.clone().flat_map(|end| endian.bytes(end, 4)).collect();
        let raw = [ends, texts.concat().into_bytes()].concat();
        let time = match endian {
            Little => [endian.bytes(1 << 63, 8), endian.bytes(3_000_000_000, 8)],
            Big => [endian.bytes(3_000_000_000, 8), endian.bytes(1 << 63, 8)],
        };
        let objects = [
            Object::new("/'n'/'label'", Index::Texts(3, raw.len() as u64)),
            Object::new("/'n'/'when'", Index::Values(0x44, 1)),
            Object::new("/'n'/'on'", Index::Values(0x21, 2)),
        ];
        let one = [raw, time.concat(), vec![0, 1]].concat();
        let bytes = segment(endian, 0, &objects, &[one.clone(), one].concat());
        let file = TdmsFile::parse(&bytes).unwrap();
        let label = file.channel("n", "label").unwrap();
        assert_eq!(label.texts().unwrap().collect::<Vec<_>>(), [texts, texts].concat());
        let when: Vec<_> = file.channel("n", "when").unwrap().timestamps().unwrap().collect();
        assert_eq!((when.len(), when[1].seconds, when[1].fraction), (2, 3_000_000_000, 1 << 63));
        assert_eq!(values(&file, "n", "on"), [0.0, 1.0, 0.0, 1.0]);
        let error = label.values().unwrap_err().to_string();
        assert_eq!(error, "channel `label` is of texts, expected real numbers; choose another channel");
    }
    assert_eq!(TEXT, 0x20);
}

#[test]
fn side_by_side() {
    let bytes = segment(Little, 0, &two(Little), &chunk(Little, [1.0, 2.0, 3.0], [i16::MIN, 5, 6]));
    let file = TdmsFile::parse(&bytes).unwrap();
    let samples: Vec<_> = file.rows("m", &["b", "a"], TdmsTime::Waveform).unwrap().map(Result::unwrap).collect();
    let seen: Vec<_> = samples.iter().map(|sample| (sample.time, sample.values()[0], sample.values()[1])).collect();
    assert_eq!(seen, [(2.0, -32768.0, 1.0), (2.5, 5.0, 2.0), (3.0, 6.0, 3.0)]);
    assert_eq!(samples[2].number, 2);
    // the lowest number of a channel that no card delivered is a number like any other
    assert!(!samples[0].is_at_rail);

    let by_rate: Vec<_> = file.rows("m", &["a"], TdmsTime::Rate(500.0)).unwrap().map(|s| s.unwrap().time).collect();
    assert_eq!(by_rate, [0.0, 0.002, 0.004]);
    let by_channel: Vec<_> = file.rows("m", &["b"], TdmsTime::Channel("a")).unwrap().map(|s| s.unwrap().time).collect();
    assert_eq!(by_channel, [1.0, 2.0, 3.0]);

    let error = |found: Result<_, TdmsError>| match found {
        Err(error) => error.to_string(),
        Ok::<tdms_file::TdmsRows<'_>, _>(_) => panic!("expected an error"),
    };
    assert_eq!(
        error(file.rows("m", &["Fx"], TdmsTime::Waveform)),
        "no channel `Fx` in group `m`; there are `a` in `m`, `b` in `m`"
    );
    assert_eq!(error(file.rows("m", &[], TdmsTime::Waveform)), "0 channels side by side, expected 1 to 16");
    assert!(matches!(file.rows("m", &["a"], TdmsTime::Rate(0.0)), Err(TdmsError::Rate(_))));
}

#[test]
fn no_time_or_two() {
    let objects = [
        Object::new("/'m'/'a'", Index::Values(I16, 1)).with(Little, "wf_increment", 0.5),
        Object::new("/'m'/'b'", Index::Values(I16, 1)).with(Little, "wf_increment", 0.25),
        Object::new("/'m'/'c'", Index::Values(I16, 1)).with(Little, "wf_increment", 0.0),
        Object::new("/'m'/'d'", Index::Values(F64, 1)),
    ];
    let bytes = segment(Little, 0, &objects, &[Little.i16s(&[1, 2, 3]), Little.f64s(&[f64::NAN])].concat());
    let file = TdmsFile::parse(&bytes).unwrap();
    let error = |names: &[&str]| file.rows("m", names, TdmsTime::Waveform).unwrap_err().to_string();
    assert_eq!(
        error(&["a", "b"]),
        "channel `b` starts at 0 s with steps of 0.25 s, but `a` at 0 s with 0.5 s; samples side by side need one time axis"
    );
    assert!(error(&["c"]).starts_with("channel `c` has 0 as wf_increment, expected seconds"), "{}", error(&["c"]));
    assert!(error(&["d"]).starts_with("channel `d` has nothing as wf_increment"), "{}", error(&["d"]));
    let mut samples = file.rows("m", &["a"], TdmsTime::Channel("d")).unwrap();
    assert!(matches!(samples.next(), Some(Err(TdmsError::Time { row: 0, .. }))));
    assert!(samples.next().is_none());
}

#[test]
fn what_is_missing_is_told_once_at_the_end() {
    let bytes = segment(Little, 0, &two(Little), &chunk(Little, [1.0, 2.0, 3.0], [1, 2, 3]));
    let file = TdmsFile::parse(&bytes[..bytes.len() - 3]).unwrap();
    let mut samples = file.rows("m", &["a", "b"], TdmsTime::Waveform).unwrap();
    assert_eq!(samples.next().unwrap().unwrap().values(), [1.0, 1.0]);
    let uneven = samples.next().unwrap().unwrap_err().to_string();
    assert_eq!(uneven, "channel `b` ends after 1 values, another has 3; the other channels are cut there");
    let fault = samples.next().unwrap().unwrap_err().to_string();
    assert!(fault.contains("3 bytes are missing"), "{fault}");
    assert!(samples.next().is_none());
}

#[test]
fn scales() {
    let scale = |object: Object, k: usize, kind: &str, numbers: &[(&str, f64)], inputs: &[(&str, u32)]| {
        let name = |name: &str| format!("NI_Scale[{k}]_{name}");
        let mut object = object.with_text(Little, &name("Scale_Type"), kind);
        for &(what, value) in numbers {
            object = object.with(Little, &name(what), value);
        }
        for &(what, value) in inputs {
            object = object.with_count(Little, &name(what), value);
        }
        object
    };
    let linear = [("Linear_Slope", 2.0), ("Linear_Y_Intercept", 1.0)];
    let squared =
        [("Polynomial_Coefficients[0]", 0.0), ("Polynomial_Coefficients[1]", 0.0), ("Polynomial_Coefficients[2]", 1.0)];
    let own = Object::new("/'m'/'own'", Index::Values(I16, 2));
    let own = scale(own, 0, "Linear", &linear, &[("Linear_Input_Source", u32::MAX)]);
    let own =
        scale(own, 1, "Polynomial", &squared, &[("Polynomial_Coefficients_Size", 3), ("Polynomial_Input_Source", 0)]);
    let operands = [("Subtract_Left_Operand_Input_Source", u32::MAX), ("Subtract_Right_Operand_Input_Source", 1)];
    let own = scale(own, 2, "Subtract", &[], &operands);
    let objects = [
        scale(Object::new("/'m'", Index::None), 0, "Linear", &linear, &[]),
        own,
        Object::new("/'m'/'inherited'", Index::Values(I16, 2)),
        scale(Object::new("/'m'/'circle'", Index::Values(I16, 2)), 0, "Linear", &linear, &[("Linear_Input_Source", 0)]),
        scale(Object::new("/'m'/'hot'", Index::Values(I16, 2)), 0, "Thermocouple", &[], &[]),
        scale(Object::new("/'m'/'half'", Index::Values(I16, 2)), 0, "Linear", &linear[..1], &[]),
        scale(Object::new("/'m'/'done'", Index::Values(I16, 2)), 0, "Linear", &linear, &[]).with_text(
            Little,
            "NI_Scaling_Status",
            "scaled",
        ),
        Object::new("/'m'/'many'", Index::Values(I16, 2)).with_count(Little, "NI_Number_Of_Scales", u32::MAX),
    ];
    let raw: Vec<i16> = (0..7).flat_map(|_| [3, -4]).collect();
    let bytes = segment(Little, 0, &objects, &Little.i16s(&raw));
    let file = TdmsFile::parse(&bytes).unwrap();
    // (2 x + 1)^2 - x
    assert_eq!(values(&file, "m", "own"), [46.0, 53.0]);
    assert_eq!(values(&file, "m", "inherited"), [7.0, -7.0]);
    assert_eq!(values(&file, "m", "done"), [3.0, -4.0]);
    let error = |name: &str| file.channel("m", name).unwrap().values().unwrap_err().to_string();
    assert_eq!(
        error("hot"),
        "channel `hot`: scale 0 is of type `Thermocouple`, expected one of Linear, Polynomial, Add, Subtract, AdvancedAPI; \
         its raw values can be read"
    );
    assert!(error("circle").contains("takes scale 0, which does not come before it"));
    assert!(error("half").contains("without a number NI_Scale[0]_Linear_Y_Intercept"));
    assert!(error("many").contains("most are not described"));
    assert_eq!(file.channel("m", "hot").unwrap().raw().unwrap().collect::<Vec<_>>(), [3.0, -4.0]);
}
