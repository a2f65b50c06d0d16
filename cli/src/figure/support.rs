//! What holds the rod: the springs of its clamp, and a roller ahead of it, as symbols of a fixed size.

use super::canvas::FigureError;
use super::chart::Chart;
use super::element::Element;
use super::palette::{INK, WHITE};
use super::plane::PlaneWindow;
use std::f64::consts::{FRAC_PI_2, TAU};
use vibrissa::rod::{AnyRod, PhysicalRod};
use vibrissa::{Pose, State};

/// Distance of the plate from the base of the rod, half of its width, and half of the width of the spring, pixels.
const BEHIND: f64 = 44.0;
const PLATE: f64 = 20.0;
const TURN: f64 = 9.0;
/// Straight ends of the spring, pixels, and its corners.
const END: f64 = 8.0;
const CORNERS: usize = 7;
/// Radii of the first and the last turn of a spiral spring, pixels, its turns and its points.
const SPIRAL: (f64, f64) = (5.0, 15.0);
const TURNS: f64 = 2.25;
const POINTS: usize = 60;
/// Strokes behind the plate, and their length, pixels.
const STROKES: usize = 5;
const STROKE: f64 = 9.0;
/// Radius of a roller, and the gap between it and the middle of the rod, pixels.
const ROLLER: f64 = 7.0;
const GAP: f64 = 2.0;
/// Width of all lines, pixels.
const LINE: u32 = 2;

/// Draws what holds the rod in a state.
pub(super) fn draw(chart: &Chart<'_>, window: &PlaneWindow, rod: &AnyRod, state: &State) -> Result<(), FigureError> {
    if let Some(springs) = rod.springs() {
        let base = rod.base(state.pose, &state.reactions);
        let compliance = springs.compliance();
        let (moves, turns) = (compliance[0][0] + compliance[1][1] > 0.0, compliance[2][2] > 0.0);
        let frame = DrawingFrame::new((base.x, base.y), base.phi, window.scale);
        chart.draw_series(springs_behind(moves, turns).into_iter().map(|line| frame.line(line)))?;
    }
    if let Some(roller) = &state.roller {
        let frame = DrawingFrame::new((roller.x, roller.y), roller.alpha, window.scale);
        let middles = [-1.0, 1.0].map(|side| frame.at((0.0, side * (ROLLER + GAP))));
        chart.draw_series(middles.map(|at| Element::circle(at, ROLLER, WHITE.filled())))?;
        chart.draw_series(middles.map(|at| Element::circle(at, ROLLER, INK.stroke_width(LINE))))?;
    }
    Ok(())
}

/// Draws a rigid clamp: the plate without springs, at the base of the rod.
pub(super) fn draw_rigid(chart: &Chart<'_>, window: &PlaneWindow, pose: Pose) -> Result<(), FigureError> {
    let frame = DrawingFrame::new((pose.x, pose.y), pose.phi, window.scale);
    let at_base = |line: Vec<(f64, f64)>| line.into_iter().map(|(x, y)| (x + BEHIND, y)).collect();
    chart.draw_series(plate().into_iter().map(at_base).map(|line| frame.line(line)))
}

/// Lines (pixels) of a plate behind the base and its strokes.
fn plate() -> Vec<Vec<(f64, f64)>> {
    let mut lines = vec![vec![(-BEHIND, -PLATE), (-BEHIND, PLATE)]];
    let apart = 2.0 * PLATE / STROKES as f64;
    lines.extend((0..STROKES).map(|k| {
        let y = -PLATE + (k as f64 + 1.0) * apart;
        vec![(-BEHIND, y), (-BEHIND - STROKE, y - STROKE)]
    }));
    lines
}

/// Lines (pixels, the rod runs to +x from the origin) of a plate that moves with the clamp, and of what connects it to the rod: a coil spring
/// if the base moves, a spiral one if it turns.
fn springs_behind(moves: bool, turns: bool) -> Vec<Vec<(f64, f64)>> {
    let mut lines = plate();
    let mut rest = vec![(0.0, 0.0)];
    if moves {
        let pitch = (BEHIND - 2.0 * END) / (CORNERS as f64 - 1.0);
        let corner = |k: usize| (-END - pitch * k as f64, if k.is_multiple_of(2) { TURN } else { -TURN });
        rest.push((-END, 0.0));
        rest.extend((0..CORNERS).map(corner));
        rest.push((END - BEHIND, 0.0));
    }
    rest.push((-BEHIND, 0.0));
    lines.push(rest);
    if turns {
        let spiral = |k: usize| {
            let part = k as f64 / POINTS as f64;
            let (sin, cos) = (TAU * TURNS * part + FRAC_PI_2).sin_cos();
            let radius = SPIRAL.0 + (SPIRAL.1 - SPIRAL.0) * part;
            (radius * cos, radius * sin)
        };
        lines.push((0..=POINTS).map(spiral).collect());
    }
    lines
}

/// A place (m) and a direction in the plane, to draw about by pixels.
struct DrawingFrame {
    origin: (f64, f64),
    sin_cos: (f64, f64),
    /// mm per pixel
    scale: f64,
}

impl DrawingFrame {
    fn new((x, y): (f64, f64), direction: f64, scale: f64) -> Self {
        Self { origin: (1e3 * x, 1e3 * y), sin_cos: direction.sin_cos(), scale }
    }

    /// mm
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (sin, cos) = self.sin_cos;
        (self.origin.0 + self.scale * (x * cos - y * sin), self.origin.1 + self.scale * (x * sin + y * cos))
    }

    fn line(&self, points: Vec<(f64, f64)>) -> Element {
        Element::line(points.into_iter().map(|point| self.at(point)), INK.stroke_width(LINE))
    }
}

#[cfg(test)]
mod tests {
    use crate::figure;
    use rod_files::{Scan, Scene};

    /// The figure of a sweep with this table `[clamp]`.
    fn figure_of_sweep(clamp: &str) -> String {
        let scene = include_str!("../../../scenes/O1_q40.toml").replace("step = 1e-3", "step = 1e-2");
        let scene = Scene::parse("scene.toml".as_ref(), &format!("{scene}\n{clamp}")).unwrap();
        figure::sweep(&Scan::run(scene).unwrap()).unwrap()
    }

    #[test]
    fn what_holds_the_rod_is_drawn_at_both_ends_of_the_path() {
        let lines = |clamp: &str| figure_of_sweep(clamp).matches("stroke=\"#000000\" stroke-width=\"2\"").count();
        let rollers = |clamp: &str| figure_of_sweep(clamp).matches("<circle").count();
        let rigid = lines("");
        // the plate with five strokes and the connection; a spiral spring is one line more
        assert_eq!(lines("[clamp]\nstiffness_x = 500") - rigid, 2 * 7);
        assert_eq!(lines("[clamp]\nstiffness_phi = 0.4") - rigid, 2 * 8);
        assert_eq!(rollers("[clamp]\nroller = 0.02") - rollers(""), 2 * 4);
    }
}
