//! The share of random guesses from which `equilibrium` comes to the state of the sweep at that pose: by Newton's method alone, and
//! with `argmin`'s trust region where that fails.
//!
//! `cargo bench --bench rough_guesses` prints a table; `-- --write FILE` writes the guesses, for benches/peers/guesses/run.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

#[path = "measure/mod.rs"]
mod measure;

use measure::objects::{COEFFICIENT, OBJECTS, Object, path, rod};
use measure::{Random, is_timed};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::io::Write;
use std::time::Instant;
use vibrissa::Sweep;
use vibrissa::contact::{Contact, ContactKind, Equilibrium, Inadmissible, State, equilibrium_with_search};

/// Guesses of each phase and spread.
const GUESSES: usize = 2000;
/// Distances of the clamp from the objects, and distances of the states.
const DISTANCES: [f64; 3] = [0.2, 0.4, 0.6];
const STEP: f64 = 2e-3;
const PHASES: [&str; 4] = ["A", "B", "BA", "BB"];
/// Largest difference from the state of the sweep in positions, arc lengths and forces (relative to 1 + force).
const SAME: f64 = 1e-9;
/// Iterations of the trust region: none, and its default.
const LIMITS: [(&str, u64); 2] = [("Newton", 0), ("Newton, trust region", 100)];

/// How far guesses are from the state, uniformly distributed.
#[derive(Clone, Copy)]
struct Spread {
    name: &'static str,
    /// Largest distance in x of a contact, which stays on its parabola.
    x: f64,
    /// Largest distance of an arc length; none: anywhere on the rod. In order along the rod.
    s: Option<f64>,
    /// Largest power of two by which a force is off; of 1 where arc lengths are anywhere.
    force: f64,
}

const SPREADS: [Spread; 3] = [
    Spread { name: "near", x: 0.05, s: Some(0.1), force: 1.0 },
    Spread { name: "rough", x: 0.1, s: Some(0.2), force: 2.0 },
    Spread { name: "random", x: 0.3, s: None, force: 4.0 },
];

/// What a guess comes to.
#[derive(Clone, Copy, Debug)]
enum End {
    Right,
    Admissible,
    Inadmissible,
    NotSolved,
}

/// A state of a sweep, with its object.
struct Known {
    object: Object,
    state: State,
}

/// The states of the nine scans, by phase.
fn known() -> BTreeMap<String, Vec<Known>> {
    let mut known = BTreeMap::<_, Vec<_>>::new();
    for object in OBJECTS {
        for q in DISTANCES {
            let outcome = Sweep::new(&rod(), &object.contour(), path(q, 0.8, -0.9), STEP).unwrap().run();
            for state in outcome.states {
                known.entry(state.phase().to_string()).or_default().push(Known { object, state });
            }
        }
    }
    known
}

impl Known {
    fn guess(&self, spread: Spread, random: &mut Random) -> Vec<Contact> {
        let mut guess = self.state.contacts.clone();
        for contact in &mut guess {
            let [xv, yv] = self.object.vertices[contact.piece];
            contact.x += random.within(spread.x);
            contact.y = yv + COEFFICIENT * (contact.x - xv).powi(2);
            let power = random.within(spread.force).exp2();
            (contact.s, contact.force) = match spread.s {
                Some(most) => ((contact.s + random.within(most)).clamp(0.01, 1.0), contact.force * power),
                None => (0.5 + random.within(0.5), power),
            };
        }
        let mut places: Vec<f64> = guess.iter().map(|contact| contact.s).collect();
        places.sort_by(f64::total_cmp);
        for (contact, s) in guess.iter_mut().zip(places) {
            contact.s = if contact.kind == ContactKind::Tip { 1.0 } else { s };
        }
        guess
    }

    fn end(&self, found: &Equilibrium) -> End {
        let same = |ours: &Contact, truth: &Contact| {
            let force = (ours.force - truth.force) / (1.0 + truth.force);
            [ours.x - truth.x, ours.y - truth.y, ours.s - truth.s, force].iter().all(|v| v.abs() <= SAME)
        };
        match found.is_admissible() {
            Err(Inadmissible::NotSolved(_)) => End::NotSolved,
            _ if found.state.contacts.iter().zip(&self.state.contacts).all(|(ours, truth)| same(ours, truth)) => {
                End::Right
            }
            Ok(()) => End::Admissible,
            Err(_) => End::Inadmissible,
        }
    }

    /// A line for other programs: the pose; of each contact its parabola's vertex, whether it is of the tip, and t, f, s of guess and
    /// state; the offset of the rod's slope angle at the contacts from the tangent angle.
    fn write(&self, to: &mut impl Write, head: &str, guess: &[Contact]) {
        let pose = self.state.pose;
        let mut line = format!("{head},{:e},{:e},{:e}", pose.x, pose.y, pose.phi);
        let shape = self.state.elastica(&rod()).unwrap();
        for (guess, truth) in guess.iter().zip(&self.state.contacts) {
            let [xv, yv] = self.object.vertices[guess.piece];
            let tip = u8::from(guess.kind == ContactKind::Tip);
            let slope = shape.at(truth.s).phi;
            let offset = PI * ((slope - truth.alpha) / PI).round();
            let numbers =
                [xv, yv, offset, guess.x - xv, guess.force, guess.s, truth.x - xv, truth.force, truth.s, slope];
            line += &format!(",{tip}");
            numbers.iter().for_each(|number| line += &format!(",{number:e}"));
        }
        writeln!(to, "{line}").unwrap();
    }
}

/// Calls `visit` with each guess, the same in every run.
fn for_guesses(mut visit: impl FnMut(Spread, &str, &Known, &[Contact])) {
    let (known, mut random) = (known(), Random(17));
    for spread in SPREADS {
        for phase in PHASES {
            let states = &known[phase];
            for k in 0..GUESSES {
                let known = &states[k * 7919 % states.len()];
                visit(spread, phase, known, &known.guess(spread, &mut random));
            }
        }
    }
}

fn write(file: &str) {
    let mut to = std::io::BufWriter::new(std::fs::File::create(file).unwrap());
    for_guesses(|spread, phase, known, guess| known.write(&mut to, &format!("{},{phase}", spread.name), guess));
    to.flush().unwrap();
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(k) = arguments.iter().position(|argument| argument == "--write") {
        return write(&arguments[k + 1]);
    }
    if !is_timed() {
        return;
    }
    let mut rows = BTreeMap::<_, ([usize; 4], f64)>::new();
    for_guesses(|spread, phase, known, guess| {
        let contour = known.object.contour();
        for (method, most) in LIMITS {
            let started = Instant::now();
            let found = equilibrium_with_search(&rod(), &contour, known.state.pose, guess, |search| {
                search.configure(|state| state.max_iters(most))
            });
            let row = rows.entry((spread.name, phase.to_owned(), method)).or_default();
            row.1 += started.elapsed().as_secs_f64() / GUESSES as f64;
            row.0[known.end(&found.unwrap()) as usize] += 1;
        }
    });
    println!("| guesses | phase | method | right | other, admissible | inadmissible | not solved | mean time |");
    println!("|---|---|---|---|---|---|---|---|");
    for spread in SPREADS {
        for phase in PHASES {
            for (method, _) in LIMITS {
                let (ends, seconds) = rows[&(spread.name, phase.to_owned(), method)];
                let shares = ends.map(|n| format!("{:.1} %", 100.0 * n as f64 / GUESSES as f64)).join(" | ");
                println!("| {} | {phase} | {method} | {shares} | {:.0} us |", spread.name, 1e6 * seconds);
            }
        }
    }
}
