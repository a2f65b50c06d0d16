//! Messy files are understood, and the command that `inspect` prints reads them.

use crate::common::{SCENE, complaint, vibrissa};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::OnceLock;

/// t, x0, y0, phi0, f0x, f0y, m0z.
type Record = [f64; 7];

/// A recording without noise, made once.
pub fn recording() -> &'static [Record] {
    static MADE: OnceLock<Vec<Record>> = OnceLock::new();
    MADE.get_or_init(|| {
        let directory = tempfile::tempdir().unwrap();
        fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
        let arguments = ["simulate", "scene.toml", "--rate", "100", "--speed", "2e-3", "--file", "made.csv"];
        assert_eq!(vibrissa(directory.path(), &arguments).status.code(), Some(0));
        let text = fs::read_to_string(directory.path().join("made.csv")).unwrap();
        let row = |line: &str| -> Option<Record> {
            line.split(',').map(|cell| cell.parse().ok()).collect::<Option<Vec<f64>>>()?.try_into().ok()
        };
        let rows: Vec<Record> = text.lines().filter_map(row).collect();
        assert!(rows.len() > 400, "{}", rows.len());
        rows
    })
}

/// A table of the recording.
fn table<const N: usize>(head: &str, separator: &str, row: impl Fn(&Record) -> [f64; N]) -> String {
    let mut text = head.to_owned();
    for record in recording() {
        let cells = row(record).map(|value| format!("{value:.9e}"));
        let _ = writeln!(text, "{}", cells.join(separator));
    }
    text
}

fn own() -> String {
    table("t,x0,y0,phi0,f0x,f0y,m0z\n", ",", |record| *record)
}

/// What is said of files beside the rod, with the exit status.
pub fn inspected(directory: &Path, arguments: &[&str]) -> (Value, i32) {
    fs::write(directory.join("rod.toml"), SCENE).unwrap();
    let output = vibrissa(directory, &[&["inspect", "--json"], arguments].concat());
    let found =
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", complaint(&output)));
    (found, output.status.code().unwrap())
}

/// Runs the commands that were printed: they must read the files. Returns what the last one said.
pub fn runs(directory: &Path, found: &Value) -> String {
    let mut said = String::new();
    for command in found["commands"].as_array().unwrap() {
        assert_eq!(command["reads"], true);
        let words: Vec<&str> = command["words"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        let more: &[&str] =
            if words[1] == "reconstruct" { &["--local", "--out", "result"] } else { &["--out", "result"] };
        let output = vibrissa(directory, &[&words[1..], more].concat());
        said = String::from_utf8_lossy(&output.stdout).into_owned();
        let complaint = complaint(&output);
        // rows that are left out, and points of a made-up shape, need not fit
        let may_misfit = words[1] == "forces" || found.to_string().contains("oops");
        let is_read = output.status.code() == Some(0) || may_misfit && output.status.code() == Some(2);
        assert!(is_read && !complaint.contains("error: "), "{words:?}: {complaint}{said}");
    }
    said
}

/// Looks at one file, with the rod; the printed command must read it, and give the samples of the recording to the fit.
fn settles(name: &str, contents: &[u8]) -> Value {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join(name), contents).unwrap();
    let (found, status) = inspected(directory.path(), &[name, "--rod", "rod.toml"]);
    assert_eq!(status, 0, "{found:#}");
    let said = runs(directory.path(), &found);
    assert!(!said.is_empty());
    found
}

/// Meanings and units of the columns in order, `-` where there is none.
fn meanings(found: &Value) -> Vec<String> {
    let columns = found["files"][0]["columns"].as_array().unwrap();
    let text = |value: &Value| value.as_str().unwrap_or("-").to_owned();
    columns.iter().map(|column| format!("{} {}", text(&column["meaning"]), text(&column["unit"]))).collect()
}

fn fact(found: &Value, what: &str) -> String {
    let facts = found["files"][0]["facts"].as_array().unwrap();
    let fact = facts.iter().find(|fact| fact["what"] == what);
    fact.map_or_else(String::new, |fact| fact["found"].as_str().unwrap().to_owned())
}

/// Questions and answers.
pub fn questions(found: &Value) -> String {
    let questions = found["files"].as_array().unwrap().iter().flat_map(|file| file["questions"].as_array().unwrap());
    questions.map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// What is said of one table, with the rod or without it.
pub fn looked(text: &str, options: &[&str]) -> (Value, i32) {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scan.csv"), text).unwrap();
    inspected(directory.path(), &[&["scan.csv"], options].concat())
}

const ROD: &[&str] = &["--rod", "rod.toml"];
const OWN: &str = "t,x0,y0,phi0,f0x,f0y,m0z\n";
const FOREIGN: &str = "time [s],pos_x,pos_y,angle [rad],force_x [N],force_y [N],moment_z [N m]\n";

pub fn words(found: &Value) -> String {
    let words = found["commands"][0]["words"].as_array().unwrap();
    words.iter().map(|word| word.as_str().unwrap()).collect::<Vec<_>>().join(" ")
}

#[test]
fn a_recording_with_names_of_its_own_needs_no_option() {
    let found = settles("scan.csv", own().as_bytes());
    assert_eq!(meanings(&found), ["t s", "x0 m", "y0 m", "phi0 rad", "f0x N", "f0y N", "m0z N m"]);
    assert_eq!(words(&found), "vibrissa reconstruct scan.csv --rod rod.toml");
    assert!(fact(&found, "frame").starts_with("the physics confirms"), "{found:#}");
    assert!(fact(&found, "motion of the clamp").starts_with("straight, 40.00 mm along 180.0 degrees"), "{found:#}");
    assert!(fact(&found, "rate").starts_with("100.000000 Hz"), "{found:#}");
}

#[test]
fn german_semicolons_and_decimal_commas_with_loads() {
    let head = "Messung 3, Parabel\n\nZeit [s];X [mm];Y [mm];Winkel [Grad];Kraft X [mN];Kraft Y [mN];Moment Z [N mm]\n";
    let text = table(head, ";", |[t, x, y, phi, fx, fy, mz]| {
        [*t, 1e3 * x, 1e3 * y, phi.to_degrees(), -1e3 * fx, -1e3 * fy, -1e3 * mz]
    });
    let (head, rows) = text.split_at(head.len());
    let found = settles("messung.csv", (head.to_owned() + &rows.replace('.', ",")).as_bytes());
    assert_eq!(meanings(&found), ["t s", "x0 mm", "y0 mm", "phi0 deg", "f0x -mN", "f0y -mN", "m0z -N mm"]);
    assert_eq!(fact(&found, "format"), "text, semicolons between the cells, decimal comma");
    assert!(fact(&found, "frame").starts_with("the columns are loads on the sensor"), "{found:#}");
    assert!(words(&found).contains("--unit Kraft X=-mN"), "{}", words(&found));
}

#[test]
fn millimetres_degrees_and_milliseconds_by_their_values() {
    let text = table("time\tpos_x\tpos_y\ttheta\tf0x\tf0y\tm0z\n", "\t", |[t, x, y, phi, fx, fy, mz]| {
        [1e3 * t, 1e3 * x, 1e3 * y, phi.to_degrees(), *fx, *fy, *mz]
    });
    let found = settles("scan.tsv", text.as_bytes());
    assert_eq!(meanings(&found), ["t ms", "x0 mm", "y0 mm", "phi0 deg", "f0x N", "f0y N", "m0z N m"]);
    assert_eq!(found["files"][0]["columns"][1]["unit_certainty"], "likely");
}

#[test]
fn forces_without_a_unit_are_a_question_without_the_rod() {
    let text = table("t,x0,y0,phi0,Fx,Fy,Mz\n", ",", |[t, x, y, phi, fx, fy, mz]| {
        [*t, *x, *y, *phi, 1e3 * fx, 1e3 * fy, 1e3 * mz]
    });
    let found = settles("scan.csv", text.as_bytes());
    assert_eq!(fact(&found, "units"), "the stiffness of the rod fits forces in mN and moments in N mm");
    assert!(words(&found).contains("--unit Fx=mN --unit Fy=mN --unit Mz=N mm"), "{}", words(&found));
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("scan.csv"), &text).unwrap();
    let (found, status) = inspected(directory.path(), &["scan.csv"]);
    assert_eq!((status, found["files"][0]["questions"].as_array().unwrap().len()), (2, 3), "{found:#}");
    let answers = ["scan.csv", "--rod", "rod.toml", "--unit", "Fx=mN", "--unit", "Fy=mN", "--unit", "Mz=N mm"];
    let (found, status) = inspected(directory.path(), &answers);
    assert_eq!(status, 0, "{found:#}");
    runs(directory.path(), &found);
}

