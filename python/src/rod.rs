//! The rod.

use crate::array::Floats;
use crate::clamp::PyElasticClamp;
use crate::errors;
use crate::pickle::{Constructor, Reduced};
use crate::scene_tables::{number, point, points};
use numpy::ndarray::Ix2;
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use toml::{Table, Value};
use vibrissa::Rod;
use vibrissa::rod::{AnyRod, ClampSpec, CurvatureSpec, RodFault, RodSpec, SectionSpec, StiffnessSpec};

/// A quantity along the rod: a number, or points of arc length (m) and value.
#[derive(Clone, PartialEq, IntoPyObject)]
pub enum Along {
    Constant(f64),
    Points(Vec<[f64; 2]>),
}

impl Along {
    fn extract(object: &Bound<'_, PyAny>, name: &str, unit: &str) -> PyResult<Option<Self>> {
        if object.is_none() {
            return Ok(None);
        }
        if let Ok(number) = object.extract() {
            return Ok(Some(Self::Constant(number)));
        }
        let wrong = |found: &[usize]| {
            errors::value(format!(
                "{name} has the shape {found:?}, expected a number ({unit}), or points of shape (n, 2): m, {unit}"
            ))
        };
        let numbers: Floats<'_> = object.extract()?;
        let numbers = numbers.view();
        let points = numbers.view().into_dimensionality::<Ix2>().map_err(|_| wrong(numbers.shape()))?;
        if points.ncols() != 2 {
            return Err(wrong(numbers.shape()));
        }
        Ok(Some(Self::Points(points.rows().into_iter().map(|row| [row[0], row[1]]).collect())))
    }

    fn curvature_spec(&self) -> CurvatureSpec {
        match self {
            Self::Constant(curvature) => CurvatureSpec::Constant(*curvature),
            Self::Points(points) => CurvatureSpec::Points(points.clone()),
        }
    }

    fn number(&self) -> Option<f64> {
        if let Self::Constant(number) = self { Some(*number) } else { None }
    }

    fn points(&self) -> Option<&Vec<[f64; 2]>> {
        if let Self::Points(points) = self { Some(points) } else { None }
    }

    fn value(&self) -> Value {
        match self {
            Self::Constant(number) => Value::Float(*number),
            Self::Points(points) => Value::Array(points.iter().copied().map(point).collect()),
        }
    }

    /// As Python writes it.
    fn representation(&self) -> String {
        match self {
            Self::Constant(number) => format!("{number:?}"),
            Self::Points(points) => format!("{points:?}"),
        }
    }

    /// Of a scene file.
    fn of(table: &Table, field: &str) -> Option<Self> {
        number(table, field).map(Self::Constant).or_else(|| points(table, field).map(Self::Points))
    }
}

fn curvature(object: &Bound<'_, PyAny>) -> PyResult<Option<Along>> {
    Along::extract(object, "natural_curvature", "1/m")
}

fn diameter(object: &Bound<'_, PyAny>) -> PyResult<Option<Along>> {
    Along::extract(object, "diameter", "m")
}

/// How stiff a rod or section is, as it is written: the stiffness, or diameter and Young's modulus.
type Stiffness = [Option<f64>; 3];

const STIFFNESS: [&str; 3] = ["bending_stiffness", "diameter", "youngs_modulus"];

fn stiffness_spec([bending_stiffness, diameter, youngs_modulus]: Stiffness) -> StiffnessSpec {
    StiffnessSpec { bending_stiffness, diameter, youngs_modulus }
}

/// What is wrong with a rod, with the number of the section.
fn wrong(fault: RodFault) -> PyErr {
    errors::value(match fault.section {
        Some(index) => format!("sections[{index}]: {fault}"),
        None => fault.to_string(),
    })
}

fn insert_numbers(table: &mut Table, names: &[&str], values: &[Option<f64>]) {
    let given =
        names.iter().zip(values).filter_map(|(name, value)| Some(((*name).to_owned(), Value::Float((*value)?))));
    table.extend(given);
}

