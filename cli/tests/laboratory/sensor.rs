//! What a stage and a sensor make of the truth. Channels: 0 is f0x, 1 is f0y, 2 is m0z.

use super::recording::Recording;
use crate::random::dice::Dice;
use std::f64::consts::TAU;

/// Size of a spike, N, N, N m.
const SPIKE: [f64; 3] = [0.2, 0.2, 10e-3];
/// Frequency of the mains, Hz.
const MAINS: f64 = 50.0;

/// The command is told a stiffness that is too large by this share.
pub fn stiffness(recording: &mut Recording, share: f64) {
    recording.stiffness *= 1.0 + share;
}

/// The same for the length.
pub fn length(recording: &mut Recording, share: f64) {
    recording.length *= 1.0 + share;
}

/// The moment is taken about a point that is off the start of the rod, m along it and across it.
pub fn lever(recording: &mut Recording, along: f64, across: f64) {
    recording.each(|row| {
        let (sin, cos) = row.pose[2].sin_cos();
        let (x, y) = (along * cos - across * sin, along * sin + across * cos);
        let [fx, fy, m] = row.felt;
        [fx, fy, m + (x * fy - y * fx)]
    });
}

/// The stage goes farther than it says, by this share of its way.
pub fn stage_scale(recording: &mut Recording, share: f64) {
    let start = recording.rows[0].pose;
    for row in &mut recording.rows {
        row.pose[0] += share * (row.pose[0] - start[0]);
        row.pose[1] += share * (row.pose[1] - start[1]);
    }
}

/// The pose is late by this time, s, in a uniform motion.
pub fn lag(recording: &mut Recording, time: f64) {
    let late = recording.speed * time;
    for row in &mut recording.rows {
        row.pose[0] -= late * recording.direction[0];
        row.pose[1] -= late * recording.direction[1];
    }
}

/// White noise of the position, m.
pub fn stage_noise(recording: &mut Recording, sigma: f64, dice: &mut Dice) {
    for row in &mut recording.rows {
        row.pose[0] += sigma * dice.normal();
        row.pose[1] += sigma * dice.normal();
    }
}

/// The position is rounded to these steps, m.
pub fn encoder(recording: &mut Recording, step: f64) {
    for row in &mut recording.rows {
        row.pose[0] = rounded(row.pose[0], step);
        row.pose[1] = rounded(row.pose[1], step);
    }
}

fn rounded(value: f64, step: f64) -> f64 {
    if step > 0.0 { (value / step).round() * step } else { value }
}

pub fn gain(recording: &mut Recording, channel: usize, share: f64) {
    recording.rows.iter_mut().for_each(|row| row.felt[channel] *= 1.0 + share);
}

/// A share of one channel, relative to the ranges of both, is added to another one.
pub fn cross_talk(recording: &mut Recording, from: usize, to: usize, share: f64) {
    let range = recording.range();
    let factor = share * range[to] / range[from];
    recording.rows.iter_mut().for_each(|row| row.felt[to] += factor * row.felt[from]);
}

/// A quadratic and a cubic part of every channel, each this share of the range at full range.
pub fn non_linear(recording: &mut Recording, share: f64, dice: &mut Dice) {
    for (c, range) in recording.range().into_iter().enumerate() {
        let [square, cube] = [0; 2].map(|_| share * dice.sign() * range);
        for row in &mut recording.rows {
            let part = row.felt[c] / range;
            row.felt[c] += square * part.powi(2) + cube * part.powi(3);
        }
    }
}

fn signed(force: f64, moment: f64, dice: &mut Dice) -> [f64; 3] {
    [force, force, moment].map(|size| dice.sign() * size)
}

/// Constant offsets.
pub fn bias(recording: &mut Recording, force: f64, moment: f64, dice: &mut Dice) {
    let offset = signed(force, moment, dice);
    recording.each(|row| std::array::from_fn(|c| row.felt[c] + offset[c]));
}

/// Offsets that grow from 0 at the start of the scan to these sizes at its end.
pub fn drift(recording: &mut Recording, force: f64, moment: f64, dice: &mut Dice) {
    let offset = signed(force, moment, dice);
    let shares: Vec<f64> = recording.rows.iter().map(|row| recording.share(row)).collect();
    for (row, share) in recording.rows.iter_mut().zip(shares) {
        row.felt = std::array::from_fn(|c| row.felt[c] + share * offset[c]);
    }
}

/// Random walks with these standard deviations at the end of the scan.
pub fn random_walk(recording: &mut Recording, force: f64, moment: f64, dice: &mut Dice) {
    let step = (recording.rows.len() as f64).sqrt().recip();
    let mut walk = [0.0; 3];
    recording.each(|row| {
        for (at, size) in walk.iter_mut().zip([force, force, moment]) {
            *at += size * step * dice.normal();
        }
        std::array::from_fn(|c| row.felt[c] + walk[c])
    });
}

/// Sines of the mains with these amplitudes.
pub fn hum(recording: &mut Recording, force: f64, moment: f64, dice: &mut Dice) {
    let phases = [0; 3].map(|_| dice.angle());
    let sizes = [force, force, moment];
    recording.each(|row| std::array::from_fn(|c| row.felt[c] + sizes[c] * (TAU * MAINS * row.t + phases[c]).sin()));
}

/// A filter of first order in every channel; `inverse` is 1 over its corner frequency, s. It filters the white noise, too.
pub fn low_pass(recording: &mut Recording, inverse: f64) {
    let Some(factor) = (inverse > 0.0).then(|| (-TAU * recording.period / inverse).exp()) else { return };
    let mut state = recording.rows[0].felt;
    recording.each(|row| {
        for (at, felt) in state.iter_mut().zip(row.felt) {
            *at = felt + factor * (*at - felt);
        }
        state
    });
}

/// Readings are rounded to these steps.
pub fn quantise(recording: &mut Recording, force: f64, moment: f64) {
    recording.each(|row| {
        let [fx, fy, m] = row.felt;
        [rounded(fx, force), rounded(fy, force), rounded(m, moment)]
    });
}

/// This share of the samples has a spike in one channel.
pub fn spikes(recording: &mut Recording, share: f64, dice: &mut Dice) {
    for row in &mut recording.rows {
        if dice.share() < share {
            let channel = dice.whole(0, 2);
            row.felt[channel] += dice.sign() * SPIKE[channel];
        }
    }
}

/// This share of the samples is missing.
pub fn drop_samples(recording: &mut Recording, share: f64, dice: &mut Dice) {
    recording.rows.retain(|_| dice.share() >= share);
}
