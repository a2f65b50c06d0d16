//! Rods made of sections, each of constant stiffness and natural curvature: the closed form, section by section.

use crate::error::RodError;
use crate::model::constant::Constant;
use crate::model::interval::{
    Chain, largest_curvature, moment_range, piece_at, pieces, product, sign_between, sign_of_range, union,
};
use crate::model::{Cut, CutSensitivities, RodModel};
use crate::segment::Segment;

/// By how much the lengths of the sections of a rod of length 1 may miss it: rounding of some hundred lengths.
const ADDING_UP: f64 = 1e-12;

/// Largest ratio of the stiffness of two sections: that of the ends of a cone with 100 times the diameter. With more, rounding of the stiff
/// section moves the soft one.
const MOST_VARIED: f64 = 1e8;

/// A section of a rod, uniform in itself. In SI units for [`Rod::sections`](crate::Rod::sections), dimensionless for [`Sections`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodSection {
    /// Length, m.
    pub length: f64,
    /// Bending stiffness E I, N m^2.
    pub bending_stiffness: f64,
    /// Curvature at rest, 1/m, positive where the rod turns counter-clockwise from the clamp to the tip.
    pub natural_curvature: f64,
}

/// A rod of sections, in each of which stiffness and natural curvature are constant: exact, at the price of one closed form for each
/// section that an interval passes. A single section is a uniform rod that may be bent at rest.
///
/// ```
/// use rod_core::{Cut, RodModel, RodSection, Sections};
/// // the outer half is four times softer, and a quarter circle of radius 1 / pi at rest
/// let inner = RodSection { length: 0.5, bending_stiffness: 1.0, natural_curvature: 0.0 };
/// let outer = RodSection { length: 0.5, bending_stiffness: 0.25, natural_curvature: std::f64::consts::PI };
/// let rod = Sections::new(&[inner, outer])?;
/// let tip = rod.carry(0.0, &Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 }, 0.0, 0.0, 1.0);
/// assert!((tip.x - 0.5 - std::f64::consts::FRAC_1_PI).abs() < 1e-15 && (tip.phi - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Sections {
    /// Where one section ends and the next begins.
    joints: Vec<f64>,
    parts: Vec<Constant>,
}

impl Sections {
    /// A rod of sections from the clamp to the tip, dimensionless: their lengths add up to 1.
    ///
    /// # Errors
    /// [`RodError::Section`] where a length or stiffness is not a positive, finite number, or a natural curvature is not finite;
    /// [`RodError::SectionsLength`] where the lengths do not add up to 1.
    pub fn new(sections: &[RodSection]) -> Result<Self, RodError> {
        let total = check_sections(sections)?;
        if (total - 1.0).abs() > ADDING_UP {
            return Err(RodError::SectionsLength { total, expected: 1.0 });
        }
        let mut end = 0.0;
        let ends = sections.iter().map(|section| {
            end += section.length;
            end
        });
        Ok(Self {
            joints: ends.take(sections.len() - 1).collect(),
            parts: sections
                .iter()
                .map(|section| Constant {
                    stiffness: section.bending_stiffness,
                    natural_curvature: section.natural_curvature,
                })
                .collect(),
        })
    }

    /// The parts that an interval passes: the section, and where it begins and ends.
    fn passed(&self, from: f64, to: f64, mut show: impl FnMut(&Constant, f64, f64)) {
        pieces(&self.joints, from, to, |i, from, to| show(&self.parts[i], from, to));
    }

    /// Shows the parts of a segment, each with its end.
    fn parts_of(&self, segment: &Segment<Cut>, to: f64, mut show: impl FnMut(&Constant, &Segment<Cut>, f64, &Cut)) {
        let mut start = segment.start;
        self.passed(segment.s, to, |part, from, to| {
            let end = part.carry(&start, segment.a, segment.b, to - from);
            show(part, &Segment { s: from, start, ..*segment }, to, &end);
            start = end;
        });
    }
}

