//! The number types of a single contact.

use core::fmt::Display;
use num_traits::NumAssign;
use num_traits::float::FloatCore;

/// A number type that [`single`](crate::single) can compute in: `f32`, `f64`, or a type of your own that is a [`rod_core::Scalar`]
/// and can be an entry of a matrix.
pub trait Number: rod_core::Scalar + FloatCore + NumAssign + nalgebra::Scalar + Display {}

impl<T: rod_core::Scalar + FloatCore + NumAssign + nalgebra::Scalar + Display> Number for T {}
