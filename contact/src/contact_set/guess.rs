//! A contact set from contacts in SI units: those of a user's guess, or of a state.

use crate::contact_set::{ActiveContact, Configuration, tangent_hold};
use crate::error::ContactError;
use crate::scene::rod::{Walk, at_clamp, push};
use crate::scene::world::{Foot, World};
use crate::state::{Contact, ContactKind, SlipMode};
use rod_contours::StretchKind;
use rod_core::{Clamp, Hold, Pose, Reactions, RodModel, Units};
use smallvec::SmallVec;
use std::f64::consts::{PI, TAU};

/// A contact of a guess, dimensionless.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GuessedContact {
    pub stretch: usize,
    pub foot: Foot,
    pub tip: bool,
    pub s: f64,
    pub force: f64,
    /// Force along the contour and whether the rod sticks, where there is friction.
    pub friction: Option<(f64, bool)>,
}

impl GuessedContact {
    /// Its contribution to the force (A, B) of the segment before it.
    fn push(&self) -> (f64, f64) {
        push(self.force, self.friction.map_or(0.0, |(friction, _)| friction), self.foot.alpha)
    }
}

/// Largest angle, as a share of the cone of normals, by which the force of a state may point out of the cone by rounding.
const ROUNDING: f64 = 1e-6;

/// Fixed-point iterations for the base of a clamp on springs and the moment about it. Two suffice where turns and shifts are not coupled.
const GIVING_WAY: usize = 8;

type Slopes = SmallVec<[f64; 8]>;

/// The rod's slope angles at the contacts from the chords between them, where the rod turns `turns` times as far as its chord: twice,
/// if it is an arc, once, if it is straight. On a smooth contour it lies along that.
pub(crate) fn by_chords(clamp: Pose, supposed: &[GuessedContact], turns: f64) -> Slopes {
    let (mut from, mut phi) = ((clamp.x, clamp.y), clamp.phi);
    let slope = |GuessedContact { foot, tip, .. }: &GuessedContact| {
        let chord = (foot.y - from.1).atan2(foot.x - from.0);
        let turn = chord - phi;
        phi += turns * (turn - TAU * (turn / TAU).round());
        from = (foot.x, foot.y);
        if !tip {
            phi = foot.alpha + PI * ((phi - foot.alpha) / PI).round();
        }
        phi
    };
    supposed.iter().map(slope).collect()
}

/// The contacts with arc lengths that are those of the chords between them.
pub(crate) fn along_chords(clamp: Pose, supposed: &[GuessedContact]) -> SmallVec<[GuessedContact; 8]> {
    let (mut from, mut s) = ((clamp.x, clamp.y), 0.0);
    let moved = |contact: &GuessedContact| {
        s += (contact.foot.x - from.0).hypot(contact.foot.y - from.1);
        from = (contact.foot.x, contact.foot.y);
        GuessedContact { s, ..*contact }
    };
    supposed.iter().map(moved).collect()
}

/// The rod's slope angles at the contacts by the shape that the forces would give it.
pub(crate) fn by_forces(rod: &impl RodModel, clamp: &impl Clamp, supposed: &[GuessedContact]) -> Slopes {
    if let Some(mut rod) = beyond_roller(rod, clamp, supposed) {
        return supposed.iter().map(|contact| rod.to(contact.s, contact.push())).collect();
    }
    let (mut base, mut felt) = (clamp.pose(), clamp_reactions(clamp.pose(), supposed));
    if clamp.law().is_some() {
        for _ in 0..GIVING_WAY {
            base = clamp.base(&felt);
            felt = clamp_reactions(base, supposed);
        }
    }
    let mut rod = Walk::new(rod, at_clamp(base, felt.m0z), (felt.f0y, -felt.f0x));
    supposed.iter().map(|contact| rod.to(contact.s, contact.push())).collect()
}

/// The rod from the roller of its clamp on, under the forces. None without a roller, or where the roller does not hold the rod.
fn beyond_roller<'a, M: RodModel>(rod: &'a M, clamp: &impl Clamp, supposed: &[GuessedContact]) -> Option<Walk<'a, M>> {
    let roller = clamp.roller()?;
    let [x, y] = roller.point(clamp.pose());
    let Reactions { f0x, f0y, m0z } = clamp_reactions(Pose { x, y, phi: 0.0 }, supposed);
    let hold = roller.under(rod, clamp.pose(), -m0z, f0y, -f0x)?;
    Some(Walk::beyond(rod, hold.s, hold.at, (f0y, -f0x)))
}

