//! The best contour and errors from a start on.

use super::blocks::{Block, Blocks, Part};
use super::curve::{Curve, Node};
use super::finer::finer;
use super::flatten::flattened;
use super::grow::{Grown, grown};
use super::posterior::{Posterior, log_choices};
use super::prior::Prior;
use super::problem::{Explained, Fit, FreeError, Model, Sources};
use super::propose::{dulled, joined, sharpened, without_part};
use super::simple::{Best, SimpleShape};
use super::start::Start;
use super::trim::touched;
use super::verdict::{Goodness, MOST_UNREACHED};
use super::{ContourFit, FittedBlock, FittedObject, Knowledge};
use crate::least_squares::{Damped, Iterate, iterate};
use crate::phase::Label;
use crate::systematic::Source;
use nalgebra::{DMatrix, DVector, Vector3};
use rod_contact::State;
use rod_core::{PhysicalRod, Rod, Sample};
use std::cmp::Ordering;
use std::ops::Range;

/// Most changes of a contour, one after the other.
const CHANGES: usize = 10;
/// The part of the evaluations that are left which is kept for the starts after this one: half of them.
const KEPT: usize = 2;
/// Decrease of the cost, which is that of chi squared, for which a finer contour is taken. Smaller: nodes for noise.
const WORTH: f64 = 5.0;
/// The same of the evidence of a contour that explains its recording: what the iterations leave.
const LEAST: f64 = 0.1;
/// Most contours that are tried at a time of which a hollow is straight, a vertex is a bend, and of each other kind. Larger: more time.
const HOLLOWS: usize = 6;
const VERTICES: usize = 12;
const OTHERS: usize = 3;
/// Ratio of standard deviations of changes of curvature below which a straighter contour is tried.
const STRAIGHTER: f64 = 0.7;
/// Ratio of the costs after and before up to which a contour that was changed is worth more than a rough fit; the same by difference of the evidence, of one
/// that explains its recording. Larger: more time.
const HOPEFUL: f64 = 2.0;
const ROUGH: f64 = 30.0;
/// Chi squared per degree of freedom of a rough fit up to which it may soon explain the recording.
const NEAR: f64 = 1.5;
/// Smallest and largest standard deviation of the change of curvature, L^-1.5: a contour of the size of a hundred rods, and a vertex at each point.
const BENDS: (f64, f64) = (1.0, 1e3);

/// The search for the contour of a recording, from several starts.
pub(super) struct Search<'a, R> {
    pub rod: &'a R,
    pub sources: &'a Sources,
    /// Errors at the start less what is known of them, in standard deviations of their budget.
    pub errors: &'a DVector<f64>,
    /// Evaluations that are left.
    pub evaluations: usize,
}

