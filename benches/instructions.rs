//! Instructions, which noise cannot move: counted by valgrind and compared with those that are kept in instructions.csv.
//!
//! `cargo bench --bench instructions` prints them beside the kept ones and fails where one has grown by more than 5 %;
//! `-- --keep` keeps them. Another compiler, or a processor with other instructions, for which the mathematics of the system has
//! other code, counts otherwise: then nothing is compared. Each work is run a few and many times by this very program: the difference is the work itself,
//! without what comes before it. Works are counted at the same time, one on each processor: they do not see each other.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic, reason = "a bench may, and it is there to be read")]

mod measure;

use measure::objects::{OBJECTS, path, rod, sweep};
use measure::slalom::Warm;
use measure::solves::{self, PHASES};
use measure::waves::{self, Kind};
use measure::{kernel, segments, verdict};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::hint::black_box;
use std::process::{Command, ExitCode};
use vibrissa::contact::Derivatives;
use vibrissa::reconstruct::{Ar1, Budget, Friction, NoiseModel, single};
use vibrissa::rod::{
    AnyRod, Cone, Cut, NewtonWorkspace, Reactions, RodModel, RodSection, Sections, Smooth, VaryingRod, advance,
    advance_with_sensitivities, walk,
};
use vibrissa::{ClampPath, Composite, Pose, Rod, Sample, Settings, State, Sweep, equilibrium, reconstruct};

/// What is kept, beside this file.
const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.csv");
/// Works that are compared with each other.
const SEGMENT: &str = "segment";
const DERIVATIVES: &str = "segment with derivatives";
const EDGES: [&str; 2] = ["sweep past edges: 1000", "sweep past edges: 2000"];
const SWEPT_OVER: [&str; 2] = ["sweep over an edge of a polygon of 500", "sweep over an edge of a polygon of 2000"];
/// Coefficients of friction, and what is estimated of the errors that samples share.
const FRICTIONS: [f64; 3] = [0.0, 0.1, 0.3];
const ERRORS: [(&str, Option<Budget>); 2] = [("as is", Some(Budget::NONE)), ("with shared errors", None)];
/// Growth that fails.
const MOST: f64 = 1.05;
/// The argument by which this program runs a work, under valgrind, in place of counting.
const WORK: &str = "--work";

/// A work: its name, how often it is done few times and many times, and what does it so many times and returns the number of
/// its units.
struct Work {
    name: String,
    times: [usize; 2],
    run: Box<dyn Fn(usize) -> usize>,
}

impl Work {
    fn new(name: impl Into<String>, times: [usize; 2], run: impl Fn(usize) -> usize + 'static) -> Self {
        Self { name: name.into(), times, run: Box::new(run) }
    }
}

/// Segments of a rod of any model: those of the uniform rod with a twentieth of force and moment, for the softer end, from the tip back.
fn along(rod: impl RodModel + 'static) -> impl Fn(usize) -> usize {
    move |times| {
        let segments = segments();
        for measure::Segment { start, a, b, s } in segments.iter().cycle().take(times * 1024) {
            let start = Cut { x: start.x, y: start.y, phi: start.phi, moment: 0.05 * start.kappa };
            black_box(rod.carry_with_sensitivities(1.0, black_box(&start), 0.05 * a, 0.05 * b, -*s));
        }
        times * 1024
    }
}

/// The name of a reconstruction.
fn reconstruction(errors: &str, mu: f64) -> String {
    let friction = if mu > 0.0 { format!(", friction of {mu} asked for") } else { String::new() };
    format!("reconstruction of a scan {errors}{friction}")
}

/// A scan of O1 at q = 0.4 with friction, 8501 samples with the noise of an industrial sensor, reconstructed as often.
fn reconstructed(budget: Option<Budget>, mu: f64) -> impl Fn(usize) -> usize {
    move |times| {
        let (contour, path) = (OBJECTS[0].contour(), path(0.4, 0.8, -0.9));
        let step = path.length() / 8500.0;
        let states = Sweep::new(&rod(), &contour, path, step).unwrap().with_friction(mu).unwrap().run().states;
        // 2.5 mN and 0.06 mN m in units of the paper's wire
        let sigma = Reactions { f0x: 0.0396, f0y: 0.0396, m0z: 0.0095 };
        let ar1 = Ar1 { sigma, correlation: 0.45 };
        let mut sensor = NoiseModel { ar1, ..NoiseModel::default() }.generator(1).unwrap();
        let samples: Vec<Sample> =
            states.iter().filter_map(|state| Some(Sample::new(state.pose, sensor.sample(state.reactions)?))).collect();
        let friction = if mu > 0.0 { Friction::Estimate } else { Friction::None };
        let settings = Settings { budget, friction, ..Settings::default() };
        for _ in 0..times {
            black_box(reconstruct(&rod(), black_box(&samples), &settings).unwrap());
        }
        times
    }
}

