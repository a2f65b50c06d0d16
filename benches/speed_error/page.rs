//! The measured part of docs/speed-against-error.md.

use crate::boundary;
use crate::figure::Figure;
use crate::level::{cheapest, duration, time_at};
use crate::row::{NONE, Row};
use crate::segment;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Errors that methods are chosen for, and the one that they are compared at.
const LEVELS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
const LEVEL: f64 = 1e-9;
const MARKERS: [&str; 2] = ["<!-- measured: begin -->", "<!-- measured: end -->"];

/// Where the page lies, and the folder of its figures.
fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Tasks with their problems, in the order in which they come.
fn tasks(rows: &[Row]) -> Vec<(&str, &str)> {
    let mut tasks = Vec::new();
    for row in rows.iter().filter(|row| row.error.is_some()) {
        let task = (row.task.as_str(), row.problem.as_str());
        if !tasks.contains(&task) {
            tasks.push(task);
        }
    }
    tasks
}

/// Of each task the cheapest method at each error.
fn choice(rows: &[Row]) -> String {
    let errors = LEVELS.map(|level| format!("{level:e}")).join(" | ");
    let mut text = format!("| task | problem | {errors} |\n|{}\n", "---|".repeat(2 + LEVELS.len()));
    for (task, problem) in tasks(rows) {
        let _ = write!(text, "| {task} | {problem} |");
        for level in LEVELS {
            let of_task = rows.iter().filter(|row| (row.task.as_str(), row.problem.as_str()) == (task, problem));
            // one of many steps does not lead to the end of a segment
            let of_task = of_task.filter(|row| row.method != segment::WALK);
            let cell = cheapest(of_task, level).map_or("-".to_owned(), |(row, time)| {
                let setting = if row.setting == NONE { String::new() } else { format!(" ({})", row.setting) };
                format!("{}{setting}: {}", row.method, duration(time))
            });
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

/// Of each method the time at one error: a table a figure, a column a panel.
fn times(figures: &[Figure<'_>]) -> String {
    let mut text = String::new();
    for figure in figures.iter().filter(|figure| !figure.methods().is_empty()) {
        let titles: Vec<&str> = figure.panels.iter().map(|panel| panel.title.as_str()).collect();
        let lines = "---|".repeat(titles.len() + 1);
        let _ = writeln!(text, "| {} | {} |\n|{lines}", figure.title, titles.join(" | "));
        for method in figure.methods() {
            let _ = write!(text, "| {method} |");
            for panel in &figure.panels {
                let of_method = panel.rows.iter().copied().filter(|row| row.method == method);
                let _ = write!(text, " {} |", time_at(of_method, LEVEL).map_or("-".to_owned(), duration));
            }
            text.push('\n');
        }
        text.push('\n');
    }
    text
}

/// Which methods did not come to the solution, at which settings.
fn failures(rows: &[Row]) -> String {
    let mut text = String::new();
    let failed = |row: &&Row| (row.error, row.seconds) == (None, None) || row.note.starts_with(boundary::SOLVED_FROM);
    for (task, problem) in tasks(rows) {
        let of_task = || rows.iter().filter(|row| row.task == task && row.problem == problem).filter(failed);
        let mut told: Vec<(&str, &str, Vec<&str>)> = Vec::new();
        for row in of_task() {
            match told.iter_mut().find(|(method, note, _)| *method == row.method && *note == row.note) {
                Some((_, _, settings)) => settings.push(&row.setting),
                None => told.push((&row.method, &row.note, vec![&row.setting])),
            }
        }
        for (method, note, settings) in told {
            let _ = writeln!(text, "- {task}, {method}, at {}: {note}.", settings.join(", "));
        }
    }
    if text.is_empty() { "- None.\n".to_owned() } else { text }
}

/// All that is measured, as Markdown.
pub fn measured(machine: &str, rows: &[Row], figures: &[Figure<'_>], claims: &[String]) -> String {
    let mut text = format!("Measured {machine}.\n\n");
    let _ = writeln!(
        text,
        "The cheapest of all methods measured that has no larger error, with its setting:\n\n{}",
        choice(rows)
    );
    let _ = writeln!(text, "Claims, and whether they hold:\n");
    claims.iter().for_each(|claim| {
        let _ = writeln!(text, "- {claim}");
    });
    let _ = writeln!(text, "\nMethods that did not come to the solution from every guess:\n\n{}", failures(rows));
    let _ = writeln!(
        text,
        "All methods at an error of {LEVEL:e}; a dash where no setting is so exact:\n\n{}",
        times(figures)
    );
    text
}

/// Puts figures and numbers into the documentation.
pub fn update(measured: &str, figures: &[PathBuf]) {
    let folder = docs().join("speed");
    std::fs::create_dir_all(&folder).unwrap();
    for figure in figures {
        std::fs::copy(figure, folder.join(figure.file_name().unwrap())).unwrap();
    }
    let page = docs().join("speed-against-error.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let [begin, end] = MARKERS;
    let (before, rest) = text.split_once(begin).unwrap_or_else(|| panic!("{} has no {begin}", page.display()));
    let (_, after) = rest.split_once(end).unwrap_or_else(|| panic!("{} has no {end}", page.display()));
    std::fs::write(&page, format!("{before}{begin}\n\n{}\n\n{end}{after}", measured.trim())).unwrap();
}
