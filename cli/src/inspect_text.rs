//! What `inspect` prints.

use rod_files::table::Table;
use rod_files::{Certainty, InspectedFile, Inspection, quoted};
use std::fmt::Write;

/// The report of a look at files: layout, columns, faults, questions, commands.
pub fn inspection_text(found: &Inspection) -> String {
    let mut text = String::new();
    for file in &found.files {
        text += &of_file(file);
    }
    let faults: Vec<_> =
        found.files.iter().flat_map(|file| file.faults.iter().map(move |fault| (file, fault))).collect();
    if !faults.is_empty() {
        text += "to correct:\n";
        let mut table = Table::new(["place", "field", "found", "expected", "effect"]);
        for (file, fault) in faults {
            let place = fault.line.map_or_else(|| file.file.clone(), |line| format!("{}:{line}", file.file));
            let effect = if fault.prevents { "the file is not read" } else { "these rows only" };
            table.row([place, fault.field.clone(), fault.value.clone(), fault.expected.clone(), effect.to_owned()]);
        }
        let _ = writeln!(text, "{table}");
    }
    for file in found.files.iter().filter(|file| !file.questions.is_empty()) {
        let _ = writeln!(text, "to answer, about {}:", file.file);
        for question in &file.questions {
            let _ = writeln!(text, "  {}", question.text);
            question.answers.iter().for_each(|answer| {
                let _ = writeln!(text, "    {answer}");
            });
        }
        text.push('\n');
    }
    let is_settled = found.is_settled();
    for command in &found.commands {
        let line: Vec<String> = command.words.iter().map(|word| quoted(word)).collect();
        let what = match (command.reads && is_settled, command.setup.is_some()) {
            (true, false) => "this command reads it:",
            (true, true) => "this command reads it, with the setup below:",
            (false, _) => "this command reads it after these corrections and answers:",
        };
        let _ = writeln!(text, "{what}\n  {}", line.join(" "));
        if let Some(setup) = &command.setup {
            let _ = writeln!(text, "\nsetup (--write-setup FILE writes it):");
            setup.lines().for_each(|line| {
                let _ = writeln!(text, "  {line}");
            });
        }
    }
    text
}

fn of_file(file: &InspectedFile) -> String {
    let mut text = format!("{}: {}\n", file.file, file.kind);
    let width = file.facts.iter().map(|fact| fact.what.len()).max().unwrap_or_default();
    for fact in &file.facts {
        let _ = writeln!(text, "  {:<width$}  {}", fact.what, fact.found);
    }
    if !file.columns.is_empty() {
        let has_behaviour = file.columns.iter().any(|column| column.behaviour.is_some());
        let mut names = vec!["column", "meaning", "unit", "least", "most", "noise", "why"];
        if has_behaviour {
            names.insert(6, "values");
        }
        let mut table = Table::new(names);
        for column in &file.columns {
            let mark = |certainty: Certainty| match certainty {
                Certainty::Sure => "",
                Certainty::Likely => " (likely)",
                Certainty::Open => " (open)",
            };
            let meaning = column
                .meaning
                .as_ref()
                .map_or_else(|| "-".to_owned(), |meaning| meaning.clone() + mark(column.meaning_certainty));
            let is_used = column.meaning.is_some();
            let unit = match &column.unit {
                Some(unit) => unit.clone() + if is_used { mark(column.unit_certainty) } else { "" },
                None if is_used && column.unit_certainty == Certainty::Open => "? (open)".to_owned(),
                None => "-".to_owned(),
            };
            let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4e}"));
            let why: Vec<&str> = [&column.meaning_why, &column.unit_why]
                .into_iter()
                .map(String::as_str)
                .filter(|why| is_used && !why.is_empty())
                .collect();
            let mut cells = vec![
                column.name.clone(),
                meaning,
                unit,
                number(column.least),
                number(column.most),
                number(column.noise),
                why.join("; "),
            ];
            if has_behaviour {
                cells.insert(6, column.behaviour.clone().unwrap_or_else(|| "-".to_owned()));
            }
            table.row(cells);
        }
        text += &table.to_string();
    }
    text.push('\n');
    text
}
