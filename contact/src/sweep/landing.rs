//! A snap: the equilibrium ends, and the rod slips or jumps to another one.

use super::{AT_END, Sweep};
use crate::contact_set::Configuration;
use crate::contact_set::edit::{across_corner, beyond_corner, off_corner};
use crate::continuation::inflection::is_at_inflection;
use crate::continuation::step::{FIRST_STEP, Point, Seen, Stepper};
use crate::error::StopReason;
use crate::event::EventKind;
use crate::friction::{UNLOADED, smooth};
use crate::gap::GAP_TOLERANCE;
use crate::scene::setup::Setup;
use crate::scene::world::World;
use crate::snap::chain::Chain;
use crate::snap::settle::{rest, settle};
use rod_core::{Grip, PhysicalRod, Pose};

/// Distances (path parameter) beyond a fold at which the descent starts, tried in order. The chain has its own fold, up to the
/// square of a link's length away, and must be beyond it. A longer distance may miss an equilibrium that ends soon.
const KICK: [f64; 4] = [2e-3, 8e-3, 2e-2, 5e-2];
/// The same beyond the first touch of a free rod along a straight edge, which has no isolated solution.
const TOUCH_KICK: [f64; 2] = [1e-4, 5e-4];
/// Bend (rad over the length) given to a straight rod that is met head-on: without one the chain does not buckle.
const BEND: f64 = 0.05;
/// Longest and shortest way (L) of a tip that slips over a corner. A longer way is reported as a snap; a shorter one would lead
/// back at once.
const FARTHEST_SLIP: f64 = 0.05;
const SHORTEST_SLIP: f64 = 1e-9;

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The equilibrium ends in `last`: the rod jumps to where the descent of its energy leads.
    pub(super) fn snap(&mut self, last: Seen) -> Result<Point, StopReason> {
        // the descent and the solves about it know no friction
        let (here, rubbing) = (&smooth(&last.configuration), &last.configuration.clone());
        let tau = here.tau();
        if let Some(landed) = self.slip(here) {
            return Ok(self.landed(EventKind::SlipOver, last, landed));
        }
        let mut beyond = None;
        // a free rod has no fold to get over
        let kicks = TOUCH_KICK.into_iter().filter(|_| here.count() == 0).chain(KICK);
        for kick in kicks {
            // from inside an object the descent leads anywhere
            if self.is_clamp_inside(tau + kick) {
                continue;
            }
            let Landed { at_pose, ahead } = self.land(here, tau, kick);
            // a free rod that touches something and stays free has gone past it
            let elsewhere = |landed: &Seen| here.count() + landed.configuration.count() > 0;
            // one that does not hold further on would only lead back
            if let Some(landed) = at_pose.filter(elsewhere).and_then(|landed| self.goes_on_landed(landed, rubbing)) {
                return Ok(self.jumped(last, landed));
            }
            beyond = beyond.or(ahead.filter(elsewhere));
        }
        let follows = !self.setup().world.rubs();
        let behind = if follows { self.behind_next_fold(here) } else { None };
        if let Some(landed) = behind.and_then(|landed| self.goes_on(landed)) {
            return Ok(self.jumped(last, landed));
        }
        // Where the new branch starts only just beyond the fold, it is entered there. And a rod that does not come to
        // rest in the descent, but could be free, will be.
        let landed = beyond.or_else(|| self.free(tau).filter(|_| here.count() > 0).map(|free| self.stepper.look(free)));
        if let Some(landed) = landed {
            let end = self.setup().path.length();
            let is_beyond = landed.configuration.tau() > end + AT_END && tau <= end;
            let back = if is_beyond { self.back_to_end(&landed.configuration) } else { None };
            let landed = back.unwrap_or(landed);
            let held_back = if follows { None } else { self.goes_on_landed(landed.clone(), rubbing) };
            let landed = held_back.unwrap_or_else(|| self.stepper.point(landed));
            return Ok(self.jumped(last, landed));
        }
        if let Some(landed) = self.slip_off(here) {
            return Ok(self.landed(EventKind::SlipOver, last, landed));
        }
        if let Some(landed) = self.slide_over(here) {
            return Ok(self.jumped(last, landed));
        }
        self.reached = tau;
        Err(if is_at_inflection(&self.setup().world, here) {
            StopReason::LineContact
        } else if last.scan.is_by_an_end() {
            StopReason::EndOfContour
        } else {
            StopReason::NoLanding
        })
    }

    /// The tip, come to a convex corner, slips over it and rests on the piece beyond: where the turn is small a short jump,
    /// which needs no descent to find.
    fn slip(&mut self, last: &Configuration) -> Option<Point> {
        let guess = beyond_corner(last.clone(), &self.setup().world)?;
        self.slipped(last, guess)
    }

    /// A corner slips off the tip, which rests on a piece beside it: where the descent, whose links are longer than such a slip,
    /// comes to no rest.
    fn slip_off(&mut self, last: &Configuration) -> Option<Point> {
        off_corner(last, &self.setup().world).into_iter().find_map(|guess| self.slipped(last, guess))
    }

    /// The tip, come to a convex corner, slides over it until the rod lies on the corner: where the descent comes to no rest.
    fn slide_over(&mut self, last: &Configuration) -> Option<Point> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let guess = across_corner(last.clone(), &corrector.setup.world)?;
        let landed = settle(corrector, scanner, guess)?;
        if same(&corrector.setup.world, &landed.configuration, last) {
            return None;
        }
        self.goes_on(landed)
    }

    /// The equilibrium by `guess`, if it is a slip away from `last`.
    fn slipped(&mut self, last: &Configuration, guess: Configuration) -> Option<Point> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let here = last.contacts.last()?.stretch;
        let landed = settle(corrector, scanner, guess)?;
        let rubs = corrector.setup.world.rubs();
        let Seen { configuration, .. } = &landed;
        let n = configuration.count();
        let tip = n.checked_sub(1).filter(|_| configuration.ends_at_tip() && n == last.count())?;
        let (world, there) = (&corrector.setup.world, configuration.contacts[tip].stretch);
        let from = world.support(here, last.t(last.count() - 1));
        let to = world.support(there, configuration.t(tip));
        // no way at all would be back at once
        let way = (to.x - from.x).hypot(to.y - from.y);
        let slips = there != here && (SHORTEST_SLIP..FARTHEST_SLIP).contains(&way);
        if slips && rubs {
            return self.goes_on_landed(landed, last);
        }
        slips.then(|| self.stepper.point(landed))
    }

    /// Whether the clamp is inside an object at `tau`.
    fn is_clamp_inside(&self, tau: f64) -> bool {
        let Setup { world, path, .. } = self.setup();
        let Pose { x, y, .. } = path.at(tau);
        let mut inside = false;
        world.objects_at(x, y, |object| inside |= world.is_inside(object, x, y, GAP_TOLERANCE));
        inside
    }

    fn jumped(&mut self, last: Seen, landed: Point) -> Point {
        let before = &last.configuration;
        let bears = (0..before.count()).any(|j| before.force(j) > UNLOADED);
        let kind = match (before.count(), landed.configuration.count()) {
            (0, _) => EventKind::FirstContact,
            // with friction its contact may come to rest at the very pose where it ends
            (_, 0) if !bears => EventKind::Release,
            (_, 0) => EventKind::SnapOff,
            _ => EventKind::Snap,
        };
        self.landed(kind, last, landed)
    }

    fn landed(&mut self, kind: EventKind, last: Seen, landed: Point) -> Point {
        let before = self.stepper.point(last);
        self.announce(kind, &before, &landed);
        self.stepper.h = FIRST_STEP;
        landed
    }

    /// Where the rod lands from `last`, whose clamp is at `tau`: found `kick` beyond, and brought back to `tau` if it
    /// can be.
    fn land(&mut self, last: &Configuration, tau: f64, kick: f64) -> Landed {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let mut chain = Chain::of(&corrector.setup, last, tau + kick);
        // head-on, a straight rod gives to either side
        chain.bend_if_straight(BEND);
        let ahead = rest(&mut chain, corrector, scanner, tau + kick, |_, _| true);
        let elsewhere = |world: &World<'_>, found: &Seen| !same(world, &found.configuration, last);
        let back = ahead.as_ref().and_then(|ahead| {
            let mut back = ahead.configuration.clone();
            back.set_tau(tau);
            settle(corrector, scanner, back).filter(|found| elsewhere(&corrector.setup.world, found))
        });
        let at_pose = back.or_else(|| {
            chain.clamp = corrector.setup.path.at(tau);
            rest(&mut chain, corrector, scanner, tau, elsewhere)
        });
        Landed { at_pose, ahead }
    }
}

