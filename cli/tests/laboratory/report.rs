//! The table of all recordings, and totals.

use super::judge::{RANGES, Reliability, Score, Verdict};
use std::fmt::Write;
use std::time::Duration;

/// A recording that was judged.
pub struct Judged {
    pub wrong: String,
    pub level: &'static str,
    pub scene: &'static str,
    pub seed: u64,
    /// The imperfections with their levels, and the true labels.
    pub what: String,
    pub cycle: String,
    pub score: Score,
    pub said: Vec<String>,
    pub time: Duration,
}

impl Judged {
    /// A line on this recording alone.
    pub fn line(&self) -> String {
        let Self { wrong, scene, seed, what, cycle, said, time, .. } = self;
        let said = if said.is_empty() { String::new() } else { format!("; said: {}", said.join(" / ")) };
        format!(
            "{wrong}, {scene}, seed {seed} ({what}): {}, {:.1} s; true {cycle}{said}",
            self.score.verdict,
            time.as_secs_f64()
        )
    }
}

/// The table in Markdown. Of several seeds the worst value is shown.
pub fn table(judged: &[Judged]) -> String {
    let mut text = String::from(
        "| imperfection | level | scene | verdicts | labels right % | median mm | 99.9 % mm | beyond 6 sigma % | unanswered % | status |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for same in judged.chunk_by(|a, b| a.wrong == b.wrong && a.scene == b.scene) {
        let Judged { wrong, level, scene, .. } = &same[0];
        let scores = || same.iter().map(|one| &one.score);
        let most = |value: fn(&Score) -> Option<f64>| scores().filter_map(value).max_by(f64::total_cmp);
        let least = |value: fn(&Score) -> Option<f64>| scores().filter_map(value).min_by(f64::total_cmp);
        let percent = |value: Option<f64>| value.map_or_else(|| "-".into(), |share| format!("{:.2}", 100.0 * share));
        let mm = |value: Option<f64>| value.map_or_else(|| "-".into(), |distance| format!("{:.2e}", 1e3 * distance));
        let mut statuses: Vec<String> =
            scores().map(|score| score.status.map_or("signal".into(), |s| s.to_string())).collect();
        statuses.sort_unstable();
        statuses.dedup();
        writeln!(
            text,
            "| {wrong} | {level} | {scene} | {} | {} | {} | {} | {} | {} | {} |",
            verdicts(same),
            percent(least(|score| score.labels)),
            mm(most(|score| score.median)),
            mm(most(|score| score.p999)),
            percent(most(|score| score.beyond)),
            percent(most(|score| score.unanswered)),
            statuses.join(", ")
        )
        .unwrap();
    }
    text
}

/// Counts of the verdicts for each imperfection, and of all imperfections and all mistakes.
pub fn totals(judged: &[Judged]) -> String {
    let heads: Vec<String> = Verdict::ALL.map(|verdict| verdict.to_string()).into();
    let mut text = format!("| imperfection | {} |\n|---|---|---|---|---|\n", heads.join(" | "));
    let mut row = |name: &str, of: &[&Judged]| {
        let counts = Verdict::ALL.map(|verdict| of.iter().filter(|one| one.score.verdict == verdict).count());
        writeln!(text, "| {name} | {} |", counts.map(|count| count.to_string()).join(" | ")).unwrap();
    };
    for same in judged.chunk_by(|a, b| a.wrong == b.wrong) {
        row(&same[0].wrong, &same.iter().collect::<Vec<_>>());
    }
    let (mistakes, rest): (Vec<_>, Vec<_>) = judged.iter().partition(|one| one.wrong.starts_with("mistake"));
    row("all but mistakes", &rest);
    row("mistakes", &mistakes);
    text
}

fn verdicts(of: &[Judged]) -> String {
    if let [one] = of {
        return one.score.verdict.to_string();
    }
    let count = |verdict: Verdict| of.iter().filter(|one| one.score.verdict == verdict).count();
    let counts = Verdict::ALL.into_iter().map(|verdict| (verdict, count(verdict))).filter(|pair| pair.1 > 0);
    counts.map(|(verdict, count)| format!("{count} {verdict}")).collect::<Vec<_>>().join(", ")
}

/// Of the labels with a probability in each range, the share that is right, in the recordings that were not refused.
pub fn reliability(judged: &[Judged]) -> String {
    let mut sum = Reliability::default();
    let answered = judged.iter().filter(|one| one.score.verdict != Verdict::Refused);
    answered.for_each(|one| sum.add(&one.score.reliability));
    let mut text = String::from("| probability | labels | mean probability % | right % |\n|---|---|---|---|\n");
    for (least, [all, right, probabilities]) in RANGES.iter().zip(sum.0) {
        let percent = |of: f64| 100.0 * of / all;
        writeln!(text, "| {least} and more | {all} | {:.3} | {:.3} |", percent(probabilities), percent(right)).unwrap();
    }
    text
}
