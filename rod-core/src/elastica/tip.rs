//! What is prescribed of a rod without contacts: dead loads, and at the tip each coordinate or the load that belongs to it.

use crate::clamp::Clamp;
use crate::physical::PhysicalRod;
use crate::pose::Pose;
use crate::units::Units;
use std::f64::consts::TAU;

/// Largest sum of all forces, E I / L^2. The shape depends on the moment at the clamp by up to e^sqrt(force): beyond this
/// value double precision does not resolve the moments that the search tries.
const MOST_FORCE: f64 = 1e3;
/// Largest moment at the tip, E I / L: more than 10 turns of a uniform rod.
const MOST_MOMENT: f64 = 1e2;
/// Largest angle between clamp and held tip, turns. More of them is an angle in degrees, most likely.
const MOST_TURNS: f64 = 4.0;
/// Distance of the held tip from the clamp, L, from which on it is near full extension, where the forces are large.
pub(super) const STRETCHED: f64 = 0.9;
/// Distance from the clamp of a held tip, L, from which on a rod would have to be straight: its tip force is not determined.
const STRAIGHT: f64 = 1.0 - 1e-9;

/// A dead load: a force of fixed magnitude and direction on a point of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeadLoad {
    /// Arc length from the clamp, m.
    pub s: f64,
    /// Force on the rod along x, N.
    pub fx: f64,
    /// Force on the rod along y, N.
    pub fy: f64,
}

/// One coordinate of the tip: it is held, or the load along it is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TipEnd {
    /// The coordinate has this value (m or rad); the reaction of the support is unknown.
    Held(f64),
    /// The load has this value (N or N m); the coordinate is unknown.
    Loaded(f64),
}

/// What is prescribed at the tip, coordinate by coordinate.
///
/// ```
/// use rod_core::{Pose, Tip, TipEnd};
/// let pinned = Tip::place(0.05, 0.02); // m; without a moment
/// // a column whose tip is guided along x, under an axial force of 3 N
/// let guided = Tip { x: TipEnd::Loaded(-3.0), y: TipEnd::Held(0.0), phi: TipEnd::Held(0.0) };
/// assert_eq!(pinned.phi, TipEnd::Loaded(0.0));
/// assert_eq!(Tip::pose(Pose { x: 0.05, y: 0.0, phi: 0.0 }).y, guided.y);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// x (m) or the force along x (N).
    pub x: TipEnd,
    /// y (m) or the force along y (N).
    pub y: TipEnd,
    /// Slope angle (rad) or moment (N m). The angle counts whole turns: phi and phi + 2 pi are different shapes.
    pub phi: TipEnd,
}

impl Tip {
    /// A tip without support and load.
    pub const FREE: Self = Self::loaded(0.0, 0.0, 0.0);

    /// A tip under a force (N) and a moment (N m).
    pub const fn loaded(fx: f64, fy: f64, moment: f64) -> Self {
        Self { x: TipEnd::Loaded(fx), y: TipEnd::Loaded(fy), phi: TipEnd::Loaded(moment) }
    }

    /// A tip that is pinned at a place (m) and free to turn.
    pub const fn place(x: f64, y: f64) -> Self {
        Self { x: TipEnd::Held(x), y: TipEnd::Held(y), phi: TipEnd::Loaded(0.0) }
    }

    /// A tip in a clamp of its own (m, rad).
    pub const fn pose(pose: Pose) -> Self {
        Self { x: TipEnd::Held(pose.x), y: TipEnd::Held(pose.y), phi: TipEnd::Held(pose.phi) }
    }

    /// x, y and phi.
    pub(super) fn ends(&self) -> [TipEnd; 3] {
        [self.x, self.y, self.phi]
    }
}

/// The argument of a search for equilibria that is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ElasticaArgument {
    /// The rod.
    Rod,
    /// The pose of the clamp.
    Pose,
    /// A dead load, by its number from 0.
    Load(usize),
    /// The loads as a whole.
    Loads,
    /// The tip.
    Tip,
}

/// Why there are no equilibria of a rod without contacts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ElasticaError {
    /// An argument is not what it should be.
    #[error("{message}")]
    Argument {
        /// Which.
        argument: ElasticaArgument,
        /// The quantity, its value, and what was expected.
        message: String,
    },
    /// No start of the search led to an equilibrium.
    #[error(
        "no equilibrium found with forces of the tip support up to {most} N ({dimensionless} E I / L^2) and the tip {distance:.3} L from the \
         clamp, expected {}",
        remedy(*.distance)
    )]
    NotFound {
        /// Largest force that the search tries, N.
        most: f64,
        /// The same, E I / L^2.
        dimensionless: f64,
        /// Distance of the held tip from the clamp, L.
        distance: f64,
    },
}

