//! A rod as a user writes it, and the rules by which it becomes one.

use crate::any_rod::AnyRod;
use crate::clamp::ElasticClamp;
use crate::error::RodError;
use crate::model::RodSection;
use crate::rod::Rod;
use crate::varying::{NaturalCurvature, VaryingRod};

/// Sections that are longer together than so many lengths of their rod are in another unit.
const IN_MM: f64 = 100.0;

/// The fields of a rod in SI units, as scene files and the Python class have them: which of them go together is checked by
/// [`build`](Self::build).
///
/// A uniform rod has [`stiffness`](Self::stiffness) alone. With `tip_diameter` the wire tapers; `diameters` are those of more places; `sections` are parts of constant stiffness, in
/// place of the stiffness of the whole; `natural_curvature` bends it at rest. A rod that is uniform and straight at rest is one, however it is
/// written: with diameters that are all alike, with a curvature of 0, or in sections that are all alike.
///
/// ```
/// use rod_core::{CurvatureSpec, RodSpec, StiffnessSpec};
/// let wire = StiffnessSpec::of_wire(0.5e-3, 206e9);
/// let rod = RodSpec { tip_diameter: Some(0.5e-3), ..RodSpec::new(0.1, wire) };
/// assert!(rod.build()?.uniform().is_some());
/// let whisker = RodSpec {
///     tip_diameter: Some(1e-4),
///     natural_curvature: Some(CurvatureSpec::Constant(5.0)),
///     ..RodSpec::new(0.1, wire)
/// };
/// assert!(whisker.build()?.varying().is_some());
/// let fault = RodSpec { tip_diameter: Some(0.0), ..RodSpec::new(0.1, wire) }.build().unwrap_err();
/// assert_eq!(fault.to_string(), "tip_diameter is 0, expected a positive, finite number");
/// assert_eq!((fault.section, fault.field), (None, Some("tip_diameter")));
/// # Ok::<(), rod_core::RodFault>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RodSpec {
    /// Length, m.
    pub length: f64,
    /// How stiff it is, at the clamp; nothing for a rod of sections.
    pub stiffness: StiffnessSpec,
    /// Diameter at the tip, m: the diameter changes linearly along the rod.
    pub tip_diameter: Option<f64>,
    /// Arc lengths from the clamp (m) and diameters (m), from 0 to the length, with straight lines between them: in place of the two others.
    pub diameters: Option<Vec<[f64; 2]>>,
    /// Curvature at rest.
    pub natural_curvature: Option<CurvatureSpec>,
    /// Parts from the clamp to the tip, whose lengths add up to that of the rod.
    pub sections: Vec<SectionSpec>,
    /// Yield stress, Pa: of a uniform rod that is straight at rest and clamped rigidly.
    pub yield_stress: Option<f64>,
    /// What holds it.
    pub clamp: ClampSpec,
}

/// How stiff a rod or section is, as it is written: its bending stiffness, or diameter and Young's modulus of a round wire.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StiffnessSpec {
    /// Bending stiffness E I, N m^2.
    pub bending_stiffness: Option<f64>,
    /// Diameter, m.
    pub diameter: Option<f64>,
    /// Young's modulus, Pa.
    pub youngs_modulus: Option<f64>,
}

/// A curvature at rest, positive where the rod turns counter-clockwise from the clamp to the tip.
#[derive(Clone, Debug, PartialEq)]
pub enum CurvatureSpec {
    /// The same all along, 1/m.
    Constant(f64),
    /// Arc lengths from the clamp (m) and curvatures (1/m), with straight lines between them.
    Points(Vec<[f64; 2]>),
}

/// A part of a rod whose stiffness and natural curvature are constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionSpec {
    /// Length, m.
    pub length: f64,
    /// How stiff it is.
    pub stiffness: StiffnessSpec,
    /// Curvature at rest, 1/m; 0 where it is not given.
    pub natural_curvature: Option<f64>,
}

