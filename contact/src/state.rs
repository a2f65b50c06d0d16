//! One equilibrium of the rod, with its certificate.

use crate::phase::Phase;
use rod_core::{Elastica, Load, PhysicalRod, Pose, Reactions, RodError};

/// How a contact holds the rod.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum ContactKind {
    /// The rod lies tangentially on a smooth stretch of the contour.
    Tangent,
    /// The tip of the rod rests on the contour.
    Tip,
    /// The rod lies on a convex corner; the direction of the force is free inside the cone of the two normals.
    Corner,
    /// The tip rests in a concave corner, held by two forces, given as one.
    Notch,
}

/// A name in small letters, such as `tangent`.
impl std::fmt::Display for ContactKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Tangent => "tangent",
            Self::Tip => "tip",
            Self::Corner => "corner",
            Self::Notch => "notch",
        })
    }
}

/// One contact, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Contact {
    /// Number of the object, from 0.
    pub object: usize,
    /// Number of the object's piece, from 0 (for a corner or notch: the piece before it).
    pub piece: usize,
    /// How it holds.
    pub kind: ContactKind,
    /// Arc length along the rod, m.
    pub s: f64,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Tangent angle of the contour, radians: the force on the rod is force (sin alpha, -cos alpha).
    pub alpha: f64,
    /// Contact force, N, >= 0: the normal one where there is friction.
    pub force: f64,
    /// What friction does there; none where there is none.
    #[cfg_attr(feature = "serde", serde(flatten, default, skip_serializing_if = "Option::is_none"))]
    pub friction: Option<ContactFriction>,
}

/// How a rod moves along a contour with friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SlipMode {
    /// The rod slips in the sense of the contour.
    #[cfg_attr(feature = "serde", serde(rename = "slip+"))]
    Forward,
    /// The rod slips against the sense of the contour.
    #[cfg_attr(feature = "serde", serde(rename = "slip-"))]
    Backward,
    /// The tip sticks, or the side rolls.
    #[cfg_attr(feature = "serde", serde(rename = "stick"))]
    Stick,
}

/// Its name in files: `slip+`, `slip-` or `stick`.
impl std::fmt::Display for SlipMode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Forward => "slip+",
            Self::Backward => "slip-",
            Self::Stick => "stick",
        })
    }
}

/// Friction at a contact, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactFriction {
    /// How the rod moves there.
    pub mode: SlipMode,
    /// Force on the rod along the contour's direction, N: force (cos alpha, sin alpha).
    #[cfg_attr(feature = "serde", serde(rename = "friction"))]
    pub force: f64,
    /// Slip coordinate, m: arc length of the contour at the contact, from parameter 0 of the piece or from its start, plus the arc length
    /// from there to the rod's tip in the contour's sense. It grows as the rod slips forward, falls as it slips backward, and stays as it sticks. It means
    /// nothing but by its differences between states on one piece. 0 where contacts slide whatever their motion.
    pub slip: f64,
}

impl Contact {
    /// The whole force on the rod: with friction it is not across the contour.
    pub fn load(&self) -> Load {
        let friction = self.friction.map_or(0.0, |friction| friction.force);
        if friction == 0.0 {
            return Load { s: self.s, force: self.force, alpha: self.alpha };
        }
        Load { s: self.s, force: self.force.hypot(friction), alpha: self.alpha + friction.atan2(self.force) }
    }
}

/// Where the rod runs through the roller ahead of its clamp, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RollerContact {
    /// Arc length along the rod, m.
    pub s: f64,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Slope angle of the rod there, radians: the force on the rod is force (sin alpha, -cos alpha).
    pub alpha: f64,
    /// The reaction R of the roller, N, of either sign.
    pub force: f64,
}

