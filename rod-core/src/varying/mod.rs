//! Rods that are not uniform or not straight at rest, made from SI units.

mod cones;
mod natural_curvature;
mod stiffness;
mod stress;

use crate::elastica::Elastica;
use crate::error::{RodError, finite};
use crate::model::{Cone, Cut, CutSensitivities, RodModel, RodSection, check_sections};
use crate::physical::{PhysicalRod, RodParameter};
use crate::pose::Pose;
use crate::rod::{Rod, positive};
use crate::segment::Segment;
use crate::units::Units;
use cones::Cones;
use natural_curvature::{Curvature, Function};
use std::sync::Arc;
use stiffness::{Model, Stiffness};
use stress::Diameters;

pub use natural_curvature::NaturalCurvature;

/// By how much the lengths of sections may miss their sum, relative: rounding of some hundred lengths.
const ROUNDING: f64 = 1e-13;
/// Chords of the shape at rest that are compared with each other.
const CHORDS: usize = 400;
/// Largest angle (rad) by which a rod turns at rest: a chord turns by a quarter of a radian at most, on average.
const MOST_TURN: f64 = 100.0;
/// Largest ratio of the diameters of a cone. The stiffness then varies by a factor of 1e8, and its rounding by 100.
const MOST_TAPERED: f64 = 100.0;

/// An inextensible, unshearable rod (Euler-Bernoulli) whose bending stiffness or natural curvature varies along it.
///
/// [`Rod::tapered`], [`Rod::sections`], [`Rod::varying`] and [`Rod::with_natural_curvature`] make it from SI units. It is a
/// [`RodModel`], in units of its length and of its stiffness at the clamp: [`units`](Self::units) converts.
///
/// ```
/// use rod_core::{GeneralElastica, Load, Pose, Rod};
/// // a whisker, 40 mm long, 0.1 mm thick at the base and 0.02 mm at the tip, with a radius of 50 mm at rest
/// let whisker = Rod::tapered(0.04, 1e-4, 2e-5, 3e9)?.with_natural_curvature(20.0)?;
/// let clamp = Pose { x: 0.0, y: 0.0, phi: 0.0 };
/// // 1 uN across it at three quarters of its length, towards -y
/// let load = Load { s: 0.03, force: 1e-6, alpha: 0.0 };
/// let (shape, _) = GeneralElastica::under_loads(&whisker, whisker.units(), clamp, &[load])?;
/// let reactions = shape.reactions();
/// assert!((reactions.f0y - 1e-6).abs() < 1e-18 && reactions.m0z > 0.0); // N, N m
/// // beyond the load the rod is bent as at rest
/// assert!((shape.at(0.04)?.kappa - 20.0).abs() < 1e-9); // 1/m
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone)]
pub struct VaryingRod {
    /// Length and stiffness at the clamp.
    at_clamp: Rod,
    stiffness: Stiffness,
    model: Model,
    diameters: Option<Diameters>,
}

impl Rod {
    /// A wire of `length` (m) whose diameter falls linearly from `base_diameter` at the clamp to `tip_diameter` (m), of
    /// `youngs_modulus` (Pa): E I = E pi d^4 / 64. The tip may be the thick end.
    ///
    /// ```
    /// use rod_core::Rod;
    /// let message = Rod::tapered(0.04, 1e-4, 0.0, 3e9).unwrap_err().to_string();
    /// assert_eq!(message, "tip_diameter is 0, expected a positive, finite number");
    /// ```
    ///
    /// # Errors
    /// [`RodError::NotPositive`] where one of the four is not a positive, finite number, [`RodError::TooThick`] where a diameter is
    /// larger than the length, and [`RodError::TooTapered`] where one diameter is more than 100 times the other.
    pub fn tapered(
        length: f64,
        base_diameter: f64,
        tip_diameter: f64,
        youngs_modulus: f64,
    ) -> Result<VaryingRod, RodError> {
        positive("diameter at the clamp", base_diameter)?;
        positive("tip_diameter", tip_diameter)?;
        let at_clamp = Self::from_diameter(length, base_diameter, youngs_modulus)?;
        if tip_diameter > length {
            return Err(RodError::TooThick { diameter: tip_diameter, length });
        }
        let ratio = tip_diameter / base_diameter;
        if !(1.0 / MOST_TAPERED..=MOST_TAPERED).contains(&ratio) {
            return Err(RodError::TooTapered { tip_diameter, base_diameter });
        }
        // a taper of exactly 0 where the diameters are equal
        let taper = (base_diameter - tip_diameter) / base_diameter;
        VaryingRod::new(at_clamp, Stiffness::Cone(Cone { taper }))
    }

