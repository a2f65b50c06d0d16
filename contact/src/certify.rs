//! A configuration as a state in SI units, with its certificate.

use crate::configuration::{Configuration, Span};
use crate::path::ClampPath;
use crate::scan::Scan;
use crate::state::{Certificate, Contact, State};
use crate::world::World;
use rod_core::{Reactions, Rod, Section, SolveReport, Supports, Units, advance};

/// Rounding of an arc length.
const AT_TIP: f64 = 1e-12;

/// What is known of a configuration besides its unknowns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quality {
    pub residual: f64,
    pub condition: f64,
    pub iterations: u32,
    pub stable: bool,
}

impl Quality {
    /// Of a free rod: nothing was solved.
    pub const FREE: Self = Self { residual: 0.0, condition: 1.0, iterations: 0, stable: true };

    pub fn new(report: &SolveReport, stable: bool) -> Self {
        Self { residual: report.residual, condition: report.condition, iterations: report.iterations, stable }
    }
}

/// The state of `rod` in `configuration`.
pub(crate) fn state(
    rod: &Rod,
    world: &World<'_>,
    path: &ClampPath,
    configuration: &Configuration,
    scan: &Scan,
    quality: Quality,
) -> State {
    let Units { length, force, moment, .. } = rod.units();
    let n = configuration.count();
    let supports = configuration.supports(world);
    let clamp = path.at(configuration.tau());
    let spans = configuration.spans(world, path);
    let mut contacts = Vec::with_capacity(n);
    let mut min_force = f64::INFINITY;
    for j in 0..n {
        let at = supports.support(j, configuration.t(j));
        let f = configuration.force(j);
        min_force = min_force.min(f);
        contacts.push(Contact {
            object: world.object(configuration.contacts[j].stretch),
            piece: world.piece(configuration.contacts[j].stretch),
            kind: configuration.kind(world, j),
            s: on_rod(configuration.s(j)) * length,
            x: at.x * length,
            y: at.y * length,
            alpha: at.alpha,
            force: f * force,
        });
    }
    let Span { start: Section { kappa, .. }, a, b, .. } = spans[0];
    let certificate = Certificate {
        residual: quality.residual,
        min_gap: scan.min_gap * length,
        min_force: min_force * force,
        first_integral: first_integral(&spans),
        stable: quality.stable,
        condition: quality.condition,
        iterations: quality.iterations,
    };
    let pose = rod_core::Pose { x: clamp.x * length, y: clamp.y * length, phi: clamp.phi };
    let reactions = Reactions { f0x: 0.0 - b * force, f0y: a * force, m0z: 0.0 - kappa * moment };
    let mut state = State { pose, contacts, reactions, energy: 0.0, max_stress: rod.bending_stress(0.0), certificate };
    if n > 0
        && let Ok(elastica) = state.elastica(rod)
    {
        state.energy = elastica.bending_energy();
        state.max_stress = rod.bending_stress(elastica.largest_curvature());
    }
    state
}

/// An arc length beyond the tip by rounding is at the tip. One that is further beyond stays, and shows that the contact set is
/// not the right one.
fn on_rod(s: f64) -> f64 {
    if s <= 1.0 + AT_TIP { s.min(1.0) } else { s }
}

/// Largest change of kappa^2 / 2 - (A sin phi - B cos phi) from the start of a segment to where the next one starts, which
/// was computed without it.
fn first_integral(spans: &[Span]) -> f64 {
    let invariant = |at: &Section, a: f64, b: f64| {
        let (sin, cos) = at.phi.sin_cos();
        0.5 * at.kappa * at.kappa - (a * sin - b * cos)
    };
    let change = |pair: &[Span]| {
        let Span { s, start, a, b } = pair[0];
        let end = advance(&start, a, b, pair[1].s - s);
        (invariant(&end, a, b) - invariant(&pair[1].start, a, b)).abs()
    };
    spans.windows(2).map(change).fold(0.0, f64::max)
}
