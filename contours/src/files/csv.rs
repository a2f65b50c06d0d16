//! Points from a table.

use std::path::Path;

use super::FileError;
use crate::Point;

/// The points of a CSV file: the columns x and y of its header, in the unit the file uses; other columns are ignored.
///
/// ```
/// let directory = std::env::temp_dir().join("rod-contours-points");
/// std::fs::create_dir_all(&directory)?;
/// let file = directory.join("points.csv");
/// std::fs::write(&file, "name, x, y\nfirst, 0, 1e-3\nsecond, 0.5, 2\n")?;
/// assert_eq!(rod_contours::file::points(&file)?, [[0.0, 1e-3], [0.5, 2.0]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`FileError`] names the line, the column and the text of a cell that is not a finite number.
pub fn points(file: &Path) -> Result<Vec<Point>, FileError> {
    points_with_lines(file).map(|points| points.into_iter().map(|(point, _)| point).collect())
}

/// The points, each with its line, from 1.
pub(crate) fn points_with_lines(file: &Path) -> Result<Vec<(Point, u64)>, FileError> {
    let text = super::text(file)?;
    // A mark that some programs put before the text.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let malformed = |error: csv::Error| {
        let line = error.position().map_or(1, |place| Lines::of(text).line(place));
        let message = match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                format!("{len} columns, expected {expected_len} as in the header")
            }
            _ => error.to_string(),
        };
        FileError::Malformed { file: file.to_path_buf(), line, message }
    };
    let mut table = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = table.headers().map_err(malformed)?.clone();
    let column = |column: &'static str| {
        header.iter().position(|name| name == column).map(|index| (column, index)).ok_or_else(|| FileError::Column {
            file: file.to_path_buf(),
            column,
            header: header.iter().collect::<Vec<_>>().join(","),
        })
    };
    let columns = [column("x")?, column("y")?];
    let mut lines = Lines::of(text);
    let mut points = Vec::new();
    for record in table.records() {
        let record = record.map_err(malformed)?;
        let line = record.position().map_or(1, |place| lines.line(place));
        let number = |(column, index): (&'static str, usize)| {
            let text = record.get(index).unwrap_or_default();
            text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| FileError::Cell {
                file: file.to_path_buf(),
                line,
                column,
                text: text.to_owned(),
            })
        };
        points.push(([number(columns[0])?, number(columns[1])?], line));
    }
    Ok(points)
}

/// Counts lines up to places that come in order. The reader does not count the empty ones before a record.
struct Lines<'a> {
    text: &'a [u8],
    seen: usize,
    line: u64,
}

impl<'a> Lines<'a> {
    fn of(text: &'a str) -> Self {
        Self { text: text.as_bytes(), seen: 0, line: 1 }
    }

    /// The line, from 1, of the record that starts at this place or after the empty lines there.
    fn line(&mut self, place: &csv::Position) -> u64 {
        let start = usize::try_from(place.byte()).unwrap_or(usize::MAX).clamp(self.seen, self.text.len());
        let empty = self.text[start..].iter().take_while(|byte| matches!(byte, b'\n' | b'\r')).count();
        let start = start + empty;
        self.line += self.text[self.seen..start].iter().filter(|byte| **byte == b'\n').count() as u64;
        self.seen = start;
        self.line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<(Point, u64)>, String> {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("points.csv");
        std::fs::write(&file, text).unwrap();
        points_with_lines(&file).map_err(|error| error.to_string().replace(directory.path().to_str().unwrap(), ""))
    }

    #[test]
    fn columns_in_any_order() {
        assert_eq!(read("y,t,x\n1,9,2\n\n3,9,-4e-3\n").unwrap(), [([2.0, 1.0], 2), ([-4e-3, 3.0], 4)]);
        assert_eq!(read("\u{feff}x,y\r\n1,2\r\n").unwrap(), [([1.0, 2.0], 2)]);
        assert_eq!(read("x,y\n").unwrap(), []);
    }

    #[test]
    fn what_is_no_table_of_points() {
        assert_eq!(
            read("x;y\n1;2\n").unwrap_err(),
            "/points.csv: no column x in the header \"x;y\", expected columns named x and y, separated by commas"
        );
        let expected = "/points.csv:3: column y is \"abc\", expected a finite number";
        assert_eq!(read("x,y\n0,0\n1, abc\n").unwrap_err(), expected);
        assert_eq!(read("x,y\n0,0\n1,NaN\n").unwrap_err(), expected.replace("abc", "NaN"));
        assert_eq!(read("x,y\n0,0\n1,\n").unwrap_err(), expected.replace("abc", ""));
        assert_eq!(read("x,y\n0,0\n1\n").unwrap_err(), "/points.csv:3: 1 columns, expected 2 as in the header");
        assert!(points("nowhere.csv".as_ref()).unwrap_err().to_string().starts_with("cannot read nowhere.csv: "));
    }
}
