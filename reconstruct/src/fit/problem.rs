//! The fit of contour and shared errors as a least-squares problem.

use super::blocks::{Block, Blocks};
use super::contact_rates::ContactRates;
use super::curve::Curve;
use super::forward::{Forward, Place};
use super::prior::Prior;
use crate::friction::ANY;
use crate::least_squares::{Loss, NormalMatrix, Problem};
use crate::phase::Label;
use crate::pipeline::{Pass, Reconstruction};
use crate::point::Clamp;
use crate::systematic::{Correction, Errors, Source, SourceEstimate};
use nalgebra::{DVector, Matrix3, Vector2, Vector3};
use rod_contact::{Contact, Derivatives, Quantity, State};
use rod_contours::Composite;
use rod_core::{PhysicalRod, Pose, Reactions, Response, Rod, RodParameter, SupportRate, Units};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Scale of Cauchy's loss for the residual of a block, standard deviations. Larger: outliers bend the contour; smaller: a start that is far
/// off converges slowly.
const LOSS: Loss = Loss::Cauchy(6.0);
/// Cost of a block that no branch of the model reaches: that of a residual of 1000 standard deviations. Smaller: contours win that lose bad
/// blocks.
const LOST: f64 = 368.0;
/// Residual of a block, standard deviations, from which on the model is on another branch than the rod. Smaller: what is not explained counts as
/// not reached.
pub(super) const BRANCH: f64 = 20.0;
/// Step for derivatives of the correction by the errors, in standard deviations of the budget.
const STEP: f64 = 1e-6;
/// Rate of a contact by an offset below which it is left out: cardinal splines fall to a fourth from knot to knot.
const FAR: f64 = 1e-5;

/// Initial standard deviation of the change of curvature, L^-1.5.
const BEND: f64 = 30.0;

/// What a block costs, where contours are compared, that has this residual or is not reached: on another branch than the rod it is not reached.
fn cost_of(residual: Option<f64>) -> f64 {
    residual.filter(|residual| *residual < BRANCH).map_or(LOST, |residual| LOSS.of(residual))
}

/// What is known of the shared errors before: their sources and standard deviations.
#[derive(Clone, Debug, Default)]
pub(super) struct Sources {
    pub sigmas: Errors,
    /// What is known of each error of each recording, 0 where nothing is.
    pub known: Vec<Errors>,
    /// Those that are not known exactly.
    pub free: Vec<FreeError>,
    /// Whether friction was asked for: then it is always free.
    pub is_rough: bool,
}

/// An error that is not known exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FreeError {
    pub source: Source,
    /// The recording whose error it is; none if it is one of rod, sensor, clamp or stage, which all recordings have.
    pub recording: Option<usize>,
}

impl FreeError {
    /// Whether it is one of a recording.
    pub fn is_of(self, recording: usize) -> bool {
        self.recording.is_none_or(|own| own == recording)
    }
}

