//! The Jacobian of a system at a point, ready to solve: that of links in a row, or any matrix with its inverse.

use super::linear::{condition, invert, multiply};
use super::links::Links;
use super::newton::System;

/// A regular Jacobian.
#[derive(Clone, Debug, Default)]
pub(crate) struct Jacobian {
    size: usize,
    /// Whether `links` hold it; otherwise the matrix does.
    is_linked: bool,
    links: Links,
    matrix: Vec<f64>,
    inverse: Vec<f64>,
}

impl Jacobian {
    /// Takes the Jacobian of `system` at `u`, and writes the residual there; false where the Jacobian has no inverse.
    #[inline(always)]
    pub fn take(&mut self, system: &impl System, u: &[f64], residual: &mut [f64]) -> bool {
        let is_linked = system.evaluate_links(u, residual, self.links_of(u.len()));
        (is_linked && self.eliminate()) || self.take_matrix(|_, matrix| system.evaluate(u, residual, Some(matrix)))
    }

    /// The links of a Jacobian with `size` unknowns, to be added; then [`eliminate`](Self::eliminate).
    #[inline(always)]
    pub fn links_of(&mut self, size: usize) -> &mut Links {
        self.size = size;
        self.links.clear();
        &mut self.links
    }

    /// Gets ready to solve by the links that were added; false where they do not give all digits: then
    /// [`take_matrix`](Self::take_matrix).
    #[inline(always)]
    pub fn eliminate(&mut self) -> bool {
        self.is_linked = self.links.eliminate();
        self.is_linked
    }

    /// Takes the whole matrix, which `write` writes column by column; false where it has no inverse.
    #[inline(never)]
    pub fn take_matrix(&mut self, write: impl FnOnce(&Links, &mut [f64])) -> bool {
        let Self { size, is_linked, links, matrix, inverse } = self;
        *is_linked = false;
        matrix.resize(*size * *size, 0.0);
        inverse.resize(*size * *size, 0.0);
        write(links, matrix);
        invert(*size, matrix, inverse)
    }

    /// Writes it into the leading block of a column-major matrix with `stride` rows.
    pub fn write(&self, matrix: &mut [f64], stride: usize) {
        if self.is_linked {
            return Links::write(self.links.links(), matrix, stride);
        }
        for (to, column) in matrix.chunks_exact_mut(stride).zip(self.matrix.chunks_exact(self.size.max(1))) {
            to[..self.size].copy_from_slice(column);
        }
    }

    /// Writes the Newton correction for this residual: minus the inverse times the residual.
    #[inline(always)]
    pub fn correction(&self, residual: &[f64], step: &mut [f64]) {
        if self.is_linked {
            step.iter_mut().zip(residual).for_each(|(step, left)| *step = -left);
            self.links.solve(step.as_chunks_mut::<1>().0, usize::MAX);
        } else {
            multiply(&self.inverse, residual, -1.0, step);
        }
    }

    /// The same to all digits, where no later correction restores them.
    pub fn refined_correction(&self, residual: &[f64], step: &mut [f64]) {
        self.correction(residual, step);
        if self.is_linked {
            self.links.refine(residual, step);
        }
    }

    /// Writes the last column of the inverse.
    pub fn last_column(&self, column: &mut [f64]) {
        let Some(last) = self.size.checked_sub(1) else { return };
        if self.is_linked {
            self.links.last_column(column);
        } else {
            column.copy_from_slice(&self.inverse[self.size * last..][..self.size]);
        }
    }

    /// Condition number in the 1-norm, with each unknown in units of 1 / `weight`.
    #[inline(always)]
    pub fn condition(&self, weight: impl Fn(usize) -> f64) -> f64 {
        if self.is_linked {
            self.links.condition(weight)
        } else {
            condition(self.size, &self.matrix, &self.inverse, weight)
        }
    }
}
