//! The command, run on a recording, and what it answers.

use super::recording::Recording;
use crate::common::{complaint, vibrissa};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::time::{Duration, Instant};

/// A contact point of the answer.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// Reported standard deviations along x and y, or across the contour.
    sigma: Sigma,
}

#[derive(Clone, Copy, Debug)]
enum Sigma {
    Axes([f64; 2]),
    Across(f64),
}

impl Point {
    /// Reported standard deviation across the contour whose unit normal is given, m. From deviations along the axes it neglects
    /// their correlation.
    pub fn sigma_across(&self, [nx, ny]: [f64; 2]) -> f64 {
        match self.sigma {
            Sigma::Axes([x, y]) => (nx * x).hypot(ny * y),
            Sigma::Across(sigma) => sigma,
        }
    }

    fn read(contact: &Value) -> Option<Self> {
        let [x, y] = [contact["x"].as_f64()?, contact["y"].as_f64()?];
        // Columns of several kinds of error, as sigma_x and sigma_systematic_x, are independent; a total contains the others.
        let sum = |axis: &str| {
            let fields = contact.as_object()?.iter();
            let mut of_axis = fields.filter(|(name, _)| name.starts_with("sigma_") && name.ends_with(axis));
            let total = of_axis.clone().find(|(name, _)| name.contains("total"));
            match total {
                Some((_, value)) => value.as_f64(),
                None => of_axis.try_fold(0.0_f64, |sum, (_, value)| Some(sum.hypot(value.as_f64()?))),
            }
        };
        let across = contact.as_object()?.keys().any(|name| name.starts_with("sigma_") && name.ends_with("_across"));
        let sigma = if across { Sigma::Across(sum("_across")?) } else { Sigma::Axes([sum("_x")?, sum("_y")?]) };
        Some(Self { x, y, sigma })
    }
}

/// The answer to one row.
#[derive(Clone, Debug)]
pub struct Line {
    /// None where the command does not say.
    pub label: Option<String>,
    /// Reported probability that it is right.
    pub probability: Option<f64>,
    pub point: Option<Point>,
    pub second: Option<Point>,
}

/// What the command did.
#[derive(Debug)]
pub struct Answer {
    /// Exit status; none after a signal.
    pub status: Option<i32>,
    /// Lines of standard error, findings and warnings of the report.
    pub said: Vec<String>,
    /// Answers to the rows, in order; empty if there are no results.
    pub lines: Vec<Line>,
    /// Time that the command took.
    pub time: Duration,
}

/// Runs `vibrissa reconstruct` in a directory, which keeps its files.
pub fn run(directory: &Path, recording: &Recording) -> Answer {
    recording.write(&directory.join("recording.csv"));
    recording.write_rod(&directory.join("rod.toml"));
    let start = Instant::now();
    let arguments = ["reconstruct", "recording.csv", "--rod", "rod.toml", "--out", "out"];
    let output = vibrissa(directory, &arguments);
    let time = start.elapsed();
    let mut said: Vec<String> = complaint(&output).lines().map(str::to_owned).collect();
    let report = fs::read_to_string(directory.join("out/report.json")).unwrap_or_default();
    if let Ok(report) = serde_json::from_str::<Value>(&report) {
        for list in [&report["physics"]["findings"], &report["rows"]["warnings"]] {
            let new = |text: &&str| said.iter().all(|line| !line.contains(*text));
            let texts = list.as_array().into_iter().flatten().filter_map(Value::as_str).filter(new);
            let texts: Vec<String> = texts.map(str::to_owned).collect();
            said.extend(texts);
        }
    }
    let lines = fs::File::open(directory.join("out/points.jsonl")).map_or_else(|_| Vec::new(), lines);
    Answer { status: output.status.code(), said, lines, time }
}

fn lines(file: fs::File) -> Vec<Line> {
    let read = |line: std::io::Result<String>| {
        let value: Value = serde_json::from_str(&line.unwrap()).unwrap();
        let second = value.get("second").and_then(Point::read);
        let label = value["label"].as_str().map(str::to_owned);
        Line { label, probability: value["probability"].as_f64(), point: Point::read(&value), second }
    };
    BufReader::new(file).lines().map(read).collect()
}