    /// A wire of `length` (m) and `youngs_modulus` (Pa) whose diameter was measured in several places: `points` of arc length (m, from the clamp)
    /// and diameter (m), from 0 to the length, with straight lines between them. E I = E pi d^4 / 64. Two points are [`Rod::tapered`], to the last
    /// bit.
    ///
    /// ```
    /// use rod_core::Rod;
    /// let whisker = Rod::from_diameters(0.04, &[[0.0, 1e-4], [0.01, 0.9e-4], [0.04, 2e-5]], 3e9)?;
    /// let message = Rod::from_diameters(0.04, &[[0.0, 1e-4], [0.01, 0.0], [0.03, 2e-5]], 3e9).unwrap_err().to_string();
    /// assert_eq!(
    ///     message,
    ///     "diameter of point 2 is 0.0 m, expected a positive, finite number; \
    ///      point 3 of diameter has the arc length 0.03 m, expected 0.04 m, the length of the rod"
    /// );
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    ///
    /// # Errors
    /// [`RodError::NotPositive`] where length or modulus are not positive, finite numbers; [`RodError::Diameters`] where there are fewer than two
    /// points, arc lengths do not grow from 0 to the length, diameters are not positive and finite, larger than the length, or more than 100 times
    /// larger or smaller than that at the clamp; [`RodError::Step`] where the diameter changes too fast: tenfold within 1e-3 of
    /// the length, or at all within 1e-12.
    pub fn from_diameters(length: f64, points: &[[f64; 2]], youngs_modulus: f64) -> Result<VaryingRod, RodError> {
        positive("length", length)?;
        cones::check(length, points)?;
        positive("youngs_modulus", youngs_modulus)?;
        if let [[_, base], [_, tip]] = *points {
            return Self::tapered(length, base, tip, youngs_modulus);
        }
        let at_clamp = Self::from_diameter(length, points[0][1], youngs_modulus)?;
        VaryingRod::new(at_clamp, Stiffness::Cones(Cones::new(length, points))).map_err(|error| match error {
            RodError::NotSmooth { .. } | RodError::Border { .. } | RodError::Stiffness { .. } => cones::step(points),
            error => error,
        })
    }

    /// A rod of `length` (m) that consists of sections from the clamp to the tip, each of constant stiffness and natural curvature.
    ///
    /// ```
    /// use rod_core::{Rod, RodSection};
    /// // a wire with a softer end
    /// let wire = RodSection { length: 0.06, bending_stiffness: 6e-4, natural_curvature: 0.0 };
    /// let end = RodSection { length: 0.04, bending_stiffness: 1e-4, natural_curvature: 0.0 };
    /// let rod = Rod::sections(0.1, &[wire, end])?;
    /// let message = Rod::sections(0.2, &[wire, end]).unwrap_err().to_string();
    /// assert_eq!(message, "the lengths of the sections add up to 0.1, expected 0.2, the length of the rod");
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    ///
    /// # Errors
    /// [`RodError::Section`] where a length or stiffness is not a positive, finite number, or a natural curvature is not finite;
    /// [`RodError::SectionsLength`] where the lengths do not add up to that of the rod; [`RodError::NotPositive`] where there is no
    /// section, or where a [unit](Self::units) is not a positive, finite number.
    pub fn sections(length: f64, sections: &[RodSection]) -> Result<VaryingRod, RodError> {
        positive("length", length)?;
        let total = check_sections(sections)?;
        if (total - length).abs() > ROUNDING * length {
            return Err(RodError::SectionsLength { total, expected: length });
        }
        VaryingRod::of_sections(length, sections)
    }

