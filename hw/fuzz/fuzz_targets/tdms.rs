//! TDMS files: any bytes.
#![no_main]

use tdms_file::{TdmsFile, TdmsTime};
use rod_hw_fuzz::bounded;

/// Values that are read at most; the others are read the same way.
const MOST: usize = 10_000;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    // of a card each bit can be a channel, whose place is noted
    let file = match bounded(data.len(), 2048, || TdmsFile::parse(data)) {
        Ok(file) => file,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    if let Some(fault) = file.fault() {
        assert!(!fault.to_string().is_empty());
    }
    let _ = bounded(data.len(), 2048, || file.channel("no", "such").is_err());
    let mut left = MOST;
    for channel in file.channels() {
        assert!(channel.len() <= data.len());
        let _ = (channel.unit(), channel.time_axis(), channel.is_daqmx(), channel.is_empty());
        bounded(data.len(), 64, || {
            for values in [channel.raw(), channel.values()] {
                match values {
                    Ok(values) => left -= values.take(left).count(),
                    Err(error) => assert!(!error.to_string().is_empty()),
                }
            }
            if let Ok(texts) = channel.texts() {
                let mut length = 0;
                for text in texts.take(left) {
                    left -= 1;
                    length += text.len();
                }
                // what is not UTF-8 is replaced by three bytes
                assert!(length <= 3 * data.len());
            }
            if let Ok(times) = channel.timestamps() {
                left -= times.take(left).count();
            }
        });
    }
    for group in file.groups() {
        assert!(file.group(group.name()).is_some());
        let names: Vec<&str> = group.channels().map(|channel| channel.name()).take(16).collect();
        let own = names.first().copied().unwrap_or_default();
        for time in [TdmsTime::Waveform, TdmsTime::Rate(1000.0), TdmsTime::Channel(own)] {
            match file.rows(group.name(), &names, time) {
                Ok(samples) => {
                    for sample in samples.take(left) {
                        left -= 1;
                        if let Ok(sample) = sample {
                            assert_eq!(sample.values().len(), names.len());
                        }
                    }
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
});
