//! What is timed, and how: all points of one task in turns.

use crate::measure::in_turns;
use crate::row::Row;
use std::time::Instant;

/// How long a point works in a round, seconds: what is faster is repeated.
const TURN: f64 = 1e-4;
/// Rounds of a task: as many as fit into so many seconds, within bounds.
const TASK: f64 = 6.0;
const ROUNDS: (usize, usize) = (7, 60);

/// A method with one setting, ready to be timed.
pub struct Point<'a> {
    pub method: &'static str,
    pub setting: String,
    /// Of each problem that it is judged by, or a few numbers that stand for many problems.
    pub errors: Vec<(String, Option<f64>)>,
    pub note: String,
    /// Does the work some times and returns how many; none where it does not lead to an answer.
    pub work: Option<Box<dyn FnMut() -> usize + 'a>>,
}

/// Times all points of a task in turns.
pub fn measure(task: &str, points: Vec<Point<'_>>) -> Vec<Row> {
    let (mut rows, mut works) = (Vec::new(), Vec::new());
    for Point { method, setting, errors, note, work } in points {
        let from = rows.len();
        rows.extend(errors.into_iter().map(|(problem, error)| Row {
            task: task.to_owned(),
            problem,
            method: method.to_owned(),
            setting: setting.clone(),
            error,
            seconds: None,
            note: note.clone(),
        }));
        works.extend(work.map(|work| (from..rows.len(), repeated(work))));
    }
    let mut turns: Vec<_> = works.iter_mut().map(|(_, work)| &mut **work as &mut dyn FnMut() -> usize).collect();
    let start = Instant::now();
    in_turns(1, &mut turns);
    let round = 0.5 * start.elapsed().as_secs_f64();
    let rounds = ((TASK / round) as usize).clamp(ROUNDS.0, ROUNDS.1);
    let times = in_turns(rounds, &mut turns);
    for ((of, _), time) in works.into_iter().zip(times) {
        rows[of].iter_mut().for_each(|row| row.seconds = Some(time.least));
    }
    rows
}

/// The same work as often as fits into a turn.
fn repeated<'a>(mut work: Box<dyn FnMut() -> usize + 'a>) -> Box<dyn FnMut() -> usize + 'a> {
    work();
    let start = Instant::now();
    work();
    let times = (TURN / start.elapsed().as_secs_f64().max(1e-9)) as usize;
    if times <= 1 { work } else { Box::new(move || (0..times).map(|_| work()).sum()) }
}

/// The median and the largest of errors, as those of two problems.
pub fn median_and_worst(mut errors: Vec<f64>) -> Vec<(String, Option<f64>)> {
    errors.sort_by(f64::total_cmp);
    let count = errors.len();
    let (median, worst) = (errors.get(count / 2).copied(), errors.last().copied());
    vec![(format!("median of {count}"), median), (format!("worst of {count}"), worst)]
}
