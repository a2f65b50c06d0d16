//! A snap: the equilibrium ends, and the rod slips or jumps to another one.

use super::Sweep;
use crate::contact_set::edit::{across_corner, beyond_borders, beyond_corner, off_corner};
use crate::contact_set::{ActiveContact, Configuration, Unknown};
use crate::continuation::branch::Corrector;
use crate::continuation::certify::energy;
use crate::continuation::inflection::is_at_inflection;
use crate::continuation::stepper::Stepper;
use crate::continuation::transition::solve_fixed;
use crate::continuation::{Point, Seen};
use crate::error::StopReason;
use crate::event::EventKind;
use crate::friction::{UNLOADED, without_unloaded};
use crate::gap::{GAP_TOLERANCE, Scanner};
use crate::limits::LIMITS;
use crate::path::ClampPath;
use crate::scene::Setup;
use crate::scene::rod::Segment;
use crate::scene::world::World;
use crate::snap::chain::Chain;
use crate::snap::{settle, settle_chain};
use crate::stability::clearance;
use rod_core::{PhysicalRod, Pose};
use smallvec::SmallVec;

/// An equilibrium that has ended, and its energy (J).
pub(super) struct EndedBranch {
    pub seen: Seen,
    pub energy: f64,
}

/// Where a rod lands: at the pose where its equilibrium ended, and a little further along the path.
struct Landing {
    at_pose: Option<Seen>,
    ahead: Option<Seen>,
}

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The point where the rod lands after its equilibrium has ended in `last`. The candidates are tried in the order of `docs/sweep.md`, section 7;
    /// one with more energy than `last` is refused.
    pub(super) fn snap(&mut self, last: Seen) -> Result<Point, StopReason> {
        let last = self.end_with_energy(last);
        // the descent and the solves about it know no friction
        let here = &without_friction(&last.seen.configuration);
        if let Some(lighter) = self.let_go_of_unloaded(&last.seen.configuration) {
            return Ok(self.report_landing(EventKind::Release, last, lighter));
        }
        // the links of the descent are longer than a slip over a corner
        if let Some(landed) = self.slip(here, &last).or_else(|| self.slip_off(here, &last)) {
            return Ok(self.report_landing(EventKind::SlipOver, last, landed));
        }
        if self.ends_at_jump && here.count() > 0 {
            self.reached = here.tau();
            return Err(StopReason::Jump);
        }
        if let Some(landed) = self.buckle(here, &last).or_else(|| self.descend(here, &last)) {
            return Ok(if here.count() == 0 {
                self.land_at_first_contact(last, landed)
            } else {
                self.land_after_jump(last, landed)
            });
        }
        if let Some(landed) = self.slide_over(here, &last) {
            return Ok(self.land_after_jump(last, landed));
        }
        self.reached = here.tau();
        Err(if is_at_inflection(&self.setup().world, here) || self.is_along(here) {
            StopReason::LineContact
        } else if last.seen.scan.is_by_an_end() {
            StopReason::EndOfContour
        } else {
            StopReason::NoLanding
        })
    }

    /// The landing of a straight rod that is pushed along its axis: just behind the pose, where it has buckled. At the pose itself the branches of
    /// the straight and of the buckled rod cross, and rounding decides to which of them a solution belongs and where its tangent leads.
    fn buckle(&mut self, here: &Configuration, last: &EndedBranch) -> Option<Point> {
        if !self.is_column(here, last.energy) {
            return None;
        }
        LIMITS.snap.ahead.into_iter().find_map(|kick| {
            let Stepper { corrector, scanner, .. } = &mut self.stepper;
            let mut near = descent(corrector, scanner, here, kick).1?.configuration;
            near.set_tau(here.tau() + LIMITS.probe.way);
            let landed = settle(corrector, scanner, near)?;
            let pushed = self.end_with_clamp_work(last, &landed.configuration);
            let buckled = !self.is_column(&landed.configuration, energy(self.setup(), &landed.configuration));
            if buckled { self.continue_from_landing(landed, &pushed) } else { None }
        })
    }

    /// Whether a rod with this energy (J) bears a force at its tip without being bent: a force f across it has an energy of f^2 / 6.
    fn is_column(&self, configuration: &Configuration, energy: f64) -> bool {
        let bears =
            configuration.count() == 1 && configuration.is_tip(0) && configuration.force(0) > LIMITS.snap.flat_force;
        bears && energy < LIMITS.snap.energy_rounding * self.setup().rod.units().energy
    }

    /// The landing by descent of the energy from `here`, which is `last` without friction, and by what is found beside the descent.
    fn descend(&mut self, here: &Configuration, last: &EndedBranch) -> Option<Point> {
        let (tau, is_free) = (here.tau(), here.count() == 0);
        // a free rod has no fold to get over
        let kicks = LIMITS.snap.ahead_of_touch.into_iter().filter(|_| is_free).chain(LIMITS.snap.ahead);
        let mut beyond: SmallVec<[Seen; 4]> = SmallVec::new();
        for kick in kicks {
            // from inside an object the descent leads anywhere
            if self.is_clamp_inside(tau + kick) {
                continue;
            }
            let Landing { at_pose, ahead } = self.landing(here, tau, kick);
            if is_free {
                // one that touches something and stays free has gone past it
                let mut found = at_pose.into_iter().chain(ahead).filter(|landed| landed.configuration.count() > 0);
                let met = found.find_map(|landed| {
                    let ahead = landed.configuration;
                    self.first_touch(&ahead, (tau, kick)).or_else(|| self.flat_touch(ahead, tau))
                });
                if met.is_some() {
                    return met;
                }
                continue;
            }
            // one that does not hold further on would only lead back
            if let Some(landed) = at_pose.and_then(|landed| self.continue_from_landing(landed, last)) {
                return Some(landed);
            }
            beyond.extend(ahead);
        }
        if !self.setup().world.rubs()
            && let Some(landed) =
                self.behind_next_fold(here).and_then(|landed| self.continue_from_landing(landed, last))
        {
            return Some(landed);
        }
        // what was found further on is brought back; not on the way back itself
        let is_silent = self.is_silent;
        for ahead in beyond.iter().filter(|_| !is_silent) {
            let back = self
                .bring_back(&ahead.configuration, tau)
                .filter(|back| !back.configuration.is_same_equilibrium(here, &self.setup().world));
            if let Some(landed) = back.and_then(|landed| self.continue_from_landing(landed, last)) {
                return Some(landed);
            }
        }
        // where the new branch begins only just beyond, it is entered there
        for ahead in beyond {
            let pushed = self.end_with_clamp_work(last, &ahead.configuration);
            if let Some(landed) = self.continue_from_landing(ahead, &pushed) {
                return Some(landed);
            }
        }
        // a rod that does not come to rest in the descent, but could be free, will be
        let free = self.free_configuration(tau).filter(|_| !is_free).map(|free| self.stepper.look(free));
        free.and_then(|free| self.continue_from_landing(free, last))
    }

    /// The point where a free rod, found in contact within `kick` of `tau`, touches first: one contact, without force.
    fn first_touch(&mut self, found: &Configuration, (tau, kick): (f64, f64)) -> Option<Point> {
        let touch = |j: usize| {
            let mut alone = Configuration::free(found.tau());
            let unknowns = [found.t(j), found.force(j), found.get(Unknown::ArcLength(j))];
            alone.insert(0, ActiveContact::smooth(found.contacts[j].stretch, found.contacts[j].hold), unknowns);
            let at = solve_fixed(&mut self.stepper.corrector, alone, Unknown::Force(0), 0.0).ok()?;
            (tau - LIMITS.transition.touch_slack..=tau + kick).contains(&at.tau()).then_some(at)
        };
        let touched = (0..found.count()).filter_map(touch).min_by(|a, b| a.tau().total_cmp(&b.tau()))?;
        let seen = self.stepper.look(touched);
        if !seen.scan.is_outside() {
            return None;
        }
        self.continue_from(seen).ok().flatten()
    }

    /// The touch of a free rod by a contour without curvature there, which has no isolated solution: the contact, found further on, is followed
    /// back until its force is of the order of rounding.
    fn flat_touch(&mut self, near: Configuration, tau: f64) -> Option<Point> {
        let (mut way, mut followed) = (near.tau() - tau, vec![near]);
        while way > LIMITS.snap.flat_way {
            way *= 0.1;
            let mut nearer = followed[followed.len() - 1].clone();
            nearer.set_tau(tau + way);
            let Stepper { corrector, scanner, .. } = &mut self.stepper;
            match settle(corrector, scanner, nearer).filter(|nearer| nearer.configuration.count() > 0) {
                Some(nearer) => followed.push(nearer.configuration),
                None => break,
            }
        }
        // a rod that is met head-on bears its buckling load from the start: it is taken where it has buckled
        if followed
            .last()
            .is_some_and(|nearest| (0..nearest.count()).any(|j| nearest.force(j) > LIMITS.snap.flat_force))
        {
            followed.truncate(1);
        }
        followed.into_iter().rev().find_map(|near| {
            let seen = self.stepper.look(near);
            self.continue_from(seen).ok().flatten()
        })
    }

    /// The free rod has come to a first contact: reports it.
    fn land_at_first_contact(&mut self, last: EndedBranch, touching: Point) -> Point {
        let there = self.stepper.look(Configuration::free(touching.configuration.tau()));
        // a rod that is met head-on buckles: in contact it is only further on
        let free = if there.scan.is_outside() { self.end_with_energy(there) } else { last };
        self.report_landing(EventKind::FirstContact, free, touching)
    }

    /// Whether the rod is as curved as the contour at a contact, and touches it along a line.
    fn is_along(&self, last: &Configuration) -> bool {
        let segments = last.segments(self.setup());
        (0..last.count()).any(|j| clearance(self.setup(), last, &segments, j) < LIMITS.snap.flat_clearance)
    }

    /// The same equilibrium without its unloaded contacts. It is needed where one contact ends while another comes to the border of its piece, as
    /// when a rod comes to lie flat on an edge.
    fn let_go_of_unloaded(&mut self, last: &Configuration) -> Option<Point> {
        let lighter = without_unloaded(last).filter(|lighter| lighter.count() > 0)?;
        let passed = beyond_borders(&lighter, &self.setup().world);
        [lighter].into_iter().chain(passed).find_map(|lighter| {
            let seen = self.stepper.look(lighter);
            if seen.scan.is_outside() { self.continue_from(seen).ok().flatten() } else { None }
        })
    }

    /// The tip, come to a convex corner, slips over it and rests on the piece beyond: where the turn is small a short jump,
    /// which needs no descent to find.
    fn slip(&mut self, here: &Configuration, last: &EndedBranch) -> Option<Point> {
        let guess = beyond_corner(here.clone(), &self.setup().world)?;
        self.slip_to(here, last, guess)
    }

    /// A corner slips off the tip, which rests on a piece beside it.
    fn slip_off(&mut self, here: &Configuration, last: &EndedBranch) -> Option<Point> {
        off_corner(here, &self.setup().world).into_iter().find_map(|guess| self.slip_to(here, last, guess))
    }

    /// The tip, come to a convex corner, slides over it until the rod lies on the corner: where the descent comes to no rest.
    fn slide_over(&mut self, here: &Configuration, last: &EndedBranch) -> Option<Point> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let guess = across_corner(here.clone(), &corrector.setup.world)?;
        let landed = settle(corrector, scanner, guess)?;
        if landed.configuration.is_same_equilibrium(here, &corrector.setup.world) {
            return None;
        }
        self.continue_from_landing(landed, last)
    }

    /// The equilibrium near `guess`, if the tip has slipped there from `here`, which is `last` without friction.
    fn slip_to(&mut self, here: &Configuration, last: &EndedBranch, guess: Configuration) -> Option<Point> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let piece = here.contacts.last()?.stretch;
        let landed = settle(corrector, scanner, guess)?;
        let rubs = corrector.setup.world.rubs();
        let Seen { configuration, .. } = &landed;
        let n = configuration.count();
        let tip = n.checked_sub(1).filter(|_| configuration.ends_at_tip() && n == here.count())?;
        let (world, there) = (&corrector.setup.world, configuration.contacts[tip].stretch);
        let from = world.support(piece, here.t(here.count() - 1));
        let to = world.support(there, configuration.t(tip));
        // no way at all would be back at once
        let way = (to.x - from.x).hypot(to.y - from.y);
        if there == piece || !(LIMITS.snap.shortest_slip..LIMITS.snap.farthest_slip).contains(&way) {
            return None;
        }
        if rubs {
            return self.continue_from_landing(landed, last);
        }
        let landed = self.stepper.point(landed);
        self.if_energy_falls(last.energy, Some(landed))
    }

    /// Whether the clamp is inside an object at `tau`.
    fn is_clamp_inside(&self, tau: f64) -> bool {
        let Setup { world, path, .. } = self.setup();
        let Pose { x, y, .. } = path.at(tau);
        let mut inside = false;
        world.objects_at(x, y, |object| inside |= world.is_inside(object, x, y, GAP_TOLERANCE));
        inside
    }

    /// The rod has jumped from `last` to `landed`: reports the event by its contacts before and after.
    fn land_after_jump(&mut self, last: EndedBranch, landed: Point) -> Point {
        let before = &last.seen.configuration;
        let bears = (0..before.count()).any(|j| before.force(j) > UNLOADED);
        let kind = match (before.count(), landed.configuration.count()) {
            // with friction its contact may come to rest at the very pose where it ends
            (_, 0) if !bears => EventKind::Release,
            (_, 0) => EventKind::SnapOff,
            _ => EventKind::Snap,
        };
        self.report_landing(kind, last, landed)
    }

    /// Reports the event from `last` to `landed`. The new branch begins with the first step.
    fn report_landing(&mut self, kind: EventKind, last: EndedBranch, landed: Point) -> Point {
        let before = self.stepper.point(last.seen);
        self.announce(kind, &before, &landed);
        self.stepper.h = LIMITS.step.first;
        landed
    }

    /// Where the rod lands from `last`, whose clamp is at `tau`: found `kick` beyond, and brought back to `tau` if it
    /// can be.
    fn landing(&mut self, last: &Configuration, tau: f64, kick: f64) -> Landing {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let (mut chain, ahead) = descent(corrector, scanner, last, kick);
        let elsewhere = |world: &World<'_>, found: &Seen| !found.configuration.is_same_equilibrium(last, world);
        let back = ahead.as_ref().and_then(|ahead| {
            let mut back = ahead.configuration.clone();
            back.set_tau(tau);
            settle(corrector, scanner, back).filter(|found| elsewhere(&corrector.setup.world, found))
        });
        let at_pose = back.or_else(|| {
            chain.clamp = corrector.setup.path.at(tau);
            settle_chain(&mut chain, corrector, scanner, tau, elsewhere)
        });
        Landing { at_pose, ahead }
    }

    /// An equilibrium without friction, found further along the path, swept back to `tau`. None where the sweep does not arrive there.
    pub(super) fn bring_back(&mut self, ahead: &Configuration, tau: f64) -> Option<Seen> {
        let path = &self.setup().path;
        let way = ClampPath::between(path.at(ahead.tau()), path.at(tau))?;
        let (mut start, end) = (ahead.clone(), way.length());
        start.set_tau(0.0);
        let setup = self.setup().along(way).without_friction();
        let mut there = self.lead_to(setup, start, end).filter(|there| there.tau() <= end + LIMITS.sweep.at_end)?;
        there.set_tau(tau);
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        settle(corrector, scanner, there)
    }
}

