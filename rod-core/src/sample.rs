//! What is known of one instant of a scan.

use crate::pose::{Pose, Reactions};

/// Where the clamp was and what it felt, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample<T = f64> {
    /// Time, s, where it is known.
    pub t: Option<T>,
    /// The clamp.
    pub pose: Pose<T>,
    /// What it felt.
    pub reactions: Reactions<T>,
    /// Standard deviations of the reactions, where the sensor tells them.
    pub sigma: Option<Reactions<T>>,
}

impl<T> Sample<T> {
    /// A sample without time and standard deviations.
    ///
    /// ```
    /// use rod_core::{Pose, Reactions, Sample};
    /// let free = Sample::new(Pose { x: 0.0, y: 0.0, phi: 1.5 }, Reactions::default());
    /// assert!(free.t.is_none() && free.sigma.is_none());
    /// ```
    pub fn new(pose: Pose<T>, reactions: Reactions<T>) -> Self {
        Self { t: None, pose, reactions, sigma: None }
    }
}