impl<'a, R: PhysicalRod> Search<'a, R> {
    /// The fit at the contour of a start.
    pub fn begun(&mut self, start: &'a Start) -> Option<Begun<'a, R>> {
        let length = self.rod.units().length;
        let scaled = |chain: &Vec<Node>| chain.iter().map(|node| node.scaled(length)).collect();
        let curve = Curve::through(&start.chains.iter().map(scaled).collect::<Vec<_>>())?;
        let mut fit = Fit::new(self.rod, curve, &start.blocks, self.sources);
        fit.asked.clone_from(&start.asked);
        let solved = self.solved(&mut fit, self.errors, ROUGHLY)?;
        Some(Begun { fit, solved })
    }

    /// The better fit that more evaluations give, from the contour and the states of one that was found; perhaps with other errors.
    pub fn resumed(&mut self, best: &Solved, blocks: &'a Blocks) -> Option<Solved> {
        self.continued(&best.curve, best, blocks).filter(|found| found.preferred(best).is_lt())
    }

    /// The fit from a contour near that of a fit which was found, whose states are taken over.
    pub fn continued(&mut self, curve: &Curve, near: &Solved, blocks: &'a Blocks) -> Option<Solved> {
        let mut fit = self.near(curve, near, blocks);
        let again = self.solved(&mut fit, self.errors, ROUGHLY)?;
        Some(self.improved(&mut fit, again))
    }

    /// The same of a contour whose nodes stay.
    pub fn unchanged(&mut self, curve: &Curve, near: &Solved, blocks: &'a Blocks) -> Option<Solved> {
        self.solved(&mut self.near(curve, near, blocks), self.errors, WELL)
    }

    /// The problem at a contour near that of a fit which was found, whose states are taken over.
    fn near(&self, curve: &Curve, near: &Solved, blocks: &'a Blocks) -> Fit<'a, R> {
        let mut fit = Fit::new(self.rod, curve.clone(), blocks, self.sources);
        (fit.states, fit.bend) = (near.states.clone(), near.bend);
        fit.asked.clone_from(&near.asked);
        fit
    }

    /// The fit at contours that are changed as long as that makes it better.
    fn improved(&mut self, fit: &mut Fit<'_, R>, mut best: Solved) -> Solved {
        // what is far off is changed before it is known well
        let mut is_rough = true;
        let mut changes = 0;
        while changes < CHANGES {
            let asked = fit.count_asked();
            if is_rough && best.is_near_where_asked() {
                best = self.refined(fit, &best).unwrap_or(best);
                is_rough = false;
            }
            match self.changed(&best, fit) {
                Some(solved) => {
                    // as long as more is explained, it goes on
                    changes += usize::from(fit.count_asked() <= asked);
                    (is_rough, best) = (!solved.is_near_where_asked(), solved);
                }
                None if is_rough && self.evaluations > 0 => {
                    best = self.refined(fit, &best).unwrap_or(best);
                    is_rough = false;
                }
                None => break,
            }
        }
        best
    }

    /// The first change that makes a fit better; roughly, where it is still far off. The fit is left as it is if none does.
    fn changed(&mut self, best: &Solved, fit: &mut Fit<'_, R>) -> Option<Solved> {
        let (bend, errors) = (fit.bend, best.errors());
        for change in Change::of(best) {
            if self.evaluations == 0 {
                break;
            }
            (fit.curve, fit.states, fit.asked) = (best.curve.clone(), best.states.clone(), best.asked.clone());
            fit.bend = bend;
            for (curve, states, asked, bend) in self.change(*change, best, fit) {
                (fit.curve, fit.states, fit.bend, fit.asked) = (curve, states, bend, asked);
                let rough = self.solved(fit, &errors, ROUGHLY).filter(|rough| rough.is_hopeful(best));
                let found =
                    rough.and_then(
                        |rough| if rough.is_near_where_asked() { self.refined(fit, &rough) } else { Some(rough) },
                    );
                if let Some(found) = found.filter(|found| found.is_worth(*change, best)) {
                    return Some(found);
                }
            }
        }
        (fit.curve, fit.states, fit.bend) = (best.curve.clone(), best.states.clone(), bend);
        fit.asked.clone_from(&best.asked);
        None
    }

    /// Improves a fit that has begun, and keeps it if it is to be preferred to the best one.
    pub fn improve(&mut self, begun: Begun<'a, R>, best: &mut Option<(Solved, &'a Blocks)>) {
        // what one start takes is not left for the others; one that grows takes all
        let kept = if begun.fit.asked.contains(&false) { 0 } else { self.evaluations / KEPT };
        self.evaluations -= kept;
        let Begun { mut fit, solved } = begun;
        let blocks = fit.blocks;
        let mut found = self.improved(&mut fit, solved);
        let is_cut_short = self.evaluations == 0;
        self.evaluations += kept;
        if found.goodness.explains && is_cut_short {
            // no other start is needed
            found = self.improved(&mut fit, found);
        }
        if best.as_ref().is_none_or(|best| found.preferred(&best.0).is_lt()) {
            *best = Some((found, blocks));
        }
    }

    /// The fit from one that is known roughly.
    fn refined(&mut self, fit: &mut Fit<'_, R>, rough: &Solved) -> Option<Solved> {
        fit.curve = rough.curve.clone();
        self.solved(fit, &rough.errors(), WELL)
    }

    fn solved(&mut self, fit: &mut Fit<'_, R>, errors: &DVector<f64>, effort: Effort) -> Option<Solved> {
        let solved = solve(fit, errors, effort);
        self.evaluations = self.evaluations.saturating_sub(std::mem::take(&mut fit.evaluations));
        solved
    }

    /// Contours that a change gives, with states of a contour near by, for a fit that has the contour and the states of `best`.
    fn change(&mut self, change: Change, best: &Solved, fit: &Fit<'_, R>) -> Vec<Changed> {
        let length = self.rod.units().length;
        let with_states = |curve: Curve| (curve, best.states.clone(), best.asked.clone(), fit.bend);
        let through = |chains: Vec<Vec<Vec<Node>>>, most: usize| {
            chains.iter().take(most).filter_map(|chains| Curve::through(chains)).map(with_states).collect()
        };
        match change {
            Change::Grown => {
                let errors = self.sources.errors(best.x.iter().skip(best.curve.count()));
                let (found, evaluations) = grown(fit, errors, &best.curve);
                self.evaluations = self.evaluations.saturating_sub(evaluations);
                found
                    .and_then(|Grown { chains, states, asked }| {
                        Some((Curve::through(&chains)?, states, asked, fit.bend))
                    })
                    .into_iter()
                    .collect()
            }
            Change::Straighter if best.straightest < STRAIGHTER * best.bend => {
                let straighter = |(curve, states, asked, _)| (curve, states, asked, best.straightest);
                best.curve_anew().map(with_states).map(straighter).into_iter().collect()
            }
            Change::Straighter => Vec::new(),
            Change::Flatter => through(flattened(&best.curve, &best.states, length), HOLLOWS),
            Change::Finer => finer(&best.curve, best.seen(fit.blocks), length).map(with_states).into_iter().collect(),
            Change::Duller => through(dulled(&best.curve.nodes_of_chains()), VERTICES),
            Change::Fewer | Change::Joined | Change::Sharper => {
                let chains = best.curve.nodes_of_chains();
                let touched = touched(&chains, &best.states, length);
                let changed = match change {
                    Change::Fewer => without_part(&chains, &touched),
                    Change::Joined => joined(&chains, &touched, length),
                    _ => sharpened(&chains, &touched, length),
                };
                through(changed, OTHERS)
            }
        }
    }
}

/// A fit that has begun, and what it came to.
pub(super) struct Begun<'a, R> {
    pub fit: Fit<'a, R>,
    pub solved: Solved,
}

