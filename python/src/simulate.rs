//! Simulated recordings.

use crate::array::{structured, whole};
use crate::composite::contours;
use crate::friction::{Given, rubbing};
use crate::running::Watch;
use crate::samples::SAMPLE;
use crate::scene::PyScene;
use crate::{errors, running};
use pyo3::prelude::*;
use rod_files::read_noise;
use std::path::PathBuf;
use vibrissa::contact::{Item, Stop};
use vibrissa::reconstruct::{NoiseGenerator, NoiseModel};
use vibrissa::rod::{AnyRod, Reactions};
use vibrissa::{ClampPath, Pose, Sample, Sweep};

/// A model of noise from a mapping with the tables of a noise file, or from such a file.
pub fn model(noise: &Bound<'_, PyAny>) -> PyResult<NoiseModel> {
    if let Ok(file) = noise.extract::<PathBuf>() {
        return read_noise(&file).map_err(errors::file);
    }
    let text: String = noise.py().import("json")?.call_method1("dumps", (noise,))?.extract()?;
    let model: NoiseModel = serde_json::from_str(&text).map_err(errors::value)?;
    model.check().map_err(errors::value)?;
    Ok(model)
}

/// The sweep and the sensor, without the interpreter.
struct Recorder<'a> {
    sweep: Sweep<'a, AnyRod>,
    path: ClampPath,
    sensor: NoiseGenerator,
    step: f64,
    rate: f64,
}

impl Recorder<'_> {
    fn run(mut self) -> (Vec<Sample>, Option<Stop>) {
        let (mut samples, mut next, mut watch) = (Vec::new(), 0, Watch::new());
        let start = self.path.at(0.0);
        for item in self.sweep {
            let state = match item {
                Ok(Item::State(state)) => state,
                Ok(Item::Event(_)) => continue,
                Err(stop) => return (samples, Some(stop)),
            };
            let Pose { x, y, phi } = state.pose;
            let turns_only = self.path.turns_only();
            let way = if turns_only { (phi - start.phi).abs() } else { (x - start.x).hypot(y - start.y) };
            let number = (way / self.step).round() as usize;
            // the sensor goes on where the sweep has nothing to report
            for _ in next..number {
                self.sensor.sample(Reactions::default());
            }
            next = number + 1;
            if let Some(reactions) = self.sensor.sample(state.reactions) {
                samples.push(Sample { t: Some(number as f64 / self.rate), pose: state.pose, reactions, sigma: None });
            }
            if watch.should_end() {
                break;
            }
        }
        (samples, None)
    }
}

/// Simulate a recording: a scene, swept at a speed, felt by a sensor.
///
/// Parameters
/// ----------
/// scene : Scene
///     The rod, the objects and the path of the clamp: one straight leg. For paths of several legs use ``vibrissa simulate``. The
///     step of the scene is not used.
/// rate : float
///     Samples in a second, in Hz.
/// speed : float
///     Speed of the clamp: m/s, or rad/s where it only turns.
/// noise : mapping, str or os.PathLike, optional
///     The tables of a noise file (``docs/scene-files.md``), such as ``{"white": {"force": 2.5e-3, "m0z": 6e-5}}`` in N and N m, or
///     the file. Without it the sensor reads the truth.
/// seed : int, optional
///     Of the noise.
/// friction : float, tuple of float, or list, optional
///     Coulomb friction, as in :func:`vibrissa.sweep`, instead of that of the scene.
///
/// Returns
/// -------
/// numpy.ndarray
///     Structured: ``t`` (s), ``x0``, ``y0`` (m), ``phi0`` (rad), ``f0x``, ``f0y`` (N), ``m0z`` (N m), and ``sigma_...``, which are
///     NaN. Lost samples and poses that a snap jumps over have no row.
///
/// Raises
/// ------
/// ValueError
///     An argument is not possible.
/// SweepStopped
///     The sweep could not go on.
#[pyfunction]
#[pyo3(signature = (scene, *, rate, speed, noise=None, seed=0, friction=None))]
pub fn simulate<'py>(
    py: Python<'py>,
    scene: &PyScene,
    rate: f64,
    speed: f64,
    noise: Option<&Bound<'py, PyAny>>,
    #[pyo3(from_py_with = whole)] seed: u64,
    friction: Option<Given>,
) -> PyResult<Bound<'py, PyAny>> {
    for (what, value) in [("rate", rate), ("speed", speed)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(errors::value(format!("{what} is {value}, expected a positive, finite number")));
        }
    }
    let path = scene.path.get().path.straight();
    let path = path.ok_or_else(|| errors::value("the path is not straight, expected a ClampPath"))?;
    let noise = noise.map(model).transpose()?.unwrap_or_default();
    let objects: Vec<_> = scene.objects.iter().map(|object| object.bind(py).clone()).collect();
    let (objects, step, rod) = (contours(&objects), speed / rate, &scene.rod.get().rod);
    let friction = match friction {
        Some(given) => given.of(&objects)?,
        None => scene.friction.clone(),
    };
    let constructor = running::run(py, || {
        let sensor = noise.generator(seed).map_err(errors::value)?;
        let sweep = Sweep::new(rod, &objects[..], path, step).and_then(|sweep| rubbing(sweep, friction.as_ref()));
        Ok::<_, PyErr>(Recorder { sweep: sweep.map_err(errors::value)?, path, sensor, step, rate }.run())
    })?;
    match constructor? {
        (_, Some(stop)) => Err(errors::stopped(py, &stop, None)),
        (samples, None) => structured(py, SAMPLE, samples.iter()),
    }
}
