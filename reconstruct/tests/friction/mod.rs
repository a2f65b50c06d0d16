//! Rods that slide with Coulomb friction.

mod recording;
mod reference;
