//! The errors of contact points in units of their standard deviations.

use super::scene::Scan;
use rod_contact::State;
use rod_contours::Contour;
use rod_reconstruct::nalgebra::Vector2;
use rod_reconstruct::{Label, Reading, Touch};
use std::collections::BTreeMap;

/// Errors of contour points below this count as none, lengths of the rod.
const ROUNDING: f64 = 1e-6;
/// What is farther than this many standard deviations from the contour is wrong.
pub const WRONG: f64 = 6.0;

/// The points of one contact in one phase.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Samples with several contacts, and how many of them have this contact.
    pub samples: usize,
    pub answered: usize,
    /// Points beyond `WRONG` standard deviations.
    pub wrong: usize,
    /// Largest distance from the contour, in lengths of the rod and in standard deviations.
    pub largest: f64,
    pub most_sigmas: f64,
    /// Sum of the squared distances in standard deviations, and their number.
    pub squares: f64,
    pub measured: usize,
    /// Scans with wrong points.
    pub scans: usize,
    pub reasons: BTreeMap<String, usize>,
}

impl Tally {
    fn add(&mut self, gap: f64, sigma: f64) {
        self.answered += 1;
        self.largest = self.largest.max(gap);
        if gap > ROUNDING {
            self.most_sigmas = self.most_sigmas.max(gap / sigma);
            self.wrong += usize::from(gap > WRONG * sigma);
        }
        self.squares += (gap / sigma).powi(2).min(1e4);
        self.measured += 1;
    }

    pub fn join(&mut self, other: &Self) {
        self.samples += other.samples;
        self.answered += other.answered;
        self.wrong += other.wrong;
        self.largest = self.largest.max(other.largest);
        self.most_sigmas = self.most_sigmas.max(other.most_sigmas);
        self.squares += other.squares;
        self.measured += other.measured;
        self.scans += usize::from(other.wrong > 0);
        for (why, count) in &other.reasons {
            *self.reasons.entry(why.clone()).or_default() += count;
        }
    }
}

/// Tallies by true phase and contact.
pub type Tallies = BTreeMap<(String, &'static str), Tally>;

fn gap(scan: &Scan, touch: &Touch) -> f64 {
    scan.scene.objects.iter().map(|o| o.closest(touch.x, touch.y).gap.abs()).fold(f64::INFINITY, f64::min)
}

/// Judges all samples. Those that have one contact and are said to have it are called `one`, others that have at most one `other`.
pub fn judge(scan: &Scan, readings: &[Reading]) -> Tallies {
    let mut tallies = Tallies::new();
    for (state, reading) in scan.states.iter().zip(readings) {
        let phase = state.phase();
        let truth = Label::of(phase.contacts, phase.tip);
        if !truth.several() && !reading.label.several() {
            let tally = tallies.entry(("one".into(), "only")).or_default();
            tally.samples += 1;
            if let Ok(touch) = reading.touch {
                tally.add(gap(scan, &touch), touch.sigma_normal());
            }
            continue;
        }
        let name = if truth.several() { phase.to_string() } else { "other".into() };
        let contacts = [("first", Some(reading.touch)), ("second", reading.second)];
        for (which, touch) in contacts {
            let tally = tallies.entry((name.clone(), which)).or_default();
            tally.samples += 1;
            match touch {
                _ if !reading.label.several() => {
                    *tally.reasons.entry(format!("label {}", reading.label)).or_default() += 1
                }
                Some(Ok(touch)) => tally.add(gap(scan, &touch), touch.sigma_normal()),
                Some(Err(why)) => {
                    let why: String = why.to_string().chars().filter(|c| c.is_alphabetic() || *c == ' ').collect();
                    *tally.reasons.entry(why).or_default() += 1;
                }
                None => {}
            }
        }
    }
    tallies
}

/// Consecutive samples whose point is wrong.
struct Stretch {
    from: usize,
    to: usize,
    gap: f64,
    sigmas: f64,
    what: String,
    /// Largest distance from the true contact in standard deviations of that distance.
    off: f64,
}

/// Samples without a wrong point that a stretch of wrong ones may contain.
const BETWEEN: usize = 50;

/// Distance of a point from the true contact in standard deviations of its components.
fn off(state: &State, which: &str, touch: &Touch) -> f64 {
    let contact = if which == "first" { state.contacts.first() } else { state.contacts.last() };
    let Some(contact) = contact else { return f64::INFINITY };
    let d = Vector2::new(touch.x - contact.x, touch.y - contact.y);
    touch.covariance.try_inverse().map_or(f64::NAN, |inverse| (d.dot(&(inverse * d))).max(0.0).sqrt())
}

/// The wrong points, a line for each stretch of samples.
pub fn wrong(scan: &Scan, readings: &[Reading]) -> Vec<String> {
    let mut stretches: Vec<Stretch> = Vec::new();
    for which in ["first", "second"] {
        for (k, (state, reading)) in scan.states.iter().zip(readings).enumerate() {
            let touch = if which == "first" { Some(reading.touch) } else { reading.second };
            let Some(Ok(touch)) = touch.filter(|_| reading.label.several()) else { continue };
            let (gap, sigma) = (gap(scan, &touch), touch.sigma_normal());
            if gap <= ROUNDING || gap <= WRONG * sigma {
                continue;
            }
            let what = format!("{which}, {} as {}", state.phase(), reading.label);
            let off = off(state, which, &touch);
            match stretches.last_mut() {
                Some(last) if last.what == what && k <= last.to + BETWEEN => {
                    last.off = last.off.max(off);
                    last.to = k;
                    last.gap = last.gap.max(gap);
                    last.sigmas = last.sigmas.max(gap / sigma);
                }
                _ => stretches.push(Stretch { from: k, to: k, gap, sigmas: gap / sigma, what, off }),
            }
        }
    }
    let line = |s: &Stretch| {
        format!(
            "{}..={}: {}: {:.1e} L, {:.1} sigma, {:.1} from the contact",
            s.from, s.to, s.what, s.gap, s.sigmas, s.off
        )
    };
    stretches.iter().map(line).collect()
}
