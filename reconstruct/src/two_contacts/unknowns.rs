//! The six unknowns of two contacts at one instant of a scan.

use std::ops::{Index, IndexMut};

/// An unknown of two contacts at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unknown {
    /// Reaction f0x of the clamp, EI/L^2.
    F0x,
    /// Reaction f0y of the clamp, EI/L^2.
    F0y,
    /// Reaction m0z of the clamp, EI/L.
    M0z,
    /// Arc length of the first contact, L.
    S1,
    /// Force of the first contact, EI/L^2: positive from a solid on the rod's left, negative from one on its right.
    F1,
    /// Arc length of the second contact, L; 1 where that is at the tip.
    S2,
}

/// Number of unknowns.
pub(super) const UNKNOWNS: usize = Unknown::ALL.len();

impl Unknown {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 6] = [Self::F0x, Self::F0y, Self::M0z, Self::S1, Self::F1, Self::S2];
    /// Those that are measured.
    pub const REACTIONS: [Self; 3] = [Self::F0x, Self::F0y, Self::M0z];
    /// Those that are not.
    pub const CONTACTS: [Self; 3] = [Self::S1, Self::F1, Self::S2];
}

/// A value for each unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unknowns<T = f64>(pub [T; UNKNOWNS]);

impl<T> Unknowns<T> {
    /// From a value for each.
    pub fn from_fn(value: impl Fn(Unknown) -> T) -> Self {
        Self(Unknown::ALL.map(value))
    }
}

impl Unknowns {
    /// The derivatives of a number that depends on none of them.
    pub const ZERO: Self = Self([0.0; UNKNOWNS]);

    /// The derivatives of one of them.
    pub fn unit(unknown: Unknown) -> Self {
        Self::from_fn(|other| f64::from(u8::from(other == unknown)))
    }
}

impl<T> Index<Unknown> for Unknowns<T> {
    type Output = T;

    fn index(&self, unknown: Unknown) -> &T {
        &self.0[unknown as usize]
    }
}

impl<T> IndexMut<Unknown> for Unknowns<T> {
    fn index_mut(&mut self, unknown: Unknown) -> &mut T {
        &mut self.0[unknown as usize]
    }
}

/// Derivatives of a number by the unknowns and by their rates along the scan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient {
    pub by_value: Unknowns,
    pub by_rate: Unknowns,
}

impl Gradient {
    /// Of a number that does not depend on rates.
    pub fn of_values(by_value: Unknowns) -> Self {
        Self { by_value, by_rate: Unknowns::ZERO }
    }
}
