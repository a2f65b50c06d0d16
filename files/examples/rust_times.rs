//! The Rust half of `python/bench/crossing.py`. Prints the shortest time in seconds of a sweep with 1,000 steps past a scene, and of the
//! reconstruction of a recording of it.
#![allow(clippy::print_stdout, reason = "it is there to be read")]

use rod_files::{ReadOptions, Reconstructed, Recording, Scene};
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;
use vibrissa::{Settings, Sweep};

/// The shortest of several times: what else the machine does makes the others longer.
fn shortest(rounds: u32, mut work: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut best = f64::INFINITY;
    for _ in 0..rounds {
        let begin = Instant::now();
        work()?;
        best = best.min(begin.elapsed().as_secs_f64());
    }
    Ok(best)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, recording, sweeps, reconstructions] = &arguments[..] else {
        return Err("expected SCENE RECORDING SWEEPS RECONSTRUCTIONS".into());
    };
    let scene = Scene::read(Path::new(scene))?;
    let step = scene.path.length() / 1000.0;
    let swept = shortest(sweeps.parse()?, || {
        black_box(Sweep::new(&scene.rod, &scene.objects, scene.path, step)?.run());
        Ok(())
    })?;
    let recording = Recording::read(Path::new(recording), scene.rod.at_clamp(), &ReadOptions::default())?;
    let reconstructed = shortest(reconstructions.parse()?, || {
        black_box(Reconstructed::new(recording.clone(), scene.rod.clone(), &Settings::default())?);
        Ok(())
    })?;
    println!("{swept} {reconstructed}");
    Ok(())
}
