//! Coefficients of friction of the objects.

use crate::error::ContactError;
use std::fmt;

/// Coulomb's law at a contact: a rod that sticks holds |f_t| up to `at_rest` f, one that slips is held back by `slipping` f, where f is the
/// normal force and f_t the tangential one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// Static coefficient, >= `slipping`.
    pub at_rest: f64,
    /// Kinetic coefficient, > 0, or 0 where the static one is: a rod that slips without friction would never come to rest.
    pub slipping: f64,
}

impl Coefficients {
    /// No friction.
    pub const NONE: Self = Self { at_rest: 0.0, slipping: 0.0 };

    /// One coefficient for both.
    pub const fn equal(coefficient: f64) -> Self {
        Self { at_rest: coefficient, slipping: coefficient }
    }

    /// Whether they are finite, and 0 < `slipping` <= `at_rest`, or both are 0.
    pub fn are_valid(&self) -> bool {
        let Self { at_rest, slipping } = *self;
        at_rest.is_finite() && (0.0 < slipping || at_rest == 0.0 && slipping == 0.0) && slipping <= at_rest
    }

    /// The same as an error of the coefficients of an object.
    pub(crate) fn check(&self, object: usize) -> Result<(), ContactError> {
        if self.are_valid() {
            return Ok(());
        }
        let Self { at_rest, slipping } = *self;
        let is_one = slipping.is_finite() && slipping >= 0.0;
        let (value, expected) = if !is_one {
            (slipping, "a finite kinetic coefficient >= 0".to_owned())
        } else if slipping == 0.0 && at_rest > 0.0 {
            (slipping, format!("a kinetic coefficient above 0 beside the static one, {at_rest}"))
        } else {
            (at_rest, format!("a finite static coefficient not below the kinetic one, {slipping}"))
        };
        Err(ContactError::Friction { object, value, expected })
    }
}

/// The friction between the rod and the objects, for [`Sweep::with_friction`](crate::Sweep::with_friction).
///
/// A number is one coefficient for all objects, a list one for each object (and none for those beyond its end). A closure is a law of its
/// own. [`Sweep::with_friction`](crate::Sweep::with_friction) asks it once for each piece and refuses coefficients that are not valid.
///
/// ```
/// use rod_contact::{Coefficients, Friction};
/// assert_eq!(0.3.coefficients(4, 1), Coefficients::equal(0.3));
/// assert_eq!(vec![0.0, 0.5].coefficients(1, 0), Coefficients::equal(0.5));
/// // steel, but for a greased piece of object 0
/// let greased = |object: usize, piece: usize| {
///     if (object, piece) == (0, 2) { Coefficients::NONE } else { Coefficients { at_rest: 0.6, slipping: 0.48 } }
/// };
/// assert_eq!(greased.coefficients(0, 2), Coefficients::NONE);
/// ```
pub trait Friction: Send + Sync {
    /// The coefficients of a piece of an object. A convex corner has those of the piece before it.
    fn coefficients(&self, object: usize, piece: usize) -> Coefficients;

    /// Whether the law is one for so many objects. By default any law is; a list is not where it is longer than that.
    ///
    /// # Errors
    /// [`ContactError::Friction`] with the first object that there is not.
    fn fits(&self, _objects: usize) -> Result<(), ContactError> {
        Ok(())
    }
}

impl Friction for f64 {
    fn coefficients(&self, _object: usize, _piece: usize) -> Coefficients {
        Coefficients::equal(*self)
    }
}

impl Friction for Vec<f64> {
    fn coefficients(&self, object: usize, _piece: usize) -> Coefficients {
        Coefficients::equal(self.get(object).copied().unwrap_or(0.0))
    }

    fn fits(&self, objects: usize) -> Result<(), ContactError> {
        self.get(objects).map_or(Ok(()), |value| {
            let expected = format!("no coefficient beyond those of the {objects} objects");
            Err(ContactError::Friction { object: objects, value: *value, expected })
        })
    }
}

impl<F: Fn(usize, usize) -> Coefficients + Send + Sync> Friction for F {
    fn coefficients(&self, object: usize, piece: usize) -> Coefficients {
        self(object, piece)
    }
}

impl fmt::Debug for dyn Friction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Friction")
    }
}
