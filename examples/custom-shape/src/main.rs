//! A rod swept past ripples between two walls, a scene built in code: `cargo run --release`.

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::process::ExitCode;

use custom_shape::Trochoid;
use vibrissa::contact::{Item, Phase};
use vibrissa::contour::Frame;
use vibrissa::{ClampPath, Composite, Contour, Line, Pose, Rod, State, Sweep};

/// Distance of reported states, m.
const STEP: f64 = 5e-3;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let rod = Rod::from_diameter(0.1, 0.5e-3, 206e9)?; // length m, diameter m, Young's modulus Pa
    let object = object(0.006, 0.003)?;
    let clamp = |x| Pose { x, y: -0.06, phi: FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.12), clamp(-0.2))?;

    println!("{:>10}  {:14}  {:5}  {:>10}  {:>10}  {:>10}", "x0 (m)", "", "phase", "f0x (N)", "f0y (N)", "m0z (N m)");
    for item in Sweep::new(&rod, &object, path, STEP)? {
        match item {
            // Free states are all alike.
            Ok(Item::State(state)) if state.phase() == Phase::FREE => {}
            Ok(Item::State(state)) => println!("{}", row("", &state)),
            Ok(Item::Event(event)) => println!("{}", row(&event.kind.to_string(), &event.after)),
            Err(stop) => {
                eprintln!("{stop}");
                return Ok(ExitCode::from(2));
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Three crests between two walls, which go on where the outer ripples are straight: smooth throughout. Lengths in m.
fn object(radius: f64, arm: f64) -> Result<Composite, Box<dyn Error>> {
    let ripples = Trochoid::new(radius, arm, TAU + (arm / radius).acos())?; // to the inflections
    let [start, end] = [ripples.range().from, ripples.range().to].map(|t| ripples.frame(t));
    let along = |Frame { x, y, alpha, .. }: Frame, way: f64| [x + way * alpha.cos(), y + way * alpha.sin()];
    let falling = Line::new(along(start, -0.15), [start.x, start.y])?;
    let rising = Line::new([end.x, end.y], along(end, 0.15))?;
    Ok(Composite::new(vec![Box::new(falling), Box::new(ripples), Box::new(rising)])?)
}

/// A line of the table: where the clamp is, what happened, the phase and what the clamp feels.
fn row(event: &str, state: &State) -> String {
    let r = state.reactions;
    let phase = state.phase();
    format!("{:10.6}  {event:14}  {phase:5}  {:10.6}  {:10.6}  {:10.7}", state.pose.x, r.f0x, r.f0y, r.m0z)
}