/// A file that says N m where N mm are: the stiffness of the rod contradicts it.
#[test]
fn units_that_contradict_the_rod_are_a_question() {
    let directory = tempfile::tempdir().unwrap();
    let text = table("t,x0,y0,phi0,f0x [N],f0y [N],m0z [N m]\n", ",", |[t, x, y, phi, fx, fy, mz]| {
        [*t, *x, *y, *phi, *fx, *fy, 1e3 * mz]
    });
    fs::write(directory.path().join("scan.csv"), &text).unwrap();
    let (found, status) = inspected(directory.path(), &["scan.csv", "--rod", "rod.toml"]);
    let asked = questions(&found);
    assert!(status == 2 && asked.contains("the physics fits `m0z` in N mm"), "{found:#}");
    // without a written unit the rod tells it
    let found = settles("scan.csv", text.replace(" [N]", "").replace(" [N m]", "").as_bytes());
    assert!(words(&found).ends_with("--unit m0z=N mm"), "{}", words(&found));
}

#[test]
fn columns_without_names() {
    let found = settles("scan.csv", table("", ",", |record| *record).as_bytes());
    assert_eq!(meanings(&found)[..4], ["t s", "x0 m", "y0 m", "phi0 rad"]);
    assert!(words(&found).contains("--header none --column t=1 --column x0=2"), "{}", words(&found));
}

#[test]
fn a_header_of_three_rows() {
    let head = "Time;X;Y;Phi;Fx;Fy;Mz\ns;mm;mm;deg;N;N;N m\nclock;stage;stage;stage;ATI;ATI;ATI\n";
    let text = table(head, ";", |[t, x, y, phi, fx, fy, mz]| [*t, 1e3 * x, 1e3 * y, phi.to_degrees(), *fx, *fy, *mz]);
    let found = settles("scan.csv", text.as_bytes());
    assert_eq!(meanings(&found), ["t s", "x0 mm", "y0 mm", "phi0 deg", "f0x N", "f0y N", "m0z N m"]);
    assert_eq!(fact(&found, "header"), "names in line 1, units in line 2");
}

#[test]
fn swapped_axes_and_signs_are_told_by_the_physics() {
    let text = table("t,x0,y0,phi0,f0x,f0y,m0z\n", ",", |[t, x, y, phi, fx, fy, mz]| [*t, *x, *y, *phi, -fy, *fx, -mz]);
    let found = settles("scan.csv", text.as_bytes());
    assert!(fact(&found, "frame").starts_with("the physics prefers f0x = f0y, f0y = -f0x, m0z = -m0z"), "{found:#}");
    assert!(words(&found).contains("--column f0x=f0y --column f0y=f0x"), "{}", words(&found));
}

#[test]
fn gaps_and_repeated_rows() {
    let text = own();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.drain(100..120);
    let again = lines[50];
    lines.splice(50..50, [again, again]);
    let cells: Vec<&str> = lines[300].split(',').collect();
    let oops = [&cells[..4], &["oops"], &cells[5..]].concat().join(",");
    lines[300] = &oops;
    let found = settles("scan.csv", (lines.join("\n") + "\n").as_bytes());
    assert!(fact(&found, "gaps").starts_with("1 gap, the longest of 0.2100 s before line 10"), "{found:#}");
    assert!(fact(&found, "repeated rows").starts_with("2 rows"), "{found:#}");
    let faults = found["files"][0]["faults"].as_array().unwrap();
    let oops = faults.iter().find(|fault| fault["field"] == "f0x").unwrap();
    assert_eq!((&oops["line"], oops["value"].as_str().unwrap()), (&301.into(), "`oops`, the first of 1 cell"));
}

