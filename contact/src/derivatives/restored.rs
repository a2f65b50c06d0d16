//! A state as the boundary-value problem that it solves.

use crate::contact_set::{ActiveContact, Configuration, tangent_hold};
use crate::derivatives::quantity::Quantity;
use crate::error::ContactError;
use crate::scene::rod::{Walk, at_clamp, push};
use crate::scene::world::World;
use crate::state::{ContactFriction, ContactKind, SlipMode, State};
use rod_contours::StretchKind;
use rod_core::{Clamp, ClampLaw, Hold, Linearisation, MultiPoint, PhysicalRod, Pose, Reactions, Units};

/// Largest residual (L, rad) of a state that counts as an equilibrium. States of a sweep are within 1e-9.
const LARGEST_RESIDUAL: f64 = 1e-8;

/// A state's contact set with its unknowns, and its equations to first order.
#[derive(Clone, Debug)]
pub(crate) struct Restored {
    pub configuration: Configuration,
    pub linear: Linearisation,
    /// The support of the clamp, dimensionless.
    pub clamp: Pose,
    /// How far it has given way, if it does.
    pub given: Option<Given>,
}

impl Restored {
    pub fn new<R: PhysicalRod>(rod: &R, world: &World<'_>, state: &State) -> Result<Self, ContactError> {
        let sticks = |friction: ContactFriction| friction.mode == SlipMode::Stick;
        if let Some(index) = state.contacts.iter().position(|contact| contact.friction.is_some_and(sticks)) {
            return Err(ContactError::Sticks { index });
        }
        let length = rod.units().length;
        let clamp = Pose { x: state.pose.x / length, y: state.pose.y / length, phi: state.pose.phi };
        if rod.clamp(clamp).roller().is_some() {
            return Err(ContactError::Roller);
        }
        let configuration = configuration(rod, world, state)?;
        let linear = {
            let supports = configuration.supports(world);
            let problem = MultiPoint { rod: rod.model(), clamp: rod.clamp(clamp), supports: &supports };
            problem.linearise(configuration.of_contacts())
        };
        let residual = linear.residual();
        if residual.is_nan() || residual > LARGEST_RESIDUAL {
            return Err(ContactError::NotEquilibrium { reason: "it does not solve their equations" });
        }
        let Units { force, moment, .. } = rod.units();
        let Reactions { f0x, f0y, m0z } = state.reactions;
        let reactions = Reactions { f0x: f0x / force, f0y: f0y / force, m0z: m0z / moment };
        let given = rod.clamp(clamp).law().map(|law| Given::new(law, reactions));
        Ok(Self { configuration, linear, clamp, given })
    }
}

/// The contact set of a state with its unknowns.
fn configuration<R: PhysicalRod>(rod: &R, world: &World<'_>, state: &State) -> Result<Configuration, ContactError> {
    let units = rod.units();
    let Reactions { f0x, f0y, m0z } = state.reactions;
    // the rod from its base on, for its slope angles at the contacts
    let Pose { x, y, phi } = rod.base(state.pose, &state.reactions);
    let base = at_clamp(Pose { x: x / units.length, y: y / units.length, phi }, m0z / units.moment);
    let mut rod = Walk::new(rod.model(), base, (f0y / units.force, -f0x / units.force));
    let mut configuration = Configuration::free(0.0);
    for (j, contact) in state.contacts.iter().enumerate() {
        let kind = match contact.kind {
            ContactKind::Tangent | ContactKind::Tip => StretchKind::Piece(contact.piece),
            ContactKind::Corner => StretchKind::Corner { before: contact.piece },
            ContactKind::Notch => StretchKind::Notch { before: contact.piece },
        };
        let stretch = world.find(contact.object, kind).ok_or(ContactError::Guess {
            index: j,
            reason: "there is no such object, or it has no such piece or joint",
        })?;
        let (s, force) = (contact.s / units.length, contact.force / units.force);
        let friction = contact.friction.map_or(0.0, |friction| friction.force / units.force);
        let phi = rod.to(s, push(force, friction, contact.alpha));
        let (x, y) = (contact.x / units.length, contact.y / units.length);
        let (t, alpha) = match contact.kind {
            // the point does not tell the angle
            ContactKind::Corner | ContactKind::Notch => {
                let start = world.support(stretch, 0.0);
                ((contact.alpha - start.alpha) / start.turning, contact.alpha)
            }
            _ => {
                let foot = world.foot(stretch, x, y);
                (foot.t, foot.alpha)
            }
        };
        let tip = matches!(contact.kind, ContactKind::Tip | ContactKind::Notch);
        let (hold, third) = if tip { (Hold::Tip, phi) } else { (tangent_hold(phi - alpha), s) };
        configuration.insert(j, ActiveContact::smooth(stretch, hold), [t, force, third]);
        configuration.rub(j, friction, false);
    }
    Ok(configuration)
}

/// A clamp on springs under its reactions, dimensionless.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    compliance: [[f64; 3]; 3],
    reactions: [f64; 3],
}

impl Given {
    pub fn new(law: ClampLaw, Reactions { f0x, f0y, m0z }: Reactions) -> Self {
        Self { compliance: law.compliance, reactions: [f0x, f0y, m0z] }
    }

    /// The change of compliance times reactions (x, y, phi; dimensionless) under the same dimensionless reactions, per SI unit of the
    /// quantity.
    pub fn rates(&self, units: &Units, quantity: Quantity<'_>) -> [f64; 3] {
        let Units { length, force, moment, .. } = *units;
        let spring = match quantity {
            // in units of force and moment, which are proportional to E I
            Quantity::Stiffness => return self.times(|_, _| 1.0 / (moment * length)),
            // of E I / L^3 along x and y, E I / L^2 across, E I / L
            Quantity::Length => {
                let powers = |i: usize, j: usize| 1.0 + f64::from(u8::from(i < 2)) + f64::from(u8::from(j < 2));
                return self.times(|i, j| -powers(i, j) / length);
            }
            Quantity::ClampStiffnessX => 0,
            Quantity::ClampStiffnessY => 1,
            Quantity::ClampStiffnessPhi => 2,
            _ => return [0.0; 3],
        };
        // dC = -C dK C: what gives way along the spring, and the unit of its stiffness
        let unit = if spring < 2 { force / length } else { moment };
        let given = self.times(|_, _| 1.0)[spring] / unit;
        self.compliance.map(|row| -row[spring] * given)
    }

    /// Compliance, entry by entry times a factor, times reactions.
    fn times(&self, factor: impl Fn(usize, usize) -> f64) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|j| self.compliance[i][j] * factor(i, j) * self.reactions[j]).sum())
    }
}
