//! A branch of equilibria at many poses in a row, each from the one before: ours, and AUTO-07p where benches/peers/speed/auto/run has
//! prepared it. AUTO's program runs here, so that all are timed in turns.

use crate::boundary::NEWTON;
use crate::held::{Case, largest};
use crate::level::{duration, time_at};
use crate::measure::objects::{OBJECTS, rod};
use crate::point::{self, Point};
use crate::problem::Problem;
use crate::row::{NONE, Row, folder};
use crate::scan::SWEEP;
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::process::{Command, Stdio};
use vibrissa::contact::{Contact, ContactKind, State};
use vibrissa::rod::{NewtonOptions, NewtonWorkspace, Supports, solve};
use vibrissa::{ClampPath, Pose, Sweep, equilibrium};

const AUTO: &str = "AUTO-07p, NCOL";
const LEVELS: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// A branch: the transition that it starts from, the way of the clamp from one pose to the next (to -x), and the number of poses.
struct Branch {
    task: &'static str,
    name: &'static str,
    start: &'static str,
    step: f64,
    poses: usize,
}

/// As in benches/peers/speed/auto/c.b and c.bb.
const BRANCHES: [Branch; 2] = [
    Branch { task: "branch B", name: "b", start: "o1-q40-2-a-to-b", step: 1e-3, poses: 879 },
    Branch { task: "branch BB", name: "bb", start: "o1-q40-3-b-to-bb", step: 2e-4, poses: 314 },
];

pub const TASKS: [&str; 2] = [BRANCHES[0].task, BRANCHES[1].task];

fn options(tolerance: f64) -> NewtonOptions {
    NewtonOptions { tolerance, ..NewtonOptions::default() }
}

impl Branch {
    fn x0(&self, case: &Case<'_>) -> f64 {
        let (clamp, motion) = (case.problem.clamp.unwrap(), case.problem.motion.unwrap());
        case.problem.tau.unwrap().along(clamp.x, motion.x).hi
    }

    fn clamp(case: &Case<'_>, x: f64) -> Pose {
        Pose { x, ..case.clamp }
    }

    /// Calls `visit` with the solution at each pose, by Newton's method from the one before.
    fn walk(&self, case: &Case<'_>, tolerance: f64, mut visit: impl FnMut(f64, &[f64])) {
        let (mut u, mut workspace) = (case.solution.clone(), NewtonWorkspace::new());
        let x0 = self.x0(case);
        for k in 1..=self.poses {
            let x = x0 - self.step * k as f64;
            solve(&case.clamped(Self::clamp(case, x)), &mut u, &options(tolerance), &mut workspace);
            visit(x, &u);
        }
    }

    fn newton<'a>(&'a self, case: &'a Case<'a>, digits: i32) -> Point<'a> {
        let setting = format!("1e-{digits}");
        let tolerance = setting.parse().unwrap();
        let mut truth = Truth::new(case);
        let mut errors = Vec::new();
        self.walk(case, tolerance, |x, u| errors.push(truth.error(x, &seen(case, x, u))));
        let work = move || {
            self.walk(case, tolerance, |_, u| {
                black_box(u);
            });
            self.poses
        };
        self.point(NEWTON, setting, errors, Some(Box::new(work)))
    }

    /// States with their certificates.
    fn sweep<'a>(&'a self, case: &'a Case<'a>) -> Point<'a> {
        let contour = OBJECTS[0].contour();
        let x0 = self.x0(case) - self.step;
        let mut first = None;
        self.walk(case, 1e-13, |x, u| {
            if first.is_none() {
                first = Some((x, u.to_vec()));
            }
        });
        let guess = contacts(case, &first.unwrap().1);
        let start = equilibrium(&rod(), &contour, Self::clamp(case, x0), &guess).unwrap().state;
        let last = x0 - self.step * (self.poses - 1) as f64;
        let path = ClampPath::new(Self::clamp(case, x0), Self::clamp(case, last)).unwrap();
        let run = move || Sweep::from_state(&rod(), &contour, &start, path, self.step).unwrap().run().states;
        let mut truth = Truth::new(case);
        let errors = run().iter().map(|state| truth.error(state.pose.x, &seen_of(state))).collect();
        let work = move || black_box(run()).len();
        self.point(SWEEP, NONE.to_owned(), errors, Some(Box::new(work)))
    }

    /// What AUTO was prepared for.
    fn auto<'a>(&'a self, case: &'a Case<'a>) -> Vec<Point<'a>> {
        let Ok(all) = std::fs::read_dir(folder().join("auto")) else { return Vec::new() };
        let mut prepared: Vec<(u32, u32, std::path::PathBuf)> = all
            .filter_map(|entry| {
                let path = entry.unwrap().path();
                let name = path.file_name()?.to_str()?.to_owned();
                let [branch, ncol, ntst] = name.split('-').collect::<Vec<_>>()[..] else { return None };
                (branch == self.name).then(|| (ncol.parse().unwrap(), ntst.parse().unwrap(), path))
            })
            .collect();
        prepared.sort();
        let point = |(ncol, ntst, path): (u32, u32, std::path::PathBuf)| {
            let found = states(&path.join("states.txt"));
            let mut truth = Truth::new(case);
            // the first is the start, which is given
            let errors: Vec<f64> = found[1..].iter().map(|found| truth.error_of_auto(case, found)).collect();
            assert_eq!(errors.len(), self.poses, "{}", path.display());
            let work = move || {
                let mut program = Command::new(path.join("run"));
                program.current_dir(&path).env("OMP_NUM_THREADS", "1").stdout(Stdio::null());
                assert!(program.status().unwrap().success());
                self.poses
            };
            let method: &'static str = if ncol == 4 { "AUTO-07p, NCOL 4" } else { "AUTO-07p, NCOL 7" };
            self.point(method, ntst.to_string(), errors, Some(Box::new(work)))
        };
        prepared.into_iter().map(point).collect()
    }

    fn point<'a>(
        &self,
        method: &'static str,
        setting: String,
        errors: Vec<f64>,
        work: Option<Box<dyn FnMut() -> usize + 'a>>,
    ) -> Point<'a> {
        let error = Some(largest(errors)).filter(|error| error.is_finite());
        let note = format!("worst of {} states", self.poses);
        Point { method, setting, errors: vec![("O1, q = 0.4".to_owned(), error)], note, work }
    }
}

