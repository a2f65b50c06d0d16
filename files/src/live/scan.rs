//! What a live scan is made with.

use super::stage::{StageDelay, StageSpec};
use crate::{ReadOptions, Setup};
use std::path::PathBuf;
use vibrissa::reconstruct::{Budget, Known};
use vibrissa::{ClampPath, Rod};

/// A scan to be made with a sensor.
#[derive(Clone, Debug)]
pub struct LiveScan {
    /// The rod.
    pub rod: Rod,
    /// How large the errors may be that all samples share.
    pub budget: Budget,
    /// What a calibration says of them.
    pub known: Known,
    /// How the sensor is set up.
    pub setup: Setup,
    /// How the clamp moves; none where the samples contain its poses.
    pub stage: Option<StageSpec>,
    /// Delay of the clock of a stage's table, in place of that of the setup.
    pub stage_delay: Option<StageDelay>,
    /// Its path, which a constant speed needs.
    pub path: Option<ClampPath>,
    /// How the table of a stage is written.
    pub read: ReadOptions,
    /// Files that are read, which must not be overwritten.
    pub inputs: Vec<PathBuf>,
}

impl LiveScan {
    /// Delay of the clock of a stage's table: that which is given, or that of the setup; none where neither states one.
    pub fn delay(&self) -> Option<StageDelay> {
        self.stage_delay.or(self.setup.stage_delay)
    }
}
