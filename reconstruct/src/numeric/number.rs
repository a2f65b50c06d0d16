//! The numbers a single contact is found in.

use core::fmt::Display;
use num_traits::NumAssign;
use num_traits::float::FloatCore;

/// What [`single`](crate::single) computes in: `f32`, `f64`, or a type of your own that can be both a [`rod_core::Scalar`] and
/// an entry of a matrix.
pub trait Number: rod_core::Scalar + FloatCore + NumAssign + nalgebra::Scalar + Display {}

impl<T: rod_core::Scalar + FloatCore + NumAssign + nalgebra::Scalar + Display> Number for T {}