/// A part of a rod, of constant bending stiffness and natural curvature.
///
/// Parameters
/// ----------
/// length : float
///     Length in m.
/// bending_stiffness : float, optional
///     Bending stiffness E I in N m^2.
/// diameter : float, optional
///     Diameter of a round wire in m; E I = E pi d^4 / 64.
/// youngs_modulus : float, optional
///     Young's modulus in Pa.
/// natural_curvature : float, optional
///     Curvature at rest in 1/m, positive to the left.
///
/// Raises
/// ------
/// ValueError
///     A value is not positive and finite, or the arguments do not go together.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> shaft, tip = vibrissa.Section(0.06, 6e-4), vibrissa.Section(0.04, 1e-4, natural_curvature=5.0)
/// >>> vibrissa.Rod(0.1, sections=[shaft, tip]).bending_stiffness
/// 0.0006
#[pyclass(frozen, eq, get_all, name = "Section", module = "vibrissa")]
#[derive(Clone, PartialEq)]
pub struct PySection {
    /// Length in m.
    length: f64,
    /// Bending stiffness E I in N m^2.
    bending_stiffness: f64,
    /// Diameter of the wire in m; None where it is not known.
    diameter: Option<f64>,
    /// Young's modulus in Pa; None where it is not known.
    youngs_modulus: Option<f64>,
    /// Curvature at rest in 1/m.
    natural_curvature: f64,
}

impl PySection {
    fn stiffness(&self) -> Stiffness {
        [self.diameter.is_none().then_some(self.bending_stiffness), self.diameter, self.youngs_modulus]
    }

    fn spec(&self) -> SectionSpec {
        let natural_curvature = (self.natural_curvature != 0.0).then_some(self.natural_curvature);
        SectionSpec { length: self.length, stiffness: stiffness_spec(self.stiffness()), natural_curvature }
    }

    fn table(&self) -> Table {
        let mut table = Table::from_iter([("length".to_owned(), Value::Float(self.length))]);
        insert_numbers(&mut table, &STIFFNESS, &self.stiffness());
        if self.natural_curvature != 0.0 {
            insert_numbers(&mut table, &["natural_curvature"], &[Some(self.natural_curvature)]);
        }
        table
    }

    /// Of a scene file.
    fn of(table: &Table) -> PyResult<Self> {
        let [stiffness, diameter, modulus] = STIFFNESS.map(|field| number(table, field));
        let length = number(table, "length").unwrap_or(f64::NAN);
        Self::new(length, stiffness, diameter, modulus, number(table, "natural_curvature").unwrap_or(0.0))
    }
}

#[pymethods]
impl PySection {
    #[new]
    #[pyo3(signature = (length, bending_stiffness=None, *, diameter=None, youngs_modulus=None, natural_curvature=0.0))]
    fn new(
        length: f64,
        bending_stiffness: Option<f64>,
        diameter: Option<f64>,
        youngs_modulus: Option<f64>,
        natural_curvature: f64,
    ) -> PyResult<Self> {
        let stiffness = stiffness_spec([bending_stiffness, diameter, youngs_modulus]);
        let spec = SectionSpec { length, stiffness, natural_curvature: Some(natural_curvature) };
        let bending_stiffness = spec.build().map_err(wrong)?.bending_stiffness;
        Ok(Self { length, bending_stiffness, diameter, youngs_modulus, natural_curvature })
    }

    fn __repr__(&self) -> String {
        let mut text = representation("Section", self.length, self.stiffness());
        if self.natural_curvature != 0.0 {
            text += &format!(", natural_curvature={:?}", self.natural_curvature);
        }
        text + ")"
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let mut arguments: Vec<_> = STIFFNESS.into_iter().zip(self.stiffness()).collect();
        arguments.extend([("length", Some(self.length)), ("natural_curvature", Some(self.natural_curvature))]);
        Ok(Constructor::class(py, "Section", &arguments.into_py_dict(py)?)?.reduce(py))
    }
}

