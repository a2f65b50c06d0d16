//! Scenes from and to TOML.

use crate::array::whole_or_none;
use crate::composite::{PyComposite, contours, objects};
use crate::errors;
use crate::friction::{self, Given};
use crate::path::{Leg, PyPath};
use crate::pickle::{Reduced, constructor};
use crate::rod::PyRod;
use crate::scan::PyScan;
use crate::scene_tables::{Object, degrees, number, point, two};
use crate::sweep::{Options, Steps, run};
use pyo3::prelude::*;
use pyo3::types::PyList;
use rod_files::{LegPath, Scene, SceneFriction};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::{Table, Value};
use vibrissa::contact::Chain;
use vibrissa::contour::Motion;
use vibrissa::{ClampPath, Pose};

/// A rod, objects and the path of the clamp.
///
/// Parameters
/// ----------
/// rod : Rod
///     The rod.
/// objects : Composite, Shape, object with ``frame``, or sequence of these
///     What the rod touches.
/// path : Path
///     The way of the clamp.
/// step : float or sequence of float
///     Distance of reported states: m, or rad where the clamp only turns; one for all legs, or one for each.
/// name : str, optional
///     What to call it.
/// friction : float, tuple of float, or list, optional
///     Coulomb friction between rod and objects, as in :func:`vibrissa.sweep`.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> scene = vibrissa.Scene.read("scenes/O1_q40.toml")  # doctest: +SKIP
/// >>> scan = scene.sweep()  # doctest: +SKIP
#[pyclass(frozen, name = "Scene", module = "vibrissa")]
pub struct PyScene {
    pub rod: Py<PyRod>,
    pub objects: Vec<Py<PyComposite>>,
    pub path: Py<PyPath>,
    steps: Vec<f64>,
    /// None where there is none.
    pub friction: Option<SceneFriction>,
    name: String,
    warnings: Vec<String>,
}

impl PyScene {
    fn of(py: Python<'_>, scene: Scene, directory: &Path) -> PyResult<Self> {
        if scene.rod.roller().is_some() {
            return Err(errors::value(
                "clamp.roller is a roller ahead of the clamp, which is not known in Python, expected no field roller",
            ));
        }
        let tables = scene.tables().clone();
        let Scene { name, objects, path, step, legs, friction, warnings, .. } = scene;
        let mut written = written_objects(&tables, directory).into_iter();
        let with = |composite| Py::new(py, PyComposite::read(composite, written.next()));
        let objects = objects.into_iter().map(with).collect::<PyResult<_>>()?;
        let rod = PyRod::of_tables(&tables)?;
        let mut steps = vec![step];
        steps.extend(legs.iter().map(|leg| leg.step));
        let path = path_of(py, path, &legs, &tables)?;
        Ok(Self { rod: Py::new(py, rod)?, objects, path, steps, friction, name, warnings })
    }

    fn directory(file: &Path) -> PathBuf {
        let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
        absolute.parent().map_or_else(PathBuf::new, Path::to_path_buf)
    }

    fn table(&self) -> PyResult<Table> {
        let mut list = Vec::new();
        for (number, object) in self.objects.iter().enumerate() {
            let PyComposite { composite, object } = object.get();
            let none = || {
                errors::value(format!(
                    "object {number} has a piece that scene files have no name for, such as a Bezier, a Graph or a shape of your own, \
                     expected Parabola, Line, CircularArc, EllipticArc, Spline or polygons"
                ))
            };
            let mut table = object.as_ref().ok_or_else(none)?.table(composite.is_cavity());
            if let Some(found) = self.friction.as_ref().and_then(|friction| friction.objects().get(number)) {
                friction::write(&mut table, found)?;
            }
            list.push(Value::Table(table));
        }
        let rod = self.rod.get();
        let clamp = rod.springs().map(|springs| ("clamp".to_owned(), Value::Table(springs.table())));
        let others = [
            ("rod".to_owned(), Value::Table(rod.table())),
            ("object".to_owned(), Value::Array(list)),
            ("sweep".to_owned(), Value::Table(self.sweep_table()?)),
        ];
        Ok(others.into_iter().chain(clamp).collect())
    }

    fn sweep_table(&self) -> PyResult<Table> {
        let legs = self.path.get().legs.as_deref().unwrap_or_default();
        let Some((&Leg::Straight { path: first, to }, others)) = legs.split_first() else {
            return Err(errors::value(
                "the path has no form in scene files, expected a straight first leg, then straight legs or legs about a pivot",
            ));
        };
        let from = first.at(0.0);
        let mut sweep = Table::new();
        let mut put = |name: &str, value| sweep.insert(name.to_owned(), value);
        put("from", point([from.x, from.y]));
        put("to", point([to.x, to.y]));
        put("angle", Value::Float(degrees(from.phi)));
        if to.phi != from.phi {
            put("angle_to", Value::Float(degrees(to.phi)));
        }
        let step = |number: usize, turns_only: bool| {
            let step = self.steps.get(number).or(self.steps.last()).copied().unwrap_or(f64::NAN);
            if turns_only { ("step_angle", Value::Float(degrees(step))) } else { ("step", Value::Float(step)) }
        };
        let (name, value) = step(0, first.turns_only());
        put(name, value);
        let others: Vec<Value> = others
            .iter()
            .enumerate()
            .map(|(number, leg)| {
                let mut table = leg_table(leg);
                let (name, value) = step(number + 1, leg.path().turns_only());
                table.insert(name.to_owned(), value);
                Value::Table(table)
            })
            .collect();
        if !others.is_empty() {
            put("leg", Value::Array(others));
        }
        Ok(sweep)
    }
}

