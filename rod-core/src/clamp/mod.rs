//! How the rod is held at its base: rigidly, on springs, on a pivot, or rigidly with a roller ahead.
//!
//! What the base does is linear in the reactions, so that a clamp is a few numbers ([`ClampLaw`]). Which clamp it is, is a type
//! parameter of [`MultiPoint`](crate::MultiPoint): the rigid one, a [`Pose`], costs nothing.

mod elastic;
mod roller;
mod springs;

pub use elastic::{Elastic, Pivot};
pub(crate) use roller::Passage;
pub use roller::{Roller, RollerHold};
pub use springs::ElasticClamp;

use crate::pose::{Pose, Reactions};

/// What holds the base of a rod, dimensionless (units of the rod).
///
/// A [`Pose`] holds it rigidly, [`Elastic`] on springs, [`Pivot`] free to turn. The *pose* is that of the support, which the stage
/// prescribes; the base of a rod on a clamp that gives way is elsewhere. The reactions (f0x, f0y, m0z) act **on the rod at its base**:
/// m0z has its origin there, not at the support. A sensor on the support feels the same force, and about its own origin r_s the
/// moment m0z + (r(0) - r_s) x (f0x, f0y).
pub trait Clamp {
    /// The support.
    fn pose(&self) -> Pose;

    /// How the clamp gives way; None where it is rigid.
    #[inline(always)]
    fn law(&self) -> Option<ClampLaw> {
        None
    }

    /// The roller through which the rod runs between this clamp and its first contact; None without one. A clamp that gives way has none.
    #[inline(always)]
    fn roller(&self) -> Option<Roller> {
        None
    }

    /// Where the base of the rod is under these reactions. Its slope angle is NaN on a pivot: the reactions do not determine it.
    #[inline(always)]
    fn base(&self, reactions: &Reactions) -> Pose {
        let Pose { x, y, phi } = self.pose();
        match self.law() {
            None => Pose { x, y, phi },
            Some(ClampLaw { compliance, torque }) => {
                let [by_x, by_y, by_phi] = product(&compliance, reactions);
                Pose { x: x - by_x, y: y - by_y, phi: if torque.is_some() { f64::NAN } else { phi - by_phi } }
            }
        }
    }

    /// The energy that the clamp stores under these reactions, E I / L: half of reactions times displacement.
    #[inline(always)]
    fn energy(&self, reactions: &Reactions) -> f64 {
        self.law().map_or(0.0, |law| stored(&law.compliance, reactions))
    }
}

/// The rigid clamp: the base of the rod is where the support is.
impl Clamp for Pose {
    #[inline(always)]
    fn pose(&self) -> Pose {
        *self
    }
}

impl<C: Clamp + ?Sized> Clamp for &C {
    #[inline(always)]
    fn pose(&self) -> Pose {
        (**self).pose()
    }
    #[inline(always)]
    fn law(&self) -> Option<ClampLaw> {
        (**self).law()
    }
    #[inline(always)]
    fn roller(&self) -> Option<Roller> {
        (**self).roller()
    }
}

/// How the base of a rod gives way under its reactions r = (f0x, f0y, m0z), dimensionless:
///
/// ```text
/// (x(0), y(0), phi(0)) = pose - compliance r,      or, with a torque, m0z = torque in place of the third
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClampLaw {
    /// Displacement (x, y, phi) per reaction (f0x, f0y, m0z), row by row, along the axes of the world: symmetric.
    pub compliance: [[f64; 3]; 3],
    /// The moment m0z, where that is given and the slope angle is not.
    pub torque: Option<f64>,
}

impl ClampLaw {
    /// What is left of the three equations for a base that is displaced from the support by (x, y, phi).
    pub(crate) fn residual(&self, displacement: [f64; 3], reactions: &Reactions) -> [f64; 3] {
        let mut left = self.rates(displacement, reactions);
        left[2] -= self.torque.unwrap_or(0.0);
        left
    }

    /// The rates of the equations where displacement and reactions have these rates.
    pub(crate) fn rates(&self, displacement: [f64; 3], reactions: &Reactions) -> [f64; 3] {
        let mut rates = displacement;
        let gives = product(&self.compliance, reactions);
        rates.iter_mut().zip(gives).for_each(|(rate, gives)| *rate += gives);
        if self.torque.is_some() {
            rates[2] = reactions.m0z;
        }
        rates
    }
}

/// Displacement under the reactions.
pub(crate) fn product(compliance: &[[f64; 3]; 3], &Reactions { f0x, f0y, m0z }: &Reactions) -> [f64; 3] {
    compliance.map(|[by_x, by_y, by_moment]| by_x * f0x + by_y * f0y + by_moment * m0z)
}

/// Half of displacement times reactions: what the springs store.
pub(crate) fn stored(compliance: &[[f64; 3]; 3], reactions: &Reactions) -> f64 {
    let [x, y, phi] = product(compliance, reactions);
    0.5 * (x * reactions.f0x + y * reactions.f0y + phi * reactions.m0z)
}