impl Sources {
    /// Those that the local answers to some recordings had a budget for, and a value of each estimate less what is known, in standard deviations of the
    /// budget: of an error that all recordings have, the mean.
    pub fn of(rod: &Rod, locals: &[&Reconstruction], value: impl Fn(&SourceEstimate) -> f64) -> (Self, DVector<f64>) {
        let mut sigmas = Errors::zeros();
        let (mut known, mut start) = (vec![Errors::zeros(); locals.len()], vec![Errors::zeros(); locals.len()]);
        for (local, (known, start)) in locals.iter().zip(known.iter_mut().zip(&mut start)) {
            for estimate in local.calibration().iter().flat_map(|calibration| &calibration.sources) {
                let (k, unit) = (estimate.source as usize, estimate.source.unit(rod));
                (known[k], start[k]) = (estimate.known / unit, value(estimate) / unit);
                sigmas[k] = sigmas[k].max(estimate.budget / unit);
            }
            // its sign is that of the passes
            let k = Source::Friction as usize;
            let rubbing = local.passes.iter().find(|pass| pass.used_friction != 0.0);
            let sign = rubbing.map_or(0.0, Pass::drawn);
            (known[k], start[k]) = (sign * known[k], sign * start[k]);
            // a coefficient that is known exactly is none of the estimates
            let is_estimated = local.calibration().is_some_and(|found| found.source(Source::Friction).is_some());
            if let Some(pass) = rubbing.filter(|_| !is_estimated) {
                (known[k], start[k]) = (pass.used_friction.abs(), pass.used_friction.abs());
            }
        }
        let is_rough = locals.iter().flat_map(|local| &local.passes).any(|pass| pass.used_friction != 0.0);
        let of_source = |source: &Source| {
            let own = (0..locals.len()).filter(|_| source.is_of_scan()).map(Some);
            let all = Some(None).filter(|_| !source.is_of_scan());
            own.chain(all).map(|recording| FreeError { source: *source, recording }).collect::<Vec<_>>()
        };
        let possible = Source::ALL.iter().filter(|source| sigmas[**source as usize] > 0.0);
        let free: Vec<FreeError> = possible.flat_map(of_source).collect();
        let off = |error: &FreeError| {
            let k = error.source as usize;
            let of = (0..locals.len()).filter(|recording| error.is_of(*recording));
            let off: Vec<f64> = of.map(|recording| (start[recording][k] - known[recording][k]) / sigmas[k]).collect();
            off.iter().sum::<f64>() / off.len() as f64
        };
        let start = DVector::from_iterator(free.len(), free.iter().map(off));
        (Self { sigmas, known, free, is_rough }, start)
    }

    /// The number of an error that all recordings have; none if it is known exactly.
    fn number(&self, source: Source) -> Option<usize> {
        self.free.iter().position(|error| error.source == source)
    }

    /// Whether an error is always free.
    pub fn is_always_free(&self, error: &FreeError) -> bool {
        self.is_rough && error.source == Source::Friction
    }

    /// For each error the standard deviation, in that of its budget, in which the local answers contain other errors in its place: of friction that was asked
    /// for; 0 of others.
    pub fn least_spread(&self, locals: &[&Reconstruction]) -> Vec<f64> {
        let sigma = self.sigmas[Source::Friction as usize];
        let of = |error: &FreeError| {
            let local = locals.get(error.recording?)?;
            let told = local.passes.iter().filter_map(|pass| Some(pass.friction?.sigma / sigma));
            self.is_always_free(error).then(|| told.fold(0.0, f64::max))
        };
        self.free.iter().map(|error| of(error).unwrap_or_default()).collect()
    }

    /// The same with friction of each recording, of which nothing is known.
    pub fn and_friction(&self) -> Self {
        let mut with = self.clone();
        let of = |recording| FreeError { source: Source::Friction, recording: Some(recording) };
        with.sigmas[Source::Friction as usize] = ANY;
        with.free.extend((0..self.known.len()).map(of));
        with
    }

    /// The same, with all errors as they are known that need not be free.
    pub fn exact(&self) -> Self {
        let free = self.free.iter().filter(|error| self.is_always_free(error)).copied().collect();
        Self { free, ..self.clone() }
    }

    /// Of the errors that are free here those that are free there.
    pub fn of_free(&self, errors: &DVector<f64>, there: &Self) -> DVector<f64> {
        let kept = self.free.iter().zip(errors.iter()).filter(|(error, _)| there.free.contains(error));
        DVector::from_iterator(there.free.len(), kept.map(|(_, off)| *off))
    }

