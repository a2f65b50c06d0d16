//! One interval of a rod that is not uniform: collocation with and without derivatives, against Dop853 and Taylor series, in kernels
//! of the uniform rod.
//!
//! Random intervals of a cone with 1/5 of the diameter at its tip and of half a cone that is bent at rest, under forces up to 60 times
//! the stiffness at the soft end of the interval; whole rods from the tip back; rods of sections. Then whole scans with such rods.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench may, and it is there to be read")]

mod measure;

use measure::objects::{OBJECTS, path};
use measure::{Random, interleaved, is_timed, kernel, machine, segments, verdict};
use std::f64::consts::PI;
use std::hint::black_box;
use vibrissa::rod::{Bent, Cone, Cut, Method, Ode, Propagator, RodModel, RodSection, Sections, Smooth, VaryingRod};
use vibrissa::{Rod, Sweep};

/// Interleaved rounds, and intervals of each set.
const ROUNDS: usize = 30;
const INTERVALS: usize = 1024;
/// Tolerance of Dop853, relative and absolute.
const TOLERANCE: f64 = 1e-12;
/// Terms of the Taylor series, and what its last terms may contribute.
const TERMS: usize = 25;
const LAST: f64 = 1e-15;
/// What an interval with its derivatives may cost, in kernels, and by how much its value may differ from the Taylor series.
const MOST_KERNELS: f64 = 40.0;
const MOST_ERROR: f64 = 1e-12;
/// Where scans begin: the last of the rods touches the object at x0 = 0.88.
const FREE: f64 = 0.9;

/// E I = (1 - taper s)^4, kappa0 = bend[0] + bend[1] s.
#[derive(Clone, Copy)]
struct Law {
    taper: f64,
    bend: [f64; 2],
}

impl Law {
    fn stiffness(&self, s: f64) -> f64 {
        let square = (1.0 - self.taper * s) * (1.0 - self.taper * s);
        square * square
    }

    fn natural_curvature(&self, s: f64) -> f64 {
        self.bend[0] + self.bend[1] * s
    }

    fn curvature(&self, s: f64, moment: f64) -> f64 {
        moment / self.stiffness(s) + self.natural_curvature(s)
    }
}

/// Where a set of intervals is: anywhere between two arc lengths, or the whole rod from the tip back.
struct Set {
    name: &'static str,
    law: Law,
    between: Option<[f64; 2]>,
    strength: f64,
}

const CONE: Law = Law { taper: 0.8, bend: [0.0; 2] };
const SETS: [Set; 4] = [
    Set { name: "cone to 1/5, inner half", law: CONE, between: Some([0.0, 0.5]), strength: 60.0 },
    Set { name: "cone to 1/5, outer half", law: CONE, between: Some([0.5, 1.0]), strength: 60.0 },
    Set {
        name: "cone to 1/2, kappa0 = 0.5 + s",
        law: Law { taper: 0.5, bend: [0.5, 1.0] },
        between: Some([0.0, 1.0]),
        strength: 60.0,
    },
    Set { name: "cone to 1/5, whole, from the tip", law: CONE, between: None, strength: 20.0 },
];

struct Interval {
    s: f64,
    start: Cut,
    a: f64,
    b: f64,
    length: f64,
}

impl Set {
    fn intervals(&self) -> Vec<Interval> {
        let mut random = Random(1);
        let interval = |_| {
            let mut place = |[from, to]: [f64; 2]| from + (to - from) * random.within(1.0).abs();
            let (s, to) = self.between.map_or((1.0, 0.0), |range| (place(range), place(range)));
            let soft = self.law.stiffness(s.max(to));
            let moment = if self.between.is_some() { random.within(6.0 * soft) } else { 0.0 };
            let start = Cut { x: 0.0, y: 0.0, phi: random.within(PI), moment };
            let strength = self.strength * soft;
            Interval { s, start, a: random.within(strength), b: random.within(strength), length: to - s }
        };
        (0..INTERVALS).map(interval).collect()
    }
}