fn leg_table(leg: &Leg) -> Table {
    match leg {
        Leg::Straight { to: Pose { x, y, phi }, .. } => {
            Table::from_iter([("to".to_owned(), point([*x, *y])), ("angle_to".to_owned(), Value::Float(degrees(*phi)))])
        }
        Leg::Pivot { pivot, turn, .. } => {
            Table::from_iter([("pivot".to_owned(), point(*pivot)), ("turn".to_owned(), Value::Float(degrees(*turn)))])
        }
    }
}

/// The path of a scene that has been read, with its legs as they are written.
fn path_of(py: Python<'_>, first: ClampPath, legs: &[rod_files::Leg], tables: &Table) -> PyResult<Py<PyPath>> {
    let sweep = tables.get("sweep").and_then(Value::as_table).cloned().unwrap_or_default();
    let straight = |path: ClampPath, table: &Table| {
        let end = path.at(path.length());
        let [x, y] = two(table, "to").unwrap_or([end.x, end.y]);
        let phi = number(table, "angle_to").map_or(end.phi, f64::to_radians);
        Leg::Straight { path, to: Pose { x, y, phi } }
    };
    let mut written = vec![Some(straight(first, &sweep))];
    if legs.is_empty() {
        return Py::new(py, PyPath::new(first, written.into_iter().collect(), None));
    }
    let listed = sweep.get("leg").and_then(Value::as_array).into_iter().flatten();
    let leg = |(leg, table): (&rod_files::Leg, &Table)| match leg.path {
        LegPath::Straight(path) => Some(straight(path, table)),
        LegPath::Pivot(path) => {
            let (pivot, turn) = (two(table, "pivot")?, number(table, "turn")?.to_radians());
            Some(Leg::Pivot { path, pivot, turn })
        }
    };
    written.extend(legs.iter().zip(listed.filter_map(Value::as_table)).map(leg));
    let first: Arc<dyn vibrissa::contact::Path> = Arc::new(first);
    let paths = std::iter::once(first).chain(legs.iter().map(|leg| leg.path.path())).collect();
    Py::new(py, PyPath::new(Chain::new(paths).map_err(errors::value)?, written.into_iter().collect(), None))
}

/// The fields `[contour]` and `[[object]]` as they are written, with absolute files.
fn written_objects(tables: &Table, directory: &Path) -> Vec<Object> {
    let listed = tables.get("object").and_then(Value::as_array).into_iter().flatten();
    let all = tables.get("contour").into_iter().chain(listed).filter_map(Value::as_table);
    all.map(|table| {
        let flag = |name: &str| table.get(name).and_then(Value::as_bool).unwrap_or(false);
        let motion = Motion {
            rotation: number(table, "angle").map_or(0.0, f64::to_radians),
            translation: two(table, "position").unwrap_or_default(),
            scale: number(table, "scale").unwrap_or(1.0),
            mirror: flag("mirror"),
        };
        let mut made_of: Table = table
            .iter()
            .filter(|(name, _)| ["piece", "file"].contains(&name.as_str()))
            .map(|(k, v)| (k.clone(), v.clone()))
            .collect();
        absolute(&mut made_of, directory);
        // friction belongs to the scene, not to the shape
        let pieces = made_of.get_mut("piece").and_then(Value::as_array_mut).into_iter().flatten();
        for piece in pieces.filter_map(Value::as_table_mut) {
            piece.remove("friction");
        }
        Object { made_of, motion, reversed: flag("reversed") }
    })
    .collect()
}

fn absolute(table: &mut Table, directory: &Path) {
    for (name, value) in table.iter_mut() {
        match value {
            Value::String(file) if name == "file" => *file = directory.join(&*file).to_string_lossy().into_owned(),
            Value::Array(values) => {
                values.iter_mut().filter_map(Value::as_table_mut).for_each(|table| absolute(table, directory));
            }
            _ => {}
        }
    }
}

