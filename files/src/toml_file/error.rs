//! What can be wrong with a TOML file, and where in it.

use super::{message, number};
use miette::{Diagnostic, NamedSource, SourceSpan};
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Why a TOML file is not what it is read as: a scene, or a part of one that stands in a file of its own.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read as text.
    #[error("cannot read {what} {}: {source}", file.display())]
    Unreadable {
        /// What it should be, as in "the scene".
        what: &'static str,
        /// Which file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is no text.
    #[error("{}:{line}: byte {byte:#04x} is no text in UTF-8, expected {what} as a TOML file", file.display())]
    NoText {
        /// What it should be, as in "the scene".
        what: &'static str,
        /// Which file.
        file: PathBuf,
        /// Line of the byte, from 1.
        line: usize,
        /// The first byte that is no text.
        byte: u8,
    },
    /// The file is not what it should be.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(Box<Invalid>),
}

/// A place in a TOML file and what is wrong there. It displays as `file:line:column: field: what is wrong`.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{file}:{line}:{column}: {}", self.complaint())]
pub struct Invalid {
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1, in characters.
    pub column: usize,
    /// The field, as in `rod.length` or `contour.piece[2].vertex`; none where the text is no TOML, or for the whole file.
    pub field: Option<String>,
    /// What is wrong, and what was expected.
    pub message: String,
    #[source_code]
    text: NamedSource<String>,
    #[label]
    span: SourceSpan,
}

impl SceneError {
    /// What is wrong, for a text that is no file: without the place.
    pub(crate) fn without_place(&self) -> String {
        match self {
            Self::Invalid(invalid) => invalid.complaint(),
            other => other.to_string(),
        }
    }
}

impl Invalid {
    fn complaint(&self) -> String {
        match &self.field {
            Some(field) => format!("{field}: {}", self.message),
            None => self.message.clone(),
        }
    }
}

/// What is wrong at a place of a text that is not known here, or at several places of a table.
#[derive(Clone)]
pub(crate) struct Fault {
    /// The place of what is wrong, or of the table.
    span: Range<usize>,
    /// What is wrong at each place; one at least.
    parts: Vec<(Range<usize>, String)>,
}

impl Fault {
    pub fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        let message = message::with_short_numbers(message.into());
        Self { span: span.clone(), parts: vec![(span, message)] }
    }

    /// All that is wrong within a table: the message names the line of each fault that is not on the first line of the table. None where
    /// there is no fault; a single one stays what it is.
    pub fn all(span: Range<usize>, mut faults: Vec<Self>) -> Option<Self> {
        if faults.len() < 2 {
            return faults.pop();
        }
        Some(Self { span, parts: faults.into_iter().flat_map(|fault| fault.parts).collect() })
    }

    /// What is wrong, without the place: the first of several faults.
    pub fn message(&self) -> &str {
        self.parts.first().map_or("", |(_, message)| message)
    }

    /// Where it is.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The same, with more in the message.
    pub fn and(mut self, more: &str) -> Self {
        if let Some((_, last)) = self.parts.last_mut() {
            last.push_str(more);
        }
        self
    }

    /// The message, with the lines of several faults.
    fn message_in(&self, text: &str) -> String {
        let own = line_at(text, self.span.start);
        let message = |(span, message): &(Range<usize>, String)| match line_at(text, span.start) {
            line if line == own => message.clone(),
            line => format!("{message} (line {line})"),
        };
        self.parts.iter().map(message).collect::<Vec<_>>().join("; ")
    }

    /// What is wrong with a text that is no TOML. Most often a number has a decimal comma, or a unit behind it: then the
    /// message shows it.
    pub fn of_syntax(error: toml::de::Error, text: &str) -> Self {
        let fault = Self::from(error);
        if let Some(span) = table_head(text) {
            let message = "this is a table (CSV), expected a TOML file; give a recording to `vibrissa reconstruct`, and its rod or scene by --rod";
            return Self::new(span, message);
        }
        if let Some((span, hint)) = number::decimal_comma(text, fault.span.start) {
            return Self::new(span, hint);
        }
        let written = text.get(fault.span.start..).and_then(|rest| rest.lines().next()).unwrap_or_default().trim();
        if let Some(message) = message::duplicate(fault.message(), written) {
            return Self::new(fault.span, message);
        }
        if !fault.message().starts_with("string values must be quoted") {
            return fault;
        }
        let message = format!(
            "the value is `{written}`, expected a number, or a text in quotes: \"{}\"",
            written.split('#').next().unwrap_or_default().trim()
        );
        Self::new(fault.span, message)
    }

    /// The error for the user: `table` is the text's tree, where it has one.
    pub fn in_text(self, file: &Path, text: &str, table: Option<&DeTable<'_>>) -> SceneError {
        let file = file.display().to_string();
        let before = text.get(..self.span.start).unwrap_or(text);
        let start_of_line = before.rfind('\n').map_or(0, |newline| newline + 1);
        SceneError::Invalid(Box::new(Invalid {
            line: line_at(text, self.span.start),
            column: before[start_of_line..].chars().count() + 1,
            field: table.and_then(|table| field_at(table, &self.span)),
            message: self.message_in(text),
            text: NamedSource::new(&file, text.to_owned()).with_language("TOML"),
            span: self.span.into(),
            file,
        }))
    }
}