#[test]
fn tables_below_and_beside_each_other_are_named() {
    let directory = tempfile::tempdir().unwrap();
    let text = own();
    let below = format!("{text}\nt,x0,y0,phi0,f0x,f0y,m0z\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n2,1,2,3,4,5,6\n");
    fs::write(directory.path().join("below.csv"), &below).unwrap();
    let (found, status) = inspected(directory.path(), &["below.csv", "--rod", "rod.toml"]);
    let fault = &found["files"][0]["faults"][0];
    assert_eq!((status, fault["line"].as_u64()), (2, Some(text.lines().count() as u64 + 2)), "{found:#}");
    assert!(fault["value"].as_str().unwrap().starts_with("a second table: t, x0"), "{found:#}");
    let beside = table("t,x0,y0,phi0,,f0x,f0y,m0z\n", ",", |record| *record);
    let beside: String = beside
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            if cells.len() == 7 {
                format!("{},,{}\n", cells[..4].join(","), cells[4..].join(","))
            } else {
                format!("{line}\n")
            }
        })
        .collect();
    fs::write(directory.path().join("beside.csv"), beside).unwrap();
    let (found, status) = inspected(directory.path(), &["beside.csv", "--rod", "rod.toml"]);
    let fault = &found["files"][0]["faults"][0];
    assert_eq!(status, 2, "{found:#}");
    assert!(fault["value"].as_str().unwrap().contains("beside the first"), "{found:#}");
}

#[test]
fn numbers_written_as_text() {
    let text = own();
    let marked: String = text
        .lines()
        .enumerate()
        .map(|(k, line)| {
            let cells = line.split(',').enumerate();
            let mark = |(at, cell): (usize, &str)| match (k, at % 2) {
                (0, _) => cell.to_owned(),
                (_, 0) => format!("'{cell}"),
                _ => format!("\"{cell}\""),
            };
            cells.map(mark).collect::<Vec<_>>().join(",") + "\n"
        })
        .collect();
    settles("scan.csv", marked.as_bytes());
}

