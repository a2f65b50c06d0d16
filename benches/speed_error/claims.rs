//! What is said of speed, and whether it holds.

use crate::boundary::{KERNEL, KERNELS, NEWTON, PHASES};
use crate::level::{cheapest, time_at};
use crate::measure::verdict;
use crate::row::{NONE, Row};
use crate::{scan, segment};

/// The kernel with derivatives costs at most so many kernels, a warm solve so many times its evaluations of the kernel.
const DERIVATIVES: f64 = 2.5;
const WARM: f64 = 4.0;
/// The tolerance of a solve where none is asked for.
const DEFAULT: &str = "1e-13";
/// Against scipy at equal error: how many times faster a warm solve of these phases and a scan are at least.
const ERROR: f64 = 1e-9;
const PEER: &str = "scipy";
const COLLOCATION: &str = "solve_bvp";
const FASTER: [(&str, f64); 3] = [("B warm", 1000.0), ("BB warm", 1000.0), (scan::TASK, 500.0)];

fn seconds(rows: &[Row], task: &str, method: &str, setting: &str) -> Option<(f64, f64)> {
    let row = rows.iter().find(|row| row.task == task && row.method == method && row.setting == setting)?;
    let count = row.note.strip_suffix(KERNELS).and_then(|count| count.trim().parse().ok());
    Some((row.seconds?, count.unwrap_or(f64::NAN)))
}

/// Methods of scipy that a task was done by with a name that ends so, and the fastest of them at the error.
fn scipy<'a>(rows: &[&'a Row], kind: &str, ending: &str) -> Option<(&'a str, f64)> {
    let of_scipy = |row: &&&Row| row.method.contains(PEER) && row.method.contains(kind) && row.method.ends_with(ending);
    let mut methods: Vec<&str> = rows.iter().filter(of_scipy).map(|row| row.method.as_str()).collect();
    methods.dedup();
    let time = |method: &str| time_at(rows.iter().copied().filter(|row| row.method == method), ERROR);
    methods.into_iter().filter_map(|method| Some((method, time(method)?))).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// By which method of scipy a task is done, and how many times faster by ours at equal error, on the same problem.
fn faster<'a>(rows: &'a [Row], task: &str) -> Vec<(&'a str, f64)> {
    let is_ours = |row: &&Row| [NEWTON, scan::SWEEP].contains(&row.method.as_str());
    let of_task = || rows.iter().filter(|row| row.task == task);
    let Some(problem) = of_task().find(is_ours).map(|row| &row.problem) else { return Vec::new() };
    let same: Vec<&Row> = of_task().filter(|row| row.problem == *problem).collect();
    let ours = || same.iter().copied().filter(is_ours);
    if task == scan::TASK {
        // with as many poses
        let poses = ours().filter_map(|row| {
            let (method, time) = scipy(&same, "", &format!(", {} poses", row.setting))?;
            Some((method, time / cheapest(std::iter::once(row), ERROR)?.1))
        });
        return poses.collect();
    }
    let solved = || Some((scipy(&same, COLLOCATION, "")?, cheapest(ours(), ERROR)?.1));
    solved().map(|((method, time), ours)| (method, time / ours)).into_iter().collect()
}

/// All claims that the rows can tell of.
pub fn claims(rows: &[Row]) -> Vec<String> {
    let mut claims = Vec::new();
    let kernel = |method| seconds(rows, segment::TASK, method, "f64").map(|(time, _)| time);
    if let (Some(plain), Some(derived)) = (kernel(segment::KERNEL), kernel(segment::DERIVATIVES)) {
        let what = format!("the closed form with its derivatives costs at most {DERIVATIVES} times the closed form");
        claims.push(verdict(&what, derived / plain, ..=DERIVATIVES));
    }
    for phase in PHASES {
        let task = format!("{phase} warm");
        let kernel = seconds(rows, &task, KERNEL, NONE);
        if let (Some((kernel, _)), Some((solve, count))) = (kernel, seconds(rows, &task, NEWTON, DEFAULT)) {
            let ratio = solve / (count * kernel);
            let what = format!("a warm solve of {phase} costs at most {WARM} times the {count} {KERNELS} in it");
            claims.push(verdict(&what, ratio, ..=WARM));
        }
    }
    for (task, least) in FASTER {
        for (method, ratio) in faster(rows, task) {
            let what = format!("{task} at an error of {ERROR:e} is at least {least} times faster than {method}");
            claims.push(verdict(&what, ratio, least..));
        }
    }
    claims
}
