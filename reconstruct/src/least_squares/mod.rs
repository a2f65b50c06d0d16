//! Nonlinear least squares: every nonlinear fit of this crate is a [`Problem`] that this module solves.
//!
//! A problem gives its Gauss-Newton equations at a point: residuals, each divided by its standard deviation, their derivatives, and a prior
//! as residuals of its own. Outliers count less by a [`Loss`]. [`iterate`] is the one loop; how far each step may go is a [`StepControl`]:
//! the whole step, the part of it that the natural monotonicity test admits, or a damped step. Weighted means and equations with one
//! solution (a root, a projection on one condition) are not made problems of this kind.

mod equations;
mod iterate;
mod problem;
mod step_control;

pub(crate) use equations::{Equations, NormalMatrix, Rows};
pub(crate) use iterate::{Status, iterate};
pub(crate) use problem::{Iterate, Loss, Problem};
pub(crate) use step_control::{Damped, Monotone, WholeSteps};
