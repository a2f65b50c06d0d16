//! Every fault of a recording is answered with its file and line, the value and what was expected.

use rod_files::{Place, ReadOptions, Recording, RecordingError, RowProblem};
use vibrissa::{Pose, Rod};

const HEADER: &str = "x0,y0,phi0,f0x,f0y,m0z";

fn parse(text: &str) -> Result<Recording, RecordingError> {
    Recording::parse("rec.csv".as_ref(), text.as_bytes(), &Rod::new(0.1, 6.32e-4).unwrap())
}

/// A recording of 20 rows on lines 2 to 21, the clamp moving by 1 mm a row, with some of them replaced.
fn with_rows(replaced: &[(usize, &str)]) -> String {
    let mut rows: Vec<String> = (0..20).map(|k| format!("{},-0.04,1.5,0.1,-0.2,3e-3", 80 - k)).collect();
    for &(line, row) in replaced {
        rows[line - 2] = row.to_owned();
    }
    format!("{HEADER}\n{}\n", rows.join("\n"))
}

/// Checks that there is no recording, and that the message holds all these parts.
fn refuses(text: &str, parts: &[&str]) {
    let message = parse(text).unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert_eq!(message.lines().count(), 1, "{message}");
}

/// Checks that exactly this line cannot be used, and what is said of it.
fn leaves_out(line: usize, row: &str, message: &str) -> RowProblem {
    let recording = parse(&with_rows(&[(line, row)])).unwrap();
    assert_eq!(recording.rows.len(), 20);
    assert_eq!(recording.samples().count(), 19);
    let fault = recording.rows[line - 2].as_ref().unwrap_err();
    assert_eq!(fault.to_string(), format!("line {line}: {message}"));
    let warning = format!("rec.csv: 1 of 20 rows cannot be used, line {line}: {message}");
    assert_eq!(recording.warnings(), [warning]);
    fault.problem.clone()
}

#[test]
fn columns_in_any_order_with_others_between_them() {
    let mut text =
        "# made by hand, \"quoted\nm0z, phi0 ,note,\"f0y\",x0,sigma_m0z,t,y0,sigma_f0y,f0x,sigma_f0x\r\n".to_owned();
    for k in 0..12 {
        text += &format!("{k}.5, 1.5,hello,{k},-{k}.25,0.1,{k},7,0.2,\"-3\",0.3\r\n");
        if k == 5 {
            text += "\r\n# a \"comment\n   \n";
        }
    }
    let recording = parse(&text).unwrap();
    assert_eq!(recording.warnings(), ["rec.csv: columns not used: note"]);
    assert_eq!(recording.rows.len(), 12);
    let sample = recording.rows[11].as_ref().unwrap();
    assert_eq!(sample.pose, Pose { x: -11.25, y: 7.0, phi: 1.5 });
    assert_eq!((sample.reactions.f0x, sample.reactions.f0y, sample.reactions.m0z), (-3.0, 11.0, 11.5));
    let sigma = sample.sigma.unwrap();
    assert_eq!((sigma.f0x, sigma.f0y, sigma.m0z, sample.t), (0.3, 0.2, 0.1, Some(11.0)));
}

#[test]
fn a_byte_order_mark_and_no_newline_at_the_end() {
    let text = "\u{feff}".to_owned() + with_rows(&[]).trim_end();
    let recording = parse(&text).unwrap();
    assert_eq!(recording.samples().count(), 20);
    assert!(recording.samples().all(|sample| sample.t.is_none() && sample.sigma.is_none()));
}

#[test]
fn missing_columns() {
    refuses(
        "# scan 3\nx0,y0,phi0,f0x,f0y\n",
        &[
            "rec.csv:2: no column m0z, found x0, y0, phi0, f0x, f0y; expected x0, y0 (m), phi0 (rad), f0x, f0y (N), m0z (N m)",
        ],
    );
    refuses(
        "x0,y0,PHI0,f0x-mean,f0y,m0z\n",
        &[
            "no column phi0, f0x, found x0, y0, PHI0, f0x-mean, f0y, m0z; expected",
            "; `PHI0` is phi0 but for its letters' case",
            "; is `f0x-mean` f0x? Give it in N and name it f0x",
        ],
    );
    refuses(
        "0.1,0.2,0.3,0,0,0\n",
        &["rec.csv:1: the first line holds numbers, expected the names of the columns above them; add such a line"],
    );
    refuses(&format!("{HEADER},sigma_f0x\n"), &["no column sigma_f0y, sigma_m0z, found x0", "all of sigma_f0x"]);
    refuses(&format!("{HEADER},f0x\n"), &["rec.csv:1: two columns are named f0x, expected one; say which"]);
    refuses("", &["rec.csv: no line that names columns, expected x0, y0 (m)"]);
    refuses("# only this\n\n", &["rec.csv: no line that names columns"]);
}