/// The reactions of the clamp to the forces, with its moment about the base.
fn clamp_reactions(base: Pose, supposed: &[GuessedContact]) -> Reactions {
    let [mut a, mut b, mut m0z] = [0.0; 3];
    for contact in supposed {
        let (foot, (own_a, own_b)) = (&contact.foot, contact.push());
        a += own_a;
        b += own_b;
        m0z += (foot.x - base.x) * own_a + (foot.y - base.y) * own_b;
    }
    Reactions { f0x: -b, f0y: a, m0z }
}

/// The configuration of guessed contacts at which the rod has the slope angles `slopes`.
pub(crate) fn configuration_of_guess(supposed: &[GuessedContact], slopes: &[f64]) -> Configuration {
    let mut configuration = Configuration::free(0.0);
    for (j, (GuessedContact { stretch, foot, tip, s, force, .. }, phi)) in supposed.iter().zip(slopes).enumerate() {
        let (hold, third) = if *tip { (Hold::Tip, *phi) } else { (tangent_hold(phi - foot.alpha), *s) };
        configuration.insert(j, ActiveContact::smooth(*stretch, hold), [foot.t, *force, third]);
    }
    // behind all others, as their unknowns are
    for (j, contact) in supposed.iter().enumerate() {
        if let Some((friction, sticks)) = contact.friction {
            configuration.rub(j, friction, sticks);
        }
    }
    configuration
}

/// The contacts of a guess on the contours, dimensionless.
pub(crate) fn contacts_of_guess(
    world: &World<'_>,
    units: Units,
    guess: &[Contact],
) -> Result<SmallVec<[GuessedContact; 8]>, ContactError> {
    let mut supposed: SmallVec<[GuessedContact; 8]> = SmallVec::new();
    for (index, contact) in guess.iter().enumerate() {
        let wrong = |reason| Err(ContactError::Guess { index, reason });
        if ![contact.s, contact.x, contact.y, contact.force].iter().all(|v| v.is_finite()) {
            return wrong("its numbers are not finite");
        }
        if supposed.last().is_some_and(|before| before.tip) {
            return wrong("it follows a contact at the tip, expected that to be the last");
        }
        let wanted = match contact.kind {
            ContactKind::Tangent | ContactKind::Tip => StretchKind::Piece(contact.piece),
            ContactKind::Corner => StretchKind::Corner { before: contact.piece },
            ContactKind::Notch => StretchKind::Notch { before: contact.piece },
        };
        let Some(stretch) = world.find(contact.object, wanted) else {
            return wrong(match contact.kind {
                ContactKind::Tangent | ContactKind::Tip => "there is no such object, or it has no such piece",
                ContactKind::Corner => "there is no such object, or no corner after that piece of it",
                ContactKind::Notch => "there is no such object, or no notch after that piece of it",
            });
        };
        let mut foot = world.foot(stretch, contact.x / units.length, contact.y / units.length);
        turn_on_joint(world, stretch, &mut foot, contact.alpha);
        let tip = matches!(contact.kind, ContactKind::Tip | ContactKind::Notch);
        let s = if tip { 1.0 } else { contact.s / units.length };
        let friction = contact.friction.map(|f| (f.force / units.force, f.mode == SlipMode::Stick));
        if friction.is_some_and(|(force, _)| !force.is_finite()) {
            return wrong("its friction is not finite");
        }
        supposed.push(GuessedContact { stretch, foot, tip, s, force: contact.force / units.force, friction });
    }
    Ok(supposed)
}

/// On a vertex all parameters are the same point. The direction of the force, if it is within the cone of the normals, gives the parameter.
fn turn_on_joint(world: &World<'_>, stretch: usize, foot: &mut Foot, alpha: f64) {
    if !(world.is_corner(stretch) || world.is_notch(stretch)) {
        return;
    }
    let [from, to] = [false, true].map(|upper| world.border(stretch, upper));
    let [first, last] = [from, to].map(|t| world.support(stretch, t).alpha);
    let off = alpha - 0.5 * (first + last);
    let alpha = alpha - TAU * (off / TAU).round();
    let share = (alpha - first) / (last - first);
    if (-ROUNDING..=1.0 + ROUNDING).contains(&share) {
        foot.t = from + (to - from) * share;
        foot.alpha = alpha;
    }
}