fn works() -> Vec<Work> {
    let repeated = |once: fn(&[measure::Segment]) -> usize| {
        move |times: usize| {
            let segments = segments();
            (0..times).map(|_| once(&segments)).sum()
        }
    };
    let mut works = vec![
        Work::new(SEGMENT, [1, 5], repeated(kernel)),
        Work::new(
            DERIVATIVES,
            [1, 5],
            repeated(|segments| {
                for measure::Segment { start, a, b, s } in segments {
                    black_box(advance_with_sensitivities(black_box(start), *a, *b, *s));
                }
                segments.len()
            }),
        ),
        Work::new(
            "segment in f32",
            [1, 5],
            repeated(|segments| {
                for measure::Segment { start, a, b, s } in segments {
                    let start = vibrissa::rod::Section {
                        x: start.x as f32,
                        y: start.y as f32,
                        phi: start.phi as f32,
                        kappa: start.kappa as f32,
                    };
                    black_box(advance(black_box(&start), *a as f32, *b as f32, *s as f32));
                }
                segments.len()
            }),
        ),
        Work::new(
            "step of a walk along a segment",
            [1, 3],
            repeated(|segments| {
                for measure::Segment { start, a, b, s } in &segments[..256] {
                    walk(black_box(start), *a, *b, *s, 100).for_each(|section| {
                        black_box(section);
                    });
                }
                256 * 100
            }),
        ),
    ];
    let halves =
        [1.0, 0.25].map(|bending_stiffness| RodSection { length: 0.5, bending_stiffness, natural_curvature: 0.0 });
    let cone = Smooth::new(Cone { taper: 0.5 }).unwrap();
    works.push(Work::new("segment of two sections with derivatives", [1, 5], along(Sections::new(&halves).unwrap())));
    works.push(Work::new("segment of a cone with derivatives", [1, 3], along(cone)));
    for (index, phase) in PHASES.iter().enumerate() {
        works.push(Work::new(format!("warm solve of {phase}"), [1, 9], move |times| {
            let (cases, mut u, mut workspace) = (&solves::warm()[index], Vec::new(), NewtonWorkspace::new());
            (0..times).map(|_| solves::solve_all(cases, &mut u, &mut workspace)).sum()
        }));
    }
    for phase in PHASES {
        works.push(Work::new(format!("equilibrium from the state before in {phase}"), [1, 3], move |times| {
            let contour = OBJECTS[0].contour();
            let states = sweep(&contour, path(0.4, 0.8, -0.9), 1701).states;
            let is_in_phase = |state: &State| state.phase().to_string() == phase;
            let pairs: Vec<_> = states.windows(2).filter(|pair| pair.iter().all(is_in_phase)).collect();
            for pair in pairs.iter().cycle().take(times * pairs.len()) {
                black_box(equilibrium(&rod(), &contour, pair[1].pose, black_box(&pair[0].contacts)).unwrap());
            }
            times * pairs.len()
        }));
    }
    for phase in PHASES {
        works.push(Work::new(format!("stiffness of the clamp in {phase}"), [1, 9], move |times| {
            let contour = OBJECTS[0].contour();
            let states = sweep(&contour, path(0.4, 0.8, -0.9), 1701).states;
            let states: Vec<_> = states.iter().filter(|state| state.phase().to_string() == phase).collect();
            for state in states.iter().cycle().take(times * states.len()) {
                black_box(Derivatives::new(&rod(), &contour, black_box(state)).unwrap().stiffness().unwrap());
            }
            times * states.len()
        }));
    }
    for contacts in [1, 2, 3, 4, 8, 16] {
        works.push(Work::new(format!("warm solve between discs, contacts: {contacts}"), [100, 300], move |times| {
            Warm::new(contacts).solve(times, &mut Vec::new(), &mut NewtonWorkspace::new())
        }));
    }
    for (k, edges) in [1000, 2000].into_iter().enumerate() {
        works.push(Work::new(EDGES[k], [1, 3], move |times| {
            let objects = waves::objects(Kind::Edges, edges);
            (0..times).for_each(|_| _ = black_box(waves::sweep(black_box(&objects))));
            times
        }));
    }
    // each edge that the contact runs over is two events
    for (k, edges) in [500, 2000].into_iter().enumerate() {
        works.push(Work::new(SWEPT_OVER[k], [1, 2], move |times| {
            let corner = |k: usize| {
                let (sin, cos) = (TAU * k as f64 / edges as f64).sin_cos();
                [0.3 * cos, 0.3 * sin]
            };
            let polygon = Composite::polygon(&(0..edges).map(corner).collect::<Vec<_>>()).unwrap();
            let pose = |x| Pose { x, y: -0.6, phi: FRAC_PI_2 };
            let rod = Rod::new(1.0, 1.0).unwrap();
            let run = || Sweep::new(&rod, &polygon, ClampPath::new(pose(0.5), pose(-0.6)).unwrap(), 1.0).unwrap().run();
            (0..times).map(|_| black_box(run()).events.len() / 2).sum()
        }));
    }
    // The poses of both are those of one scan; twice as many are twice as many reported states, and the same events.
    let scan = |states: usize| {
        move |times: usize| {
            let contour = OBJECTS[0].contour();
            (0..times).for_each(|_| {
                black_box(sweep(black_box(&contour), path(0.4, 0.8, -0.9), states));
            });
            times
        }
    };
    works.push(Work::new("scan of 7 events without states between", [1, 3], scan(2)));
    works.push(Work::new("scan of 7 events and 1000 states", [1, 2], scan(1000)));
    // what a program pays that learns only at run time which rod it is
    works.push(Work::new("scan of 7 events and 1000 states, as a rod of any kind", [1, 2], |times| {
        for _ in 0..times {
            let contour = OBJECTS[0].contour();
            let path = path(0.4, 0.8, -0.9);
            let step = path.length() / 999.0;
            black_box(Sweep::new(&AnyRod::from(rod()), black_box(&contour), path, step).unwrap().run());
        }
        times
    }));
    // from where all these rods are free
    let of_rod = |rod: VaryingRod| {
        move |times: usize| {
            let (contour, path) = (OBJECTS[0].contour(), path(0.4, 0.9, -0.9));
            let step = path.length() / 999.0;
            for _ in 0..times {
                let outcome = Sweep::new(&rod, black_box(&contour), path, step).unwrap().run();
                assert!(black_box(outcome).stop.is_none());
            }
            times
        }
    };
    let bent = rod().with_natural_curvature(0.5).unwrap();
    works.push(Work::new("scan of 1000 states with a rod that is bent at rest", [1, 2], of_rod(bent)));
    let diameter = 0.01_f64;
    let cone = Rod::tapered(1.0, diameter, 0.5 * diameter, 64.0 / (PI * diameter.powi(4))).unwrap();
    works.push(Work::new("scan of 1000 states with a cone", [1, 2], of_rod(cone)));
    let rubbing = |states: usize| {
        move |times: usize| {
            let contour = OBJECTS[0].contour();
            let step = path(0.4, 0.8, -0.9).length() / (states - 1) as f64;
            for _ in 0..times {
                let sweep = Sweep::new(&rod(), black_box(&contour), path(0.4, 0.8, -0.9), step).unwrap();
                black_box(sweep.with_friction(0.1).unwrap().run());
            }
            times
        }
    };
    works.push(Work::new("scan of 7 events with friction, without states between", [1, 3], rubbing(2)));
    works.push(Work::new("scan of 7 events with friction and 1000 states", [1, 2], rubbing(1000)));
    works.push(Work::new("one contact from reactions, with its covariance", [1, 9], |times| {
        let states = sweep(&OBJECTS[0].contour(), path(0.4, 0.8, -0.9), 1701).states;
        let samples: Vec<_> = states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect();
        let (rod, covariance) = (rod(), Matrix3::from_diagonal_element(1e-6));
        for sample in samples.iter().cycle().take(times * samples.len()) {
            black_box(single(&rod, black_box(sample.pose), black_box(sample.reactions), &covariance).ok());
        }
        times * samples.len()
    }));
    for (errors, budget) in ERRORS {
        for mu in FRICTIONS {
            // long enough for what only the first one does to be nothing beside it
            works.push(Work::new(reconstruction(errors, mu), [0, 1], reconstructed(budget, mu)));
        }
    }
    works
}

