//! Detects how a table is written, from its first lines.

use super::date;
use super::error::{TableError, TableProblem};
use super::fault::shown;
use super::heading::is_unit;
use super::number::{has_fraction, number};
use super::options::{Decimal, Delimiter, Header, TableOptions};
use super::role::parted;
use super::split::{Splitter, comment};
use std::borrow::Cow;

/// A line that is not blank.
pub(super) struct Line<'t> {
    /// From 1.
    pub number: u64,
    pub text: Cow<'t, str>,
}

/// How a table is written.
#[derive(Debug)]
pub(super) struct Layout {
    pub delimiter: Delimiter,
    pub decimal: Decimal,
    /// Line of the names.
    pub header: Option<u64>,
    pub headings: Vec<String>,
    /// Cells of the row of units.
    pub units: Option<Vec<String>>,
    /// Its line.
    pub units_line: Option<u64>,
    /// From here on there are rows.
    pub first: u64,
}

/// A line with its cells.
struct Row {
    line: u64,
    comment: bool,
    cells: Vec<String>,
    /// How many of them are numbers, and how many something else.
    numbers: usize,
    texts: usize,
}

impl Row {
    /// A row of the table, if it is one: perhaps with remarks.
    fn is_data(&self) -> bool {
        !self.comment && self.numbers > self.texts
    }

    fn is_names(&self) -> bool {
        self.numbers == 0 && self.texts > 0
    }

    fn is_units(&self) -> bool {
        let known = self.cells.iter().filter(|cell| is_unit(cell)).count();
        !self.comment && self.numbers == 0 && self.texts > 0 && 2 * known >= self.texts
    }

    /// Whether it can stand below so many names: cells beyond them are empty.
    fn fits(&self, names: usize) -> bool {
        self.cells.len() >= names && self.cells[names..].iter().all(String::is_empty)
    }

    /// The names, without empty ones at the end.
    fn names(&self) -> Vec<String> {
        let mut names = self.cells.clone();
        while names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        names
    }
}

