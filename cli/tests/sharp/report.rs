//! What many scenes came to, as a table, and the seeds of each class of failure.

use super::scene::KINDS;
use super::verdict::Verdict;
use crate::witness::run::{End, False};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Seeds named of each class.
const NAMED: usize = 6;

/// The table, and below it the classes of failure.
pub fn table(verdicts: &[Verdict]) -> String {
    let ends: BTreeSet<End> = verdicts.iter().filter_map(|v| v.end).collect();
    let mut out = format!(
        "{:24}{:>7}{:>9}{:>9}{:>8}{:>14}{:>13}",
        "kind", "scenes", "states", "touching", "events", "false states", "false events"
    );
    for end in &ends {
        write!(out, "{:>14}", format!("{end:?}")).unwrap();
    }
    writeln!(out, "{:>9}{:>16}{:>9}", "refused", "steps disagree", "seconds").unwrap();
    let mut row = |label: &str, of: &[&Verdict]| {
        let sum = |f: fn(&Verdict) -> usize| of.iter().map(|v| f(v)).sum::<usize>();
        let count = |f: &dyn Fn(&Verdict) -> bool| of.iter().filter(|v| f(v)).count();
        let (states, touching, events) = (sum(|v| v.states), sum(|v| v.touching), sum(|v| v.events));
        let wrong = format!("{} in {}", sum(|v| v.false_states.len()), count(&|v| !v.false_states.is_empty()));
        let wrong_events = format!("{} in {}", sum(|v| v.false_events.len()), count(&|v| !v.false_events.is_empty()));
        write!(out, "{label:24}{:>7}{states:>9}{touching:>9}{events:>8}{wrong:>14}{wrong_events:>13}", of.len())
            .unwrap();
        for end in &ends {
            write!(out, "{:>14}", count(&|v| v.end == Some(*end))).unwrap();
        }
        let steps = format!("{} of {}", count(&Verdict::disagrees), count(&|v| v.steps.is_some()));
        let seconds = of.iter().map(|v| v.time.as_secs_f64()).sum::<f64>();
        writeln!(out, "{:>9}{steps:>16}{seconds:>9.2}", count(&|v| v.end.is_none())).unwrap();
    };
    for kind in KINDS {
        row(kind, &verdicts.iter().filter(|v| v.scene.kind == kind).collect::<Vec<_>>());
    }
    row("all", &verdicts.iter().collect::<Vec<_>>());
    out + &classes(verdicts)
}

/// Every class of failure with how often, how grave, and some seeds.
fn classes(verdicts: &[Verdict]) -> String {
    let mut classes: BTreeMap<String, (BTreeSet<u64>, usize, f64)> = BTreeMap::new();
    for verdict in verdicts {
        let (seed, kind) = (verdict.scene.seed, verdict.scene.kind);
        let mut add = |class: String, off: f64| {
            let entry = classes.entry(class).or_default();
            entry.0.insert(seed);
            (entry.1, entry.2) = (entry.1 + 1, entry.2.max(off));
        };
        for (found, of) in [(&verdict.false_states, "false state"), (&verdict.false_events, "false event")] {
            for False { phase, fault, .. } in found {
                add(format!("{of}, {}, {kind}, {phase}", fault.bad.what), fault.bad.off);
            }
        }
        match verdict.end {
            None => add(format!("refused, {kind}"), 0.0),
            Some(end) if end != End::Done => add(format!("end, {end:?}, {kind}"), 0.0),
            Some(_) => {}
        }
        for (factor, _) in verdict.steps.iter().flatten() {
            add(format!("steps, x{factor}, {kind}"), 0.0);
        }
    }
    let mut out = String::new();
    let mut slow: Vec<_> = verdicts.iter().map(|v| (v.time, v.scene.seed)).collect();
    slow.sort();
    let slow: Vec<_> = slow.iter().rev().take(5).map(|(t, seed)| format!("{seed}: {:.2} s", t.as_secs_f64())).collect();
    writeln!(out, "slowest: {}", slow.join(", ")).unwrap();
    for (class, (seeds, count, off)) in classes {
        let named: Vec<_> = seeds.iter().take(NAMED).map(u64::to_string).collect();
        writeln!(out, "{class}: {count} in {} scenes, up to {off:.1e}: {}", seeds.len(), named.join(" ")).unwrap();
    }
    out
}
