//! Forces from points on a rod.

use crate::array::{Column, Floats, Get, structured, twos};
use crate::rod::PyRod;
use crate::{errors, running};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rod_files::{FilmForces, FilmedRod, Setup, channels_of_columns};
use std::path::PathBuf;
use vibrissa::reconstruct::{
    FamilyMember, ForceSettings, Frame, FrameContact, FrameFault, FrameForces, HiddenBase, PolePrior, SeenPoint,
};

/// A frame with its number.
type FrameRow = (i64, Result<FrameForces, FrameFault>);

/// A number of a frame that was judged.
fn of(row: &FrameRow, number: impl Fn(&FrameForces) -> f64) -> f64 {
    row.1.as_ref().map_or(f64::NAN, number)
}

/// The same of its first contact.
fn first(row: &FrameRow, number: impl Fn(&FrameContact) -> f64) -> f64 {
    of(row, |judged| judged.contacts.first().map_or(f64::NAN, &number))
}

/// The same if the base is hidden.
fn if_hidden(row: &FrameRow, number: impl Fn(&HiddenBase) -> f64) -> f64 {
    of(row, |judged| judged.if_hidden.as_ref().map_or(f64::NAN, &number))
}

fn sigma(row: &FrameRow, k: usize) -> f64 {
    of(row, |judged| judged.covariance[k][k].max(0.0).sqrt())
}

const FRAME: &[Column<FrameRow>] = &[
    Column { name: "frame", get: Get::Int(|row| row.0) },
    Column {
        name: "verdict",
        get: Get::Text(|row| {
            row.1.as_ref().map_or_else(|_| "fault".into(), |judged| judged.verdict.to_string().into())
        }),
    },
    Column { name: "contacts", get: Get::Int(|row| row.1.as_ref().map_or(0, |judged| judged.contacts.len() as i64)) },
    Column { name: "s", get: Get::Float(|row| first(row, |contact| contact.s)) },
    Column { name: "x", get: Get::Float(|row| first(row, |contact| contact.x)) },
    Column { name: "y", get: Get::Float(|row| first(row, |contact| contact.y)) },
    Column { name: "force", get: Get::Float(|row| first(row, |contact| contact.force)) },
    Column { name: "sigma_s", get: Get::Float(|row| first(row, |contact| contact.sigmas()[0])) },
    Column { name: "sigma_force", get: Get::Float(|row| first(row, |contact| contact.sigma_force)) },
    Column { name: "f0x", get: Get::Float(|row| of(row, |judged| judged.reactions.f0x)) },
    Column { name: "f0y", get: Get::Float(|row| of(row, |judged| judged.reactions.f0y)) },
    Column { name: "m0z", get: Get::Float(|row| of(row, |judged| judged.reactions.m0z)) },
    Column { name: "sigma_f0x", get: Get::Float(|row| sigma(row, 3)) },
    Column { name: "sigma_f0y", get: Get::Float(|row| sigma(row, 4)) },
    Column { name: "sigma_m0z", get: Get::Float(|row| sigma(row, 5)) },
    Column { name: "x0", get: Get::Float(|row| of(row, |judged| judged.base.x)) },
    Column { name: "y0", get: Get::Float(|row| of(row, |judged| judged.base.y)) },
    Column { name: "phi0", get: Get::Float(|row| of(row, |judged| judged.base.phi)) },
    Column { name: "chi2", get: Get::Float(|row| of(row, |judged| judged.chi_squared)) },
    Column { name: "freedom", get: Get::Int(|row| row.1.as_ref().map_or(0, |judged| judged.freedom as i64)) },
    Column { name: "p_value", get: Get::Float(|row| of(row, |judged| judged.p_value)) },
    Column {
        name: "shortening",
        get: Get::Float(|row| of(row, |judged| judged.shortening.map_or(f64::NAN, |(share, _)| share))),
    },
    Column { name: "hidden", get: Get::Float(|row| if_hidden(row, |other| other.length)) },
    Column { name: "force_if_hidden", get: Get::Float(|row| if_hidden(row, |other| other.force)) },
    Column { name: "m0z_if_hidden", get: Get::Float(|row| if_hidden(row, |other| other.m0z)) },
];

/// A contact: frame, number of the explanation (0 the best one), number of the contact from the base.
type ContactRow = (i64, usize, usize, FrameContact);

