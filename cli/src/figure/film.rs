//! A film: the points of some frames with the rod through them and the forces on it, and forces and moments over the frames.

use super::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, span, svg, write};
use super::element::Element;
use super::line::thin_line;
use super::palette::{FAINT, FIRST, INK, MUTED, TRANSITION};
use super::plane::PlaneWindow;
use super::trace::{self, Along, LINE, TracePart};
use rod_files::FilmForces;
use vibrissa::reconstruct::{FilmPole, FrameContact, FrameForces};
use vibrissa::rod::{Elastica, Load, RodError};

/// Most frames that are drawn.
const MOST: usize = 25;
/// Points on a rod.
const POINTS: usize = 200;
/// Least and largest height of the plane, height of the title, and of a plot over the frames, pixels.
const HEIGHT: (f64, f64) = (300.0, 1200.0);
const HEAD: u32 = 144;
const PLOT: u32 = 240;
/// Length of the largest force that is drawn, pixels.
const ARROW: f64 = 110.0;
/// How often the window is widened for the arrows. More changes nothing that is seen.
const WIDER: usize = 4;
/// Radius of a point, and half the width of the cross of a pole, pixels.
const DOT: i32 = 2;
const CROSS: f64 = 7.0;

/// Which frames have no line and no force.
const WITHOUT: &str = "without frames whose verdict is family, not explained or fault";

type Curve = Vec<(f64, f64)>;

/// Draws shapes and forces of some frames.
pub(crate) fn frames(found: &FilmForces) -> Result<String, FigureError> {
    let every = found.frames.len().div_ceil(MOST).max(1);
    let drawn = || found.frames.iter().zip(&found.film.frames).step_by(every);
    let dots = || drawn().flat_map(|((_, frame), _)| frame.points.iter().map(|point| (1e3 * point.x, 1e3 * point.y)));
    let judged = || {
        drawn().filter_map(|(_, judged)| judged.as_ref().ok()).filter(|judged| judged.verdict.has_contacts_of_its_own())
    };
    let rods: Vec<Curve> = judged().filter_map(|judged| rod(found, judged).ok()).collect();
    let rim = |cross: f64| found.film.pole.as_ref().map(|pole| rim(pole, cross)).unwrap_or_default();
    let extent = rim(0.0);
    let all = || dots().chain(rods.iter().flatten().copied()).chain(extent.iter().flatten().copied());
    let missing = match (found.family_count(), found.settings.pole) {
        (count @ 1.., None) => format!("; {count} of them family: --pole may determine them"),
        _ => String::new(),
    };
    if all().next().is_none() {
        let notes = [format!("{WITHOUT}{missing}"), String::new()];
        return svg((PAGE, HEAD), |root| title(root, &format!("{}: no points", found.name), &notes));
    }
    let largest =
        judged().flat_map(|judged| &judged.contacts).fold(f64::MIN_POSITIVE, |most, contact| most.max(contact.force));
    // an arrow that ends at the contact would lie in the pole
    let arrows = |scale: f64| -> Vec<[Curve; 2]> {
        let length = scale * ARROW / largest;
        let one = |contact: &FrameContact| {
            let at = (1e3 * contact.x, 1e3 * contact.y);
            let end = if extent.is_empty() { at } else { (at.0 + length * contact.fx, at.1 + length * contact.fy) };
            arrow(end, [contact.fx, contact.fy], length, scale)
        };
        judged().flat_map(|judged| &judged.contacts).map(one).collect()
    };
    let around = |arrows: &[[Curve; 2]]| {
        let points = || all().chain(arrows.iter().flatten().flatten().copied());
        let (x, y) = (span(points().map(|point| point.0), 0.08), span(points().map(|point| point.1), 0.08));
        PlaneWindow::as_wide_as(PAGE, &x, &y, HEIGHT)
    };
    // arrows have a length in pixels, and a wider window has larger ones
    let (mut window, mut height) = around(&[]);
    for _ in 0..WIDER {
        (window, height) = around(&arrows(window.scale));
    }
    svg((PAGE, HEAD + height), |root| {
        let (head, area) = root.split_vertically(HEAD);
        let shown = if every > 1 { format!("; one frame of {every} is drawn") } else { String::new() };
        let (name, unit) = force_unit(found);
        let said = if judged().all(|judged| judged.contacts.is_empty()) {
            "no force is found".to_owned()
        } else {
            let from = if extent.is_empty() { "arrows" } else { "arrows from the contacts" };
            format!("{from}: forces on the rod, the longest {:.2} {name}", largest / unit)
        };
        let pole = if extent.is_empty() { "" } else { "; black: the pole" };
        let notes = [format!("dots: points; lines: the rod; {said}{pole}"), format!("{WITHOUT}{missing}{shown}")];
        title(&head, &format!("{}: the rod and the forces on it", found.name), &notes)?;
        let chart = window.chart(&area, (12, 8))?;
        chart.draw_series(rods.iter().map(|rod| {
            Element::line(thin_line(rod.iter().copied(), (window.scale, window.scale)), FAINT.stroke_width(2))
        }))?;
        chart.draw_series(dots().map(|at| Element::circle(at, DOT, MUTED.filled())))?;
        for line in rim(CROSS * window.scale) {
            chart.draw_series([Element::line(line, INK.stroke_width(LINE / 2))])?;
        }
        for line in arrows(window.scale).into_iter().flatten() {
            chart.draw_series([Element::line(line, FIRST.stroke_width(LINE / 2))])?;
        }
        Ok(())
    })
}

