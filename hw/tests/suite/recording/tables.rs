//! Tables as other programs write them: dirty, and refused where they are ambiguous.

use rod_hw::recording::{Cell, Decimal, Delimiter, Header, Row, Table, TableOptions};

fn parse(text: &str) -> Table {
    Table::parse("f.csv", text.as_bytes(), &TableOptions::default()).unwrap()
}

fn names(table: &Table) -> Vec<&str> {
    table.columns().iter().map(|column| column.name.as_str()).collect()
}

fn units(table: &Table) -> Vec<Option<&str>> {
    table.columns().iter().map(|column| column.unit.as_deref()).collect()
}

fn numbers(table: &Table) -> Vec<Vec<f64>> {
    let width = table.columns().len();
    table.rows().map(|row| (0..width).map(|i| row.number(i).unwrap_or(f64::NAN)).collect()).collect()
}

/// Checks that there is no table, and that the message holds all these parts.
fn refuses(text: &str, options: &TableOptions, parts: &[&str]) {
    let message = Table::parse("f.csv", text.as_bytes(), options).unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn delimiters_and_decimal_marks() {
    let expected = [[0.0, 0.5, -1.25], [0.1, 1.0, 2e-3]];
    for text in [
        "t,Fx,Fy\n0,0.5,-1.25\n0.1,1,2e-3\n",
        "t, Fx, Fy\n0, 0.5, -1.25\n0.1, 1, 2e-3\n",
        "t;Fx;Fy\n0;0.5;-1.25\n0.1;1;2e-3\n",
        "t;Fx;Fy\n0;0,5;-1,25\n0,1;1;2e-3\n",
        "t\tFx\tFy\n0\t0,5\t-1,25\n0,1\t1\t2e-3\n",
        "t\tFx\tFy\n0\t0.5\t-1.25\n0.1\t1\t2e-3\n",
        "t Fx Fy\n0 0.5 -1.25\n0.1 1 2e-3\n",
        "   t     Fx   Fy\n   0    0.5  -1.25\n  0.1    1   2e-3\n",
        "t Fx Fy\n0 0,5 -1,25\n0,1 1 2e-3\n",
        "t,Fx,Fy\n\"0\",\"0,5\",\"-1,25\"\n\"0,1\",\"1\",\"2e-3\"\n",
        "# t,Fx,Fy\n0,0.5,-1.25\n0.1,1,2e-3\n",
        "% made by a script\n% t Fx Fy\n0 0.5 -1.25\n0.1 1 2e-3\n",
        "\u{feff}t,Fx,Fy\r\n0,0.5,-1.25\r\n0.1,1,2e-3\r\n",
        "t,Fx,Fy\r0,0.5,-1.25\r0.1,1,2e-3\r",
        "t,Fx,Fy,\n0,0.5,-1.25,\n0.1,1,2e-3,\n",
        "t,Fx,Fy\n0,0.5,-1.25,,\n0.1,1,2e-3,,\n",
        "t;Fx;Fy\n\n0;0.5;-1.25\n# a remark\n\n0.1;1;2e-3",
    ] {
        let table = parse(text);
        assert_eq!(names(&table), ["t", "Fx", "Fy"], "{text:?}");
        assert_eq!(numbers(&table), expected, "{text:?}");
    }
}

#[test]
fn units_above_and_below() {
    for text in [
        "t [s],Fx [mN],phi0 [°]\n0,1,2\n",
        "t (s);Fx (mN);phi0 (°)\n0;1;2\n",
        "t / s\tFx / mN\tphi0 / °\n0\t1\t2\n",
        "t,Fx,phi0\ns,mN,°\n0,1,2\n",
        "t,Fx,phi0\n[s],[mN],[°]\n0,1,2\n",
        "t [s] Fx [mN] phi0 [°]\n0 1 2\n",
        "Sensor;K3D40;\nt;Fx;phi0\ns;mN;°\n0;1;2\n",
    ] {
        let table = parse(text);
        assert_eq!(names(&table), ["t", "Fx", "phi0"], "{text:?}");
        assert_eq!(units(&table), [Some("s"), Some("mN"), Some("°")], "{text:?}");
        assert_eq!(numbers(&table), [[0.0, 1.0, 2.0]]);
    }
    // older programs write Latin-1
    let table = Table::parse("f.csv", b"x,phi0 [\xb0]\n1,2\n", &TableOptions::default()).unwrap();
    assert_eq!(units(&table), [None, Some("°")]);
    let options = TableOptions { units: vec![("x".into(), "mm".into())], ..TableOptions::default() };
    assert_eq!(units(&Table::parse("f.csv", b"x [V],y\n1,2\n", &options).unwrap()), [Some("mm"), None]);
    let options = TableOptions { units: vec![("z".into(), "mm".into())], ..TableOptions::default() };
    refuses("x,y\n1,2\n", &options, &["f.csv: no column `z`, for which the option `unit` gives one; found x, y"]);
}

#[test]
fn preambles() {
    let text = "Messung vom 3.5.2024, 12:30\nSensor: K3D40, Nr. 12\nRate, 500\n\nt,Fx,Fy\n0,1,2\n1,1,2\n";
    let table = parse(text);
    assert_eq!((names(&table), table.header_line()), (vec!["t", "Fx", "Fy"], Some(5)));
    assert_eq!(table.rows().map(|row| row.line()).collect::<Vec<_>>(), [6, 7]);
    assert_eq!(table.note("Sensor"), Some("K3D40, Nr. 12"));
    // of the same width as the table
    let table = parse("Rate;500\nName;scan 3\nt;Fx\n0;1\n1;1\n");
    assert_eq!((names(&table), table.len()), (vec!["t", "Fx"], 2));
    // a line of text between rows is no header
    let table = parse("t,Fx\n0,1\ngain,changed\n1,1\n2,2\n");
    assert_eq!((names(&table), table.len()), (vec!["t", "Fx"], 4));
    assert_eq!(table.rows().nth(1).unwrap().cell(0), Cell::Text("gain"));
    let table = parse("# made: by hand, \"quoted\n# 5, 6\nt,Fx\n0,1\n# end: here\n");
    assert_eq!((names(&table), numbers(&table)), (vec!["t", "Fx"], vec![vec![0.0, 1.0]]));
    assert_eq!((table.note("made"), table.note("end")), (Some("by hand, \"quoted"), Some("here")));
}

#[test]
fn cells_that_are_no_numbers() {
    let table = parse("t,Fx,note\n0,,start\n1,NaN,\n2,inf,a\n3,?,a\n4,N/A,\"b, c\"\n");
    let row = |i| table.rows().nth(i).unwrap();
    let problem = |row: Row<'_>| row.number(1).unwrap_err().to_string();
    assert_eq!(problem(row(0)), "Fx is empty, expected a number");
    assert_eq!(problem(row(1)), "Fx is NaN, expected a finite number");
    assert_eq!(problem(row(2)), "Fx is inf, expected a finite number");
    assert_eq!(problem(row(3)), "Fx is `?`, expected a number");
    assert_eq!(problem(row(4)), "Fx is NaN, expected a finite number");
    let notes: Vec<Cell<'_>> = table.rows().map(|row| row.cell(2)).collect();
    assert_eq!(notes, [Cell::Text("start"), Cell::Empty, Cell::Text("a"), Cell::Text("a"), Cell::Text("b, c")]);
    assert_eq!(row(0).cell(3), Cell::Empty);
}

#[test]
fn rows_of_another_length_and_a_cut_file() {
    let table = parse("t,Fx,Fy\n0,1,2\n1,1\n2,1,2,3\n3,1,2,,\n4,1");
    let faults: Vec<String> = table.faults().map(|fault| fault.to_string()).collect();
    assert_eq!(
        faults,
        [
            "line 3: the number of cells is 2, expected 3",
            "line 4: the number of cells is 4, expected 3",
            "line 6: the number of cells is 2, expected 3; the file was cut there"
        ]
    );
    assert_eq!(table.len(), 5);
    // a quote that is not closed spoils one row
    let table = parse("t,Fx,Fy\n0,\"1,2\n1,1,2\n");
    assert_eq!(table.faults().count(), 1);
    assert_eq!(table.rows().nth(1).unwrap().number(2), Ok(2.0));
}

#[test]
fn headers_that_do_not_fit() {
    // as the export of a data acquisition program has it, with the last row cut
    let text = "Fx,Fy,FzTx,Ty,Tz\n0.1,0.2,0.3,0.001,0.002,0.003\n0.1,0.2,0.3,0.001,0.002,0.003\n0.1,0.2,0.3,0.0";
    let default = TableOptions::default();
    refuses(
        text,
        &default,
        &[
            "f.csv:1: 5 names, but 6 cells in most rows (commas between them), expected as many; a delimiter is missing in `FzTx`; correct line 1, or give the names in the options",
        ],
    );
    let names_given = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"].map(String::from).to_vec();
    let options = TableOptions { header: Header::Names(names_given), ..TableOptions::default() };
    let table = Table::parse("f.csv", text.as_bytes(), &options).unwrap();
    assert_eq!((names(&table)[3], table.len(), table.faults().count()), ("Tx", 3, 1));
    refuses(
        "t,Fx,Fy,Fz\n0,1.5,2\n1,1,2\n",
        &default,
        &["f.csv:1: 4 names, but 3 cells", "; correct line 1, or give the"],
    );

    refuses("1,2\n3,4\n", &default, &["f.csv:1: the first line holds numbers, expected the names"]);
    let options = TableOptions { header: Header::None, ..TableOptions::default() };
    let table = Table::parse("f.csv", b"1,2\n3,4\n", &options).unwrap();
    assert_eq!((names(&table), numbers(&table)), (vec!["1", "2"], vec![vec![1.0, 2.0], vec![3.0, 4.0]]));
    let options = TableOptions { header: Header::Line(2), ..TableOptions::default() };
    let table = Table::parse("f.csv", b"a,b\n1,2\n3,4\n", &options).unwrap();
    assert_eq!((names(&table), numbers(&table)), (vec!["1", "2"], vec![vec![3.0, 4.0]]));
    let options = TableOptions { header: Header::Line(7), ..TableOptions::default() };
    refuses("a,b\n1,2\n", &options, &["f.csv: no line 7 with names of columns", "the file has 2 lines"]);
    for text in ["", "\n\n", "# only this\n", "\u{feff}"] {
        refuses(text, &default, &["f.csv: no line that names columns"]);
    }
    assert_eq!((names(&parse("x0,y0\n")), parse("x0,y0\n").len()), (vec!["x0", "y0"], 0));
}

#[test]
fn ambiguous_commas() {
    let default = TableOptions::default();
    let text = "t,Fx\n0,5,1,25\n0,75,2,5\n";
    refuses(
        text,
        &default,
        &[
            "f.csv:2: `0,5,1,25` could be numbers with decimal commas or numbers separated by commas (4 of them, under 2 names); say which in the options",
        ],
    );
    refuses("Fx\n0,5\n1,5\n", &default, &["could be numbers with decimal commas"]);
    let options = TableOptions { decimal: Some(Decimal::Comma), ..TableOptions::default() };
    let table = Table::parse("f.csv", b"Fx\n0,5\n1,5\n", &options).unwrap();
    assert_eq!(numbers(&table), [[0.5], [1.5]]);
    let names = ["a", "b", "c", "d"].map(String::from).to_vec();
    let options =
        TableOptions { delimiter: Some(Delimiter::Comma), header: Header::Names(names), ..TableOptions::default() };
    let table = Table::parse("f.csv", text.as_bytes(), &options).unwrap();
    assert_eq!(numbers(&table)[0], [0.0, 5.0, 1.0, 25.0]);
    // whole numbers under as many names are not ambiguous
    assert_eq!(numbers(&parse("a,b,c,d\n0,5,1,25\n")), [[0.0, 5.0, 1.0, 25.0]]);
    refuses(
        "t;Fx\n0,5;1\n1;0.5\n",
        &default,
        &["f.csv: `0.5` in line 3 has a decimal point, `0,5` in line 2 a decimal comma, expected the same"],
    );
}

#[test]
fn two_bytes_a_letter() {
    for bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        let text: Vec<u8> = "\u{feff}x\tphi0 [°]\r\n0,5\t2\r\n".encode_utf16().flat_map(bytes).collect();
        let table = Table::parse("f.txt", &text, &TableOptions::default()).unwrap();
        assert_eq!((numbers(&table), units(&table)), (vec![vec![0.5, 2.0]], vec![None, Some("°")]));
    }
}

