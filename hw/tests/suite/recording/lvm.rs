//! LabVIEW measurement files, of the shapes that `lvm_read` has samples of, and those samples where they are there.

use rod_hw::RawSample;
use rod_hw::recording::{Cell, ColumnMap, Role, Table, TableOptions};
use std::path::Path;

const HEAD: &str = "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\n";
const END: &str = "***End_of_Header***\t\n\t\n";

fn parse_all(text: &str) -> Vec<Table> {
    Table::parse_all("f.lvm", text.as_bytes(), &TableOptions::default()).unwrap()
}

fn parse(text: &str) -> Table {
    Table::parse("f.lvm", text.as_bytes(), &TableOptions::default()).unwrap()
}

fn column(table: &Table, at: usize) -> Vec<f64> {
    table.rows().map(|row| row.number(at).unwrap()).collect()
}

fn named(table: &Table) -> Vec<(&str, Option<&str>)> {
    table.columns().iter().map(|column| (column.name.as_str(), column.unit.as_deref())).collect()
}

fn refuses(text: &str, options: &TableOptions, parts: &[&str]) {
    let message = Table::parse("f.lvm", text.as_bytes(), options).unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

/// Without a column of x, with decimal commas.
fn without_x(second_step: &str) -> String {
    format!(
        "{HEAD}Separator\tTab\nDecimal_Separator\t,\nMulti_Headings\tYes\nX_Columns\tNo\nDate\t2013/02/19\n{END}\
        Channels\t2\t\t\nSamples\t3\t3\t\nY_Unit_Label\tNewtons\tm/s^2\t\nX_Dimension\tTime\tTime\t\n\
        X0\t0,5\t0,5\t\nDelta_X\t3,906250E-5\t{second_step}\t\n***End_of_Header***\t\t\t\n\
        X_Value\tForce (Trigger)\tAcceleration\tComment\n\t0,914018\t1,204792\n\t0,537321\t-1,208403\tlost\n\t0,616905\t1,213915\n"
    )
}

#[test]
fn x_from_start_and_step() {
    let table = parse(&without_x("3,906250E-5"));
    let expected = [
        ("X_Value", Some("s")),
        ("Force (Trigger)", Some("Newtons")),
        ("Acceleration", Some("m/s^2")),
        ("Comment", None),
    ];
    assert_eq!(named(&table), expected);
    assert_eq!(column(&table, 0), [0.5, 0.5 + 3.90625e-5, 0.5 + 2.0 * 3.90625e-5]);
    assert_eq!(column(&table, 2), [1.204792, -1.208403, 1.213915]);
    let comments: Vec<Cell<'_>> = table.rows().map(|row| row.cell(3)).collect();
    assert_eq!(comments, [Cell::Empty, Cell::Text("lost"), Cell::Empty]);
    assert_eq!((table.note("Date"), table.note("Channels")), (Some("2013/02/19"), Some("2")));
    assert_eq!(table.rows().next().unwrap().line(), 19);
    let options = TableOptions::default();
    refuses(
        &without_x("1"),
        &options,
        &["f.lvm:18: Delta_X is 0.0000390625 and 1, expected X0 and Delta_X above, the same for all channels"],
    );
    refuses(&without_x("1").replace("X0\t0,5", "X1\t0,5"), &options, &["f.lvm:18: X0 is missing, expected"]);
}

/// Each channel with an x of its own, without a line for the decimal separator, in as many segments as there are times.
fn with_xs(times: &[[&str; 2]]) -> String {
    let mut text = format!("{HEAD}Separator\tTab\nMulti_Headings\tYes\nX_Columns\tMulti\n{END}");
    for [first, second] in times {
        text += "Channels\t2\t\t\t\nSamples\t2\t\t2\t\nY_Unit_Label\tVolts\t\tg\t\nX_Dimension\tTime\t\tTime\t\n\
            X0\t0.0\t\t0.0\t\nDelta_X\t1.0\t\t1.0\t\n***End_of_Header***\t\t\t\t\nX_Value\tVoltage\tX_Value\tAcceleration\tComment\n";
        text += &format!("0.0\t-0.035\t0.0\t0.5\n{first}\t-0.034\t{second}\t0.25\n\n");
    }
    text
}

#[test]
fn an_x_for_each_channel() {
    let table = parse(&with_xs(&[["1.0", "1.0"]]));
    let expected = [
        ("X_Value", Some("s")),
        ("Voltage", Some("Volts")),
        ("X_Value of Acceleration", Some("s")),
        ("Acceleration", Some("g")),
        ("Comment", None),
    ];
    assert_eq!(named(&table), expected);
    let map = ColumnMap::new().with_channels(["Voltage", "Acceleration"]);
    let samples: Vec<RawSample> = table.samples(&map).unwrap().map(Result::unwrap).collect();
    assert_eq!((samples.len(), samples[1].time(), &samples[1].channels[..]), (2, 1.0, &[-0.034, 0.25][..]));

    let table = parse(&with_xs(&[["1.0", "1.5"]]));
    let message = table.samples::<RawSample>(&map).err().unwrap().to_string();
    assert_eq!(
        message,
        "f.lvm:18: `X_Value of Acceleration` is 1.5, `X_Value` 1, expected the same times for all channels; read them one by one, or resample"
    );
    let map = ColumnMap::new().with(Role::Time, "X_Value of Acceleration").with_channels(["Acceleration"]);
    let samples: Vec<RawSample> = table.samples(&map).unwrap().map(Result::unwrap).collect();
    assert_eq!(samples[1].time(), 1.5);
}

#[test]
fn segments() {
    let text = with_xs(&[["1.0", "1.0"], ["2.0", "2.0"], ["3.0", "3.0"]]);
    let tables = parse_all(&text);
    let last: Vec<f64> = tables.iter().map(|table| column(table, 0)[1]).collect();
    assert_eq!(last, [1.0, 2.0, 3.0]);
    refuses(&text, &TableOptions::default(), &["f.lvm: 3 segments, expected one; say which in the option `segment`"]);
    let options = |segment| TableOptions { segment: Some(segment), ..TableOptions::default() };
    assert_eq!(column(&Table::parse("f.lvm", text.as_bytes(), &options(2)).unwrap(), 0), [0.0, 2.0]);
    refuses(&text, &options(4), &["f.lvm: 3 segments, expected"]);
    refuses(&text, &options(0), &["f.lvm: 3 segments, expected"]);
}

#[test]
fn empty_fields_and_other_separators() {
    for (separator, name) in [("\t", "Tab"), (",", "Comma")] {
        let text = format!(
            "LabVIEW Measurement\nSeparator\t{name}\nDecimal_Separator\t.\nMulti_Headings\tNo\nX_Columns\tOne\n***End_of_Header***\n\n\
            Notes\tvalid only for Dev0/Ai0\nChannels\t3\n***Start_Special***\nX_Value\tnot this\n***End_Special***\n\
            X_Dimension\tTime\tTime\tTime\n***End_of_Header***\nX_Value\tDev0/Ai0\tUntitled\tDev0/Ai0 1\tComment\n\
            0.0\t-0.011923\t\t7.25\n0.001\t-0.009206\t\t7.5\tOK\n0.002\t-0.0"
        )
        .replace('\t', separator);
        let table = parse(&text);
        let names: Vec<&str> = named(&table).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["X_Value", "Dev0/Ai0", "Untitled", "Dev0/Ai0 1", "Comment"]);
        let cells: Vec<Cell<'_>> = (0..5).map(|at| table.rows().nth(1).unwrap().cell(at)).collect();
        let number = Cell::Number;
        assert_eq!(cells, [number(0.001), number(-0.009206), Cell::Empty, number(7.5), Cell::Text("OK")]);
        let faults: Vec<String> = table.faults().map(|fault| fault.to_string()).collect();
        assert_eq!(faults, ["line 18: the number of cells is 2, expected 5; the file was cut there"]);
    }
}

