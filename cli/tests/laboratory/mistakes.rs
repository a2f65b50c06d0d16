//! Mistakes of the operator, one row each. The command must refuse such a recording with status 2.

use super::recording::Recording;

/// A mistake: it has no level.
pub struct Mistake {
    pub name: &'static str,
    pub make: fn(&mut Recording),
}

const fn mistake(name: &'static str, make: fn(&mut Recording)) -> Mistake {
    Mistake { name, make }
}

fn readings(recording: &mut Recording, change: fn([f64; 3]) -> [f64; 3]) {
    recording.each(|row| change(row.felt));
}

fn poses(recording: &mut Recording, change: fn([f64; 3]) -> [f64; 3]) {
    recording.rows.iter_mut().for_each(|row| row.pose = change(row.pose));
}

pub const MISTAKES: &[Mistake] = &[
    mistake("-f0x", |r| readings(r, |[fx, fy, m]| [-fx, fy, m])),
    mistake("-f0y", |r| readings(r, |[fx, fy, m]| [fx, -fy, m])),
    mistake("-m0z", |r| readings(r, |[fx, fy, m]| [fx, fy, -m])),
    mistake("-f0x, -f0y, -m0z", |r| readings(r, |[fx, fy, m]| [-fx, -fy, -m])),
    mistake("-f0x, -m0z", |r| readings(r, |[fx, fy, m]| [-fx, fy, -m])),
    mistake("f0x and f0y swapped", |r| readings(r, |[fx, fy, m]| [fy, fx, m])),
    mistake("x0 in mm", |r| poses(r, |[x, y, phi]| [1e3 * x, y, phi])),
    mistake("phi0 in degrees", |r| poses(r, |[x, y, phi]| [x, y, phi.to_degrees()])),
    mistake("-x0", |r| poses(r, |[x, y, phi]| [-x, y, phi])),
    mistake("stiffness x 2", |r| r.stiffness *= 2.0),
    mistake("stiffness / 2", |r| r.stiffness /= 2.0),
];
