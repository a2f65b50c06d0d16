//! The points of the figures, as files.

use std::path::{Path, PathBuf};

/// What a method made of a task with one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub task: String,
    pub problem: String,
    pub method: String,
    pub setting: String,
    /// Relative to 1 + |truth|; none where there is no answer.
    pub error: Option<f64>,
    /// Seconds; none where there is no answer.
    pub seconds: Option<f64>,
    pub note: String,
}

/// The setting of a method that has none.
pub const NONE: &str = "-";

const COLUMNS: [&str; 7] = ["task", "problem", "method", "setting", "error", "seconds", "note"];

/// Where the files of measured points lie: `speed-against-error` in cargo's target directory.
pub fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().join("speed-against-error");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

pub fn write(path: &Path, rows: &[Row]) {
    let mut file = csv::Writer::from_path(path).unwrap();
    file.write_record(COLUMNS).unwrap();
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4e}"));
    for Row { task, problem, method, setting, error, seconds, note } in rows {
        let (error, seconds) = (number(*error), number(*seconds));
        file.write_record([task, problem, method, setting, &error, &seconds, note]).unwrap();
    }
    file.flush().unwrap();
}

/// The rows of a file; none where there is no such file.
pub fn read(path: &Path) -> Vec<Row> {
    let Ok(mut file) = csv::Reader::from_path(path) else { return Vec::new() };
    let header = file.headers().unwrap().clone();
    let places = COLUMNS.map(|name| header.iter().position(|column| column == name).unwrap());
    file.records()
        .map(|record| {
            let record = record.unwrap();
            let [task, problem, mut method, mut setting, error, seconds, note] =
                places.map(|place| record[place].to_owned());
            // of two settings the second makes another method, with a line of its own
            if let Some(at) = setting.find([',', ' ']) {
                let second = setting.split_off(at);
                method = format!("{method}, {}", second.trim_start_matches([',', ' ']));
            }
            let number = |text: String| text.parse().ok().filter(|value: &f64| value.is_finite());
            Row { task, problem, method, setting, error: number(error), seconds: number(seconds), note }
        })
        .collect()
}
