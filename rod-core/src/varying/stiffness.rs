//! The models of rods by how their stiffness varies.

use super::cones::Cones;
use super::natural_curvature::{Curvature, Function};
use crate::error::RodError;
use crate::model::{Bent, Cone, Profile, RodModel, RodSection, Sections, Smooth};
use crate::physical::RodParameter;
use std::sync::Arc;

/// A rod of any model, dimensionless.
pub(super) type Model = Arc<dyn RodModel + Send + Sync>;

/// How the stiffness varies, dimensionless.
#[derive(Clone)]
pub(super) enum Stiffness {
    Sections(Vec<RodSection>),
    Cone(Cone),
    Cones(Cones),
    Function { function: Function, borders: Vec<f64> },
}

impl Stiffness {
    /// The rod with this stiffness, straight at rest or with the natural curvature of its sections.
    pub fn model(&self) -> Result<Model, RodError> {
        match self {
            Self::Sections(sections) => Ok(Arc::new(Sections::new(sections)?)),
            _ => self.bent(Curvature::Constant(0.0)),
        }
    }

    /// The rod with this stiffness and another natural curvature.
    pub fn bent(&self, curvature: Curvature) -> Result<Model, RodError> {
        if let (Self::Sections(sections), &Curvature::Constant(natural_curvature)) = (self, &curvature) {
            let bent = |section: &RodSection| RodSection { natural_curvature, ..*section };
            return Ok(Arc::new(Sections::new(&sections.iter().map(bent).collect::<Vec<_>>())?));
        }
        let (natural, breaks) = curvature.function();
        let natural = move |s: f64| natural(s);
        Ok(match self.clone() {
            Self::Sections(sections) => {
                let steps = Steps::new(&sections);
                let borders = merged(&steps.joints, &breaks);
                Arc::new(Smooth::with_borders(Bent::new(steps, natural), &borders)?)
            }
            Self::Cone(cone) => Arc::new(Smooth::with_borders(Bent::new(cone, natural), &merged(&[], &breaks))?),
            Self::Cones(cones) => {
                let borders = merged(&cones.joints, &breaks);
                Arc::new(Smooth::with_borders(Bent::new(cones, natural), &borders)?)
            }
            Self::Function { function, borders } => {
                let borders = merged(&borders, &breaks);
                Arc::new(Smooth::with_borders(Bent::new(move |s: f64| function(s), natural), &borders)?)
            }
        })
    }
}

impl Stiffness {
    /// The change of the curvature at arc length `s` under `moment` per unit of a parameter, dimensionless; none where there is no such
    /// parameter.
    pub fn curvature_rate(&self, parameter: RodParameter, s: f64, moment: f64) -> Option<f64> {
        match (self, parameter) {
            (_, RodParameter::NaturalCurvature) => Some(1.0),
            (Self::Cone(Cone { taper }), RodParameter::Taper) => Some(4.0 * s * moment * (1.0 - taper * s).powi(-5)),
            (Self::Sections(sections), RodParameter::SectionStiffness(i) | RodParameter::SectionCurvature(i)) => {
                let stiffness = sections.get(i)?.bending_stiffness;
                let from: f64 = sections[..i].iter().map(|section| section.length).sum();
                // the first and the last one have no end
                let is_here = (i == 0 || s >= from) && (i + 1 == sections.len() || s < from + sections[i].length);
                let by_stiffness = matches!(parameter, RodParameter::SectionStiffness(_));
                Some(match (is_here, by_stiffness) {
                    (false, _) => 0.0,
                    (true, true) => -moment / (stiffness * stiffness),
                    (true, false) => 1.0,
                })
            }
            _ => None,
        }
    }
}

/// The borders of both, in order, those of the second that are on the rod.
fn merged(borders: &[f64], breaks: &[f64]) -> Vec<f64> {
    let inner = breaks.iter().filter(|s| **s > 0.0 && **s < 1.0 && !borders.contains(s));
    let mut all: Vec<f64> = borders.iter().chain(inner).copied().collect();
    // borders out of order are for the caller to complain about
    if all.len() > borders.len() {
        all.sort_by(f64::total_cmp);
    }
    all
}

/// A stiffness that is constant between joints.
struct Steps {
    joints: Vec<f64>,
    stiffness: Vec<f64>,
}

impl Steps {
    fn new(sections: &[RodSection]) -> Self {
        let mut end = 0.0;
        let mut joints: Vec<f64> = Vec::new();
        for section in &sections[..sections.len().saturating_sub(1)] {
            end += section.length;
            joints.push(end);
        }
        Self { joints, stiffness: sections.iter().map(|section| section.bending_stiffness).collect() }
    }
}

impl Profile for Steps {
    fn stiffness(&self, s: f64) -> f64 {
        self.stiffness[self.joints.partition_point(|&joint| joint <= s)]
    }
    fn is_monotonic(&self) -> bool {
        true
    }
}