    /// A rod of `length` (m) whose `bending_stiffness` (N m^2) is a function of the arc length (m, from the clamp). It is smooth but
    /// at `borders` (m), which grow from the clamp to the tip.
    ///
    /// ```
    /// use rod_core::Rod;
    /// // softer towards the tip, and half as stiff from 80 mm on
    /// let stiffness = |s: f64| if s < 0.08 { 1e-3 * (-9.0 * s).exp() } else { 0.5e-3 * (-9.0 * s).exp() };
    /// assert!(Rod::varying(0.1, stiffness, &[0.08]).is_ok());
    /// // a jump that nobody told
    /// assert!(Rod::varying(0.1, stiffness, &[]).unwrap_err().to_string().contains("not smooth near arc length 0.07"));
    /// ```
    ///
    /// # Errors
    /// [`RodError::NotPositive`] for the length, [`RodError::Stiffness`] where a stiffness is not a positive, finite number,
    /// [`RodError::NotSmooth`] near a jump or kink that is not among the borders, [`RodError::Border`] for borders out of order; all
    /// with the place in m.
    pub fn varying(
        length: f64,
        bending_stiffness: impl Fn(f64) -> f64 + Send + Sync + 'static,
        borders: &[f64],
    ) -> Result<VaryingRod, RodError> {
        positive("length", length)?;
        let clamp = bending_stiffness(0.0);
        positive("bending_stiffness at arc length 0", clamp)?;
        let function: Function = Arc::new(move |s| bending_stiffness(s * length) / clamp);
        let borders = borders.iter().map(|border| border / length).collect();
        VaryingRod::new(Self::new(length, clamp)?, Stiffness::Function { function, borders })
    }

    /// The same rod, bent at rest. A curvature that is a number keeps the closed form; one that is a function has to be smooth. The
    /// yield stress does not go along.
    ///
    /// ```
    /// use rod_core::Rod;
    /// let rod = Rod::new(0.1, 1e-3)?;
    /// let (arc, coil) = (rod.with_natural_curvature(5.0)?, rod.with_natural_curvature(|s: f64| 200.0 * s)?);
    /// # Ok::<(), rod_core::RodError>(())
    /// ```
    ///
    /// # Errors
    /// As [`VaryingRod::with_natural_curvature`].
    pub fn with_natural_curvature(self, curvature: impl Into<NaturalCurvature>) -> Result<VaryingRod, RodError> {
        let uniform =
            RodSection { length: self.length(), bending_stiffness: self.bending_stiffness(), natural_curvature: 0.0 };
        let rod = VaryingRod::of_sections(self.length(), &[uniform])?.with_natural_curvature(curvature)?;
        match self.diameter() {
            Some(diameter) => rod.with_section_diameters(&[diameter]),
            None => Ok(rod),
        }
    }
}

impl VaryingRod {
    /// Of sections that have been checked.
    fn of_sections(length: f64, sections: &[RodSection]) -> Result<Self, RodError> {
        let clamp = sections.first().map_or(f64::NAN, |first| first.bending_stiffness);
        let at_clamp = Rod::new(length, clamp)?;
        let dimensionless = |section: &RodSection| RodSection {
            length: section.length / length,
            bending_stiffness: section.bending_stiffness / clamp,
            natural_curvature: section.natural_curvature * length,
        };
        Self::new(at_clamp, Stiffness::Sections(sections.iter().map(dimensionless).collect()))
    }

    fn new(at_clamp: Rod, stiffness: Stiffness) -> Result<Self, RodError> {
        let model = stiffness.model().and_then(open).map_err(|error| in_si(error, &at_clamp))?;
        let diameters = match (&stiffness, at_clamp.diameter()) {
            (Stiffness::Cone(Cone { taper }), Some(clamp)) => Some(Diameters::Cone { clamp, taper: *taper }),
            (Stiffness::Cones(cones), Some(clamp)) => Some(Diameters::Cones { clamp, cones: cones.clone() }),
            _ => None,
        };
        Ok(Self { at_clamp, stiffness, model, diameters })
    }

    /// The same rod with another curvature at rest (1/m) than it has: a number, or a smooth function of the arc length (m), which may
    /// jump at the joints of sections and the borders of [`Rod::varying`].
    ///
    /// # Errors
    /// [`RodError::NotFinite`] for a number and [`RodError::NaturalCurvature`] for a function that is not finite,
    /// [`RodError::CurvatureEnd`] for points that do not go from 0 to the length, [`RodError::NotSmooth`] near a jump or kink, [`RodError::CrossesItself`] where the rod has a loop at rest, [`RodError::Coiled`]
    /// where it turns by more than 100 rad.
    pub fn with_natural_curvature(self, curvature: impl Into<NaturalCurvature>) -> Result<Self, RodError> {
        let length = self.length();
        let curvature = curvature.into().0;
        curvature.check(length)?;
        let curvature = curvature.over(length);
        if let Curvature::Constant(curvature) = curvature {
            finite("natural_curvature", curvature)?;
        }
        let model = self.stiffness.bent(curvature).and_then(open).map_err(|error| in_si(error, &self.at_clamp))?;
        Ok(Self { model, ..self })
    }

