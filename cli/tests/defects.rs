//! Scenes that an earlier version got wrong or did not finish: what each must give, and which of them do not yet.

use crate::witness::description::boundaries;
use crate::witness::run::{End, Run};
use rod_files::Scene;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Where a sweep may end.
type Ends = &'static [End];

/// The path is long enough, and nothing stands in the clamp's way.
const GOES_ON: Ends = &[End::Done];
/// The clamp is moved into the object.
const GOES_ON_OR_CLAMP_INSIDE: Ends = &[End::Done, End::ClampInside];
/// A rod that leans along an edge with its straight end: only ends that say so, or none.
const NOTCHED: Ends = &[End::Done, End::LineContact];

/// Steps of which none may change the events, in steps of the scene.
const STEPS: &[f64] = &[1.0, 0.999, 0.37, 0.125];
/// Only the sweep itself is judged, at a step that keeps it short: these scenes are about what is reconstructed from it.
const COARSE: &[f64] = &[50.0];

/// What a scene must give: no false state at any of the steps, one of these ends, and the same events at all of them.
struct Expected {
    name: &'static str,
    ends: Ends,
    steps: &'static [f64],
}

const fn expected(name: &'static str, ends: Ends, steps: &'static [f64]) -> Expected {
    Expected { name, ends, steps }
}

/// In the order of the files' names.
const SCENES: [Expected; 29] = [
    expected("chamfer_0_goes_on", GOES_ON, STEPS),
    expected("chamfer_1e-3_goes_on", GOES_ON, STEPS),
    expected("chamfer_1e-5_first_contact", GOES_ON, STEPS),
    expected("chamfer_second_contact", GOES_ON_OR_CLAMP_INSIDE, STEPS),
    expected("chamfer_start_in_contact", GOES_ON, STEPS),
    expected("ellipse_penetration_132", GOES_ON, STEPS),
    expected("ellipse_penetration_29", GOES_ON, STEPS),
    expected("ellipse_penetration_9", GOES_ON, STEPS),
    expected("ellipse_random_smallest_aspect", GOES_ON, STEPS),
    expected("false_contact_state", GOES_ON_OR_CLAMP_INSIDE, STEPS),
    expected("false_free_state_ellipse", GOES_ON, STEPS),
    expected("false_free_state_ellipse_least_aspect", GOES_ON, STEPS),
    expected("false_state_corner", GOES_ON, STEPS),
    expected("fillet_r1e-5_first_contact", GOES_ON, STEPS),
    expected("notch_40", NOTCHED, STEPS),
    expected("notch_8", NOTCHED, STEPS),
    // not known to be wrong: the landing may not exist
    expected("notch_88", &[End::Done, End::LineContact, End::NoLanding], &[1.0]),
    expected("recon_clean_BA_10", GOES_ON, COARSE),
    expected("recon_seed0", GOES_ON, COARSE),
    expected("recon_seed4", GOES_ON, COARSE),
    expected("silent_false_free_exit0", GOES_ON, STEPS),
    expected("stepdep_channel_1254", &[End::Done, End::LineContact, End::ClampInside], STEPS),
    expected("stepdep_hollow_1331", NOTCHED, STEPS),
    expected("stepdep_vnotch_1028", NOTCHED, STEPS),
    expected("stepdep_vnotch_1108", NOTCHED, STEPS),
    expected("stepdep_vnotch_1380", NOTCHED, STEPS),
    expected("thin_ellipse_0.005", GOES_ON, STEPS),
    expected("thin_ellipse_0.01", GOES_ON, STEPS),
    expected("tiny_edge_random_1099", GOES_ON, STEPS),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/defects")
}

/// What a scene does not give of what it must.
fn faults(expected: &Expected) -> Vec<String> {
    let file = folder().join(format!("{}.toml", expected.name));
    let text = std::fs::read_to_string(&file).unwrap();
    let mut scene = Scene::parse(&file, &text).unwrap();
    let objects = boundaries(&text).unwrap();
    let mut out = Vec::new();
    let mut first: Option<Run> = None;
    for factor in expected.steps {
        let run = Run::of(&mut scene, *factor);
        let (wrong, at_events) = (run.false_states(&scene, &objects), run.false_events(&scene, &objects));
        println!(
            "{} x{factor}: {:?}, {} states, {} events, {} + {} false",
            expected.name,
            run.end,
            run.states.len(),
            run.events.len(),
            wrong.len(),
            at_events.len()
        );
        out.extend(wrong.iter().map(|found| format!("x{factor}: false state, {found}")));
        out.extend(at_events.iter().map(|found| format!("x{factor}: false state at an event, {found}")));
        if !expected.ends.contains(&run.end) {
            out.push(format!("x{factor}: ends with {:?}", run.end));
        }
        match &first {
            None => first = Some(run),
            Some(one) => {
                let differs = one.differs(&run, scene.rod.length());
                out.extend(differs.map(|what| format!("x{factor}: not as at the first step, {what}")));
            }
        }
    }
    out
}

#[test]
fn every_file_is_in_the_table() {
    let files = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let names: BTreeSet<String> = files.map(|file| file.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    assert_eq!(names, SCENES.iter().map(|scene| scene.name.to_owned()).collect());
}

#[test]
fn scenes_give_what_they_must() {
    let mut wrong = Vec::new();
    for scene in &SCENES {
        let found = faults(scene);
        found.iter().for_each(|fault| println!("    {fault}"));
        wrong.extend(found.first().map(|fault| format!("{}: {fault}", scene.name)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
