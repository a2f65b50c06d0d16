//! Takes the counts of a sensor, one sample after the other, and says where the rod touches. Fails where that is not where the
//! contact was.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hprintln;
use microcontroller::{SCAN, Sensor, exit, rod};
use rod_reconstruct::single;

/// How far a point may be off, m: the counts are whole, hence the forces wrong by 60 nN and the moment by 3 nN m.
const OFF: f32 = 1e-6;

#[entry]
fn main() -> ! {
    exit(if scan() { EXIT_SUCCESS } else { EXIT_FAILURE })
}

fn scan() -> bool {
    let (Ok(rod), Ok(sensor), covariance) = (rod(), Sensor::new(), Sensor::covariance()) else {
        hprintln!("no rod or no sensor");
        return false;
    };
    let mut good = true;
    for (index, sample) in SCAN.iter().enumerate() {
        let pose = sample.pose();
        let felt = match sensor.reactions(1e-3 * index as f64, sample.counts, pose) {
            Ok(felt) => felt,
            Err(error) => {
                hprintln!("sample {}: {}", index, error);
                return false;
            }
        };
        let clamp = 1e3 * pose.x;
        match single(&rod, pose, felt, &covariance) {
            Ok(touch) => {
                let [x, y] = sample.contact;
                let off = (touch.x - x).abs().max((touch.y - y).abs());
                good &= off < OFF;
                let (mm, sigma) = ([touch.x, touch.y, touch.s].map(|v| 1e3 * v), 1e3 * touch.sigma_normal());
                hprintln!(
                    "clamp at {:5.1} mm: contact at ({:7.4}, {:7.4}) mm +- {:.4} mm, {:7.4} mm along the rod, {:6.1} mN",
                    clamp,
                    mm[0],
                    mm[1],
                    sigma,
                    mm[2],
                    1e3 * touch.force
                );
            }
            Err(none) => {
                good = false;
                hprintln!("clamp at {:5.1} mm: {}", clamp, none);
            }
        }
    }
    good
}
