//! MCAP files, not compressed: any bytes.
#![no_main]

use rod_hw::recording::mcap::McapFile;
use rod_hw_fuzz::bounded;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let file = match bounded(data.len(), 100, || McapFile::parse(data)) {
        Ok(file) => file,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    if let Some(fault) = file.fault() {
        assert!(!fault.to_string().is_empty());
    }
    let count: usize = file.topics().iter().map(|topic| topic.messages).sum();
    assert!(count <= data.len());
    assert!(file.wrenches("no such").is_err() || file.topics().iter().any(|topic| topic.name == "no such"));
    for topic in file.topics().iter().take(16) {
        bounded(data.len(), 100, || {
            read(&file, &topic.name, data.len());
        });
        if let Ok(samples) = file.wrenches(&topic.name) {
            for sample in samples.flatten() {
                assert!(sample.wrench.components().iter().all(|value| value.is_finite()));
            }
        }
    }
});

fn read(file: &McapFile<'_>, topic: &str, length: usize) {
    match file.wrenches(topic) {
        Ok(messages) => {
            let mut count = 0;
            for message in messages {
                count += 1;
                if let Err(error) = message {
                    assert!(!error.to_string().is_empty());
                }
            }
            assert!(count <= length);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
