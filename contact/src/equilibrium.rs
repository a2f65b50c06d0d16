//! Equilibrium at one pose for a given contact set.

use crate::contact_set::guess::{
    GuessedContact, along_chords, by_chords, by_forces, configuration_of_guess, contacts_of_guess,
};
use crate::contact_set::{Configuration, Unknowns};
use crate::continuation::branch::Corrector;
use crate::continuation::certify::{Quality, state};
use crate::error::ContactError;
use crate::friction::sliding::slide_all;
use crate::gap::Scanner;
use crate::path::{ClampPath, check};
use crate::scene::Setup;
use crate::scene::world::World;
use crate::state::{Contact, State};
use rod_contours::Composite;
#[cfg(feature = "argmin")]
use rod_core::TrustRegionSearch;
use rod_core::{PhysicalRod, Pose, SolveReport, SolveStatus};

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
    /// Whether the rod can be in this state: it is solved, no contact pulls or lies beyond the tip, the contacts are in order
    /// and on their pieces (to 1e-9 L), the rod is nowhere more than 1e-9 L inside an object, and it is stable.
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
    /// let along = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.9, x: 0.35, y: 0.6, alpha: 1.3, force: 1.0, friction: None };
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
fn first_inadmissibility(
    report: &SolveReport,
    in_order: bool,
    off_piece: Option<usize>,
    state: &State,
    length: f64,
) -> Result<(), Inadmissible> {
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
    if let Some(contact) = off_piece {
        return Err(Inadmissible::OffPiece { contact });
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
/// let guess = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.6, x: 0.25, y: 0.3, alpha: 1.2, force: 1.0, friction: None };
/// let found = equilibrium(&rod, &contour, pose, &[guess])?;
/// assert!(found.report.status.is_solved() && found.state.certificate.stable);
/// assert_eq!(found.state.phase().to_string(), "B");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ContactError::NotFinite`], [`ContactError::Angle`], [`ContactError::Guess`] where a contact cannot be where it is said to be.
pub fn equilibrium<R: PhysicalRod>(
    rod: &R,
    objects: &(impl AsRef<[Composite]> + ?Sized),
    pose: Pose,
    guess: &[Contact],
) -> Result<Equilibrium, ContactError> {
    sliding_equilibrium(rod, objects, pose, guess, 0.0)
}

/// [`equilibrium`] of a rod all of whose contacts slide the same way along it: of each the force is turned from the normal of the contour by
/// atan `coefficient`, towards the tip of the rod where that is positive, as on a rod that is drawn back over its contacts. With a coefficient of 0 the
/// friction of the guess stays as it is.
///
/// ```
/// use rod_contact::{Contact, ContactKind, sliding_equilibrium};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// let contour = Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?;
/// let pose = Pose { x: 0.1, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
/// let guess = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.6, x: 0.25, y: 0.3, alpha: 1.2, force: 1.0, friction: None };
/// let found = sliding_equilibrium(&Rod::new(1.0, 1.0)?, &contour, pose, &[guess], 0.2)?;
/// assert_eq!(found.is_admissible(), Ok(()));
/// let [contact] = found.state.contacts.as_slice() else { return Err("not one contact".into()) };
/// assert!((contact.friction.ok_or("smooth")?.force - 0.2 * contact.force).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`equilibrium`]; [`ContactError::NotFinite`] for a coefficient that is not.
pub fn sliding_equilibrium<R: PhysicalRod>(
    rod: &R,
    objects: &(impl AsRef<[Composite]> + ?Sized),
    pose: Pose,
    guess: &[Contact],
    coefficient: f64,
) -> Result<Equilibrium, ContactError> {
    #[cfg(feature = "argmin")]
    let rescue = |corrector: &mut Corrector<'_, R>, configuration: &mut Configuration| {
        Some(corrector.solve_by_trust_region(configuration, 0.0, |search| search))
    };
    #[cfg(not(feature = "argmin"))]
    let rescue = |_: &mut Corrector<'_, R>, _: &mut Configuration| None;
    found(rod, objects.as_ref(), pose, (guess, coefficient), rescue)
}

/// [`equilibrium`] with the user's limits and observers of `argmin`'s trust region: `search` gets its executor before it runs, up to
/// three times, where Newton's method has failed.
///
/// ```
/// use rod_contact::{Contact, ContactKind, equilibrium_with_search};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// let contour = Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?;
/// let pose = Pose { x: 0.1, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
/// let guess = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.6, x: 0.25, y: 0.3, alpha: 1.2, force: 1.0, friction: None };
/// let found = equilibrium_with_search(&Rod::new(1.0, 1.0)?, &contour, pose, &[guess], |search| {
///     search.configure(|state| state.max_iters(20)).timeout(std::time::Duration::from_millis(5))
/// })?;
/// assert_eq!(found.is_admissible(), Ok(()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`equilibrium`].
#[cfg(feature = "argmin")]
pub fn equilibrium_with_search<R: PhysicalRod>(
    rod: &R,
    objects: &(impl AsRef<[Composite]> + ?Sized),
    pose: Pose,
    guess: &[Contact],
    mut search: impl FnMut(TrustRegionSearch<'_>) -> TrustRegionSearch<'_>,
) -> Result<Equilibrium, ContactError> {
    let rescue = |corrector: &mut Corrector<'_, R>, configuration: &mut Configuration| {
        Some(corrector.solve_by_trust_region(configuration, 0.0, &mut search))
    };
    found(rod, objects.as_ref(), pose, (guess, 0.0), rescue)
}

/// The equilibrium by Newton's method, or by `rescue` where that fails.
fn found<R: PhysicalRod>(
    rod: &R,
    objects: &[Composite],
    pose: Pose,
    (guess, sliding): (&[Contact], f64),
    rescue: impl FnMut(&mut Corrector<'_, R>, &mut Configuration) -> Option<SolveReport>,
) -> Result<Equilibrium, ContactError> {
    check(pose, ["pose.x", "pose.y", "pose.phi"])?;
    let units = rod.units();
    let mut corrector = Corrector::new(Setup::new(rod, objects, ClampPath::standing(pose)));
    corrector.setup.world.slide(sliding)?;
    let supposed = contacts_of_guess(&corrector.setup.world, units, guess)?;
    let (configuration, report) = solve_guess(&mut corrector, &supposed, rescue);
    let mut scanner = Scanner::default();
    let setup = &corrector.setup;
    let scan = scanner.scan(setup, &configuration);
    let stable = report.status.is_solved() && scanner.is_stable(setup, &configuration, &scan);
    let quality = Quality::new(&report, stable);
    let in_order = configuration.is_ordered(&setup.world);
    let off_piece = configuration.off_piece(&setup.world);
    let state = state(setup, &configuration, &scan, quality);
    let admissible = first_inadmissibility(&report, in_order, off_piece, &state, units.length);
    Ok(Equilibrium { state, report, admissible })
}

type Root = (Configuration, SolveReport);

/// Newton's method from each start, then `rescue` from each (none where there is no such method): the first root in which no contact
/// pulls, lies beyond the tip, out of order or off its piece; else the first root; else what the first solve came to. `rescue` is only tried where
/// Newton's method finds no root.
fn solve_guess<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    supposed: &[GuessedContact],
    mut rescue: impl FnMut(&mut Corrector<'_, R>, &mut Configuration) -> Option<SolveReport>,
) -> Root {
    let [first, second, third] = starts(&corrector.setup, supposed);
    let mut best = by_newton(corrector, &first);
    for start in [&second, &third] {
        if is_plausible(&corrector.setup.world, &best) {
            return best;
        }
        let root = by_newton(corrector, start);
        best = better(&corrector.setup.world, best, root);
    }
    if best.1.status.is_solved() {
        return best;
    }
    // the chords, which do not depend on forces and arc lengths, lead the trust region to a root most often
    for start in [third, first, second] {
        let mut configuration = start;
        let Some(report) = rescue(corrector, &mut configuration) else { return best };
        best = better(&corrector.setup.world, best, (configuration, report));
        if is_plausible(&corrector.setup.world, &best) {
            break;
        }
    }
    best
}

fn by_newton<R: PhysicalRod>(corrector: &mut Corrector<'_, R>, start: &Configuration) -> Root {
    let mut configuration = start.clone();
    let report = corrector.solve_from_guess(&mut configuration, 0.0);
    (configuration, report)
}

fn better(world: &World<'_>, best: Root, other: Root) -> Root {
    let gained = other.1.status.is_solved() && (!best.1.status.is_solved() || is_plausible(world, &other));
    if gained { other } else { best }
}

/// Whether a solve came to a root that a rod may be in, as far as that costs nothing to see.
fn is_plausible(world: &World<'_>, (configuration, report): &Root) -> bool {
    let holds = |j| configuration.force(j) >= 0.0 && configuration.s(j) <= 1.0;
    let solved = report.status.is_solved();
    solved
        && (0..configuration.count()).all(holds)
        && configuration.is_ordered(world)
        && configuration.off_piece(world).is_none()
}

/// Where a solve may start: with the arc lengths and forces of the guess and the slope angles of arcs or those by the forces, the
/// smaller residual first, since a force may be a mere guess; then with arc lengths and slope angles of the chords.
fn starts<R: PhysicalRod>(setup: &Setup<'_, R>, supposed: &[GuessedContact]) -> [Configuration; 3] {
    let clamp = setup.path.at(0.0);
    let of_guess = |supposed: &[GuessedContact], slopes: &[f64]| {
        let mut configuration = configuration_of_guess(supposed, slopes);
        slide_all(&setup.world, &mut configuration);
        configuration
    };
    let arcs = of_guess(supposed, &by_chords(clamp, supposed, 2.0));
    let by_forces = of_guess(supposed, &by_forces(setup.rod.model(), &setup.clamp(0.0), supposed));
    let chords = of_guess(&along_chords(clamp, supposed), &by_chords(clamp, supposed, 1.0));
    let off = |configuration: &Configuration| {
        let (supports, u) = (configuration.supports(&setup.world), configuration.of_contacts());
        let mut residual = Unknowns::from_elem(0.0, u.len());
        setup.problem(&supports, 0.0).evaluate_into(u, &mut residual, None);
        residual.iter().map(|r| r * r).sum::<f64>()
    };
    if off(&by_forces) < off(&arcs) { [by_forces, arcs, chords] } else { [arcs, by_forces, chords] }
}

/// Why the equilibrium of a given contact set is not one of the rod: the first of the conditions that it breaks.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Inadmissible {
    /// The equations were not solved.
    #[error("the equations are not solved ({0:?}); start from a better guess, or take the contact set from a sweep")]
    NotSolved(SolveStatus),
    /// A contact pulls the rod.
    #[error("contact {contact} pulls with {force:e} N; leave it out")]
    Pulls {
        /// Number of the contact, from 0 at the clamp.
        contact: usize,
        /// Its force, N, < 0.
        force: f64,
    },
    /// A tangential contact lies beyond the tip.
    #[error("the last contact is at {s} m, beyond the tip of a rod of {length} m; take a contact of the tip instead")]
    BeyondTip {
        /// Arc length, m.
        s: f64,
        /// Length of the rod, m.
        length: f64,
    },
    /// The contacts are not in the order of the guess along the rod.
    #[error("the contacts are not in order along the rod; give the guess in another order")]
    NotInOrder,
    /// A contact lies on the curve of its piece, but beyond the end of the piece, or the force at a corner points out of the cone of its
    /// normals.
    #[error(
        "contact {contact} lies beyond the end of its piece; take the corner or the piece that follows there, or leave it out"
    )]
    OffPiece {
        /// Number of the contact, from 0 at the clamp.
        contact: usize,
    },
    /// The rod goes into or through an object.
    #[error(
        "the rod goes {depth:e} m into or through an object; a contact is missing, or the one of the tip is tangential"
    )]
    Inside {
        /// Depth, m; of a rod that comes out again, how far it is behind the contour where it went in.
        depth: f64,
    },
    /// The energy is not a minimum.
    #[error("the equilibrium is not stable; the rod would leave it")]
    Unstable,
}
