//! What Newton's method solves.

use super::links::Links;

/// A square system of nonlinear equations F(u) = 0 with its exact Jacobian.
pub trait System {
    /// Number of equations and unknowns.
    fn dimension(&self) -> usize;

    /// Writes F(u) and, where asked for, its Jacobian (column-major: dF_i/du_j at `i + j * dimension`). Both come zeroed or
    /// with old content: every entry must be written.
    fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>);

    /// Whether the Jacobian is that of links in a row, which [`evaluate_links`](Self::evaluate_links) writes: then Newton's method costs as much
    /// as there are links, and asks for the whole matrix only where that is more exact. False by default.
    fn is_linked(&self) -> bool {
        false
    }

    /// Writes F(u), and adds the links of its Jacobian to `links`, which comes empty. Called where [`is_linked`](Self::is_linked) alone.
    fn evaluate_links(&self, _u: &[f64], _residual: &mut [f64], _links: &mut Links) {}

    /// Writes the weight of each unknown in the norm that judges corrections (1 / its natural size). All 1 by default.
    fn weights(&self, _u: &[f64], weights: &mut [f64]) {
        weights.fill(1.0);
    }
}

impl<S: System + ?Sized> System for &S {
    fn dimension(&self) -> usize {
        (**self).dimension()
    }

    fn evaluate(&self, u: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        (**self).evaluate(u, residual, jacobian);
    }

    fn is_linked(&self) -> bool {
        (**self).is_linked()
    }

    fn evaluate_links(&self, u: &[f64], residual: &mut [f64], links: &mut Links) {
        (**self).evaluate_links(u, residual, links);
    }

    fn weights(&self, u: &[f64], weights: &mut [f64]) {
        (**self).weights(u, weights);
    }
}
