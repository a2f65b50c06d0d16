//! The equilibria of a rod without contacts, and the forces on it.

use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use super::element::Element;
use super::film::arrow;
use super::labels::Labels;
use super::line::thin_line;
use super::palette::{FIRST, INK, MUTED, OTHERS};
use super::plane::PlaneWindow;
use super::support;
use rod_files::ElasticaRun;
use std::f64::consts::FRAC_PI_2;
use vibrissa::rod::{AnyRod, ElasticaEquilibrium, TipEnd};

/// Points on a shape, at least.
const POINTS: usize = 400;
/// Least and largest height of the plane, and height of the title, pixels.
const HEIGHT: (f64, f64) = (300.0, 1200.0);
const HEAD: u32 = 110;
/// Width of the lines of stable and unstable equilibria, pixels, and the dashes of these.
const STABLE: u32 = 5;
const UNSTABLE: u32 = 3;
const DASH: (i32, i32) = (14, 10);
/// Length of the largest force that is drawn, pixels.
const ARROW: f64 = 110.0;
/// Distance of a number from the tip, pixels.
const BESIDE: f64 = 24.0;

/// Draws the shapes: stable ones as lines, unstable ones dashed, and the forces that are given.
pub(crate) fn equilibria(run: &ElasticaRun) -> Result<String, FigureError> {
    let count = POINTS.max(run.scene.points);
    let curve = |one: &ElasticaEquilibrium<AnyRod>| -> Vec<(f64, f64)> {
        one.shape.sample(count).map(|at| (1e3 * at.x, 1e3 * at.y)).collect()
    };
    let curves: Vec<_> = run.equilibria.iter().map(curve).collect();
    let seen = || curves.iter().flatten().copied();
    let length = 1e3 * run.scene.rod.length();
    let widened = |value: f64| [value - 0.04 * length, value + 0.04 * length];
    let (x, y) = (span(seen().flat_map(|at| widened(at.0)), 0.1), span(seen().flat_map(|at| widened(at.1)), 0.1));
    let (window, height) = PlaneWindow::as_wide_as(PAGE, &x, &y, HEIGHT);
    let forces: Vec<_> = run.equilibria.iter().flat_map(|one| forces(run, one)).collect();
    let largest = forces.iter().fold(0.0_f64, |most, (_, [fx, fy])| most.max(fx.hypot(*fy)));
    svg((PAGE, HEAD + height), |root| {
        let (head, area) = root.split_vertically(HEAD);
        write(&head, &format!("{}: equilibria", run.scene.name), (24, 36), HPos::Left, TITLE, INK)?;
        let arrows = if largest > 0.0 {
            format!("; arrows: given forces, the longest {} N", rounded(largest))
        } else {
            String::new()
        };
        let note = format!("numbers: branches; lines: stable; dashed: unstable{arrows}");
        write(&head, &note, (24, 80), HPos::Left, BODY, MUTED)?;
        let chart = window.chart(&area, (12, 10))?;
        // the first ones on top
        for (branch, (one, curve)) in run.equilibria.iter().zip(&curves).enumerate().rev() {
            let line = thin_line(curve.iter().copied(), (window.scale, window.scale));
            let colour = OTHERS[branch % OTHERS.len()];
            chart.draw_series([match one.stable {
                true => Element::line(line, colour.stroke_width(STABLE)),
                false => Element::dashed(line, DASH, colour.stroke_width(UNSTABLE)),
            }])?;
        }
        support::draw_rigid(&chart, &window, run.scene.clamp)?;
        for (to, force) in &forces {
            let length = window.scale * ARROW / largest;
            for line in arrow(*to, *force, length, window.scale) {
                chart.draw_series([Element::line(line, FIRST.stroke_width(2))])?;
            }
        }
        let mut labels = Labels::default();
        for (branch, one) in run.equilibria.iter().enumerate() {
            let places = places(run, one).into_iter().map(|(at, direction)| {
                let ((x, y), (sin, cos)) = (chart.backend_coord(&at), direction.sin_cos());
                (x + (BESIDE * cos).round() as i32, y - (BESIDE * sin).round() as i32)
            });
            if let Some(place) = labels.place(places, (BODY as i32, BODY as i32)) {
                write(root, &branch.to_string(), place, HPos::Center, BODY, OTHERS[branch % OTHERS.len()])?;
            }
        }
        Ok(())
    })
}

/// Where the number of an equilibrium may stand: places on the rod (mm), and directions from there. All tips that are held are at one place, and
/// shapes like an S cross in the middle.
fn places(run: &ElasticaRun, one: &ElasticaEquilibrium<AnyRod>) -> Vec<((f64, f64), f64)> {
    let is_held = [run.scene.tip.x, run.scene.tip.y].iter().all(|end| matches!(end, TipEnd::Held(_)));
    let (parts, turns) = match is_held {
        true => ([0.3, 0.7, 0.4, 0.6, 0.2], [FRAC_PI_2, -FRAC_PI_2]),
        false => ([1.0; 5], [0.9, -0.9]),
    };
    let at = |part: f64| {
        let at = one.shape.at(part * one.shape.length());
        turns.map(|turn| ((1e3 * at.x, 1e3 * at.y), at.phi + turn))
    };
    parts.into_iter().flat_map(at).collect()
}

/// A number with four digits.
fn rounded(value: f64) -> String {
    let power = 10.0_f64.powf(3.0 - value.log10().floor());
    format!("{}", (value * power).round() / power)
}

/// The places (mm) and the given forces (N) on the rod.
fn forces(run: &ElasticaRun, one: &ElasticaEquilibrium<AnyRod>) -> Vec<((f64, f64), [f64; 2])> {
    let given = |end: TipEnd| if let TipEnd::Loaded(force) = end { force } else { 0.0 };
    let tip = (one.shape.length(), [given(run.scene.tip.x), given(run.scene.tip.y)]);
    let all = run.scene.loads.iter().map(|load| (load.s, [load.fx, load.fy])).chain([tip]);
    let placed = all.filter(|(_, [fx, fy])| fx.hypot(*fy) > 0.0).map(|(s, force)| {
        let at = one.shape.at(s);
        ((1e3 * at.x, 1e3 * at.y), force)
    });
    placed.collect()
}