    /// The same rod with the diameters (m) of its sections, which are round: then the [bending stress](Self::bending_stress) is known. They do
    /// not change the stiffness.
    ///
    /// ```
    /// use rod_core::{Rod, RodSection};
    /// let section = |length, bending_stiffness| RodSection { length, bending_stiffness, natural_curvature: 0.0 };
    /// let wires = Rod::sections(0.1, &[section(0.06, 6.32e-4), section(0.04, 8.19e-5)])?.with_section_diameters(&[0.5e-3, 0.3e-3])?;
    /// // 1 N mm bends the thin wire (32 M / pi d^3)
    /// let stress = wires.bending_stress(0.08, 1e-3).ok_or("no diameter")?;
    /// assert!((stress - 32e-3 / (std::f64::consts::PI * 27e-12)).abs() < 1e-6 * stress);
    /// let message = wires.with_section_diameters(&[0.5e-3]).unwrap_err().to_string();
    /// assert_eq!(message, "diameters are given for 1 sections, expected one for each of the 2 sections of the rod");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RodError::SectionDiameters`] where there is not one for each section, or the rod has none; [`RodError::Section`] where one is not a
    /// positive, finite number.
    pub fn with_section_diameters(self, diameters: &[f64]) -> Result<Self, RodError> {
        let sections = if let Stiffness::Sections(sections) = &self.stiffness { sections.as_slice() } else { &[] };
        if sections.len() != diameters.len() || sections.is_empty() {
            return Err(RodError::SectionDiameters { given: diameters.len(), sections: sections.len() });
        }
        let wrong = |diameter: &f64| !(diameter.is_finite() && *diameter > 0.0);
        if let Some(index) = diameters.iter().position(wrong) {
            let (what, value, expected) = ("diameter", diameters[index], "a positive, finite number");
            return Err(RodError::Section { index, what, value, expected });
        }
        let joints = sections[1..].iter().zip(sections).scan(0.0, |end, (_, section)| {
            *end += section.length;
            Some(*end)
        });
        let diameters = Diameters::Sections { joints: joints.collect(), diameters: diameters.to_vec() };
        Ok(Self { diameters: Some(diameters), ..self })
    }

    /// The bending stress 32 |M| / (pi d^3) (Pa) at the surface at arc length `s` (m) under the bending moment M = `moment` (N m), which is
    /// E d |kappa - kappa0| / 2; at a joint that on the side of the tip. None where the diameter d is not known.
    pub fn bending_stress(&self, s: f64, moment: f64) -> Option<f64> {
        let diameter = self.diameters.as_ref()?.at(s / self.length());
        Some(32.0 * moment.abs() / (std::f64::consts::PI * diameter.powi(3)))
    }

    /// The largest bending stress (Pa) of a shape of this rod, found to 1e-10 of it.
    pub(crate) fn largest_stress<M: RodModel>(&self, shape: &Elastica<M>) -> Option<f64> {
        let diameters = self.diameters.as_ref()?;
        let segments = shape.segments();
        let ends = segments.iter().skip(1).map(|next| (next.s, Some(&next.start))).chain([(1.0, None)]);
        let parts = segments.iter().zip(ends);
        // what is known of all of them first
        let starts = parts.clone().filter(|(segment, (to, _))| *to > segment.s);
        let least = starts.map(|(Segment { s, start, .. }, _)| diameters.stress(*s, start.moment)).fold(0.0, f64::max);
        let larger = |most: f64, (segment, end)| {
            if most.is_nan() { most } else { diameters.largest_stress(&*self.model, segment, end, most) }
        };
        Some(parts.fold(least, larger) * self.units().moment)
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.at_clamp.length()
    }

    /// The uniform, straight rod of its length and of its stiffness at the clamp.
    pub fn at_clamp(&self) -> &Rod {
        &self.at_clamp
    }

    /// The change of the curvature (1/L) at arc length `s` (L) under `moment` (E I / L) per SI unit of a parameter.
    pub(crate) fn curvature_rate(&self, parameter: RodParameter, s: f64, moment: f64) -> Option<f64> {
        let unit = match parameter {
            RodParameter::SectionStiffness(_) => self.at_clamp.bending_stiffness(),
            RodParameter::SectionCurvature(_) | RodParameter::NaturalCurvature => 1.0 / self.length(),
            _ => 1.0,
        };
        self.stiffness.curvature_rate(parameter, s, moment).map(|rate| rate / unit)
    }

    /// What the dimensionless units of this rod are in SI: those of its length and its stiffness at the clamp.
    pub fn units(&self) -> Units {
        self.at_clamp.units()
    }
}

