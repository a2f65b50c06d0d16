//! Friction that is strong, that changes, or that is not there.

use super::parabola::{State, scan};
use super::recording::rod;
use crate::common::noise::Noise;
use rod_core::Sample;
use rod_reconstruct::noise_estimate::ChannelNoise;
use rod_reconstruct::{Budget, Friction, Settings, reconstruct};

fn noisy(states: &[State], level: f64, seed: u64) -> Vec<Sample> {
    let mut noise = Noise::new(seed, 0.0);
    let mut sample = |state: &State| {
        let mut sample = state.sample;
        sample.reactions.f0x += level * 2.5 / 63.2 * noise.sample();
        sample.reactions.f0y += level * 2.5 / 63.2 * noise.sample();
        sample.reactions.m0z += level * 0.06 / 6.32 * noise.sample();
        sample
    };
    states.iter().map(|state| sample(state)).collect()
}

#[test]
fn look() {
    let _ = ChannelNoise::white(1.0);
    for (name, step, level, mu) in [
        ("0", 2e-4, 0.0, Box::new(|_| 0.0) as Box<dyn Fn(f64) -> f64>),
        ("0.1", 2e-4, 0.0, Box::new(|_| 0.1)),
        ("0.3", 2e-4, 0.0, Box::new(|_| 0.3)),
        ("-0.3", 2e-4, 0.0, Box::new(|_| -0.3)),
        ("0 noisy", 2e-5, 1.0, Box::new(|_| 0.0)),
        ("0.02 noisy", 2e-5, 1.0, Box::new(|_| 0.02)),
        ("0.1 noisy", 2e-5, 1.0, Box::new(|_| 0.1)),
        ("0.3 noisy", 2e-5, 1.0, Box::new(|_| 0.3)),
        ("0.2+0.3x clean", 2e-4, 0.0, Box::new(|x| 0.2 + 0.3 * x)),
        ("0.2+0.3x noisy", 2e-5, 1.0, Box::new(|x| 0.2 + 0.3 * x)),
        ("step noisy", 2e-5, 1.0, Box::new(|x| if x > 0.1 { 0.1 } else { 0.2 })),
    ] {
        let states = scan(step, -0.3, mu);
        let samples = noisy(&states, level, 1);
        for (how, settings) in [
            ("none", Settings::default()),
            ("estimate", Settings { friction: Friction::Estimate, ..Settings::default() }),
            ("as is", Settings { friction: Friction::Estimate, budget: Some(Budget::NONE), ..Settings::default() }),
        ] {
            let start = std::time::Instant::now();
            let found = reconstruct(&rod(), &samples, &settings).unwrap();
            let time = start.elapsed();
            let right = found.readings.iter().zip(&states).filter(|(a, b)| a.label == b.label).count();
            let pass = &found.passes[0];
            let mut off = Vec::new();
            let (mut z, mut none) = (Vec::new(), 0);
            for (reading, state) in found.readings.iter().zip(&states) {
                let Some([_, x, y, alpha]) = state.contact else { continue };
                match reading.touch {
                    Ok(touch) => {
                        let across = (alpha.cos() * (touch.y - y) - alpha.sin() * (touch.x - x)).abs();
                        off.push(across);
                        z.push(across / touch.sigma_normal());
                    }
                    Err(_) => none += 1,
                }
            }
            off.sort_by(f64::total_cmp);
            z.sort_by(f64::total_cmp);
            let at = |v: &[f64], share: f64| v.get((share * (v.len().max(1) - 1) as f64) as usize).copied().unwrap_or(f64::NAN);
            println!("{name} {how}: {time:?}, labels {:.4}, used {:.6}, {none} none, off {:.1e} {:.1e} {:.1e}, z {:.2} {:.2} {:.2}", right as f64 / states.len() as f64, pass.used_friction,
                at(&off, 0.5), at(&off, 0.95), at(&off, 1.0), at(&z, 0.5), at(&z, 0.95), at(&z, 1.0));
            println!("      {:?}", pass.friction);
            for finding in found.findings() {
                println!("      {finding}");
            }
        }
    }
}
