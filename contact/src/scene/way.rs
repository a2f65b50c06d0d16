//! One leg of the clamp's path as the sweep follows it: dimensionless, with a parameter by which no pose moves much faster than
//! one length of the rod, or one radian, per unit.

use crate::error::ContactError;
use crate::path::{ClampPath, Path, PathPoint, check};
use rod_core::{Pose, Units};
use std::fmt;
use std::sync::Arc;

/// Places at which the speed of a bent path is sampled, and by how much it may be larger in between.
const SAMPLES: u32 = 256;
const MARGIN: f64 = 1.2;

/// Places at which the rates of a bent path are compared with differences of its poses, the step of these, relative to the length of the
/// path, and their accepted error, relative to the largest rate. A path may go to and fro a thousand times.
const COMPARED: u32 = 16;
const STEP: f64 = 1e-5;
const ERROR: f64 = 1e-3;

/// A leg.
#[derive(Clone, Debug)]
pub(crate) enum Way {
    /// With the path's own parameter, dimensionless.
    Straight(ClampPath),
    Bent(Bent),
}

/// A leg that is not straight.
#[derive(Clone)]
pub(crate) struct Bent {
    path: Arc<dyn Path>,
    /// Change of the path's parameter by the leg's.
    pace: f64,
    length: f64,
    /// Length of the rod, m.
    unit: f64,
}

impl fmt::Debug for Bent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pace, length, .. } = self;
        f.debug_struct("Bent").field("pace", pace).field("length", length).finish_non_exhaustive()
    }
}

impl Bent {
    fn new(path: Arc<dyn Path>, units: Units) -> Result<Self, ContactError> {
        let end = path.length();
        if !(end.is_finite() && end > 0.0) {
            return Err(ContactError::NotFinite { what: "length of the path", value: end });
        }
        let mut fastest: f64 = 0.0;
        for k in 0..=SAMPLES {
            let PathPoint { pose, rate } = path.point(end * f64::from(k) / f64::from(SAMPLES));
            check(pose, ["x of the path", "y of the path", "angle of the path"])?;
            let speed = rate.x.hypot(rate.y) / units.length + rate.phi.abs();
            if !speed.is_finite() {
                return Err(ContactError::NotFinite { what: "rate of the path", value: speed });
            }
            fastest = fastest.max(speed);
        }
        if fastest == 0.0 {
            return Err(ContactError::NoPath { pose: path.point(0.0).pose });
        }
        check_rates(&*path, end, fastest, units.length)?;
        Ok(Self { path, pace: 1.0 / fastest, length: end * fastest, unit: units.length })
    }

    /// Pose and rate; beyond the ends the path goes straight on.
    fn point(&self, tau: f64) -> PathPoint {
        let on = tau.clamp(0.0, self.length);
        let PathPoint { pose, rate } = self.path.point((on * self.pace).min(self.path.length()));
        let scale = |of: Pose, by: f64| Pose { x: of.x * by / self.unit, y: of.y * by / self.unit, phi: of.phi * by };
        let (mut pose, rate) = (scale(pose, 1.0), scale(rate, self.pace));
        let beyond = tau - on;
        if beyond != 0.0 {
            pose = Pose { x: pose.x + beyond * rate.x, y: pose.y + beyond * rate.y, phi: pose.phi + beyond * rate.phi };
        }
        PathPoint { pose, rate }
    }
}

/// A rate that is no derivative leads Newton's method astray, which would blame the equilibrium.
fn check_rates(path: &dyn Path, end: f64, fastest: f64, length: f64) -> Result<(), ContactError> {
    let h = STEP * end;
    for k in 0..COMPARED {
        let t = end * (f64::from(k) + 0.5) / f64::from(COMPARED);
        let [before, after] = [t - h, t + h].map(|t| path.point(t).pose);
        let rate = path.point(t).rate;
        let by_differences = |from: f64, to: f64| (to - from) / (2.0 * h);
        for (what, rate, difference, unit) in [
            ("x", rate.x, by_differences(before.x, after.x), length),
            ("y", rate.y, by_differences(before.y, after.y), length),
            ("angle", rate.phi, by_differences(before.phi, after.phi), 1.0),
        ] {
            // also where it is not a number
            let off = (rate - difference).abs();
            if off.is_nan() || off > ERROR * fastest * unit {
                return Err(ContactError::Rate { what, t, rate, difference });
            }
        }
    }
    Ok(())
}

impl Way {
    /// The legs of a path (SI units), in order.
    pub fn legs(path: &Arc<dyn Path>, units: Units) -> Result<Vec<Self>, ContactError> {
        if !path.legs().is_empty() {
            let legs: Result<Vec<_>, _> = path.legs().iter().map(|leg| Self::legs(leg, units)).collect();
            return Ok(legs?.concat());
        }
        Ok(vec![match path.straight() {
            Some(straight) => Self::Straight(straight.dimensionless(units)),
            None => Self::Bent(Bent::new(path.clone(), units)?),
        }])
    }

    /// Pose at `tau`.
    pub fn at(&self, tau: f64) -> Pose {
        match self {
            Self::Straight(path) => path.at(tau),
            Self::Bent(bent) => bent.point(tau).pose,
        }
    }

    /// Change of the pose by tau.
    pub fn rate(&self, tau: f64) -> Pose {
        match self {
            Self::Straight(path) => path.rate(),
            Self::Bent(bent) => bent.point(tau).rate,
        }
    }

    /// Fastest way of any point of a straight rod by tau.
    pub fn largest_speed(&self) -> f64 {
        match self {
            Self::Straight(path) => {
                let rate = path.rate();
                rate.x.hypot(rate.y) + rate.phi.abs()
            }
            Self::Bent(_) => MARGIN,
        }
    }

    /// tau at the end.
    pub fn length(&self) -> f64 {
        match self {
            Self::Straight(path) => path.length(),
            Self::Bent(bent) => bent.length,
        }
    }

    /// tau at a parameter of the path itself; `unit` is the length of the rod, m.
    pub fn tau(&self, parameter: f64, unit: f64) -> f64 {
        match self {
            Self::Straight(path) if path.turns_only() => parameter,
            Self::Straight(_) => parameter / unit,
            Self::Bent(bent) => parameter / bent.pace,
        }
    }

    /// The parameter of the path itself at tau.
    pub fn parameter(&self, tau: f64, unit: f64) -> f64 {
        match self {
            Self::Straight(path) if path.turns_only() => tau,
            Self::Straight(_) => tau * unit,
            Self::Bent(bent) => tau * bent.pace,
        }
    }

    /// Straight ways through the first pose at 0 that may bring the rod there from where it is free: its own, two that turn, and two sideways.
    pub fn to_its_start(&self) -> [ClampPath; 5] {
        let own = match self {
            Self::Straight(path) => *path,
            Self::Bent(bent) => {
                let PathPoint { pose, rate } = bent.point(0.0);
                let speed = rate.x.hypot(rate.y) + rate.phi.abs();
                let rate = Pose { x: rate.x / speed, y: rate.y / speed, phi: rate.phi / speed };
                // where it begins at rest its direction is not known
                if speed > 0.0 { ClampPath::along(pose, rate) } else { ClampPath::others_to(pose)[0] }
            }
        };
        let [turning, back, left, right] = ClampPath::others_to(own.from());
        [own, turning, back, left, right]
    }
}

impl From<ClampPath> for Way {
    fn from(path: ClampPath) -> Self {
        Self::Straight(path)
    }
}