/// The rod, if it does not cross itself at rest: its chords do not.
fn open(rod: Model) -> Result<Model, RodError> {
    if rod.is_straight() {
        return Ok(rod);
    }
    let mut cut = Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 };
    let mut points = vec![[0.0, 0.0]];
    let (mut least, mut most): (f64, f64) = (0.0, 0.0);
    for k in 0..CHORDS {
        cut = rod.carry(k as f64 / CHORDS as f64, &cut, 0.0, 0.0, 1.0 / CHORDS as f64);
        points.push([cut.x, cut.y]);
        (least, most) = (least.min(cut.phi), most.max(cut.phi));
    }
    let turn = if cut.phi.is_finite() { most - least } else { f64::INFINITY };
    // a curve that turns by less than half a turn has no loop
    if turn < std::f64::consts::PI {
        return Ok(rod);
    }
    // chords show nothing of tighter coils
    if turn > MOST_TURN {
        return Err(RodError::Coiled { turn, most: MOST_TURN });
    }
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    for i in 0..CHORDS {
        for j in i + 2..CHORDS {
            let [a, b, c, d] = [points[i], points[i + 1], points[j], points[j + 1]];
            if side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0 {
                let [one, other] = [i, j].map(|k| (k as f64 + 0.5) / CHORDS as f64);
                return Err(RodError::CrossesItself { one, other });
            }
        }
    }
    Ok(rod)
}

/// An error of a dimensionless rod for the user, who knows it in SI.
fn in_si(error: RodError, at_clamp: &Rod) -> RodError {
    let (length, stiffness) = (at_clamp.length(), at_clamp.bending_stiffness());
    match error {
        RodError::Stiffness { s, value } => RodError::Stiffness { s: s * length, value: value * stiffness },
        RodError::NaturalCurvature { s, value } => RodError::NaturalCurvature { s: s * length, value: value / length },
        RodError::NotSmooth { s } => RodError::NotSmooth { s: s * length },
        RodError::CrossesItself { one, other } => RodError::CrossesItself { one: one * length, other: other * length },
        RodError::Border { s, least } => RodError::Border { s: s * length, least: least * length },
        error => error,
    }
}

impl std::fmt::Debug for VaryingRod {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("VaryingRod")
            .field("length", &self.length())
            .field("bending_stiffness_at_clamp", &self.at_clamp.bending_stiffness())
            .finish_non_exhaustive()
    }
}

impl PhysicalRod for VaryingRod {
    type Model = Self;
    type Clamp = Pose;

    fn model(&self) -> &Self {
        self
    }

    fn clamp(&self, pose: Pose) -> Pose {
        pose
    }

    fn units(&self) -> Units {
        Self::units(self)
    }

    fn curvature_rate(&self, parameter: RodParameter, s: f64, moment: f64) -> Option<f64> {
        Self::curvature_rate(self, parameter, s, moment)
    }

    fn largest_stress<M: RodModel>(&self, shape: &Elastica<M>) -> Option<f64> {
        Self::largest_stress(self, shape)
    }
}

impl RodModel for VaryingRod {
    fn carry_with_sensitivities(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> (Cut, CutSensitivities) {
        self.model.carry_with_sensitivities(s, start, a, b, length)
    }
    fn curvature_at(&self, s: f64, moment: f64) -> f64 {
        self.model.curvature_at(s, moment)
    }
    fn bending_energy(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        self.model.bending_energy(segment, to, end)
    }
    fn bending_energy_by_parts(
        &self,
        segment: &Segment<Cut>,
        to: f64,
        end: &Cut,
        show: &mut dyn FnMut(Segment<Cut>),
    ) -> f64 {
        self.model.bending_energy_by_parts(segment, to, end, show)
    }
    fn largest_curvature(&self, segment: &Segment<Cut>, to: f64, end: &Cut) -> f64 {
        self.model.largest_curvature(segment, to, end)
    }
    fn curvature_bounds(&self, from: (f64, f64), to: (f64, f64), force: f64) -> (f64, f64) {
        self.model.curvature_bounds(from, to, force)
    }
    fn one_bend(&self, from: (f64, f64), to: (f64, f64), force: f64) -> Option<f64> {
        self.model.one_bend(from, to, force)
    }
    fn least_stiffness(&self, from: f64, to: f64) -> f64 {
        self.model.least_stiffness(from, to)
    }
    fn is_straight(&self) -> bool {
        self.model.is_straight()
    }
    fn joints(&self) -> &[f64] {
        self.model.joints()
    }
    fn carry(&self, s: f64, start: &Cut, a: f64, b: f64, length: f64) -> Cut {
        self.model.carry(s, start, a, b, length)
    }
}