/// Where a rod lands: at the pose where its equilibrium ended, and a little further along the path.
struct Landed {
    at_pose: Option<Seen>,
    ahead: Option<Seen>,
}

/// Change of an unknown, relative to 1 + its size, up to which two configurations are one.
const SAME: f64 = 1e-4;

/// Whether two configurations at one pose are the same equilibrium: the parameters of a closed curve may differ by rounds.
pub(super) fn same(world: &World<'_>, a: &Configuration, b: &Configuration) -> bool {
    let near = |u: f64, v: f64| (u - v).abs() < SAME * (1.0 + v.abs());
    let alike = |j: usize| {
        let (one, other) = (&a.contacts[j], &b.contacts[j]);
        let [p, q] = [(a, one), (b, other)].map(|(set, held)| world.support(held.stretch, set.t(j)));
        let grips = match (one.grip, other.grip) {
            (Grip::Sticks { .. }, Grip::Sticks { .. }) => true,
            (one, other) => one == other,
        };
        one.stretch == other.stretch && a.is_tip(j) == b.is_tip(j) && grips && near(p.x, q.x) && near(p.y, q.y)
            // on a joint the parameter is the direction of the force
            && (p.speed != 0.0 || near(a.t(j), b.t(j)))
    };
    let is_parameter = |i: &usize| i.is_multiple_of(3) && *i < 3 * a.count();
    a.count() == b.count()
        && (0..a.count()).all(alike)
        && (0..a.z.len()).filter(|i| !is_parameter(i)).all(|i| near(a.z[i], b.z[i]))
}
