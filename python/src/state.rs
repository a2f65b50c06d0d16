//! Equilibria, one by one and as rows of an array.

use crate::array::{Column, Get, whole};
use crate::errors;
use crate::pickle::{Reduced, constructor};
use crate::pose::tuple;
use crate::rod::PyRod;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use vibrissa::State;
use vibrissa::contact::{Contact, ContactFriction, ContactKind, SlipMode};
use vibrissa::rod::AnyRod;

/// Columns of a state: those of the command's `states.csv`, and how the solve went.
pub const STATE: &[Column<State>] = &[
    Column { name: "x0", get: Get::Float(|state| state.pose.x) },
    Column { name: "y0", get: Get::Float(|state| state.pose.y) },
    Column { name: "phi0", get: Get::Float(|state| state.pose.phi) },
    Column { name: "phase", get: Get::Text(|state| state.phase().to_string().into()) },
    Column { name: "f0x", get: Get::Float(|state| state.reactions.f0x) },
    Column { name: "f0y", get: Get::Float(|state| state.reactions.f0y) },
    Column { name: "m0z", get: Get::Float(|state| state.reactions.m0z) },
    Column { name: "residual", get: Get::Float(|state| state.certificate.residual) },
    Column { name: "min_gap", get: Get::Float(|state| state.certificate.min_gap.seen) },
    Column { name: "stable", get: Get::Flag(|state| state.certificate.stable) },
    Column { name: "energy", get: Get::Float(|state| state.energy) },
    Column { name: "max_stress", get: Get::Float(|state| state.max_stress.unwrap_or(f64::NAN)) },
    Column { name: "min_gap_bound", get: Get::Float(|state| state.certificate.min_gap.lower) },
    Column { name: "gap_proven", get: Get::Flag(|state| state.certificate.min_gap.proven) },
    Column { name: "leg", get: Get::Int(|state| state.leg as i64) },
    Column { name: "min_force", get: Get::Float(|state| state.certificate.min_force.unwrap_or(f64::NAN)) },
    Column { name: "first_integral", get: Get::Float(|state| state.certificate.first_integral.unwrap_or(f64::NAN)) },
    Column { name: "condition", get: Get::Float(|state| state.certificate.condition) },
    Column { name: "iterations", get: Get::Int(|state| i64::from(state.certificate.iterations)) },
];

/// Columns of a contact.
pub const CONTACT: &[Column<Contact>] = &[
    Column { name: "object", get: Get::Int(|contact| contact.object as i64) },
    Column { name: "piece", get: Get::Int(|contact| contact.piece as i64) },
    Column { name: "kind", get: Get::Text(|contact| contact.kind.to_string().into()) },
    Column { name: "s", get: Get::Float(|contact| contact.s) },
    Column { name: "x", get: Get::Float(|contact| contact.x) },
    Column { name: "y", get: Get::Float(|contact| contact.y) },
    Column { name: "alpha", get: Get::Float(|contact| contact.alpha) },
    Column { name: "force", get: Get::Float(|contact| contact.force) },
    Column {
        name: "mode",
        get: Get::Text(|contact| contact.friction.map_or("".into(), |one| one.mode.to_string().into())),
    },
    Column { name: "friction", get: Get::Float(|contact| contact.friction.map_or(f64::NAN, |one| one.force)) },
    Column { name: "slip", get: Get::Float(|contact| contact.friction.map_or(f64::NAN, |one| one.slip)) },
];

/// Largest number of points of a shape: 240 MB.
const MOST_POINTS: usize = 10_000_000;

/// The points of the rod in a state: x, y (m) and the angle (rad), `n` of them.
pub fn points<'py>(py: Python<'py>, state: &State, rod: &AnyRod, n: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
    if n < 2 {
        return Err(errors::value(format!("n is {n}, expected at least 2 points")));
    }
    if n > MOST_POINTS {
        return Err(errors::value(format!("n is {n}, expected at most {MOST_POINTS} points")));
    }
    let mut points = Array2::zeros((n, 3));
    let elastica = state.elastica(rod).map_err(errors::value)?;
    for (mut row, section) in points.rows_mut().into_iter().zip(elastica.sample(n)) {
        (row[0], row[1], row[2]) = (section.x, section.y, section.phi);
    }
    Ok(points.into_pyarray(py))
}

