//! The states of a rod past a contour at the poses of a recording.

use super::blocks::Blocks;
use super::curve::Curve;
use crate::phase::Label;
use rod_contact::{Contact, ContactKind, Follower, State, sliding_equilibrium};
use rod_contours::Composite;
use rod_core::{PhysicalRod, Pose, Reactions};
use std::ops::Range;

/// Equilibria from which a segment is followed, at most: each reaches up to where the rod snaps.
const ANCHORS: usize = 6;
/// Part of a segment in which none is tried after one has failed.
const SPREAD: usize = 16;
/// Poses on either side of the middle of a block at which its mean is taken.
const PARTS: usize = 3;
/// Most steps from block to block: as many as a dozen transitions take. Larger: more time at contours along which the rod cannot be followed.
const MOST_STEPS: u64 = 60;
/// Distance of the contacts of one state that was found in two ways, over their arc lengths: more than what solves leave.
const SAME: f64 = 1e-6;
/// Distance from a vertex, rod lengths, within which a contact may be one at the vertex: points are known to so much at the start.
pub(super) const NEAR_VERTEX: f64 = 0.02;

/// Where the clamp of a rod is, whose contacts slide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub pose: Pose,
    /// The coefficient of friction, positive where it draws the rod towards its tip.
    pub friction: f64,
}

/// A rod past a contour, both in units in which the given rod has its own length and stiffness.
pub(super) struct Forward<'a, R> {
    pub rod: &'a R,
    pub curve: &'a Curve,
    pub objects: &'a [Composite],
}