/// What holds the base of a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ClampSpec {
    /// A rigid clamp.
    #[default]
    Rigid,
    /// Springs; some that give way nowhere are a rigid clamp.
    Springs(ElasticClamp),
    /// A rigid clamp, and a roller ahead of it where the rod at rest is at this arc length, m.
    Roller(f64),
}

/// What is wrong with a rod as it is written, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct RodFault {
    /// Number of the section, from 0; none for the rod as a whole.
    pub section: Option<usize>,
    /// The field of the rod or section, by its name in scene files; none where something is missing, or several are wrong together.
    pub field: Option<&'static str>,
    /// A sentence for the user: the field, its value, what was expected.
    pub message: String,
}

impl RodFault {
    fn at(field: &'static str, message: impl Into<String>) -> Self {
        Self { section: None, field: Some(field), message: message.into() }
    }

    /// An error of the library; `field` where it names none.
    fn of(error: &RodError, field: Option<&'static str>) -> Self {
        let (section, message) = match error {
            // the number of the section is told beside the message
            RodError::Section { index, what, value, expected } => {
                (Some(*index), format!("{what} is {value}, expected {expected}"))
            }
            error => (None, error.to_string()),
        };
        Self { section, field: named(error).or(field), message }
    }

    fn in_section(self, index: usize) -> Self {
        Self { section: Some(index), ..self }
    }
}

/// What is said where a rod has two stiffnesses.
const BOTH: &str = "bending_stiffness is given beside diameter or youngs_modulus, expected either it or those two";

/// The fields that errors may name.
const FIELDS: [&str; 7] =
    ["length", "diameter", "tip_diameter", "youngs_modulus", "bending_stiffness", "natural_curvature", "yield_stress"];

/// The field of which an error speaks.
fn named(error: &RodError) -> Option<&'static str> {
    let what = match error {
        RodError::NotPositive { what, .. } | RodError::NotFinite { what, .. } | RodError::Section { what, .. } => what,
        RodError::SectionsLength { .. } => "length",
        RodError::TooThick { .. } | RodError::Diameters { .. } | RodError::Step { .. } => "diameter",
        RodError::TooTapered { .. } => "tip_diameter",
        _ => return None,
    };
    FIELDS.into_iter().find(|field| *field == what)
}

impl StiffnessSpec {
    /// That of a bending stiffness, N m^2.
    pub fn of(bending_stiffness: f64) -> Self {
        Self { bending_stiffness: Some(bending_stiffness), ..Self::default() }
    }

    /// That of a round wire: diameter (m) and Young's modulus (Pa).
    pub fn of_wire(diameter: f64, youngs_modulus: f64) -> Self {
        Self { diameter: Some(diameter), youngs_modulus: Some(youngs_modulus), ..Self::default() }
    }

    /// The field that is given first, if one is.
    fn given(&self) -> Option<&'static str> {
        let Self { bending_stiffness, diameter, youngs_modulus } = self;
        let fields =
            [("diameter", diameter), ("youngs_modulus", youngs_modulus), ("bending_stiffness", bending_stiffness)];
        fields.into_iter().find_map(|(name, value)| value.is_some().then_some(name))
    }

    /// A uniform, straight rod of this length, m.
    fn rod(self, length: f64) -> Result<Rod, RodFault> {
        let missing = |what: &str| RodFault {
            section: None,
            field: None,
            message: format!("missing field `{what}`, expected bending_stiffness, or diameter and youngs_modulus"),
        };
        let rod = match (self.bending_stiffness, self.diameter, self.youngs_modulus) {
            (Some(stiffness), None, None) => Rod::new(length, stiffness),
            (None, Some(diameter), Some(modulus)) => Rod::from_diameter(length, diameter, modulus),
            (Some(_), ..) => {
                return Err(RodFault::at("bending_stiffness", BOTH));
            }
            (None, Some(_), None) => return Err(missing("youngs_modulus")),
            (None, None, Some(_)) => return Err(missing("diameter")),
            (None, None, None) => return Err(missing("bending_stiffness")),
        };
        rod.map_err(|error| RodFault::of(&error, None))
    }
}

