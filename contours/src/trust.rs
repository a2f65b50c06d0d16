//! Which shapes need not be tested before they are used.

/// What is known of a shape by how it was made. [`Contour::trust`](crate::Contour::trust) gives it.
#[derive(Clone, Copy, Debug)]
pub struct Trust {
    /// Its methods keep the contract.
    pub(crate) contract: bool,
    /// It does not cross itself.
    pub(crate) simple: bool,
}

impl Trust {
    /// Nothing is known: a shape from outside this crate.
    pub(crate) const NONE: Self = Self { contract: false, simple: false };
    /// Its methods are tested here, its data may let it cross itself.
    pub(crate) const TESTED: Self = Self { contract: true, simple: false };
    /// The same, and no data let it cross itself.
    pub(crate) const SIMPLE: Self = Self { contract: true, simple: true };
}

/// An argument that no other crate can name, so that no other crate can write the method that takes it.
#[derive(Clone, Copy, Debug)]
pub struct Seal(pub(crate) ());
