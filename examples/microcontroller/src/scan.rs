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
    row(0.060, [83200, -25426, -145240], [0.0646042, 0.0598727]), // A
    row(0.051, [214587, -60418, -422017], [0.0643296, 0.0589262]), // A
    row(0.042, [409354, -126974, -745938], [0.0605422, 0.0466414]), // B
    row(0.033, [931707, -408231, -1342292], [0.0517828, 0.0237246]), // B
    row(0.024, [1645925, -1051413, -2147300], [0.0450892, 0.0113841]), // B
    row(0.015, [2102778, -1963986, -2925016], [0.0403710, 0.0053779]), // B
    row(0.006, [2018606, -2748184, -3450548], [0.0371169, 0.0025325]), // B
    row(-0.003, [1560480, -3132272, -3675512], [0.0348077, 0.0011557]), // B
    row(-0.012, [1015265, -3137832, -3672065], [0.0330916, 0.0004779]), // B
    row(-0.021, [548979, -2914231, -3533655], [0.0317585, 0.0001546]), // B
    row(-0.030, [206910, -2595219, -3330797], [0.0306843, 0.0000234]), // B
    row(-0.039, [-23074, -2261525, -3106463], [0.0297934, 0.0000021]), // B
    row(-0.061, [176288, -2557867, -3306370], [0.0005773, 0.0000167]), // B
    row(-0.070, [-42892, -2225509, -3081354], [-0.0002965, 0.0000044]), // B
    row(-0.079, [-261905, -1951605, -2825592], [-0.0014408, 0.0001038]), // A
];
