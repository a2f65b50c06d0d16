//! How large the errors may be that all samples of a scan share.

use super::document::ErrorsTable;
use crate::toml_file::Fault;
use toml::Spanned;
use vibrissa::Rod;
use vibrissa::reconstruct::Budget;
use vibrissa::rod::Units;

/// Standard deviations of errors that all samples of a scan share, as a setup states them; none where it does not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SharedErrors {
    /// Bias of the forces, N.
    pub bias_force: Option<f64>,
    /// Bias of the moment, N m.
    pub bias_moment: Option<f64>,
    /// Drift of the forces along a scan, N.
    pub drift_force: Option<f64>,
    /// Drift of the moment along a scan, N m.
    pub drift_moment: Option<f64>,
    /// Relative error of the gain of a channel.
    pub gain: Option<f64>,
    /// Cross-talk between channels, relative to their ranges.
    pub cross_talk: Option<f64>,
    /// Angle of the clamp, radians.
    pub clamp_angle: Option<f64>,
    /// Place of the point to which the moment refers, m.
    pub lever: Option<f64>,
    /// Relative error of the bending stiffness.
    pub stiffness: Option<f64>,
    /// Relative error of the rod's length.
    pub length: Option<f64>,
    /// Natural curvature of the rod, 1/m.
    pub natural_curvature: Option<f64>,
    /// Compliance of the clamp against rotation, rad/(N m).
    pub clamp_compliance: Option<f64>,
    /// Way of the clamp between the time of the reactions and that of the pose, m.
    pub lag: Option<f64>,
    /// Relative error of the scale of the stage.
    pub stage_scale: Option<f64>,
}

impl SharedErrors {
    /// The budget for a rod: that of an ordinary laboratory where nothing is stated.
    pub fn budget(&self, rod: &Rod) -> Budget {
        let usual = Budget::laboratory(rod);
        let channels = |force: Option<f64>, moment: Option<f64>, usual: [f64; 3]| {
            [force.unwrap_or(usual[0]), force.unwrap_or(usual[1]), moment.unwrap_or(usual[2])]
        };
        let Units { length, moment, .. } = rod.units();
        let drift = channels(self.drift_force, self.drift_moment, usual.drift);
        Budget {
            bias: channels(self.bias_force, self.bias_moment, usual.bias),
            drift,
            // in the ratio of an ordinary laboratory
            bow: std::array::from_fn(|c| usual.bow[c] / usual.drift[c] * drift[c]),
            gain: self.gain.map_or(usual.gain, |gain| [gain; 3]),
            cross_talk: self.cross_talk.unwrap_or(usual.cross_talk),
            clamp_angle: self.clamp_angle.unwrap_or(usual.clamp_angle),
            lever: self.lever.unwrap_or(usual.lever),
            stiffness: self.stiffness.unwrap_or(usual.stiffness),
            length: self.length.unwrap_or(usual.length),
            natural_curvature: self.natural_curvature.map_or(usual.natural_curvature, |curvature| curvature * length),
            clamp_compliance: self.clamp_compliance.map_or(usual.clamp_compliance, |compliance| compliance * moment),
            lag: self.lag.unwrap_or(usual.lag),
            stage_scale: self.stage_scale.unwrap_or(usual.stage_scale),
            friction: usual.friction,
        }
    }
}

pub(super) fn errors(table: &ErrorsTable) -> Result<SharedErrors, Fault> {
    let field =
        |name: &str, field: &Option<Spanned<f64>>| match field.as_ref().map(|field| (*field.get_ref(), field.span())) {
            Some((value, place)) if !(value.is_finite() && value >= 0.0) => {
                Err(Fault::new(place, format!("{name} is {value}, expected a standard deviation, 0 or larger")))
            }
            found => Ok(found.map(|found| found.0)),
        };
    Ok(SharedErrors {
        bias_force: field("bias_force", &table.bias_force)?,
        bias_moment: field("bias_moment", &table.bias_moment)?,
        drift_force: field("drift_force", &table.drift_force)?,
        drift_moment: field("drift_moment", &table.drift_moment)?,
        gain: field("gain", &table.gain)?,
        cross_talk: field("cross_talk", &table.cross_talk)?,
        clamp_angle: field("clamp_angle", &table.clamp_angle)?.map(f64::to_radians),
        lever: field("lever", &table.lever)?,
        stiffness: field("stiffness", &table.stiffness)?,
        length: field("length", &table.length)?,
        natural_curvature: field("natural_curvature", &table.natural_curvature)?,
        clamp_compliance: field("clamp_compliance", &table.clamp_compliance)?,
        lag: field("lag", &table.lag)?,
        stage_scale: field("stage_scale", &table.stage_scale)?,
    })
}
