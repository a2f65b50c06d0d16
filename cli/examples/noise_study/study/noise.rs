//! The sensors.

use vibrissa::reconstruct::{Ar1, NoiseModel};
use vibrissa::rod::Reactions;

/// A noise level.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// In file names.
    pub name: &'static str,
    /// Standard deviation of both forces, N.
    pub force: f64,
    /// Standard deviation of the moment, N m.
    pub moment: f64,
}

/// Whether the noise remembers.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// In tables and file names.
    pub name: &'static str,
    /// Correlation of neighbouring samples.
    pub correlation: f64,
}

/// A strain gauge at the base of a whisker, an industrial six-axis sensor, and the bound that a class 0.5 sensor of 2 N
/// states.
pub const LEVELS: [Level; 3] = [
    Level { name: "0.2mN", force: 0.2e-3, moment: 0.02e-3 },
    Level { name: "2.5mN", force: 2.5e-3, moment: 0.06e-3 },
    Level { name: "10mN", force: 10e-3, moment: 0.5e-3 },
];

/// White noise, and the correlation that a strain gauge was seen to have.
pub const NOISES: [Noise; 2] = [Noise { name: "white", correlation: 0.0 }, Noise { name: "AR(1)", correlation: 0.45 }];

impl Level {
    /// A sensor that reads the truth.
    pub const CLEAN: Self = Self { name: "clean", force: 0.0, moment: 0.0 };

    /// The sensor with this noise.
    pub fn model(&self, noise: &Noise) -> NoiseModel {
        let sigma = Reactions { f0x: self.force, f0y: self.force, m0z: self.moment };
        if noise.correlation == 0.0 {
            NoiseModel { white: sigma, ..NoiseModel::default() }
        } else {
            NoiseModel { ar1: Ar1 { sigma, correlation: noise.correlation }, ..NoiseModel::default() }
        }
    }

    /// As in the tables.
    pub fn title(&self) -> String {
        if self.force == 0.0 {
            return self.name.to_owned();
        }
        let [force, moment] = [self.force, self.moment].map(|sigma| (1e6 * sigma).round() / 1e3);
        format!("{force} mN / {moment} mN m")
    }
}

impl Noise {
    /// Variance of a long mean, times the number of samples, over the variance of one sample.
    pub fn long_run(&self) -> f64 {
        (1.0 + self.correlation) / (1.0 - self.correlation)
    }
}