/// A workbook, written as an archive without compression.
fn workbook() -> Vec<u8> {
    let mut sheet =
        String::from(r#"<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>"#);
    let text = |name: char, row: usize, value: &str| {
        format!(r#"<c r="{name}{row}" t="inlineStr"><is><t>{value}</t></is></c>"#)
    };
    let letters = ['A', 'B', 'C', 'D', 'E', 'F', 'G'];
    let names = ["t [s]", "x0 [mm]", "y0 [mm]", "phi0 [deg]", "f0x", "f0y", "m0z"];
    let _ = write!(
        sheet,
        r#"<row r="2">{}</row>"#,
        letters.iter().zip(names).map(|(letter, name)| text(*letter, 2, name)).collect::<String>()
    );
    for (k, [t, x, y, phi, fx, fy, mz]) in recording().iter().enumerate() {
        let row = k + 3;
        let values = [*t, 1e3 * x, 1e3 * y, phi.to_degrees(), *fx, *fy, *mz];
        let cell = |(letter, value): (&char, f64)| match letter {
            // a number kept as text, with a decimal comma
            'B' => text('B', row, &format!("{value:.9}").replace('.', ",")),
            _ => format!(r#"<c r="{letter}{row}"><v>{value:e}</v></c>"#),
        };
        let _ = write!(sheet, r#"<row r="{row}">{}</row>"#, letters.iter().zip(values).map(cell).collect::<String>());
    }
    sheet += "</sheetData></worksheet>";
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let relations = "http://schemas.openxmlformats.org/package/2006/relationships";
    let office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    archive(&[
        (
            "_rels/.rels",
            &format!(
                r#"<Relationships xmlns="{relations}"><Relationship Id="rId1" Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>"#
            ),
        ),
        (
            "xl/workbook.xml",
            &format!(
                r#"<workbook xmlns="{main}" xmlns:r="{office}"><sheets><sheet name="Scan" sheetId="1" r:id="rId1"/></sheets></workbook>"#
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels",
            &format!(
                r#"<Relationships xmlns="{relations}"><Relationship Id="rId1" Type="{office}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>"#
            ),
        ),
        ("xl/worksheets/sheet1.xml", &sheet),
    ])
}

/// A ZIP archive of files that are stored as they are.
fn archive(files: &[(&str, &str)]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, text) in files {
        let crc = text.bytes().fold(!0_u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
        });
        let sizes =
            [(!crc).to_le_bytes(), (text.len() as u32).to_le_bytes(), (text.len() as u32).to_le_bytes()].concat();
        let common =
            [&[20_u8, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &sizes, &(name.len() as u16).to_le_bytes(), &[0, 0]].concat();
        directory.extend(
            [b"PK\x01\x02\x14\x00", &common[..], &[0; 10], &(bytes.len() as u32).to_le_bytes(), name.as_bytes()]
                .concat(),
        );
        bytes.extend([b"PK\x03\x04", &common[..], name.as_bytes(), text.as_bytes()].concat());
    }
    let count = (files.len() as u16).to_le_bytes();
    let (size, at) = ((directory.len() as u32).to_le_bytes(), (bytes.len() as u32).to_le_bytes());
    bytes.extend(directory);
    bytes.extend([b"PK\x05\x06\0\0\0\0", &count[..], &count, &size, &at, &[0, 0]].concat());
    bytes
}

#[test]
fn a_workbook_of_a_spreadsheet() {
    let found = settles("scan.xlsx", &workbook());
    assert_eq!(meanings(&found), ["t s", "x0 mm", "y0 mm", "phi0 deg", "f0x N", "f0y N", "m0z N m"]);
    assert!(fact(&found, "header").starts_with("names in line 2"), "{found:#}");
}

/// A log of a force/torque sensor, turned by 90 degrees, beside the log of a stage in ms, mm and degrees.
#[test]
fn a_sensor_and_its_stage_belong_together() {
    let directory = tempfile::tempdir().unwrap();
    let head = "ATI FT12345\nRate: 100\nTime (s),Fx (N),Fy (N),Fz (N),Tx (N-mm),Ty (N-mm),Tz (N-mm)\n";
    // its x lies along -y of the scene, its y along x
    let ati = table(head, ",", |[t, _, _, _, fx, fy, mz]| [*t, *fy, -fx, 0.0, 0.0, 0.0, -1e3 * mz]);
    let stage =
        table("t\tstage_x\tstage_y\tangle\n", "\t", |[t, x, y, phi, ..]| [1e3 * t, 1e3 * x, 1e3 * y, phi.to_degrees()]);
    fs::write(directory.path().join("ati.csv"), ati).unwrap();
    fs::write(directory.path().join("stage.tsv"), stage).unwrap();
    let files = ["ati.csv", "stage.tsv", "--rod", "rod.toml", "--write-setup", "sensor.toml", "--stage-delay", "0"];
    let (found, status) = inspected(directory.path(), &files);
    assert_eq!(status, 0, "{found:#}");
    assert!(
        words(&found).contains("--stage table:stage.tsv --stage-delay 0 s --setup sensor.toml"),
        "{}",
        words(&found)
    );
    assert!(fact(&found, "frame").starts_with("the physics prefers"), "{found:#}");
    let setup = fs::read_to_string(directory.path().join("sensor.toml")).unwrap();
    assert!(setup.contains("axes = [\"-y\", \"x\", \"z\"]") && setup.contains("sense = \"load\""), "{setup}");
    assert!(fact(&found, "frame").contains("f0x = -Fy, f0y = Fx, m0z = -Tz"), "{found:#}");
    runs(directory.path(), &found);
    // each alone is not enough
    for (file, question) in [("ati.csv", "where is the clamp"), ("stage.tsv", "which recording of a sensor")] {
        let (found, status) = inspected(directory.path(), &[file, "--rod", "rod.toml"]);
        let asked = found["files"][0]["questions"][0]["text"].as_str().unwrap();
        assert!(status == 2 && asked.starts_with(question), "{found:#}");
    }
}

#[test]
fn a_sensor_with_three_components() {
    let directory = tempfile::tempdir().unwrap();
    let log = table("Zeit [s],Kraft x [N],Kraft y [N],Moment z [mN m]\n", ",", |[t, _, _, _, fx, fy, mz]| {
        [*t, -fx, -fy, -1e3 * mz]
    });
    let stage = table("t,x0,y0,phi0\n", ",", |[t, x, y, phi, ..]| [*t, *x, *y, *phi]);
    fs::write(directory.path().join("log.csv"), log).unwrap();
    fs::write(directory.path().join("stage.csv"), stage).unwrap();
    let files = ["log.csv", "stage.csv", "--rod", "rod.toml", "--write-setup", "sensor.toml", "--stage-delay", "0"];
    let (found, status) = inspected(directory.path(), &files);
    assert_eq!(status, 0, "{found:#}");
    assert!(fact(&found, "frame").starts_with("the columns are loads on the sensor"), "{found:#}");
    let setup = fs::read_to_string(directory.path().join("sensor.toml")).unwrap();
    assert!(setup.contains("sense = \"load\" # it measures what the rod does to it"), "{setup}");
    runs(directory.path(), &found);
}

/// Reactions of the clamp in one file, its poses in another.
#[test]
fn reactions_without_poses_belong_to_a_stage() {
    let directory = tempfile::tempdir().unwrap();
    let log = table("t,f0x,f0y,m0z\n", ",", |[t, _, _, _, fx, fy, mz]| [*t, *fx, *fy, *mz]);
    let stage = table("t,x0,y0,phi0\n", ",", |[t, x, y, phi, ..]| [*t, *x, *y, *phi]);
    fs::write(directory.path().join("log.csv"), log).unwrap();
    fs::write(directory.path().join("stage.csv"), stage).unwrap();
    let files = ["log.csv", "stage.csv", "--rod", "rod.toml", "--write-setup", "sensor.toml", "--stage-delay", "0"];
    let (found, status) = inspected(directory.path(), &files);
    assert_eq!(status, 0, "{found:#}");
    let setup = fs::read_to_string(directory.path().join("sensor.toml")).unwrap();
    assert!(setup.contains("sense = \"reaction\" # it measures what it does to the rod"), "{setup}");
    assert!(fact(&found, "frame").starts_with("the columns are reactions on the rod: f0x = Fx"), "{found:#}");
    runs(directory.path(), &found);
}

#[test]
fn tracked_points() {
    let mut text = "frame,x,y\n".to_owned();
    for frame in 0..3 {
        for point in 0..=20 {
            let s = f64::from(point) * 5.0;
            let _ = writeln!(text, "{frame},{s},{}", 1e-5 * f64::from(frame) * s * s * (300.0 - s) / 100.0);
        }
    }
    let found = settles("points.csv", text.as_bytes());
    assert_eq!(meanings(&found), ["frame -", "x -", "y -"]);
    assert_eq!(words(&found), "vibrissa forces points.csv --rod rod.toml --scale 1e-3");
}

/// The length of a frame along the rod, in pixels, gives a scale if it shows the whole rod.
#[test]
fn points_in_pixels_need_a_scale() {
    let mut text = "frame,x,y\n".to_owned();
    for frame in 0..3 {
        for point in 0..=20 {
            let _ = writeln!(text, "{frame},{},{}", 100 + 100 * point, 500 + frame);
        }
    }
    for (rod, expected) in
        [(ROD, "METRES is 5.00e-5 if the longest frame shows the whole rod"), (&[], "--rod FILE compares it")]
    {
        let (found, status) = looked(&text, rod);
        let asked = questions(&found);
        assert_eq!(status, 2);
        for part in [
            "these may be pixels",
            "--scale METRES",
            "--image if y counts down",
            "divided by the same distance in pixels",
            expected,
        ] {
            assert!(asked.contains(part), "{part}: {asked}");
        }
        assert!(words(&found).ends_with("--scale METRES"), "{found:#}");
    }
}

/// A clamp that only moves has an angle, and many stages do not log it.
#[test]
fn an_angle_that_stays_the_same_is_an_option() {
    let text = table("t,x0,y0,f0x,f0y,m0z\n", ",", |[t, x, y, _, fx, fy, m]| [*t, *x, *y, *fx, *fy, *m]);
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && found.to_string().contains("needs no column: --column phi0=90deg"), "{found:#}");
    let (found, status) = looked(&text, &[ROD, &["--column", "phi0=90 deg"]].concat());
    assert_eq!((status, words(&found).ends_with("--column phi0=90deg")), (0, true), "{found:#}");
    assert!(fact(&found, "motion of the clamp").ends_with("the angle stays 90.000 degrees"), "{found:#}");
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("rod.toml"), SCENE).unwrap();
    fs::write(directory.path().join("whole.csv"), own()).unwrap();
    fs::write(directory.path().join("part.csv"), text).unwrap();
    let points = |arguments: &[&str]| {
        let output =
            vibrissa(directory.path(), &[&["reconstruct", "--rod", "rod.toml", "--out", "out"], arguments].concat());
        (fs::read_to_string(directory.path().join("out/contour.csv")).unwrap_or_default(), complaint(&output))
    };
    let whole = points(&["whole.csv"]);
    assert!(whole.0.lines().count() > 10, "{}", whole.1);
    // the angle of the file has ten digits
    assert_eq!(points(&["part.csv", "--column", "phi0=1.570796327rad"]).0, whole.0);
    let (_, message) = points(&["part.csv", "--column", "phi0=90"]);
    assert!(message.contains("no column `90`"), "{message}");
    let (_, message) = points(&["part.csv"]);
    assert!(message.contains("the option --column phi0=90deg gives its value"), "{message}");
}

/// The table of a stage may lack the angle, too.
#[test]
fn the_angle_of_a_stage_is_an_option() {
    let directory = tempfile::tempdir().unwrap();
    let stage = table("t,x0,y0\n", ",", |[t, x, y, ..]| [*t, *x, *y]);
    fs::write(directory.path().join("stage.csv"), stage).unwrap();
    let sensor = table("t,Fx [N],Fy [N],Fz [N],Tx [N m],Ty [N m],Tz [N m]\n", ",", |[t, _, _, _, fx, fy, m]| {
        [*t, -fx, -fy, 0.0, 0.0, 0.0, -m]
    });
    fs::write(directory.path().join("sensor.csv"), sensor).unwrap();
    let files = ["sensor.csv", "stage.csv", "--rod", "rod.toml", "--stage-delay", "0"];
    let (found, status) = inspected(directory.path(), &files);
    assert!(status == 2 && found.to_string().contains("--column phi0=90deg"), "{found:#}");
    let (found, status) = inspected(directory.path(), &[&files[..], &["--column", "stage:phi0=90deg"]].concat());
    assert_eq!(status, 0, "{found:#}");
    assert!(words(&found).contains("--column stage:phi0=90deg"), "{found:#}");
    runs(directory.path(), &found);
}

/// The files of a tracker state neither the rod nor the size of a pixel.
#[test]
fn points_of_deeplabcut_are_no_forces() {
    let mut text =
        "scorer,net,net,net,net,net,net\nbodyparts,base,base,base,tip,tip,tip\ncoords,x,y,likelihood,x,y,likelihood\n"
            .to_owned();
    for frame in 0..20 {
        let _ = writeln!(text, "{frame},{},2,0.9,30,{},0.8", 1 + frame, 4 + frame);
    }
    let (found, status) = looked(&text, ROD);
    let asked = questions(&found);
    assert!(status == 2 && found["files"][0]["kind"] == "tracked points of DeepLabCut, in pixels", "{found:#}");
    assert!(
        asked.contains("Here they are base, tip") && asked.contains("how long is a pixel") && !asked.contains("f0x"),
        "{asked}"
    );
    assert!(found.to_string().contains("tracking.read_deeplabcut(\\\"scan.csv\\\""), "{found:#}");
}

/// Names in languages that are known need no question; those without an axis or in other languages are questions with a guess.
#[test]
fn names_in_other_languages_are_understood_or_asked() {
    for head in ["时间,位置x,位置y,角度,力x,力y,力矩z\n", "czas,Poloha_X,Poloha_Y,kąt,sila_x,sila_y,moment\n"]
    {
        let (found, status) = looked(&table(head, ",", |record| *record), ROD);
        let roles: Vec<String> =
            meanings(&found).iter().map(|role| role.split(' ').next().unwrap().to_owned()).collect();
        assert_eq!((status, roles.join(" ").as_str()), (0, "t x0 y0 phi0 f0x f0y m0z"), "{found:#}");
    }
    for (head, asked) in [
        ("t,x,y,phi,F1,F2,M\n", &["is `F1` f0x?", "is `F2` f0y?"][..]),
        ("t,pos_1,pos_2,Winkel,kraft1,kraft2,moment\n", &["is `pos_1` x0?", "is `kraft2` f0y?"]),
        (
            "a,b,c,d,e,f,g\n",
            &["is `a` t?", "is `b` x0?", "is `c` y0?", "is `d` phi0?", "is `e` f0x?", "is `f` f0y?", "is `g` m0z?"],
        ),
    ] {
        let (found, status) = looked(&table(head, ",", |record| *record), ROD);
        let said = questions(&found);
        assert!(status == 2 && asked.iter().all(|question| said.contains(question)), "{head}: {said}");
        let values: Vec<&str> = found["files"][0]["columns"]
            .as_array()
            .unwrap()
            .iter()
            .map(|column| column["behaviour"].as_str().unwrap())
            .collect();
        assert!(values[1].starts_with("linear, -2.0") && values[2] == "constant", "{values:?}");
        assert!(values[4..].iter().all(|value| value.starts_with("at rest until")), "{values:?}");
        // the answers are options that settle it
        let answers: Vec<&str> = found["files"][0]["questions"]
            .as_array()
            .unwrap()
            .iter()
            .map(|q| q["answers"][0].as_str().unwrap())
            .collect();
        let answers = answers.join(" ");
        let answers: Vec<&str> = answers.split(' ').collect();
        let (found, status) = looked(&table(head, ",", |record| *record), &[ROD, &answers].concat());
        assert_eq!(status, 0, "{head}: {found:#}");
    }
}

#[test]
fn faults_that_prevent_reading_are_told_with_their_line() {
    let directory = tempfile::tempdir().unwrap();
    for (name, text, line, part) in [
        ("mixed.csv", "t;Fx\n0,5;1.5\n1,5;2.5\n".to_owned(), None, "decimal"),
        ("no_angle.csv", own().replace("phi0", "remark7"), Some(1), "phi0"),
        ("nothing.csv", "nothing at all\n".to_owned(), None, "columns"),
        ("binary.csv", "a\0b".to_owned(), None, "byte of zero"),
        ("words.csv", "pressure,valve\n1,2\n3,4\n".to_owned(), Some(1), "pressure"),
    ] {
        fs::write(directory.path().join(name), text).unwrap();
        let (found, status) = inspected(directory.path(), &[name, "--rod", "rod.toml"]);
        let fault = &found["files"][0]["faults"][0];
        assert_eq!((status, fault["prevents"].as_bool()), (2, Some(true)), "{name}: {found:#}");
        assert!(line.is_none() || fault["line"].as_u64() == line, "{name}: {found:#}");
        assert!(fault.to_string().contains(part), "{name}: {found:#}");
    }
    let (found, status) = inspected(directory.path(), &["missing.csv"]);
    assert_eq!((status, found["files"][0]["faults"][0]["prevents"].as_bool()), (2, Some(true)), "{found:#}");
}

#[test]
fn refusals_of_other_commands_point_to_it() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("rod.toml"), SCENE).unwrap();
    fs::write(directory.path().join("my scan.csv"), "Zeit;Kraft\n0;1\n1;2\n").unwrap();
    for command in [
        &["reconstruct", "my scan.csv"][..],
        &["calibrate", "my scan.csv", "--file", "found.toml"],
        &["live", "--sensor", "file:my scan.csv"],
    ] {
        let output = vibrissa(directory.path(), &[command, &["--rod", "rod.toml"]].concat());
        let said = complaint(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.ends_with("`vibrissa inspect 'my scan.csv'` shows what the file holds.\n"), "{said}");
    }
}

