//! Pseudo-arclength continuation (Keller 1977) of the equilibria with one contact set along the path of the clamp, up to the
//! transition at which the contact set changes.

mod between;
pub(crate) mod branch;
pub(crate) mod certify;
mod dip;
pub(crate) mod fold;
pub(crate) mod inflection;
mod joint;
pub(crate) mod recall;
pub(crate) mod step;
pub(crate) mod transition;