impl<R: PhysicalRod> Forward<'_, R> {
    /// The states at the places of all blocks, each segment followed from equilibria of its own to both sides. So a snap of the model at
    /// another pose than that of the recording does not spoil what comes after it. None where no branch reaches; a segment in which nothing
    /// is known of any contact has no states, nor has a block that is not `asked` for. `known` are states of a contour near by.
    pub fn states(
        &self,
        blocks: &Blocks,
        asked: &[bool],
        places: &[Place],
        known: &[Option<State>],
    ) -> Vec<Option<State>> {
        let mut found: Vec<Option<State>> = vec![None; places.len()];
        for segment in &blocks.runs(asked) {
            let mut failed = vec![false; segment.len()];
            for _ in 0..ANCHORS {
                let force = |k: &usize| blocks.blocks[*k].clamp.reactions.xy().norm();
                let open = |k: &usize| {
                    let block = &blocks.blocks[*k];
                    found[*k].is_none()
                        && !failed[k - segment.start]
                        && !(known[*k].is_none() && block.contacts.is_empty())
                };
                // the strongest force tells its contacts best
                let Some(anchor) = segment.clone().filter(open).max_by(|a, b| force(a).total_cmp(&force(b))) else {
                    break;
                };
                let local = &blocks.blocks[anchor].contacts;
                let known = known[anchor].as_ref().map(|state| &state.contacts[..]).unwrap_or_default();
                // where a hollow has gone, one contact does what several did
                let whole = resultant(known);
                let mut guesses = [known, local, whole.as_slice()].into_iter().filter(|guess| !guess.is_empty());
                let state = guesses.find_map(|guess| self.equilibrium(places[anchor], guess));
                let Some(state) = state else {
                    // what is wrong there is wrong near by
                    let near = segment.len() / SPREAD;
                    let at = anchor - segment.start;
                    failed[at.saturating_sub(near)..(at + near + 1).min(segment.len())].fill(true);
                    continue;
                };
                self.follow(&state, anchor + 1..segment.end, places, &mut found);
                self.follow(&state, (segment.start..anchor).rev(), places, &mut found);
                found[anchor] = Some(state);
            }
            self.follow_free(segment, blocks, places, &mut found);
            let is_touching = |k: &usize| !blocks.blocks[*k].contacts.is_empty() || known[*k].is_some();
            if blocks.segments.iter().any(|whole| whole.start == segment.start)
                && segment.start > 0
                && found[segment.clone()].iter().all(Option::is_none)
                && segment.clone().any(|k| is_touching(&k))
                && let Some(before) = found[segment.start - 1].clone()
            {
                let landed = self.landed(&before, segment.clone(), places);
                if let Some((k, state)) = landed {
                    self.follow(&state, k + 1..segment.end, places, &mut found);
                    found[k] = Some(state);
                }
            }
        }
        found
    }

    /// The states of a free rod, for blocks of a segment that have no contact by the local answer and to which no contact led. The recording shows no jump
    /// inside a segment: where the model jumps from a free rod to the states of a contact, the blocks on both sides count as not reached.
    fn follow_free(&self, segment: &Range<usize>, blocks: &Blocks, places: &[Place], found: &mut [Option<State>]) {
        let is_free = |k: &usize| blocks.blocks[*k].label == Label::Free;
        let (mut rest, mut beside_jumps) = (segment.clone(), Vec::new());
        while let Some(anchor) = rest.find(|k| found[*k].is_none() && is_free(k)) {
            let Some(state) = self.equilibrium(places[anchor], &[]) else { continue };
            // up to a state of a contact, and not beyond where there is none
            let is_own = |found: &[Option<State>], k: &usize| is_free(k) || found[*k].is_some();
            let after: Vec<usize> = (anchor + 1..segment.end).take_while(|k| is_own(found, k)).collect();
            let before: Vec<usize> = (segment.start..anchor).rev().take_while(|k| is_own(found, k)).collect();
            let next = self.follow(&state, after.into_iter(), places, found);
            let last = self.follow(&state, before.into_iter(), places, found);
            beside_jumps
                .extend(next.into_iter().flat_map(|k| [k - 1, k]).chain(last.into_iter().flat_map(|k| [k, k + 1])));
            found[anchor] = Some(state);
        }
        beside_jumps.into_iter().for_each(|k| found[k] = None);
    }

    /// The mean reactions over the poses `half` before to `half` after that of a state, as a block of samples has where contacts form or let go
    /// inside it. Poses beyond a jump of the rod are left out: a jump inside a block of the recording is small, or the block is not explained.
    pub fn mean_reactions(&self, state: &State, friction: f64, half: [f64; 3]) -> Reactions {
        let (Reactions { mut f0x, mut f0y, mut m0z }, mut count) = (state.reactions, 1.0);
        for sense in [-1.0, 1.0] {
            let Some(mut follower) = self.follower(state, friction) else { continue };
            for part in 1..=PARTS {
                let share = sense * (part as f64 - 0.25) / (PARTS as f64 + 0.25);
                let Pose { x, y, phi } = state.pose;
                let pose = Pose { x: x + share * half[0], y: y + share * half[1], phi: phi + share * half[2] };
                if follower.to(pose).is_err() {
                    break;
                }
                let there = follower.state().reactions;
                (f0x, f0y, m0z, count) = (f0x + there.f0x, f0y + there.f0y, m0z + there.m0z, count + 1.0);
            }
        }
        Reactions { f0x: f0x / count, f0y: f0y / count, m0z: m0z / count }
    }

    /// The equilibrium with about these contacts, if the rod can be there.
    fn equilibrium(&self, at: Place, guess: &[Contact]) -> Option<State> {
        let near = NEAR_VERTEX * self.rod.units().length;
        let guess: Vec<Contact> = guess.iter().map(|contact| self.curve.place(contact, near)).collect::<Option<_>>()?;
        let found = sliding_equilibrium(self.rod, self.objects, at.pose, &guess, at.friction).ok()?;
        found.is_admissible().ok()?;
        Some(found.state)
    }

    /// Follows the rod from a state on, up to where it jumps.
    fn follower(&self, from: &State, friction: f64) -> Option<Follower<'_, R>> {
        Some(self.jumping(from, friction)?.without_jumps())
    }

    /// The same also where it jumps.
    fn jumping(&self, from: &State, friction: f64) -> Option<Follower<'_, R>> {
        let follower = Follower::from_state(self.rod, self.objects, from).ok()?.with_most_steps(MOST_STEPS);
        follower.sliding(friction).ok()
    }

    /// Where the rod lands that jumps on its way from a state: the first block after the jump, and the state there.
    fn landed(&self, from: &State, way: Range<usize>, places: &[Place]) -> Option<(usize, State)> {
        let friction = places.get(way.start)?.friction;
        let mut follower = self.follower(from, friction)?;
        for k in way {
            let before = follower.state().clone();
            if follower.to(places[k].pose).is_err() {
                let mut jumping = self.jumping(&before, friction)?;
                jumping.to(places[k].pose).ok()?;
                return Some((k, jumping.state().clone()));
            }
        }
        None
    }

    /// Follows the rod from a state until it jumps, cannot be followed, or comes to a place whose state is known: that place if the state there is another one.
    /// Friction is the same along the way.
    pub fn follow(
        &self,
        from: &State,
        mut way: impl Iterator<Item = usize>,
        places: &[Place],
        found: &mut [Option<State>],
    ) -> Option<usize> {
        let first = way.next()?;
        let mut follower = self.follower(from, places[first].friction)?;
        for k in std::iter::once(first).chain(way) {
            let is_reached = follower.to(places[k].pose).is_ok();
            if let Some(known) = &found[k] {
                return (!is_reached || !is_same(follower.state(), known)).then_some(k);
            }
            if !is_reached {
                return None;
            }
            found[k] = Some(follower.state().clone());
        }
        None
    }
}

/// Whether two states at one pose are on one branch.
fn is_same(one: &State, other: &State) -> bool {
    let is_near = |(a, b): (&Contact, &Contact)| (a.s - b.s).hypot(a.x - b.x).hypot(a.y - b.y) < SAME * a.s.max(b.s);
    one.contacts.len() == other.contacts.len() && one.contacts.iter().zip(&other.contacts).all(is_near)
}

/// The contact that has the force and the moment of several on one side of the rod, and lies between them; none of fewer.
fn resultant(contacts: &[Contact]) -> Option<Contact> {
    let [first, .., _] = contacts else { return None };
    let force: f64 = contacts.iter().map(|contact| contact.force).sum();
    let mean =
        |of: fn(&Contact) -> f64| contacts.iter().map(|contact| contact.force * of(contact)).sum::<f64>() / force;
    let (s, x, y) = (mean(|contact| contact.s), mean(|contact| contact.x), mean(|contact| contact.y));
    Some(Contact { kind: ContactKind::Tangent, s, x, y, force, ..*first })
}
