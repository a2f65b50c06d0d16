//! Where a rod lands that has lost its equilibrium: the descent of its energy, and the equilibrium next to where that comes to
//! rest.

pub(crate) mod chain;
pub(crate) mod settle;
