//! Recordings of text (CSV, TSV, LabVIEW's LVM): any file.
#![no_main]

use rod_hw::recording::{ColumnMap, Decimal, Delimiter, Header, Recorded, Role, Table, TableOptions};
use rod_hw::{RawSample, ReactionSample, WrenchSample};
use rod_hw_fuzz::bounded;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    read(data, &TableOptions::default());
    // and as somebody says who knows better
    let most = TableOptions::default();
    let options = match data.last().copied().unwrap_or_default() % 8 {
        0 => TableOptions { header: Header::None, ..most },
        1 => TableOptions { header: Header::Line(2), ..most },
        2 => TableOptions { header: Header::Names(vec!["time".into(), "Fx".into()]), ..most },
        3 => TableOptions { delimiter: Some(Delimiter::Blanks), decimal: Some(Decimal::Comma), ..most },
        4 => TableOptions { delimiter: Some(Delimiter::Comma), decimal: Some(Decimal::Point), ..most },
        5 => TableOptions { delimiter: Some(Delimiter::Semicolon), ..most },
        6 => TableOptions { segment: Some(2), units: vec![("Fx".into(), "mN".into())], ..most },
        _ => TableOptions { delimiter: Some(Delimiter::Tab), header: Header::Line(u64::MAX), ..most },
    };
    read(data, &options);
});

fn read(data: &[u8], options: &TableOptions) {
    // as TableOptions::most_bytes promises
    let tables = match bounded(data.len(), 100, || Table::parse_all("f", data, options)) {
        Ok(tables) => tables,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    for table in &tables {
        assert!(table.len() <= data.len() && table.faults().count() <= table.len());
        for row in table.rows() {
            for column in 0..=table.columns().len().min(16) {
                let _ = (row.cell(column), row.number(column));
            }
        }
        let map = ColumnMap::new();
        samples::<RawSample>(table, &map);
        samples::<WrenchSample>(table, &map);
        samples::<ReactionSample>(table, &map);
        let first = table.columns().first().map(|column| column.heading.clone()).unwrap_or_default();
        let last = table.columns().last().map(|column| column.heading.clone()).unwrap_or_default();
        samples::<RawSample>(table, &map.clone().with(Role::Time, first).with_channels([last]));
    }
}

fn samples<S: Recorded>(table: &Table, map: &ColumnMap) {
    match table.samples::<S>(map) {
        Ok(samples) => {
            let mut last = f64::NEG_INFINITY;
            let mut count = 0;
            for sample in samples {
                count += 1;
                match sample {
                    Ok(sample) => {
                        assert!(sample.time().is_finite() && sample.time() > last);
                        last = sample.time();
                    }
                    Err(fault) => assert!(!fault.to_string().is_empty()),
                }
            }
            assert!(count <= table.len());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
