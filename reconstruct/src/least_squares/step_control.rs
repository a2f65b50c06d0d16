//! How far a Gauss-Newton step may go.

use super::equations::{Equations, NormalMatrix};
use super::problem::{Iterate, Problem};
use nalgebra::DVector;

/// Relative decrease of the cost, predicted by a step, below which the iteration has settled.
const SETTLED_COST: f64 = 1e-6;

/// What decides on the steps of an iteration.
pub(crate) trait StepControl<P: Problem> {
    /// Sets out from a point whose equations are new. False where they give no step.
    fn set_out(&mut self, _from: &Iterate<P::Equations>) -> bool {
        true
    }

    /// One step; whether the iteration has settled. None where no step can be taken.
    fn advance(&mut self, problem: &mut P, at: &mut Iterate<P::Equations>) -> Option<bool>;
}

/// WholeSteps steps, for problems that are nearly linear. The equations that are left at the end are those that the last step came from.
pub(crate) struct WholeSteps {
    /// Largest change of an unknown in the last step.
    small: f64,
    is_stale: bool,
}

impl WholeSteps {
    /// Until no unknown changes by as much as `small`.
    pub fn until(small: f64) -> Self {
        Self { small, is_stale: false }
    }
}

impl<P: Problem> StepControl<P> for WholeSteps {
    fn advance(&mut self, problem: &mut P, at: &mut Iterate<P::Equations>) -> Option<bool> {
        if self.is_stale {
            at.equations = problem.equations(&at.x);
        }
        let step = at.equations.step()?;
        at.x += &step;
        self.is_stale = true;
        Some(step.amax() < self.small)
    }
}

/// Steps that the natural monotonicity test admits (Deuflhard 2004, section 4.4): it asks that the next step be shorter, not that the cost
/// fall, which along the narrow curved valley of stiff conditions allows tiny steps only.
pub(crate) struct Monotone {
    /// Sizes of the unknowns, in which the lengths of steps are measured.
    sizes: DVector<f64>,
    step: DVector<f64>,
    length: f64,
    /// Share of the step that is tried first.
    share: f64,
}

impl Monotone {
    /// Length of a step, relative to the sizes of the unknowns, below which the iteration has settled: rounding.
    const SETTLED: f64 = 1e-13;
    /// Smallest share of a step that is tried. Smaller: more time before a start that is too far away is given up.
    const LEAST_SHARE: f64 = 1e-3;

    pub fn with_sizes(sizes: DVector<f64>) -> Self {
        Self { step: DVector::zeros(sizes.len()), sizes, length: 0.0, share: 1.0 }
    }
}

impl<P: Problem<Equations = NormalMatrix>> StepControl<P> for Monotone {
    fn set_out(&mut self, from: &Iterate<NormalMatrix>) -> bool {
        let Some(step) = from.equations.step() else { return false };
        self.length = step.component_div(&self.sizes).norm();
        self.step = step;
        true
    }

    fn advance(&mut self, problem: &mut P, at: &mut Iterate<NormalMatrix>) -> Option<bool> {
        while self.share > Self::LEAST_SHARE {
            let there = &at.x + &self.step * self.share;
            let equations = problem.equations(&there);
            if let Some(ahead) = equations.step().filter(|_| equations.cost.is_finite()) {
                let length = ahead.component_div(&self.sizes).norm();
                if length <= (1.0 - 0.25 * self.share) * self.length || length < Self::SETTLED {
                    *at = Iterate { x: there, equations };
                    (self.step, self.length) = (ahead, length);
                    self.share = (2.0 * self.share).min(1.0);
                    let fall = at.equations.relative_fall(&self.step);
                    return Some(length < Self::SETTLED || fall < SETTLED_COST);
                }
            }
            self.share *= 0.5;
        }
        None
    }
}

/// Damped steps that let the cost fall (Levenberg-Marquardt), from starts that are too far away for others.
pub(crate) struct Damped {
    damping: f64,
    /// Relative decrease of the cost, predicted by a step, below which the step is not tried and the iteration has settled.
    settled: f64,
}

impl Damped {
    /// Factor on the damping after a step that was rejected; its inverse after one that was accepted.
    const FACTOR: f64 = 10.0;
    /// Smallest damping, and the smallest after a rejected step.
    const LEAST: (f64, f64) = (1e-14, 1e-4);
    /// Most attempts of a step.
    const ATTEMPTS: usize = 10;
    /// Relative increase of the cost that is rounding: near the solution of a noise-free scan the cost itself is.
    const COST_ROUNDING: f64 = 1e-9;
}

impl Default for Damped {
    /// Damping at first, relative to the diagonal of the equations.
    fn default() -> Self {
        Self { damping: 1e-3, settled: 0.0 }
    }
}

impl Damped {
    /// With next to no damping at first: from a place near the solution.
    pub fn lightly() -> Self {
        Self { damping: Self::LEAST.0, settled: 0.0 }
    }

    /// Until a step would let the cost fall by less than this share: for costs that are not smooth, along which short steps go on for ever.
    #[cfg(feature = "contact")]
    pub fn until(settled: f64) -> Self {
        Self { settled, ..Self::default() }
    }
}

impl<P: Problem<Equations = NormalMatrix>> StepControl<P> for Damped {
    fn advance(&mut self, problem: &mut P, at: &mut Iterate<NormalMatrix>) -> Option<bool> {
        if !at.equations.cost.is_finite() {
            return None;
        }
        for _ in 0..Self::ATTEMPTS {
            if let Some(step) = at.equations.damped_step(self.damping) {
                if at.equations.relative_fall(&step) < self.settled {
                    return Some(true);
                }
                let there = &at.x + &step;
                let equations = problem.equations(&there);
                if equations.cost <= at.equations.cost * (1.0 + Self::COST_ROUNDING) {
                    let fall = at.equations.relative_fall(&step);
                    *at = Iterate { x: there, equations };
                    self.damping = (self.damping * Self::FACTOR.recip()).max(Self::LEAST.0);
                    return Some(fall < SETTLED_COST);
                }
            }
            self.damping = (self.damping * Self::FACTOR).max(Self::LEAST.1);
        }
        None
    }
}