/// A contact between rod and object.
///
/// Parameters
/// ----------
/// kind : {"tangent", "tip", "corner", "notch"}
///     How it holds: the rod lies along the contour, rests on it with its tip, lies on a convex corner, or rests with its tip in
///     a concave one.
/// s : float
///     Arc length along the rod from the clamp, in m.
/// x, y : float
///     Position in m.
/// alpha : float
///     Tangent angle of the contour in rad; the force on the rod is ``force (sin alpha, -cos alpha)``, and with friction
///     ``friction (cos alpha, sin alpha)`` more.
/// force : float
///     Contact force in N, not negative: the normal one where there is friction.
/// object, piece : int, optional
///     Number of the object, and of its piece, from 0; for a corner or notch of the piece before it.
/// mode : {"slip+", "slip-", "stick"}, optional
///     How the rod moves along the contour, with friction: in its sense, against it, or not (the tip sticks, the side rolls).
/// friction : float, optional
///     Force on the rod along the contour's direction in N.
/// slip : float, optional
///     Slip coordinate in m: arc length of the contour less that of the rod in the contour's sense. Only its differences between
///     states on one piece mean anything.
///
/// Raises
/// ------
/// ValueError
///     There is no such kind or mode, or ``mode``, ``friction`` and ``slip`` are not given together.
#[pyclass(frozen, eq, get_all, name = "Contact", module = "vibrissa")]
#[derive(Clone, PartialEq)]
pub struct PyContact {
    /// How it holds: "tangent", "tip", "corner" or "notch".
    kind: String,
    /// Arc length along the rod from the clamp, in m.
    s: f64,
    /// Position in m.
    x: f64,
    /// Position in m.
    y: f64,
    /// Tangent angle of the contour in rad.
    alpha: f64,
    /// Contact force in N.
    force: f64,
    /// Number of the object, from 0.
    object: usize,
    /// Number of the object's piece, from 0.
    piece: usize,
    /// How the rod moves along the contour: "slip+", "slip-" or "stick"; None without friction.
    mode: Option<String>,
    /// Force on the rod along the contour's direction in N; None without friction.
    friction: Option<f64>,
    /// Slip coordinate in m; None without friction.
    slip: Option<f64>,
}

impl PyContact {
    pub fn of(contact: &Contact) -> Self {
        let Contact { object, piece, kind, s, x, y, alpha, force, friction, .. } = *contact;
        let mode = friction.map(|one| one.mode.to_string());
        let (friction, slip) = (friction.map(|one| one.force), friction.map(|one| one.slip));
        Self { kind: kind.to_string(), s, x, y, alpha, force, object, piece, mode, friction, slip }
    }

    pub fn contact(&self) -> PyResult<Contact> {
        let Self { s, x, y, alpha, force, object, piece, .. } = *self;
        let friction = rubs(self.mode.as_deref(), self.friction, self.slip)?;
        Ok(Contact { object, piece, kind: kind(&self.kind)?, s, x, y, alpha, force, friction })
    }
}

/// What friction does at a contact: all of it is given, or nothing.
fn rubs(mode: Option<&str>, force: Option<f64>, slip: Option<f64>) -> PyResult<Option<ContactFriction>> {
    match (mode, force, slip) {
        (None, None, None) => Ok(None),
        (Some(name), Some(force), Some(slip)) => {
            let modes = [SlipMode::Forward, SlipMode::Backward, SlipMode::Stick];
            let none = || errors::value(format!("mode is {name:?}, expected \"slip+\", \"slip-\" or \"stick\""));
            let mode = modes.into_iter().find(|mode| mode.to_string() == name).ok_or_else(none)?;
            Ok(Some(ContactFriction { mode, force, slip }))
        }
        _ => {
            let number = |value: Option<f64>| value.map_or("None".to_owned(), |value| format!("{value:?}"));
            let (mode, force, slip) = (mode.unwrap_or("None"), number(force), number(slip));
            Err(errors::value(format!(
                "mode is {mode}, friction {force} and slip {slip}, expected all three, or none of them without friction"
            )))
        }
    }
}

fn kind(name: &str) -> PyResult<ContactKind> {
    let kinds = [ContactKind::Tangent, ContactKind::Tip, ContactKind::Corner, ContactKind::Notch];
    let none = || errors::value(format!("kind is {name:?}, expected \"tangent\", \"tip\", \"corner\" or \"notch\""));
    kinds.into_iter().find(|kind| kind.to_string() == name).ok_or_else(none)
}

#[pymethods]
impl PyContact {
    #[new]
    #[pyo3(signature = (kind, s, x, y, alpha, force, object=0, piece=0, *, mode=None, friction=None, slip=None))]
    #[expect(clippy::too_many_arguments, reason = "the fields of a contact")]
    fn new(
        kind: String,
        s: f64,
        x: f64,
        y: f64,
        alpha: f64,
        force: f64,
        #[pyo3(from_py_with = whole)] object: usize,
        #[pyo3(from_py_with = whole)] piece: usize,
        mode: Option<String>,
        friction: Option<f64>,
        slip: Option<f64>,
    ) -> PyResult<Self> {
        self::kind(&kind)?;
        rubs(mode.as_deref(), friction, slip)?;
        Ok(Self { kind, s, x, y, alpha, force, object, piece, mode, friction, slip })
    }

