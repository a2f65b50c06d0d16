//! Equilibrium at one pose for a given contact set.

use crate::branch::Corrector;
use crate::certify::{Quality, state};
use crate::configuration::{Configuration, Held};
use crate::error::ContactError;
use crate::path::ClampPath;
use crate::scan::Scanner;
use crate::stability::is_stable;
use crate::state::{Contact, ContactKind, State};
use crate::world::World;
use rod_contours::{Composite, StretchKind};
use rod_core::{Hold, Pose, Rod, SolveReport};
use std::f64::consts::{PI, TAU};

/// What a solve for a given contact set came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// The state. Its certificate says whether it can exist: a contact set that is not the right one shows as a force that
    /// pulls, a negative gap, or as unstable.
    pub state: State,
    /// How the solve ended. Unless its status is solved, the state is only where it came to.
    pub report: SolveReport,
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
/// let contour = Composite::single(Parabola::new([0.0, 0.0], 5.0)?);
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
/// [`ContactError::NotFinite`], [`ContactError::Guess`] where a contact cannot be where it is said to be.
pub fn equilibrium(
    rod: &Rod,
    objects: &(impl AsRef<[Composite]> + ?Sized),
    pose: Pose,
    guess: &[Contact],
) -> Result<Equilibrium, ContactError> {
    for (what, value) in [("pose.x", pose.x), ("pose.y", pose.y), ("pose.phi", pose.phi)] {
        if !value.is_finite() {
            return Err(ContactError::NotFinite { what, value });
        }
    }
    let units = rod.units();
    let path = ClampPath::standing(pose).dimensionless(units);
    let world = World::new(objects.as_ref(), units.length);
    let mut configuration = Configuration::free(0.0);
    let (mut from, mut phi) = ((path.at(0.0).x, path.at(0.0).y), pose.phi);
    for (index, contact) in guess.iter().enumerate() {
        let wrong = |reason| Err(ContactError::Guess { index, reason });
        if ![contact.s, contact.x, contact.y, contact.force].iter().all(|v| v.is_finite()) {
            return wrong("its numbers are not finite");
        }
        if configuration.ends_at_tip() {
            return wrong("it follows a contact at the tip, expected that to be the last");
        }
        let wanted = match contact.kind {
            ContactKind::Tangent | ContactKind::Tip => StretchKind::Piece(contact.piece),
            ContactKind::Corner => StretchKind::Corner { before: contact.piece },
            ContactKind::Notch => StretchKind::Notch { before: contact.piece },
        };
        let Some(stretch) = world.find(contact.object, wanted) else {
            return wrong("there is no such object, or it has no such piece, corner or notch");
        };
        let foot = world.foot(stretch, contact.x / units.length, contact.y / units.length);
        // The rod's direction there, from the chord: an arc turns twice as far as its chord.
        let chord = (foot.y - from.1).atan2(foot.x - from.0);
        let turn = chord - phi;
        phi += 2.0 * (turn - TAU * (turn / TAU).round());
        from = (foot.x, foot.y);
        let tip = matches!(contact.kind, ContactKind::Tip | ContactKind::Notch);
        let (hold, third) = if tip {
            (Hold::Tip, phi)
        } else {
            let offset = PI * ((phi - foot.alpha) / PI).round();
            phi = foot.alpha + offset;
            (Hold::Tangent { offset }, contact.s / units.length)
        };
        configuration.insert(index, Held { stretch, hold }, [foot.t, contact.force / units.force, third]);
    }
    let mut corrector = Corrector::new(world.clone(), path);
    corrector.options.max_iterations = 60;
    let report = corrector.at_pose(&mut configuration, 0.0);
    let stable = report.status.is_solved() && is_stable(&world, &path, &configuration);
    let scan = Scanner::default().scan(&world, &path, &configuration);
    let quality = Quality::new(&report, stable);
    Ok(Equilibrium { state: state(rod, &world, &path, &configuration, &scan, quality), report })
}
