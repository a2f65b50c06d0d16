//! From text to lines, and from lines to cells.

use super::options::Delimiter;
use csv_core::ReadRecordResult;
use std::borrow::Cow;
use std::io::BufRead;

/// Columns there may be.
pub(super) const MOST_COLUMNS: usize = 4096;

/// Lines with their numbers, from 1, as an editor counts them. A file without any line feed has carriage returns.
#[derive(Clone, Debug)]
pub(super) struct Lines<'t> {
    rest: &'t [u8],
    end: u8,
    number: u64,
}

impl<'t> Lines<'t> {
    pub fn new(text: &'t [u8]) -> Self {
        let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
        Self { rest: text, end, number: 0 }
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = (u64, Cow<'t, str>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let (all, mut rest) = (self.rest, self.rest);
        // bytes in memory can always be read; this looks for the end many bytes at a time
        let length = rest.skip_until(self.end).unwrap_or(all.len());
        let (line, rest) = all.split_at(length.min(all.len()));
        let line = line.strip_suffix(&[self.end]).unwrap_or(line);
        self.rest = rest;
        self.number += 1;
        Some((self.number, text(line.strip_suffix(b"\r").unwrap_or(line))))
    }
}

/// The text of bytes, which are Latin-1 where they are not UTF-8: older programs write degrees and micro signs so.
pub(super) fn text(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
    }
}

/// The text of a comment, if the line is one.
pub(super) fn comment(line: &str) -> Option<&str> {
    let marks = |line: &str| line.starts_with(['#', '%']) || line.starts_with("//");
    if is_plain(line) && !marks(line) {
        return None;
    }
    let line = plain(line);
    marks(line).then(|| line.trim_start_matches(['#', '%', '/']).trim())
}

/// A cell without blanks and quotes around it.
pub(super) fn plain(cell: &str) -> &str {
    if is_plain(cell) {
        return cell;
    }
    let cell = cell.trim();
    match cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')) {
        Some(inner) => inner.trim(),
        None => cell,
    }
}

/// Whether there is nothing to take away, as far as the first and last byte tell: most cells are such.
fn is_plain(cell: &str) -> bool {
    let bytes = cell.as_bytes();
    let solid = |byte: Option<&u8>| byte.is_some_and(|byte| byte.is_ascii_graphic() && *byte != b'"');
    solid(bytes.first()) && solid(bytes.last())
}

/// Splits lines at a delimiter. A quoted cell may hold delimiters, but no ends of lines: a quote that is not closed spoils one
/// row and not all that follow.
pub(super) struct Splitter {
    delimiter: Delimiter,
    quotes: bool,
    reader: csv_core::Reader,
    unquoted: Vec<u8>,
    ends: Vec<usize>,
}

impl Splitter {
    pub fn new(delimiter: Delimiter) -> Self {
        let reader = csv_core::ReaderBuilder::new()
            .delimiter(byte(delimiter))
            .terminator(csv_core::Terminator::Any(b'\n'))
            .build();
        Self { delimiter, quotes: true, reader, unquoted: Vec::new(), ends: Vec::new() }
    }

    /// Quotes are letters like others.
    pub fn without_quotes(delimiter: Delimiter) -> Self {
        Self { quotes: false, ..Self::new(delimiter) }
    }

    /// Hands on all cells of a line, without blanks and quotes around them, and returns how many there are.
    pub fn each(&mut self, line: &str, mut f: impl FnMut(usize, &str)) -> usize {
        if self.delimiter == Delimiter::Blanks {
            return line.split_whitespace().map(plain).enumerate().map(|(i, cell)| f(i, cell)).count();
        }
        if !self.quotes || !line.contains('"') {
            let delimiter = byte(self.delimiter);
            let (mut start, mut count) = (0, 0);
            // byte by byte, for cells are short
            for (at, _) in line.bytes().enumerate().filter(|(_, byte)| *byte == delimiter) {
                f(count, plain(line.get(start..at).unwrap_or_default()));
                (start, count) = (at + 1, count + 1);
            }
            f(count, plain(line.get(start..).unwrap_or_default()));
            return count + 1;
        }
        let count = self.unquote(line);
        let mut start = 0;
        for (i, end) in self.ends[..count].iter().enumerate() {
            let cell = self.unquoted.get(start..*end).unwrap_or_default();
            f(i, plain(std::str::from_utf8(cell).unwrap_or_default()));
            start = *end;
        }
        count
    }