/// A contour, states of one near by, which blocks are to be explained, and the standard deviation of changes of curvature.
type Changed = (Curve, Vec<Option<State>>, Vec<bool>, f64);

/// What may be changed of a contour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    /// What nothing touches goes, and what explains more of the recording comes.
    Grown,
    /// No hollow is bridged by several contacts.
    Flatter,
    /// More nodes, and vertices, where the recording asks for them.
    Finer,
    /// A bend is a vertex.
    Sharper,
    /// Changes of curvature are smaller.
    Straighter,
    /// A vertex is a bend.
    Duller,
    /// A part less.
    Fewer,
    /// Two parts are one.
    Joined,
}

impl Change {
    /// Those that may make a fit better, in the order in which they are tried. A contour that explains its recording may be simpler.
    fn of(best: &Solved) -> &'static [Self] {
        const SIMPLER: [Change; 8] = [
            Change::Grown,
            Change::Fewer,
            Change::Joined,
            Change::Flatter,
            Change::Straighter,
            Change::Sharper,
            Change::Duller,
            Change::Finer,
        ];
        match (best.goodness.explains, best.explained.unreached) {
            (true, 0) => &SIMPLER[1..],
            (true, _) => &SIMPLER,
            (false, _) => &[Self::Grown, Self::Finer, Self::Flatter],
        }
    }
}

/// How well a contour is to be known.
#[derive(Clone, Copy)]
struct Effort {
    /// Relative decrease of the cost at which the iteration has settled.
    settled: f64,
    /// Most steps before the smoothness is estimated anew: the cost is not smooth everywhere.
    steps: usize,
    /// How often it is.
    estimates: usize,
}

/// As well as the choice among contours needs.
const ROUGHLY: Effort = Effort { settled: 1e-2, steps: 20, estimates: 1 };
/// To some hundredths of chi squared.
const WELL: Effort = Effort { settled: 1e-5, steps: 60, estimates: 2 };

/// A fit at one contour.
pub(super) struct Solved {
    x: DVector<f64>,
    pub curve: Curve,
    pub cost: f64,
    /// -2 times the logarithm of the evidence, but for what all contours have.
    evidence: f64,
    /// The standard deviation of changes of curvature of the greatest evidence that is not above that of the fit.
    straightest: f64,
    covariance: DMatrix<f64>,
    /// Standard deviations of the errors, in those of their budget.
    spread: Vec<f64>,
    bend: f64,
    explained: Explained,
    states: Vec<Option<State>>,
    asked: Vec<bool>,
    pub goodness: Goodness,
}

