//! Contour where the recording asks for some and there is none.
//!
//! Where a run of explained blocks ends, either a new contact begins somewhere along the rod, or the contour goes on in another direction than was
//! guessed. The shape of the rod is known there, so a new contact has few unknowns. Each such contour is tried on the next blocks. The best
//! are fitted to these, and one that explains them is followed to the end of the run. It is kept only if the cost of the whole recording falls.

use super::blocks::Blocks;
use super::curve::{Curve, Node};
use super::pair::with_tip;
use super::problem::{Explained, Fit, Sources, cost_of};
use super::propose::{NEW, Space, TIP_BENDS, joined, onwards, with_other_ends};
use super::swept::Swept;
use super::trim::{touched, trimmed};
use crate::least_squares::{Damped, iterate};
use crate::numeric::wrap_angle;
use crate::systematic::Errors;
use nalgebra::Vector2;
use rod_contact::{Contact, ContactKind, State};
use rod_core::{PhysicalRod, Reactions};
use std::cell::Cell;
use std::ops::Range;

/// Most runs for which contour is looked for at a time.
const RUNS: usize = 8;
/// Blocks on which new contour is tried, and from one such window to the next: their ratio.
const WINDOW: usize = 12;
const WIDER: f64 = 1.7;
/// Mean square of residuals up to which blocks are explained, and up to which no other contour is tried.
const GOOD: f64 = 3.0;
const WELL: f64 = 1.3;
/// Sum of the squares of the residuals of a block that is explained, at most.
const OUTLIER: f64 = 30.0;
/// Sum of the squares of the residuals that a block counts with which is not reached.
const MISSED: f64 = 368.0;
/// Blocks to either side of one over which that mean is taken.
const NEAR: usize = 2;
/// Standard deviation of what is known of the contour while new contour is fitted to a window, rod lengths.
const HELD: f64 = 1e-4;
/// How many of the contours that were tried are fitted, with at most so many steps; and steps for a wider window.
const FITTED: usize = 4;
const STEPS: usize = 20;
const STEPS_ON: usize = 15;
/// Relative decrease of the cost at which these fits have settled.
const SETTLED: f64 = 1e-3;
/// Least share of an evaluation of the whole recording that a window takes: the contour is made anew, and its equilibrium looked for.
const LEAST: f64 = 0.05;
/// Distance (rod lengths) and angle (radians) up to which a contact may be one of the contour that is there.
const CLOSE: f64 = 0.015;
const CLOSE_TURN: f64 = 0.5;
/// Places along a segment of which nothing is explained where its contacts are looked for, as shares of it; arc lengths that are tried there.
const PLACES: [f64; 3] = [0.5, 0.2, 0.8];
const ARC_LENGTHS: usize = 48;
/// Cost up to which a contour may lose by being trimmed: what noise does to some blocks.
const TRIMMED: f64 = 20.0;
/// Nodes by which an end that is touched goes on, each turned by so much (radians) towards the solid.
const END: usize = 4;
const END_TURN: f64 = 0.1;

/// A contour, and the states of the rod past it, as far as they are known.
#[derive(Clone)]
pub(super) struct Grown {
    pub chains: Vec<Vec<Node>>,
    pub states: Vec<Option<State>>,
}

/// Blocks on which contour is tried, and the states that are known there.
#[derive(Clone)]
struct Window {
    range: Range<usize>,
    blocks: Blocks,
    states: Vec<Option<State>>,
}

/// What a contour makes of a window.
struct Tried {
    /// Of the blocks alone.
    cost: f64,
    /// Mean square of the residuals; a block that is not reached counts much.
    mean: f64,
    chains: Vec<Vec<Node>>,
    /// With the states that were found.
    window: Window,
}

struct Growth<'a, 'b, R> {
    fit: &'b Fit<'a, R>,
    /// The errors as they are.
    sources: Sources,
    length: f64,
    swept: Swept,
    /// Evaluations of the model at all poses that this took.
    evaluations: Cell<f64>,
}