const CONTACT: &[Column<ContactRow>] = &[
    Column { name: "frame", get: Get::Int(|row| row.0) },
    Column { name: "explanation", get: Get::Int(|row| row.1 as i64) },
    Column { name: "contact", get: Get::Int(|row| row.2 as i64) },
    Column { name: "s", get: Get::Float(|row| row.3.s) },
    Column { name: "x", get: Get::Float(|row| row.3.x) },
    Column { name: "y", get: Get::Float(|row| row.3.y) },
    Column { name: "force", get: Get::Float(|row| row.3.force) },
    Column { name: "fx", get: Get::Float(|row| row.3.fx) },
    Column { name: "fy", get: Get::Float(|row| row.3.fy) },
    Column { name: "tip", get: Get::Flag(|row| row.3.is_tip) },
    Column { name: "sigma_s", get: Get::Float(|row| row.3.sigmas()[0]) },
    Column { name: "sigma_x", get: Get::Float(|row| row.3.sigmas()[1]) },
    Column { name: "sigma_y", get: Get::Float(|row| row.3.sigmas()[2]) },
    Column { name: "sigma_force", get: Get::Float(|row| row.3.sigma_force) },
    Column { name: "sigma_fx", get: Get::Float(|row| row.3.sigmas()[3]) },
    Column { name: "sigma_fy", get: Get::Float(|row| row.3.sigmas()[4]) },
];

type MemberRow = (i64, FamilyMember);

const MEMBER: &[Column<MemberRow>] = &[
    Column { name: "frame", get: Get::Int(|row| row.0) },
    Column { name: "s", get: Get::Float(|row| row.1.s) },
    Column { name: "x", get: Get::Float(|row| row.1.x) },
    Column { name: "y", get: Get::Float(|row| row.1.y) },
    Column { name: "force", get: Get::Float(|row| row.1.force) },
    Column { name: "chi2", get: Get::Float(|row| row.1.chi_squared) },
];

/// Forces on a rod, frame by frame: what :func:`forces` gives.
#[pyclass(frozen, name = "Forces", module = "vibrissa")]
pub struct PyForces {
    found: FilmForces,
}

impl PyForces {
    fn rows(&self) -> impl Iterator<Item = (i64, &Result<FrameForces, FrameFault>)> {
        self.found.frames.iter().map(|(number, _)| *number).zip(&self.found.film.frames)
    }

    fn judged(&self) -> impl Iterator<Item = (i64, &FrameForces)> {
        self.rows().filter_map(|(number, judged)| Some((number, judged.as_ref().ok()?)))
    }
}