    /// The errors of each recording that are so many standard deviations of their budget off what is known.
    pub fn errors<'a>(&self, off: impl IntoIterator<Item = &'a f64>) -> Vec<Errors> {
        let mut errors = self.known.clone();
        self.free.iter().zip(off).for_each(|(error, off)| self.add(*error, *off, &mut errors));
        errors
    }

    /// Makes an error larger by so many standard deviations of its budget.
    fn add(&self, error: FreeError, off: f64, errors: &mut [Errors]) {
        let k = error.source as usize;
        let of = errors.iter_mut().enumerate().filter(|(recording, _)| error.is_of(*recording));
        of.for_each(|(_, errors)| errors[k] += off * self.sigmas[k]);
    }
}

/// The fit at one contour. Its unknowns are the offsets of the contour's points (m), then the errors less what is known of them, in standard
/// deviations of their budget.
#[derive(Clone)]
pub(super) struct Fit<'a, R> {
    pub rod: &'a R,
    pub curve: Curve,
    pub blocks: &'a Blocks,
    pub sources: &'a Sources,
    /// Which blocks are to be explained; the others cost as much as if they were not reached.
    pub asked: Vec<bool>,
    /// Standard deviation of the change of curvature over a length of way, 1/m per root of m.
    pub bend: f64,
    /// States of the best contour so far, and its cost.
    pub states: Vec<Option<State>>,
    pub least: f64,
    /// How often the model was evaluated.
    pub evaluations: usize,
}

/// The recording against a contour.
#[derive(Clone, Debug, Default)]
pub(super) struct Explained {
    /// For each block its residuals in standard deviations of the noise; none where it is left out or no branch reaches it.
    pub residuals: Vec<Option<Vector3<f64>>>,
    pub labels: Vec<Option<Label>>,
    /// Blocks, not beside jumps, that no branch reaches.
    pub unreached: usize,
    /// Blocks of which nothing was asked.
    pub others: usize,
}

impl Explained {
    /// Some of the blocks, of which these are `asked` for.
    pub fn part(&self, part: Range<usize>, blocks: &[Block], asked: &[bool]) -> Self {
        let is_lost = |k: &usize| self.residuals[*k].is_none() && !blocks[*k].is_left_out;
        let (unreached, others): (Vec<usize>, Vec<usize>) = part.clone().filter(is_lost).partition(|k| asked[*k]);
        Self {
            residuals: self.residuals[part.clone()].to_vec(),
            labels: self.labels[part].to_vec(),
            unreached: unreached.len(),
            others: others.len(),
        }
    }

    /// Without the blocks from a jump on along which the model is on the other side of it: those are not reached.
    fn without_branch(&mut self, from_jump: impl Iterator<Item = usize>) {
        for k in from_jump.skip_while(|k| self.residuals[*k].is_none()).collect::<Vec<_>>() {
            if self.residuals[k].is_none_or(|residual| residual.norm() < BRANCH) {
                return;
            }
            (self.residuals[k], self.labels[k]) = (None, None);
            self.unreached += 1;
        }
    }
}

/// A block without the errors.
pub(super) struct Corrected {
    /// m, rad.
    pub pose: Pose,
    /// The coefficient with which its contacts slide, positive where friction draws the rod towards its tip.
    pub friction: f64,
    pub reactions: Vector3<f64>,
    /// Derivatives of the reactions and of the pose by the measured reactions.
    by_reactions: Matrix3<f64>,
    pose_by_reactions: Matrix3<f64>,
}

impl Corrected {
    /// Measured less model, in standard deviations of the noise as it was measured: a gain, or a clamp that yields to noisy reactions, must
    /// not make the noise small. `by_pose` are the derivatives of the model.
    pub fn residual(&self, model: &Vector3<f64>, by_pose: &Matrix3<f64>, block: &Block) -> Vector3<f64> {
        let by_noise = self.by_reactions - by_pose * self.pose_by_reactions;
        let residual = self.reactions - model;
        by_noise.try_inverse().map_or(residual, |shown| shown * residual).component_div(&block.sigma)
    }
}

