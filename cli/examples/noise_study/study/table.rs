//! Scores as tables in Markdown, lengths in mm.

use super::score::Share;
use super::{Level, Noise, Score};
use vibrissa::reconstruct::score::Deviation;

/// What a table tells of a score.
type Columns = [(&'static str, fn(&Score) -> String)];

const FOUND: &Columns = &[
    ("kinks found", |score| percent(score.kinks.recall())),
    ("false a scan", |score| format!("{:.2}", score.kinks.false_alarms() as f64 / score.scans.max(1) as f64)),
    ("error, mm", |score| score.kinks.median_error().map_or("-".into(), millimetres)),
    ("phases right", |score| percent(score.phases.accuracy())),
    ("two-point flagged", |score| percent(score.phases.several_recall())),
    ("single kept", |score| percent(score.phases.single_kept())),
    ("with a point", |score| percent(score.answered.value())),
];
const POINTS: &Columns = &[
    ("points", |score| deviation(&score.points, true)),
    ("contour", |score| deviation(&score.contour, true)),
    ("naive in two-point stretches", |score| deviation(&score.naive, true)),
];
const SEVERAL: &Columns = &[
    ("first contact", |score| deviation(&score.several[0], false)),
    ("second contact", |score| deviation(&score.several[1], false)),
    ("samples without first / second", |score| {
        both(score.resolved.map(|share| share.value().map(|value| 1.0 - value)))
    }),
    ("stretches without first / second", |score| both(score.given_up.map(|share| share.value()))),
];
const LABELS: &Columns = &[
    ("explained", |score| percent(score.explained.value())),
    ("wrong", |score| score.sure.iter().map(Share::others).sum::<usize>().to_string()),
    ("wrong by their probabilities", |score| format!("{:.0}", score.expected)),
    ("right below 0.7", |score| percent(score.sure[0].value())),
    ("0.7 to 0.9", |score| percent(score.sure[1].value())),
    ("0.9 to 0.98", |score| percent(score.sure[2].value())),
    ("above", |score| percent(score.sure[3].value())),
];
const TABLES: [(&str, &Columns); 4] = [
    ("Kinks, phases and what is kept:", FOUND),
    ("Distances from the contour, mm: median / 95 % / largest", POINTS),
    ("Two-point stretches, distances from the contour, mm: median / 95 %", SEVERAL),
    ("Recordings that one contour explains (with --fit), labels, and the share that is right by probability:", LABELS),
];

/// Tables with a row for each noise.
pub fn tables<'a>(rows: impl IntoIterator<Item = (&'a Level, Option<&'a Noise>, &'a Score)>) -> String {
    let rows = rows.into_iter().map(|(level, noise, score)| {
        let noise = noise.map_or(String::new(), |noise| format!(", {}", noise.name));
        (format!("{}{noise}", level.title()), score)
    });
    markdown("noise", &rows.collect::<Vec<_>>())
}

/// The coefficients of friction that were found, with a row for each noise.
pub fn frictions<'a>(rows: impl IntoIterator<Item = (&'a Level, Option<&'a Noise>, &'a Score)>) -> String {
    let mut text = String::from(
        "Friction found, mean and standard deviation over the scans; root mean square of its error in stated standard deviations:\n\n\
         | noise | mu | by the noise alone | with errors that samples share |\n|---|---|---|---|\n",
    );
    for (level, noise, score) in rows {
        let noise = noise.map_or(String::new(), |noise| format!(", {}", noise.name));
        let count = score.frictions.len().max(1) as f64;
        let mean = |of: &dyn Fn(&[f64; 3]) -> f64| score.frictions.iter().map(of).sum::<f64>() / count;
        let mu = mean(&|found| found[0]);
        let [scatter, alone, all] =
            [mean(&|f| (f[0] - mu).powi(2)), mean(&|f| f[1].powi(2)), mean(&|f| f[2].powi(2))].map(f64::sqrt);
        text += &format!("| {}{noise} | {mu:.6} +- {scatter:.1e} | {alone:.1} | {all:.2} |\n", level.title());
    }
    text
}

/// A table with a row for each noise and each coefficient of friction, those of a noise below each other.
pub fn compared(rows: &[(f64, &Level, Option<&Noise>, Score)]) -> String {
    let mut text = String::from(
        "Friction compared. Distances of single contacts from the contour, mm: median / 95 %; share of them within two standard deviations by the \
         noise alone / with errors that samples share; root mean square error of mu, its size in standard deviations by the noise alone:\n\n\
         | noise | mu | phases right | with a point | error, mm | covered | error of mu |\n|---|---|---|---|---|---|---|\n",
    );
    let name = |level: &Level, noise: Option<&Noise>| {
        format!("{}{}", level.title(), noise.map_or(String::new(), |noise| format!(", {}", noise.name)))
    };
    let mut noises: Vec<String> = rows.iter().map(|(_, level, noise, _)| name(level, *noise)).collect();
    noises.sort_by_key(|one| rows.iter().position(|(_, level, noise, _)| *one == name(level, *noise)));
    noises.dedup();
    for one in noises {
        for (mu, .., score) in rows.iter().filter(|(_, level, noise, _)| one == name(level, *noise)) {
            let root = |of: &dyn Fn(&[f64; 3]) -> f64| {
                let squares: f64 = score.frictions.iter().map(|found| of(found).powi(2)).sum();
                (squares / score.frictions.len().max(1) as f64).sqrt()
            };
            let friction = if *mu == 0.0 {
                "-".to_owned()
            } else {
                format!("{:.1e}, {:.1}", root(&|found| found[0] - mu), root(&|found| found[1]))
            };
            text += &format!(
                "| {one} | {mu} | {} | {} | {} | {} | {friction} |\n",
                percent(score.phases.accuracy()),
                percent(score.answered.value()),
                deviation(&score.points, false),
                both(score.covered.map(|share| share.value())),
            );
        }
    }
    text
}

/// Tables with a row for each scan.
pub fn by_scan<'a>(rows: impl IntoIterator<Item = (&'a str, &'a Score)>) -> String {
    markdown("scan", &rows.into_iter().map(|(name, score)| (name.to_owned(), score)).collect::<Vec<_>>())
}

fn markdown(what: &str, rows: &[(String, &Score)]) -> String {
    let mut text = String::new();
    for (title, columns) in TABLES {
        let heads: Vec<&str> = columns.iter().map(|column| column.0).collect();
        text += &format!("{title}\n\n| {what} | {} |\n|---|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
        for (name, score) in rows {
            let cells: Vec<String> = columns.iter().map(|column| column.1(score)).collect();
            text += &format!("| {name} | {} |\n", cells.join(" | "));
        }
        text += "\n";
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
        size if size < 1e-4 => format!("{length:.0e}"),
        size => {
            let digits = (1.0 - size.log10().floor()).clamp(0.0, 5.0) as usize;
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