/// Instructions of this program doing work number `index` so many times.
fn instructions(index: usize, times: usize) -> Result<(f64, usize), String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args([WORK, &index.to_string(), &times.to_string()])
        .output()
        .map_err(|error| format!("valgrind, expected to be installed: {error}"))?;
    let (said, found) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    let counted = said.lines().find_map(|line| line.split("Collected :").nth(1)).and_then(|n| n.trim().parse().ok());
    match (counted, found.trim().parse()) {
        (Some(counted), Ok(units)) => Ok((counted, units)),
        _ => Err(format!("valgrind counted nothing: {said}{found}")),
    }
}

/// Instructions a unit of work.
fn count(index: usize, [few, many]: [usize; 2]) -> Result<f64, String> {
    let ((least, units), (most, more)) = (instructions(index, few)?, instructions(index, many)?);
    Ok((most - least) / (more - units) as f64)
}

/// What counts depend on besides the sources.
fn circumstances() -> String {
    #[cfg(target_arch = "x86_64")]
    let fused = std::arch::is_x86_feature_detected!("fma") && std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    let fused = false;
    let (arch, os) = (std::env::consts::ARCH, std::env::consts::OS);
    format!("{}; {arch} {os}{}", measure::machine::compiler(), if fused { " with FMA and AVX2" } else { "" })
}

