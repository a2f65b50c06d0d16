//! A recording of O1 at q = 0.4 with mu = 0.1 from a solver that shares no code with this library, in units of the rod.

use rod_core::{Pose, Reactions, Rod};
use rod_reconstruct::{Label, Sample};
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

#[derive(Deserialize)]
struct Row {
    x0: f64,
    f0x: f64,
    f0y: f64,
    m0z: f64,
    label: Label,
}

/// A contact of every fifth row.
#[derive(Clone, Copy, Deserialize)]
pub struct Contact {
    pub row: usize,
    /// 0 is the first contact, 1 the second.
    pub contact: usize,
    pub s: f64,
    pub x: f64,
    pub y: f64,
    pub alpha: f64,
    pub normal: f64,
    pub tangential: f64,
}

/// The samples, their labels, and the contacts.
pub struct Recording {
    pub samples: Vec<Sample>,
    pub labels: Vec<Label>,
    pub contacts: Vec<Contact>,
}

pub fn rod() -> Rod {
    Rod::new(1.0, 1.0).unwrap()
}

/// The recording with mu = 0.1.
pub fn recording() -> Recording {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/friction/");
    let rows: Vec<Row> = csv::Reader::from_path(format!("{folder}O1_q40_mu0.1.csv"))
        .unwrap()
        .deserialize()
        .map(Result::unwrap)
        .collect();
    let contacts = csv::Reader::from_path(format!("{folder}O1_q40_mu0.1_contacts.csv"));
    let sample = |row: &Row| {
        let Row { x0, f0x, f0y, m0z, .. } = *row;
        Sample::new(Pose { x: x0, y: -0.4, phi: FRAC_PI_2 }, Reactions { f0x, f0y, m0z })
    };
    Recording {
        samples: rows.iter().map(sample).collect(),
        labels: rows.iter().map(|row| row.label).collect(),
        contacts: contacts.unwrap().deserialize().map(Result::unwrap).collect(),
    }
}