    fn __repr__(&self) -> String {
        let Self { kind, s, x, y, alpha, force, object, piece, .. } = self;
        let rubs = match (&self.mode, self.friction, self.slip) {
            (Some(mode), Some(friction), Some(slip)) => {
                format!(", mode={mode:?}, friction={friction:?}, slip={slip:?}")
            }
            _ => String::new(),
        };
        format!("Contact({kind:?}, {s:?}, {x:?}, {y:?}, {alpha:?}, {force:?}, {object}, {piece}{rubs})")
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let Self { kind, s, x, y, alpha, force, object, piece, mode, friction, slip } = self;
        Ok(constructor!(py, "Contact", kind, s, x, y, alpha, force, object, piece, mode, friction, slip).reduce(py))
    }
}

/// An equilibrium of the rod, SI units.
#[pyclass(frozen, eq, name = "State", module = "vibrissa")]
#[derive(Clone, PartialEq)]
pub struct PyState {
    pub state: State,
}

#[pymethods]
impl PyState {
    /// Pose of the clamp: x (m), y (m), phi (rad).
    #[getter]
    fn pose(&self) -> (f64, f64, f64) {
        tuple(self.state.pose)
    }

    /// Reactions of the clamp on the rod: f0x (N), f0y (N), m0z (N m).
    #[getter]
    fn reactions(&self) -> (f64, f64, f64) {
        let reactions = self.state.reactions;
        (reactions.f0x, reactions.f0y, reactions.m0z)
    }

    /// The phase: "free", or the contacts from the clamp to the tip, A at the tip and B along the side.
    #[getter]
    fn phase(&self) -> String {
        self.state.phase().to_string()
    }

    /// The contacts from the clamp to the tip.
    #[getter]
    fn contacts(&self) -> Vec<PyContact> {
        self.state.contacts.iter().map(PyContact::of).collect()
    }

    /// Leg of the path, from 0.
    #[getter]
    fn leg(&self) -> usize {
        self.state.leg
    }

    /// Bending energy in J.
    #[getter]
    fn energy(&self) -> f64 {
        self.state.energy
    }

    /// Largest bending stress in Pa; None where the rod has no diameter.
    #[getter]
    fn max_stress(&self) -> Option<f64> {
        self.state.max_stress
    }

    /// Largest residual of the boundary-value problem, dimensionless.
    #[getter]
    fn residual(&self) -> f64 {
        self.state.certificate.residual
    }

    /// Smallest gap between rod and objects that was computed, in m; negative: penetration.
    #[getter]
    fn min_gap(&self) -> f64 {
        self.state.certificate.min_gap.seen
    }

    /// Lower bound of the gap over the whole rod, in m; minus infinity where nothing is proven.
    #[getter]
    fn min_gap_bound(&self) -> f64 {
        self.state.certificate.min_gap.lower
    }

    /// Whether the bound is proven: not for shapes whose closest points are sampled.
    #[getter]
    fn gap_proven(&self) -> bool {
        self.state.certificate.min_gap.proven
    }

    /// Whether the equilibrium is stable.
    #[getter]
    fn stable(&self) -> bool {
        self.state.certificate.stable
    }

    /// Condition number (1-norm) of the Jacobian; 1 for a free rod.
    #[getter]
    fn condition(&self) -> f64 {
        self.state.certificate.condition
    }

    /// Points of the rod.
    ///
    /// Parameters
    /// ----------
    /// rod : Rod
    ///     The rod that is in this state.
    /// n : int, optional
    ///     Number of points at equal distances from clamp to tip, at least 2.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray
    ///     Of shape (n, 3): x (m), y (m), slope angle phi (rad).
    #[pyo3(signature = (rod, n=101))]
    fn shape<'py>(
        &self,
        py: Python<'py>,
        rod: &PyRod,
        #[pyo3(from_py_with = whole)] n: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        points(py, &self.state, &rod.rod, n)
    }

    /// The state as JSON with all digits, as :meth:`from_json` reads it.
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.state).map_err(errors::value)
    }

    /// A state from JSON.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     As from :meth:`to_json`.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     The text is no state.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        Ok(Self { state: serde_json::from_str(text).map_err(errors::value)? })
    }

    fn __repr__(&self) -> String {
        let (x, y, phi) = self.pose();
        format!("<vibrissa.State {} at clamp ({x:?}, {y:?}, {phi:?})>", self.phase())
    }

    /// For `pickle` and `copy`: a function and its arguments.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let from_json = py.get_type::<Self>().getattr("from_json")?;
        Ok((from_json, (self.to_json()?,).into_pyobject(py)?))
    }
}
