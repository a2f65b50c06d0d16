//! A branch of equilibria along the path: the boundary-value problem with the path parameter as one more unknown and one
//! more, linear, equation. This equation, the condition, selects a pose, a step of pseudo-arclength or an event.

use crate::contact_set::{ActiveContact, ActiveSupports, Configuration, Unknown, Unknowns};
use crate::limits::LIMITS;
use crate::scene::Setup;
use rod_core::{
    Links, NewtonOptions, NewtonWorkspace, PhysicalRod, Rod, SolveReport, SolveStatus, System, newton_step, solve,
};
#[cfg(feature = "argmin")]
use rod_core::{TrustRegionSearch, solve_by_trust_region};

/// The condition that picks a point of the branch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Condition<'a> {
    /// One unknown has a given value: the pose, a vanishing force, a contact at the tip or at the border of its stretch.
    Fixed { unknown: Unknown, value: f64 },
    /// A contact that sticks is at the limit of friction: its force along the contour, unknown number `friction`, is `ratio` times its
    /// normal force, unknown number `force`.
    OnCone { friction: usize, force: usize, ratio: f64 },
    /// The plane across a tangent at a distance from a point.
    Plane { tangent: &'a Tangent, from: &'a [f64], distance: f64 },
}

/// Direction of a branch, of length 1 in the metric `weights`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tangent {
    pub direction: Unknowns,
    pub weights: Unknowns,
}

impl Tangent {
    fn row(&self, i: usize) -> f64 {
        self.direction[i] * self.weights[i] * self.weights[i]
    }

    /// Component of z - from along the tangent.
    pub fn along(&self, z: &[f64], from: &[f64]) -> f64 {
        z.iter().zip(from).enumerate().map(|(i, (z, f))| self.row(i) * (z - f)).sum()
    }

    /// Distance of two points in the tangent's metric.
    pub fn distance(&self, z: &[f64], from: &[f64]) -> f64 {
        z.iter().zip(from).zip(&self.weights).map(|((z, f), w)| ((z - f) * w).powi(2)).sum::<f64>().sqrt()
    }

    /// `configuration` moved by `distance` along the tangent.
    pub fn ahead(&self, configuration: &Configuration, distance: f64) -> Configuration {
        let mut ahead = configuration.clone();
        for (z, d) in ahead.z.iter_mut().zip(&self.direction) {
            *z += distance * d;
        }
        ahead
    }

    /// The rate of unknown number `i` by arclength.
    pub fn rate(&self, i: usize) -> f64 {
        self.direction[i]
    }

    /// The rate of an unknown of a contact by arclength.
    pub fn rate_of(&self, unknown: Unknown) -> f64 {
        self.direction[unknown.index(self.direction.len())]
    }

    /// Change of the path parameter by arclength.
    pub fn by_tau(&self) -> f64 {
        self.direction.last().copied().unwrap_or(1.0)
    }

    /// Component of the direction of another tangent of the same contact set along this one.
    pub fn component(&self, other: &[f64]) -> f64 {
        other.iter().enumerate().map(|(i, d)| self.row(i) * d).sum()
    }

    /// Cosine of the angle to another direction of the same contact set.
    pub fn cosine(&self, other: &[f64]) -> f64 {
        let norm: f64 = other.iter().zip(&self.weights).map(|(d, w)| (d * w).powi(2)).sum();
        self.component(other) / norm.sqrt()
    }
}

struct Bordered<'a, R = Rod> {
    setup: &'a Setup<'a, R>,
    holding: ActiveSupports<'a>,
    condition: Condition<'a>,
    /// Number of unknowns.
    size: usize,
}

