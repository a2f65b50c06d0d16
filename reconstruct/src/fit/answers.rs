//! The answers to the samples that a contour gives: the states of the rod past it.

use super::contact_rates::ContactRates;
use super::distinct::Distinct;
use super::doubt::{Margins, probabilities};
use super::forward::{Forward, Place};
use super::problem::{Fit, Model};
use crate::phase::Label;
use crate::pipeline::{Reading, Reason};
use crate::point::Touch;
use nalgebra::{DMatrix, DVector, Matrix2};
use rod_contact::{ContactKind, State};
use rod_core::{PhysicalRod, Pose, Sample};

/// Probability that a contact is there of which only the guessed part of a contour tells.
const DOUBTFUL: f64 = 0.5;

impl<R: PhysicalRod> Fit<'_, R> {
    /// The answers to samples, by the states of a model with the unknowns `x` of this covariance. `labels` are those of the blocks; none where the
    /// model is not reached, and there is no answer.
    pub fn answers(
        &self,
        x: &DVector<f64>,
        model: &Model,
        rates: &[Option<Vec<ContactRates>>],
        covariance: &DMatrix<f64>,
        labels: &[Option<Label>],
        samples: &[Sample],
    ) -> Option<Vec<Option<Reading>>> {
        let forward = Forward { rod: self.rod, curve: &model.curve, objects: &model.objects };
        let (length, shared) = (self.rod.units().length, self.by_errors(covariance)?);
        let blocks = &self.blocks.blocks;
        let mut known = blocks.iter().find_map(|block| block.systematic).unwrap_or_else(Matrix2::zeros);
        let margins = |k: usize| {
            known = blocks[k].systematic.unwrap_or(known);
            let (Some(state), Some(rates)) = (&model.states[k], &rates[k]) else { return Margins::NONE };
            let distinct = model.curve.distinct(&state.contacts, covariance, length);
            Margins::of(&distinct, rates, covariance, &known, length)
        };
        let margins: Vec<Margins> = (0..blocks.len()).map(margins).collect();
        let probabilities = probabilities(labels, &margins, &self.blocks.segments);
        let touched = self.touched(model, rates, &(covariance - &shared));
        let (mut answers, mut covariances) = (vec![None; samples.len()], Vec::new());
        for (k, block) in self.blocks.blocks.iter().enumerate().filter(|(k, _)| labels[*k].is_some()) {
            let probability = probabilities[k];
            let Some(state) = &model.states[k] else {
                answers[block.samples.clone()].fill_with(|| Some(Reading::of_model(Label::Free, probability, &[])));
                continue;
            };
            // at a fold those of the block before hold
            if let Some(rates) = &rates[k] {
                covariances = rates.iter().map(|by| [covariance, &shared].map(|of| by.of_point(of))).collect();
            }
            if covariances.is_empty() && !state.contacts.is_empty() {
                continue;
            }
            // the errors of the samples of a block are about those of its mean
            let mean = block.clamp.pose;
            let place = |sample: &Sample| Place {
                pose: Pose {
                    x: state.pose.x + sample.pose.x - mean.x * length,
                    y: state.pose.y + sample.pose.y - mean.y * length,
                    phi: state.pose.phi + sample.pose.phi - mean.z,
                },
                friction: model.corrected[k].friction,
            };
            let places: Vec<Place> = samples[block.samples.clone()].iter().map(place).collect();
            let mut found = vec![None; places.len()];
            let middle = places.len() / 2;
            forward.follow(state, middle..places.len(), &places, &mut found);
            forward.follow(state, (0..middle).rev(), &places, &mut found);
            for (answer, state) in answers[block.samples.clone()].iter_mut().zip(&found) {
                let told = |state: &State| {
                    let contacts = model.bent_contacts(k, &state.contacts, length);
                    let distinct = model.curve.distinct(&contacts, covariance, length);
                    let is_on_touched =
                        |contact| model.curve.node_at(contact).is_some_and(|node| touched.contains(&node));
                    let is_known: Vec<bool> = contacts.iter().map(is_on_touched).collect();
                    self.answer(x, &distinct, &is_known, &covariances, probability)
                };
                // a contact that begins inside the block may have no covariance yet
                let is_known = |state: &&State| state.contacts.is_empty() || !covariances.is_empty();
                *answer = state.as_ref().filter(is_known).map(told);
            }
        }
        Some(answers)
    }

    /// The part of a covariance of the unknowns that the errors cause which all samples share; none where it is singular.
    pub(super) fn by_errors(&self, covariance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let (first, count) = (self.curve.count(), self.sources.free.len());
        let rows = covariance.columns(first, count);
        let own = covariance.view((first, first), (count, count)).into_owned();
        if count == 0 { Some(covariance * 0.0) } else { Some(rows * own.cholesky()?.solve(&rows.transpose())) }
    }

    /// The answer of the contacts of a state that are told. The errors of their points are those of the block, whose contacts these are.
    fn answer(
        &self,
        x: &DVector<f64>,
        distinct: &[Distinct],
        is_known: &[bool],
        covariances: &[[Matrix2<f64>; 2]],
        probability: f64,
    ) -> Reading {
        // the model has the length of the given rod, and its bending stiffness
        let (longer, stiffer) = self.rod_over_given(x);
        let touch = |Distinct { like, contact, spread }: &Distinct| {
            if !is_known.get(*like).copied().unwrap_or(false) {
                return Err(Reason::Untouched);
            }
            let [covariance, systematic] = covariances.get(*like).or(covariances.last()).copied().unwrap_or_default();
            Ok(Touch {
                s: contact.s * longer,
                x: contact.x * longer,
                y: contact.y * longer,
                alpha: contact.alpha,
                force: contact.load().force * stiffer / (longer * longer),
                covariance: covariance + spread,
                systematic,
            })
        };
        let touches: Vec<Result<Touch, Reason>> = distinct.iter().map(touch).collect();
        // a contact where nothing tells of the contour may as well not be there
        let doubt = if touches.contains(&Err(Reason::Untouched)) { DOUBTFUL } else { 1.0 };
        let is_at_tip = distinct.last().is_some_and(|last| last.contact.kind == ContactKind::Tip);
        Reading::of_model(Label::of(distinct.len(), is_at_tip), doubt * probability, &touches)
    }
}