/// The beginning of a text that makes a rod or section.
fn representation(what: &str, length: f64, stiffness: Stiffness) -> String {
    let named = |(name, value): (&str, Option<f64>)| value.map(|value| format!(", {name}={value:?}"));
    let wire: String = STIFFNESS.into_iter().zip(stiffness).skip(1).filter_map(named).collect();
    let stiffness = stiffness[0].map_or_else(String::new, |stiffness| format!(", {stiffness:?}"));
    format!("{what}({length:?}{stiffness}{wire}")
}

/// An inextensible, unshearable, linear elastic rod.
///
/// A uniform one has ``bending_stiffness``, or ``diameter`` and ``youngs_modulus`` of a round wire. With ``tip_diameter``, or points of
/// ``diameter``, the wire tapers; ``sections`` are parts of constant stiffness; ``natural_curvature`` bends it at rest.
///
/// Parameters
/// ----------
/// length : float
///     Length in m.
/// bending_stiffness : float, optional
///     Bending stiffness E I in N m^2.
/// diameter : float or array_like, optional
///     Diameter of a round wire in m, at the clamp; E I = E pi d^4 / 64. Or points of shape (n, 2): arc length from the clamp (m) and diameter
///     (m), from 0 to ``length``, with straight lines between them; then without ``tip_diameter``.
/// youngs_modulus : float, optional
///     Young's modulus in Pa.
/// tip_diameter : float, optional
///     Diameter at the tip in m; the diameter changes linearly along the rod.
/// natural_curvature : float or array_like, optional
///     Curvature at rest in 1/m, positive to the left; or points of shape (n, 2): arc length from the clamp (m) and curvature (1/m), from 0 to
///     ``length``, with straight lines between them.
/// sections : sequence of Section, optional
///     Parts from the clamp to the tip, in place of stiffness or diameters. Their lengths add up to ``length``.
/// yield_stress : float, optional
///     Yield stress of a uniform rod in Pa. It is kept for scene files; the rod stays elastic.
/// clamp : ElasticClamp, optional
///     The springs that hold it; without them the clamp is rigid.
///
/// Raises
/// ------
/// ValueError
///     A value is not positive and finite, the arguments do not go together, or the rod crosses itself at rest.
///
/// Notes
/// -----
/// ``sweep``, ``Scene``, ``Follower``, ``equilibrium``, ``Derivatives``, ``simulate``, ``single``, ``Recording``,
/// ``reconstruct`` and studies take any rod. ``Live`` takes uniform rods that are straight at rest, on any clamp.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> rod = vibrissa.Rod(0.1, diameter=0.5e-3, youngs_modulus=206e9)
/// >>> round(rod.bending_stiffness, 6)
/// 0.000632
/// >>> whisker = vibrissa.Rod(0.04, diameter=1e-4, tip_diameter=1e-5, youngs_modulus=3e9, natural_curvature=20.0)
/// >>> whisker.is_uniform
/// False
#[pyclass(frozen, eq, name = "Rod", module = "vibrissa")]
#[derive(Clone)]
pub struct PyRod {
    pub rod: AnyRod,
    length: f64,
    stiffness: Stiffness,
    /// Where it is points, `stiffness` has none.
    diameter: Option<Along>,
    tip_diameter: Option<f64>,
    natural_curvature: Option<Along>,
    sections: Vec<PySection>,
    yield_stress: Option<f64>,
    clamp: Option<PyElasticClamp>,
}

impl PartialEq for PyRod {
    fn eq(&self, other: &Self) -> bool {
        let numbers = |rod: &Self| (rod.length, rod.stiffness, rod.tip_diameter, rod.yield_stress);
        numbers(self) == numbers(other)
            && self.diameter == other.diameter
            && self.natural_curvature == other.natural_curvature
            && self.sections == other.sections
            && self.clamp == other.clamp
    }
}