#[test]
fn cells_that_are_no_numbers() {
    leaves_out(7, "75,-0.04,1.5,abc,-0.2,3e-3", "f0x is `abc`, expected a number");
    leaves_out(7, "75,-0.04,1.5,,-0.2,3e-3", "f0x is empty, expected a number");
    leaves_out(7, "75 mm,-0.04,1.5,0.1,-0.2,3e-3", "x0 is `75 mm`, expected a number");
    leaves_out(2, "80,-0.04,1.5,0.1,-0.2,nan", "m0z is NaN, expected a finite number");
    leaves_out(21, "61,-0.04,1.5,0.1,-inf,0", "f0y is -inf, expected a finite number");
    leaves_out(21, "61,-0.04,1e999,0.1,0,0", "phi0 is inf, expected a finite number");
}

#[test]
fn the_pose_is_known_where_only_the_reactions_are_not() {
    let recording = parse(&with_rows(&[(7, "75,-0.04,1.5,abc,-0.2,3e-3"), (9, "x,0,0,0,0,0")])).unwrap();
    let poses: Vec<_> = recording.faults().map(|fault| fault.pose).collect();
    assert_eq!(poses, [Some(Pose { x: 75.0, y: -0.04, phi: 1.5 }), None]);
}

#[test]
fn lines_are_those_of_an_editor() {
    for end in ["\n", "\r\n"] {
        let mut lines = vec!["# a comment", "", HEADER, "", ""];
        let rows: Vec<String> =
            (0..20).map(|k| format!("{k},0,0,0,0,{}", if k % 7 == 3 { "?" } else { "0" })).collect();
        for (k, row) in rows.iter().enumerate() {
            lines.push(row);
            // Blank lines and comments, also right before rows with faults.
            lines.extend(match k {
                2 => vec!["", "# one", ""],
                9 => vec!["   ", ""],
                _ => vec![],
            });
        }
        let recording = parse(&lines.join(end)).unwrap();
        let found: Vec<Place> = recording.faults().map(|fault| fault.place).collect();
        let expected: Vec<Place> =
            (1..).zip(&lines).filter(|(_, line)| line.ends_with('?')).map(|(k, _)| Place::Line(k)).collect();
        assert_eq!((found.len(), found), (3, expected));
    }
}

#[test]
fn rows_of_another_length() {
    leaves_out(7, "75,-0.04,1.5", "the number of cells is 3, expected 6");
    leaves_out(7, "75,-0,04,1,5,0,1", "the number of cells is 7, expected 6");
    let trailing = with_rows(&[(7, "75,-0.04,1.5,0.1,-0.2,3e-3,,")]);
    assert_eq!(parse(&trailing).unwrap().samples().count(), 20, "empty cells at the end do no harm");
}

#[test]
fn poses_that_do_not_go_on() {
    let problem = leaves_out(7, "76,-0.04,1.5,0,0,0", "the pose of line 6 is repeated, expected a clamp that moves");
    assert_eq!(problem, RowProblem::Repeated { of: Place::Line(6) });
    let back = "the pose turns back behind that of line 6, expected a clamp that goes on in one direction";
    assert_eq!(leaves_out(7, "76.5,-0.04,1.5,0,0,0", back), RowProblem::TurnsBack { of: Place::Line(6) });
    // A row with a fault is not one that the next may repeat.
    let recording = parse(&with_rows(&[(7, "75,-0.04,1.5,?,0,0"), (8, "75,-0.04,1.5,0,0,0")])).unwrap();
    assert_eq!(recording.samples().count(), 19);
}

#[test]
fn a_scan_there_and_back() {
    let mut text = format!("{HEADER}\n");
    for k in (0..30).chain((0..30).rev()) {
        text += &format!("{k},0,0,0,0,0\n");
    }
    // its passes are reconstructed one by one
    let recording = parse(&text).unwrap();
    assert_eq!(recording.samples().count(), 60);
    assert!(recording.warnings().is_empty(), "{:?}", recording.warnings());
}

#[test]
fn standard_deviations_that_are_none() {
    let mut text = format!("{HEADER},sigma_f0x,sigma_f0y,sigma_m0z\n");
    for k in 0..20 {
        text += &format!(
            "{k},0,0,0,0,0,0.1,{},0.1\n",
            if k == 3 {
                "0"
            } else if k == 4 {
                "-1"
            } else {
                "0.1"
            }
        );
    }
    let recording = parse(&text).unwrap();
    let faults: Vec<String> = recording.faults().map(ToString::to_string).collect();
    let expected =
        ["line 5: sigma_f0y is 0, expected a positive number", "line 6: sigma_f0y is -1, expected a positive number"];
    assert_eq!(faults, expected);
}