impl SectionSpec {
    /// The section, checked on its own.
    ///
    /// # Errors
    /// [`RodFault`] without the number of the section.
    pub fn build(&self) -> Result<RodSection, RodFault> {
        let Self { length, stiffness, natural_curvature } = *self;
        let bending_stiffness = match stiffness {
            // an error of a section says what a section expects
            StiffnessSpec { bending_stiffness: Some(given), diameter: None, youngs_modulus: None } => given,
            wire => wire.rod(length)?.bending_stiffness(),
        };
        let section =
            RodSection { length, bending_stiffness, natural_curvature: natural_curvature.unwrap_or_default() };
        let alone = |error| RodFault { section: None, ..RodFault::of(&error, None) };
        Rod::sections(length, &[section]).map_err(alone)?;
        Ok(section)
    }
}

/// A rod without its clamp.
enum Alone {
    Uniform(Rod),
    Varying(VaryingRod),
}

impl RodSpec {
    /// A uniform rod that is straight at rest, on a rigid clamp.
    pub fn new(length: f64, stiffness: StiffnessSpec) -> Self {
        Self {
            length,
            stiffness,
            tip_diameter: None,
            diameters: None,
            natural_curvature: None,
            sections: Vec::new(),
            yield_stress: None,
            clamp: ClampSpec::Rigid,
        }
    }

    /// The rod.
    ///
    /// # Errors
    /// [`RodFault`]: a value is not what a rod can have, or fields do not go together.
    pub fn build(&self) -> Result<AnyRod, RodFault> {
        let rod = match self.alone()? {
            Alone::Uniform(rod) => AnyRod::from(rod),
            Alone::Varying(rod) => AnyRod::from(rod),
        };
        let rod = match self.clamp {
            ClampSpec::Rigid => rod,
            ClampSpec::Springs(springs) => rod.with_springs(springs),
            ClampSpec::Roller(distance) => {
                rod.with_roller(distance).map_err(|error| RodFault::of(&error, Some("clamp.roller")))?
            }
        };
        if self.yield_stress.is_some() && !rod.is_held_rigidly() {
            let message = "yield_stress is given for a rod whose clamp gives way or has a roller, expected it with a rigid clamp alone";
            return Err(RodFault::at("yield_stress", message));
        }
        Ok(rod)
    }

    fn alone(&self) -> Result<Alone, RodFault> {
        let rod = if self.sections.is_empty() { self.of_one_piece()? } else { self.of_sections()? };
        let bent = self.natural_curvature.as_ref().filter(|curvature| **curvature != CurvatureSpec::Constant(0.0));
        let rod = match (rod, bent) {
            (Alone::Uniform(rod), None) => {
                let Some(stress) = self.yield_stress else { return Ok(Alone::Uniform(rod)) };
                return rod.with_yield_stress(stress).map(Alone::Uniform).map_err(|error| RodFault::of(&error, None));
            }
            (Alone::Uniform(rod), Some(_)) => {
                rod.with_natural_curvature(0.0).map_err(|error| RodFault::of(&error, None))?
            }
            (Alone::Varying(rod), _) => rod,
        };
        // the stress at the surface of a varying rod is not compared with a limit
        if self.yield_stress.is_some() {
            let message = "yield_stress is given for a rod that is not uniform or not straight at rest, expected it with a uniform rod alone";
            return Err(RodFault::at("yield_stress", message));
        }
        let curvature = match bent {
            None => return Ok(Alone::Varying(rod)),
            Some(CurvatureSpec::Constant(curvature)) => Ok(NaturalCurvature::from(*curvature)),
            Some(CurvatureSpec::Points(points)) => NaturalCurvature::points(points),
        };
        let rod = curvature.and_then(|curvature| rod.with_natural_curvature(curvature));
        rod.map(Alone::Varying).map_err(|error| RodFault::at("natural_curvature", error.to_string()))
    }