impl<R: PhysicalRod> Bordered<'_, R> {
    fn condition_at(&self, z: &[f64]) -> f64 {
        match self.condition {
            Condition::Fixed { unknown, value } => z[unknown.index(z.len())] - value,
            Condition::OnCone { friction, force, ratio } => z[friction] - ratio * z[force],
            Condition::Plane { tangent, from, distance } => tangent.along(z, from) - distance,
        }
    }

    /// The change of the first three equations with tau, which moves the clamp: only the first segment ends there.
    fn by_tau(&self, tau: f64) -> [f64; 3] {
        let rate = self.setup.path.rate(tau);
        [-rate.x, -rate.y, -rate.phi]
    }

    fn condition_row(&self, column: usize, size: usize) -> f64 {
        match self.condition {
            Condition::Fixed { unknown, .. } => f64::from(u8::from(unknown.index(size) == column)),
            Condition::OnCone { friction, .. } if column == friction => 1.0,
            Condition::OnCone { force, ratio, .. } => {
                if column == force {
                    -ratio
                } else {
                    0.0
                }
            }
            Condition::Plane { tangent, .. } => tangent.row(column),
        }
    }
}

impl<R: PhysicalRod> System for Bordered<'_, R> {
    fn dimension(&self) -> usize {
        self.size
    }

    fn evaluate(&self, z: &[f64], residual: &mut [f64], jacobian: Option<&mut [f64]>) {
        let (last, size) = (z.len() - 1, z.len());
        let problem = self.setup.problem(&self.holding, z[last]);
        residual[last] = self.condition_at(z);
        match jacobian {
            None => problem.evaluate_into(&z[..last], residual, None),
            Some(matrix) => {
                problem.evaluate_into(&z[..last], residual, Some((&mut *matrix, size)));
                for column in 0..size {
                    matrix[column * size + last] = self.condition_row(column, size);
                }
                let by_tau = &mut matrix[last * size..][..last];
                by_tau.fill(0.0);
                by_tau.iter_mut().zip(self.by_tau(z[last])).for_each(|(entry, rate)| *entry = rate);
            }
        }
    }

    fn is_linked(&self) -> bool {
        self.setup.problem(&self.holding, 0.0).is_linked()
    }

    fn evaluate_links(&self, z: &[f64], residual: &mut [f64], links: &mut Links) {
        let (last, size) = (z.len() - 1, z.len());
        self.setup.problem(&self.holding, z[last]).evaluate_links(&z[..last], residual, links);
        residual[last] = self.condition_at(z);
        links.set_border(self.by_tau(z[last]), (0..size).map(|column| self.condition_row(column, size)));
    }

    fn weights(&self, z: &[f64], weights: &mut [f64]) {
        let last = z.len() - 1;
        self.setup.problem(&self.holding, z[last]).weights(&z[..last], &mut weights[..last]);
        weights[last] = 1.0;
    }
}

/// Solves for points of branches. It keeps the memory of Newton's method.
#[derive(Debug)]
pub(crate) struct Corrector<'a, R = Rod> {
    pub setup: Setup<'a, R>,
    workspace: NewtonWorkspace,
}

fn options(max_iterations: u32) -> NewtonOptions {
    NewtonOptions { max_iterations, longest_step: 0.5, ..NewtonOptions::default() }
}

impl<'a, R: PhysicalRod> Corrector<'a, R> {
    pub fn new(setup: Setup<'a, R>) -> Self {
        Self { setup, workspace: NewtonWorkspace::new() }
    }

    /// Moves `configuration`, near a branch, onto it where `condition` holds.
    pub fn correct(&mut self, configuration: &mut Configuration, condition: Condition<'_>) -> SolveReport {
        self.solve(configuration, condition, LIMITS.step.most_iterations)
    }

    #[inline(never)]
    fn solve(&mut self, configuration: &mut Configuration, condition: Condition<'_>, iterations: u32) -> SolveReport {
        let Configuration { contacts, z } = configuration;
        let system = bordered_system(&self.setup, contacts, condition, z.len());
        solve(&system, z, &options(iterations), &mut self.workspace)
    }

    /// [`correct`](Self::correct), and the tangent at the solution: by the last Jacobian of the solve, which was taken at most one small
    /// correction away. No tangent where the solve failed.
    pub fn correct_with_tangent(
        &mut self,
        configuration: &mut Configuration,
        condition: Condition<'_>,
    ) -> (SolveReport, Option<Tangent>) {
        let report = self.correct(configuration, condition);
        let tangent = report.status.is_solved().then(|| self.tangent(configuration));
        (report, tangent)
    }

