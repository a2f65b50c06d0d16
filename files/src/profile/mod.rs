//! Contours as points: what `vibrissa contour` writes.

mod reach;
mod trace;

use crate::Scene;
use crate::output::write_csv;
use reach::Reach;
use std::io::{self, Write};
use trace::Tracer;

/// Largest distance of a chord from the contour unless it is given, in lengths of the rod: far below the width of a line.
const TOLERANCE: f64 = 1e-6;

/// The least tolerance, in lengths of the rod: a million points on a circle of its size.
const FINEST: f64 = 1e-12;

/// Most points of all objects: a hundred megabytes.
const MOST: usize = 1_000_000;

/// Why a contour cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// A tolerance that is none.
    #[error("--tolerance is {tolerance} m, expected at least {least:e} m, which is 1e-12 of the rod's length")]
    Tolerance {
        /// The tolerance, m.
        tolerance: f64,
        /// The least, m.
        least: f64,
    },
    /// An object that is not in the scene.
    #[error("--object is {object}, expected a number from 0 to {}: the scene has {count}", count.saturating_sub(1))]
    NoObject {
        /// Its number.
        object: usize,
        /// How many objects there are.
        count: usize,
    },
    /// More points than any use of them needs.
    #[error(
        "the contour needs more than {MOST} points, expected fewer; give a larger --tolerance than {tolerance:e} m"
    )]
    TooMany {
        /// The tolerance, m.
        tolerance: f64,
    },
}

/// A point of a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// m
    pub x: f64,
    /// m
    pub y: f64,
    /// Direction of travel with the solid on the left, rad, without jumps by whole turns.
    pub tangent_angle: f64,
    /// 1/m, positive where the solid is convex.
    pub curvature: f64,
    /// Length of the contour from its first point, m.
    pub arc_length: f64,
}

/// The contour of one object as points, in its own direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Number of the object in the scene, from 0.
    pub object: usize,
    /// The points; those of a closed contour end with the first one.
    pub points: Vec<ProfilePoint>,
    /// Where pieces meet, m.
    pub joints: Vec<[f64; 2]>,
}

impl Scene {
    /// The contours of all objects, or of one (by its number, from 0), as points so close together that no chord is farther
    /// than `tolerance` (m, by default 1e-6 of the rod's length) from the contour.
    ///
    /// A piece that goes on for ever ends 1.5 lengths of the rod from the clamp's path. At a corner or notch two points
    /// stand 1e-9 of the rod's length before and behind the vertex, so that each has one direction.
    ///
    /// # Errors
    /// [`ProfileError`].
    pub fn profiles(&self, tolerance: Option<f64>, object: Option<usize>) -> Result<Vec<Profile>, ProfileError> {
        let length = self.rod.length();
        let tolerance = tolerance.unwrap_or(TOLERANCE * length);
        let least = FINEST * length;
        if !(tolerance.is_finite() && tolerance >= least) {
            return Err(ProfileError::Tolerance { tolerance, least });
        }
        let count = self.objects.len();
        if let Some(object) = object.filter(|object| *object >= count) {
            return Err(ProfileError::NoObject { object, count });
        }
        let reach = Reach::new(self.poses(), length);
        let mut profiles: Vec<Profile> = Vec::new();
        for (index, contour) in self.objects.iter().enumerate() {
            if object.is_some_and(|object| object != index) {
                continue;
            }
            let room = MOST - profiles.iter().map(|profile| profile.points.len()).sum::<usize>();
            let mut tracer = Tracer::new(contour, tolerance, length, room);
            tracer.run(&reach).ok_or(ProfileError::TooMany { tolerance })?;
            profiles.push(Profile { object: index, points: tracer.points, joints: tracer.joints });
        }
        Ok(profiles)
    }
}

/// The columns of contour.csv.
const COLUMNS: [&str; 6] = ["x", "y", "tangent_angle", "curvature", "arc_length", "object"];

/// Writes the points of contours as CSV, one point a row, SI units and radians.
///
/// # Errors
/// Those of `out`.
pub fn write_profile_table(profiles: &[Profile], out: &mut dyn Write) -> io::Result<()> {
    let rows = profiles.iter().flat_map(|profile| {
        profile.points.iter().map(|point| {
            let ProfilePoint { x, y, tangent_angle, curvature, arc_length } = *point;
            (x, y, tangent_angle, curvature, arc_length, profile.object)
        })
    });
    write_csv(out, &COLUMNS, rows)
}
