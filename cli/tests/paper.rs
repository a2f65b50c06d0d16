//! The nine scans of the paper, from the command to the files.

use crate::common::{complaint, vibrissa};
use std::fs;
use std::path::Path;

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
            for file in ["states.csv", "events.jsonl", "sweep.svg", "sweep.json"] {
                assert!(folder.join(file).metadata().unwrap().len() > 0);
            }
        }
    }
    let report = fs::read_to_string(out.join("paper.json")).unwrap();
    assert!(report.contains("\"complete\": true") && report.contains("\"missing\": []"), "{report}");
    assert_eq!(report.matches("\"matches\": true").count(), 9, "{report}");
    let cycles = fs::read_to_string(out.join("phase_cycles.svg")).unwrap();
    assert_eq!(cycles.matches(", as in the paper").count(), 9);
    let criterion = fs::read_to_string(out.join("criterion.svg")).unwrap();
    assert!(["O1_q40", "O2_q40", "O3_q40"].iter().all(|name| criterion.contains(name)));

    let goodness = texts(&out.join("goodness_of_fit.svg"));
    assert!(goodness.iter().any(|text| text.starts_with("simulated noise in place of the experiment")), "{goodness:?}");
    let fits: Vec<f64> = goodness.iter().filter_map(|text| text.parse().ok()).collect();
    assert_eq!(fits.len(), 27);
    assert!(fits.iter().all(|fit| (0.99..1.0).contains(fit)), "{fits:?}");

    let points = texts(&out.join("contact_points.svg"));
    for object in ["O1, q = 40 mm", "O2, q = 40 mm", "O3, q = 40 mm", "true contour", "x in mm", "y in mm"] {
        assert!(points.iter().any(|text| text == object), "{object} is not in {points:?}");
    }
    let errors: Vec<f64> = points.iter().filter_map(|text| number_between(text, "≤ ", " mm with two")).collect();
    assert!(errors.len() == 3 && errors.iter().all(|error| (4.0..7.0).contains(error)), "{errors:?}");
    let clean = points.iter().filter_map(|text| number_between(text, "error ≤ ", " mm with one"));
    assert!(clean.filter(|error| *error < 1e-9).count() == 3, "{points:?}");

    let notches = texts(&out.join("notches.svg"));
    let errors: Vec<f64> = notches.iter().filter_map(|text| number_between(text, "largest error ", " mm")).collect();
    assert!(errors.len() == 6 && errors[..3].iter().all(|error| *error > 4.0), "{notches:?}");
    assert!(errors[3..].iter().all(|error| *error < 1e-4), "{notches:?}");
    let shares = notches.iter().filter_map(|text| number_between(text, "", " % of the samples"));
    assert!(shares.filter(|share| *share >= 99.0).count() == 3, "{notches:?}");

    let diagram = texts(&out.join("phase_diagram.svg"));
    assert!(["free", "A", "B", "BA", "BB"].iter().all(|phase| diagram.iter().any(|text| text == phase)), "{diagram:?}");
    let mut counts: Vec<u32> = diagram.iter().filter_map(|text| text.parse().ok()).collect();
    counts.sort_unstable();
    // The steps of three cycles C1, two C2, four C3: free A, A free, A B, B A, B BB, BB B, BB BA, BA B, and A BA, of
    // which one is a touch and three are snaps.
    assert_eq!(counts, [1, 2, 3, 3, 5, 6, 9, 9, 9, 13]);

    let distances = texts(&out.join("distances.svg"));
    for text in ["q = 20 mm", "q = 40 mm", "q = 60 mm", "(a) O1", "(f) O3", "y − y0 in mm", "y in mm"] {
        assert!(distances.iter().any(|found| found == text), "{text} is not in {distances:?}");
    }
    let concave: Vec<&String> = distances.iter().filter(|text| text.starts_with("concave: ")).collect();
    assert!(concave.len() == 3 && concave.iter().all(|text| text.matches("apart").count() == 1), "{concave:?}");
}

/// The texts of a drawing, in order.
fn texts(file: &Path) -> Vec<String> {
    let drawing = fs::read_to_string(file).unwrap();
    let texts =
        drawing.split("<text").skip(1).map(|text| text.split_once('>').unwrap().1.split_once("</text>").unwrap().0);
    // without the tags of lowered letters
    let plain = |text: &str| text.split('<').map(|part| part.rsplit('>').next().unwrap()).collect::<String>();
    texts.map(|text| plain(text).trim().to_owned()).collect()
}

/// The number between two parts of a text.
fn number_between(text: &str, before: &str, after: &str) -> Option<f64> {
    text.split_once(before)?.1.split_once(after)?.0.parse().ok()
}