/// The best offsets and errors at the contour of `fit`, with the smoothness that the recording asks for.
fn solve<R: PhysicalRod>(fit: &mut Fit<'_, R>, errors: &DVector<f64>, effort: Effort) -> Option<Solved> {
    let (count, free) = (fit.curve.count(), errors.len());
    let mut x = DVector::zeros(count + free);
    x.rows_mut(0, count).copy_from(&fit.curve.offsets);
    x.rows_mut(count, free).copy_from(errors);
    let bends = [BENDS.0, BENDS.1].map(|bend| bend * fit.rod.units().length.powf(-1.5));
    for _ in 0..effort.estimates {
        fit.least = f64::INFINITY;
        let (at, _) = iterate(fit, x.clone(), Damped::until(effort.settled), effort.steps);
        x = at.x;
        if let Some(covariance) = at.equations.covariance() {
            let expected = |curve: Curve| Prior::of(&x, &curve).expected(fit.bend, &covariance);
            let curve = fit.curve.moved(x.rows(0, count).into_owned());
            fit.bend = curve.map_or(fit.bend, expected).clamp(bends[0], bends[1]);
        }
    }
    fit.least = f64::INFINITY;
    let (Iterate { x, equations }, _) = iterate(fit, x, Damped::until(effort.settled), effort.steps);
    let covariance = equations.covariance()?;
    let model = fit.model(&x)?;
    let explained = fit.explained(&model);
    let Model { curve, states, .. } = model;
    // unknowns that the prior alone determines count for nothing
    let known = Prior::of(&x, &curve);
    let prior = known.at(fit.bend);
    let determined = x.len() as f64 - (&covariance * prior.matrix).trace();
    let farthest = farthest(&x, count, fit.sources, None);
    let goodness = Goodness::of(&explained, &fit.blocks.blocks, determined, farthest);
    fit.states.clone_from(&states);
    let spread = covariance.diagonal().iter().skip(count).map(|variance| variance.max(0.0).sqrt()).collect();
    let cost = prior.cost + fit.cost_of(&explained);
    let (asked, bend) = (fit.asked.clone(), fit.bend);
    // vertices are nodes between the ends of a chain
    let nodes = || curve.chains().flatten().map(|(_, node)| node);
    let (inner, vertices) =
        (nodes().count() - 2 * curve.chains().count(), nodes().filter(|node| node.is_vertex).count());
    // any number of vertices, and any nodes as these, are equally likely before (Scott and Berger 2010)
    let evidence = cost + known.price(fit.bend, &equations)? + 2.0 * log_choices(inner, vertices);
    let straightest = if goodness.explains { known.straightest(bend, bends[0], &equations) } else { bend };
    Some(Solved { x, curve, asked, cost, evidence, straightest, covariance, spread, bend, explained, states, goodness })
}

/// The error that is farthest off what is known of it, in standard deviations of its budget: of all, or of a recording. The errors come after `count` other
/// unknowns.
fn farthest(x: &DVector<f64>, count: usize, sources: &Sources, recording: Option<usize>) -> Option<(Source, f64)> {
    let own = sources.free.iter().enumerate().filter(|(_, error)| recording.is_none_or(|own| error.is_of(own)));
    own.map(|(i, error)| (error.source, x[count + i])).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}

impl Solved {
    /// The order in which fits from different starts are preferred: those that explain, the most probable first; then the others, by their cost.
    pub fn preferred(&self, other: &Self) -> Ordering {
        match (self.goodness.explains, other.goodness.explains) {
            (true, true) => self.evidence.total_cmp(&other.evidence),
            (false, false) => self.cost.total_cmp(&other.cost),
            (now, then) => then.cmp(&now),
        }
    }

    /// Whether some more steps may explain the recording.
    pub fn is_near(&self) -> bool {
        self.is_near_where_asked() && !self.asked.contains(&false)
    }

    /// The same of the blocks that are to be explained.
    fn is_near_where_asked(&self) -> bool {
        let goodness = &self.goodness;
        let (known, unreached) = (self.explained.residuals.iter().flatten().count(), self.explained.unreached);
        unreached as f64 <= MOST_UNREACHED * (known + unreached) as f64
            && goodness.chi_squared < NEAR * goodness.degrees_of_freedom
    }

    /// Errors less what is known of them, in standard deviations of their budget.
    pub fn errors(&self) -> DVector<f64> {
        let count = self.curve.count();
        self.x.rows(count, self.x.len() - count).into_owned()
    }