/// What may help where nothing is found.
fn remedy(distance: f64) -> &'static str {
    if distance > STRETCHED {
        "a tip further from full extension, or smaller loads"
    } else {
        "smaller loads, a tip with less held, or a rod whose stiffness varies less: equilibria of this one may need larger forces"
    }
}

fn wrong<T>(argument: ElasticaArgument, message: String) -> Result<T, ElasticaError> {
    Err(ElasticaError::Argument { argument, message })
}

fn finite(argument: ElasticaArgument, values: &[(&str, f64)]) -> Result<(), ElasticaError> {
    match values.iter().find(|(_, value)| !value.is_finite()) {
        Some((what, value)) => wrong(argument, format!("{what} is {value}, expected a finite number")),
        None => Ok(()),
    }
}

/// Refuses what cannot be computed.
pub(super) fn check(rod: &impl PhysicalRod, pose: Pose, loads: &[DeadLoad], tip: &Tip) -> Result<(), ElasticaError> {
    let units = rod.units();
    let clamp = rod.clamp(pose);
    if clamp.law().is_some() || clamp.roller().is_some() {
        let message = "the clamp of the rod has springs or a roller, expected a rod on a rigid clamp".to_owned();
        return wrong(ElasticaArgument::Rod, message);
    }
    finite(ElasticaArgument::Pose, &[("x", pose.x), ("y", pose.y), ("phi", pose.phi)])?;
    let mut force = 0.0;
    for (index, load) in loads.iter().enumerate() {
        let argument = ElasticaArgument::Load(index);
        finite(argument, &[("s", load.s), ("fx", load.fx), ("fy", load.fy)])?;
        if !(0.0..=units.length).contains(&load.s) {
            let message = format!("s is {:?} m, expected 0 to {:?} m, the length of the rod", load.s, units.length);
            return wrong(argument, message);
        }
        force += load.fx.hypot(load.fy);
    }
    check_tip(units, pose, tip)?;
    let [x, y] = [tip.x, tip.y].map(|end| if let TipEnd::Loaded(force) = end { force } else { 0.0 });
    let (total, most) = (force + x.hypot(y), MOST_FORCE * units.force);
    if total > most {
        let argument = if x.hypot(y) > most { ElasticaArgument::Tip } else { ElasticaArgument::Loads };
        let message =
            format!("the forces add up to {total:?} N, expected at most {most:?} N, which is {MOST_FORCE} E I / L^2");
        return wrong(argument, message);
    }
    Ok(())
}

fn check_tip(units: Units, pose: Pose, tip: &Tip) -> Result<(), ElasticaError> {
    let argument = ElasticaArgument::Tip;
    let held = |end: TipEnd| if let TipEnd::Held(value) = end { Some(value) } else { None };
    for (end, names) in tip.ends().iter().zip([("x", "fx"), ("y", "fy"), ("phi", "moment")]) {
        match *end {
            TipEnd::Held(value) => finite(argument, &[(names.0, value)])?,
            TipEnd::Loaded(value) => finite(argument, &[(names.1, value)])?,
        }
    }
    let (x, y) = (held(tip.x), held(tip.y));
    let away = x.map_or(0.0, |x| x - pose.x).hypot(y.map_or(0.0, |y| y - pose.y));
    if away > STRAIGHT * units.length {
        let place = match (x, y) {
            (Some(x), Some(y)) => format!("place is ({x:?}, {y:?}) m, {away:?} m from the clamp"),
            (Some(x), None) => format!("x is {x:?} m, {away:?} m from the clamp"),
            (_, y) => format!("y is {:?} m, {away:?} m from the clamp", y.unwrap_or(f64::NAN)),
        };
        let message = format!("{place}, expected less than {:?} m, the length of the rod", units.length);
        return wrong(argument, message);
    }
    if let Some(phi) = held(tip.phi).filter(|phi| (phi - pose.phi).abs() > MOST_TURNS * TAU) {
        let turns = (phi - pose.phi).abs() / TAU;
        let message = format!("phi is {phi:?} rad, {turns:.1} turns from the clamp, expected at most {MOST_TURNS}");
        return wrong(argument, message);
    }
    if let TipEnd::Loaded(moment) = tip.phi {
        let most = MOST_MOMENT * units.moment;
        if moment.abs() > most {
            let message =
                format!("moment is {moment:?} N m, expected at most {most:?} N m, which is {MOST_MOMENT} E I / L");
            return wrong(argument, message);
        }
    }
    Ok(())
}