#[pymethods]
impl PyScene {
    #[new]
    #[pyo3(
        signature = (rod, objects, path, step, *, name="scene".to_owned(), friction=None),
        text_signature = "(rod, objects, path, step, *, name='scene', friction=None)"
    )]
    fn new(
        rod: Py<PyRod>,
        objects: &Bound<'_, PyAny>,
        path: Py<PyPath>,
        step: Steps,
        name: String,
        friction: Option<Given>,
    ) -> PyResult<Self> {
        let objects = self::objects(objects)?;
        let friction = friction.map(|given| given.of(&contours(&objects))).transpose()?.flatten();
        let objects = objects.into_iter().map(Bound::unbind).collect();
        let legs = path.get().count();
        let steps = match step {
            Steps::One(step) => vec![step; legs],
            Steps::Each(steps) if steps.len() == legs => steps,
            Steps::Each(steps) => {
                let found = steps.len();
                return Err(errors::value(format!(
                    "step has {found} numbers, expected one, or {legs}: one for each leg"
                )));
            }
        };
        Ok(Self { rod, objects, path, steps, friction, name, warnings: Vec::new() })
    }

    /// A scene from a TOML file.
    ///
    /// Parameters
    /// ----------
    /// file : str or os.PathLike
    ///     The file, as ``docs/scene-files.md`` describes it.
    ///
    /// Returns
    /// -------
    /// Scene
    ///
    /// Raises
    /// ------
    /// OSError
    ///     The file cannot be read.
    /// ValueError
    ///     It is no scene; the text tells line, column and field.
    #[staticmethod]
    fn read(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let scene = Scene::read(&file).map_err(errors::file)?;
        Self::of(py, scene, &Self::directory(&file))
    }

    /// A scene from TOML.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The text, as in a scene file.
    /// file : str or os.PathLike, optional
    ///     What to call it in messages. It is not opened; files that the text names are looked for in its directory.
    ///
    /// Returns
    /// -------
    /// Scene
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     It is no scene; the text tells line, column and field.
    #[staticmethod]
    #[pyo3(signature = (text, file=PathBuf::from("scene.toml")), text_signature = "(text, file='scene.toml')")]
    fn parse(py: Python<'_>, text: &str, file: PathBuf) -> PyResult<Self> {
        let scene = Scene::parse(&file, text).map_err(errors::file)?;
        Self::of(py, scene, &Self::directory(&file))
    }

    /// The scene as TOML, as the command reads it.
    ///
    /// Files that it names are written with absolute paths. Angles are written in degrees; nearly all come back to the last bit,
    /// the others to one unit in the last place.
    ///
    /// Returns
    /// -------
    /// str
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     A shape or the path has no form in scene files.
    fn to_toml(&self) -> PyResult<String> {
        toml::to_string(&self.table()?).map_err(errors::value)
    }

    /// The rod.
    #[getter]
    fn rod(&self, py: Python<'_>) -> Py<PyRod> {
        self.rod.clone_ref(py)
    }

    /// The objects.
    #[getter]
    fn objects(&self, py: Python<'_>) -> Vec<Py<PyComposite>> {
        self.objects.iter().map(|object| object.clone_ref(py)).collect()
    }

    /// The path of the clamp.
    #[getter]
    fn path(&self, py: Python<'_>) -> Py<PyPath> {
        self.path.clone_ref(py)
    }

    /// Distances of reported states, one for each leg: m, or rad where the clamp only turns.
    #[getter]
    fn steps(&self) -> Vec<f64> {
        self.steps.clone()
    }

    /// Coefficients of friction as :func:`vibrissa.sweep` takes them, a list with an item for each object: a number, ``(at_rest,
    /// slipping)``, or a list of these with one for each piece. None without friction.
    #[getter]
    fn friction<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyList>>> {
        self.friction.as_ref().map(|friction| friction::listed(py, friction)).transpose()
    }

    /// What it is called: the name of its file.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// What may be a mistake in its file.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// Sweep the scene, see :func:`vibrissa.sweep`.
    ///
    /// Parameters
    /// ----------
    /// most_steps : int, optional
    ///     Steps along branches of equilibria after which the sweep stops; by default 2 million.
    ///
    /// Returns
    /// -------
    /// Scan
    ///
    /// Raises
    /// ------
    /// SweepStopped
    ///     The sweep could not go on; its ``scan`` has all before that.
    #[pyo3(signature = (*, most_steps=None))]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole_or_none)] most_steps: Option<u64>,
    ) -> PyResult<Bound<'py, PyScan>> {
        let objects: Vec<_> = self.objects.iter().map(|object| object.bind(py).clone()).collect();
        let steps = match self.steps[..] {
            [step] => Steps::One(step),
            _ => Steps::Each(self.steps.clone()),
        };
        let options = Options { start: None, friction: self.friction.as_ref(), most_steps };
        run(self.rod.bind(py), &objects, self.path.bind(py), &steps, &options)
    }

    fn __repr__(&self) -> String {
        format!("<vibrissa.Scene {:?} of {} objects>", self.name, self.objects.len())
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let (rod, objects, path) = (self.rod.bind(py), self.objects(py), self.path.bind(py));
        let (objects, step, name, friction) = (PyList::new(py, objects)?, &self.steps, &self.name, self.friction(py)?);
        Ok(constructor!(py, "Scene", rod, objects, path, step, name, friction).reduce(py))
    }
}
