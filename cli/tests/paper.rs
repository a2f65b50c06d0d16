//! The nine scans of the paper, from the command to the files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{complaint, vibrissa};
use std::fs;

#[test]
fn the_nine_scans_give_the_phases_of_the_paper() {
    let directory = tempfile::tempdir().unwrap();
    let output = vibrissa(directory.path(), &["paper"]);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    assert_eq!(complaint(&output), "", "no progress bar where nobody looks at a terminal");
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said.matches(": match)").count(), 9, "{said}");
    // O1, q = 0.4: the snap-off is a fold, the others are simple zeros.
    for place in ["0.646410161514", "0.451369186091", "-0.494186171964", "-0.567373240938", "-0.787160945062"] {
        assert!(said.contains(place), "{place} is not in: {said}");
    }
    let out = directory.path().join("out");
    for object in ["O1", "O2", "O3"] {
        for distance in [20, 40, 60] {
            let folder = out.join(format!("{object}_q{distance}"));
            let states = fs::read_to_string(folder.join("states.jsonl")).unwrap();
            assert_eq!(states.lines().count(), 171);
            for end in [states.lines().next(), states.lines().last()] {
                assert!(end.unwrap().contains("\"phase\":\"free\""), "a scan starts and ends free");
            }
            for file in ["states.csv", "events.jsonl", "sweep.svg"] {
                assert!(folder.join(file).metadata().unwrap().len() > 0);
            }
        }
    }
    let cycles = fs::read_to_string(out.join("phase_cycles.svg")).unwrap();
    assert_eq!(cycles.matches(", as in the paper").count(), 9);
    let criterion = fs::read_to_string(out.join("criterion.svg")).unwrap();
    assert!(["O1_q40", "O2_q40", "O3_q40"].iter().all(|name| criterion.contains(name)));
}
