//! Time against true error: every method that there is for a task, at every setting, on problems whose results are known to
//! 30 digits.
//!
//! `cargo bench --bench speed_error` measures, prints a table and draws figures into `speed-against-error` of cargo's target
//! directory. `-- --figures` draws again what was measured before, with what `benches/peers/speed/run` left there of other
//! programs. `-- --docs` also puts figures and numbers into docs/speed-against-error.md. `-- --branch` measures branches of equilibria
//! alone, with AUTO-07p where benches/peers/speed/auto/run has prepared it, and draws their figure.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

#[path = "../measure/mod.rs"]
mod measure;

mod boundary;
mod branch;
mod claims;
mod exact;
mod figure;
mod figures;
mod guess;
mod held;
mod integrators;
mod inversion;
mod level;
mod minimise;
mod page;
mod point;
mod problem;
mod rk4;
mod row;
mod scalar;
mod scan;
mod segment;
mod shooting;
mod still;

use guess::Start;
use held::Case;
use measure::{is_timed, machine};
use problem::Problem;
use row::Row;

/// Rows of this program, of other programs.
const OURS: &str = "ours.csv";
const PEERS: &str = "peers.csv";
/// Rows of both, measured in turns.
const BRANCHES: &str = "branches.csv";
/// On what they were measured.
const MACHINE: &str = "machine.txt";

/// What rounding makes of a true solution, where the problem is as well conditioned as can be.
const ROUNDING: f64 = 1e-15;

/// The problems of the phases; where one is not in the reference set, the first of its phase is taken.
const CHOSEN: [&str; 6] =
    ["a-parabola", "b-parabola", "ba-two-parabolas", "bb-two-parabolas", "bba-discs", "bbb-discs"];

/// The reference problem of a phase.
fn chosen<'a>(problems: &'a [Problem], phase: &str) -> Option<&'a Problem> {
    let of_phase = || problems.iter().filter(|problem| problem.phase().as_deref() == Some(phase));
    let named = |problem: &&Problem| CHOSEN.contains(&problem.name.as_str());
    of_phase().find(named).or_else(|| of_phase().find(|problem| problem.is_moderate()))
}

/// Measures all tasks.
fn measured(problems: &[Problem]) -> Vec<Row> {
    let mut rows = point::measure(segment::TASK, segment::points(problems));
    for phase in boundary::PHASES {
        let Some(problem) = chosen(problems, phase) else { continue };
        let case = Case::new(problem);
        for (how, start) in [("warm", Start::warm(&case)), ("cold", Start::cold(&case))] {
            rows.extend(point::measure(&format!("{phase} {how}"), boundary::points(&case, &start)));
        }
    }
    if let Some(problem) = problems.iter().find(|problem| problem.name == still::FLOOR) {
        let case = Case::new(problem);
        let start = Start::cold(&case);
        let points = still::point(&case).into_iter().chain(boundary::newton(&case, &start));
        rows.extend(point::measure(still::TASK, points.collect()));
    }
    rows.extend(point::measure(scan::TASK, scan::points(problems)));
    rows.extend(point::measure(inversion::TASK, inversion::points(problems)));
    rows
}

fn print(rows: &[Row]) {
    let number = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1e}"));
    println!("{:14} {:24} {:28} {:>8} {:>8} {:>8}  note", "task", "problem", "method", "setting", "error", "seconds");
    for Row { task, problem, method, setting, error, seconds, note } in rows {
        let (error, seconds) = (number(*error), number(*seconds));
        println!("{task:14} {problem:24} {method:28} {setting:>8} {error:>8} {seconds:>8}  {note}");
    }
}

/// Fails where a true solution is none to this program.
fn check(problems: &[Problem]) {
    let of_contacts = || problems.iter().filter(|problem| problem.phase().is_some());
    for case in of_contacts().map(Case::new) {
        let (name, error) = (&case.problem.name, case.error(&case.solution));
        assert!(error < ROUNDING * case.problem.condition.max(1.0), "{name}: {error:e}");
    }
    println!("{} reference problems, {} with contacts", problems.len(), of_contacts().count());
}

fn main() {
    exact::check();
    let problems = problem::problems();
    if !is_timed() {
        check(&problems);
        return;
    }
    let asked = |what: &str| std::env::args().any(|argument| argument == what);
    let folder = row::folder();
    let machine = folder.join(MACHINE);
    if asked("--branch") {
        let rows = branch::measure(&problems);
        row::write(&folder.join(BRANCHES), &rows);
        print(&rows);
        println!("\n{}", branch::table(&rows));
    } else if !asked("--figures") {
        row::write(&folder.join(OURS), &measured(&problems));
        std::fs::write(&machine, machine::line()).unwrap();
    }
    let mut rows = row::read(&folder.join(OURS));
    rows.extend(row::read(&folder.join(PEERS)));
    rows.extend(row::read(&folder.join(BRANCHES)));
    print(&rows);
    let figures = figures::figures(&rows);
    let mut drawn = Vec::new();
    for figure in &figures {
        if let Some(drawing) = figure.draw() {
            let path = folder.join(figure.name).with_extension("svg");
            std::fs::write(&path, drawing).unwrap();
            println!("{}", path.display());
            drawn.push(path);
        }
    }
    let claims = claims::claims(&rows);
    claims.iter().for_each(|claim| println!("{claim}"));
    let machine = std::fs::read_to_string(&machine).unwrap_or_default();
    let measured = page::measured(&machine, &rows, &figures, &claims);
    std::fs::write(folder.join("measured.md"), &measured).unwrap();
    if asked("--docs") {
        page::update(&measured, &drawn);
    }
}
