//! The recording with mu = 0.1, reconstructed.

use super::recording::{recording, rod};
use rod_reconstruct::{Budget, Friction, Reconstruction, Settings, reconstruct};

fn found(settings: &Settings) -> Reconstruction {
    reconstruct(&rod(), &recording().samples, settings).unwrap()
}

#[test]
fn look() {
    let recording = recording();
    for (name, settings) in [
        ("as is, estimate", Settings { friction: Friction::Estimate, budget: Some(Budget::NONE), ..Settings::default() }),
        ("estimate", Settings { friction: Friction::Estimate, ..Settings::default() }),
        ("known", Settings { friction: Friction::Known { mu: 0.1, sigma: 0.0 }, ..Settings::default() }),
        ("none", Settings::default()),
        ("none as is", Settings { budget: Some(Budget::NONE), ..Settings::default() }),
    ] {
        let start = std::time::Instant::now();
        let found = found(&settings);
        let time = start.elapsed();
        let right = found.readings.iter().zip(&recording.labels).filter(|(a, b)| a.label == **b).count();
        let pass = &found.passes[0];
        println!("{name}: {time:?}, labels {right} of {}, used {:e}, {:?}", recording.labels.len(), pass.used_friction - 0.1, pass.friction);
        let mut off: Vec<Vec<f64>> = vec![Vec::new(); 6];
        let mut none = [0; 3];
        for contact in &recording.contacts {
            let reading = &found.readings[contact.row];
            let several = recording.labels[contact.row].several();
            let kind = if several { 1 + contact.contact } else { 0 };
            let touch = if contact.contact == 0 { reading.touch } else { reading.second.unwrap_or(reading.touch) };
            match touch {
                Ok(touch) => {
                    off[kind].push((touch.x - contact.x).hypot(touch.y - contact.y));
                    off[kind + 3].push((touch.alpha - contact.alpha).abs());
                }
                Err(_) => none[kind] += 1,
            }
        }
        for (k, off) in off.iter_mut().enumerate() {
            off.sort_by(f64::total_cmp);
            if let Some(last) = off.last() {
                println!("   {k}: {} points, {} none, median {:e} 95 % {:e} worst {last:e}", off.len(), none[k % 3], off[off.len() / 2], off[off.len() * 95 / 100]);
            }
        }
        println!("   runs {:?}", found.runs);
        for finding in found.findings() {
            println!("   {finding}");
        }
    }
}