#[test]
fn the_report_for_people_has_a_table_of_faults_and_the_command() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("rod.toml"), SCENE).unwrap();
    fs::write(directory.path().join("scan.csv"), own()).unwrap();
    let output = vibrissa(directory.path(), &["inspect", "scan.csv", "--rod", "rod.toml"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.ends_with("this command reads it:\n  vibrissa reconstruct scan.csv --rod rod.toml\n"), "{said}");
    fs::write(directory.path().join("scan.csv"), own().replace("phi0", "remark7")).unwrap();
    let output = vibrissa(directory.path(), &["inspect", "scan.csv", "--rod", "rod.toml"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("to correct:\n  place       field  found"), "{said}");
}

/// A coordinate that stays the same says nothing of its unit: both have one.
#[test]
fn both_coordinates_have_one_unit() {
    for (factor, unit, places) in [(1e3, "mm", [-0.4, 4.0]), (1e2, "cm", [0.5, 15.0]), (1.0 / 0.0254, "in", [0.5, 4.0])]
    {
        for y0 in places {
            for head in [FOREIGN, OWN] {
                let text = table(head, ",", |[t, x, _, phi, fx, fy, mz]| [*t, factor * x, y0, *phi, *fx, *fy, *mz]);
                let (found, status) = looked(&text, ROD);
                let units = meanings(&found);
                let is_right = units[1] == format!("x0 {unit}") && units[2] == format!("y0 {unit}");
                assert!(is_right || status == 2, "{unit} {y0}: {found:#}");
                assert!(is_right || head == OWN || unit == "in", "{unit} {y0}: {found:#}");
            }
        }
    }
    // the one that states its unit states that of the other
    let text = table("t,x0 [cm],y0,phi0,f0x,f0y,m0z\n", ",", |[t, x, y, phi, fx, fy, mz]| {
        [*t, 1e2 * x, 1e2 * y, *phi, *fx, *fy, *mz]
    });
    let (found, _) = looked(&text, ROD);
    assert!(words(&found).contains("--unit y0=cm"), "{found:#}");
}

/// x in m and y in mm, without a unit: both in cm agreed with the work, too, and was taken.
#[test]
fn coordinates_in_different_units_are_a_question() {
    let directory = tempfile::tempdir().unwrap();
    let sweep = "from = [0.08, -0.045]\nto = [-0.02, -0.035]\nangle = 85.0\nstep = 1e-3\n";
    let (objects, _) = SCENE.split_once("[sweep]").unwrap();
    fs::write(directory.path().join("scene.toml"), format!("{objects}[sweep]\n{sweep}")).unwrap();
    let arguments = ["simulate", "scene.toml", "--rate", "50", "--speed", "2e-3", "--file", "made.csv"];
    assert_eq!(vibrissa(directory.path(), &arguments).status.code(), Some(0));
    let made = fs::read_to_string(directory.path().join("made.csv")).unwrap();
    let mut text = "time,pos_x,pos_y,angle,Fx,Fy,Mz\n".to_owned();
    for line in made.lines() {
        let cells: Vec<f64> = line.split(',').map_while(|cell| cell.parse().ok()).collect();
        if let [t, x, y, phi, fx, fy, mz] = cells[..] {
            let _ = writeln!(text, "{t},{x},{},{},{},{},{}", 1e3 * y, phi.to_degrees(), -1e3 * fx, -1e3 * fy, 1e3 * mz);
        }
    }
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && questions(&found).contains("in which unit is `pos_y`?"), "{found:#}");
}

