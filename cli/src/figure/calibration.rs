//! How far the criteria of known phases are from 0, before and after a calibration.

use super::canvas::{Area, BODY, FigureError, HPos, PAGE, TITLE, svg, write};
use super::chart::{Chart, Room};
use super::element::Element;
use super::palette::{FAINT, INK, RGBColor, TRANSITION};
use rod_files::Reconstructed;
use std::ops::Range;
use vibrissa::Label;
use vibrissa::reconstruct::{Evidence, Travel};

/// Height of a plot, of the title and of what is below the last plot, pixels.
const PLOT: u32 = 330;
const HEAD: u32 = 110;
const FOOT: u32 = 66;
/// Most dots of a recording in a plot: more cannot be seen.
const DOTS: usize = 1500;
/// Radius of a dot, pixels.
const RADIUS: f64 = 2.5;
/// Share of the values at both ends that may be out of sight: single steep places would flatten all others.
const HIDDEN: f64 = 0.01;
const COLOURS: [RGBColor; 2] = [FAINT, TRANSITION];

/// The criteria that vanish at a sample, dimensionless; none where the phase does not require them to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residual {
    /// Way of the clamp, m.
    way: f64,
    /// K, s - 1 and normal speed.
    of: [Option<f64>; 3],
}

impl Residual {
    /// Those of a recording, with the labels of another reconstruction of it.
    pub fn all(found: &Reconstructed, labelled: &Reconstructed) -> Vec<Self> {
        let mut travel = Travel::new(found.rod.at_clamp());
        let ways: Vec<Option<f64>> = found.samples.iter().map(|sample| travel.go(&sample.pose).ok()).collect();
        let one = |number: usize| {
            let evidence = found.found.evidence(number)?;
            let label = labelled.found.readings.get(number)?.label;
            let of = |holds: bool, criterion: fn(&Evidence) -> f64| {
                Some(criterion(evidence)).filter(|value| holds && value.is_finite())
            };
            let single = matches!(label, Label::A | Label::B);
            let of = [
                of(matches!(label, Label::B | Label::BB), |evidence| evidence.criterion.value),
                of(label == Label::A, |evidence| evidence.length.value),
                of(single, |evidence| evidence.tangent.value),
            ];
            Some(Self { way: (*ways.get(number)?)?, of })
        };
        let stride = found.samples.len().div_ceil(DOTS).max(1);
        (0..found.samples.len()).step_by(stride).filter_map(one).collect()
    }
}

/// Draws the residuals before and after above each other.
pub(crate) fn calibration(residuals: &[Vec<Residual>; 2]) -> Result<String, FigureError> {
    let longest = residuals.iter().flatten().map(|residual| residual.way).fold(0.0, f64::max);
    let across = 0.0..(1e3 * longest).max(1e-3);
    svg((PAGE, HEAD + 3 * PLOT + FOOT), |root| {
        let (head, mut rest) = root.split_vertically(HEAD);
        write(&head, "Conditions of the phases, 0 in theory, dimensionless", (24, 36), HPos::Left, TITLE, INK)?;
        for (colour, (name, x)) in COLOURS.into_iter().zip([("before", 24), ("after the calibration", 200)]) {
            head.draw(&Element::circle((x + 14, 84), 7.0, colour.filled()))?;
            write(&head, name, (x + 34, 84), HPos::Left, BODY, INK)?;
        }
        for (index, name) in ["K", "s/L − 1", "normal speed"].into_iter().enumerate() {
            let (part, below) = rest.split_vertically(PLOT + if index == 2 { FOOT } else { 0 });
            panel(&part, &across, (index, name), residuals)?;
            rest = below;
        }
        Ok(())
    })
}

fn panel(
    area: &Area<'_>,
    across: &Range<f64>,
    (index, name): (usize, &str),
    residuals: &[Vec<Residual>; 2],
) -> Result<(), FigureError> {
    let points = |which: usize| {
        residuals[which].iter().filter_map(move |residual| Some((1e3 * residual.way, residual.of[index]?)))
    };
    let mut values: Vec<f64> = points(0).chain(points(1)).map(|point| point.1).collect();
    values.sort_unstable_by(f64::total_cmp);
    let end = |share: f64| values.get((share * values.len().saturating_sub(1) as f64).round() as usize).copied();
    let (low, high) = (end(HIDDEN).unwrap_or(0.0).min(0.0), end(1.0 - HIDDEN).unwrap_or(0.0).max(0.0));
    let margin = (0.1 * (high - low)).max(1e-9);
    let last = index == 2;
    let room = Room { left: 130, right: 24, top: 16, bottom: if last { 82 } else { 16 } };
    let chart = Chart::new(area, room, across.clone(), low - margin..high + margin);
    chart.axes((10, 5), (if last { "way of the clamp in mm" } else { "" }, name))?;
    chart.draw_series([Element::line([(across.start, 0.0), (across.end, 0.0)], INK)])?;
    for (which, colour) in COLOURS.into_iter().enumerate() {
        chart.draw_series(points(which).map(|point| Element::circle(point, RADIUS, colour.filled())))?;
    }
    Ok(())
}
