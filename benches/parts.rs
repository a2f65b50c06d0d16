//! The instructions of a certified state by part, counted by valgrind: a state that a sweep reports within a phase.
//!
//! `cargo bench -p vibrissa --bench parts` prints a table. Each phase is swept with few and with many reported states, by this very program: the
//! difference is the states themselves, without the steps between them. The functions of the parts are kept apart by `#[inline(never)]`.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic, reason = "a bench may, and it is there to be read")]

mod measure;

use measure::objects::{OBJECTS, path, rod, sweep};
use measure::slalom::Warm;
use measure::solves::PHASES;
use measure::{is_timed, machine};
use rayon::prelude::*;
use std::process::{Command, ExitCode};
use vibrissa::contact::Outcome;
use vibrissa::{ClampPath, Rod, State, Sweep};

/// Parts of a state, and the end of the name of the function that does each of them.
const PARTS: [(&str, &str); 6] = [
    ("solve", "Corrector<R>::solve"),
    ("gap proof", "Scanner::scan_between"),
    ("transitions looked for", "::keeps_contacts"),
    ("stability", "::keeps_stability"),
    ("report", "certify::state"),
    ("prediction", "Way::at_pose"),
];
/// Contacts of the last column.
const CONTACTS: usize = 8;
/// Few and many reported states.
const STATES: [usize; 2] = [101, 301];
/// The argument by which this program sweeps, under valgrind, in place of counting.
const WORK: &str = "--work";

/// The longest stretch of the sweep past O1 at q = 0.4 in a phase, from its first state to its last, with so many states.
fn sweep_phase(phase: &str, states: usize) -> Outcome {
    let contour = OBJECTS[0].contour();
    let all = sweep(&contour, path(0.4, 0.8, -0.9), 1701).states;
    let is_in_phase = |state: &State| state.phase().to_string() == phase;
    let stretches = all.chunk_by(|one, next| is_in_phase(one) == is_in_phase(next));
    let stretch = stretches.filter(|stretch| is_in_phase(&stretch[0])).max_by_key(|stretch| stretch.len()).unwrap();
    let (first, last) = (&stretch[0], &stretch[stretch.len() - 1]);
    let path = ClampPath::new(first.pose, last.pose).unwrap();
    let step = path.length() / (states - 1) as f64;
    Sweep::from_state(&rod(), &contour, first, path, step).unwrap().run()
}

/// Sweeps a case with so many states.
fn run(case: usize, states: usize) {
    let outcome = match PHASES.get(case) {
        Some(phase) => sweep_phase(phase, states),
        None => Warm::new(CONTACTS).sweep(&Rod::new(1.0, 1.0).unwrap(), states),
    };
    assert!(outcome.stop.is_none() && outcome.events.is_empty() && outcome.states.len() == states, "{outcome:?}");
}

/// Instructions of this program sweeping a case: of all, and of each part.
fn instructions(case: usize, states: usize) -> [f64; PARTS.len() + 1] {
    let file = std::env::temp_dir().join(format!("vibrissa-parts-{}-{case}-{states}", std::process::id()));
    let collected = Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(std::env::current_exe().unwrap())
        .args([WORK, &case.to_string(), &states.to_string()])
        .output()
        .unwrap();
    assert!(collected.status.success(), "{}", String::from_utf8_lossy(&collected.stderr));
    let annotated =
        Command::new("callgrind_annotate").args(["--inclusive=yes", "--threshold=100"]).arg(&file).output().unwrap();
    std::fs::remove_file(&file).unwrap();
    let text = String::from_utf8(annotated.stdout).unwrap();
    let count = |end: &str| {
        let lines =
            text.lines().filter(|line| line.split(" [").next().is_some_and(|name| name.trim_end().ends_with(end)));
        let numbers = lines.filter_map(|line| line.split_whitespace().next()?.replace(',', "").parse::<f64>().ok());
        numbers.fold(0.0, f64::max)
    };
    std::array::from_fn(|i| if i == 0 { count("PROGRAM TOTALS") } else { count(PARTS[i - 1].1) })
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == WORK) {
        let [case, states] = [1, 2].map(|k| arguments[at + k].parse::<usize>().unwrap());
        run(case, states);
        return ExitCode::SUCCESS;
    }
    if !is_timed() {
        return ExitCode::SUCCESS;
    }
    println!("{}", machine::line());
    println!("Instructions of a certified state by part");
    let columns: Vec<[f64; PARTS.len() + 1]> = (0..=PHASES.len())
        .into_par_iter()
        .map(|case| {
            let [few, many] = STATES.map(|states| instructions(case, states));
            std::array::from_fn(|i| (many[i] - few[i]) / (STATES[1] - STATES[0]) as f64)
        })
        .collect();
    println!("| part | {} | {CONTACTS} contacts |", PHASES.join(" | "));
    println!("|---|{}", "---|".repeat(columns.len()));
    let row = |name: &str, value: &dyn Fn(&[f64; PARTS.len() + 1]) -> f64| {
        let values: Vec<String> = columns.iter().map(|column| format!("{:.0}", value(column))).collect();
        println!("| {name} | {} |", values.join(" | "));
    };
    for (i, (name, _)) in PARTS.iter().enumerate() {
        row(name, &|column| column[i + 1]);
    }
    row("the rest", &|column| column[0] - column[1..].iter().sum::<f64>());
    row("all", &|column| column[0]);
    let found = columns.iter().all(|column| column[1..].iter().all(|part| *part > 0.0));
    println!(
        "{}",
        if found { "all parts found" } else { "A PART IS NOT FOUND: its function has been inlined or renamed" }
    );
    if found { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