    fn unquote(&mut self, line: &str) -> usize {
        self.reader.reset();
        // cells take no more room than the line, and there is one more of them than delimiters
        let room = line.len() + 2;
        if self.unquoted.len() < room {
            self.unquoted.resize(room, 0);
            self.ends.resize(room, 0);
        }
        let (mut input, mut written, mut count) = (line.as_bytes(), 0, 0);
        loop {
            let (result, read, bytes, ends) =
                self.reader.read_record(input, &mut self.unquoted[written..], &mut self.ends[count..]);
            (input, written, count) = (&input[read..], written + bytes, count + ends);
            match result {
                // no more input is the end of the line
                ReadRecordResult::InputEmpty => {}
                _ => return count,
            }
        }
    }

    /// The cells of a line, as many as a table may have and one more, so that a long line takes no more room than it has to.
    pub fn cells(&mut self, line: &str) -> Vec<String> {
        let mut cells = Vec::new();
        self.each(line, |i, cell| {
            if i <= MOST_COLUMNS {
                cells.push(cell.to_owned());
            }
        });
        cells
    }
}

fn byte(delimiter: Delimiter) -> u8 {
    match delimiter {
        Delimiter::Comma => b',',
        Delimiter::Semicolon => b';',
        Delimiter::Tab | Delimiter::Blanks => b'\t',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_all_systems() {
        for text in ["a\n\nb", "a\r\n\r\nb\r\n", "a\r\rb\r"] {
            let lines: Vec<_> = Lines::new(text.as_bytes()).map(|(n, line)| (n, line.into_owned())).collect();
            assert_eq!(lines, [(1, "a".into()), (2, String::new()), (3, "b".into())], "{text:?}");
        }
        assert_eq!(text(b"phi [\xb0]"), "phi [°]");
    }

    #[test]
    fn cells() {
        let cells = |delimiter, line: &str| Splitter::new(delimiter).cells(line);
        assert_eq!(cells(Delimiter::Comma, "a, b ,,\"c\",d"), ["a", "b", "", "c", "d"]);
        assert_eq!(cells(Delimiter::Comma, "\"0,5\", \"2\",\"a \"\"b\"\"\""), ["0,5", "2", "a \"b\""]);
        assert_eq!(cells(Delimiter::Comma, "1,\"2,3\n4"), ["1", "2,3\n4"]);
        assert_eq!(cells(Delimiter::Comma, ""), [""]);
        assert_eq!(cells(Delimiter::Tab, "1\t\t2\t"), ["1", "", "2", ""]);
        assert_eq!(cells(Delimiter::Blanks, "  1  2\t3 "), ["1", "2", "3"]);
        assert_eq!(Splitter::without_quotes(Delimiter::Comma).cells("5\",\"6"), ["5\"", "\"6"]);
        assert_eq!(comment("  # x: 1"), Some("x: 1"));
    }

    proptest::proptest! {
        #[test]
        fn any_line_is_split(line in "[ab\",;\t ]{0,40}") {
            for delimiter in [Delimiter::Comma, Delimiter::Semicolon, Delimiter::Tab, Delimiter::Blanks] {
                let mut counted = 0;
                let count = Splitter::new(delimiter).each(&line, |i, _| { assert_eq!(i, counted); counted += 1 });
                assert_eq!(count, counted);
                assert!(count <= line.len() + 1);
            }
        }
    }
}
