//! Which figures there are.

use crate::boundary::PHASES;
use crate::figure::{Figure, Panel};
use crate::row::Row;
use crate::{branch, inversion, scan, segment, still};

/// One figure a group of tasks.
pub fn figures(rows: &[Row]) -> Vec<Figure<'_>> {
    let of_task = |task: &str| rows.iter().filter(|row| row.task == task).collect::<Vec<_>>();
    // of many problems the median and the worst, otherwise one panel a problem
    let by_problem = |task: &str| {
        let mut panels: Vec<Panel<'_>> = Vec::new();
        for row in of_task(task) {
            let title = row.problem.split(" of ").next().unwrap_or_default();
            let title = if title == row.problem { title.to_owned() } else { format!("{title} error of many problems") };
            match panels.iter_mut().find(|panel| panel.title == title) {
                Some(panel) => panel.rows.push(row),
                None => panels.push(Panel { title, rows: vec![row] }),
            }
        }
        panels
    };
    let by_phase = |how: &str| {
        let panel = |phase: &str| {
            let mut rows = of_task(&format!("{phase} {how}"));
            let problem = rows.first().map_or("", |row| &row.problem);
            // others may have measured other problems too
            rows.retain(|row| row.problem == problem);
            Panel { title: format!("phase {phase}: {problem}"), rows }
        };
        PHASES.map(panel).into_iter().filter(|panel| !panel.rows.is_empty()).collect()
    };
    let figure = |name, title, unit, panels| Figure { name, title, unit, panels };
    vec![
        figure("segment", "One segment of the rod", "time of one segment, s", by_problem(segment::TASK)),
        figure(
            "warm",
            "A boundary-value problem, from the solution with the clamp moved 1e-3",
            "time of one solve, s",
            by_phase("warm"),
        ),
        figure("cold", "A boundary-value problem, from a rough guess", "time of one solve, s", by_phase("cold")),
        figure("scan", "Transitions of a whole scan", "time of the scan, s", by_problem(scan::TASK)),
        figure(
            "inversion",
            "From reactions back to the contact",
            "time of one contact, s",
            by_problem(inversion::TASK),
        ),
        figure(
            "branch",
            "A branch of equilibria, each from the one before",
            "time of one state, s",
            branch::TASKS.iter().map(|task| Panel { title: (*task).to_owned(), rows: of_task(task) }).collect(),
        ),
        figure("static", "One pose, the tip on a floor", "time, s", by_problem(still::TASK)),
    ]
}
