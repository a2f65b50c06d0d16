//! Which kinks a noise level lets one see at all.

use super::{Clean, Level, MARGIN, Noise, STEP};
use std::collections::BTreeMap;
use vibrissa::reconstruct::kink::KinkKind;
use vibrissa::{Settings, reconstruct};

/// Half-windows, m.
const HALVES: [f64; 5] = [0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3];
/// Longest half-window that is taken for usable: over longer ones the reactions are no quadratics, m.
const USABLE: f64 = 4e-3;
/// A change of slope must exceed its standard deviation by so much.
const SURE: f64 = 5.0;

/// Standard deviation of the change of slope (per m) that a quadratic with a hinge, fitted to half-windows of length `half`
/// (m) on either side, finds in noise of this standard deviation: 8 sqrt(6) sigma / (H sqrt(n)), n samples in a half-window,
/// times the root of the noise's long-run variance.
pub fn slope_sigma(sigma: f64, noise: &Noise, half: f64) -> f64 {
    8.0 * 6_f64.sqrt() * sigma * noise.long_run().sqrt() / (half * (half / STEP).sqrt())
}

/// The least changes of slope that stand out, for each noise.
pub fn limits<'a>(noises: impl IntoIterator<Item = (&'a Level, &'a Noise)>) -> String {
    let heads: Vec<String> = HALVES.iter().map(|half| format!("H = {} mm", 1e3 * half)).collect();
    let mut text = format!("| noise | {} |\n|---|{}\n", heads.join(" | "), "---|".repeat(HALVES.len()));
    for (level, noise) in noises {
        let cells = HALVES.map(|half| {
            let [force, moment] = [level.force, level.moment].map(|sigma| SURE * slope_sigma(sigma, noise, half));
            format!("{:.2} / {:.3}", force, moment)
        });
        text += &format!("| {}, {} | {} |\n", level.title(), noise.name, cells.join(" | "));
    }
    text
}

/// A kind of transition: how far its changes of slope range, and how many there are.
#[derive(Default)]
struct Sizes {
    count: usize,
    least: [f64; 3],
    largest: [f64; 3],
    below: Vec<usize>,
}

/// The kinks of the scans by the kind of transition, as clean data show them, and how many of each kind are below the limit:
/// whose three changes of slope together exceed their standard deviations by less than 5 in the longest window that fits
/// between the transitions beside, 4 mm at most.
pub fn kinks_below(scans: &[Clean], noises: &[(&Level, &Noise)]) -> super::Outcome<String> {
    let mut kinds: BTreeMap<String, Sizes> = BTreeMap::new();
    for clean in scans {
        let found = reconstruct(clean.scene.rod.at_clamp(), &clean.samples, &Settings::default())?;
        for (index, transition) in clean.transitions.iter().enumerate() {
            let near = found.kinks.iter().filter(|kink| (kink.tau - transition.at).abs() < MARGIN);
            let near = near.min_by(|a, b| (a.tau - transition.at).abs().total_cmp(&(b.tau - transition.at).abs()));
            let Some(kink) = near.filter(|kink| transition.shows && kink.kind == KinkKind::Kink) else { continue };
            let others = clean.transitions.iter().enumerate().filter(|other| other.0 != index);
            let room = others.map(|other| (other.1.at - transition.at).abs()).fold(USABLE, f64::min);
            let sizes = kinds.entry(transition.name.clone()).or_default();
            sizes.below.resize(noises.len(), 0);
            for (below, (level, noise)) in sizes.below.iter_mut().zip(noises) {
                let sigmas = [level.force, level.force, level.moment].map(|sigma| slope_sigma(sigma, noise, room));
                let square: f64 = kink.change.iter().zip(sigmas).map(|(change, sigma)| (change / sigma).powi(2)).sum();
                *below += usize::from(square.sqrt() < SURE);
            }
            for c in 0..3 {
                let size = kink.change[c].abs();
                sizes.least[c] = if sizes.count == 0 { size } else { sizes.least[c].min(size) };
                sizes.largest[c] = sizes.largest[c].max(size);
            }
            sizes.count += 1;
        }
    }
    let heads: Vec<String> = noises.iter().map(|(level, noise)| format!("{}, {}", level.title(), noise.name)).collect();
    let mut text = format!(
        "| transition | number | f0x, mN/mm | f0y, mN/mm | m0z, mN m/mm | {} |\n|---|---|---|---|---|{}\n",
        heads.join(" | "),
        "---|".repeat(noises.len())
    );
    for (name, sizes) in kinds {
        // N/m is mN/mm, N m/m is mN m/mm
        let range = |c: usize| format!("{:.2} to {:.2}", sizes.least[c], sizes.largest[c]);
        let below: Vec<String> = sizes.below.iter().map(usize::to_string).collect();
        let ranges = [range(0), range(1), range(2)].join(" | ");
        text += &format!("| {name} | {} | {ranges} | {} |\n", sizes.count, below.join(" | "));
    }
    Ok(text)
}