impl PyRod {
    /// The rod of the tables `[rod]` and `[clamp]`.
    pub fn of_tables(tables: &Table) -> PyResult<Self> {
        let none = Table::new();
        let table = tables.get("rod").and_then(Value::as_table).unwrap_or(&none);
        let clamp = tables.get("clamp").and_then(Value::as_table).map(PyElasticClamp::of_table).transpose()?;
        let field = |name: &str| number(table, name);
        let [stiffness, _, modulus] = STIFFNESS.map(field);
        let tables = table.get("section").and_then(Value::as_array).into_iter().flatten();
        let sections: Vec<_> = tables.filter_map(Value::as_table).map(PySection::of).collect::<PyResult<_>>()?;
        let sections = (!sections.is_empty()).then_some(sections);
        let (length, diameter) = (field("length").unwrap_or(f64::NAN), Along::of(table, "diameter"));
        let curvature = Along::of(table, "natural_curvature");
        let (tip, stress) = (field("tip_diameter"), field("yield_stress"));
        Self::new(length, stiffness, diameter, modulus, tip, curvature, sections, stress, clamp)
    }

    /// The springs of the clamp, if it gives way.
    pub fn springs(&self) -> Option<&PyElasticClamp> {
        self.clamp.as_ref()
    }

    /// The table `[rod]`.
    pub fn table(&self) -> Table {
        let mut table = Table::from_iter([("length".to_owned(), Value::Float(self.length))]);
        insert_numbers(&mut table, &STIFFNESS, &self.stiffness);
        insert_numbers(&mut table, &["tip_diameter", "yield_stress"], &[self.tip_diameter, self.yield_stress]);
        for (name, along) in [("diameter", &self.diameter), ("natural_curvature", &self.natural_curvature)] {
            table.extend(along.as_ref().map(|along| (name.to_owned(), along.value())));
        }
        if !self.sections.is_empty() {
            let sections = self.sections.iter().map(|section| Value::Table(section.table())).collect();
            table.insert("section".to_owned(), Value::Array(sections));
        }
        table
    }

    /// The rod for what takes only a uniform one that is straight at rest, on whatever clamp.
    pub fn uniform(&self) -> PyResult<&Rod> {
        self.rod.uniform().ok_or_else(|| {
            errors::value(format!(
                "rod is {}, not uniform or not straight at rest, expected a uniform, straight one: only from its reactions scans are \
                 reconstructed",
                self.__repr__()
            ))
        })
    }
}

