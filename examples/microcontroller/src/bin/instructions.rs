//! Counts the instructions of each step, and the stack that the inversion takes.
//!
//! Under `qemu-system-arm -icount shift=0` an instruction takes a nanosecond of the board's time, and the system timer ticks
//! every 40: many repetitions make the count exact to a part of an instruction.
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m::Peripherals;
use cortex_m::asm::nop;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hprintln;
use microcontroller::{Recorded, SCAN, Sensor, exit, rod};
use nalgebra::Matrix3;
use rod_core::{Pose, Reactions, Rod, Scalar, Section, advance, advance_with_sensitivities, inflection, walk};
use rod_reconstruct::{Number, single};

/// Instructions to a tick of the timer: the board's clock is 25 MHz.
const TICK: u32 = 40;
const REPETITIONS: u32 = 200;
/// Steps of a walk.
const STEPS: usize = 20;
/// Bytes of stack that are looked at.
const PAINTED: u32 = 32 * 1024;
const PAINT: u32 = 0x5a5a_a5a5;

/// Counts instructions.
struct Counter {
    timer: SYST,
    /// Of a repetition of nothing.
    empty: f32,
}

impl Counter {
    fn new(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0xff_ffff);
        timer.clear_current();
        timer.enable_counter();
        let mut counter = Self { timer, empty: 0.0 };
        counter.empty = counter.of(&mut || {});
        counter
    }

    /// Instructions of one repetition. Not inlined: the compiler must not see that nothing is done.
    #[inline(never)]
    fn of(&mut self, work: &mut dyn FnMut()) -> f32 {
        self.timer.clear_current();
        let start = SYST::get_current();
        (0..REPETITIONS).for_each(|_| work());
        // it counts down
        let ticks = start.wrapping_sub(SYST::get_current()) & 0xff_ffff;
        (ticks * TICK) as f32 / REPETITIONS as f32 - self.empty
    }

    /// Prints mean and most over the samples.
    fn show<S>(&mut self, what: &str, samples: &[S], work: &mut dyn FnMut(&S)) {
        let (mut sum, mut most) = (0.0, 0.0_f32);
        for sample in samples {
            let count = self.of(&mut || work(black_box(sample)));
            sum += count;
            most = most.max(count);
        }
        hprintln!("  {:42} {:9.0} {:9.0}", what, sum / samples.len() as f32, most);
    }
}

/// The steps for one kind of number. What they need is made beforehand.
struct Steps<T: Number> {
    rod: Rod<T>,
    none: Matrix3<T>,
    covariance: Matrix3<T>,
}

/// A sample, and the same for a rod of length 1 and bending stiffness 1: section at the clamp, force, arc length of the contact.
#[derive(Clone, Copy)]
struct Scaled<T> {
    pose: Pose<T>,
    felt: Reactions<T>,
    clamp: Section<T>,
    force: [T; 2],
    length: T,
}

impl<T: Number> Steps<T> {
    fn scaled(&self, sensor: &Sensor, sample: &Recorded) -> Option<Scaled<T>> {
        let n = |v: f32| T::from_f64(f64::from(v));
        let pose = sample.pose();
        let felt = sensor.reactions(0.0, sample.counts, pose).ok()?;
        let (pose, units) = (Pose { x: n(pose.x), y: n(pose.y), phi: n(pose.phi) }, self.rod.units());
        let felt = Reactions { f0x: n(felt.f0x), f0y: n(felt.f0y), m0z: n(felt.m0z) };
        let clamp = Section { x: T::zero(), y: T::zero(), phi: pose.phi, kappa: -felt.m0z / units.moment };
        let touch = single(&self.rod, pose, felt, &self.covariance).ok()?;
        let force = [felt.f0y / units.force, -felt.f0x / units.force];
        Some(Scaled { pose, felt, clamp, force, length: touch.s / units.length })
    }

