//! A configuration as a state in SI units, with its certificate.

use crate::contact_set::Configuration;
use crate::friction::slip_coordinate;
use crate::gap::Scan;
use crate::limits::LIMITS;
use crate::scene::Setup;
use crate::scene::world::World;
use crate::state::{Certificate, Contact, ContactFriction, GapBounds, RollerContact, SlipMode, State};
use rod_core::{Clamp, Elastica, Grip, PhysicalRod, Pose, Reactions, RollerHold, SolveReport, Supports, Units};

/// The quality of a configuration: the part of its certificate that comes from the solve and the stability.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quality {
    pub residual: f64,
    pub condition: f64,
    pub iterations: u32,
    pub stable: bool,
}

impl Quality {
    /// The quality of a free rod, which needs no solve.
    pub const FREE: Self = Self { residual: 0.0, condition: 1.0, iterations: 0, stable: true };

    pub fn new(report: &SolveReport, stable: bool) -> Self {
        Self { residual: report.residual, condition: report.condition, iterations: report.iterations, stable }
    }
}

/// The state of the rod in `configuration`, which was scanned.
#[inline(never)]
pub(crate) fn state<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    configuration: &Configuration,
    scan: &Scan,
    quality: Quality,
) -> State {
    let Setup { rod, world, .. } = setup;
    let Units { length, force, .. } = rod.units();
    let n = configuration.count();
    let supports = configuration.supports(world);
    let clamp = setup.clamp(configuration.tau());
    let Pose { x, y, phi } = clamp.pose();
    // what was scanned is this configuration
    let mut shape = Elastica::of_segments(rod.model().clone(), rod.units(), scan.segments().iter().copied());
    let mut contacts = Vec::with_capacity(n);
    for j in 0..n {
        let at = supports.support(j, configuration.t(j));
        let f = configuration.force(j);
        contacts.push(Contact {
            object: world.object(configuration.contacts[j].stretch),
            piece: world.piece(configuration.contacts[j].stretch),
            kind: configuration.kind(world, j),
            s: on_rod(configuration.s(j)) * length,
            x: at.x * length,
            y: at.y * length,
            alpha: at.alpha,
            force: f * force,
            friction: friction(world, configuration, j, (length, force)),
        });
    }
    let certificate = Certificate {
        residual: quality.residual,
        min_gap: GapBounds { lower: scan.gap.lower * length, seen: scan.gap.seen * length, ..scan.gap },
        min_force: contacts.iter().map(|contact| contact.force).reduce(f64::min),
        first_integral: shape.first_integral_error(),
        stable: quality.stable,
        condition: quality.condition,
        iterations: quality.iterations,
    };
    let reactions = shape.reactions();
    let bending_energy = shape.split();
    State {
        pose: Pose { x: x * length, y: y * length, phi },
        contacts,
        leg: 0,
        reactions,
        roller: roller(setup, configuration),
        energy: bending_energy + clamp_energy(rod, &clamp, &reactions),
        max_stress: rod.largest_stress(&shape),
        certificate,
    }
}

/// The roller ahead of the clamp, if there is one.
fn roller<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration) -> Option<Box<RollerContact>> {
    let supports = configuration.supports(&setup.world);
    let RollerHold { s, force, at } =
        setup.problem(&supports, configuration.tau()).roller(configuration.of_contacts())?;
    let units = setup.rod.units();
    Some(Box::new(RollerContact {
        s: s * units.length,
        x: at.x * units.length,
        y: at.y * units.length,
        alpha: at.phi,
        force: force * units.force,
    }))
}

/// The friction at contact j, in SI units: `length` and `force` are the units.
fn friction(
    world: &World<'_>,
    configuration: &Configuration,
    j: usize,
    (length, force): (f64, f64),
) -> Option<ContactFriction> {
    let mode = match configuration.contacts[j].grip {
        Grip::SMOOTH => return None,
        Grip::Sticks { .. } => SlipMode::Stick,
        Grip::Slips { ratio } if ratio < 0.0 => SlipMode::Forward,
        Grip::Slips { .. } => SlipMode::Backward,
    };
    // that takes the length of the contour
    let slip = if world.sliding() == 0.0 { slip_coordinate(world, configuration, j) * length } else { 0.0 };
    Some(ContactFriction { mode, force: configuration.friction(j) * force, slip })
}

/// Energy (J) of the rod in `configuration` and of its clamp.
pub(crate) fn energy<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration) -> f64 {
    let supports = configuration.supports(&setup.world);
    let problem = setup.problem(&supports, configuration.tau());
    let shape = problem.elastica(configuration.of_contacts(), setup.rod.units());
    shape.bending_energy() + clamp_energy(&setup.rod, &problem.clamp, &shape.reactions())
}

/// Energy (J) of the clamp of a rod.
fn clamp_energy<R: PhysicalRod>(rod: &R, clamp: &R::Clamp, reactions: &Reactions) -> f64 {
    if clamp.law().is_none() {
        return 0.0;
    }
    let Units { force, moment, energy, .. } = rod.units();
    let Reactions { f0x, f0y, m0z } = reactions;
    clamp.energy(&Reactions { f0x: f0x / force, f0y: f0y / force, m0z: m0z / moment }) * energy
}

/// An arc length, at the tip if it is beyond it by rounding. A larger one stays as it is: it shows that the contact set is wrong.
fn on_rod(s: f64) -> f64 {
    if s <= 1.0 + LIMITS.transition.at_tip { s.min(1.0) } else { s }
}
