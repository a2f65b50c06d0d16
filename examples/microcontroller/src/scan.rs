//! A recording: some samples of a scan with a single contact.

use rod_core::{Pose, Rod, RodError};

/// What was recorded at one place, and where the contact was.
pub struct Recorded {
    /// Abscissa of the clamp, m.
    pub clamp_x: f32,
    /// Counts of the three bridges.
    pub counts: [i32; 3],
    /// The contact, m.
    pub contact: [f32; 2],
}

impl Recorded {
    /// Where the clamp was.
    pub fn pose(&self) -> Pose<f32> {
        Pose { x: self.clamp_x, y: -0.04, phi: core::f32::consts::FRAC_PI_2 }
    }
}

/// The rod: 100 mm of spring steel wire, 0.5 mm thick.
///
/// # Errors
/// None: these are lengths of a rod.
pub fn rod() -> Result<Rod<f32>, RodError> {
    Ok(Rod::from_diameter(0.1, 0.5e-3, 206e9)?.cast())
}

const fn row(clamp_x: f32, counts: [i32; 3], contact: [f32; 2]) -> Recorded {
    Recorded { clamp_x, counts, contact }
}

/// Every ninth of the samples in phases A and B of `vibrissa sweep scenes/O1_q40.toml`, its reactions as the counts that
/// [`Sensor`](crate::Sensor) makes of them.
#[rustfmt::skip]
pub const SCAN: [Recorded; 15] = [
    row(0.060, [83200, -25426, -145240], [0.064604238, 0.059872665]), // A
    row(0.051, [214587, -60418, -422017], [0.064329628, 0.058926168]), // A
    row(0.042, [409354, -126974, -745938], [0.060542239, 0.046641419]), // B
    row(0.033, [931707, -408231, -1342292], [0.051782831, 0.023724586]), // B
    row(0.024, [1645925, -1051413, -2147300], [0.045089161, 0.011384138]), // B
    row(0.015, [2102778, -1963986, -2925016], [0.040371000, 0.005377882]), // B
    row(0.006, [2018606, -2748184, -3450548], [0.037116865, 0.002532488]), // B
    row(-0.003, [1560480, -3132272, -3675512], [0.034807722, 0.001155710]), // B
    row(-0.012, [1015265, -3137832, -3672065], [0.033091628, 0.000477908]), // B
    row(-0.021, [548979, -2914231, -3533655], [0.031758483, 0.000154613]), // B
    row(-0.030, [206910, -2595219, -3330797], [0.030684271, 0.000023411]), // B
    row(-0.039, [-23074, -2261525, -3106463], [0.029793406, 0.000002134]), // B
    row(-0.061, [176288, -2557867, -3306370], [0.000577296, 0.000016664]), // B
    row(-0.070, [-42892, -2225509, -3081354], [-0.000296537, 0.000004397]), // B
    row(-0.079, [-261905, -1951605, -2825592], [-0.001440827, 0.000103799]), // A
];