    /// What is known of the errors, of `possible` ones.
    pub fn posterior(&self, possible: usize) -> Posterior {
        let (count, all) = (self.curve.count(), self.x.len() - self.curve.count());
        let covariance = self.covariance.view((count, count), (all, all)).into_owned();
        Posterior { errors: self.errors(), covariance, possible }
    }

    /// The contour as one from which a fit starts: nothing draws it to where it came from.
    pub fn curve_anew(&self) -> Option<Curve> {
        Curve::through(&self.curve.nodes_of_chains())
    }

    /// With at least these standard deviations of the errors, in those of their budget.
    pub fn with_least_spread(mut self, least: &[f64]) -> Self {
        self.spread.iter_mut().zip(least).for_each(|(spread, least)| *spread = spread.max(*least));
        self
    }

    /// With other standard deviations of the errors, in those of their budget.
    pub fn with_spread(self, spread: Vec<f64>) -> Self {
        Self { spread, ..self }
    }

    /// The contour and the errors that are free, where those that are fixed are as they are known, to first order.
    pub fn without(&self, fixed: &[usize], free: &[usize]) -> Option<(Curve, DVector<f64>)> {
        let count = self.curve.count();
        let fixed: Vec<usize> = fixed.iter().map(|i| count + i).collect();
        let own = self.covariance.select_rows(&fixed).select_columns(&fixed).cholesky()?;
        let moved = &self.x - self.covariance.select_columns(&fixed) * own.solve(&self.x.select_rows(&fixed));
        let curve = self.curve.moved(moved.rows(0, count).into_owned())?;
        Some((curve, DVector::from_iterator(free.len(), free.iter().map(|i| moved[count + i]))))
    }

