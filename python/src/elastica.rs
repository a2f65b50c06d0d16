//! Equilibria of a rod without contacts.

use crate::array::{Floats, two};
use crate::pose::{PyPose, tuple};
use crate::rod::PyRod;
use crate::{errors, running};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vibrissa::Pose;
use vibrissa::rod::{
    AnyRod, DeadLoad, ElasticaArgument, ElasticaEquilibrium, ElasticaError, Section, Tip, TipEnd, elastica_equilibria,
};

/// Largest number of points of a shape: 480 MB.
const MOST_POINTS: usize = 10_000_000;

/// An equilibrium of a rod without contacts: what :func:`elastica` gives.
#[pyclass(frozen, name = "Elastica", module = "vibrissa")]
pub struct PyElastica {
    one: ElasticaEquilibrium<AnyRod>,
    pose: Pose,
    rod: PyRod,
    branch: usize,
    points: usize,
    tip_held: (bool, bool, bool),
}

impl PyElastica {
    fn tip_section(&self) -> Section {
        self.one.shape.at(self.one.shape.length())
    }

    fn array<'py>(&self, py: Python<'py>, n: usize) -> Bound<'py, PyArray2<f64>> {
        let mut rows = Array2::zeros((n, 6));
        let (length, last) = (self.one.shape.length(), (n - 1) as f64);
        for (k, mut row) in rows.rows_mut().into_iter().enumerate() {
            let s = length * k as f64 / last;
            let Section { x, y, phi, kappa } = self.one.shape.at(s);
            for (cell, value) in row.iter_mut().zip([s, x, y, phi, kappa, self.one.shape.moment(s)]) {
                *cell = value;
            }
        }
        rows.into_pyarray(py)
    }
}

#[pymethods]
impl PyElastica {
    /// The rod.
    #[getter]
    fn rod(&self) -> PyRod {
        self.rod.clone()
    }

    /// The clamp: x (m), y (m), phi (rad).
    #[getter]
    fn pose(&self) -> (f64, f64, f64) {
        tuple(self.pose)
    }

    /// Number of the equilibrium by potential energy, from 0.
    #[getter]
    fn branch(&self) -> usize {
        self.branch
    }

    /// Array of shape (points, 6) at equal distances from the clamp to the tip: s, x, y (m), phi (rad), kappa (1/m), bending moment (N m).
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.array(py, self.points)
    }

    /// Force and moment of the clamp on the rod: f0x, f0y (N), m0z (N m).
    #[getter]
    fn reactions(&self) -> (f64, f64, f64) {
        (self.one.reactions.f0x, self.one.reactions.f0y, self.one.reactions.m0z)
    }

    /// The tip: x (m), y (m), phi (rad).
    #[getter]
    fn tip(&self) -> (f64, f64, f64) {
        let Section { x, y, phi, .. } = self.tip_section();
        (x, y, phi)
    }

    /// Whether x, y and phi of the tip are held.
    #[getter]
    fn tip_held(&self) -> (bool, bool, bool) {
        self.tip_held
    }

    /// Force and moment on the tip: fx, fy (N), moment (N m), those given or those of the support where the tip is held.
    #[getter]
    fn tip_load(&self) -> (f64, f64, f64) {
        (self.one.tip.fx, self.one.tip.fy, self.one.tip.moment)
    }

    /// Bending energy in J.
    #[getter]
    fn energy(&self) -> f64 {
        self.one.bending_energy
    }

    /// Bending energy less the work of the given loads from the shape at rest, in J.
    #[getter]
    fn potential_energy(&self) -> f64 {
        self.one.potential_energy
    }

    /// Whether the second variation of the energy is positive definite.
    #[getter]
    fn stable(&self) -> bool {
        self.one.stable
    }

    /// In how many independent directions the second variation is negative.
    #[getter]
    fn unstable_directions(&self) -> usize {
        self.one.unstable_directions
    }

    /// Whether the second variation vanishes in a direction: at a critical load, or of one that belongs to a family.
    #[getter]
    fn critical(&self) -> bool {
        self.one.critical
    }

    /// Largest violation of the equations: L, rad, and moments in E I / L relative to 1 + the largest of them; at most 1e-12.
    #[getter]
    fn residual(&self) -> f64 {
        self.one.residual
    }

    fn __repr__(&self) -> String {
        let stable = match (self.one.stable, self.one.unstable_directions) {
            (true, _) => "stable",
            (false, 0) => "critical",
            (false, _) => "unstable",
        };
        let Section { x, y, phi, .. } = self.tip_section();
        // no -0.000
        let [x, y, phi] = [1e3 * x, 1e3 * y, phi].map(|value| (1e3 * value).round() / 1e3 + 0.0);
        format!("<vibrissa.Elastica {}: {stable}, tip at ({x:.3}, {y:.3}) mm, {phi:.3} rad>", self.branch)
    }
}