#[pymethods]
impl PyRod {
    #[new]
    #[pyo3(signature = (
        length, bending_stiffness=None, *, diameter=None, youngs_modulus=None, tip_diameter=None, natural_curvature=None,
        sections=None, yield_stress=None, clamp=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "the fields of a rod in a scene file")]
    pub fn new(
        length: f64,
        bending_stiffness: Option<f64>,
        #[pyo3(from_py_with = diameter)] diameter: Option<Along>,
        youngs_modulus: Option<f64>,
        tip_diameter: Option<f64>,
        #[pyo3(from_py_with = curvature)] natural_curvature: Option<Along>,
        sections: Option<Vec<PySection>>,
        yield_stress: Option<f64>,
        clamp: Option<PyElasticClamp>,
    ) -> PyResult<Self> {
        let of_base = diameter.as_ref().and_then(Along::number);
        let (sections, stiffness) = (sections.unwrap_or_default(), [bending_stiffness, of_base, youngs_modulus]);
        let spec = RodSpec {
            length,
            stiffness: stiffness_spec(stiffness),
            tip_diameter,
            diameters: diameter.as_ref().and_then(Along::points).cloned(),
            natural_curvature: natural_curvature.as_ref().map(Along::curvature_spec),
            sections: sections.iter().map(PySection::spec).collect(),
            yield_stress,
            clamp: ClampSpec::Springs(clamp.as_ref().map(PyElasticClamp::clamp).transpose()?.unwrap_or_default()),
        };
        let rod = spec.build().map_err(wrong)?;
        Ok(Self { rod, length, stiffness, diameter, tip_diameter, natural_curvature, sections, yield_stress, clamp })
    }

    /// Length in m.
    #[getter]
    fn length(&self) -> f64 {
        self.length
    }

    /// Bending stiffness E I in N m^2, at the clamp.
    #[getter]
    fn bending_stiffness(&self) -> f64 {
        self.rod.at_clamp().bending_stiffness()
    }

    /// Diameter of the wire in m, at the clamp, or points of arc length (m) and diameter (m); None where it is not known.
    #[getter]
    fn diameter(&self) -> Option<Along> {
        self.diameter.clone()
    }

    /// Young's modulus in Pa; None where it is not known.
    #[getter]
    fn youngs_modulus(&self) -> Option<f64> {
        self.stiffness[2]
    }

    /// Diameter at the tip in m; None where the rod does not taper.
    #[getter]
    fn tip_diameter(&self) -> Option<f64> {
        self.tip_diameter
    }

    /// Curvature at rest: 1/m, or points of arc length (m) and curvature (1/m); None where it is not given.
    #[getter]
    fn natural_curvature(&self) -> Option<Along> {
        self.natural_curvature.clone()
    }

    /// The sections from the clamp to the tip; empty where it has none.
    #[getter]
    fn sections(&self) -> Vec<PySection> {
        self.sections.clone()
    }

    /// Yield stress in Pa; None where it is not known.
    #[getter]
    fn yield_stress(&self) -> Option<f64> {
        self.yield_stress
    }

    /// The springs of the clamp; None where it is rigid.
    #[getter]
    fn clamp(&self) -> Option<PyElasticClamp> {
        self.clamp.clone()
    }

    /// Whether the rod is uniform and straight at rest, on a rigid clamp.
    #[getter]
    fn is_uniform(&self) -> bool {
        self.rod.uniform_on_rigid_clamp().is_some()
    }

    fn __repr__(&self) -> String {
        let mut text = representation("Rod", self.length, self.stiffness);
        if let Some(tip) = self.tip_diameter {
            text += &format!(", tip_diameter={tip:?}");
        }
        // a single diameter is there already
        let diameters = self.diameter.as_ref().filter(|diameter| diameter.points().is_some());
        for (name, along) in [("diameter", diameters), ("natural_curvature", self.natural_curvature.as_ref())] {
            text += &along.map_or_else(String::new, |along| format!(", {name}={}", along.representation()));
        }
        if !self.sections.is_empty() {
            let sections: Vec<_> = self.sections.iter().map(PySection::__repr__).collect();
            text += &format!(", sections=[{}]", sections.join(", "));
        }
        if let Some(stress) = self.yield_stress {
            text += &format!(", yield_stress={stress:?}");
        }
        if let Some(clamp) = &self.clamp {
            text += &format!(", clamp={}", clamp.__repr__());
        }
        text + ")"
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let mut numbers: Vec<_> = STIFFNESS.into_iter().zip(self.stiffness).collect();
        numbers.extend([
            ("length", Some(self.length)),
            ("tip_diameter", self.tip_diameter),
            ("yield_stress", self.yield_stress),
        ]);
        let arguments = numbers.into_py_dict(py)?;
        arguments.set_item("diameter", self.diameter.clone())?;
        arguments.set_item("natural_curvature", self.natural_curvature.clone())?;
        arguments.set_item("clamp", self.clamp.clone())?;
        arguments.set_item("sections", (!self.sections.is_empty()).then(|| self.sections.clone()))?;
        Ok(Constructor::class(py, "Rod", &arguments)?.reduce(py))
    }
}