/// The end of an interval by Taylor series with steps by their last two terms (Jorba and Zou 2005).
fn by_taylor(law: &Law, &Interval { s, start, a, b, length }: &Interval) -> Cut {
    let (mut at, to, direction) = (s, s + length, length.signum());
    let (sin, cos) = start.phi.sin_cos();
    let mut state = [start.x, start.y, start.phi, start.moment, cos, sin];
    while at != to {
        let mut series = [[0.0; TERMS]; 6];
        (0..6).for_each(|i| series[i][0] = state[i]);
        let width = 1.0 - law.taper * at;
        let (ratio, mut compliance, mut kappa) = (law.taper / width, [0.0; TERMS], [0.0; TERMS]);
        compliance[0] = 1.0 / law.stiffness(at);
        for n in 0..TERMS - 1 {
            compliance[n + 1] = compliance[n] * ratio * ((n + 4) as f64) / ((n + 1) as f64);
            let product = |u: &[f64], v: &[f64]| (0..=n).map(|i| u[i] * v[n - i]).sum::<f64>();
            let natural = [law.natural_curvature(at), law.bend[1]].get(n).copied().unwrap_or(0.0);
            kappa[n] = product(&compliance, &series[3]) + natural;
            let [_, _, _, _, cos, sin] = &series;
            let rate = [cos[n], sin[n], kappa[n], a * cos[n] + b * sin[n], -product(sin, &kappa), product(cos, &kappa)];
            (0..6).for_each(|i| series[i][n + 1] = rate[i] / (n + 1) as f64);
        }
        let reach = |n: usize| {
            let size = (0..6).map(|i| series[i][n].abs()).fold(1e-300, f64::max);
            (LAST / size).powf(1.0 / n as f64)
        };
        let h = reach(TERMS - 1).min(reach(TERMS - 2));
        let is_last = h >= (to - at).abs();
        let h = if is_last { to - at } else { direction * h };
        state = series.map(|c| c.iter().rev().fold(0.0, |sum, term| sum * h + term));
        at = if is_last { to } else { at + h };
    }
    Cut { x: state[0], y: state[1], phi: state[2], moment: state[3] }
}

fn distance(u: &Cut, v: &Cut) -> f64 {
    [u.x - v.x, u.y - v.y, u.phi - v.phi, u.moment - v.moment].iter().fold(0.0, |most, d| d.abs().max(most))
}

/// Median and largest difference of many.
fn spread(mut differences: Vec<f64>) -> [f64; 2] {
    differences.sort_by(f64::total_cmp);
    [differences[differences.len() / 2], differences[differences.len() - 1]]
}

