//! The first equilibrium: free, or brought into contact from where the rod is free.

use super::{Sweep, rest};
use crate::contact_set::Configuration;
use crate::continuation::step::{Point, Seen, Stepper};
use crate::error::StopReason;
use crate::gap::scan::Scan;
use crate::path::ClampPath;
use crate::snap::chain::Chain;
use std::f64::consts::PI;

/// Bends (rad over the length) given to a straight rod that is let go into contact, tried in order. Without a bend the chain
/// does not buckle; its sign decides to which side.
const BENDS: [f64; 4] = [0.05, -0.05, 0.5, -0.5];
/// Range and step of the search for a free pose behind a start in contact, in the path parameter: lengths of the rod, or
/// radians of a path that only turns.
const BACK: (f64, f64) = (4.0, 0.05);

impl Sweep<'_> {
    /// The first point: free, or brought into contact along the path, or else by another way.
    pub(super) fn start(&mut self) -> Result<Point, StopReason> {
        if let Some(start) = self.free(0.0) {
            return Ok(self.at_rest(start));
        }
        if self.scan_straight(0.0).clamp_inside {
            return Err(StopReason::ClampInside);
        }
        let ways = self.setup().path.to_its_start();
        let brought = ways.into_iter().find_map(|way| self.brought_by(way));
        let brought = brought.map(|start| self.stepper.look(start));
        let start = brought.or_else(|| self.let_go()).ok_or(StopReason::NoStart)?;
        let start = self.stepper.point(start);
        if start.scan.is_outside() { Ok(start) } else { Err(StopReason::NoStart) }
    }

    /// The rod in the first pose, come there on a path that goes through that pose at 0: swept in silence from where,
    /// further back, it is free.
    fn brought_by(&mut self, way: ClampPath) -> Option<Configuration> {
        let farthest = if way.turns_only() { PI } else { BACK.0 };
        let tries = (farthest / BACK.1) as usize;
        let mut silent = Self::from_setup(self.setup().along(way), self.stepper.steps_left, f64::INFINITY, 0);
        let start = (1..=tries).find_map(|k| silent.free(-BACK.1 * k as f64))?;
        let mut point = Box::new(silent.at_rest(start));
        let brought = loop {
            if point.configuration.tau() >= 0.0 {
                break Some(point.configuration);
            }
            match silent.stepper.step(&point, 0.0).and_then(|step| silent.arrive(step)) {
                Ok(next) => point = next,
                Err(_) => break None,
            }
            silent.pending.clear();
        };
        self.stepper.steps_left = silent.stepper.steps_left;
        brought
    }

    /// The straight rod at a pose, if it touches nothing there.
    pub(super) fn free(&mut self, tau: f64) -> Option<Configuration> {
        let scan = self.scan_straight(tau);
        scan.is_outside().then(|| Configuration::free(tau))
    }

    /// A look at the straight rod where it has not come from elsewhere: all that is behind an open contour is solid.
    fn scan_straight(&mut self, tau: f64) -> Scan {
        let filled = self.setup().filled();
        self.stepper.scanner.scan(&filled, &Configuration::free(tau))
    }

    /// The straight rod let go in the first pose.
    fn let_go(&mut self) -> Option<Seen> {
        let Stepper { corrector, scanner, .. } = &mut self.stepper;
        BENDS.into_iter().find_map(|bend| {
            rest(&mut Chain::straight(corrector.setup.path.at(0.0), bend), corrector, scanner, 0.0, |_| true)
        })
    }
}
