//! The first equilibrium: the free rod, the one that a sweep along the path brings there, or the one of least energy that is reached.

use super::Sweep;
use super::outcome::{Approach, Start, StartCandidate};
use crate::contact_set::Configuration;
use crate::continuation::certify::energy;
use crate::continuation::stepper::Stepper;
use crate::continuation::{Point, Step};
use crate::error::StopReason;
use crate::gap::Scan;
use crate::limits::LIMITS;
use crate::path::ClampPath;
use crate::phase::Phase;
use crate::scene::Setup;
use crate::snap::chain::Chain;
use crate::snap::settle_chain;
use rod_core::PhysicalRod;
use std::f64::consts::PI;

/// The approaches by the ways to the start of a path.
const APPROACHES: [Approach; 5] =
    [Approach::AlongPath, Approach::TurningIn, Approach::TurningIn, Approach::MovingIn, Approach::MovingIn];

/// An equilibrium in the first pose.
struct Candidate {
    approach: Approach,
    configuration: Configuration,
    /// J.
    energy: f64,
}

impl<R: PhysicalRod> Sweep<'_, R> {
    /// The first point, and, as for [`resume`](Self::resume), the step that ends the branch there at once, if it does.
    pub(super) fn find_start(&mut self) -> Result<(Point, Option<Step>), StopReason> {
        if let Some(start) = self.free_configuration(0.0) {
            self.start = Some(Start::Free);
            return Ok((self.point_of(start), None));
        }
        if self.scan_free(0.0).clamp_inside {
            return Err(StopReason::ClampInside);
        }
        let (mut found, mut has_come) = (Vec::new(), false);
        for (approach, way) in APPROACHES.into_iter().zip(self.setup().path.to_its_start()) {
            if let Some((way, brought)) = self.bring_along(way) {
                self.keep_candidate(&mut found, approach, Some(brought));
                has_come |= approach == Approach::AlongPath && way <= LIMITS.start.own_path && !found.is_empty();
            }
        }
        let let_go = LIMITS.start.bends.map(|bend| self.let_go(bend));
        // what lies behind an open contour has not come there by bending
        for let_go in let_go.iter().flatten().filter(|let_go| self.is_before(let_go)).cloned().collect::<Vec<_>>() {
            self.keep_candidate(&mut found, Approach::LettingGo, Some(let_go));
        }
        if found.is_empty() {
            self.keep_candidate(&mut found, Approach::LettingGo, let_go.into_iter().flatten().next());
        }
        let best = if has_come { 0 } else { least_energy(&found).ok_or(StopReason::NoStart)? };
        let best = found.remove(best);
        found.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        found.insert(0, best);
        self.start = Some(Start::InContact(found.iter().map(Candidate::start_candidate).collect()));
        let start = found.swap_remove(0).configuration;
        // it may have come there another way than it goes on
        if self.setup().world.rubs() {
            return self.resume_rubbing(start);
        }
        Ok((self.point_of(start), None))
    }

    /// Keeps the equilibrium that an approach has reached, if it is outside of all objects and not known yet.
    fn keep_candidate(&mut self, found: &mut Vec<Candidate>, approach: Approach, reached: Option<Configuration>) {
        let Some(configuration) = reached else { return };
        let known =
            found.iter().any(|known| known.configuration.is_same_equilibrium(&configuration, &self.setup().world));
        if known || !self.stepper.look(configuration.clone()).scan.is_outside() {
            return;
        }
        let energy = energy(self.setup(), &configuration);
        found.push(Candidate { approach, configuration, energy });
    }

    /// The rod brought to the first pose along `way`, which goes through this pose at 0, from the nearest free pose further back; and the distance
    /// of that pose.
    fn bring_along(&mut self, way: ClampPath) -> Option<(f64, Configuration)> {
        let farthest = if way.turns_only() { PI } else { LIMITS.start.farthest_back };
        let tries = (farthest / LIMITS.start.step_back) as usize;
        let mut free = Self::from_setup(self.setup().along(way), 0, f64::INFINITY, 0);
        let back = (1..=tries).find_map(|k| free.free_configuration(-LIMITS.start.step_back * k as f64))?;
        let way = ClampPath::between(way.at(back.tau()), way.at(0.0))?;
        let end = way.length();
        let mut brought = self
            .lead_to(self.setup().along(way), Configuration::free(0.0), end)
            .filter(|brought| brought.tau() <= end + LIMITS.sweep.at_end)?;
        brought.set_tau(0.0);
        // the pose is the same but for rounding
        let mut exact = brought.clone();
        let solved = exact.count() > 0 && self.stepper.corrector.at_pose(&mut exact, 0.0).status.is_solved();
        Some((-back.tau(), if solved { exact } else { brought }))
    }

    /// The free rod at a pose, if it touches nothing there.
    pub(super) fn free_configuration(&mut self, tau: f64) -> Option<Configuration> {
        let scan = self.scan_free(tau);
        scan.is_outside().then(|| Configuration::free(tau))
    }

    /// The scan of the free rod. All that is behind an open contour counts as solid, because the rod has not come from there.
    fn scan_free(&mut self, tau: f64) -> Scan {
        let filled = self.setup().with_filled_objects();
        self.stepper.scanner.scan(&filled, &Configuration::free(tau))
    }

    /// Whether no part of the rod lies behind an open contour.
    fn is_before(&mut self, configuration: &Configuration) -> bool {
        let filled = self.setup().with_filled_objects();
        self.stepper.scanner.scan(&filled, configuration).is_outside()
    }

    /// The free rod let go in the first pose.
    fn let_go(&mut self, bend: f64) -> Option<Configuration> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        let mut chain = Chain::at_rest(corrector.setup.rod.model(), &corrector.setup.clamp(0.0), bend);
        settle_chain(&mut chain, corrector, scanner, 0.0, |_, _| true).map(|seen| seen.configuration)
    }

    /// The equilibrium at `end` of the path of `setup`, swept to from `start`, an equilibrium on this path. A `start` without contacts is the free
    /// rod.
    pub(super) fn lead_to(&mut self, setup: Setup<'_, R>, start: Configuration, end: f64) -> Option<Configuration> {
        let mut silent = Sweep::from_setup(setup, self.stepper.steps_left, f64::INFINITY, 0);
        silent.is_silent = true;
        let mut point = Box::new(silent.point_of(start));
        let led = loop {
            if point.configuration.tau() >= end {
                break Some(point.configuration);
            }
            match silent.stepper.step(&point, end).and_then(|step| silent.arrive(step)) {
                Ok(next) => point = next,
                Err(_) => break None,
            }
            silent.pending.clear();
        };
        self.stepper.steps_left = silent.stepper.steps_left;
        led
    }
}

impl Candidate {
    fn start_candidate(&self) -> StartCandidate {
        let Self { approach, configuration, energy } = self;
        let phase = Phase { contacts: configuration.count(), tip: configuration.ends_at_tip() };
        StartCandidate { approach: *approach, phase, energy: *energy }
    }
}

/// The candidate of least energy.
fn least_energy(found: &[Candidate]) -> Option<usize> {
    let lower = |best: usize, k: usize| found[k].energy < found[best].energy * (1.0 - LIMITS.start.same_energy);
    (0..found.len()).reduce(|best, k| if lower(best, k) { k } else { best })
}
