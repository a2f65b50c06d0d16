//! How well a solution explains the reactions.

use super::part::Part;
use super::system::{Solution, System};
use super::unknowns::Unknown;
use crate::point::Inverse;

/// Largest misfit that noise explains, as a normal deviate. Larger: contradictory conditions pass, such as those of a missed transition;
/// smaller: right solutions are rejected, one in 40 at 2.
pub(super) const BY_CHANCE: f64 = 2.0;

/// The sum of the weighted squares of a solution, without those that only ask for smoothness, and what noise makes of it on average.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misfit {
    pub squares: f64,
    pub freedom: f64,
}

impl Misfit {
    /// The reactions of a solution have as many degrees of freedom as they have coefficients, less those that the solution takes up: the
    /// trace of what it passes on of each coefficient's error.
    pub fn of<I: Inverse>(system: &System<'_, I>, solution: &Solution) -> Self {
        let free = |part: &Part| -> f64 {
            let weight = &part.series.normal;
            let taken = |unknown: Unknown| {
                let (from, n) = part.columns(unknown);
                // both are symmetric: the trace of their product
                solution.covariance.view((from, from), (n, n)).dot(weight) / part.series.variance[unknown as usize]
            };
            3.0 * part.series.terms() as f64 - Unknown::REACTIONS.into_iter().map(taken).sum::<f64>()
        };
        let squares = (solution.cost - system.roughness(&solution.x)).max(0.0);
        Self { squares, freedom: system.parts.iter().map(free).sum::<f64>().max(1.0) }
    }

    /// The squares as a deviate of the normal distribution (Wilson and Hilferty 1931).
    pub fn deviate(&self) -> f64 {
        let spread = 2.0 / (9.0 * self.freedom);
        ((self.squares / self.freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
    }

    /// Factor by which the variance of the noise is larger than it is taken to be; 1 where the misfit may be chance.
    pub fn excess(&self) -> f64 {
        if self.deviate() < BY_CHANCE { 1.0 } else { self.squares / self.freedom }
    }
}
