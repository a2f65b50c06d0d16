//! A clamp on springs.

use crate::errors;
use crate::pickle::{Constructor, Reduced};
use crate::scene_tables::number;
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use toml::{Table, Value};
use vibrissa::rod::ElasticClamp;

/// The springs, as in scene files.
const FIELDS: [&str; 3] = ["stiffness_x", "stiffness_y", "stiffness_phi"];

/// Springs between the support, which the path moves, and the base of a rod. They keep the directions of the world.
///
/// Parameters
/// ----------
/// stiffness_x, stiffness_y : float, optional
///     Stiffness along x and y in N/m; None is rigid.
/// stiffness_phi : float, optional
///     Stiffness against turning in N m/rad; None is rigid.
///
/// Raises
/// ------
/// ValueError
///     A stiffness is not positive.
///
/// Examples
/// --------
/// >>> import vibrissa
/// >>> soft = vibrissa.ElasticClamp(stiffness_phi=0.4)
/// >>> vibrissa.Rod(0.1, 2e-3, clamp=soft).clamp
/// ElasticClamp(stiffness_phi=0.4)
#[pyclass(frozen, eq, get_all, name = "ElasticClamp", module = "vibrissa")]
#[derive(Clone, PartialEq)]
pub struct PyElasticClamp {
    /// Stiffness along x in N/m; None is rigid.
    stiffness_x: Option<f64>,
    /// Stiffness along y in N/m; None is rigid.
    stiffness_y: Option<f64>,
    /// Stiffness against turning in N m/rad; None is rigid.
    stiffness_phi: Option<f64>,
}

impl PyElasticClamp {
    fn fields(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let stiffness = [self.stiffness_x, self.stiffness_y, self.stiffness_phi];
        FIELDS.into_iter().zip(stiffness).filter_map(|(name, stiffness)| Some((name, stiffness?)))
    }

    /// The clamp of the library.
    pub fn clamp(&self) -> PyResult<ElasticClamp> {
        ElasticClamp::springs(self.stiffness_x, self.stiffness_y, self.stiffness_phi).map_err(errors::value)
    }

    /// Of a table `[clamp]`.
    pub fn of_table(table: &Table) -> PyResult<Self> {
        let [x, y, phi] = FIELDS.map(|name| number(table, name));
        Self::new(x, y, phi)
    }

    /// The table `[clamp]`.
    pub fn table(&self) -> Table {
        self.fields().map(|(name, stiffness)| (name.to_owned(), Value::Float(stiffness))).collect()
    }
}

#[pymethods]
impl PyElasticClamp {
    #[new]
    #[pyo3(signature = (*, stiffness_x=None, stiffness_y=None, stiffness_phi=None))]
    fn new(stiffness_x: Option<f64>, stiffness_y: Option<f64>, stiffness_phi: Option<f64>) -> PyResult<Self> {
        let created = Self { stiffness_x, stiffness_y, stiffness_phi };
        created.clamp()?;
        Ok(created)
    }

    pub fn __repr__(&self) -> String {
        let fields: Vec<_> = self.fields().map(|(name, stiffness)| format!("{name}={stiffness:?}")).collect();
        format!("ElasticClamp({})", fields.join(", "))
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        Ok(Constructor::class(py, "ElasticClamp", &self.fields().into_py_dict(py)?)?.reduce(py))
    }
}
