//! Equilibrium at one pose for a given contact set.

use crate::contact_set::guess::{by_chords, by_forces, held, supposed};
use crate::contact_set::order::ordered;
use crate::contact_set::{Configuration, Unknowns};
use crate::continuation::branch::Corrector;
use crate::continuation::certify::{Quality, state};
use crate::error::ContactError;
use crate::gap::scan::Scanner;
use crate::inadmissible::Inadmissible;
use crate::path::{ClampPath, check};
use crate::scene::setup::Setup;
use crate::state::{Contact, State};
use rod_contours::Composite;
use rod_core::{Pose, Rod, SolveReport};

/// What a solve for a given contact set came to.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Equilibrium {
    /// The state. Its certificate says whether it can exist: a contact set that is not the right one shows as a force that
    /// pulls, a negative gap, as unstable, or as a contact with an arc length beyond the rod's.
    pub state: State,
    /// How the solve ended. Unless its status is solved, the state is only where it came to.
    pub report: SolveReport,
    admissible: Result<(), Inadmissible>,
}

/// Depth (L) inside an object that is rounding.
const DEEPEST: f64 = 1e-9;

impl Equilibrium {
    /// Whether the rod can be in this state: it is solved, no contact pulls or lies beyond the tip, the contacts are in order, the
    /// rod is nowhere more than 1e-9 L inside an object, and it is stable.
    ///
    /// # Errors
    /// The first of these conditions that is broken, with what to try.
    ///
    /// ```
    /// use rod_contact::{Contact, ContactKind, Inadmissible, equilibrium};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
    /// let pose = Pose { x: 0.32, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
    /// let along = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.9, x: 0.35, y: 0.6, alpha: 1.3, force: 1.0 };
    /// let beyond = equilibrium(&rod, &object, pose, &[along])?;
    /// assert!(matches!(beyond.is_admissible(), Err(Inadmissible::BeyondTip { .. })));
    /// let tip = equilibrium(&rod, &object, pose, &[Contact { kind: ContactKind::Tip, ..along }])?;
    /// assert_eq!(tip.is_admissible(), Ok(()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_admissible(&self) -> Result<(), Inadmissible> {
        self.admissible
    }
}

/// The first condition that a solved or unsolved state breaks.
fn judged(report: &SolveReport, in_order: bool, state: &State, length: f64) -> Result<(), Inadmissible> {
    if !report.status.is_solved() {
        return Err(Inadmissible::NotSolved(report.status));
    }
    let pulls = state.contacts.iter().position(|contact| contact.force < 0.0);
    if let Some(contact) = pulls {
        return Err(Inadmissible::Pulls { contact, force: state.contacts[contact].force });
    }
    if let Some(last) = state.contacts.last().filter(|last| last.s > length) {
        return Err(Inadmissible::BeyondTip { s: last.s, length });
    }
    if !in_order {
        return Err(Inadmissible::NotInOrder);
    }
    let depth = -state.certificate.min_gap.seen;
    if depth > DEEPEST * length {
        return Err(Inadmissible::Inside { depth });
    }
    if state.certificate.stable { Ok(()) } else { Err(Inadmissible::Unstable) }
}

/// The equilibrium of `rod` on `objects` (one [`Composite`] or a list of them) with its clamp at `pose` (m, radians),
/// held by exactly the contacts of `guess`: of each its object, piece and kind are kept; force, arc length and position
/// are where the solve starts.
///
/// Nothing is added to the contact set or taken from it: that is what a [`Sweep`](crate::Sweep) does.
///
/// ```
/// use rod_contact::{Contact, ContactKind, equilibrium};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// let contour = Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?;
/// let rod = Rod::new(1.0, 1.0)?;
/// // a vertical rod beside the parabola, pushed against its flank
/// let pose = Pose { x: 0.1, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
/// let guess = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.6, x: 0.25, y: 0.3, alpha: 1.2, force: 1.0 };
/// let found = equilibrium(&rod, &contour, pose, &[guess])?;
/// assert!(found.report.status.is_solved() && found.state.certificate.stable);
/// assert_eq!(found.state.phase().to_string(), "B");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ContactError::NotFinite`], [`ContactError::Angle`], [`ContactError::Guess`] where a contact cannot be where it is said to be.
pub fn equilibrium(
    rod: &Rod,
    objects: &(impl AsRef<[Composite]> + ?Sized),
    pose: Pose,
    guess: &[Contact],
) -> Result<Equilibrium, ContactError> {
    check(pose, ["pose.x", "pose.y", "pose.phi"])?;
    let units = rod.units();
    let mut corrector = Corrector::new(Setup::new(rod, objects.as_ref(), ClampPath::standing(pose)));
    let Setup { world, path, .. } = &corrector.setup;
    let supposed = supposed(world, units, guess)?;
    let clamp = path.at(0.0);
    // a force may be a mere guess, and then the chords know better
    let [by_chords, by_forces] =
        [by_chords(clamp, &supposed), by_forces(clamp, &supposed)].map(|phi| held(&supposed, &phi));
    let off = |configuration: &Configuration| {
        let (supports, u) = (configuration.supports(world), configuration.of_contacts());
        let mut residual = Unknowns::from_elem(0.0, u.len());
        corrector.setup.problem(&supports, 0.0).evaluate_into(u, &mut residual, None);
        residual.iter().map(|r| r * r).sum::<f64>()
    };
    let (first, second) =
        if off(&by_forces) < off(&by_chords) { (by_forces, by_chords) } else { (by_chords, by_forces) };
    let mut solve = |mut configuration: Configuration| {
        let report = corrector.solve_from_guess(&mut configuration, 0.0);
        (configuration, report)
    };
    let (mut configuration, mut report) = solve(first);
    if !report.status.is_solved() {
        let other = solve(second);
        if other.1.status.is_solved() {
            (configuration, report) = other;
        }
    }
    let mut scanner = Scanner::default();
    let setup = &corrector.setup;
    let scan = scanner.scan(setup, &configuration);
    let stable = report.status.is_solved() && scanner.is_stable(&setup.world, &configuration, &scan);
    let quality = Quality::new(&report, stable);
    let in_order = ordered(&setup.world, &configuration);
    let state = state(setup, &configuration, &scan, quality);
    let admissible = judged(&report, in_order, &state, units.length);
    Ok(Equilibrium { state, report, admissible })
}