fn main() {
    let rounds = if is_timed() { ROUNDS } else { 1 };
    println!("{}", machine::line());
    println!("An interval, in kernels; least of {rounds} interleaved rounds; differences from the Taylor series");
    let segments = segments();
    let (mut dearest, mut worst): (f64, f64) = (0.0, 0.0);
    for set in &SETS {
        let (intervals, law) = (set.intervals(), set.law);
        let rod = Smooth::new(Bent::new(Cone { taper: law.taper }, move |s| law.natural_curvature(s))).unwrap();
        let ode = Ode::with_law(move |s, moment| law.curvature(s, moment), Method::Dop853, TOLERANCE).unwrap();
        let value = |i: &Interval| rod.carry(i.s, &i.start, i.a, i.b, i.length);
        let integrated = |i: &Interval| ode.advance(i.s, &i.start, i.a, i.b, i.length).unwrap();
        let exact: Vec<_> = intervals.iter().map(|interval| by_taylor(&law, interval)).collect();
        let errors = |end: &dyn Fn(&Interval) -> Cut| {
            spread(intervals.iter().zip(&exact).map(|(interval, exact)| distance(&end(interval), exact)).collect())
        };
        let over = |once: &dyn Fn(&Interval)| {
            intervals.iter().for_each(|interval| once(black_box(interval)));
            intervals.len()
        };
        let times = interleaved(
            rounds,
            [
                &mut || kernel(&segments),
                &mut || over(&|i| _ = black_box(value(i))),
                &mut || over(&|i| _ = black_box(rod.carry_with_sensitivities(i.s, &i.start, i.a, i.b, i.length))),
                &mut || over(&|i| _ = black_box(integrated(i))),
                &mut || over(&|i| _ = black_box(by_taylor(&law, i))),
            ],
        );
        let kernels = times.map(|time| time.least / times[0].least);
        let [ours, dop853] = [errors(&value), errors(&integrated)];
        println!("{}", set.name);
        println!("  collocation                    {:6.1}   median {:.0e}, worst {:.0e}", kernels[1], ours[0], ours[1]);
        println!("  collocation with derivatives   {:6.1}", kernels[2]);
        println!(
            "  Dop853 at {TOLERANCE:e}, values only  {:6.1}   median {:.0e}, worst {:.0e}",
            kernels[3], dop853[0], dop853[1]
        );
        println!("  Taylor, values only            {:6.1}", kernels[4]);
        dearest = dearest.max(kernels[2]);
        worst = worst.max(ours[1]);
    }
    for count in [1, 2, 8] {
        let section = |i: usize| RodSection {
            length: 1.0 / count as f64,
            bending_stiffness: 1.0 / (1 + i) as f64,
            natural_curvature: 0.1 * i as f64,
        };
        let rod = Sections::new(&(0..count).map(section).collect::<Vec<_>>()).unwrap();
        let intervals = SETS[3].intervals();
        let with_derivatives = || {
            for i in &intervals {
                black_box(rod.carry_with_sensitivities(i.s, black_box(&i.start), i.a, i.b, i.length));
            }
            intervals.len()
        };
        let [unit, time] = interleaved(rounds, [&mut || kernel(&segments), &mut || with_derivatives()]);
        println!("whole rod of sections: {count}, with derivatives {:6.1}", time.least / unit.least);
    }
    scans(rounds);
    if is_timed() {
        println!("{}", verdict("a smooth interval with derivatives, at most 40 kernels", dearest, ..=MOST_KERNELS));
        println!("{}", verdict("its worst error over 1e-12, at most 1", worst / MOST_ERROR, ..=1.0));
    }
}

/// Scans of O1 at q = 0.4 with 1000 states, in such scans with the uniform rod. They begin where all these rods are free: at x0 = 0.8 the rod
/// that is bent at rest is in contact, and such a start has to be sought.
fn scans(rounds: usize) {
    let object = &OBJECTS[0].contour();
    let uniform = Rod::new(1.0, 1.0).unwrap();
    let base = 0.01_f64;
    let cone = Rod::tapered(1.0, base, 0.5 * base, 64.0 / (PI * base.powi(4))).unwrap();
    let bent = uniform.with_natural_curvature(0.5).unwrap();
    let section = |bending_stiffness| RodSection { length: 0.5, bending_stiffness, natural_curvature: 0.0 };
    let two = Rod::sections(1.0, &[section(1.0), section(0.8)]).unwrap();
    let scan = |rod: &VaryingRod| {
        let path = path(0.4, FREE, -0.9);
        let outcome = Sweep::new(black_box(rod), object, path, path.length() / 999.0).unwrap().run();
        assert!(outcome.stop.is_none());
        1
    };
    let times = interleaved(
        rounds.min(10),
        [
            &mut || {
                black_box(measure::objects::sweep(object, path(0.4, FREE, -0.9), 1000));
                1
            },
            &mut || scan(&bent),
            &mut || scan(&two),
            &mut || scan(&cone),
        ],
    );
    let ratios = times.each_ref().map(|time| time.least / times[0].least);
    for (name, ratio) in ["uniform", "one section, bent at rest", "two sections", "cone"].into_iter().zip(ratios) {
        println!("scan of 1000 states, {name:26} {ratio:6.1}");
    }
    if is_timed() {
        println!("{}", verdict("a scan with one section over one with the uniform rod, at most 2", ratios[1], ..=2.0));
        println!("{}", verdict("with two sections, at most 3", ratios[2], ..=3.0));
        println!("{}", verdict("with a cone, at most 25", ratios[3], ..=25.0));
    }
}
