//! The stress up to which scans are proposed.

use super::PlanFileError;
use vibrissa::rod::AnyRod;

/// The largest bending stress that a rod is to bear in a scan.
///
/// There is no default for a material: of two steels with one Young's modulus, one may bear six times the stress of the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LargestStress {
    /// The yield stress of the rod.
    #[default]
    Yield,
    /// This one, Pa.
    Given(f64),
    /// Any.
    Any,
}

impl LargestStress {
    /// The limit for a rod, Pa; none for any stress, or where the diameter of the rod is not known, and with it no stress.
    pub(super) fn limit(self, rod: &AnyRod) -> Result<Option<f64>, PlanFileError> {
        let diameter = rod.uniform().and_then(|rod| rod.diameter()).is_some();
        let is_known = diameter || rod.varying().is_some_and(|rod| rod.bending_stress(0.0, 1.0).is_some());
        let yield_stress = rod.uniform().and_then(|rod| rod.yield_stress());
        match self {
            Self::Any => Ok(None),
            Self::Given(limit) if is_known => Ok(Some(limit)),
            Self::Given(_) => Err(PlanFileError::NoDiameter),
            Self::Yield if is_known => yield_stress.map(Some).ok_or(PlanFileError::NoStress),
            Self::Yield => Ok(None),
        }
    }
}
