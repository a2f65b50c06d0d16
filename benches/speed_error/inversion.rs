//! From reactions back to the contact: in closed form in both precisions, and through integrators.

use crate::held::largest;
use crate::integrators::{Integrator, Name, integrators};
use crate::point::{Point, median_and_worst};
use crate::problem::Problem;
use nalgebra::Matrix3;
use std::hint::black_box;
use vibrissa::reconstruct::{GeneralError, Touch, single, single_general};
use vibrissa::rod::{Reactions, Units};
use vibrissa::{Pose, Rod};

pub const TASK: &str = "inversion";
const CLOSED: &str = "closed form";
const SINGLE: &str = "closed form, f32";

/// From a sample to the point of contact.
type Invert<'a> = Box<dyn Fn(&Sample) -> Option<[f64; 2]> + 'a>;

/// What a sample tells, in double and in single precision.
#[derive(Clone)]
struct Sample {
    pose: Pose,
    reactions: Reactions,
    pose32: Pose<f32>,
    reactions32: Reactions<f32>,
}

impl Sample {
    fn of(problem: &Problem) -> Self {
        let (pose, truth) = (problem.pose(), problem.reactions.unwrap());
        let [f0x, f0y, m0z] = [truth.f0x.hi, truth.f0y.hi, truth.m0z.hi];
        Self {
            pose,
            reactions: Reactions { f0x, f0y, m0z },
            pose32: Pose { x: pose.x as f32, y: pose.y as f32, phi: pose.phi as f32 },
            reactions32: Reactions { f0x: f0x as f32, f0y: f0y as f32, m0z: m0z as f32 },
        }
    }

    /// The point, also where a tip contact comes out a rounding beyond the tip.
    fn closed(&self, rod: &Rod) -> Option<[f64; 2]> {
        let found = single(rod, black_box(self.pose), self.reactions, &Matrix3::zeros());
        found.or_else(|none| none.touch().ok_or(none)).ok().map(|Touch { x, y, .. }| [x, y])
    }

    fn single(&self, rod: &Rod<f32>) -> Option<[f64; 2]> {
        let found = single(rod, black_box(self.pose32), self.reactions32, &Matrix3::zeros());
        found.or_else(|none| none.touch().ok_or(none)).ok().map(|touch| [touch.x.into(), touch.y.into()])
    }

    fn integrated(&self, integrator: &Integrator) -> Option<[f64; 2]> {
        let (rod, none) = (&*integrator.rod, Matrix3::zeros());
        match single_general(rod, Units::ONE, black_box(self.pose), self.reactions, &none) {
            Ok(touch) => Some([touch.x, touch.y]),
            Err(GeneralError::NoContact(none)) => none.touch().map(|touch| [touch.x, touch.y]),
            Err(_) => None,
        }
    }
}

/// All methods on the single contacts of the reference set that are well enough conditioned. Their reactions are rounded to
/// doubles first, as those of a sensor would be.
pub fn points<'a>(problems: &[Problem]) -> Vec<Point<'a>> {
    let alone = |problem: &&Problem| matches!(problem.phase().as_deref(), Some("A" | "B")) && problem.is_moderate();
    let problems: Vec<&Problem> = problems.iter().filter(alone).collect();
    let samples: Vec<Sample> = problems.iter().map(|problem| Sample::of(problem)).collect();
    let mut points = Vec::new();
    let mut add = |method, setting: &str, note: &str, invert: Invert<'a>| {
        let errors = problems.iter().zip(&samples).map(|(problem, sample)| {
            let truth = &problem.contacts[0];
            invert(sample).map_or(f64::INFINITY, |[x, y]| largest([truth.x.error(x), truth.y.error(y)]))
        });
        let errors = median_and_worst(errors.collect());
        let samples = samples.clone();
        let work = move || {
            samples.iter().for_each(|sample| {
                black_box(invert(sample));
            });
            samples.len()
        };
        let work: Box<dyn FnMut() -> usize> = Box::new(work);
        points.push(Point { method, setting: setting.to_owned(), errors, note: note.to_owned(), work: Some(work) });
    };
    let rod = Rod::new(1.0, 1.0).unwrap();
    add(CLOSED, "f64", "", Box::new(move |sample| sample.closed(&rod)));
    let rod = rod.cast();
    add(SINGLE, "f32", "inputs rounded to f32", Box::new(move |sample| sample.single(&rod)));
    for integrator in integrators(1).into_iter().filter(|integrator| integrator.name != Name::Rk4) {
        let (name, setting) = (integrator.name.of_inversion(), integrator.setting.clone());
        add(name, &setting, "", Box::new(move |sample| sample.integrated(&integrator)));
    }
    points
}