/// How many equilibria are wanted: a whole number, or all of them.
pub struct Branches(Option<usize>);

impl<'py> FromPyObject<'py> for Branches {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        if object.extract::<String>().is_ok_and(|text| text == "all") {
            return Ok(Self(None));
        }
        let number = object.extract::<usize>().ok().filter(|number| *number > 0);
        number.map(|number| Self(Some(number))).ok_or_else(|| {
            let found = object.repr().map_or_else(|_| "something else".to_owned(), |text| text.to_string());
            errors::value(format!("branches is {found}, expected a whole number, at least 1, or 'all'"))
        })
    }
}

/// How many points a shape has.
pub struct Points(usize);

impl<'py> FromPyObject<'py> for Points {
    fn extract_bound(object: &Bound<'py, PyAny>) -> PyResult<Self> {
        let number = object.extract::<usize>().ok().filter(|number| (2..=MOST_POINTS).contains(number));
        number.map(Self).ok_or_else(|| {
            let found = object.repr().map_or_else(|_| "something else".to_owned(), |text| text.to_string());
            errors::value(format!("points is {found}, expected a whole number from 2 to {MOST_POINTS}"))
        })
    }
}

/// The equilibria of a rod without contacts: under dead loads, with its tip loaded, pinned, guided or clamped.
///
/// The lowest potential energy comes first; of mirror images first the one that bends to the left. The search is sampled: it may
/// miss equilibria, but each that it gives fulfils the equations to 1e-12 (``residual``). With a place of the tip that is held there are
/// infinitely many: those with forces of the support up to 225 E I / L^2 of a uniform rod are searched for.
///
/// Parameters
/// ----------
/// rod : Rod
///     Any rod on a rigid clamp.
/// pose : tuple of float
///     The clamp: x (m), y (m), phi (rad).
/// loads : sequence of (s, fx, fy), or array of shape (n, 3), optional
///     Dead loads: arc length from the clamp (m), force on the rod (N). Their directions stay when the rod bends.
/// tip : dict, optional
///     Along each coordinate of the tip its value or its load: ``x`` or ``fx``, ``y`` or ``fy``, ``phi`` or ``moment`` (m, N, rad, N m); a load
///     of 0 where neither is given. ``place=(x, y)``, ``pose=(x, y, phi)`` and ``force=(fx, fy)`` are short for several of them. Without
///     it the tip is free. ``phi`` counts whole turns.
/// branches : int or "all"
///     How many equilibria are wanted.
/// points : int
///     Points of each shape.
///
/// Returns
/// -------
/// list of Elastica
///     At most `branches`, at least one.
///
/// Raises
/// ------
/// ValueError
///     A number is not finite, a load is not on the rod, the tip is out of reach, the loads add up to more than 1000 E I / L^2, the
///     clamp of the rod gives way, or the search finds nothing.
///
/// Examples
/// --------
/// >>> import math, vibrissa
/// >>> rod = vibrissa.Rod(0.1, bending_stiffness=6.3e-4)
/// >>> [tip] = vibrissa.elastica(rod, (0.0, 0.0, 0.0), tip=dict(force=(0.0, -0.063)))
/// >>> round(1e3 * tip.tip[1], 4)
/// -30.1721
/// >>> column = vibrissa.elastica(rod, (0.0, 0.0, math.pi / 2), tip=dict(force=(0.0, -0.2)), branches="all")
/// >>> [one.stable for one in column]
/// [True, True, False]
#[pyfunction]
#[pyo3(signature = (rod, pose, loads=None, tip=None, branches=Branches(Some(1)), points=Points(200)), text_signature = "(rod, pose, loads=(), tip=None, branches=1, points=200)")]
pub fn elastica(
    py: Python<'_>,
    rod: &PyRod,
    pose: PyPose,
    loads: Option<&Bound<'_, PyAny>>,
    tip: Option<&Bound<'_, PyDict>>,
    branches: Branches,
    points: Points,
) -> PyResult<Vec<PyElastica>> {
    let Points(points) = points;
    let loads = loads.map_or_else(|| Ok(Vec::new()), dead_loads)?;
    let tip = tip.map_or(Ok(Tip::FREE), prescribed)?;
    let found = running::run(py, || elastica_equilibria(&rod.rod, pose.0, &loads, &tip))?;
    let mut found = found.map_err(|error| errors::value(named(&error)))?;
    found.truncate(branches.0.unwrap_or(found.len()));
    let is_held = |end| matches!(end, TipEnd::Held(_));
    let tip_held = (is_held(tip.x), is_held(tip.y), is_held(tip.phi));
    let one = |(branch, one)| PyElastica { one, pose: pose.0, rod: rod.clone(), branch, points, tip_held };
    Ok(found.into_iter().enumerate().map(one).collect())
}

