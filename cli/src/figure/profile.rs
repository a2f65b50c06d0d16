//! The contours of a scene.

use super::canvas::{FigureError, HPos, TITLE, span, svg, write};
use super::contour;
use super::element::Element;
use super::palette::{INK, WHITE};
use super::plane::PlaneWindow;
use rod_files::Profile;
use std::ops::Range;

/// Width of the picture and bounds of its height, pixels.
const WIDTH: u32 = 1200;
const HEIGHT: Range<f64> = 420.0..1500.0;
/// Room for the title, pixels.
const HEAD: u32 = 70;
/// Radius of the marks where pieces meet, and their least distance, pixels.
const MARK: i32 = 6;
const MARKS: f64 = 18.0;

/// Draws the contours of a scene.
pub(crate) fn profile(name: &str, profiles: &[Profile]) -> Result<String, FigureError> {
    let all = || profiles.iter().flat_map(|profile| &profile.points);
    let x = span(all().map(|point| 1e3 * point.x), 0.06);
    let y = span(all().map(|point| 1e3 * point.y), 0.06);
    let (beside, below) = PlaneWindow::TRIMMINGS;
    let (plot, trimmings) = (f64::from(WIDTH - beside), f64::from(below + HEAD));
    let height = (plot * (y.end - y.start) / (x.end - x.start) + trimmings).clamp(HEIGHT.start, HEIGHT.end).round();
    let window = PlaneWindow::of(&x, &y, (plot, height - trimmings), (0.0, 0.0));
    svg((WIDTH, height as u32), |root| {
        let (head, body) = root.split_vertically(HEAD);
        write(&head, name, (24, 36), HPos::Left, TITLE, INK)?;
        let chart = window.chart(&body, (12, 10))?;
        for profile in profiles {
            contour::draw(&chart, &window, profile.points.iter().map(|point| (1e3 * point.x, 1e3 * point.y)))?;
            let marks = marks(&profile.joints, MARKS * window.scale);
            chart.draw_series(marks.iter().map(|mark| Element::circle(*mark, MARK, WHITE.filled())))?;
            chart.draw_series(marks.iter().map(|mark| Element::circle(*mark, MARK, INK.stroke_width(3))))?;
        }
        Ok(())
    })
}

/// The joints (mm) that are at least so far (mm) from the one before; none where most are nearer, as on a fine polygon.
fn marks(joints: &[[f64; 2]], least: f64) -> Vec<(f64, f64)> {
    let mut marks: Vec<(f64, f64)> = Vec::new();
    for [x, y] in joints {
        let (x, y) = (1e3 * x, 1e3 * y);
        if marks.last().is_none_or(|last| (last.0 - x).hypot(last.1 - y) >= least) {
            marks.push((x, y));
        }
    }
    if 2 * marks.len() < joints.len() { Vec::new() } else { marks }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_too_near_to_be_told_apart_are_not_marked() {
        let joints = |apart: f64| (0..100).map(|k| [1e-3 * apart * f64::from(k), 0.0]).collect::<Vec<_>>();
        assert_eq!(marks(&joints(1.0), 0.9).len(), 100);
        assert!(marks(&joints(1.0), 2.5).is_empty());
    }
}