/// Poses in metres under a heading of millimetres: the work of the clamp is a thousand times too small.
#[test]
fn the_work_of_the_clamp_contradicts_a_stated_unit_of_the_pose() {
    let (found, status) = looked(&own().replace("x0,y0", "x0 [mm],y0 [mm]"), ROD);
    assert!(status == 2 && questions(&found).contains("the physics fits `x0`, `y0` in m"), "{found:#}");
}

#[test]
fn a_mirror_between_pose_and_reactions_is_a_question() {
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| [*t, -x, *y, *phi, *fx, *fy, *mz]);
    let (found, status) = looked(&text, ROD);
    let asked = questions(&found);
    assert!(status == 2 && asked.contains("--unit x0=-m") && asked.contains("--unit f0x=-N"), "{found:#}");
    let (found, status) = looked(&text, &[ROD, &["--unit", "x0=-m"]].concat());
    assert!(status == 0 && fact(&found, "frame").starts_with("the physics confirms"), "{found:#}");
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| [*t, *x, *y, -phi, *fx, *fy, *mz]);
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && questions(&found).contains("--unit phi0=-rad"), "{found:#}");
}

/// The scene turned so that the clamp is at 3 degrees: in radians they would be 172 degrees.
#[test]
fn degrees_under_the_name_of_the_angle_are_no_mirror() {
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| {
        let (sin, cos) = (-87_f64).to_radians().sin_cos();
        let turned = |a: &f64, b: &f64| [cos * a - sin * b, sin * a + cos * b];
        let ([x, y], [fx, fy]) = (turned(x, y), turned(fx, fy));
        [*t, x, y, phi.to_degrees() - 87.0, fx, fy, *mz]
    });
    let (found, status) = looked(&text, ROD);
    assert!(meanings(&found)[3] == "phi0 deg" || status == 2, "{found:#}");
    assert!(!words(&found).contains("f0x=-N"), "{found:#}");
}

#[test]
fn names_that_are_not_si_leave_the_units_of_the_others_open() {
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| {
        [*t, 1e3 * x, 1e3 * y, phi.to_degrees(), 1e3 * fx, 1e3 * fy, 1e3 * mz]
    });
    let (found, status) = looked(&text, &[]);
    assert!(status == 2 && questions(&found).contains("in which unit is `f0x`"), "{found:#}");
    let (found, status) = looked(&text, ROD);
    assert!(status == 0 && words(&found).contains("--unit f0x=mN --unit f0y=mN --unit m0z=N mm"), "{found:#}");
    // counts: the arm of the moment is a hundred times the way
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| [*t, *x, *y, *phi, 1e6 * fx, 1e6 * fy, 1e8 * mz]);
    assert_eq!(looked(&text, &[]).1, 2);
}

