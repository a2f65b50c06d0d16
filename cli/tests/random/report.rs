//! What many scenes came to, as a table, and the failures as files.

use super::generator::KINDS;
use super::sweep::{End, Verdict};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Where scenes that failed are written.
pub fn directory() -> PathBuf {
    match std::env::var_os("RANDOM_SCENES_OUT") {
        Some(path) => path.into(),
        None => Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().join("random_scenes"),
    }
}

/// What is worth a file: one line on what went wrong.
pub fn failure(verdict: &Verdict) -> Option<String> {
    let mut what = Vec::new();
    match &verdict.end {
        End::Refused(_) | End::Panicked(_) | End::Endless => {
            what.push(format!("{}: {}", verdict.end.name(), verdict.message));
        }
        End::Stopped(reason) if verdict.gave_up() || verdict.doubt.is_some() => {
            let doubt = verdict.doubt.as_deref().unwrap_or_default();
            what.push(format!("{reason:?} at {:.4} of the path: {} {doubt}", verdict.share, verdict.message));
        }
        _ => {}
    }
    let mut seen: BTreeMap<&str, (usize, f64, String)> = BTreeMap::new();
    for fault in &verdict.faults {
        let place =
            format!("phase {} at tau = {:.9}{}", fault.phase, fault.tau, if fault.event { ", event" } else { "" });
        let entry = seen.entry(fault.bad.what).or_insert((0, 0.0, place));
        *entry = (entry.0 + 1, entry.1.max(fault.bad.off), entry.2.clone());
    }
    what.extend(seen.iter().map(|(name, (n, off, at))| format!("bad: {name} (x{n}, up to {off:.3e}), first in {at}")));
    (!what.is_empty()).then(|| what.join("\n# "))
}

/// Writes the scenes that failed, each with what went wrong at its top.
pub fn write_failures(verdicts: &[Verdict], directory: &Path) {
    std::fs::create_dir_all(directory).unwrap();
    for verdict in verdicts {
        let file = directory.join(format!("{}.toml", verdict.scene.seed));
        match failure(verdict) {
            Some(what) => std::fs::write(file, format!("# {what}\n{}", verdict.scene.text)).unwrap(),
            // of an earlier run
            None => drop(std::fs::remove_file(file)),
        }
    }
}

/// The table.
pub fn table(verdicts: &[Verdict]) -> String {
    let names: BTreeSet<String> = verdicts.iter().map(|v| v.end.name()).collect();
    let mut out = format!("{:22}{:>7}", "kind", "scenes");
    for name in &names {
        write!(out, "{name:>14}").unwrap();
    }
    writeln!(out, "{:>9}{:>9}{:>8}{:>6}{:>6}{:>9}", "states", "touching", "events", "most", "bad", "seconds").unwrap();
    let mut row = |label: &str, of: &[&Verdict]| {
        write!(out, "{label:22}{:>7}", of.len()).unwrap();
        for name in &names {
            write!(out, "{:>14}", of.iter().filter(|v| v.end.name() == *name).count()).unwrap();
        }
        let sum = |f: fn(&Verdict) -> usize| of.iter().map(|v| f(v)).sum::<usize>();
        let most = of.iter().map(|v| v.most).max().unwrap_or(0);
        let bad = of.iter().filter(|v| v.is_bad()).count();
        let seconds = of.iter().map(|v| v.time.as_secs_f64()).sum::<f64>();
        let (states, touching, events) = (sum(|v| v.states), sum(|v| v.touching), sum(|v| v.events));
        writeln!(out, "{states:>9}{touching:>9}{events:>8}{most:>6}{bad:>6}{seconds:>9.2}").unwrap();
    };
    for kind in KINDS {
        row(kind, &verdicts.iter().filter(|v| v.scene.kind == kind).collect::<Vec<_>>());
    }
    row("all", &verdicts.iter().collect::<Vec<_>>());
    out + &faults(verdicts)
}

/// Bad states by kind, doubtful ends, the slowest scenes, and the share of those that could not go on.
fn faults(verdicts: &[Verdict]) -> String {
    let mut out = String::new();
    let mut kinds: BTreeMap<&str, (Vec<u64>, usize, f64)> = BTreeMap::new();
    for verdict in verdicts {
        for fault in &verdict.faults {
            let entry = kinds.entry(fault.bad.what).or_default();
            if entry.0.last() != Some(&verdict.scene.seed) {
                entry.0.push(verdict.scene.seed);
            }
            entry.1 += 1;
            entry.2 = entry.2.max(fault.bad.off);
        }
    }
    let mut kinds: Vec<_> = kinds.into_iter().collect();
    kinds.sort_by_key(|(_, (seeds, ..))| std::cmp::Reverse(seeds.len()));
    for (what, (seeds, count, off)) in kinds {
        let some: Vec<_> = seeds.iter().take(12).map(u64::to_string).collect();
        writeln!(out, "bad: {what}: {} scenes, {count} times, up to {off:.3e}: {}", seeds.len(), some.join(" "))
            .unwrap();
    }
    for verdict in verdicts
        .iter()
        .filter(|v| v.gave_up() || v.doubt.is_some() || matches!(v.end, End::Refused(_) | End::Panicked(_)))
    {
        let doubt = verdict.doubt.as_deref().unwrap_or_default();
        let (seed, kind, end) = (verdict.scene.seed, verdict.scene.kind, verdict.end.name());
        writeln!(out, "{end} {seed} ({kind}) at {:.3}: {doubt} {}", verdict.share, verdict.message).unwrap();
    }
    let mut slow: Vec<_> = verdicts.iter().map(|v| (v.time, v.scene.seed)).collect();
    slow.sort();
    let slow: Vec<_> = slow.iter().rev().take(5).map(|(t, seed)| format!("{seed}: {:.2} s", t.as_secs_f64())).collect();
    writeln!(out, "slowest: {}", slow.join(", ")).unwrap();
    let touching = verdicts.iter().filter(|v| v.touching > 0).count();
    writeln!(out, "scenes with contact: {touching} of {}", verdicts.len()).unwrap();
    let late = verdicts.iter().map(|v| v.late).sum::<usize>();
    let with_late = verdicts.iter().filter(|v| v.late > 0).count();
    writeln!(out, "snaps that land further along the path: {late} in {with_late} scenes").unwrap();
    let doubtful = verdicts.iter().filter(|v| v.doubt.is_some() && !v.gave_up()).count();
    writeln!(out, "ends that the problem does not seem to have, beside those: {doubtful}").unwrap();
    let gave_up = verdicts.iter().filter(|v| v.gave_up()).count();
    let share = 100.0 * gave_up as f64 / verdicts.len() as f64;
    writeln!(out, "could not go on: {gave_up} of {} ({share:.2} %)", verdicts.len()).unwrap();
    out
}