#[pymethods]
impl PyForces {
    /// Structured, one row a frame: ``frame``; ``verdict`` (``"free"``, ``"determined"``, ``"uncertain"``: place and force are known roughly only,
    /// ``"family"``: they are not determined separately, ``"several"``: other contacts explain the frame too, ``"not explained"``, or ``"fault"``);
    /// number of ``contacts``; of the one next to the base ``s``, ``x``, ``y`` (m), ``force`` (N), ``sigma_s``, ``sigma_force``; ``f0x``, ``f0y``
    /// (N), ``m0z`` (N m) and their standard deviations; the base ``x0``, ``y0`` (m), ``phi0`` (rad); ``chi2``, ``freedom``, ``p_value``;
    /// ``shortening``, the share by which a rod of which both ends are seen looks too short. If the first point is only taken for the base:
    /// ``hidden``, the length of the rod that no point shows (m), and ``force_if_hidden`` (N), ``m0z_if_hidden`` (N m), force and moment if that length
    /// is before the first point. NaN where there is no number, infinite
    /// standard deviations where the frame does not determine it.
    #[getter]
    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<FrameRow> = self.rows().map(|(number, judged)| (number, judged.clone())).collect();
        structured(py, FRAME, rows.iter())
    }

    /// Structured, one row a contact, from the base to the tip: ``frame``, ``explanation`` (0 the best, then the rivals), ``contact``, ``s``, ``x``,
    /// ``y`` (m), ``force``, ``fx``, ``fy`` (N, on the rod), ``tip``, and standard deviations.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut rows: Vec<ContactRow> = Vec::new();
        for (frame, judged) in self.judged() {
            for (number, contacts) in std::iter::once(&judged.contacts).chain(&judged.rivals).enumerate() {
                rows.extend(contacts.iter().enumerate().map(|(k, contact)| (frame, number, k, *contact)));
            }
        }
        structured(py, CONTACT, rows.iter())
    }

    /// Structured, of frames whose verdict is ``"family"``: at places along the rod the force that explains the frame: ``frame``, ``s``,
    /// ``x``, ``y`` (m), ``force`` (N), ``chi2``.
    #[getter]
    fn family<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows: Vec<MemberRow> = self
            .judged()
            .flat_map(|(frame, judged)| judged.family.iter().map(move |member| (frame, *member)))
            .collect();
        structured(py, MEMBER, rows.iter())
    }

    /// Covariance of (x0, y0, phi0, f0x, f0y, m0z) of each frame, shape (frames, 6, 6), SI units; NaN where there is none.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let none = [[f64::NAN; 6]; 6];
        let all: Vec<f64> = self
            .rows()
            .flat_map(|(_, judged)| judged.as_ref().map_or(none, |judged| judged.covariance))
            .flatten()
            .collect();
        Ok(PyArray1::from_vec(py, all).reshape([self.found.frames.len(), 6, 6])?.into_any())
    }

    /// Standard deviation of each coordinate of the points, m: as given, or found.
    #[getter]
    fn sigma(&self) -> f64 {
        self.found.film.sigma
    }

    /// Why a frame gives nothing, by its number.
    #[getter]
    fn faults<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let faults = PyDict::new(py);
        for (number, judged) in self.rows() {
            if let Err(fault) = judged {
                faults.set_item(number, fault.to_string())?;
            }
        }
        Ok(faults)
    }

    /// What may be wrong, in sentences: frames with faults, frames that nothing explains, points that show a part of the rod only, frames of the free
    /// rod of another shape than the others.
    #[getter]
    fn findings(&self) -> Vec<String> {
        self.found.warnings()
    }

    /// The curvature at rest that was found from ``rest``: points (m, 1/m) as a rod takes them with their standard deviations, shape (41, 3); None
    /// where no frames of the free rod were given.
    #[getter]
    fn rest<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(rest) = &self.found.rest else { return Ok(None) };
        let all: Vec<f64> = (0..41)
            .flat_map(|k| {
                let s = rest.length * f64::from(k) / 40.0;
                let (curvature, sigma) = rest.curvature(s);
                [s, curvature, sigma]
            })
            .collect();
        Ok(Some(PyArray1::from_vec(py, all).reshape([41, 3])?.into_any()))
    }

    /// The pole that the frames touch: ``center`` (x, y) and ``radius`` (m), their ``covariance`` (m^2; zeros for a radius that was given, or not
    /// needed), ``chi2``, ``freedom``, ``p_value``, and the numbers of the ``frames`` that touch it and of those that touch something ``elsewhere``.
    /// None where `pole` was not asked for, or no pole explains the frames.
    #[getter]
    fn pole<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(pole) = &self.found.film.pole else { return Ok(None) };
        let numbers = |all: &[usize]| all.iter().map(|index| self.found.frames[*index].0).collect::<Vec<i64>>();
        let judged = PyDict::new(py);
        judged.set_item("center", pole.center)?;
        judged.set_item("radius", pole.radius)?;
        let covariance = PyArray1::from_vec(py, pole.covariance.concat()).reshape([3, 3])?;
        judged.set_item("covariance", covariance)?;
        judged.set_item("chi2", pole.chi_squared)?;
        judged.set_item("freedom", pole.freedom)?;
        judged.set_item("p_value", pole.p_value)?;
        judged.set_item("frames", numbers(&pole.frames))?;
        judged.set_item("elsewhere", numbers(&pole.elsewhere))?;
        Ok(Some(judged))
    }

    fn __len__(&self) -> usize {
        self.found.frames.len()
    }

    fn __repr__(&self) -> String {
        format!("<Forces: {}>", self.found.summary().lines().next().unwrap_or_default())
    }
}

/// Frames as they come from Python: numbers, points in one piece, where each frame ends, standard deviations (NaN where not known).
#[derive(FromPyObject)]
pub struct FlatFrames {
    numbers: Vec<i64>,
    ends: Vec<usize>,
    #[pyo3(from_py_with = twos)]
    points: Vec<[f64; 2]>,
    sigma: Vec<f64>,
}

