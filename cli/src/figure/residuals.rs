//! What the contour of the fit leaves of a recording.

use super::abscissa::Abscissa;
use super::canvas::{BODY, FigureError, HPos, PAGE, TITLE, svg, write};
use super::palette::{INK, MUTED, label_colour};
use super::reactions::{along, path};
use super::trace::{self, Along, LINE, TracePart};
use rod_files::Reconstructed;
use std::ops::Range;
use vibrissa::Label;
use vibrissa::reconstruct::{ContourFit, FittedBlock, Goodness};

const WIDTH: u32 = PAGE;
/// Height of a plot, and of the title.
const PLOT: u32 = 260;
const HEAD: u32 = 140;
const NAMES: [&str; 3] = ["f_{0x}: residual / σ", "f_{0y}: residual / σ", "m_{0z}: residual / σ"];

/// Draws the residuals of the three channels above each other, coloured by the phase of the model, with the ends of the worst window as vertical
/// lines.
pub(crate) fn residuals(found: &Reconstructed, fit: &ContourFit) -> Result<String, FigureError> {
    let Some(path) = path(found) else { return svg((WIDTH, HEAD), |_| Ok(())) };
    let abscissa = Abscissa::of(&path);
    let at = |sample: usize| abscissa.value(found.samples[sample].pose);
    let middle = |block: &FittedBlock| at((block.samples.start + block.samples.end) / 2);
    let name = |label: Option<Label>| label.map_or_else(|| "?".to_owned(), |label| label.to_string());
    let worst = &fit.goodness.worst;
    let along = Along {
        phases: fit.runs().into_iter().map(|(samples, label)| (ends(&samples, at), name(label))).collect(),
        marks: worst.iter().flat_map(|worst| [worst.samples.start, worst.samples.end - 1]).map(at).collect(),
        ..along(found, &path, abscissa)
    };
    let height = HEAD + PLOT * NAMES.len() as u32 + trace::trimmings(true, true);
    svg((WIDTH, height), |root| {
        let (head, rest) = root.split_vertically(HEAD);
        let title = format!("{}: measured less the rod past the fitted contour", found.name);
        write(&head, &title, (24, 36), HPos::Left, TITLE, INK)?;
        for (line, y) in verdict(&fit.goodness).into_iter().zip([76, 110]) {
            write(&head, &line, (24, y), HPos::Left, BODY, MUTED)?;
        }
        let of_channel = |(channel, name): (usize, &'static str)| {
            (name, parts(fit, |block| Some((middle(block), block.residuals?[channel]))))
        };
        trace::stack(root, &rest, &along, PLOT, NAMES.into_iter().enumerate().map(of_channel).collect())
    })
}

fn ends(samples: &Range<usize>, at: impl Fn(usize) -> f64) -> Range<f64> {
    at(samples.start)..at(samples.end - 1)
}

/// How well the contour explains the recording, and where it does so worst.
fn verdict(Goodness { chi_squared, degrees_of_freedom, explains, worst, .. }: &Goodness) -> Vec<String> {
    let explains = if *explains { "explains the recording" } else { "does not explain the recording" };
    let all = format!("the contour {explains}: χ² {chi_squared:.0} of {degrees_of_freedom:.0} degrees of freedom");
    let worst = worst.as_ref().map(|worst| {
        format!("worst window (between the vertical lines): χ² {:.0} of {}", worst.chi_squared, worst.residuals)
    });
    std::iter::once(all).chain(worst).collect()
}

/// The residuals of blocks along which the model has one phase; a gap where some are left out.
fn parts(fit: &ContourFit, point: impl Fn(&FittedBlock) -> Option<(f64, f64)>) -> Vec<TracePart> {
    let known = |block: &FittedBlock| point(block).is_some().then_some(block.label);
    let runs = fit.blocks.chunk_by(|one, other| known(one) == known(other));
    let part = |run: &[FittedBlock]| {
        let colour = run[0].label.map_or(MUTED, label_colour);
        TracePart { points: run.iter().filter_map(&point).collect(), style: colour.stroke_width(LINE / 2) }
    };
    runs.map(part).filter(|part| !part.points.is_empty()).collect()
}