#[test]
fn a_time_that_does_not_grow_is_told_of() {
    let mut text = format!("{HEADER},t\n");
    for k in 0..20 {
        text += &format!(
            "{k},0,0,0,0,0,{}\n",
            if k == 3 {
                2
            } else if k == 8 {
                0
            } else {
                k
            }
        );
    }
    let recording = parse(&text).unwrap();
    assert_eq!(recording.samples().count(), 20);
    assert_eq!(recording.late, [5, 10].map(Place::Line));
    assert_eq!(recording.warnings(), ["rec.csv: the time does not increase in 2 of 20 rows, lines 5, 10"]);
}

#[test]
fn too_few_usable_rows() {
    refuses(&format!("{HEADER}\n"), &["rec.csv: 0 usable rows, expected at least 10"]);
    refuses(&format!("{HEADER}\n1,0,0,0,0,0\n2,0,0,0,0,0\n"), &["rec.csv: 2 usable rows, expected at least 10"]);
    let mut text = format!("{HEADER}\n");
    for k in 0..100 {
        text += &format!(
            "{k},0,0,0,0,{}\n",
            if k % 5 < 2 {
                "0"
            } else if k % 5 == 2 {
                "?"
            } else {
                "nan"
            }
        );
    }
    refuses(
        &text,
        &[
            "rec.csv: 60 of 100 rows cannot be used, expected at most half of them; line 4: m0z is `?`, expected a number; line 5: m0z is NaN, expected a finite number",
        ],
    );
}

/// The same rows as [`with_rows`], written in another way.
fn written(header: &str, delimiter: &str, comma: bool, scale: [f64; 6]) -> String {
    let mut text = header.to_owned() + "\n";
    for k in 0..20 {
        let row = [0.08 - 1e-3 * f64::from(k), -0.04, 1.5, 0.125, -0.25, 3e-3];
        let cells: Vec<String> = row.iter().zip(scale).map(|(value, scale)| format!("{:?}", value * scale)).collect();
        let row = cells.join(delimiter);
        text += &(if comma { row.replace('.', ",") } else { row } + "\n");
    }
    text
}

#[test]
fn tables_of_other_programs() {
    let ones = [1.0; 6];
    let names = ["x0", "y0", "phi0", "f0x", "f0y", "m0z"];
    let units = "x0 [mm];y0 [mm];phi0 [rad];f0x [mN];f0y [mN];m0z [N mm]";
    let thousand = [1e3, 1e3, 1.0, 1e3, 1e3, 1e3];
    let lvm = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tOne\n***End_of_Header***\t\n\t\n\
        Channels\t5\nY_Unit_Label\tmm\trad\tmN\tmN\tN mm\n***End_of_Header***\nX_Value\ty0\tphi0\tf0x\tf0y\tm0z\tx0 [mm]\tComment";
    let expected = parse(&written(HEADER, ",", false, ones)).unwrap();
    for (text, scale) in [
        (written(&names.join("\t"), "\t", false, ones), 1.0),
        (written(&names.join(";"), ";", true, ones), 1.0),
        (written(&names.join(" "), " ", true, ones), 1.0),
        (written(&format!("Messung 3; Probe 1\n\n{units}"), ";", true, thousand), 1e3),
        (written(&units.replace(" [", "_").replace(']', "").replace("N mm", "Nmm"), ";", false, thousand), 1e3),
        (written(&format!("{}\nmm,mm,rad,mN,mN,N mm", names.join(",")), ",", false, thousand), 1e3),
        (lvm.to_owned() + &lvm_rows(), 1e3),
    ] {
        let found = parse(&text).unwrap();
        assert_eq!(found.samples().count(), 20, "{text}");
        for (found, expected) in found.samples().zip(expected.samples()) {
            let (f, e) = (found.reactions, expected.reactions);
            let pairs = [
                (found.pose.x, expected.pose.x),
                (found.pose.y, expected.pose.y),
                (f.f0x, e.f0x),
                (f.f0y, e.f0y),
                (f.m0z, e.m0z),
            ];
            for (found, expected) in pairs {
                // a product and a quotient by 1000 are rounded once each
                let bound = if scale == 1.0 { 0.0 } else { 4.0 * f64::EPSILON * expected.abs() };
                assert!((found - expected).abs() <= bound, "{found} {expected} in {text}");
            }
        }
    }
}