/// Writes a title, and notes below it.
fn title(head: &Area<'_>, title: &str, notes: &[String; 2]) -> Result<(), FigureError> {
    write(head, title, (24, 36), HPos::Left, TITLE, INK)?;
    for (note, y) in notes.iter().zip([80, 114]) {
        write(head, note, (24, y), HPos::Left, BODY, MUTED)?;
    }
    Ok(())
}

/// The unit of forces in figures, by the largest one, and what it is in N.
fn force_unit(found: &FilmForces) -> (&'static str, f64) {
    if !found.rod.is_stiffness_known {
        return ("EI/L²", found.rod.rod.units().force);
    }
    let judged = found.film.frames.iter().flatten();
    let largest = judged.flat_map(|judged| &judged.contacts).fold(0.0_f64, |most, contact| most.max(contact.force));
    if largest < 1e-4 { ("µN", 1e-6) } else { ("mN", 1e-3) }
}

/// The rod of a frame, mm.
fn rod(found: &FilmForces, judged: &FrameForces) -> Result<Curve, RodError> {
    let load =
        |contact: &FrameContact| Load { s: contact.s, force: contact.force, alpha: contact.fx.atan2(-contact.fy) };
    let loads: Vec<Load> = judged.contacts.iter().map(load).collect();
    let rod = &found.rod.rod;
    let shape = Elastica::of_rod(rod.clone(), rod.units(), judged.base, judged.reactions.m0z, &loads)?;
    Ok(shape.sample(POINTS).map(|at| (1e3 * at.x, 1e3 * at.y)).collect())
}

/// The rim of a pole, and a cross of half this width at its centre, mm.
fn rim(pole: &FilmPole, size: f64) -> Vec<Curve> {
    let [x, y] = pole.center.map(|c| 1e3 * c);
    let at = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / POINTS as f64).sin_cos();
        (x + 1e3 * pole.radius * cos, y + 1e3 * pole.radius * sin)
    };
    let cross = [vec![(x - size, y), (x + size, y)], vec![(x, y - size), (x, y + size)]];
    let rim = (pole.radius > 0.0).then(|| (0..=POINTS).map(at).collect());
    cross.into_iter().chain(rim).collect()
}

/// The lines of the arrow of a force that ends at `to`; `length` (mm) is that of the unit of force, `pixel` (mm) the size of a pixel.
pub(super) fn arrow(to: (f64, f64), [fx, fy]: [f64; 2], length: f64, pixel: f64) -> [Curve; 2] {
    let force = fx.hypot(fy);
    let back = |along: f64, across: f64| {
        let (x, y) = (fx / force, fy / force);
        (to.0 - along * x - across * y, to.1 - along * y + across * x)
    };
    let head = 10.0 * pixel;
    [vec![back(length * force, 0.0), to], vec![back(head, 0.5 * head), to, back(head, -0.5 * head)]]
}