#[test]
fn files_that_are_no_tables() {
    let default = TableOptions::default();
    let wide = "1,".repeat(100_000) + "\n";
    refuses(
        &("a".to_owned() + &",a".repeat(100_000) + "\n" + &wide),
        &default,
        &["f.csv:1: more than 4096 columns, expected no more"],
    );
    let message = Table::read("nowhere.csv".as_ref(), &default).unwrap_err().to_string();
    assert!(message.starts_with("cannot read nowhere.csv: "), "{message}");
    let file = std::env::temp_dir().join(format!("rod-hw-too-long-{}.csv", std::process::id()));
    std::fs::write(&file, "a,b\n1,2\n").unwrap();
    assert_eq!(Table::read(&file, &default).unwrap().len(), 1);
    let short = TableOptions { most_bytes: 7, ..TableOptions::default() };
    let message = Table::read(&file, &short).unwrap_err().to_string();
    std::fs::remove_file(&file).unwrap();
    assert!(message.contains("longer than 7 bytes, expected no more"), "{message}");
}

proptest::proptest! {
    /// Whatever the bytes, an answer and no panic.
    #[test]
    fn any_bytes(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..400)) {
        let _ = Table::parse_all("f.csv", &bytes, &TableOptions::default());
    }

    #[test]
    fn any_text_of_tables(text in "[0-9a,;.\t \"#\n\r\\[NF-]{0,200}") {
        if let Ok(table) = Table::parse("f.csv", text.as_bytes(), &TableOptions::default()) {
            let lines = text.split('\n').count().max(text.split('\r').count()) as u64;
            assert!(table.rows().all(|row| row.line() <= lines));
            assert!(table.len() as u64 <= lines);
        }
    }

    /// What is written with any delimiter and decimal mark is read as it was.
    #[test]
    fn numbers_come_back(
        rows in proptest::collection::vec(proptest::array::uniform3(-1e6..1e6_f64), 1..20),
        way in 0_usize..6,
        preamble in proptest::bool::ANY,
    ) {
        let (delimiter, comma) = [(",", false), (";", false), (";", true), ("\t", true), (" ", false), (" ", true)][way];
        let mut text = if preamble { "Messung 3\n\n".to_owned() } else { String::new() };
        text += &format!("a{delimiter}b{delimiter}c\n");
        for row in &rows {
            // with a fraction each, as programs write measured values
            let cells = row.map(|value| format!("{value:?}"));
            let cells = if comma { cells.map(|cell| cell.replace('.', ",")) } else { cells };
            text += &(cells.join(delimiter) + "\n");
        }
        let table = Table::parse("f.csv", text.as_bytes(), &TableOptions::default()).unwrap();
        let found: Vec<[f64; 3]> = table.rows().map(|row| [0, 1, 2].map(|i| row.number(i).unwrap())).collect();
        assert_eq!(found, rows);
    }
}

#[test]
fn a_segment_of_a_table_without_segments_and_bytes_that_are_no_text() {
    let segment = TableOptions { segment: Some(2), ..TableOptions::default() };
    refuses("x,y\n1,2\n", &segment, &["f.csv: the option `segment` is 2, but only LVM files have segments"]);
    refuses("x,y\n1,\0\n", &TableOptions::default(), &["f.csv:2: a byte of zero, which no text has"]);
}
