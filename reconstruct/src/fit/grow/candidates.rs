//! Contours that may explain blocks.

use super::window::{Tried, Window};
use super::{Curve, Grown, Growth, Node, WINDOW};
use crate::fit::pair::with_tip;
use crate::fit::propose::{TIP_BENDS, joined, with_other_ends};
use crate::numeric::wrap_angle;
use nalgebra::Vector2;
use rod_contact::{Contact, ContactKind};
use rod_core::{PhysicalRod, Reactions};
use std::ops::Range;

/// Distance (rod lengths) and angle (radians) up to which a contact may be one of the contour that is there.
const CLOSE: f64 = 0.015;
const CLOSE_TURN: f64 = 0.5;
/// Places along a segment of which nothing is explained where its contacts are looked for, as shares of it; arc lengths that are tried there.
const PLACES: [f64; 3] = [0.5, 0.2, 0.8];
const ARC_LENGTHS: usize = 48;
/// Most contacts of which some are tried where others have been: the number of choices doubles with each.
const MOST_REMEMBERED: usize = 4;

impl<R: PhysicalRod> Growth<'_, '_, R> {
    /// Contour beyond an explained block, which explains the blocks next to it, up to the end of a run.
    pub fn beyond(&self, now: &Grown, k: usize, end: usize, is_forwards: bool) -> Option<Tried> {
        let state = now.states[k].as_ref()?;
        let range = if is_forwards { k..end.min(k + WINDOW) } else { end.max((k + 1).saturating_sub(WINDOW))..k + 1 };
        let mut window = self.window(range.clone());
        window.states[k - range.start] = Some(state.clone());
        let touched = self.touched(now);
        let held = held(now, &touched);
        let (space, shape) = (self.space(), state.elastica(self.fit.rod).ok()?);
        let with = |chain: Vec<Node>| [now.chains.as_slice(), &[chain]].concat();
        let contours = std::iter::once(now.chains.clone())
            .chain(space.on_rod(&shape).into_iter().map(with))
            .chain(joined(&now.chains, &touched, self.length))
            .chain(with_other_ends(&now.chains, &touched, self.length));
        let tried = |chains: Vec<Vec<Node>>| Some((self.tried(&chains, &window, &held, 0)?.cost, chains, &window));
        self.best_of(now, contours.filter_map(tried).collect(), &held, end)
    }

    /// Contacts for a run of blocks with contour that is there: some of those that the rod has before the run, or after it.
    pub fn remembered(&self, now: &Grown, good: &[bool], run: &Range<usize>) -> Option<Tried> {
        let held = held(now, &self.touched(now));
        let known = |k: &usize| now.states[*k].as_ref().filter(|state| good[*k] && !state.contacts.is_empty());
        let before = (0..run.start).rev().find_map(|k| known(&k));
        let after = (run.end..good.len()).find_map(|k| known(&k));
        let mut windows: Vec<Window> = Vec::new();
        for state in [before, after].into_iter().flatten() {
            let contacts = &state.contacts[..state.contacts.len().min(MOST_REMEMBERED)];
            for range in
                [run.start..run.end.min(run.start + WINDOW), run.start.max(run.end.saturating_sub(WINDOW))..run.end]
            {
                let mut is_counted = range.clone().filter(|k| !self.fit.blocks.blocks[*k].is_left_out);
                let at = if range.start == run.start { is_counted.next() } else { is_counted.next_back() };
                let Some(at) = at else { continue };
                for some in 1..1_usize << contacts.len() {
                    let mut window = self.window(range.clone());
                    let is_one = |(i, _): &(usize, &Contact)| some >> i & 1 == 1;
                    window.blocks.blocks[at - range.start].contacts =
                        contacts.iter().enumerate().filter(is_one).map(|(_, contact)| *contact).collect();
                    windows.push(window);
                }
            }
        }
        let tried = |window: &Window| Some((self.tried(&now.chains, window, &held, 0)?.cost, now.chains.clone()));
        let found = windows.iter().filter_map(|window| tried(window).map(|(cost, chains)| (cost, chains, window)));
        self.best_of(now, found.collect(), &held, run.end)
    }

    /// Contacts, and contour where there is none for them, for a run of blocks beside which nothing is explained.
    pub fn seeded(&self, now: &Grown, run: &Range<usize>) -> Option<Tried> {
        let (rod, units) = (self.fit.rod, self.fit.rod.units());
        let held = held(now, &self.touched(now));
        let (curve, space) = (Curve::through(&now.chains)?, self.space());
        let corrected = self.fit.corrected(&self.sources.known)?;
        let mut windows: Vec<Window> = Vec::new();
        for share in PLACES {
            let k = run.start + ((run.len() - 1) as f64 * share) as usize;
            let range = k.saturating_sub(WINDOW / 2).max(run.start)..(k + WINDOW / 2).min(run.end);
            let (pose, r) = (corrected[k].pose, corrected[k].reactions);
            let reactions = Reactions { f0x: r.x * units.force, f0y: r.y * units.force, m0z: r.z * units.moment };
            let local = Some(&self.fit.blocks.blocks[k].contacts).filter(|contacts| !contacts.is_empty()).cloned();
            let arc_lengths = (1..ARC_LENGTHS).map(|i| self.length * i as f64 / ARC_LENGTHS as f64);
            let pairs = arc_lengths.filter_map(|s| with_tip(rod, pose, reactions, s).map(Vec::from));
            windows.extend(local.into_iter().chain(pairs).map(|contacts| {
                let mut window = self.window(range.clone());
                window.blocks.blocks[k - range.start].contacts = contacts;
                window
            }));
        }
        let mut found = Vec::new();
        for (window, bend) in windows.iter().flat_map(|window| TIP_BENDS.map(|bend| (window, bend))) {
            let contacts = window.blocks.blocks.iter().flat_map(|block| &block.contacts);
            let new = contacts.filter(|contact| !self.is_there(&curve, contact)).map(|contact| {
                let bend = if contact.kind == ContactKind::Tip { bend } else { bend.max(TIP_BENDS[1]) };
                space.through(Vector2::new(contact.x, contact.y), contact.alpha, bend)
            });
            let chains: Vec<Vec<Node>> = now.chains.iter().cloned().chain(new).collect();
            if let Some(tried) = self.tried(&chains, window, &held, 0) {
                found.push((tried.cost, chains, window));
            }
        }
        self.best_of(now, found, &held, run.end)
    }

    /// Whether a contact may be one of the contour that is there.
    fn is_there(&self, curve: &Curve, contact: &Contact) -> bool {
        curve.place(contact, 0.0).is_some_and(|place| {
            let way = (place.x - contact.x).hypot(place.y - contact.y);
            way < CLOSE * self.length && wrap_angle(place.alpha - contact.alpha).abs() < CLOSE_TURN
        })
    }
}

/// Places of the contour that are touched.
fn held(now: &Grown, touched: &[Vec<bool>]) -> Vec<Vector2<f64>> {
    let nodes = now.chains.iter().flatten().zip(touched.iter().flatten());
    nodes.filter(|(_, is_touched)| **is_touched).map(|(node, _)| node.at).collect()
}
