//! One segment: the closed form in both precisions, walked along, and integrated.

use crate::integrators::{Integrator, integrators};
use crate::measure::Random;
use crate::point::{Point, median_and_worst};
use crate::problem::Problem;
use std::hint::black_box;
use std::rc::Rc;
use vibrissa::rod::{Cut, Propagator, Section, advance, advance_with_sensitivities, walk};

pub const TASK: &str = "segment";
pub const KERNEL: &str = "closed form";
pub const DERIVATIVES: &str = "closed form with derivatives";
const SINGLE: &str = "closed form, f32";
pub const WALK: &str = "walk, a step";

/// What is timed are so many segments, each near one of the problems, so that no branch predictor learns them by heart; and
/// how near, in parts of each number.
const TIMED: usize = 4096;
const NEAR: f64 = 1e-3;
/// Of slow methods so many are enough.
const FEW: usize = 256;
/// Steps of a walk.
const STEPS: [usize; 3] = [10, 100, 1000];

#[derive(Clone, Copy)]
struct Segment {
    start: Section,
    a: f64,
    b: f64,
    length: f64,
}

impl Segment {
    fn of(problem: &Problem) -> Self {
        let force = problem.force.unwrap();
        Self { start: problem.section(), a: force.a, b: force.b, length: problem.length.unwrap() }
    }

    fn near(&self, random: &mut Random) -> Self {
        let mut near = |value: f64| value * (1.0 + random.within(NEAR));
        let Section { x, y, phi, kappa } = self.start;
        let start = Section { x, y, phi: near(phi), kappa: near(kappa) };
        Self { start, a: near(self.a), b: near(self.b), length: near(self.length) }
    }

    fn single(&self) -> (Section<f32>, [f32; 3]) {
        let Section { x, y, phi, kappa } = self.start;
        let start = Section { x: x as f32, y: y as f32, phi: phi as f32, kappa: kappa as f32 };
        (start, [self.a as f32, self.b as f32, self.length as f32])
    }
}

/// Largest error of the end of a segment.
fn error(problem: &Problem, end: &Section) -> f64 {
    let truth = problem.end.unwrap();
    let pairs = [(truth.x, end.x), (truth.y, end.y), (truth.phi, end.phi), (truth.kappa, end.kappa)];
    pairs.map(|(truth, value)| truth.error(value)).into_iter().fold(0.0, f64::max)
}

fn double(section: Section<f32>) -> Section {
    let Section { x, y, phi, kappa } = section;
    Section { x: x.into(), y: y.into(), phi: phi.into(), kappa: kappa.into() }
}

/// All methods on the segments of the reference set that are well enough conditioned.
pub fn points<'a>(problems: &[Problem]) -> Vec<Point<'a>> {
    let problems: Vec<&Problem> = problems.iter().filter(|p| p.kind == "segment" && p.is_moderate()).collect();
    let originals: Vec<Segment> = problems.iter().map(|problem| Segment::of(problem)).collect();
    let mut random = Random(1);
    let timed: Vec<Segment> = originals.iter().cycle().take(TIMED).map(|segment| segment.near(&mut random)).collect();
    let mut points = Vec::new();
    let mut add = |method, setting: &str, note: &str, end: &dyn Fn(&Segment) -> Section, work| {
        let errors = problems.iter().zip(&originals).map(|(problem, segment)| error(problem, &end(segment)));
        let errors = median_and_worst(errors.collect());
        points.push(Point { method, setting: setting.to_owned(), errors, note: note.to_owned(), work: Some(work) });
    };

    let kernel = |Segment { start, a, b, length }: &Segment| advance(black_box(start), *a, *b, *length);
    add(KERNEL, "f64", "", &kernel, each(&timed, kernel));
    let derived =
        |Segment { start, a, b, length }: &Segment| advance_with_sensitivities(black_box(start), *a, *b, *length);
    add(DERIVATIVES, "f64", "error of the end", &|segment| derived(segment).0, each(&timed, derived));
    let short = |(start, [a, b, length]): &(Section<f32>, [f32; 3])| advance(black_box(start), *a, *b, *length);
    let shortened: Vec<_> = timed.iter().map(Segment::single).collect();
    add(SINGLE, "f32", "inputs rounded to f32", &|segment| double(short(&segment.single())), each(&shortened, short));
    for steps in STEPS {
        let last = |Segment { start, a, b, length }: &Segment| walk(start, *a, *b, *length, steps).last().unwrap();
        let mut all = each(&timed[..FEW], move |Segment { start, a, b, length }| {
            walk(black_box(start), *a, *b, *length, steps).for_each(|section| {
                black_box(section);
            });
        });
        add(WALK, &steps.to_string(), "time of one of so many steps", &last, Box::new(move || all() * steps));
    }
    for Integrator { name, setting, rod, .. } in integrators(1) {
        let rod = Rc::new(rod);
        let end = |rod: &dyn Propagator, Segment { start, a, b, length }: &Segment| {
            let Section { x, y, phi, kappa } = *start;
            let end = rod.advance(0.0, black_box(&Cut { x, y, phi, moment: kappa }), *a, *b, *length).unwrap();
            Section { x: end.x, y: end.y, phi: end.phi, kappa: end.moment }
        };
        let timed_rod = rod.clone();
        let all = each(&timed[..FEW], move |segment| end(&**timed_rod, segment));
        add(name.of_segments(), &setting, "", &|segment| end(&**rod, segment), all);
    }
    points
}

/// The work of doing something with each of these.
fn each<'a, T: Clone + 'a, R>(items: &[T], act: impl Fn(&T) -> R + 'a) -> Box<dyn FnMut() -> usize + 'a> {
    let items = items.to_vec();
    Box::new(move || {
        for item in &items {
            black_box(act(item));
        }
        items.len()
    })
}
