//! Weighted fits of m0z^2 over the load.

use super::bins::ReactionBin;
use crate::numeric::NormalEquations;
use nalgebra::{SMatrix, SVector, Vector1};

/// The functions of a bin whose linear combination is fitted to its m0z^2: the load first, then a constant.
pub(super) type Columns<'a, const N: usize> = &'a dyn Fn(&ReactionBin) -> [f64; N];

/// Coefficients of the functions, and their covariance.
pub(super) struct Fit<const N: usize> {
    pub at: SVector<f64, N>,
    covariance: SMatrix<f64, N, N>,
}

impl<const N: usize> Fit<N> {
    /// The weighted least-squares fit to the bins that are `on`, weighted for a line of this slope; none for too few bins. Where the
    /// scatter exceeds the noise, the covariance is that of the scatter. `floor` is the smallest standard deviation of a bin.
    pub fn of(bins: &[ReactionBin], on: &[bool], columns: Columns<'_, N>, slope: f64, floor: f64) -> Option<Self> {
        let used: Vec<&ReactionBin> = bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin).collect();
        if used.len() <= N {
            return None;
        }
        // columns of one size: squares of newtons and newton metres differ by many orders of magnitude
        let mut scale = [0.0_f64; N];
        for bin in &used {
            let row = columns(bin);
            (0..N).for_each(|c| scale[c] = scale[c].max(row[c].abs()));
        }
        let scale = scale.map(|largest| if largest > 0.0 { largest } else { 1.0 });
        let row = |bin: &ReactionBin| {
            let row = columns(bin);
            SVector::<f64, N>::from_fn(|c, _| row[c] / scale[c])
        };
        let mut equations = NormalEquations::<N, 1>::default();
        for bin in &used {
            let sigma = sigma(bin, slope).max(floor);
            equations.add(&row(bin), &Vector1::new(bin.square), sigma.powi(-2));
        }
        let normal = equations.factor()?;
        let at = normal.solve(&equations.right);
        let square = |bin: &&ReactionBin| ((row(bin).dot(&at) - bin.square) / sigma(bin, slope).max(floor)).powi(2);
        let rest = used.iter().map(square).sum::<f64>() / (used.len() - N) as f64;
        let covariance = normal.inverse() * rest.max(1.0);
        Some(Self {
            at: SVector::from_fn(|c, _| at[c] / scale[c]),
            covariance: SMatrix::from_fn(|a, b| covariance[(a, b)] / (scale[a] * scale[b])),
        })
    }

    /// Standard error of a coefficient.
    pub fn sigma(&self, column: usize) -> f64 {
        self.covariance[(column, column)].max(0.0).sqrt()
    }

    /// Scatter beyond the noise: root of the mean square.
    pub fn rest(&self, bins: &[ReactionBin], on: &[bool], columns: Columns<'_, N>) -> f64 {
        let used = || bins.iter().zip(on).filter(|(_, on)| **on).map(|(bin, _)| bin);
        let excess = |bin: &ReactionBin| self.off(bin, columns).powi(2) - sigma(bin, self.at[0]).powi(2);
        (used().map(excess).sum::<f64>() / used().count().max(1) as f64).max(0.0).sqrt()
    }

    /// Distance of a bin from the fit.
    pub fn off(&self, bin: &ReactionBin, columns: Columns<'_, N>) -> f64 {
        bin.square - columns(bin).iter().zip(&self.at).map(|(column, at)| column * at).sum::<f64>()
    }
}

/// The functions of a straight line.
pub(super) fn straight(bin: &ReactionBin) -> [f64; 2] {
    [bin.load, 1.0]
}

/// The functions of a straight line with an offset of the moment: m0z^2 grows by twice the offset times m0z.
pub(super) fn with_offset(bin: &ReactionBin) -> [f64; 3] {
    [bin.load, 1.0, bin.reactions.m0z]
}

/// Standard deviation of the distance from a line of this slope.
pub(super) fn sigma(bin: &ReactionBin, slope: f64) -> f64 {
    bin.sigma_square.hypot(slope * bin.sigma_load)
}
