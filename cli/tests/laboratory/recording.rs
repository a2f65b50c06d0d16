//! A recording while it is made, and the files of it.

use super::truth::Truth;
use std::fmt::Write;
use std::path::Path;
use vibrissa::Rod;

/// Standard deviation of the white noise: forces in N, moment in N m.
pub const NOISE: [f64; 3] = [0.5e-3, 0.5e-3, 0.02e-3];

/// One row of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Number of the true state that it is of.
    pub truth: usize,
    /// Time, s.
    pub t: f64,
    /// x0 in m, y0 in m, phi0 in rad.
    pub pose: [f64; 3],
    /// f0x in N, f0y in N, m0z in N m.
    pub felt: [f64; 3],
}

/// A recording, and the rod that the command is told.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    pub rows: Vec<Row>,
    /// Time between two samples, s.
    pub period: f64,
    /// Speed of the clamp, m/s.
    pub speed: f64,
    /// Direction of the clamp's way.
    pub direction: [f64; 2],
    /// Length, m, and bending stiffness, N m^2, that the command is told.
    pub length: f64,
    pub stiffness: f64,
}

impl Recording {
    /// The truth, read by an ideal sensor.
    pub fn ideal(truth: &Truth, rod: &Rod, period: f64, speed: f64) -> Self {
        let row = |(number, state): (usize, &super::truth::TrueState)| Row {
            truth: number,
            // poses that a snap jumps over have no sample, but take their time
            t: state.way / speed,
            pose: [state.pose.x, state.pose.y, state.pose.phi],
            felt: [state.reactions.f0x, state.reactions.f0y, state.reactions.m0z],
        };
        let rows: Vec<Row> = truth.states.iter().enumerate().map(row).collect();
        let (first, last) = (rows[0].pose, rows[rows.len() - 1].pose);
        let (x, y) = (last[0] - first[0], last[1] - first[1]);
        let direction = [x / x.hypot(y), y / x.hypot(y)];
        Self { rows, period, speed, direction, length: rod.length(), stiffness: rod.bending_stiffness() }
    }

    /// Changes the readings of each row.
    pub fn each(&mut self, mut change: impl FnMut(&Row) -> [f64; 3]) {
        for row in &mut self.rows {
            row.felt = change(row);
        }
    }

    /// Largest absolute value of each channel.
    pub fn range(&self) -> [f64; 3] {
        std::array::from_fn(|c| self.rows.iter().map(|row| row.felt[c].abs()).fold(0.0, f64::max))
    }

    /// Share of the scan, 0 to 1, at a row.
    pub fn share(&self, row: &Row) -> f64 {
        row.t / self.rows[self.rows.len() - 1].t
    }

    /// Writes the table that the command reads.
    pub fn write(&self, file: &Path) {
        let mut text = String::from("t,x0,y0,phi0,f0x,f0y,m0z\n");
        for Row { t, pose: [x, y, phi], felt: [f0x, f0y, m0z], .. } in &self.rows {
            writeln!(text, "{t},{x},{y},{phi},{f0x},{f0y},{m0z}").unwrap();
        }
        std::fs::write(file, text).unwrap();
    }

    /// Writes the rod that the command is told.
    pub fn write_rod(&self, file: &Path) {
        let Self { length, stiffness, .. } = self;
        std::fs::write(file, format!("[rod]\nlength = {length}\nbending_stiffness = {stiffness}\n")).unwrap();
    }
}
