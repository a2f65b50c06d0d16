//! The one loop of all fits.

use super::problem::{Iterate, Problem};
use super::step_control::StepControl;
use nalgebra::DVector;

/// How an iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    Converged,
    /// No step can be taken: the equations are singular, or no part of the step is admitted.
    Stalled,
    /// After as many steps as were allowed.
    OutOfSteps,
}

/// From `x` on, with at most so many steps.
pub(crate) fn iterate<P: Problem>(
    problem: &mut P,
    x: DVector<f64>,
    mut control: impl StepControl<P>,
    most_steps: usize,
) -> (Iterate<P::Equations>, Status) {
    problem.reweigh(&x);
    let equations = problem.equations(&x);
    let mut at = Iterate { x, equations };
    if !control.set_out(&at) {
        return (at, Status::Stalled);
    }
    for _ in 0..most_steps {
        match control.advance(problem, &mut at) {
            None => return (at, Status::Stalled),
            Some(is_settled) if !is_settled => {}
            Some(_) => {
                if !problem.reweigh(&at.x) {
                    return (at, Status::Converged);
                }
                at.equations = problem.equations(&at.x);
                if !control.set_out(&at) {
                    return (at, Status::Stalled);
                }
            }
        }
    }
    (at, Status::OutOfSteps)
}

#[cfg(test)]
mod tests {
    use super::super::{Damped, Loss, Monotone, NormalMatrix, WholeSteps};
    use super::*;

    /// y = a exp(b t) at t = 0, 0.1, ..., 1; the last sample is wild.
    struct Growth {
        loss: Option<Loss>,
        wild: f64,
    }

    impl Problem for Growth {
        type Equations = NormalMatrix;

        fn equations(&mut self, x: &DVector<f64>) -> NormalMatrix {
            let mut normal = NormalMatrix::empty(2);
            for k in 0..=10 {
                let t = 0.1 * f64::from(k);
                let model = x[0] * (x[1] * t).exp();
                let data = 2.0 * (-1.5 * t).exp() + if k == 10 { self.wild } else { 0.0 };
                let residual = (model - data) / 0.01;
                let weight = self.loss.map_or(1.0, |loss| loss.weight(1.0, residual));
                let row = [(0, (x[1] * t).exp() / 0.01), (1, t * model / 0.01)];
                normal.add_weighted(&row, residual, weight);
            }
            normal
        }
    }

    #[test]
    fn every_step_control_finds_the_solution() {
        let mut exact = Growth { loss: None, wild: 0.0 };
        let start = DVector::from_column_slice(&[1.0, 0.0]);
        let sizes = DVector::repeat(2, 1.0);
        let found = [
            iterate(&mut exact, start.clone(), WholeSteps::until(1e-12), 50),
            iterate(&mut exact, start.clone(), Monotone::with_sizes(sizes), 50),
            iterate(&mut exact, start, Damped::default(), 50),
        ];
        for (at, status) in found {
            assert_eq!(status, Status::Converged);
            assert!((at.x[0] - 2.0).abs() + (at.x[1] + 1.5).abs() < 1e-4, "{}", at.x);
        }
    }

    #[test]
    fn a_robust_loss_leaves_a_wild_sample_out() {
        let start = DVector::from_column_slice(&[1.9, -1.4]);
        let off = |loss| {
            let (at, _) = iterate(&mut Growth { loss, wild: 1.0 }, start.clone(), WholeSteps::until(1e-12), 100);
            (at.x[1] + 1.5).abs()
        };
        assert!(off(None) > 0.1);
        assert!(off(Some(Loss::Cauchy(3.0))) < 0.02);
        assert!(off(Some(Loss::Quartic(3.0))) < 1e-4);
    }

    #[test]
    fn unknowns_that_nothing_tells_stall_the_iteration() {
        struct Nothing;
        impl Problem for Nothing {
            type Equations = NormalMatrix;
            fn equations(&mut self, _: &DVector<f64>) -> NormalMatrix {
                NormalMatrix::empty(1)
            }
        }
        let (at, status) = iterate(&mut Nothing, DVector::zeros(1), WholeSteps::until(1e-9), 5);
        assert_eq!((at.x[0], status), (0.0, Status::Stalled));
    }
}