/// Bounds of the smallest gap between the whole rod and all objects, m. About zero wherever there is a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GapBounds {
    /// The gap is nowhere smaller than this: a bound over all points of the rod, not over samples. Above -1e-9 L in every
    /// state at a pose that a sweep reports, and within 1e-3 of `seen` for a free rod. Minus infinity where nothing is proven:
    /// the rod is inside an object by more than 1e-12 L, as it may be in a state at an event, or the search was given up.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "unbounded::finite", deserialize_with = "unbounded::or_minus_infinity")
    )]
    pub lower: f64,
    /// The smallest gap that was computed; negative: penetration. Infinity where there is no object.
    #[cfg_attr(
        feature = "serde",
        serde(serialize_with = "unbounded::finite", deserialize_with = "unbounded::or_infinity")
    )]
    pub seen: f64,
    /// Whether `lower` is proven. It is not where the closest points of a shape are themselves looked for among samples
    /// ([`Contour::closest_is_exact`](rod_contours::Contour::closest_is_exact)): then it is as good as they are. Of a rod whose stiffness or natural
    /// curvature varies continuously, the proof takes the bounds of these profiles, computed from 8 nodes in each cell, for true.
    pub proven: bool,
}

/// How well a state fulfils what defines it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Certificate {
    /// Largest residual of the boundary-value problem, dimensionless.
    pub residual: f64,
    /// Bounds of the smallest gap over the whole rod, m.
    pub min_gap: GapBounds,
    /// Smallest contact force, N; none where there is no contact.
    pub min_force: Option<f64>,
    /// Largest change of the first integral kappa^2 / 2 - (A sin phi - B cos phi) along a segment plus its jump,
    /// dimensionless; none for a rod whose stiffness or natural curvature varies, along which it is not constant.
    pub first_integral: Option<f64>,
    /// Whether the equilibrium is stable: positive second variation of the energy under the contacts.
    pub stable: bool,
    /// Condition number (1-norm) of the Jacobian; 1 for a free rod.
    pub condition: f64,
    /// Newton iterations spent on this state.
    pub iterations: u32,
}

/// One equilibrium, SI units.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    /// The support of the clamp. On a clamp that gives way the base of the rod is elsewhere: [`PhysicalRod::base`].
    pub pose: Pose,
    /// Contacts from the clamp to the tip.
    pub contacts: Vec<Contact>,
    /// The leg of the path, from 0 ([`Chain`](crate::Chain)).
    #[cfg_attr(feature = "serde", serde(default))]
    pub leg: usize,
    /// What the clamp feels: forces on the rod at its base, and the moment about the base. What a roller feels is not in them.
    pub reactions: Reactions,
    /// The roller ahead of the clamp; none without one ([`Guided`](rod_core::Guided)).
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub roller: Option<Box<RollerContact>>,
    /// Bending energy, and that of a clamp that gives way, J.
    pub energy: f64,
    /// Largest bending stress at the surface, E d |kappa - kappa0| / 2, Pa; none where the diameter d of the rod, or of one of its sections, is
    /// not known ([`PhysicalRod::largest_stress`]).
    pub max_stress: Option<f64>,
    /// How well it holds.
    pub certificate: Certificate,
}

impl State {
    /// The phase: which contacts there are.
    pub fn phase(&self) -> Phase {
        let tip = self.contacts.last().is_some_and(|c| matches!(c.kind, ContactKind::Tip | ContactKind::Notch));
        Phase { contacts: self.contacts.len(), tip }
    }

    /// The shape of the rod in this state, SI units.
    ///
    /// # Errors
    /// [`RodError`] where the state's numbers are not those of a rod as long as `rod`.
    pub fn elastica<R: PhysicalRod>(&self, rod: &R) -> Result<Elastica<R::Model>, RodError> {
        let of_roller =
            self.roller.as_deref().map(|roller| Load { s: roller.s, force: roller.force, alpha: roller.alpha });
        let of_contacts = self.contacts.iter().map(Contact::load);
        let loads: Vec<_> = of_roller.into_iter().chain(of_contacts).collect();
        let base = rod.base(self.pose, &self.reactions);
        Elastica::of_rod(rod.model().clone(), rod.units(), base, self.reactions.m0z, &loads)
    }
}

/// Bounds that may be infinite, for formats such as JSON that have no infinity: it is written as none.
#[cfg(feature = "serde")]
mod unbounded {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn finite<S: Serializer>(bound: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        bound.is_finite().then_some(bound).serialize(serializer)
    }

    pub(super) fn or_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
    }

    pub(super) fn or_minus_infinity<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NEG_INFINITY))
    }
}
