//! Raw data as cards deliver them.

use crate::values;
use crate::writer::Endian::{Big, Little};
use crate::writer::{DAQMX, Endian, Index, Object, segment};
use tdms_file::{DataType, TdmsFault, TdmsFile, TdmsTime};

/// Codes of DAQmx.
const U8: u32 = 0;
const I16: u32 = 3;
const I32: u32 = 5;

/// A count of 16 bits with the scale of a card of 20 V.
fn volts(endian: Endian, path: &'static str, count: u64, scaler: [u32; 4], widths: &[u32]) -> Object {
    let index = Index::Daqmx(false, count, vec![scaler], widths.to_vec());
    Object::new(path, index)
        .with_count(endian, "NI_Number_Of_Scales", 2)
        .with_text(endian, "NI_Scale[1]_Scale_Type", "Linear")
        .with(endian, "NI_Scale[1]_Linear_Slope", 0.5)
        .with(endian, "NI_Scale[1]_Linear_Y_Intercept", 0.25)
        .with_count(endian, "NI_Scale[1]_Linear_Input_Source", 0)
        .with(endian, "wf_increment", 0.002)
}

#[test]
fn counts_of_one_card() {
    for endian in [Little, Big] {
        let objects =
            [volts(endian, "/'d'/'a'", 2, [I16, 0, 2, 0], &[4]), volts(endian, "/'d'/'b'", 2, [I16, 0, 0, 0], &[4])];
        // b, a in each row; two chunks and a half
        let raw = endian.i16s(&[1, -1, 2, -2, 3, i16::MIN, i16::MAX, -4, 5, -5]);
        let bytes = segment(endian, DAQMX, &objects, &raw);
        let file = TdmsFile::parse(&bytes).unwrap();
        let a = file.channel("d", "a").unwrap();
        assert!(a.is_daqmx() && a.data_type() == Some(DataType::I16));
        assert_eq!(a.raw().unwrap().collect::<Vec<_>>(), [-1.0, -2.0, -32768.0, -4.0, -5.0]);
        assert_eq!(values(&file, "d", "a"), [-0.25, -0.75, -16383.75, -1.75, -2.25]);
        assert_eq!(values(&file, "d", "b"), [0.75, 1.25, 1.75, 16383.75, 2.75]);
        // the ends of the card's range
        let samples = file.rows("d", &["a", "b"], TdmsTime::Waveform).unwrap();
        let at_rail: Vec<bool> = samples.map(|sample| sample.unwrap().is_at_rail).collect();
        assert_eq!(at_rail, [false, false, true, true, false]);
    }
}

#[test]
fn two_cards_and_a_file_cut_in_the_second() {
    let widths = [2, 5];
    let objects =
        [volts(Little, "/'d'/'a'", 3, [I16, 0, 0, 0], &widths), volts(Little, "/'d'/'b'", 2, [I32, 1, 1, 0], &widths)];
    let second = |value: i32| [vec![0xee], value.to_le_bytes().to_vec()].concat();
    let raw = [Little.i16s(&[1, 2, 3]), second(10), second(-20)].concat();
    let bytes = segment(Little, DAQMX, &objects, &[raw.clone(), raw].concat());
    let of = |bytes: &[u8]| {
        let file = TdmsFile::parse(bytes).unwrap();
        let raw = |name: &str| file.channel("d", name).unwrap().raw().unwrap().collect::<Vec<_>>();
        (raw("a"), raw("b"))
    };
    assert_eq!(of(&bytes), (vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0], vec![10.0, -20.0, 10.0, -20.0]));
    assert_eq!(of(&bytes[..bytes.len() - 1]), (vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0], vec![10.0, -20.0, 10.0]));
    assert_eq!(of(&bytes[..bytes.len() - 11]), (vec![1.0, 2.0, 3.0, 1.0, 2.0], vec![10.0, -20.0]));
}

#[test]
fn lines_of_a_digital_port() {
    let line = |path, bit| Object::new(path, Index::Daqmx(true, 4, vec![[U8, 0, bit, 0]], vec![2]));
    let objects = [line("/'d'/'l0'", 0), line("/'d'/'l7'", 7), line("/'d'/'l9'", 9)];
    let bytes = segment(Little, DAQMX, &objects, &[1, 0, 0x80, 2, 0x81, 0xfd, 0, 2]);
    let file = TdmsFile::parse(&bytes).unwrap();
    assert_eq!(values(&file, "d", "l0"), [1.0, 0.0, 1.0, 0.0]);
    assert_eq!(values(&file, "d", "l7"), [0.0, 1.0, 1.0, 0.0]);
    assert_eq!(values(&file, "d", "l9"), [0.0, 1.0, 0.0, 1.0]);
}

#[test]
fn two_scalers_of_a_channel() {
    let index = Index::Daqmx(false, 2, vec![[I16, 0, 0, 0], [I16, 0, 2, 1]], vec![4]);
    let object = Object::new("/'d'/'sum'", index)
        .with_count(Little, "NI_Number_Of_Scales", 3)
        .with_text(Little, "NI_Scale[2]_Scale_Type", "Add")
        .with_count(Little, "NI_Scale[2]_Add_Left_Operand_Input_Source", 0)
        .with_count(Little, "NI_Scale[2]_Add_Right_Operand_Input_Source", 1);
    let bytes = segment(Little, DAQMX, &[object], &Little.i16s(&[1, 10, 2, 20]));
    let file = TdmsFile::parse(&bytes).unwrap();
    assert_eq!(values(&file, "d", "sum"), [11.0, 22.0]);
}

#[test]
fn scalers_that_do_not_fit() {
    let fault = |index: Index| {
        let bytes = segment(Little, DAQMX, &[Object::new("/'d'/'a'", index)], &[0; 8]);
        TdmsFile::parse(&bytes).unwrap().fault().cloned().expect("a fault")
    };
    let outside = "a scaler lies outside of the card's rows";
    for scaler in [[I16, 0, 3, 0], [I16, 1, 0, 0], [I16, u32::MAX, u32::MAX, 0]] {
        let found = fault(Index::Daqmx(false, 1, vec![scaler], vec![4]));
        assert_eq!(found, TdmsFault::Layout { segment: 0, what: outside });
    }
    let unknown = fault(Index::Daqmx(false, 1, vec![[10, 0, 0, 0]], vec![4]));
    assert!(matches!(unknown, TdmsFault::Unknown { what: "the type of a DAQmx scaler", found: 10, .. }), "{unknown}");
    let twice = fault(Index::Daqmx(false, 1, vec![[I16, 0, 0, 0]; 2], vec![4]));
    assert!(matches!(twice, TdmsFault::Unknown { what: "the number of a DAQmx scaler", .. }), "{twice}");
    let many = fault(Index::Daqmx(false, 1, vec![[I16, 0, 0, 0]; 65], vec![4]));
    assert!(matches!(many, TdmsFault::Unknown { found: 65, .. }), "{many}");
}
