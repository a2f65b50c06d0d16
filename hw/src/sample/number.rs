//! The numbers that samples are of.

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign};
use num_traits::{One, Zero};
use rod_core::Scalar;

/// A number of the kernel that vectors and matrices of nalgebra can have: `f32`, `f64`.
pub trait Number: Scalar + nalgebra::Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign {}

impl<T: Scalar + nalgebra::Scalar + Zero + One + ClosedAddAssign + ClosedSubAssign + ClosedMulAssign> Number for T {}