    fn show(&self, name: &str, counter: &mut Counter, scan: &[Scaled<T>; SCAN.len()]) {
        hprintln!("{}", name);
        let mut all = |what: &str, work: &mut dyn FnMut(&Scaled<T>)| counter.show(what, scan, work);
        all("sine and cosine", &mut |at| _ = black_box(Scalar::sin_cos(at.pose.phi)));
        all("square root", &mut |at| _ = black_box(Scalar::sqrt(at.length)));
        all("segment: advance", &mut |at| _ = black_box(advance(&at.clamp, at.force[0], at.force[1], at.length)));
        all("segment with derivatives", &mut |at| {
            black_box(advance_with_sensitivities(&at.clamp, at.force[0], at.force[1], at.length));
        });
        all("a walk of 20 steps, all of it", &mut |at| {
            walk(&at.clamp, at.force[0], at.force[1], at.length, STEPS).for_each(|section| _ = black_box(section));
        });
        all("inflection", &mut |at| _ = black_box(inflection(&at.clamp, at.force[0], at.force[1])));
        all("single, no covariance", &mut |at| _ = black_box(single(&self.rod, at.pose, at.felt, &self.none).ok()));
        all("single, with covariance", &mut |at| {
            black_box(single(&self.rod, at.pose, at.felt, &self.covariance).ok());
        });
        if let Some(sample) = scan.first() {
            let stack =
                stack(&mut || _ = black_box(single(&self.rod, sample.pose, sample.felt, &self.covariance).ok()));
            hprintln!("  {:42} {:9} bytes", "stack of single, with covariance", stack);
        }
    }
}

/// Bytes of stack that the work takes.
#[inline(never)]
fn stack(work: &mut dyn FnMut()) -> u32 {
    let top = cortex_m::register::msp::read() & !3;
    let bottom = top - PAINTED;
    // SAFETY: below the stack pointer nothing is in use, and no interrupt is enabled; the stack is 4 MiB.
    (bottom..top).step_by(4).for_each(|at| unsafe { core::ptr::write_volatile(at as *mut u32, PAINT) });
    work();
    // SAFETY: as above.
    let touched = (bottom..top).step_by(4).find(|&at| unsafe { core::ptr::read_volatile(at as *const u32) } != PAINT);
    top - touched.unwrap_or(top)
}

fn scan<T: Number>(steps: &Steps<T>, sensor: &Sensor) -> Option<[Scaled<T>; SCAN.len()]> {
    let mut all = [steps.scaled(sensor, &SCAN[0])?; SCAN.len()];
    for (at, sample) in all.iter_mut().zip(&SCAN) {
        *at = steps.scaled(sensor, sample)?;
    }
    Some(all)
}

fn measure() -> Option<()> {
    let mut counter = Counter::new(Peripherals::take()?.SYST);
    let (rod, sensor) = (rod().ok()?, Sensor::new().ok()?);
    let nops = counter.of(&mut || {
        nop();
        nop();
        nop();
        nop();
        nop();
    });
    hprintln!("five instructions that do nothing count {:.1}", nops);
    hprintln!("{:44} {:>9} {:>9}", "instructions", "mean", "most");
    counter.show("counts to reactions (rod-hw)", &SCAN, &mut |sample| {
        black_box(sensor.reactions(0.0, sample.counts, sample.pose()).ok());
    });
    let single = Steps { rod, none: Matrix3::zeros(), covariance: Sensor::covariance() };
    single.show("f32", &mut counter, &scan(&single, &sensor)?);
    let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9).ok()?;
    let double = Steps { rod, none: Matrix3::zeros(), covariance: Sensor::covariance().map(f64::from) };
    double.show("f64, in software", &mut counter, &scan(&double, &sensor)?);
    Some(())
}

#[entry]
fn main() -> ! {
    exit(if measure().is_some() { EXIT_SUCCESS } else { EXIT_FAILURE })
}