/// Draws force and place of the first contact and the moment at the base over the frames, with one standard deviation on either side.
pub(crate) fn over_frames(found: &FilmForces) -> Result<String, FigureError> {
    let is_known = found.rod.is_stiffness_known;
    let (unit, force) = force_unit(found);
    let moment = if is_known { 1e-6 } else { found.rod.rod.units().moment };
    let first = format!("force in {unit}");
    let names = [first.as_str(), "arc length in mm", if is_known { "m_{0z} in µN m" } else { "m_{0z} in EI/L" }];
    type Quantity = fn(&FrameForces) -> Option<(f64, f64)>;
    let quantities: [(Quantity, f64); 3] = [
        (|judged| judged.contacts.first().map(|contact| (contact.force, contact.sigma_force)), force),
        (|judged| judged.contacts.first().map(|contact| (contact.s, contact.sigmas()[0])), 1e-3),
        (|judged| Some((judged.reactions.m0z, judged.covariance[5][5].max(0.0).sqrt())), moment),
    ];
    let numbers: Vec<f64> = found.frames.iter().map(|(number, _)| *number as f64).collect();
    let along = Along {
        across: span(numbers.iter().copied(), 0.02),
        foot: "frame".into(),
        phases: Vec::new(),
        marks: Vec::new(),
        legs: Vec::new(),
        modes: Vec::new(),
    };
    let height = HEAD + PLOT * names.len() as u32 + trace::trimmings(true, true);
    svg((PAGE, height), |root| {
        let (head, rest) = root.split_vertically(HEAD);
        let notes = [
            "vertical bars: one standard deviation on either side; m_{0z}: of the clamp on the rod".to_owned(),
            WITHOUT.to_owned(),
        ];
        title(&head, &format!("{}: the first contact, and the moment at the base", found.name), &notes)?;
        let traces = names.into_iter().zip(quantities).map(|(name, (quantity, unit))| {
            let values: Vec<Option<(f64, f64)>> = found
                .film
                .frames
                .iter()
                .map(|judged| {
                    judged.as_ref().ok().filter(|judged| judged.verdict.has_contacts_of_its_own()).and_then(quantity)
                })
                .collect();
            (name, parts(&numbers, &values, unit))
        });
        trace::stack(root, &rest, &along, PLOT, traces.collect())
    })
}

/// Bars of standard deviations, and lines through the values of neighbouring frames.
fn parts(numbers: &[f64], values: &[Option<(f64, f64)>], unit: f64) -> Vec<TracePart> {
    let known: Vec<(f64, Option<(f64, f64)>)> = numbers.iter().copied().zip(values.iter().copied()).collect();
    let bar = |(at, value): &(f64, Option<(f64, f64)>)| {
        let (value, sigma) = value.filter(|(_, sigma)| sigma.is_finite())?;
        let points = vec![(*at, (value - sigma) / unit), (*at, (value + sigma) / unit)];
        Some(TracePart { points, style: FAINT.stroke_width(LINE) })
    };
    let bars = known.iter().filter_map(bar);
    let runs = known.chunk_by(|one, other| one.1.is_some() == other.1.is_some());
    let line = |run: &[(f64, Option<(f64, f64)>)]| TracePart {
        points: run.iter().filter_map(|(at, value)| value.map(|(value, _)| (*at, value / unit))).collect(),
        style: TRANSITION.stroke_width(2),
    };
    // a frame on its own is a dash
    let dash = |mut part: TracePart| {
        if let [(at, value)] = part.points[..] {
            part.points = vec![(at - 0.3, value), (at + 0.3, value)];
        }
        part
    };
    bars.chain(runs.map(line).filter(|part| !part.points.is_empty()).map(dash)).collect()
}