#[test]
fn damaged_headers() {
    let options = TableOptions::default();
    refuses(
        "LabVIEW Measurement\t\nSeparator\tTab\n",
        &options,
        &["f.lvm:2: the file ends without `***End_of_Header***`"],
    );
    let text = format!("{HEAD}{END}Channels\t2\nX0\t0\t0\n***End_of_Header***\n");
    refuses(
        &text,
        &options,
        &["f.lvm:7: the file ends in the header of a segment, after `X0`, expected a line that starts with X_Value"],
    );
    refuses(&format!("{HEAD}{END}"), &options, &["f.lvm: no line that names columns"]);
}

#[test]
fn the_samples_of_lvm_read() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/sensors");
    if !directory.is_dir() {
        eprintln!("no {}: the real files are left out", directory.display());
        return;
    }
    // rows; numbers in the first and the last of them, as lvm_read has them
    for (file, rows, first, last) in [
        (
            "multi_time_column",
            3,
            &[0.0, -0.035229, 0.0, 0.532608][..],
            &[3.90625e-5, -0.034191, 3.90625e-5, 0.467541][..],
        ),
        ("no_decimal_separator", 4, &[0.0, -0.008807, 0.0, -0.028189], &[0.00075, 0.059248, 0.00075, -0.021172]),
        ("short", 10, &[0.0, 0.914018, 1.204792], &[9.0 * 3.90625e-5, 0.680572, 1.212775]),
        ("with_comments", 9, &[0.0, 1.833787, 5.479238, 0.0], &[9.723275, 1.717152, 5.407475, 89.8217]),
        ("with_empty_fields", 7, &[0.0, -0.011923, 7.254639], &[0.006, -0.020074, 7.254639]),
    ] {
        let table = Table::read(&directory.join(format!("lvm-{file}.lvm")), &TableOptions::default()).unwrap();
        assert_eq!((table.len(), table.faults().count()), (rows, 0), "{file}");
        for (row, expected) in [(0, first), (rows - 1, last)] {
            let row = table.rows().nth(row).unwrap();
            let found: Vec<f64> = (0..expected.len()).map(|at| row.number(at).unwrap()).collect();
            assert_eq!(found, expected, "{file}");
        }
    }
}
