//! The setup of a sweep: the rod, the objects and the path of the clamp, in lengths of the rod.

pub(crate) mod corner;
pub(crate) mod rod;
pub(crate) mod springs;
pub(crate) mod way;
pub(crate) mod world;

use crate::path::ClampPath;
use crate::scene::way::Way;
use crate::scene::world::World;
use rod_contours::Composite;
use rod_core::{MultiPoint, PhysicalRod, Rod, Supports};

/// A rod, the objects and the way of the clamp, dimensionless: from it and a contact set comes every boundary-value problem.
#[derive(Clone, Debug)]
pub(crate) struct Setup<'a, R = Rod> {
    pub rod: R,
    pub world: World<'a>,
    pub path: Way,
}

impl<'a, R: PhysicalRod> Setup<'a, R> {
    /// `path` is in the units of the rod and the objects.
    pub fn new(rod: &R, objects: &'a [Composite], path: ClampPath) -> Self {
        Self::on(rod, objects, path.dimensionless(rod.units()).into())
    }

    /// `path` is dimensionless, the objects are not.
    pub fn on(rod: &R, objects: &'a [Composite], path: Way) -> Self {
        Self { rod: rod.clone(), world: World::new(objects, rod.units().length), path }
    }

    /// The rod held by `supports`, with the support of its clamp at `tau` of the path.
    pub fn problem<'s, S: Supports>(&'s self, supports: &'s S, tau: f64) -> MultiPoint<'s, S, &'s R::Model, R::Clamp> {
        MultiPoint { rod: self.rod.model(), clamp: self.clamp(tau), supports }
    }

    /// The clamp of the rod, whose support is at `tau` of the path.
    #[inline(always)]
    pub fn clamp(&self, tau: f64) -> R::Clamp {
        self.rod.clamp(self.path.at(tau))
    }

    /// The same rod and objects on another way of the clamp, dimensionless.
    pub fn along(&self, path: ClampPath) -> Self {
        Self { path: path.into(), ..self.clone() }
    }

    /// The same without friction.
    pub fn without_friction(mut self) -> Self {
        self.world.polish();
        self
    }

    /// The same with all that is behind an open contour solid: for a rod that has not come there along the path.
    pub fn with_filled_objects(&self) -> Self {
        let mut filled = self.clone();
        filled.world.fill();
        filled
    }
}
