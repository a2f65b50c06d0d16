//! What is swept.

use super::{LegPath, SceneFriction};
use vibrissa::contact::{Chain, ContactError};
use vibrissa::rod::AnyRod;
use vibrissa::{Composite, Sweep};

/// A rod, the objects and the way of the clamp: of a scene file, or made in Python.
#[derive(Clone, Debug)]
pub struct RodOnPath<'a> {
    /// The rod on its clamp.
    pub rod: &'a AnyRod,
    /// The objects, coordinates in m.
    pub objects: &'a [Composite],
    /// The legs of the path in order, at least one.
    pub legs: Vec<LegPath>,
    /// Friction between the rod and the objects; none where there is none.
    pub friction: Option<&'a SceneFriction>,
}

impl<'a> RodOnPath<'a> {
    /// Whether the clamp turns without moving on all legs.
    pub fn turns_only(&self) -> bool {
        self.legs.iter().all(LegPath::turns_only)
    }

    /// The sweep with states at these distances, one for each leg: m, or radians where the clamp only turns.
    ///
    /// # Errors
    /// As [`Sweep::with_steps`].
    pub fn sweep_by(&self, steps: &[f64]) -> Result<Sweep<'a, AnyRod>, ContactError> {
        let path = Chain::new(self.legs.iter().map(LegPath::path).collect())?;
        let sweep = Sweep::with_steps(self.rod, self.objects, path, steps)?;
        match self.friction {
            Some(friction) => sweep.with_friction(friction.clone()),
            None => Ok(sweep),
        }
    }
}