/// The model with some unknowns.
pub(super) struct Model {
    pub curve: Curve,
    pub objects: Vec<Composite>,
    pub corrected: Vec<Corrected>,
    pub states: Vec<Option<State>>,
    /// Derivatives of the dimensionless reactions of each state by its pose (m, radians); 0 where the rod touches nothing, and at a fold.
    pub by_pose: Vec<Matrix3<f64>>,
    /// How far the rod is bent at rest beyond what is given, times its length.
    pub natural: f64,
    /// How each state changes with that, per 1/m; none where the rod touches nothing or is at a fold, and where it is known.
    pub by_natural: Vec<Option<Response>>,
}

impl Model {
    /// The contacts of a state at a block, to first order in what the rod is bent at rest beyond what is given.
    pub fn bent_contacts(&self, block: usize, contacts: &[Contact], length: f64) -> Vec<Contact> {
        let mut bent = contacts.to_vec();
        let rates = self.by_natural.get(block).and_then(Option::as_ref).map_or(&[][..], |response| &response.contacts);
        if rates.len() == contacts.len() {
            let more = self.natural / length;
            for (contact, rate) in bent.iter_mut().zip(rates) {
                contact.x += rate.x * more;
                contact.y += rate.y * more;
                contact.alpha += rate.alpha * more;
                contact.s += rate.s * more;
                contact.force += rate.force * more;
            }
        }
        bent
    }

    /// How the reactions of a block change with the natural curvature of the rod, times its length; dimensionless.
    fn reactions_by_natural(&self, block: usize, units: Units) -> Vector3<f64> {
        let by = self.by_natural.get(block).and_then(Option::as_ref).map(|response| response.reactions);
        by.map_or_else(Vector3::zeros, |Reactions { f0x, f0y, m0z }| {
            Vector3::new(f0x / units.force, f0y / units.force, m0z / units.moment) / units.length
        })
    }

    /// By how much the reactions of a block differ from those of its state, to first order in what the rod is bent at rest beyond what is given; dimensionless.
    pub fn bend(&self, block: usize, units: Units) -> Vector3<f64> {
        self.reactions_by_natural(block, units) * self.natural
    }
}

/// Derivatives of the reactions of a state by the coefficient with which its contacts slide, and by the offsets of the points of the contour that it feels.
#[derive(Default)]
struct Rates {
    by_friction: Vector3<f64>,
    by_offsets: Vec<(usize, Vector3<f64>)>,
}

/// How a state changes with each offset of the contour by which its contacts move at a rate that `is_felt`.
fn by_offsets(
    derivatives: &Derivatives<'_>,
    curve: &Curve,
    state: &State,
    is_felt: impl Fn(&SupportRate) -> bool,
) -> Vec<(usize, Response)> {
    let felt = |contact| curve.rates(contact).into_iter().filter(|(_, rate)| is_felt(rate)).collect();
    let at: Vec<BTreeMap<usize, SupportRate>> = state.contacts.iter().map(felt).collect();
    let unknowns: BTreeSet<usize> = at.iter().flat_map(|rates| rates.keys().copied()).collect();
    let response = |i: usize| {
        let of_contact = |contact: usize| at[contact].get(&i).copied().unwrap_or_default();
        Some((i, derivatives.by_contours(of_contact).ok()?))
    };
    unknowns.into_iter().filter_map(response).collect()
}

/// A block against the model.
struct Row {
    residual: Vector3<f64>,
    /// Derivatives by the unknowns.
    by: [Vec<(usize, f64)>; 3],
}

impl<'a, R: PhysicalRod> Fit<'a, R> {
    /// Of a contour of which no states are known, at the initial smoothness.
    pub fn new(rod: &'a R, curve: Curve, blocks: &'a Blocks, sources: &'a Sources) -> Self {
        let states = vec![None; blocks.blocks.len()];
        let bend = BEND * rod.units().length.powf(-1.5);
        let asked = vec![true; blocks.blocks.len()];
        Self { rod, curve, blocks, sources, asked, bend, states, least: f64::INFINITY, evaluations: 0 }
    }
}

