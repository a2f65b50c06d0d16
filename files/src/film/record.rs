//! Frames as they are written.

use crate::FilmedRod;
use serde::Serialize;
use vibrissa::reconstruct::{FilmPole, Frame, FrameContact, FrameFault, FrameForces, FrameVerdict, RestShape};

/// Columns of forces.csv.
pub(super) const COLUMNS: [&str; 27] = [
    "frame",
    "verdict",
    "contacts",
    "s",
    "x",
    "y",
    "force",
    "fx",
    "fy",
    "sigma_s",
    "sigma_x",
    "sigma_y",
    "sigma_force",
    "f0x",
    "f0y",
    "m0z",
    "sigma_f0x",
    "sigma_f0y",
    "sigma_m0z",
    "x0",
    "y0",
    "phi0",
    "chi2",
    "freedom",
    "hidden",
    "force_if_hidden",
    "m0z_if_hidden",
];

/// What numbers of a rod of unknown stiffness, computed with 1 N m^2, are divided by: forces come in E I / L^2, moments in E I / L.
fn units(rod: &FilmedRod) -> (f64, f64) {
    let units = rod.rod.units();
    if rod.is_stiffness_known { (1.0, 1.0) } else { (units.force, units.moment) }
}

/// A line of forces.jsonl. Numbers that are not determined are null.
#[derive(Default, Serialize)]
pub(super) struct FrameRecord {
    frame: i64,
    verdict: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    fault: Option<String>,
    contacts: Vec<ContactRecord>,
    s: Option<f64>,
    x: Option<f64>,
    y: Option<f64>,
    force: Option<f64>,
    sigma_s: Option<f64>,
    sigma_force: Option<f64>,
    f0x: Option<f64>,
    f0y: Option<f64>,
    m0z: Option<f64>,
    sigma_f0x: Option<f64>,
    sigma_f0y: Option<f64>,
    sigma_m0z: Option<f64>,
    /// Of (f0x, f0y, m0z).
    covariance: Option<[[f64; 3]; 3]>,
    x0: Option<f64>,
    y0: Option<f64>,
    phi0: Option<f64>,
    sigma_x0: Option<f64>,
    sigma_y0: Option<f64>,
    sigma_phi0: Option<f64>,
    chi2: Option<f64>,
    freedom: Option<usize>,
    p: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shortening: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    sigma_shortening: Option<f64>,
    /// m.
    #[serde(skip_serializing_if = "Option::is_none")]
    hidden: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    force_if_hidden: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    m0z_if_hidden: Option<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rivals: Vec<Vec<ContactRecord>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    family: Vec<MemberRecord>,
    force_unit: &'static str,
    #[serde(skip)]
    has_contacts_of_its_own: bool,
}

#[derive(Clone, Serialize)]
struct ContactRecord {
    s: f64,
    x: f64,
    y: f64,
    force: f64,
    fx: f64,
    fy: f64,
    tip: bool,
    sigma_s: Option<f64>,
    sigma_x: Option<f64>,
    sigma_y: Option<f64>,
    sigma_force: Option<f64>,
    sigma_fx: Option<f64>,
    sigma_fy: Option<f64>,
}

#[derive(Serialize)]
struct MemberRecord {
    s: f64,
    x: f64,
    y: f64,
    force: f64,
    chi2: f64,
}

/// A number, if it is one.
fn known(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}

impl ContactRecord {
    fn of(contact: &FrameContact, force: f64) -> Self {
        let [s, x, y, fx, fy] = contact.sigmas();
        Self {
            s: contact.s,
            x: contact.x,
            y: contact.y,
            force: contact.force / force,
            fx: contact.fx / force,
            fy: contact.fy / force,
            tip: contact.is_tip,
            sigma_s: known(s),
            sigma_x: known(x),
            sigma_y: known(y),
            sigma_force: known(contact.sigma_force / force),
            sigma_fx: known(fx / force),
            sigma_fy: known(fy / force),
        }
    }
}