/// Reactions and contact points.
fn seen(case: &Case<'_>, x: f64, u: &[f64]) -> Vec<f64> {
    let kappa = case.clamped(Branch::clamp(case, x)).clamp_curvature(u);
    seen_with(case, u, kappa)
}

fn seen_with(case: &Case<'_>, u: &[f64], kappa: f64) -> Vec<f64> {
    let (mut f0x, mut f0y, mut seen) = (0.0, 0.0, Vec::new());
    for (j, of) in u.chunks_exact(3).enumerate() {
        let at = case.supports.support(j, of[0]);
        let (sin, cos) = at.alpha.sin_cos();
        (f0x, f0y) = (f0x - of[1] * sin, f0y + of[1] * cos);
        seen.extend([at.x, at.y]);
    }
    seen.extend([f0x, f0y, -kappa]);
    seen
}

fn seen_of(state: &State) -> Vec<f64> {
    let mut seen: Vec<f64> = state.contacts.iter().flat_map(|contact| [contact.x, contact.y]).collect();
    seen.extend([state.reactions.f0x, state.reactions.f0y, state.reactions.m0z]);
    seen
}

fn contacts(case: &Case<'_>, u: &[f64]) -> Vec<Contact> {
    let contact = |(j, of): (usize, &[f64])| {
        let at = case.supports.support(j, of[0]);
        let piece = case.problem.contacts[j].support.unwrap();
        let piece = if case.problem.contacts.len() == 1 { 1 } else { piece };
        Contact {
            object: 0,
            piece,
            kind: ContactKind::Tangent,
            s: of[2],
            x: at.x,
            y: at.y,
            alpha: at.alpha,
            force: of[1],
            friction: None,
        }
    };
    u.chunks_exact(3).enumerate().map(contact).collect()
}

/// Numbers of AUTO's states: x0; t, f, length of the segment of each contact; the curvature at the clamp.
fn states(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect()).collect()
}

/// The true states, one after the other: Newton's method to rounding.
struct Truth<'a> {
    case: &'a Case<'a>,
    u: Vec<f64>,
    workspace: NewtonWorkspace,
}

impl<'a> Truth<'a> {
    fn new(case: &'a Case<'a>) -> Self {
        Self { case, u: case.solution.clone(), workspace: NewtonWorkspace::new() }
    }

    fn error(&mut self, x: f64, found: &[f64]) -> f64 {
        let problem = self.case.clamped(Branch::clamp(self.case, x));
        let report = solve(&problem, &mut self.u, &options(1e-15), &mut self.workspace);
        assert!(report.residual < 1e-13, "{x}: {report:?}");
        let truth = seen(self.case, x, &self.u);
        largest(truth.iter().zip(found).map(|(truth, found)| (truth - found).abs() / (1.0 + truth.abs())))
    }

    fn error_of_auto(&mut self, case: &Case<'_>, found: &[f64]) -> f64 {
        let last = found.len() - 1;
        self.error(found[0], &seen_with(case, &found[1..last], found[last]))
    }
}

/// Both branches.
pub fn measure(problems: &[Problem]) -> Vec<Row> {
    let of = |branch: &Branch| {
        let case = Case::new(problems.iter().find(|problem| problem.name == branch.start).unwrap());
        let mut points: Vec<_> = (3..=13).step_by(2).map(|digits| branch.newton(&case, digits)).collect();
        points.push(branch.sweep(&case));
        points.extend(branch.auto(&case));
        point::measure(branch.task, points)
    };
    BRANCHES.iter().flat_map(of).collect()
}

/// How many times as long as Newton's method and a sweep AUTO takes for a state, at some errors, as Markdown.
pub fn table(rows: &[Row]) -> String {
    let mut text =
        "| branch | error | Newton | sweep, with certificate | AUTO-07p | over Newton | over the sweep |\n".to_owned();
    text.push_str("|---|---|---|---|---|---|---|\n");
    for task in TASKS {
        for level in LEVELS {
            let time = |method: &str| {
                let of = rows.iter().filter(|row| row.task == task && row.method.starts_with(method));
                let mut methods: Vec<&str> = of.clone().map(|row| row.method.as_str()).collect();
                methods.dedup();
                let times =
                    methods.iter().filter_map(|name| time_at(of.clone().filter(|row| row.method == *name), level));
                times.min_by(f64::total_cmp)
            };
            let [newton, sweep, auto] = [NEWTON, SWEEP, AUTO].map(time);
            let show = |time: Option<f64>| time.map_or(NONE.to_owned(), duration);
            let over = |other: Option<f64>| auto.zip(other).map_or(NONE.to_owned(), |(a, b)| format!("{:.0}", a / b));
            let [a, b, c] = [newton, sweep, auto].map(show);
            let _ = writeln!(text, "| {task} | {level:e} | {a} | {b} | {c} | {} | {} |", over(newton), over(sweep));
        }
    }
    text
}
