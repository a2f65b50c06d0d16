//! Whether the contacts of a solution push, and from the side of the solid.

use super::beyond::Beyond;
use super::envelope::NormalSpeed;
use super::part::Part;
use super::system::Solution;
use super::unknowns::{Unknown, Unknowns};
use crate::point::{Clamp, Inverse};
use crate::scan::LocalEstimate;
use nalgebra::Vector3;

/// Instants of a stretch that are checked, and the largest t among them: at the ends of a series its rates are uncertain.
const INSTANTS: usize = 13;
const WITHIN: f64 = 0.95;
/// Share of the instants at which the signs must be right. Larger: noise at single instants rejects right solutions.
const MOSTLY: f64 = 0.75;
/// A force below this share of the reactions has no certain sign.
const SMALL: f64 = 0.05;
/// The second contact is beyond the tip if it is by more than this many of its standard deviations, and this length of rounding.
const BEYOND: f64 = 1.5;
const ROUNDING: f64 = 1e-6;
/// Error of the mean of (side of the first contact) times (slope of the normal speed) that is noise, dimensionless.
const SIDE: f64 = 0.1;
/// The same in standard deviations of the contact's speed.
const DOUBT: f64 = 2.0;

/// Whether the forces push, the second contact is on the rod and the first contact is on the side of the solid.
///
/// The side of a moving contact follows from the slope of the normal speed along the rod, which is the speed of the contact times
/// the difference of the curvatures of contour and rod.
pub(super) fn are_right<I: Inverse>(rod: &I, part: &Part, solution: &Solution) -> bool {
    let place = |k: usize| -WITHIN + 2.0 * WITHIN * k as f64 / (INSTANTS - 1) as f64;
    let (mut good, mut side, mut doubt) = (0, 0.0, 0.0);
    for k in 0..INSTANTS {
        let local = part.local(&solution.x, place(k));
        let Unknowns([f0x, f0y, m0z, s1, f1, s2]) = local.values;
        let clamp = |i: usize, v: &Unknowns| Clamp {
            pose: local.pose[i],
            reactions: Vector3::from(Unknown::REACTIONS.map(|unknown| v[unknown])),
            natural: if i == 0 { local.natural } else { 0.0 },
            friction: if i == 0 { local.friction } else { 0.0 },
        };
        let estimate = LocalEstimate::exact(clamp(0, &local.values), clamp(1, &local.rates));
        let speed = NormalSpeed::at(rod, &estimate, s1);
        let (_, gradient) = rod.gradient_at(&estimate.clamp, s1);
        let velocity = gradient.rate(&estimate.rate);
        let (sin, cos) = speed.section.phi.sin_cos();
        let along = cos * velocity[0] + sin * velocity[1] + local.rates[Unknown::S1];
        let small = SMALL * (f0x.hypot(f0y) + m0z.abs());
        if f1.abs() > small {
            side += f1.signum() * speed.by_s * along / INSTANTS as f64;
            doubt += speed.by_s.abs() * part.sigma_of_rate(&local, &solution.covariance) / INSTANTS as f64;
        }
        let beyond = Beyond::new(rod, &estimate.clamp, s1);
        let pushes = !part.tip || beyond.pushes(f1, small);
        if !part.tip {
            let covariance = part.covariance(&local, &solution.covariance);
            let sigma = covariance[(Unknown::S2 as usize, Unknown::S2 as usize)].max(0.0).sqrt();
            if s2 - 1.0 > BEYOND * sigma + ROUNDING {
                return false;
            }
        }
        good += usize::from(pushes && s1 > 0.0 && s1 < s2);
    }
    good as f64 >= MOSTLY * INSTANTS as f64 && side > -SIDE - DOUBT * doubt
}