impl FlatFrames {
    fn frames(&self, visible: &str) -> PyResult<Vec<(i64, Frame)>> {
        let (base_is_first, tip_is_last) = match visible {
            "base" => (true, false),
            "tip" => (false, true),
            "both" => (true, true),
            "neither" => (false, false),
            _ => {
                return Err(errors::value(format!(
                    "visible is '{visible}', expected 'base', 'tip', 'both' or 'neither': the ends of the rod that the points show"
                )));
            }
        };
        let point = |k: usize| {
            let [x, y] = self.points[k];
            SeenPoint { x, y, sigma: Some(self.sigma[k]).filter(|sigma| !sigma.is_nan()) }
        };
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let frames = self.numbers.iter().zip(starts.zip(&self.ends)).map(|(number, (start, end))| {
            // an end of which the point was not seen is not known
            let is_seen = |k: usize| self.points.get(k).is_some_and(|[x, y]| !(x.is_nan() && y.is_nan()));
            let (first, last) = (start < *end && is_seen(start), start < *end && is_seen(*end - 1));
            let points = (start..*end).filter(|k| is_seen(*k)).map(point).collect();
            let channels = Vec::new();
            (
                *number,
                Frame { points, base_is_first: base_is_first && first, tip_is_last: tip_is_last && last, channels },
            )
        });
        Ok(frames.collect())
    }
}

/// Centre, standard deviation and radius of a pole, as far as they are known.
type PoleArgument = (Option<[f64; 2]>, Option<f64>, Option<f64>);

/// Forces from frames in one piece; `vibrissa.forces` calls it.
#[pyfunction]
#[pyo3(signature = (rod, frames, rest, channels, setup, visible, sigma, friction, contacts, pole, shortening))]
#[allow(clippy::too_many_arguments, reason = "the keywords of the function in Python")]
pub fn _forces(
    py: Python<'_>,
    rod: &PyRod,
    frames: FlatFrames,
    rest: Option<FlatFrames>,
    channels: Option<Vec<(String, Floats<'_>)>>,
    setup: Option<PathBuf>,
    visible: &str,
    sigma: Option<f64>,
    friction: f64,
    contacts: usize,
    pole: Option<PoleArgument>,
    shortening: f64,
) -> PyResult<PyForces> {
    let positive = |what: &str, value: f64, least: f64| {
        if value.is_finite() && value >= least {
            return Ok(());
        }
        let expected = if least > 0.0 { "a number larger than 0" } else { "a number, 0 or larger" };
        Err(errors::value(format!("{what} is {value}, expected {expected}")))
    };
    sigma.map_or(Ok(()), |sigma| positive("sigma", sigma, f64::MIN_POSITIVE))?;
    positive("friction", friction, 0.0)?;
    positive("shortening", shortening, f64::MIN_POSITIVE)?;
    let pole = pole.map(|(center, sigma, radius)| PolePrior { center, sigma, radius });
    if let Some(PolePrior { center, sigma, radius }) = pole {
        if center.is_some_and(|center| center.iter().any(|c| !c.is_finite())) {
            return Err(errors::value("pole is not finite, expected True, or x and y in m"));
        }
        sigma.map_or(Ok(()), |sigma| positive("pole_sigma", sigma, f64::MIN_POSITIVE))?;
        radius.map_or(Ok(()), |radius| positive("pole_radius", radius, 0.0))?;
    }
    if contacts > 2 {
        return Err(errors::value(format!("contacts is {contacts}, expected 0, 1 or 2")));
    }
    let mut all = frames.frames(visible)?;
    if let Some(channels) = channels {
        let columns: Vec<(String, Vec<f64>)> =
            channels.into_iter().map(|(name, values)| (name, values.view().iter().copied().collect())).collect();
        let setup = setup.map_or_else(|| Ok(Setup::default()), |file| Setup::read(&file)).map_err(errors::file)?;
        let rows = channels_of_columns(&columns, rod.rod.length(), &setup.mounting).map_err(errors::value)?;
        if rows.len() != all.len() {
            return Err(errors::value(format!(
                "the channels have {} rows, expected one a frame: {}",
                rows.len(),
                all.len()
            )));
        }
        all.iter_mut().zip(rows).for_each(|((_, frame), channels)| frame.channels = channels);
    }
    let rest = rest.map(|rest| rest.frames(visible)).transpose()?;
    let rest: Option<Vec<Frame>> = rest.map(|frames| frames.into_iter().map(|(_, frame)| frame).collect());
    let rod = FilmedRod { rod: rod.rod.clone(), is_stiffness_known: true };
    let settings = ForceSettings { friction, sigma, most_contacts: contacts, pole, most_shortening: shortening };
    let found = running::run(py, || FilmForces::of("frames".into(), all, rest.as_deref(), rod, &settings))?;
    let found = found.map_err(|error| errors::value(format!("rest: {error}")))?;
    found.base_in_doubt(["visible=\"tip\"", "channels"]).map_or(Ok(()), |text| errors::warn(py, &text))?;
    Ok(PyForces { found })
}
