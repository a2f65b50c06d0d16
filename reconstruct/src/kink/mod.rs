//! Kinks and jumps of the reactions along the path of the clamp, at which the contact phase changes.
//!
//! At every place and at many scales, a quadratic with a step and a hinge is fitted to the samples on either side. What it explains
//! beyond a quadratic is compared with the noise, with its own misfit, and with a quartic, which has as many parameters and
//! no corner. The scales are searched from the finest to the coarsest. A transition that is found is placed between the
//! samples by a fit with a free knot, and no later window reaches across it. On each scale the noise is that of about the times of
//! its windows: drift and low-pass filters leave more of it than neighbouring samples show.
//!
//! Results on the nine scans of Merker et al. (2020), which were used during development: 85,001 samples each, 20 noise draws a
//! scan, wire of 100 mm and 6.32e-4 N m^2, noise estimated from the data. "Found" are transitions (all but A -> B) within
//! 1 mm (`cargo test --release -p rod-reconstruct --test suite kinks_of_the_paper -- --ignored --nocapture`):
//!
//! | noise | found | false a scan | median error of position |
//! |---|---|---|---|
//! | none (one scan each) | 51 of 51 | 0 | 1e-6 mm |
//! | 0.2 mN / 0.02 mN m, white | 100 % | 0.16 | 0.0010 mm |
//! | the same, AR(1) of 0.45 | 100 % | 0.08 | 0.0014 mm |
//! | 2.5 mN / 0.06 mN m, white | 99.9 % | 0.09 | 0.0067 mm |
//! | the same, AR(1) of 0.45 | 99.1 % | 0.11 | 0.0097 mm |
//! | 10 mN / 0.5 mN m, white | 89.2 % | 0.08 | 0.024 mm |
//! | the same, AR(1) of 0.45 | 71.0 % | 0.08 | 0.022 mm |
//!
//! The median error of position is 1.0 to 1.3 of the stated standard deviation, where 0.67 would be expected: the curvature breaks
//! at a kink, too. Noise that changes along a recording (for example from errors of the pose, where slopes are large) causes
//! false alarms.

mod basis;
mod candidate;
mod filter;
mod find;
mod free_knot;
mod level;
mod scale;
mod search;
mod transition;

pub use filter::KinkFilter;
pub use find::find_kinks;
pub use scale::KinkOptions;
pub use transition::{Kink, KinkKind};