/// A sensor turned by 20 degrees: part of the contact fits as it is, more if it is turned back.
#[test]
fn a_sensor_turned_by_no_right_angle_is_a_question() {
    for (degrees, options) in [(20.0_f64, ROD), (-30.0, ROD), (30.0, &[]), (45.0, &[])] {
        let text = table(FOREIGN, ",", |[t, x, y, phi, fx, fy, mz]| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            [*t, *x, *y, *phi, cos * fx - sin * fy, sin * fx + cos * fy, *mz]
        });
        let (found, status) = looked(&text, options);
        assert!(status == 2 && !questions(&found).is_empty(), "{degrees}: {found:#}");
    }
    // nothing tests a file in which hardly anything is in contact
    let few: String = own().lines().take(200).map(|line| line.to_owned() + "\n").collect();
    let (found, status) = looked(&few, &[]);
    assert!(status == 2 && questions(&found).contains("--rod FILE"), "{found:#}");
}

#[test]
fn reactions_that_nothing_explains_are_a_question() {
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| {
        let (sin, cos) = 30_f64.to_radians().sin_cos();
        [*t, *x, *y, *phi, cos * fx - sin * fy, sin * fx + cos * fy, *mz]
    });
    // the work along the way may fit another frame
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && !questions(&found).is_empty(), "{found:#}");
    // an angle that is wrong by 90 degrees
    let text = table(OWN, ",", |[t, x, y, _, fx, fy, mz]| [*t, *x, *y, 0.0, *fx, *fy, *mz]);
    assert_eq!(looked(&text, ROD).1, 2);
}

/// A stage at 1 Hz: its times in seconds are those of the sensor, in milliseconds they have 0.1 % in common.
#[test]
fn common_times_tell_seconds_from_milliseconds() {
    let directory = tempfile::tempdir().unwrap();
    let head = "t [s],Fx [N],Fy [N],Fz [N],Tx [N m],Ty [N m],Tz [N m]\n";
    let log = table(head, ",", |[t, _, _, _, fx, fy, mz]| [*t, *fx, *fy, 0.0, 0.0, 0.0, *mz]);
    fs::write(directory.path().join("log.csv"), log).unwrap();
    for (head, factor, unit) in
        [("t,x0,y0,phi0\n", 1.0, "t s"), ("time,x0,y0,phi0\n", 1.0, "t s"), ("t,x0,y0,phi0\n", 1e3, "t ms")]
    {
        let mut text = head.to_owned();
        for [t, x, y, phi, ..] in recording().iter().step_by(100) {
            let _ = writeln!(text, "{},{x},{y},{phi}", factor * t);
        }
        fs::write(directory.path().join("stage.csv"), text).unwrap();
        let files = ["log.csv", "stage.csv", "--rod", "rod.toml", "--stage-delay", "0"];
        let (found, status) = inspected(directory.path(), &files);
        assert_eq!((status, found["files"][1]["columns"][0]["unit"].as_str()), (0, unit.get(2..)), "{found:#}");
    }
    // alone, too, the name stands for seconds
    let slow: String = own().lines().step_by(100).map(|line| line.to_owned() + "\n").collect();
    assert!(fact(&looked(&slow, ROD).0, "rate").starts_with("1.000000 Hz"));
}

#[test]
fn rows_that_are_no_measurements() {
    let fault = |text: &str| {
        let (found, status) = looked(text, ROD);
        (found["files"][0]["faults"].to_string(), status)
    };
    let text = own();
    let changed = |of: &dyn Fn(usize, &mut Vec<String>)| -> String {
        let line = |(k, line): (usize, &str)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            of(k, &mut cells);
            cells.join(",") + "\n"
        };
        text.lines().enumerate().map(line).collect()
    };
    let mark = changed(&|k, cells| {
        if k == 50 || k == 90 {
            "-999".clone_into(&mut cells[4])
        }
    });
    assert!(fault(&mark).0.contains("-999 in 2 rows, far from all others"), "{}", fault(&mark).0);
    let clipped = changed(&|_, cells| {
        if let Ok(value) = cells[5].parse::<f64>() {
            cells[5] = value.min(0.02).to_string();
        }
    });
    assert!(fault(&clipped).0.contains("exactly 0.02, its limit"), "{}", fault(&clipped).0);
    let stuck = changed(&|k, cells| {
        if (1000..1100).contains(&k) {
            "-0.0123".clone_into(&mut cells[4])
        }
    });
    assert!(fault(&stuck).0.contains("-0.0123 in 100 rows one after the other"), "{}", fault(&stuck).0);
    let mut rows: Vec<&str> = text.lines().skip(1).collect();
    rows.sort_by_key(|line| line.bytes().rev().take(9).map(u64::from).fold(7, |sum, byte| (31 * sum + byte) % 1009));
    let (said, status) = fault(&(OWN.to_owned() + &rows.join("\n") + "\n"));
    assert!(status == 2 && said.contains("sort them"), "{said}");
}

#[test]
fn a_name_of_any_length_is_looked_at() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("long.csv"), "x".repeat(70_000)).unwrap();
    let output = vibrissa(directory.path(), &["inspect", "long.csv"]);
    assert!(output.status.code() == Some(2) && output.stdout.len() < 10_000, "{}", output.stdout.len());
}

/// The text of a row of the recording under foreign names: time, mm, degrees.
fn lab_rows(time: impl Fn(f64) -> String, separator: &str) -> String {
    let mut text = String::new();
    for [t, x, y, phi, fx, fy, mz] in recording() {
        let cells = [1e3 * x, 1e3 * y, phi.to_degrees(), *fx, *fy, 1e3 * mz].map(|value| format!("{value:.9e}"));
        let _ = writeln!(text, "{}{separator}{}", time(*t), cells.join(separator));
    }
    text
}

/// Hours, minutes and seconds.
fn clock(t: f64) -> String {
    let milliseconds = (1e3 * t).round() as u64;
    let (seconds, rest) = (milliseconds / 1000, milliseconds % 1000);
    format!("{:02}:{:02}:{:02}.{rest:03}", 10 + seconds / 3600, seconds / 60 % 60, seconds % 60)
}

const LAB: &str = "Stage X [mm],Stage Y [mm],Angle [deg],Force X [N],Force Y [N],Moment Z [N mm]\n";