/// The first law at a pose: the clamp does no work and friction dissipates, so that no transition gains energy.
impl<R: PhysicalRod> Sweep<'_, R> {
    /// An equilibrium that has ended, with its energy.
    pub(super) fn end_with_energy(&self, seen: Seen) -> EndedBranch {
        let energy = energy(self.setup(), &seen.configuration);
        EndedBranch { seen, energy }
    }

    /// The same with the energy that is available further on: that of `last` plus the largest work of the clamp on its way to `ahead`, if its
    /// reactions on the way are between those at both ends.
    pub(super) fn end_with_clamp_work(&self, last: &EndedBranch, ahead: &Configuration) -> EndedBranch {
        let (setup, from) = (self.setup(), &last.seen.configuration);
        let [a, b] = [from.tau(), ahead.tau()].map(|tau| setup.path.at(tau));
        let work = [from, ahead].map(|configuration| {
            let Segment { start, a: along, b: across, .. } = configuration.segments(setup)[0];
            // f0x = -B, f0y = A, m0z = -M
            across * (a.x - b.x) + along * (b.y - a.y) + start.moment * (a.phi - b.phi)
        });
        let most = work[0].max(work[1]).max(0.0) * setup.rod.units().energy;
        EndedBranch { seen: last.seen.clone(), energy: last.energy + most }
    }

    /// Whether a rod with the energy `before` (J) may come to another equilibrium by itself: the energy of rod and clamp only falls.
    pub(super) fn may_fall(&self, before: f64, after: &Configuration) -> bool {
        let unit = self.setup().rod.units().energy;
        energy(self.setup(), after) <= before + LIMITS.snap.energy_rounding * (unit + before)
    }

    /// A point, if a rod with this energy may come to it.
    pub(super) fn if_energy_falls(&self, before: f64, point: Option<Point>) -> Option<Point> {
        point.filter(|point| self.may_fall(before, &point.configuration))
    }
}

/// The chain that has come to rest from `last` with its clamp moved on by `kick`, and the equilibrium next to it.
fn descent<R: PhysicalRod>(
    corrector: &mut Corrector<'_, R>,
    scanner: &mut Scanner,
    last: &Configuration,
    kick: f64,
) -> (Chain, Option<Seen>) {
    let tau = last.tau() + kick;
    let mut chain = Chain::of(&corrector.setup, last, tau);
    // head-on, a straight rod gives to either side
    chain.bend_if_straight(LIMITS.snap.bend);
    let ahead = settle_chain(&mut chain, corrector, scanner, tau, |_, _| true);
    (chain, ahead)
}

/// The same contacts without a force along the contour. The coefficients of friction of the objects stay.
pub(super) fn without_friction(configuration: &Configuration) -> Configuration {
    let mut without = configuration.clone();
    for j in 0..without.count() {
        without.set_slipping(j, 0.0);
    }
    without
}