impl FrameRecord {
    pub fn of(frame: i64, judged: &Result<FrameForces, FrameFault>, rod: &FilmedRod) -> Self {
        let (force, moment) = units(rod);
        let force_unit = if rod.is_stiffness_known { "N" } else { "EI/L^2" };
        let judged = match judged {
            Ok(judged) => judged,
            Err(fault) => return Self::of_fault(frame, fault, force_unit),
        };
        let contacts = |contacts: &[FrameContact]| -> Vec<_> {
            contacts.iter().map(|contact| ContactRecord::of(contact, force)).collect()
        };
        let own = contacts(&judged.contacts);
        // a family has no place and force of its own
        let is_family = judged.verdict == FrameVerdict::Family;
        let first = own.first().filter(|_| !is_family).cloned();
        let if_determined = |number: f64, sigma: f64| Some(number).filter(|number| !is_family || sigma < number.abs());
        let sizes = [force, force, moment];
        let sigma = |k: usize| judged.covariance[k][k].max(0.0).sqrt();
        let reactions: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| judged.covariance[i + 3][j + 3] / sizes[i] / sizes[j]));
        let of = |number: fn(&ContactRecord) -> Option<f64>| first.as_ref().and_then(number);
        Self {
            frame,
            verdict: judged.verdict.to_string(),
            fault: None,
            s: of(|c| Some(c.s)),
            x: of(|c| Some(c.x)),
            y: of(|c| Some(c.y)),
            force: of(|c| Some(c.force)),
            sigma_s: of(|c| c.sigma_s),
            sigma_force: of(|c| c.sigma_force),
            f0x: if_determined(judged.reactions.f0x / force, sigma(3) / force),
            f0y: if_determined(judged.reactions.f0y / force, sigma(4) / force),
            m0z: Some(judged.reactions.m0z / moment),
            sigma_f0x: known(sigma(3) / force),
            sigma_f0y: known(sigma(4) / force),
            sigma_m0z: known(sigma(5) / moment),
            covariance: reactions[0][0].is_finite().then_some(reactions),
            x0: Some(judged.base.x),
            y0: Some(judged.base.y),
            phi0: Some(judged.base.phi),
            sigma_x0: known(sigma(0)),
            sigma_y0: known(sigma(1)),
            sigma_phi0: known(sigma(2)),
            chi2: Some(judged.chi_squared),
            freedom: Some(judged.freedom),
            p: Some(judged.p_value),
            shortening: judged.shortening.map(|(share, _)| share),
            sigma_shortening: judged.shortening.map(|(_, sigma)| sigma),
            hidden: judged.if_hidden.map(|other| other.length),
            force_if_hidden: judged.if_hidden.map(|other| other.force / force),
            m0z_if_hidden: judged.if_hidden.map(|other| other.m0z / moment),
            rivals: judged.rivals.iter().map(|rival| contacts(rival)).collect(),
            family: judged
                .family
                .iter()
                .map(|member| MemberRecord {
                    s: member.s,
                    x: member.x,
                    y: member.y,
                    force: member.force / force,
                    chi2: member.chi_squared,
                })
                .collect(),
            contacts: own,
            force_unit,
            has_contacts_of_its_own: judged.verdict.has_contacts_of_its_own(),
        }
    }

    fn of_fault(frame: i64, fault: &FrameFault, force_unit: &'static str) -> Self {
        Self { frame, verdict: "fault".into(), fault: Some(fault.to_string()), force_unit, ..Self::default() }
    }
}

/// A cell of a table.
fn cell(number: Option<f64>) -> String {
    number.map_or_else(String::new, |number| format!("{number:?}"))
}

impl ContactRecord {
    /// Its numbers in the order of [`CONTACT_COLUMNS`].
    fn cells(&self) -> [String; 12] {
        let Self { s, x, y, force, fx, fy, sigma_s, sigma_x, sigma_y, sigma_force, sigma_fx, sigma_fy, .. } = self;
        let known = [s, x, y, force, fx, fy].map(|number| Some(*number));
        let sigmas = [sigma_s, sigma_x, sigma_y, sigma_force, sigma_fx, sigma_fy].map(|sigma| *sigma);
        let mut all = known.into_iter().chain(sigmas).map(cell);
        std::array::from_fn(|_| all.next().unwrap_or_default())
    }
}

/// How many of the numbers of a contact are in forces.csv.
const OF_FIRST: usize = 10;