    /// The rod without its curvature at rest: uniform, a cone, or cones.
    fn of_one_piece(&self) -> Result<Alone, RodFault> {
        if let Some(points) = &self.diameters {
            return self.of_diameters(points);
        }
        let rod = self.stiffness.rod(self.length)?;
        let StiffnessSpec { diameter, youngs_modulus, .. } = self.stiffness;
        match (self.tip_diameter, diameter.zip(youngs_modulus)) {
            (Some(tip), Some((diameter, modulus))) if tip != diameter => {
                let at_tip = |error: RodError| match error {
                    RodError::TooThick { .. } => RodFault::at("tip_diameter", error.to_string()),
                    error => RodFault::of(&error, None),
                };
                Rod::tapered(self.length, diameter, tip, modulus).map(Alone::Varying).map_err(at_tip)
            }
            (Some(_), None) => {
                let message = "tip_diameter is given beside bending_stiffness, expected diameter and youngs_modulus of a wire that tapers";
                Err(RodFault::at("tip_diameter", message))
            }
            _ => Ok(Alone::Uniform(rod)),
        }
    }

    fn of_diameters(&self, points: &[[f64; 2]]) -> Result<Alone, RodFault> {
        let beside = |field, message: &str| Err(RodFault::at(field, message));
        let StiffnessSpec { bending_stiffness, diameter, youngs_modulus } = self.stiffness;
        if self.tip_diameter.is_some() {
            let message =
                "tip_diameter is given beside the diameters of points, expected it beside that of the base alone";
            return beside("tip_diameter", message);
        }
        if diameter.is_some() {
            return beside("diameter", "diameter is given beside the diameters of points, expected one of the two");
        }
        if bending_stiffness.is_some() {
            return beside("bending_stiffness", BOTH);
        }
        // what is missing is told as of any wire
        let base = points.first().map_or(f64::NAN, |point| point[1]);
        let Some(modulus) = youngs_modulus else {
            return StiffnessSpec { diameter: Some(base), ..self.stiffness }.rod(self.length).map(Alone::Uniform);
        };
        let rod = Rod::from_diameters(self.length, points, modulus).map_err(|error| RodFault::of(&error, None))?;
        if points.iter().any(|point| point[1] != base) {
            return Ok(Alone::Varying(rod));
        }
        StiffnessSpec::of_wire(base, modulus).rod(self.length).map(Alone::Uniform)
    }

    /// The rod of its sections, with their curvatures at rest.
    fn of_sections(&self) -> Result<Alone, RodFault> {
        let given = self.diameters.as_ref().map(|_| "diameter").or_else(|| self.stiffness.given());
        let given = given.or_else(|| self.tip_diameter.and(Some("tip_diameter")));
        if let Some(field) = given {
            let message = format!("{field} is given beside sections, expected it in the sections alone");
            return Err(RodFault::at(field, message));
        }
        let build = |(index, section): (usize, &SectionSpec)| section.build().map_err(|fault| fault.in_section(index));
        let sections = self.sections.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        let bent = self.sections.iter().position(|section| section.natural_curvature.is_some());
        if let (Some(_), Some(index)) = (&self.natural_curvature, bent) {
            let message = "natural_curvature is given beside that of the rod, expected one of the two";
            return Err(RodFault::at("natural_curvature", message).in_section(index));
        }
        let wrong = |error: RodError| match error {
            RodError::SectionsLength { total, expected } if total > IN_MM * expected => {
                let message = format!(
                    "the lengths of the sections add up to {total} m, expected {expected} m, the length of the rod; are they in mm?"
                );
                RodFault::at("length", message).in_section(0)
            }
            error => RodFault::of(&error, Some("length")),
        };
        let rod = Rod::sections(self.length, &sections).map_err(wrong)?;
        let first = &self.sections[0];
        let alike = |section: &SectionSpec| section.stiffness == first.stiffness;
        if self.sections.iter().all(alike) && sections.iter().all(|section| section.natural_curvature == 0.0) {
            return first.stiffness.rod(self.length).map(Alone::Uniform);
        }
        // of all sections, or of none
        match self.sections.iter().map(|section| section.stiffness.diameter).collect::<Option<Vec<_>>>() {
            Some(diameters) => rod.with_section_diameters(&diameters).map(Alone::Varying).map_err(wrong),
            None => Ok(Alone::Varying(rod)),
        }
    }
}