    /// Solves at the pose `tau` from near by.
    pub fn at_pose(&mut self, configuration: &mut Configuration, tau: f64) -> SolveReport {
        self.correct(configuration, Condition::Fixed { unknown: Unknown::Path, value: tau })
    }

    /// Solves at the pose `tau` from a guess.
    pub fn solve_from_guess(&mut self, configuration: &mut Configuration, tau: f64) -> SolveReport {
        self.solve(
            configuration,
            Condition::Fixed { unknown: Unknown::Path, value: tau },
            LIMITS.step.most_iterations_from_guess,
        )
    }

    /// Solves at the pose `tau` from a guess from which [`solve_from_guess`](Self::solve_from_guess) fails.
    #[cfg(feature = "argmin")]
    pub fn solve_by_trust_region(
        &mut self,
        configuration: &mut Configuration,
        tau: f64,
        search: impl FnOnce(TrustRegionSearch<'_>) -> TrustRegionSearch<'_>,
    ) -> SolveReport {
        let Configuration { contacts, z } = configuration;
        let system =
            bordered_system(&self.setup, contacts, Condition::Fixed { unknown: Unknown::Path, value: tau }, z.len());
        solve_by_trust_region(&system, z, &options(LIMITS.step.most_iterations_from_guess), &mut self.workspace, search)
    }

    /// The tangent of the branch at `configuration`, in the direction in which the condition's row grows (with the pose
    /// fixed towards growing tau, on a plane as the plane's own tangent), and how well the configuration solves its
    /// equations.
    pub fn inspect(&mut self, configuration: &Configuration, condition: Condition<'_>) -> (Tangent, SolveReport) {
        let system = bordered_system(&self.setup, &configuration.contacts, condition, configuration.z.len());
        let mut z = configuration.z.clone();
        self.workspace.prepare(&system, &z);
        newton_step(&system, &mut z, &options(LIMITS.step.most_iterations), &mut self.workspace);
        let status = SolveStatus::Converged;
        let report = self.workspace.report(&system, &configuration.z, status, 0, 0.0);
        (self.tangent(configuration), report)
    }

    /// [`inspect`](Self::inspect) with the pose fixed.
    pub fn inspect_at_pose(&mut self, configuration: &Configuration) -> (Tangent, SolveReport) {
        self.inspect(configuration, Condition::Fixed { unknown: Unknown::Path, value: configuration.tau() })
    }

    /// The direction of the branch, of any length, for `size` unknowns: the last column of the inverse of the last Jacobian. If the pose was
    /// fixed in the last solve, tau grows along it.
    pub fn direction(&self, size: usize) -> Unknowns {
        let mut column = Unknowns::from_elem(0.0, size);
        self.workspace.last_column(&mut column);
        column
    }

    /// The tangent at `configuration` by the Jacobian that the workspace holds.
    fn tangent(&self, configuration: &Configuration) -> Tangent {
        let size = configuration.z.len();
        let column = self.direction(size);
        let mut weights = Unknowns::from_elem(1.0, size);
        let holding = configuration.supports(&self.setup.world);
        let problem = self.setup.problem(&holding, configuration.tau());
        problem.weights(&configuration.z, &mut weights[..size - 1]);
        let length = column.iter().zip(&weights).map(|(d, w)| (d * w).powi(2)).sum::<f64>().sqrt();
        Tangent { direction: column.iter().map(|d| d / length).collect(), weights }
    }
}

fn bordered_system<'a, R: PhysicalRod>(
    setup: &'a Setup<'a, R>,
    contacts: &'a [ActiveContact],
    condition: Condition<'a>,
    size: usize,
) -> Bordered<'a, R> {
    Bordered { setup, holding: ActiveSupports { world: &setup.world, contacts }, condition, size }
}