#[test]
fn dates_are_times() {
    let rate = |found: &Value| fact(found, "rate").split(' ').next().unwrap().parse::<f64>().unwrap();
    for (name, time) in [
        ("Timestamp", (|t| format!("2026-03-12T{}", clock(t))) as fn(f64) -> String),
        ("Timestamp", |t| format!("2026-03-12T{}Z", clock(t))),
        ("time", |t| format!("2026-03-12 {}", clock(t))),
        ("Zeit", |t| format!("12.03.2026 {}", clock(t))),
        ("Date,Time", |t| format!("12.03.2026,{}", clock(t))),
    ] {
        let found = settles("scan.csv", (format!("{name},{LAB}") + &lab_rows(time, ",")).as_bytes());
        assert!((rate(&found) - 100.0).abs() < 0.01, "{found:#}");
        assert!(meanings(&found).contains(&"t s".to_owned()), "{found:#}");
        assert!(!found.to_string().contains("NaN"), "{found:#}");
    }
    // a spreadsheet counts days
    let days = |t: f64| format!("{:.10}", 46_093.0 + (36_000.0 + t) / 86_400.0);
    let found = settles("scan.csv", (format!("Timestamp,{LAB}") + &lab_rows(days, ",")).as_bytes());
    assert!(meanings(&found)[0] == "t day" && (rate(&found) - 100.0).abs() < 0.5, "{found:#}");
    let text = format!("Timestamp,{LAB}") + &lab_rows(|_| "noon".to_owned(), ",");
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && !found.to_string().contains("do not grow"), "{found:#}");
}

#[test]
fn rows_below_the_table_are_not_of_the_scan() {
    let text =
        format!("Time [s],{LAB}") + &lab_rows(|t| t.to_string(), ",") + "\nMean,1,2,3,4,5,6\nMax,2,3,4,5,6,7\nend\n";
    let found = settles("scan.csv", text.as_bytes());
    assert!(fact(&found, "motion of the clamp").starts_with("straight, 40.00 mm"), "{found:#}");
    assert!(found["files"][0]["columns"][4]["most"].as_f64().unwrap() < 1.0, "{found:#}");
}

#[test]
fn spellings_of_units_and_notes() {
    let rows = lab_rows(|t| t.to_string(), ",");
    for head in [
        "Time in s,Stage X in mm,Stage Y in mm,Angle in degrees,Force X in N,Force Y in N,Moment Z in N mm\n",
        "t [s],Stage X [mm],Stage Y [mm],Angle [deg],Force X [N],Force Y [N],Moment Z [N×mm]\n",
        "Время [с],Положение X [мм],Положение Y [мм],Угол [град],Сила X [Н],Сила Y [Н],Момент Z [Н·мм]\n",
        "time,pose.position.x [mm],pose.position.y [mm],pose.yaw [deg],wrench.force.x [N],wrench.force.y [N],wrench.torque.z [newton millimetre]\n",
    ] {
        settles("scan.csv", (head.to_owned() + &rows).as_bytes());
    }
    // a unit that is not understood is no statement
    let head = format!("t [s],{LAB}").replace("N mm", "foot-ells");
    let (found, status) = looked(&(head + &rows), ROD);
    assert!(status == 0 || questions(&found).contains("the unit `foot-ells` was not understood"), "{found:#}");
    assert!(!questions(&found).contains("the file states another unit"), "{found:#}");
    let note = rows.find("\n0.5").unwrap() + 1;
    let noted = format!("// rig 2\nt [s],{LAB}{}// note, with comma\n{}", &rows[..note], &rows[note..]);
    settles("scan.csv", noted.as_bytes());
    // a column that nobody needs asks nothing
    let warm: String = format!("t [s],{LAB}{rows}")
        .lines()
        .zip(0..)
        .fold(String::new(), |text, (line, k)| text + line + if k == 0 { ",Temperature [°C]\n" } else { ",20.5\n" });
    settles("scan.csv", warm.as_bytes());
}

#[test]
fn a_column_without_a_name_is_asked_for() {
    let text = format!("t [s],{LAB}").replace("Angle [deg]", "") + &lab_rows(|t| t.to_string(), ",");
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && questions(&found).contains("--column 'phi0=column 4'"), "{found:#}");
    assert!(!found.to_string().contains("a second table"), "{found:#}");
    let (found, status) = looked(&text, &[ROD, &["--column", "phi0=column 4"]].concat());
    assert_eq!(status, 0, "{found:#}");
}

#[test]
fn exchanged_coordinates_are_offered() {
    let text = table(OWN, ",", |[t, x, y, phi, fx, fy, mz]| [*t, *y, *x, *phi, *fx, *fy, *mz]);
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && questions(&found).contains("--column x0=y0 --column y0=x0"), "{found:#}");
    let (found, status) = looked(&text, &[ROD, &["--column", "x0=y0", "--column", "y0=x0"]].concat());
    assert_eq!(status, 0, "{found:#}");
}

/// 90 degrees are no 90 radians, however well another hypothesis fits.
#[test]
fn an_angle_beyond_a_turn_is_not_in_radians() {
    let text = table("t,x0,y0,phi0 [deg],Fx [N],Fy [N],Mz [N m]\n", ",", |[t, x, y, phi, fx, fy, mz]| {
        let (sin, cos) = 20_f64.to_radians().sin_cos();
        [*t, *x, *y, phi.to_degrees(), cos * fx + sin * fy, cos * fy - sin * fx, *mz]
    });
    let (found, status) = looked(&text, ROD);
    assert!(status == 2 && !questions(&found).contains("phi0=rad"), "{found:#}");
}

#[test]
fn too_few_rows_are_said() {
    for rows in [0, 3] {
        let text: String = own().lines().take(1 + rows).map(|line| line.to_owned() + "\n").collect();
        let (found, status) = looked(&text, ROD);
        let fault = &found["files"][0]["faults"][0];
        assert!(status == 2 && fault["value"] == rows.to_string().as_str(), "{found:#}");
        assert!(
            fault["expected"].as_str().unwrap().starts_with("at least 16 rows") && questions(&found).is_empty(),
            "{found:#}"
        );
    }
}

#[test]
fn files_of_trackers_are_no_tables_of_points() {
    let directory = tempfile::tempdir().unwrap();
    let text = "scorer,net,net,net,net,net,net\nbodyparts,base,base,base,tip,tip,tip\ncoords,x,y,likelihood,x,y,likelihood\n0,1,2,0.9,3,4,0.8\n";
    fs::write(directory.path().join("points.csv"), text).unwrap();
    fs::write(directory.path().join("rod.toml"), SCENE).unwrap();
    let output = vibrissa(directory.path(), &["forces", "points.csv", "--rod", "rod.toml"]);
    let said = complaint(&output);
    assert!(said.contains("found scorer, net;") && said.contains("read_deeplabcut"), "{said}");
    assert!(said.ends_with("`vibrissa inspect points.csv` shows what the file holds.\n"), "{said}");
}
