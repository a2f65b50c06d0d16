//! The inversion and nothing else, to see its size: reactions from one place of the memory, the contact to another.
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m_rt::entry;
use microcontroller::{Sensor, exit};
use nalgebra::Matrix3;
use rod_core::{Pose, Reactions, Rod};
use rod_reconstruct::single;

#[entry]
fn main() -> ! {
    let Ok(rod) = Rod::new(0.1, 6.3e-4) else { exit(cortex_m_semihosting::debug::EXIT_FAILURE) };
    // what the compiler does not know it cannot leave out
    let (rod, covariance): (Rod<f32>, Matrix3<f32>) = black_box((rod.cast(), Sensor::covariance()));
    loop {
        let (pose, felt): (Pose<f32>, Reactions<f32>) =
            black_box((Pose { x: 0.0, y: 0.0, phi: 1.5 }, Reactions { f0x: -0.018, f0y: 0.007, m0z: 5e-4 }));
        black_box(single(&rod, pose, felt, &covariance).ok());
    }
}
