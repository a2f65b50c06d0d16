//! Scores as tables in Markdown, lengths in mm.

use super::{Level, Noise, Score};
use vibrissa::compare::Deviation;

const COLUMNS: [&str; 15] = [
    "noise",
    "kinks found",
    "false a scan",
    "kink error",
    "phases right",
    "two-point found",
    "single kept",
    "with point",
    "points: median / 95 % / largest",
    "contour: median / 95 % / largest",
    "first: median / 95 %",
    "second: median / 95 %",
    "without first / second",
    "stretches without first / second",
    "naive in two-point: median / 95 % / largest",
];

/// A row for each noise.
pub fn table<'a>(rows: impl IntoIterator<Item = (&'a Level, Option<&'a Noise>, &'a Score)>) -> String {
    let rows = rows.into_iter().map(|(level, noise, score)| {
        let noise = noise.map_or(String::new(), |noise| format!(", {}", noise.name));
        (format!("{}{noise}", level.title()), score)
    });
    markdown(rows)
}

/// A row for each scan.
pub fn by_scan<'a>(rows: impl IntoIterator<Item = (&'a str, &'a Score)>) -> String {
    markdown(rows.into_iter().map(|(name, score)| (name.to_owned(), score)))
}

fn markdown<'a>(rows: impl IntoIterator<Item = (String, &'a Score)>) -> String {
    let mut text = format!("| {} |\n|{}\n", COLUMNS.join(" | "), "---|".repeat(COLUMNS.len()));
    for (name, score) in rows {
        let cells = [
            name,
            percent(score.kinks.recall()),
            format!("{:.2}", score.kinks.false_alarms() as f64 / score.scans.max(1) as f64),
            score.kinks.median_error().map_or("-".into(), millimetres),
            percent(score.phases.accuracy()),
            percent(score.phases.several_recall()),
            percent(score.phases.single_kept()),
            percent(score.answered.value()),
            deviation(&score.points, true),
            deviation(&score.contour, true),
            deviation(&score.several[0], false),
            deviation(&score.several[1], false),
            both(score.resolved.map(|share| share.value().map(|value| 1.0 - value))),
            both(score.given_up.map(|share| share.value())),
            deviation(&score.naive, true),
        ];
        text += &format!("| {} |\n", cells.join(" | "));
    }
    text
}

fn both(shares: [Option<f64>; 2]) -> String {
    shares.map(percent).join(" / ")
}

fn deviation(distances: &[f64], largest: bool) -> String {
    Deviation::of(distances.iter().copied()).map_or("-".into(), |off| {
        let last = largest.then_some(off.largest);
        let numbers: Vec<String> = [off.median, off.percentile_95].into_iter().chain(last).map(millimetres).collect();
        numbers.join(" / ")
    })
}

/// Two significant digits of a length in m.
fn millimetres(length: f64) -> String {
    let length = 1e3 * length;
    match length.abs() {
        size if size < 1e-3 => format!("{length:.0e}"),
        size => {
            let digits = (1.0 - size.log10().floor()).clamp(0.0, 4.0) as usize;
            format!("{length:.digits$}")
        }
    }
}

/// Only all of them are 100 %, only none 0 %.
fn percent(share: Option<f64>) -> String {
    match share {
        None => "-".into(),
        Some(share) if share >= 1.0 => "100 %".into(),
        Some(share) if share <= 0.0 => "0 %".into(),
        Some(share) => format!("{:.2} %", (100.0 * share).clamp(0.01, 99.99)),
    }
}
