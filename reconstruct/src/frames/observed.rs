//! The observations of a frame, dimensionless.

use super::observation::{Channel, Frame, Measurand, SeenPoint};
use super::pole::Pole;
use rod_core::{Clamp, PhysicalRod, Pose, Units};

/// What the least squares see of a frame.
#[derive(Clone)]
pub(super) struct Observed {
    pub dots: Vec<Dot>,
    pub channels: Vec<Measured>,
    /// Displacement (x, y, phi) of the base per reaction; 0 on a rigid clamp.
    pub compliance: [[f64; 3]; 3],
    /// Whether the first dot is the base, and the last one the tip.
    pub ends: [bool; 2],
    /// A pole that a single contact is at.
    pub pole: Option<Pole>,
}

/// A point on the rod, lengths in L.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dot {
    pub at: [f64; 2],
    pub sigma: f64,
    /// Its arc length, where that is known.
    pub s: Option<f64>,
}

/// A measured number and its standard deviation, dimensionless.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub quantity: Measurand,
    pub value: f64,
    pub sigma: f64,
}

impl Observed {
    /// The observations of `frame`; points of unknown noise have that of the film, `sigma` (L).
    ///
    /// Both ends are held in place only where the points cannot tell an apparent shortening: a film that sees both ends lets the tip lie where
    /// it does.
    pub fn new<R: PhysicalRod>(frame: &Frame, rod: &R, sigma: f64) -> Self {
        let units = rod.units();
        let length = units.length;
        let mut dots: Vec<Dot> = frame
            .points
            .iter()
            .map(|&SeenPoint { x, y, sigma: own }| Dot {
                at: [x / length, y / length],
                sigma: own.map_or(sigma, |own| own / length),
                s: None,
            })
            .collect();
        if let Some(first) = dots.first_mut().filter(|_| frame.base_is_first) {
            first.s = Some(0.0);
        }
        if let Some(last) = dots.last_mut().filter(|_| frame.tip_is_last && !frame.base_is_first) {
            last.s = Some(1.0);
        }
        let held = rod.clamp(Pose { x: 0.0, y: 0.0, phi: 0.0 });
        Self {
            dots,
            channels: frame.channels.iter().map(|channel| dimensionless(channel, &units)).collect(),
            compliance: held.law().map_or([[0.0; 3]; 3], |law| law.compliance),
            ends: [frame.base_is_first, frame.tip_is_last],
            pole: None,
        }
    }

    /// The same with no channel or pole more exact than `floor`.
    pub fn blurred(&self, floor: f64) -> Self {
        let blur = |channel: &Measured| Measured { sigma: channel.sigma.max(floor), ..*channel };
        let pole = self.pole.map(|pole| Pole { sigma: pole.sigma.max(floor), ..pole });
        Self { dots: self.dots.clone(), channels: self.channels.iter().map(blur).collect(), pole, ..*self }
    }

    /// The most exact channel, or the pole.
    pub fn most_exact(&self) -> f64 {
        let pole = self.pole.map_or(f64::INFINITY, |pole| pole.sigma);
        self.channels.iter().fold(pole, |least, channel| least.min(channel.sigma))
    }

    /// The value of a channel, where there is one for this quantity.
    pub fn channel(&self, quantity: Measurand) -> Option<f64> {
        self.channels.iter().find(|channel| channel.quantity == quantity).map(|channel| channel.value)
    }
}

fn dimensionless(channel: &Channel, units: &Units) -> Measured {
    let Units { length, force, moment, curvature, .. } = *units;
    let Channel { quantity, value, sigma } = *channel;
    let (quantity, unit) = match quantity {
        // in the unit of its largest weight, so that value and sigma are of the order of the reactions
        Measurand::Reaction([x, y, z]) => {
            let weights = [x * force, y * force, z * moment];
            let unit = weights.iter().fold(f64::MIN_POSITIVE, |most, weight| most.max(weight.abs()));
            (Measurand::Reaction(weights.map(|weight| weight / unit)), unit)
        }
        Measurand::Curvature(s) => (Measurand::Curvature(s / length), curvature),
        Measurand::Marker(s, axis) => (Measurand::Marker(s / length, axis), unit_of(axis, length)),
        Measurand::Base(axis) | Measurand::Support(axis) => (quantity, unit_of(axis, length)),
    };
    Measured { quantity, value: value / unit, sigma: sigma / unit }
}

fn unit_of(axis: super::Axis, length: f64) -> f64 {
    if axis == super::Axis::Angle { 1.0 } else { length }
}