/// A contour that explains more of a recording than `curve`, of which the fit has the states; none if none is found. And the number of evaluations
/// of the model that this took.
pub(super) fn grown<R: PhysicalRod>(
    fit: &Fit<'_, R>,
    errors: Errors,
    curve: &Curve,
    explained: &Explained,
) -> (Option<Grown>, usize) {
    let mut now = Grown { chains: curve.nodes_of_chains(), states: fit.states.clone() };
    let mut growth = Growth {
        fit,
        sources: Sources { known: errors, ..Sources::default() },
        length: fit.rod.units().length,
        swept: Swept::default(),
        evaluations: Cell::new(0.0),
    };
    growth.swept = growth.swept_by(&now);
    let mut cost = growth.cost(&now);
    let mut is_new = false;
    if let Some(chains) = trimmed(&now.chains, &growth.touched(&now), &growth.swept, growth.length) {
        let shorter = Grown { chains, ..now.clone() };
        let of_shorter = growth.cost(&shorter);
        if of_shorter < cost + TRIMMED {
            is_new = of_shorter < cost;
            (now, cost) = (shorter, of_shorter);
        }
    }
    let mut good: Vec<bool> = (0..fit.blocks.blocks.len()).map(|k| is_good(k, fit.blocks, explained)).collect();
    let mut seen: Vec<Range<usize>> = Vec::new();
    for _ in 0..RUNS {
        let Some((run, segment)) = longest_run(fit.blocks, &good, &seen) else { break };
        seen.push(run.clone());
        if let Some((found, part, less)) = growth.explaining(&now, cost, &good, &run, &segment) {
            good[part].fill(true);
            (now, cost, is_new) = (found, less, true);
        }
    }
    (is_new.then_some(now), growth.evaluations.get().ceil() as usize)
}

/// Whether a block is explained, together with those around it.
fn is_good(k: usize, blocks: &Blocks, explained: &Explained) -> bool {
    let segment = blocks.segment_of(k);
    let near = k.saturating_sub(NEAR).max(segment.start)..(k + NEAR + 1).min(segment.end);
    let squares: Vec<f64> = near.filter_map(|j| Some(explained.residuals[j]?.norm_squared())).collect();
    let is_own = blocks.blocks[k].is_left_out || explained.residuals[k].is_some_and(|r| r.norm_squared() < OUTLIER);
    is_own && !squares.is_empty() && squares.iter().sum::<f64>() < 3.0 * GOOD * squares.len() as f64
}

/// The longest run of blocks that are not explained, with its segment, but for those that were seen.
fn longest_run(blocks: &Blocks, good: &[bool], seen: &[Range<usize>]) -> Option<(Range<usize>, Range<usize>)> {
    let mut runs: Vec<(Range<usize>, Range<usize>)> = Vec::new();
    for segment in &blocks.segments {
        let mut first = segment.start;
        while first < segment.end {
            let end = (first..segment.end).find(|k| good[*k] != good[first]).unwrap_or(segment.end);
            let counted = (first..end).filter(|k| !blocks.blocks[*k].is_left_out).count();
            if !good[first] && counted > 1 && !seen.contains(&(first..end)) {
                runs.push((first..end, segment.clone()));
            }
            first = end;
        }
    }
    runs.into_iter().max_by_key(|(run, _)| run.len())
}

impl<R: PhysicalRod> Growth<'_, '_, R> {
    fn touched(&self, now: &Grown) -> Vec<Vec<bool>> {
        touched(&now.chains, &now.states, self.length)
    }

    /// Where the rod was: by states, and where there is none, by the local answer.
    fn swept_by(&self, now: &Grown) -> Swept {
        let mut others = self.fit.blocks.clone();
        for (block, _) in others.blocks.iter_mut().zip(&now.states).filter(|(_, state)| state.is_some()) {
            block.contacts.clear();
        }
        let states = Swept::of_states(self.fit.rod, now.states.iter().flatten());
        states.and(Swept::of(self.fit.rod, &others, &self.sources.known))
    }

