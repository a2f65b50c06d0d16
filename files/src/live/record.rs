//! The files that a live scan writes while it runs. They are complete up to the last flush, whatever happens then.

use crate::OutputError;
use crate::output::check_output;
use crate::reconstructed::PointRecord;
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use vibrissa::hw::recording::{Contents, Recorder};
use vibrissa::hw::{LinkCounters, ReactionSample};
use vibrissa::reconstruct::Reading;

/// recording.csv and points.jsonl.
#[derive(Debug)]
pub(super) struct LiveFiles {
    directory: PathBuf,
    /// Lines of the recording's head: name and text.
    notes: Vec<(&'static str, String)>,
    /// Created with the first sample, which has the number of channels.
    recorder: Option<Recorder<BufWriter<File>>>,
    points: BufWriter<File>,
    line: Vec<u8>,
}

const RECORDING: &str = "recording.csv";
const POINTS: &str = "points.jsonl";
const SUMMARY: &str = "summary.json";
const FILES: [&str; 3] = [RECORDING, POINTS, SUMMARY];

/// A line of points.jsonl.
#[derive(Serialize)]
struct LiveRecord {
    t: f64,
    /// The flags of its quality.
    quality: Vec<&'static str>,
    #[serde(flatten)]
    point: PointRecord,
}

impl LiveFiles {
    pub fn new(directory: &Path, notes: Vec<(&'static str, String)>) -> Result<Self, OutputError> {
        fs::create_dir_all(directory)
            .map_err(|source| OutputError::Directory { directory: directory.to_path_buf(), source })?;
        let points = BufWriter::new(create(directory, POINTS)?);
        Ok(Self { directory: directory.to_path_buf(), notes, recorder: None, points, line: Vec::new() })
    }

    pub fn sample(&mut self, sample: &ReactionSample) -> Result<(), OutputError> {
        let recorder = match self.recorder.take() {
            Some(recorder) => recorder,
            None => {
                let contents = Contents {
                    raw: Some(sample.raw.channels.len()),
                    sigma: sample.sigma.is_some(),
                    systematic: sample.systematic.is_some(),
                    out_of_plane: true,
                };
                let out = BufWriter::new(create(&self.directory, RECORDING)?);
                let notes: Vec<(&str, &str)> = self.notes.iter().map(|(key, text)| (*key, text.as_str())).collect();
                Recorder::new(out, &notes, contents).map_err(self.write_error(RECORDING))?
            }
        };
        let written = self.recorder.insert(recorder).write(sample);
        written.map_err(self.write_error(RECORDING))
    }

    pub fn answer(&mut self, sample: &ReactionSample, reading: Option<&Reading>) -> Result<(), OutputError> {
        let point = match reading {
            Some(reading) => PointRecord::of_reading(sample.pose, reading),
            None => PointRecord::without(Some(sample.pose), sample.quality.to_string()),
        };
        let record = LiveRecord { t: sample.t, quality: sample.quality.names().collect(), point };
        self.line.clear();
        let written = serde_json::to_writer(&mut self.line, &record).map_err(io::Error::from).and_then(|()| {
            self.line.push(b'\n');
            self.points.write_all(&self.line)
        });
        written.map_err(self.write_error(POINTS))
    }

    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.points.flush().map_err(self.write_error(POINTS))
    }

    /// Closes both and writes the summary beside them.
    pub fn finish(mut self, counters: &LinkCounters, summary: &impl Serialize) -> Result<(), OutputError> {
        self.flush()?;
        if let Some(recorder) = self.recorder.take() {
            recorder.finish(Some(counters)).map_err(self.write_error(RECORDING))?;
        }
        let mut out = BufWriter::new(create(&self.directory, SUMMARY)?);
        serde_json::to_writer_pretty(&mut out, summary)
            .map_err(io::Error::from)
            .and_then(|()| out.write_all(b"\n"))
            .and_then(|()| out.flush())
            .map_err(self.write_error(SUMMARY))
    }

    fn write_error(&self, name: &str) -> impl Fn(io::Error) -> OutputError + use<> {
        let file = self.directory.join(name);
        move |source| OutputError::File { file: file.clone(), source }
    }
}

/// Whether the files of a live scan may be written to a directory.
pub(super) fn check(directory: &Path, inputs: &[PathBuf]) -> Result<(), OutputError> {
    FILES.iter().try_for_each(|name| check_output(&directory.join(name), inputs))
}

fn create(directory: &Path, name: &str) -> Result<File, OutputError> {
    let file = directory.join(name);
    check_output(&file, &[])?;
    File::create(&file).map_err(|source| OutputError::File { file, source })
}
