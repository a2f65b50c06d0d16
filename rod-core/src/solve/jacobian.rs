//! The Jacobian of a system at a point, ready to solve: that of links in a row, or any matrix with its inverse.

use super::linear::{invert, multiply, norm_1, weighted_condition};
use super::links::Links;
use super::system::System;

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
        (system.is_linked() && self.take_links(u.len(), |links| system.evaluate_links(u, residual, links)))
            || self.take_matrix(u.len(), |matrix| system.evaluate(u, residual, Some(matrix)))
    }

    /// Takes the links that `add` adds, of a Jacobian with `size` unknowns; false where their elimination loses too many digits: then
    /// [`take_matrix`](Self::take_matrix).
    #[inline(always)]
    pub fn take_links(&mut self, size: usize, add: impl FnOnce(&mut Links)) -> bool {
        self.size = size;
        self.links.clear();
        add(&mut self.links);
        self.is_linked = self.links.eliminate();
        self.is_linked
    }

    /// Takes the whole matrix with `size` unknowns, which `write` writes column by column; false where it has no inverse.
    #[inline(always)]
    pub fn take_matrix(&mut self, size: usize, write: impl FnOnce(&mut [f64])) -> bool {
        (self.size, self.is_linked) = (size, false);
        self.matrix.resize(size * size, 0.0);
        self.inverse.resize(size * size, 0.0);
        write(&mut self.matrix);
        invert(size, &self.matrix, &mut self.inverse)
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
            self.links.correction(residual, step);
        } else {
            multiply(&self.inverse, residual, -1.0, step);
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

    /// Condition number in the 1-norm.
    #[inline(always)]
    pub fn condition(&self) -> f64 {
        if self.is_linked {
            self.links.condition(|_| 1.0)
        } else if self.size == 0 {
            1.0
        } else {
            norm_1(self.size, &self.matrix) * norm_1(self.size, &self.inverse)
        }
    }

    /// The same with each unknown in units of 1 / its weight.
    pub fn weighted_condition(&self, weights: &[f64]) -> f64 {
        if self.is_linked {
            self.links.condition(|i| weights[i])
        } else {
            weighted_condition(&self.matrix, &self.inverse, weights)
        }
    }
}
