//! The setup as written: names, types and spans.

use serde::Deserialize;
use toml::{Spanned, Value};

/// A setup file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SetupDocument {
    #[serde(default)]
    pub sensor: SensorTable,
    #[serde(default)]
    pub mounting: MountingTable,
    #[serde(default)]
    pub accuracy: AccuracyTable,
    #[serde(default)]
    pub tare: TareTable,
    #[serde(default)]
    pub identification: IdentificationTable,
    #[serde(default)]
    pub stage: StageClockTable,
    #[serde(default)]
    pub recording: RecordingTable,
    pub errors: Option<ErrorsTable>,
}

/// `[errors]`: how large the errors may be that all samples of a scan share, as standard deviations.
#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ErrorsTable {
    pub bias_force: Option<Spanned<f64>>,
    pub bias_moment: Option<Spanned<f64>>,
    pub drift_force: Option<Spanned<f64>>,
    pub drift_moment: Option<Spanned<f64>>,
    pub gain: Option<Spanned<f64>>,
    pub cross_talk: Option<Spanned<f64>>,
    pub clamp_angle: Option<Spanned<f64>>,
    pub lever: Option<Spanned<f64>>,
    pub stiffness: Option<Spanned<f64>>,
    pub length: Option<Spanned<f64>>,
    pub natural_curvature: Option<Spanned<f64>>,
    pub clamp_compliance: Option<Spanned<f64>>,
    pub lag: Option<Spanned<f64>>,
    pub stage_scale: Option<Spanned<f64>>,
}

/// `[sensor]`: what it sends.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SensorTable {
    pub profile: Option<Spanned<String>>,
    pub rate: Option<Spanned<f64>>,
    pub force_unit: Option<Spanned<String>>,
    pub torque_unit: Option<Spanned<String>>,
    pub counts_per_force_unit: Option<Spanned<f64>>,
    pub counts_per_torque_unit: Option<Spanned<f64>>,
    pub channels: Option<Spanned<Vec<String>>>,
    pub calibration: Option<Spanned<String>>,
    pub part: Option<Spanned<String>>,
    pub compensate: Option<Spanned<bool>>,
    pub matrix: Option<Spanned<Vec<Spanned<Vec<f64>>>>>,
    pub components: Option<Spanned<Vec<String>>>,
    pub bias: Option<Spanned<Vec<f64>>>,
}

/// `[mounting]`: how it sits under the clamp.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MountingTable {
    pub angle: Option<Spanned<f64>>,
    pub axes: Option<Spanned<Vec<String>>>,
    pub lever: Option<Spanned<Vec<f64>>>,
    pub lever_tolerance: Option<Spanned<f64>>,
    pub sense: Option<Spanned<String>>,
    pub turns_from: Option<Spanned<f64>>,
    pub most_force_across: Option<Spanned<f64>>,
    pub most_moment_across: Option<Spanned<f64>>,
}

/// `[accuracy]`: how far it can be trusted.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AccuracyTable {
    pub force_range: Option<Spanned<f64>>,
    pub torque_range: Option<Spanned<f64>>,
    pub force_class: Option<Spanned<f64>>,
    pub torque_class: Option<Spanned<f64>>,
    pub force_sigma: Option<Spanned<f64>>,
    pub torque_sigma: Option<Spanned<f64>>,
}

/// `[tare]`: the window without contact that a scan begins with.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TareTable {
    pub seconds: Option<Spanned<f64>>,
    pub force_change: Option<Spanned<f64>>,
    pub torque_change: Option<Spanned<f64>>,
}

/// `[identification]`: how contacts and phases are told.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct IdentificationTable {
    pub half_window: Option<Spanned<f64>>,
}

/// `[stage]`: its clock.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StageClockTable {
    pub delay: Option<Spanned<f64>>,
}

/// `[recording]`: what of a recording is meant.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordingTable {
    pub columns: Option<Spanned<Vec<String>>>,
    pub group: Option<Spanned<String>>,
    pub time: Option<Spanned<Value>>,
    pub topic: Option<Spanned<String>>,
}