impl Layout {
    pub fn find(file: &str, lines: &[Line<'_>], options: &TableOptions) -> Result<Self, TableError> {
        let body: Vec<&Line<'_>> = lines.iter().filter(|line| comment(&line.text).is_none()).collect();
        let (delimiter, blanks) = match options.delimiter {
            Some(delimiter) => (delimiter, None),
            None => sniff(&body, options.decimal),
        };
        let mut splitter = Splitter::new(delimiter);
        let cells: Vec<Vec<String>> = lines
            .iter()
            .map(|line| {
                let cells = splitter.cells(comment(&line.text).unwrap_or(&line.text));
                if delimiter == Delimiter::Blanks { with_units(cells) } else { cells }
            })
            .collect();
        let decimal = match options.decimal.or(blanks) {
            Some(decimal) => decimal,
            None => mark(file, lines, &cells)?,
        };
        let rows: Vec<Row> = lines.iter().zip(cells).map(|(line, cells)| Row::new(line, cells, decimal)).collect();
        let found =
            Self { delimiter, decimal, header: None, headings: Vec::new(), units: None, units_line: None, first: 0 };
        let guessed = options.delimiter.is_none() && options.decimal.is_none();
        found.below_header(file, lines, &rows, &options.header, guessed)
    }

    fn below_header(
        mut self,
        file: &str,
        lines: &[Line<'_>],
        rows: &[Row],
        header: &Header,
        guessed: bool,
    ) -> Result<Self, TableError> {
        let first = rows.iter().position(Row::is_data);
        let names = match header {
            Header::Find => names(rows, first),
            Header::Line(wanted) => {
                let last = lines.last().map_or(0, |line| line.number);
                let at = rows.iter().position(|row| row.line == *wanted && !row.names().is_empty());
                Some(at.ok_or(TableProblem::NoSuchLine { line: *wanted, lines: last }.at(file, None))?)
            }
            Header::None | Header::Names(_) => None,
        };
        if names.is_none() {
            // the first row, below whatever there is
            let Some(row) = first.map(|first| &rows[first]) else {
                return Err(TableProblem::Empty.at(file, None));
            };
            self.first = row.line;
            self.headings = match header {
                Header::Names(names) => names.clone(),
                Header::None => (1..=row.cells.len()).map(|i| i.to_string()).collect(),
                _ => return Err(TableProblem::NoHeader.at(file, row.line)),
            };
        }
        let mut below = first.unwrap_or(rows.len());
        if let Some(at) = names {
            self.header = Some(rows[at].line);
            self.headings = rows[at].names();
            below = at + 1;
            let next = rows[below..].iter().position(|row| !row.comment).map(|next| below + next);
            if let Some(next) = next.filter(|next| rows[*next].is_units() && rows[*next].fits(self.headings.len())) {
                self.units = Some(rows[next].cells.clone());
                self.units_line = Some(rows[next].line);
                below = next + 1;
                if *header == Header::Find {
                    below += remarks(&rows[below..]);
                }
            }
            // comments between the names and the rows are read with them
            self.first = rows[below - 1].line + 1;
        }
        self.check(file, lines, &rows[below.min(rows.len())..], guessed)?;
        Ok(self)
    }

    /// Whether most rows have as many cells as there are names.
    fn check(&self, file: &str, lines: &[Line<'_>], rows: &[Row], guessed: bool) -> Result<(), TableError> {
        let names = self.headings.len();
        let data: Vec<&Row> = rows.iter().filter(|row| row.is_data()).collect();
        let cells = most_common(data.iter().filter(|row| !row.fits(names)).map(|row| row.cells.len()));
        let mut misfits = data.iter().filter(|row| !row.fits(names) && row.cells.len() == cells);
        let count = misfits.clone().count();
        let Some(misfit) = misfits.next().filter(|_| 2 * count > data.len()) else {
            return Ok(());
        };
        let points = data.iter().any(|row| row.cells.iter().any(|cell| has_fraction(cell, Decimal::Point)));
        if guessed && self.delimiter == Delimiter::Comma && cells > names && !points {
            let text = lines.iter().find(|line| line.number == misfit.line).map_or("", |line| &line.text);
            return Err(TableProblem::AmbiguousComma { text: shown(text), names, cells }.at(file, misfit.line));
        }
        let line = self.header.unwrap_or(misfit.line);
        let remedy = match self.headings.iter().find(|name| cells > names && parted(name).is_some()) {
            Some(two) => {
                format!("a delimiter is missing in `{two}`; correct line {line}, or give the names in the options")
            }
            None => format!("correct line {line}, or give the names or the delimiter in the options"),
        };
        Err(TableProblem::HeaderWidth { names, cells, delimiter: self.delimiter, remedy }.at(file, line))
    }
}

/// The line of the names: the first one that fits the rows and has one of them below, perhaps after a row of units; or a comment
/// right before the rows; or, where nothing fits, the line before the first row.
fn names(rows: &[Row], first: Option<usize>) -> Option<usize> {
    let Some(first) = first else {
        // no row at all: names without rows, unless there are only comments
        return rows.iter().position(|row| !row.comment);
    };
    let width = most_common(rows.iter().filter(|row| row.is_data()).map(|row| row.cells.len()));
    let fits = |row: &Row| {
        let names = row.names().len();
        row.is_names()
            && (names == width || names < width && rows.iter().filter(|row| row.is_data()).all(|row| row.fits(names)))
    };
    let text: Vec<usize> = (0..rows.len()).filter(|&i| !rows[i].comment).collect();
    let above = text.windows(2).find(|pair| fits(&rows[pair[0]]) && rows[pair[1]].is_data()).map(|pair| pair[0]);
    let with_units = |triple: &&[usize]| {
        let [names, units] = [&rows[triple[0]], &rows[triple[1]]];
        let below = &rows[triple[1] + 1..];
        let data = below.get(remarks(below)).is_some_and(Row::is_data) || rows[triple[2]].is_data();
        fits(names) && units.is_units() && units.cells.len() >= names.names().len() && data
    };
    let above_units = text.windows(3).find(with_units).map(|triple| triple[0]);
    // where the row of units passes for names, the names are above it
    let found = above.into_iter().chain(above_units).min();
    let commented = first.checked_sub(1).filter(|&i| rows[i].comment && fits(&rows[i]));
    found.or(commented).or_else(|| rows[..first].iter().rposition(|row| !row.comment && row.is_names()))
}

/// Most rows of remarks between the units and the rows. More: a table without a row of numbers near it is taken for remarks.
const MOST_REMARKS: usize = 3;

/// How many rows of text are above the first row of numbers: remarks below the units. None where there are more than a header has.
fn remarks(rows: &[Row]) -> usize {
    let count = rows.iter().take_while(|row| !row.is_data()).count();
    if count <= MOST_REMARKS && rows[..count].iter().all(|row| row.comment || row.is_names()) { count } else { 0 }
}

fn most_common(counts: impl Iterator<Item = usize>) -> usize {
    let mut tally: Vec<(usize, usize)> = Vec::new();
    for count in counts {
        match tally.iter_mut().find(|(known, _)| *known == count) {
            Some((_, times)) => *times += 1,
            None => tally.push((count, 1)),
        }
    }
    tally.into_iter().max_by_key(|(count, times)| (*times, *count)).map_or(0, |(count, _)| count)
}

impl Row {
    fn new(line: &Line<'_>, cells: Vec<String>, decimal: Decimal) -> Self {
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
        let numbers =
            cells.iter().filter(|cell| number(cell, decimal).is_some() || date::seconds(cell).is_some()).count();
        let comment = comment(&line.text).is_some();
        Self { line: line.number, comment, cells, numbers, texts: filled - numbers }
    }
}

/// What separates the cells, and the decimal mark where that shows in the same.
fn sniff(body: &[&Line<'_>], decimal: Option<Decimal>) -> (Delimiter, Option<Decimal>) {
    let rows: Vec<&str> = body.iter().map(|line| &*line.text).filter(|line| is_numeric(line)).collect();
    let lines = if rows.is_empty() { body.iter().map(|line| &*line.text).collect() } else { rows };
    let most = |holds: &dyn Fn(&str) -> bool| 2 * lines.iter().filter(|line| holds(line)).count() > lines.len();
    let parts = |line: &str| line.split_whitespace().count() > 1;
    let commas = |line: &str| {
        let numbers = line.split_whitespace().all(|cell| number(cell, Decimal::Comma).is_some());
        parts(line) && numbers && line.contains(',')
    };
    if most(&|line| line.contains('\t')) {
        (Delimiter::Tab, None)
    } else if most(&|line| line.contains(';')) {
        (Delimiter::Semicolon, None)
    } else if most(&commas) {
        (Delimiter::Blanks, Some(Decimal::Comma))
    } else if most(&|line| line.contains(',')) && decimal != Some(Decimal::Comma) {
        (Delimiter::Comma, None)
    } else if most(&parts) {
        (Delimiter::Blanks, None)
    } else if decimal == Some(Decimal::Comma) {
        // one column
        (Delimiter::Semicolon, None)
    } else {
        (Delimiter::Comma, None)
    }
}

/// Whether a line is mostly made of what numbers and what separates them is made of.
fn is_numeric(line: &str) -> bool {
    let of_numbers = |c: &char| {
        c.is_ascii_digit() || c.is_whitespace() || matches!(c, '+' | '-' | '.' | ',' | ';' | 'e' | 'E' | '"' | '\'')
    };
    let count = line.chars().filter(of_numbers).count();
    line.contains(|c: char| c.is_ascii_digit()) && 10 * count >= 7 * line.chars().count()
}

/// The decimal mark, where cells with fractions agree on one.
fn mark(file: &str, lines: &[Line<'_>], cells: &[Vec<String>]) -> Result<Decimal, TableError> {
    let mut found: [Option<(u64, &str)>; 2] = [None, None];
    for (line, cells) in lines.iter().zip(cells).filter(|(line, _)| comment(&line.text).is_none()) {
        for cell in cells {
            for (found, decimal) in found.iter_mut().zip([Decimal::Point, Decimal::Comma]) {
                if found.is_none() && has_fraction(cell, decimal) {
                    *found = Some((line.number, cell));
                }
            }
        }
    }
    match found {
        [Some((point_line, point)), Some((comma_line, comma))] => {
            let (point, comma) = (shown(point), shown(comma));
            Err(TableProblem::MixedDecimals { point, point_line, comma, comma_line }.at(file, None))
        }
        [None, Some(_)] => Ok(Decimal::Comma),
        _ => Ok(Decimal::Point),
    }
}

/// Between blanks, `Fx [N]` is one name: what is in brackets belongs to the name before.
fn with_units(cells: Vec<String>) -> Vec<String> {
    let closed = |name: &str| name.matches(['[', '(']).count() <= name.matches([']', ')']).count();
    let mut joined: Vec<String> = Vec::new();
    for cell in cells {
        match joined.last_mut() {
            Some(last) if cell.starts_with(['[', '(']) && !last.ends_with([']', ')']) || !closed(last) => {
                last.push(' ');
                last.push_str(&cell);
            }
            _ => joined.push(cell),
        }
    }
    joined
}