    /// The states of the blocks with their residuals, and whether they are where the recording is explained worst.
    fn seen<'a>(&'a self, blocks: &'a Blocks) -> impl Iterator<Item = (&'a State, Vector3<f64>, bool)> {
        let worst = self.goodness.unlikely_window().map_or(0..0, |worst| worst.samples.clone());
        let blocks = blocks.blocks.iter().zip(self.states.iter().zip(&self.explained.residuals));
        blocks.filter_map(move |(block, (state, residual))| {
            Some((state.as_ref()?, (*residual)?, worst.contains(&block.samples.start)))
        })
    }

    /// Number of blocks with several contacts.
    fn several(&self) -> usize {
        self.explained.labels.iter().flatten().filter(|label| label.several()).count()
    }

    /// Whether this rough fit may come to be preferred to what it was changed from.
    fn is_hopeful(&self, before: &Self) -> bool {
        match before.goodness.explains {
            true => self.evidence < before.evidence + ROUGH,
            false => self.cost < HOPEFUL * before.cost,
        }
    }

    /// Whether this is to be preferred to what it was changed from.
    fn is_worth(&self, change: Change, before: &Self) -> bool {
        match (self.goodness.explains, before.goodness.explains) {
            (true, true) => self.evidence < before.evidence - LEAST,
            (true, false) => true,
            (false, true) => false,
            // fewer contacts explain as much
            (false, false) if change == Change::Flatter => {
                let fewer = before.x.len().saturating_sub(self.x.len()) as f64;
                self.several() < before.several() && self.cost < before.cost + WORTH + fewer
            }
            (false, false) => self.cost < before.cost - WORTH,
        }
    }

    /// The fit to each recording, whose `samples` come one recording after the other; `given` is a uniform rod of the length and the stiffness at the clamp
    /// of `rod`.
    pub fn results<R: PhysicalRod>(
        mut self,
        rod: &R,
        samples: &[Sample],
        blocks: &Blocks,
        sources: &Sources,
        given: &Rod,
    ) -> Vec<ContourFit> {
        let parts = self.parts(blocks, sources);
        let Self { x, curve, covariance, spread, bend, explained, goodness, states, asked, .. } = self;
        let mut fit = Fit::new(rod, curve.clone(), blocks, sources);
        (fit.bend, fit.states, fit.asked) = (bend, states, asked);
        let model = fit.model_with(&x, curve.clone(), fit.states.clone());
        let told = |(label, state): (&Option<Label>, &Option<State>)| match state {
            Some(state) => label.map(|_| curve.label(&state.contacts, &covariance, given.length())),
            None => *label,
        };
        let labels: Vec<Option<Label>> = explained.labels.iter().zip(&fit.states).map(told).collect();
        let explaining = model.as_ref().filter(|_| goodness.explains);
        let rates = model.as_ref().map(|model| fit.contact_rates(&x, model)).unwrap_or_default();
        let readings = explaining.and_then(|model| fit.answers(&x, model, &rates, &covariance, &labels, samples));
        let count = curve.count();
        let errors = |recording: usize| {
            let own = sources.free.iter().enumerate().filter(move |(_, error)| error.is_of(recording));
            let value = |(i, error): (usize, &FreeError)| {
                let (source, k, unit) = (error.source, error.source as usize, error.source.unit(given));
                let (known, budget) = (sources.known[recording][k], sources.sigmas[k]);
                (source, (known + x[count + i] * budget) * unit, spread[i] * budget * unit)
            };
            own.map(value).collect()
        };
        // the model has the length of the given rod; the true one may have another
        let (length, _) = fit.rod_over_given(&x);
        let known = model.as_ref().map(|model| fit.known(model, &rates, &covariance, &labels));
        let known =
            known.unwrap_or_else(|| curve.chains().map(|chain| chain.map(|_| Knowledge::Unknown).collect()).collect());
        let residuals = 3.0 * explained.residuals.iter().flatten().count() as f64;
        let best = Best { x: &x, covariance: &covariance, goodness: &goodness, residuals, known: &known };
        let shapes = if goodness.explains { fit.shapes(&best) } else { Vec::new() };
        let object = |(nodes, known): (&Vec<Node>, Vec<Knowledge>)| FittedObject {
            points: nodes.iter().map(|node| [node.at.x * length, node.at.y * length]).collect(),
            vertices: (0..nodes.len()).filter(|i| nodes[*i].is_vertex).collect(),
            known: known.into_iter().map(|one| one.scaled(length)).collect(),
        };
        let objects: Vec<FittedObject> = curve.nodes_of_chains().iter().zip(known).map(object).collect();
        let shapes: Vec<SimpleShape> = shapes.into_iter().map(|shape| shape.scaled(length)).collect();
        let of_recording = |(recording, (part, goodness)): (usize, (&Part, Goodness))| {
            let Range { start, end } = part.samples;
            let own = blocks.blocks.iter().enumerate().filter(|(_, block)| block.recording == recording);
            let block = |(k, block): (usize, &Block)| FittedBlock {
                samples: block.samples.start - start..block.samples.end - start,
                label: labels[k],
                residuals: explained.residuals[k].map(Into::into),
            };
            ContourFit {
                objects: objects.clone(),
                shapes: shapes.clone(),
                errors: errors(recording),
                goodness,
                blocks: own.map(block).collect(),
                ringing: part.ringing,
                readings: readings.as_ref().map_or_else(Vec::new, |readings| readings[start..end].to_vec()),
                length: given.length(),
            }
        };
        blocks.recordings.iter().zip(parts).enumerate().map(of_recording).collect()
    }

    /// How well each recording is explained; not at all if another is not.
    fn parts(&mut self, blocks: &Blocks, sources: &Sources) -> Vec<Goodness> {
        let (count, all) = (self.curve.count(), 3.0 * self.explained.residuals.iter().flatten().count() as f64);
        let determined = all - self.goodness.degrees_of_freedom;
        let of_recording = |recording: usize| {
            let is_own = |k: &usize| blocks.blocks[*k].recording == recording;
            let own: Vec<usize> = (0..blocks.blocks.len()).filter(is_own).collect();
            let Range { start, end } = own.first().map_or(0..0, |first| *first..first + own.len());
            let part = self.explained.part(start..end, &blocks.blocks, &self.asked);
            let residuals = 3.0 * part.residuals.iter().flatten().count() as f64;
            let farthest = farthest(&self.x, count, sources, Some(recording));
            // unknowns count where the residuals are that determine them
            let mut goodness =
                Goodness::of(&part, &blocks.blocks[start..end], determined * residuals / all.max(1.0), farthest);
            let first = blocks.recordings[recording].samples.start;
            if let Some(worst) = &mut goodness.worst {
                worst.samples = worst.samples.start - first..worst.samples.end - first;
            }
            goodness
        };
        let mut parts: Vec<Goodness> = (0..blocks.recordings.len()).map(of_recording).collect();
        self.goodness.explains &= parts.iter().all(|part| part.explains);
        parts.iter_mut().for_each(|part| part.explains = self.goodness.explains);
        parts
    }
}