impl<R: PhysicalRod> Fit<'_, R> {
    fn errors(&self, x: &DVector<f64>) -> Vec<Errors> {
        self.sources.errors(x.iter().skip(self.curve.count()))
    }

    /// How many blocks are to be explained.
    pub fn count_asked(&self) -> usize {
        self.asked.iter().filter(|asked| **asked).count()
    }

    /// What all blocks cost, without what is known of contour and errors before.
    pub fn cost_of(&self, explained: &Explained) -> f64 {
        let counted = explained.residuals.iter().zip(&self.blocks.blocks).filter(|(_, block)| !block.is_left_out);
        counted.map(|(residual, _)| cost_of(residual.map(|residual| residual.norm()))).sum()
    }

    /// The blocks without the errors of their recordings.
    pub fn corrected(&self, errors: &[Errors]) -> Option<Vec<Corrected>> {
        let corrections = self.blocks.corrections(errors)?;
        Some(self.blocks.blocks.iter().map(|block| self.without(block, &corrections[block.recording])).collect())
    }

    /// A block without its errors.
    fn without(&self, block: &Block, correction: &Correction) -> Corrected {
        let length = self.rod.units().length;
        let in_metres = |pose: Vector3<f64>| Vector3::new(pose.x * length, pose.y * length, pose.z);
        let Clamp { pose, reactions, friction, .. } = block.corrected(&block.clamp, correction);
        let pose = in_metres(pose);
        let (mut by_reactions, mut pose_by_reactions) = (Matrix3::zeros(), Matrix3::zeros());
        // the correction is linear in the reactions
        for c in 0..3 {
            let mut other = block.clamp;
            other.reactions[c] += 1.0;
            let there = block.corrected(&other, correction);
            by_reactions.set_column(c, &(there.reactions - reactions));
            pose_by_reactions.set_column(c, &(in_metres(there.pose) - pose));
        }
        let pose = Pose { x: pose.x, y: pose.y, phi: pose.z };
        Corrected { pose, friction, reactions, by_reactions, pose_by_reactions }
    }

    /// The reactions at a block of a model, dimensionless.
    pub fn reactions(&self, block: usize, model: &Model) -> Vector3<f64> {
        let units = self.rod.units();
        let of = |state: &State| Clamp::new(units, state.pose, state.reactions).reactions;
        model.states[block].as_ref().map_or_else(Vector3::zeros, of) + model.bend(block, units)
    }

    /// The model with these unknowns; none where its contour is no curve.
    pub fn model(&self, x: &DVector<f64>) -> Option<Model> {
        let curve = self.curve.moved(x.rows(0, self.curve.count()).into_owned())?;
        let model = self.model_with(x, curve, Vec::new())?;
        let place = |one: &Corrected| Place { pose: one.pose, friction: one.friction };
        let places: Vec<Place> = model.corrected.iter().map(place).collect();
        let forward = Forward { rod: self.rod, curve: &model.curve, objects: &model.objects };
        let states = forward.states(self.blocks, &self.asked, &places, &self.states);
        Some(self.with_states(model, states))
    }

    /// The model with these unknowns, whose contour and states are known.
    pub fn model_with(&self, x: &DVector<f64>, curve: Curve, states: Vec<Option<State>>) -> Option<Model> {
        let errors = self.errors(x);
        let (objects, corrected) = (curve.objects()?, self.corrected(&errors)?);
        // one rod for all recordings
        let natural = errors.first().map_or(0.0, |errors| errors[Source::NaturalCurvature as usize]);
        let (by_pose, by_natural) = (Vec::new(), Vec::new());
        let model = Model { curve, objects, corrected, states: Vec::new(), by_pose, natural, by_natural };
        Some(self.with_states(model, states))
    }

    /// A model with these states, and how they change with the pose and with the natural curvature of the rod.
    fn with_states(&self, model: Model, states: Vec<Option<State>>) -> Model {
        let units = self.rod.units();
        let size = [units.force, units.force, units.moment];
        let is_bent = model.natural != 0.0 || self.sources.number(Source::NaturalCurvature).is_some();
        let rates = |state: &Option<State>| {
            let touching = state.as_ref().filter(|state| !state.contacts.is_empty());
            let derivatives = touching.and_then(|state| Derivatives::new(self.rod, &model.objects, state).ok());
            let Some(derivatives) = derivatives else { return (Matrix3::zeros(), None) };
            let stiffness = derivatives.stiffness();
            let by_pose = stiffness.map_or_else(|_| Matrix3::zeros(), |by| Matrix3::from_fn(|c, j| by[c][j] / size[c]));
            let by_natural = || derivatives.by_rod(self.rod, RodParameter::NaturalCurvature).ok();
            (by_pose, is_bent.then(by_natural).flatten())
        };
        let (by_pose, by_natural) = states.iter().map(rates).unzip();
        Model { states, by_pose, by_natural, ..model }
    }

    /// Whether a block without a state is explained by a free rod: nothing in its segment tells of a contact.
    fn is_free(&self, block: usize, states: &[Option<State>]) -> bool {
        let mut segment = self.blocks.segment_of(block);
        segment.all(|k| states[k].is_none() && self.blocks.blocks[k].label == Label::Free)
    }

    /// The recording against the model.
    pub fn explained(&self, model: &Model) -> Explained {
        let (means, Model { corrected, states, by_pose, .. }) = (self.means(model), model);
        let mut explained = Explained::default();
        for (k, block) in self.blocks.blocks.iter().enumerate() {
            let state = states[k].as_ref();
            let is_known = self.asked[k] && (state.is_some() || self.is_free(k, states));
            let label = state.map_or(Label::Free, |state| Label::of(state.phase().contacts, state.phase().tip));
            explained.labels.push(is_known.then_some(label));
            let residual = corrected[k].residual(&means[k], &by_pose[k], block);
            explained.residuals.push((is_known && !block.is_left_out).then_some(residual));
            explained.unreached += usize::from(self.asked[k] && !is_known && !block.is_left_out);
            explained.others += usize::from(!self.asked[k] && !block.is_left_out);
        }
        let jumps = self.blocks.segments.iter().zip(self.blocks.segments.iter().skip(1));
        for (before, after) in jumps {
            explained.without_branch(before.clone().rev());
            explained.without_branch(after.clone());
        }
        explained
    }

    /// Whether a coefficient of friction is one of the unknowns.
    fn rubs(&self) -> bool {
        self.sources.free.iter().any(|error| error.source == Source::Friction)
    }

    /// None at a fold.
    fn rates(&self, Model { curve, objects, .. }: &Model, state: &State) -> Option<Rates> {
        let units = self.rod.units();
        let derivatives = Derivatives::new(self.rod, objects, state).ok()?;
        let size = Vector3::new(units.force, units.force, units.moment);
        let is_near = |rate: &SupportRate| rate.x.hypot(rate.y) > FAR || rate.alpha.abs() * units.length > FAR;
        let felt = |Response { reactions: Reactions { f0x, f0y, m0z }, .. }: &Response| {
            Vector3::new(*f0x, *f0y, *m0z).component_div(&size)
        };
        let by_offsets = by_offsets(&derivatives, curve, state, is_near);
        Some(Rates {
            by_friction: if self.rubs() { felt(&derivatives.by_sliding().ok()?) } else { Vector3::zeros() },
            by_offsets: by_offsets.iter().map(|(i, response)| (*i, felt(response))).collect(),
        })
    }

    /// For each error, what takes the errors off each recording if this one is a step larger.
    fn stepped(&self, x: &DVector<f64>) -> Option<Vec<Vec<Correction>>> {
        let errors = self.errors(x);
        let with_step = |error: &FreeError| {
            let mut other = errors.clone();
            self.sources.add(*error, STEP, &mut other);
            self.blocks.corrections(&other)
        };
        self.sources.free.iter().map(with_step).collect()
    }

    /// The errors of a block, by number, with the block as it is if one of them is a step larger.
    fn with_steps<'b>(
        &'b self,
        block: &'b Block,
        stepped: &'b [Vec<Correction>],
    ) -> impl Iterator<Item = (usize, Corrected)> + 'b {
        let of_block = |(i, error): (usize, &FreeError)| error.is_of(block.recording).then_some(i);
        let numbers = self.sources.free.iter().enumerate().filter_map(of_block);
        numbers.map(|i| (i, self.without(block, &stepped[i][block.recording])))
    }

    /// The length and the bending stiffness of the rod, which is that of all recordings, over the given ones.
    pub fn rod_over_given(&self, x: &DVector<f64>) -> (f64, f64) {
        let errors = self.errors(x);
        let of = |source: Source| errors.first().map_or(1.0, |errors| 1.0 + errors[source as usize]);
        (of(Source::Length), of(Source::Stiffness))
    }

    /// How the contacts of each block change with the unknowns; none at a fold, and where the model has no state.
    pub fn contact_rates(&self, x: &DVector<f64>, model: &Model) -> Vec<Option<Vec<ContactRates>>> {
        let Some(stepped) = self.stepped(x) else { return vec![None; model.states.len()] };
        let of = |(block, state): (usize, &Option<State>)| self.rates_of(x, model, block, state.as_ref()?, &stepped);
        model.states.iter().enumerate().map(of).collect()
    }

    fn rates_of(
        &self,
        x: &DVector<f64>,
        Model { curve, objects, corrected, by_natural, .. }: &Model,
        block: usize,
        state: &State,
        stepped: &[Vec<Correction>],
    ) -> Option<Vec<ContactRates>> {
        let (longer, _) = self.rod_over_given(x);
        let mut by = vec![ContactRates { longer, ..ContactRates::default() }; state.contacts.len()];
        let mut add = |i: usize, response: &Response, share: f64| {
            for (by, rate) in by.iter_mut().zip(&response.contacts) {
                by.rates.push((i, share, *rate));
            }
        };
        let derivatives = Derivatives::new(self.rod, objects, state).ok()?;
        by_offsets(&derivatives, curve, state, |_| true).iter().for_each(|(i, response)| add(*i, response, 1.0));
        let moves = [Quantity::ClampX, Quantity::ClampY, Quantity::ClampAngle];
        let by_pose: Vec<Response> = moves.into_iter().filter_map(|by| derivatives.by(by).ok()).collect();
        let by_friction = if self.rubs() { derivatives.by_sliding().ok() } else { None };
        for (i, other) in self.with_steps(&self.blocks.blocks[block], stepped) {
            let (from, to) = (corrected[block].pose, other.pose);
            for (response, moved) in by_pose.iter().zip([to.x - from.x, to.y - from.y, to.phi - from.phi]) {
                add(curve.count() + i, response, moved / STEP);
            }
            if let Some(by_friction) = &by_friction {
                add(curve.count() + i, by_friction, (other.friction - corrected[block].friction) / STEP);
            }
        }
        let response = by_natural.get(block).and_then(Option::as_ref);
        if let Some((i, response)) = self.sources.number(Source::NaturalCurvature).zip(response) {
            let sigma = self.sources.sigmas[Source::NaturalCurvature as usize] / self.rod.units().length;
            add(curve.count() + i, response, sigma);
        }
        if let Some(i) = self.sources.number(Source::Length) {
            let sigma = self.sources.sigmas[Source::Length as usize];
            for (by, contact) in by.iter_mut().zip(&state.contacts) {
                by.by_length = Some((curve.count() + i, Vector2::new(contact.x, contact.y) * sigma));
            }
        }
        Some(by)
    }

    /// The rows of all blocks; none of those that the model does not reach.
    fn rows(&self, x: &DVector<f64>, at: &Model) -> Option<Vec<Option<Row>>> {
        let Model { corrected, states, .. } = at;
        let (first, stepped, means) = (self.curve.count(), self.stepped(x)?, self.means(at));
        let row = |k: usize| {
            let (block, state) = (&self.blocks.blocks[k], states[k].as_ref());
            if !self.asked[k] || state.is_none() && !self.is_free(k, states) {
                return None;
            }
            let (here, model) = (&corrected[k], means[k]);
            let mut by: [Vec<(usize, f64)>; 3] = Default::default();
            let touching = state.filter(|state| !state.contacts.is_empty());
            let by_pose = at.by_pose[k];
            let Rates { by_friction, by_offsets } = match touching {
                Some(state) => self.rates(at, state)?,
                None => Rates::default(),
            };
            let by_natural = at.reactions_by_natural(k, self.rod.units());
            let residual = here.residual(&model, &by_pose, block);
            let without = here.residual(&here.reactions, &by_pose, block);
            for (i, rate) in by_offsets {
                let rate = here.residual(&(here.reactions + rate), &by_pose, block) - without;
                (0..3).for_each(|c| by[c].push((i, rate[c])));
            }
            for (i, there) in self.with_steps(block, &stepped) {
                let (from, to) = (here.pose, there.pose);
                let moved = Vector3::new(to.x - from.x, to.y - from.y, to.phi - from.phi);
                let bent = match self.sources.free[i].source {
                    Source::NaturalCurvature => {
                        by_natural * (self.sources.sigmas[Source::NaturalCurvature as usize] * STEP)
                    }
                    _ => by_friction * (there.friction - here.friction),
                };
                let rate = (there.residual(&(model + by_pose * moved + bent), &by_pose, block) - residual) / STEP;
                (0..3).for_each(|c| by[c].push((first + i, rate[c])));
            }
            Some(Row { residual, by })
        };
        Some((0..self.blocks.blocks.len()).map(row).collect())
    }
}