/// The error with the name of the argument.
fn named(error: &ElasticaError) -> String {
    let ElasticaError::Argument { argument, message, .. } = error else { return error.to_string() };
    match argument {
        ElasticaArgument::Load(index) => format!("loads[{index}]: {message}"),
        ElasticaArgument::Loads => format!("loads: {message}"),
        ElasticaArgument::Pose => format!("pose: {message}"),
        ElasticaArgument::Tip => format!("tip: {message}"),
        _ => format!("rod: {message}"),
    }
}

fn dead_loads(object: &Bound<'_, PyAny>) -> PyResult<Vec<DeadLoad>> {
    let floats: Floats<'_> = object.extract()?;
    let view = floats.view();
    match *view.shape() {
        [0] | [0, _] => Ok(Vec::new()),
        [_, 3] => {
            let numbers: Vec<f64> = view.iter().copied().collect();
            Ok(numbers.chunks_exact(3).map(|load| DeadLoad { s: load[0], fx: load[1], fy: load[2] }).collect())
        }
        _ => Err(errors::value(format!(
            "loads has the shape {:?}, expected loads of shape (n, 3): s (m), fx (N), fy (N)",
            view.shape()
        ))),
    }
}

/// The fields of the tip that are numbers, by coordinate: held, or loaded.
const FIELDS: [(&str, &str); 3] = [("x", "fx"), ("y", "fy"), ("phi", "moment")];

/// What is given along a coordinate, and by which field.
type Given = Option<(String, TipEnd)>;

fn prescribed(fields: &Bound<'_, PyDict>) -> PyResult<Tip> {
    let mut given: [Given; 3] = [None, None, None];
    let mut give = |k: usize, field: &str, end: TipEnd| match given[k].replace((field.to_owned(), end)) {
        None => Ok(()),
        Some((first, _)) => {
            let coordinate = FIELDS[k].0;
            let message = format!("tip has {first} and {field}, expected one of the two along {coordinate}");
            Err(errors::value(message))
        }
    };
    for (field, value) in fields {
        let field: String = field.extract()?;
        let wrong = |error: PyErr| PyTypeError::new_err(format!("tip: {field}: {}", error.value(value.py())));
        match field.as_str() {
            "place" => {
                let [x, y] = two(&value).map_err(wrong)?;
                give(0, &field, TipEnd::Held(x))?;
                give(1, &field, TipEnd::Held(y))?;
            }
            "force" => {
                let [fx, fy] = two(&value).map_err(wrong)?;
                give(0, &field, TipEnd::Loaded(fx))?;
                give(1, &field, TipEnd::Loaded(fy))?;
            }
            "pose" => {
                let PyPose(Pose { x, y, phi }) = value.extract().map_err(wrong)?;
                [x, y, phi].into_iter().enumerate().try_for_each(|(k, value)| give(k, &field, TipEnd::Held(value)))?;
            }
            name => {
                let number = || value.extract::<f64>().map_err(wrong);
                if let Some(k) = FIELDS.iter().position(|(held, _)| *held == name) {
                    give(k, &field, TipEnd::Held(number()?))?;
                } else if let Some(k) = FIELDS.iter().position(|(_, loaded)| *loaded == name) {
                    give(k, &field, TipEnd::Loaded(number()?))?;
                } else {
                    return Err(errors::value(format!(
                        "tip has the field {name}, expected place, pose or force, or x or fx, y or fy, phi or moment"
                    )));
                }
            }
        }
    }
    let [x, y, phi] = given.map(|given| given.map_or(TipEnd::Loaded(0.0), |(_, end)| end));
    Ok(Tip { x, y, phi })
}