impl FrameRecord {
    /// The row of forces.csv.
    pub fn row(&self) -> Vec<String> {
        let mut row = vec![self.frame.to_string(), self.verdict.clone(), self.contacts.len().to_string()];
        match self.contacts.first().filter(|_| self.s.is_some()) {
            Some(first) => row.extend(first.cells().into_iter().take(OF_FIRST)),
            None => row.resize(row.len() + OF_FIRST, String::new()),
        }
        let Self { f0x, f0y, m0z, sigma_f0x, sigma_f0y, sigma_m0z, x0, y0, phi0, chi2, freedom, .. } = *self;
        row.extend([f0x, f0y, m0z, sigma_f0x, sigma_f0y, sigma_m0z, x0, y0, phi0, chi2].map(cell));
        row.push(freedom.map_or_else(String::new, |freedom| freedom.to_string()));
        row.extend([self.hidden, self.force_if_hidden, self.m0z_if_hidden].map(cell));
        row
    }

    /// The rows of contacts.csv, from the base to the tip: none of a frame that has no contacts of its own.
    pub fn contact_rows(&self) -> Vec<Vec<String>> {
        let row = |(number, contact): (usize, &ContactRecord)| {
            let mut row =
                vec![self.frame.to_string(), self.verdict.clone(), number.to_string(), contact.tip.to_string()];
            row.extend(contact.cells());
            row
        };
        self.contacts.iter().enumerate().filter(|_| self.has_contacts_of_its_own).map(row).collect()
    }
}

/// Columns of contacts.csv.
pub(super) const CONTACT_COLUMNS: [&str; 16] = [
    "frame",
    "verdict",
    "contact",
    "tip",
    "s",
    "x",
    "y",
    "force",
    "fx",
    "fy",
    "sigma_s",
    "sigma_x",
    "sigma_y",
    "sigma_force",
    "sigma_fx",
    "sigma_fy",
];

/// The file rest.json.
#[derive(Serialize)]
pub(super) struct RestRecord {
    /// Arc length (m), curvature (1/m), its standard deviation (1/m): as the field natural_curvature takes the first two.
    natural_curvature: Vec<[f64; 2]>,
    sigma: Vec<f64>,
    legendre: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    chi2: f64,
    freedom: usize,
    frames: usize,
    sigma_points: f64,
}

/// Number of points at which the curvature at rest is written.
const POINTS: usize = 41;

impl RestRecord {
    pub fn of(rest: &RestShape) -> Self {
        let places = (0..POINTS).map(|k| rest.length * k as f64 / (POINTS - 1) as f64);
        let (points, sigma) = places.map(|s| (s, rest.curvature(s))).map(|(s, (of, sigma))| ([s, of], sigma)).unzip();
        Self {
            natural_curvature: points,
            sigma,
            legendre: rest.coefficients.clone(),
            covariance: rest.covariance.clone(),
            chi2: rest.chi_squared,
            freedom: rest.freedom,
            frames: rest.frames,
            sigma_points: rest.sigma,
        }
    }
}

/// pole.json. Standard deviations of a radius that was given, or not needed, are null.
#[derive(Serialize)]
pub(super) struct PoleRecord {
    /// Centre, m.
    x: f64,
    y: f64,
    /// m.
    radius: f64,
    sigma_x: f64,
    sigma_y: f64,
    sigma_radius: Option<f64>,
    /// Of (x, y, radius), m^2.
    covariance: [[f64; 3]; 3],
    chi2: f64,
    freedom: usize,
    p: f64,
    /// Numbers of the frames that touch it, and of those that touch something else.
    frames: Vec<i64>,
    elsewhere: Vec<i64>,
}

impl PoleRecord {
    /// The pole of frames with their numbers.
    pub fn of(pole: &FilmPole, frames: &[(i64, Frame)]) -> Self {
        let [sigma_x, sigma_y, sigma_radius] = pole.sigmas();
        let numbers = |all: &[usize]| all.iter().filter_map(|index| Some(frames.get(*index)?.0)).collect();
        Self {
            x: pole.center[0],
            y: pole.center[1],
            radius: pole.radius,
            sigma_x,
            sigma_y,
            sigma_radius: (sigma_radius > 0.0).then_some(sigma_radius),
            covariance: pole.covariance,
            chi2: pole.chi_squared,
            freedom: pole.freedom,
            p: pole.p_value,
            frames: numbers(&pole.frames),
            elsewhere: numbers(&pole.elsewhere),
        }
    }
}
