//! A controller follows a contour that it does not know: it drags a rod along it and keeps the force f0y constant, by what the
//! clamp feels alone. `cargo run --release --example follow_contour` prints the contact points that it felt.
#![allow(clippy::print_stdout, reason = "a program may print")]

use std::error::Error;
use std::f64::consts::{FRAC_PI_4, TAU};

use vibrissa::contour::{DualNum, Range};
use vibrissa::reconstruct::{nalgebra::Matrix3, single};
use vibrissa::{Composite, Follower, Graph, Pose, Rod};

/// The force to hold (N), and its tolerance (relative).
const FORCE: f64 = 0.02;
const TOLERANCE: f64 = 1e-3;
/// Way from one sample to the next, and the longest correction (m).
const STEP: f64 = 1e-3;
const LONGEST: f64 = 1e-3;
/// Way (m) of the trial that tells how stiff the rod is here.
const TRIAL: f64 = 1e-6;
/// Corrections of a sample.
const MOST: usize = 30;

/// The height of the ceiling at x, m: known to the simulation only.
pub fn ceiling() -> Result<Composite, Box<dyn Error>> {
    let waves = Graph::new(Range { from: -1.0, to: 1.0 }, |x| (x * (TAU / 0.05)).sin() * 0.003 + 0.06)?;
    Ok(Composite::single(waves)?)
}

/// Moves the clamp up or down until the force is right.
fn hold(rod: &mut Follower<'_>) -> Result<(), Box<dyn Error>> {
    for _ in 0..MOST {
        let (pose, felt) = (rod.state().pose, rod.state().reactions.f0y);
        if (felt - FORCE).abs() <= TOLERANCE * FORCE {
            return Ok(());
        }
        // a clone tries the move, and is thrown away
        let mut trial = rod.clone();
        trial.to(Pose { y: pose.y + TRIAL, ..pose })?;
        let stiffness = (trial.state().reactions.f0y - felt) / TRIAL;
        let way = if stiffness > 0.0 { ((FORCE - felt) / stiffness).clamp(-LONGEST, LONGEST) } else { LONGEST };
        rod.to(Pose { y: pose.y + way, ..pose })?;
    }
    Err("the force cannot be held".into())
}

/// Pose of the clamp, the force f0y there (N), and the contact point felt (m).
pub type Felt = (Pose, f64, [f64; 2]);

/// What is felt in so many samples.
pub fn follow(samples: usize) -> Result<Vec<Felt>, Box<dyn Error>> {
    let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9)?; // length m, diameter m, Young's modulus Pa
    let object = ceiling()?;
    let mut held = Follower::new(&rod, &object, Pose { x: 0.0, y: -0.02, phi: FRAC_PI_4 })?;
    let mut felt = Vec::new();
    for _ in 0..samples {
        hold(&mut held)?;
        let state = held.state();
        let touch = single(&rod, state.pose, state.reactions, &Matrix3::zeros())?;
        felt.push((state.pose, state.reactions.f0y, [touch.x, touch.y]));
        held.to(Pose { x: state.pose.x - STEP, ..state.pose })?;
    }
    Ok(felt)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:>10} {:>10} {:>10} {:>12} {:>12}", "x0 (m)", "y0 (m)", "f0y (N)", "contact x", "contact y");
    for (pose, f0y, [x, y]) in follow(100)? {
        println!("{:10.6} {:10.6} {f0y:10.6} {x:12.9} {y:12.9}", pose.x, pose.y);
    }
    Ok(())
}
