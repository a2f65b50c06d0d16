//! Memory is bounded by the length of a file whatever is in it, and a recorder takes none.

use allocation_counter::measure;
use rod_core::{Pose, Reactions};
use rod_hw::recording::{Contents, Recorder, Table, TableOptions};
use rod_hw::{Channels, OutOfPlane, Quality, RawSample, ReactionSample};

/// A header that takes half of the file, and as many segments as there is room for.
fn many_segments(length: usize) -> String {
    let head = format!("LabVIEW Measurement\t\nNotes\t{}\n***End_of_Header***\t\n", "a".repeat(length / 2));
    head + &"X_Value\n\n".repeat(length / 18)
}

#[test]
fn of_files_that_mean_harm() {
    let count = 200_000;
    let alternating = |a: &str, b: &str| format!("{a}\n{b}\n").repeat(count / 4);
    let digits =
        (0..2000).map(|k| [0.1, 0.7, 1.3].map(|a| format!("{:.15}", (a * f64::from(k)).sin())).join(",") + "\n");
    let texts = [
        ("rows of one digit", "a\n".to_owned() + &"1\n".repeat(count / 2), 100.0),
        ("rows of one letter", "a\n1\n1\n1\n".to_owned() + &alternating("b", "c"), 100.0),
        ("rows of too many cells", "a,b\n1,2\n1,2\n1,2\n".to_owned() + &"1,,1\n".repeat(count / 5), 100.0),
        ("one line of delimiters", ",".repeat(count), 100.0),
        ("one line of quotes", "a,b\n1,2\n".to_owned() + &"\"".repeat(count), 100.0),
        ("few wide lines", (",1".repeat(4000) + "\n").repeat(count / 8000), 100.0),
        ("wide names above short rows", ",a".repeat(4000) + "\n" + &"1\n".repeat(count / 2), 100.0),
        ("comments", "#\n".repeat(count / 2), 100.0),
        ("many segments below a long header", many_segments(count), 100.0),
        ("numbers of 15 digits", "a,b,c\n".to_owned() + &digits.collect::<String>(), 4.0),
    ];
    for (what, text, most) in texts {
        let used = measure(|| drop(Table::parse_all("f.csv", text.as_bytes(), &TableOptions::default())));
        // the first lines are looked at whole
        let ratio = used.bytes_max as f64 / text.len() as f64;
        assert!(ratio < most, "{what}: {ratio} bytes a byte");
    }
}

#[test]
fn of_a_recorder() {
    let contents = Contents { raw: Some(6), ..Contents::default() };
    let sample = |k: u32| ReactionSample {
        t: f64::from(k),
        pose: Pose { x: 0.1, y: 0.2, phi: 1.5 },
        reactions: Reactions { f0x: 0.1, f0y: 0.2, m0z: 0.3 },
        sigma: None,
        systematic: None,
        out_of_plane: OutOfPlane::default(),
        quality: Quality::empty(),
        raw: RawSample::new(f64::from(k), Channels::from([0.1 * f64::from(k); 6])),
    };
    let record = |count| {
        let used = measure(|| {
            let mut recorder = Recorder::new(std::io::sink(), &[], contents).unwrap();
            (0..count).for_each(|k| recorder.write(&sample(k)).unwrap());
            recorder.finish(None).unwrap();
        });
        (used.bytes_max, used.count_total)
    };
    assert_eq!(record(10), record(10_000));
}
