//! The equilibria of a rod without contacts, and the forces on it.

use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use super::element::Element;
use super::film::arrow;
use super::line::thin_line;
use super::palette::{FIRST, INK, MUTED, OTHERS};
use super::plane::PlaneWindow;
use super::support;
use rod_files::ElasticaRun;
use std::f64::consts::{FRAC_PI_2, PI};
use vibrissa::Pose;
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
/// Distance of a number from its shape, pixels.
const BESIDE: f64 = 24.0;
/// Places on a shape beside which its number may stand.
const PLACES: usize = 25;

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
        if let Some(pose) = tip_clamp(run) {
            support::draw_rigid(&chart, &window, pose)?;
        }
        for (to, force) in &forces {
            let length = window.scale * ARROW / largest;
            for line in arrow(*to, *force, length, window.scale) {
                chart.draw_series([Element::line(line, FIRST.stroke_width(2))])?;
            }
        }
        let numbers = number_places(run, &curves, BESIDE * window.scale);
        for (branch, place) in numbers.into_iter().enumerate() {
            let place = chart.backend_coord(&place);
            write(root, &branch.to_string(), place, HPos::Center, BODY, OTHERS[branch % OTHERS.len()])?;
        }
        Ok(())
    })
}

/// The pose of a tip that is held in place and in angle, turned by pi: that of a clamp there.
fn tip_clamp(run: &ElasticaRun) -> Option<Pose> {
    let tip = run.scene.tip;
    match (tip.x, tip.y, tip.phi) {
        (TipEnd::Held(x), TipEnd::Held(y), TipEnd::Held(phi)) => Some(Pose { x, y, phi: phi + PI }),
        _ => None,
    }
}

/// Where the number of each equilibrium stands (mm): `beside` (mm) from its shape, where it is farthest from the other shapes, the clamps and the
/// numbers before it.
fn number_places(run: &ElasticaRun, curves: &[Vec<(f64, f64)>], beside: f64) -> Vec<(f64, f64)> {
    let mut taken: Vec<(f64, f64)> = vec![(1e3 * run.scene.clamp.x, 1e3 * run.scene.clamp.y)];
    taken.extend(tip_clamp(run).map(|pose| (1e3 * pose.x, 1e3 * pose.y)));
    for (branch, one) in run.equilibria.iter().enumerate() {
        let others = || {
            let others = curves.iter().enumerate().filter(|(other, _)| *other != branch);
            others.flat_map(|(_, curve)| curve).chain(&taken).copied()
        };
        // from the tip on, which is the first of places that are as good
        let places = (0..PLACES).rev().flat_map(|k| {
            let at = one.shape.at(one.shape.length() * k as f64 / (PLACES - 1) as f64);
            let ((x, y), directions) = ((1e3 * at.x, 1e3 * at.y), [at.phi + FRAC_PI_2, at.phi - FRAC_PI_2]);
            directions.map(|direction| ((x, y), (x + beside * direction.cos(), y + beside * direction.sin())))
        });
        let (mut best, mut farthest) = (None, f64::NEG_INFINITY);
        for (on_shape, number) in places {
            let free = nearest(on_shape, others()).min(nearest(number, others()));
            // it keeps off its own shape, too, which may come back
            let is_clear = nearest(number, curves[branch].iter().copied()) > 0.9 * beside;
            let free = if is_clear { free } else { 0.5 * free };
            if best.is_none() || free > farthest + 1e-6 * beside {
                (best, farthest) = (Some(number), free);
            }
        }
        taken.extend(best);
    }
    taken
}

/// The distance of a place from the nearest of some points; infinite without points.
fn nearest(place: (f64, f64), points: impl Iterator<Item = (f64, f64)>) -> f64 {
    points.map(|(x, y)| (x - place.0).hypot(y - place.1)).fold(f64::INFINITY, f64::min)
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