/// What is kept, if it was counted in these circumstances.
fn kept(circumstances: &str) -> Option<BTreeMap<String, f64>> {
    let text = std::fs::read_to_string(KEPT).ok()?;
    let mut lines = text.lines();
    if lines.next()?.strip_prefix("# ") != Some(circumstances) {
        return None;
    }
    let lines = lines.filter_map(|line| line.rsplit_once(','));
    Some(lines.filter_map(|(name, count)| Some((name.to_owned(), count.parse().ok()?))).collect())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    let works = works();
    if let Some(at) = arguments.iter().position(|argument| argument == WORK) {
        let [index, times] = [1, 2].map(|k| arguments[at + k].parse::<usize>().unwrap());
        println!("{}", (works[index].run)(times));
        return ExitCode::SUCCESS;
    }
    if !measure::is_timed() {
        return ExitCode::SUCCESS;
    }
    let keep = arguments.iter().any(|argument| argument == "--keep");
    let circumstances = circumstances();
    let kept = kept(&circumstances);
    let mut text = format!("# {circumstances}\nwork,instructions\n");
    let mut counts = BTreeMap::new();
    let mut grown = 0;
    let times: Vec<[usize; 2]> = works.iter().map(|work| work.times).collect();
    let counted: Vec<Result<f64, String>> =
        times.into_par_iter().enumerate().map(|(index, times)| count(index, times)).collect();
    println!("{:>12} {:>12} {:>8}", "instructions", "kept", "ratio");
    for (work, counted) in works.iter().zip(counted) {
        let count = match counted {
            Ok(count) => count,
            Err(what) => {
                println!("{}: {what}", work.name);
                return ExitCode::FAILURE;
            }
        };
        let before = kept.as_ref().map_or(f64::NAN, |kept| kept.get(&work.name).copied().unwrap_or(0.0));
        // a work that is not kept, where others are, has grown from nothing
        let ratio = count / before;
        let fails = ratio > MOST;
        grown += usize::from(fails);
        println!("{count:12.0} {before:12.0} {ratio:8.3} {}{}", work.name, if fails { "  GROWN" } else { "" });
        text += &format!("{},{count:.0}\n", work.name);
        counts.insert(work.name.clone(), count);
    }
    let over = |more: &str, fewer: &str| counts[more] / counts[fewer];
    println!(
        "{}",
        verdict(
            "twice as many edges that are not met, less than 1.05 times the work",
            over(EDGES[1], EDGES[0]),
            ..1.05
        )
    );
    println!(
        "{}",
        verdict(
            "an edge of four times as many that are swept over, less than 1.1 times the work",
            over(SWEPT_OVER[1], SWEPT_OVER[0]),
            ..1.1
        )
    );
    println!(
        "{}",
        verdict("derivatives of a segment, at most 4 times the segment", over(DERIVATIVES, SEGMENT), ..=4.0)
    );
    for (errors, _) in ERRORS {
        for mu in &FRICTIONS[1..] {
            let ratio = over(&reconstruction(errors, *mu), &reconstruction(errors, 0.0));
            println!("{}", verdict(&format!("{errors}, mu = {mu}, at most 1.3 times the frictionless"), ratio, ..=1.3));
        }
    }
    if keep {
        std::fs::write(KEPT, text).unwrap();
        println!("kept in {KEPT}");
        return ExitCode::SUCCESS;
    }
    if kept.is_none() {
        println!("nothing to compare with in {KEPT}, which holds for other circumstances than {circumstances}");
    }
    if grown > 0 {
        println!("{grown} of {} grew by more than 5 %: mend it, or keep it by `-- --keep` and say why", works.len());
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
