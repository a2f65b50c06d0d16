//! What is wrong with a frame before anything is solved.

use super::fault::FrameFault;
use super::observation::{Channel, Frame, Measurand, SeenPoint};
use super::scatter::scatter;

/// Length of the points along the rod, as a share of the length of the rod, beyond which they are not of this rod, and below which they are in
/// another unit.
const LENGTHS: (f64, f64) = (0.02, 1.3);
/// Number of chords by which the length of a frame is measured.
const FEW_CHORDS: usize = 10;
/// Scatter of the points across the rod (L) from which on they are of more than one rod.
const MOST_SCATTER: f64 = 0.03;
/// Share of the points at which they turn back, from which on they are no curve.
const NO_CURVE: f64 = 0.2;
/// Cosine of the angle between two chords from which on the points turn back: 120 degrees.
const TURNS_BACK: f64 = -0.5;
/// Chords shorter than so many standard deviations have no direction.
const SHARP: f64 = 8.0;

/// What is wrong at first sight with a frame of a rod of `length` (m) whose points have the noise `sigma` (L).
pub(super) fn check(length: f64, frame: &Frame, sigma: f64) -> Result<(), FrameFault> {
    let number = |what, of: String, value: f64, expected| FrameFault::Number { what, of, value, expected };
    for (k, SeenPoint { x, y, sigma }) in frame.points.iter().enumerate() {
        let of = || format!("point {k} (from 0)");
        if let Some((what, value)) = [("x", *x), ("y", *y)].into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(number(what, of(), value, "a finite number (m)"));
        }
        if let Some(sigma) = sigma.filter(|sigma| !(*sigma > 0.0 && sigma.is_finite())) {
            return Err(number("sigma", of(), sigma, "a standard deviation larger than 0 (m)"));
        }
    }
    for Channel { quantity, value, sigma } in &frame.channels {
        let of = || quantity.to_string();
        if !value.is_finite() {
            return Err(number("the value", of(), *value, "a finite number"));
        }
        if !(*sigma > 0.0 && sigma.is_finite()) {
            return Err(number("sigma", of(), *sigma, "a standard deviation larger than 0"));
        }
    }
    let poses =
        frame.channels.iter().filter(|c| matches!(c.quantity, Measurand::Base(_) | Measurand::Support(_))).count();
    if frame.points.len() < 3 && (poses < 3 || frame.channels.len() + frame.points.len() < 4) {
        return Err(FrameFault::TooFew { points: frame.points.len(), channels: frame.channels.len() });
    }
    if frame.points.len() < 3 {
        return Ok(());
    }
    let chords: Vec<[f64; 2]> =
        frame.points.windows(2).map(|pair| [pair[1].x - pair[0].x, pair[1].y - pair[0].y]).collect();
    let turns_back = |sharp: f64| {
        let turns = move |pair: &[[f64; 2]]| {
            let [[ax, ay], [bx, by]] = [pair[0], pair[1]];
            let (a, b) = (ax.hypot(ay), bx.hypot(by));
            a > sharp && b > sharp && ax * bx + ay * by < TURNS_BACK * a * b
        };
        chords.windows(2).map(turns)
    };
    // along a few of the points, so that their noise does not add to the length
    let few = frame.points.iter().step_by(frame.points.len().div_ceil(FEW_CHORDS)).chain(frame.points.last());
    let few: Vec<&SeenPoint> = few.collect();
    let measured: f64 = few.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y)).sum();
    let ratio = measured / length;
    let scatter = scatter(std::iter::once(frame), length);
    if LENGTHS.1 >= ratio && scatter > MOST_SCATTER {
        return Err(FrameFault::Scatter { share: 1e2 * scatter });
    }
    if !(LENGTHS.0..=LENGTHS.1).contains(&ratio) {
        let back = turns_back(0.0).filter(|turns| *turns).count() as f64;
        let hint = match ratio {
            _ if back > NO_CURVE * chords.len() as f64 => {
                "their order turns back everywhere: are two rods mixed?".to_owned()
            }
            300.0..3000.0 => "are the points in mm?".to_owned(),
            3000.0.. => "are the points in pixels, without a scale?".to_owned(),
            3e-4..3e-3 => "is the rod's length in mm?".to_owned(),
            _ => "are the scale of the image and the rod right?".to_owned(),
        };
        return Err(FrameFault::Length { measured, length, hint });
    }
    let back = turns_back(SHARP * sigma * length).position(|turns| turns);
    back.map_or(Ok(()), |k| Err(FrameFault::Order { point: k + 1 }))
}
