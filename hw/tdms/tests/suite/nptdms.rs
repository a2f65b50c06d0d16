//! Files that npTDMS wrote: `hw/tdms/peers/vectors.py`. `hw/tdms/peers/run` compares more of them with what npTDMS reads.

use crate::values;
use tdms_file::{TdmsFile, TdmsTime, TdmsValue};

#[test]
fn waveforms() {
    let file = TdmsFile::parse(include_bytes!("../vectors/waveforms.tdms")).unwrap();
    assert_eq!(file.fault(), None);
    assert_eq!(file.properties()["operator"], TdmsValue::Text("Müller".into()));
    assert_eq!(file.properties()["run"].number(), Some(7.0));
    let channels: Vec<_> = file.group("Measured").unwrap().channels().collect();
    assert_eq!(channels.iter().map(|channel| channel.name()).collect::<Vec<_>>(), ["Fx", "Fy"]);
    assert_eq!(channels[0].unit(), Some("mN"));
    assert_eq!(values(&file, "Measured", "Fy"), [0.0, -0.125, -0.25, 100.0, 99.875, 99.75]);
    let axis = channels[1].time_axis().unwrap();
    // 2021-02-28 12:00:00.25 UTC; npTDMS goes through microseconds
    assert!((axis.start.unwrap().unix_seconds() - 1_614_513_600.25).abs() < 1e-6);
    assert_eq!((axis.offset, axis.increment), (0.5, 2e-3));
    let samples = file.rows("Measured", &["Fy", "Fx"], TdmsTime::Waveform).unwrap();
    let last = samples.map(Result::unwrap).last().unwrap();
    assert_eq!((last.time, last.values()), (0.5 + 5.0 * 2e-3, &[99.75, 102.0][..]));
}

#[test]
fn kinds() {
    let file = TdmsFile::parse(include_bytes!("../vectors/kinds.tdms")).unwrap();
    assert_eq!(file.fault(), None);
    assert_eq!(values(&file, "g", "counts"), [-16385.0, -1.0, 16382.5]);
    assert_eq!(values(&file, "g", "single"), [f64::from(0.1_f32), f64::INFINITY]);
    assert_eq!(values(&file, "g", "large"), [2.0_f64.powi(64)]);
    assert_eq!(file.channel("g", "label").unwrap().texts().unwrap().collect::<Vec<_>>(), ["", "größer"]);
    let when = file.channel("it's", "when").unwrap().timestamps().unwrap().next().unwrap();
    assert_eq!(when.seconds, 2_082_844_800 + 1_614_513_600);
}