impl<R: PhysicalRod> Problem for Fit<'_, R> {
    type Equations = NormalMatrix;

    fn equations(&mut self, x: &DVector<f64>) -> NormalMatrix {
        self.evaluations += 1;
        let here = self.model(x).and_then(|model| Some((self.rows(x, &model)?, model)));
        let Some((rows, Model { curve, states, .. })) = here else {
            return NormalMatrix { cost: f64::INFINITY, ..NormalMatrix::empty(x.len()) };
        };
        let mut normal = Prior::of(x, &curve).at(self.bend);
        let is_counted = |k: &usize| self.asked[*k] && !self.blocks.blocks[*k].is_left_out;
        for row in (0..rows.len()).filter(is_counted).map(|k| &rows[k]) {
            if let Some(Row { residual, by }) = row {
                let weight = LOSS.weight(1.0, residual.norm());
                (0..3).for_each(|c| normal.add_weighted(&by[c], residual[c], weight));
            }
            normal.cost += row.as_ref().map_or(LOST, |row| LOSS.excess(row.residual.norm()));
        }
        // a step that is rejected may have lost states
        if normal.cost <= self.least {
            self.least = normal.cost;
            for (known, state) in self.states.iter_mut().zip(states) {
                *known = state.or(known.take());
            }
        }
        normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_costs_its_chi_squared_while_that_is_small() {
        for residual in [0.1, 0.5, 1.0] {
            let cost = cost_of(Some(residual));
            assert!((cost / residual.powi(2) - 1.0).abs() < 0.02, "{residual}: {cost}");
        }
        // an outlier costs less than its square, and more than what is explained; on another branch as much as what is not reached
        assert!(cost_of(Some(3.0)) < cost_of(Some(12.0)) && cost_of(Some(12.0)) < 144.0);
        assert!((cost_of(Some(1000.0)) - LOST).abs() + (cost_of(None) - LOST).abs() < 1e-9);
    }
}
