//! The extension module of the Python package `vibrissa`: the library's types as classes of Python.
//!
//! What a class computes, the library computes; here arguments are taken in and results handed out. Tables for pandas and
//! Arrow, and figures, are Python's (`vibrissa/*.py`).
//!
//! The interpreter is free for other threads while the library works ([`running::run`]); only shapes that are written in Python
//! take it back.

mod array;
mod clamp;
mod composite;
mod derivatives;
mod elastica;
mod equilibrium;
mod errors;
mod event;
mod explore;
mod follower;
mod forces;
mod friction;
mod live;
mod own_function;
mod own_path;
mod own_shape;
mod path;
mod pickle;
mod plan;
mod pose;
mod reach;
mod reading;
mod reconstruct;
mod recording;
mod rod;
mod running;
mod samples;
mod scan;
mod scene;
mod scene_tables;
mod shape;
mod shapes;
mod simulate;
mod single;
mod state;
mod study;
mod sweep;
mod whisker;

use pyo3::prelude::*;

/// The compiled part of `vibrissa`.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("UNITS", array::units(module.py())?)?;
    module.add_class::<rod::PyRod>()?;
    module.add_class::<rod::PySection>()?;
    module.add_class::<clamp::PyElasticClamp>()?;
    module.add_class::<shape::PyShape>()?;
    shapes::add(module)?;
    module.add_class::<composite::PyComposite>()?;
    path::add(module)?;
    module.add_class::<own_path::PyClampFunction>()?;
    module.add_class::<state::PyContact>()?;
    module.add_class::<state::PyState>()?;
    module.add_class::<event::PyEvent>()?;
    module.add_class::<scan::PyScan>()?;
    module.add_class::<scene::PyScene>()?;
    module.add_class::<study::PyStudy>()?;
    module.add_function(wrap_pyfunction!(study::_study_row, module)?)?;
    module.add_class::<equilibrium::PyEquilibrium>()?;
    module.add_class::<elastica::PyElastica>()?;
    module.add_class::<follower::PyFollower>()?;
    module.add_class::<derivatives::PyDerivatives>()?;
    module.add_class::<derivatives::PyTransitionDerivatives>()?;
    module.add_class::<recording::PyRecording>()?;
    module.add_class::<reconstruct::PyReconstruction>()?;
    module.add_class::<forces::PyForces>()?;
    module.add_function(wrap_pyfunction!(forces::_forces, module)?)?;
    module.add_class::<live::PyLive>()?;
    module.add_class::<explore::PyExplorer>()?;
    module.add_class::<explore::PyProposal>()?;
    module.add_function(wrap_pyfunction!(elastica::elastica, module)?)?;
    module.add_function(wrap_pyfunction!(equilibrium::equilibrium, module)?)?;
    module.add_function(wrap_pyfunction!(simulate::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(reconstruct::reconstruct, module)?)?;
    module.add_function(wrap_pyfunction!(reconstruct::reconstruct_together, module)?)?;
    module.add_function(wrap_pyfunction!(reach::_reach, module)?)?;
    module.add_function(wrap_pyfunction!(plan::_plan, module)?)?;
    module.add_function(wrap_pyfunction!(single::single, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::sweep, module)?)?;
    module.add_function(wrap_pyfunction!(own_shape::check_contract, module)?)?;
    module.add_function(wrap_pyfunction!(whisker::_average_whisker, module)?)?;
    module.add_function(wrap_pyfunction!(whisker::_mean_curvature, module)?)?;
    Ok(())
}
