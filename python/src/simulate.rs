//! Simulated recordings.

use crate::array::{structured, whole};
use crate::composite::contours;
use crate::friction::Given;
use crate::path::Leg;
use crate::running::Watch;
use crate::samples::SAMPLE;
use crate::scene::PyScene;
use crate::{errors, running};
use pyo3::prelude::*;
use rod_files::{RodOnPath, Tick, Ticks, read_noise};
use std::path::PathBuf;
use vibrissa::Sample;
use vibrissa::contact::Stop;
use vibrissa::reconstruct::NoiseModel;

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

/// The samples up to where the sweep stops or somebody presses Ctrl-C, without the interpreter.
fn recorded(ticks: Ticks<'_>, rate: f64) -> Result<Vec<Sample>, Stop> {
    let (mut samples, mut watch) = (Vec::new(), Watch::new());
    for tick in ticks {
        let Tick { number, pose, reactions, .. } = tick?;
        let sample = |reactions| Sample { t: Some(number as f64 / rate), pose, reactions, sigma: None };
        samples.extend(reactions.map(sample));
        if watch.should_end() {
            break;
        }
    }
    Ok(samples)
}

/// Simulate a recording: a scene, swept at a speed, felt by a sensor.
///
/// Parameters
/// ----------
/// scene : Scene
///     The rod, the objects and the path of the clamp: any that a scene file can have, straight legs and legs about a pivot. The step of
///     the scene is not used.
/// rate : float
///     Samples in a second, in Hz.
/// speed : float
///     Speed of the clamp: m/s, or rad/s where it only turns on the whole path. On a leg on which it only turns, of others on which it
///     moves, the speed in m/s of the tip of the straight rod. Of several legs each takes a whole number of samples, at the nearest speed.
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
///     An argument is not possible, or the path has no form in scene files.
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
    let Some(legs) = &scene.path.get().legs else {
        return Err(errors::value(
            "the path has no form in scene files, expected straight legs, or legs about a pivot on which the clamp turns with the arc",
        ));
    };
    let noise = noise.map(model).transpose()?.unwrap_or_default();
    let objects: Vec<_> = scene.objects.iter().map(|object| object.bind(py).clone()).collect();
    let objects = contours(&objects);
    let friction = match friction {
        Some(given) => given.of(&objects)?,
        None => scene.friction.clone(),
    };
    let legs = legs.iter().map(Leg::path).collect();
    let swept = RodOnPath { rod: &scene.rod.get().rod, objects: &objects, legs, friction: friction.as_ref() };
    let recorded = running::run(py, || {
        let ticks = Ticks::new(&swept, &noise, [rate, speed], seed).map_err(errors::value)?;
        Ok::<_, PyErr>(recorded(ticks, rate))
    })?;
    match recorded? {
        Err(stop) => Err(errors::stopped(py, &stop, None)),
        Ok(samples) => structured(py, SAMPLE, samples.iter()),
    }
}
