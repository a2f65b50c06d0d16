//! Rods that slide with Coulomb friction.

mod changing;
mod parabola;
mod recording;
mod reference;