fn lvm_rows() -> String {
    let rows = (0..20).map(|k| format!("{k},0\t-40,0\t1,5\t125,0\t-250,0\t3,0\t{},0", 80 - k));
    "\n".to_owned() + &rows.collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn tables_that_are_ambiguous() {
    let comma = written(HEADER, ",", true, [1.0; 6]);
    refuses(
        &comma,
        &[
            "rec.csv:2: `0,08,-0,04,1,5,0,125,-0,` could be numbers with decimal commas or numbers separated by commas (12 of them, under 6 names)",
        ],
    );
    refuses(
        "x0,y0,phi0f0x,f0y,m0z\n80,-0.04,1.5,0.1,-0.2,3e-3\n",
        &["rec.csv:1: 5 names, but 6 cells in most rows", "a delimiter is missing in `phi0f0x`; correct line 1"],
    );
    refuses(
        &written("x0 [mm],y0 [mm],phi0 [rad],f0x [N m],f0y [mN],m0z", ",", false, [1.0; 6]),
        &["rec.csv:1: the unit of f0x [N m]: `N m` is a unit of torque, expected one of force: N, mN"],
    );
    refuses(
        &written("F0x,y0,phi0,x0,f0y,m0z", ",", false, [1.0; 6]),
        &["rec.csv:1: no unit of F0x, expected one of force, as in `F0x [N]`"],
    );
}

#[test]
fn a_file_that_was_cut() {
    let text = with_rows(&[]);
    let recording = parse(text.trim_end().trim_end_matches(",3e-3")).unwrap();
    assert_eq!(recording.samples().count(), 19);
    let cell = "the number of cells is 5, expected 6; the file was cut there";
    assert_eq!(
        recording.warnings(),
        [
            format!("rec.csv: 1 of 20 rows cannot be used, line 21: {cell}"),
            "rec.csv: the end of the recording is missing".into()
        ]
    );
}

#[test]
fn what_a_recorder_wrote() {
    use vibrissa::hw::recording::{Contents, Recorder};
    use vibrissa::hw::{OutOfPlane, Quality, RawSample, ReactionSample};
    let contents = Contents { raw: Some(0), sigma: true, ..Contents::default() };
    let mut recorder = Recorder::new(Vec::new(), &[], contents).unwrap();
    let sample = |k: i32| ReactionSample {
        t: 0.1 * f64::from(k),
        pose: Pose { x: 1e-3 * f64::from(k), y: -0.04, phi: 1.5 },
        reactions: vibrissa::rod::Reactions { f0x: 0.1, f0y: 0.2, m0z: 1e-3 },
        sigma: Some(vibrissa::rod::Reactions { f0x: 1e-3, f0y: 1e-3, m0z: 1e-5 }),
        systematic: None,
        out_of_plane: OutOfPlane::default(),
        quality: match k {
            3 => Quality::GAP_BEFORE,
            7 => Quality::SATURATED | Quality::GAP_BEFORE,
            _ => Quality::empty(),
        },
        raw: RawSample::default(),
    };
    for k in 0..20 {
        recorder.write(&sample(k)).unwrap();
    }
    let file = recorder.finish(None).unwrap();
    let rod = Rod::new(0.1, 6.32e-4).unwrap();
    let recording = Recording::parse("rec.csv".as_ref(), &file, &rod).unwrap();
    let expected: Vec<_> = (0..20).filter(|k| *k != 7).map(|k| sample(k).sample()).collect();
    assert_eq!(recording.samples().copied().collect::<Vec<_>>(), expected);
    let warnings = recording.warnings();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings[0].starts_with("rec.csv: columns not used: host_time, device_time"), "{warnings:?}");
    let flagged = "line 11: the sensor flagged the sample: saturated, gap before, expected a sample without flags";
    assert_eq!(warnings[1], format!("rec.csv: 1 of 20 rows cannot be used, {flagged}"));

    let cut = Recording::parse("rec.csv".as_ref(), &file[..file.len() - 40], &rod).unwrap();
    assert!(cut.warnings().contains(&"rec.csv: the end of the recording is missing".to_owned()));
}

#[test]
fn a_file_that_cannot_be_read() {
    let rod = Rod::new(0.1, 6.32e-4).unwrap();
    let message = Recording::read("nowhere.csv".as_ref(), &rod, &ReadOptions::default()).unwrap_err().to_string();
    assert!(message.starts_with("cannot read the recording nowhere.csv: "), "{message}");
    // Latin-1 is text, a byte of zero is not.
    let latin = Recording::parse("latin.csv".as_ref(), b"\xff\xd8\xff\xe0,a\n", &rod).unwrap_err().to_string();
    assert!(latin.starts_with("latin.csv:1: no column x0, y0"), "{latin}");
    let image = Recording::parse("image.csv".as_ref(), b"\xff\xd8\n\xff\xe0,\x00\n", &rod).unwrap_err().to_string();
    assert_eq!(image, "image.csv:2: a byte of zero, which no text has, expected a table (CSV, TSV or LVM)");
}
