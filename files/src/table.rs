//! Tables of plain text.

use std::fmt;

/// How many there are of what has a plural in -s.
pub fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// Most characters of a cell; what is longer is shortened.
const WIDEST: usize = 200;

/// Rows of text in columns: words to the left, numbers to the right.
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with these names of columns, and no row.
    pub fn new<'a>(header: impl IntoIterator<Item = &'a str>) -> Self {
        Self { rows: vec![header.into_iter().map(str::to_owned).map(shortened).collect()] }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().map(shortened).collect());
    }

    /// Whether the body of a column, blanks and dashes aside, holds numbers only.
    fn is_numeric(&self, column: usize) -> bool {
        let body = self.rows[1..].iter().filter_map(|row| row.get(column));
        body.filter(|cell| !cell.is_empty() && *cell != "-").all(|cell| cell.parse::<f64>().is_ok())
    }
}

/// Text of at most 200 characters, with an ellipsis where it was longer.
pub fn shortened(text: String) -> String {
    match text.char_indices().nth(WIDEST) {
        Some(_) => text.chars().take(WIDEST - 1).chain(['…']).collect(),
        None => text,
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width =
            |column: usize| self.rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
        let layout: Vec<_> = (0..columns).map(|column| (width(column).unwrap_or(0), self.is_numeric(column))).collect();
        for row in &self.rows {
            let mut line = String::new();
            for (cell, (width, numeric)) in row.iter().zip(&layout) {
                line += "  ";
                line += &if *numeric { format!("{cell:>width$}") } else { format!("{cell:<width$}") };
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_has_no_plural() {
        assert_eq!([0, 1, 2].map(|count| counted(count, "kink")), ["0 kinks", "1 kink", "2 kinks"]);
    }

    #[test]
    fn long_cells_are_shortened() {
        let mut table = Table::new(["name"]);
        table.row(["ä".repeat(70_000)]);
        assert_eq!(table.to_string().lines().nth(1).map(|line| line.chars().count()), Some(202));
        assert!(table.to_string().ends_with("ä…\n"));
    }

    #[test]
    fn numbers_stand_right_and_words_left() {
        let mut table = Table::new(["kind", "x0"]);
        table.row(["touch".into(), "-1.5".into()]);
        table.row(["snap-off".into(), "-".into()]);
        assert_eq!(table.to_string(), "  kind        x0\n  touch     -1.5\n  snap-off     -\n");
    }
}