/// The length of all sections, each of which is a rod.
pub(crate) fn check_sections(sections: &[RodSection]) -> Result<f64, RodError> {
    for (index, section) in sections.iter().enumerate() {
        let RodSection { length, bending_stiffness, natural_curvature } = *section;
        let wrong = |what, value, expected| Err(RodError::Section { index, what, value, expected });
        if !(length > 0.0 && length.is_finite()) {
            return wrong("length", length, "a positive, finite number");
        }
        if !(bending_stiffness > 0.0 && bending_stiffness.is_finite() && (1.0 / bending_stiffness).is_finite()) {
            return wrong("bending_stiffness", bending_stiffness, "a positive, finite number");
        }
        let ratio = bending_stiffness / sections[0].bending_stiffness;
        if !(1.0 / MOST_VARIED..=MOST_VARIED).contains(&ratio) {
            return wrong(
                "bending_stiffness",
                bending_stiffness,
                "between 1e-8 and 1e8 times that of the first section",
            );
        }
        if !natural_curvature.is_finite() {
            return wrong("natural_curvature", natural_curvature, "a finite number");
        }
    }
    let total = sections.iter().map(|section| section.length).sum();
    if sections.is_empty() {
        Err(RodError::NotPositive { what: "the number of sections", value: 0.0 })
    } else {
        Ok(total)
    }
}

impl RodModel for Sections {
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        let (mut end, mut chain) = (*start, Chain::new());
        // at both ends, each on the side of the interval
        let mut curvatures = None;
        self.passed(s, s + length, |part, from, to| {
            let first = curvatures.map_or_else(|| part.curvature(end.moment), |(first, _)| first);
            let (next, d) = part.carry_with_sensitivities(&end, a, b, to - from);
            chain.then(&d);
            end = next;
            curvatures = Some((first, part.curvature(end.moment)));
        });
        let (kappa_start, kappa_end) = curvatures.unwrap_or_default();
        (end, chain.finish((start, kappa_start), (&end, kappa_end), a, b))
    }

    fn carry(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        let mut end = *start;
        self.passed(s, s + length, |part, from, to| end = part.carry(&end, a, b, to - from));
        end
    }

    fn curvature_at(&self, s: f64, moment: f64) -> f64 {
        self.parts[piece_at(&self.joints, s)].curvature(moment)
    }

    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, _end: &Cut) -> f64 {
        let mut sum = 0.0;
        self.parts_of(segment, to, |part, segment, to, end| sum += part.bending_energy(segment, to, end));
        sum
    }

    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        let (moments, length) = ([from.1, to.1], to.0 - from.0);
        let mut bent: f64 = 0.0;
        self.passed(from.0, to.0, |part, _, _| {
            let natural = (part.natural_curvature, part.natural_curvature);
            bent = bent.max(largest_curvature(moments, force, length, 1.0 / part.stiffness, natural));
        });
        let moment = moment_range(moments, force, length, bent);
        let mut all = (f64::INFINITY, f64::NEG_INFINITY);
        self.passed(from.0, to.0, |part, _, _| {
            let (low, high) = product(moment, (1.0 / part.stiffness, 1.0 / part.stiffness));
            all = union(all, (low + part.natural_curvature, high + part.natural_curvature));
        });
        all
    }

    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        let (length, mut passed, mut bent, mut compliance) = (to.0 - from.0, 0, [0.0; 2], 0.0_f64);
        self.passed(from.0, to.0, |part, _, _| {
            passed += 1;
            bent = [from.1, to.1].map(|moment| part.curvature(moment));
            compliance = compliance.max(1.0 / part.stiffness);
        });
        if passed == 1 {
            return sign_between(bent, force * compliance, length);
        }
        if self.is_straight() {
            return sign_between([from.1, to.1], force * compliance, length);
        }
        sign_of_range(self.curvature_bounds(from, to, force))
    }

    fn least_stiffness(&self, from: f64, to: f64) -> f64 {
        let mut least = f64::INFINITY;
        self.passed(from, to, |part, _, _| least = least.min(part.stiffness));
        least
    }

    fn joints(&self) -> &[f64] {
        &self.joints
    }

    fn is_straight(&self) -> bool {
        self.parts.iter().all(|part| part.natural_curvature == 0.0)
    }

    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, _end: &Cut) -> f64 {
        let mut most: f64 = 0.0;
        self.parts_of(segment, to, |part, segment, to, end| most = most.max(part.largest_curvature(segment, to, end)));
        most
    }
}
