//! Lever arms from loads.

use nalgebra::Vector3;
use proptest::prelude::*;
use rod_hw::*;
use std::array::from_fn;

/// Between -0.5 and 0.5, scaled to variance 1: a number mixed (SplitMix64).
fn noise(n: u64) -> f64 {
    let z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) as f64 / u64::MAX as f64 - 0.5) * 12.0_f64.sqrt()
}

proptest! {
    #[test]
    fn finds_what_was_put_in(
        lever in proptest::array::uniform3(-0.1..0.1),
        forces in proptest::collection::vec(proptest::array::uniform3(-2.0..2.0), 4..20),
    ) {
        let loads: Vec<Wrench> = forces.iter().map(|f| Wrench { force: *f, torque: cross(lever, *f) }).collect();
        if let Ok(found) = fit_lever_arm(&loads) {
            prop_assert!(found.lever.iter().zip(lever).all(|(a, b)| (a - b).abs() < 1e-11), "{found:?}");
            // and the clamp is then free of moments
            let frame = Frame::same().with_origin(found.lever).unwrap();
            let there = frame.wrench(&loads[0]);
            let free = there.torque.iter().all(|m| m.abs() < 1e-10);
            prop_assert!(free);
        }
    }
}

#[test]
fn its_standard_deviation_is_that_of_many_fits() {
    let lever = [0.01, -0.02, 0.03];
    let fit = |seed: u64| {
        let mut n = 1000 * seed;
        let loads: Vec<Wrench> = (0..12_u32)
            .map(|i| {
                let angle = f64::from(i);
                let force = [0.5 * angle.cos(), 0.5 * angle.sin(), if i % 3 == 0 { 0.3 } else { -0.1 }];
                let exact = cross(lever, force);
                let torque = from_fn(|k| {
                    n += 1;
                    exact[k] + 1e-4 * noise(n)
                });
                Wrench { force, torque }
            })
            .collect();
        fit_lever_arm(&loads).unwrap()
    };
    let count = 400.0;
    let fits: Vec<LeverArm> = (1..=400).map(fit).collect();
    for (i, exact) in lever.into_iter().enumerate() {
        let scatter = (fits.iter().map(|f| (f.lever[i] - exact).powi(2)).sum::<f64>() / count).sqrt();
        let stated = (fits.iter().map(|f| f.sigma[i].powi(2)).sum::<f64>() / count).sqrt();
        assert!((scatter / stated - 1.0).abs() < 0.2, "{scatter} {stated}");
    }
    let residual = fits.iter().map(|f| f.residual).sum::<f64>() / count;
    assert!((residual - 1e-4).abs() < 1e-5, "{residual}");
}

#[test]
fn refuses() {
    let load = Wrench { force: [0.0, -0.5, 0.0], torque: [0.0, 0.0, -1e-3] };
    assert_eq!(fit_lever_arm(&[load]), Err(GeometryError::Few { found: 1 }));
    let error = fit_lever_arm(&[load, load * 2.0, -load]).unwrap_err().to_string();
    assert!(error.starts_with("the forces differ by a sine of 0.000 only"), "{error}");
    assert_eq!(fit_lever_arm(&[Wrench::default(); 3]), Err(GeometryError::Parallel { spread: 0.0 }));
    let broken = Wrench { force: [f64::NAN, 0.0, 0.0], ..load };
    assert_eq!(fit_lever_arm(&[load, broken]), Err(GeometryError::NotFinite { load: 2 }));
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    Vector3::from(a).cross(&Vector3::from(b)).into()
}
