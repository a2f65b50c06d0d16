//! The imperfections, one row each, in the order in which a laboratory applies them.

use super::recording::Recording;
use super::sensor::{
    bias, cross_talk, drift, drop_samples, encoder, gain, hum, lag, length, lever, low_pass, non_linear, quantise,
    random_walk, spikes, stage_noise, stage_scale, stiffness,
};
use super::world::World;
use crate::random::dice::Dice;

/// At which point of the measurement an imperfection acts, and how at a multiple of its ordinary level.
pub enum Acts {
    /// On the rod, the clamp and the object.
    World(fn(&mut World, f64, &mut Dice)),
    /// On the readings, before the white noise.
    Before(fn(&mut Recording, f64, &mut Dice)),
    /// On the readings, with the white noise.
    After(fn(&mut Recording, f64, &mut Dice)),
}

/// An imperfection at its ordinary level.
pub struct Imperfection {
    /// A combination of several takes only one of those whose names agree up to a comma.
    pub name: &'static str,
    pub level: &'static str,
    /// Whether it is seen in a fast scan only.
    pub fast: bool,
    pub acts: Acts,
}

const fn slow(name: &'static str, level: &'static str, acts: Acts) -> Imperfection {
    Imperfection { name, level, fast: false, acts }
}

const fn fast(name: &'static str, level: &'static str, acts: Acts) -> Imperfection {
    Imperfection { name, level, fast: true, acts }
}

use Acts::{After, Before, World as Of};

/// All imperfections. Signs and phases are drawn at random.
pub const IMPERFECTIONS: &[Imperfection] = &[
    slow("clamp angle", "0.5 deg", Of(|w, level, dice| w.turned += level * dice.sign() * 0.5_f64.to_radians())),
    slow("elastic clamp", "200 EI/L", Of(|w, level, _| w.compliance = level / 200.0)),
    slow("natural curvature, 0.03", "0.03/L", Of(|w, level, dice| w.curvature = level * dice.sign() * 0.03)),
    slow("natural curvature, 0.01", "0.01/L", Of(|w, level, dice| w.curvature = level * dice.sign() * 0.01)),
    slow("friction", "0.02", Of(|w, level, _| w.friction = level * 0.02)),
    slow("stiffness", "5 %", Before(|r, level, dice| stiffness(r, level * 0.05 * dice.sign()))),
    slow("length", "0.5 %", Before(|r, level, dice| length(r, level * 0.005 * dice.sign()))),
    slow("lever, along", "1 mm", Before(|r, level, dice| lever(r, level * 1e-3 * dice.sign(), 0.0))),
    slow("lever, across", "1 mm", Before(|r, level, dice| lever(r, 0.0, level * 1e-3 * dice.sign()))),
    slow("stage scale", "0.5 %", Before(|r, level, dice| stage_scale(r, level * 0.005 * dice.sign()))),
    fast("lag", "20 ms at 10 mm/s", Before(|r, level, _| lag(r, level * 0.02))),
    slow("stage noise", "5 um", Before(|r, level, dice| stage_noise(r, level * 5e-6, dice))),
    slow("encoder steps", "5 um", Before(|r, level, _| encoder(r, level * 5e-6))),
    slow("gain f0x", "1 %", Before(|r, level, dice| gain(r, 0, level * 0.01 * dice.sign()))),
    slow("gain f0y", "1 %", Before(|r, level, dice| gain(r, 1, level * 0.01 * dice.sign()))),
    slow("gain m0z", "1 %", Before(|r, level, dice| gain(r, 2, level * 0.01 * dice.sign()))),
    slow("cross-talk f0x -> f0y", "0.5 %", Before(|r, level, dice| cross_talk(r, 0, 1, level * 0.005 * dice.sign()))),
    slow("cross-talk f0y -> f0x", "0.5 %", Before(|r, level, dice| cross_talk(r, 1, 0, level * 0.005 * dice.sign()))),
    slow("cross-talk f0x -> m0z", "0.5 %", Before(|r, level, dice| cross_talk(r, 0, 2, level * 0.005 * dice.sign()))),
    slow("cross-talk f0y -> m0z", "0.5 %", Before(|r, level, dice| cross_talk(r, 1, 2, level * 0.005 * dice.sign()))),
    slow("cross-talk m0z -> f0x", "0.5 %", Before(|r, level, dice| cross_talk(r, 2, 0, level * 0.005 * dice.sign()))),
    slow("cross-talk m0z -> f0y", "0.5 %", Before(|r, level, dice| cross_talk(r, 2, 1, level * 0.005 * dice.sign()))),
    slow("non-linearity", "0.5 %", Before(|r, level, dice| non_linear(r, level * 0.005, dice))),
    slow("bias, before tare", "5 mN, 0.3 mN m", Before(|r, level, dice| bias(r, level * 5e-3, level * 0.3e-3, dice))),
    slow("bias, after tare", "1 mN, 0.05 mN m", Before(|r, level, dice| bias(r, level * 1e-3, level * 0.05e-3, dice))),
    slow("drift, before tare", "5 mN, 0.3 mN m", Before(|r, level, dice| drift(r, level * 5e-3, level * 0.3e-3, dice))),
    slow(
        "drift, after tare",
        "1 mN, 0.05 mN m",
        Before(|r, level, dice| drift(r, level * 1e-3, level * 0.05e-3, dice)),
    ),
    slow(
        "random walk",
        "1 mN, 0.05 mN m",
        Before(|r, level, dice| random_walk(r, level * 1e-3, level * 0.05e-3, dice)),
    ),
    slow("hum", "5 mN, 0.2 mN m, 50 Hz", Before(|r, level, dice| hum(r, level * 5e-3, level * 0.2e-3, dice))),
    slow("low-pass", "5 Hz", After(|r, level, _| low_pass(r, level / 5.0))),
    slow("quantisation", "5 mN, 0.2 mN m", After(|r, level, _| quantise(r, level * 5e-3, level * 0.2e-3))),
    slow("spikes", "0.1 %", After(|r, level, dice| spikes(r, level * 1e-3, dice))),
    slow("dropped samples", "1 %", After(|r, level, dice| drop_samples(r, level * 0.01, dice))),
];