    fn space(&self) -> Space<'_> {
        Space { length: self.length, swept: &self.swept }
    }

    /// Some blocks, of which nothing is known.
    fn window(&self, range: Range<usize>) -> Window {
        let mut blocks = self.fit.blocks.blocks[range.clone()].to_vec();
        blocks.iter_mut().for_each(|block| block.contacts.clear());
        let states = vec![None; blocks.len()];
        let segments = std::iter::once(0..blocks.len()).collect();
        let blocks = Blocks { blocks, segments, frame: self.fit.blocks.frame, ringing: 0 };
        Window { range, blocks, states }
    }

    /// What a contour makes of a window; after so many steps of its fit, in which nodes at the places `held` stay.
    fn tried(&self, chains: &[Vec<Node>], window: &Window, held: &[Vector2<f64>], steps: usize) -> Option<Tried> {
        let mut nodes = chains.to_vec();
        for node in nodes.iter_mut().flatten().filter(|node| held.contains(&node.at)) {
            node.sigma = HELD * self.length;
        }
        let curve = Curve::through(&nodes)?;
        let mut x = curve.offsets.clone();
        let mut fit = Fit::new(self.fit.rod, curve, &window.blocks, &self.sources);
        fit.states.clone_from(&window.states);
        // new contour may bend more than what is known
        fit.bend = fit.bend.max(self.fit.bend);
        if steps > 0 {
            x = iterate(&mut fit, x, Damped::until(SETTLED), steps).0.x;
        }
        let model = fit.model(&x)?;
        let explained = fit.explained(&model);
        let share = window.range.len() as f64 / self.fit.blocks.blocks.len() as f64;
        self.evaluations.set(self.evaluations.get() + share.max(LEAST) * (fit.evaluations + 1) as f64);
        let counted = explained.residuals.iter().zip(&window.blocks.blocks).filter(|(_, block)| !block.is_left_out);
        let squares: Vec<Option<f64>> = counted.map(|(residual, _)| residual.map(|r| r.norm_squared())).collect();
        let cost = squares.iter().map(|square| cost_of(square.map(f64::sqrt))).sum();
        let mean =
            squares.iter().map(|square| square.unwrap_or(MISSED)).sum::<f64>() / (3 * squares.len().max(1)) as f64;
        let mut moved = model.curve.nodes_of_chains();
        for (node, given) in moved.iter_mut().flatten().zip(chains.iter().flatten()) {
            node.sigma = given.sigma;
        }
        let chains = moved;
        Some(Tried { cost, mean, chains, window: Window { states: model.states, ..window.clone() } })
    }

    /// What a contour costs along the whole recording.
    fn cost(&self, now: &Grown) -> f64 {
        let range = 0..self.fit.blocks.blocks.len();
        let whole = Window { range, blocks: self.fit.blocks.clone(), states: now.states.clone() };
        self.tried(&now.chains, &whole, &[], 0).map_or(f64::INFINITY, |tried| tried.cost)
    }

    /// With contour that explains a part of a run, if that costs less than before: that contour, the part and the cost.
    fn explaining(
        &self,
        now: &Grown,
        cost: f64,
        good: &[bool],
        run: &Range<usize>,
        segment: &Range<usize>,
    ) -> Option<(Grown, Range<usize>, f64)> {
        let known = |k: &usize| good[*k] && now.states[*k].as_ref().is_some_and(|state| !state.contacts.is_empty());
        // the blocks next to the run may be half explained
        let before = (run.start >= segment.start + NEAR).then(|| run.start - NEAR).filter(known);
        let after = (run.end + NEAR <= segment.end).then(|| run.end + NEAR - 1).filter(known);
        let is_less = |found: &Tried| self.cost(&now.with(found)) < cost;
        let forwards = || self.beyond(now, before?, run.end, true).filter(is_less);
        let backwards = || self.beyond(now, after?, run.start, false).filter(is_less);
        let seeded = || {
            let is_alone = before.is_none() && after.is_none();
            is_alone.then(|| self.seeded(now, run))?.filter(is_less)
        };
        let start = forwards().or_else(backwards).or_else(seeded)?;
        let found = self.continued(self.continued(start, run.end, true), run.start, false);
        let (part, found) = (found.window.range.clone(), now.with(&found));
        let less = self.cost(&found);
        (less < cost).then_some((found, part, less))
    }

    /// Contour beyond an explained block, which explains the blocks next to it, up to the end of a run.
    fn beyond(&self, now: &Grown, k: usize, end: usize, is_forwards: bool) -> Option<Tried> {
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
        self.best_of(contours.filter_map(tried).collect(), &held)
    }

    /// Contacts, and contour where there is none for them, for a run of blocks beside which nothing is explained.
    fn seeded(&self, now: &Grown, run: &Range<usize>) -> Option<Tried> {
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
        self.best_of(found, &held)
    }

    /// Whether a contact may be one of the contour that is there.
    fn is_there(&self, curve: &Curve, contact: &Contact) -> bool {
        curve.place(contact, 0.0).is_some_and(|place| {
            let way = (place.x - contact.x).hypot(place.y - contact.y);
            way < CLOSE * self.length && wrap_angle(place.alpha - contact.alpha).abs() < CLOSE_TURN
        })
    }

    /// The best of some contours after a fit to their windows, if it explains its own.
    fn best_of(&self, mut found: Vec<(f64, Vec<Vec<Node>>, &Window)>, held: &[Vector2<f64>]) -> Option<Tried> {
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<Tried> = None;
        for (_, chains, window) in found.into_iter().take(FITTED) {
            let Some(tried) = self.tried(&chains, window, held, STEPS) else { continue };
            if best.as_ref().is_none_or(|best| tried.mean < best.mean) {
                best = Some(tried);
            }
            if best.as_ref().is_some_and(|best| best.mean < WELL) {
                break;
            }
        }
        best.filter(|best| best.mean < GOOD)
    }

    /// From a window that is explained on towards the end of its run.
    fn continued(&self, mut at: Tried, end: usize, is_forwards: bool) -> Tried {
        loop {
            let Range { start, end: stop } = at.window.range;
            let width = ((stop - start) as f64 * WIDER) as usize;
            let range = if is_forwards {
                start..end.min(start + width).max(stop)
            } else {
                end.max(stop.saturating_sub(width)).min(start)..stop
            };
            if range == at.window.range {
                return at;
            }
            let mut window = self.window(range.clone());
            for (k, state) in at.window.range.clone().zip(&at.window.states) {
                window.states[k - range.start].clone_from(state);
            }
            match self.tried(&self.with_ends(&at), &window, &[], STEPS_ON) {
                Some(wider) if wider.mean < GOOD => at = wider,
                _ => return at,
            }
        }
    }

    /// The contour of a window, which goes on beyond ends that are touched.
    fn with_ends(&self, at: &Tried) -> Vec<Vec<Node>> {
        let touched = touched(&at.chains, &at.window.states, self.length);
        let more =
            |from: Vector2<f64>, at: Vector2<f64>, turn: f64| onwards(at, at - from, turn, END, NEW * self.length);
        let with_ends = |(chain, touched): (&Vec<Node>, &Vec<bool>)| {
            let (mut all, last) = (Vec::new(), chain.len() - 1);
            // the second node from an end: its interval is one of the last two
            if touched[1.min(last)] {
                all = more(chain[1].at, chain[0].at, -END_TURN);
                all.reverse();
            }
            all.extend_from_slice(chain);
            if touched[last - 1] {
                all.extend(more(chain[last - 1].at, chain[last].at, END_TURN));
            }
            all
        };
        at.chains.iter().zip(&touched).map(with_ends).collect()
    }
}

impl Grown {
    /// With the contour of a window, and its states there.
    fn with(&self, found: &Tried) -> Self {
        let mut states = self.states.clone();
        states[found.window.range.clone()].clone_from_slice(&found.window.states);
        Self { chains: found.chains.clone(), states }
    }
}

/// Places of the contour that are touched.
fn held(now: &Grown, touched: &[Vec<bool>]) -> Vec<Vector2<f64>> {
    let nodes = now.chains.iter().flatten().zip(touched.iter().flatten());
    nodes.filter(|(_, is_touched)| **is_touched).map(|(node, _)| node.at).collect()
}