/// A text with the name of its file, to report faults that show only when the text is used.
#[derive(Clone, Debug)]
pub(crate) struct SourceText {
    file: PathBuf,
    text: String,
}

impl SourceText {
    pub fn new(file: &Path, text: &str) -> Self {
        Self { file: file.to_path_buf(), text: text.to_owned() }
    }

    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The error with its place in the text.
    pub fn place(&self, fault: Fault) -> SceneError {
        let table = DeTable::parse(&self.text).ok();
        fault.in_text(&self.file, &self.text, table.as_ref().map(Spanned::get_ref))
    }

    /// An error at the value of a field, given its path as in `sweep.from`.
    pub fn error(&self, field: &str, message: &str) -> SceneError {
        self.error_at(&[field], message)
    }

    /// An error at the first of these fields that the text has.
    pub fn error_at(&self, fields: &[impl AsRef<str>], message: &str) -> SceneError {
        let table = DeTable::parse(&self.text).ok();
        let table = table.as_ref().map(Spanned::get_ref);
        let place = |table: &DeTable<'_>| fields.iter().find_map(|field| place_of(table, field.as_ref()));
        let span = table.and_then(place).unwrap_or(0..0);
        Fault::new(span, message).in_text(&self.file, &self.text, table)
    }
}

impl From<toml::de::Error> for Fault {
    fn from(error: toml::de::Error) -> Self {
        let message = message::plain(error.message());
        let message = match number::hint_for_quoted_number(&message) {
            Some(hint) => format!("{message}; {hint}"),
            None => message,
        };
        // An error without a place concerns the file as a whole.
        Self::new(error.span().unwrap_or(0..0), message)
    }
}

/// The line of a place, from 1.
fn line_at(text: &str, place: usize) -> usize {
    text.get(..place).unwrap_or(text).matches('\n').count() + 1
}

/// Where the names of the columns are in the text of a table (CSV, TSV), comments before them.
fn table_head(text: &str) -> Option<Range<usize>> {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let (at, line) = (start, line.trim_end());
        start += text[start..].find('\n').map_or(0, |end| end + 1);
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let is_head = line.contains([',', ';', '\t']) && !line.contains(['=', '[', '{']);
        return is_head.then(|| at..at + line.len());
    }
    None
}

/// Path of the smallest field whose key or value holds the span.
fn field_at(table: &DeTable<'_>, span: &Range<usize>) -> Option<String> {
    let mut best: Option<(usize, String)> = None;
    visit(table, "", &mut |place, path| {
        let holds = place.start <= span.start && span.end <= place.end && !span.is_empty();
        if holds && best.as_ref().is_none_or(|(length, _)| place.len() <= *length) {
            best = Some((place.len(), path.to_owned()));
        }
    });
    best.map(|(_, path)| path)
}

/// Where the value of a field stands, given its path as in `sweep.from` or `crosstalk[1][3]`.
pub(crate) fn place_of(table: &DeTable<'_>, path: &str) -> Option<Range<usize>> {
    let mut found = None;
    // The key is seen before the value.
    visit(table, "", &mut |place, seen| {
        if seen == path {
            found = Some(place);
        }
    });
    found
}

/// Calls `seen` with the span and path of every key and every value.
pub(super) fn visit(table: &DeTable<'_>, path: &str, seen: &mut impl FnMut(Range<usize>, &str)) {
    for (key, value) in table {
        let path = if path.is_empty() { key.get_ref().to_string() } else { format!("{path}.{}", key.get_ref()) };
        seen(key.span(), &path);
        visit_value(value, &path, seen);
    }
}

fn visit_value(value: &Spanned<DeValue<'_>>, path: &str, seen: &mut impl FnMut(Range<usize>, &str)) {
    seen(value.span(), path);
    match value.get_ref() {
        DeValue::Table(table) => visit(table, path, seen),
        DeValue::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                visit_value(value, &format!("{path}[{}]", index + 1), seen);
            }
        }
        _ => {}
    }
}
